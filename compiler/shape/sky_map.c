/*
 * sky_map.c: versions of maps: hashes (FNV-1a, word by word) of their sizes and texels.
 */
#include "compiler/shape/sky_map.h"

#include <stddef.h>
#include <string.h>

uint64_t sky_map_version(const KrsSkyMap *map)
{
    const size_t count = 3 * (size_t)map->width * map->height;
    const float *all   = &map->texels[0][0];
    uint64_t     hash  = 0xcbf29ce484222325 ^ ((uint64_t)map->width << 32 | map->height);
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &all[i], sizeof bits);
        hash = (hash ^ bits) * 0x100000001b3;
    }
    return hash;
}
