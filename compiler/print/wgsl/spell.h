/*
 * spell.h: functions and expressions of print/glsl in WGSL.
 */
#ifndef KRS_SPELL_H
#define KRS_SPELL_H

#include "compiler/print/printer.h"

/* Spells a function, or an expression of operands of this type, perhaps with a statement before it;
   the type does not matter in a function. */
void wgsl_spell(const char *text, size_t length, GraphType type, Text *out);

#endif
