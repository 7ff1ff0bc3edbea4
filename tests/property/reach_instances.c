/*
 * reach_instances.c: random kernel-reflection sequences, and all their instances copied one by one.
 */
#include "tests/property/reach_instances.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

static void random_unit(Random *random, double u[3])
{
    do
        for (int i = 0; i < 3; i++)
            u[i] = random_between(random, -1, 1);
    while (dot3(u, u) < 0.01 || dot3(u, u) > 1);
    normalize3(u);
}

/* ---- points, boxes and balls, the plain way ---- */

const Ball no_ball = {{0, 0, 0}, -1};

bool is_empty(Box box)
{
    return box.axis[0].low > box.axis[0].high || box.axis[1].low > box.axis[1].high ||
           box.axis[2].low > box.axis[2].high;
}

double diagonal(Box box)
{
    double sum = 0;
    for (int i = 0; i < 3 && !is_empty(box); i++)
        sum += pow(box.axis[i].high - box.axis[i].low, 2);
    return sqrt(sum);
}

double middle(Range side) { return 0.5 * (side.low + side.high); }

/* Corner 0 .. 7, a bit an axis. */
static void corner_of(Box box, int corner, double p[3])
{
    for (int i = 0; i < 3; i++)
        p[i] = corner >> i & 1 ? box.axis[i].high : box.axis[i].low;
}

void include(Box *box, const double p[3])
{
    for (int i = 0; i < 3; i++)
        box->axis[i] = (Range){fmin(box->axis[i].low, p[i]), fmax(box->axis[i].high, p[i])};
}

bool in_box(Box box, const double p[3])
{
    for (int i = 0; i < 3; i++)
        if (!(p[i] >= box.axis[i].low && p[i] <= box.axis[i].high))
            return false;
    return true;
}

bool in_ball(Ball ball, const double p[3])
{
    double offset[3] = {p[0] - ball.centre[0], p[1] - ball.centre[1], p[2] - ball.centre[2]};
    return sqrt(dot3(offset, offset)) <= ball.radius;
}

double excess(const ReachStage *mirror, const double p[3])
{
    return dot3(mirror->normal, p) - mirror->offset;
}

void reflect(const ReachStage *mirror, double p[3])
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

static void reflect_group(InstanceTable *group, const ReachStage *mirror)
{
    size_t kept = 0;
    for (size_t i = 0; i < group->count; i++) {
        Instance instance = group->items[i];
        if (!group->clipped || cut_instance(&instance, mirror))
            group->items[kept++] = instance;
    }
    assert_true(2 * kept <= MAX_INSTANCES);
    for (size_t i = 0; i < kept; i++) {
        Instance *image = &group->items[kept + i];
        *image          = group->items[i];
        for (int k = 0; k < POINTS; k++)
            reflect(mirror, image->points[k]);
    }
    group->count = 2 * kept;
}

void grow_group(InstanceTable *group, const ReachStage *stage, const Instance *kernel)
{
    if (stage->kind == REACH_REFLECT)
        reflect_group(group, stage);
    if (stage->kind == REACH_KERNEL && !is_empty(stage->kernel)) {
        assert_true(group->count < MAX_INSTANCES);
        group->items[group->count++] = *kernel;
    }
    for (size_t i = 0; i < group->count && stage->kind == REACH_MAP; i++)
        for (int k = 0; k < POINTS; k++)
            map(stage, group->items[i].points[k]);
}

/* ---- sequences at random ---- */

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

Instance random_instance(Random *random, Box box)
{
    Instance instance;
    for (int k = 0; k < POINTS; k++) {
        corner_of(box, k % CORNERS, instance.points[k]);
        for (int i = 0; i < 3 && k >= CORNERS; i++)
            instance.points[k][i] = random_between(random, box.axis[i].low, box.axis[i].high);
    }
    return instance;
}

void random_mirror(Random *random, Box before, ReachStage *stage)
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

ReachStage random_stage(Random *random, const ReachStage *before)
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

/* Returns the box around a box, or only what a mirror keeps of it, and the mirror image. */
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
        double offset[3];
        for (int i = 0; i < 3; i++) {
            kernel.centre[i] = middle(stage->kernel.axis[i]);
            offset[i]        = kernel.centre[i] - ball.centre[i];
        }
        if (ball.radius < 0)
            return kernel;
        ball.radius = fmax(ball.radius, sqrt(dot3(offset, offset)) + kernel.radius);
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

void bound_loosely(ReachStage *stage, const ReachStage *before, bool cut)
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

void loosen(Random *random, ReachStage *stage)
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
