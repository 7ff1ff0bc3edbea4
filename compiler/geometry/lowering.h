/*
 * lowering.h: what the files of the lowering share.  lower.c walks through a tree of shapes; the
 * others have one family of shapes each, and lower_surface.c and lower_normal.c what a hit needs
 * to know of them.
 */
#ifndef KRS_LOWERING_H
#define KRS_LOWERING_H

#include "compiler/geometry/lower.h"

/* What a hit needs; NODE_NONE in `color`: not painted yet.  `normal` is in the space of the shape
   that was lowered; it need not be a unit vector (unit_normal). */
typedef struct Surface {
    Node color, roughness, metallic, emission, level, instance, uv, normal, trap;
} Surface;

typedef struct Lowered {
    Node    distance; /* NODE_NONE: the empty set */
    Surface surface;
} Lowered;

/* A shape that was lowered on the way: where, and its distance there. */
typedef struct Visit {
    const struct Shape *shape;
    Node                point, distance; /* `distance` may be NODE_NONE */
} Visit;
typedef struct Visits {
    Visit *items;
    size_t count, capacity;
} Visits;

typedef struct Nodes {
    Node  *items;
    size_t count, capacity;
} Nodes;

typedef struct Lowering {
    Graph      *graph;
    Arena      *scratch;
    bool        surfaces; /* else the distance alone */
    AlongMethod method;   /* of lower_along.c */
    bool        thin;     /* rays pass all that is around: sheets have no thickness */
    bool        guarded;  /* what is far is left out (guards.c) */
    Node        unit;     /* guarded: how long 1 is outside of everything */
    size_t      most;     /* nodes that the graph may have */
    bool        overflow;
    Nodes      *still;  /* NULL, or, of lower_gradient, what counts as constant */
    Visits     *visits; /* NULL, or what takes down every shape that is met, parts first */
} Lowering;

/* Where a shape stands: the mapped point, and the sequence around it.  `lipschitz` says that
   something above (a blend, an offset) moves the zero set and so needs the slope.  With surfaces
   also the normal of the surface and the radius of a pixel, in the shape's space. */
typedef struct Place {
    Node point, level, instance; /* level, instance: NODE_NONE outside of sequences */
    bool lipschitz;
    Node normal, footprint;
    Node smoothing; /* the width over which normals change sides of a mirror; NODE_NONE: at once */
} Place;

/* A place outside of everything, of a lowering without surfaces. */
Place place_bare(Node point, bool lipschitz);

extern const Lowered lowered_nothing;

/* The same place at another point; below something that needs the slope. */
Place place_at(Place place, Node point);
Place place_steady(Place place);

/* ---- lower_normal.c ---- */
/* One map of space, or a kernel that joins what is further in, from outside inwards. */
typedef struct NormalStep {
    enum { NORMAL_MIRROR, NORMAL_TURN, NORMAL_STRETCH, NORMAL_KERNEL } kind;
    Node axis, share;    /* MIRROR: unit; how much of it, on the way out */
    Node rows[3];        /* TURN; [0] of STRETCH: factors */
    Node normal, nearer; /* KERNEL: of its surface; that it is nearer than all further out */
} NormalStep;

/* The way of a normal from a place inwards; does nothing in a lowering without surfaces. */
typedef struct NormalPath {
    Place       innermost; /* normal, footprint and smoothing behind the steps so far */
    NormalStep *steps;
    uint32_t    count;
} NormalPath;

/* `most`: steps that will be taken. */
NormalPath normal_path(Lowering *l, Place place, uint32_t most);
/* Before x -> stretch * rows * x + shift. */
void normal_turn(Lowering *l, NormalPath *path, const Node rows[3], Node stretch);
/* Before a turn about y that brings `inner` to where `outer` is. */
void normal_turn_about_y(Lowering *l, NormalPath *path, Node outer, Node inner);
/* Before x -> factors * x, element by element; `least` of them. */
void normal_stretch(Lowering *l, NormalPath *path, Node factors, Node least);
/* Before a reflection along a unit vector that depends on the point. */
void normal_flip(Lowering *l, NormalPath *path, Node axis);
/* OP_fold at the point; mirrors are where smoothing is. */
void normal_fold(Lowering *l, NormalPath *path, Node point, Node axis, Node offset);
/* A kernel was lowered here; `outer` is all that was joined before. */
void normal_kernel(Lowering *l, NormalPath *path, Lowered outer, Lowered kernel);
/* The normal in the space where the path began, of what was lowered behind it: of its kernels, or
   `inner` where there is none. */
Node normal_out(Lowering *l, const NormalPath *path, Node inner);
/* The place behind the steps, at a point there. */
Place place_behind(const NormalPath *path, Place place, Node point);
/* A unit vector; `otherwise` where nothing is left of the normal. */
Node unit_normal(Graph *g, Node normal, Node otherwise);

/* ---- lower.c ---- */
/* Whether rays that go from root to root of what is in a shape are rays to the shape. */
bool    rays_pass(const Shape *shape);
Lowered lower_shape(Lowering *l, const Shape *shape, Place place);

/* ---- lower_primitive.c ---- */
Lowered lower_primitive(Lowering *l, const Shape *shape, Place place);

/* ---- lower_surface.c ---- */
/* The one where the condition holds, the other elsewhere. */
Surface choose_surface(Graph *g, Node condition, Surface a, Surface b);
/* `weight` 1 is a; what cannot be mixed is taken from a where `nearer`. */
Surface mix_surface(Graph *g, Node nearer, Node weight, Surface a, Surface b);
Lowered lower_paint(Lowering *l, const Shape *shape, Place place);

/* ---- lower_csg.c ---- */
/* The union of two distances, sharp or blended. */
Lowered join_two(Lowering *l, Blend blend, Lowered a, Lowered b);
/* The place of what a joint holds: a blend moves the zero set. */
Place joint_place(const Shape *shape, Place place);
/* A shape whose distance is looked at where it is not 0: it is no less than that to the sides of the
   shape's box. */
Lowered lower_operand(Lowering *l, const Shape *shape, Place place);
Lowered lower_union(Lowering *l, const Shape *shape, Place place);
Lowered lower_intersection(Lowering *l, const Shape *shape, Place place);
Lowered lower_difference(Lowering *l, const Shape *shape, Place place);
Lowered lower_xor(Lowering *l, const Shape *shape, Place place);
Lowered lower_morph(Lowering *l, const Shape *shape, Place place);

/* ---- lower_place.c ---- */
/* The same as lower_shape behind maps that have been taken down, at a point there. */
Lowered lower_behind(Lowering *l, const Shape *child, Place place, const NormalPath *path,
                     Node point);
/* R^T (point - shift) / scale: where the point was before the map. */
Node    before_map(Graph *g, const Map *map, Node point);
Lowered scale_distance(Lowering *l, Lowered result, Node factor);
/* Takes up the unit behind a map that enlarges; returns the one to go back to. */
Node    enter_scale(Lowering *l, Node scale);
Lowered lower_transform(Lowering *l, const Shape *shape, Place place);
Lowered lower_stretch(Lowering *l, const Shape *shape, Place place);
Lowered lower_mirror(Lowering *l, const Shape *shape, Place place);
Lowered lower_smooth(Lowering *l, const Shape *shape, Place place);
Lowered lower_elongate(Lowering *l, const Shape *shape, Place place);

/* ---- lower_figure.c ---- */
Lowered lower_extrude(Lowering *l, const Shape *shape, Place place);
Lowered lower_revolve(Lowering *l, const Shape *shape, Place place);

/* ---- lower_offset.c ---- */
Lowered lower_offset(Lowering *l, const Shape *shape, Place place);
Lowered lower_shell(Lowering *l, const Shape *shape, Place place);

/* ---- lower_moebius.c ---- */
/* How far a walk through maps has come, from outside inwards.  An empty ball of radius d around
   the point behind them is one of radius d * scale around the point outside or, once a map has
   inverted, d / (shrink + bend * |d|). */
typedef struct Passage {
    Node point, scale;
    Node shrink, bend; /* NODE_NONE: nothing has inverted yet */
} Passage;

/* An inversion on the way inwards, at a point. */
typedef struct Inversion {
    Node way, axis; /* from where it takes infinity to the point, and its direction, */
    Node inverse;   /* and 1 by its length; */
    Node sigma;     /* how much larger things become */
} Inversion;

Inversion inversion_at(Graph *g, const Map *map, Node point);
/* A direction behind a map, but not reflected in the inversion. */
Node turn_behind(Graph *g, const Map *map, Node way);

Passage passage_new(Graph *g, Node point);
/* Behind a map without `first`; normals take at most two steps. */
void passage_map(Lowering *l, Passage *passage, const Map *map, NormalPath *path);
/* What was lowered behind the maps, as distances outside. */
Lowered passage_out(Lowering *l, const Passage *passage, Lowered result);
/* As enter_scale, behind all of the maps. */
Node enter_passage(Lowering *l, const Passage *passage);

/* Of what lies in a ball before the map that is next on the way inwards, seen from outside of
   everything: the distance to it is at least this; NODE_NONE: nothing is known.  The ball becomes
   the one, a little larger, whose image this is the distance to. */
Node passage_hull(Lowering *l, const Passage *passage, const Map *map, Ball *ball);

/* The hulls that a walk through a sequence has come through.  Another one is worth its price where
   the pole may be within those so far, as seen from outside; otherwise they are far from the pole,
   and bound there what the next one would. */
typedef struct Hulls {
    Node distance; /* to all of them: the largest; NODE_NONE: there are none */
    Ball within;   /* where the point is unless that is above 0; infinite: anywhere */
} Hulls;

void hulls_fold(Lowering *l, Hulls *hulls, Node normal, Node offset);
/* Before passage_map.  `ball`: around what the map is applied to.  Whether there is one more. */
bool hulls_map(Lowering *l, Hulls *hulls, const Passage *passage, const Map *map, Ball ball);
/* Of two distances, each of which may be NODE_NONE. */
Node    nearer_of(Graph *g, Node a, Node b);
Node    farther_of(Graph *g, Node a, Node b);
Lowered lower_inversion(Lowering *l, const Shape *shape, Place place);

/* ---- lower_images.c ---- */
/* lower_along by ALONG_DIRECTIONAL or ALONG_PROBE. */
Node lower_image(Graph *graph, const Shape *shape, Node plain, AlongMethod method, Arena *scratch);

/* ---- lower_guards.c ---- */
/* A place between two stages of a sequence where what is left may be left out. */
typedef struct Stop {
    const LevelBound *bound; /* around all that is left */
    Passage           passage;
    Node              so_far; /* the distance by the stages after; NODE_NONE: of nothing */
} Stop;

/* Whether there is to be one before a stage. */
bool may_stop(const Lowering *l, const Shape *krs, uint32_t stage, Place place);
/* The distance of a sequence which is `whole` when nothing is left out; stops from the outermost
   to the innermost. */
Node guard_stops(Lowering *l, const Stop *stops, uint32_t count, Node whole);

/* ---- lower_deform.c ---- */
Lowered lower_twist(Lowering *l, const Shape *shape, Place place);
Lowered lower_bend(Lowering *l, const Shape *shape, Place place);
Lowered lower_taper(Lowering *l, const Shape *shape, Place place);
Lowered lower_displace(Lowering *l, const Shape *shape, Place place);

/* ---- meta.c ---- */
Lowered lower_meta(Lowering *l, const Shape *shape, Place place);

/* ---- lower_repeat.c ---- */
Lowered lower_repeat(Lowering *l, const Shape *shape, Place place);
Lowered lower_repeat_polar(Lowering *l, const Shape *shape, Place place);

/* ---- lower_krs.c ---- */
Lowered lower_krs(Lowering *l, const Shape *shape, Place place);

#endif
