/*
 * judge.c: random points, random balls around them, random pairs.
 */
#include "tests/oracle/judge.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>

enum { BALL_SAMPLES = 48, NEIGHBOURS = 6 };

/* Rounding in the evaluation of the field, in units of space; scenes here are a few units wide. */
static const double ROUNDING = 1e-9;

static bool ball_is_mixed(const Trial *trial, Random *random, Vec point, bool inside, double radius)
{
    for (int i = 0; i < BALL_SAMPLES; i++)
        if (trial->inside(trial->inside_user, random_in_ball(random, point, radius)) != inside)
            return true;
    return false;
}

/* Pairs from a millionth of the region to all of it apart. */
static int count_steep_pairs(const Trial *trial, Random *random, Vec point, double value,
                             double *steepest)
{
    int steep = 0;
    for (int i = 0; i < NEIGHBOURS; i++) {
        double reach = trial->half * pow(10, random_between(random, -6, 0));
        Vec    other = vec_add(point, vec_scale(reach, random_unit(random)));
        double rise  = fabs(trial->field(trial->field_user, other) - value);
        *steepest    = fmax(*steepest, rise / (reach + ROUNDING));
        steep += !(rise <= reach * (1 + 1e-7) + ROUNDING);
    }
    return steep;
}

Verdict judge(const Trial *trial)
{
    Verdict verdict = {0};
    Random  random  = {trial->seed};
    for (int i = 0; i < trial->points; i++) {
        Vec    point  = vec_add(trial->centre, random_in_cube(&random, trial->half));
        double value  = trial->field(trial->field_user, point);
        bool   inside = trial->inside(trial->inside_user, point);
        double radius = 0.999 * fabs(value) - ROUNDING;
        if (radius > 0) {
            verdict.sign_errors += (value < 0) != inside;
            verdict.ball_errors += ball_is_mixed(trial, &random, point, inside, radius);
        }
        verdict.sign_errors += isnan(value) != 0;
        verdict.slope_errors += count_steep_pairs(trial, &random, point, value, &verdict.steepest);
    }
    return verdict;
}

double exaggerated_field(const void *exaggeration, Vec point)
{
    const Exaggeration *e = exaggeration;
    return e->factor * e->field(e->user, point);
}

void judge_acquits(const Trial *trial, const char *what)
{
    Verdict verdict = judge(trial);
    if (verdict.sign_errors + verdict.ball_errors + verdict.slope_errors > 0)
        fail_msg("%s: of %d points, %d on the wrong side, %d farther than the surface, "
                 "%d steep pairs (slope %.9g)",
                 what, trial->points, verdict.sign_errors, verdict.ball_errors,
                 verdict.slope_errors, verdict.steepest);
}

static Verdict judge_exaggerated(const Trial *trial, double factor)
{
    Exaggeration wrong   = {trial->field, trial->field_user, factor};
    Trial        planted = *trial;
    planted.field        = exaggerated_field;
    planted.field_user   = &wrong;
    return judge(&planted);
}

void judge_refutes_larger(const Trial *trial, double factor, const char *what)
{
    Verdict verdict = judge_exaggerated(trial, factor);
    if (verdict.ball_errors == 0 || verdict.slope_errors == 0)
        fail_msg("%s: %g times the field is not refuted: %d balls, %d slopes", what, factor,
                 verdict.ball_errors, verdict.slope_errors);
}

void judge_refutes_steeper(const Trial *trial, double factor, const char *what)
{
    Verdict verdict = judge_exaggerated(trial, factor);
    if (verdict.slope_errors == 0)
        fail_msg("%s: %g times the field is not refuted: slope %g", what, factor, verdict.steepest);
}
