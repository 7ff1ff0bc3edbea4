/*
 * sky_map.h: a sky that is a picture of all directions: longitude from left to right, latitude from
 * top to bottom.  Its middle is the direction -z, and y is up.
 */
#ifndef KRS_SKY_MAP_H
#define KRS_SKY_MAP_H

#include <stdint.h>

typedef struct KrsSkyMap {
    uint32_t width, height;
    uint64_t version;         /* others have another one, unless they are equal */
    const float (*texels)[3]; /* radiance, linear and not negative; rows from the top */
} KrsSkyMap;

/* Of texels whose map is complete but for its version. */
uint64_t sky_map_version(const KrsSkyMap *map);

#endif
