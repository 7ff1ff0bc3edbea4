/*
 * refute_report.h: what is said of a distance or a claim that was refuted.
 */
#ifndef KRS_REFUTE_REPORT_H
#define KRS_REFUTE_REPORT_H

#include "compiler/refute/refuter.h"

/* Reports the distance of a shape: `whole` found it to be wrong, and `finding` refutes it. */
void report_finding(Refuter *r, const Finding *whole, const Finding *finding);
/* Reports that a claim beside the distance is refuted. */
void report_claim(Refuter *r, const Finding *finding);

#endif
