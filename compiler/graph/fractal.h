/*
 * fractal.h: Julia sets of quaternions and Mandelbulbs, in double precision.
 *
 * The solid of n iterations is the set of points whose orbit has not left the ball of the escape
 * radius after n steps; it contains the solid of n + 1.  print/glsl has the same in GLSL.
 */
#ifndef KRS_FRACTAL_H
#define KRS_FRACTAL_H

#include "compiler/graph/graph.h"

enum { MAX_POWER = 16, MAX_ITERATIONS = 64 };

/* Returns the least R that an orbit of z^power + c does not come back from: R^power = R + |c|. */
double julia_radius(double c, uint32_t power);
/* Returns the same for the Mandelbulb, whatever the point. */
double mandelbulb_radius(uint32_t power);

/* These return the `evaluate` columns of ops.def.  Operands: point, c (Julia sets), (power, most
   iterations), (iterations, escape radius). */
NodeValue evaluate_julia(const NodeValue *o, uint32_t size);
NodeValue evaluate_julia_trap(const NodeValue *o, uint32_t size);
/* Evaluates a Mandelbulb; operands: point, (power, most iterations), (iterations, escape radius). */
NodeValue evaluate_mandelbulb(const NodeValue *o, uint32_t size);
NodeValue evaluate_mandelbulb_trap(const NodeValue *o, uint32_t size);

/* Iterations of loops in a shader's bound (print/glsl) with so many iterations of the orbit at
   most: there and back again in a Julia set, unless both ways are unrolled. */
enum { UNROLLED_JULIA = 32 };
uint32_t fractal_loops(Op op, double iterations);

/* Returns the radius of a ball about the origin that every Mandelbulb of this power contains. */
double mandelbulb_core(double power);
/* Outside of this many escape radii the ball of that radius serves as the solid. */
#define MANDELBULB_NEAR 1.15

#endif
