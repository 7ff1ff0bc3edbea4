/*
 * search_pairs.h: random numbers, what a point alone refutes, and pairs of points.
 */
#ifndef KRS_SEARCH_PAIRS_H
#define KRS_SEARCH_PAIRS_H

#include "compiler/refute/search_types.h"

/* Return a random number in [low, high), and a random whole number below `count`. */
double search_between(Search *s, double low, double high);
size_t search_index(Search *s, size_t count);

/* Returns a length of any order of magnitude from `least` sizes to one. */
double any_scale(Search *s, double least);
void   random_direction(Search *s, double direction[3]);
void   random_point(Search *s, double point[3]);

/* Tells whether nothing worse can be found than was. */
bool is_decided(const Search *s);
/* Returns the distance at a point; what one point alone refutes is noted at once. */
double distance_at(Search *s, double p[3]);

/* Returns the side at the point that was looked at last. */
static inline double side_now(const Search *s) { return s->values[s->side].v[0]; }

static inline bool are_sides_different(double a, double b) { return (a > 0) != (b > 0); }

/* Looks at both points of a pair, and weighs it. */
void judge_pair(Search *s, PointPair *pair);
/* Replaces a pair by the half that is steeper, or for sides that differ by the one with the
   surface; false: too near. */
bool halve_pair(Search *s, PointPair *pair);
/* Brings q as near to p as the other side is, along the segment. */
void tighten_pair(Search *s, PointPair *pair);
/* Marches from p until the side changes, at most `farthest`; then the pair is tightened. */
bool reach_surface(Search *s, PointPair *pair, const double direction[3], double farthest);
/* Finds the unit gradient of the distance by differences; false: it is flat. */
bool gradient_at(Search *s, const double p[3], double gradient[3]);

#endif
