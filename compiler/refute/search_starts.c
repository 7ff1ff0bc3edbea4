/*
 * search_starts.c: where a search begins: the best pair at a random place of one of several kinds.
 *
 * What a guard may leave out has to be in the guard's box.  The bound by that box counts only some
 * way out of it, and what sticks out is small; so points go down to the surface of what may be left
 * out, and from one that is out of the box another goes away from it to where the guard decides.
 */
#include "compiler/refute/search_starts.h"

#include <math.h>
#include <string.h>

#include "compiler/base/vec.h"
#include "compiler/refute/search_pairs.h"
#include "compiler/refute/search_targets.h"

static void nudge(Search *s, double p[3], double least)
{
    double direction[3];
    random_direction(s, direction);
    add_scaled3(p, p, any_scale(s, least), direction);
}

/* Starts on a random ray, close to a surface. */
static void start_at_surface(Search *s, double p[3])
{
    double direction[3];
    random_direction(s, direction);
    random_point(s, p);
    for (int i = 0; i < 40; i++) {
        (void)distance_at(s, p);
        double distance = side_now(s);
        if (!(fabs(distance) > 1e-5 * s->size) || !(fabs(distance) < LONGEST))
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

/* Starts at a corner of the box, on an edge, or on a face. */
static void start_at_edge(Search *s, double p[3])
{
    random_point(s, p);
    size_t free_axis = search_index(s, 4), second = search_index(s, 4);
    for (size_t i = 0; i < 3; i++)
        if (i != free_axis && (i != second || free_axis == 3) && box_is_finite(s->box))
            p[i] = search_index(s, 2) ? s->box.axis[i].low : s->box.axis[i].high;
    nudge(s, p, 1e-5);
}

static void start_at_landmark(Search *s, double p[3])
{
    memcpy(p, s->values[s->landmarks.items[search_index(s, s->landmarks.count)]].v, 3 * sizeof *p);
    if (!(length3(p) < 1e6 * (s->size + 1)))
        random_point(s, p);
    nudge(s, p, 1e-6);
}

/* Starts at a target; `axis` becomes the direction in which it changes, else it stays. */
static void start_at_target(Search *s, double p[3], double axis[3])
{
    const Target *target = &s->targets.items[search_index(s, s->targets.count)];
    random_point(s, p);
    if (target->goal == GOAL_HIGH)
        drive_up(s, target, p, axis);
    else
        drive_to_zero(s, target, p, axis);
    if (!normalize3(axis))
        memcpy(axis, (double[]){1, 0, 0}, 3 * sizeof *axis);
    if (!(length3(p) < 1e6 * (s->size + 1)))
        random_point(s, p);
    if (search_index(s, 2))
        nudge(s, p, 1e-5);
}

static void choose_start(Search *s, double p[3], double axis[3])
{
    random_direction(s, axis);
    size_t kind = search_index(s, 10);
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

/* Returns the best of pairs around a point, along an axis, along the gradient, and in any
   direction. */
static PointPair best_around(Search *s, double p[3], const double axis[3])
{
    PointPair best = {.ratio = -1};
    for (int i = 0; i < 6; i++) {
        double    direction[3];
        PointPair pair;
        random_direction(s, direction);
        if (i < 3)
            memcpy(direction, axis, sizeof direction);
        else if (i == 3)
            (void)gradient_at(s, p, direction);
        double half = 0.5 * any_scale(s, 1e-5);
        add_scaled3(pair.p, p, half, direction);
        add_scaled3(pair.q, p, -half, direction);
        judge_pair(s, &pair);
        if (pair.ratio > best.ratio)
            best = pair;
    }
    return best;
}

/* Returns the pair of a point and the nearest surface that a few ways from it find. */
static PointPair best_by_directions(Search *s, double p[3])
{
    PointPair best = {.ratio = -1};
    for (int i = 0; i < 4; i++) {
        double    direction[3];
        PointPair pair = {.ratio = 0};
        memcpy(pair.p, p, sizeof pair.p);
        random_direction(s, direction);
        if (i == 0)
            (void)gradient_at(s, p, direction);
        (void)distance_at(s, pair.p);
        double side = side_now(s), farthest = s->aimed ? s->size : 4 * fabs(side);
        for (int k = 0; k < 3 && i == 0; k++)
            direction[k] *= side > 0 ? -1 : 1;
        if (fabs(side) < 1e-6 * s->size || !(fabs(side) < LONGEST))
            return best;
        if (reach_surface(s, &pair, direction, farthest) && pair.ratio > best.ratio)
            best = pair;
    }
    return best;
}

PointPair best_pair(Search *s)
{
    double p[3], axis[3];
    choose_start(s, p, axis);
    return s->steep ? best_around(s, p, axis) : best_by_directions(s, p);
}

/* ---- guards ---- */

/* Slides down to where a distance is 0, along its gradient; `axis` is that, a unit vector.  False:
   it does not get there. */
static bool slide_down(Search *s, const Target *distance, double p[3], double axis[3])
{
    for (int i = 0; i < 24; i++) {
        double at = target_at(s, distance, p), slope = target_slope(s, distance, p, at, axis);
        if (!(slope > 0) || !isfinite(slope) || !(fabs(at) < LONGEST))
            return false;
        add_scaled3(axis, (double[3]){0}, 1 / slope, axis);
        if (fabs(at) < NEAREST * s->size)
            return true;
        add_scaled3(p, p, -at, axis);
    }
    return false;
}

PointPair best_past_guard(Search *s)
{
    const Guard *guard = &s->guards.items[search_index(s, s->guards.count)];
    PointPair    best = {.ratio = -1}, pair = {.ratio = 0};
    double       axis[3];
    random_point(s, pair.q);
    if (!slide_down(s, &guard->rest, pair.q, axis))
        return best;
    add_scaled3(pair.q, pair.q, -4 * NEAREST * s->size, axis); /* into it */
    double out   = target_at(s, &guard->bound, pair.q);
    double slope = target_slope(s, &guard->bound, pair.q, out, axis);
    if (!(out > 0) || !(slope > 0) || !isfinite(slope) || side_now(s) > 0)
        return best;
    for (double length = s->size; length > 1e-4 * s->size; length *= 0.8) {
        add_scaled3(pair.p, pair.q, length / slope, axis);
        judge_pair(s, &pair);
        if (pair.ratio > best.ratio)
            best = pair;
    }
    return best;
}
