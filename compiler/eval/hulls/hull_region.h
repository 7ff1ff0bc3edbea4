/*
 * hull_region.h: a region that holds parts, and is their convex hull or little more.
 */
#ifndef KRS_HULL_REGION_H
#define KRS_HULL_REGION_H

#include "compiler/eval/hulls/extents.h"
#include "compiler/eval/hulls/fillet_zone.h"

/* Makes the hull as far as that matters in a zone; NULL: all of the zone is in it.  `many`: it is
   one of many, which had best be alike. */
const Shape *hull_region(Elaboration *e, const Call *call, const Extents *extents,
                         const FilletZone *zone, bool many);

#endif
