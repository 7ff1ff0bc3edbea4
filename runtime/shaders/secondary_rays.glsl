/*
 * secondary_rays.glsl: where rays of hits begin: to lights, over the hemisphere for occlusion, and cones; and what is known
 * on their way (secondary_step.glsl).  Shaders of pages have such rays as well (web/picture).
 */
#include "discs.glsl"
#include "light_types.glsl"
#include "hemisphere.glsl"
#include "media.glsl"

const uint MAX_STEPS = 1024u;
// The pixels above the surface at which rays start, where it is even and where it is not.
const float LIFT_OF_EVEN = 0.125, LIFT = 0.5;
// The evenness below which a surface is uneven, and above which it is even.
const float UNEVEN = 0.9, EVEN = 0.99;
// Up to this many pixels from the start, a distance may be as small a part of the true one as it is
// there.
const float NEAR_START = 8.0;
// The least step of a ray: the smaller of these parts of the permitted error and of a pixel.  It
// grows by STEP_GROWTH with each step, so that a ray which creeps along a surface leaves it; rays for
// occlusion go farther.
const float MIN_STEP = 0.0625, MIN_STEP_IN_PIXELS = 0.015625;
#ifdef PATH_RAYS // they start nearer to the surface
const float STEP_GROWTH = 1.02;
#else
const float STEP_GROWTH = 1.008, STEP_GROWTH_OF_SKY = 1.08;
#endif
// A ray for occlusion that recedes from all there is takes steps of at least this part of its length, and
// of all of it where it is farther than so many reaches: what is out there and counts is large.  Most of
// those that recede more slowly graze a surface, so that they count little.
const float MIN_OF_LENGTH = 0.25, FAR_REACHES = 60.0;
// A ray of a path that begins behind its surface is not blocked by that for so long.
const float LEAVING_IN_PIXELS = 0.125;
// The margin around a cone, in pixels: if the cone is empty, the light is visible from pixels as
// near as that, too.
const float CONE_MARGIN = 3.0;
// The factor by which pixels on surfaces at a grazing angle are farther apart, at most.
const float MAX_STRETCHED = 4.0;
// Relaxation.  SAFETY: the step, relative to the longest after which the balls would still meet.
// LEARNING: how fast the mean slope follows the last one.  STEEPEST: the largest slope that is
// relied on.
const float SAFETY = 0.6, LEARNING = 0.5, STEEPEST = 0.9;

// The light of the dispatch.
Light light;
bool  positional;
float radius;      // of the light; a directional one is at distance 1

// The current item.
HitPoint hit;
vec3  start, direction; // the next distance is evaluated at start + t direction
float t;
float end;         // of the ray
float free_start;  // nothing is before
#ifdef PLANES
float plane_t;     // where the ray meets a plane before it ends; INFINITE: nowhere
#endif
float facing;      // cosine between the normal and the direction
float lift;        // height of the start above the surface
bool  is_cone;     // else a ray
float spread;      // radius of the cone at distance 1
float margin;      // width around the cone that must be empty, too
bool  blocked;
bool  below_horizon;            // its point of the light is behind the surface
float last_distance, last_step; // the distance before the last step, and its length
bool  took_least_step;          // the last step was the least one, not the distance
float min_step, growth;
float slope;                  // of the radius along the ray: a running mean
#ifdef STEPS
float max_ahead;             // how far it is to the next root, or less
float radius_here;            // of the empty ball around the position, of what has no roots
float last_radius;            // the same before the last step
#else
#define last_radius last_distance
#endif
float start_ratio;            // distance at the start, relative to the true one
uint  step_count, step_limit; // so far, and at most

// Chooses the light that rays go to.
void begin_light(uint number)
{
    light = find_light(number);
    positional = (light.kind & LIGHT_POSITIONAL) != 0u;
    radius = light_radius(light);
}

// Begins a ray from `start`, above a surface of this normal.
void begin_ray(vec3 normal, vec3 toward)
{
    direction = toward;
    facing = dot(normal, direction);
    free_start = 0.0;
#ifdef PLANES
    plane_t = max(krs_plane_t(start, direction), 0.0);
    plane_t = plane_t < end ? plane_t : INFINITE;
    end = min(end, plane_t);
#endif
    vec2 range = clip_ray(start, direction, end);
    // A ray from inside of a solid that reaches the box around all solids has met a wall there.
    bool inside = hit.side < 0.0 || is_in_medium();
    blocked = inside && range.y < end;
#ifdef AIMS // others are clipped by those who march them
    end = inside ? min(end, range.y) : end;
#else
    end = min(end, range.y);
#endif
    step_limit = blocked || below_horizon ? 0u : MAX_STEPS;
#ifdef PLANES
    free_start = range.x;
    step_limit = free_start < end ? step_limit : 0u;
#endif
}

// Finds where a cone, with its whole width, has left the box around the scene.
float find_end_of_cone()
{
    vec3 to_walls = mix(start - frame.low.xyz, frame.high.xyz - start,
                        greaterThan(direction, vec3(0.0)));
    vec3 speed = abs(direction) - spread;
    vec3 ends = mix(vec3(INFINITE), max(to_walls + margin, 0.0) / max(speed, 1e-6),
                    greaterThan(speed, vec3(1e-6)));
    return min(min(ends.x, ends.y), ends.z);
}

// Tells how high a ray starts above a surface of this evenness.
float find_lift(float evenness)
{
    float pixels = mix(LIFT, LIFT_OF_EVEN, smoothstep(UNEVEN, EVEN, evenness));
    return pixels * hit.near + 4.0 * hit.rounding;
}

// Aims a cone at the centre of the light, or a ray at a random point of it.
void aim_at_light(vec3 normal, vec2 square, vec2 disc)
{
    start = hit.position + normal * lift;
    vec3  toward = positional ? light.vector - start : light.vector;
    float light_distance = max(length(toward), 1e-12);
    vec3  axis = toward / light_distance;
    float to_light = positional ? light_distance : frame.farthest;
    end = to_light;
    if (radius > 0.0 && !is_cone) {
        vec3 right, up;
        vec2 point = radius * disc;
        find_frame(axis, right, up);
        place_on_light(light, square, point, right, up);
        toward += point.x * right + point.y * up;
        light_distance = length(toward);
        end = positional ? light_distance : end;
    }
    below_horizon = dot(normal, toward) <= 0.0 && !is_cone;
    begin_ray(normal, toward / light_distance);
    if (is_cone) {
        float turned = max(-dot(normal, hit.direction), 1.0 / MAX_STRETCHED);
        spread = radius / light_distance;
        margin = CONE_MARGIN * hit.width / turned;
        end = min(to_light, find_end_of_cone());
        free_start = 0.0;
        blocked = blocked || facing <= 2.0 * spread;
#ifdef PLANES
        blocked = blocked || krs_plane_cosine(direction) < 1.01 * spread + 1e-6;
#endif
        step_limit = blocked ? 0u : MAX_STEPS;
    }
}

// Aims over the hemisphere, up to the end of the scene.  Rays that fall end earlier: what they would meet
// is mostly ground in the light, for which the colour of the sky's ground stands.
void aim_over_hemisphere(vec3 normal, vec2 disc)
{
    vec3 toward = find_hemisphere_ray(normal, disc);
    lift = max(lift, LIFT_OF_OCCLUSION * hit.near);
    start = hit.position + normal * lift;
    end = toward.y < 0.0 ? frame.occlusion_reach : frame.farthest;
    begin_ray(normal, toward);
}

// Begins to step along the ray, or the cone.
void begin_steps()
{
    t = free_start;
    slope = facing;
    step_count = 0u;
    last_distance = last_step = 0.0;
#ifdef STEPS
    last_radius = 0.0;
#endif
    took_least_step = true;
    float least = min(MIN_STEP * frame.error, MIN_STEP_IN_PIXELS);
    growth = STEP_GROWTH;
#ifndef PATH_RAYS
    growth = control.phase == RAYS_OVER_HEMISPHERE ? STEP_GROWTH_OF_SKY : growth;
#endif
    min_step = (is_cone ? 1.0 : least) * hit.width + hit.rounding;
}
