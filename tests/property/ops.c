/*
 * ops.c: every row of ops.def keeps its promise.
 *
 * Operands are affine functions of the point, whose facts are known; sampled inside random
 * boxes, each operation must stay in the range, under the slope and within the gradient that
 * op_fact derives.  To show that the sampler would notice a wrong rule, the same is done with
 * rules that were broken on purpose (a slope made smaller, an operand forgotten): every broken
 * rule must be refuted.  A new row is tested as soon as it exists.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

#include "tests/property/op_trial.h"

/* ---- rules, right and broken ---- */

typedef enum Mutation {
    RIGHT,
    SMALLER_SLOPE,    /* 0.7 times the slope, as if a factor of a norm were forgotten */
    SMALLER_GRADIENT, /* derivatives drawn in to 0.7 of their size */
    SMALLER_RANGE,    /* the range drawn in to 0.7 of its width */
    FORGET_OPERAND,   /* one operand is taken to be the same all over the box; further ones by + */
    MUTATION_COUNT = FORGET_OPERAND + MAX_OPERANDS
} Mutation;

static const char *const mutation_names[] = {
    "right",    "smaller slope", "smaller gradient", "smaller range",
    "forget a", "forget b",      "forget c",         "forget d",
};

static Range shrunk(Range range, double factor)
{
    double middle = (range.low + range.high) / 2, half = (range.high - range.low) / 2;
    return (Range){middle - factor * half, middle + factor * half};
}

static Fact trial_fact(const Trial *trial, Mutation mutation, bool with_gradient)
{
    Fact     operands[MAX_OPERANDS];
    uint32_t size = trial->type <= TYPE_VEC4 ? trial->type : 1;
    for (uint32_t i = 0; i < trial->arity; i++) {
        operands[i] = operand_fact(&trial->operands[i], trial->half, with_gradient);
        if (mutation == (Mutation)(FORGET_OPERAND + i)) {
            operands[i].slope = 0;
            memset(operands[i].gradient, 0, sizeof operands[i].gradient);
        }
    }
    Fact fact = op_fact(trial->row.op, trial->type, 0, trial->types, operands, NULL);
    if (mutation == SMALLER_SLOPE)
        fact.slope *= 0.7;
    for (uint32_t i = 0; i < size; i++) {
        if (mutation == SMALLER_RANGE && fact.value[i].high - fact.value[i].low < HUGE_VAL)
            fact.value[i] = shrunk(fact.value[i], 0.7);
        for (int j = 0; j < 3 && mutation == SMALLER_GRADIENT; j++) {
            fact.gradient[i][j].low *= 0.7;
            fact.gradient[i][j].high *= 0.7;
        }
    }
    return fact;
}

/* ---- what is checked ---- */

typedef struct Sample {
    double    p[3], piece[3];
    NodeValue value;
} Sample;

static Sample sample_at(const Trial *trial, const double p[3])
{
    Sample sample;
    memcpy(sample.p, p, sizeof sample.p);
    sample.value = trial_value(trial, p);
    trial_piece(trial, p, sample.piece);
    return sample;
}

/* Near a pole little but the rounding of the operands is seen. */
static bool sample_defined(const Trial *trial, const Sample *sample, uint32_t size)
{
    double most = trial->type == TYPE_UINT ? UINT32_MAX : 1000;
    for (uint32_t i = 0; i < size; i++)
        if (!(fabs(sample->value.v[i]) <= most))
            return false;
    return true;
}

static double sample_size(const Sample *sample, uint32_t size)
{
    double largest = 1;
    for (uint32_t i = 0; i < size; i++)
        largest = fmax(largest, fabs(sample->value.v[i]));
    return largest;
}

static bool range_holds(const Fact *fact, const Sample *sample, uint32_t size)
{
    for (uint32_t i = 0; i < size; i++)
        if (!(fact->value[i].low <= sample->value.v[i] &&
              sample->value.v[i] <= fact->value[i].high))
            return false;
    return true;
}

static bool slope_holds(const Fact *fact, const Sample *a, const Sample *b, uint32_t size)
{
    double moved = 0, changed = 0, scale = fmax(sample_size(a, size), sample_size(b, size));
    for (int j = 0; j < 3; j++)
        moved = hypot(moved, a->p[j] - b->p[j]);
    for (uint32_t i = 0; i < size; i++)
        changed = hypot(changed, a->value.v[i] - b->value.v[i]);
    return fact->slope == HUGE_VAL || changed <= fact->slope * moved * (1 + 1e-9) + 1e-13 * scale;
}

/* a and b differ in coordinate j only: by the mean value theorem, the difference quotient is a
   value of the derivative. */
static bool gradient_holds(const Fact *fact, const Sample *a, const Sample *b, int j, uint32_t size)
{
    double moved = b->p[j] - a->p[j], scale = fmax(sample_size(a, size), sample_size(b, size));
    for (uint32_t i = 0; i < size && moved != 0; i++) {
        double quotient = (b->value.v[i] - a->value.v[i]) / moved;
        double slack    = 1e-9 * fabs(quotient) + 1e-13 * scale / fabs(moved);
        Range  g        = fact->gradient[i][j];
        if (!(g.low - slack <= quotient && quotient <= g.high + slack))
            return false;
    }
    return true;
}

static bool same_piece(const Sample *a, const Sample *b)
{
    return memcmp(a->piece, b->piece, sizeof a->piece) == 0;
}

/* What is refuted by points of the box, or NULL. */
static const char *refutation(Random *random, const Trial *trial, const Fact *fact)
{
    enum { POINTS = 10 };
    Sample   samples[POINTS];
    uint32_t size = trial->type <= TYPE_VEC4 ? trial->type : 1, count = 0;
    for (int k = 0; k < POINTS; k++) {
        double p[3]   = {0};
        bool   corner = random_below(random, 3) == 0;
        for (int j = 0; j < 3 && k > 0; j++) /* the first is the middle, where operands are exact */
            p[j] = corner ? (random_below(random, 2) ? 1 : -1) * trial->half[j]
                          : random_between(random, -trial->half[j], trial->half[j]);
        Sample sample = sample_at(trial, p);
        if (!sample_defined(trial, &sample, size))
            continue;
        if (!range_holds(fact, &sample, size))
            return "range";
        for (uint32_t other = 0; other < count; other++)
            if (same_piece(&samples[other], &sample) &&
                !slope_holds(fact, &samples[other], &sample, size))
                return "slope";
        int j         = (int)random_below(random, 3);
        p[j]          = random_between(random, -trial->half[j], trial->half[j]);
        Sample beside = sample_at(trial, p);
        if (sample_defined(trial, &beside, size) && same_piece(&beside, &sample) &&
            !gradient_holds(fact, &sample, &beside, j, size))
            return "gradient";
        samples[count++] = sample;
    }
    return NULL;
}

enum { TRIALS = 6000 };

/* Returns the trial that refutes a rule, or -1. */
static int refuting_trial(Row row, Mutation mutation, bool with_gradient, const char **what)
{
    Random random = {.state = 1000u * (uint64_t)row.op + 17};
    for (int trial_number = 0; trial_number < TRIALS; trial_number++) {
        Trial trial = trial_make(&random, row);
        Fact  fact  = trial_fact(&trial, mutation, with_gradient);
        *what       = refutation(&random, &trial, &fact);
        if (*what)
            return trial_number;
    }
    return -1;
}

/* ---- tests ---- */

static void keeps_its_promises(void **state)
{
    Row row = op_rows[*(Op *)*state];
    for (int with_gradient = 0; with_gradient < 2; with_gradient++) {
        const char *what;
        int         trial = refuting_trial(row, RIGHT, with_gradient, &what);
        if (trial >= 0)
            fail_msg("%s: the %s of trial %d %s gradients is refuted", row.name, what, trial,
                     with_gradient ? "with" : "without");
    }
}

/* What only jumps has a slope of 0 or none, which 0.7 does not change. */
static bool only_jumps(Op op)
{
    switch (op) {
    case OP_sign:
    case OP_floor:
    case OP_ceil:
    case OP_round:
    case OP_step:
    case OP_less:
    case OP_less_equal:
    case OP_equal:
    case OP_not_equal:
    case OP_front:
    case OP_and:
    case OP_or:
    case OP_not:
    case OP_push_id:
    case OP_hash_id:
    case OP_join_id:
    case OP_id_unit:
    case OP_to_uint:
    case OP_julia_trap:
    case OP_mandelbulb_trap: return true;
    default: return false;
    }
}

/* Tells whether breaking a rule in this way changes anything. */
static bool is_broken_by(Row row, Mutation mutation)
{
    if (row.op == OP_footprint || row.op == OP_footprint_axes)
        return false; /* it is 0, whatever is changed */
    if (mutation == SMALLER_SLOPE || mutation == SMALLER_GRADIENT)
        return !only_jumps(row.op);
    uint32_t i = mutation - FORGET_OPERAND;
    if (row.op == OP_guard && i == 3 && mutation != SMALLER_RANGE)
        return false; /* it says where the value jumps, and nothing else */
    return mutation == SMALLER_RANGE || moving_eighths(operand_kind(row.op, row.signature[i], i));
}

static void broken_rules_are_refuted(void **state)
{
    Row      row   = op_rows[*(Op *)*state];
    Mutation count = (Mutation)(FORGET_OPERAND + (strchr(row.signature, '>') - row.signature));
    for (Mutation mutation = SMALLER_SLOPE; mutation < count; mutation++)
        for (int with_gradient = 0; with_gradient < 2 && is_broken_by(row, mutation);
             with_gradient++) {
            const char *what;
            if (refuting_trial(row, mutation, with_gradient, &what) < 0)
                fail_msg("%s: %s %s gradients is not noticed", row.name, mutation_names[mutation],
                         with_gradient ? "with" : "without");
        }
}

int main(void)
{
    static Op         ops[OP_COUNT];
    struct CMUnitTest tests[2 * OP_COUNT];
    size_t            count = 0;
    for (Op op = 0; op < OP_COUNT; op++)
        if (op_rows[op].name && !op_has_traits(op, READS_TABLES) && !op_has_traits(op, OF_HOST)) {
            /* those: unit/instances.c, property/iterations.c */
            ops[op]        = op;
            tests[count++] = (struct CMUnitTest){graph_op_name(op), keeps_its_promises, NULL, NULL,
                                                 &ops[op]};
            tests[count++] = (struct CMUnitTest){graph_op_name(op), broken_rules_are_refuted, NULL,
                                                 NULL, &ops[op]};
        }
    return _cmocka_run_group_tests("operations", tests, count, NULL, NULL);
}
