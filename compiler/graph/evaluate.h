/*
 * evaluate.h: the graph in double precision.
 *
 * This is both a product (krs query, the library's distance calls) and the oracle that every
 * shader is held against.
 */
#ifndef KRS_EVALUATE_H
#define KRS_EVALUATE_H

#include "compiler/graph/graph.h"

/* A list of the nodes that a set of roots needs, in order, ready to be run many times. */
typedef struct Tape {
    const Graph    *graph;
    const Node     *nodes; /* all needed nodes, operands first */
    size_t          count;
    size_t          frame_count; /* the first frame_count of them are compile or frame time */
    const uint32_t *skips;       /* NULL, or how many to skip at each when it is a guard that leaves
                              something out */
    /* The tape of each instance function (instance_table.h) that is called, by its number: what it
       does at an instance.  What they need of the frame is on the tape that calls them.  Others are
       empty.  These tapes know each other as well, but count none as theirs. */
    const struct Tape *functions;
    uint32_t           function_count;
    /* Instance group functions have the list of one cell, as in shaders, so a distance is at most the cell's
       clearance.  Else all instances count that may be nearest. */
    bool by_cells;
    /* NULL, or what counts the operations that are run at points, those of functions included. */
    uint64_t *ran;
} Tape;

Tape tape_new(const Graph *graph, const Node *roots, size_t root_count, Arena *arena);

/* Returns the same, but what a guard leaves out is not run, and its values are then of no use.  A
   guard stands on it twice: before what it may leave out, and after. */
Tape tape_new_guarded(const Graph *graph, const Node *roots, size_t root_count, Arena *arena);

/* Tells whether something on it may differ from frame to frame. */
bool tape_needs_frame(const Tape *tape);
/* Tells how many nodes it has at points, those of functions that it calls included. */
size_t tape_operations(const Tape *tape);

/* Returns the multiply-adds of a tape at each point; what depends on the frame does not count. */
double tape_flops(const Tape *tape);
/* Returns the same of one of its nodes; of a call for a list of usual length. */
double tape_node_flops(const Tape *tape, Node node);
/* Returns about that of a tape on which instances of groups are parts by themselves, and rows
   constants. */
double tape_flops_separate(const Tape *tape);

/* Returns the iterations of the loops that its shaders have within operations and over instances of
   groups, at most. */
uint32_t tape_loops(const Tape *tape);

/* Returns where on the tape a node is that the roots need. */
size_t tape_index(const Tape *tape, Node node);

/* Tells whether a tape needs the value of a slot of the parameter block; ANY_SLOT: of any. */
#define ANY_SLOT UINT32_MAX
bool tape_depends_on(const Tape *tape, uint32_t slot);

/* Runs the part of a tape that does not depend on the point.  `values` has graph->count
   elements, indexed by node; parameters[slot] is the parameter block (slot 0: time). */
void tape_run_frame(const Tape *tape, const NodeValue *parameters, NodeValue *values);
/* Tells whether a node's value is finite: elements of numbers, vectors and truth values count. */
bool node_value_is_finite(const Graph *graph, Node node, const NodeValue *values);
/* Finds something that is not finite in what the part of a tape that depends on the point gets from the frame;
   NODE_NONE: all is.  A value that is chosen against, as in `if a == 0 then 1 else 1 / a`, is not used: it does
   not count. */
Node tape_frame_infinite(const Tape *tape, const NodeValue *values);
/* Runs the rest at a point; tape_run_frame has filled `values`. */
void tape_run_point(const Tape *tape, const double point[3], NodeValue *values);
/* Does the same on a surface that has this normal there, seen by pixels of this radius. */
void tape_run_surface(const Tape *tape, const double point[3], const double normal[3],
                      double footprint, NodeValue *values);
/* Does the same, seen by a ray of this direction, which may be NULL, and no pixel. */
void tape_run_seen(const Tape *tape, const double point[3], const double normal[3],
                   const double view[3], NodeValue *values);

/* Returns the value of a leaf that is the same at all points, where nobody looks. */
NodeValue leaf_unseen(const Expr *leaf);
/* Runs a single operation of a tape, which reads tables or textures; tape_run_frame has filled
   `values`, where those of its operands change. */
NodeValue tape_run_reader(const Tape *tape, Node node, const NodeValue *operands,
                          NodeValue *values);

/* substitute.c: a copy of a root with other nodes in place of some of its tape: `by` has for each node
   of the tape the other one + 1, or 0. */
Node graph_replace_nodes(Graph *graph, Node root, const Tape *tape, const Node *by, Arena *scratch);

#endif
