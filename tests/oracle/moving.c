/*
 * Expressions that change ever faster with time, or with a parameter without limits, against
 * themselves.
 *
 * No constant bounds the slope of sin(time * x), so the host finds it for each state.  Each solid
 * is a formula written twice, as a scene and as C: the judge tries to refute its distance at many
 * times, slow and fast, and the slope in the parameter block is held against the largest
 * difference quotient of the C formula: never below it and, unless time flies, not far above.
 * The same distances over the slope of another state are refuted: a slot that is not refreshed
 * would be noticed.
 */
#include "tests/oracle/judge.h"
#include "tests/oracle/product.h"

#include <stdio.h>

typedef struct Moment {
    double time, k;
} Moment;
static const Moment moments[] = {{0, 1},  {0.3, -2},  {1, 0},  {-7, 1.5},
                                 {40, 9}, {1e3, -30}, {1e5, 2}};
enum { MOMENTS = sizeof moments / sizeof *moments, FAST = 4 };

/* The expression of which the slot has the slope. */
typedef double Formula(Vec p, Moment f);

typedef struct Solid {
    const char *name, *text;
    Formula    *formula, *solid; /* `solid` is negative inside; NULL: so is the formula */
    double      half;            /* points are drawn from this cube */
    double      cut;             /* half side of the cube that the text cuts it to; 0: none */
    double      slope_factor;    /* how many times too large the slope may be, up to FAST */
} Solid;

static double wobble(Vec p, Moment f) { return vec_length(p) - 1 + 0.1 * sin(p.x * f.time); }
static double sheet(Vec p, Moment f) { return p.y - 0.2 * sin(f.time * p.x) * cos(p.z); }
static double product_wave(Vec p, Moment f) { return p.z + 0.3 * sin(p.x * p.y * f.time); }
static double rod(Vec p, Moment f)
{
    return hypot(p.x, p.y) - 0.7 + 0.2 * sin(f.k * f.k * p.z + f.time);
}
static double bowl(Vec p, Moment f)
{
    double side = fmax(fmax(fabs(p.x), fabs(p.y)), fabs(p.z)) - 0.9;
    return fmax(p.y - f.time * p.x * p.x, side);
}
static double bump(Vec p, Moment f) { return sin(f.time * p.x) + cos(f.k * p.z); }
static double bumpy(Vec p, Moment f) { return vec_length(p) - 1 - 0.15 * bump(p, f); }
static double mirrored(Vec p, Moment f)
{
    return wobble(vec(p.x > 0.5 ? 1 - p.x : p.x, p.y, p.z), f);
}

#define WOBBLE "shape wobble(r = 1) { distance: length(p) - r + 0.1 * sin(x * time) }\n"

static const Solid solids[] = {
    {"a shape", WOBBLE "show wobble();", wobble, NULL, 2, 0, 1.2},
    {"a sheet", "show field(y - 0.2 * sin(time * x) * cos(z));", sheet, NULL, 2, 0, 1.5},
    {"a cut field", "show field(z + 0.3 * sin(x * y * time)).within(box([3, 3, 3]));", product_wave,
     NULL, 1.8, 1.5, 1.6},
    {"a parameter", "param k = 1; show field(length([x, y]) - 0.7 + 0.2 * sin(k * k * z + time));",
     rod, NULL, 2, 0, 1.5},
    {"a bounded shape",
     "shape bowl() { distance: max(y - time * x * x, max(max(abs(x), abs(y)), abs(z)) - 0.9),"
     " within: box([2, 2, 2]) }\nshow bowl();",
     bowl, NULL, 1.5, 0, 2},
    {"a displacement", "param k = 1;\nshow sphere(1).displace(sin(time * x) + cos(k * z), 0.15);",
     bump, bumpy, 1.8, 0, 1.6},
    {"a sequence", WOBBLE "show krs { kernel wobble(); reflect plane([1, 0, 0], 0.5); };", wobble,
     mirrored, 2, 0, 1.2},
};
enum { SOLIDS = sizeof solids / sizeof *solids };

typedef struct Asked {
    const Solid *solid;
    Moment       moment;
} Asked;

static bool inside(const void *user, Vec p)
{
    const Asked *asked = user;
    const Solid *solid = asked->solid;
    double       side  = fmax(fmax(fabs(p.x), fabs(p.y)), fabs(p.z)) - solid->cut;
    double       value = (solid->solid ? solid->solid : solid->formula)(p, asked->moment);
    return value <= 0 && (solid->cut == 0 || side <= 0);
}

static void set_moment(const Product *product, Moment moment)
{
    KrsParameter k;
    if (krs_parameter(product->scene, 0, &k) == KRS_OK)
        assert_int_equal(krs_state_set(product->state, "k", &moment.k, 1), KRS_OK);
    assert_int_equal(krs_state_set_time(product->state, moment.time), KRS_OK);
}

/* What the host has found; there is one in each scene. */
static double slope_in_block(const Product *product)
{
    KrsStateSlope slope;
    float         block[8][4];
    assert_int_equal(krs_state_slope_count(product->scene), 1);
    assert_int_equal(krs_state_slope(product->scene, 0, &slope), KRS_OK);
    assert_in_range(krs_parameter_slots(product->scene), slope.slot + 1, 8);
    krs_state_parameters(product->state, block);
    return block[slope.slot][0];
}

static void is_safe(void **state)
{
    const Solid *solid   = *state;
    Product      product = product_compile(solid->text);
    for (int i = 0; i < MOMENTS; i++) {
        Asked asked = {solid, moments[i]};
        Trial trial = {product_field, &product, inside, &asked, vec(0, 0, 0), solid->half, 200, 17};
        set_moment(&product, moments[i]);
        judge_acquits(&trial, solid->name);
    }
    product_free(&product);
}

/* Largest difference quotient, over steps that are short for the moment, where the expression
   counts. */
static double steepest(const Solid *solid, Moment moment, double half)
{
    Random random = {31};
    double most = 0, step = 1e-5 / (1 + fabs(moment.time) + moment.k * moment.k);
    for (int i = 0; i < 4000; i++) {
        Vec    p = random_in_cube(&random, half), direction = vec_scale(step, random_unit(&random));
        Vec    gradient;
        double at = solid->formula(p, moment);
        if (i % 2) { /* up the gradient */
            gradient = vec(solid->formula(vec(p.x + step, p.y, p.z), moment) - at,
                           solid->formula(vec(p.x, p.y + step, p.z), moment) - at,
                           solid->formula(vec(p.x, p.y, p.z + step), moment) - at);
            if (vec_length(gradient) > 0)
                direction = vec_scale(step, vec_unit(gradient));
        }
        most = fmax(most, fabs(solid->formula(vec_add(p, direction), moment) - at) /
                              vec_length(direction));
    }
    return most;
}

static void slopes_are_those_of_the_state(void **state)
{
    const Solid *solid   = *state;
    Product      product = product_compile(solid->text);
    for (int i = 0; i < MOMENTS; i++) {
        set_moment(&product, moments[i]);
        double half  = solid->cut > 0 ? solid->cut : fmin(solid->half, 1);
        double found = slope_in_block(&product), least = steepest(solid, moments[i], half);
        bool   tight = i > FAST || found <= solid->slope_factor * least + 1e-4;
        if (!(found >= least * (1 - 1e-4) && tight))
            fail_msg("%s at time %g: slope %g, seen %g", solid->name, moments[i].time, found,
                     least);
    }
    product_free(&product);
}

/* Distances of one moment, divided by the slope of another. */
static void stale_slopes_are_refuted(void **state)
{
    const Solid *solid   = *state;
    Product      product = product_compile(solid->text);
    set_moment(&product, moments[0]);
    double stale = fmax(slope_in_block(&product), 1);
    set_moment(&product, moments[FAST]);
    double fresh = fmax(slope_in_block(&product), 1);
    Asked  asked = {solid, moments[FAST]};
    /* What is displaced is divided by the sum of both slopes. */
    double       factor = solid->formula == bump ? (1 + 0.15 * fresh) / (1 + 0.15 * stale)
                                                 : fresh / stale;
    Exaggeration wrong  = {product_field, &product, factor};
    Trial   trial = {exaggerated_field, &wrong, inside, &asked, vec(0, 0, 0), solid->half, 200, 17};
    Verdict verdict = judge(&trial);
    assert_true(factor > 1.5);
    if (verdict.slope_errors == 0 || verdict.ball_errors == 0)
        fail_msg("%s: %g times the distance is not refuted", solid->name, factor);
    product_free(&product);
}

int main(void)
{
    static const struct {
        const char        *what;
        CMUnitTestFunction test;
    } kinds[] = {{"is safe", is_safe},
                 {"has the slope of the moment", slopes_are_those_of_the_state},
                 {"would show a stale slope", stale_slopes_are_refuted}};
    enum { KINDS = sizeof kinds / sizeof *kinds };
    struct CMUnitTest tests[KINDS * SOLIDS];
    static char       names[KINDS * SOLIDS][64];
    for (size_t i = 0; i < KINDS * SOLIDS; i++) {
        const Solid *solid = &solids[i / KINDS];
        snprintf(names[i], sizeof names[0], "%s %s", solid->name, kinds[i % KINDS].what);
        tests[i] = (struct CMUnitTest){names[i], kinds[i % KINDS].test, NULL, NULL,
                                       (void *)(uintptr_t)solid};
    }
    return _cmocka_run_group_tests("slopes of states", tests, KINDS * SOLIDS, NULL, NULL);
}
