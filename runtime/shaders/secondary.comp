#version 440
#extension GL_GOOGLE_include_directive : enable
#extension GL_KHR_shader_subgroup_shuffle : enable
/*
 * secondary.comp: rays that start at hits: to lights, and over the hemisphere for occlusion.
 *
 * Such a ray is blocked where it is inside of a solid, not where the distance is small.  A distance
 * may be a bound far below the true one, and light must not depend on how the bound was derived.
 * Where rays begin and end is in secondary.glsl.
 *
 * STEPS: there is krs_steps, by which rays go from root to root of what has any.
 *
 * PLANES: distances leave out planes.  What starts outside of a plane, and does not fall towards it,
 * never meets it.  Else a ray is marched up to there, and ends blocked.  The box is that around all else.
 */
#ifndef REFILL // chosen by the renderer; this choice suits every device
#define REFILL 0
#endif
#include "scene.glsl"
#include "frame.glsl"
#include "secondary.glsl"

bool item_needs_step() { return step_count < step_limit; }

float item_distance(vec3 position)
{
#ifdef STEPS
    // Back to the last position and some roundings farther.  Else a point just before a surface
    // without thickness could count as behind it at this step.
    float some = 2.0 * ROUNDING * (largest(position) + t);
    vec2  steps = krs_steps(position, direction, last_step > 0.0 ? last_step + some : 0.0);
    // Balls around other solids are not known from inside of one.
    float least = min(steps.x, steps.y);
    max_ahead = hit.side < 0.0 ? -least : steps.x;
    radius_here = hit.side < 0.0 ? -least : min(steps.y, end);
    return least;
#else
    return krs_distance(position);
#endif
}

#include "secondary_step.glsl"

void end_group(uint steps)
{
    if (unresolved > 0u)
        atomicAdd(counts.unresolved, unresolved);
}

const uint REFILL_THRESHOLD = 3u;
#define SAVES 0
void save_item() {}

#include "schedule.glsl"
