/*
 * touching.c: what must not show in a picture: where solids touch, and where the equation of a smooth
 * surface is singular.
 *
 * A wall of blocks that touch is the same set of points as one block, and must look like it, also
 * behind an inversion.  The normals of a surface whose equation has a triple curve on it are held
 * against those of another equation of the same surface, which has none.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/support/renderer.h"

enum { WIDTH = 200, HEIGHT = 150, PIXELS = WIDTH * HEIGHT };
static const KrsRenderOptions usual = {.width = WIDTH, .height = HEIGHT};

/* Pixels that show: another colour, where the whole is even: its neighbours are alike. */
static size_t count_different(const KrsPicture *parts, const KrsPicture *whole)
{
    size_t different = 0, even = 0;
    for (size_t k = WIDTH + 1; k + WIDTH + 1 < PIXELS; k++) {
        const float *a = &parts->color[4 * k], *b = &whole->color[4 * k];
        bool         inside = whole->component[k] != 0, differs = false;
        for (int i = 0; i < 9; i++) {
            size_t       near = k + (size_t)(i % 3) + (size_t)(i / 3) * WIDTH - WIDTH - 1;
            const float *c    = &whole->color[4 * near];
            inside            = inside && whole->component[near] != 0;
            for (int n = 0; n < 3; n++)
                inside = inside && fabsf(c[n] - b[n]) < 0.04f;
        }
        for (int n = 0; n < 3; n++)
            differs = differs || fabsf(a[n] - b[n]) > 0.02f;
        even += inside;
        different += inside && differs;
    }
    assert_true(even > PIXELS / 10);
    return different;
}

static void blocks_look_like_a_wall(void **state)
{
    static const struct {
        const char *parts, *whole, *around;
    } walls[] = {
        {"box([1, 1, 1]).repeat([1, 1, 1], [3, 3, 3])", "box([3, 3, 3])",
         ".rotate([1, 2, 3], 0.4)"},
        {"union([box([1, 3, 3]).move([i - 1, 0, 0]) for i in 0..3])", "box([3, 3, 3])",
         ".rotate([2, 1, 3], 0.7)"},
        {"box([1, 0.3, 1]).repeat([1, 0, 1], [5, 1, 5]).rotate([0, 1, 0], 0.4)",
         "box([5, 0.3, 5]).rotate([0, 1, 0], 0.4)",
         ".transform(invert(center: [0, 1.5, 0], radius: 2))"},
        {"cylinder(0.6, 1).repeat([0, 1, 0], [1, 4, 1])", "cylinder(0.6, 4)",
         ".rotate([1, 0.3, 0.2], 0.5).transform(invert(center: [0.5, 0.8, 2], radius: 2))"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof walls / sizeof *walls; i++) {
        char text[400];
        snprintf(text, sizeof text, "show (%s)%s;", walls[i].whole, walls[i].around);
        KrsPicture *whole = picture_of(text, &usual);
        snprintf(text, sizeof text, "show (%s)%s;", walls[i].parts, walls[i].around);
        KrsPicture *parts     = picture_of(text, &usual);
        size_t      different = count_different(parts, whole);
        if (different > 0)
            print_message("%zu pixels show: %s\n", different, text);
        assert_true(different <= 2);
        krs_picture_free(whole);
        krs_picture_free(parts);
    }
}

/* Taubin's heart is u = y cbrt(w), with u = x^2 + 9/4 z^2 + y^2 - 1 and w = x^2 + 9/80 z^2. */
static void heart_normal(const float p[3], double n[3])
{
    double x = p[0], y = p[1], z = p[2], w = x * x + 9.0 / 80 * z * z, root = cbrt(w);
    n[0] = 2 * x - y * 2 * x / (3 * root * root);
    n[1] = 2 * y - root;
    n[2] = 4.5 * z - y * (9.0 / 40) * z / (3 * root * root);
}

/* How far a normal of the picture is from the heart's, in degrees. */
static double heart_angle(const float *position, const float *normal)
{
    double right[3], along = 0;
    heart_normal(position, right);
    double size = sqrt(right[0] * right[0] + right[1] * right[1] + right[2] * right[2]);
    for (int i = 0; i < 3; i++)
        along += normal[i] * right[i] / size;
    return acos(fmin(along, 1)) * 180 / M_PI;
}

static void a_heart_has_no_belt(void **state)
{
    static const char *const cameras[] = {
        "eye: [2.6, 0.3, 3], fov: 30deg",
        "eye: [1.5, 0.05, 1.2], target: [0.5, 0, 0.3], fov: 20deg",
        "eye: [1.3, 0.02, 0.3], target: [1, 0, 0], fov: 10deg",
        "eye: [0.1, 1, 3], target: [0, 0, 0.5], fov: 25deg",
        "eye: [0.9, -0.5, 0.4], target: [0.85, 0, 0.3], fov: 25deg",
        "eye: [-20, 3, 30], fov: 3deg",
    };
    (void)state;
    for (size_t i = 0; i < sizeof cameras / sizeof *cameras; i++) {
        char text[200];
        snprintf(text, sizeof text, "use \"std/surfaces.krs\"; show heart(); camera { %s }",
                 cameras[i]);
        KrsPicture *picture = picture_of(text, &usual);
        size_t      wrong = 0, belt = 0;
        double      worst = 0;
        for (size_t k = 0; k < PIXELS; k++) {
            const float *position = &picture->position[3 * k];
            if (picture->component[k] == 0 || fabsf(position[1]) > 0.1f)
                continue;
            double angle = heart_angle(position, &picture->normal[3 * k]);
            belt++;
            wrong += angle > 2;
            worst = fmax(worst, angle);
        }
        if (belt <= 500 || wrong > belt / 500 || worst >= 6)
            fail_msg("%s: %zu of %zu wrong, the worst by %g degrees", cameras[i], wrong, belt,
                     worst);
        krs_picture_free(picture);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks_look_like_a_wall),
        cmocka_unit_test(a_heart_has_no_belt),
    };
    return cmocka_run_group_tests_name("touching", tests, renderer_open, renderer_close);
}
