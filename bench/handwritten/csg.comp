#version 450
#extension GL_GOOGLE_include_directive : enable
/*
 * csg.comp: ../scenes/csg.krs by hand: Quilez' primitives and his quadratic smooth minimum, its
 * division made a factor.  Where more than two parts meet, the order of blends is seen; it is
 * that of the scene, halves of halves.
 */
#include "view.glsl"

#define LOW      vec3(-1.85, -0.2, -1.25)
#define HIGH     vec3(1.85, 1.3, 1.25)
#define METALLIC 0.8

float ball(vec3 p, vec3 at, float radius) { return length(p - at) - radius; }

float block(vec3 p, vec3 half_size)
{
    vec3 q = abs(p) - half_size;
    return length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0);
}

float post(vec3 p, vec3 at, float radius, float half_height)
{
    vec2 q = vec2(length(p.xz - at.xz) - radius, abs(p.y - at.y) - half_height);
    return min(max(q.x, q.y), 0.0) + length(max(q, 0.0));
}

float ring(vec3 p, vec3 at, float major, float minor)
{
    return length(vec2(length(p.xz - at.xz) - major, p.y - at.y)) - minor;
}

// `along` is the way from one end to the other; its square is a literal, so that it is divided
// by when the shader is compiled.
float rib(vec3 p, vec3 from, vec3 along, float radius)
{
    vec3 q = p - from;
    return length(q - along * clamp(dot(q, along / dot(along, along)), 0.0, 1.0)) - radius;
}

// CSG nodes of the body are 0.15 wide, of what is cut out 0.04.
float join(float a, float b)
{
    float h = max(0.15 - abs(a - b), 0.0);
    return min(a, b) - h * h * (0.25 / 0.15);
}

float cut(float a, float b)
{
    float h = max(0.04 - abs(a - b), 0.0);
    return min(a, b) - h * h * (0.25 / 0.04);
}

float body(vec3 p)
{
    float base = join(block(p, vec3(1.8, 0.15, 1.2)), post(p, vec3(0.0, 0.6, 0.0), 0.75, 0.6));
    float foot = join(ring(p, vec3(0.0, 1.1, 0.0), 0.75, 0.12),
                      post(p, vec3(1.4, 0.25, 0.8), 0.34, 0.15));
    float left = join(post(p, vec3(1.38, 0.25, -0.82), 0.33, 0.16),
                      post(p, vec3(-1.42, 0.25, 0.78), 0.35, 0.14));
    float back = join(post(p, vec3(-1.4, 0.25, -0.8), 0.36, 0.17),
                      rib(p, vec3(0.56, 0.8, 0.32), vec3(0.7, -0.6, 0.4), 0.11));
    float first = join(join(base, foot), join(left, back));

    float ribs = join(rib(p, vec3(0.54, 0.82, -0.34), vec3(0.7, -0.62, -0.4), 0.1),
                      rib(p, vec3(-0.57, 0.78, 0.3), vec3(-0.71, -0.58, 0.4), 0.12));
    float last = join(rib(p, vec3(-0.55, 0.8, -0.33), vec3(-0.71, -0.6, -0.39), 0.115),
                      ball(p, vec3(0.0, 0.6, 0.78), 0.2));
    float two = join(ball(p, vec3(0.7, 0.56, 0.34), 0.19), ball(p, vec3(0.66, 0.62, -0.42), 0.21));
    float three = join(ball(p, vec3(0.02, 0.66, -0.77), 0.2),
                       join(ball(p, vec3(-0.68, 0.6, -0.38), 0.18),
                            ball(p, vec3(-0.66, 0.58, 0.4), 0.22)));
    return join(first, join(join(ribs, last), join(two, three)));
}

float tools(vec3 p)
{
    float bore = cut(post(p, vec3(0.0), 0.45, 1.5),
                     cut(post(p, vec3(0.0, 1.2, 0.0), 0.58, 0.25),
                         post(p, vec3(1.4, 0.0, 0.8), 0.14, 1.0)));
    float holes = cut(post(p, vec3(1.38, 0.0, -0.82), 0.13, 1.0),
                      cut(post(p, vec3(-1.42, 0.0, 0.78), 0.15, 1.0),
                          post(p, vec3(-1.4, 0.0, -0.8), 0.14, 1.0)));
    float sinks = cut(post(p, vec3(1.4, 0.44, 0.8), 0.22, 0.1),
                      cut(post(p, vec3(1.38, 0.45, -0.82), 0.21, 0.1),
                          post(p, vec3(-1.42, 0.43, 0.78), 0.23, 0.1)));
    float slots = cut(cut(post(p, vec3(-1.4, 0.46, -0.8), 0.22, 0.1),
                          block(p, vec3(0.09, 1.5, 0.55))),
                      cut(ball(p, vec3(0.05, -0.1, 1.3), 0.42),
                          ball(p, vec3(-0.1, -0.08, -1.3), 0.4)));
    return cut(cut(bore, holes), cut(sinks, slots));
}

float map(vec3 p) { return -cut(-body(p), tools(p)); }

vec4 material(vec3 p) { return vec4(0.52711513, 0.25415209, 0.06847817, 0.35); }

#include "tracer.glsl"
