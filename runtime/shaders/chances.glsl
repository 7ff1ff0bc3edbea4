/*
 * chances.glsl: random numbers of which nobody knows beforehand how many there are.
 */
uint chances;

// Begins the numbers of a pixel for a use, at the surface `control.value` of its path.
void begin_chances(uvec2 pixel, uint use)
{
    chances = hash_bits(pixel.x + hash_bits(pixel.y + hash_bits(control.ray +
              hash_bits(use + control.value + hash_bits(control.seed)))));
}

// Returns a random number in (0, 1).
float find_chance()
{
    chances += 0x9e3779b9u;
    return (float(hash_bits(chances) >> 9u) + 0.5) / 8388608.0;
}
