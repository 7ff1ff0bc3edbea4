#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * shadow.comp: how much of a light a pixel sees: the mean of what the rays of the pixels around have
 * found (secondary.comp).
 *
 * A shadow is a function of the place alone: a mean over places much nearer to each other than the
 * penumbra is wide blurs nothing.  So the radius of the mean comes from how far away the blockers
 * are, and which surfaces the neighbours are on does not matter.  Along the way to the light a
 * shadow changes little up to half the way to the blockers, so what is near is counted aside from
 * that: where light is grazing a surface its penumbrae are long.
 *
 * Means are taken twice where penumbrae are wide: of all pixels nearby, whose rays together are
 * spread evenly, and then of some of these means, farther apart.
 */
#include "frame.glsl"
#include "solid.glsl"
#include "shared.glsl"
#include "neighbours.glsl"

// The mean reaches so far, for the width of the penumbra; in pixels at least, and at least for a
// second mean, where light falls straight, and where it is grazing.
const float BLUR_OF_PENUMBRA = 0.5, LEAST_BLUR = 1.25, NEAR_BLUR = 2.0, GRAZING = 0.25;

// What part of a disc is above a line that is so far below its middle, in radii.
float part_above(float depth)
{
    float h = clamp(depth, -1.0, 1.0), away = 1.0 - abs(h);
    // The segment's area over pi: away^1.5 times a polynomial that is right to 5e-4.
    float segment = away * sqrt(away) * (0.607 - 0.107 * away);
    return h < 0.0 ? segment : 1.0 - segment;
}

// The light as a place sees it.
struct Disc {
    vec3  toward; // its middle, unit
    float spread; // its radius at distance 1
};

Disc find_disc(Light light, Place place)
{
    bool  positional = (light.kind & LIGHT_POSITIONAL) != 0u;
    vec3  toward = positional ? light.vector - place.position : light.vector;
    float remote = max(length(toward), 1e-30);
    return Disc(toward / remote, light_radius(light) / remote);
}

// The share of the light's disc that is in front of the surface.
float find_part_above(Disc disc, float rise)
{
    float across = sqrt(max(1.0 - rise * rise, 0.0));
    return disc.spread > 0.0 ? part_above(rise / max(disc.spread * across, 1e-30))
                             : float(rise > 0.0);
}

// What a quarter of a tile adds to the penumbrae around a pixel.
Penumbrae find_quarter(ivec2 quarter, float weight)
{
    ivec2 quarters = 2 * ((ivec2(work.extent) + 7) / 8);
    bool  exists = all(greaterThanEqual(quarter, ivec2(0))) && all(lessThan(quarter, quarters));
    uvec2 within = uvec2(clamp(quarter, ivec2(0), quarters - 1));
    uint  tile = (within.y >> 1u) * uint(quarters.x >> 1) + (within.x >> 1u);
    uint  number = 4u * tile + 2u * (within.y & 1u) + (within.x & 1u);
    Penumbrae of = unpack_penumbrae(find_listed(quarter_at(LIGHT_OF_QUARTERS, number)));
    weight = exists ? weight : 0.0;
    return Penumbrae(weight * of.lit, weight * of.hidden, weight * of.width);
}

// How far the mean reaches, in pixels, by the four quarters around.  0 where all of them see the
// light, or nothing does.  Fewer pixels would often agree by chance at the ends of a penumbra, and make it
// narrower.
float find_blur(ivec2 pixel)
{
    vec2  place = 0.25 * (vec2(pixel) + 0.5) - 0.5, part = fract(place);
    ivec2 first = ivec2(floor(place)), step = ivec2(0);
    float lit = 0.0, hidden = 0.0, width = 0.0;
    do {
        vec2      aside = abs(1.0 - vec2(step) - part);
        Penumbrae found = find_quarter(first + step, aside.x * aside.y);
        lit += found.lit;
        hidden += found.hidden;
        width += found.width;
        step = ivec2(1 - step.x, step.y + step.x);
    } while (step.y < 2);
    float blur = max(BLUR_OF_PENUMBRA * width / max(hidden, 1e-6), LEAST_BLUR);
    return lit > 0.0 && hidden > 0.0 ? blur * inversesqrt(float(control.rays)) : 0.0;
}

// The mean of what is seen, of every `stride`th of 5x5 pixels, as far as their places are near.
float find_mean(uint list, ivec2 pixel, Place place, Disc disc, int stride, float blur)
{
    vec2  sums = vec2(0.0);
    float within = 1.0 / max(blur * place.width, 1e-30), edge = 1.0 / (2.0 * float(stride) + 1.0);
    float stretched = 1.0 - min(2.0 * disc.spread, 1.0); // towards the light
    ivec2 step = ivec2(-2);
    do {
        ivec2     offset = stride * step;
        Neighbour there = find_neighbour(list, pixel + offset);
        vec3      apart = (there.position - place.position) * within;
        apart -= stretched * dot(apart, disc.toward) * disc.toward;
        vec2      aside = vec2(offset) * edge;
        float     weight = max(1.0 - dot(apart, apart), 0.0) * max(1.0 - dot(aside, aside), 0.0);
        float     seen = list == RAYS_SHARED ? float(there.code == LIT)
                                             : openness_of_code(there.code);
        bool      knows = there.exists && (list == MEANS_SHARED || there.code != BELOW_HORIZON);
        sums += knows ? weight * vec2(seen, 1.0) : vec2(0.0);
        step = next_offset(step, 2);
    } while (step.y <= 2 && blur > 0.0);
    return sums.y > 0.0 ? sums.x / sums.y : 1.0;
}

void begin_group() {}

// First by all around; who needs a wider mean is listed for the second time.
void do_item(uint number)
{
    uint  slot = find_listed(control.reading + number);
    bool  wide = control.phase == SHADOW_WIDE;
    Place place = find_place_of(slot);
    ivec2 pixel = ivec2(pixel_of(slot));
    uint  word = find_shared(RAYS_SHARED, slot), own = word & 255u;
    float blur = find_blur(pixel), share = own == BELOW_HORIZON || own == LIT ? 1.0 : 0.0;
    Disc  disc = find_disc(find_light(control.light), place);
    uint  list = wide ? MEANS_SHARED : RAYS_SHARED;
    float mean = find_mean(list, pixel, place, disc, wide ? 2 : 1, blur);
    share = blur > 0.0 ? mean : share;
    float rise = dot(find_hit(FACING, slot).xyz, disc.toward);
    if (!wide)
        keep_shared(MEANS_SHARED, slot, uintBitsToFloat(word), code_of_openness(share));
    if (!wide && blur > NEAR_BLUR * clamp(rise, GRAZING, 1.0))
        solid[LIST_WIDE * band_pixels() + atomicAdd(counts.wide, 1u)] = slot;
    else
        keep_lighting(control.value, slot, share * find_part_above(disc, rise));
}

#include "pixels.glsl"
