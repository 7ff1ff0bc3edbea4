#version 450
#extension GL_GOOGLE_include_directive : enable
/*
 * trace.comp: primary rays, by sphere tracing.
 *
 * A ray advances by the distance to the scene, which cannot take it through a surface, until it
 * is within the permitted error of one: a share of the pixel's width there, or what single
 * precision can tell.  A few further steps then bring it onto the surface.  A ray from inside of
 * a solid sees the solid's inner wall.
 *
 * The distance is the one heavy thing and stands once, in one loop, which is bounded; rays that
 * need longer are continued by another dispatch from the state in their Ray.
 */
#include "scene.glsl"
#include "frame.glsl"

// Steps onto the surface once the error is permitted, the first plain, then by the secant: two
// end well below a hundredth of a pixel at usual angles.  A ray that falls at less than the
// least slope only grazes.
const uint  REFINEMENTS = 2u;
const float LEAST_SLOPE = 0.1;

void main()
{
    uvec2 pixel;
    uint  index;
    if (!find_pixel(pixel, index))
        return;
    krs_prepare();

    vec3  origin, direction;
    float base, slope;
    find_ray(vec2(pixel) + work.offset, origin, direction, base, slope);
    vec2 range = clip_ray(origin, direction, frame.eye.w);

    // No side yet: the first distance tells, unless the ray comes from outside of the box.
    Ray ray = Ray(range.x, range.x > 0.0 ? 1.0 : 0.0, 0u, range.x <= range.y ? MARCHING : MISS);
    if (control.beginning == 0u)
        ray = rays[index];

    float start = largest(origin);
    float base_error = frame.error * base + ROUNDING * start;
    float slope_error = max(frame.error * slope, ROUNDING);
    float last = INFINITE, step_before = INFINITE;
    uint  close = 0u;
    uint  budget = min(work.steps, frame.most_steps - min(ray.steps, frame.most_steps));

    // A ray that is being refined finishes here, so that where a dispatch ends is not seen.
    for (uint i = 0u; (i < budget || close > 0u) && ray.fate == MARCHING; i++) {
        float distance = krs_distance(origin + ray.t * direction);
        ray.side = ray.side == 0.0 ? (distance < 0.0 ? -1.0 : 1.0) : ray.side;
        distance *= ray.side;
        ray.steps++;

        if (close > 0u || distance < base_error + slope_error * ray.t)
            close++;
        bool away = close > 1u && abs(distance) >= abs(last);
        if (away)
            ray.t -= step_before; // that place was nearer
        if (away || close > REFINEMENTS) {
            ray.fate = HIT;
        } else {
            float slope_here = clamp((last - distance) / step_before, LEAST_SLOPE, 1.0);
            step_before = close > 1u ? distance / slope_here : distance;
            last = distance;
            ray.t += step_before;
            if (ray.t > range.y)
                ray.fate = close > 0u ? HIT : MISS;
        }
    }

    if (ray.fate == MARCHING) {
        if (ray.steps >= frame.most_steps) {
            // It has been creeping along a surface, so that is what is drawn; and it is counted.
            atomicAdd(control.unresolved, 1u);
            ray.fate = ray.t <= range.y ? HIT : MISS; // a t that is not a number is a miss
        } else {
            atomicAdd(control.marching, 1u);
        }
    }
    rays[index] = ray;
    hits[index].position = origin + ray.t * direction;
    hits[index].pixel = base + slope * ray.t;
}
