/*
 * How far rays may go along a polynomial (ray_step.c), by each of the three methods, against
 * the roots that formulas.h finds: the library's surfaces, and random polynomials.
 *
 * No step may go beyond the root, and marching must arrive there: soon, where steps are exact.
 * Random polynomials are put to the question of krs_raycast as well.
 */
#include "compiler/scene/program.h"
#include "tests/oracle/formulas.h"
#include "tests/oracle/product.h"

#include <stdio.h>

/* The last two are of research. */
typedef enum Method { EXACT, TAYLOR, ROOT_FREE, METHODS } Method;

/* A scene of one component, ready to be asked along rays. */
typedef struct Steps {
    Product product;
    Method  method;
    Node    root;
    Tape    tape;
} Steps;

static const char *const method_names[METHODS] = {"exact", "taylor", "root-free"};
/* A ray has arrived where its steps are so short, in radii of the region; then it is as near to its
   root, which is where the other methods take many steps. */
static const double enough[METHODS]  = {1e-10, 1e-6, 1e-6};
static const double arrived[METHODS] = {1e-8, 2e-3, 2e-3};
/* How many steps a ray may need on average and at most. */
static const int mean_steps[METHODS] = {20, 100, 100};
enum { MAX_STEPS = 20000 };

/* Takes `product`, which steps_free frees. */
static Steps steps_new(Product product, Method method)
{
    KrsScene *scene = product.scene;
    assert_int_equal(krs_component_count(scene), 1);
    const Node *root  = method == EXACT    ? roots_of(&scene->roots, ROOTS_ALONG).items
                        : method == TAYLOR ? research_roots(&scene->roots, RESEARCH_TAYLOR)
                                           : research_roots(&scene->roots, RESEARCH_ROOT_FREE);
    Steps       steps = {product, method, root[0], {0}};
    steps.tape        = tape_new(scene->graph, &steps.root, 1, &scene->arena);
    state_refresh(product.state);
    tape_run_frame(&steps.tape, product.state->parameters, product.state->values);
    return steps;
}

static double step_at(const Steps *steps, Vec p, Vec direction)
{
    double at[3] = {p.x, p.y, p.z}, v[3] = {direction.x, direction.y, direction.z};
    tape_run_surface(&steps->tape, at, v, 0, steps->product.state->values);
    return steps->product.state->values[steps->root].v[0];
}

/* One ray against what is known of it; returns the number of steps. */
static int march(const Steps *steps, Formula *formula, double radius, Vec origin, Vec direction,
                 const Entry *entry, const char *what)
{
    double end = vec_length(origin) + radius, t = 0, step = 1, leeway = 1e-8 * radius;
    double truth = entry->fate == RAY_HITS ? (double)entry->t : end;
    int    count = 0;
    if (entry->fate == RAY_HITS && !entry->on_ball) {
        Vec hit = vec_add(origin, vec_scale(truth, direction));
        leeway  = surface_leeway(formula, radius, hit, direction);
    }
    while (count < MAX_STEPS && t < end && fabs(step) > enough[steps->method] * radius) {
        step = fmax(step_at(steps, vec_add(origin, vec_scale(t, direction)), direction), 0);
        t += step;
        count++;
        if (t > truth + leeway && truth < end)
            fail_msg("%s: a step goes to %.12g, the surface is at %.12g", what, t, truth);
    }
    if (truth < end ? fabs(t - truth) > leeway + arrived[steps->method] * radius : t < end)
        fail_msg("%s: a ray ends at %.12g after %d steps, the surface is at %.12g", what, t, count,
                 truth);
    return count;
}

static int march_rays(const Steps *steps, Formula *formula, double radius, int rays, int *hits,
                      const char *what)
{
    Random random = {7};
    int    count  = 0;
    for (int i = 0; i < rays; i++) {
        Vec origin, direction;
        random_ray(&random, radius, &origin, &direction);
        Entry entry = surface_entry(formula, radius, origin, direction);
        if (entry.fate == RAY_DOUBTFUL)
            continue;
        *hits += entry.fate == RAY_HITS && !entry.on_ball;
        count += march(steps, formula, radius, origin, direction, &entry, what);
    }
    return count;
}

static void surfaces_are_not_overshot(void **state)
{
    Method    method = (Method)(uintptr_t)*state;
    const int rays   = method == EXACT ? 80 : 25;
    for (size_t i = 0; i < SURFACES; i++) {
        const Surface *surface = &surfaces[i];
        Steps steps = steps_new(product_format("use \"std/surfaces.krs\";\n%sshow %sopen: false);",
                                               surface->before, surface->call),
                                method);
        int   hits  = 0;
        int   count = march_rays(&steps, surface->formula, surface->radius, rays, &hits,
                                 surface->name);
        if (hits < 3 || count > rays * mean_steps[method])
            fail_msg("%s, %s: %d hits, %d steps", surface->name, method_names[method], hits, count);
        product_free(&steps.product);
    }
}

/* ---- random polynomials ---- */

enum { MAX_TERMS = 12 };

/* The one that is looked at: a Formula has no place for it. */
static struct Polynomial {
    int    terms, exponents[MAX_TERMS][3];
    double factors[MAX_TERMS];
} polynomial;

static Real polynomial_value(const Real p[3])
{
    Real sum = -0.1;
    for (int i = 0; i < polynomial.terms; i++) {
        Real term = polynomial.factors[i];
        for (int axis = 0; axis < 3; axis++)
            for (int k = 0; k < polynomial.exponents[i][axis]; k++)
                term *= p[axis];
        sum += term;
    }
    return sum;
}

/* Sums of terms, or of products of a term and a sum, of any degree up to `most`. */
static void draw_polynomial(Random *random, int most, SceneText *text)
{
    int degree       = 1 + random_below(random, most);
    polynomial.terms = 2 + random_below(random, MAX_TERMS - 1);
    text->length     = 0;
    scene_write(text, "show algebraic(");
    for (int k = 0; k < polynomial.terms; k++) {
        int left = k ? random_below(random, degree + 1) : degree, *powers = polynomial.exponents[k];
        for (int axis = 0; axis < 3; axis++) {
            powers[axis] = axis < 2 ? random_below(random, left + 1) : left;
            left -= powers[axis];
        }
        polynomial.factors[k] = random_between(random, -2, 2);
        scene_write(text, "%s(%.17g) * x^%d * y^%d * z^%d", k ? " + " : "", polynomial.factors[k],
                    powers[0], powers[1], powers[2]);
    }
    scene_write(text, " == 0.1).within(sphere(1.5));");
}

static void ask_rays(const Product *product, Random *random, int rays, const char *what)
{
    for (int i = 0; i < rays; i++) {
        Vec origin, direction;
        random_ray(random, 1.5, &origin, &direction);
        Entry entry = surface_entry(polynomial_value, 1.5, origin, direction);
        if (entry.fate == RAY_DOUBTFUL)
            continue;
        KrsHit hit = product_raycast(product, origin, direction, 100, 0);
        if (hit.unresolved || hit.hit != (entry.fate == RAY_HITS))
            fail_msg("%s: ray %d is %s, its root at %.12Lg", what, i,
                     hit.hit ? "a false hit" : "missed", entry.t);
        if (!hit.hit)
            continue;
        Vec    p      = vec(hit.point[0], hit.point[1], hit.point[2]);
        double leeway = entry.on_ball ? 1e-8 : surface_leeway(polynomial_value, 1.5, p, direction);
        if (fabs(hit.t - (double)entry.t) > leeway)
            fail_msg("%s: ray %d ends at %.12g, its root is at %.12Lg", what, i, hit.t, entry.t);
    }
}

static void random_polynomials_are_not_overshot(void **state)
{
    enum { RAYS = 8 };
    static SceneText text;
    Method           method = (Method)(uintptr_t)*state;
    Random           random = {101};
    int              hits = 0, count = 0, polynomials = method == EXACT ? 200 : 80;
    for (int i = 0; i < polynomials; i++) {
        draw_polynomial(&random, i % 4 == 0 ? 20 : 9, &text);
        Steps steps = steps_new(product_compile(text.bytes), method);
        count += march_rays(&steps, polynomial_value, 1.5, RAYS, &hits, text.bytes);
        if (method == EXACT)
            ask_rays(&steps.product, &random, RAYS, text.bytes);
        product_free(&steps.product);
    }
    if (hits < polynomials || count > polynomials * RAYS * mean_steps[method])
        fail_msg("%s: %d hits, %d steps", method_names[method], hits, count);
}

int main(void)
{
    product_wants_research();
    struct CMUnitTest tests[2 * METHODS];
    static char       names[2 * METHODS][64];
    for (int i = 0; i < METHODS; i++) {
        void *state = (void *)(uintptr_t)i;
        snprintf(names[2 * i], sizeof names[0], "surfaces of the library, %s", method_names[i]);
        snprintf(names[2 * i + 1], sizeof names[0], "random polynomials, %s", method_names[i]);
        tests[2 * i]     = (struct CMUnitTest){names[2 * i], surfaces_are_not_overshot, NULL, NULL,
                                               state};
        tests[2 * i + 1] = (struct CMUnitTest){
            names[2 * i + 1], random_polynomials_are_not_overshot, NULL, NULL, state};
    }
    return _cmocka_run_group_tests("rays", tests, 2 * METHODS, NULL, NULL);
}
