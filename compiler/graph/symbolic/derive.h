/*
 * derive.h: derivatives of expressions by the coordinates of the point, as expressions.
 */
#ifndef KRS_DERIVE_H
#define KRS_DERIVE_H

#include "compiler/graph/graph.h"

/* The uses that a derivative permits. */
typedef enum Smoothness {
    DERIVED_NOT,     /* some operation has no derivative here */
    DERIVED_BETWEEN, /* true between kinks and jumps, of which there may be any number */
    DERIVED_SMOOTH   /* true everywhere, and may be derived again */
} Smoothness;

/* Finds d root / dx, dy, dz of the point, each of the type of root (FLOAT or VECn): new nodes of
   the same graph.  Columns da, db, dc of ops.def are the rules.  DERIVED_NOT leaves `partial`
   undefined, and `*blame` (may be NULL) is the operation without a rule. */
Smoothness graph_derive(Graph *graph, Node root, Node partial[3], Node *blame, Arena *scratch);

/* Returns the gradient of a FLOAT as one VEC3. */
Smoothness graph_gradient(Graph *graph, Node root, Node *gradient, Node *blame, Arena *scratch);
/* Returns the same where some nodes are taken for constants. */
Smoothness graph_gradient_of(Graph *graph, Node root, const Node *held, size_t held_count,
                             Node *gradient, Node *blame, Arena *scratch);

/* Returns the gradient of a FLOAT as far as it is known: operations without a rule, such as noise,
   count as constant.  In bodies of instance groups it is that by OP_INSTANCE_POINT. */
Node graph_known_gradient(Graph *graph, Node root, Arena *scratch);

#endif
