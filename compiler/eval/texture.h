/*
 * texture.h: what a value that is a texture does.
 */
#ifndef KRS_EVAL_TEXTURE_H
#define KRS_EVAL_TEXTURE_H

#include "compiler/eval/elaborate.h"

/* `t(u, v)`, and `t.alpha(u, v)`, `t.size`, of the texture of this number. */
Value call_texture(Elaboration *e, const Environment *env, const Syntax *syntax, uint32_t number);
Value texture_method(Elaboration *e, const Environment *env, const Syntax *syntax, uint32_t number);

#endif
