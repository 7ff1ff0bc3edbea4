/*
 * search_pairs.c: what a point alone refutes, and how much of a claim a pair of points uses up.
 *
 * A pair that is steep on average has a half that is at least as steep, so pairs climb to where a
 * distance jumps by being halved.
 */
#include "compiler/refute/search_pairs.h"

#include <math.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/base/splitmix.h"
#include "compiler/base/vec.h"

/* The absolute part of what rounding may do, in sizes. */
static const double ABSOLUTE = 1e-9;

/* ---- random numbers ---- */

double search_between(Search *s, double low, double high)
{
    return low + (high - low) * splitmix_unit(&s->random);
}

size_t search_index(Search *s, size_t count) { return splitmix_next(&s->random) % count; }

double any_scale(Search *s, double least)
{
    return s->size * real_pow(least, splitmix_unit(&s->random));
}

void random_direction(Search *s, double direction[3])
{
    double angle = search_between(s, 0, 2 * M_PI), z = s->figure ? 0 : search_between(s, -1, 1);
    double radius = sqrt(fmax(0, 1 - z * z));
    direction[0]  = radius * real_cos(angle);
    direction[1]  = radius * real_sin(angle);
    direction[2]  = z;
}

void random_point(Search *s, double point[3])
{
    for (int i = 0; i < 3; i++)
        point[i] = search_between(s, s->around.axis[i].low, s->around.axis[i].high);
}

/* ---- what is claimed at a point ---- */

/* Tells how far outside of the box a point is, at most along one axis. */
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

bool is_decided(const Search *s)
{
    return s->worst.fault == FAULT_NAN || s->worst.fault == FAULT_OUTSIDE ||
           s->worst.fault == FAULT_CLAIM;
}

double distance_at(Search *s, double p[3])
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
    if (isnan(distance) && !is_decided(s) && isfinite(length3(p)))
        note(s, FAULT_NAN, INFINITY, p, p, distance, distance);
    else if (s->claim) {
        if (distance > rounding_at(s, p) && !is_decided(s))
            note(s, FAULT_CLAIM, INFINITY, p, p, distance, distance);
    } else if (s->side == s->distance && distance < -rounding_at(s, p) &&
               outside(s, p) > 1e3 * rounding_at(s, p) && !is_decided(s))
        note(s, FAULT_OUTSIDE, INFINITY, p, p, distance, distance);
    return distance;
}

/* ---- pairs ---- */

static void aim_along(Search *s, const double from[3], const double to[3])
{
    double length = distance3(from, to);
    for (int i = 0; i < 3 && length > 0; i++)
        s->aim[i] = (to[i] - from[i]) / length;
}

/* Tells how much of its claim a pair uses up; 0 where it says nothing. */
static double ratio_of(const Search *s, const PointPair *pair)
{
    double length = distance3(pair->p, pair->q), rounding = rounding_at(s, pair->p);
    double a = pair->at_p, b = pair->at_q;
    if (!(length >= NEAREST * s->size) || isnan(a) || isnan(b) ||
        isinf(pair->side_p + pair->side_q))
        return 0;
    if (s->side == s->distance && (fabs(a) > LONGEST || fabs(b) > LONGEST))
        return 0; /* nothing is anywhere, or a wall is */
    if (s->claim) /* none is refuted here: uphill is towards 0 */
        return 1 / (1 + fabs(fmax(a, b)) / s->size);
    double rise = s->steep                                          ? fabs(a - b)
                  : are_sides_different(pair->side_p, pair->side_q) ? fmax(fabs(a), fabs(b))
                                                                    : 0;
    return fmax(0, rise - rounding) / length;
}

static void weigh(Search *s, PointPair *pair)
{
    pair->ratio = ratio_of(s, pair);
    if (!is_decided(s) && pair->ratio > s->worst.ratio)
        note(s, s->steep ? FAULT_STEEP : FAULT_LONG, pair->ratio, pair->p, pair->q, pair->at_p,
             pair->at_q);
}

void judge_pair(Search *s, PointPair *pair)
{
    aim_along(s, pair->p, pair->q);
    pair->at_p   = distance_at(s, pair->p);
    pair->side_p = side_now(s);
    aim_along(s, pair->q, pair->p);
    pair->at_q   = distance_at(s, pair->q);
    pair->side_q = side_now(s);
    weigh(s, pair);
}

bool halve_pair(Search *s, PointPair *pair)
{
    if (distance3(pair->p, pair->q) < 2.5 * NEAREST * s->size)
        return false;
    PointPair first = *pair, second = *pair;
    double    middle[3];
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

void tighten_pair(Search *s, PointPair *pair)
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

bool reach_surface(Search *s, PointPair *pair, const double direction[3], double farthest)
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
            tighten_pair(s, pair);
            return true;
        }
        t += fmax(0.6 * fabs(pair->side_q), 0.03 * t + 1e-9 * s->size);
    }
    return false;
}

bool gradient_at(Search *s, const double p[3], double gradient[3])
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
    return normalize3(gradient);
}
