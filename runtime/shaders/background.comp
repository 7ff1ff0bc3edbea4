#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * background.comp: adds the light of the sky to the pixels whose rays hit nothing, and lists the
 * pixels of all others.  A sun, a light with a disc in the sky, is added with the sky.  The kernel
 * runs once more for each further sun.
 *
 * An item is a quarter of a tile of 8x8 pixels.
 */
#include "frame.glsl"
#include "hit_lists.glsl"
#include "light.glsl"
#include "sky_map.glsl"
#include "results.glsl"

Light sun;
float sky; // 1: the sky is added; 0: the sun alone
bool  keeps_counts;

void begin_group()
{
    sun = find_light(control.light);
    if (control.light >= control.lights || control.no_background != 0u)
        sun.softness = 0.0; // there is no sun
    sky = control.phase == BACKGROUND_FIRST && control.no_background == 0u ? 1.0 : 0.0;
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

// Stores what is seldom wanted: the number of steps, and lists by march group.
void store_more(uint quarter, uint exist, uint hits)
{
    bool by_march_group = control.by_march_group != 0u;
    uint first = slot_of_quarter(quarter), left = by_march_group || keeps_counts ? exist : 0u;
    for (; left != 0u; left &= left - 1u) {
        uint slot = slot_of_bit(first, left), index = index_of(pixel_of(slot));
        RayEnd  ray = find_end(index);
        if (keeps_counts)
            results[ROW_COUNTS * band_pixels() + index] = uvec4(0u, ray.steps, 0u, 0u);
        bool    listed = by_march_group && ray.march_group != MARCH_GROUP_OF_PLATE;
        if (listed && (hits & left & ~left + 1u) != 0u) {
            uint first_of_list = (LIST_OF_MARCH_GROUP + ray.march_group) * band_pixels();
            pixel_lists[first_of_list + atomicAdd(counts.of_march_group[ray.march_group], 1u)] =
                slot;
        }
    }
}

vec3 find_radiance(uvec2 pixel)
{
    vec3  origin, direction;
    float base, slope;
    find_ray(vec2(work.corner + pixel) + work.offset, origin, direction, base, slope);
    vec3 seen = sky_radiance(direction);
    if (has_sky_map())
        seen = sky_map_radiance(direction);
    vec3 radiance = sky * seen +
                    sun_radiance(direction, sun.vector, sun.color, sun.softness);
    float left = let_through(origin.y, direction.y, FARTHEST);
    return finite_or_black(through_fog(radiance, left, sky > 0.0));
}

void do_item(uint quarter)
{
    uvec2 corner = pixel_of(slot_of_quarter(quarter));
    uint  exist = find_existing(corner) & find_sampled(quarter), hits = 0u, unresolved = 0u, clamped = 0u, bit = 0u;
    do {
        uvec2 pixel = corner + uvec2(bit & 3u, bit >> 2u);
        uint  index = index_of(pixel);
        bool  exists = (exist >> bit & 1u) != 0u;
        RayEnd   ray = find_end(exists ? index : 0u);
        vec3  radiance = find_radiance(pixel);
        hits |= uint(ray.state == STATE_HIT) << bit;
        unresolved |= uint(ray.unresolved) << bit;
        float factor = clamp_factor(radiance);
        clamped += uint(exists && ray.state != STATE_HIT && factor < 1.0);
        if (exists && ray.state != STATE_HIT)
            add_light(index, factor * radiance);
        bit++;
    } while (bit < 16u);
    exist = control.phase == BACKGROUND_FIRST ? exist : 0u;
    unresolved &= exist;
    hits &= exist;
    if (unresolved != 0u)
        atomicAdd(counts.unresolved, bitCount(unresolved));
    if (clamped != 0u)
        atomicAdd(counts.clamped, clamped);
    if (control.phase == BACKGROUND_FIRST) {
        pixel_lists[quarter_at(HITS_OF_QUARTERS, quarter)] = hits;
        pixel_lists[quarter_at(LIGHT_OF_QUARTERS, quarter)] = 0u; // it stays 0 where nothing is hit
    }
    list_hits(quarter, hits);
    store_more(quarter, exist, hits);
}

#include "pixels.glsl"
