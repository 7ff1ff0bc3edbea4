/*
 * turns.h: loops of lists and of statements whose turns differ in numbers only (turns.c).
 */
#ifndef KRS_EVAL_TURNS_H
#define KRS_EVAL_TURNS_H

#include "compiler/eval/elaborate.h"

enum { MOST_TURN_PARTS = 8 };

/* One of the shapes that each turn gives. */
typedef struct TurnPart {
    const Syntax *syntax;  /* what is shown; or NULL */
    const Shape  *witness; /* of the first turn */
    const Shape  *shape;   /* what all turns have in common */
    Box          *boxes;   /* of the turns */
    const Shape **turns;
} TurnPart;

typedef struct Turned Turned;

/* A loop that has had its first turn. */
typedef struct TurnBody {
    const Environment *env;
    const Syntax      *range, *syntax; /* of the variable; of the body */
    const char        *variable;
    bool               shown;   /* each shape is a component */
    bool               bounded; /* shapes are blended: each distance must be exact */
    /* Evaluates the body with turn_condition and turn_shape; false: it has something else. */
    bool (*evaluate)(Elaboration *e, const Environment *env, Turned *turned);
} TurnBody;

/* The loop with a leaf in the place of its variable. */
struct Turned {
    const TurnBody *body;
    TurnPart        parts[MOST_TURN_PARTS];
    size_t          part_count, found; /* those that the first turn gave; that are evaluated */
    Node            leaf;
    Nodes           roots; /* conditions of the loop; what must hold; what may not be finite */
    size_t          conditions, required, first_required;
    /* What is evaluated before the last condition must hold and be finite also where the turn is left out:
       how much must hold, how many numbers are to be finite, and the first node behind it. */
    size_t  early_required, early_numbers;
    Node    early_end;
    double *turns; /* values of the variable */
    size_t  count;
};

/* For a body that is evaluated: a condition on all that follows, and a shape that the turn gives.  False: it
   has a value of another kind, never holds, or there are more shapes than in the first turn. */
bool turn_condition(Elaboration *e, Turned *turned, Value condition);
bool turn_shape(Turned *turned, Value value);

/* Whether some loop may be tried now. */
bool turns_are_tried(const Elaboration *e);
/* Tries to make the shapes of all turns; `turned` has its body and the witnesses. */
bool turns_try(Elaboration *e, Turned *turned);

#endif
