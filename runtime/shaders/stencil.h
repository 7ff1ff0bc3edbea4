/*
 * stencil.h: stencil.glsl for C: the corners of all stencils under their names, for tests and the
 * bench.
 */
#ifndef KRS_STENCIL_H
#define KRS_STENCIL_H

#include <stddef.h>
#include <sys/types.h>

#include "krs/vulkan.h"

typedef struct vec3 {
    float x, y, z;
} vec3;
#define vec3(x, y, z) ((vec3){(float)(x), (float)(y), (float)(z)})

#define STENCIL 1
#define TAPS    forward_taps
#define stencil forward
#include "runtime/shaders/stencil.glsl"
#undef STENCIL
#undef TAPS
#undef stencil
#define STENCIL 2
#define TAPS    tetrahedron_taps
#define stencil tetrahedron
#include "runtime/shaders/stencil.glsl"
#undef STENCIL
#undef TAPS
#undef stencil
#define STENCIL 3
#define TAPS    octahedron_taps
#define stencil octahedron
#include "runtime/shaders/stencil.glsl"
#undef STENCIL
#undef TAPS
#undef stencil
#define STENCIL 4
#define TAPS    cube_taps
#define stencil cube
#include "runtime/shaders/stencil.glsl"
#undef STENCIL
#undef TAPS
#undef stencil
#define STENCIL 5
#define TAPS    icosahedron_taps
#define stencil icosahedron
#include "runtime/shaders/stencil.glsl"
#undef STENCIL
#undef TAPS
#undef stencil
#define STENCIL 6
#define TAPS    dodecahedron_taps
#define stencil dodecahedron
#include "runtime/shaders/stencil.glsl"
#undef STENCIL
#undef TAPS
#undef stencil

typedef vec3 StencilCorner(uint i);
typedef struct Stencil {
    StencilCorner *corner; /* NULL: none */
    uint           taps;
} Stencil;

/* Returns the stencil of a kind of normals; none for the default and for derivatives. */
static inline Stencil find_stencil(KrsNormals normals)
{
    switch (normals) {
    case KRS_NORMALS_FORWARD: return (Stencil){forward, forward_taps};
    case KRS_NORMALS_TETRAHEDRON: return (Stencil){tetrahedron, tetrahedron_taps};
    case KRS_NORMALS_OCTAHEDRON: return (Stencil){octahedron, octahedron_taps};
    case KRS_NORMALS_CUBE: return (Stencil){cube, cube_taps};
    case KRS_NORMALS_ICOSAHEDRON: return (Stencil){icosahedron, icosahedron_taps};
    case KRS_NORMALS_DODECAHEDRON: return (Stencil){dodecahedron, dodecahedron_taps};
    default: return (Stencil){NULL, 0};
    }
}

#endif
