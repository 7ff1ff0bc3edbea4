#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * background.comp: adds the light of the sky to the pixels whose rays hit nothing, and lists the
 * pixels of all others.  A sun, a light with a disc in the sky, is added with the sky.  The shader
 * runs once more for each further sun.
 *
 * An item is a quarter of a tile of 8x8 pixels.
 */
#include "frame.glsl"
#include "hit_lists.glsl"
#include "light.glsl"
#ifdef SKY_MAP
#include "sky_map.glsl"
#endif
#include "results.glsl"

Light sun;
float sky; // 1: the sky is added; 0: the sun alone
bool  keeps_counts;
bool  begins; // there is no light of the pixels yet

void begin_group()
{
    sun = find_light(control.light);
    if (control.light >= control.lights || control.no_background != 0u)
        sun.softness = 0.0; // there is no sun
    sky = control.phase == BACKGROUND_FIRST && control.no_background == 0u ? 1.0 : 0.0;
    begins = control.phase == BACKGROUND_FIRST && control.first_ray != 0u;
    keeps_counts = control.phase == BACKGROUND_FIRST && control.first_ray != 0u &&
                   is_wanted(ROW_COUNTS);
}

// Lists the hits of a quarter.  Indices are reserved for all of its pixels at once, since an atomic
// operation costs each lane as much as many distances.
void list_hits(uint quarter, uint hits)
{
    uint first = slot_of_quarter(quarter), sparse = hits & sparse_pixels_of_quarter(quarter);
    uint at = 0u, sparse_at = 0u;
    if (hits != 0u) {
        at = atomicAdd(counts.hit_count, bitCount(hits));
        pixel_lists[quarter_at(LISTED_QUARTERS, atomicAdd(counts.quarters, 1u))] = quarter;
    }
    if (sparse != 0u)
        sparse_at = LIST_SPARSE * band_pixels() + atomicAdd(counts.sparse, bitCount(sparse));
    do { // do-while, as in pixels.glsl
        uint bit = hits & ~hits + 1u, slot = slot_of_bit(first, bit);
        if (hits != 0u)
            pixel_lists[at++] = slot;
        if ((sparse & bit) != 0u)
            pixel_lists[sparse_at++] = slot;
        hits &= ~bit;
    } while (hits != 0u);
}

// Stores the number of steps of each pixel of a quarter.
void store_counts(uint quarter, uint exist)
{
    uint first = slot_of_quarter(quarter), left = keeps_counts ? exist : 0u;
    for (; left != 0u; left &= left - 1u) {
        uint index = index_of(pixel_of(slot_of_bit(first, left)));
        results[ROW_COUNTS * band_pixels() + index] = uvec4(0u, find_end(index).steps, 0u, 0u);
    }
}

// Lists the hits of a quarter by march group, those of one group at a time.  `groups` has the four
// bits of their numbers, each as a bit for every pixel.
void list_by_group(uint quarter, uint hits, uvec4 groups)
{
    uint first = slot_of_quarter(quarter), left = control.by_march_group != 0u ? hits : 0u;
    do { // do-while, as in pixels.glsl
        uvec4 own = groups >> uint(findLSB(left | 0x10000u)) & 1u, differ = groups ^ uvec4(-ivec4(own));
        uint  same = left & ~(differ.x | differ.y | differ.z | differ.w), at = 0u;
        uint  group = own.x | own.y << 1u | own.z << 2u | own.w << 3u;
        left &= ~same;
        same = group == MARCH_GROUP_OF_PLATE ? 0u : same;
        if (same != 0u) {
            at = (LIST_OF_MARCH_GROUP + group) * band_pixels() +
                 atomicAdd(counts.of_march_group[group], bitCount(same));
        }
        do {
            if (same != 0u)
                pixel_lists[at++] = slot_of_bit(first, same);
            same &= same - 1u;
        } while (same != 0u);
    } while (left != 0u);
}

vec3 find_radiance(uvec2 pixel)
{
    vec3  origin, direction;
    float base, slope;
    find_ray(vec2(work.corner + pixel) + work.offset, origin, direction, base, slope);
#ifdef SKY_MAP
    vec3 seen = sky_map_radiance(direction);
#else
    vec3 seen = sky_radiance(direction);
#endif
    vec3 radiance = sky * seen +
                    sun_radiance(direction, sun.vector, sun.color, sun.softness);
    float left = let_through(origin.y, direction.y, FARTHEST);
    return finite_or_black(through_fog(radiance, left, sky > 0.0));
}

// Adds the light of the sky to pixels of a quarter.
void add_sky(uvec2 corner, uint misses)
{
    uint clamped = 0u, row = control.color_row * band_pixels();
    do { // do-while, as in pixels.glsl
        uint  bit = uint(findLSB(misses | 0x10000u)) & 15u;
        uvec2 pixel = corner + uvec2(bit & 3u, bit >> 2u);
        vec3  radiance = find_radiance(pixel);
        float factor = clamp_factor(radiance);
        // A number that is 0 so far is not fetched: all lanes fetch the first pixel.
        uint  index = index_of(pixel), fetched = begins ? 0u : index;
        vec3  before = begins ? vec3(0.0) : load_color(control.color_row, fetched).rgb;
        if (misses != 0u) {
            clamped += uint(factor < 1.0);
            store_color(row + index, before + factor * radiance);
        }
        misses &= misses - 1u;
    } while (misses != 0u);
    if (clamped != 0u)
        atomicAdd(counts.clamped, clamped);
}

void do_item(uint quarter)
{
    uvec2 corner = pixel_of(slot_of_quarter(quarter));
    uint  exist = find_existing(corner) & find_sampled(quarter), hits = 0u, unresolved = 0u, bit = 0u;
    uvec4 groups = uvec4(0u);
    do {
        uvec2  pixel = corner + uvec2(bit & 3u, bit >> 2u);
        RayEnd ray = find_end((exist >> bit & 1u) != 0u ? index_of(pixel) : 0u);
        hits |= uint(ray.state == STATE_HIT) << bit;
        unresolved |= uint(ray.unresolved) << bit;
        groups |= (uvec4(ray.march_group) >> uvec4(0u, 1u, 2u, 3u) & 1u) << bit;
        bit++;
    } while (bit < 16u);
    add_sky(corner, exist & ~hits);
    exist = control.phase == BACKGROUND_FIRST ? exist : 0u;
    unresolved &= exist;
    hits &= exist;
    if (unresolved != 0u)
        atomicAdd(counts.unresolved, bitCount(unresolved));
    if (control.phase == BACKGROUND_FIRST) {
        pixel_lists[quarter_at(HITS_OF_QUARTERS, quarter)] = hits;
        pixel_lists[quarter_at(LIGHT_OF_QUARTERS, quarter)] = 0u; // these stay 0 where nothing is hit
        pixel_lists[quarter_at(LIGHT_AROUND_QUARTERS, quarter)] = 0u;
    }
    list_hits(quarter, hits);
    list_by_group(quarter, hits, groups);
    store_counts(quarter, exist);
}

#include "pixels.glsl"
