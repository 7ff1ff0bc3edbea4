/*
 * Algebraic surfaces and fields against their own expressions.
 *
 * Each solid is a formula written twice, as a scene and as C.  The judge asks the C formula
 * which points are inside, and tries to refute the compiler's distance: by its sign, by balls
 * that hold both sides, and by its slope.  A bound can be safe and of no use, so Newton's method
 * on the C formula finds surface points near the asked ones, and the share of their distance that
 * the compiler's distance reaches must be sound on average.
 */
#include "tests/oracle/judge.h"
#include "tests/oracle/product.h"

#include <stdio.h>

typedef double Formula(Vec p);

typedef struct Solid {
    const char *name, *text;
    Formula    *formula;
    double      half;  /* points are drawn from this cube */
    double      share; /* of the distance to the surface that is reached at least, on average */
    double      cut;   /* half side of the cube that the text cuts it to; 0: none */
} Solid;

static const double T = 1.6180339887498948482;

static double square(double a) { return a * a; }
static double power(double a, int n) { return n ? a * power(a, n - 1) : 1; }

static double quadric(Vec p) { return vec_dot(p, p) - 1; }
static double cayley(Vec p) { return 4 * vec_dot(p, p) + 16 * p.x * p.y * p.z - 1; }
static double ding_dong(Vec p) { return p.x * p.x + p.z * p.z - (1 - p.y) * p.y * p.y; }
static double kummer(Vec p)
{
    double l = 2.9 / 1.7, u = square(1 - p.z) - 2 * p.x * p.x, v = square(1 + p.z) - 2 * p.y * p.y;
    return square(vec_dot(p, p) - 1.3) - l * u * v;
}
static double barth_sextic(Vec p)
{
    double x = p.x * p.x, y = p.y * p.y, z = p.z * p.z, g = T * T;
    return (1 + 2 * T) * square(x + y + z - 1) - 4 * (g * x - y) * (g * y - z) * (g * z - x);
}
static double barth_decic(Vec p)
{
    double x = p.x * p.x, y = p.y * p.y, z = p.z * p.z, g = power(T, 4), r = x + y + z;
    return 8 * (x - g * y) * (y - g * z) * (z - g * x) *
               (x * x + y * y + z * z - 2 * (x * y + x * z + y * z)) +
           (3 + 5 * T) * square(r - 1) * square(r - (2 - T));
}
/* T14(x) + T14(y) + T14(z) + 1, Chebyshev polynomials by their definition. */
static double chebyshev(double x)
{
    return fabs(x) <= 1 ? cos(14 * acos(x)) : cosh(14 * acosh(fabs(x)));
}
static double chmutov(Vec p) { return chebyshev(p.x) + chebyshev(p.y) + chebyshev(p.z) + 1; }
static double heart(Vec p)
{
    double a = p.x * p.x + 2.25 * p.z * p.z + p.y * p.y - 1;
    return power(a, 3) - p.x * p.x * power(p.y, 3) - 0.1125 * p.z * p.z * power(p.y, 3);
}
static double gyroid(Vec p)
{
    return sin(p.x) * cos(p.y) + sin(p.y) * cos(p.z) + sin(p.z) * cos(p.x);
}
static double waves(Vec p) { return p.y - 0.3 * sin(2 * p.x) * exp(0.4 * p.z); }
static double superquadric(Vec p)
{
    return pow(fabs(p.x), 2.5) + pow(fabs(p.y), 2.5) + pow(fabs(p.z), 2.5) - 1;
}
static double cushion(Vec p)
{
    double bumps = 0.5 * sin(9 * p.x) * sin(9 * p.y);
    return power(p.x, 10) + power(p.y, 10) + power(fabs(p.z), 5) - 1 + bumps;
}
/* Waves on waves, the smallest the steepest. */
static double ripples(Vec p)
{
    double small = 0.1 * sin(20 * p.x + p.z) + 0.02 * sin(150 * p.z - p.x);
    return p.y - 0.4 * sin(p.x) * cos(p.z) - small;
}
static double cliffs(Vec p) { return p.y - 0.1 * exp(1.5 * sin(2 * p.x) + p.z); }
static double swell(Vec p) { return exp(p.x) + exp(2 * p.y) + exp(-p.z) * p.x - 4; }
#define CHMUTOV(x)                                                                \
    "8192 * " #x "^14 - 28672 * " #x "^12 + 39424 * " #x "^10 - 26880 * " #x "^8" \
    " + 9408 * " #x "^6 - 1568 * " #x "^4 + 98 * " #x "^2 - 1"

static const Solid solids[] = {
    {"quadric", "show algebraic(x^2 + y^2 + z^2 == 1);", quadric, 2, 0.6, 0},
    {"cayley", "show algebraic(4 * (x^2 + y^2 + z^2) + 16 * x * y * z == 1);", cayley, 1.5, 0.3, 0},
    {"ding-dong", "show algebraic(x^2 + z^2 == (1 - y) * y^2);", ding_dong, 1.5, 0.3, 0},
    {"kummer",
     "let l = 2.9 / 1.7;\nshow algebraic((x^2 + y^2 + z^2 - 1.3)^2 == l * ((1 - z)^2 - 2 * x^2)"
     " * ((1 + z)^2 - 2 * y^2));",
     kummer, 2, 0.2, 0},
    {"Barth sextic",
     "let g = (1 + sqrt(5)) / 2;\nshow algebraic((1 + 2 * g) * (x^2 + y^2 + z^2 - 1)^2 =="
     " 4 * (g^2 * x^2 - y^2) * (g^2 * y^2 - z^2) * (g^2 * z^2 - x^2));",
     barth_sextic, 1.8, 0.15, 0},
    {"Barth decic",
     "let g = (1 + sqrt(5)) / 2;\nlet k = g^4;\nlet n = 2 - g;\nshow algebraic("
     "8 * (x^2 - k * y^2) * (y^2 - k * z^2) * (z^2 - k * x^2) * (x^4 + y^4 + z^4"
     " - 2 * (x^2 * y^2 + x^2 * z^2 + y^2 * z^2)) + (3 + 5 * g) * (x^2 + y^2 + z^2 - 1)^2"
     " * (x^2 + y^2 + z^2 - n)^2 == 0);",
     barth_decic, 1.5, 0.1, 0},
    {"Chmutov", "show algebraic(" CHMUTOV(x) " + (" CHMUTOV(y) ") + (" CHMUTOV(z) ") + 1 == 0);",
     chmutov, 1.05, 0.05, 0},
    {"heart", "show algebraic((x^2 + 9 / 4 * z^2 + y^2 - 1)^3 == x^2 * y^3 + 9 / 80 * z^2 * y^3);",
     heart, 1.5, 0.2, 0},
    {"gyroid", "show field(sin(x) * cos(y) + sin(y) * cos(z) + sin(z) * cos(x));", gyroid, 4, 0.35,
     0},
    {"waves", "show field(y - 0.3 * sin(2 * x) * exp(0.4 * z)).within(box([4, 4, 4]));", waves, 1.9,
     0.2, 2},
    {"superquadric",
     "show field(pow(abs(x), 2.5) + pow(abs(y), 2.5) + pow(abs(z), 2.5) - 1).within(box([2.2, 2.2,"
     " 2.2]));",
     superquadric, 2, 0.2, 0},
    {"cushion",
     "show field(pow(abs(x), 10) + pow(abs(y), 10) + pow(abs(z), 5) - 1"
     " + 0.5 * sin(9 * x) * sin(9 * y))"
     ".within(box([2.6, 2.6, 2.6]));",
     cushion, 1.29, 0.18, 0},
    {"ripples",
     "show field(y - 0.4 * sin(x) * cos(z) - (0.1 * sin(20 * x + z) + 0.02 * sin(150 * z - x)));",
     ripples, 5, 0.3, 0},
    {"swell", "show field(exp(x) + exp(2 * y) + exp(-z) * x - 4).within(box([4, 4, 4]));", swell,
     1.9, 0.4, 2},
};
enum { SOLIDS = sizeof solids / sizeof *solids };

static double box_side(Vec p, double half)
{
    return fmax(fmax(fabs(p.x), fabs(p.y)), fabs(p.z)) - half;
}

static bool inside(const void *user, Vec p)
{
    const Solid *solid  = user;
    bool         within = solid->cut == 0 || box_side(p, solid->cut) <= 0;
    return solid->formula(p) <= 0 && within;
}

static void is_safe(void **state)
{
    const Solid *solid   = *state;
    Product      product = product_compile(solid->text);
    Trial trial = {product_field, &product, inside, solid, vec(0, 0, 0), solid->half, 800, 17};
    judge_acquits(&trial, solid->name);
    product_free(&product);
}

/* Down the gradient of |f| from p to the surface; false when that leads nowhere. */
static bool nearby_surface(Formula *f, Vec p, Vec *found)
{
    const double h = 1e-6;
    for (int i = 0; i < 60; i++) {
        double value    = f(p);
        Vec    gradient = vec((f(vec(p.x + h, p.y, p.z)) - f(vec(p.x - h, p.y, p.z))) / (2 * h),
                              (f(vec(p.x, p.y + h, p.z)) - f(vec(p.x, p.y - h, p.z))) / (2 * h),
                              (f(vec(p.x, p.y, p.z + h)) - f(vec(p.x, p.y, p.z - h))) / (2 * h));
        double squared  = vec_dot(gradient, gradient);
        if (fabs(value) <= 1e-10 * (1 + sqrt(squared))) {
            *found = p;
            return true;
        }
        if (!(squared > 1e-12))
            return false;
        p = vec_sub(p, vec_scale(value / squared, gradient));
    }
    return false;
}

static void is_of_use(void **state)
{
    const Solid *solid = *state;
    if (solid->cut != 0)
        return;
    Product product = product_compile(solid->text);
    Random  random  = {23};
    double  sum = 0, most = 0;
    int     count = 0;
    for (int i = 0; i < 600; i++) {
        Vec p = random_in_cube(&random, solid->half), surface;
        if (!nearby_surface(solid->formula, p, &surface))
            continue;
        double share = fabs(product_distance(&product, p)) / vec_distance(p, surface);
        if (!isfinite(share))
            continue;
        most = fmax(most, share);
        sum += share;
        count++;
    }
    if (!(count > 200 && most <= 1 + 1e-6 && sum / count >= solid->share))
        fail_msg("%s: of %d distances at most %g, on average %g", solid->name, count, most,
                 sum / count);
    product_free(&product);
}

/* ---- rays ---- */

/* Where a ray first comes into the solid, by small steps and bisection; infinite: nowhere. */
static double first_root(const Solid *solid, Vec origin, Vec direction)
{
    const double STEP = 1e-3;
    for (double t = 0; t < 8; t += STEP) {
        if (!inside(solid, vec_add(origin, vec_scale(t, direction))))
            continue;
        double low = t - STEP, high = t;
        for (int i = 0; i < 40; i++) {
            double middle = (low + high) / 2;
            if (inside(solid, vec_add(origin, vec_scale(middle, direction))))
                high = middle;
            else
                low = middle;
        }
        return high;
    }
    return INFINITY;
}

/* Nothing is said of rays that pass the solid by less than its smallest features. */
static void rays_end_at_roots(void **state)
{
    const double TOLERANCE = 1e-5;
    (void)state;
    Random random = {47};
    for (size_t i = 0; i < SOLIDS; i++) {
        const Solid *solid = &solids[i];
        if (solid->formula != cushion && solid->formula != swell && solid->formula != superquadric)
            continue;
        Product product = product_compile(solid->text);
        int     hits    = 0;
        for (int k = 0; k < 150; k++) {
            Vec    origin = vec_scale(4, random_unit(&random)), target = random_in_cube(&random, 1);
            Vec    offset    = vec_sub(target, origin);
            Vec    direction = vec_scale(1 / vec_distance(target, origin), offset);
            double root      = first_root(solid, origin, direction);
            KrsHit hit       = product_raycast(&product, origin, direction, 8, TOLERANCE);
            if (!isfinite(root))
                continue;
            hits++;
            if (!hit.hit || fabs(hit.t - root) > 10 * TOLERANCE)
                fail_msg("%s: a ray ends after %.9g, not after %.9g", solid->name, hit.t, root);
        }
        assert_true(hits > 40);
        product_free(&product);
    }
}

/* ---- sheets ---- */

static double steepness(Formula *f, Vec p)
{
    const double h = 1e-6;
    double       x = f(vec(p.x + h, p.y, p.z)) - f(vec(p.x - h, p.y, p.z));
    double       y = f(vec(p.x, p.y + h, p.z)) - f(vec(p.x, p.y - h, p.z));
    double       z = f(vec(p.x, p.y, p.z + h)) - f(vec(p.x, p.y, p.z - h));
    return hypot(hypot(x, y), z) / (2 * h);
}

/* At the field's zeros, which are found by Newton's method, the distance is 0, and beside them it
   is more, on the sides of the box as well. */
static void sheets_are_thin(void **state)
{
    static const char *const text[] = {
        "show field(exp(x) + exp(2 * y) + exp(-z) * x - 4).within(box([4, 4, 4]), open: true);",
        "show field(y - 0.3 * sin(2 * x) * exp(0.4 * z)).within(box([4, 4, 4]), open: true);",
        "show field(y - 0.1 * exp(1.5 * sin(2 * x) + z)).within(box([4, 4, 4]), open: true);",
    };
    static Formula *const formulas[] = {swell, waves, cliffs};
    const double          half       = 0.5e-3 * 4 * sqrt(3);
    (void)state;
    Random random = {41};
    for (int i = 0; i < 3; i++) {
        Product product = product_compile(text[i]);
        int     zeros   = 0;
        for (int k = 0; k < 2000; k++) {
            Vec    p        = random_in_cube(&random, 2), surface;
            double side     = k % 2 ? 2 : p.x;
            p               = vec(side, p.y, p.z);
            double distance = fabs(formulas[i](p)) / steepness(formulas[i], p);
            if (distance > 0.3)
                assert_true(product_distance(&product, p) > 0);
            if (!nearby_surface(formulas[i], p, &surface) || box_side(surface, 1.99) > 0)
                continue;
            Vec    normal = vec_scale(1 / vec_distance(p, surface), vec_sub(p, surface));
            Vec    beside = vec_add(surface, vec_scale(3 * half, normal));
            double near   = fabs(formulas[i](beside)) / steepness(formulas[i], surface);
            assert_true(fabs(product_distance(&product, surface)) <= 1e-6);
            if (near > 2 * half)
                assert_true(product_distance(&product, beside) > 0);
            zeros++;
        }
        assert_true(zeros > 300);
        product_free(&product);
    }
}

/* ---- random polynomials ---- */

enum { MAX_TERMS = 12 };

typedef struct Polynomial {
    int    terms, exponents[MAX_TERMS][3];
    double factors[MAX_TERMS];
} Polynomial;

static bool in_polynomial(const void *user, Vec p)
{
    const Polynomial *poly = user;
    double            sum  = -0.1;
    for (int i = 0; i < poly->terms; i++)
        sum += poly->factors[i] * power(p.x, poly->exponents[i][0]) *
               power(p.y, poly->exponents[i][1]) * power(p.z, poly->exponents[i][2]);
    return sum <= 0;
}

static Polynomial random_polynomial(Random *random, SceneText *text)
{
    Polynomial poly   = {.terms = 2 + random_below(random, MAX_TERMS - 1)};
    int        degree = 1 + random_below(random, 9);
    scene_write(text, "show algebraic(");
    for (int k = 0; k < poly.terms; k++) {
        int left = k ? random_below(random, degree + 1) : degree;
        for (int axis = 0; axis < 3; axis++) {
            poly.exponents[k][axis] = axis < 2 ? random_below(random, left + 1) : left;
            left -= poly.exponents[k][axis];
        }
        poly.factors[k] = random_between(random, -2, 2);
        scene_write(text, "%s(%.17g) * x^%d * y^%d * z^%d", k ? " + " : "", poly.factors[k],
                    poly.exponents[k][0], poly.exponents[k][1], poly.exponents[k][2]);
    }
    scene_write(text, " == 0.1);");
    return poly;
}

static void random_polynomials_are_safe(void **state)
{
    (void)state;
    static SceneText text;
    Random           random  = {5};
    int              refuted = 0;
    for (int i = 0; i < 150; i++) {
        text.length        = 0;
        Polynomial poly    = random_polynomial(&random, &text);
        Product    product = product_compile(text.bytes);
        Trial trial = {product_field, &product, in_polynomial, &poly, vec(0, 0, 0), 1.5, 120, 29};
        judge_acquits(&trial, text.bytes);
        Exaggeration larger = {product_field, &product, 3};
        trial.field         = exaggerated_field;
        trial.field_user    = &larger;
        refuted += judge(&trial).ball_errors > 0;
        product_free(&product);
    }
    /* Three times as much is above the distance to most of these surfaces, and is noticed. */
    assert_true(refuted > 75);
}

/* ---- long formulas ---- */

enum { BALLS = 340 };

/* Balls, each of a field of its own steepness. */
typedef struct Balls {
    Vec    centre[BALLS];
    double radius[BALLS], steepness[BALLS];
} Balls;

static bool in_balls(const void *user, Vec p)
{
    const Balls *balls = user;
    bool         in    = false;
    for (int i = 0; i < BALLS; i++)
        in = in || vec_distance(p, balls->centre[i]) <= balls->radius[i];
    return in;
}

/* For long formulas less is tried (family/field_bounds.c, graph/bounds/facts.c). */
static void a_long_formula_is_safe(void **state)
{
    (void)state;
    static SceneText text;
    static Balls     balls;
    Random           random = {61};
    for (int i = 0; i < BALLS; i++) {
        Vec c              = random_in_cube(&random, 1);
        balls.centre[i]    = c;
        balls.radius[i]    = random_between(&random, 0.03, 0.15);
        balls.steepness[i] = random_between(&random, 0.5, 3);
        scene_write(&text, "let b%d = %.17g * (length(p - [%.17g, %.17g, %.17g]) - %.17g);\n", i,
                    balls.steepness[i], c.x, c.y, c.z, balls.radius[i]);
        if (i > 0)
            scene_write(&text, "let f%d = min(%c%d, b%d);\n", i, i > 1 ? 'f' : 'b', i - 1, i);
    }
    scene_write(&text, "show field(f%d).within(box([4, 4, 4]));", BALLS - 1);
    Product product = product_compile(text.bytes);
    Trial   trial   = {product_field, &product, in_balls, &balls, vec(0, 0, 0), 1.5, 400, 67};
    judge_acquits(&trial, "balls");
    judge_refutes_steeper(&trial, 1.5, "balls");
    product_free(&product);
}

int main(void)
{
    struct CMUnitTest tests[2 * SOLIDS + 4];
    static char       names[2 * SOLIDS][64];
    size_t            count = 0;
    for (size_t i = 0; i < SOLIDS; i++) {
        void *state = (void *)(uintptr_t)&solids[i];
        snprintf(names[count], sizeof names[0], "%s is safe", solids[i].name);
        tests[count] = (struct CMUnitTest){names[count], is_safe, NULL, NULL, state};
        count++;
        snprintf(names[count], sizeof names[0], "%s is of use", solids[i].name);
        tests[count] = (struct CMUnitTest){names[count], is_of_use, NULL, NULL, state};
        count++;
    }
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(rays_end_at_roots);
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(sheets_are_thin);
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(random_polynomials_are_safe);
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(a_long_formula_is_safe);
    return _cmocka_run_group_tests("fields", tests, count, NULL, NULL);
}
