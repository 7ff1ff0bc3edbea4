#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * sample.comp: the scene at given points.
 */
#include "scene.glsl"

layout(local_size_x = 64) in;

layout(push_constant) uniform Work { uint count; } work;

struct Answer {
    vec3  color;
    float distance;
    vec3  emission;
    float surface_distance;
    float roughness, metallic;
    uint  component, level;
    uint  instance, unused[3];
};

layout(std430, set = 1, binding = 1) readonly buffer Points { vec4 points[]; };
layout(std430, set = 1, binding = 2) writeonly buffer Answers { Answer answers[]; };

void main()
{
    uint index = gl_GlobalInvocationID.x;
    if (index >= work.count)
        return;
    krs_prepare();

    vec3 p = points[index].xyz;
    KrsSurface surface = krs_surface(p);
    Answer answer;
    answer.color = surface.color;
    answer.distance = krs_distance(p);
    answer.emission = surface.emission;
    answer.surface_distance = surface.distance;
    answer.roughness = surface.roughness;
    answer.metallic = surface.metallic;
    answer.component = surface.component;
    answer.level = surface.level;
    answer.instance = surface.instance;
    answer.unused = uint[3](0u, 0u, 0u);
    answers[index] = answer;
}
