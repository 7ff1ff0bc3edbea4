/*
 * guards.h: skips levels of sequences that are far away.
 */
#ifndef KRS_GUARDS_H
#define KRS_GUARDS_H

#include "compiler/lower/map_chain.h"

/* A point between two stages of a sequence where a guard may skip the remaining stages. */
typedef struct GuardSite {
    const LevelBound *bound; /* box and ball around what the remaining stages make */
    MapChain          chain; /* the maps passed before this site */
    Node so_far; /* distance to the kernels passed before it; NODE_NONE: there are none */
} GuardSite;

/* Tells whether a guard goes before a stage of the sequence `krs`. */
bool may_guard(const Lowering *l, const Shape *krs, uint32_t stage, LowerContext context);
/* Returns the distance to a sequence with guards at these sites, from the outermost to the
   innermost.  `whole` is the distance without guards. */
Node guard_at_sites(Lowering *l, const GuardSite *guard_sites, uint32_t count, Node whole);

#endif
