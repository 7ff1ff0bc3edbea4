#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * point_query.comp: the scene at given points.
 */
#include "runtime/shared/answers.h"
#include "scene.glsl"

layout(local_size_x = 64) in;

layout(std140, set = 1, binding = WORK_BINDING) uniform PointWorkBlock { PointWork work; };

layout(std430, set = 1, binding = POINTS_BINDING) readonly buffer Points { Point points[]; };
layout(std430, set = 1, binding = ANSWERS_BINDING) writeonly buffer Answers { Answer answers[]; };

// Returns the distance, then one step along each axis and back: their differences are the gradient.
vec4 find_gradient(vec3 p)
{
    float step = work.min_step + 1e-3 * max(max(abs(p.x), abs(p.y)), abs(p.z));
    vec4  found = vec4(0.0);
    for (uint i = 0u; i < work.taps; i++) {
        uint  axis = (i + 1u) / 2u;
        float sign_of_tap = (i & 1u) != 0u ? 1.0 : -1.0;
        vec3  direction = sign_of_tap * vec3(axis == 1u, axis == 2u, axis == 3u);
        float distance = krs_distance(p + step * direction);
        found += axis == 0u ? vec4(0.0, 0.0, 0.0, distance) : vec4(distance * direction, 0.0);
    }
#ifdef OPEN_SURFACES // the distance is nowhere negative: differences see both sides
    vec3 gradient = krs_gradient(p, step);
    found.xyz = work.taps > 1u && dot(gradient, gradient) > 0.0 ? gradient : found.xyz;
#endif
    float steepness = length(found.xyz);
    found.xyz /= steepness > 0.0 ? steepness : 1.0;
    return found;
}

// Returns a row of an answer.
vec4 row_of(float number) { return vec4(number, 0.0, 0.0, 0.0); }
vec4 row_of(vec3 numbers) { return vec4(numbers, 0.0); }

// Limits numbers; what is not a number becomes the lower limit.
vec4 limit(vec4 numbers, float low, float high)
{
    return mix(vec4(low), min(numbers, high), greaterThan(numbers, vec4(low)));
}
#define LIMITED(numbers, low, high)   limit(numbers, low, high)
#define UNLIMITED(numbers, low, high) numbers

void main()
{
    uint index = gl_GlobalInvocationID.x;
    if (index >= work.count)
        return;
    krs_prepare();

    vec3 p = points[index].point;
    vec4 gradient_and_distance = find_gradient(p);
#ifdef OPEN_SURFACES // they are seen from both sides
    if (dot(gradient_and_distance.xyz, points[index].direction) > 0.0)
        gradient_and_distance.xyz = -gradient_and_distance.xyz;
#endif
#ifdef KRS_VIEW
    krs_view = points[index].direction;
#endif
    KrsSurface surface = krs_surface(p, gradient_and_distance.xyz, 0.0);
    Answer answer;
    answer.gradient = gradient_and_distance.xyz;
    answer.distance = gradient_and_distance.w;
    answer.normal = surface.normal;
    answer.surface_distance = surface.distance;
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends) \
    answer.name = uvec4(surface.name);
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    answer.name = asked(row_of(surface.name), low, high);
#include "krs/surface.def"
    answers[index] = answer;
}
