/*
 * map.h: conformal maps of space, whose numbers may change from frame to frame.
 */
#ifndef KRS_MAP_H
#define KRS_MAP_H

#include "compiler/shape/builder.h"
#include "compiler/shape/cover.h"

Map       *map_new(ShapeBuilder *builder); /* the identity, to be changed */
const Map *map_identity(ShapeBuilder *builder);
const Map *map_translation(ShapeBuilder *builder, Node shift);
/* Scales by a number above 0. */
const Map *map_scaling(ShapeBuilder *builder, Node scale);
/* These rotate by an angle in radians about an axis of any length but 0, and from a direction to
   another. */
const Map *map_rotation(ShapeBuilder *builder, Node axis, Node angle);
const Map *map_alignment(ShapeBuilder *builder, Node from, Node to);
/* Mirrors in the plane of a unit normal and an offset. */
const Map *map_reflection(ShapeBuilder *builder, Node normal, Node offset);
/* Returns f(g(x)). */
const Map *map_product(ShapeBuilder *builder, const Map *f, const Map *g);
const Map *map_inverse(ShapeBuilder *builder, const Map *f);
Node       map_rotate(ShapeBuilder *builder, const Map *f, Node vector); /* rows times vector */
Node       map_apply(ShapeBuilder *builder, const Map *f, Node point);   /* without `first` */
void       rotate_product(ShapeBuilder *builder, const Node a[3], const Node b[3], Node product[3]);
/* Return a map's ranges for all values of the parameters, without `first`; and the box around the
   image of a box under a similarity. */
MapRange map_range(ShapeBuilder *builder, const Map *f);
Box      map_box(ShapeBuilder *builder, const Map *f, Box box);

/* ---- moebius.c: maps of frame time that invert ---- */
/* Inverts in the sphere about `center`; the radius is not 0. */
const Map *map_inversion(ShapeBuilder *builder, Node center, Node radius);
/* Returns (a q + b) (c q + d)^-1 for the quaternions a, b, c, d; NULL when that does not map space
   to space, with *reason set. */
const Map *map_of_matrix(ShapeBuilder *builder, const double entries[4][4], const char **reason);
/* Returns f(g(x)) of two maps, not both similarities, without their `first`; NULL: they stay two. */
const Map *moebius_product(ShapeBuilder *builder, const Map *f, const Map *g);
const Map *inversion_inverse(ShapeBuilder *builder, const Map *f);

/* Finds the rows of the inverse of a rotation. */
void transpose_rows(Graph *graph, const Node rows[3], Node transposed[3]);

#endif
