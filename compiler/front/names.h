/*
 * names.h: checks, before anything is evaluated, that every name is defined.
 */
#ifndef KRS_NAMES_H
#define KRS_NAMES_H

#include "compiler/front/syntax.h"

/* The names that a file sees besides its own: built-in functions, the library, used files. */
typedef struct NameScope {
    const char *const *known;
    size_t             known_count;
    bool               incomplete; /* some are missing because of mistakes reported before */
} NameScope;

/*
 * Reports
 *     E0201  names that are used but not defined, each once and with the nearest known name; not
 *            where a mistake that is already reported may have hidden the definition
 *     E0202  names that are defined twice in one scope
 *     E0203  cycles among top-level `let`s, with the location of each definition in the cycle
 *     W0201  definitions that hide x, y, z, p, u, v
 * Bodies of functions that are never called are checked too.  A function may call itself.  A `let`
 * may not need its own value, not even through functions that it calls.
 */
void names_check(const Syntax *file, const NameScope *scope, Diags *diags, Arena *arena);

#endif
