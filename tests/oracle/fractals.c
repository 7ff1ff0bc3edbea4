/*
 * fractals.c: fractals against what they are defined by.
 *
 * Which points belong to a fractal is found by iterating, with Hamilton's product and with sines
 * and cosines, on a grid of voxels around it; nothing is shared with the compiler.  Any point
 * inside refutes a distance that is longer than the way there, so the nearest inside voxel does,
 * and points still nearer that are looked for around it; for points inside, likewise what is
 * outside.
 *
 * Proven bounds are never above the truth.  Estimates are measured, and reported.
 */
#include "tests/oracle/product.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- membership, by iterating ---- */

typedef struct Fractal {
    bool   bulb;
    int    power, iterations;
    double c[4];
    double radius; /* out of which no orbit comes back */
} Fractal;

typedef struct Quaternion {
    double w, x, y, z;
} Quaternion;

static Quaternion hamilton(Quaternion a, Quaternion b)
{
    return (Quaternion){a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
                        a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                        a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
                        a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

/* R^p - R grows beyond its only minimum: halving finds where it is |c|. */
static double escape_radius(const double c[4], int power)
{
    double size = sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2] + c[3] * c[3]);
    double low = pow(power, -1.0 / (power - 1)), high = 2 + size;
    for (int i = 0; i < 200; i++) {
        double middle = (low + high) / 2;
        if (pow(middle, power) - middle < size)
            low = middle;
        else
            high = middle;
    }
    return high;
}

static bool in_julia(const Fractal *f, Vec p, double *trap)
{
    Quaternion z = {p.x, p.y, p.z, 0};
    *trap        = 1;
    for (int n = 0; n <= f->iterations; n++) {
        double size = sqrt(z.w * z.w + z.x * z.x + z.y * z.y + z.z * z.z);
        if (n > 0)
            *trap = fmin(*trap, size);
        if (size > f->radius)
            return false;
        Quaternion power = z;
        for (int i = 1; i < f->power; i++)
            power = hamilton(power, z);
        z = (Quaternion){power.w + f->c[0], power.x + f->c[1], power.y + f->c[2],
                         power.z + f->c[3]};
    }
    return true;
}

static bool in_bulb(const Fractal *f, Vec c, double *trap)
{
    Vec w = c;
    *trap = 1;
    for (int n = 0; n <= f->iterations; n++) {
        double size = vec_length(w);
        if (n > 0)
            *trap = fmin(*trap, size);
        if (size > f->radius)
            return false;
        double tilt = size > 0 ? f->power * acos(w.y / size) : 0, turn = f->power * atan2(w.x, w.z);
        double r = pow(size, f->power);
        w = vec_add(c, vec(r * sin(tilt) * sin(turn), r * cos(tilt), r * sin(tilt) * cos(turn)));
    }
    return true;
}

static bool inside(const Fractal *f, Vec p)
{
    double trap;
    return f->bulb ? in_bulb(f, p, &trap) : in_julia(f, p, &trap);
}

/* ---- the way to the other side ---- */

/* The middles of voxels next to one of the other side, of both sides. */
typedef struct Voxels {
    Vec   *solid, *empty;
    size_t solid_count, empty_count;
    double side;
} Voxels;

enum { CELLS = 72 };

static Vec voxel_middle(double reach, int i, int j, int k)
{
    double side = 2 * reach / CELLS;
    return vec((i + 0.5) * side - reach, (j + 0.5) * side - reach, (k + 0.5) * side - reach);
}

static size_t voxel_index(int i, int j, int k) { return ((size_t)i * CELLS + j) * CELLS + k; }

static bool at_border(const bool *is_solid, int i, int j, int k)
{
    bool own = is_solid[voxel_index(i, j, k)];
    for (int side = -1; side <= 1; side += 2)
        if ((i + side >= 0 && i + side < CELLS && is_solid[voxel_index(i + side, j, k)] != own) ||
            (j + side >= 0 && j + side < CELLS && is_solid[voxel_index(i, j + side, k)] != own) ||
            (k + side >= 0 && k + side < CELLS && is_solid[voxel_index(i, j, k + side)] != own))
            return true;
    return false;
}

static Voxels voxels_new(const Fractal *f)
{
    enum { ALL = CELLS * CELLS * CELLS };
    double reach    = 1.05 * f->radius;
    bool  *is_solid = malloc(ALL * sizeof *is_solid);
    Voxels v = {malloc(ALL * sizeof(Vec)), malloc(ALL * sizeof(Vec)), 0, 0, 2 * reach / CELLS};
    for (int i = 0; i < CELLS; i++)
        for (int j = 0; j < CELLS; j++)
            for (int k = 0; k < CELLS; k++)
                is_solid[voxel_index(i, j, k)] = inside(f, voxel_middle(reach, i, j, k));
    for (int i = 0; i < CELLS; i++)
        for (int j = 0; j < CELLS; j++)
            for (int k = 0; k < CELLS; k++) {
                if (!at_border(is_solid, i, j, k))
                    continue;
                if (is_solid[voxel_index(i, j, k)])
                    v.solid[v.solid_count++] = voxel_middle(reach, i, j, k);
                else
                    v.empty[v.empty_count++] = voxel_middle(reach, i, j, k);
            }
    free(is_solid);
    return v;
}

static void voxels_free(Voxels *v)
{
    free(v->solid);
    free(v->empty);
}

/* Returns the length of the shortest way found from p to a point of the other side. */
static double distance_to_other_side(const Fractal *f, const Voxels *v, Random *random, Vec p)
{
    bool       own   = inside(f, p);
    const Vec *all   = own ? v->empty : v->solid;
    size_t     count = own ? v->empty_count : v->solid_count;
    Vec        best  = vec(1e9, 0, 0);
    for (size_t i = 0; i < count; i++)
        if (vec_distance(p, all[i]) < vec_distance(p, best))
            best = all[i];
    for (int i = 0; i < 60 && count > 0; i++) {
        double reach = v->side * pow(0.93, i);
        double part  = random_between(random, 0, 1);
        Vec    near  = vec_add(best, vec_scale(part * reach, random_unit(random)));
        if (i % 2 == 0) /* straight home */
            near = vec_mix(best, p, part * fmin(reach / vec_distance(best, p), 1));
        if (inside(f, near) != own && vec_distance(p, near) < vec_distance(p, best))
            best = near;
    }
    return vec_distance(p, best);
}

/* ---- distances ---- */

typedef struct Measure {
    double most, max_inside; /* of the distance over the way to the other side */
    double mean;             /* outside */
    size_t wrong_sides, count;
} Measure;

static Measure measure(const Product *product, const Fractal *f, int points)
{
    Random  random  = {.state = 7};
    Voxels  v       = voxels_new(f);
    Measure m       = {0};
    size_t  outside = 0;
    for (int i = 0; i < points; i++) {
        Vec p = random_in_cube(&random, 1.3 * f->radius);
        if (i % 3 == 0 && v.solid_count > 0) {
            Vec    border   = v.solid[random_below(&random, (int)v.solid_count)];
            double distance = random_between(&random, 0, 3 * v.side);
            p               = vec_add(border, vec_scale(distance, random_unit(&random)));
        }
        double distance = distance_to_other_side(f, &v, &random, p),
               d        = product_distance(product, p);
        bool own        = inside(f, p);
        m.wrong_sides += (d <= 0) != own && fabs(d) > 1e-12;
        m.count++;
        if (own)
            m.max_inside = fmax(m.max_inside, -d / distance);
        else {
            m.most = fmax(m.most, d / distance);
            m.mean += d / distance;
            outside++;
        }
    }
    m.mean /= (double)outside;
    voxels_free(&v);
    return m;
}

typedef struct Set {
    const char *name;
    double      c[4];
    int         power, iterations;
} Set;

static const Set julia_sets[] = {
    {"connected", {-0.2, 0.6, 0.2, 0.2}, 2, 10},
    {"basilica", {-1, 0.2, 0, 0}, 2, 12},
    {"curled", {-0.125, -0.256, 0.847, 0.0895}, 2, 9},
    {"dust", {0.45, 0.55, 0.3, 0}, 2, 6},
    {"ball", {0, 0, 0, 0}, 2, 12},
    {"cubic", {-0.2, 0.4, -0.4, -0.4}, 3, 6},
    {"cubic of the page", {-0.2, 0.6, 0.2, 0.1}, 3, 8},
    {"torn", {0.6, 0.6, 0.4, 0.2}, 3, 4},
    {"quartic", {0.3, 0.6, 0.1, 0.2}, 4, 5},
    {"eighth", {0.4, 0.3, 0.5, 0.1}, 8, 3},
    {"one step", {-0.5, 0.3, 0.2, 0}, 2, 1},
};

static Fractal julia_of(const Set *set, char *text, size_t size)
{
    Fractal f = {.power = set->power, .iterations = set->iterations};
    memcpy(f.c, set->c, sizeof f.c);
    f.radius = escape_radius(f.c, f.power);
    snprintf(text, size, "show julia(c: [%g, %g, %g, %g], power: %d, iterations: %d);", f.c[0],
             f.c[1], f.c[2], f.c[3], f.power, f.iterations);
    return f;
}

static void julia_bounds_hold(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof julia_sets / sizeof *julia_sets; i++) {
        char    text[200];
        Fractal f       = julia_of(&julia_sets[i], text, sizeof text);
        Product product = product_compile(text);
        Measure m       = measure(&product, &f, 1500);
        print_message("# %-18s z^%d: at most %.3f of the way, %.3f inside; mean %.2f\n",
                      julia_sets[i].name, f.power, m.most, m.max_inside, m.mean);
        assert_true(m.most <= 1);
        assert_true(m.max_inside <= 1);
        assert_true(m.wrong_sides == 0);
        assert_true(m.mean > 0.3); /* else it would be of no use */
        product_free(&product);
    }
}

/* The comparison can fail: a solid that is 2 % larger, or 10 % smaller, is found. */
static void a_fault_is_found(void **state)
{
    (void)state;
    char    text[200];
    Fractal f       = julia_of(&julia_sets[4], text, sizeof text);
    Product product = product_compile("show julia(c: [0, 0, 0, 0], iterations: 12).scale(1.02);");
    Measure m       = measure(&product, &f, 500);
    assert_true(m.max_inside > 1);
    product_free(&product);
    product = product_compile("show julia(c: [0, 0, 0, 0], iterations: 12).scale(0.9);");
    m       = measure(&product, &f, 500);
    assert_true(m.most > 1);
    product_free(&product);
}

/* Blends and offsets need a distance that rises no faster than 1. */
static void julia_bounds_are_not_steep(void **state)
{
    (void)state;
    Random random = {.state = 99};
    for (size_t i = 0; i < sizeof julia_sets / sizeof *julia_sets; i++) {
        char    text[200];
        double  steepest = 0;
        Fractal f        = julia_of(&julia_sets[i], text, sizeof text);
        Product product  = product_compile(text);
        for (int k = 0; k < 20000; k++) {
            double size = pow(10, random_between(&random, -6, 0));
            Vec    a    = random_in_cube(&random, 1.2 * f.radius);
            Vec    b    = vec_add(a, vec_scale(size, random_unit(&random)));
            double rise = fabs(product_distance(&product, a) - product_distance(&product, b));
            steepest    = fmax(steepest, rise / (vec_distance(a, b) + 1e-9));
        }
        assert_true(steepest <= 1);
        assert_true(steepest > 0.8);
        product_free(&product);
    }
}

static void mandelbulbs_are_measured(void **state)
{
    (void)state;
    static const int powers[][2] = {{8, 4}, {8, 8}, {3, 6}, {2, 10}, {5, 5}};
    for (size_t i = 0; i < sizeof powers / sizeof *powers; i++) {
        char    text[200];
        Fractal f = {.bulb = true, .power = powers[i][0], .iterations = powers[i][1]};
        f.radius  = pow(2, 1.0 / (f.power - 1));
        snprintf(text, sizeof text, "show mandelbulb(power: %d, iterations: %d);", f.power,
                 f.iterations);
        Product product = product_compile(text);
        Measure m       = measure(&product, &f, 1500);
        print_message("# mandelbulb of %d: at most %.3f of the way, %.3f inside; mean %.2f\n",
                      f.power, m.most, m.max_inside, m.mean);
        assert_true(m.most <= 1);
        assert_true(m.max_inside <= 1);
        assert_true(m.wrong_sides == 0);
        assert_true(m.mean > 0.25);
        product_free(&product);
    }
}

/* Far away the whole set is a ball, and nothing overflows. */
static void far_away_is_far(void **state)
{
    (void)state;
    static const char *const scenes[] = {"show julia(c: [-0.2, 0.6, 0.2, 0.1], power: 8);",
                                         "show mandelbulb(power: 8);",
                                         "show mandelbulb(power: 16);"};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        Product product = product_compile(scenes[i]);
        for (double far = 10; far < 1e15; far *= 10) {
            double d = product_distance(&product, vec(0.6 * far, 0, 0.8 * far));
            assert_true(d <= far && d > far - 2);
        }
        assert_true(product_distance(&product, vec(0, 0, 0)) <= 0 || i == 0);
        product_free(&product);
    }
}

/* ---- what states may change ---- */

static void set_parameter(Product *product, const char *name, const double *values, size_t count)
{
    assert_int_equal(krs_state_set(product->state, name, values, count), KRS_OK);
}

/* Iterations and c of frame time give the same solid as constants. */
static void states_may_change_them(void **state)
{
    (void)state;
    Random  random = {.state = 5};
    Product moving = product_compile("param n = 4 in [2, 9]; param a = 0.1 in [-0.5, 0.5];"
                                     "show julia(c: [a, 0.6, 0.2, a], power: 3, iterations: n);"
                                     "show mandelbulb(iterations: n).move([4, 0, 0]);");
    for (int n = 2; n <= 9; n++) {
        char   text[300];
        double a = 0.1 * n - 0.5, number = fmin(n + 0.4, 9);
        snprintf(text, sizeof text,
                 "show julia(c: [%.17g, 0.6, 0.2, %.17g], power: 3, iterations: %d);"
                 "show mandelbulb(iterations: %d).move([4, 0, 0]);",
                 a, a, n, n);
        Product still = product_compile(text);
        set_parameter(&moving, "n", &number, 1);
        set_parameter(&moving, "a", &a, 1);
        for (int i = 0; i < 300; i++) {
            Vec p = vec_add(random_in_cube(&random, 1.4), vec(i % 2 ? 4 : 0, 0, 0));
            assert_true(fabs(product_distance(&moving, p) - product_distance(&still, p)) < 1e-6);
        }
        product_free(&still);
    }
    product_free(&moving);
}

/* ---- colours ---- */

static double channel(unsigned rgb, int shift)
{
    double value = (rgb >> shift & 255) / 255.0;
    return value <= 0.04045 ? value / 12.92 : pow((value + 0.055) / 1.055, 2.4);
}

static void color_at(const Product *product, Vec p, double color[3])
{
    double point[1][3] = {{p.x, p.y, p.z}};
    KrsHit hit;
    assert_int_equal(krs_probe(product->state, (const double(*)[3])point, 1, &hit), KRS_OK);
    memcpy(color, hit.color, sizeof hit.color);
}

/* Between two colours of a palette light is mixed, beyond its ends it stays. */
static void palettes_mix(void **state)
{
    (void)state;
    static const unsigned ember[] = {0x1c0b12, 0x5e1421, 0xb3321d, 0xe8742a, 0xf9b95a, 0xfff1c9};
    Product               product = product_compile(
                      "show sphere(9).paint(#123456).color_by(x, palette: \"ember\");"
                                    "show sphere(9).move([0, 40, 0]).color_by(x);"
                                    "show sphere(9).move([0, 80, 0])"
                                    ".color_by(x, palette: [#1c0b12, #fff1c9]);");
    for (double x = -0.5; x <= 1.5; x += 0.01) {
        double t = fmin(fmax(x, 0), 1) * 5, color[3];
        int    i = (int)fmin(floor(t), 4);
        for (int which = 0; which < 3; which++) {
            color_at(&product, vec(x, 40 * which, 0), color);
            for (int k = 0; k < 3; k++) {
                int    shift = 16 - 8 * k;
                double low   = channel(ember[which < 2 ? i : 0], shift);
                double high  = channel(ember[which < 2 ? i + 1 : 5], shift);
                double part  = which < 2 ? t - i : t / 5;
                assert_true(fabs(color[k] - (low + part * (high - low))) < 1e-9);
            }
        }
    }
    product_free(&product);
}

/* The trap is the least size of the iterates after the first, also under maps and in CSG nodes. */
static void traps_are_traps(void **state)
{
    (void)state;
    Random  random = {.state = 3};
    char    text[200];
    Fractal julia   = julia_of(&julia_sets[6], text, sizeof text);
    Fractal bulb    = {.bulb = true, .power = 8, .iterations = 5, .radius = pow(2, 1.0 / 7)};
    Product product = product_compile(
        "let a = julia(c: [-0.2, 0.6, 0.2, 0.1], power: 3, iterations: 8) - sphere(0.3);"
        "show a.scale(2).move([8, 0, 0]).color_by(orbit_trap, palette: \"gray\");"
        "show mandelbulb(power: 8, iterations: 5)"
        ".color_by(orbit_trap, palette: [#000000, #ffffff]);");
    for (int i = 0; i < 2000; i++) {
        Vec    p = random_in_cube(&random, 0.9);
        double color[3], trap;
        if (in_bulb(&bulb, p, &trap)) {
            color_at(&product, p, color);
            assert_true(fabs(color[0] - trap) < 1e-9);
        }
        if (in_julia(&julia, p, &trap) && vec_length(p) > 0.3) {
            color_at(&product, vec_add(vec_scale(2, p), vec(8, 0, 0)), color);
            double step = fmin(floor(5 * trap), 4), part = 5 * trap - step;
            double low  = channel((unsigned)(51 * step + (step > 0 && step < 3)), 0);
            double high = channel((unsigned)(51 * (step + 1) + (step < 2)), 0);
            assert_true(fabs(color[0] - (low + part * (high - low))) < 1e-9);
        }
    }
    product_free(&product);
}

/* ---- cuts ---- */

static void fractals_can_be_cut(void **state)
{
    (void)state;
    Random  random = {.state = 23};
    char    text[200];
    Fractal f    = julia_of(&julia_sets[6], text, sizeof text);
    Product cut  = product_compile("show julia(c: [-0.2, 0.6, 0.2, 0.1], power: 3, iterations: 8)"
                                    "     - half_space([0, 1, 0], 0.1);");
    Product man  = product_compile("show (sphere(1) - wedge(60deg)).move([-3, 0, 0]);");
    Product mold = product_compile("show box([3, 3, 3]) - mandelbulb(iterations: 4);");
    Fractal bulb = {.bulb = true, .power = 8, .iterations = 4, .radius = pow(2, 1.0 / 7)};
    for (int i = 0; i < 20000; i++) {
        Vec  p      = random_in_cube(&random, 1.4);
        bool in_cut = inside(&f, p) && p.y > 0.1;
        bool in_man = vec_length(p) < 1 && fabs(atan2(p.x, p.z)) > acos(-1) / 6;
        assert_true((product_distance(&cut, p) <= 0) == in_cut || fabs(p.y - 0.1) < 1e-9);
        assert_true((product_distance(&man, vec_add(p, vec(-3, 0, 0))) <= 0) == in_man);
        assert_true((product_distance(&mold, p) <= 0) == !inside(&bulb, p));
    }
    product_free(&cut);
    product_free(&man);
    product_free(&mold);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(julia_bounds_hold),
        cmocka_unit_test(a_fault_is_found),
        cmocka_unit_test(julia_bounds_are_not_steep),
        cmocka_unit_test(mandelbulbs_are_measured),
        cmocka_unit_test(far_away_is_far),
        cmocka_unit_test(states_may_change_them),
        cmocka_unit_test(palettes_mix),
        cmocka_unit_test(traps_are_traps),
        cmocka_unit_test(fractals_can_be_cut),
    };
    return cmocka_run_group_tests_name("fractals", tests, NULL, NULL);
}
