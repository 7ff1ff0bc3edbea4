/*
 * iterations.h: loops of lists and of statements whose iterations differ in numbers only (iterations.c).
 */
#ifndef KRS_EVAL_ITERATIONS_H
#define KRS_EVAL_ITERATIONS_H

#include "compiler/eval/elaborate.h"

enum { MAX_ITERATION_PARTS = 8 };

/* One of the shapes that each iteration gives. */
typedef struct IterationPart {
    const Syntax *syntax;  /* what is shown; or NULL */
    const Shape  *witness; /* of the first iteration */
    const Shape  *shape;   /* what all iterations have in common */
    Box          *boxes;   /* of the iterations */
    const Shape **iterations;
} IterationPart;

typedef struct Iterated Iterated;

/* A loop that has had its first iteration. */
typedef struct IterationBody {
    const Environment *env;
    const Syntax      *range, *syntax; /* of the variable; of the body */
    const char        *variable;
    bool               shown;   /* each shape is a component */
    bool               bounded; /* shapes are blended: each distance must be exact */
    /* Evaluates the body with iteration_condition and iteration_shape; false: it has something else. */
    bool (*evaluate)(Elaboration *e, const Environment *env, Iterated *iterated);
} IterationBody;

/* The loop with a leaf in the place of its variable. */
struct Iterated {
    const IterationBody *body;
    IterationPart        parts[MAX_ITERATION_PARTS];
    size_t part_count, found; /* those that the first iteration gave; that are evaluated */
    Node   leaf;
    Nodes  roots;      /* conditions of the loop; what must hold; what may not be finite */
    Nodes  required;   /* what must hold in each iteration */
    size_t conditions; /* of the loop */
    /* Numbers that are evaluated before the last condition must hold and be finite also where the
       iteration is left out: how many must hold, how many are to be finite, and the first node
       behind them. */
    size_t  early_required, early_numbers;
    Node    early_end;
    double *iterations; /* values of the variable */
    size_t  count;
};

/* Take from a body that is evaluated a condition on all that follows, and a shape that the
   iteration gives.  False: it has a value of another kind, never holds, or there are more shapes
   than in the first iteration. */
bool iteration_condition(Elaboration *e, Iterated *iterated, Value condition);
bool iteration_shape(Iterated *iterated, Value value);

/* Tells whether some loop may be tried now. */
bool iterations_are_tried(const Elaboration *e);
/* Tries to make the shapes of all iterations; `iterated` has its body and the witnesses. */
bool iterations_try(Elaboration *e, Iterated *iterated);

#endif
