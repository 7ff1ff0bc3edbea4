/*
 * search_starts.h: where a search begins.
 */
#ifndef KRS_SEARCH_STARTS_H
#define KRS_SEARCH_STARTS_H

#include "compiler/refute/search_types.h"

/* Returns the best of pairs at a place of a random kind. */
PointPair best_pair(Search *s);
/* Returns a point of what a guard may leave out, and one where the guard decides: a way too long
   for the bound if the first is not in the box. */
PointPair best_past_guard(Search *s);

#endif
