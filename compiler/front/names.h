/*
 * names.h: every name is defined somewhere, before anything is evaluated.
 */
#ifndef KRS_NAMES_H
#define KRS_NAMES_H

#include "compiler/front/syntax.h"

/* A file and what it can see. */
typedef struct NameScope {
    const char *const *known; /* names from outside: built-in functions, the library, used files */
    size_t             known_count;
    bool               incomplete; /* some are missing because of mistakes reported before */
} NameScope;

/* Reports names used and not defined (E0201, each once, with the nearest known name; not where
   a mistake already reported may have hidden the definition), names defined twice
   in one scope (E0202), cycles among top-level `let`s (E0203: the chain of definitions as
   places), and definitions that hide x, y, z, p, u, v (W0201).  Bodies of functions that are
   never called are checked too.  A function may call itself; a `let` may not need itself, also
   not through functions it calls. */
void names_check(const Syntax *file, const NameScope *scope, Diags *diags, Arena *arena);

#endif
