/*
 * lights.c: rectangles and spots send their light to one side, as their formulas say.
 *
 * The floor is y = 0, white and dull, and its pixels tell their places.  What a pixel gets is
 * computed here from the properties of the lights alone.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "tests/support/renderer.h"

enum { WIDTH = 40, HEIGHT = 40, SAMPLES = 64, CELLS = 200 };

#define SCENE                                                                    \
    "camera { eye: [0, 9, 0], target: [0, 0, 0], up: [0, 0, -1], fov: 50deg }\n" \
    "sky { zenith: black, horizon: black, ground: black }\n"                     \
    "material white { color: [1, 1, 1], roughness: 1, specular: 0 }\n"           \
    "show plane().paint(white);\n"

static const double place[3] = {1.5, 3, 0.5}, target[3] = {0.5, 0, -0.5};

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void unit(double v[3])
{
    double length = sqrt(dot(v, v));
    for (int i = 0; i < 3; i++)
        v[i] /= length;
}

static void cross(const double a[3], const double b[3], double c[3])
{
    for (int i = 0; i < 3; i++)
        c[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* Returns the part of a spot's light at an angle from its axis: it fades as smoothstep of the
   cosine. */
static double fade(double cosine, double angle, double edge)
{
    double outer = cos(angle / 2), inner = cos(angle / 2 * (1 - edge));
    double t = fmin(fmax((cosine - outer) / (inner - outer), 0), 1);
    return t * t * (3 - 2 * t);
}

/* Returns what a place of the floor sends to the eye: white scatters 1 / pi of its irradiance. */
static double lit_by_spot(const double at[3])
{
    double axis[3], way[3], square = 0;
    for (int i = 0; i < 3; i++) {
        axis[i] = target[i] - place[i];
        way[i]  = at[i] - place[i];
        square += way[i] * way[i];
    }
    unit(axis);
    unit(way);
    return 20 * fade(dot(axis, way), 50 * M_PI / 180, 0.4) * -way[1] / square / M_PI;
}

/* Returns the sum over small parts of the rectangle, 1.6 wide and 0.8 high. */
static double lit_by_rectangle(const double at[3])
{
    const double upright[3] = {0, 1, 0};
    double       axis[3], right[3], up[3], sum = 0;
    for (int i = 0; i < 3; i++)
        axis[i] = target[i] - place[i];
    unit(axis);
    cross(upright, axis, right);
    unit(right);
    cross(axis, right, up);
    for (int k = 0; k < CELLS; k++) {
        double a = 1.6 * ((k / 20 + 0.5) / (CELLS / 20) - 0.5),
               b = 0.8 * ((k % 20 + 0.5) / 20 - 0.5);
        double way[3], square = 0;
        for (int i = 0; i < 3; i++) {
            way[i] = at[i] - place[i] - a * right[i] - b * up[i];
            square += way[i] * way[i];
        }
        unit(way);
        sum += 20 * fmax(dot(axis, way), 0) * -way[1] / square / M_PI / CELLS;
    }
    return sum;
}

/* By how much the mean pixel is off, in parts of the brightest one. */
static double find_off(const char   *light, double (*truth)(const double at[3]),
                       KrsIntegrator integrator, double gain)
{
    char        text[1024];
    KrsPicture *picture;
    double      off = 0, brightest = 0;
    snprintf(text, sizeof text,
             SCENE "light one { position: [1.5, 3, 0.5], target: [0.5, 0, -0.5], "
                   "intensity: 20, %s }",
             light);
    picture = picture_of(text, &(KrsRenderOptions){.width        = WIDTH,
                                                   .height       = HEIGHT,
                                                   .samples      = SAMPLES,
                                                   .integrator   = integrator,
                                                   .no_occlusion = true});
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        const double at[3] = {(double)picture->position[3 * i], 0,
                              (double)picture->position[3 * i + 2]};
        off += fabs((double)picture->color[4 * i] * gain - truth(at)) / (WIDTH * HEIGHT);
        brightest = fmax(brightest, truth(at));
    }
    krs_picture_free(picture);
    print_message("# %s, %s: off by %.4f of the brightest\n", light,
                  krs_integrator_names[integrator], off / brightest);
    return off / brightest;
}

static void spots_are_cones(void **state)
{
    (void)state;
    const char *spot = "angle: 50deg, edge: 0.4";
    assert_true(find_off(spot, lit_by_spot, KRS_INTEGRATOR_DIRECT, 1) < 2e-3);
    assert_true(find_off(spot, lit_by_spot, KRS_INTEGRATOR_PREVIEW, 1) < 0.02);
}

static void rectangles_face_their_target(void **state)
{
    (void)state;
    const char *panel = "size: [1.6, 0.8]";
    assert_true(find_off(panel, lit_by_rectangle, KRS_INTEGRATOR_DIRECT, 1) < 4e-3);
    assert_true(find_off(panel, lit_by_rectangle, KRS_INTEGRATOR_PREVIEW, 1) < 0.03);
}

static void a_wrong_light_is_noticed(void **state)
{
    (void)state;
    const char *panel = "size: [1.6, 0.8]", *spot = "angle: 50deg, edge: 0.4";
    assert_true(find_off(panel, lit_by_rectangle, KRS_INTEGRATOR_DIRECT, 0.96) > 4e-3);
    assert_true(find_off("angle: 48deg, edge: 0.4", lit_by_spot, KRS_INTEGRATOR_DIRECT, 1) > 2e-3);
    assert_true(find_off(spot, lit_by_rectangle, KRS_INTEGRATOR_DIRECT, 1) > 0.03);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spots_are_cones),
        cmocka_unit_test(rectangles_face_their_target),
        cmocka_unit_test(a_wrong_light_is_noticed),
    };
    return cmocka_run_group_tests(tests, renderer_open, renderer_close);
}
