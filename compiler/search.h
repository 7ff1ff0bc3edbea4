/*
 * search.h: a directed search for points that refute a distance.
 *
 * What a distance d claims: it is a number everywhere, solid only in its box, never longer than the
 * way to its surface, and, where something may move that surface, 1-Lipschitz.  Each of these is
 * refuted by one point or by two, which are looked for where claims break: near the surface, at the
 * corners and edges of the box, and where an operation of the graph branches, jumps, has its pole
 * or is steepest.  From the best finds a local search climbs on.
 *
 * The search is deterministic: its budget is counted in operations, not in time.
 */
#ifndef KRS_SEARCH_H
#define KRS_SEARCH_H

#include "compiler/shape/box.h"
#include "compiler/graph/evaluate.h"

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

/* Where an operation is worth looking at. */
typedef struct Target Target;
/* A bound by a box, and what may be left out because of it. */
typedef struct Guard Guard;

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
    } landmarks; /* points that the frame knows */
} Search;

/* A search for `distance`, whose tape and lists are in the arena; everything else is set by the
   caller before search_start: box, steep, figure, random, aimed.  False: nothing to look at. */
bool search_new(Search *search, const Graph *graph, Node distance, Node side, Box box,
                Arena *arena);
/* The same for a point at which two numbers are both above 0. */
bool search_new_claim(Search *search, Graph *graph, Node a, Node b, Box box, Arena *arena);
/* Takes on the values of parameters; false when something in the graph is then not finite. */
bool search_start(Search *search, const NodeValue *parameters);
/* Looks on until so many more operations have been spent. */
void search_run(Search *search, uint64_t operations);
/* Makes the most of a pair that others found. */
void search_from(Search *search, const double p[3], const double q[3], uint64_t operations);
/* Whether `worst` is more than rounding. */
bool search_refuted(const Search *search);
/* A point of the surface that is nearer to p than the distance at p: false when none is found. */
bool search_surface(Search *search, const double p[3], double surface[3]);

/* In [0, 1); splitmix64, the same on every machine. */
double random_unit(uint64_t *state);

#endif
