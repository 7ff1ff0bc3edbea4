/*
 * inline.h: copies the bodies of functions to where they are called.
 */
#ifndef KRS_INLINE_H
#define KRS_INLINE_H

#include "compiler/target/instructions.h"

/* Makes one function of a module that was read: the entry point without any call, in `variables` and
   `body`; private globals become its variables.  Takes time in proportion to what it makes.
   Returns false, and the module is spent, if a function that is called returns anywhere but at its
   end, or the SPIR-V is none that glslang makes. */
bool inline_functions(ShaderModule *module);

#endif
