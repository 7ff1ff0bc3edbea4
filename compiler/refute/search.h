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

#include "compiler/refute/search_types.h"

/* Makes a search for `distance`, whose tape and lists are in the arena; everything else is set by
   the caller before search_start: box, steep, figure, random, aimed.  False: there is nothing to
   look at. */
bool search_new(Search *search, const Graph *graph, Node distance, Node side, Box box,
                Arena *arena);
/* Does the same for a point at which two numbers are both above 0. */
bool search_new_claim(Search *search, Graph *graph, Node a, Node b, Box box, Arena *arena);
/* Takes on the values of parameters; false when something in the graph is then not finite. */
bool search_start(Search *search, const NodeValue *parameters);
/* Looks on until so many more operations have been spent. */
void search_run(Search *search, uint64_t operations);
/* Makes the most of a pair that others found. */
void search_from(Search *search, const double p[3], const double q[3], uint64_t operations);
/* Tells whether `worst` is more than rounding. */
bool search_refuted(const Search *search);
/* Finds a point of the surface that is nearer to p than the distance at p; false when none is
   found. */
bool search_surface(Search *search, const double p[3], double surface[3]);

#endif
