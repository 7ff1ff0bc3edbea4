/*
 * map_chain.h: points and distances through chains of conformal maps.
 */
#ifndef KRS_MAP_CHAIN_H
#define KRS_MAP_CHAIN_H

#include "compiler/lower/normal.h"
#include "compiler/shape/map.h"

/* Returns the inverse of a map that is a similarity: R^T (point - shift) / scale. */
Node before_map(Graph *g, const Map *map, Node point);

/* The maps passed so far, from outside inwards, and the point behind them.  Let a ball of radius d
   around this point be empty.  Then a ball around the point outside is empty, too.  Its radius is
   d * scale or, if a map inverts, d / (shrink + bend * |d|). */
typedef struct MapChain {
    Node point, scale;
    Node shrink, bend; /* NODE_NONE: no map so far inverts */
} MapChain;

/* The inverse of an inversion at a point. */
typedef struct Inversion {
    Node offset, axis; /* from the pole of the inverse to the point; its direction */
    Node inverse;      /* 1 / length of the offset */
    Node sigma;        /* the factor by which lengths grow at the point */
} Inversion;

Inversion inversion_at(Graph *g, const Map *map, Node point);
/* Rotates a direction as the inverse of a map does; the reflection of an inversion is left out. */
Node rotate_behind(Graph *g, const Map *map, Node direction);

MapChain map_chain_new(Graph *g, Node point);
/* Appends a map without `first`, and its at most two steps to the path of the normal. */
void map_chain_append(Lowering *l, MapChain *chain, const Map *map, NormalPath *path);
/* Converts distances behind all maps into distances outside. */
Lowered map_chain_out(Lowering *l, const MapChain *chain, Lowered result);
/* Enters the scales of all maps of the chain (enter_scale). */
Node enter_map_chain(Lowering *l, const MapChain *chain);

/* Returns a bound, outside of all maps, for the distance to the image of a ball.  `map` is the next
   map inwards, and the ball contains what it is applied to.  NODE_NONE where there is no bound.
   `*ball` becomes the slightly larger ball to whose image the result is the distance. */
Node map_chain_hull(Lowering *l, const MapChain *chain, const Map *map, Ball *ball);

/* Bounds of a sequence near the poles of its maps: the hulls passed so far.  Another hull pays only
   where the pole of its map may lie within the hulls so far, as seen from outside.  Otherwise these
   are far from the pole, and are as good a bound there as the next one. */
typedef struct PoleBounds {
    Node distance; /* the largest distance to a hull; NODE_NONE: there are none */
    Ball within;   /* contains the point wherever `distance` is not above 0; may be infinite */
} PoleBounds;

void pole_bounds_fold(Lowering *l, PoleBounds *pole_bounds, Node normal, Node offset);
/* Adds a hull before map_chain_append, and tells whether it did.  `ball` contains what the map is
   applied to. */
bool pole_bounds_append(Lowering *l, PoleBounds *pole_bounds, const MapChain *chain, const Map *map,
                        Ball ball);
/* These return the smaller or larger of two distances, either of which may be NODE_NONE. */
Node nearer_of(Graph *g, Node a, Node b);
Node farther_of(Graph *g, Node a, Node b);

#endif
