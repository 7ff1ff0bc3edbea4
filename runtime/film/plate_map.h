/*
 * plate_map.h: the plate of another renderer as rays of paths meet it.
 */
#ifndef KRS_PLATE_MAP_H
#define KRS_PLATE_MAP_H

#include "runtime/tracer/job.h"

/* Tells whether rays of a job's paths may meet the plate: it catches something, its depths and its colours
   are known, and its camera is no panorama. */
bool plate_map_exists(const Job *job);
/* Returns the rows of the map, of four numbers each (blocks.h). */
size_t plate_map_rows(const Job *job);
void   plate_map_make(const Job *job, uint32_t (*rows)[4]);

#endif
