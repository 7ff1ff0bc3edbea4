/*
 * surfaces.glsl: in place of a scene: the surfaces of hits, which the host has found (lane_surfaces.c).  So the shader is
 * the same for all scenes.
 */
#include "runtime/shared/blocks.h"

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

#if defined(LAYERS) || defined(SUBSURFACE)
const uint ROWS_OF_SURFACE = SURFACE_ROWS;
#else
const uint ROWS_OF_SURFACE = PLAIN_SURFACE_ROWS;
#endif

layout(set = 1, binding = SURFACE_TEXELS_BINDING) uniform usamplerBuffer surface_texels;

uint krs_slot; // of the hit whose surface is asked for

// Takes the next number of the surface; where there are no more it is as nothing else is said.
void take(inout uint at, out uint number, uint otherwise)
{
    number = otherwise;
    if (at < 4u * ROWS_OF_SURFACE)
        number = texelFetch(surface_texels, int(ROWS_OF_SURFACE * krs_slot + at / 4u))[at & 3u];
    at++;
}

void take(inout uint at, out float number, float otherwise)
{
    uint bits;
    take(at, bits, floatBitsToUint(otherwise));
    number = uintBitsToFloat(bits);
}

void take(inout uint at, out vec3 numbers, float otherwise)
{
    take(at, numbers.x, otherwise);
    take(at, numbers.y, otherwise);
    take(at, numbers.z, otherwise);
}

void krs_prepare() {}

KrsSurface krs_surface(vec3 p, vec3 normal, float footprint)
{
    KrsSurface surface;
    uint at = 0u;
    take(at, surface.distance, 0.0);
    take(at, surface.normal, 0.0);
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends)                                \
    take(at, surface.name, uint(otherwise));
#include "krs/surface.def"
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends)                     \
    take(at, surface.name, otherwise);
#include "krs/surface.def"
    return surface;
}
