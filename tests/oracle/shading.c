/*
 * shading.c: what the device paints and lights: normals of smooth mirrors, materials that know
 * the normal, u and v, and the filtering of what is finer than a pixel.
 *
 * A picture's own positions say where each pixel's ray hits; normals and colours must be what
 * formulas say of that place.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/support/renderer.h"
#include "tests/oracle/brute.h"

enum { WIDTH = 240, HEIGHT = 160, PIXELS = WIDTH * HEIGHT };

static KrsPicture *take(const char *text, KrsRenderOptions options)
{
    options.width  = WIDTH;
    options.height = HEIGHT;
    return picture_of(text, &options);
}

static Vec read(const float *plane, int pixel)
{
    return vec(plane[3 * pixel], plane[3 * pixel + 1], plane[3 * pixel + 2]);
}

/* Tells whether a pixel and those around it see one component, not from too far aside. */
static bool is_clear(const KrsPicture *picture, int pixel)
{
    int x = pixel % WIDTH, y = pixel / WIDTH;
    if (x < 2 || y < 2 || x > WIDTH - 3 || y > HEIGHT - 3)
        return false;
    for (int j = -2; j <= 2; j++)
        for (int i = -2; i <= 2; i++)
            if (picture->component[pixel + j * WIDTH + i] != picture->component[pixel])
                return false;
    return picture->component[pixel] != 0;
}

static const char CAMERA[] = "camera { eye: [1, 2, 7], target: [0, 0, 0], fov: 24deg }"
                             "light sun { direction: [1, 2, 3], softness: 1deg }";

/* Two balls of radius 1 at x = -0.6 and 0.6, one the mirror image of the other. */
static void smooth_normals_on_the_device(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        char   text[600];
        double width = k ? 0.5 : 0.2;
        snprintf(text, sizeof text,
                 "%s show krs { kernel sphere(1).move([-0.6, 0, 0]);"
                 " reflect plane([1, 0, 0], 0); }.smooth_mirrors(%g);",
                 CAMERA, width);
        KrsPicture *picture = take(text, (KrsRenderOptions){0});
        size_t      checked = 0, blended = 0;
        for (int i = 0; i < PIXELS; i++) {
            if (!is_clear(picture, i))
                continue;
            Vec    p = read(picture->position, i), found = read(picture->normal, i);
            double share    = fmin(fmax(p.x / width + 0.5, 0), 1);
            Vec    kernel   = vec_unit(vec(-fabs(p.x) + 0.6, p.y, p.z));
            Vec    expected = vec_unit(vec((1 - 2 * share) * kernel.x, kernel.y, kernel.z));
            /* Within the reach of the differences the two sides' normals are mixed before. */
            double tolerance = fabs(p.x) < 0.06 ? 0.15 : 0.01;
            if (vec_distance(found, expected) > tolerance)
                fail_msg("at (%g, %g, %g) the normal is (%g, %g, %g), not (%g, %g, %g)", p.x, p.y,
                         p.z, found.x, found.y, found.z, expected.x, expected.y, expected.z);
            checked++;
            blended += share > 0.05 && share < 0.95;
        }
        assert_true(checked > 6000 && blended > 500);
        krs_picture_free(picture);
    }
}

/* Without a width the zone is a pixel: away from the mirror nothing changes, and right on it the
   normal is between. */
static void a_pixel_is_the_least_width(void **state)
{
    (void)state;
    char text[600], plain[600];
    snprintf(text, sizeof text,
             "%s show sphere(1).move([-0.6, 0, 0])"
             ".mirror(plane([1, 0, 0], 0)).smooth_mirrors();",
             CAMERA);
    snprintf(plain, sizeof plain,
             "%s show sphere(1).move([-0.6, 0, 0])"
             ".mirror(plane([1, 0, 0], 0));",
             CAMERA);
    KrsRenderOptions sharp  = {.methods.no_filter = true};
    KrsPicture      *smooth = take(text, sharp), *hard = take(plain, sharp);
    double           pixel   = 2 * tan(12 * acos(-1) / 180) * 7.3 / HEIGHT;
    size_t           changed = 0;
    for (int i = 0; i < PIXELS; i++) {
        if (!is_clear(hard, i))
            continue;
        Vec    p   = read(hard->position, i);
        double off = vec_distance(read(smooth->normal, i), read(hard->normal, i));
        if (fabs(p.x) > 1.5 * pixel)
            assert_true(off < 1e-4);
        changed += off > 0.05;
    }
    assert_true(changed > 20);
    krs_picture_free(smooth);
    krs_picture_free(hard);
}

/* A ball painted with its normal, or with a formula of its u and v, stretched and turned. */
static void materials_on_the_device(void **state)
{
    (void)state;
    static const char *const materials[] = {"0.5 + 0.5 * normal",
                                            "[0.5 + 0.1 * u, 0.5 + 0.1 * v, 0]"};
    for (int k = 0; k < 2; k++) {
        char text[600];
        snprintf(text, sizeof text,
                 "%s material m { color: %s } show sphere(1).paint(m).scale([1.3, 1, 0.8])"
                 ".rotate([0, 0, 1], 0.6);",
                 CAMERA, materials[k]);
        KrsPicture *picture = take(text, (KrsRenderOptions){0});
        size_t      checked = 0;
        for (int i = 0; i < PIXELS; i++) {
            if (!is_clear(picture, i))
                continue;
            Vec p        = vec_rotate(read(picture->position, i), vec(0, 0, 1), -0.6);
            Vec at       = vec_unit(vec(p.x / 1.3, p.y, p.z / 0.8));
            Vec expected = k == 0 ? vec_scale(0.5, vec_add(vec(1, 1, 1), at))
                                  : vec(0.5 + 0.1 * atan2(at.z, at.x), 0.5 + 0.1 * asin(at.y), 0);
            if (vec_distance(read(picture->albedo, i), expected) > 5e-3)
                fail_msg("material %d at (%g, %g, %g)", k, at.x, at.y, at.z);
            checked++;
        }
        assert_true(checked > 4000);
        krs_picture_free(picture);
    }
}

/* How far pictures of a scene differ with filtering and without, at clear pixels: the mean over
   all, of light that is about 1. */
static double filtering(const char *shown, uint32_t samples, double *worst)
{
    char text[800];
    snprintf(text, sizeof text,
             "%s material steel { color: [0.9, 0.9, 0.9], metallic: 1, roughness: 0.15 } show %s;",
             CAMERA, shown);
    KrsPicture *soft  = take(text, (KrsRenderOptions){.samples = samples});
    KrsPicture *hard  = take(text,
                             (KrsRenderOptions){.samples = samples, .methods.no_filter = true});
    double      sum   = 0;
    size_t      count = 0;
    *worst            = 0;
    for (int i = 0; i < PIXELS; i++) {
        assert_true(soft->color[4 * i + 3] == hard->color[4 * i + 3]); /* coverage is the rays' */
        if (!is_clear(hard, i))
            continue;
        for (int c = 0; c < 3; c++) {
            double off = fabs((double)soft->color[4 * i + c] - hard->color[4 * i + c]);
            sum += off;
            *worst = fmax(*worst, off);
        }
        count += 3;
    }
    assert_true(count > 3000);
    krs_picture_free(soft);
    krs_picture_free(hard);
    print_message("# %s: %u samples, mean %.5f, worst %.5f\n", shown, samples, sum / (double)count,
                  *worst);
    return sum / (double)count;
}

/* Where nothing is finer than a pixel, nothing changes, not even a mirrored highlight; fine
   grooves become a rougher coat; and many samples need no filter. */
static void only_fine_detail_is_filtered(void **state)
{
    (void)state;
    static const char grooves[] = "(box([2, 2, 0.4]) - cylinder(0.006, 3).repeat([0.013, 0, 0])"
                                  ".move([0, 0, 0.2])).paint(steel)";
    double            worst;
    assert_true(filtering("sphere(1).paint(steel)", 1, &worst) < 1e-3);
    assert_true(filtering("box([3, 3, 0.1]).paint(steel)", 1, &worst) < 1e-4);
    assert_true(filtering("sphere(1).scale([1.4, 1, 0.6]).paint(steel)", 1, &worst) < 2e-3);
    assert_true(filtering(grooves, 1, &worst) > 0.003);
    filtering(grooves, 9, &worst);
    assert_true(worst == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(smooth_normals_on_the_device),
        cmocka_unit_test(a_pixel_is_the_least_width),
        cmocka_unit_test(materials_on_the_device),
        cmocka_unit_test(only_fine_detail_is_filtered),
    };
    return cmocka_run_group_tests_name("shading", tests, renderer_open, renderer_close);
}
