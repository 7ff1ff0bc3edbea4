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

#include "compiler/graph/evaluate.h"
#include "compiler/graph/facts.h"

#include "tests/support/random.h"

/* ---- rows under test ---- */

/*
 * What each operand is like, by letter:
 *     m  mostly moves with the point   c  mostly fixed
 *     p  mostly fixed, positive or 0   w  mostly fixed width, sometimes 0
 *     b  truth                         i  instance number
 *     e  often a whole number in the middle of the box, so that two are equal there
 *     s  mostly moves with the point, often from a steep place of gradient noise
 * and, always fixed:
 *     r  row of one rotation           u  unit vector              n  whole number 1..7
 *     l  -2..0                         h  0..2
 *     k  whole number 2..5             q  -1/2..1/2
 * Rows without a line here have m, b and i as their types ask.
 */
static const struct {
    Op          op;
    const char *kinds;
} special_operands[] = {
    {OP_turn, "mrrr"},
    {OP_fold, "muc"},
    {OP_front, "muc"},
    {OP_cell, "mplh"},
    {OP_cell_polar, "mn"},
    {OP_smin_stairs, "mmwn"},
    {OP_blend_weight, "mmw"},
    {OP_less, "ee"},
    {OP_less_equal, "ee"},
    {OP_equal, "ee"},
    {OP_not_equal, "ee"},
    {OP_noise2, "s"},
    {OP_noise3, "s"},
    {OP_julia, "mqkk"},
    {OP_julia_trap, "mqkk"},
    {OP_mandelbulb, "mkk"},
    {OP_mandelbulb_trap, "mkk"},
#define SMIN(name, ...) {OP_##name, "mmw"},
#include "compiler/graph/ops.def"
};

typedef struct Row {
    Op          op;
    const char *name;
    const char *signature; /* of a MAP row: g for each operand, FLOAT or vector */
} Row;

#define MAP_SIGNATURE(arity) ((arity) == 1 ? "g>g" : (arity) == 2 ? "gg>g" : "ggg>g")

/* Of leaves, too, without a name. */
static const Row op_rows[OP_COUNT] = {
#define MAP(name, arity, ...)          [OP_##name] = {OP_##name, #name, MAP_SIGNATURE(arity)},
#define OP(name, signature, glsl, ...) [OP_##name] = {OP_##name, #name, signature},
#include "compiler/graph/ops.def"
};

static void random_unit(Random *random, double u[3])
{
    double size;
    do {
        for (int i = 0; i < 3; i++)
            u[i] = random_between(random, -1, 1);
        size = sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    } while (size < 0.1 || size > 1);
    for (int i = 0; i < 3; i++)
        u[i] /= size;
}

/* Three orthonormal rows, from a unit vector and another. */
static void random_rotation(Random *random, double rows[3][3])
{
    double other[3], along = 0, size = 0;
    random_unit(random, rows[0]);
    random_unit(random, other);
    for (int i = 0; i < 3; i++)
        along += other[i] * rows[0][i];
    for (int i = 0; i < 3; i++) {
        rows[1][i] = other[i] - along * rows[0][i];
        size += rows[1][i] * rows[1][i];
    }
    for (int i = 0; i < 3; i++)
        rows[1][i] /= sqrt(size);
    for (int i = 0; i < 3; i++) {
        int y = (i + 1) % 3, z = (i + 2) % 3;
        rows[2][i] = rows[0][y] * rows[1][z] - rows[0][z] * rows[1][y];
    }
}

/* ---- operands ---- */

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

static NodeValue operand_value(const Operand *operand, const double p[3])
{
    NodeValue value = {{0}};
    for (uint32_t i = 0; i < operand->size; i++) {
        value.v[i] = operand->base[i];
        for (int j = 0; j < 3; j++)
            value.v[i] += operand->gradient[i][j] * p[j];
    }
    if (operand->type == TYPE_BOOL)
        value.v[0] = value.v[0] > 0;
    if (operand->type == TYPE_UINT)
        value.v[0] = floor(fmin(fmax(value.v[0] * 1e9 + 2e9, 0), UINT32_MAX));
    return value;
}

/* What is known of an operand; without gradients, only the norms are left to the rule. */
static Fact operand_fact(const Operand *operand, const double half[3], bool with_gradient)
{
    Fact fact  = {.slope = operand->slope};
    bool steps = operand->type == TYPE_BOOL || operand->type == TYPE_UINT;
    if (steps && operand->slope > 0)
        fact.slope = HUGE_VAL;
    for (uint32_t i = 0; i < operand->size; i++) {
        double reach = 0;
        for (int j = 0; j < 3; j++) {
            double g = operand->gradient[i][j];
            reach += fabs(g) * half[j];
            fact.gradient[i][j] = steps || !with_gradient ? (Range){-fact.slope, fact.slope}
                                                          : (Range){g, g};
        }
        reach += reach > 0 ? 1e-13 : 0;
        fact.value[i] = (Range){operand->base[i] - reach, operand->base[i] + reach};
    }
    if (operand->type == TYPE_BOOL)
        fact.value[0] = (Range){fact.value[0].low > 0, fact.value[0].high > 0};
    if (operand->type == TYPE_UINT)
        fact.value[0] = (Range){0, UINT32_MAX};
    return fact;
}

/* A moving operand moves along one direction (shared by all, or its own); a vector of 3 may also
   be the point itself, turned and scaled. */
static void operand_move(Random *random, Operand *operand, const double shared[3])
{
    double own[3], size = 0, speed = random_between(random, 0.2, 2);
    random_unit(random, own);
    if (operand->type == TYPE_VEC3 && random_below(random, 2)) {
        double rows[3][3];
        random_rotation(random, rows);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                operand->gradient[i][j] = speed * rows[i][j];
        operand->slope = speed * (1 + 1e-14);
        return;
    }
    const double *direction = random_below(random, 4) ? shared : own;
    bool          along     = random_below(random, 3) == 0; /* in the direction of the value */
    for (uint32_t i = 0; i < operand->size; i++) {
        double rate = along ? operand->base[i] : random_between(random, -speed, speed);
        size += rate * rate;
        for (int j = 0; j < 3; j++)
            operand->gradient[i][j] = rate * direction[j];
    }
    operand->slope = sqrt(size) * (1 + 1e-14);
}

static double fixed_number(Random *random, char kind)
{
    switch (kind) {
    case 'p': return random_below(random, 4) ? random_between(random, 0.3, 2) : 0;
    case 'w': return random_below(random, 6) ? random_between(random, 0.05, 2) : 0;
    case 'n': return 1 + random_below(random, 7);
    case 'k': return 2 + random_below(random, 4);
    case 'q': return random_between(random, -0.5, 0.5);
    case 'l': return -(double)random_below(random, 3);
    case 'h': return random_below(random, 3);
    default: return random_between(random, -2, 2);
    }
}

/* In how many of eight trials an operand moves. */
static int moving_eighths(char kind)
{
    switch (kind) {
    case 'm':
    case 's': return 7;
    case 'b':
    case 'i':
    case 'e': return 4;
    case 'c':
    case 'p':
    case 'w': return 1;
    default: return 0;
    }
}

/* Of some places halfway between whole numbers, the one where noise rises most along an axis. */
static void steep_place(Random *random, Operand *operand)
{
    Op     op       = operand->type == TYPE_VEC2 ? OP_noise2 : OP_noise3;
    double steepest = -1;
    for (int k = 0; k < 40; k++) {
        NodeValue place = {{0}};
        for (uint32_t i = 0; i < operand->size; i++)
            place.v[i] = floor(random_between(random, -1000, 1000)) + 0.5;
        double middle = op_evaluate(op, TYPE_FLOAT, 0, &operand->type, &place).v[0];
        for (uint32_t i = 0; i < operand->size; i++) {
            NodeValue beside = place;
            beside.v[i] += 1e-3;
            double value = op_evaluate(op, TYPE_FLOAT, 0, &operand->type, &beside).v[0];
            if (fabs(value - middle) > steepest) {
                steepest = fabs(value - middle);
                memcpy(operand->base, place.v, sizeof operand->base);
            }
        }
    }
}

static void operand_make(Random *random, Operand *operand, char kind, GraphType type,
                         const double shared[3], const double row[3])
{
    *operand    = (Operand){.type = type, .size = type <= TYPE_VEC4 ? type : 1};
    bool narrow = random_below(random, 3) == 0; /* near what happens at 0 and whole numbers */
    for (uint32_t i = 0; i < operand->size; i++) {
        operand->base[i] = fixed_number(random, kind);
        if (kind == 'm' && narrow)
            operand->base[i] *= 0.01;

        if (random_below(random, 8) < (kind == 'e' ? 4 : kind == 'm'))
            operand->base[i] = round(operand->base[i]);
        if (kind == 'r')
            operand->base[i] = row[i];
        if (kind == 'u')
            operand->base[i] = shared[i];
    }
    if (random_below(random, 8) < moving_eighths(kind))
        operand_move(random, operand, shared);
    if (kind == 's' && random_below(random, 2)) { /* the point itself */
        steep_place(random, operand);
        operand->slope = 1;
        for (uint32_t i = 0; i < operand->size; i++)
            for (uint32_t j = 0; j < 3; j++)
                operand->gradient[i][j] = i == j;
    }
}

static char operand_kind(Op op, char letter, uint32_t i)
{
    for (size_t k = 0; k < sizeof special_operands / sizeof *special_operands; k++)
        if (special_operands[k].op == op)
            return special_operands[k].kinds[i];
    return letter == 'b' ? 'b' : letter == 'u' ? 'i' : 'm';
}

/* Types for the letters of a signature: those of `g`, `v` and `t` are drawn. */
static GraphType letter_type(char letter, GraphType map, GraphType vector, GraphType any)
{
    switch (letter) {
    case 'f': return TYPE_FLOAT;
    case 'b': return TYPE_BOOL;
    case 'u': return TYPE_UINT;
    case 'g': return map;
    case 'v': return vector;
    case 't': return any;
    default: return (GraphType)(letter - '0');
    }
}

static Trial trial_make(Random *random, Row row)
{
    Trial     trial  = {.row = row};
    GraphType map    = (GraphType)(random_below(random, 2) ? 1 : 1 + random_below(random, 4));
    GraphType vector = (GraphType)(2 + random_below(random, 3));
    GraphType any    = (GraphType)(1 + random_below(random, 6));
    double    shared[3], rows[3][3], size = exp(random_between(random, log(1e-3), log(2)));
    trial.arity = (uint32_t)(strchr(row.signature, '>') - row.signature);
    random_unit(random, shared);
    random_rotation(random, rows);
    for (int j = 0; j < 3; j++)
        trial.half[j] = size * random_between(random, 0.2, 1);
    for (uint32_t i = 0; i < trial.arity; i++) {
        char letter    = row.signature[i];
        trial.types[i] = letter_type(letter, map, vector, any);
        operand_make(random, &trial.operands[i], operand_kind(row.op, letter, i), trial.types[i],
                     shared, rows[(i + 2) % 3]);
    }
    trial.type = graph_op_type(row.op, trial.types, trial.arity);
    return trial;
}

static NodeValue trial_value(const Trial *trial, const double p[3])
{
    NodeValue operands[MAX_OPERANDS] = {0};
    for (uint32_t i = 0; i < trial->arity; i++)
        operands[i] = operand_value(&trial->operands[i], p);
    return op_evaluate(trial->row.op, trial->type, 0, trial->types, operands);
}

/* The piece that p is in, of operations whose slope holds between jumps only. */
static void trial_piece(const Trial *trial, const double p[3], double piece[3])
{
    NodeValue o[MAX_OPERANDS];
    memset(piece, 0, 3 * sizeof *piece);
    for (uint32_t i = 0; i < trial->arity; i++)
        o[i] = operand_value(&trial->operands[i], p);
    if (trial->row.op == OP_cell)
        for (int i = 0; i < 3; i++) {
            double cell = o[1].v[i] > 0 ? floor(o[0].v[i] / o[1].v[i] + 0.5) : 0;
            piece[i]    = fmin(fmax(cell, o[2].v[i]), o[3].v[i]);
        }
    if (trial->row.op == OP_cell_polar)
        piece[0] = floor(atan2(o[0].v[2], o[0].v[0]) * o[1].v[0] / (2 * acos(-1)) + 0.5);
}

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

/* The trial that refutes a rule, or -1. */
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
    case OP_julia_trap:
    case OP_mandelbulb_trap: return true;
    default: return false;
    }
}

/* Whether breaking a rule in this way changes anything. */
static bool is_broken_by(Row row, Mutation mutation)
{
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
        if (op_rows[op].name) {
            ops[op]        = op;
            tests[count++] = (struct CMUnitTest){graph_op_name(op), keeps_its_promises, NULL, NULL,
                                                 &ops[op]};
            tests[count++] = (struct CMUnitTest){graph_op_name(op), broken_rules_are_refuted, NULL,
                                                 NULL, &ops[op]};
        }
    return _cmocka_run_group_tests("operations", tests, count, NULL, NULL);
}
