/*
 * patterns.c: patterns and textures of a plane that goes to the horizon, at one sample, held against
 * the mean of many rays of each pixel; and devices against the host.
 *
 * A material that only emits shows its pattern as it is.  The rays of the truth meet the plane in closed
 * form, and each looks up the pattern by its definition.
 */
#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "runtime/writer/exr.h"
#include "runtime/tracer/query.h"
#include "tests/oracle/product.h"
#include "tests/support/folder.h"
#include "tests/support/random.h"
#include "tests/support/renderer.h"

enum { WIDTH = 96, HEIGHT = 64, RAYS = 20, SIDE = 32 };

/* No light but what materials emit. */
#define DARK                                                 \
    "sky { zenith: black, horizon: black, ground: black }\n" \
    "light none { direction: [0, 1, 0], intensity: 0 }\n"

/* ---- a picture to look up ---- */

static unsigned char grays[SIDE][SIDE]; /* linear, rows from the top */

static void write_picture(uint64_t seed)
{
    Random    random = {seed};
    png_image image  = {.version = PNG_IMAGE_VERSION, .width = SIDE, .height = SIDE};
    image.format     = PNG_FORMAT_GRAY;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            grays[y][x] = (unsigned char)(random_below(&random, 2) * 200 +
                                          random_below(&random, 56));
    assert_true(png_image_write_to_file(&image, "gray.png", 0, grays, SIDE, NULL));
}

static double texel(int x, int y)
{
    return grays[SIDE - 1 - ((y % SIDE) + SIDE) % SIDE][((x % SIDE) + SIDE) % SIDE] / 255.0;
}

/* Bilinear, by its definition, repeated in each square of edge 1. */
static double texture_at(double u, double v)
{
    double x = u * SIDE - 0.5, y = v * SIDE - 0.5, s = x - floor(x), t = y - floor(y);
    int    i = (int)floor(x), j = (int)floor(y);
    return (texel(i, j) * (1 - s) + texel(i + 1, j) * s) * (1 - t) +
           (texel(i, j + 1) * (1 - s) + texel(i + 1, j + 1) * s) * t;
}

/* ---- patterns, by their definitions ---- */

static double checker_at(double u, double v) { return fmod(fabs(floor(u) + floor(v)), 2) == 0; }

static double brick_at(double u, double v)
{
    double row = floor(v / 0.5), x = u + (fmod(fabs(row), 2) == 1 ? 0.5 : 0);
    double in_brick = x - floor(x), in_row = v - 0.5 * row;
    return in_brick > 0.1 && in_brick < 0.9 && in_row > 0.1 && in_row < 0.4;
}

static double saw_at(double u, double v)
{
    (void)u;
    return v - floor(v);
}

static double wave_at(double u, double v) { return 0.5 + 0.5 * sin(3 * u + 4 * v); }

static double vein_at(double u, double v)
{
    (void)v;
    return pow(0.5 + 0.5 * sin(2 * M_PI * u), 3);
}

typedef struct Pattern {
    const char *text; /* of u and v in the plane, q = [u, v] */
    double (*at)(double u, double v);
    double      mean, most; /* how wrong it may be: in the mean, and anywhere */
    double      moire;      /* how wrong it is at least, in the mean, without a filter */
    const char *sharp;      /* the same without; NULL: there is no such text */
} Pattern;

static const Pattern patterns[] = {
    {"checker(q)", checker_at, 0.04, 0.5, 0.12,
     "if fract((floor(q.x) + floor(q.y)) / 2) == 0 then 1 else 0"},
    {"brick(q, [1, 0.5], 0.2)", brick_at, 0.04, 0.35, 0.2,
     "let row = floor(q.y / 0.5) in let a = fract(q.x + 0.5 * (row % 2)) in let b = q.y - 0.5 * "
     "row in "
     "if a > 0.1 and a < 0.9 and b > 0.1 and b < 0.4 then 1 else 0"},
    {"saw(q.y)", saw_at, 0.02, 0.15, 0.08, "fract(q.y)"},
    {"0.5 + 0.5 * wave(3 * q.x + 4 * q.y)", wave_at, 0.015, 0.2, 0.07,
     "0.5 + 0.5 * sin(3 * q.x + 4 * q.y)"},
    {"marble([q.x, 0, 0], 1, 0)", vein_at, 0.015, 0.2, 0.05, "(0.5 + 0.5 * sin(tau * q.x)) ^ 3"},
    /* Three taps along the longer side of a pixel.  One of its length is wrong by 0.063 and 0.052. */
    {"t(q).r", texture_at, 0.042, 0.3, 0, NULL},
};
enum { PATTERNS = sizeof patterns / sizeof *patterns };
_Static_assert(PATTERNS % 3 == 0, "three are shown at once");

/* ---- the truth ---- */

typedef struct View {
    Vec    eye, target;
    double height; /* of the picture plane, at distance 1 */
} View;

static const View views[] = {
    {{0.3, 1.5, 4}, {0.3, 0, -3}, 0.8},
    {{2, 3, 5}, {0, 0.4, 0.2}, 0.9},
};
enum { VIEWS = sizeof views / sizeof *views };

/* Where a ray meets the plane; false: it does not. */
static bool meets(const View *view, double x, double y, double *u, double *v)
{
    Vec    ahead = vec_unit(vec_sub(view->target, view->eye));
    Vec    right = vec_unit(vec_cross(ahead, vec(0, 1, 0))), up = vec_cross(right, ahead);
    double across = view->height * (x - WIDTH / 2.0) / HEIGHT;
    double above  = view->height * (HEIGHT / 2.0 - y) / HEIGHT;
    Vec    to     = vec_add(ahead, vec_add(vec_scale(across, right), vec_scale(above, up)));
    if (to.y >= -1e-3)
        return false;
    *u = view->eye.x - view->eye.y / to.y * to.x;
    *v = view->eye.z - view->eye.y / to.y * to.z;
    return true;
}

/* The mean over a pixel; false: a ray of it does not meet the plane. */
static bool mean_of_pixel(const View *view, const Pattern *pattern, int x, int y, double *mean)
{
    double u, v;
    *mean = 0;
    for (int j = 0; j < RAYS; j++)
        for (int i = 0; i < RAYS; i++) {
            if (!meets(view, x + (i + 0.5) / RAYS, y + (j + 0.5) / RAYS, &u, &v))
                return false;
            *mean += pattern->at(u, v) / (RAYS * RAYS);
        }
    return true;
}

/* ---- pictures ---- */

/* Returns a scene with three patterns, in red, green and blue, and a camera for each view. */
static Product scene_with(const char *const shown[3])
{
    SceneText text = {.length = 0};
    scene_write(&text, "use \"std/patterns.krs\";\n"
                       "let t = texture(\"gray.png\", space: \"linear\");\n" DARK);
    for (int i = 0; i < VIEWS; i++)
        scene_write(
            &text, "camera view%d { eye: [%g, %g, %g], target: [%g, %g, %g], fov: 2 * atan(%g) }\n",
            i, views[i].eye.x, views[i].eye.y, views[i].eye.z, views[i].target.x, views[i].target.y,
            views[i].target.z, views[i].height / 2);
    scene_write(&text,
                "material shown { color: black, emission: let q = [x, z] in [%s, %s, %s] }\n",
                shown[0], shown[1], shown[2]);
    scene_write(&text, "show plane([0, 1, 0], 0).paint(shown);\n");
    return product_compile(text.bytes);
}

typedef struct Wrong {
    double mean, most;
    int    pixels;
} Wrong;

static Wrong wrong_in(const KrsPicture *picture, int channel, const View *view,
                      const Pattern *pattern)
{
    Wrong wrong = {0, 0, 0};
    for (int k = 0; k < WIDTH * HEIGHT; k++) {
        double mean;
        if (!mean_of_pixel(view, pattern, k % WIDTH, k / WIDTH, &mean))
            continue;
        double off = fabs((double)picture->color[4 * k + channel] - mean);
        wrong.mean += off;
        wrong.most = fmax(wrong.most, off);
        wrong.pixels++;
    }
    assert_true(wrong.pixels > WIDTH * HEIGHT / 2);
    wrong.mean /= wrong.pixels;
    return wrong;
}

static void is_right(const Pattern *pattern, Wrong wrong)
{
    if (wrong.mean > pattern->mean || wrong.most > pattern->most)
        fail_msg("%s is wrong by %g, at most %g", pattern->text, wrong.mean, wrong.most);
}

static void has_moire(const Pattern *pattern, Wrong wrong)
{
    if (pattern->sharp && wrong.mean < pattern->moire)
        fail_msg("%s is wrong by no more than %g", pattern->sharp, wrong.mean);
}

typedef void Judge(const Pattern *pattern, Wrong wrong);

/* Three patterns, as a view shows them. */
static void show_three(const Product *product, int view, KrsIntegrator integrator, int first,
                       Judge *judge)
{
    KrsRenderOptions options = {.width      = WIDTH,
                                .height     = HEIGHT,
                                .samples    = 1,
                                .camera     = (size_t)view,
                                .integrator = integrator};
    KrsRendering    *rendering;
    KrsPicture      *picture;
    assert_int_equal(krs_rendering_new(renderer, product->scene, KRS_FOR_PICTURES, &rendering),
                     KRS_OK);
    assert_int_equal(krs_render(rendering, product->state, &options, &picture), KRS_OK);
    for (int k = 0; k < 3; k++)
        judge(&patterns[first + k], wrong_in(picture, k, &views[view], &patterns[first + k]));
    krs_picture_free(picture);
    krs_rendering_free(rendering);
}

static Product scene_of(int first, bool sharp)
{
    const char *shown[3];
    for (int k = 0; k < 3; k++)
        shown[k] = sharp && patterns[first + k].sharp ? patterns[first + k].sharp
                                                      : patterns[first + k].text;
    return scene_with(shown);
}

/* Shows all patterns, three at once, and hands on how wrong each is. */
static void show_all(bool sharp, int view_count, Judge *judge)
{
    write_picture(7);
    for (int first = 0; first < PATTERNS; first += 3) {
        Product product = scene_of(first, sharp);
        for (int v = 0; v < view_count; v++)
            show_three(&product, v, KRS_INTEGRATOR_PREVIEW, first, judge);
        product_free(&product);
    }
}

static void pixels_show_the_mean_of_a_pattern(void **context)
{
    (void)context;
    show_all(false, VIEWS, is_right);
}

/* Whatever the integrator is. */
static void paths_show_the_mean_of_a_pattern(void **context)
{
    (void)context;
    write_picture(7);
    Product product = scene_of(0, false);
    show_three(&product, 0, KRS_INTEGRATOR_PATH, 0, is_right);
    product_free(&product);
}

/* What is not filtered is found to be wrong. */
static void without_a_filter_there_is_moire(void **context)
{
    (void)context;
    show_all(true, 1, has_moire);
}

/* ---- devices and the host ---- */

enum { POINTS = 4000 };

static const char both_ways[] =
    "use \"std/patterns.krs\";\n"
    "let t = texture(\"gray.png\", wrap: \"%s\");\n"
    "let c = texture(\"color.exr\", wrap: \"%s\");\n"
    "show field(dot(p, p) - 9).within(box([8, 8, 8]))"
    ".paint(0.5 * t(x, y) + 0.5 * c(0.7 * x + y, z) * c.alpha(z, x));\n";

static void write_color(void)
{
    static float      numbers[12 * 9][4];
    Random            random  = {3};
    const char *const names[] = {"R", "G", "B", "A"};
    PictureChannel    channels[4];
    OutputError       error;
    for (int i = 0; i < 12 * 9; i++)
        for (int k = 0; k < 4; k++)
            numbers[i][k] = (float)random_between(&random, 0, 1);
    for (int k = 0; k < 4; k++)
        channels[k] = (PictureChannel){names[k], SAMPLE_HALF, &numbers[0][k], 4};
    Picture     picture = {.width         = 12,
                           .height        = 9,
                           .crop_width    = 12,
                           .crop_height   = 9,
                           .channels      = channels,
                           .channel_count = 4};
    OutputFile *output  = output_open("color.exr", NULL, &error);
    assert_true(exr_write(&picture, output, &error));
    assert_int_equal(output_commit(output), KRS_OK);
}

static void compare_at_points(const Product *product)
{
    static float        points[POINTS][3];
    static SurfacePoint surfaces[POINTS];
    KrsRendering       *rendering;
    Random              random = {11};
    for (int i = 0; i < POINTS; i++)
        for (int k = 0; k < 3; k++)
            points[i][k] = (float)random_between(&random, -2.5, 2.5);
    assert_int_equal(krs_rendering_new(renderer, product->scene, KRS_FOR_PICTURES, &rendering),
                     KRS_OK);
    assert_int_equal(point_query_sample(rendering, product->state, (const float(*)[3])points,
                                        POINTS, NULL, surfaces),
                     KRS_OK);
    for (int i = 0; i < POINTS; i++) {
        KrsHit hit = product_probe(
            product, vec((double)points[i][0], (double)points[i][1], (double)points[i][2]));
        for (int k = 0; k < 3; k++)
            assert_true(fabs(hit.color[k] - (double)surfaces[i].color[k]) < 2e-4);
    }
    krs_rendering_free(rendering);
}

static void devices_read_what_the_host_reads(void **context)
{
    static const char *const wraps[] = {"repeat", "clamp", "mirror"};
    (void)context;
    write_picture(7);
    write_color();
    for (int w = 0; w < 3; w++) {
        Product product = product_format(both_ways, wraps[w], wraps[2 - w]);
        compare_at_points(&product);
        product_free(&product);
    }
}

/* ---- other pictures ---- */

static void color_is(KrsRendering *rendering, KrsState *state, double wanted)
{
    SurfacePoint found;
    const float  point[1][3] = {{0.5f / SIDE, 0, 0.5f / SIDE}};
    assert_int_equal(point_query_sample(rendering, state, point, 1, NULL, &found), KRS_OK);
    assert_true(fabs((double)found.color[0] - wanted) < 1e-3);
}

/* Another picture of the same size is another number: no kernel is compiled. */
static void an_edited_picture_is_read_again(void **context)
{
    static const char text[] = "let t = texture(\"gray.png\", space: \"linear\");"
                               "camera { eye: [0, 2, 5] } show plane([0, 1, 0], 0).paint(t(x, z));";
    KrsScene         *edited;
    KrsChanges        changes;
    KrsRendering     *rendering;
    (void)context;
    write_picture(7);
    Product product = product_compile(text);
    assert_int_equal(krs_rendering_new(renderer, product.scene, KRS_FOR_PICTURES, &rendering),
                     KRS_OK);
    color_is(rendering, product.state, texel(0, 0));
    assert_int_equal(krs_scene_update(product.scene, text, strlen(text), &edited, &changes),
                     KRS_OK);
    assert_int_equal(changes.kind, KRS_CHANGE_NOTHING);
    krs_scene_free(edited);
    double before = texel(0, 0);
    write_picture(8);
    assert_true(fabs(before - texel(0, 0)) > 0.1);
    assert_int_equal(krs_scene_update(product.scene, text, strlen(text), &edited, &changes),
                     KRS_OK);
    assert_int_equal(changes.kind, KRS_CHANGE_VALUES);
    assert_int_equal(krs_state_update(product.state, edited), KRS_OK);
    assert_int_equal(krs_rendering_update(rendering, edited), KRS_OK);
    color_is(rendering, product.state, texel(0, 0));
    krs_rendering_free(rendering);
    krs_scene_free(product.scene);
    product.scene = edited;
    product_free(&product);
}

/* ---- sequences ---- */

/* Turned, mirrored twice and smaller: each ball has the texture as the first one has it. */
static const char balls[] =
    "let t = texture(\"gray.png\", space: \"linear\");\n"
    "camera { eye: [0, 0, 9], target: [0, 0, 0], projection: \"orthographic\", height: 4 }\n" DARK
    "material shown { color: black, emission: t(2 * u / tau, 3 * v / pi) }\n"
    "show krs {\n"
    "    kernel sphere(1);\n"
    "    mobius translate([1, 0.8, 0]) * rotate([0, 1, 0], 0.4) * scale(0.7);\n"
    "    reflect plane([-1, 0, 0], 0);\n"
    "    reflect plane([0, -1, 0], 0);\n"
    "}.paint(shown);\n";

/* Returns the point of the first ball that a point of the others is the image of. */
static Vec in_kernel(Vec at)
{
    Vec    q = vec_scale(1 / 0.7, vec(fabs(at.x) - 1, fabs(at.y) - 0.8, at.z));
    double c = cos(0.4), s = sin(0.4);
    return vec(c * q.x - s * q.z, q.y, s * q.x + c * q.z);
}

static void kernels_carry_their_texture(void **context)
{
    (void)context;
    write_picture(7);
    Product product = product_compile(balls);
    Random  random  = {5};
    for (int i = 0; i < 500; i++) {
        Vec    around = vec_unit(vec(random_between(&random, -1, 1), random_between(&random, -1, 1),
                                     random_between(&random, -1, 1)));
        Vec    middle = vec(i & 1 ? 1 : -1, i & 2 ? 0.8 : -0.8, 0);
        Vec    at = vec_add(middle, vec_scale(0.7, around)), q = in_kernel(at);
        double u = atan2(q.z, q.x), v = atan2(q.y, hypot(q.x, q.z));
        KrsHit hit = product_probe(&product, at);
        assert_true(fabs(hit.emission[0] - texture_at(2 * u / (2 * M_PI), 3 * v / M_PI)) < 1e-6);
    }
    product_free(&product);
}

/* What the footprint is behind mirrors, too: the picture is its own mirror image. */
static void pictures_of_mirror_images_are_mirrored(void **context)
{
    (void)context;
    write_picture(7);
    KrsRenderOptions options = {.width = WIDTH, .height = HEIGHT, .samples = 1};
    KrsPicture      *picture = picture_of(balls, &options);
    double           most    = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const float *left  = &picture->color[4 * (y * WIDTH + x)];
            const float *right = &picture->color[4 * (y * WIDTH + WIDTH - 1 - x)];
            assert_true(fabsf(left[0] - right[0]) < 1e-3F);
            most = fmax(most, (double)left[0]);
        }
    krs_picture_free(picture);
    assert_true(most > 0.2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(pixels_show_the_mean_of_a_pattern, enter_folder,
                                        leave_folder),
        cmocka_unit_test_setup_teardown(paths_show_the_mean_of_a_pattern, enter_folder,
                                        leave_folder),
        cmocka_unit_test_setup_teardown(devices_read_what_the_host_reads, enter_folder,
                                        leave_folder),
        cmocka_unit_test_setup_teardown(an_edited_picture_is_read_again, enter_folder,
                                        leave_folder),
        cmocka_unit_test_setup_teardown(kernels_carry_their_texture, enter_folder, leave_folder),
        cmocka_unit_test_setup_teardown(pictures_of_mirror_images_are_mirrored, enter_folder,
                                        leave_folder),
        cmocka_unit_test_setup_teardown(without_a_filter_there_is_moire, enter_folder,
                                        leave_folder),
    };
    return cmocka_run_group_tests_name("patterns", tests, renderer_open, renderer_close);
}
