/*
 * bumps.c: a surface with bumps has the normals that it would have if it were as high as they say.
 *
 * A wave on a plane has its normals in closed form, also where the plane is turned, enlarged, or the
 * mirror image of another.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "runtime/tracer/query.h"
#include "tests/oracle/product.h"
#include "tests/support/random.h"
#include "tests/support/renderer.h"

enum { POINTS = 300 };

/* A slab whose upper side is at y = 0, of which the wave is along x. */
#define WAVY                                                             \
    "material wavy { color: gray, bump: 0.1 * sin(3 * x) + 0.05 * z }\n" \
    "let slab = box([20, 2, 20]).move([0, -1, 0]).paint(wavy);\n"

/* Returns the normal of the slab in its own space, up to its length. */
static Vec wavy(Vec at) { return vec_unit(vec(-0.3 * cos(3 * at.x), 1, -0.05)); }

static Vec turned(Vec a, double angle)
{
    double c = cos(angle), s = sin(angle);
    return vec(c * a.x - s * a.y, s * a.x + c * a.y, a.z);
}

static Vec plain(Vec at) { return wavy(at); }
static Vec enlarged(Vec at) { return wavy(vec_scale(1 / 2.5, at)); }
static Vec rotated(Vec at) { return turned(wavy(turned(at, -0.7)), 0.7); }
static Vec reflected(Vec at)
{
    Vec normal = wavy(vec(fabs(at.x) + 1, at.y, at.z));
    return at.x < 0 ? vec(-normal.x, normal.y, normal.z) : normal;
}

typedef struct Placed {
    const char *text;
    Vec (*normal)(Vec at);
    double turn; /* of the surface about z */
} Placed;

static const Placed places[] = {
    {WAVY "show slab;\n", plain, 0},
    {WAVY "show slab.scale(2.5);\n", enlarged, 0},
    {WAVY "show slab.rotate([0, 0, 1], 0.7);\n", rotated, 0.7},
    {WAVY "show krs { kernel slab.move([-1, 0, 0]); reflect plane([-1, 0, 0], 0); };\n", reflected,
     0},
    /* the first of so many that they are an instance group */
    {WAVY "show union([slab.move([0, -50 * i, 0]) for i in 0..80]).rotate([0, 0, 1], 0.7);\n",
     rotated, 0.7},
    {WAVY "show union([slab, sphere(0.5).move([0, 30, 0])], blend: 0.1);\n", plain, 0},
};
enum { PLACES = sizeof places / sizeof *places };

static Vec place_on(const Placed *placed, Random *random)
{
    Vec at = vec(random_between(random, -3, 3), 0, random_between(random, -3, 3));
    if (fabs(at.x) < 0.05)
        at.x = 0.05; /* mirrors are edges */
    return turned(at, placed->turn);
}

static double apart(const double a[3], Vec b)
{
    return vec_length(vec_sub(vec(a[0], a[1], a[2]), b));
}

static void on_host(const Placed *placed, const Product *product)
{
    Random random = {3};
    for (int i = 0; i < POINTS; i++) {
        Vec    at     = place_on(placed, &random);
        Vec    wanted = placed->normal(at), even = turned(vec(0, 1, 0), placed->turn);
        KrsHit hit = product_probe(product, at);
        assert_true(apart(hit.normal, even) < 1e-6);
        if (apart(hit.shading, wanted) > 1e-4)
            fail_msg("%s at %g: %g %g %g, not %g %g %g", placed->text, at.x, hit.shading[0],
                     hit.shading[1], hit.shading[2], wanted.x, wanted.y, wanted.z);
    }
}

static void on_device(const Placed *placed, const Product *product)
{
    static float        points[POINTS][3];
    static SurfacePoint found[POINTS];
    KrsRendering       *rendering;
    Random              random = {4};
    for (int i = 0; i < POINTS; i++) {
        Vec at       = place_on(placed, &random);
        points[i][0] = (float)at.x, points[i][1] = (float)at.y, points[i][2] = (float)at.z;
    }
    assert_int_equal(krs_rendering_new(renderer, product->scene, KRS_FOR_PICTURES, &rendering),
                     KRS_OK);
    assert_int_equal(point_query_sample(rendering, product->state, (const float(*)[3])points,
                                        POINTS, NULL, found),
                     KRS_OK);
    for (int i = 0; i < POINTS; i++) {
        const double normal[3] = {(double)found[i].normal[0], (double)found[i].normal[1],
                                  (double)found[i].normal[2]};
        Vec          at = vec((double)points[i][0], (double)points[i][1], (double)points[i][2]);
        assert_true(apart(normal, placed->normal(at)) < 5e-3);
    }
    krs_rendering_free(rendering);
}

static void normals_are_those_of_a_wave(void **state)
{
    (void)state;
    for (int i = 0; i < PLACES; i++) {
        Product product = product_compile(places[i].text);
        on_host(&places[i], &product);
        on_device(&places[i], &product);
        product_free(&product);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(normals_are_those_of_a_wave)};
    return cmocka_run_group_tests_name("bumps", tests, renderer_open, renderer_close);
}
