/*
 * search_targets.c: where an operation branches, jumps or is steepest, and the way there.
 *
 * An operation is a target there: a comparison where both sides are equal, a quotient where its
 * divisor is 0, an exponential where its argument is largest.  From a random point, steps along the
 * gradient of that expression lead there, also into a region too thin for random points to meet.
 */
#include "compiler/refute/search_targets.h"

#include <math.h>
#include <string.h>

#include "compiler/base/vec.h"
#include "compiler/refute/search_pairs.h"

static double target_value(const Search *s, const Target *t)
{
    const double *a = s->values[t->a].v, *b = s->values[t->b].v, *c = s->values[t->c].v;
    double        x = a[t->component];
    switch (t->goal) {
    case GOAL_EQUAL: return x - b[t->component];
    case GOAL_ZERO:
    case GOAL_HIGH: return x;
    case GOAL_WHOLE: return x - floor(x + 0.5);
    case GOAL_HALF: return x - floor(x) - 0.5;
    case GOAL_UNIT: return fabs(x) - 1;
    case GOAL_FRONT: return dot3(a, b) - c[0];
    case GOAL_WALL: return x / b[t->component] - floor(x / b[t->component]) - 0.5;
    }
    return 0;
}

double target_at(Search *s, const Target *t, double p[3])
{
    distance_at(s, p);
    return target_value(s, t);
}

/* ---- what is worth looking at in one operation: the column `target` of ops.def ---- */

/* A list of targets that grows, and an operation to look at. */
typedef struct Prospect {
    Search      *search;
    Arena       *arena;
    const Graph *graph;
    const Expr  *e;
} Prospect;

static void add_target(const Prospect *p, Goal goal, int a, int b)
{
    const Expr *items = p->graph->items;
    Node        of = p->e->operands[a], by = p->e->operands[b];
    if (items[of].time != TIME_POINT && items[by].time != TIME_POINT)
        return;
    uint32_t count = items[of].type <= TYPE_VEC4 && goal != GOAL_FRONT ? items[of].type : 1;
    for (uint32_t k = 0; k < count; k++) {
        Target target = {goal, of, by, goal == GOAL_FRONT ? p->e->operands[2] : of, k};
        array_push(p->arena, &p->search->targets, target);
    }
}

static void target_none(const Prospect *p) { (void)p; }
static void target_equal(const Prospect *p) { add_target(p, GOAL_EQUAL, 0, 1); }
static void target_zero(const Prospect *p) { add_target(p, GOAL_ZERO, 0, 0); }
static void target_divisor(const Prospect *p) { add_target(p, GOAL_ZERO, 1, 1); }
static void target_whole(const Prospect *p) { add_target(p, GOAL_WHOLE, 0, 0); }
static void target_half(const Prospect *p) { add_target(p, GOAL_HALF, 0, 0); }
static void target_unit(const Prospect *p) { add_target(p, GOAL_UNIT, 0, 0); }
static void target_high(const Prospect *p) { add_target(p, GOAL_HIGH, 0, 0); }
static void target_front(const Prospect *p) { add_target(p, GOAL_FRONT, 0, 1); }
static void target_walls(const Prospect *p) { add_target(p, GOAL_WALL, 0, 1); }

static void target_zeros(const Prospect *p)
{
    target_zero(p);
    target_divisor(p);
}

static void target_limits(const Prospect *p)
{
    target_equal(p);
    add_target(p, GOAL_EQUAL, 0, 2);
}

static void target_edges(const Prospect *p)
{
    add_target(p, GOAL_EQUAL, 2, 0);
    add_target(p, GOAL_EQUAL, 2, 1);
}

static void target_guard(const Prospect *p)
{
    const Node *o     = p->e->operands;
    Guard       guard = {{GOAL_ZERO, o[0], o[0], o[0], 0}, {GOAL_ZERO, o[2], o[2], o[2], 0}};
    array_push(p->arena, &p->search->guards, guard);
}

static void (*const targets[OP_COUNT])(const Prospect *p) = {
#define RULES(name, cost, traits, simplify, derive, local, series, parity, rebase, target) \
    [OP_##name] = target,
#include "compiler/graph/ops.def"
};

void add_targets(Search *s, Arena *arena, const Graph *g, const Expr *e)
{
    if (e->operand_count > 0)
        targets[e->op](&(Prospect){s, arena, g, e});
}

double target_slope(Search *s, const Target *t, const double p[3], double at, double gradient[3])
{
    double step = 1e-6 * s->size;
    for (int i = 0; i < 3; i++) {
        double beside[3] = {p[0], p[1], p[2]};
        beside[i] += step;
        gradient[i] = (target_at(s, t, beside) - at) / step;
    }
    return length3(gradient);
}

void drive_to_zero(Search *s, const Target *t, double p[3], double axis[3])
{
    double at = target_at(s, t, p);
    for (int i = 0; i < 10 && at != 0; i++) {
        double slope = target_slope(s, t, p, at, axis), next[3];
        if (!(slope > 0) || !isfinite(slope))
            return;
        double length = fmax(-0.5 * s->size, fmin(0.5 * s->size, at / slope));
        add_scaled3(next, p, -length / slope, axis);
        double then = target_at(s, t, next);
        if (!isfinite(then))
            return;
        for (int k = 0; k < 30 && are_sides_different(at, then); k++) {
            double middle[3];
            for (int d = 0; d < 3; d++)
                middle[d] = 0.5 * (p[d] + next[d]);
            double half  = target_at(s, t, middle);
            bool   first = are_sides_different(at, half);
            memcpy(first ? next : p, middle, sizeof middle);
            *(first ? &then : &at) = half;
        }
        bool arrived = distance3(p, next) < 1e-7 * s->size;
        memcpy(p, next, sizeof next);
        at = then;
        if (arrived)
            return;
    }
}

void drive_up(Search *s, const Target *t, double p[3], double axis[3])
{
    double at = target_at(s, t, p), step = 0.1 * s->size;
    for (int i = 0; i < 24 && step > 1e-5 * s->size; i++) {
        double slope = target_slope(s, t, p, at, axis), next[3];
        if (!(slope > 0) || !isfinite(slope))
            return;
        add_scaled3(next, p, step / slope, axis);
        double then = target_at(s, t, next);
        if (then > at) {
            memcpy(p, next, sizeof next);
            at = then;
            step *= 1.5;
        } else
            step *= 0.3;
    }
}
