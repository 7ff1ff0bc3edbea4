/*
 * reach.c: the bounds of kernel-reflection sequences hold, and are tight.
 *
 * Random sequences go through reach_tighten stage by stage, as bound_sequence in family/sequence_bounds.c calls it,
 * from correct but loose bounds of this file's own.  All their instances are copied one by one:
 * no point that the mirrors leave may lie outside of box or ball, and no side of the box much
 * farther out than the kernels' boxes, copied without being clipped (the search does not clip
 * either).  To show that the judge would notice a wrong search, it also judges searches that are
 * broken on purpose: each must be refuted.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <time.h>
#include <cmocka.h>

#include "compiler/base/vec.h"
#include "compiler/shape/reach.h"
#include "compiler/krs.h"

#include "tests/support/random.h"

static void random_unit(Random *random, double u[3])
{
    do
        for (int i = 0; i < 3; i++)
            u[i] = random_between(random, -1, 1);
    while (dot3(u, u) < 0.01 || dot3(u, u) > 1);
    normalize3(u);
}

/* ---- points, boxes and balls, the plain way ---- */

static const Ball no_ball = {{0, 0, 0}, -1};

static bool is_empty(Box box)
{
    return box.axis[0].low > box.axis[0].high || box.axis[1].low > box.axis[1].high ||
           box.axis[2].low > box.axis[2].high;
}

static double diagonal(Box box)
{
    double sum = 0;
    for (int i = 0; i < 3 && !is_empty(box); i++)
        sum += pow(box.axis[i].high - box.axis[i].low, 2);
    return sqrt(sum);
}

static double middle(Range side) { return 0.5 * (side.low + side.high); }

/* Corner 0 .. 7, a bit an axis. */
static void corner_of(Box box, int corner, double p[3])
{
    for (int i = 0; i < 3; i++)
        p[i] = corner >> i & 1 ? box.axis[i].high : box.axis[i].low;
}

static void include(Box *box, const double p[3])
{
    for (int i = 0; i < 3; i++)
        box->axis[i] = (Range){fmin(box->axis[i].low, p[i]), fmax(box->axis[i].high, p[i])};
}

static bool in_box(Box box, const double p[3])
{
    for (int i = 0; i < 3; i++)
        if (!(p[i] >= box.axis[i].low && p[i] <= box.axis[i].high))
            return false;
    return true;
}

static bool in_ball(Ball ball, const double p[3])
{
    double way[3] = {p[0] - ball.centre[0], p[1] - ball.centre[1], p[2] - ball.centre[2]};
    return sqrt(dot3(way, way)) <= ball.radius;
}

/* How far a point is in front of a mirror, where nothing is kept. */
static double excess(const ReachStage *mirror, const double p[3])
{
    return dot3(mirror->normal, p) - mirror->offset;
}

static void reflect(const ReachStage *mirror, double p[3])
{
    double twice = 2 * excess(mirror, p);
    for (int i = 0; i < 3; i++)
        p[i] -= twice * mirror->normal[i];
}

static void map(const ReachStage *stage, double p[3])
{
    double q[3] = {p[0], p[1], p[2]};
    for (int i = 0; i < 3; i++)
        p[i] = dot3(stage->rows[i], q) + stage->shift[i];
}

/* ---- every instance by itself ---- */

enum { CORNERS = 8, POINTS = 16, MOST_STAGES = 12, MOST_INSTANCES = 1 << (MOST_STAGES - 1) };

/* Points of the copy of a kernel's box: its corners, and others. */
typedef struct Instance {
    double points[POINTS][3];
} Instance;

/* All instances after some stages; `clipped`: only what the mirrors keep. */
typedef struct Crowd {
    bool     clipped;
    size_t   count;
    Instance items[MOST_INSTANCES];
} Crowd;

/* Moves each point in front of the mirror towards one behind it until it lies in the mirror: the
   instance is convex, so it still belongs to it.  False when the mirror keeps nothing. */
static bool cut_instance(Instance *instance, const ReachStage *mirror)
{
    double ahead[POINTS];
    int    kept = 0;
    for (int i = 0; i < POINTS; i++) {
        ahead[i] = excess(mirror, instance->points[i]);
        kept += ahead[i] <= 0;
    }
    for (int i = 0; i < POINTS && kept > 0; i++) {
        int j = i;
        while (ahead[j] > 0)
            j = (j + 1) % POINTS;
        if (j == i)
            continue;
        double *p = instance->points[i], *q = instance->points[j];
        for (int k = 0; k < 3; k++)
            p[k] += (q[k] - p[k]) * ahead[i] / (ahead[i] - ahead[j]);
    }
    return kept > 0;
}

static void reflect_crowd(Crowd *crowd, const ReachStage *mirror)
{
    size_t kept = 0;
    for (size_t i = 0; i < crowd->count; i++) {
        Instance instance = crowd->items[i];
        if (!crowd->clipped || cut_instance(&instance, mirror))
            crowd->items[kept++] = instance;
    }
    assert_true(2 * kept <= MOST_INSTANCES);
    for (size_t i = 0; i < kept; i++) {
        Instance *image = &crowd->items[kept + i];
        *image          = crowd->items[i];
        for (int k = 0; k < POINTS; k++)
            reflect(mirror, image->points[k]);
    }
    crowd->count = 2 * kept;
}

static void grow_crowd(Crowd *crowd, const ReachStage *stage, const Instance *kernel)
{
    if (stage->kind == REACH_REFLECT)
        reflect_crowd(crowd, stage);
    if (stage->kind == REACH_KERNEL && !is_empty(stage->kernel)) {
        assert_true(crowd->count < MOST_INSTANCES);
        crowd->items[crowd->count++] = *kernel;
    }
    for (size_t i = 0; i < crowd->count && stage->kind == REACH_MAP; i++)
        for (int k = 0; k < POINTS; k++)
            map(stage, crowd->items[i].points[k]);
}

/* ---- random sequences ---- */

static Box random_box(Random *random)
{
    Box  box;
    bool flat = random_below(random, 10) == 0;
    for (int i = 0; i < 3; i++) {
        double centre = random_between(random, -2, 2), half = random_between(random, 0.02, 1);
        half        = flat && i == 1 ? 0 : half;
        box.axis[i] = (Range){centre - half, centre + half};
    }
    if (random_below(random, 10) == 0)
        box.axis[random_below(random, 3)] = (Range){1, -1};
    return box;
}

static Instance random_instance(Random *random, Box box)
{
    Instance instance;
    for (int k = 0; k < POINTS; k++) {
        corner_of(box, k % CORNERS, instance.points[k]);
        for (int i = 0; i < 3 && k >= CORNERS; i++)
            instance.points[k][i] = random_between(random, box.axis[i].low, box.axis[i].high);
    }
    return instance;
}

/* A mirror that mostly cuts, or passes near to, what is in `before`. */
static void random_mirror(Random *random, Box before, ReachStage *stage)
{
    random_unit(random, stage->normal);
    if (random_below(random, 6) == 0) {
        int axis = (int)random_below(random, 3);
        for (int i = 0; i < 3; i++)
            stage->normal[i] = i == axis ? random_below(random, 2) * 2.0 - 1 : 0;
    }
    stage->offset = random_between(random, -0.3, 0.7) * diagonal(before);
    for (int i = 0; i < 3 && !is_empty(before); i++)
        stage->offset += stage->normal[i] * middle(before.axis[i]);
}

static void random_map(Random *random, ReachStage *stage)
{
    double other[3], scale = exp(random_between(random, -1, 0.7));
    random_unit(random, stage->rows[0]);
    random_unit(random, other);
    cross3(stage->rows[0], other, stage->rows[1]);
    normalize3(stage->rows[1]);
    cross3(stage->rows[0], stage->rows[1], stage->rows[2]);
    for (int i = 0; i < 3; i++) {
        stage->shift[i] = random_between(random, -2, 2);
        for (int j = 0; j < 3; j++)
            stage->rows[i][j] *= scale;
    }
}

static ReachStage random_stage(Random *random, const ReachStage *before)
{
    ReachStage stage = {.kind = REACH_MAP};
    uint32_t   dice  = random_below(random, 10);
    if (dice < 2 || (!before && dice < 9)) {
        stage.kind   = REACH_KERNEL;
        stage.kernel = random_box(random);
    } else if (dice < 8) {
        stage.kind = REACH_REFLECT;
        random_mirror(random, before ? before->box : box_empty, &stage);
    } else {
        random_map(random, &stage);
    }
    return stage;
}

/* ---- loose bounds ---- */

/* The box around a box, or only what a mirror keeps of it, and the mirror image. */
static Box fold_box(Box box, const ReachStage *mirror, bool cut)
{
    Box fold = box_empty;
    for (int i = 0; i < CORNERS; i++) {
        double p[3], ahead;
        corner_of(box, i, p);
        ahead = excess(mirror, p);
        for (int axis = 0; axis < 3 && cut && ahead > 0; axis++) {
            double q[3], back;
            corner_of(box, i ^ 1 << axis, q);
            back = excess(mirror, q);
            for (int k = 0; k < 3 && back <= 0; k++)
                q[k] = p[k] + (q[k] - p[k]) * ahead / (ahead - back);
            if (back <= 0)
                include(&fold, q);
        }
        if (cut && ahead > 0)
            continue;
        include(&fold, p);
        reflect(mirror, p);
        include(&fold, p);
    }
    return fold;
}

static Box loose_box(const ReachStage *stage, Box before, bool cut)
{
    Box box = stage->kind == REACH_KERNEL ? before : box_empty, from = before;
    if (stage->kind == REACH_KERNEL)
        from = stage->kernel;
    if (is_empty(from))
        return box;
    if (stage->kind == REACH_REFLECT)
        return fold_box(from, stage, cut);
    for (int i = 0; i < CORNERS; i++) {
        double p[3];
        corner_of(from, i, p);
        if (stage->kind == REACH_MAP)
            map(stage, p);
        include(&box, p);
    }
    return box;
}

static Ball loose_ball(const ReachStage *stage, Ball before)
{
    Ball ball = before;
    if (stage->kind == REACH_KERNEL && !is_empty(stage->kernel)) {
        Ball   kernel = {.radius = 0.5 * diagonal(stage->kernel)};
        double way[3];
        for (int i = 0; i < 3; i++) {
            kernel.centre[i] = middle(stage->kernel.axis[i]);
            way[i]           = kernel.centre[i] - ball.centre[i];
        }
        if (ball.radius < 0)
            return kernel;
        ball.radius = fmax(ball.radius, sqrt(dot3(way, way)) + kernel.radius);
    } else if (stage->kind == REACH_REFLECT && ball.radius >= 0) {
        double ahead = excess(stage, ball.centre);
        ball.radius += fabs(ahead);
        for (int i = 0; i < 3; i++)
            ball.centre[i] -= ahead * stage->normal[i];
    } else if (stage->kind == REACH_MAP) {
        map(stage, ball.centre);
        ball.radius *= sqrt(dot3(stage->rows[0], stage->rows[0]));
    }
    return ball;
}

/* Gives a stage bounds that follow from those of the stage before (NULL: nothing is there). */
static void bound_loosely(ReachStage *stage, const ReachStage *before, bool cut)
{
    stage->box  = loose_box(stage, before ? before->box : box_empty, cut);
    stage->ball = loose_ball(stage, before ? before->ball : no_ball);
    /* More than rounding. */
    double more = 1e-9 * (1 + diagonal(stage->box));
    for (int i = 0; i < 3 && !is_empty(stage->box); i++) {
        more = fmax(more, 1e-9 * fabs(stage->box.axis[i].low));
        stage->box.axis[i].low -= more;
        stage->box.axis[i].high += more;
    }
    if (stage->ball.radius >= 0)
        stage->ball.radius += more + 1e-9 * stage->ball.radius;
}

static void loosen(Random *random, ReachStage *stage)
{
    double size = diagonal(stage->box);
    for (int i = 0; i < 3 && !is_empty(stage->box); i++) {
        stage->box.axis[i].low -= random_between(random, 0, 0.1) * size;
        stage->box.axis[i].high += random_between(random, 0, 0.1) * size;
    }
    if (stage->ball.radius >= 0) {
        bool endless = random_below(random, 8) == 0;
        stage->ball.radius *= endless ? HUGE_VAL : random_between(random, 1, 1.2);
    }
}

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
static void copy_search(Copy *copy, uint32_t count, const double u[3], double beyond)
{
    Fault fault = copy->fault;
    if (count == 0 || (copy->opened++ > 20 && fault == ENDED_TOO_EARLY))
        return;
    const ReachStage *stage = &copy->stages[count - 1];
    if (copy_bound(stage, u, fault) + beyond <= copy->reached)
        return;
    double v[3] = {u[0], u[1], u[2]}, sign = fault == MIRRORED_WITH_WRONG_SIGN ? -1 : 1;
    if (stage->kind == REACH_KERNEL) {
        double reach = beyond;
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
        copy_search(copy, count - 1, v, beyond + sign * 2 * along * stage->offset);
    } else if (stage->kind == REACH_MAP) {
        for (int i = 0; i < 3; i++) {
            double column[3] = {stage->rows[0][i], stage->rows[1][i], stage->rows[2][i]};
            v[i]             = dot3(u, fault == MAP_NOT_TRANSPOSED ? stage->rows[i] : column);
        }
        beyond += fault == MAP_NOT_SHIFTED ? 0 : dot3(u, stage->shift);
    }
    copy_search(copy, count - 1, stage->kind == REACH_MAP ? v : u, beyond);
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

/* Of all calls: after how many a point was outside, and how many left a side too far out. */
typedef struct Verdict {
    int    calls, outside, loose;
    double farthest; /* of all sides, in diagonals */
} Verdict;

/* How far out a side may be, in diagonals of the exact box. */
static const double LOOSE = 0.02;

typedef struct Bench {
    Crowd clipped, whole;
} Bench;

static bool crowd_is_inside(const Crowd *crowd, Box box, Ball ball)
{
    for (size_t i = 0; i < crowd->count; i++)
        for (int k = 0; k < POINTS; k++) {
            const double *p = crowd->items[i].points[k];
            if (!in_box(box, p) || !in_ball(ball, p))
                return false;
        }
    return true;
}

static Box crowd_box(const Crowd *crowd)
{
    Box box = box_empty;
    for (size_t i = 0; i < crowd->count; i++)
        for (int k = 0; k < CORNERS; k++)
            include(&box, crowd->items[i].points[k]);
    return box;
}

static void compare(const Bench *bench, const ReachStage *stage, Verdict *verdict)
{
    Box    box = stage->box, exact = crowd_box(&bench->whole);
    double far = 0;
    for (int i = 0; i < 3 && !is_empty(box); i++) {
        far = fmax(far, (box.axis[i].high - exact.axis[i].high) / diagonal(exact));
        far = fmax(far, (exact.axis[i].low - box.axis[i].low) / diagonal(exact));
    }
    bool wide = !is_empty(box) && stage->ball.radius > 0.5000001 * diagonal(box);
    verdict->calls++;
    verdict->outside += !crowd_is_inside(&bench->clipped, box, stage->ball);
    verdict->loose += !(far <= LOOSE) || wide;
    verdict->farthest = fmax(verdict->farthest, far);
}

static void judge_sequence(Bench *bench, Random *random, Fault fault, Verdict *verdict)
{
    ReachStage stages[MOST_STAGES];
    uint32_t   count     = 3 + random_below(random, MOST_STAGES - 2);
    bool       cut       = random_below(random, 2);
    bench->clipped.count = bench->whole.count = 0;
    for (uint32_t i = 0; i < count; i++) {
        ReachStage *stage = &stages[i], *before = i > 0 ? stage - 1 : NULL;
        *stage          = random_stage(random, before);
        Instance kernel = random_instance(random, stage->kernel);
        grow_crowd(&bench->clipped, stage, &kernel);
        grow_crowd(&bench->whole, stage, &kernel);
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
    for (int i = 0; i < MOST_STAGES; i++) {
        ReachStage *stage  = &stages[i];
        Instance    kernel = {0};
        *stage             = (ReachStage){.kind = i == 0 ? REACH_KERNEL : REACH_REFLECT};
        if (i == 0) {
            stage->kernel = (Box){{{-1, 1}, {-2, 2}, {-1, 1}}};
            kernel        = random_instance(random, stage->kernel);
        } else {
            random_mirror(random, stages[i - 1].box, stage);
        }
        grow_crowd(&bench->clipped, stage, &kernel);
        grow_crowd(&bench->whole, stage, &kernel);
        stage->box  = crowd_box(&bench->whole);
        stage->ball = (Ball){.radius = HUGE_VAL};
    }
    for (int i = 0; i < MOST_STAGES; i++) {
        bool   last = i == MOST_STAGES - 1;
        double more = diagonal(stages[i].box) * (last ? 0.3 : 100 * pow(factor, MOST_STAGES - i));
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
        ReachStage stages[MOST_STAGES];
        make_boundless(bench, &random, turn % 2 == 0 ? 1 : 4, stages);
        reach_tighten(stages, MOST_STAGES);
        compare(bench, &stages[MOST_STAGES - 1], &verdict);
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

/* ---- trees ---- */

enum { MIRRORS = 28, TREE_STAGES = 2 * MIRRORS + 1 };

/* A branch of bench/scenes/tree.krs: where it begins, and its directions ahead and to the side. */
typedef struct Branch {
    double at[3], ahead[3], side[3];
} Branch;

/* Goes on along an arc that turns by twice `bend`; the box grows around what is passed. */
static Branch next_branch(Branch branch, int number, Box *box)
{
    const double degree = acos(-1) / 180, turn = 100 * degree;
    double       bend = (number == 0 ? 5 : 14) * degree, width = 0.075 * pow(0.75, number);
    double       reach = number == 0 ? 0.7 : pow(0.72, number), left[3], up[3];
    Branch       next  = branch;
    *box               = box_empty;
    for (int part = 0; part <= 2; part++) {
        double angle = 0.5 * bend * part, length = reach * sin(angle) / sin(bend);
        for (int i = 0; i < 3; i++)
            next.at[i] = branch.at[i] +
                         length * (cos(angle) * branch.ahead[i] + sin(angle) * branch.side[i]);
        include(box, next.at);
    }
    for (int i = 0; i < 3; i++) {
        box->axis[i].low -= width;
        box->axis[i].high += width;
        next.ahead[i] = cos(2 * bend) * branch.ahead[i] + sin(2 * bend) * branch.side[i];
        left[i]       = cos(2 * bend) * branch.side[i] - sin(2 * bend) * branch.ahead[i];
    }
    cross3(next.ahead, left, up);
    for (int i = 0; i < 3; i++)
        next.side[i] = cos(turn) * left[i] + sin(turn) * up[i];
    return next;
}

/* Kernel, mirror, kernel, ..., kernel, without bounds, from the last twig to the root. */
static void grow_tree(ReachStage stages[TREE_STAGES])
{
    const double lean = acos(-1) / 36, tilt = acos(-1) / 20;
    Branch       branch = {{0}, {-sin(lean), cos(lean), 0}, {cos(lean), sin(lean), 0}};
    for (int number = 0; number <= MIRRORS; number++) {
        ReachStage *kernel = &stages[TREE_STAGES - 1 - 2 * number];
        *kernel            = (ReachStage){.kind = REACH_KERNEL};
        if (number > 0) {
            ReachStage *mirror = kernel + 1;
            *mirror            = (ReachStage){.kind = REACH_REFLECT};
            for (int i = 0; i < 3; i++)
                mirror->normal[i] = -sin(tilt) * branch.ahead[i] - cos(tilt) * branch.side[i];
            mirror->offset = dot3(mirror->normal, branch.at);
        }
        branch = next_branch(branch, number, &kernel->kernel);
    }
}

/* A random point of a random instance; false when a mirror cut it off. */
static bool random_point(Random *random, const ReachStage stages[TREE_STAGES], double p[3])
{
    uint32_t     from = 2 * random_below(random, MIRRORS + 1);
    const Range *side = stages[from].kernel.axis;
    for (int i = 0; i < 3; i++)
        p[i] = random_between(random, side[i].low, side[i].high);
    for (uint32_t i = from + 1; i < TREE_STAGES; i += 2) {
        if (excess(&stages[i], p) > 0)
            return false;
        if (random_below(random, 2))
            reflect(&stages[i], p);
    }
    return true;
}

/* What 100,000 points of it show of a tree of 2^28 twigs, all of which must be within. */
static Box seen_of_tree(const ReachStage stages[TREE_STAGES])
{
    const ReachStage *last   = &stages[TREE_STAGES - 1];
    Random            random = {1};
    Box               seen   = box_empty;
    int               found  = 0;
    for (int i = 0; i < 100000; i++) {
        double p[3];
        if (!random_point(&random, stages, p))
            continue;
        assert_true(in_box(last->box, p) && in_ball(last->ball, p));
        include(&seen, p);
        found++;
    }
    assert_true(found > 50000);
    return seen;
}

static void trees_shrink_to_their_crowns(void **state)
{
    (void)state;
    ReachStage loose[TREE_STAGES], tight[TREE_STAGES];
    grow_tree(loose);
    grow_tree(tight);
    clock_t start = clock();
    for (uint32_t i = 0; i < TREE_STAGES; i++) {
        bound_loosely(&loose[i], i > 0 ? &loose[i - 1] : NULL, true);
        bound_loosely(&tight[i], i > 0 ? &tight[i - 1] : NULL, true);
        if (tight[i].kind == REACH_REFLECT)
            reach_tighten(tight, i + 1);
    }
    /* It takes about a millisecond; 2^28 instances one by one would take minutes. */
    assert_true(clock() - start < CLOCKS_PER_SEC);

    double wide = diagonal(loose[TREE_STAGES - 1].box), far = 0;
    Box    box = tight[TREE_STAGES - 1].box, seen = seen_of_tree(tight);
    for (int i = 0; i < 3; i++) {
        far = fmax(far, box.axis[i].high - seen.axis[i].high);
        far = fmax(far, seen.axis[i].low - box.axis[i].low);
    }
    print_message("# tree of %d mirrors: diagonal %.3f, when loose %.3f; "
                  "at most %.3f beyond what is seen\n",
                  MIRRORS, diagonal(box), wide, far);
    assert_true(diagonal(box) < 0.6 * wide);
    assert_true(far < LOOSE * diagonal(seen));
}

/* ---- a scene ---- */

/* Goes from one point to another until it is inside of a solid; false when it never is.  Nothing
   solid may be met outside of the box. */
static bool walk(KrsFrame *frame, Box box, const double from[3], const double to[3], double p[3])
{
    double way[3] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]}, distance, t = 0;
    double length = sqrt(dot3(way, way));
    while (t < 2 * length) {
        for (int i = 0; i < 3; i++)
            p[i] = from[i] + way[i] * t / length;
        krs_distance(frame, (const double(*)[3])p, 1, &distance);
        assert_true(distance > 0 || in_box(box, p));
        if (distance <= 0)
            return true;
        t += fmax(distance, 1e-4);
    }
    return false;
}

/* Random points around the box, of up to `far` diagonals. */
static void random_outside(Random *random, Box box, double far, double p[3])
{
    do
        for (int i = 0; i < 3; i++) {
            double more = far * diagonal(box);
            p[i]        = random_between(random, box.axis[i].low - more, box.axis[i].high + more);
        }
    while (in_box(box, p));
}

/* What 2,000 walks from around a box into it meet. */
static Box seen_of_scene(KrsFrame *frame, Box box)
{
    Box    seen   = box_empty;
    Random random = {3};
    for (int i = 0; i < 2000; i++) {
        double from[3], to[3], p[3];
        random_outside(&random, box, 0.2, from);
        for (int k = 0; k < 3; k++)
            to[k] = random_between(&random, box.axis[k].low, box.axis[k].high);
        if (walk(frame, box, from, to, p))
            include(&seen, p);
    }
    return seen;
}

/* Distances know nothing of the box, so they can refute it: what is shown may neither stick out
   nor, since the walks come close to every side, leave much of the box empty. */
static void nothing_solid_is_outside_of_reported_bounds(void **state)
{
    (void)state;
    KrsScene    *scene;
    KrsFrame    *frame;
    KrsComponent tree;
    assert_int_equal(krs_compile_file("bench/scenes/tree28.krs", NULL, &scene), KRS_OK);
    assert_int_equal(krs_frame_new(scene, &frame), KRS_OK);
    assert_int_equal(krs_component_count(scene), 1);
    assert_int_equal(krs_component(scene, 0, &tree), KRS_OK);
    Box box = {
        {{tree.low[0], tree.high[0]}, {tree.low[1], tree.high[1]}, {tree.low[2], tree.high[2]}}};
    Random random = {4};
    for (int i = 0; i < 10000; i++) {
        double p[3], distance;
        random_outside(&random, box, i % 2 == 0 ? 0.01 : 0.5, p);
        krs_distance(frame, (const double(*)[3])p, 1, &distance);
        assert_true(distance > 0);
    }
    Box seen = seen_of_scene(frame, box);
    for (int i = 0; i < 3; i++) {
        assert_true(box.axis[i].high - seen.axis[i].high < 0.05 * diagonal(box));
        assert_true(seen.axis[i].low - box.axis[i].low < 0.05 * diagonal(box));
    }
    krs_frame_free(frame);
    krs_scene_free(scene);
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
        cmocka_unit_test(trees_shrink_to_their_crowns),
        cmocka_unit_test(nothing_solid_is_outside_of_reported_bounds),
    };
    return cmocka_run_group_tests_name("reach", tests, NULL, NULL);
}
