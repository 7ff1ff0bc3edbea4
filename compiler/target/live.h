/*
 * live.h: what of a flat module something depends on.
 */
#ifndef KRS_LIVE_H
#define KRS_LIVE_H

#include "compiler/target/instructions.h"

/* Tells for each id whether it is needed; the module is flat, and its stores are forwarded. */
bool *find_live(const ShaderModule *module);
/* Tells whether an instruction of the module is needed. */
bool is_live(const ShaderModule *module, const bool *live, const Instruction *instruction);

#endif
