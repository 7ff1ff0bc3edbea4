/*
 * hit_lists.glsl: lists of the pixels whose rays hit something.  All passes after the primary rays
 * are over such lists.
 *
 * A pixel has a slot: 64 times the number of its tile of 8x8 pixels, plus its number in the tile.
 * Hits are stored in the order of slots, as pixels that are near in the picture are used together.
 *
 * Means of occlusion are computed at a quarter of the pixels, the sparse ones: columns and rows 0,
 * 2, 5 and 7 of their tile.  The lists lie where the queue of rays was, each with room for all
 * pixels.  They are all hits; the sparse ones; the remaining ones, for which neighbours do not
 * suffice; and those whose shadow needs a wide mean.  Where march groups were marched one after the
 * other, lists of the hits of each follow.  Behind these is what rays share (shared.glsl).
 *
 * Last are words of the quarters of tiles, of 4x4 pixels.  They are the list of those with
 * hits, a bit for every pixel that hits, and what is known of a light there.
 */
#ifdef NO_TEXELS
layout(std430, set = 1, binding = QUEUE_BINDING) buffer PixelLists { uint pixel_lists[]; };
uint find_listed(uint number) { return pixel_lists[number]; }
#else
layout(std430, set = 1, binding = QUEUE_BINDING) writeonly buffer PixelLists {
    uint pixel_lists[];
};
layout(set = 1, binding = PIXEL_LIST_TEXELS_BINDING) uniform usamplerBuffer pixel_list_texels;
uint find_listed(uint number) { return texelFetch(pixel_list_texels, int(number)).x; }
#endif

uint band_pixels() { return work.extent.x * work.extent.y; }

// These return indices of words behind the lists of pixels: of a slot (shared.glsl), and of a
// quarter.  Tiles may reach beyond the band, so there are more slots than pixels.
uint shared_at(uint list, uint slot)
{
    return LIST_SHARED * band_pixels() + 64u * count_tiles() * list + slot;
}

uint quarter_at(uint list, uint number)
{
    return shared_at(SHARED_LISTS, 0u) + 4u * count_tiles() * list + number;
}

// Returns the index of a pixel of the band, counted row by row.
uint index_of(uvec2 pixel) { return pixel.y * work.extent.x + pixel.x; }

uint slot_of_pixel(uvec2 pixel)
{
    uint across = (work.extent.x + 7u) / 8u;
    return 64u * (pixel.y / 8u * across + pixel.x / 8u) + (pixel.y & 7u) * 8u + (pixel.x & 7u);
}

// Returns the first slot of a quarter of a tile; the others are in four rows of four.
uint slot_of_quarter(uint number)
{
    return 64u * (number / 4u) + 4u * (number & 1u) + 32u * (number >> 1u & 1u);
}

// Returns a bit for each pixel of a quarter that is in the band; `corner` is the quarter's first
// pixel.
uint find_existing(uvec2 corner)
{
    uvec2 size = min(max(work.extent, corner) - corner, uvec2(4u));
    return ((1u << size.x) - 1u) * (0x1111u & (1u << 4u * size.y) - 1u);
}

// Tells whether a pixel of the band, in a slot, has a ray.
bool slot_has_ray(uint slot)
{
    uvec2 pixel = pixel_of(slot), within = pixel & 3u;
    uint  quarter = 4u * (slot / 64u) + (slot >> 2u & 1u) + 2u * (slot >> 5u & 1u);
    bool  exists = pixel.x < work.extent.x && pixel.y < work.extent.y;
    return exists && (find_sampled(quarter) >> 4u * within.y + within.x & 1u) != 0u;
}

// Returns the slot of the lowest bit in a quarter whose first slot is `first`.
uint slot_of_bit(uint first, uint bit)
{
    uint number = uint(findLSB(bit));
    return first + 8u * (number >> 2u) + (number & 3u);
}

// Returns the slot at which a quarter's cone starts: in column and row 2 or 5 of the tile.
uint cone_of_quarter(uint number)
{
    return 64u * (number / 4u) + 18u + 3u * (number & 1u) + 24u * (number >> 1u & 1u);
}

// Tells whether the pixel at which a quarter's cone starts hits something.
bool has_cone(uint number)
{
    uint column = 2u - (number & 1u), row = 2u - (number >> 1u & 1u);
    return (find_listed(quarter_at(HITS_OF_QUARTERS, number)) >> 4u * row + column & 1u) != 0u;
}

// Returns the bits of the sparse pixels of a quarter: every second column and row, from the edge of
// the tile on.
uint sparse_pixels_of_quarter(uint number)
{
    return ((number & 1u) == 0u ? 0x0505u : 0x0a0au) << ((number & 2u) == 0u ? 0u : 4u);
}

#include "hit_point.glsl"

HitPoint hit_point_of_slot(uint slot)
{
    uvec2 pixel = pixel_of(slot);
    RayEnd   ray = find_end(index_of(pixel));
    vec3  origin, direction;
    float base, slope;
    find_ray(vec2(work.corner + pixel) + work.offset, origin, direction, base, slope);
    return hit_point_on(slot, origin, direction, base, slope, ray.t, ray.side, ray.steps);
}

// Returns the hit of item `number` of the list that is read.
HitPoint find_hit_point(uint number)
{
    return hit_point_of_slot(find_listed(control.reading + number));
}
