/*
 * scene.glsl: a stand-in for a compiled scene.
 *
 * At run time the compiler's text takes the place of this file.  It promises what is declared
 * here, so that the kernels can be checked by themselves:
 *     glslangValidator -V --target-env vulkan1.1 -I. -Iruntime/shaders -Icompiler/print/glsl \
 *         runtime/shaders/trace.comp
 */
layout(std140, set = 0, binding = 0) uniform KrsParameters { vec4 krs_parameter[1]; };

struct KrsSurface {
    float distance;
    vec3  color;
    float roughness;
    float metallic;
    vec3  emission;
    uint  component;
    uint  level;
    uint  instance;
    vec3  normal;
};

float krs_local_radius;

void krs_prepare() { krs_local_radius = 1.0 + krs_parameter[0].x; }

float krs_distance(vec3 p) { return length(p) - krs_local_radius; }

KrsSurface krs_surface(vec3 p, vec3 normal, float footprint)
{
    return KrsSurface(krs_distance(p), vec3(0.8), 0.5, 0.0, vec3(0.0), 1u, 0u, 1u, normal);
}
