#version 440
#extension GL_GOOGLE_include_directive : enable
#extension GL_KHR_shader_subgroup_shuffle : enable
/*
 * query.comp: where rays that a program asks about end; point_query.comp says what is there.
 *
 * The rule is that of trace.comp, without beams, and the permitted error is a length.  A ray that
 * runs out of steps ends where it is, and is told apart.
 */
#ifndef REFILL // which variant: the renderer says so; this one suits every device
#define REFILL 0
#endif
#include "scene.glsl"
#include "frame.glsl"

const uint REFILL_THRESHOLD = 2u;
#define SAVES 0

// The longest interval that may stay unverified, in permitted errors.
const float TOLERANCE = 0.0625;
const float LEARNING = 0.3; // of the mean slope
// Solids that touch are one: from inside they count as grown by what rounding may leave open at
// the seam between two.
const float SEAM = 4.0;     // roundings

// The roundings from a surface within which they may have decided on which side a ray begins.
const float SIDE_ROUNDINGS = 64.0; // roundings

layout(std430, set = 1, binding = QUERY_RAYS_BINDING) readonly buffer QueryRays {
    QueryRay query_rays[];
};
layout(std430, set = 1, binding = RAY_HITS_BINDING) writeonly buffer RayHits { RayHit ray_hits[]; };
// The points where rays hit, or were given up, for point_query.comp.
layout(std430, set = 1, binding = POINTS_BINDING) writeonly buffer Points { Point points[]; };

uint  index;              // of the ray
vec3  origin, direction;
float end;
float rounding;           // of coordinates at t = 0
float t, clearance, step; // as of a RayMarch (trace.comp)
float slope;              // of the clearance along the ray: a running mean
float side;               // as of a RayEnd; 0: not known
bool  ends_at_walls;      // all solids end at `end`
uint  steps, state;
uint  side_bits;          // on which side the ray begins, as of a RayHit

void exchange_item(uint number) {}
void begin_group(uint first) {}

void begin_item(uint number, bool saved)
{
    QueryRay query_ray = query_rays[number];
    index = number;
    origin = query_ray.origin;
    direction = query_ray.direction;
    end = query_ray.end;
    rounding = largest(origin);
    t = clearance = step = 0.0;
    slope = -1.0;
    side = query_ray.kind == float(BEGINS_OUTSIDE) ? 1.0 : 0.0;
    ends_at_walls = query_ray.kind == float(ENDS_AT_WALLS);
    steps = side_bits = 0u;
    state = end >= 0.0 ? STATE_MARCHING : STATE_MISS;
}

bool item_needs_step()
{
    return (state == STATE_MARCHING || state == STATE_REFINING) && steps < frame.max_steps;
}

// Returns the distance of an item.  Where branches save work, components that are far away for
// their size are left out.
float item_distance(vec3 position)
{
#ifdef ALONG
    // Some roundings farther back than the ray has been: what was just before a surface without
    // thickness there must not be behind it here.
    return krs_along(position, direction,
                     step > 0.0 ? step + 2.0 * ROUNDING * (rounding + t) : 0.0);
#elif defined(EARLY_OUTS)
    return krs_distance_lod(position, 0.0);
#else
    return krs_distance(position);
#endif
}

vec3 item_position() { return origin + (t + step) * direction; }

// The surface is crossed between t and t + step, within the permitted error.  The ray ends where
// the chord of the clearances crosses 0; a long interval is sampled there once more.
void refine(float last_clearance, float new_clearance, float tolerance)
{
    float along = last_clearance > new_clearance
                      ? clamp(last_clearance / (last_clearance - new_clearance), 0.0, 2.0)
                      : 0.0;
    bool  accurate = step - clearance <= 2.0 * tolerance || state == STATE_REFINING;
    step *= along;
    t += accurate ? step : 0.0;
    state = !accurate ? STATE_REFINING : t <= end ? STATE_HIT : STATE_MISS;
}

void take_distance(float distance)
{
    float at = t + step;
    float least = ROUNDING * (rounding + at), tolerance = TOLERANCE * frame.error + least;
    if (side == 0.0) {
        side = distance < 0.0 ? -1.0 : 1.0;
        side_bits = abs(distance) > SIDE_ROUNDINGS * least ? 0u
                    : distance < 0.0                 ? QUERY_SIDE_UNKNOWN | QUERY_BEGINS_INSIDE
                                                     : QUERY_SIDE_UNKNOWN;
    }
    float seam = side < 0.0 ? SEAM * least : 0.0;
    float new_clearance = side * distance + seam;
    float unverified = step - clearance; // a surface may hide in an interval of this length
    steps++;
    // Twice: a step of `tolerance` beyond the clearance may be rounded up.
    if (state == STATE_REFINING ||
        (new_clearance <= 0.0 && unverified <= frame.error + 2.0 * tolerance)) {
        refine(clearance - seam, new_clearance - seam, tolerance);
    } else if (new_clearance > 0.0 && unverified <= new_clearance + 1.01 * tolerance) {
        slope = mix(slope, step > 0.0 ? (new_clearance - clearance) / step : -1.0, LEARNING);
        t = at;
        clearance = new_clearance;
#ifdef ALONG // it is what is free ahead, and tells nothing of what is behind
        step = new_clearance + tolerance;
#else
        step = new_clearance * max(1.0, 2.0 / (1.0 - min(slope, 0.98))) + tolerance;
#endif
        state = at + new_clearance > end ? STATE_MISS : STATE_MARCHING;
    } else {
        step = max(0.5 * (step + clearance - max(new_clearance, 0.0)), clearance + tolerance);
        slope = -1.0;
    }
}

void end_item()
{
    uint point = 0u;
    if (state == STATE_MISS && side < 0.0 && ends_at_walls) {
        state = STATE_HIT;
        t = end;
    }
    if (state == STATE_REFINING) // no step was left to find where it crosses the surface
        state = STATE_MARCHING;
    if (state != STATE_MISS) {
        point = atomicAdd(counts.hit_count, 1u);
        points[point] = Point(origin + t * direction, 0.0, direction, 0.0);
    }
    ray_hits[index] = RayHit(t, state, point, steps | side_bits);
}

void save_item() {}
void end_group(uint steps) {}

#include "schedule.glsl"
