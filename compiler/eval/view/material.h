/*
 * material.h: materials, and surfaces that are coloured by a number.
 */
#ifndef KRS_EVAL_MATERIAL_H
#define KRS_EVAL_MATERIAL_H

#include "compiler/eval/elaborate.h"

/* Returns a material, or a colour that becomes one; NULL: reported. */
const Material *to_material(Elaboration *e, Value value, const Syntax *syntax);

/* palette.c: `.color_by`. */
Value method_color_by(Elaboration *e, const Shape *shape, Call *call);

#endif
