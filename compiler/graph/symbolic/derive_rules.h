/*
 * derive_rules.h: the rules by which expressions are derived, one for each row of ops.def.
 */
#ifndef KRS_DERIVE_RULES_H
#define KRS_DERIVE_RULES_H

#include "compiler/graph/graph.h"

/* Columns of ops.def are no deeper. */
enum { MAX_KEPT_OPERANDS = 8 };

typedef struct Derivation {
    Graph      *graph;
    bool        breaks;   /* what was derived so far is true only between kinks and jumps */
    const bool *held;     /* nodes that are taken for constants, by number; or NULL */
    size_t      held_end; /* none from this number on */
    bool partly; /* what has no rule counts as constant; instance groups have points of their own */
    Node kept[MAX_KEPT_OPERANDS]; /* of columns of ops.def, whose last operands are made first */
    uint32_t kept_count;
} Derivation;

/* The derivative of a node from those of its operands, `inner`; NODE_NONE: there is none. */
typedef Node DeriveRule(Derivation *d, const Expr *e, Node node, const Node *inner);
#define RULES(name, cost, traits, simplify, derive, ...) DeriveRule derive;
#include "compiler/graph/ops.def"

/* ---- what the rules share ---- */

/* Returns a derivative that holds only where nothing jumps or breaks off. */
Node between_jumps(Derivation *d, Node derivative);
/* Returns what a length is divided by: below it, what is divided is 0. */
Node not_zero(Derivation *d, Node length);
bool is_zero(const Graph *graph, Node node);
Node zero_of(Graph *graph, GraphType type);
/* Tells whether the operands from `from` up to `count` do not depend on the point. */
bool others_are_constant(const Graph *g, const Node *inner, int from, int count);

#endif
