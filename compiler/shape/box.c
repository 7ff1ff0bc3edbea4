/*
 * box.c: bounding volumes.  Everything here errs to the outside.
 */
#include "compiler/shape/box.h"

#include <math.h>

#include "compiler/base/elementary.h"

const Box box_empty    = {{{INFINITY, -INFINITY}, {INFINITY, -INFINITY}, {INFINITY, -INFINITY}}};
const Box box_infinite = {{{-INFINITY, INFINITY}, {-INFINITY, INFINITY}, {-INFINITY, INFINITY}}};

static Range range_common(Range a, Range b)
{
    return (Range){fmax(a.low, b.low), fmin(a.high, b.high)};
}

bool box_is_empty(Box box)
{
    return box.axis[0].low > box.axis[0].high || box.axis[1].low > box.axis[1].high ||
           box.axis[2].low > box.axis[2].high;
}

bool box_is_finite(Box box)
{
    for (int i = 0; i < 3; i++)
        if (!isfinite(box.axis[i].low) || !isfinite(box.axis[i].high))
            return false;
    return true;
}

Box box_hull(Box a, Box b)
{
    if (box_is_empty(a))
        return b;
    if (box_is_empty(b))
        return a;
    for (int i = 0; i < 3; i++)
        a.axis[i] = range_hull(a.axis[i], b.axis[i]);
    return a;
}

Box box_common(Box a, Box b)
{
    for (int i = 0; i < 3; i++)
        a.axis[i] = range_common(a.axis[i], b.axis[i]);
    return box_is_empty(a) ? box_empty : a;
}

Box box_grow(Box box, double by)
{
    if (box_is_empty(box))
        return box;
    for (int i = 0; i < 3; i++)
        box.axis[i] = (Range){box.axis[i].low - by, box.axis[i].high + by};
    return box_is_empty(box) ? box_empty : box;
}

Box box_move(Box box, const Range by[3])
{
    if (box_is_empty(box))
        return box;
    for (int i = 0; i < 3; i++)
        box.axis[i] = range_add(box.axis[i], by[i]);
    return box;
}

Box box_rotate(Box box, Range rows[3][3])
{
    if (box_is_empty(box))
        return box;
    Box rotated;
    for (int i = 0; i < 3; i++) {
        rotated.axis[i] = range_mul(rows[i][0], box.axis[0]);
        for (int j = 1; j < 3; j++)
            rotated.axis[i] = range_add(rotated.axis[i], range_mul(rows[i][j], box.axis[j]));
    }
    return rotated;
}

void box_centre(Box box, double centre[3])
{
    for (int i = 0; i < 3; i++)
        centre[i] = 0.5 * (box.axis[i].low + box.axis[i].high);
}

double cell_margin(Range content, double period)
{
    return fmin(0.5 * period - content.high, 0.5 * period + content.low);
}

double box_diagonal(Box box)
{
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        double side = box.axis[i].high - box.axis[i].low;
        sum += side * side;
    }
    return box_is_empty(box) ? 0 : sqrt(sum);
}

Ball ball_around(Box box)
{
    if (box_is_empty(box))
        return (Ball){{0, 0, 0}, -1};
    if (!box_is_finite(box))
        return (Ball){{0, 0, 0}, INFINITY};
    Ball ball = {.radius = 0.5 * box_diagonal(box)};
    box_centre(box, ball.centre);
    return ball;
}

Box ball_box(Ball ball)
{
    if (ball.radius < 0)
        return box_empty;
    Box box;
    for (int i = 0; i < 3; i++)
        box.axis[i] = (Range){ball.centre[i] - ball.radius, ball.centre[i] + ball.radius};
    return box;
}

Ball ball_hull(Ball a, Ball b)
{
    if (a.radius < 0)
        return b;
    if (b.radius < 0)
        return a;
    if (isinf(a.radius) || isinf(b.radius))
        return (Ball){{0, 0, 0}, INFINITY};
    double offset[3], distance = 0;
    for (int i = 0; i < 3; i++) {
        offset[i] = b.centre[i] - a.centre[i];
        distance += offset[i] * offset[i];
    }
    distance = sqrt(distance);
    if (distance + b.radius <= a.radius)
        return a;
    if (distance + a.radius <= b.radius)
        return b;
    Ball hull = {.radius = 0.5 * (distance + a.radius + b.radius)};
    for (int i = 0; i < 3; i++)
        hull.centre[i] = a.centre[i] + offset[i] * (hull.radius - a.radius) / distance;
    hull.radius *= 1 + 1e-14;
    return hull;
}

/*
 * Finds what one mirror makes of a ball, with e = u.c - w: empty when e >= r, else centre c - e u
 * and radius r - e when e <= 0, sqrt(r^2 - e^2) when e > 0.  Mirrors that move: the radius of the
 * least e, about the middle of all centres, and as much more as the centres leave it.
 */
Ball ball_fold(Ball ball, const Range u[3], Range w)
{
    if (ball.radius < 0 || isinf(ball.radius))
        return ball;
    Range e = range_sub(range_of(0), w);
    for (int i = 0; i < 3; i++)
        e = range_add(e, range_mul(u[i], range_of(ball.centre[i])));
    if (e.low >= ball.radius)
        return (Ball){{0, 0, 0}, -1};
    Ball   fold  = {.radius = ball.radius - e.low};
    double leave = 0;
    if (e.low > 0)
        fold.radius = sqrt(ball.radius * ball.radius - e.low * e.low);
    for (int i = 0; i < 3; i++) {
        Range shift    = range_mul(e, u[i]);
        fold.centre[i] = ball.centre[i] - 0.5 * (shift.low + shift.high);
        leave          = real_hypot(leave, 0.5 * (shift.high - shift.low));
    }
    fold.radius = (fold.radius + leave) * (1 + 1e-14);
    return fold;
}

/* Returns the part of a box on the kept side of a mirror, axis by axis. */
static Box clip_to_half_space(Box box, const Range u[3], Range w)
{
    for (int i = 0; i < 3; i++) {
        /* u_i x_i <= w - (the least that the other axes can contribute) */
        Range rest = w;
        for (int j = 0; j < 3; j++)
            if (j != i)
                rest = range_sub(rest, range_mul(u[j], box.axis[j]));
        if (u[i].low > 1e-12)
            box.axis[i].high = fmin(box.axis[i].high,
                                    fmax(rest.high / u[i].low, rest.high / u[i].high));
        if (u[i].high < -1e-12)
            box.axis[i].low = fmax(box.axis[i].low,
                                   fmin(rest.high / u[i].low, rest.high / u[i].high));
        if (box.axis[i].low > box.axis[i].high)
            return box_empty;
    }
    return box;
}

Box box_fold(Box box, const Range u[3], Range w)
{
    if (box_is_empty(box))
        return box;
    Box retained = clip_to_half_space(box, u, w);
    if (box_is_empty(retained))
        return retained;
    /* The image is x - 2 (u.x - w) u, that is, (I - 2 u u^T) x + 2 w u. */
    Range rows[3][3], shift[3];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            Range uu   = i == j ? range_square(u[i]) : range_mul(u[i], u[j]);
            rows[i][j] = range_sub(range_of(i == j), range_mul(range_of(2), uu));
        }
        shift[i] = range_mul(range_of(2), range_mul(w, u[i]));
    }
    return box_hull(retained, box_move(box_rotate(retained, rows), shift));
}
