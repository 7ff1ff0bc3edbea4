/*
 * occluders.glsl: a number for each pixel, in the room of a list that is not in use: of what its ray
 * over the hemisphere has met, the distance, then the albedo.
 */
uint occluder_at(uint list, ivec2 pixel)
{
    ivec2 within = clamp(pixel, ivec2(0), ivec2(work.extent) - 1);
    return list * band_pixels() + index_of(uvec2(within));
}

void store_occluder(uint list, ivec2 pixel, float number)
{
    pixel_lists[occluder_at(list, pixel)] = floatBitsToUint(number);
}

float find_occluder(uint list, ivec2 pixel)
{
    return uintBitsToFloat(find_listed(occluder_at(list, pixel)));
}
