#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * occlusion.comp: how open a pixel is: the mean of what the rays of the pixels around have found
 * (secondary.comp), over places near the plane of its own, as occlusion differs from surface to
 * surface.
 *
 * Means are taken twice: at anchors (solid.glsl) of all pixels nearby, whose rays together are
 * spread evenly, and then everywhere of those of the anchors around.
 */
#include "frame.glsl"
#include "solid.glsl"
#include "shared.glsl"
#include "neighbours.glsl"

const uint AT_ANCHORS = 0u, BY_ANCHORS = 1u, OF_REST = 2u; // control.phase

// The mean is over places so near to the plane, in pixels, and asks for so much weight; it reaches
// so many pixels.
const float ON_PLANE = 1.5, LEAST_WEIGHT = 0.5, NEAR_REACH = 3.0, FAR_REACH = 4.5;

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

// The sum of how open those around are, times their weights, and of these: all of 5x5 pixels, or
// 3x3 anchors.
vec2 add_open(ivec2 pixel, Place place, vec3 normal, bool anchors)
{
    ivec2 nearest = anchor_at(pixel);
    int   reach = anchors ? 1 : 2;
    float within = 1.0 / (anchors ? FAR_REACH : NEAR_REACH), thin = 1.0 / (ON_PLANE * place.width);
    uint  list = anchors ? MEANS_SHARED : RAYS_SHARED;
    vec2  sums = vec2(0.0);
    ivec2 step = ivec2(-reach);
    do {
        ivec2     at = anchors ? pixel_of_anchor(nearest + step) : pixel + step;
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
    bool  anchors = control.phase == BY_ANCHORS;
    Place place = find_place_of(slot);
    vec3  normal = find_hit(FACING, slot).xyz;
    vec2  sums = add_open(ivec2(pixel_of(slot)), place, normal, anchors);
    float open = sums.x / max(sums.y, 1e-6);
    if (control.phase == AT_ANCHORS)
        keep_shared(MEANS_SHARED, slot, find_depth(place), code_of_openness(open));
    else if (!anchors || sums.y > LEAST_WEIGHT)
        keep_lighting(control.value, slot, open);
    else
        solid[2u * band_pixels() + atomicAdd(counts.rest, 1u)] = slot;
}

#include "pixels.glsl"
