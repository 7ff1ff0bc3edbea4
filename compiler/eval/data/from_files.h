/*
 * from_files.h: functions whose values come from files.
 */
#ifndef KRS_FROM_FILES_H
#define KRS_FROM_FILES_H

#include "compiler/eval/elaborate.h"

BuiltinFunction builtin_read_csv, builtin_read_json, builtin_text, builtin_svg, builtin_texture,
    builtin_footprint;

/* Evaluates `t.alpha(u, v)` or `t.size` of the texture of this number. */
Value texture_method(Elaboration *e, const Environment *env, const Syntax *syntax, uint32_t number);

#endif
