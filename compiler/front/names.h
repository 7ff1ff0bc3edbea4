/*
 * names.h: checks, before anything is evaluated, that every name is defined, and tells what each means.
 */
#ifndef KRS_NAMES_H
#define KRS_NAMES_H

#include "compiler/front/syntax.h"

/* A name that a file sees besides its own, and the statement of another file that defines it; NULL:
   it is built in. */
typedef struct KnownName {
    const char   *name;
    const Syntax *defined;
} KnownName;

/* The names that a file sees besides its own: built-in functions, the library, used files. */
typedef struct NameScope {
    const KnownName *known;
    size_t           known_count;
    bool             incomplete; /* some are missing because of mistakes reported before */
} NameScope;

/* A place where a name stands, and what it means there. */
typedef struct NameUse {
    Span          span;
    const char   *name;
    const Syntax *meaning; /* the node that defines it; NULL: it is built in */
    bool          defines; /* it is this node that stands here */
    Span          seen;    /* of a definition: where it is seen unless another one hides it */
} NameUse;

/* The names of files, in the order in which they were checked: without those that are not defined, and those behind
   a dot and of properties. */
typedef struct NameUses {
    NameUse *items;
    size_t   count, capacity;
} NameUses;

/*
 * Reports
 *     E0201  names that are used but not defined, each once and with the nearest known name; not
 *            where a mistake that is already reported may have hidden the definition
 *     E0202  names that are defined twice in one scope
 *     E0203  cycles among top-level `let`s, with the location of each definition in the cycle
 *     W0201  definitions that hide x, y, z, p, u, v
 * Bodies of functions that are never called are checked too.  A function may call itself.  A `let`
 * may not need its own value, not even through functions that it calls.
 *
 * `uses`, unless NULL, gets all names of the file; its memory is that of `kept`.
 */
void names_check(const Syntax *file, const NameScope *scope, Diags *diags, Arena *arena,
                 NameUses *uses, Arena *kept);

#endif
