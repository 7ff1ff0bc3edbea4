/*
 * op_trial.h: an operation of ops.def with operands made at random.
 *
 * Operands are affine functions of the point, whose facts are known.
 */
#ifndef PROPERTY_OP_TRIAL_H
#define PROPERTY_OP_TRIAL_H

#include "compiler/graph/bounds/facts.h"
#include "compiler/graph/evaluate.h"

#include "tests/support/random.h"

typedef struct Row {
    Op          op;
    const char *name;
    const char *signature; /* of a MAP row: g for each operand, FLOAT or vector */
} Row;

/* A trial for each operation; `name` is NULL where there is nothing to try. */
extern const Row op_rows[OP_COUNT];

/* base + gradient * point; truths and instance numbers are steps of its first component. */
typedef struct Operand {
    GraphType type;
    uint32_t  size;
    double    base[4], gradient[4][3];
    double    slope; /* largest singular value of the gradient */
} Operand;

typedef struct Trial {
    Row       row;
    uint32_t  arity;
    GraphType types[MAX_OPERANDS], type;
    Operand   operands[MAX_OPERANDS];
    double    half[3]; /* the box is [-half, half] */
} Trial;

/* Returns what is known of an operand; without gradients, only the norms are left to the rule. */
Fact operand_fact(const Operand *operand, const double half[3], bool with_gradient);
/* In how many of eight trials an operand moves. */
int       moving_eighths(char kind);
char      operand_kind(Op op, char letter, uint32_t i);
Trial     trial_make(Random *random, Row row);
NodeValue trial_value(const Trial *trial, const double p[3]);
/* The piece that p is in, of operations whose slope holds between jumps only. */
void trial_piece(const Trial *trial, const double p[3], double piece[3]);

#endif
