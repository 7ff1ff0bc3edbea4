/*
 * hit_lists.glsl: the pixels whose ray hits something, as a list: what comes after the primary rays
 * is about them alone.
 *
 * A pixel is known by its slot: 64 times its tile of 8x8 pixels, and its number in there.  So lie
 * the hits in memory, as what is near in the picture is looked at together.
 *
 * Means of occlusion are taken at a quarter of the pixels: the sparse ones, in columns and rows 0,
 * 2, 5 and 7 of their tile.  Lists lie where the queue of rays was, each long enough for all
 * pixels: all hits, the sparse ones, the remaining ones for which neighbours do not suffice, and
 * those whose shadow needs a wide mean.  Where groups of components were marched one after the
 * other, lists of what each of them shows follow, and behind these is what rays share
 * (shared.glsl).
 *
 * Last are words of the quarters of tiles, of 4x4 pixels: the list of those in which something is
 * hit; of each, a bit for every pixel that is; and of each, what is known of a light there.
 */
#ifdef NO_TEXELS
layout(std430, set = 1, binding = 6) buffer PixelLists { uint pixel_lists[]; };
uint find_listed(uint number) { return pixel_lists[number]; }
#else
layout(std430, set = 1, binding = 6) writeonly buffer PixelLists { uint pixel_lists[]; };
layout(set = 1, binding = 12) uniform usamplerBuffer pixel_list_texels;
uint find_listed(uint number) { return texelFetch(pixel_list_texels, int(number)).x; }
#endif

uint band_pixels() { return work.extent.x * work.extent.y; }

uint band_tiles()
{
    uvec2 tiles = (work.extent + 7u) / 8u;
    return tiles.x * tiles.y;
}

// Behind the lists of pixels: words of slots by shared.glsl, and words of quarters.  Tiles may
// reach beyond the band, so there are more slots than pixels.
uint shared_at(uint list, uint slot)
{
    return LIST_SHARED * band_pixels() + 64u * band_tiles() * list + slot;
}

uint quarter_at(uint list, uint number)
{
    return shared_at(SHARED_LISTS, 0u) + 4u * band_tiles() * list + number;
}

// In the band.
uvec2 pixel_of(uint slot)
{
    uvec2 tile = find_cell(slot / 64u, (work.extent.x + 7u) / 8u);
    return 8u * tile + uvec2(slot & 7u, slot >> 3u & 7u);
}

// Of a pixel among those of the band, row by row.
uint index_of(uvec2 pixel) { return pixel.y * work.extent.x + pixel.x; }

uint slot_of_pixel(uvec2 pixel)
{
    uint across = (work.extent.x + 7u) / 8u;
    return 64u * (pixel.y / 8u * across + pixel.x / 8u) + (pixel.y & 7u) * 8u + (pixel.x & 7u);
}

// The first slot of a quarter of a tile; the others are in four rows of four.
uint slot_of_quarter(uint number)
{
    return 64u * (number / 4u) + 4u * (number & 1u) + 32u * (number >> 1u & 1u);
}

// That of a bit, where a quarter begins at this one.
uint slot_of_bit(uint first, uint bit)
{
    uint number = uint(findLSB(bit));
    return first + 8u * (number >> 2u) + (number & 3u);
}

// That of its cone: the one nearest to the middle of the tile but one, both ways.
uint cone_of_quarter(uint number)
{
    return 64u * (number / 4u) + 18u + 3u * (number & 1u) + 24u * (number >> 1u & 1u);
}

// Whether something is hit there.
bool has_cone(uint number)
{
    uint column = 2u - (number & 1u), row = 2u - (number >> 1u & 1u);
    return (find_listed(quarter_at(HITS_OF_QUARTERS, number)) >> 4u * row + column & 1u) != 0u;
}

// Bits of the sparse pixels of a quarter: every second column and row, from its outer ones on.
uint sparse_pixels_of_quarter(uint number)
{
    return ((number & 1u) == 0u ? 0x0505u : 0x0a0au) << ((number & 2u) == 0u ? 0u : 4u);
}

// The ray of a pixel of the list, and where it hits.  That is found anew wherever it is asked for:
// it costs no more than to fetch it.
struct HitPoint {
    uint  slot;
    vec3  position;
    vec3  direction; // of the ray, unit
    float width;     // of a pixel there
    float rounding;  // of the coordinates
    float side;      // as of a RayEnd,
    uint  steps;     // likewise
};

HitPoint hit_point_of_slot(uint slot)
{
    uvec2 pixel = pixel_of(slot);
    RayEnd   ray = find_end(index_of(pixel));
    vec3  origin, direction;
    float base, slope;
    find_ray(vec2(work.corner + pixel) + work.offset, origin, direction, base, slope);
    vec3  position = origin + ray.t * direction;
    float rounding = ROUNDING * (largest(position) + largest(origin));
    float width = max(base + slope * ray.t, 1e-30); // something is divided by it
    return HitPoint(slot, position, direction, width, rounding, ray.side, ray.steps);
}

// The place of item `number` of the list that is read.
HitPoint find_hit_point(uint number)
{
    return hit_point_of_slot(find_listed(control.reading + number));
}
