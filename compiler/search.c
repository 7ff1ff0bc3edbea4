/*
 * search.c: points that refute a distance: where they are looked for, and how finds are improved.
 *
 * An operation is a target where it branches, jumps or is steepest: a comparison where both sides
 * are equal, a quotient where its divisor is 0, an exponential where its argument is largest.  From
 * a random point, steps along the gradient of that expression lead there, also into a region too
 * thin for random points to meet.  A pair that is steep on average has a half that is at least as
 * steep, so pairs climb to where a distance jumps by being halved.
 *
 * What a guard may leave out has to be in the guard's box.  The bound by that box counts only some
 * way out of it, and what sticks out is small; so points go down to the surface of what may be left
 * out, and from one that is out of the box another goes away from it to where the guard decides.
 */
#include "compiler/search.h"

#include <math.h>
#include <string.h>

#include "compiler/base/vec.h"

/* Where on the way from smooth to steep an expression is looked at. */
typedef enum Goal {
    GOAL_EQUAL, /* a = b */
    GOAL_ZERO,  /* a = 0 */
    GOAL_WHOLE, /* a is a whole number */
    GOAL_HALF,  /* a is halfway between two */
    GOAL_UNIT,  /* |a| = 1 */
    GOAL_HIGH,  /* a is largest */
    GOAL_FRONT, /* a lies in the plane of unit normal b and offset c */
    GOAL_WALL   /* a lies between two cells of period b */
} Goal;

struct Target {
    Goal     goal;
    Node     a, b, c;
    uint32_t component;
};

struct Guard {
    Target bound, rest;
};

enum { BATCH = 24, KEPT = 4, CLIMB_STEPS = 48 };

/* The box that stands for a side without end, in world units. */
static const double UNBOUNDED = 10;
/* Pairs nearer than this, in sizes, say more about rounding than about the distance. */
static const double NEAREST = 1e-6;
/* The relative part of what rounding may do, and the absolute one, in sizes. */
static const double RELATIVE = 1e-6, ABSOLUTE = 1e-9;
/* What stands for the distance to nothing. */
static const double NOWHERE = 1e29;

/* ---- random numbers ---- */

static uint64_t random_next(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15;
    z          = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
    z          = (z ^ z >> 27) * 0x94d049bb133111eb;
    return z ^ z >> 31;
}

double random_unit(uint64_t *state) { return (double)(random_next(state) >> 11) * 0x1p-53; }

static double between(Search *s, double low, double high)
{
    return low + (high - low) * random_unit(&s->random);
}

static size_t choose(Search *s, size_t count) { return random_next(&s->random) % count; }

/* A length of any order of magnitude from `least` sizes to one. */
static double any_scale(Search *s, double least)
{
    return s->size * pow(least, random_unit(&s->random));
}

static void random_direction(Search *s, double direction[3])
{
    double angle = between(s, 0, 2 * M_PI), z = s->figure ? 0 : between(s, -1, 1);
    double radius = sqrt(fmax(0, 1 - z * z));
    direction[0]  = radius * cos(angle);
    direction[1]  = radius * sin(angle);
    direction[2]  = z;
}

static void random_point(Search *s, double point[3])
{
    for (int i = 0; i < 3; i++)
        point[i] = between(s, s->around.axis[i].low, s->around.axis[i].high);
}

/* ---- what is claimed at a point ---- */

/* How far outside of the box a point is, at most along one axis. */
static double outside(const Search *s, const double p[3])
{
    double most = -INFINITY;
    for (int i = 0; i < (s->figure ? 2 : 3); i++)
        most = fmax(most, fmax(s->box.axis[i].low - p[i], p[i] - s->box.axis[i].high));
    return most;
}

static double rounding_at(const Search *s, const double p[3])
{
    return ABSOLUTE * (s->size + length3(p));
}

static void note(Search *s, Fault fault, double ratio, const double p[3], const double q[3],
                 double at_p, double at_q)
{
    s->worst = (Witness){.fault = fault, .ratio = ratio, .at_p = at_p, .at_q = at_q};
    memcpy(s->worst.p, p, sizeof s->worst.p);
    memcpy(s->worst.q, q, sizeof s->worst.q);
}

static bool is_settled(const Search *s)
{
    return s->worst.fault == FAULT_NAN || s->worst.fault == FAULT_OUTSIDE ||
           s->worst.fault == FAULT_CLAIM;
}

/* The distance at a point; what one point alone refutes is noted at once. */
static double distance_at(Search *s, double p[3])
{
    if (s->figure)
        p[2] = 0;
    if (s->aimed)
        tape_run_surface(&s->tape, p, s->aim, 0, s->values);
    else
        tape_run_point(&s->tape, p, s->values);
    s->spent += s->cost;
    s->evaluations++;
    double distance = s->values[s->distance].v[0];
    if (isnan(distance) && !is_settled(s) && isfinite(length3(p)))
        note(s, FAULT_NAN, INFINITY, p, p, distance, distance);
    else if (s->claim) {
        if (distance > rounding_at(s, p) && !is_settled(s))
            note(s, FAULT_CLAIM, INFINITY, p, p, distance, distance);
    } else if (s->side == s->distance && distance < -rounding_at(s, p) &&
               outside(s, p) > 1e3 * rounding_at(s, p) && !is_settled(s))
        note(s, FAULT_OUTSIDE, INFINITY, p, p, distance, distance);
    return distance;
}

/* ---- pairs ---- */

typedef struct Pair {
    double p[3], q[3], at_p, at_q, side_p, side_q, ratio;
} Pair;

/* At the point that was looked at last. */
static double side_now(const Search *s) { return s->values[s->side].v[0]; }

static void aim_along(Search *s, const double from[3], const double to[3])
{
    double way = distance3(from, to);
    for (int i = 0; i < 3 && way > 0; i++)
        s->aim[i] = (to[i] - from[i]) / way;
}

static bool are_sides_different(double a, double b) { return (a > 0) != (b > 0); }

/* How much of its claim a pair uses up; 0 where it says nothing. */
static double ratio_of(const Search *s, const Pair *pair)
{
    double way = distance3(pair->p, pair->q), rounding = rounding_at(s, pair->p);
    double a = pair->at_p, b = pair->at_q;
    if (!(way >= NEAREST * s->size) || isnan(a) || isnan(b) || isinf(pair->side_p + pair->side_q))
        return 0;
    if (s->side == s->distance && (fabs(a) > NOWHERE || fabs(b) > NOWHERE))
        return 0; /* nothing is anywhere, or a wall is */
    if (s->claim) /* none is refuted here: uphill is towards 0 */
        return 1 / (1 + fabs(fmax(a, b)) / s->size);
    double rise = s->steep                                          ? fabs(a - b)
                  : are_sides_different(pair->side_p, pair->side_q) ? fmax(fabs(a), fabs(b))
                                                                    : 0;
    return fmax(0, rise - rounding) / way;
}

static void weigh(Search *s, Pair *pair)
{
    pair->ratio = ratio_of(s, pair);
    if (!is_settled(s) && pair->ratio > s->worst.ratio)
        note(s, s->steep ? FAULT_STEEP : FAULT_LONG, pair->ratio, pair->p, pair->q, pair->at_p,
             pair->at_q);
}

static void judge(Search *s, Pair *pair)
{
    aim_along(s, pair->p, pair->q);
    pair->at_p   = distance_at(s, pair->p);
    pair->side_p = side_now(s);
    aim_along(s, pair->q, pair->p);
    pair->at_q   = distance_at(s, pair->q);
    pair->side_q = side_now(s);
    weigh(s, pair);
}

/* The half that is steeper, or for sides that differ the one with the surface; false: too near. */
static bool halve(Search *s, Pair *pair)
{
    if (distance3(pair->p, pair->q) < 2.5 * NEAREST * s->size)
        return false;
    Pair   first = *pair, second = *pair;
    double middle[3];
    for (int i = 0; i < 3; i++)
        middle[i] = 0.5 * (pair->p[i] + pair->q[i]);
    double at = distance_at(s, middle);
    memcpy(first.q, middle, sizeof middle);
    memcpy(second.p, middle, sizeof middle);
    first.at_q = second.at_p = at;
    weigh(s, &first);
    weigh(s, &second);
    *pair = first.ratio >= second.ratio ? first : second;
    return true;
}

/* Brings q as near to p as the other side is, along the segment. */
static void tighten(Search *s, Pair *pair)
{
    double low = 0, high = 1, end[3];
    memcpy(end, pair->q, sizeof end);
    aim_along(s, pair->q, pair->p);
    for (int i = 0; i < 24 && are_sides_different(pair->side_p, pair->side_q); i++) {
        double t = 0.5 * (low + high), m[3];
        for (int k = 0; k < 3; k++)
            m[k] = pair->p[k] + t * (end[k] - pair->p[k]);
        double at = distance_at(s, m), side = side_now(s);
        if (are_sides_different(pair->side_p, side)) {
            memcpy(pair->q, m, sizeof m);
            pair->at_q   = at;
            pair->side_q = side;
            high         = t;
        } else
            low = t;
    }
    weigh(s, pair);
}

/* Marches from p until the side changes, at most `farthest`; then the pair is tightened. */
static bool reach_surface(Search *s, Pair *pair, const double direction[3], double farthest)
{
    memcpy(s->aim, direction, sizeof s->aim);
    pair->at_p   = distance_at(s, pair->p);
    pair->side_p = side_now(s);
    add_scaled3(s->aim, (double[3]){0}, -1, direction);
    double t = 0.5 * fabs(pair->side_p);
    for (int i = 0; i < 40 && t <= farthest; i++) {
        add_scaled3(pair->q, pair->p, t, direction);
        pair->at_q   = distance_at(s, pair->q);
        pair->side_q = side_now(s);
        if (!isfinite(pair->side_q))
            return false;
        if (are_sides_different(pair->side_p, pair->side_q)) {
            tighten(s, pair);
            return true;
        }
        t += fmax(0.6 * fabs(pair->side_q), 0.03 * t + 1e-9 * s->size);
    }
    return false;
}

/* Unit gradient of the distance by differences; false: flat. */
static bool gradient_at(Search *s, const double p[3], double gradient[3])
{
    double step = 1e-6 * s->size;
    for (int i = 0; i < 3; i++) {
        double before[3] = {p[0], p[1], p[2]}, after[3] = {p[0], p[1], p[2]};
        before[i] -= step;
        after[i] += step;
        (void)distance_at(s, after);
        gradient[i] = side_now(s);
        (void)distance_at(s, before);
        gradient[i] -= side_now(s);
    }
    double length = length3(gradient);
    if (!isfinite(length) || !(length > 0))
        return false;
    for (int i = 0; i < 3; i++)
        gradient[i] /= length;
    return true;
}

/* ---- targets ---- */

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

static double target_at(Search *s, const Target *t, double p[3])
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
#define RULES(name, cost, promises, simplify, derive, local, series, parity, anchor, target) \
    [OP_##name] = target,
#include "compiler/graph/ops.def"
};

static void add_targets(Search *s, Arena *arena, const Graph *g, const Expr *e)
{
    if (e->operand_count > 0)
        targets[e->op](&(Prospect){s, arena, g, e});
}

/* The gradient of a target by differences, and its length; `at` is its value at p. */
static double target_slope(Search *s, const Target *t, const double p[3], double at,
                           double gradient[3])
{
    double step = 1e-6 * s->size;
    for (int i = 0; i < 3; i++) {
        double beside[3] = {p[0], p[1], p[2]};
        beside[i] += step;
        gradient[i] = (target_at(s, t, beside) - at) / step;
    }
    return length3(gradient);
}

/* From p on to where a target is 0, by Newton's steps, and between two steps by halving. */
static void drive_to_zero(Search *s, const Target *t, double p[3], double axis[3])
{
    double at = target_at(s, t, p);
    for (int i = 0; i < 10 && at != 0; i++) {
        double slope = target_slope(s, t, p, at, axis), next[3];
        if (!(slope > 0) || !isfinite(slope))
            return;
        double way = fmax(-0.5 * s->size, fmin(0.5 * s->size, at / slope));
        add_scaled3(next, p, -way / slope, axis);
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

/* Uphill from p, by steps that grow where they help. */
static void drive_up(Search *s, const Target *t, double p[3], double axis[3])
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

/* ---- starts ---- */

static void nudge(Search *s, double p[3], double least)
{
    double direction[3];
    random_direction(s, direction);
    add_scaled3(p, p, any_scale(s, least), direction);
}

/* Along a random ray until close to a surface. */
static void start_at_surface(Search *s, double p[3])
{
    double direction[3];
    random_direction(s, direction);
    random_point(s, p);
    for (int i = 0; i < 40; i++) {
        (void)distance_at(s, p);
        double distance = side_now(s);
        if (!(fabs(distance) > 1e-5 * s->size) || !(fabs(distance) < NOWHERE))
            break;
        add_scaled3(p, p, 0.9 * distance, direction);
    }
    for (int i = 0; i < 3; i++)
        if (!(p[i] > s->around.axis[i].low && p[i] < s->around.axis[i].high)) {
            random_point(s, p); /* the ray has missed */
            return;
        }
    nudge(s, p, 1e-5);
}

/* At a corner of the box, on an edge, or on a face. */
static void start_at_edge(Search *s, double p[3])
{
    random_point(s, p);
    size_t free_axis = choose(s, 4), second = choose(s, 4);
    for (size_t i = 0; i < 3; i++)
        if (i != free_axis && (i != second || free_axis == 3) && box_is_finite(s->box))
            p[i] = choose(s, 2) ? s->box.axis[i].low : s->box.axis[i].high;
    nudge(s, p, 1e-5);
}

static void start_at_landmark(Search *s, double p[3])
{
    memcpy(p, s->values[s->landmarks.items[choose(s, s->landmarks.count)]].v, 3 * sizeof *p);
    if (!(length3(p) < 1e6 * (s->size + 1)))
        random_point(s, p);
    nudge(s, p, 1e-6);
}

/* `axis` becomes the direction in which the target changes, else it stays. */
static void start_at_target(Search *s, double p[3], double axis[3])
{
    const Target *target = &s->targets.items[choose(s, s->targets.count)];
    random_point(s, p);
    if (target->goal == GOAL_HIGH)
        drive_up(s, target, p, axis);
    else
        drive_to_zero(s, target, p, axis);
    double length = length3(axis);
    for (int i = 0; i < 3; i++)
        axis[i] = length > 0 && isfinite(length) ? axis[i] / length : i == 0;
    if (!(length3(p) < 1e6 * (s->size + 1)))
        random_point(s, p);
    if (choose(s, 2))
        nudge(s, p, 1e-5);
}

static void choose_start(Search *s, double p[3], double axis[3])
{
    random_direction(s, axis);
    size_t kind = choose(s, 10);
    if (kind < 4 && s->targets.count > 0)
        start_at_target(s, p, axis);
    else if (kind < 7)
        start_at_surface(s, p);
    else if (kind == 7)
        start_at_edge(s, p);
    else if (kind == 8 && s->landmarks.count > 0)
        start_at_landmark(s, p);
    else
        random_point(s, p);
}

/* The best of pairs around a point, along an axis, along the gradient, and in any direction. */
static Pair best_around(Search *s, double p[3], const double axis[3])
{
    Pair best = {.ratio = -1};
    for (int i = 0; i < 6; i++) {
        double direction[3];
        Pair   pair;
        random_direction(s, direction);
        if (i < 3)
            memcpy(direction, axis, sizeof direction);
        else if (i == 3)
            (void)gradient_at(s, p, direction);
        double half = 0.5 * any_scale(s, 1e-5);
        add_scaled3(pair.p, p, half, direction);
        add_scaled3(pair.q, p, -half, direction);
        judge(s, &pair);
        if (pair.ratio > best.ratio)
            best = pair;
    }
    return best;
}

/* The pair of a point and the nearest surface that a few ways from it find. */
static Pair best_way(Search *s, double p[3])
{
    Pair best = {.ratio = -1};
    for (int i = 0; i < 4; i++) {
        double direction[3];
        Pair   pair = {.ratio = 0};
        memcpy(pair.p, p, sizeof pair.p);
        random_direction(s, direction);
        if (i == 0)
            (void)gradient_at(s, p, direction);
        (void)distance_at(s, pair.p);
        double side = side_now(s), farthest = s->aimed ? s->size : 4 * fabs(side);
        for (int k = 0; k < 3 && i == 0; k++)
            direction[k] *= side > 0 ? -1 : 1;
        if (fabs(side) < 1e-6 * s->size || !(fabs(side) < NOWHERE))
            return best;
        if (reach_surface(s, &pair, direction, farthest) && pair.ratio > best.ratio)
            best = pair;
    }
    return best;
}

/* Down to where a distance is 0, along its gradient; `axis` is that, a unit vector.  False: it does
   not get there. */
static bool slide_down(Search *s, const Target *distance, double p[3], double axis[3])
{
    for (int i = 0; i < 24; i++) {
        double at = target_at(s, distance, p), slope = target_slope(s, distance, p, at, axis);
        if (!(slope > 0) || !isfinite(slope) || !(fabs(at) < NOWHERE))
            return false;
        add_scaled3(axis, (double[3]){0}, 1 / slope, axis);
        if (fabs(at) < NEAREST * s->size)
            return true;
        add_scaled3(p, p, -at, axis);
    }
    return false;
}

/* A point of what a guard may leave out, and one where the guard decides: a way too long for the
   bound if the first is not in the box. */
static Pair best_past_guard(Search *s)
{
    const Guard *guard = &s->guards.items[choose(s, s->guards.count)];
    Pair         best = {.ratio = -1}, pair = {.ratio = 0};
    double       axis[3];
    random_point(s, pair.q);
    if (!slide_down(s, &guard->rest, pair.q, axis))
        return best;
    add_scaled3(pair.q, pair.q, -4 * NEAREST * s->size, axis); /* into it */
    double out   = target_at(s, &guard->bound, pair.q);
    double slope = target_slope(s, &guard->bound, pair.q, out, axis);
    if (!(out > 0) || !(slope > 0) || !isfinite(slope) || side_now(s) > 0)
        return best;
    for (double way = s->size; way > 1e-4 * s->size; way *= 0.8) {
        add_scaled3(pair.p, pair.q, way / slope, axis);
        judge(s, &pair);
        if (pair.ratio > best.ratio)
            best = pair;
    }
    return best;
}

/* ---- climbing ---- */

/* A pair near another one: both points moved, turned about p, or nearer and farther. */
static Pair changed(Search *s, const Pair *pair)
{
    Pair   next = *pair;
    double shift[3], way = distance3(pair->p, pair->q), move = any_scale(s, 1e-6);
    random_direction(s, shift);
    switch (choose(s, 3)) {
    case 0:
        add_scaled3(next.p, next.p, move, shift);
        add_scaled3(next.q, next.q, move, shift);
        break;
    case 1: add_scaled3(next.q, next.q, way * random_unit(&s->random), shift); break;
    default: {
        double factor = exp2(between(s, -2, 1));
        for (int i = 0; i < 3; i++)
            next.q[i] = next.p[i] + factor * (next.q[i] - next.p[i]);
    }
    }
    return next;
}

static void climb(Search *s, Pair pair, int steps)
{
    for (int i = 0; i < steps && !is_settled(s); i++) {
        Pair next = pair;
        if (s->steep && i % 4 == 0) {
            if (halve(s, &next) && next.ratio >= pair.ratio)
                pair = next;
            continue;
        }
        next = changed(s, &pair);
        judge(s, &next);
        if (!s->steep && next.ratio > 0)
            tighten(s, &next);
        if (next.ratio > pair.ratio)
            pair = next;
    }
}

/* ---- the search ---- */

static uint64_t operation_cost(const Graph *graph, const Expr *e)
{
    GraphType types[MAX_OPERANDS];
    for (uint32_t k = 0; k < e->operand_count; k++)
        types[k] = graph->items[e->operands[k]].type;
    return 1 + (e->operand_count ? (uint64_t)op_cost((Op)e->op, e->type, types) : 0);
}

/* The box and what is next to it, cut where it goes on for ever, and anything for an empty one;
   with guards as far as half the radius of the box, where the outermost begins. */
static void choose_around(Search *search)
{
    Box box = box_is_empty(search->box) ? box_infinite : search->box;
    for (int i = 0; i < 3; i++)
        if (!isfinite(box.axis[i].low) || !isfinite(box.axis[i].high)) {
            box.axis[i].low  = fmax(box.axis[i].low, -UNBOUNDED);
            box.axis[i].high = fmin(box.axis[i].high, UNBOUNDED);
        }
    double outer = search->guards.count > 0 ? 0.3 * box_diagonal(box) : 0;
    for (int i = 0; i < 3; i++) {
        double low = box.axis[i].low, high = box.axis[i].high;
        double margin          = fmax(0.25 * fabs(high - low), outer) + 1e-3;
        search->around.axis[i] = (Range){fmin(low, high) - margin, fmax(low, high) + margin};
    }
    search->size = box_diagonal(search->around);
}

bool search_new(Search *search, const Graph *graph, Node distance, Node side, Box box, Arena *arena)
{
    *search = (Search){.distance = distance, .side = side, .box = box, .aim = {1}, .cost = 1};
    if (graph->items[distance].time != TIME_POINT)
        return false;
    search->tape   = tape_new(graph, (Node[]){distance, side}, 2, arena);
    search->values = arena_new_array(arena, NodeValue, graph->count);
    for (size_t i = search->tape.frame_count; i < search->tape.count; i++) {
        const Expr *e = &graph->items[search->tape.nodes[i]];
        add_targets(search, arena, graph, e);
        search->cost += operation_cost(graph, e);
        for (int k = 0; k < e->operand_count; k++) {
            const Expr *of = &graph->items[e->operands[k]];
            if (of->type == TYPE_VEC3 && of->time != TIME_POINT)
                array_push(arena, &search->landmarks, e->operands[k]);
        }
    }
    choose_around(search);
    return isfinite(search->size) && search->size < 1e100;
}

bool search_new_claim(Search *search, Graph *graph, Node a, Node b, Box box, Arena *arena)
{
    Node   roots[3] = {a, b, graph_op2(graph, OP_min, a, b)};
    Graph *simple   = graph_simplify(graph, roots, 3, arena);
    if (!search_new(search, simple, roots[2], roots[2], box, arena))
        return false;
    search->claim = true;
    for (int i = 0; i < 2; i++) { /* what is wrong may be thin, but lies at a surface */
        Target target = {GOAL_ZERO, roots[i], roots[i], roots[i], 0};
        for (int times = 0; times < 4; times++)
            array_push(arena, &search->targets, target);
    }
    return true;
}

bool search_start(Search *search, const NodeValue *parameters)
{
    tape_run_frame(&search->tape, parameters, search->values);
    return tape_frame_infinite(&search->tape, search->values) == NODE_NONE;
}

static Pair best_pair(Search *s)
{
    double p[3], axis[3];
    choose_start(s, p, axis);
    return s->steep ? best_around(s, p, axis) : best_way(s, p);
}

/* The best KEPT of a batch of starts, and from these uphill. */
static void search_batch(Search *s, uint64_t end)
{
    Pair kept[KEPT];
    for (int i = 0; i < KEPT; i++)
        kept[i].ratio = -1;
    for (int i = 0; i < BATCH && s->spent < end && !is_settled(s); i++) {
        Pair pair = s->guards.count > 0 && choose(s, 2) ? best_past_guard(s) : best_pair(s);
        for (int k = 0; k < KEPT; k++)
            if (pair.ratio > kept[k].ratio) {
                Pair less = kept[k];
                kept[k]   = pair;
                pair      = less;
            }
    }
    for (int i = 0; i < KEPT && s->spent < end; i++)
        if (kept[i].ratio > 0)
            climb(s, kept[i], CLIMB_STEPS);
}

void search_run(Search *search, uint64_t operations)
{
    uint64_t end = search->spent + operations;
    while (search->spent < end && !is_settled(search))
        search_batch(search, end);
}

void search_from(Search *search, const double p[3], const double q[3], uint64_t operations)
{
    uint64_t end = search->spent + operations;
    Pair     pair;
    memcpy(pair.p, p, sizeof pair.p);
    memcpy(pair.q, q, sizeof pair.q);
    judge(search, &pair);
    do
        climb(search, pair, CLIMB_STEPS);
    while (search->spent < end && !is_settled(search));
}

bool search_refuted(const Search *search)
{
    return is_settled(search) || search->worst.ratio > 1 + RELATIVE;
}

bool search_surface(Search *search, const double p[3], double surface[3])
{
    Pair   pair, best = {.ratio = -1};
    double direction[3];
    memcpy(pair.p, p, sizeof pair.p);
    pair.at_p = distance_at(search, pair.p);
    for (int i = 0; i < 200 && isfinite(pair.at_p); i++) {
        random_direction(search, direction);
        if (i == 0)
            (void)gradient_at(search, p, direction);
        for (int k = 0; k < 3 && i == 0; k++)
            direction[k] *= pair.at_p > 0 ? -1 : 1;
        Pair way = pair;
        if (reach_surface(search, &way, direction, 0.999999 * fabs(pair.at_p)) &&
            (best.ratio < 0 || distance3(p, way.q) < distance3(p, best.q))) {
            best       = way;
            best.ratio = 1;
        }
    }
    memcpy(surface, best.q, 3 * sizeof *surface);
    return best.ratio > 0;
}
