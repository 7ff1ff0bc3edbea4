/*
 * samples.glsl: points of the unit square for the rays of pixels, so that neighbours together fill
 * it evenly.
 *
 * Pixels are numbered along the Z-order curve.  The bits of this number, scrambled from the highest
 * to the lowest, say which point of Sobol's (0, 2)-sequence a pixel takes.  See Ahmed and Wonka,
 * Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error, 2020.  Divide the unit square
 * into as many equal boxes, of any shape, as a square of 2^n by 2^n pixels has pixels.  Then each
 * box has one of its points.  The noise that is left differs most between neighbours.
 *
 * Each further ray of a pixel goes on by steps of the R4 sequence: multiples of powers of a root of
 * x^5 = x + 1, modulo 1.  The position of rays in their pixels follows the R2 sequence (place_ray
 * in plan.c).  Both together fill the pixel and the square evenly.
 */

#ifndef SAMPLES // frame.glsl may have it already
#define SAMPLES

const uint USE_OF_LENS = 0x6c656e73u; // no light has this number

// Returns the bits of a number of 16 bits, with a 0 before each.
uint spread_bits(uint bits)
{
    bits = (bits | bits << 8u) & 0x00ff00ffu;
    bits = (bits | bits << 4u) & 0x0f0f0f0fu;
    bits = (bits | bits << 2u) & 0x33333333u;
    return (bits | bits << 1u) & 0x55555555u;
}

// Flips each bit at random, depending on the lower bits (Laine and Karras 2011, with the constants
// of Vegdahl 2021).
uint scramble_bits(uint bits, uint seed)
{
    bits ^= bits * 0x3d20adeau;
    bits += seed;
    bits *= seed >> 16u | 1u;
    bits ^= bits * 0x05526c56u;
    return bits ^ bits * 0x53a22864u;
}

// Returns a hash that looks random (PCG, O'Neill 2014).
uint hash_bits(uint bits)
{
    bits = bits * 747796405u + 2891336453u;
    bits = (bits >> (bits >> 28u) + 4u ^ bits) * 277803737u;
    return bits >> 22u ^ bits;
}

// Returns the bits of the point of a pixel.  Points for different values of `use` are independent.
uvec2 sample_bits(uvec2 pixel, uint use, uint seed)
{
    uint number = spread_bits(pixel.x) | spread_bits(pixel.y) << 1u;
    uint own = hash_bits(use + 977u * seed);
    uint x = scramble_bits(bitfieldReverse(number), own);
    uint y = x ^ (x & 0x55555555u) << 1u; // Pascal's triangle modulo 2 makes the second dimension
    y ^= (y & 0x33333333u) << 2u;
    y ^= (y & 0x0f0f0f0fu) << 4u;
    y ^= (y & 0x00ff00ffu) << 8u;
    y ^= (y & 0x0000ffffu) << 16u;
    y ^= hash_bits(own);
    return uvec2(x, y);
}

// Returns the point for ray `ray` of a pixel.
vec2 sample_square(uvec2 pixel, uint ray, uint use, uint seed)
{
    uvec2 bits = sample_bits(pixel, use, seed);
    return fract(vec2(bits >> 8u) / 16777216.0 + vec2(0.6287067, 0.5385973) * float(ray));
}

// Returns the same on the lens, by the two other steps of R4: fractions of 2^32.
vec2 sample_lens(uvec2 pixel, uint ray, uint seed)
{
    uvec2 bits = sample_bits(pixel, USE_OF_LENS, seed) + uvec2(3679390609u, 3152041523u) * ray;
    return vec2(bits >> 8u) / 16777216.0;
}

// Maps the unit square to the unit disc, with areas in proportion.
vec2 disc_of_square(vec2 square)
{
    float angle = 2.0 * PI * square.x;
    return sqrt(square.y) * vec2(krs_cos(angle), krs_sin(angle));
}
#endif
