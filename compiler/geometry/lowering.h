/*
 * lowering.h: what the files of the lowering share: lower.c walks and joins, lower_repeat.c
 * has the copies in cells, lower_krs.c the sequences.
 */
#ifndef KRS_LOWERING_H
#define KRS_LOWERING_H

#include "compiler/geometry/lower.h"

/* What a hit needs; NODE_NONE in `color`: not painted yet. */
typedef struct Surface {
    Node color, roughness, metallic, emission, level, instance;
} Surface;

typedef struct Lowered {
    Node    distance; /* NODE_NONE: the empty set */
    Surface surface;
} Lowered;

typedef struct Lowering {
    Graph *graph;
    Arena *scratch;
    bool   surfaces; /* else the distance alone */
    size_t most;     /* nodes that the graph may have */
    bool   overflow;
} Lowering;

/* Where a shape stands: the mapped point, and the sequence around it.  `lipschitz` says that
   something above (a blend, an offset) moves the zero set and so needs the slope. */
typedef struct Place {
    Node point, level, instance; /* level, instance: NODE_NONE outside of sequences */
    bool lipschitz;
} Place;

extern const Lowered lowered_nothing;

/* The same place at another point; below something that needs the slope. */
Place place_at(Place place, Node point);
Place place_steady(Place place);

/* ---- lower.c ---- */
Lowered lower_shape(Lowering *l, const Shape *shape, Place place);
/* The union of two distances, sharp or blended. */
Lowered join_two(Lowering *l, Blend blend, Lowered a, Lowered b);
/* R^T (point - shift) / scale: where the point was before the map. */
Node before_map(Graph *g, const Similarity *map, Node point);
Lowered scale_distance(Lowering *l, Lowered result, Node factor);

/* ---- lower_repeat.c ---- */
Lowered lower_repeat(Lowering *l, const Shape *shape, Place place);
Lowered lower_repeat_polar(Lowering *l, const Shape *shape, Place place);

/* ---- lower_krs.c ---- */
Lowered lower_krs(Lowering *l, const Shape *shape, Place place);

#endif
