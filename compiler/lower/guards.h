/*
 * guards.h: levels of sequences that may be left out.
 */
#ifndef KRS_GUARDS_H
#define KRS_GUARDS_H

#include "compiler/lower/map_chain.h"

/* A point between two stages of a sequence where a guard may skip the remaining stages. */
typedef struct GuardSite {
    const LevelBound *bound; /* around all that the remaining stages make */
    MapChain          chain;
    Node              so_far; /* the distance by the stages after; NODE_NONE: of nothing */
} GuardSite;

/* Whether a guard goes before a stage. */
bool may_guard(const Lowering *l, const Shape *krs, uint32_t stage, LowerContext context);
/* The distance of a sequence, which is `whole` when nothing is left out; sites from the outermost
   to the innermost. */
Node guard_at_sites(Lowering *l, const GuardSite *guard_sites, uint32_t count, Node whole);

#endif
