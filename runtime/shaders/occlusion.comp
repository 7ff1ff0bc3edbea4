#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * occlusion.comp: how open a pixel is: the mean of what the rays of the pixels around have found
 * (secondary.comp), over places near the plane of its own, as occlusion differs from surface to
 * surface.
 *
 * Means are taken three times: at anchors (solid.glsl) of all pixels nearby, whose rays together are
 * spread evenly; there again of every second of these means around, as far as what closes a place
 * off is away; and then everywhere of those of the anchors around.
 */
#include "frame.glsl"
#include "solid.glsl"
#include "shared.glsl"
#include "neighbours.glsl"

// The mean is over places so near to the plane, in pixels, and asks for so much weight; it reaches
// so many pixels.  The wider one goes less far than what is hit is away: nearer to it occlusion
// changes within a pixel.
const float ON_PLANE = 1.5, LEAST_WEIGHT = 0.5, NEAR_REACH = 3.0, WIDE_REACH = 8.0, FAR_REACH = 4.5;
const float REACH_OF_HITS = 0.25;

// Anchors by their numbers in the whole band, along a row or a column.
ivec2 pixel_of_anchor(ivec2 number)
{
    ivec2 within = ivec2(0x7520 >> 4 * (number.x & 3) & 7, 0x7520 >> 4 * (number.y & 3) & 7);
    return 8 * (number >> 2) + within;
}

ivec2 anchor_at(ivec2 pixel)
{
    ivec2 within = ivec2(0x33221110 >> 4 * (pixel.x & 7) & 7, 0x33221110 >> 4 * (pixel.y & 7) & 7);
    return 4 * (pixel >> 3) + within;
}

// How far the wider mean reaches, in pixels, by how open a place is.
float find_wide_reach(Place place, float open)
{
    float away = frame.occlusion_reach * sqrt(open); // root of the mean square
    return min(WIDE_REACH, REACH_OF_HITS * away / place.width) * inversesqrt(float(control.rays));
}

// The sum of how open those around are, times their weights, and of these: all of 5x5 pixels, or
// 3x3 anchors, so many apart.
vec2 add_open(uint list, ivec2 pixel, Place place, vec3 normal, int apart, float radius)
{
    bool  anchors = apart > 0;
    ivec2 nearest = anchor_at(pixel);
    int   reach = anchors ? 1 : 2;
    float within = 1.0 / radius, thin = 1.0 / (ON_PLANE * place.width);
    vec2  sums = vec2(0.0);
    ivec2 step = ivec2(-reach);
    do {
        ivec2     at = anchors ? pixel_of_anchor(nearest + apart * step) : pixel + step;
        Neighbour there = find_neighbour(list, at);
        vec2      aside = vec2(at - pixel) * within;
        float     above = dot(there.position - place.position, normal) * thin;
        float     weight = max(1.0 - above * above, 0.0) * max(1.0 - dot(aside, aside), 0.0);
        sums += there.exists ? weight * vec2(openness_of_code(there.code), 1.0) : vec2(0.0);
        step = next_offset(step, reach);
    } while (step.y <= reach);
    return sums;
}

void begin_group() {}

// Who has no anchor on its surface is listed, and is the rest.
void do_item(uint number)
{
    uint  slot = find_listed(control.reading + number);
    bool  by_anchors = control.phase == OCCLUSION_UPSAMPLED;
    bool  wider = control.phase == OCCLUSION_WIDER;
    uint  list = wider ? MEANS_SHARED : RAYS_SHARED;
    int   apart = wider ? 2 : by_anchors ? 1 : 0;
    Place place = find_place_of(slot);
    float own = openness_of_code(max(find_shared(list, slot) & 255u, CLOSED));
    float radius = wider ? find_wide_reach(place, own) : by_anchors ? FAR_REACH : NEAR_REACH;
    vec3  normal = find_hit(FACING, slot).xyz;
    vec2  sums = add_open(list, ivec2(pixel_of(slot)), place, normal, apart, max(radius, 1.0));
    float open = sums.x / max(sums.y, 1e-6);
    // Of the rest anchors are asked as well: the mean there takes the place of the ray.
    if (control.phase == OCCLUSION_AT_SPARSE_PIXELS || wider)
        keep_shared(wider ? RAYS_SHARED : MEANS_SHARED, slot, find_depth(place),
                    code_of_openness(open));
    else if (!by_anchors || sums.y > LEAST_WEIGHT)
        keep_lighting(control.value, slot, open);
    else
        solid[LIST_REMAINING * band_pixels() + atomicAdd(counts.rest, 1u)] = slot;
}

#include "pixels.glsl"
