/*
 * claims.c: the claims of a declaration, put to the test by sampling when it is first used.
 *
 * Pairs of near points refute a slope, single points a solid outside of `within`.  The other claims
 * are pairs of numbers that are nowhere above 0 both (claim_pairs.h).  Where such a pair is above 0 may
 * be thin, but it then lies at the surface of one of the two.  So between any two samples on
 * different sides of a surface the surface is found by halving, and its sides are looked at.
 */
#include "compiler/eval/declared/claims.h"

#include <math.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/eval/declared/claim_pairs.h"
#include "compiler/graph/evaluate.h"
#include "compiler/shape/slope.h"

/* ---- samples ---- */

/* Samples, and the least of them where many operations make each one slow. */
enum { SAMPLES = 400, MIN_SAMPLES = 40, MANY_OPERATIONS = 5000 };

/* The numbers that are sampled at points of a box, at the default values of the parameters. */
typedef struct Sampling {
    Tape       tape;
    NodeValue *values;
    Box        around;
    double     size, rounding;
    uint32_t   count; /* of samples */
    bool       flat;  /* z stays 0 */
} Sampling;

/* Fills a point for sampling: a fixed sequence (Roberts' R3), spread over a box. */
static void sample_point(uint32_t index, Box box, double point[3])
{
    static const double steps[3] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
    for (int i = 0; i < 3; i++) {
        double t = fmod(0.5 + (index + 1) * steps[i], 1);
        point[i] = box.axis[i].low + t * (box.axis[i].high - box.axis[i].low);
    }
}

/* Begins to sample; false: the box is so large that show_one refuses it, in better words. */
static bool start_sampling(Elaboration *e, Sampling *s, const Node *roots, size_t count, Box box)
{
    NodeValue *parameters = arena_new_array(e->scratch, NodeValue, e->graph->parameters.count);
    s->tape               = tape_new(e->graph, roots, count, e->scratch);
    s->values             = arena_new_array(e->scratch, NodeValue, e->graph->count);
    s->flat               = false;
    parameter_defaults(&e->scene->parameters, parameters);
    tape_run_frame(&s->tape, parameters, s->values);
    s->around   = box_is_finite(box) ? box_grow(box, 0.3 * box_diagonal(box) + 0.1)
                                     : (Box){{{-10, 10}, {-10, 10}, {-10, 10}}};
    s->size     = box_diagonal(s->around);
    s->rounding = 1e-9 * (1 + s->size);
    s->count    = (uint32_t)fmax(
           fmin(SAMPLES, SAMPLES * (double)MANY_OPERATIONS / (double)(tape_operations(&s->tape) + 1)),
           MIN_SAMPLES);
    return s->size < 1e100;
}

static void sample_at(const Sampling *s, double point[3])
{
    if (s->flat)
        point[2] = 0;
    tape_run_point(&s->tape, point, s->values);
}

static void refuse_claim(Elaboration *e, const Syntax *declaration, const char *claim,
                         const char *found, const double point[3])
{
    const Syntax *syntax = find_property(declaration, claim);
    Diag *diag  = diag_add(e->diags, DIAG_FALSE_CLAIM, syntax->span, "`%s` of `%s` is not true",
                           claim, declaration->name);
    diag->label = "claimed here";
    diag_note(e->diags, diag,
              diag_text(e->diags, "%s at [%.4g, %.4g, %.4g]", found, point[0], point[1], point[2]));
    if (strcmp(claim, "exact") == 0)
        diag->help =
            "leave `exact` out: the compiler then derives a safe slope; where it is a bound "
            "that rises no faster than the distance, claim `slope: 1`";
}

/* ---- slope and box ---- */

/* Tells whether a point lies farther than `rounding` from the box of the shape. */
static bool is_outside(const Shape *shape, const double point[3], double rounding)
{
    for (int i = 0; i < (shape->figure ? 2 : 3); i++) {
        Range side = shape->box.axis[i];
        if (point[i] < side.low - rounding || point[i] > side.high + rounding)
            return true;
    }
    return false;
}

static bool check_slope_and_box(Elaboration *e, const Shape *shape, double slope)
{
    Node     distance = shape->declared;
    bool     bounded  = find_property(shape->declaration->syntax, "within") != NULL;
    Sampling s;
    if (!start_sampling(e, &s, &distance, 1, shape->box))
        return true;
    for (uint32_t i = 0; i < s.count; i++) {
        double a[3], b[3], moved = 0;
        sample_point(i, s.around, a);
        sample_point(i + 7 * SAMPLES, (Box){{{-1, 1}, {-1, 1}, {-1, 1}}}, b);
        for (int k = 0; k < 3; k++) {
            b[k] = shape->figure && k == 2 ? a[k] : a[k] + b[k] * s.size * (i % 2 ? 0.1 : 1e-4);
            moved += (b[k] - a[k]) * (b[k] - a[k]);
        }
        sample_at(&s, a);
        double at_a = s.values[distance].v[0];
        sample_at(&s, b);
        double at_b = s.values[distance].v[0];
        if (slope > 0 && !(fabs(at_a - at_b) <= slope * sqrt(moved) * (1 + 1e-6) + s.rounding)) {
            const char *found = diag_text(e->diags, "its slope is %.4g",
                                          fabs(at_a - at_b) / sqrt(moved));
            refuse_claim(e, shape->declaration->syntax, shape->exact ? "exact" : "slope", found, a);
            return false;
        }
        if (bounded && at_a < -s.rounding && is_outside(shape, a, s.rounding)) {
            refuse_claim(e, shape->declaration->syntax, "within",
                         "there is something outside of it", a);
            return false;
        }
    }
    return true;
}

/* ---- exact ---- */

/* Finds the unit gradient of a number; false: it is flat there. */
static bool gradient_at(const Sampling *s, Node number, const double point[3], double gradient[3])
{
    double step = 1e-6 * s->size, length = 0;
    for (int i = 0; i < 3; i++) {
        double after[3], before[3];
        memcpy(after, point, sizeof after);
        memcpy(before, point, sizeof before);
        after[i] += step;
        before[i] -= step;
        sample_at(s, after);
        gradient[i] = s->values[number].v[0];
        sample_at(s, before);
        gradient[i] -= s->values[number].v[0];
        length = real_hypot(length, gradient[i]);
    }
    for (int i = 0; i < 3; i++)
        gradient[i] /= length > 0 ? length : 1;
    return length > 0 && isfinite(length);
}

/* Checks points outside: the surface lies against the gradient, as far away as an exact distance
   says. */
static bool check_exact(Elaboration *e, const Shape *shape)
{
    Node     distance = shape->declared;
    Sampling s;
    if (!start_sampling(e, &s, &distance, 1, shape->box))
        return true;
    s.flat = shape->figure;
    for (uint32_t i = 0; i < s.count; i++) {
        double point[3], gradient[3], end[3];
        sample_point(i, s.around, point);
        sample_at(&s, point);
        double length = s.values[distance].v[0];
        if (!(length > 0) || !gradient_at(&s, distance, point, gradient))
            continue;
        for (int k = 0; k < 3; k++)
            end[k] = point[k] - length * gradient[k];
        sample_at(&s, end);
        double rest = s.values[distance].v[0];
        if (rest <= 1e-4 * length + 1e-5 * s.size)
            continue;
        const char *found = diag_text(e->diags,
                                      "the surface is not %.4g away, as it says, but "
                                      "farther,",
                                      length);
        refuse_claim(e, shape->declaration->syntax, "exact", found, point);
        return false;
    }
    return true;
}

/* ---- pairs of numbers ---- */

/* Brings two points with different signs of a number to a millionth of the size, at its surface. */
static void find_surface(const Sampling *s, Node number, double above[3], double below[3])
{
    double middle[3], separation;
    do {
        separation = 0;
        for (int i = 0; i < 3; i++) {
            middle[i]  = 0.5 * (above[i] + below[i]);
            separation = fmax(separation, fabs(above[i] - below[i]));
        }
        sample_at(s, middle);
        memcpy(s->values[number].v[0] > 0 ? above : below, middle, sizeof middle);
    } while (separation > 1e-6 * s->size);
}

static bool refutes(const Sampling *s, const ShapeClaim *claim, double point[3])
{
    sample_at(s, point);
    return s->values[claim->a].v[0] > s->rounding && s->values[claim->b].v[0] > s->rounding;
}

/* Tells whether a claim is refuted at a sample, or at the surfaces of the two numbers between it
   and the one before. */
static bool refutes_between(const Sampling *s, const ShapeClaim *claim, const double before[3],
                            double point[3])
{
    const Node numbers[2] = {claim->a, claim->b};
    double     last[3], now[3];
    if (refutes(s, claim, point))
        return true;
    for (int i = 0; i < 2; i++) {
        memcpy(last, before, sizeof last);
        memcpy(now, point, sizeof now);
        sample_at(s, last);
        bool was = s->values[numbers[i]].v[0] > 0;
        sample_at(s, now);
        if (was == (s->values[numbers[i]].v[0] > 0))
            continue;
        find_surface(s, numbers[i], was ? last : now, was ? now : last);
        if (refutes(s, claim, last) || refutes(s, claim, now)) {
            memcpy(point, refutes(s, claim, last) ? last : now, sizeof now);
            return true;
        }
    }
    return false;
}

/* Checks claims at pairs of points; `shape` is what they are claimed of. */
static bool check_pairs(Elaboration *e, const Shape *shape, const ShapeClaims *claims)
{
    Node     roots[2 * MAX_SHAPE_CLAIMS];
    Sampling s;
    for (uint32_t i = 0; i < claims->count; i++) {
        roots[2 * i]     = claims->items[i].a;
        roots[2 * i + 1] = claims->items[i].b;
    }
    if (claims->count == 0 || !start_sampling(e, &s, roots, 2 * claims->count, shape->box))
        return true;
    for (uint32_t k = 0; k < claims->count; k++) {
        const ShapeClaim *claim = &claims->items[k];
        s.flat                  = shape->figure && strcmp(claim->property, "figure") != 0;
        for (uint32_t i = 0; i < s.count; i++) {
            double before[3], point[3];
            sample_point(i, s.around, before);
            sample_point(i + 1, s.around, point);
            if (!refutes_between(&s, claim, before, point))
                continue;
            refuse_claim(e, shape->declaration->syntax, claim->property, claim->wrong, point);
            return false;
        }
    }
    return true;
}

/* ---- at the surface ---- */

/* Places of the surface, a millionth of the size inside of it at most. */
typedef struct Surfaces {
    double   points[SAMPLES][3];
    uint32_t count;
} Surfaces;

static void find_surfaces(const Sampling *s, Node distance, Surfaces *surfaces)
{
    surfaces->count = 0;
    for (uint32_t i = 0; i < s->count; i++) {
        double a[3], b[3];
        sample_point(i, s->around, a);
        sample_point(i + 1, s->around, b);
        sample_at(s, a);
        bool outside = s->values[distance].v[0] > 0;
        sample_at(s, b);
        if (outside == (s->values[distance].v[0] > 0))
            continue;
        find_surface(s, distance, outside ? a : b, outside ? b : a);
        memcpy(surfaces->points[surfaces->count++], outside ? b : a, sizeof a);
    }
}

/* Returns the distance from a point to the nearest point of the surface. */
static double distance_to(const Surfaces *surfaces, const double p[3])
{
    double least = HUGE_VAL;
    for (uint32_t i = 0; i < surfaces->count; i++) {
        const double *at = surfaces->points[i];
        least = fmin(least, real_hypot(real_hypot(at[0] - p[0], at[1] - p[1]), at[2] - p[2]));
    }
    return least;
}

/* A `bound` is no larger than the distance to any point of the surface. */
static bool check_bound(Elaboration *e, const Shape *shape, const Sampling *s,
                        const Surfaces *surfaces)
{
    for (uint32_t i = 0; i < s->count; i++) {
        double point[3];
        sample_point(i, s->around, point);
        sample_at(s, point);
        double bound = s->values[shape->bound].v[0];
        if (!(s->values[shape->distance].v[0] > 0))
            continue;
        double length = distance_to(surfaces, point);
        if (bound <= length * (1 + 1e-6) + 1e-6 * s->size)
            continue;
        const char *found = diag_text(e->diags, "it is %.4g, and the surface %.4g away,", bound,
                                      length);
        refuse_claim(e, shape->declaration->syntax, "bound", found, point);
        return false;
    }
    return true;
}

static bool check_uv(Elaboration *e, const Shape *shape, const Sampling *s, Surfaces *surfaces)
{
    for (uint32_t i = 0; i < surfaces->count; i++) {
        sample_at(s, surfaces->points[i]);
        if (node_value_is_finite(e->graph, shape->uv, s->values))
            continue;
        refuse_claim(e, shape->declaration->syntax, "uv", "it is not finite", surfaces->points[i]);
        return false;
    }
    return true;
}

static bool check_at_surface(Elaboration *e, const Shape *shape)
{
    Node     roots[3] = {shape->distance};
    size_t   count    = 1;
    Sampling s;
    Surfaces surfaces;
    if (shape->bound != NODE_NONE)
        roots[count++] = shape->bound;
    if (shape->uv != NODE_NONE)
        roots[count++] = shape->uv;
    if (count == 1 || !start_sampling(e, &s, roots, count, shape->box))
        return true;
    s.flat = shape->figure;
    find_surfaces(&s, shape->distance, &surfaces);
    return (shape->bound == NODE_NONE || check_bound(e, shape, &s, &surfaces)) &&
           (shape->uv == NODE_NONE || check_uv(e, shape, &s, &surfaces));
}

bool check_claims(Elaboration *e, const Shape *shape, double slope)
{
    if (!check_slope_and_box(e, shape, slope))
        return false;
    if (is_of_library(e, shape))
        return true;
    ShapeClaims claims = claims_of(e->graph, shape, e->scratch);
    return (!shape->exact || check_exact(e, shape)) && check_pairs(e, shape, &claims) &&
           check_at_surface(e, shape);
}

bool check_core(Elaboration *e, const Shape *shape, const Shape *core, Node rounding)
{
    if (is_of_library(e, shape))
        return true;
    ShapeClaims claims = core_claims(e->graph, shape, core, rounding, e->scratch);
    bool        good   = check_pairs(e, shape, &claims);
    arena_free(e->scratch);
    return good;
}

bool check_hull(Elaboration *e, const Shape *shape, const Shape *hull)
{
    if (is_of_library(e, shape))
        return true;
    ShapeClaims claims = hull_claims(e->graph, shape, hull, e->scratch);
    bool        good   = check_pairs(e, shape, &claims);
    arena_free(e->scratch);
    return good;
}
