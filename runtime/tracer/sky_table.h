/*
 * sky_table.h: a sky that is a picture, on a device, with means of it and sums to choose directions
 * by (blocks.h).
 */
#ifndef KRS_SKY_TABLE_H
#define KRS_SKY_TABLE_H

#include "runtime/tracer/handles.h"

/* Tells how many rows the table of a map has. */
size_t sky_table_rows(const KrsSkyMap *map);
/* Fills in such a table.  Returns the irradiance by half of the sky, on the average over all
   halves; negative: there is no memory. */
double sky_table_fill(const KrsSkyMap *map, float (*rows)[4]);

/* Brings a map to the device, unless it is there; NULL: there is none. */
bool sky_table_upload(KrsRendering *rendering, const KrsSkyMap *map);
/* Binds the table, or an idle one, in the scene's set. */
void sky_table_bind(KrsRendering *rendering);
/* Returns what sky_table_fill has returned for the map of the last upload; 0 without one. */
double sky_table_irradiance(const KrsRendering *rendering);

#endif
