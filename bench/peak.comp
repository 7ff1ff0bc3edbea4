#version 450
#extension GL_GOOGLE_include_directive : enable
/*
 * peak.comp: nothing but multiply-adds, in chains that do not wait for each other.
 *
 * CHAINS vectors of four, so many that each finds its last value ready again when its turn comes,
 * so few that all stay in registers; which number that is depends on the device, so peak.c tries
 * several.
 */
#include "sizes.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 1) writeonly buffer Sums { vec4 sums[]; };
layout(push_constant) uniform Zero { int zero; };

#define ONCE  for (int i = 0; i < CHAINS; i++) chain[i] = chain[i] * scale + step;
#define TWICE ONCE ONCE

void main()
{
    float seed = float(gl_LocalInvocationIndex + uint(zero));
    vec4  chain[CHAINS], scale = vec4(0.999, 0.998, 0.997, 0.996), step = vec4(0.001 * seed);
    for (int i = 0; i < CHAINS; i++)
        chain[i] = vec4(seed) + float(i);
    for (int iteration = zero; iteration < ITERATIONS; iteration++) {
        TWICE TWICE TWICE TWICE
    }
    vec4 sum = vec4(0.0);
    for (int i = 0; i < CHAINS; i++)
        sum += chain[i];
    sums[gl_LocalInvocationIndex] = sum;
}
