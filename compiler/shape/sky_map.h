/*
 * sky_map.h: versions of skies that are pictures of all directions.
 */
#ifndef KRS_SKY_MAP_H
#define KRS_SKY_MAP_H

#include "krs/krs.h"

/* Returns the version of texels whose map is complete but for that. */
uint64_t sky_map_version(const KrsSkyMap *map);

#endif
