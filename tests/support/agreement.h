/*
 * agreement.h: whether two pictures of a scene show the same: what two devices make of it, or two
 * ways to trace it.
 */
#ifndef SUPPORT_AGREEMENT_H
#define SUPPORT_AGREEMENT_H

#include <stdio.h>

#include "krs/vulkan.h"

/* Planes that are compared. */
enum { AGREEMENT_AOVS = KRS_AOV_DEPTH | KRS_AOV_IDS };

/* Pixels that differ, by what differs, each counted once, in this order.  A pixel at an outline,
   where the first picture shows something else beside it, may show either side. */
typedef struct Agreement {
    size_t pixels, solid; /* all, and those that show something in the first picture */
    size_t outline;       /* differ in any way, at an outline */
    size_t hits, components, levels, instances, depths; /* elsewhere */
    double deepest; /* difference of depths elsewhere, in widths of a pixel */
} Agreement;

/* Returns two pictures of one size and camera.  Depths may differ by `permitted` widths of a
   pixel. */
Agreement agreement_of(const KrsPicture *a, const KrsPicture *b, double permitted);
/* Pixels that differ away from outlines. */
size_t agreement_faults(const Agreement *agreement);

/* Returns the same, and pixels that differ are told to `report` in lines that begin with `prefix`,
   the first `most` of them: column, row, and both answers. */
Agreement agreement_list(const KrsPicture *a, const KrsPicture *b, double permitted, FILE *report,
                         const char *prefix, size_t most);

#endif
