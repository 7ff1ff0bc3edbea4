#version 440
#extension GL_GOOGLE_include_directive : enable
#extension GL_KHR_shader_subgroup_shuffle : enable
/*
 * secondary.comp: what the distance around a hit tells: its normal, how open it is, and whether
 * it sees a light.
 *
 * The three phases are dispatches of one kernel, so that the scene is compiled once for them
 * and its distance stands once, in one loop.  A dispatch of the last phase is about one light.
 *
 * Two kinds of scenes are different.  LOOSE: a distance in it is only a bound, which may be far
 * below the true one.  A ray to a light then ends where it is inside of something, as primary rays
 * do, not where it is near; and how near things are where that shows is looked for (looks.glsl).
 * ALONG: there is krs_along, by which rays to a point of a light go; such a kernel has no other
 * phase, since that is no distance.  SEAMS: solids touch, face to face (look_again).
 */
#ifndef TRACE // which variant: the renderer says so; this one suits every device
#define TRACE 3u
#define REFILL 0
#endif
#include "scene.glsl"
#include "frame.glsl"
#include "solid.glsl"
#include "stencil.glsl"

const uint NORMALS = 0u, OCCLUSION = 1u, SHADOW = 2u; // control.phase
const uint SHADOW_STEPS = 1024u;
const uint OCCLUSION_TAPS = 5u;
const float LEAST_STEEPNESS = 1e-6;

// What is less open than this is black, and what is more so less of it is seen: no step shows.
const float BLACK = 0.03;
// Rays to lights start so many pixels above the surface.
const float LIFT = 0.5;
// For so many pixels from there a distance may be a bound as at the start.
const float SHARED = 8.0;
// A way is clear for the pixels around as well if it stays so many of them away from everything.
const float CLEARANCE = 3.0;
// Relaxation: of the gap between balls that would still meet as far aside as they must; how fast
// the slope is learned, and the steepest that is counted on.
const float CAUTION = 0.6, LEARNING = 0.5, STEEPEST = 0.9;
// What is lit and not clear: less than 1 by a bit (fill.comp).
const float LIT = 0.99999994;
// What a ray to a point of a light may leave open where it must get inside: as in trace.comp, and
// by how much more after each step.
const float OPEN = 0.0625;
const float MOST_OPEN = 0.015625;
const float PATIENCE = 0.015625;

// Differences for normals reach as far as a pixel asks for, but less of the coordinates would be
// noise.
const float NOISE = 3e-4;
// What is so even is flat, and seen from outside already what is so EVEN_OUTSIDE; taps that lose
// all of the solid still leave as much as LEAST_EVEN.
const float EVEN = 0.9995, EVEN_OUTSIDE = 0.998, LEAST_EVEN = 0.7;

// The item.
Place place;
vec3  start, way;  // the next distance is asked for at start + t way
float t;
float end;         // of the way to the light
float sharpness;   // of the shadow's edge
float before;      // the distance at the step before,
float gap;         // which was so long
bool  crept;       // whatever the distance was
float slope;       // of the distance along the way, as it was on average
float share;       // of the true distance, at the start of a shadow ray
vec3  sum, level;  // of the taps of a normal, with the signs of their directions and without
float extent;      // of their directions: the sum of their squares
bool  again;       // they are looked at once more, farther out,
float middle;      // where the distance in their middle is this,
float even;        // and so even was it before,
vec3  facing_before; // with this normal,
float steepness_before;
#ifdef GRADIENT
bool  derived;     // the normal is by derivatives,
float outside;     // and this the distance where one unit is away, as the tap outside says
#ifdef LOOSE
const uint BOUND_TAPS = 1u;
#else
const uint BOUND_TAPS = 0u;
#endif
#endif
float steepness;   // of the distance around the hit
float blocked, weight; // of those of occlusion
float visible;     // how much of the light
#ifdef LOOSE
float open_before; // as the distance at the step before says
float least, least_at, least_distance; // the last minimum of that, and where it was
bool  falling;     // towards the next
#endif
float facing;      // cosine between normal and way
bool  is_clear;    // nothing else is near the way to it
uint  taps, limit; // so far, and at most

uint  lost;        // of this lane's shadow rays


// How steep the distance is, 1 unless it is a bound.  In a hollow edge the differences of its two
// sides cancel in part, and the rest is in the level, below 0; on a convex one they may.
float find_steepness(float reach)
{
#ifdef GRADIENT
    if (derived)
        return clamp(outside, LEAST_STEEPNESS, 1.0);
#endif
    float found = length(vec2(length(sum), length(min(level, 0.0)))) / (extent * reach / 3.0);
    return found > LEAST_STEEPNESS ? min(found, 1.0) : LEAST_STEEPNESS;
}

#ifdef LOOSE
#include "looks.glsl"
#endif

// A number in [0, 1) for a pixel, one of many that differ (PCG, O'Neill 2014).
float random(uvec2 pixel, uint which)
{
    uint hash = (pixel.x + 16384u * pixel.y) * 747796405u + which * 2891336453u;
    hash ^= control.seed * 2654435769u;
    hash = ((hash >> ((hash >> 28u) + 4u)) ^ hash) * 277803737u;
    return float((hash >> 22u ^ hash) >> 8u) / 16777216.0;
}

// A point of the unit disc for this ray of its pixel: the rays together fill it evenly, and none
// of it hangs on the place of the ray in the pixel.  That has the steps of two dimensions (R2,
// phases.c), so these are the last two of four (R4).
vec2 disc_point(vec2 pixel_seed)
{
    vec2  even = fract(pixel_seed + vec2(0.6287067, 0.5385973) * float(control.ray));
    float angle = 2.0 * PI * even.x;
    return sqrt(even.y) * vec2(cos(angle), sin(angle));
}

Light light;

// From the hit to the light: to its middle, or for area shadows to a point of its disc.
void aim_at_light(vec3 normal)
{
    bool  positional = (light.kind & POSITIONAL) != 0u;
    start = place.position + normal * (LIFT * place.width + 4.0 * place.rounding);
    vec3  toward = positional ? light.vector - start : light.vector;
    float radius = positional ? light.softness : tan(0.5 * min(light.softness, 3.0));
    // As wide as the light is seen, and outwards of the hard shadow's edge: the distance of a
    // ray that misses is known, not how deep one is that does not.
    float remote = max(length(toward), 1e-12);
    sharpness = light.softness <= 0.0 ? INFINITE : 0.5 * remote / radius;
    if (control.shadows == AREA_SHADOWS) {
        vec3 axis = toward / remote;
        vec3 aside = normalize(abs(axis.x) < 0.7 ? vec3(0.0, axis.z, -axis.y)
                                                 : vec3(-axis.z, 0.0, axis.x));
        uvec2 pixel = work.corner + pixel_of(place.slot);
        vec2  seed = vec2(random(pixel, 2u * control.light + 1u),
                          random(pixel, 2u * control.light + 2u));
        vec2 at = radius * disc_point(seed);
        toward += at.x * aside + at.y * cross(axis, aside);
        sharpness = INFINITE;
        remote = length(toward);
    }
    way = toward / remote;
    end = positional ? remote : frame.eye.w;
    float box_end = clip_ray(start, way, end).y;
    // From inside of a solid nothing leaves the box around all of them.
    bool walled = place.side < 0.0 && box_end < end && (light.kind & CASTS_SHADOWS) != 0u;
    end = min(end, box_end);
    facing = walled ? 0.0 : dot(normal, way);
    visible = facing > 0.0 ? 1.0 : 0.0;
    is_clear = true;
    limit = facing > 0.0 && (light.kind & CASTS_SHADOWS) != 0u ? SHADOW_STEPS : 0u;
}

// Where the ray comes from that hits here, unit.
vec3 find_backwards()
{
    return control.projection == ORTHOGRAPHIC ? -frame.forward.xyz
                                              : normalize(frame.eye.xyz - place.position);
}

void look_up_item(uint number) {}

void begin_group(uint first)
{
    lost = 0u;
    light = find_light(control.light);
}

void begin_item(uint number, bool saved)
{
    place = find_place(number);
    vec3 normal = find_hit(FACING, place.slot).xyz;
    start = place.position;
    taps = 0u;
    sum = level = vec3(0.0);
    extent = 0.0;
    before = gap = 0.0;
    crept = true;
#ifdef LOOSE
    looks = 0u;
    open_before = least = INFINITE;
    falling = false;
#endif
    blocked = 0.0;
    weight = 0.33;
    if (control.phase == SHADOW) {
        aim_at_light(normal);
        t = 0.0;
        slope = facing;
    } else if (control.phase == OCCLUSION) {
        way = normal;
        t = 0.0625 * frame.occlusion_reach;
        steepness = find_hit(LIGHTING, place.slot).x;
        limit = OCCLUSION_TAPS;
    } else {
        // Differences over a pixel or so: finer detail would only be noise.
        way = stencil(0u);
        t = max(frame.blur * place.width, NOISE * largest(place.position) + place.rounding);
        limit = TAPS;
        again = false;
        middle = 0.0;
#ifdef GRADIENT
        derived = false;
        outside = 1.0;
#endif
#if defined(GRADIENT) && !defined(ANCHORED)
        // Differences are for where derivatives are no numbers.
        vec3 gradient = krs_gradient(place.position, t);
        // Differences are as well for where rounding makes what is seen face away.
        float facing_eye = place.side * dot(gradient, find_backwards());
        derived = facing_eye > 0.0 && dot(gradient, gradient) < INFINITE;
        if (derived) {
            sum = place.side * normalize(gradient);
            way = sum;
            extent = 3.0 / t; // its own unit
            limit = BOUND_TAPS;
        }
#endif
    }
}

bool item_wants_more()
{
#ifdef LOOSE
    if (looks > 0u)
        return true;
#endif
    return taps < limit;
}

float item_distance(vec3 place)
{
#ifdef ALONG
    return krs_along(place, way);
#else
    return krs_distance(place);
#endif
}

vec3 item_place()
{
#ifdef LOOSE
    if (looks > 0u)
        return look_point();
#endif
    return start + t * way;
}

// Where this ball of empty space meets the last one: so far behind here, so far aside of the way.
// Nothing in between is nearer to the way, for what it is away from the start (math.md 6).
struct Rim {
    float back, aside;
    bool  exists; // none does where one ball is in the other
};

Rim find_rim(float distance)
{
    float back = 0.5 * (gap + (distance - before) * (distance + before) / max(gap, 1e-30));
    float aside = sqrt(max(distance * distance - back * back, 0.0));
    return Rim(back, aside, !crept && back > 0.0 && back < gap);
}

// How much of the light a distance here leaves visible, if a surface may be at the rim.
float find_open(float distance, Rim rim)
{
    float open = sharpness * distance / max(t, place.rounding);
    float there = sharpness * rim.aside / max(t - rim.back, place.rounding);
    return rim.exists ? min(open, there) : open;
}

#ifdef LOOSE
// What comes near is not as near as it seems.
void look_at_least()
{
    if (least < visible)
        begin_looks(start + least_at * way, least_distance);
}

void note_open(float open, float distance)
{
    bool rising = open >= open_before;
    if (rising && falling)
        look_at_least();
    if (!rising) {
        least = open;
        least_at = t;
        least_distance = distance;
    }
    falling = !rising;
    open_before = open;
}
#endif

// What is nearer blocks the light.  Near the start even what is open may have a small distance,
// where that is only a bound: as small a part of the true one as at the first step.
float find_touch(float distance)
{
    float lift = LIFT * place.width + 4.0 * place.rounding;
    if (taps == 1u)
        share = clamp(distance / lift, 0.0625, 1.0);
    float near = mix(share, 1.0, min(t / (SHARED * place.width), 1.0));
#ifdef LOOSE
    return near * place.rounding;
#else
    // Where there is a penumbra, it tells what is near.
    float touch = near * frame.error * place.width;
    if (sharpness < INFINITE)
        touch = min(touch, BLACK * t / sharpness);
    return max(touch, place.rounding);
#endif
}

// A ray that creeps along a surface goes on by a pixel at least, or a sixteenth of the penumbra's
// width: what it could miss is too small to be seen.  Where it must get inside to be blocked, by
// as little as primary rays leave open, but by more and more the longer it creeps.
float find_pace()
{
#ifdef LOOSE
    if (sharpness == INFINITE)
        return min(OPEN * frame.error, MOST_OPEN) * place.width * (1.0 + PATIENCE * float(taps)) +
               place.rounding;
#endif
    return max(place.width, 0.0625 * t / sharpness);
}

#ifndef LOOSE
// As far aside nothing must be for what is found so far to hold.  The surface itself falls away by
// the cosine.
float find_room_needed(float at)
{
    float clear = is_clear ? min(CLEARANCE * place.width, 0.5 * facing * at) : 0.0;
    return max(clear, visible * at / sharpness);
}

// A gap beyond the distance, as long as may be if the distance goes on as it did.
float relax(float distance)
{
    float needed = min(find_room_needed(t) / distance, 1.0);
    float relaxed = 2.0 * sqrt(1.0 - needed * needed) / (1.0 - clamp(slope, -1.0, STEEPEST));
    return distance * max(CAUTION * relaxed, 1.0);
}

// Where balls leave too much open in between, or do not meet, the ray has gone too far.
bool has_gone_too_far(float distance, Rim rim)
{
    bool narrow = rim.exists && rim.aside < find_room_needed(t - rim.back);
    return !crept && gap > before && (narrow || gap > before + distance);
}
#endif

// A step of a ray to a light.  What has gone too far goes back to where the last ball ends, and has
// found nothing.
void take_shadow(float distance)
{
    Rim  rim = find_rim(distance);
    bool back = false;
#ifdef LOOSE
    if (sharpness < INFINITE)
        note_open(find_open(distance, rim), distance);
#else
    back = has_gone_too_far(distance, rim);
    float risen = gap > 0.0 ? mix(slope, (distance - before) / gap, LEARNING) : slope;
    slope = back ? -1.0 : risen;
    visible = back ? visible : min(visible, find_open(distance, rim));
#endif
    visible = !back && distance < find_touch(distance) ? 0.0 : visible;
    bool near = distance < min(CLEARANCE * place.width, 0.5 * facing * t);
    is_clear = is_clear && (back || !near);
    float pace = find_pace(), least = max(distance, pace);
    limit = !back && (visible < BLACK || t + least >= end) ? 0u : limit;
    crept = !back && distance < pace;
    float next = least;
#ifndef LOOSE
    next = min(crept ? pace : max(relax(distance), pace), max(end - t, 0.0));
#endif
    t += back ? before - gap : next;
    gap = back ? before : next;
    before = back ? before : distance;
#ifdef LOOSE
    if (limit == 0u && falling && looks == 0u)
        look_at_least();
    if (visible < BLACK)
        looks = 0u;
#endif
}

// How much less room there is than an open surface would leave, at five scales.
void take_occlusion(float room)
{
    blocked += weight * clamp(1.0 - room / t, 0.0, 1.0);
    weight *= 0.75;
    t *= 2.0;
}

// The parts of the sum that do not cancel: where all is flat, opposite taps do; on an edge, or
// where things are smaller than the taps are apart, they do not.
float find_evenness()
{
    float size = length(sum), uneven = length(vec2(size, length(level)));
    return uneven > 0.0 && uneven < INFINITE ? size / uneven : 1.0;
}

#if defined(ROOTS) && STENCIL == 3
// Around a curve on which its gradient vanishes a polynomial's distance is far from linear.  So
// what is not even is looked at again from nearer, with the corners of a cube as well: of weight
// 9/8 they make the octahedron exact up to the fifth power.
const float NEARER = 0.125;
const uint CORNERS = 8u;
vec3 corner(uint i)
{
    return 0.57735026919 * (2.0 * vec3(i & 1u, i >> 1u & 1u, i >> 2u & 1u) - 1.0);
}

void look_nearer()
{
    t = max(NEARER * t, NOISE / 3.0 * largest(place.position) + place.rounding);
    again = true;
    taps = 0u;
    limit = TAPS + CORNERS;
    way = stencil(0u);
    sum = level = vec3(0.0);
    extent = 0.0;
}

void take_difference(float distance)
{
    float weight = taps > TAPS ? 1.125 : 1.0;
    sum += weight * distance * way;
    level += weight * distance * abs(way);
    extent += weight * dot(way, way);
    way = taps < TAPS ? stencil(taps) : corner(taps - TAPS);
    if (taps < TAPS || again)
        return;
    even = find_evenness();
    if (even < EVEN)
        look_nearer();
}

float find_flatness() { return again ? even : find_evenness(); }
#else
// Solids that touch have a seam, where taps inside find a surface that is none.  So what is not
// even is looked at again from so far outside that no tap is inside if it is flat.
void look_again()
{
    facing_before = normalize(sum);
    steepness_before = find_steepness(t);
    start = place.position + t * facing_before;
    again = true;
    taps = 0u;
    limit = TAPS + 1u;
    way = sum = level = vec3(0.0);
    extent = 0.0;
}

void take_difference(float distance)
{
#if STENCIL == 1
    sum += distance * (taps == 1u ? vec3(-1.0) : way);
    extent += dot(way, way);
    way = stencil(taps);
#else
    if (again && taps == 1u)
        middle = distance;
    sum += distance * way;
    level += (distance - middle) * abs(way);
    extent += dot(way, way);
    way = stencil(again ? taps - 1u : taps);
    if (taps < limit || again)
        return;
#ifdef SEAMS
    even = find_evenness();
    if (even > LEAST_EVEN && even < EVEN)
        look_again();
#endif
#endif
}

float find_flatness() { return find_evenness(); }
#endif

#ifdef GRADIENT
// Where the bound falls less than that towards the surface, derivatives may be next to nothing but
// rounding, as near a curve on which a polynomial vanishes several times.
const float LEAST_OUTSIDE = 0.4;
void take_outside(float distance)
{
    outside = distance;
#ifdef ROOTS
    if (outside >= LEAST_OUTSIDE)
        return;
    derived = false;
    taps = 0u;
    limit = TAPS;
    way = stencil(0u);
    sum = vec3(0.0);
    extent = 0.0;
#endif
}
#endif

// And how steep the distance is.
float take_normal()
{
    float size = length(sum), flatness = find_flatness();
    vec3  normal = size > 0.0 && size < INFINITE ? sum / size : find_backwards();
    float found = find_steepness(t);
    if (again && flatness < max(even, EVEN_OUTSIDE)) {
        normal = facing_before;
        flatness = even;
        found = steepness_before;
    }
    keep_hit(FACING, place.slot, vec4(normal, flatness));
    return found;
}

void take_distance(float distance)
{
    distance *= place.side;
#ifdef LOOSE
    if (looks > 0u) {
        take_look(distance);
        if (looks == 0u && control.phase == OCCLUSION) {
            take_occlusion(max(estimate, look_bound / steepness));
        } else if (looks == 0u) {
            visible = min(visible, least * estimate / look_bound);
            limit = visible < BLACK ? 0u : limit;
        }
        return;
    }
#endif
    taps++;
    if (control.phase == SHADOW) {
        take_shadow(distance);
    } else if (control.phase == OCCLUSION) {
        float room = distance / steepness;
#ifdef LOOSE
        if (distance > 0.0 && room < t) {
            begin_looks(item_place(), distance);
            return;
        }
#endif
        take_occlusion(room);
#ifdef GRADIENT
    } else if (derived) {
        take_outside(distance / t);
#endif
    } else {
        take_difference(distance);
    }
}

// How much of the light is seen: none of what is black.
float find_seen()
{
    float seen = max(visible - BLACK, 0.0) / (1.0 - BLACK);
    seen = seen * seen * (3.0 - 2.0 * seen);
    return is_clear ? seen : min(seen, LIT);
}

// One number for all phases: of each store lavapipe makes a loop.
void end_item()
{
    float found = 0.0;
    if (control.phase == SHADOW) {
        lost += limit > 0u ? 1u : 0u;
        found = find_seen();
    } else if (control.phase == OCCLUSION) {
        // Light finds its way in by reflection.
        found = exp2(-2.5 * blocked);
    } else {
        found = take_normal();
    }
    keep_lighting(control.value, place.slot, found);
}

void end_group(uint turns)
{
    if (lost > 0u)
        atomicAdd(counts.unresolved, lost);
}

const bool SAVES = false;
void save_item() {}

#include "schedule.glsl"
