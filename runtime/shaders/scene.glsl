/*
 * scene.glsl: a stand-in for a compiled scene.
 *
 * At run time the text that the compiler prints takes the place of this file, and declares the same
 * names.  So shaders can be checked by themselves:
 *     glslangValidator -V --target-env vulkan1.1 -I. -Iruntime/shaders -Icompiler/print/glsl \
 *         runtime/shaders/trace.comp
 *
 * With SURFACES there is no scene, but what the host has found of its surfaces.
 */
#ifdef SURFACES
#include "surfaces.glsl"
#else
layout(std140, set = 0, binding = 0) uniform KrsParameters { vec4 krs_parameter[1]; };

// Names of types in surface.def.
#define FLOAT float
#define VEC3  vec3
#define UINT  uint

struct KrsSurface {
    float distance;
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) type name;
#include "krs/surface.def"
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends) shown name;
#include "krs/surface.def"
    vec3 normal;
};

float krs_local_radius;

void krs_prepare() { krs_local_radius = 1.0 + krs_parameter[0].x; }

float krs_distance(vec3 p) { return length(p) - krs_local_radius; }

KrsSurface krs_surface(vec3 p, vec3 normal, float footprint)
{
    KrsSurface surface;
    surface.distance = krs_distance(p);
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    surface.name = type(otherwise);
#include "krs/surface.def"
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends) surface.name = shown(otherwise);
#include "krs/surface.def"
    surface.normal = normal;
    return surface;
}

float krs_volume_density(uint volume, vec3 p) { return max(1.0 - length(p), 0.0); }
vec3  krs_volume_albedo(uint volume, vec3 p) { return vec3(1.0); }
float krs_volume_anisotropy(uint volume, vec3 p) { return 0.0; }
vec3  krs_volume_emission(uint volume, vec3 p) { return vec3(0.0); }
#endif
