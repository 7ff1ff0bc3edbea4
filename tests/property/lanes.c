/*
 * lanes.c: lane tapes give what tapes give, bit for bit, on every instruction set of this machine;
 * ranges over boxes hold what is found in them; what is pruned for a box is the same in it.
 *
 * Graphs are made at random from every operation there is.  What is pruned for a smaller box than the one
 * it is asked in must be seen to be wrong.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

#include "compiler/graph/lanes/lanes.h"

#include "tests/property/garden.h"

enum { GRAPHS = 300, POINTS = 45, ROOTS = 3, NODES = 60 };

/* Some expressions of one graph, as a tape and as a lane tape. */
typedef struct Pair {
    Tape       tape;
    NodeValue *values;
    LaneTape   lanes;
    LaneWork   work;
    Node       roots[ROOTS];
} Pair;

/* Makes the tapes of the roots. */
static void pair_finish(Bench *b, Pair *pair, const NodeValue *parameters)
{
    pair->tape   = tape_new(b->graph, pair->roots, ROOTS, &b->arena);
    pair->values = arena_new_array(&b->arena, NodeValue, b->graph->count);
    tape_run_frame(&pair->tape, parameters, pair->values);
    pair->lanes         = lane_tape_new(&pair->tape, pair->roots, ROOTS, false, 0, &b->arena);
    pair->lanes.scalars = arena_new_array(&b->arena, double, pair->lanes.scalar_count + 1);
    lane_tape_scalars(&pair->lanes, pair->values, pair->lanes.scalars);
    pair->work = lane_work_in(arena_alloc(&b->arena, lane_work_bytes(&pair->lanes), 1),
                              pair->values);
}

static void pair_make(Bench *b, Pair *pair)
{
    b->graph      = graph_new(&b->arena);
    Garden garden = random_garden(b, NODES);
    Place  place  = random_place(b);
    for (int i = 0; i < ROOTS; i++)
        pair->roots[i] = garden.nodes[garden.count - 1 - random_below(&b->random, 20)];
    pair_finish(b, pair, place.parameters);
}

/* Mostly usual coordinates, and those that operations may stumble over. */
static double random_coordinate(Bench *b)
{
    static const double odd[] = {0, -0.0, 1, -1, 0.5, 1e-300, 1e200, -1e200, 1e-160};
    return random_below(&b->random, 8) ? random_between(&b->random, -2, 2)
                                       : odd[random_below(&b->random, 9)];
}

static void random_points(Bench *b, double (*points)[3], size_t count)
{
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            points[i][k] = random_coordinate(b);
}

static bool same_number(double a, double b)
{
    return memcmp(&a, &b, sizeof a) == 0 || (isnan(a) && isnan(b));
}

/* ---- points ---- */

/* Returns how many outputs differ from what the tape finds. */
static size_t count_different(const Pair *pair, const double (*points)[3], size_t count,
                              const double *results)
{
    size_t different = 0, outputs = pair->lanes.output_count;
    for (size_t i = 0; i < count; i++) {
        size_t output = 0;
        tape_run_point(&pair->tape, points[i], pair->values);
        for (int root = 0; root < ROOTS; root++)
            for (uint32_t k = 0; k < components(pair->tape.graph->items[pair->roots[root]].type);
                 k++)
                different += !same_number(pair->values[pair->roots[root]].v[k],
                                          results[i * outputs + output++]);
    }
    return different;
}

static void lanes_give_what_tapes_give(void **state)
{
    Bench         *b = *state;
    const LaneSet *sets;
    size_t         count = lane_sets(&sets);
    for (int turn = 0; turn < GRAPHS; turn++) {
        Pair   pair;
        double points[POINTS][3];
        pair_make(b, &pair);
        random_points(b, points, POINTS);
        double *results = arena_new_array(&b->arena, double, POINTS *pair.lanes.output_count);
        for (size_t set = 0; set < count; set++)
            for (size_t some = 1; some <= POINTS; some += 11) {
                lane_use_set(&sets[set]);
                lane_run(&pair.lanes, &pair.work, LANE_DOUBLE,
                         (LanePoints){.points = (const double(*)[3])points, .count = some}, 0,
                         pair.lanes.output_count, results);
                if (count_different(&pair, (const double(*)[3])points, some, results))
                    fail_msg("graph %d on %s is different", turn, sets[set].name);
            }
        lane_use_set(NULL);
    }
}

/* ---- boxes ---- */

static Box random_box(Bench *b)
{
    Box    box;
    double half = pow(2, -random_between(&b->random, 0, 6));
    for (int k = 0; k < 3; k++) {
        double middle = random_between(&b->random, -2, 2);
        box.axis[k]   = (Range){middle - half, middle + half};
    }
    return box;
}

/* Returns the value at one point; NAN: none. */
static double first_output(const Pair *pair, const double point[3])
{
    double result;
    lane_run(&pair->lanes, &pair->work, LANE_DOUBLE,
             (LanePoints){.points = (const double(*)[3])point, .count = 1}, 0, 1, &result);
    return result;
}

/* By the mean value theorem: how far the values at two points of the box are outside of what derivatives
   permit, as far as rounding does not explain it. */
static bool slope_permits(const Pair *pair, const LaneSlope *slope, const double a[3],
                          const double b[3])
{
    double from = first_output(pair, a), to = first_output(pair, b);
    Range  change = range_of(0);
    for (int k = 0; k < 3; k++)
        change = range_add(change, range_mul(slope->by[k], range_of(b[k] - a[k])));
    double slack = 1e-9 * (1 + fabs(from) + fabs(to) + range_largest(change));
    return !isfinite(from) || !isfinite(to) || fabs(from) > 1e6 || fabs(to) > 1e6 ||
           (to - from >= change.low - slack && to - from <= change.high + slack);
}

static void points_in(Bench *b, Box box, double (*points)[3]);

/* Between their pieces these may jump. */
static bool has_pieces(const LaneTape *tape)
{
    for (size_t i = 0; i < tape->count; i++)
        if (tape->steps[i].op == OP_cell || tape->steps[i].op == OP_select ||
            tape->steps[i].op == OP_guard)
            return true;
    for (size_t i = 0; i < tape->call_count; i++)
        if (tape->tape->graph->items[tape->calls[i].node].op == OP_cell_polar)
            return true;
    return false;
}

static size_t boundless;

/* Rounding hides that from those who ask ranges alone. */
static bool is_constant(const LaneSlope *slope)
{
    bool constant = true;
    for (int j = 0; j < 3; j++)
        constant = constant && slope->by[j].low == 0 && slope->by[j].high == 0;
    return constant;
}

/* Derivatives of a box, tried between points of another one.  Returns how many are not permitted. */
static size_t try_slopes(Bench *b, const Pair *pair, Box known, Box looked, bool *bounded)
{
    double     points[POINTS][3];
    size_t     wrong  = 0;
    LaneRanges ranges = lane_ranges_new(&pair->lanes, &b->arena);
    LaneSlope *slopes = lane_slopes_new(&pair->lanes, &b->arena), slope;
    lane_ranges_run(&pair->lanes, &ranges, known);
    *bounded   = lane_slopes_run(&pair->lanes, &ranges, slopes, &slope);
    bool clear = lane_is_boundless(&pair->lanes, &ranges, pair->lanes.outputs[0]);
    assert_false(clear && *bounded && !is_constant(&slope));
    boundless += clear;
    *bounded = *bounded && !has_pieces(&pair->lanes);
    points_in(b, looked, points);
    for (int i = 1; *bounded && i < POINTS; i++)
        wrong += !slope_permits(pair, &slope, points[i - 1], points[i]);
    return wrong;
}

static Box half_of(Box box)
{
    for (int k = 0; k < 3; k++)
        box.axis[k].high = box.axis[k].low / 2 + box.axis[k].high / 2;
    return box;
}

static void points_in(Bench *b, Box box, double (*points)[3])
{
    for (int i = 0; i < POINTS; i++)
        for (int k = 0; k < 3; k++)
            points[i][k] = random_below(&b->random, 6) == 0
                               ? (random_below(&b->random, 2) ? box.axis[k].low : box.axis[k].high)
                               : random_between(&b->random, box.axis[k].low, box.axis[k].high);
}

static bool holds(Range range, double number)
{
    return isnan(number) || (range.low <= number && number <= range.high);
}

/* What is known of many graphs in many boxes. */
typedef struct Tally {
    size_t steps, left, calls, outside, different, unsure;
} Tally;

/* Ranges and a pruned tape of one box, looked at in the points of another one. */
static void try_box(Bench *b, Pair *pair, Box known, Box looked, Tally *tally)
{
    double     points[POINTS][3];
    size_t     outputs = pair->lanes.output_count;
    LaneRanges ranges  = lane_ranges_new(&pair->lanes, &b->arena);
    double    *whole   = arena_new_array(&b->arena, double, POINTS *outputs);
    double    *pruned  = arena_new_array(&b->arena, double, POINTS *outputs);
    lane_ranges_run(&pair->lanes, &ranges, known);
    LaneTape shorter = lane_prune(&pair->lanes, &ranges, outputs, &b->arena);
    assert_true(shorter.rows <= lane_max_rows(&pair->lanes));
    assert_true(shorter.count <= lane_max_steps(&pair->lanes));
    points_in(b, looked, points);
    LanePoints all = {.points = (const double(*)[3])points, .count = POINTS};
    lane_run(&pair->lanes, &pair->work, LANE_DOUBLE, all, 0, outputs, whole);
    lane_run(&shorter, &pair->work, LANE_DOUBLE, all, 0, outputs, pruned);
    for (size_t i = 0; i < POINTS * outputs; i++) {
        Range    range = lane_ranges_output(&pair->lanes, &ranges, i % outputs);
        uint32_t value = pair->lanes.outputs[i % outputs];
        tally->outside += !holds(range, whole[i]);
        tally->different += !same_number(whole[i], pruned[i]);
        tally->unsure += !(value & LANE_SCALAR) && ranges.sure[value] && isnan(whole[i]);
    }
    tally->steps += pair->lanes.count;
    tally->left += shorter.count;
    tally->calls += shorter.call_count;
}

static void ranges_hold_and_pruning_changes_nothing(void **state)
{
    Bench *b     = *state;
    Tally  tally = {0};
    for (int turn = 0; turn < 4 * GRAPHS; turn++) {
        Pair pair;
        Box  box = random_box(b);
        pair_make(b, &pair);
        try_box(b, &pair, box, box, &tally);
        if (tally.outside + tally.different + tally.unsure)
            fail_msg("graph %d: %zu outside, %zu different, %zu not numbers", turn, tally.outside,
                     tally.different, tally.unsure);
    }
    print_message("# %zu of %zu steps are left\n", tally.left, tally.steps);
    assert_true(tally.left < 0.9 * (double)tally.steps);
}

static const double tau = 6.283185307179586;

/* Returns a box about a place that is this far around the y axis, from x to z. */
static Box box_around(double angle, double half)
{
    double x = 1.05 * cos(angle), z = 1.05 * sin(angle);
    return (Box){{{x - half, x + half}, {-0.1, 0.1}, {z - half, z + half}}};
}

/* Copies around an axis are a call, whose rule knows values only where their number is the same everywhere.
   Within one sector it is a turn, and no call is left. */
static void copies_around_an_axis_have_ranges(void **state)
{
    Bench *b    = *state;
    Box    box  = {{{1, 1.1}, {-0.1, 0.1}, {-0.4, 0.4}}};
    Pair   pair = {0};
    b->graph    = graph_new(&b->arena);
    for (int i = 0; i < ROOTS; i++)
        pair.roots[i] = graph_op2(b->graph, OP_cell_polar, graph_leaf(b->graph, OP_POINT),
                                  graph_number(b->graph, 7));
    pair_finish(b, &pair, NULL);
    LaneRanges ranges = lane_ranges_new(&pair.lanes, &b->arena);
    lane_ranges_run(&pair.lanes, &ranges, box);
    for (size_t i = 0; i < 3; i++) {
        Range range = lane_ranges_output(&pair.lanes, &ranges, i);
        assert_true(range.low >= -1.2 && range.high <= 1.2);
    }
    Tally tally = {0};
    try_box(b, &pair, box, box, &tally);
    for (int i = 0; i < 7; i++)
        try_box(b, &pair, box_around(i * tau / 7, 0.2), box_around(i * tau / 7, 0.2), &tally);
    assert_true(tally.outside + tally.different + tally.unsure == 0);
    assert_true(tally.calls == 0);
    Box border = box_around(0.5 * tau / 7, 0.2);
    try_box(b, &pair, border, border, &tally);
    assert_true(tally.outside + tally.different + tally.unsure == 0);
    assert_true(tally.calls > 0);
}

/* abs(x - c round(x / c)), as a product with the reciprocal, or with another factor, when it is none. */
static Node distance_to_multiples(Graph *graph, double period, double factor)
{
    Node x     = graph_component(graph, graph_leaf(graph, OP_POINT), 0);
    Node count = graph_op1(graph, OP_round,
                           graph_op2(graph, OP_mul, x, graph_number(graph, factor)));
    return graph_op1(
        graph, OP_abs,
        graph_op2(graph, OP_sub, x, graph_op2(graph, OP_mul, count, graph_number(graph, period))));
}

/* Ranges of distances to multiples hold; they are as narrow as the values, where steps alone know nothing. */
static void ranges_of_waves_hold(void **state)
{
    static const double PERIOD = 0.3, FACTORS[2] = {1 / 0.3, 3};
    Bench              *b = *state;
    for (int turn = 0; turn < 2 * GRAPHS; turn++) {
        Pair   pair  = {0};
        Tally  tally = {0};
        double at = random_between(&b->random, -3, 3), half = random_between(&b->random, 0, 0.2);
        Box    box  = {{{at - half, at + half}, {0, 0}, {0, 0}}};
        Range  seen = {INFINITY, 0};
        b->graph    = graph_new(&b->arena);
        for (int i = 0; i < ROOTS; i++)
            pair.roots[i] = distance_to_multiples(b->graph, PERIOD, FACTORS[turn % 2]);
        pair_finish(b, &pair, NULL);
        LaneRanges ranges = lane_ranges_new(&pair.lanes, &b->arena);
        lane_ranges_run(&pair.lanes, &ranges, box);
        try_box(b, &pair, box, box, &tally);
        assert_true(tally.outside + tally.different + tally.unsure == 0);
        for (int i = 0; i <= 1000; i++) {
            double x = at + half * (0.002 * i - 1), off = fabs(x - PERIOD * round(x / PERIOD));
            seen = (Range){fmin(seen.low, off), fmax(seen.high, off)};
        }
        Range range = lane_ranges_output(&pair.lanes, &ranges, 0);
        if (turn % 2 == 0)
            assert_true(range.low >= seen.low - 0.001 && range.high <= seen.high + 0.001);
    }
}

/* Tapers leave quotients of a length with itself, once it is known where it is clamped. */
static void quotients_with_themselves_are_one(void **state)
{
    Bench *b    = *state;
    Pair   pair = {0};
    b->graph    = graph_new(&b->arena);
    Node x      = graph_component(b->graph, graph_leaf(b->graph, OP_POINT), 0);
    Node y      = graph_op2(b->graph, OP_min, x, graph_number(b->graph, 3));
    for (int i = 0; i < ROOTS; i++)
        pair.roots[i] = graph_op2(b->graph, OP_div, y, x);
    pair_finish(b, &pair, NULL);
    for (int i = 0; i < 100; i++) {
        Tally      tally  = {0};
        double     low    = random_between(&b->random, -2, 2.9);
        Box        box    = {{{low, random_between(&b->random, low, 2.9)}, {0, 1}, {0, 1}}};
        LaneRanges ranges = lane_ranges_new(&pair.lanes, &b->arena);
        lane_ranges_run(&pair.lanes, &ranges, box);
        LaneTape shorter = lane_prune(&pair.lanes, &ranges, 1, &b->arena);
        lane_ranges_run(&shorter, &ranges, box);
        Range range = lane_ranges_output(&shorter, &ranges, 0);
        bool  zero  = box.axis[0].low <= 0 && box.axis[0].high >= 0;
        assert_true(zero ? range.low < 1 && range.high > 1 : range.low == 1 && range.high == 1);
        try_box(b, &pair, box, box, &tally);
        assert_true(tally.outside + tally.different + tally.unsure == 0);
    }
}

static void what_is_pruned_for_less_is_seen(void **state)
{
    Bench *b     = *state;
    Tally  tally = {0};
    for (int turn = 0; turn < GRAPHS; turn++) {
        Pair pair;
        Box  box = random_box(b);
        pair_make(b, &pair);
        try_box(b, &pair, half_of(box), box, &tally);
    }
    assert_true(tally.outside > 100);
    assert_true(tally.different > 100);
}

static void slopes_hold(void **state)
{
    Bench *b       = *state;
    size_t bounded = 0, wrong = 0;
    for (int turn = 0; turn < 4 * GRAPHS; turn++) {
        Pair pair;
        Box  box = random_box(b);
        bool known;
        pair_make(b, &pair);
        if (try_slopes(b, &pair, box, box, &known))
            fail_msg("graph %d changes faster than its derivatives", turn);
        bounded += known;
        wrong += try_slopes(b, &pair, half_of(box), box, &known) > 0;
    }
    print_message("# %zu of %d have bounds; %zu are wrong outside of their boxes; %zu boundless\n",
                  bounded, 4 * GRAPHS, wrong, boundless);
    assert_true(bounded > GRAPHS && wrong > 50 && boundless > 10);
}

/* ---- second derivatives ---- */

/* By Taylor's theorem at the middle of two points: how far the values there are from twice the value in the middle is what
   the second derivatives permit along the way. */
static bool hessian_permits(const Pair *pair, const LaneHessian *hessian, const double a[3],
                            const double b[3])
{
    static const int ROW[6] = {0, 1, 2, 1, 0, 0}, COLUMN[6] = {0, 1, 2, 2, 2, 1};
    double           middle[3];
    for (int k = 0; k < 3; k++)
        middle[k] = a[k] / 2 + b[k] / 2;
    double from = first_output(pair, a), to = first_output(pair, b),
           at     = first_output(pair, middle);
    double change = from + to - 2 * at;
    Range  bend   = range_of(0);
    for (int i = 0; i < 6; i++)
        bend = range_add(bend, range_mul(hessian->by[i],
                                         range_of((i < 3 ? 0.25 : 0.5) * (b[ROW[i]] - a[ROW[i]]) *
                                                  (b[COLUMN[i]] - a[COLUMN[i]]))));
    double slack = 1e-9 * (1 + fabs(from) + fabs(to) + fabs(at) + range_largest(bend));
    return !isfinite(change) || fabs(from) > 1e6 || fabs(to) > 1e6 || fabs(at) > 1e6 ||
           (change >= bend.low - slack && change <= bend.high + slack);
}

/* Returns those of a box, tried between points of another one, as many times as wide; a share of
   what is known may be left out.  Returns how many are not permitted. */
static size_t try_hessians(Bench *b, const Pair *pair, Box known, Box looked, double share,
                           bool *bounded)
{
    double       points[POINTS][3];
    size_t       wrong    = 0;
    LaneRanges   ranges   = lane_ranges_new(&pair->lanes, &b->arena);
    LaneSlope   *slopes   = lane_slopes_new(&pair->lanes, &b->arena), slope;
    LaneHessian *hessians = lane_hessians_new(&pair->lanes, &b->arena), hessian;
    lane_ranges_run(&pair->lanes, &ranges, known);
    *bounded = lane_slopes_run(&pair->lanes, &ranges, slopes, &slope) &&
               lane_hessians_run(&pair->lanes, &ranges, slopes, hessians, &hessian) &&
               !has_pieces(&pair->lanes) && !hessian.flat;
    for (int i = 0; *bounded && i < 6; i++) {
        hessian.by[i].low *= share;
        hessian.by[i].high *= share;
    }
    points_in(b, looked, points);
    for (int i = 1; *bounded && i < POINTS; i++)
        wrong += !hessian_permits(pair, &hessian, points[i - 1], points[i]);
    return wrong;
}

static void hessians_hold(void **state)
{
    Bench *b       = *state;
    size_t bounded = 0, wrong = 0, halved = 0;
    for (int turn = 0; turn < 12 * GRAPHS; turn++) {
        Pair pair;
        Box  box = random_box(b);
        bool known;
        pair_make(b, &pair);
        if (try_hessians(b, &pair, box, box, 1, &known))
            fail_msg("graph %d bends more than its second derivatives", turn);
        bounded += known;
        wrong += try_hessians(b, &pair, half_of(box), box, 1, &known) > 0;
        halved += try_hessians(b, &pair, box, box, 0.5, &known) > 0;
    }
    print_message("# %zu of %d have bounds; %zu are wrong outside of their boxes, %zu if halved\n",
                  bounded, 12 * GRAPHS, wrong, halved);
    assert_true(bounded > GRAPHS / 2 && wrong > 20 && halved > 50);
}

/* What random graphs seldom have: roots, lengths with corners that do not count, blends, faces of boxes, segments. */
typedef enum Form {
    ROOT,
    LENGTH,
    CUT_LENGTH,
    BLEND_QUADRATIC,
    BLEND_CUBIC,
    BLEND_EXPONENTIAL,
    FACE,
    LENGTH_OF_ONE,
    QUOTIENT,
    POWER,
    SEGMENT,
    FORMS,
    ASKEW_SEGMENT =
        FORMS /* not the nearest point of it: there is a corner where t meets its bounds */
} Form;

/* |q + e - t d| with t = (q + e).d / d.d from 0 to 1, of which about a half is in the box; e keeps it away from the segment
   itself. */
static Node distance_to_segment(Graph *g, const Node q[3], Box box, double askew)
{
    double x = box.axis[0].high - box.axis[0].low, y = box.axis[1].high - box.axis[1].low;
    Node   along[3] = {graph_number(g, x), graph_number(g, 0.5 * y), graph_number(g, 0)};
    Node   away[3]  = {q[0], q[1], graph_op2(g, OP_add, q[2], graph_number(g, 2))};
    Node   from = graph_op(g, OP_vec3, away), way = graph_op(g, OP_vec3, along);
    Node   share   = graph_op2(g, OP_add, graph_op2(g, OP_dot, from, way),
                               graph_op2(g, OP_mul, q[1], graph_number(g, askew * y)));
    Node   part    = graph_op2(g, OP_div, share, graph_number(g, x * x + 0.25 * y * y));
    Node   clamped = graph_op3(g, OP_clamp, part, graph_number(g, 0), graph_number(g, 1));
    return graph_op1(g, OP_length,
                     graph_op2(g, OP_sub, from, graph_op2(g, OP_scale, way, clamped)));
}

static Node form_node(Graph *g, Form form, Box box)
{
    Node p[3], q[3], zero = graph_number(g, 0), width = graph_number(g, 0.7);
    for (uint32_t k = 0; k < 3; k++) {
        p[k] = graph_component(g, graph_leaf(g, OP_POINT), k);
        q[k] = graph_op2(g, OP_sub, p[k],
                         graph_number(g, 0.5 * (box.axis[k].low + box.axis[k].high)));
    }
    Node far    = graph_op2(g, OP_add, q[0], graph_number(g, 2));
    Node a      = graph_op1(g, OP_sin, graph_op2(g, OP_add, p[0], p[1]));
    Node c      = graph_op1(g, OP_cos, graph_op2(g, OP_mul, p[1], p[2]));
    Node cut[3] = {far, graph_op2(g, OP_max, q[1], zero), graph_op1(g, OP_abs, q[2])};
    switch (form) {
    case ROOT: return graph_op1(g, OP_sqrt, graph_op2(g, OP_add, graph_op1(g, OP_square, far), a));
    case LENGTH: {
        Node parts[3] = {far, a, c};
        return graph_op1(g, OP_length, graph_op(g, OP_vec3, parts));
    }
    case CUT_LENGTH: return graph_op1(g, OP_length, graph_op(g, OP_vec3, cut));
    case BLEND_QUADRATIC: return graph_op3(g, OP_smin_quadratic, a, c, width);
    case BLEND_CUBIC: return graph_op3(g, OP_smin_cubic, a, c, width);
    case BLEND_EXPONENTIAL: return graph_op3(g, OP_smin_exponential, a, c, width);
    case FACE: {
        Node half[3] = {graph_op2(g, OP_max, q[0], zero), zero, zero};
        Node bent    = graph_op2(g, OP_add, graph_op1(g, OP_length, graph_op(g, OP_vec3, half)),
                                 graph_op2(g, OP_min, q[0], zero));
        return graph_op2(g, OP_add, bent, a);
    }
    case LENGTH_OF_ONE: {
        Node one[3] = {zero, graph_op1(g, OP_neg, graph_op1(g, OP_square, far)), zero};
        return graph_op2(g, OP_add, graph_op1(g, OP_length, graph_op(g, OP_vec3, one)), a);
    }
    case QUOTIENT: return graph_op2(g, OP_div, a, far);
    case SEGMENT: return graph_op2(g, OP_add, distance_to_segment(g, q, box, 0), a);
    case ASKEW_SEGMENT: return graph_op2(g, OP_add, distance_to_segment(g, q, box, 0.5), a);
    default: return graph_op2(g, OP_pow, far, graph_number(g, 2.5));
    }
}

/* How many graphs of one kind have second derivatives that hold, and of how many half of them would not. */
typedef struct Held {
    size_t bounded, halved;
} Held;

typedef Node MakeNode(Bench *b, const void *kind, Box box);

static Held try_graphs(Bench *b, MakeNode *make, const void *kind, const char *name, int turns)
{
    Held held = {0, 0};
    for (int turn = 0; turn < turns; turn++) {
        Pair pair = {0};
        Box  box  = random_box(b);
        bool known;
        b->graph = graph_new(&b->arena);
        for (int i = 0; i < ROOTS; i++)
            pair.roots[i] = make(b, kind, box);
        pair_finish(b, &pair, NULL);
        if (try_slopes(b, &pair, box, box, &known))
            fail_msg("%s grows faster than its derivatives", name);
        if (try_hessians(b, &pair, box, box, 1, &known))
            fail_msg("%s bends more than its second derivatives", name);
        held.bounded += known;
        held.halved += try_hessians(b, &pair, box, box, 0.5, &known) > 0;
    }
    print_message("# %s: %zu of %d have bounds, %zu are wrong if halved\n", name, held.bounded,
                  turns, held.halved);
    return held;
}

static Node make_form(Bench *b, const void *form, Box box)
{
    return form_node(b->graph, *(const Form *)form, box);
}

static void hessians_of_forms_hold(void **state)
{
    static const char *const NAMES[FORMS] = {"a root",           "a length",
                                             "a length of cuts", "a quadratic blend",
                                             "a cubic blend",    "an exponential blend",
                                             "a face",           "a length of one",
                                             "a quotient",       "a power",
                                             "a segment"};
    for (Form form = ROOT; form < FORMS; form++) {
        Held held = try_graphs(*state, make_form, &form, NAMES[form], 40);
        assert_true(held.bounded >= 20 && held.halved > 0);
    }
}

typedef struct Row {
    Op          op;
    uint32_t    arity;
    const char *name;
    bool        steps; /* it is the same in parts of the box, and jumps */
} Row;

static const Row ROWS_OF_TABLE[] = {
#define MAP(name, arity, called, glsl, value, range, da, db, dc, norm, meaning) \
    {OP_##name, arity, #name,                                                   \
     OP_##name == OP_sign || OP_##name == OP_floor || OP_##name == OP_ceil ||   \
         OP_##name == OP_round || OP_##name == OP_step},
#include "compiler/graph/ops.def"
};

/* Operands wave between 0.1 and 0.9, where all operations are defined; smoothstep goes from one number to another. */
static Node make_row(Bench *b, const void *kind, Box box)
{
    const Row *row = kind;
    Graph     *g   = b->graph;
    (void)box;
    Node operands[MAX_OPERANDS];
    for (uint32_t k = 0; k < row->arity; k++) {
        Node way    = graph_vec3(g, random_between(&b->random, -2, 2),
                                 random_between(&b->random, -2, 2), random_between(&b->random, -2, 2));
        Node wave   = graph_op1(g, OP_sin, graph_op2(g, OP_dot, graph_leaf(g, OP_POINT), way));
        operands[k] = graph_op2(g, OP_add, graph_number(g, random_between(&b->random, 0.3, 0.7)),
                                graph_op2(g, OP_mul, graph_number(g, 0.2), wave));
        if (row->op == OP_smoothstep && k < 2)
            operands[k] = graph_number(g, k == 0 ? 0.05 : 0.95);
    }
    return graph_op(g, row->op, operands);
}

/* Each row of ops.def has right second derivatives, and where it does not jump it has some. */
static void hessians_of_rows_hold(void **state)
{
    for (size_t i = 0; i < sizeof ROWS_OF_TABLE / sizeof *ROWS_OF_TABLE; i++) {
        const Row *row  = &ROWS_OF_TABLE[i];
        Held       held = try_graphs(*state, make_row, row, row->name, 60);
        assert_true(row->steps || (held.bounded >= 10 && held.halved > 0));
    }
}

static void corners_have_no_second_derivatives(void **state)
{
    static const Form askew = ASKEW_SEGMENT;
    try_graphs(*state, make_form, &askew, "a segment askew", 40);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(lanes_give_what_tapes_give, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(ranges_hold_and_pruning_changes_nothing, bench_start,
                                        bench_stop),
        cmocka_unit_test_setup_teardown(copies_around_an_axis_have_ranges, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(ranges_of_waves_hold, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(quotients_with_themselves_are_one, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(what_is_pruned_for_less_is_seen, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(slopes_hold, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(hessians_hold, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(hessians_of_forms_hold, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(hessians_of_rows_hold, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(corners_have_no_second_derivatives, bench_start,
                                        bench_stop),
    };
    return cmocka_run_group_tests_name("lanes", tests, NULL, NULL);
}
