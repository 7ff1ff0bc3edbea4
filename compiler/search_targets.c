/*
 * search_targets.c: where an operation branches, jumps or is steepest, and the way there.
 *
 * An operation is a target there: a comparison where both sides are equal, a quotient where its
 * divisor is 0, an exponential where its argument is largest.  From a random point, steps along the
 * gradient of that expression lead there, also into a region too thin for random points to meet.
 */
#include "compiler/searching.h"

#include <math.h>
#include <string.h>

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
    case GOAL_FRONT: return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] - c[0];
    case GOAL_WALL: return x / b[t->component] - floor(x / b[t->component]) - 0.5;
    }
    return 0;
}

double target_at(Search *s, const Target *t, double p[3])
{
    distance_at(s, p);
    return target_value(s, t);
}

static void add_target(Search *s, Arena *arena, Goal goal, const Graph *g, const Expr *e, int a,
                       int b)
{
    Node of = e->operands[a];
    if (g->items[of].time != TIME_POINT && g->items[e->operands[b]].time != TIME_POINT)
        return;
    uint32_t count = g->items[of].type <= TYPE_VEC4 && goal != GOAL_FRONT ? g->items[of].type : 1;
    for (uint32_t k = 0; k < count; k++) {
        Target target = {goal, of, e->operands[b], goal == GOAL_FRONT ? e->operands[2] : of, k};
        array_push(arena, &s->targets, target);
    }
}

static void add_guard(Search *s, Arena *arena, const Expr *e)
{
    Guard guard = {{GOAL_ZERO, e->operands[0], e->operands[0], e->operands[0], 0},
                   {GOAL_ZERO, e->operands[2], e->operands[2], e->operands[2], 0}};
    array_push(arena, &s->guards, guard);
}

/* Whether an operation chooses between its first two operands. */
static bool branches_where_equal(Op op)
{
    switch (op) {
    case OP_less:
    case OP_less_equal:
    case OP_equal:
    case OP_not_equal:
    case OP_min:
    case OP_max:
    case OP_step:
    case OP_smin_quadratic:
    case OP_smin_cubic:
    case OP_smin_circular:
    case OP_smin_exponential:
    case OP_smin_chamfer:
    case OP_smin_stairs: return true;
    default: return false;
    }
}

void add_targets(Search *s, Arena *arena, const Graph *g, const Expr *e)
{
    if (branches_where_equal((Op)e->op)) {
        add_target(s, arena, GOAL_EQUAL, g, e, 0, 1);
        return;
    }
    switch ((Op)e->op) {
    case OP_clamp:
        add_target(s, arena, GOAL_EQUAL, g, e, 0, 1);
        add_target(s, arena, GOAL_EQUAL, g, e, 0, 2);
        break;
    case OP_smoothstep:
        add_target(s, arena, GOAL_EQUAL, g, e, 2, 0);
        add_target(s, arena, GOAL_EQUAL, g, e, 2, 1);
        break;
    case OP_pow:
    case OP_atan2:
        add_target(s, arena, GOAL_ZERO, g, e, 0, 0);
        add_target(s, arena, GOAL_ZERO, g, e, 1, 1);
        break;
    case OP_abs:
    case OP_sign:
    case OP_sqrt:
    case OP_inversesqrt:
    case OP_log:
    case OP_log2:
    case OP_length:
    case OP_normalize: add_target(s, arena, GOAL_ZERO, g, e, 0, 0); break;
    case OP_div: add_target(s, arena, GOAL_ZERO, g, e, 1, 1); break;
    case OP_mod: add_target(s, arena, GOAL_WALL, g, e, 0, 1); break;
    case OP_floor:
    case OP_ceil:
    case OP_fract: add_target(s, arena, GOAL_WHOLE, g, e, 0, 0); break;
    case OP_round: add_target(s, arena, GOAL_HALF, g, e, 0, 0); break;
    case OP_asin:
    case OP_acos: add_target(s, arena, GOAL_UNIT, g, e, 0, 0); break;
    case OP_exp:
    case OP_exp2:
    case OP_sinh:
    case OP_cosh: add_target(s, arena, GOAL_HIGH, g, e, 0, 0); break;
    case OP_tanh:
    case OP_atan: add_target(s, arena, GOAL_ZERO, g, e, 0, 0); break;
    case OP_guard: add_guard(s, arena, e); break;
    case OP_fold:
    case OP_front: add_target(s, arena, GOAL_FRONT, g, e, 0, 1); break;
    case OP_cell: add_target(s, arena, GOAL_WALL, g, e, 0, 1); break;
    default: break;
    }
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
        add_scaled(next, p, -length / slope, axis);
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
        bool arrived = separation(p, next) < 1e-7 * s->size;
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
        add_scaled(next, p, step / slope, axis);
        double then = target_at(s, t, next);
        if (then > at) {
            memcpy(p, next, sizeof next);
            at = then;
            step *= 1.5;
        } else
            step *= 0.3;
    }
}
