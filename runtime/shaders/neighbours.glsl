/*
 * neighbours.glsl: reads what the pixels around a pixel have shared (shared.glsl).
 */

// A neighbour's code, and the position of its hit.
struct Neighbour {
    bool exists;
    uint code;
    vec3 position;
};

bool is_in_band(ivec2 pixel)
{
    return all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, ivec2(work.extent)));
}

// Returns the word of a pixel in a list of shared.glsl; 0 outside of the band.
uint find_word(uint list, ivec2 pixel)
{
    ivec2 within = clamp(pixel, ivec2(0), ivec2(work.extent) - 1);
    uint  word = find_shared(list, slot_of_pixel(uvec2(within)));
    return is_in_band(pixel) ? word : 0u;
}

Neighbour find_neighbour(uint list, ivec2 pixel)
{
    uint word = find_word(list, pixel);
    vec3 origin, axis;
    find_axis(vec2(ivec2(work.corner) + pixel) + work.offset, origin, axis);
    return Neighbour(word != 0u, word & 255u,
                     origin + uintBitsToFloat(word & 0xffffff00u) * axis);
}

// Returns the offset after `offset`, of those from -reach to reach in both directions.  It is not
// found by its number, since lavapipe divides integers lane by lane.
ivec2 next_offset(ivec2 offset, int reach)
{
    bool ends = offset.x == reach;
    return ivec2(ends ? -reach : offset.x + 1, offset.y + int(ends));
}
