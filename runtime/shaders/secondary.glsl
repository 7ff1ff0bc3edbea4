/*
 * secondary.glsl: where rays of hits begin and end: to lights, over the hemisphere for occlusion, and cones.  Those
 * who march them (secondary.comp, or lanes of the host) are in between.
 *
 * The visible part of a light, and the openness of a hit, are fractions of rays: means over neighbours (shadow.comp,
 * occlusion.comp).  A cone from a hit to the whole light saves rays if it is empty.  Then all points of the light are
 * visible, from the pixels around as well.
 */
#include "hit_lists.glsl"
#ifdef PATH_RAYS
#include "results.glsl"
#endif
#include "secondary_ends.glsl"
#include "secondary_rays.glsl"

uint  unresolved;  // rays of this lane that ran out of steps

// Returns a point of the unit square, for the light or the hemisphere of the dispatch.
vec2 sample_now()
{
    uint use = control.phase == RAYS_OVER_HEMISPHERE ? 0u : 1u + control.light;
    return sample_square(work.corner + pixel_of(hit.slot), control.ray, use, control.seed);
}

#ifdef PATH_RAYS
vec3 added; // by the light if it is visible,
uint row;   // to this row of results

// Finds where the path was scattered; its ray has gone on.  That of the light starts as high at
// least.
HitPoint hit_of_path(uint slot)
{
    uint index = index_of(pixel_of(slot));
    vec4 surface = load_path(PATH_SURFACE, index);
    row = uint(abs(surface.w)) / CODES_OF_RAYS;
    surface.w = sign(surface.w) * (abs(surface.w) - float(row * CODES_OF_RAYS));
    enter_medium(surface.w);
    vec4  next = load_path(PATH_ORIGIN, index);
    float rounding = 2.0 * ROUNDING * largest(surface.xyz);
    lift = max(SNAPPED_START * rounding, length(next.xyz - surface.xyz));
    return HitPoint(slot, surface.xyz, vec3(0.0), next.w, next.w, rounding, sign(surface.w), 0u);
}

// Aims at the light that the path has chosen.  A light behind the surface is seen from there.
void aim_as_chosen(vec3 normal)
{
    uint index = index_of(pixel_of(hit.slot));
    vec4 chosen = load_path(PATH_LIGHT, index);
    vec3 toward = load_path(PATH_TOWARD, index).xyz;
    float behind = dot(normal, toward) < 0.0 ? -1.0 : 1.0;
    start = hit.position + behind * lift * normal;
    end = min(chosen.w, frame.farthest);
    added = chosen.rgb;
    below_horizon = !(largest(added) > 0.0);
    begin_ray(behind * normal, toward);
    if (chosen.w == 0.0) { // a light without shadows
        blocked = false;
        step_limit = 0u;
    }
}
#endif

void exchange_item(uint number) {}

void begin_group(uint first)
{
    unresolved = 0u;
#ifdef PATH_RAYS // to the lights that paths have chosen
    is_cone = false;
#else
    begin_light(control.light);
#ifdef MIXED_RAYS // one sample has no noise
    radius = control.rays > 1u || !are_of_paths() ? radius : 0.0;
#endif
    is_cone = control.phase == RAYS_CONES;
#endif
}

void begin_item(uint number, bool saved)
{
    uint listed = find_listed(control.reading + number);
    bool exists = !is_cone || has_cone(listed);
#ifdef PATH_RAYS
    hit = hit_of_path(listed);
#else
    hit = hit_point_of_slot(!exists ? 0u : is_cone ? cone_of_quarter(listed) : listed);
#endif
    spread = margin = 0.0;
    below_horizon = false;
    vec4 facing_and_evenness = load_hit(FACING, hit.slot);
    vec3 normal = facing_and_evenness.xyz;
#ifdef PATH_RAYS
    aim_as_chosen(normal);
#else
    lift = find_lift(facing_and_evenness.w);
    vec2 square = sample_now(), disc = disc_of_square(square);
    if (control.phase == RAYS_OVER_HEMISPHERE)
        aim_over_hemisphere(normal, disc);
    else
        aim_at_light(normal, square, disc);
#endif
    blocked = blocked || !exists;
    step_limit = exists ? step_limit : 0u;
    begin_steps();
}

// Tells how far from the start the centre of the light is; 0: it has no place.
float find_light_distance() { return positional ? max(length(light.vector - start), 1e-30) : 0.0; }

void end_ray()
{
    unresolved += step_limit > 0u ? 1u : 0u;
#ifdef PLANES
    if (!blocked && plane_t < INFINITE) {
        blocked = true;
        t = plane_t;
    }
#endif
#ifdef PATH_RAYS
    if (!blocked && !below_horizon)
        add_light_to(row, index_of(pixel_of(hit.slot)), clamped(added));
#else
    store_end(hit.slot, find_depth(hit),
              RayOfHit(blocked, below_horizon, t, hit.width, radius, find_light_distance()));
#endif
}

void end_item()
{
    if (!is_cone)
        end_ray();
    else if (!blocked && step_limit == 0u)
        store_shared(RAYS_SHARED, hit.slot, find_depth(hit), LIT);
}
