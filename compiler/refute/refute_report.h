/*
 * refute_report.h: what is said of a distance or a claim that was refuted.
 */
#ifndef KRS_REFUTE_REPORT_H
#define KRS_REFUTE_REPORT_H

#include "compiler/refute/refuter.h"

/* The distance of a shape, found to be wrong in `whole`, is refuted in `finding`. */
void report_finding(Refuter *r, const Finding *whole, const Finding *finding);
/* A claim beside the distance is. */
void report_claim(Refuter *r, const Finding *finding);

#endif
