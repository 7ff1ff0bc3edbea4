/*
 * detail.c: highlights on what is finer than a pixel, in previews of one sample: on thin wires, and
 * on things that a small mirror makes thin.  Right is the mean of many samples.
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

enum { SIDE = 64, MANY = 256 };

#define STEEL                                                        \
    "sky { zenith: black, horizon: black, ground: black }\n"         \
    "material steel { color: white, roughness: 0.2, metallic: 1 }\n" \
    "light { direction: [0.3, 0.5, 1], intensity: 1, shadow: false }\n"

/* Wires of not half a pixel, in all directions. */
static const char wires[] = STEEL
    "def wire(i) = cylinder(0.22 / 64, 4).rotate([1, 0, 0], 17deg * i).rotate([0, 0, 1], 72deg);\n"
    "camera { eye: [0, 0, 9], target: [0, 0, 0], projection: \"orthographic\", height: 1 }\n"
    "show union([wire(i).move([0, 0.083 * i - 0.46, 0]) for i in 0..12]).paint(steel);\n";

/* A small ball that mirrors a fence of steel around it. */
static const char mirrored[] = STEEL
    "let post = cylinder(0.12, 6).move([3, 0, 0]);\n"
    "camera { eye: [0, 0, 9], target: [0, 0, 0], projection: \"orthographic\", height: 0.2 }\n"
    "material chrome { color: white, roughness: 0, metallic: 1 }\n"
    "show sphere(0.1).paint(chrome);\n"
    "show union([post.rotate([0, 1, 0], 15deg * i + 8deg) for i in 0..24]).paint(steel);\n";

static KrsPicture *take(const PathFixture *fixture, uint32_t samples, bool filters)
{
    KrsRenderOptions options = {.width             = SIDE,
                                .height            = SIDE,
                                .samples           = samples,
                                .methods.no_filter = !filters,
                                .no_occlusion      = true,
                                .aovs              = KRS_AOV_COLOR};
    return path_fixture_render(fixture, &options);
}

/* Highlights may be brighter than this. */
static double green_of(const KrsPicture *picture, size_t pixel)
{
    return fmin((double)picture->color[4 * pixel + 1], 2);
}

static double off_by(const KrsPicture *picture, const KrsPicture *right)
{
    double sum = 0;
    for (size_t i = 0; i < SIDE * SIDE; i++)
        sum += pow(green_of(picture, i) - green_of(right, i), 2);
    return sqrt(sum / (SIDE * SIDE));
}

/* Returns how many pixels are far too bright. */
static int count_glints(const KrsPicture *picture, const KrsPicture *right)
{
    int count = 0;
    for (size_t i = 0; i < SIDE * SIDE; i++)
        count += green_of(picture, i) > green_of(right, i) + 0.4;
    return count;
}

static double sum_of(const KrsPicture *picture)
{
    double sum = 0;
    for (size_t i = 0; i < SIDE * SIDE; i++)
        sum += green_of(picture, i);
    return sum;
}

/* Pictures of one sample, filtered and not, and of many. */
typedef struct Taken {
    KrsPicture *one, *sharp, *many;
} Taken;

static Taken take_all(const char *text)
{
    PathFixture fixture = path_fixture_open(text);
    Taken taken = {take(&fixture, 1, true), take(&fixture, 1, false), take(&fixture, MANY, true)};
    path_fixture_close(&fixture);
    print_message(
        "# off by %.4f, not filtered by %.4f; %d glints, %d; %.2f of light, %.2f, right %.2f\n",
        off_by(taken.one, taken.many), off_by(taken.sharp, taken.many),
        count_glints(taken.one, taken.many), count_glints(taken.sharp, taken.many),
        sum_of(taken.one), sum_of(taken.sharp), sum_of(taken.many));
    return taken;
}

static void free_all(Taken taken)
{
    krs_picture_free(taken.one);
    krs_picture_free(taken.sharp);
    krs_picture_free(taken.many);
}

/* They have most of their light, and not in single pixels. */
static void wires_do_not_glitter(void **state)
{
    (void)state;
    Taken taken = take_all(wires);
    assert_true(off_by(taken.one, taken.many) < off_by(taken.sharp, taken.many));
    assert_true(fabs(sum_of(taken.one) / sum_of(taken.many) - 1) < 0.35);
    free_all(taken);
}

static void small_mirrors_do_not_glitter(void **state)
{
    (void)state;
    Taken taken = take_all(mirrored);
    assert_true(count_glints(taken.sharp, taken.many) > 5);
    assert_int_equal(count_glints(taken.one, taken.many), 0);
    free_all(taken);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wires_do_not_glitter),
        cmocka_unit_test(small_mirrors_do_not_glitter),
    };
    return cmocka_run_group_tests_name("detail", tests, renderer_open, renderer_close);
}
