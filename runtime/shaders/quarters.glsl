/*
 * quarters.glsl: reads what is known of a light in the quarters of tiles around (penumbrae.comp).
 */

// Returns the penumbrae of the quarter in a column and row of the band; none outside of it.
Penumbrae find_quarter(uint list, ivec2 quarter)
{
    ivec2 quarters = 2 * ((ivec2(work.extent) + 7) / 8);
    bool  exists = all(greaterThanEqual(quarter, ivec2(0))) && all(lessThan(quarter, quarters));
    uvec2 within = uvec2(clamp(quarter, ivec2(0), quarters - 1));
    uint  tile = (within.y >> 1u) * uint(quarters.x >> 1) + (within.x >> 1u);
    uint  number = 4u * tile + 2u * (within.y & 1u) + (within.x & 1u);
    uint  word = find_listed(quarter_at(list, number));
    return unpack_penumbrae(exists ? word : 0u);
}
