/*
 * far.c: polynomials that rays come to from far away, on the host and on the device.
 *
 * Rays start up to 100,000 units away, aimed at the surface or past it, and the root of each is
 * found here in long double precision, in the ball that the surface is known to be in: an answer
 * must be that root, whoever gives it, and none is unresolved.  And pictures of such surfaces over
 * an endless floor must show the floor, level and lit, up to the horizon: red light casts shadows, green
 * light does not, and far from the surface there is as much of both.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/oracle/exact.h"
#include "tests/oracle/formulas.h"
#include "tests/oracle/product.h"
#include "tests/support/renderer.h"

static Real power(Real a, int n) { return n ? a * power(a, n - 1) : 1; }

static Real ball(const Real p[3]) { return p[0] * p[0] + p[1] * p[1] + p[2] * p[2] - 1; }
static Real double_torus(const Real p[3])
{
    Real x = p[0] * p[0], curve = x * (1 - x) - p[1] * p[1];
    return curve * curve + p[2] * p[2] - 0.01L;
}
static Real cube_8(const Real p[3]) { return power(p[0], 8) + power(p[1], 8) + power(p[2], 8) - 1; }
static Real cube_12(const Real p[3])
{
    return power(p[0], 12) + power(p[1], 12) + power(p[2], 12) - 1;
}
static Real heart(const Real p[3])
{
    Real x = p[0] * p[0], z = p[2] * p[2], y = power(p[1], 3);
    return power(x + 2.25L * z + p[1] * p[1] - 1, 3) - x * y - 0.1125L * z * y;
}
static Real quartic(const Real p[3])
{
    return power(p[0], 4) + power(p[1], 4) + power(p[2], 4) - ball(p) - 0.6L;
}
static Real saddle(const Real p[3]) { return power(p[0], 3) - 3 * p[0] * p[2] * p[2] - p[1]; }
static Real sextic(const Real p[3])
{
    Real g = (3 + sqrtl(5)) / 2, x = p[0] * p[0], y = p[1] * p[1], z = p[2] * p[2];
    return (2 + sqrtl(5)) * power(x + y + z - 1, 2) - 4 * (g * x - y) * (g * y - z) * (g * z - x);
}

/* The solid within the ball of this radius, which is part of the text unless all of it is there. */
static const struct Form {
    const char *name, *text;
    Formula    *formula;
    double      radius;
} forms[] = {
    {"a ball", "algebraic(x^2 + y^2 + z^2 == 1)", ball, 1.5},
    {"a double torus", "algebraic((x^2 * (1 - x^2) - y^2)^2 + z^2 == 0.01)", double_torus, 1.5},
    {"8th powers", "algebraic(x^8 + y^8 + z^8 == 1)", cube_8, 2},
    {"12th powers", "algebraic(x^12 + y^12 + z^12 == 1)", cube_12, 2},
    {"a heart", "algebraic((x^2 + 9/4 * z^2 + y^2 - 1)^3 == x^2 * y^3 + 9/80 * z^2 * y^3)", heart,
     2},
    {"a quartic", "algebraic(x^4 + y^4 + z^4 == x^2 + y^2 + z^2 - 1 + 0.6)", quartic, 2},
    {"a cut saddle", "algebraic(x^3 - 3 * x * z^2 == y).within(sphere(1.5))", saddle, 1.5},
    {"a cut sextic",
     "algebraic((2 + sqrt(5)) * (x^2 + y^2 + z^2 - 1)^2 == 4 * (g^2 * x^2 - y^2)"
     " * (g^2 * y^2 - z^2) * (g^2 * z^2 - x^2)).within(sphere(1.5))",
     sextic, 1.5},
};
enum { FORMS = sizeof forms / sizeof forms[0] };

/* One without a box around it, from which no box tells how far it is; all around the vertical. */
static const struct Form column = {"a column of 12th powers", "algebraic(x^12 + z^12 == 1)", NULL,
                                   2};

static const char golden[] = "let g = (1 + sqrt(5)) / 2;\n";

/* ---- rays ---- */

enum { RAYS = 400 };

static double origins[RAYS][3], directions[RAYS][3];
static Entry  entries[RAYS];
#define FROM       ((const double(*)[3])origins)
#define DIRECTIONS ((const double(*)[3])directions)

/* From 3 to 100,000 units away, to somewhere near the surface; or past it. */
static void draw_rays(const struct Form *form, Random *random)
{
    for (int i = 0; i < RAYS; i++) {
        double distance  = 3 * form->radius * pow(10, 4.5 * random_between(random, 0, 1));
        Vec    from      = vec_scale(distance, random_unit(random));
        Vec    to        = random_in_cube(random, i % 4 ? 0.6 * form->radius : 2 * form->radius);
        Vec    direction = vec_unit(vec_sub(to, from));
        entries[i]       = surface_entry(form->formula, form->radius, from, direction);
        for (int k = 0; k < 3; k++) {
            origins[i][k]    = (&from.x)[k];
            directions[i][k] = (&direction.x)[k];
        }
    }
}

/* Rays whose answer is wrong; the tolerance is 1e-3. */
static int count_wrong(const struct Form *form, const KrsHit *hits, const char *who)
{
    int wrong = 0;
    for (int i = 0; i < RAYS; i++) {
        const Entry *entry = &entries[i];
        if (entry->fate == RAY_DOUBTFUL)
            continue;
        bool   is    = entry->fate == RAY_HITS;
        Vec    p     = vec(hits[i].point[0], hits[i].point[1], hits[i].point[2]);
        Vec    v     = vec(directions[i][0], directions[i][1], directions[i][2]);
        double steep = 1;
        if (is && !entry->on_ball) {
            Vec slope = surface_slope(form->formula, p);
            steep     = fabs(vec_dot(slope, v)) / fmax(vec_length(slope), 1e-9);
        }
        if (steep < 0.05)
            continue; /* it grazes: a hair decides */
        bool right = hits[i].hit == is && !hits[i].unresolved &&
                     (!is || fabs(hits[i].t - (double)entry->t) <= 3e-3 / steep);
        wrong += !right;
        if (!right && wrong <= 3)
            print_message("# %s, %s: ray %d from %g units away ends at %.9g (%s), not at %.9Lg "
                          "(%d)\n",
                          form->name, who, i,
                          hypot(hypot(origins[i][0], origins[i][1]), origins[i][2]), hits[i].t,
                          hits[i].unresolved ? "unresolved"
                          : hits[i].hit      ? "hit"
                                             : "miss",
                          entry->t, entry->fate);
    }
    return wrong;
}

static void rays_end_at_roots(void **state)
{
    const struct Form *form    = *state;
    Random             random  = {11};
    Product            product = product_format("%sshow %s;", golden, form->text);
    KrsRendering      *rendering;
    static KrsHit      hits[RAYS];
    draw_rays(form, &random);
    assert_int_equal(krs_raycast(product.state, FROM, DIRECTIONS, RAYS, 1e6, 1e-3, hits), KRS_OK);
    assert_int_equal(count_wrong(form, hits, "the host"), 0);
    assert_int_equal(krs_rendering_new(renderer, product.scene, KRS_FOR_QUESTIONS, &rendering),
                     KRS_OK);
    assert_int_equal(
        krs_device_raycast(rendering, product.state, FROM, DIRECTIONS, RAYS, 1e6, 1e-3, hits),
        KRS_OK);
    assert_int_equal(count_wrong(form, hits, "the device"), 0);
    krs_rendering_free(rendering);
    product_free(&product);
}

/* ---- pictures ---- */

enum { WIDTH = 160, HEIGHT = 90 };

/* The pixel's row is below the horizon of a level eye; -1: near it. */
static int sees_floor(const Lens *lens, int k)
{
    Line   ray   = lens_ray(lens, k % WIDTH + 0.5, k / WIDTH + 0.5);
    double pixel = lens_pixel(lens, 1);
    return fabs(ray.direction.y) < pixel ? -1 : ray.direction.y < 0;
}

/* The ray passes the surface; of a column, as seen from above. */
static bool passes(const struct Form *form, Line ray)
{
    if (form == &column) {
        ray.origin.y    = 1;
        ray.direction.y = 0;
        ray.direction   = vec_unit(ray.direction);
    }
    return chord_is_empty(chord_of_ball(ray, vec(0, 1, 0), 1.02 * form->radius));
}

static void floors_are_plain(void **state)
{
    const struct Form *form = *state;
    const Vec          eye = {1, 3.6, 9}, target = {0.4, 1.1, -0.5};
    const double       fov     = 36 * 0.017453292519943295;
    Lens               lens    = lens_make(eye, target, tan(0.5 * fov), false, WIDTH, HEIGHT);
    Product            product = product_format(
                   "%slight red { direction: [-1.1, 1.6, 1.2], color: [1, 0, 0] }\n"
                              "light green { direction: [-1.1, 1.6, 1.2], color: [0, 1, 0], shadow: false }\n"
                              "sky { zenith: #000000, horizon: #000000, ground: #000000 }\n"
                              "image { tone_map: \"none\" }\nmaterial white { color: [1, 1, 1], roughness: 1 }\n"
                              "show plane([0, 1, 0], 0).paint(white);\nshow %s.scale(0.5).move([0, 1, 0]);\n"
                              "camera { eye: [1, 3.6, 9], target: [0.4, 1.1, -0.5], fov: 36deg }",
                   golden, form->text);
    KrsRenderOptions options = {.width = WIDTH, .height = HEIGHT, .samples = 1};
    KrsRendering    *rendering;
    KrsPicture      *picture = NULL;
    int              floors = 0, strange = 0, dark = 0, tilted = 0, shaded = 0;
    if (krs_rendering_new(renderer, product.scene, KRS_FOR_PICTURES, &rendering) != KRS_OK ||
        krs_render(rendering, product.state, &options, &picture) != KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
    for (int k = 0; k < WIDTH * HEIGHT; k++) {
        Line         ray   = lens_ray(&lens, k % WIDTH + 0.5, k / WIDTH + 0.5);
        int          below = sees_floor(&lens, k);
        double       t     = below == 1 ? -eye.y / ray.direction.y : 1e9;
        const float *color = &picture->color[4 * k];
        shaded += picture->component[k] == 1 && color[0] < 0.5F * color[1];
        if (below < 0 || t < 25)
            continue;
        bool clear = passes(form, ray);
        floors += below && clear;
        strange += clear && (picture->component[k] == 1) != below;
        tilted += below && clear && !(picture->normal[3 * k + 1] > 0.9999F);
        dark += form != &column && below && clear && picture->component[k] == 1 &&
                !(color[0] > 0.99F * color[1]);
    }
    if (floors < 500 || strange > 0 || tilted > 0 || dark > 0 || shaded < 10)
        fail_msg("%s: of %d pixels of the floor far away %d show something else, %d are not level, "
                 "%d are in shadow; %d near the surface",
                 form->name, floors, strange, tilted, dark, shaded);
    assert_int_equal(picture->stats.unresolved, 0);
    krs_picture_free(picture);
    krs_rendering_free(rendering);
    product_free(&product);
}

int main(void)
{
    struct CMUnitTest tests[2 * FORMS + 1];
    static char       names[FORMS][80];
    size_t            count = 0;
    for (size_t i = 0; i < FORMS; i++) {
        void *form = (void *)(uintptr_t)&forms[i];
        snprintf(names[i], sizeof names[i], "%s over an endless floor", forms[i].name);
        tests[count++] = (struct CMUnitTest){forms[i].name, rays_end_at_roots, NULL, NULL, form};
        tests[count++] = (struct CMUnitTest){names[i], floors_are_plain, NULL, NULL, form};
    }
    tests[count++] = (struct CMUnitTest){column.name, floors_are_plain, NULL, NULL,
                                         (void *)(uintptr_t)&column};
    return _cmocka_run_group_tests("far", tests, count, renderer_open, renderer_close);
}
