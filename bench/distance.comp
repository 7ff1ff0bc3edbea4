#version 450
#extension GL_GOOGLE_include_directive : enable
/*
 * distance.comp: nothing but evaluations of a scene's distance, each at a place that depends on
 * the one before.
 */
#include "scene.glsl"
#include "sizes.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 1) writeonly buffer Ends { vec4 ends[]; };
layout(push_constant) uniform Zero { int zero; };

void main()
{
    krs_prepare();
    uint index = gl_GlobalInvocationID.x;
    vec3 p = 3.0 * fract(float(index) * vec3(0.8191725, 0.6710436, 0.5497005)) - 1.0;
    for (int i = zero; i < EVALUATIONS; i++)
        p += 1e-3 * krs_distance(p);
    ends[index] = vec4(p, 0.0);
}
