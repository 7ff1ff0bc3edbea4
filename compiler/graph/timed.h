/*
 * timed.h: what depends on the time.
 */
#ifndef KRS_TIMED_H
#define KRS_TIMED_H

#include "compiler/graph/graph.h"

/* Marks each node of a graph that depends on the time, also through numbers and places of tables. */
void graph_mark_timed(const Graph *graph, bool *timed);

#endif
