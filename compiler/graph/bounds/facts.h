/*
 * facts.h: ranges and slopes of expressions over a box.
 *
 * A slope (Lipschitz constant) is what the tracer divides by; it must be safe, never tight at
 * any price: rounding goes outwards and an unbounded factor makes an unbounded slope.  Two
 * engines run side by side and the smaller result counts: a calculus of norms (sum, product
 * and chain rules on slopes) and intervals of the gradient (math.md, section 4).
 */
#ifndef KRS_FACTS_H
#define KRS_FACTS_H

#include "compiler/graph/evaluate.h"
#include "compiler/graph/range.h"

typedef struct Fact {
    Range  value[4];       /* per component */
    Range  gradient[4][3]; /* per component, d/dx d/dy d/dz of the point */
    double slope;          /* Lipschitz constant with respect to the point, Euclidean norms */
} Fact;

/* Returns a fact per node of the graph for points in the box and parameters in their ranges (or,
   where `parameters` is given, at these very values: NodeValue-like rows of 4 doubles per slot). */
Fact *graph_facts(const Graph *graph, Box box, const double (*parameters)[4], Arena *arena);

/* frame_ranges.c: range of a component of a node that does not depend on the point, over the ranges
   of the parameters. */
Range graph_frame_range(const Graph *graph, Node node, uint32_t component, Arena *scratch);

/* Returns the slope of `root` over a box, refined by cutting the box into at most `cells` cells;
   inf when there is no bound.  `*blame` (may be NULL) is the node whose slope first became infinite
   or contributes most. */
double graph_slope(const Graph *graph, Node root, Box box, const double (*parameters)[4],
                   uint32_t cells, Node *blame, Arena *scratch);

/* The slope of one expression, to be found again and again, for other values of the parameters. */
typedef struct SlopeTask {
    Tape     tape;
    Node     root;
    Box      box;
    uint32_t cells;
} SlopeTask;

/* The tape is in the arena; the graph must live as long. */
SlopeTask slope_task(const Graph *graph, Node root, Box box, uint32_t cells, Arena *arena);
/* Returns the bytes that a task needs to be run, aligned as doubles. */
size_t slope_task_size(const SlopeTask *task);
/* Finds the slope as graph_slope does. */
double slope_task_run(const SlopeTask *task, const double (*parameters)[4], void *workspace,
                      Node *blame);

/* Ranges of some expressions, to be found over one box after the other. */
typedef struct RangeTask {
    Tape  tape;
    Fact *facts;
} RangeTask;

/* Makes a task, with its facts, in the arena; the graph must live as long. */
RangeTask range_task(const Graph *graph, const Node *roots, size_t count, Arena *arena);
/* Parameters have these very values from now on, as in graph_facts. */
void range_task_set(const RangeTask *task, const double (*parameters)[4]);
void range_task_run(const RangeTask *task, Box box);
/* These return the values of a FLOAT that a root needs, over the box of the last run, and how fast it changes there. */
Range  range_task_value(const RangeTask *task, Node node);
double range_task_slope(const RangeTask *task, Node node);

/* Returns the fact of one operation from the facts of its operands: the rule of its row. */
Fact op_fact(Op op, GraphType type, uint32_t index, const GraphType *types, const Fact *operands,
             const double *constant);

/* rules_space.c: the same of a node that reads a texture of the graph. */
Fact texture_fact_of(const Graph *graph, const Expr *e, const Fact *operands);

#endif
