/*
 * rays.glsl: the rays of a camera, lights, and lengths along rays: what shaders of the runtime share with those of pages
 * (web/picture).
 *
 * Whoever includes it has the frame, the work and the control block (frame.glsl), and load_input.
 */
#ifndef RAYS
#define RAYS

const float PI       = 3.14159265358979;
const float INFINITE = 1e38;
const float ROUNDING = 2.4e-7; // four units in the last place of 1
// A pixel counts as no wider than this part of its ray where rays start, for normals, and, where hits are
// snapped, for all.  There rays of paths start so many roundings above a surface.  So where paths go does
// not depend on the size of the picture.
const float MAX_WIDTH = 1.0 / 64.0, SNAPPED_START = 32.0;

// Tells whether hits are snapped as near to the surface as rounding permits (march_step.glsl).  Marches
// know it when they are compiled, since lavapipe runs both sides of a branch.
bool snaps()
{
#ifdef SNAPS
    return SNAPS != 0;
#else
    return frame.snaps != 0u;
#endif
}

// Tells how wide a pixel counts that is so wide at t.
float width_at(float t, float width) { return snaps() ? min(width, MAX_WIDTH * t) : width; }

Light find_light(uint number)
{
    uint  row = LIGHTS_AT + LIGHT_ROWS * number;
    vec4  vector = uintBitsToFloat(load_input(row));
    uvec4 color = load_input(row + 1u);
    vec4  right = uintBitsToFloat(load_input(row + 2u));
    vec4  up = uintBitsToFloat(load_input(row + 3u));
    return Light(vector.xyz, vector.w, uintBitsToFloat(color.xyz), color.w, right.xyz, right.w,
                 up.xyz, up.w);
}

#ifdef LENS
#include "samples.glsl"

// Maps the unit square to a regular polygon with corners on the unit circle, with areas in
// proportion.
vec2 polygon_of_square(vec2 square, float corners)
{
    float place = corners * square.x, corner = floor(place), along = place - corner;
    float first = 2.0 * PI * corner / corners, next = 2.0 * PI * (corner + 1.0) / corners;
    return sqrt(square.y) * mix(vec2(krs_sin(first), krs_cos(first)),
                                vec2(krs_sin(next), krs_cos(next)), along);
}

// Returns the point of the lens that the ray through a point of the picture begins at, in parts of
// its radius.  The first ray of each pixel goes through its middle.
vec2 find_lens_point(vec2 image_point)
{
    vec2  pixel = floor(image_point - work.offset + 0.5);
    vec2  square = sample_lens(uvec2(max(pixel, 0.0)), control.ray, control.seed);
    vec2  point = frame.lens.w > 0.0 ? polygon_of_square(square, frame.lens.w)
                                     : disc_of_square(square);
    return control.first_ray != 0u ? vec2(0.0) : point;
}

// Finds the ray from the lens, which meets the one through its middle, `straight`, where things are
// sharp.
void find_lens_ray(vec2 image_point, vec3 straight, inout vec3 origin, out vec3 ahead)
{
    vec2 point = find_lens_point(image_point) * frame.lens.xy;
    vec3 beside = point.x * frame.right.xyz + point.y * frame.up.xyz;
    origin += beside;
    ahead = straight - frame.lens.z * beside;
}
#endif

#if !defined(LISTED_RAYS) && !defined(PATH_RAYS)
// Finds the ray of a camera through a point of the picture.
void find_ray_of_picture(vec2 image_point, out vec3 origin, out vec3 direction, out float base,
                         out float slope)
{
    vec2 plane = vec2(2.0 * image_point.x / frame.size.x - 1.0,
                      1.0 - 2.0 * image_point.y / frame.size.y);
#ifdef LENS
    plane += frame.shift.xy;
#endif
    origin = frame.eye;
    base = frame.pixel_base;
    slope = frame.pixel_slope;
    if (control.projection == PERSPECTIVE) {
        vec3  straight = frame.forward.xyz + plane.x * frame.right.xyz + plane.y * frame.up.xyz;
#ifdef LENS
        find_lens_ray(image_point, straight, origin, straight);
#endif
        float stretch = length(straight);
        direction = straight / stretch;
        slope /= stretch;
    } else {
        origin += plane.x * frame.right.xyz + plane.y * frame.up.xyz;
        direction = frame.forward.xyz;
#ifdef LENS
        find_lens_ray(image_point, direction, origin, direction);
        direction = normalize(direction);
#endif
    }
#ifdef PANORAMIC
    if (control.projection == PANORAMA) {
        float longitude = plane.x * PI, latitude = plane.y * 0.5 * PI;
        vec3  level = krs_cos(longitude) * frame.forward.xyz +
                      krs_sin(longitude) * frame.right.xyz;
        origin = frame.eye;
        direction = krs_cos(latitude) * level + krs_sin(latitude) * frame.up.xyz;
#ifdef LENS // each column has its own eye, beside the way that it looks
        origin += frame.shift.z * (krs_cos(longitude) * frame.right.xyz -
                                   krs_sin(longitude) * frame.forward.xyz);
#endif
    }
#endif
}
#endif

// Returns the interval of t in which a ray is inside of a box; empty when its end is the smaller
// number.  The box may be as large as 1e18, and no component of the direction is taken as smaller
// than 1e-18.  So nothing here is infinite times zero.
vec2 clip_to(vec3 low, vec3 high, vec3 origin, vec3 direction, float farthest)
{
    vec3 safe = mix(direction, vec3(1e-18), lessThan(abs(direction), vec3(1e-18)));
    vec3 a = (low - origin) / safe;
    vec3 b = (high - origin) / safe;
    vec3 enter = min(a, b), leave = max(a, b);
    return vec2(max(max(enter.x, enter.y), max(enter.z, 0.0)),
                min(min(leave.x, leave.y), min(leave.z, farthest)));
}

// Returns the same for the box around the scene.
vec2 clip_ray(vec3 origin, vec3 direction, float farthest)
{
    return clip_to(frame.low.xyz, frame.high.xyz, origin, direction, farthest);
}

float largest(vec3 v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }

// Finds two directions at right angles to a third (Duff et al. 2017).
void find_frame(vec3 axis, out vec3 right, out vec3 up)
{
    float side = axis.z < 0.0 ? -1.0 : 1.0;
    float a = -1.0 / (side + axis.z), b = axis.x * axis.y * a;
    right = vec3(1.0 + side * axis.x * axis.x * a, side * b, -side * axis.x);
    up = vec3(b, side + axis.y * axis.y * a, -axis.y);
}
#endif
