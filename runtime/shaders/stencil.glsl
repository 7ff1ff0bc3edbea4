/*
 * stencil.glsl: the taps for a normal: unit vectors v around the hit, where the distance f is
 * evaluated.
 *
 * The normal is along the sum of v f(p + r v).  For the corners of each of Plato's solids the sum
 * of v v^T is TAPS / 3 times the identity.  Where each corner has an opposite one, the error is of
 * second order in r.  Else, and for differences to one side, it is of first order.  STENCIL is the
 * KrsNormals of the taps, other than the default.  The file is C as well, for
 * tests/unit/stencils.c.
 */
#ifndef STENCIL
#define STENCIL 3
#endif

#if STENCIL == 1 // forward: the hit itself, and one step along each axis
const uint TAPS = 4u;
vec3 stencil(uint i)
{
    return vec3(i == 1u ? 1.0 : 0.0, i == 2u ? 1.0 : 0.0, i == 3u ? 1.0 : 0.0);
}
#elif STENCIL == 2 // tetrahedron
const uint TAPS = 4u;
vec3 stencil(uint i)
{
    float a = (i & 1u) == 0u ? 1.0 : -1.0, b = (i & 2u) == 0u ? 0.57735026919 : -0.57735026919;
    return vec3(a * 0.57735026919, b, a * b);
}
#elif STENCIL == 4 // cube
const uint TAPS = 8u;
vec3 stencil(uint i)
{
    return vec3((i & 1u) == 0u ? 0.57735026919 : -0.57735026919,
                (i & 2u) == 0u ? 0.57735026919 : -0.57735026919,
                (i & 4u) == 0u ? 0.57735026919 : -0.57735026919);
}
#elif STENCIL == 5 // icosahedron: the corners of three golden rectangles
const uint TAPS = 12u;
vec3 stencil(uint i)
{
    float a = (i & 1u) == 0u ? 0.52573111212 : -0.52573111212;
    float b = (i & 2u) == 0u ? 0.85065080835 : -0.85065080835;
    return vec3(i < 4u ? 0.0 : i < 8u ? b : a, i < 4u ? a : i < 8u ? 0.0 : b,
                i < 4u ? b : i < 8u ? a : 0.0);
}
#elif STENCIL == 6 // dodecahedron: three rectangles and a cube
const uint TAPS = 20u;
vec3 stencil(uint i)
{
    float side = (i & 1u) == 0u ? 1.0 : -1.0;
    float a = (i < 12u ? 0.35682208977 : 0.57735026919) * side;
    float b = (i < 12u ? 0.93417235896 : 0.57735026919) * ((i & 2u) == 0u ? 1.0 : -1.0);
    float c = i < 12u ? 0.0 : i < 16u ? 0.57735026919 : -0.57735026919;
    return vec3(i < 4u ? c : i < 8u ? b : a, i < 4u ? a : i < 8u ? c : b,
                i < 4u ? b : i < 8u ? a : c);
}
#else // octahedron
const uint TAPS = 6u;
vec3 stencil(uint i)
{
    float side = (i & 1u) == 0u ? 1.0 : -1.0;
    return vec3(i < 2u ? side : 0.0, i > 1u && i < 4u ? side : 0.0, i > 3u ? side : 0.0);
}
#endif
