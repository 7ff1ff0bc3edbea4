/*
 * fans.h: triangles around a vertex, before and after it is moved to another.
 */
#ifndef KRS_MESH_FANS_H
#define KRS_MESH_FANS_H

#include <stddef.h>
#include <stdint.h>

/* How far the triangles around `from` are from those that are left when it becomes `to`, one of its neighbours, at most; INFINITY:
   that is not found in this way. */
double fan_distance(const double (*at)[3], const uint32_t (*triangles)[3], const uint32_t *star,
                    size_t count, uint32_t from, uint32_t to);

#endif
