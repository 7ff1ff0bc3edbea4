#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * occlusion.comp: how open a hit is to the sky: the mean of what the rays of the pixels around have
 * found (secondary.comp).  Occlusion differs from surface to surface, so the mean is over hits near
 * the plane of the pixel's own.
 *
 * Means are computed three times.  The first are at sparse pixels (hit_lists.glsl), of all pixels
 * nearby, whose rays together are spread evenly.  The second are there as well, of every second of
 * the first means.  Their reach follows from how far the occluders are: openness changes over the
 * harmonic mean of their distances (Ward and others 1988).  The third are at all pixels, of the means
 * at the sparse pixels around.
 */
#include "frame.glsl"
#include "hit_lists.glsl"
#include "shared.glsl"
#include "neighbours.glsl"
#include "occluders.glsl"
#include "openness.glsl"

// A mean is over hits at most ON_PLANE pixels from the plane; the sum of their weights is at least
// MIN_WEIGHT.  The reaches are those of the three means, in pixels.
const float ON_PLANE = 1.5, MIN_WEIGHT = 0.5, NEAR_REACH = 3.0, WIDE_REACH = 8.0, FAR_REACH = 4.5;
// The reach of the wider mean, relative to the distance of the occluders.
const float REACH_OF_HITS = 0.7;
// A reach in space that leaves nothing out.  Its inverse is no denormal number: processors are slow at those.
const float ANY_DISTANCE = 1e12;
// Added to the mean squares of offsets, in reaches: slopes of few noisy taps count less.
const float MIN_SPREAD = 0.1;

// Returns the pixel of a sparse pixel's number, which is its column and row among the sparse ones
// of the band.
ivec2 pixel_of_sparse(ivec2 number)
{
    ivec2 within = ivec2(0x7520 >> 4 * (number.x & 3) & 7, 0x7520 >> 4 * (number.y & 3) & 7);
    return 8 * (number >> 2) + within;
}

ivec2 sparse_at(ivec2 pixel)
{
    ivec2 within = ivec2(0x33221110 >> 4 * (pixel.x & 7) & 7, 0x33221110 >> 4 * (pixel.y & 7) & 7);
    return 4 * (pixel >> 3) + within;
}

bool is_sparse(ivec2 pixel) { return pixel_of_sparse(sparse_at(pixel)) == pixel; }

// Returns the reach of the wider mean, in pixels, by the inverse of the distance of the occluders.
float find_wide_reach(float nearness)
{
    return REACH_OF_HITS * inversesqrt(float(control.rays)) / max(nearness, 1e-6);
}

// Sums over the pixels around, of weights and of weighted products; offsets are in reaches.
struct Sums {
    float weight, openness;
    float nearness;       // inverse distances of occluders, in pixels, if these are rays
    float back;           // the part that is not open times the albedo of its occluders
    vec2  offset, sloped; // of offsets; of openness times offset
    vec3  square;         // of x x, x y and y y
};

// The source that is read: a list of shared.glsl, and where albedos are.
struct Source {
    uint words, albedos;
};

// Sums the openness of 5x5 pixels, or of 3x3 sparse ones at this spacing, up to `radius` in the
// picture and `farthest` in space, both in pixels.
Sums sum_openness(Source source, ivec2 pixel, HitPoint hit, vec3 normal, int spacing, float radius,
                  float farthest)
{
    bool  sparse = spacing > 0;
    ivec2 nearest = sparse_at(pixel);
    int   reach = sparse ? 1 : 2;
    float within = 1.0 / radius, thin = 1.0 / (ON_PLANE * hit.width);
    float near = 1.0 / (farthest * hit.width);
    Sums  sums = Sums(0.0, 0.0, 0.0, 0.0, vec2(0.0), vec2(0.0), vec3(0.0));
    bool  are_means = control.phase != OCCLUSION_AT_SPARSE_PIXELS;
    ivec2 tap = ivec2(-reach);
    do {
        ivec2     at = sparse ? pixel_of_sparse(nearest + spacing * tap) : pixel + tap;
        Neighbour there = find_neighbour(source.words, at);
        vec2      lateral = vec2(at - pixel) * within;
        vec3      difference = there.position - hit.position, apart = near * difference;
        float     above = dot(difference, normal) * thin;
        float     weight = max(1.0 - above * above, 0.0) * max(1.0 - dot(lateral, lateral), 0.0) *
                       max(1.0 - dot(apart, apart), 0.0);
        weight = there.exists ? weight : 0.0;
        bool  blocked = there.code >= NARROWEST;
        bool  is_mean = are_means && (sparse || is_sparse(at));
        float open = weight * (is_mean ? openness_of_code(there.code) : float(!blocked));
        float closed = weight - open;
        sums.weight += weight;
        sums.openness += open;
        sums.nearness += blocked ? weight / width_of_code(there.code) : 0.0;
        sums.back += closed > 0.0 ? closed * find_occluder(source.albedos, at) : 0.0;
        sums.offset += weight * lateral;
        sums.sloped += open * lateral;
        sums.square += weight * lateral.xxy * lateral.xyy;
        tap = next_offset(tap, reach);
    } while (tap.y <= reach);
    return sums;
}

// Returns the openness at the pixel itself.  At the foot of a wall all taps are on one side, and
// sparse pixels are nowhere even.  So it is that of the plane which fits the taps best, not their
// mean.
float find_openness(Sums sums)
{
    float per_weight = 1.0 / max(sums.weight, 1e-6);
    float mean = sums.openness * per_weight;
    vec2  centre = sums.offset * per_weight;
    vec3  spread = sums.square * per_weight - centre.xxy * centre.xyy;
    vec2  change = sums.sloped * per_weight - mean * centre;
    spread.xz += MIN_SPREAD;
    vec2  slope = vec2(spread.z * change.x - spread.y * change.y,
                       spread.x * change.y - spread.y * change.x) /
                 (spread.x * spread.z - spread.y * spread.y);
    return clamp(mean - dot(slope, centre), 0.0, 1.0);
}

void begin_group() {}

// Does a pixel.  Those without a sparse pixel on their own surface are listed as the remaining
// ones.
void do_item(uint number)
{
    uint  slot = find_listed(control.reading + number);
    bool  upsampled = control.phase == OCCLUSION_UPSAMPLED;
    bool  wider = control.phase == OCCLUSION_WIDER;
    bool  first = control.phase == OCCLUSION_AT_SPARSE_PIXELS;
    int   spacing = wider ? 2 : upsampled ? 1 : 0;
    Source source = wider ? Source(MEANS_SHARED, LIST_REMAINING) : Source(RAYS_SHARED, LIST_WIDE);
    HitPoint hit = hit_point_of_slot(slot);
    float farthest = wider ? max(find_wide_reach(load_hit(LIGHTING, slot).x), 1.0) : ANY_DISTANCE;
    float radius = wider ? min(farthest, WIDE_REACH * inversesqrt(float(control.rays)))
                   : upsampled ? FAR_REACH : NEAR_REACH;
    vec3  normal = load_hit(FACING, slot).xyz;
    ivec2 pixel = ivec2(pixel_of(slot));
    Sums  sums = sum_openness(source, pixel, hit, normal, spacing, max(radius, 1.0), farthest);
    float openness = find_openness(sums);
    float albedo = sums.back / max(sums.weight - sums.openness, 1e-6);
    // Remaining pixels also use the words of sparse ones, so the mean of a sparse pixel replaces
    // the word of its ray.  Until there is openness, its place has how near occluders are.
    if (first)
        store_lighting(control.value, slot, sums.nearness / max(sums.weight, 1e-6));
    if (first || wider) {
        store_shared(wider ? RAYS_SHARED : MEANS_SHARED, slot, find_depth(hit),
                     code_of_openness(openness));
        store_occluder(wider ? LIST_WIDE : LIST_REMAINING, pixel, albedo);
    } else if (!upsampled || sums.weight > MIN_WEIGHT)
        store_lighting(control.value, slot, pack_openness(Openness(openness, albedo)));
    else
        pixel_lists[LIST_REMAINING * band_pixels() + atomicAdd(counts.remaining, 1u)] = slot;
}

#include "pixels.glsl"
