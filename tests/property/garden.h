/*
 * garden.h: graphs made at random from every operation there is, and a plain recursive evaluator
 * that everything is held against.
 */
#ifndef PROPERTY_GARDEN_H
#define PROPERTY_GARDEN_H

#include "compiler/graph/evaluate.h"
#include "tests/support/bench.h"

/* ---- the evaluator ---- */

typedef struct Place {
    double    point[3];
    NodeValue parameters[2];
} Place;

NodeValue evaluate_plainly(const Graph *graph, Node node, const Place *place);
Place     random_place(Bench *b);

/* ---- graphs at random ---- */

typedef struct Garden {
    Node     nodes[64];
    uint32_t count;
} Garden;

Garden random_garden(Bench *b, uint32_t count);

/* ---- comparing values ---- */

double value_apart(GraphType type, const NodeValue *a, const NodeValue *b);

/* HUGE_VAL where something is not finite. */
double value_magnitude(GraphType type, const NodeValue *a);
bool   values_same(GraphType type, const NodeValue *a, const NodeValue *b);

#endif
