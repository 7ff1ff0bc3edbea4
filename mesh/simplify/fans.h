/*
 * fans.h: compares the triangles around a vertex before and after it moves to another.
 */
#ifndef KRS_MESH_FANS_H
#define KRS_MESH_FANS_H

#include <stddef.h>
#include <stdint.h>

/* Bounds how far the triangles around `from` are from those that are left when it becomes `to`, one
   of its neighbours; returns INFINITY where the fans have no common projection. */
double fan_distance(const double (*at)[3], const uint32_t (*triangles)[3], const uint32_t *star,
                    size_t count, uint32_t from, uint32_t to);

#endif
