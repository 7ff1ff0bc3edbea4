/*
 * lane_rows.c: every row of ops.def keeps its promise in all evaluators of lanes.
 *
 * Operands are affine functions of the point.  Values on every instruction set are those of op_evaluate; over
 * a box, ranges hold them, derivatives and second derivatives bound how they change, and what is pruned is the same.
 * To show that a wrong column would be noticed, ranges and derivatives are drawn in on purpose: that
 * must be refuted of every row that has some.  A new row is tested as soon as it exists.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

#include "compiler/graph/bounds/numbers.h"
#include "compiler/graph/lanes/lanes.h"

#include "tests/property/op_trial.h"
#include "tests/support/bench.h"

enum { TRIALS = 400, POINTS = 16 };

/* A component of an operation on such operands, by lanes. */
typedef struct Made {
    Trial        trial;
    uint32_t     component;
    LaneTape     lanes;
    LaneWork     work;
    LaneRanges   ranges;
    LaneSlope    slope;
    LaneHessian  hessian;
    LaneSlope   *slopes;
    LaneHessian *hessians;
    Box          box;
    bool         sure, bounded, bent;
} Made;

/* What was asked of a row: how often it had an answer, and how often one that was drawn in was refuted. */
typedef struct Tally {
    size_t sure, moving, bent,
        curved; /* a number everywhere; a slope that is not 0; second derivatives; some not 0 */
    size_t less_range, less_slope, less_hessian;
} Tally;

/* ---- what is tried ---- */

/* base + gradient * point, in the order of operand_value. */
static Node operand_component(Bench *b, const Operand *operand, uint32_t i)
{
    const Node axes[3] = {b->x, b->y, b->z};
    Node       sum     = graph_number(b->graph, operand->base[i]);
    for (int j = 0; j < 3 && operand->slope > 0; j++) {
        Node rate = graph_number(b->graph, operand->gradient[i][j]);
        Node term = graph_op2(b->graph, OP_mul, rate, axes[j]);
        sum       = graph_op2(b->graph, OP_add, sum, term);
    }
    return sum;
}

static Node operand_node(Bench *b, const Operand *operand)
{
    static const Op vectors[] = {OP_vec2, OP_vec3, OP_vec4};
    Node            parts[4]  = {0};
    for (uint32_t i = 0; i < operand->size; i++)
        parts[i] = operand_component(b, operand, i);
    if (operand->type == TYPE_BOOL)
        return graph_op2(b->graph, OP_less, graph_number(b->graph, 0), parts[0]);
    return operand->size == 1 ? parts[0] : graph_op(b->graph, vectors[operand->size - 2], parts);
}

static void made_run(Made *made, Box box)
{
    made->box      = box;
    Range    range = lane_ranges_run(&made->lanes, &made->ranges, box);
    uint32_t out   = made->lanes.outputs[0];
    made->sure     = !(out & LANE_SCALAR) && made->ranges.sure[out];
    made->bounded  = lane_slopes_run(&made->lanes, &made->ranges, made->slopes, &made->slope);
    made->bent     = made->bounded && lane_hessians_run(&made->lanes, &made->ranges, made->slopes,
                                                        made->hessians, &made->hessian);
    assert_true(range.low <= range.high);
    assert_false(made->bent && lane_is_undecided(&made->lanes, &made->ranges));
}

static Made make(Bench *b, Row row)
{
    Made made = {.trial = trial_make(&b->random, row)};
    while (made.trial.type == TYPE_UINT) /* that is no number */
        made.trial = trial_make(&b->random, row);
    Node operands[MAX_OPERANDS], root;
    b->graph = graph_new(&b->arena);
    b->point = graph_leaf(b->graph, OP_POINT);
    b->x     = graph_component(b->graph, b->point, 0);
    b->y     = graph_component(b->graph, b->point, 1);
    b->z     = graph_component(b->graph, b->point, 2);
    for (uint32_t k = 0; k < made.trial.arity; k++)
        operands[k] = operand_node(b, &made.trial.operands[k]);
    root = graph_op(b->graph, row.op, operands);
    if (made.trial.type <= TYPE_VEC4) {
        made.component = random_below(&b->random, made.trial.type);
        root           = graph_component(b->graph, root, made.component);
    }
    Tape      *tape   = arena_new(&b->arena, Tape);
    NodeValue *values = arena_new_array(&b->arena, NodeValue, b->graph->count);
    *tape             = tape_new(b->graph, &root, 1, &b->arena);
    tape_run_frame(tape, NULL, values);
    made.lanes         = lane_tape_new(tape, &root, 1, false, 0, &b->arena);
    made.lanes.scalars = arena_new_array(&b->arena, double, made.lanes.scalar_count + 1);
    lane_tape_scalars(&made.lanes, values, made.lanes.scalars);
    made.work     = lane_work_in(arena_alloc(&b->arena, lane_work_bytes(&made.lanes), 1), values);
    made.ranges   = lane_ranges_new(&made.lanes, &b->arena);
    made.slopes   = lane_slopes_new(&made.lanes, &b->arena);
    made.hessians = lane_hessians_new(&made.lanes, &b->arena);
    Box box;
    for (int k = 0; k < 3; k++)
        box.axis[k] = (Range){-made.trial.half[k], made.trial.half[k]};
    made_run(&made, box);
    return made;
}

/* ---- samples ---- */

typedef struct Sample {
    double p[3], piece[4], value;
} Sample;

static double value_at(const Made *made, const double p[3])
{
    return trial_value(&made->trial, p).v[made->component];
}

/* The derivatives of choices are those of the pieces. */
static double chosen_piece(const Made *made, const double p[3])
{
    Trial of_condition = made->trial;
    if (made->trial.row.op == OP_select) {
        of_condition.row.op = OP_not;
        of_condition.type   = TYPE_BOOL;
        return trial_value(&of_condition, p).v[0];
    }
    /* c is far below or above the others: which it is tells the piece */
    of_condition.operands[2] = (Operand){.type = TYPE_FLOAT, .size = 1, .base = {1e9}};
    return trial_value(&of_condition, p).v[0] == 1e9;
}

static Sample sample_at(const Made *made, const double p[3])
{
    Sample sample = {.value = value_at(made, p)};
    memcpy(sample.p, p, sizeof sample.p);
    trial_piece(&made->trial, p, sample.piece);
    if (made->trial.row.op == OP_select || made->trial.row.op == OP_guard)
        sample.piece[3] = chosen_piece(made, p);
    return sample;
}

static bool same_piece(const Sample *a, const Sample *b)
{
    return memcmp(a->piece, b->piece, sizeof a->piece) == 0;
}

static void random_samples(Bench *b, const Made *made, Sample *samples)
{
    for (int i = 0; i < POINTS; i++) {
        double p[3];
        for (int k = 0; k < 3; k++)
            p[k] = random_below(&b->random, 4)
                       ? random_between(&b->random, -made->trial.half[k], made->trial.half[k])
                       : (random_below(&b->random, 2) ? 1 : -1) * made->trial.half[k];
        samples[i] = sample_at(made, p);
    }
}

static bool is_usual(double a) { return fabs(a) <= 1e3; }

static bool slope_permits(const LaneSlope *slope, const Sample *a, const Sample *b)
{
    Range  change = range_of(0);
    double moved  = b->value - a->value;
    for (int k = 0; k < 3; k++)
        change = range_add(change, range_mul(slope->by[k], range_of(b->p[k] - a->p[k])));
    double slack = 1e-9 * (1 + fabs(a->value) + fabs(b->value) + range_largest(change));
    return moved >= change.low - slack && moved <= change.high + slack;
}

/* By Taylor's theorem, at the middle of two points. */
static bool hessian_permits(const LaneHessian *hessian, const Sample *a, const Sample *b,
                            const Sample *middle)
{
    static const int ROW[6] = {0, 1, 2, 1, 0, 0}, COLUMN[6] = {0, 1, 2, 2, 2, 1};
    double           moved = a->value + b->value - 2 * middle->value;
    Range            bend  = range_of(0);
    for (int i = 0; i < 6; i++) {
        double by = (b->p[ROW[i]] - a->p[ROW[i]]) * (b->p[COLUMN[i]] - a->p[COLUMN[i]]);
        bend      = range_add(bend, range_mul(hessian->by[i], range_of((i < 3 ? 0.25 : 0.5) * by)));
    }
    double slack = 1e-9 * (1 + fabs(a->value) + fabs(b->value) + range_largest(bend));
    return moved >= bend.low - slack && moved <= bend.high + slack;
}

static Range drawn_in(Range range, double share)
{
    double middle = range.low / 2 + range.high / 2;
    if (share == 1)
        return range;
    return (Range){middle + share * (range.low - middle), middle + share * (range.high - middle)};
}

/* ---- what is refuted ---- */

static bool range_is_refuted(const Made *made, const Sample *samples, double share)
{
    Range range = drawn_in(lane_ranges_output(&made->lanes, &made->ranges, 0), share);
    bool  wrong = false;
    for (int i = 0; i < POINTS; i++)
        wrong = wrong || (isnan(samples[i].value)
                              ? made->sure
                              : samples[i].value < range.low || samples[i].value > range.high);
    return wrong;
}

static bool slope_is_refuted(const Made *made, const Sample *samples, double share)
{
    LaneSlope slope = made->slope;
    bool      wrong = false;
    for (int k = 0; k < 3; k++)
        slope.by[k] = (Range){share * slope.by[k].low, share * slope.by[k].high};
    for (int i = 1; i < POINTS; i++)
        wrong = wrong || (is_usual(samples[i].value) && is_usual(samples[i - 1].value) &&
                          same_piece(&samples[i], &samples[i - 1]) &&
                          !slope_permits(&slope, &samples[i - 1], &samples[i]));
    return wrong;
}

static bool hessian_is_refuted(const Made *made, const Sample *samples, double share)
{
    LaneHessian hessian = made->hessian;
    bool        wrong   = false;
    for (int k = 0; k < 6; k++)
        hessian.by[k] = (Range){share * hessian.by[k].low, share * hessian.by[k].high};
    for (int i = 1; i < POINTS; i++) {
        const Sample *a = &samples[i - 1], *b = &samples[i];
        double        p[3];
        for (int k = 0; k < 3; k++)
            p[k] = a->p[k] / 2 + b->p[k] / 2;
        Sample middle = sample_at(made, p);
        wrong = wrong || (is_usual(a->value) && is_usual(b->value) && is_usual(middle.value) &&
                          same_piece(a, b) && same_piece(a, &middle) &&
                          !hessian_permits(&hessian, a, b, &middle));
    }
    return wrong;
}

static bool same_number(double a, double b)
{
    return memcmp(&a, &b, sizeof a) == 0 || (isnan(a) && isnan(b));
}

static bool gives_samples(const Made *made, const LaneTape *tape, const Sample *samples)
{
    double points[POINTS][3], results[POINTS];
    bool   same = true;
    for (int i = 0; i < POINTS; i++)
        memcpy(points[i], samples[i].p, sizeof points[i]);
    lane_run(tape, &made->work, LANE_DOUBLE,
             (LanePoints){.points = (const double(*)[3])points, .count = POINTS}, 0, 1, results);
    for (int i = 0; i < POINTS; i++)
        same = same && same_number(results[i], samples[i].value);
    return same;
}

/* NULL: nothing. */
static const char *refutation(Bench *b, const Made *made, const Sample *samples)
{
    const LaneSet *sets;
    bool           same = true;
    for (size_t set = lane_sets(&sets); set-- > 0;) {
        lane_use_set(&sets[set]);
        same = same && gives_samples(made, &made->lanes, samples);
    }
    lane_use_set(NULL);
    LaneTape shorter = lane_prune(&made->lanes, &made->ranges, 1, &b->arena);
    if (!same || !gives_samples(made, &shorter, samples))
        return same ? "a pruned value" : "a value";
    if (range_is_refuted(made, samples, 1))
        return "a range";
    if (made->bounded && slope_is_refuted(made, samples, 1))
        return "a derivative";
    return made->bent && hessian_is_refuted(made, samples, 1) ? "a second derivative" : NULL;
}

/* ---- tests ---- */

/* All but identities, which are no numbers, and what reads tables (lane_instances.c). */
static bool is_tried(Op op)
{
    return op_rows[op].name && !strchr(op_rows[op].signature, 'u') &&
           !op_has_traits(op, READS_TABLES) && !op_has_traits(op, OF_HOST);
}

static bool is_moving(const Made *made)
{
    double most = 0;
    for (int k = 0; k < 3; k++)
        most = fmax(most, range_largest(made->slope.by[k]));
    return made->bounded && most > 0;
}

static void count(const Made *made, const Sample *samples, Tally *tally)
{
    tally->sure += made->sure;
    tally->moving += is_moving(made);
    tally->bent += is_moving(made) && made->bent;
    tally->curved += made->bent && !made->hessian.flat;
    tally->less_range += range_is_refuted(made, samples, 0.7);
    tally->less_slope += made->bounded && slope_is_refuted(made, samples, 0.7);
    tally->less_hessian += made->bent && hessian_is_refuted(made, samples, 0.5);
}

static void keeps_its_promises(void **state)
{
    Op    op    = *(Op *)*state;
    void *bench = NULL;
    Tally tally = {0};
    bench_start(&bench);
    for (int trial = 0; trial < TRIALS; trial++) {
        Sample samples[POINTS];
        Made   made = make(bench, op_rows[op]);
        random_samples(bench, &made, samples);
        const char *wrong = refutation(bench, &made, samples);
        if (wrong)
            fail_msg("%s: %s of trial %d is refuted", op_rows[op].name, wrong, trial);
        count(&made, samples, &tally);
    }
    bench_stop(&bench);
    if (op == OP_footprint || op == OP_footprint_axes)
        return; /* they are 0, whatever is said of them */
    assert_true(tally.sure > TRIALS / 8 && tally.less_range > 0);
    assert_true(tally.moving == 0 || tally.less_slope > 0);
    assert_true(tally.curved == 0 || tally.less_hessian > 0);
    /* What moves has second derivatives: no row is weaker than another. */
    assert_true(tally.moving == 0 || !number_rows[op].arity || tally.bent > 0);
}

int main(void)
{
    static Op         ops[OP_COUNT];
    struct CMUnitTest tests[OP_COUNT];
    size_t            tried = 0;
    for (Op op = 0; op < OP_COUNT; op++)
        if (is_tried(op)) {
            ops[op]        = op;
            tests[tried++] = (struct CMUnitTest){graph_op_name(op), keeps_its_promises, NULL, NULL,
                                                 &ops[op]};
        }
    return _cmocka_run_group_tests("rows of lanes", tests, tried, NULL, NULL);
}
