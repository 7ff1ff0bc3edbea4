/*
 * op_trial.c: an operation of ops.def with operands made at random.
 */
#include "tests/property/op_trial.h"

#include <math.h>
#include <string.h>

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
    {OP_rotate, "mrrr"},
    {OP_fold, "muc"},
    {OP_front, "muc"},
    {OP_cell, "mplh"},
    {OP_cell_polar, "mn"},
    {OP_blend_weight, "mmw"},
    {OP_less, "ee"},
    {OP_less_equal, "ee"},
    {OP_equal, "ee"},
    {OP_not_equal, "ee"},
    {OP_to_uint, "k"},
    {OP_noise2, "s"},
    {OP_noise3, "s"},
    {OP_julia, "mqkk"},
    {OP_julia_trap, "mqkk"},
    {OP_mandelbulb, "mkk"},
    {OP_mandelbulb_trap, "mkk"},
#define BLEND(name, ...) {OP_smin_##name, "mmwn"},
#define BLEND_SHARES(name, ...)                                                      \
    {OP_smin4_##name, "mw"}, {OP_smin8_##name, "mmw"}, {OP_threshold4_##name, "mw"}, \
        {OP_threshold8_##name, "mmw"},
#include "compiler/graph/blends.def"
};

#define MAP_SIGNATURE(arity) ((arity) == 1 ? "g>g" : (arity) == 2 ? "gg>g" : "ggg>g")

const Row op_rows[OP_COUNT] = {
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

static NodeValue operand_value(const Operand *operand, const double p[3])
{
    NodeValue value = {{0}};
    for (uint32_t i = 0; i < operand->size; i++) {
        value.v[i] = operand->base[i];
        for (int j = 0; j < 3; j++)
            value.v[i] += operand->gradient[i][j] * p[j];
        value.v[i] += 0.0; /* zero has no sign in graphs */
    }
    if (operand->type == TYPE_BOOL)
        value.v[0] = value.v[0] > 0;
    if (operand->type == TYPE_UINT)
        value.v[0] = floor(fmin(fmax(value.v[0] * 1e9 + 2e9, 0), UINT32_MAX));
    return value;
}

Fact operand_fact(const Operand *operand, const double half[3], bool with_gradient)
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

int moving_eighths(char kind)
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

/* Takes the one of some places halfway between whole numbers where noise rises most along an axis. */
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

char operand_kind(Op op, char letter, uint32_t i)
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

/* ---- trials ---- */

Trial trial_make(Random *random, Row row)
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

NodeValue trial_value(const Trial *trial, const double p[3])
{
    NodeValue operands[MAX_OPERANDS] = {0};
    for (uint32_t i = 0; i < trial->arity; i++)
        operands[i] = operand_value(&trial->operands[i], p);
    return op_evaluate(trial->row.op, trial->type, 0, trial->types, operands);
}

void trial_piece(const Trial *trial, const double p[3], double piece[3])
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
