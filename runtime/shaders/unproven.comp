#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * unproven.comp: lists the pixels that need rays of their own to a light.  For these the cone of
 * their quarter of a tile (secondary.comp) does not prove that all of the light is visible.
 *
 * An item is a quarter of the list.
 */
#include "frame.glsl"
#include "hit_lists.glsl"
#include "shared.glsl"

// An empty cone proves this for pixels near its start, near its plane (both in pixels, about), and
// with a similar normal (the least cosine).
const float PROVEN_NEAR = 3.0, PROVEN_ON_PLANE = 1.0, FACING_ALIKE = 0.9;

// Tells whether the empty cone of a pixel with normal `facing` proves that another pixel sees all of the
// light.
bool is_proven(HitPoint here, vec3 normal, HitPoint cone, vec3 facing)
{
    vec3  difference = here.position - cone.position;
    float turned = max(-dot(facing, cone.direction), 0.25) / here.width;
    return dot(normal, facing) > FACING_ALIKE &&
           abs(dot(difference, facing)) < PROVEN_ON_PLANE * here.width &&
           dot(difference, difference) * turned * turned < PROVEN_NEAR * PROVEN_NEAR;
}

// Returns the bits of the hits of a quarter for which its cone proves this; their visibility is
// stored.
uint find_proven(uint quarter, uint hits)
{
    uint first = slot_of_quarter(quarter), cone = cone_of_quarter(quarter), proven = 0u;
    uint left = find_shared(RAYS_SHARED, cone) != 0u ? hits : 0u;
    HitPoint there = hit_point_of_slot(cone);
    vec3  facing = load_hit(FACING, cone).xyz;
    for (; left != 0u; left &= left - 1u) {
        uint  slot = slot_of_bit(first, left);
        HitPoint here = hit_point_of_slot(slot);
        if (cone != slot && !is_proven(here, load_hit(FACING, slot).xyz, there, facing))
            continue;
        proven |= left & ~left + 1u;
        store_lighting(control.value, slot, 1.0);
        store_shared(MEANS_SHARED, slot, find_depth(here), code_of_openness(1.0));
        if (cone != slot)
            store_shared(RAYS_SHARED, slot, find_depth(here), LIT);
    }
    return proven;
}

void begin_group() {}

// Lists the other hits of a quarter.  Indices are reserved for all of them at once.
void do_item(uint number)
{
    uint quarter = find_listed(control.reading + number), first = slot_of_quarter(quarter);
    uint hits = find_listed(quarter_at(HITS_OF_QUARTERS, quarter));
    uint proven = find_proven(quarter, hits), rest = hits & ~proven;
    pixel_lists[quarter_at(LIGHT_OF_QUARTERS, quarter)] = rest | proven << 16u;
    if (rest == 0u)
        return;
    uint at = LIST_REMAINING * band_pixels() + atomicAdd(counts.remaining, bitCount(rest));
    for (; rest != 0u; rest &= rest - 1u)
        pixel_lists[at++] = slot_of_bit(first, rest);
}

#include "pixels.glsl"
