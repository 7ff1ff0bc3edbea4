#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * shadow.comp: how much of a light a pixel sees: the mean of what the rays of the pixels around
 * have found (secondary.comp).
 *
 * A shadow is a function of the position alone, so it does not matter which surfaces the neighbours
 * are on.  A mean over positions much nearer to each other than the penumbra is wide blurs nothing.
 * So the radius of the mean follows from how far away the blockers are.  Along the direction to the
 * light a shadow changes little up to half the distance to the blockers.  So distances between
 * pixels are measured across that direction: in grazing light penumbrae are long.
 *
 * Where penumbrae are wide, means are computed twice.  The first are of all pixels nearby, whose
 * rays together are spread evenly.  The second are of some of the first means, farther apart.
 */
#include "frame.glsl"
#include "hit_lists.glsl"
#include "shared.glsl"
#include "neighbours.glsl"
#include "quarters.glsl"

// RADIUS_OF_PENUMBRA: the radius of a mean, relative to the width of the penumbra.  MIN_RADIUS:
// its least, in pixels.  NEAR_RADIUS: a larger radius needs a second mean.  In grazing light that
// limit is smaller, by a factor down to GRAZING.
const float RADIUS_OF_PENUMBRA = 0.5, MIN_RADIUS = 1.25, NEAR_RADIUS = 2.0, GRAZING = 0.25;

// Rays of few pixels would fray the edge of a narrow penumbra.  So its means reach farther along
// the edge: distances there count by MIN_ALONG, and in full from a radius of WIDE_ENOUGH on.
// MIN_CHANGE: the least sum of differences that tells a direction.
const float MIN_ALONG = 0.15, WIDE_ENOUGH = 6.0, MIN_CHANGE = 1.5;

// Less weight than that says nothing: it may be due to rounding.
const float MIN_WEIGHT = 0.05;

// Returns the radius of the mean in pixels, by the four quarters around.  It is 0 where all of
// their pixels see the light, or none does.  Fewer pixels would often agree by chance at the ends
// of a penumbra, and make it narrower.
float find_radius(ivec2 pixel)
{
    vec2  tile_point = 0.25 * (vec2(pixel) + 0.5) - 0.5, fraction = fract(tile_point);
    ivec2 first = ivec2(floor(tile_point)), tap = ivec2(0);
    float lit = 0.0, hidden = 0.0, width = 0.0;
    do {
        vec2      lateral = abs(1.0 - vec2(tap) - fraction);
        Penumbrae found = find_quarter(LIGHT_AROUND_QUARTERS, first + tap);
        float     weight = lateral.x * lateral.y;
        lit += weight * found.lit;
        hidden += weight * found.hidden;
        width += weight * found.width;
        tap = ivec2(1 - tap.x, tap.y + tap.x);
    } while (tap.y < 2);
    float radius = max(RADIUS_OF_PENUMBRA * width / max(hidden, 1e-6), MIN_RADIUS);
    return lit > 0.0 && hidden > 0.0 ? radius * inversesqrt(float(control.rays)) : 0.0;
}

// The same for a pixel with a code.  Behind an edge of its own surface the blocker is near, and the
// penumbra narrow.  Its neighbours in front of the edge see the light, and tell nothing of it.
const float MIN_OWN_RADIUS = 0.5;
float find_own_radius(ivec2 pixel, uint own)
{
    float radius = find_radius(pixel);
    bool  blocked = own >= NARROWEST && own <= WIDEST;
    float widest = max(RADIUS_OF_PENUMBRA * width_of_code(own), MIN_OWN_RADIUS);
    return blocked ? min(radius, widest) : radius;
}

// Tells whether a neighbour is visible, and whether that is known.
vec2 find_seen(uint list, Neighbour there)
{
    float seen = list == RAYS_SHARED ? float(there.code == LIT) : openness_of_code(there.code);
    bool  knows = there.exists && (list == MEANS_SHARED || there.code != BELOW_HORIZON);
    return knows ? vec2(seen, 1.0) : vec2(0.0);
}

// Returns the direction in the picture, a unit vector, in which a shadow changes most over 5x5
// pixels; 0 where it does not change.
vec2 find_change(uint list, ivec2 pixel, int stride)
{
    vec2 known = vec2(0.0), product = vec2(0.0), place = vec2(0.0);
    ivec2 tap = ivec2(-2);
    do {
        vec2 seen = find_seen(list, find_neighbour(list, pixel + stride * tap));
        known += seen;
        product += seen.x * vec2(tap);
        place += seen.y * vec2(tap);
        tap = next_offset(tap, 2);
    } while (tap.y <= 2);
    vec2  change = product - place * (known.x / max(known.y, 1.0));
    float size = length(change);
    return size > MIN_CHANGE ? change / size : vec2(0.0);
}

// Returns the mean visibility over 5x5 pixels that are `stride` apart, weighted by how near their
// hits are.  Along the edge of a narrow penumbra distances count less.  It is -1 where no pixel
// knows it.
float find_mean(uint list, ivec2 pixel, HitPoint hit, Disc disc, int stride, float radius)
{
    vec2  sums = vec2(0.0);
    float within = 1.0 / max(radius * hit.width, 1e-30), edge = 1.0 / (2.0 * float(stride) + 1.0);
    // The factor by which distances along the light count; 1: not at all.
    float stretched = 1.0 - min(2.0 * disc.spread, 1.0);
    vec2  change = radius > 0.0 ? find_change(list, pixel, stride) : vec2(0.0);
    float along_edge = mix(MIN_ALONG, 1.0, min(radius / WIDE_ENOUGH, 1.0));
    along_edge = 1.0 - along_edge * along_edge;
    ivec2 tap = ivec2(-2);
    do {
        ivec2     offset = stride * tap;
        Neighbour there = find_neighbour(list, pixel + offset);
        vec3      difference = (there.position - hit.position) * within;
        difference -= stretched * dot(difference, disc.toward) * disc.toward;
        vec2      lateral = vec2(offset) * edge;
        float along = dot(lateral, vec2(change.y, -change.x));
        float counts_less = 1.0 - along_edge * along * along / max(dot(lateral, lateral), 1e-6);
        float weight = max(1.0 - counts_less * dot(difference, difference), 0.0) *
                       max(1.0 - dot(lateral, lateral), 0.0);
        sums += weight * find_seen(list, there);
        tap = next_offset(tap, 2);
    } while (tap.y <= 2 && radius > 0.0);
    return sums.y > MIN_WEIGHT ? sums.x / sums.y : -1.0;
}

void begin_group() {}

// Computes the mean of a pixel.  In the first phase pixels that need a wider mean are listed for
// the second.
void do_item(uint number)
{
    uint  slot = find_listed(control.reading + number);
    bool  wide = control.phase == SHADOW_WIDE;
    HitPoint hit = hit_point_of_slot(slot);
    ivec2 pixel = ivec2(pixel_of(slot));
    uint  word = find_shared(RAYS_SHARED, slot), own = word & 255u;
    float radius = find_own_radius(pixel, own), visible = own == BELOW_HORIZON || own == LIT ? 1.0 : 0.0;
    Disc  disc = find_disc(find_light(control.light), hit);
    uint  list = wide ? MEANS_SHARED : RAYS_SHARED;
    float mean = find_mean(list, pixel, hit, disc, wide ? 2 : 1, radius);
    bool  known = radius > 0.0 ? mean >= 0.0 : own != BELOW_HORIZON;
    visible = radius > 0.0 ? abs(mean) : visible;
    float rise = dot(load_hit(FACING, slot).xyz, disc.toward);
    if (!wide && known) // a pixel that faces away from the light tells others nothing
        store_shared(MEANS_SHARED, slot, uintBitsToFloat(word), code_of_openness(visible));
    if (!wide && known && radius > 0.0)
        pixel_lists[LIST_WIDE * band_pixels() + atomicAdd(counts.wide, 1u)] = slot;
    else
        store_lighting(control.value, slot, visible * find_fraction_above(disc, rise));
}

#include "pixels.glsl"
