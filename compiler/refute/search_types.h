/*
 * search_types.h: what the files of the search share: a search and its lists, pairs of points, and
 * what was found.
 */
#ifndef KRS_SEARCH_TYPES_H
#define KRS_SEARCH_TYPES_H

#include "compiler/base/far.h"
#include "compiler/graph/evaluate.h"
#include "compiler/shape/box.h"

typedef enum Fault {
    FAULT_NONE,
    FAULT_STEEP,   /* distances at p and q differ by more than p and q are apart */
    FAULT_LONG,    /* the distance at p is longer than the way to q, on the other side */
    FAULT_OUTSIDE, /* p is within the solid, and not in the box */
    FAULT_NAN,     /* the distance at p is not a number */
    FAULT_CLAIM,   /* two numbers are both above 0 at p, and claimed never to be */
    /* Found without a search: */
    FAULT_CONSTANT, /* something that is the same at all points is not finite */
    FAULT_BOX       /* a side of the box is not a number */
} Fault;

/* A pair of points; the faultier it is, the larger the ratio. */
typedef struct Witness {
    Fault  fault;
    double ratio; /* above 1: refuted (STEEP, LONG) */
    double p[3], q[3], at_p, at_q;
} Witness;

/* The places, on the way from smooth to steep, at which an expression is looked at. */
typedef enum Goal {
    GOAL_EQUAL, /* a = b */
    GOAL_ZERO,  /* a = 0 */
    GOAL_WHOLE, /* a is a whole number */
    GOAL_HALF,  /* a is halfway between two */
    GOAL_UNIT,  /* |a| = 1 */
    GOAL_HIGH,  /* a is largest */
    GOAL_FRONT, /* a lies in the plane of unit normal b and offset c */
    GOAL_WALL   /* a lies between two cells of period b */
} Goal;

/* A place where an operation is worth looking at. */
typedef struct Target {
    Goal     goal;
    Node     a, b, c;
    uint32_t component;
} Target;

/* A bound by a box, and what may be left out because of it. */
typedef struct Guard {
    Target bound, rest;
} Guard;

typedef struct Search {
    Tape     tape;
    Node     distance; /* FLOAT */
    Node     side;     /* FLOAT: which side of the surface a point is on; `distance`, or another
                            one where that is a step from a guard or along a ray */
    Box      box;      /* claimed; may be infinite */
    bool     steep;    /* FAULT_STEEP is looked for, else FAULT_LONG */
    bool     figure;   /* z stays 0 */
    bool     claim;    /* `distance` is the lesser of two numbers that are nowhere above 0 both */
    bool     aimed;    /* the distance is that along a ray, OP_DIRECTION */
    double   aim[3];   /* then: the ray's direction */
    uint64_t random;   /* state of the generator */
    uint64_t spent;    /* operations so far */
    uint64_t cost;     /* of one evaluation */
    uint64_t evaluations;
    Witness  worst; /* largest ratio, or what is refuted without one */

    NodeValue *values;
    Box        around; /* finite: where points are taken */
    double     size;   /* its diagonal */
    struct {
        Target *items;
        size_t  count, capacity;
    } targets;
    struct {
        Guard *items;
        size_t count, capacity;
    } guards;
    struct {
        Node  *items;
        size_t count, capacity;
    } landmarks; /* points that the state knows */
} Search;

/* Pairs nearer than this, in sizes, say more about rounding than about the distance. */
#define NEAREST 1e-6
/* Longer distances are those to the empty set. */
#define LONGEST (0.1 * NOWHERE)

typedef struct PointPair {
    double p[3], q[3], at_p, at_q, side_p, side_q, ratio;
} PointPair;

#endif
