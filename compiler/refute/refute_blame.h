/*
 * refute_blame.h: which shape is to blame for a distance that was refuted.
 */
#ifndef KRS_REFUTE_BLAME_H
#define KRS_REFUTE_BLAME_H

#include "compiler/refute/refuter.h"

/* Goes from what was refuted to the smallest shape that is refuted too. */
void find_culprit(Refuter *r, Finding *finding);

#endif
