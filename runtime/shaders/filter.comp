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

// Of an anchor's empty cone: who is so near to it in pixels, about, on its plane and faces its way.
const float PROVEN_NEAR = 2.5, PROVEN_ON_PLANE = 1.0, FACING_ALIKE = 0.9;
// The mean of a shadow reaches so far, for the width of the penumbra; in pixels at least, or there
// is none, and at least for a second mean.
const float BLUR_OF_PENUMBRA = 0.5, LEAST_BLUR = 0.75, NEAR_BLUR = 2.0;
// The mean of occlusion is over places so near to the plane, in pixels, and asks for so much weight;
// it reaches so many pixels, and less where a pixel has several rays.
const float ON_PLANE = 1.5, LEAST_WEIGHT = 1.0, NEAR_REACH = 3.0, FAR_REACH = 6.0;

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
    vec3  origin, direction;
    float base, slope;
    find_ray(vec2(ivec2(work.corner) + pixel) + work.offset, origin, direction, base, slope);
    return Neighbour(word != 0u, word & 255u,
                     origin + uintBitsToFloat(word & 0xffffff00u) * direction);
}

// ---- Cones ----

// The anchor that is nearest to a pixel of its tile.
uint anchor_of(uint slot)
{
    uint column = 0x77552220u >> 4u * (slot & 7u) & 7u, row = 0x77552220u >> 4u * (slot >> 3u & 7u) & 7u;
    return (slot & ~63u) + 8u * row + column;
}

// Whether an anchor's empty cone tells that the light is seen from another pixel.
bool is_proven(Place here, vec3 normal, uint anchor)
{
    Place there = find_place_of(anchor);
    vec3  facing = find_hit(FACING, anchor).xyz, apart = here.position - there.position;
    float turned = max(-dot(facing, there.direction), 0.25);
    return dot(normal, facing) > FACING_ALIKE && abs(dot(apart, facing)) < PROVEN_ON_PLANE * here.width &&
           dot(apart, apart) * turned * turned < PROVEN_NEAR * PROVEN_NEAR * here.width * here.width;
}

// Of a row of a tile: room in the list is taken for all at once.
void list_unproven(uint row)
{
    uint  first = 8u * row, rest = 0u, column = 0u;
    uvec2 pixel = pixel_of(first);
    uint  end = pixel.y < work.extent.y ? min(work.extent.x - pixel.x, 8u) : 0u;
    while (column < end) {
        uint slot = first + column, anchor = anchor_of(slot);
        Ray  ray = find_end(index_of(pixel) + column);
        if (ray.fate == HIT) {
            bool proven = find_shared(RAYS_SHARED, anchor) != 0u;
            if (proven && anchor != slot)
                proven = is_proven(find_place_of(slot), find_hit(FACING, slot).xyz, anchor);
            if (proven) {
                keep_lighting(control.value, slot, 1.0);
                keep_shared(MEANS_SHARED, slot, ray.t, code_of_openness(1.0));
                if (anchor != slot)
                    keep_shared(RAYS_SHARED, slot, ray.t, LIT);
            }
            rest |= uint(!proven) << column;
        }
        column++;
    }
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
// they agree that the light is seen.
float find_blur(ivec2 pixel)
{
    float lit = 0.0, hidden = 0.0, width = 0.0;
    int   i = 0;
    do {
        uint code = find_word(RAYS_SHARED, pixel + 2 * (ivec2(i % 5, i / 5) - 2)) & 255u;
        bool hides = code >= NARROWEST && code <= WIDEST;
        lit += float(code == LIT);
        hidden += float(hides);
        width += hides ? width_of_code(code) : 0.0;
        i++;
    } while (i < 25);
    float blur = BLUR_OF_PENUMBRA * width / max(hidden, 1.0) * inversesqrt(float(control.rays));
    return lit > 0.0 ? blur : 0.0;
}

// The mean of what is seen, of every `stride`th of 5x5 pixels, as far as their places are near.
float find_mean(uint list, ivec2 pixel, Place place, int stride, float blur)
{
    vec2  sums = vec2(0.0);
    float within = 1.0 / (blur * place.width), edge = 1.0 / (2.0 * float(stride) + 1.0);
    int   i = 0;
    do {
        ivec2     offset = stride * (ivec2(i % 5, i / 5) - 2);
        Neighbour there = find_neighbour(list, pixel + offset);
        vec3      apart = (there.position - place.position) * within;
        vec2      aside = vec2(offset) * edge;
        float     weight = max(1.0 - dot(apart, apart), 0.0) * max(1.0 - dot(aside, aside), 0.0);
        float     seen = list == RAYS_SHARED ? float(there.code == LIT)
                                             : openness_of_code(there.code);
        bool      knows = there.exists && (list == MEANS_SHARED || there.code != BELOW_HORIZON);
        sums += knows ? weight * vec2(seen, 1.0) : vec2(0.0);
        i++;
    } while (i < 25);
    return sums.y > 0.0 ? sums.x / sums.y : 1.0;
}

void filter_shadow_near(uint slot)
{
    ivec2 pixel = ivec2(pixel_of(slot));
    uint  word = find_shared(RAYS_SHARED, slot), own = word & 255u;
    float blur = find_blur(pixel), share = own == BELOW_HORIZON || own == LIT ? 1.0 : 0.0;
    if (blur > LEAST_BLUR)
        share = find_mean(RAYS_SHARED, pixel, find_place_of(slot), 1, blur);
    keep_shared(MEANS_SHARED, slot, uintBitsToFloat(word), code_of_openness(share));
}

void filter_shadow(uint slot)
{
    Place place = find_place_of(slot);
    ivec2 pixel = ivec2(pixel_of(slot));
    float part = find_part_above(find_light(control.light), place, find_hit(FACING, slot).xyz);
    float share = openness_of_code(find_shared(MEANS_SHARED, slot) & 255u), blur = find_blur(pixel);
    if (blur > NEAR_BLUR)
        share = find_mean(MEANS_SHARED, pixel, place, 2, blur);
    keep_lighting(control.value, slot, share * part);
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

// Of an anchor, by all around.
float find_open_near(uint slot)
{
    Place place = find_place_of(slot);
    vec3  normal = find_hit(FACING, slot).xyz;
    ivec2 pixel = ivec2(pixel_of(slot));
    vec2  sums = vec2(0.0);
    int   i = 0;
    do {
        ivec2 offset = ivec2(i % 5, i / 5) - 2;
        add_open(place, normal, find_neighbour(RAYS_SHARED, pixel + offset), vec2(offset) / NEAR_REACH,
                 sums);
        i++;
    } while (i < 25);
    return sums.x / max(sums.y, 1e-6);
}

void filter_occlusion_near(uint slot)
{
    float at = uintBitsToFloat(find_shared(RAYS_SHARED, slot));
    keep_shared(MEANS_SHARED, slot, at, code_of_openness(find_open_near(slot)));
}

// By the anchors around; who has none on its surface is listed.
void filter_occlusion(uint slot)
{
    Place place = find_place_of(slot);
    vec3  normal = find_hit(FACING, slot).xyz;
    ivec2 pixel = ivec2(pixel_of(slot)), nearest = anchor_at(pixel);
    float reach = max(FAR_REACH * inversesqrt(sqrt(float(control.rays))), NEAR_REACH);
    vec2  sums = vec2(0.0);
    int   i = 0;
    do {
        ivec2 there = pixel_of_anchor(nearest + ivec2(i % 5, i / 5) - 2);
        add_open(place, normal, find_neighbour(MEANS_SHARED, there), vec2(there - pixel) / reach,
                 sums);
        i++;
    } while (i < 25);
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
