/*
 * page.glsl: what the shaders of a page have in common: the frame and the work of a draw, which the runtime's files read
 * (runtime/shaders/rays.glsl), and what other passes have found of a pixel.
 *
 * Row 0 of a texture is the top of the picture.
 */
#include "blocks.h"

uniform Frame frame;
uniform Work work;
// The number of the ray within its pixel, of lights, the projection; and whether light comes from the middle of a light
// alone, as while something moves.
// The ray is the camera's, or that of a path: that of the mirror or glass that the last has met.
uniform uint bounce;
uniform highp sampler2D path_origins, path_directions, path_weights;
uniform uint ray_number, light_count, projection, from_middles;
// Tables of albedos, and behind them the lights, as in the runtime.
uniform highp usampler2D input_rows;
// The ray of a pixel: t, side, state, steps.
uniform highp sampler2D ends;
// Its normal, and how even the surface is.
uniform highp sampler2D facings;

Control control;

uvec4 load_input(uint number) { return texelFetch(input_rows, ivec2(int(number & 63u), int(number >> 6u)), 0); }

uint bitfieldReverse(uint bits)
{
    bits = bits >> 16u | bits << 16u;
    bits = (bits & 0xff00ff00u) >> 8u | (bits & 0x00ff00ffu) << 8u;
    bits = (bits & 0xf0f0f0f0u) >> 4u | (bits & 0x0f0f0f0fu) << 4u;
    bits = (bits & 0xccccccccu) >> 2u | (bits & 0x33333333u) << 2u;
    return (bits & 0xaaaaaaaau) >> 1u | (bits & 0x55555555u) << 1u;
}

#include "sines.glsl"
#include "rays.glsl"

bool are_of_paths()
{
#ifdef MIRRORS
    return bounce != 0u;
#else
    return false;
#endif
}

vec4 load_path(uint row, uint index)
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    return row == PATH_ORIGIN      ? texelFetch(path_origins, pixel, 0)
           : row == PATH_DIRECTION ? texelFetch(path_directions, pixel, 0)
                                   : texelFetch(path_weights, pixel, 0);
}

// Tells whether the pixel has such a ray.
bool has_ray() { return !are_of_paths() || largest(load_path(PATH_WEIGHT, 0u).xyz) > 0.0; }

void find_ray(vec2 image_point, out vec3 origin, out vec3 direction, out float base, out float slope)
{
    find_ray_of_picture(image_point, origin, direction, base, slope);
    if (are_of_paths()) {
        vec4 start = load_path(PATH_ORIGIN, 0u), ahead = load_path(PATH_DIRECTION, 0u);
        origin = start.xyz;
        base = start.w;
        direction = ahead.xyz;
        slope = ahead.w;
    }
}

void load_frame()
{
    control.projection = projection;
    control.first_ray = ray_number == 0u ? 1u : 0u;
    control.ray = ray_number;
    control.lights = light_count;
}

// Returns the pixel of this fragment, and the point of the picture that its ray goes through.
uvec2 own_pixel() { return uvec2(gl_FragCoord.xy); }
vec2 own_point() { return vec2(own_pixel()) + work.offset; }

#ifdef HITS
#include "hit_point.glsl"

// Tells whether the ray of this pixel hits something, and where.
bool find_own_hit(out HitPoint hit)
{
    vec4  ray = texelFetch(ends, ivec2(gl_FragCoord.xy), 0);
    vec3  origin, direction;
    float base, slope;
    find_ray(own_point(), origin, direction, base, slope);
    hit = hit_point_on(0u, origin, direction, base, slope, ray.x, ray.y, uint(ray.w));
    return ray.z == float(STATE_HIT);
}
#endif
