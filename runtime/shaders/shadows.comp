#version 440
#extension GL_GOOGLE_include_directive : enable
#extension GL_KHR_shader_subgroup_shuffle : enable
/*
 * shadows.comp: how much a hit sees of a light that casts shadows.
 *
 * Two kinds of scenes are different.  LOOSE: a distance in it is only a bound, which may be far
 * below the true one.  A ray to a light then ends where it is inside of something, as primary rays
 * do, not where it is near; and how near things are where that shows is looked for (walk.glsl).
 * ALONG: there is krs_along, by which rays to a point of a light go.  AREA: each ray goes to a
 * point of its own; else one to the middle tells how much is hidden, about.
 */
#ifndef TRACE // which variant: the renderer says so; this one suits every device
#define TRACE 3u
#define REFILL 0
#endif
#include "scene.glsl"
#include "frame.glsl"
#include "solid.glsl"
#include "sines.glsl"

const uint SHADOW_STEPS = 1024u;

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

// What a dispatch is about.
Light light;
bool  positional;
float radius;      // of the light, where a directional one is 1 away

// The item.
Place place;
vec3  start, way;  // the next distance is asked for at start + t way
float t;
float end;         // of the way to the light
float facing;      // cosine between normal and way
float full;        // the room around the way at which the light is seen as a whole, as a part of
                   // the length of the way; 0: the ray goes to a point
float narrowest;   // the least there was so far, at most that, squared; below 0: none
bool  is_clear;    // nothing else is near the way
float before;      // the distance at the step before,
float gap;         // which was so long
bool  crept;       // whatever the distance was
float slope;       // of the distance along the way, as it was on average
float share;       // of the true distance, at the start
uint  taps, limit; // so far, and at most
#ifdef LOOSE
vec3  sum, level;  // of looks.glsl
float extent;
float room_before; // as the distance at the step before says
float least, least_at, least_distance; // the last minimum of that, and where it was
bool  falling;     // towards the next
#endif

uint  lost;        // of this lane's rays

#ifdef LOOSE
const float LEAST_STEEPNESS = 1e-6;
#define WALK 4u
#include "stencil.glsl"
#include "looks.glsl"
#include "walk.glsl"
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
    return sqrt(even.y) * vec2(krs_cos(angle), krs_sin(angle));
}

// The ray begins so far above the surface.
float find_lift() { return LIFT * place.width + 4.0 * place.rounding; }

// From the hit to the light: to its middle, or for area shadows to a point of its disc.
void aim_at_light(vec3 normal)
{
    start = place.position + normal * find_lift();
    vec3  toward = positional ? light.vector - start : light.vector;
    float remote = max(length(toward), 1e-12);
#ifdef AREA
    vec3 axis = toward / remote;
    vec3 aside = normalize(abs(axis.x) < 0.7 ? vec3(0.0, axis.z, -axis.y)
                                             : vec3(-axis.z, 0.0, axis.x));
    uvec2 pixel = work.corner + pixel_of(place.slot);
    vec2  seed = vec2(random(pixel, 2u * control.light + 1u),
                      random(pixel, 2u * control.light + 2u));
    vec2 at = radius * disc_point(seed);
    toward += at.x * aside + at.y * cross(axis, aside);
    full = 0.0;
    remote = length(toward);
#else
    // As wide as the light is seen, and outwards of the hard shadow's edge: the distance of a
    // ray that misses is known, not how deep one is that does not.
    full = light.softness > 0.0 ? 2.0 * radius / remote : 0.0;
#endif
    way = toward / remote;
    end = positional ? remote : frame.eye.w;
    float box_end = clip_ray(start, way, end).y;
    // From inside of a solid nothing leaves the box around all of them.
    bool walled = place.side < 0.0 && box_end < end;
    end = min(end, box_end);
    facing = walled ? 0.0 : dot(normal, way);
    narrowest = facing > 0.0 ? full * full : -1.0;
    limit = facing > 0.0 ? SHADOW_STEPS : 0u;
}

void look_up_item(uint number) {}

void begin_group(uint first)
{
    lost = 0u;
    light = find_light(control.light);
    positional = (light.kind & POSITIONAL) != 0u;
    radius = positional ? light.softness : krs_tan(0.5 * min(light.softness, 3.0));
}

void begin_item(uint number, bool saved)
{
    place = find_place(number);
    aim_at_light(find_hit(FACING, place.slot).xyz);
    is_clear = true;
    t = 0.0;
    slope = facing;
    taps = 0u;
    before = gap = 0.0;
    crept = true;
#ifdef LOOSE
    looks = 0u;
    room_before = least = INFINITE;
    falling = false;
#endif
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

// Where this ball of empty space meets the last one: so far behind here, so far aside, squared.
// Nothing in between is nearer to the way, for what it is away from the start (math.md 6).
struct Rim {
    float back, aside;
    bool  exists; // none does where one ball is in the other
};

Rim find_rim(float distance, float per_gap)
{
    float back = 0.5 * (gap + (distance - before) * (distance + before) * per_gap);
    float aside = max(distance * distance - back * back, 0.0);
    return Rim(back, aside, !crept && back > 0.0 && back < gap);
}

// How much room there is around the way, squared, if a surface may be at the rim.
float find_room(float distance, Rim rim)
{
    float here = distance / max(t, place.rounding);
    float at = max(t - rim.back, place.rounding);
    return min(here * here, rim.exists ? rim.aside / (at * at) : INFINITE);
}

bool is_black() { return narrowest < BLACK * BLACK * full * full; }

#ifdef LOOSE
// What comes near is not as near as it seems.
void look_at_least()
{
    if (least < narrowest)
        begin_walk(start + least_at * way, least_distance);
}

void note_room(float room, float distance)
{
    bool rising = room >= room_before;
    if (rising && falling)
        look_at_least();
    if (!rising) {
        least = room;
        least_at = t;
        least_distance = distance;
    }
    falling = !rising;
    room_before = room;
}
#endif

// What is nearer blocks the light.  Near the start even what is open may have a small distance,
// where that is only a bound: as small a part of the true one as at the first step.
float find_touch(float distance)
{
    float first = clamp(distance / find_lift(), 0.0625, 1.0);
    share = taps == 1u ? first : share;
    float near = mix(share, 1.0, min(t * (1.0 / (SHARED * place.width)), 1.0));
#ifdef LOOSE
    return near * place.rounding;
#else
    // Where there is a penumbra, it tells what is near.
    float touch = near * frame.error * place.width;
    if (full > 0.0)
        touch = min(touch, BLACK * full * t);
    return max(touch, place.rounding);
#endif
}

// A ray that creeps along a surface goes on by a pixel at least, or a sixteenth of the penumbra's
// width: what it could miss is too small to be seen.  Where it must get inside to be blocked, by
// as little as primary rays leave open, but by more and more the longer it creeps.
float find_pace()
{
#ifdef LOOSE
    if (full == 0.0)
        return min(OPEN * frame.error, MOST_OPEN) * place.width * (1.0 + PATIENCE * float(taps)) +
               place.rounding;
#endif
    return max(place.width, 0.0625 * full * t);
}

#ifndef LOOSE
// As far aside nothing must be for what is found so far to hold, squared.  The surface itself falls
// away by the cosine.
float find_room_needed(float at)
{
    float clear = is_clear ? min(CLEARANCE * place.width, 0.5 * facing * at) : 0.0;
    return max(clear * clear, narrowest * at * at);
}

// A gap beyond the distance, as long as may be if the distance goes on as it did.
float relax(float distance)
{
    float aside = sqrt(max(distance * distance - find_room_needed(t), 0.0));
    return max(2.0 * CAUTION / (1.0 - clamp(slope, -1.0, STEEPEST)) * aside, distance);
}

// Where balls leave too much open in between, or do not meet, the ray has gone too far.
bool has_gone_too_far(float distance, Rim rim)
{
    bool narrow = rim.exists && rim.aside < find_room_needed(t - rim.back);
    return !crept && gap > before && (narrow || gap > before + distance);
}
#endif

void take_step_to_light(float distance)
{
    float per_gap = 1.0 / max(gap, 1e-30);
    Rim   rim = find_rim(distance, per_gap);
    bool  back = false;
#ifdef LOOSE
    if (full > 0.0)
        note_room(find_room(distance, rim), distance);
#else
    back = has_gone_too_far(distance, rim);
    float risen = gap > 0.0 ? mix(slope, (distance - before) * per_gap, LEARNING) : slope;
    slope = back ? -1.0 : risen;
    narrowest = back ? narrowest : min(narrowest, find_room(distance, rim));
#endif
    narrowest = !back && distance < find_touch(distance) ? -1.0 : narrowest;
    bool near = distance < min(CLEARANCE * place.width, 0.5 * facing * t);
    is_clear = is_clear && (back || !near);
    float pace = find_pace(), least = max(distance, pace);
    limit = !back && (is_black() || t + least >= end) ? 0u : limit;
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
    if (is_black())
        looks = 0u;
#endif
}

void take_distance(float distance)
{
    distance *= place.side;
#ifdef LOOSE
    if (looks > 0u) {
        take_look(distance);
        if (looks == 0u) {
            float farther = find_estimate() / look_bound;
            narrowest = min(narrowest, least * farther * farther);
            limit = is_black() ? 0u : limit;
        }
        return;
    }
#endif
    taps++;
    take_step_to_light(distance);
}

// How much of the light is seen: none of what is black.
void end_item()
{
    lost += limit > 0u ? 1u : 0u;
    float visible = full > 0.0 ? sqrt(max(narrowest, 0.0)) / full : narrowest < 0.0 ? 0.0 : 1.0;
    float seen = max(visible - BLACK, 0.0) / (1.0 - BLACK);
    seen = seen * seen * (3.0 - 2.0 * seen);
    keep_lighting(control.value, place.slot, is_clear ? seen : min(seen, LIT));
}

void end_group(uint turns)
{
    if (lost > 0u)
        atomicAdd(counts.unresolved, lost);
}

const bool SAVES = false;
void save_item() {}

#include "schedule.glsl"
