/*
 * sky_means.c: what previews take for the mean of the sky, around normals and in rough mirrors.
 *
 * The sky is what a panorama of it shows.  Its mean around a normal is summed up here over the rows
 * of that picture.  What rough metal mirrors is what paths find.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/oracle/path_fixture.h"
#include "tests/support/renderer.h"

#define SKY                                                                              \
    "param above = 0 in [0, 9]; param level = 0 in [0, 9]; param below = 0 in [0, 9];\n" \
    "light none { direction: [0, 1, 0], intensity: 0 }\n"                                \
    "sky { zenith: above * white, horizon: level * white, ground: below * white }\n"

static const char panorama[] = SKY
    "camera { eye: [0, 0, 0], target: [0, 0, -1], projection: \"panorama\" }\n"
    "show sphere(0.001).move([9, 0.02, 0]);\n";

/* A plane through the origin, seen nearly along its normal. */
static const char lit_plane[] = SKY
    "param normal = [0, 1, 0]; param from = [0, 1, 0.3];\n"
    "param rough = 1 in [0, 1]; param metal = 0 in [0, 1];\n"
    "camera { eye: from, target: [0, 0, 0], projection: \"orthographic\", height: 0.01 }\n"
    "material m { color: white, roughness: rough, metallic: metal, specular: metal }\n"
    "show plane(normal, 0).paint(m);\n";

enum { ROWS = 1024, PARTS = 3, RISES = 7 };
static const char *const parts[PARTS] = {"above", "level", "below"};
static const double      rises[RISES] = {1, 0.7, 0.3, 0, -0.3, -0.7, -1};

static KrsRenderOptions options_of(KrsIntegrator integrator, uint32_t side, uint32_t samples)
{
    return (KrsRenderOptions){.width        = side,
                              .height       = side,
                              .samples      = samples,
                              .bounces      = 2,
                              .no_occlusion = true,
                              .aovs         = KRS_AOV_COLOR,
                              .integrator   = integrator};
}

/* Only one part of the sky is bright. */
static void light_up(PathFixture *fixture, int part)
{
    for (int i = 0; i < PARTS; i++)
        path_fixture_set(fixture, parts[i], i == part);
}

/* Rows of the sky from the zenith down. */
static void find_sky(int part, double rows[ROWS])
{
    PathFixture      fixture = path_fixture_open(panorama);
    KrsRenderOptions options = options_of(KRS_INTEGRATOR_PREVIEW, ROWS, 1);
    options.width            = 8;
    light_up(&fixture, part);
    KrsPicture *picture = path_fixture_render(&fixture, &options);
    for (size_t y = 0; y < ROWS; y++)
        rows[y] = (double)picture->color[4 * (8 * y) + 1];
    krs_picture_free(picture);
    path_fixture_close(&fixture);
}

/* Returns the cosine to a normal that rises by `up`, where it is positive, over all directions of a
   height: its integral over the longitude. */
static double cosines_of(double height, double up)
{
    const double across = sqrt(1 - height * height) * sqrt(1 - up * up), along = height * up;
    if (across <= fabs(along))
        return 2 * M_PI * fmax(along, 0);
    const double end = acos(-along / across);
    return 2 * (along * end + across * sin(end));
}

/* The mean of rows of the sky around a normal, weighted by the cosine. */
static double mean_around(const double rows[ROWS], double up)
{
    double sum = 0;
    for (int y = 0; y < ROWS; y++) {
        const double latitude = M_PI * (0.5 - (y + 0.5) / ROWS);
        sum += rows[y] * cosines_of(sin(latitude), up) * cos(latitude) * M_PI / ROWS;
    }
    return sum / M_PI;
}

static void turn(PathFixture *fixture, double up)
{
    const double level = sqrt(1 - up * up);
    path_fixture_set_all(fixture, "normal", level, up, 0);
    path_fixture_set_all(fixture, "from", level, up, 0.01);
}

static void dull_planes_see_the_mean(void **state)
{
    (void)state;
    double      rows[ROWS], worst = 0;
    PathFixture fixture = path_fixture_open(lit_plane);
    size_t      wrong   = 0;
    for (int part = 0; part < PARTS; part++) {
        find_sky(part, rows);
        light_up(&fixture, part);
        for (int i = 0; i < RISES; i++) {
            const double right = mean_around(rows, rises[i]);
            turn(&fixture, rises[i]);
            Estimate found = path_fixture_estimate(
                &fixture, options_of(KRS_INTEGRATOR_PREVIEW, 8, 1), everywhere, 1);
            worst = fmax(worst, fabs(found.mean - right));
            if (i % 3 == 0)
                wrong += !must_be_near(
                    path_fixture_estimate(&fixture, options_of(KRS_INTEGRATOR_DIRECT, 32, 16),
                                          everywhere, 6),
                    right, 0.005, "a path");
        }
    }
    path_fixture_close(&fixture);
    print_message("# means of the sky are off by %.5f\n", worst);
    assert_true(worst < 0.003);
    assert_int_equal(wrong, 0);
}

/* For each roughness this is the root of the mean square of what previews are off by. */
static void rough_metal_mirrors_what_paths_find(void **state)
{
    (void)state;
    static const double roughs[] = {0.15, 0.3, 0.6};
    PathFixture         fixture  = path_fixture_open(lit_plane);
    path_fixture_set(&fixture, "metal", 1);
    for (size_t k = 0; k < sizeof roughs / sizeof *roughs; k++)
        for (int part = 0; part < PARTS; part += 2) {
            double squares = 0;
            int    count   = 0;
            light_up(&fixture, part);
            path_fixture_set(&fixture, "rough", roughs[k]);
            for (double up = -0.9; up < 1; up += 0.3, count++) {
                turn(&fixture, up);
                Estimate right = path_fixture_estimate(
                    &fixture, options_of(KRS_INTEGRATOR_DIRECT, 16, 16), everywhere, 2);
                Estimate found = path_fixture_estimate(
                    &fixture, options_of(KRS_INTEGRATOR_PREVIEW, 8, 1), everywhere, 1);
                squares += pow(found.mean - right.mean, 2);
            }
            print_message("# roughness %.2f, %s: off by %.4f\n", roughs[k], parts[part],
                          sqrt(squares / count));
            assert_true(sqrt(squares / count) < 0.03);
        }
    path_fixture_close(&fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dull_planes_see_the_mean),
        cmocka_unit_test(rough_metal_mirrors_what_paths_find),
    };
    return cmocka_run_group_tests_name("means of the sky", tests, renderer_open, renderer_close);
}
