/*
 * iterations.h: numbers of the frame that depend on the iteration of a loop.
 *
 * A loop whose iterations differ in numbers only is evaluated once (eval/iterations.c).  Its variable is then a
 * leaf of frame time, a parameter that nobody sets.  What depends on it never gets into shaders: tables
 * have the numbers of all iterations.
 */
#ifndef KRS_ITERATIONS_H
#define KRS_ITERATIONS_H

#include "compiler/graph/evaluate.h"

/* Marks what depends on a leaf: depends[n - leaf] of the nodes n from the leaf on. */
void graph_mark_iterated(const Graph *graph, Node leaf, bool *depends);
/* Finds the components of roots, one root after the other, for each of these values of the leaf.
   The roots are of frame time, and need no parameter but the leaf. */
void graph_at_iterations(const Graph *graph, const Node *roots, size_t root_count, Node leaf,
                         const double *iterations, size_t iteration_count, double *results,
                         Arena *scratch);
/* Returns a root in one iteration.  Random numbers in it are numbers of the scene's text then,
   where that has some. */
Node graph_in_iteration(Graph *graph, Node root, Node leaf, double iteration, Arena *scratch);
/* Tells whether roots need a parameter but this leaf. */
bool graph_needs_parameters(const Graph *graph, const Node *roots, size_t root_count, Node leaf,
                            Arena *scratch);
/* Tells how many numbers that are for each iteration. */
size_t graph_numbers_of(const Graph *graph, const Node *roots, size_t root_count);

#endif
