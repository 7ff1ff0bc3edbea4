#version 450
#extension GL_GOOGLE_include_directive : enable
/*
 * trace.comp: primary rays, by sphere tracing, behind beams.
 *
 * A ray advances by the distance to the scene, which cannot take it through a surface, until it
 * is within the permitted error of one: a share of the pixel's width there, or what single
 * precision can tell.  A few further steps then bring it onto the surface.  A ray from inside of
 * a solid sees the solid's inner wall.
 *
 * What the 64 rays of a tile share is marched once before, by the beam through the middle of
 * the tile: as long as the empty ball around its point is wider than the tile is there, all its
 * rays may start at the same parameter.  Tiles count from the corner of the picture, whatever
 * the crop and the band, so that equal pixels come out of all of them.
 *
 * The distance is the one heavy thing and stands once, in one loop, which is bounded; rays that
 * need longer are continued by another dispatch from the state in their Ray.
 */
#include "scene.glsl"
#include "frame.glsl"

// Steps onto the surface once the error is permitted, the first plain, then by the secant: three
// end well below a hundredth of a pixel at usual angles.  A ray that falls at less than the
// least slope only grazes.
const uint  REFINEMENTS = 3u;
const float LEAST_SLOPE = 0.1;

// A beam ends where its ball is hardly wider than the tile (measurements.md: 1.05).
const float WIDER = 1.05;

// The tiles, counted in the whole picture, that the band has a part of: the first, and how many.
void find_tiles(out uvec2 first, out uvec2 count)
{
    first = work.corner / 8u;
    count = (work.corner + work.extent - 1u) / 8u - first + 1u;
}

// How far the rays of a tile are from the ray through its middle at the same parameter t: at
// most base + slope t.
vec2 find_width(vec2 middle, vec3 origin, vec3 direction)
{
    vec2 width = vec2(0.0);
    for (uint corner = 0u; corner < 4u; corner++) {
        vec3  from, along;
        float base, slope;
        find_ray(middle + 8.0 * vec2(corner & 1u, corner >> 1u) - 4.0, from, along, base, slope);
        width = max(width, vec2(length(from - origin), length(along - direction)));
    }
    return width;
}

void main()
{
    bool  beam = control.beams == MARCH_BEAMS;
    uvec2 first, count;
    find_tiles(first, count);

    uvec2 pixel;
    uint  index;
    bool  exists = find_pixel(pixel, index);
    vec2  place = vec2(pixel) + work.offset;
    if (beam) {
        uint tile = work.first + gl_WorkGroupID.x * work.stride % work.groups;
        index = tile * 64u + gl_LocalInvocationIndex;
        exists = index < count.x * count.y;
        place = vec2(first + uvec2(index % count.x, index / count.x)) * 8.0 + 4.0;
    }
    if (!exists)
        return;
    krs_prepare();

    vec3  origin, direction;
    float base, slope;
    find_ray(place, origin, direction, base, slope);
    vec2 range = clip_ray(origin, direction, frame.eye.w);
    vec2 width = find_width(place, origin, direction);
    if (control.beams == FOLLOW_BEAMS) {
        uvec2 tile = pixel / 8u - first;
        range.x = max(range.x, hits[tile.y * count.x + tile.x].beam);
    }
    if (beam)
        range = vec2(0.0, frame.eye.w);

    // No side yet: the first distance tells, unless something empty lies behind the ray.
    Ray ray = Ray(range.x, range.x > 0.0 ? 1.0 : 0.0, 0u, range.x <= range.y ? MARCHING : MISS);
    if (control.beginning == 0u && !beam)
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
        if (beam) {
            float room = distance - ROUNDING * (start + ray.t) - width.x;
            ray.steps++;
            if (room < (WIDER * width.y) * ray.t + (WIDER - 1.0) * width.x || distance < base_error)
                ray.fate = HIT;
            else
                ray.t = (ray.t + room) / (1.0 + width.y);
            if (ray.t > range.y)
                ray.fate = MISS;
            continue;
        }
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

    if (beam) { // wherever it ends, everything before is empty
        hits[index].beam = ray.fate == MISS ? INFINITE : ray.t;
        atomicAdd(control.beam_evaluations, ray.steps);
        return;
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
