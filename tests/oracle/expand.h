/*
 * expand.h: a kernel-reflection sequence written out copy by copy.
 *
 * The set of math.md, section 1: L_0 = K_0 and L_{i+1} = K_{i+1} u (L_i n H_i) u R_i(L_i n H_i),
 * H_i = {u_i.x <= w_i}.  Every kernel of level l stands in it 2^(n-l) times, each copy moved by
 * some of the mirrors l..n-1 and cut by all of them.  Kernels are convex, so a cut copy is a
 * convex set, and its distance is found by projecting onto it.
 */
#ifndef ORACLE_EXPAND_H
#define ORACLE_EXPAND_H

#include "tests/oracle/brute.h"

enum { EXPAND_MIRRORS = 12, EXPAND_BODIES = 32 };

/* All points no farther than `radius` from a segment or, where `box` says so, a box of these
   half sides around `from`, turned by `angle` about `axis`. */
typedef struct Body {
    bool   box;
    Vec    from, to, sides, axis;
    double angle, radius;
    int    level;
} Body;

typedef struct Sequence {
    Half mirrors[EXPAND_MIRRORS];
    int  mirror_count;
    Body bodies[EXPAND_BODIES];
    int  body_count;
} Sequence;

/* x -> rows x + shift, an isometry. */
typedef struct Isometry {
    Vec rows[3], shift;
} Isometry;
Vec isometry_apply(const Isometry *map, Vec point);

/* One copy of one kernel. */
typedef struct Copy {
    const Body *body;
    uint32_t    id;   /* 1 for the uncut original's level n, then as in a heap: math.md section 1 */
    Isometry    pull; /* from the world to the space in which the kernel was placed */
    Half        cuts[EXPAND_MIRRORS]; /* in the kernel's space */
    int         cut_count;
    Vec         middle;   /* in the world, a ball around all of it: what is beyond need not be */
    double      reach;    /* looked at */
    bool        empty;    /* nothing is left of it, as far as was found */
    Vec         interior; /* a point well inside, unless empty */
} Copy;

typedef struct Expansion {
    Copy  *copies;
    size_t count;
} Expansion;

Expansion expand(const Sequence *sequence);
void      expansion_free(Expansion *expansion);

bool expansion_contains(const Expansion *expansion, Vec point);
/* Distance from a point outside: exact where the nearest copy is reached at a point that no
   mirror cuts off (*sure), else from above and close.  HUGE_VAL for the empty set. */
double expansion_distance(const Expansion *expansion, Vec point, bool *sure);
/* Returns the parameter at which a ray, of unit direction, first enters; HUGE_VAL when it never
   does.  Bodies are spheres and boxes. */
double expansion_enter(const Expansion *expansion, Vec origin, Vec direction);

/* To one copy without its cuts, and whether the nearest point survives them. */
double copy_distance_uncut(const Copy *copy, Vec point, bool *survives);

#endif
