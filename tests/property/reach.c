/*
 * reach.c: the bounds of kernel-reflection sequences hold, and are tight.
 *
 * Random sequences go through reach_tighten stage by stage, as bound_sequence in shapes.c calls it,
 * from correct but loose bounds of the tests' own.  All their instances are copied one by one:
 * no point that the mirrors leave may lie outside of box or ball, and no side of the box much
 * farther out than the kernels' boxes, copied without being clipped (the search does not clip
 * either).  To show that the judge would notice a wrong search, it also judges searches that are
 * broken on purpose: each must be refuted.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "tests/property/reach_instances.h"

/* ---- searches broken on purpose ---- */

/* What is wrong with a copy of the search. */
typedef enum Fault {
    REAL, /* no copy: reach_tighten itself */
    RIGHT_COPY,
    MIRRORED_WITH_WRONG_SIGN,
    MOVED_WITH_WRONG_SIGN,
    MAP_NOT_TRANSPOSED,
    MAP_NOT_SHIFTED,
    BALL_WITHOUT_SCALE, /* takes every direction to be of unit length */
    IMAGES_FORGOTTEN,
    KERNELS_FORGOTTEN, /* all but the last one */
    ENDED_TOO_EARLY,   /* as if there were nothing in what was not opened */
    BALL_TOO_SMALL,
    NOTHING_DONE,
    FAULT_COUNT
} Fault;

typedef struct Copy {
    const ReachStage *stages;
    Fault             fault;
    double            reached;
    int               opened;
} Copy;

static double copy_bound(const ReachStage *stage, const double u[3], Fault fault)
{
    double length = fault == BALL_WITHOUT_SCALE ? 1 : sqrt(dot3(u, u));
    double ball = dot3(u, stage->ball.centre) + stage->ball.radius * length, box = 0;
    for (int i = 0; i < 3; i++)
        box += fmax(u[i] * stage->box.axis[i].low, u[i] * stage->box.axis[i].high);
    return is_empty(stage->box) ? -HUGE_VAL : fmin(ball, box);
}

/* Instance by instance, depth first; skips what cannot reach farther. */
static void copy_search(Copy *copy, uint32_t count, const double u[3], double excess)
{
    Fault fault = copy->fault;
    if (count == 0 || (copy->opened++ > 20 && fault == ENDED_TOO_EARLY))
        return;
    const ReachStage *stage = &copy->stages[count - 1];
    if (copy_bound(stage, u, fault) + excess <= copy->reached)
        return;
    double v[3] = {u[0], u[1], u[2]}, sign = fault == MIRRORED_WITH_WRONG_SIGN ? -1 : 1;
    if (stage->kind == REACH_KERNEL) {
        double reach = excess;
        for (int i = 0; i < 3; i++)
            reach += fmax(u[i] * stage->kernel.axis[i].low, u[i] * stage->kernel.axis[i].high);
        if (!is_empty(stage->kernel))
            copy->reached = fmax(copy->reached, reach);
        if (fault == KERNELS_FORGOTTEN && !is_empty(stage->kernel))
            return;
    } else if (stage->kind == REACH_REFLECT && fault != IMAGES_FORGOTTEN) {
        double along = dot3(u, stage->normal);
        for (int i = 0; i < 3; i++)
            v[i] -= sign * 2 * along * stage->normal[i];
        sign = fault == MOVED_WITH_WRONG_SIGN ? -1 : 1;
        copy_search(copy, count - 1, v, excess + sign * 2 * along * stage->offset);
    } else if (stage->kind == REACH_MAP) {
        for (int i = 0; i < 3; i++) {
            double column[3] = {stage->rows[0][i], stage->rows[1][i], stage->rows[2][i]};
            v[i]             = dot3(u, fault == MAP_NOT_TRANSPOSED ? stage->rows[i] : column);
        }
        excess += fault == MAP_NOT_SHIFTED ? 0 : dot3(u, stage->shift);
    }
    copy_search(copy, count - 1, stage->kind == REACH_MAP ? v : u, excess);
}

static void copy_tighten(ReachStage *stages, uint32_t count, Fault fault)
{
    ReachStage *last = &stages[count - 1];
    double      more = 1e-9 * (1 + diagonal(last->box)), longest = 0;
    Box         box = last->box;
    if (is_empty(box) || fault == NOTHING_DONE)
        return;
    for (int i = 0; i < 3; i++) {
        double u[3] = {i == 0, i == 1, i == 2}, back[3] = {-u[0], -u[1], -u[2]};
        Copy   high = {stages, fault, -HUGE_VAL, 0}, low = high;
        copy_search(&high, count, u, 0);
        copy_search(&low, count, back, 0);
        box.axis[i].high = fmin(box.axis[i].high, high.reached + more);
        box.axis[i].low  = fmax(box.axis[i].low, -low.reached - more);
        longest          = fmax(longest, box.axis[i].high - box.axis[i].low);
    }
    last->box     = is_empty(box) ? box_empty : box;
    double radius = 0.5 * (fault == BALL_TOO_SMALL ? longest : diagonal(box) + more);
    if (is_empty(box))
        last->ball = no_ball;
    else if (radius < last->ball.radius)
        last->ball = (Ball){{middle(box.axis[0]), middle(box.axis[1]), middle(box.axis[2])},
                            radius};
}

/* ---- the judge ---- */

/* What all calls have told: after how many a point was outside, and how many left a side too far out. */
typedef struct Verdict {
    int    calls, outside, loose;
    double farthest; /* of all sides, in diagonals */
} Verdict;

typedef struct Bench {
    InstanceTable clipped, whole;
} Bench;

static bool instance_is_inside(const InstanceTable *group, Box box, Ball ball)
{
    for (size_t i = 0; i < group->count; i++)
        for (int k = 0; k < POINTS; k++) {
            const double *p = group->items[i].points[k];
            if (!in_box(box, p) || !in_ball(ball, p))
                return false;
        }
    return true;
}

static Box instance_box(const InstanceTable *group)
{
    Box box = box_empty;
    for (size_t i = 0; i < group->count; i++)
        for (int k = 0; k < CORNERS; k++)
            include(&box, group->items[i].points[k]);
    return box;
}

static void compare(const Bench *bench, const ReachStage *stage, Verdict *verdict)
{
    Box    box = stage->box, exact = instance_box(&bench->whole);
    double far = 0;
    for (int i = 0; i < 3 && !is_empty(box); i++) {
        far = fmax(far, (box.axis[i].high - exact.axis[i].high) / diagonal(exact));
        far = fmax(far, (exact.axis[i].low - box.axis[i].low) / diagonal(exact));
    }
    bool wide = !is_empty(box) && stage->ball.radius > 0.5000001 * diagonal(box);
    verdict->calls++;
    verdict->outside += !instance_is_inside(&bench->clipped, box, stage->ball);
    verdict->loose += !(far <= LOOSE) || wide;
    verdict->farthest = fmax(verdict->farthest, far);
}

static void judge_sequence(Bench *bench, Random *random, Fault fault, Verdict *verdict)
{
    ReachStage stages[MAX_STAGES];
    uint32_t   count     = 3 + random_below(random, MAX_STAGES - 2);
    bool       cut       = random_below(random, 2);
    bench->clipped.count = bench->whole.count = 0;
    for (uint32_t i = 0; i < count; i++) {
        ReachStage *stage = &stages[i], *before = i > 0 ? stage - 1 : NULL;
        *stage          = random_stage(random, before);
        Instance kernel = random_instance(random, stage->kernel);
        grow_group(&bench->clipped, stage, &kernel);
        grow_group(&bench->whole, stage, &kernel);
        bound_loosely(stage, before, cut);
        loosen(random, stage);
        if (stage->kind != REACH_REFLECT)
            continue;
        if (fault == REAL)
            reach_tighten(stages, i + 1);
        else
            copy_tighten(stages, i + 1, fault);
        compare(bench, stage, verdict);
    }
}

static Bench *new_bench(void)
{
    static Bench bench;
    bench.clipped.clipped = true;
    bench.clipped.count = bench.whole.count = 0;
    return &bench;
}

static Verdict judge(Fault fault, int sequences)
{
    Bench  *bench   = new_bench();
    Verdict verdict = {0};
    Random  random  = {20};
    for (int i = 0; i < sequences; i++)
        judge_sequence(bench, &random, fault, &verdict);
    return verdict;
}

/* ---- random sequences: the tests ---- */

/* The search ends within a part of the loose box's diagonal, so a box that was far too large (it
   takes eight times; seen once in 40,000) may keep a looser side.  With so few mirrors no search
   is cut short: none of these opens more than about a hundred branches. */
static void random_sequences_are_bounded_tightly(void **state)
{
    (void)state;
    Verdict verdict = judge(REAL, 600);
    print_message("# %d boxes, %d with a side farther out than %g %% of the diagonal, "
                  "the farthest %.2f %%\n",
                  verdict.calls, verdict.loose, 100 * LOOSE, 100 * verdict.farthest);
    assert_true(verdict.calls > 2000);
    assert_int_equal(verdict.outside, 0);
    assert_true(100 * verdict.loose <= verdict.calls);
}

static void broken_searches_are_refuted(void **state)
{
    (void)state;
    Verdict right = judge(RIGHT_COPY, 200);
    assert_int_equal(right.outside + right.loose, 0);
    for (Fault fault = RIGHT_COPY + 1; fault < FAULT_COUNT; fault++) {
        Verdict verdict = judge(fault, 200);
        int     noticed = fault == NOTHING_DONE ? verdict.loose : verdict.outside;
        if (noticed == 0)
            fail_msg("fault %d is not noticed in %d calls", (int)fault, verdict.calls);
    }
}

/* A kernel under eleven mirrors.  The bounds of the last stage are somewhat too large, those of the
   stages before so much that they exclude nothing, and `factor` times more stage by stage. */
static void make_boundless(Bench *bench, Random *random, double factor, ReachStage *stages)
{
    bench->clipped.count = bench->whole.count = 0;
    for (int i = 0; i < MAX_STAGES; i++) {
        ReachStage *stage  = &stages[i];
        Instance    kernel = {0};
        *stage             = (ReachStage){.kind = i == 0 ? REACH_KERNEL : REACH_REFLECT};
        if (i == 0) {
            stage->kernel = (Box){{{-1, 1}, {-2, 2}, {-1, 1}}};
            kernel        = random_instance(random, stage->kernel);
        } else {
            random_mirror(random, stages[i - 1].box, stage);
        }
        grow_group(&bench->clipped, stage, &kernel);
        grow_group(&bench->whole, stage, &kernel);
        stage->box  = instance_box(&bench->whole);
        stage->ball = (Ball){.radius = HUGE_VAL};
    }
    for (int i = 0; i < MAX_STAGES; i++) {
        bool   last = i == MAX_STAGES - 1;
        double more = diagonal(stages[i].box) * (last ? 0.3 : 100 * pow(factor, MAX_STAGES - i));
        for (int k = 0; k < 3; k++)
            stages[i].box.axis[k] = (Range){stages[i].box.axis[k].low - more,
                                            stages[i].box.axis[k].high + more};
    }
}

/* Such a search runs out of branches (or, when what is opened last promises most, of steps) and
   has to be content with the bound it was given; but it must not be wrong. */
static void searches_cut_short_are_safe(void **state)
{
    (void)state;
    Bench  *bench   = new_bench();
    Random  random  = {28};
    Verdict verdict = {0};
    for (int turn = 0; turn < 20; turn++) {
        ReachStage stages[MAX_STAGES];
        make_boundless(bench, &random, turn % 2 == 0 ? 1 : 4, stages);
        reach_tighten(stages, MAX_STAGES);
        compare(bench, &stages[MAX_STAGES - 1], &verdict);
    }
    assert_int_equal(verdict.outside, 0);
    assert_int_equal(verdict.loose, verdict.calls); /* they were cut short */
}

/* ---- what can be said in one line ---- */

static const Box unit_box = {{{0, 1}, {0, 1}, {0, 1}}};

static const Box void_box = {{{0, 1}, {2, 1}, {0, 1}}};

static const Box wide_box = {{{-9, 9}, {-9, 9}, {-9, 9}}};

static ReachStage kernel_stage(Box kernel, Box loose)
{
    return (ReachStage){
        .kind = REACH_KERNEL, .kernel = kernel, .box = loose, .ball = {{0, 0, 0}, 20}};
}

static ReachStage mirror_stage(double x, double y, double z, double offset, Box loose)
{
    return (ReachStage){.kind   = REACH_REFLECT,
                        .normal = {x, y, z},
                        .offset = offset,
                        .box    = loose,
                        .ball   = {{0, 0, 0}, 20}};
}

/* The box holds the expected one, and is larger by no more than the search may leave. */
static void assert_close(Box box, Box expected)
{
    for (int i = 0; i < 3; i++) {
        assert_true(box.axis[i].low <= expected.axis[i].low);
        assert_true(box.axis[i].high >= expected.axis[i].high);
        assert_true(box.axis[i].low > expected.axis[i].low - 0.005 * diagonal(wide_box));
        assert_true(box.axis[i].high < expected.axis[i].high + 0.005 * diagonal(wide_box));
    }
}

static void empty_kernels_reach_nowhere(void **state)
{
    (void)state;
    ReachStage loose[] = {kernel_stage(void_box, wide_box), mirror_stage(1, 0, 0, 2, wide_box),
                          kernel_stage(box_empty, wide_box), mirror_stage(0, 1, 0, 2, wide_box)};
    reach_tighten(loose, 4);
    assert_true(is_empty(loose[3].box) && loose[3].ball.radius < 0);

    ReachStage exact[] = {kernel_stage(void_box, box_empty), mirror_stage(1, 0, 0, 2, box_empty)};
    exact[1].ball      = no_ball;
    reach_tighten(exact, 2);
    assert_true(is_empty(exact[1].box) && exact[1].ball.radius < 0);
}

static void single_kernels_reach_as_far_as_they_are(void **state)
{
    (void)state;
    ReachStage alone = kernel_stage(unit_box, wide_box);
    reach_tighten(&alone, 1);
    assert_close(alone.box, unit_box);
    assert_true(alone.ball.radius <= 0.51 * diagonal(alone.box));

    Box        both     = {{{0, 4}, {0, 1}, {0, 1}}};
    ReachStage stages[] = {kernel_stage(void_box, wide_box), kernel_stage(unit_box, wide_box),
                           kernel_stage(box_empty, wide_box), mirror_stage(1, 0, 0, 2, wide_box)};
    reach_tighten(stages, 4);
    assert_close(stages[3].box, both);
    assert_true(stages[3].ball.radius <= 0.51 * diagonal(stages[3].box));
}

static void infinite_boxes_are_left_alone(void **state)
{
    (void)state;
    Box half = {{{-HUGE_VAL, 5}, {0, 1}, {0, 1}}}, line = half;
    line.axis[0].high         = HUGE_VAL;
    ReachStage lines[]        = {kernel_stage(line, line), mirror_stage(0, 1, 0, 2, line)};
    lines[1].box.axis[1].high = 4;
    lines[1].ball             = (Ball){{0, 0, 0}, HUGE_VAL};
    ReachStage before         = lines[1];
    reach_tighten(lines, 2);
    assert_memory_equal(&lines[1].box, &before.box, sizeof before.box);
    assert_memory_equal(&lines[1].ball, &before.ball, sizeof before.ball);

    /* What x >= -1 keeps of a half line is finite, but no search can know. */
    ReachStage cut[] = {kernel_stage(half, half), mirror_stage(-1, 0, 0, 1, wide_box)};
    cut[0].ball      = lines[1].ball;
    reach_tighten(cut, 2);
    assert_close(cut[1].box, (Box){{{-9, 9}, {0, 1}, {0, 1}}});
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_sequences_are_bounded_tightly),
        cmocka_unit_test(broken_searches_are_refuted),
        cmocka_unit_test(searches_cut_short_are_safe),
        cmocka_unit_test(empty_kernels_reach_nowhere),
        cmocka_unit_test(single_kernels_reach_as_far_as_they_are),
        cmocka_unit_test(infinite_boxes_are_left_alone),
    };
    return cmocka_run_group_tests_name("reach", tests, NULL, NULL);
}
