/*
 * underestimates.c: hard shadows of solids whose distance is only a bound, held against roots.
 *
 * Red light casts shadows, green light does not, on white ground: red over green is 0 or 1, and
 * has to be what a search for roots along the ray to the light says, in double precision, of the
 * solid's formula, at every pixel of the ground, those at the shadow's edge as well.  A shadow that
 * ends where the distance is small, and not where the solid is, has its edge elsewhere.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/oracle/exact.h"
#include "tests/oracle/product.h"
#include "tests/support/renderer.h"

enum { WIDTH = 192, HEIGHT = 108, SAMPLES = 100 };

/* What is asked for: pixels that are wrong, of those at an edge. */
#define MAX_WRONG 0.01
#define LIFT      0.125 /* pixels: where a ray to a light starts, above even ground */
#define HIGH      4.5   /* of the picture */

/* ---- Formulas: negative inside ---- */

static double barth(Vec p)
{
    double g = (1 + sqrt(5)) / 2, s = vec_dot(p, p) - 1;
    double x = p.x * p.x, y = p.y * p.y, z = p.z * p.z;
    return 4 * (g * g * x - y) * (g * g * y - z) * (g * g * z - x) - (1 + 2 * g) * s * s;
}

static double ring(Vec p)
{
    double s = vec_dot(p, p) + 0.64 - 0.04;
    return s * s - 4 * 0.64 * (p.x * p.x + p.z * p.z);
}

static double long_ball(Vec p) { return p.z * p.z / 2.25 + (p.x * p.x + p.y * p.y) / 0.0225 - 1; }

static const struct Form {
    const char *name, *text;
    double (*formula)(Vec p);
    double radius; /* of the ball that it is in, or cut by */
} forms[] = {
    {"Barth's sextic",
     "algebraic(4 * (g^2 * x^2 - y^2) * (g^2 * y^2 - z^2) * (g^2 * z^2 - x^2) =="
     " (1 + 2 * g) * (x^2 + y^2 + z^2 - 1)^2).within(sphere(1.5))",
     barth, 1.5},
    {"a ring", "field((x^2 + y^2 + z^2 + 0.6)^2 - 2.56 * (x^2 + z^2)).within(sphere(1.2))", ring,
     1.2},
    {"a long ball", "sphere(0.15).scale([1, 1, 10])", long_ball, 1.6},
};
enum { FORMS = sizeof forms / sizeof forms[0] };

static const Vec centre = {0, 2.4, 0}, target = {0.7, 0, -0.5};
static const Vec light = {-0.35, 1, 0.25};

/* ---- Truth ---- */

/* Returns the least of the formula between two places of a line, where it has one low point there. */
static double min_between(const struct Form *form, Line line, double a, double b)
{
    const double golden = 0.6180339887498949;
    for (int i = 0; i < 40; i++) {
        double low = b - golden * (b - a), high = a + golden * (b - a);
        if (form->formula(line_at(line, low)) < form->formula(line_at(line, high)))
            b = high;
        else
            a = low;
    }
    return form->formula(line_at(line, 0.5 * (a + b)));
}

/* Tells whether a line from a point towards the light meets the form. */
static bool is_hidden(const struct Form *form, Vec point)
{
    Line   line  = {vec_sub(point, centre), vec_unit(light)};
    Chord  chord = chord_of_ball(line, vec(0, 0, 0), form->radius);
    double values[SAMPLES + 1], step = (chord.leave - chord.enter) / SAMPLES;
    if (chord_is_empty(chord))
        return false;
    for (int i = 0; i <= SAMPLES; i++) {
        values[i] = form->formula(line_at(line, chord.enter + i * step));
        if (values[i] <= 0)
            return true;
    }
    for (int i = 1; i < SAMPLES; i++)
        if (values[i] <= values[i - 1] && values[i] <= values[i + 1] &&
            min_between(form, line, chord.enter + (i - 1) * step, chord.enter + (i + 1) * step) <=
                0)
            return true;
    return false;
}

/* ---- Pictures ---- */

static Lens camera(void)
{
    return lens_make(vec(target.x, 50, target.z + 50), target, HIGH / 2, true, WIDTH, HEIGHT);
}

/* Tells whether light reaches what pixel k sees; -1 where it is not the ground. */
static int seen_at(const KrsPicture *picture, int k)
{
    const float *color = picture->color + 4 * k;
    if (picture->component[k] != 1 || !(color[1] > 0))
        return -1;
    return color[0] > 0.5F * color[1];
}

/* Whether light reaches the ground in the middle of each pixel. */
static void find_truth(const struct Form *form, double lift, bool *lit)
{
    Lens lens = camera();
    for (int k = 0; k < WIDTH * HEIGHT; k++) {
        Line ray    = lens_ray(&lens, k % WIDTH + 0.5, k / WIDTH + 0.5);
        Vec  ground = line_at(ray, -ray.origin.y / ray.direction.y);
        ground.y    = lift * lens_pixel(&lens, 1);
        lit[k]      = !is_hidden(form, ground);
    }
}

static KrsPicture *take(const struct Form *form, double softness, KrsShadows shadows)
{
    Product product = product_format(
        "let g = (1 + sqrt(5)) / 2;\n"
        "light red { direction: [%g, %g, %g], softness: %g, color: [1, 0, 0] }\n"
        "light green { direction: [%g, %g, %g], color: [0, 1, 0], shadow: false }\n"
        "sky { zenith: #000000, horizon: #000000, ground: #000000 }\n"
        "image { tone_map: \"none\" }\n"
        "material white { color: [1, 1, 1], roughness: 1 }\n"
        "camera { eye: [%g, 50, %g], target: [%g, 0, %g], projection: \"orthographic\","
        " height: %g }\n"
        "show plane([0, 1, 0], 0).paint(white);\n"
        "show %s.move([%g, %g, %g]);\n",
        light.x, light.y, light.z, softness, light.x, light.y, light.z, target.x, target.z + 50,
        target.x, target.z, HIGH, form->text, centre.x, centre.y, centre.z);
    KrsRendering    *rendering;
    KrsPicture      *picture = NULL;
    KrsRenderOptions options = {.width = WIDTH, .height = HEIGHT, .shadows = shadows, .samples = 1};
    if (krs_rendering_new(renderer, product.scene, KRS_FOR_PICTURES, &rendering) != KRS_OK ||
        krs_render(rendering, product.state, &options, &picture) != KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
    assert_int_equal(picture->stats.unresolved, 0);
    krs_rendering_free(rendering);
    product_free(&product);
    return picture;
}

/* ---- Tests ---- */

typedef struct Match {
    int dark, lit, edge, wrong; /* pixels; at an edge: the one before is not alike */
} Match;

static Match match(const bool *truth, const KrsPicture *picture)
{
    Match found = {0};
    for (int k = 1; k < WIDTH * HEIGHT; k++) {
        int seen = seen_at(picture, k);
        if (seen < 0)
            continue;
        found.dark += !truth[k];
        found.lit += truth[k];
        found.edge += truth[k] != truth[k - 1];
        found.wrong += seen != truth[k];
    }
    return found;
}

static bool is_right(const char *name, const char *how, const bool *truth,
                     const KrsPicture *picture)
{
    Match m = match(truth, picture);
    print_message("# %s, %s: %d pixels dark, %d lit, %d at an edge, %d wrong\n", name, how, m.dark,
                  m.lit, m.edge, m.wrong);
    assert_true(m.dark > 250 && m.lit > 2000 && m.edge > 60);
    return m.wrong <= MAX_WRONG * m.edge;
}

static void shadows_end_where_roots_say(void **state)
{
    (void)state;
    int wrong = 0;
    for (int i = 0; i < FORMS; i++) {
        KrsPicture *hard = take(&forms[i], 0, KRS_SHADOWS_SOFT);
        KrsPicture *area = take(&forms[i], 1e-6, KRS_SHADOWS_AREA);
        bool        truth[WIDTH * HEIGHT];
        find_truth(&forms[i], LIFT, truth);
        wrong += !is_right(forms[i].name, "hard", truth, hard);
        wrong += !is_right(forms[i].name, "area", truth, area);
        find_truth(&forms[i], LIFT + 0.5, truth); /* the edge a fifth of a pixel off, or so */
        assert_false(is_right(forms[i].name, "PLANTED", truth, hard));
        krs_picture_free(hard);
        krs_picture_free(area);
    }
    assert_int_equal(wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shadows_end_where_roots_say),
    };
    return cmocka_run_group_tests_name("underestimates", tests, renderer_open, renderer_close);
}
