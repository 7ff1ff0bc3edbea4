/*
 * forward.h: values of variables where it is known which store they come from.
 */
#ifndef KRS_FORWARD_H
#define KRS_FORWARD_H

#include "compiler/target/instructions.h"

/* Lets what is loaded from a variable stand for the value that was stored, or be a member of it, where
   that store is always the last one.  Also finds the roots of all pointers.  The module is flat. */
void forward_stores(ShaderModule *module);

#endif
