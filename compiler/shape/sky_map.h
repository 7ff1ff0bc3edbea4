/*
 * sky_map.h: versions of skies that are pictures of all directions.
 */
#ifndef KRS_SKY_MAP_H
#define KRS_SKY_MAP_H

#include "krs/krs.h"

/* Of texels whose map is complete but for its version. */
uint64_t sky_map_version(const KrsSkyMap *map);

#endif
