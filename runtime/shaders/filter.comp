#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * filter.comp: what neighbours share of light: shadows and occlusion from the rays of the pixels
 * around (secondary.comp), and which pixels need rays of their own.
 *
 * Shadows are a function of the place alone: a mean over places much nearer to each other than the
 * penumbra is wide blurs nothing.  So the radius of the mean comes from how far away the blockers
 * are, and which surfaces the neighbours are on does not matter.  Occlusion differs from surface
 * to surface: its mean is over places near the plane of the pixel's own.
 *
 * Means are taken twice: of all pixels nearby, whose rays together are spread evenly, and then of
 * some of these means, farther apart.
 */
#include "frame.glsl"
#include "solid.glsl"
#include "shared.glsl"

// control.phase
const uint LIST_UNPROVEN = 0u, SHADOW_NEAR = 1u, SHADOW = 2u, OCCLUSION_NEAR = 3u, OCCLUSION = 4u,
           OCCLUSION_OF_REST = 5u;

// Of an empty cone: who is so near to its start in pixels, about, on its plane and faces its way.
const float PROVEN_NEAR = 3.0, PROVEN_ON_PLANE = 1.0, FACING_ALIKE = 0.9;
// The mean of a shadow reaches so far, for the width of the penumbra; in pixels at least, or there
// is none, and at least for a second mean.
const float BLUR_OF_PENUMBRA = 0.5, LEAST_BLUR = 0.75, NEAR_BLUR = 2.0;
// The mean of occlusion is over places so near to the plane, in pixels, and asks for so much weight;
// it reaches so many pixels, and less where a pixel has several rays.
const float ON_PLANE = 1.5, LEAST_WEIGHT = 0.5, NEAR_REACH = 3.0, FAR_REACH = 4.5;

// A neighbour's word, and where its hit is.
struct Neighbour {
    bool exists;
    uint code;
    vec3 position;
};

uint slot_of_pixel(uvec2 pixel)
{
    uint across = (work.extent.x + 7u) / 8u;
    return 64u * (pixel.y / 8u * across + pixel.x / 8u) + (pixel.y & 7u) * 8u + (pixel.x & 7u);
}

bool is_in_band(ivec2 pixel)
{
    return all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, ivec2(work.extent)));
}

// Of a list of shared.glsl; 0 where there is no pixel.
uint find_word(uint list, ivec2 pixel)
{
    ivec2 within = clamp(pixel, ivec2(0), ivec2(work.extent) - 1);
    uint  word = find_shared(list, slot_of_pixel(uvec2(within)));
    return is_in_band(pixel) ? word : 0u;
}

Neighbour find_neighbour(uint list, ivec2 pixel)
{
    uint  word = find_word(list, pixel);
    vec3  origin, axis;
    find_axis(vec2(ivec2(work.corner) + pixel) + work.offset, origin, axis);
    return Neighbour(word != 0u, word & 255u,
                     origin + uintBitsToFloat(word & 0xffffff00u) * axis);
}

// The next of the offsets from -reach to reach in both directions: lavapipe divides integers lane by
// lane.
ivec2 next_offset(ivec2 offset, int reach)
{
    bool ends = offset.x == reach;
    return ivec2(ends ? -reach : offset.x + 1, offset.y + int(ends));
}

// ---- Cones ----

// Whether the empty cone of one pixel, which faces that way, tells that the light is seen from
// another.
bool is_proven(Place here, vec3 normal, Place cone, vec3 facing)
{
    vec3  apart = here.position - cone.position;
    float turned = max(-dot(facing, cone.direction), 0.25) / here.width;
    return dot(normal, facing) > FACING_ALIKE &&
           abs(dot(apart, facing)) < PROVEN_ON_PLANE * here.width &&
           dot(apart, apart) * turned * turned < PROVEN_NEAR * PROVEN_NEAR;
}

// Of half a row of a tile, whose hits are these bits and which has one cone: those that it proves.
uint prove_half(uint first, uint hits)
{
    uint cone = cone_of(first), proven = 0u;
    uint left = find_shared(RAYS_SHARED, cone) != 0u ? hits : 0u;
    if (left == 0u)
        return 0u;
    Place there = find_place_of(cone);
    vec3  facing = find_hit(FACING, cone).xyz;
    for (; left != 0u; left &= left - 1u) {
        uint  slot = first + uint(findLSB(left));
        Place here = find_place_of(slot);
        if (cone != slot && !is_proven(here, find_hit(FACING, slot).xyz, there, facing))
            continue;
        proven |= left & ~left + 1u;
        keep_lighting(control.value, slot, 1.0);
        keep_shared(MEANS_SHARED, slot, find_depth(here), code_of_openness(1.0));
        if (cone != slot)
            keep_shared(RAYS_SHARED, slot, find_depth(here), LIT);
    }
    return proven;
}

uint hits_of_row(uint first)
{
    uint  hits = 0u, column = 0u;
    uvec2 pixel = pixel_of(first);
    uint  index = index_of(pixel);
    uint  end = pixel.y < work.extent.y ? min(work.extent.x - pixel.x, 8u) : 0u;
    while (column < end) {
        hits |= uint(find_end(index + column).fate == HIT) << column;
        column++;
    }
    return hits;
}

// Of a row of a tile: room in the list is taken for all at once.
void list_unproven(uint row)
{
    uint first = 8u * row, hits = hits_of_row(first);
    if (hits == 0u)
        return;
    uint rest = hits & ~prove_half(first, hits & 15u);
    rest &= ~(prove_half(first + 4u, hits >> 4u) << 4u);
    if (rest == 0u)
        return;
    uint at = 2u * band_pixels() + atomicAdd(counts.rest, bitCount(rest));
    for (; rest != 0u; rest &= rest - 1u)
        solid[at++] = first + uint(findLSB(rest));
}

// ---- Shadows ----

// What part of a disc is above a line that is so far below its middle, in radii.
float part_above(float depth)
{
    float h = clamp(depth, -1.0, 1.0), away = 1.0 - abs(h);
    // The segment's area over pi: away^1.5 times a polynomial that is right to 5e-4.
    float segment = away * sqrt(away) * (0.607 - 0.107 * away);
    return h < 0.0 ? segment : 1.0 - segment;
}

// The share of the light's disc that is in front of the surface.
float find_part_above(Light light, Place place, vec3 normal)
{
    bool  positional = (light.kind & POSITIONAL) != 0u;
    vec3  toward = positional ? light.vector - place.position : light.vector;
    float remote = max(length(toward), 1e-30), rise = dot(normal, toward) / remote;
    float across = sqrt(max(1.0 - rise * rise, 0.0)), radius = light_radius(light);
    return radius > 0.0 ? part_above(rise * remote / max(radius * across, 1e-30))
                        : float(rise > 0.0);
}

// How far the mean of a shadow reaches, in pixels: by what every second of 9x9 pixels say.  0 where
// none of them sees the light.  Fewer would often agree by chance at the ends of a penumbra, and
// make it narrower.
float find_blur(ivec2 pixel)
{
    float lit = 0.0, hidden = 0.0, width = 0.0;
    ivec2 offset = ivec2(-2);
    do {
        uint code = find_word(RAYS_SHARED, pixel + 2 * offset) & 255u;
        bool hides = code >= NARROWEST && code <= WIDEST;
        lit += float(code == LIT);
        hidden += float(hides);
        width += hides ? width_of_code(code) : 0.0;
        offset = next_offset(offset, 2);
    } while (offset.y <= 2);
    float blur = BLUR_OF_PENUMBRA * width / max(hidden, 1.0) * inversesqrt(float(control.rays));
    return lit > 0.0 ? blur : 0.0;
}

// The mean of what is seen, of every `stride`th of 5x5 pixels, as far as their places are near.
float find_mean(uint list, ivec2 pixel, Place place, int stride, float blur)
{
    vec2  sums = vec2(0.0);
    float within = 1.0 / (blur * place.width), edge = 1.0 / (2.0 * float(stride) + 1.0);
    ivec2 step = ivec2(-2);
    do {
        ivec2     offset = stride * step;
        Neighbour there = find_neighbour(list, pixel + offset);
        vec3      apart = (there.position - place.position) * within;
        vec2      aside = vec2(offset) * edge;
        float     weight = max(1.0 - dot(apart, apart), 0.0) * max(1.0 - dot(aside, aside), 0.0);
        float     seen = list == RAYS_SHARED ? float(there.code == LIT)
                                             : openness_of_code(there.code);
        bool      knows = there.exists && (list == MEANS_SHARED || there.code != BELOW_HORIZON);
        sums += knows ? weight * vec2(seen, 1.0) : vec2(0.0);
        step = next_offset(step, 2);
    } while (step.y <= 2);
    return sums.y > 0.0 ? sums.x / sums.y : 1.0;
}

void keep_shadow(uint slot, Place place, float share)
{
    vec3 normal = find_hit(FACING, slot).xyz;
    keep_lighting(control.value, slot,
                  share * find_part_above(find_light(control.light), place, normal));
}

// By all around; who needs a wider mean is listed.
void filter_shadow_near(uint slot)
{
    ivec2 pixel = ivec2(pixel_of(slot));
    uint  word = find_shared(RAYS_SHARED, slot), own = word & 255u;
    float blur = find_blur(pixel), share = own == BELOW_HORIZON || own == LIT ? 1.0 : 0.0;
    if (blur > LEAST_BLUR)
        share = find_mean(RAYS_SHARED, pixel, find_place_of(slot), 1, blur);
    keep_shared(MEANS_SHARED, slot, uintBitsToFloat(word), code_of_openness(share));
    if (blur > NEAR_BLUR)
        solid[3u * band_pixels() + atomicAdd(counts.wide, 1u)] = slot;
    else
        keep_shadow(slot, find_place_of(slot), share);
}

void filter_shadow(uint slot)
{
    Place place = find_place_of(slot);
    ivec2 pixel = ivec2(pixel_of(slot));
    keep_shadow(slot, place, find_mean(MEANS_SHARED, pixel, place, 2, find_blur(pixel)));
}

// ---- Occlusion ----

// The sum of how open neighbours near the plane through a place are, times their weights, and of
// these.
void add_open(Place place, vec3 normal, Neighbour there, vec2 aside, inout vec2 sums)
{
    vec3  apart = there.position - place.position;
    float above = dot(apart, normal) / (ON_PLANE * place.width);
    float weight = max(1.0 - above * above, 0.0) * max(1.0 - dot(aside, aside), 0.0);
    weight = there.exists ? weight : 0.0;
    sums += weight * vec2(there.exists ? openness_of_code(there.code) : 0.0, 1.0);
}

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

// The mean of all around.
float find_open_near(uint slot)
{
    Place place = find_place_of(slot);
    vec3  normal = find_hit(FACING, slot).xyz;
    ivec2 pixel = ivec2(pixel_of(slot));
    vec2  sums = vec2(0.0);
    ivec2 step = ivec2(-2);
    do {
        add_open(place, normal, find_neighbour(RAYS_SHARED, pixel + step), vec2(step) / NEAR_REACH,
                 sums);
        step = next_offset(step, 2);
    } while (step.y <= 2);
    return sums.x / max(sums.y, 1e-6);
}

void filter_occlusion_near(uint slot)
{
    float depth = uintBitsToFloat(find_shared(RAYS_SHARED, slot));
    keep_shared(MEANS_SHARED, slot, depth, code_of_openness(find_open_near(slot)));
}

// By the means of the anchors around; who has none on its surface is listed.
void filter_occlusion(uint slot)
{
    Place place = find_place_of(slot);
    vec3  normal = find_hit(FACING, slot).xyz;
    ivec2 pixel = ivec2(pixel_of(slot)), nearest = anchor_at(pixel), step = ivec2(-1);
    vec2  sums = vec2(0.0);
    do {
        ivec2 there = pixel_of_anchor(nearest + step);
        add_open(place, normal, find_neighbour(MEANS_SHARED, there),
                 vec2(there - pixel) / FAR_REACH, sums);
        step = next_offset(step, 1);
    } while (step.y <= 1);
    if (sums.y > LEAST_WEIGHT)
        keep_lighting(control.value, slot, sums.x / sums.y);
    else
        solid[2u * band_pixels() + atomicAdd(counts.rest, 1u)] = slot;
}

void begin_group() {}

void do_item(uint number)
{
    if (control.phase == LIST_UNPROVEN) {
        list_unproven(number);
        return;
    }
    uint slot = find_listed(control.reading + number);
    if (control.phase == SHADOW_NEAR)
        filter_shadow_near(slot);
    else if (control.phase == SHADOW)
        filter_shadow(slot);
    else if (control.phase == OCCLUSION_NEAR)
        filter_occlusion_near(slot);
    else if (control.phase == OCCLUSION)
        filter_occlusion(slot);
    else
        keep_lighting(control.value, slot, find_open_near(slot));
}

#include "pixels.glsl"
