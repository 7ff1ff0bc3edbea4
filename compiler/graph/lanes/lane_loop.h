/*
 * lane_loop.h: the loop over the steps of a lane tape, for one precision and one instruction set.
 *
 * It is included once for each: REAL is the type of a number, LANE_LOOP the name of the function.  The
 * rows of ops.def and blends.def are loops over lanes, which the compiler turns into vector
 * instructions; those that call the C library for each number stay as they are.  Products and sums
 * are never contracted (Makefile), so that all instruction sets give the same.
 */
#ifndef KRS_LANE_LOOP_H
#define KRS_LANE_LOOP_H

#include <assert.h>
#include <math.h>
#include <string.h>
#include <tgmath.h>

/* fmin and fmax as the C library has them, without calls. */
#define LESSER(type, name)                                                                 \
    static inline type name##_least(type a, type b) { return b != b ? a : a < b ? a : b; } \
    static inline type name##_greatest(type a, type b) { return b != b ? a : a > b ? a : b; }
LESSER(double, double)
LESSER(float, float)
#undef LESSER
#undef fmin
#undef fmax
#define fmin(a, b) _Generic((a) + (b), float : float_least, default : double_least)(a, b)
#define fmax(a, b) _Generic((a) + (b), float : float_greatest, default : double_greatest)(a, b)

#include "compiler/graph/lanes/lane_call.h"
#include "compiler/graph/lanes/lane_cell_work.h"
#include "compiler/graph/op_values.h"

#include "compiler/graph/lanes/lane_math.h"

/* Functions of single precision for which the C library would be called are loops, too. */
#define OF_SINGLE(a, single, other) _Generic((a), float : single, default : other)
#define real_sin(a)                 OF_SINGLE(a, lane_sin, real_sin)(a)
#define real_cos(a)                 OF_SINGLE(a, lane_cos, real_cos)(a)
#define real_tan(a)                 OF_SINGLE(a, lane_tan, real_tan)(a)
#define real_asin(a)                OF_SINGLE(a, lane_asin, real_asin)(a)
#define real_acos(a)                OF_SINGLE(a, lane_acos, real_acos)(a)
#define real_atan(a)                OF_SINGLE(a, lane_atan, real_atan)(a)
#define real_sinh(a)                OF_SINGLE(a, lane_sinh, real_sinh)(a)
#define real_cosh(a)                OF_SINGLE(a, lane_cosh, real_cosh)(a)
#define real_tanh(a)                OF_SINGLE(a, lane_tanh, real_tanh)(a)
#define real_exp(a)                 OF_SINGLE(a, lane_exp, real_exp)(a)
#define real_exp2(a)                OF_SINGLE(a, lane_exp2, real_exp2)(a)
#define real_log(a)                 OF_SINGLE(a, lane_log, real_log)(a)
#define real_log2(a)                OF_SINGLE(a, lane_log2, real_log2)(a)
#define real_log1p(a)               OF_SINGLE(a, lane_log1p, real_log1p)(a)
#define real_hypot(a, b)            OF_SINGLE((a) + (b), lane_hypot, real_hypot)(a, b)
#define value_sign(a)               OF_SINGLE(a, lane_sign, value_sign)(a)
#define value_unit(a)               OF_SINGLE(a, lane_unit, value_unit)(a)
#define value_mod(a, b)             OF_SINGLE((a) + (b), lane_mod, value_mod)(a, b)
#define value_pow(a, b)             OF_SINGLE((a) + (b), lane_pow, value_pow)(a, b)
#define value_atan2(a, b)           OF_SINGLE((a) + (b), lane_atan2, value_atan2)(a, b)
#define value_smoothstep(a, b, c)   OF_SINGLE((a) + (b), lane_smoothstep, value_smoothstep)(a, b, c)
#define value_stairs(a, b, k, n)    OF_SINGLE((a) + (b), lane_stairs, value_stairs)(a, b, k, n)

#ifdef __clang__
#define LANES_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#else
#define LANES_INDEPENDENT _Pragma("GCC ivdep")
#endif

#define LANE_NAME_(loop, name) loop##_##name
#define LANE_NAME(loop, name)  LANE_NAME_(loop, name)

/* Goes through each lane i of the blocks; rows are the same, or do not overlap. */
#define EACH_LANE(blocks)                             \
    for (size_t block = 0; block < (blocks); block++) \
    LANES_INDEPENDENT for (size_t i = LANE_BLOCK * block; i < LANE_BLOCK * block + LANE_BLOCK; i++)

#endif

#define LOCAL(name) LANE_NAME(LANE_LOOP, name)

/* Computes lengths.  Where the sum of squares overflows or loses what is small, the scalar
   operation goes on.  All are often 0: within a box. */
static void LOCAL(length)(REAL *to, const REAL *const *x, uint32_t size, size_t blocks)
{
    const REAL small = sizeof(REAL) == 4 ? (REAL)1e-30 : (REAL)1e-200, large = 1 / small;
    REAL       sums[LANES], tops[LANES];
    int        odd = 0;
    EACH_LANE(blocks)
    {
        REAL sum = 0, most = 0;
        for (uint32_t k = 0; k < size; k++) {
            sum += x[k][i] * x[k][i];
            most = fmax(most, fabs(x[k][i]));
        }
        sums[i] = sum;
        tops[i] = most;
    }
    for (size_t i = 0; i < LANE_BLOCK * blocks; i++)
        odd |= !((sums[i] > small) | (tops[i] == 0)) | !(sums[i] < large);
    if (!odd) {
        EACH_LANE(blocks)
        to[i] = sqrt(sums[i]);
        return;
    }
    for (size_t i = 0; i < LANE_BLOCK * blocks; i++) {
        double vector[4] = {0};
        for (uint32_t k = 0; k < size; k++)
            vector[k] = x[k][i];
        to[i] = (REAL)lane_length(vector, size);
    }
}

static void LOCAL(call)(const LaneTape *tape, const LaneWork *work, const LaneCall *call,
                        size_t points)
{
    REAL       *rows = work->rows;
    const Expr *e    = &tape->tape->graph->items[call->node];
    if (call->body && sizeof(REAL) == sizeof(double)) {
        lane_instance_call(tape, work, call, points, LANE_LOOP);
        return;
    }
    for (size_t i = 0; i < points; i++) {
        NodeValue operands[MAX_OPERANDS] = {0};
        for (uint32_t k = 0; k < e->operand_count; k++)
            for (uint32_t c = 0; c < 4 && call->from[k][c] != NODE_NONE; c++)
                operands[k].v[c] = call->from[k][c] & LANE_SCALAR
                                       ? tape->scalars[call->from[k][c] & ~LANE_SCALAR]
                                       : (double)rows[(size_t)call->from[k][c] * LANES + i];
        NodeValue value = lane_call(tape->tape, work->values, call->node, operands);
        for (uint32_t c = 0; c < call->parts; c++)
            rows[(size_t)call->to[c] * LANES + i] = (REAL)value.v[c];
    }
    /* Lanes behind the last point must hold numbers of some kind. */
    for (size_t i = points; i % LANE_BLOCK != 0; i++)
        for (uint32_t c = 0; c < call->parts; c++)
            rows[(size_t)call->to[c] * LANES + i] = 0;
}

/* ---- blends ---- */

#define BLEND(name, signature, slope, bulge, most, reach, acts, fades, cost, facts, glsl, value, \
              weights, meaning)                                                                  \
    static inline REAL LOCAL(smin_##name)(REAL a, REAL b, REAL k, REAL n)                        \
    {                                                                                            \
        REAL t = a == b ? 0 : fabs(a - b) / k, h = fmax(1 - t, 0);                               \
        (void)h, (void)n;                                                                        \
        return !(k > 0) ? fmin(a, b) : (REAL)(value);                                            \
    }
#include "compiler/graph/blends.def"

/* ---- steps ---- */

/* Zero has no sign (op_evaluate).  What is chosen is stored as it is: it may be the bits of an integer. */
#define STORE(value)        to[i] = (REAL)(value) + 0
#define STORE_OF(op, value) to[i] = (int)(op) == (int)OP_select ? (REAL)(value) : (REAL)(value) + 0

/* Runs a step on two operands of which the first is a scalar; false: there is no such loop. */
static bool LOCAL(scalar_first)(const LaneCode *code, REAL a, REAL *rows, size_t blocks)
{
    const REAL  c  = 0;
    const REAL *y  = rows + (size_t)code->from[1] * LANES;
    REAL       *to = rows + (size_t)code->to * LANES;
    (void)c;
    switch (code->op) {
#define MAP(name, arity, called, glsl, value, range, da, db, dc, norm, meaning) \
    case OP_##name:                                                             \
        if (arity != 2)                                                         \
            return false;                                                       \
        EACH_LANE(blocks)                                                       \
        {                                                                       \
            const REAL b = y[i];                                                \
            (void)b;                                                            \
            STORE(value);                                                       \
        }                                                                       \
        return true;
#include "compiler/graph/ops.def"
    default: return false;
    }
}

static bool LOCAL(scalar_second)(const LaneCode *code, REAL b, REAL *rows, size_t blocks)
{
    const REAL  c  = 0;
    const REAL *x  = rows + (size_t)code->from[0] * LANES;
    REAL       *to = rows + (size_t)code->to * LANES;
    (void)c;
    switch (code->op) {
#define MAP(name, arity, called, glsl, value, range, da, db, dc, norm, meaning) \
    case OP_##name:                                                             \
        if (arity != 2)                                                         \
            return false;                                                       \
        EACH_LANE(blocks)                                                       \
        {                                                                       \
            const REAL a = x[i];                                                \
            (void)a;                                                            \
            STORE(value);                                                       \
        }                                                                       \
        return true;
#include "compiler/graph/ops.def"
    default: return false;
    }
}

static bool LOCAL(mixed_step)(const LaneTape *tape, const LaneCode *code, REAL *rows, size_t blocks)
{
    if (code->scalars == 1)
        return LOCAL(scalar_first)(code, (REAL)tape->scalars[code->from[0]], rows, blocks);
    return LOCAL(scalar_second)(code, (REAL)tape->scalars[code->from[1]], rows, blocks);
}

#define ROW(op, value)                                                     \
    case op:                                                               \
        EACH_LANE(blocks)                                                  \
        {                                                                  \
            const REAL a = x[0][i], b = x[1][i], c = x[2][i], d = x[3][i]; \
            (void)b, (void)c, (void)d;                                     \
            STORE(value);                                                  \
        }                                                                  \
        return;

/* Runs a step on rows. */
static void LOCAL(step)(uint16_t op, REAL *to, const REAL *const *x, uint32_t size, size_t blocks)
{
    switch (op) {
#define MAP(name, arity, called, glsl, value, range, da, db, dc, norm, meaning) \
    ROW(OP_##name, value)
#define NUMBERS(name, arity, value, ...) ROW(OP_##name, value)
#define TRUTH                            NUMBERS
#include "compiler/graph/ops.def"
#define BLEND(name, signature, slope, bulge, most, reach, acts, fades, cost, facts, glsl, value, \
              weights, meaning)                                                                  \
    ROW(OP_smin_##name, LOCAL(smin_##name)(a, b, c, d))
#include "compiler/graph/blends.def"
    case OP_length:
        LOCAL(length)(to, x, size, blocks);
        return;
        ROW(LANE_LESSER, b < a ? b : a)
        ROW(LANE_GREATER, b > a ? b : a)
    default: assert(!"no step");
    }
}

/* Returns the row of an operand; a scalar fills the row `spare`. */
static const REAL *LOCAL(operand)(const LaneTape *tape, const LaneCode *code, int k, REAL *rows,
                                  REAL *spare, size_t blocks)
{
    if (k >= code->operand_count)
        return rows;
    if (!(code->scalars >> k & 1))
        return rows + (size_t)code->from[k] * LANES;
    const REAL number = (REAL)tape->scalars[code->from[k]];
    EACH_LANE(blocks)
    spare[i] = number;
    return spare;
}

static void LOCAL(general_step)(const LaneTape *tape, const LaneCode *code, REAL *rows,
                                size_t blocks)
{
    _Alignas(64) REAL spare[MAX_OPERANDS][LANES];
    const REAL       *x[MAX_OPERANDS];
    for (int k = 0; k < MAX_OPERANDS; k++)
        x[k] = LOCAL(operand)(tape, code, k, rows, spare[k], blocks);
    LOCAL(step)(code->op, rows + (size_t)code->to * LANES, x, code->operand_count, blocks);
}

void LANE_LOOP(const LaneTape *tape, const LaneWork *work, size_t points)
{
    REAL  *rows   = work->rows;
    size_t blocks = (points + LANE_BLOCK - 1) / LANE_BLOCK;
    for (const LaneCode *code = tape->code, *end = code + tape->count; code < end; code++) {
        if (code->op == LANE_CALL)
            LOCAL(call)(tape, work, &tape->calls[code->from[0]], points);
        else if (code->op >= LANE_INSTANCE)
            lane_instance_step(work, code, points);
        else if (code->op != LANE_PART &&
                 !(code->operand_count == 2 && (code->scalars == 1 || code->scalars == 2) &&
                   LOCAL(mixed_step)(tape, code, rows, blocks)))
            LOCAL(general_step)(tape, code, rows, blocks);
    }
}

#ifdef CELL_LOOP
/* ---- cell tapes ---- */

/* All lanes of a cell tape.  gcc would else unroll the loop before it looks for vectors. */
#ifdef __clang__
#define ALL_LANES EACH_LANE(CELL_LANES / LANE_BLOCK)
#else
#define ALL_LANES LANES_INDEPENDENT _Pragma("GCC unroll 1") for (size_t i = 0; i < CELL_LANES; i++)
#endif

#include "compiler/graph/lanes/lane_cell_calls.h"

/* Joins the states as the operation behind the bodies does; false: it has no loop. */
static bool LOCAL(cell_joined)(const CellTape *tape, const CellCall *call, CellStates states,
                               REAL *to)
{
    const InstanceFunction *function = call->body->function;
    const Graph            *graph    = tape->whole->tape->graph;
    const Node  node = graph->instances->bodies.items[function->first_body + function->state_count];
    const REAL *x[16] = {NULL};
    uint32_t    count = 0;
    for (uint32_t k = 0; k < graph->items[node].operand_count; k++)
        for (uint32_t c = 0; c < components(function->states[k].type); c++)
            x[count++] = states[4 * k + c];
    return LOCAL(call_of_lanes)((Op)graph->items[node].op, x, &to);
}

/* Runs an instance function over the instances of its list. */
static void LOCAL(cell_instances)(const CellTape *tape, NodeValue *values, const CellCall *call,
                                  REAL *rows, REAL *to)
{
    _Alignas(64) CellStates states;
    const InstanceFunction *function = call->body->function;
    cell_visit(call, values, rows, states, CELL_LOOP);
    if (function->sums) {
        const REAL *least = states[0], *sum = states[4], *width = states[8];
        ALL_LANES { to[i] = least[i] - width[i] * lane_log(sum[i] > 1 ? sum[i] : 1); }
    } else if (!function->joins) {
        memcpy(to, states, call->call->parts * sizeof states[0]);
    } else if (!LOCAL(cell_joined)(tape, call, states, to)) {
        cell_join(call, tape->whole->tape->graph, states, to);
    }
}

static void LOCAL(cell_call)(const CellTape *tape, NodeValue *values, const CellCall *call,
                             REAL *rows, REAL *to)
{
    const LaneTape *whole = tape->whole;
    const Expr     *e     = &whole->tape->graph->items[call->call->node];
    const REAL     *x[16] = {NULL};
    REAL           *parts[4];
    size_t          count = 0;
    if (call->instances) {
        LOCAL(cell_instances)(tape, values, call, rows, to);
        return;
    }
    for (uint32_t k = 0; k < MAX_OPERANDS; k++)
        for (uint32_t c = 0; c < 4 && call->from[k][c] != NODE_NONE; c++)
            x[count++] = rows + (size_t)call->from[k][c] * CELL_LANES;
    for (uint32_t c = 0; c < 4; c++)
        parts[c] = to + (size_t)c * CELL_LANES;
    if (LOCAL(call_of_lanes)((Op)e->op, x, parts) ||
        (e->op == OP_row && cell_read_rows(whole->tape->graph, e, values, x[1], to)))
        return;
    for (size_t i = 0; i < CELL_LANES; i++) {
        NodeValue operands[MAX_OPERANDS] = {0};
        for (uint32_t k = 0; k < e->operand_count; k++)
            for (uint32_t c = 0; c < 4 && call->from[k][c] != NODE_NONE; c++)
                operands[k].v[c] = cell_value(
                    (GraphType)whole->tape->graph->items[e->operands[k]].type,
                    rows[(size_t)call->from[k][c] * CELL_LANES + i]);
        NodeValue value = lane_call(whole->tape, values, call->call->node, operands);
        for (uint32_t c = 0; c < call->call->parts; c++)
            to[c * CELL_LANES + i] = cell_number((GraphType)e->type, value.v[c]);
    }
}

/* The row of an operand; its lanes. */
#define CELL_ROW(k) (rows + (size_t)step->from[k] * CELL_LANES)
#define CELL(op, value)                                                                    \
    case op: {                                                                             \
        const REAL *x = CELL_ROW(0), *y = CELL_ROW(1), *z = CELL_ROW(2), *w = CELL_ROW(3); \
        ALL_LANES                                                                          \
        {                                                                                  \
            const REAL a = x[i], b = y[i], c = z[i], d = w[i];                             \
            (void)b, (void)c, (void)d;                                                     \
            STORE_OF(op, value);                                                           \
        }                                                                                  \
    } break;

#define CELL_SQUARE(size, value)         \
    if (step->operand_count == (size)) { \
        switch (0) {                     \
            CELL(0, sqrt(value))         \
        }                                \
        return;                          \
    }
/* Computes lengths.  Very long ones are infinite, and very short ones 0: cells need no more. */
static inline void LOCAL(cell_length)(const CellStep *step, const REAL *rows, REAL *to)
{
    CELL_SQUARE(2, a * a + b * b)
    CELL_SQUARE(3, a * a + b * b + c * c)
    CELL_SQUARE(4, a * a + b * b + c * c + d * d)
    CELL_SQUARE(1, a * a)
}

static inline void LOCAL(cell_number)(const CellStep *step, REAL *to)
{
    REAL number;
    static_assert(sizeof number == sizeof step->from[0], "its bits are in the place of an operand");
    memcpy(&number, &step->from[0], sizeof number);
    ALL_LANES { to[i] = number; }
}

void CELL_LOOP(const CellTape *tape, NodeValue *values, REAL *rows)
{
    REAL *to = rows + (size_t)(tape->inputs + LANE_INPUTS) * CELL_LANES;
    for (const CellStep *step = tape->steps, *end = step + tape->count; step < end;
         step++, to += CELL_LANES) {
        switch (step->op) {
#define MAP(name, arity, called, glsl, value, range, da, db, dc, norm, meaning) \
    CELL(OP_##name, value)
#define NUMBERS(name, arity, value, ...) CELL(OP_##name, value)
#define TRUTH                            NUMBERS
#include "compiler/graph/ops.def"
#define BLEND(name, signature, slope, bulge, most, reach, acts, fades, cost, facts, glsl, value, \
              weights, meaning)                                                                  \
    CELL(OP_smin_##name, LOCAL(smin_##name)(a, b, c, d))
#include "compiler/graph/blends.def"
            CELL(LANE_LESSER, b < a ? b : a)
            CELL(LANE_GREATER, b > a ? b : a)
        case OP_length: LOCAL(cell_length)(step, rows, to); break;
        case LANE_CALL:
            LOCAL(cell_call)(tape, values, &tape->calls[step->from[0]], rows, to);
            break;
        case LANE_PART:
        case LANE_INSTANCE:
        case LANE_ROW:
        case LANE_STATE: break; /* who runs the body has filled the row */
        case LANE_NUMBER: LOCAL(cell_number)(step, to); break;
        default: assert(!"no step");
        }
    }
}

/* ---- cell tapes in several blocks of lanes ---- */

#ifdef __clang__
#define WIDE_LANES EACH_LANE(blocks *(CELL_LANES / LANE_BLOCK))
#else
#define WIDE_LANES                                                           \
    for (size_t first = 0; first < blocks * CELL_LANES; first += CELL_LANES) \
    LANES_INDEPENDENT _Pragma("GCC unroll 1") for (size_t i = first; i < first + CELL_LANES; i++)
#endif
#define WIDE(op, value)                                                    \
    case op:                                                               \
        WIDE_LANES                                                         \
        {                                                                  \
            const REAL a = x[0][i], b = x[1][i], c = x[2][i], d = x[3][i]; \
            (void)b, (void)c, (void)d;                                     \
            STORE_OF(op, value);                                           \
        }                                                                  \
        break;

static void LOCAL(wide_length)(uint32_t size, const REAL *const *x, REAL *to, size_t blocks)
{
    const REAL *p = x[0], *q = x[1], *r = x[2], *s = x[3];
    if (size == 2)
        WIDE_LANES { STORE(sqrt(p[i] * p[i] + q[i] * q[i])); }
    else if (size == 3)
        WIDE_LANES { STORE(sqrt(p[i] * p[i] + q[i] * q[i] + r[i] * r[i])); }
    else if (size == 4)
        WIDE_LANES { STORE(sqrt(p[i] * p[i] + q[i] * q[i] + r[i] * r[i] + s[i] * s[i])); }
    else
        WIDE_LANES { STORE(sqrt(p[i] * p[i])); }
}

/* Runs a step, of which scalars fill rows. */
static void LOCAL(wide_step)(const CellTape *tape, const CellStep *step, const REAL *constants,
                             const REAL *rows, REAL *to, size_t blocks)
{
    _Alignas(64) REAL spare[MAX_OPERANDS][CELL_WIDE];
    const REAL       *x[MAX_OPERANDS];
    for (uint32_t k = 0; k < MAX_OPERANDS; k++) {
        const bool scalar = step->scalars >> k & 1;
        x[k]              = k >= step->operand_count ? rows
                            : scalar                 ? spare[k]
                                     : rows + (size_t)(step->from[k] - tape->inputs) * CELL_WIDE;
        if (scalar)
            for (size_t i = 0; i < blocks * CELL_LANES; i++)
                spare[k][i] = constants[step->from[k]];
    }
    switch (step->op) {
#define MAP(name, arity, called, glsl, value, range, da, db, dc, norm, meaning) \
    WIDE(OP_##name, value)
#define NUMBERS(name, arity, value, ...) WIDE(OP_##name, value)
#define TRUTH                            NUMBERS
#include "compiler/graph/ops.def"
#define BLEND(name, signature, slope, bulge, most, reach, acts, fades, cost, facts, glsl, value, \
              weights, meaning)                                                                  \
    WIDE(OP_smin_##name, LOCAL(smin_##name)(a, b, c, d))
#include "compiler/graph/blends.def"
        WIDE(LANE_LESSER, b < a ? b : a)
        WIDE(LANE_GREATER, b > a ? b : a)
    case OP_length: LOCAL(wide_length)(step->operand_count, x, to, blocks); break;
    case LANE_NUMBER: {
        REAL number;
        memcpy(&number, &step->from[0], sizeof number);
        WIDE_LANES { to[i] = number; }
        break;
    }
    default: assert(!"no step");
    }
}

/* Most steps have this form: one row, or two operands of which none, the first or the second is a
   scalar. */
#define WIDE_ROW(k)            (rows + (size_t)(step->from[k] - tape->inputs) * CELL_WIDE)
#define WIDE_SCALAR(k)         (constants[step->from[k]])
#define WIDE_CASE(op, scalars) (uint32_t)(op) | (scalars) << 16
#define WIDE_LOOP_OF(x, y, p, q, value)     \
    {                                       \
        x;                                  \
        y;                                  \
        WIDE_LANES                          \
        {                                   \
            const REAL a = p, b = q, c = 0; \
            (void)a, (void)b, (void)c;      \
            STORE(value);                   \
        }                                   \
    }                                       \
    break;
#define WIDE_1(op, value)   \
    case WIDE_CASE(op, 0u): \
        WIDE_LOOP_OF(const REAL *x = WIDE_ROW(0), , x[i], 0, value)
#define WIDE_2(op, value)                                                                         \
    case WIDE_CASE(op, 0u):                                                                       \
        WIDE_LOOP_OF(const REAL *x = WIDE_ROW(0), const REAL *y = WIDE_ROW(1), x[i], y[i], value) \
    case WIDE_CASE(op, 1u):                                                                       \
        WIDE_LOOP_OF(const REAL x = WIDE_SCALAR(0), const REAL *y = WIDE_ROW(1), x, y[i], value)  \
    case WIDE_CASE(op, 2u):                                                                       \
        WIDE_LOOP_OF(const REAL *x = WIDE_ROW(0), const REAL y = WIDE_SCALAR(1), x[i], y, value)
#define WIDE_3(op, value)

void WIDE_LOOP(const CellTape *tape, const REAL *constants, REAL *rows, size_t blocks)
{
    REAL *to = rows + (size_t)LANE_INPUTS * CELL_WIDE;
    for (const CellStep *step = tape->steps, *end = step + tape->count; step < end;
         step++, to += CELL_WIDE) {
        switch (WIDE_CASE(step->op, step->scalars)) {
#define MAP(name, arity, called, glsl, value, range, da, db, dc, norm, meaning) \
    WIDE_##arity(OP_##name, value)
#include "compiler/graph/ops.def"
            WIDE_2(LANE_LESSER, b < a ? b : a)
            WIDE_2(LANE_GREATER, b > a ? b : a)
        default: LOCAL(wide_step)(tape, step, constants, rows, to, blocks);
        }
    }
}
#undef WIDE_ROW
#undef WIDE_SCALAR
#undef WIDE_CASE
#undef WIDE_LOOP_OF
#undef WIDE_1
#undef WIDE_2
#undef WIDE_3
#undef WIDE_LANES
#undef WIDE
#undef WIDE_LOOP
#undef ALL_LANES
#undef CELL
#undef CELL_ROW
#undef CELL_LOOP
#endif

#undef LANE_LOOP
#undef REAL
#undef LOCAL
#undef ROW
#undef STORE
#undef STORE_OF
