/*
 * searching.h: what the files of the search share: search.c climbs from the best starts,
 * search_pairs.c looks at pairs of points, search_targets.c leads to where operations break, and
 * search_starts.c chooses where to begin.
 */
#ifndef KRS_SEARCHING_H
#define KRS_SEARCHING_H

#include <math.h>

#include <string.h>

#include "compiler/base/vec.h"
#include "compiler/search.h"

/* Where on the way from smooth to steep an expression is looked at. */
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

struct Target {
    Goal     goal;
    Node     a, b, c;
    uint32_t component;
};

struct Guard {
    Target bound, rest;
};

/* Pairs nearer than this, in sizes, say more about rounding than about the distance. */
#define NEAREST 1e-6
/* What stands for the distance to nothing. */
#define NOWHERE 1e29

typedef struct PointPair {
    double p[3], q[3], at_p, at_q, side_p, side_q, ratio;
} PointPair;

/* ---- search_pairs.c ---- */

/* In [low, high), and a number below `count`. */
double search_between(Search *s, double low, double high);
size_t search_index(Search *s, size_t count);

/* A length of any order of magnitude from `least` sizes to one. */
double any_scale(Search *s, double least);
void   random_direction(Search *s, double direction[3]);
void   random_point(Search *s, double point[3]);

/* Whether nothing worse can be found than was. */
bool is_settled(const Search *s);
/* The distance at a point; what one point alone refutes is noted at once. */
double distance_at(Search *s, double p[3]);

/* At the point that was looked at last. */
static inline double side_now(const Search *s) { return s->values[s->side].v[0]; }

static inline bool are_sides_different(double a, double b) { return (a > 0) != (b > 0); }

/* Looks at both points of a pair, and weighs it. */
void judge_pair(Search *s, PointPair *pair);
/* The half that is steeper, or for sides that differ the one with the surface; false: too near. */
bool halve_pair(Search *s, PointPair *pair);
/* Brings q as near to p as the other side is, along the segment. */
void tighten_pair(Search *s, PointPair *pair);
/* Marches from p until the side changes, at most `farthest`; then the pair is tightened. */
bool reach_surface(Search *s, PointPair *pair, const double direction[3], double farthest);
/* Unit gradient of the distance by differences; false: flat. */
bool gradient_at(Search *s, const double p[3], double gradient[3]);

/* ---- search_targets.c ---- */

/* What is worth looking at in one operation. */
void   add_targets(Search *s, Arena *arena, const Graph *g, const Expr *e);
double target_at(Search *s, const Target *t, double p[3]);
/* The gradient of a target by differences, and its length; `at` is its value at p. */
double target_slope(Search *s, const Target *t, const double p[3], double at, double gradient[3]);
/* From p on to where a target is 0, by Newton's steps, and between two steps by halving. */
void drive_to_zero(Search *s, const Target *t, double p[3], double axis[3]);
/* Uphill from p, by steps that grow where they help. */
void drive_up(Search *s, const Target *t, double p[3], double axis[3]);

/* ---- search_starts.c ---- */

/* The best of pairs at a place of a random kind. */
PointPair best_pair(Search *s);
/* A point of what a guard may leave out, and one where the guard decides: a way too long for the
   bound if the first is not in the box. */
PointPair best_past_guard(Search *s);

#endif
