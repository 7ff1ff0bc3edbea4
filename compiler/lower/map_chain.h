/*
 * map_chain.h: points and distances through chains of conformal maps.
 */
#ifndef KRS_MAP_CHAIN_H
#define KRS_MAP_CHAIN_H

#include "compiler/lower/normal.h"
#include "compiler/shape/map.h"

/* R^T (point - shift) / scale: where the point was before the map. */
Node before_map(Graph *g, const Map *map, Node point);

/* The maps passed so far, from outside inwards.  An empty ball of radius d around
   the point behind them is one of radius d * scale around the point outside or, once a map has
   inverted, d / (shrink + bend * |d|). */
typedef struct MapChain {
    Node point, scale;
    Node shrink, bend; /* NODE_NONE: nothing has inverted yet */
} MapChain;

/* An inversion on the way inwards, at a point. */
typedef struct Inversion {
    Node offset, axis; /* from where it takes infinity to the point, and its direction, */
    Node inverse;      /* and 1 by its length; */
    Node sigma;        /* how much larger things become */
} Inversion;

Inversion inversion_at(Graph *g, const Map *map, Node point);
/* A direction behind a map, but not reflected in the inversion. */
Node turn_behind(Graph *g, const Map *map, Node direction);

MapChain map_chain_new(Graph *g, Node point);
/* Behind a map without `first`; normals take at most two steps. */
void map_chain_append(Lowering *l, MapChain *chain, const Map *map, NormalPath *path);
/* What was lowered behind the maps, as distances outside. */
Lowered map_chain_out(Lowering *l, const MapChain *chain, Lowered result);
/* As enter_scale, behind all of the maps. */
Node enter_map_chain(Lowering *l, const MapChain *chain);

/* Of what lies in a ball before the map that is next on the way inwards, seen from outside of
   everything: the distance to it is at least this; NODE_NONE: nothing is known.  The ball becomes
   the one, a little larger, whose image this is the distance to. */
Node map_chain_hull(Lowering *l, const MapChain *chain, const Map *map, Ball *ball);

/* Bounds of a sequence near the poles of its maps: the hulls passed so far.  Another hull is worth
   its price where the pole may be within those so far, as seen from outside; otherwise they are far
   from the pole, and bound there what the next one would. */
typedef struct PoleBounds {
    Node distance; /* to all of them: the largest; NODE_NONE: there are none */
    Ball within;   /* where the point is unless that is above 0; infinite: anywhere */
} PoleBounds;

void pole_bounds_fold(Lowering *l, PoleBounds *pole_bounds, Node normal, Node offset);
/* Before map_chain_append.  `ball`: around what the map is applied to.  Whether a hull was added. */
bool pole_bounds_append(Lowering *l, PoleBounds *pole_bounds, const MapChain *chain, const Map *map,
                        Ball ball);
/* Of two distances, each of which may be NODE_NONE. */
Node nearer_of(Graph *g, Node a, Node b);
Node farther_of(Graph *g, Node a, Node b);

#endif
