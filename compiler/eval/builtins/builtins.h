/*
 * builtins.h: functions and methods of the language that are built in, for the tables that have them.
 */
#ifndef KRS_BUILTINS_H
#define KRS_BUILTINS_H

#include "compiler/eval/elaborate.h"

/* ---- lists.c ---- */
BuiltinFunction builtin_sum, builtin_product, builtin_any, builtin_all, builtin_least,
    builtin_greatest, builtin_len, builtin_range;

/* ---- random.c ---- */
BuiltinFunction builtin_random, builtin_random_direction, builtin_noise, builtin_fbm;

/* ---- extremes.c ---- */
BuiltinFunction builtin_extremes;

/* ---- fractal.c ---- */
BuiltinFunction builtin_julia, builtin_mandelbulb;

/* ---- csg.c ---- */
BuiltinFunction builtin_union, builtin_intersection, builtin_difference, builtin_xor, builtin_morph,
    builtin_meta;

/* ---- cells.c ---- */
/* Finds the period of a lattice and its counts, 0 for endless; false: reported. */
bool want_lattice(Elaboration *e, const Call *call, Node *period, uint32_t cells[3]);
/* Tells whether functions have this method: `.repeat` and `.repeat_polar` of one that makes the shape of a
   cell. */
bool  repeats_functions(const char *method);
Value repeat_function(Elaboration *e, const Environment *env, const Syntax *syntax,
                      const Function *function);

/* ---- measure.c ---- */
Value method_distance(Elaboration *e, const Shape *shape, Call *call);
Value method_bounds(Elaboration *e, const Shape *shape, Call *call);

/* ---- grown.c ---- */
/* Returns a figure that is grown: an outline of its own, where outlines are wanted and that of the
   figure is known. */
const Shape *grown_outline(Elaboration *e, const Shape *figure, const Shape *grown);

/* ---- corners.c ---- */
Value method_corners(Elaboration *e, const Shape *shape, Call *call);

#endif
