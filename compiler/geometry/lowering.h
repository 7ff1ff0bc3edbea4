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

/* A shape that has been lowered, the point where, and its distance there. */
typedef struct LoweredShape {
    const struct Shape *shape;
    Node                point, distance; /* `distance` may be NODE_NONE */
} LoweredShape;
typedef struct LoweredShapes {
    LoweredShape *items;
    size_t        count, capacity;
} LoweredShapes;

typedef struct Nodes {
    Node  *items;
    size_t count, capacity;
} Nodes;

typedef struct Lowering {
    Graph         *graph;
    Arena         *scratch;
    bool           surfaces; /* else the distance alone */
    AlongMethod    method;   /* of lower_along.c */
    bool           thin;     /* rays pass all that is around: sheets have no thickness */
    bool           guarded;  /* what is far is left out (guards.c) */
    Node           unit;     /* guarded: how long 1 is outside of everything */
    size_t         most;     /* nodes that the graph may have */
    bool           overflow;
    Nodes         *held_constant;  /* for lower_gradient: nodes that count as constants; or NULL */
    LoweredShapes *lowered_shapes; /* NULL, or a list of all shapes, children first */
} Lowering;

/* Where a shape is lowered: the mapped point, and the sequence around it.  `lipschitz` says that
   something above (a blend, an offset) moves the zero set and so needs the slope.  With surfaces
   also the normal of the surface and the radius of a pixel, in the shape's space. */
typedef struct LowerContext {
    Node point, level, instance; /* level, instance: NODE_NONE outside of sequences */
    bool lipschitz;
    Node normal, footprint;
    Node smoothing; /* the width over which normals change sides of a mirror; NODE_NONE: at once */
} LowerContext;

/* Outside of all shapes, for a lowering without surfaces. */
LowerContext context_new(Node point, bool lipschitz);

extern const Lowered lowered_nothing;

/* The same context at another point; the same below something that needs the slope. */
LowerContext context_at(LowerContext context, Node point);
LowerContext context_lipschitz(LowerContext context);

/* ---- lower_normal.c ---- */
/* One map of space, or a kernel that joins what is further in, from outside inwards. */
typedef struct NormalStep {
    enum { NORMAL_MIRROR, NORMAL_TURN, NORMAL_STRETCH, NORMAL_KERNEL } kind;
    Node axis, amount;   /* MIRROR: unit; how much of it, on the way out */
    Node rows[3];        /* TURN; [0] of STRETCH: factors */
    Node normal, nearer; /* KERNEL: of its surface; that it is nearer than all further out */
} NormalStep;

/* The maps that a normal passes, from outside inwards; empty in a lowering without surfaces. */
typedef struct NormalPath {
    LowerContext innermost; /* normal, footprint and smoothing behind the steps so far */
    NormalStep  *steps;
    uint32_t     count;
} NormalPath;

/* `most`: steps that will be taken. */
NormalPath normal_path(Lowering *l, LowerContext context, uint32_t most);
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
/* The context behind the steps, at a point there. */
LowerContext context_behind(const NormalPath *path, LowerContext context, Node point);
/* A unit vector; `otherwise` where nothing is left of the normal. */
Node unit_normal(Graph *g, Node normal, Node otherwise);

/* ---- lower.c ---- */
/* Whether rays that go from root to root of what is in a shape are rays to the shape. */
bool    rays_pass(const Shape *shape);
Lowered lower_shape(Lowering *l, const Shape *shape, LowerContext context);

/* ---- lower_primitive.c ---- */
Lowered lower_primitive(Lowering *l, const Shape *shape, LowerContext context);

/* ---- lower_surface.c ---- */
/* The one where the condition holds, the other elsewhere. */
Surface choose_surface(Graph *g, Node condition, Surface a, Surface b);
/* `weight` 1 is a; what cannot be mixed is taken from a where `nearer`. */
Surface mix_surface(Graph *g, Node nearer, Node weight, Surface a, Surface b);
Lowered lower_paint(Lowering *l, const Shape *shape, LowerContext context);

/* ---- lower_csg.c ---- */
/* The union of two distances, sharp or blended. */
Lowered join_two(Lowering *l, Blend blend, Lowered a, Lowered b);
/* The context of what a joint holds: a blend moves the zero set. */
LowerContext joint_context(const Shape *shape, LowerContext context);
/* A shape whose distance is looked at where it is not 0: it is no less than that to the sides of the
   shape's box. */
Lowered lower_operand(Lowering *l, const Shape *shape, LowerContext context);
Lowered lower_union(Lowering *l, const Shape *shape, LowerContext context);
Lowered lower_intersection(Lowering *l, const Shape *shape, LowerContext context);
Lowered lower_difference(Lowering *l, const Shape *shape, LowerContext context);
Lowered lower_xor(Lowering *l, const Shape *shape, LowerContext context);
Lowered lower_morph(Lowering *l, const Shape *shape, LowerContext context);

/* ---- lower_place.c ---- */
/* The same as lower_shape behind maps that have been taken down, at a point there. */
Lowered lower_behind(Lowering *l, const Shape *child, LowerContext context, const NormalPath *path,
                     Node point);
/* R^T (point - shift) / scale: where the point was before the map. */
Node    before_map(Graph *g, const Map *map, Node point);
Lowered scale_distance(Lowering *l, Lowered result, Node factor);
/* Takes up the unit behind a map that enlarges; returns the one to go back to. */
Node    enter_scale(Lowering *l, Node scale);
Lowered lower_transform(Lowering *l, const Shape *shape, LowerContext context);
Lowered lower_stretch(Lowering *l, const Shape *shape, LowerContext context);
Lowered lower_mirror(Lowering *l, const Shape *shape, LowerContext context);
Lowered lower_smooth(Lowering *l, const Shape *shape, LowerContext context);
Lowered lower_elongate(Lowering *l, const Shape *shape, LowerContext context);

/* ---- lower_figure.c ---- */
Lowered lower_extrude(Lowering *l, const Shape *shape, LowerContext context);
Lowered lower_revolve(Lowering *l, const Shape *shape, LowerContext context);

/* ---- lower_offset.c ---- */
Lowered lower_offset(Lowering *l, const Shape *shape, LowerContext context);
Lowered lower_shell(Lowering *l, const Shape *shape, LowerContext context);

/* ---- lower_moebius.c ---- */
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
Node    nearer_of(Graph *g, Node a, Node b);
Node    farther_of(Graph *g, Node a, Node b);
Lowered lower_inversion(Lowering *l, const Shape *shape, LowerContext context);

/* ---- lower_images.c ---- */
/* lower_along by ALONG_DIRECTIONAL or ALONG_PROBE. */
Node lower_image(Graph *graph, const Shape *shape, Node plain, AlongMethod method, Arena *scratch);

/* ---- lower_guards.c ---- */
/* A point between two stages of a sequence where a guard may skip the remaining stages. */
typedef struct GuardSite {
    const LevelBound *bound; /* around all that the remaining stages make */
    MapChain          chain;
    Node              so_far; /* the distance by the stages after; NODE_NONE: of nothing */
} GuardSite;

/* Whether a guard goes before a stage. */
bool may_guard(const Lowering *l, const Shape *krs, uint32_t stage, LowerContext context);
/* The distance of a sequence, which is `whole` when nothing is left out; sites from the outermost
   to the innermost. */
Node guard_at_sites(Lowering *l, const GuardSite *guard_sites, uint32_t count, Node whole);

/* ---- lower_deform.c ---- */
Lowered lower_twist(Lowering *l, const Shape *shape, LowerContext context);
Lowered lower_bend(Lowering *l, const Shape *shape, LowerContext context);
Lowered lower_taper(Lowering *l, const Shape *shape, LowerContext context);
Lowered lower_displace(Lowering *l, const Shape *shape, LowerContext context);

/* ---- metasurface.c ---- */
Lowered lower_meta(Lowering *l, const Shape *shape, LowerContext context);

/* ---- lower_repeat.c ---- */
Lowered lower_repeat(Lowering *l, const Shape *shape, LowerContext context);
Lowered lower_repeat_polar(Lowering *l, const Shape *shape, LowerContext context);

/* ---- lower_krs.c ---- */
Lowered lower_krs(Lowering *l, const Shape *shape, LowerContext context);

#endif
