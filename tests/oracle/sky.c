/*
 * sky.c: light of a sky that is a picture of all directions.
 *
 * The pictures are written here, and what they send to a surface is summed up here over small parts
 * of the sphere, by the definition alone: longitude from left to right, the middle towards -z, y up,
 * and bilinear between the middles of texels.
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
#include "tests/oracle/path_fixture.h"
#include "tests/support/folder.h"
#include "tests/support/renderer.h"

enum { WIDTH = 64, HEIGHT = 32 };
typedef float Map[HEIGHT][WIDTH];

/* ---- An OpenEXR file: three equal channels of floats, scanlines, not compressed ---- */

static void put(FILE *file, const void *bytes, size_t count)
{
    assert_int_equal(fwrite(bytes, 1, count, file), count);
}

static void put_number(FILE *file, uint32_t number) { put(file, &number, sizeof number); }

static void put_attribute(FILE *file, const char *name, const char *type, const void *bytes,
                          uint32_t count)
{
    put(file, name, strlen(name) + 1);
    put(file, type, strlen(type) + 1);
    put_number(file, count);
    put(file, bytes, count);
}

static void put_header(FILE *file)
{
    static const char     channels[] = "B\0\2\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0"
                                       "G\0\2\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0"
                                       "R\0\2\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0";
    static const uint32_t window[4]  = {0, 0, WIDTH - 1, HEIGHT - 1};
    static const float    center[2] = {0, 0}, one = 1;
    static const char     nothing = 0;
    put_number(file, 20000630);
    put_number(file, 2);
    put_attribute(file, "channels", "chlist", channels, sizeof channels);
    put_attribute(file, "compression", "compression", &nothing, 1);
    put_attribute(file, "dataWindow", "box2i", window, sizeof window);
    put_attribute(file, "displayWindow", "box2i", window, sizeof window);
    put_attribute(file, "lineOrder", "lineOrder", &nothing, 1);
    put_attribute(file, "pixelAspectRatio", "float", &one, sizeof one);
    put_attribute(file, "screenWindowCenter", "v2f", center, sizeof center);
    put_attribute(file, "screenWindowWidth", "float", &one, sizeof one);
    put(file, &nothing, 1);
}

static void write_map(const char *name, Map map)
{
    FILE          *file = fopen(name, "wb");
    const uint32_t line = 3 * sizeof map[0];
    assert_non_null(file);
    put_header(file);
    const uint32_t first = (uint32_t)ftell(file) + 8 * HEIGHT;
    for (uint32_t y = 0; y < HEIGHT; y++) {
        put_number(file, first + y * (8 + line));
        put_number(file, 0);
    }
    for (uint32_t y = 0; y < HEIGHT; y++) {
        put_number(file, y);
        put_number(file, line);
        for (int channel = 0; channel < 3; channel++)
            put(file, map[y], sizeof map[y]);
    }
    assert_int_equal(fclose(file), 0);
}

static void fill(Map map, float number)
{
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            map[y][x] = number;
}

/* ---- What a map is, by the definition ---- */

static double at(Map map, int x, int y)
{
    y = y < 0 ? 0 : y >= HEIGHT ? HEIGHT - 1 : y;
    return (double)map[y][(x + WIDTH) % WIDTH];
}

static double radiance(Map map, const double d[3], double rotation)
{
    double longitude = atan2(d[0], -d[2]) + rotation, turns = longitude / (2 * M_PI) + 0.5;
    double x = (turns - floor(turns)) * WIDTH - 0.5, y = acos(d[1]) / M_PI * HEIGHT - 0.5;
    double a = x - floor(x), b = y - floor(y);
    int    i = (int)floor(x), k = (int)floor(y);
    return (1 - b) * ((1 - a) * at(map, i, k) + a * at(map, i + 1, k)) +
           b * ((1 - a) * at(map, i, k + 1) + a * at(map, i + 1, k + 1));
}

/* Returns the irradiance on a surface with this normal, over parts of the sphere that are as
   large. */
static double irradiance(Map map, const double normal[3], double rotation)
{
    enum { COLUMNS = 1024, LINES = 1024 };
    double sum = 0;
    for (int i = 0; i < LINES; i++)
        for (int k = 0; k < COLUMNS; k++) {
            double rise = 1 - 2 * (i + 0.5) / LINES, level = sqrt(1 - rise * rise);
            double angle = 2 * M_PI * (k + 0.5) / COLUMNS;
            double d[3] = {level * sin(angle), rise, level * cos(angle)}, cosine = 0;
            for (int c = 0; c < 3; c++)
                cosine += d[c] * normal[c];
            sum += cosine > 0 ? cosine * radiance(map, d, rotation) : 0;
        }
    return sum * 4 * M_PI / (COLUMNS * LINES);
}

/* ---- Scenes ---- */

static PathFixture open_lit(const char *text, Map map)
{
    write_map("sky.exr", map);
    return path_fixture_open(text);
}

/* A plane through the origin, with any normal, seen along it. */
static const char lit_plane[] =
    "param normal = [0, 1, 0]; param turn = 0 in [-7, 7]; param strength = 1 in [0, 9];\n"
    "param rough = 1 in [0, 1]; param metal = 0 in [0, 1]; param from = [0, 1, 0.3];\n"
    "camera { eye: from, target: [0, 0, 0], projection: \"orthographic\", height: 0.01 }\n"
    "sky { image: \"sky.exr\", rotation: turn, intensity: strength }\n"
    "material m { color: [1, 1, 1], roughness: rough, metallic: metal, specular: 0 }\n"
    "show plane(normal, 0).paint(m);\n";

/* The same brightness everywhere is the furnace of furnace.c; and so are a map and what it lacks to
   that, together: there chosen directions and those of rays must count as they should. */
static const char lit_ball[] =
    "param rough = 0.5 in [0, 1]; param metal = 0 in [0, 1]; param glass = 0 in [0, 1];\n"
    "camera { eye: [0, 0, 5], projection: \"orthographic\", height: 2 }\n"
    "sky { image: \"sky.exr\" }\n"
    "material m { color: [1, 1, 1], roughness: rough, metallic: metal, transmission: glass }\n"
    "show sphere(1).paint(m);\n";

static KrsRenderOptions options_of(KrsIntegrator integrator, uint32_t side, uint32_t samples)
{
    return (KrsRenderOptions){.width        = side,
                              .height       = side,
                              .samples      = samples,
                              .bounces      = 24,
                              .no_occlusion = true,
                              .aovs         = KRS_AOV_COLOR,
                              .integrator   = integrator};
}

enum { MATERIALS = 5 };

static Estimate look_at_ball(PathFixture *fixture, int material, KrsIntegrator integrator)
{
    static const double numbers[MATERIALS][3] = {
        {0.5, 0, 0}, {0.1, 1, 0}, {0.6, 1, 0}, {1, 0, 0}, {0.3, 0, 1}};
    static const char *const names[3] = {"rough", "metal", "glass"};
    for (int i = 0; i < 3; i++)
        path_fixture_set(fixture, names[i], numbers[material][i]);
    return path_fixture_estimate(fixture, options_of(integrator, 48, 4), everywhere, 6);
}

static void an_even_map_is_a_furnace(void **state)
{
    (void)state;
    Map    map;
    size_t wrong = 0;
    fill(map, 1);
    PathFixture fixture = open_lit(lit_ball, map);
    for (int i = 0; i < MATERIALS; i++)
        wrong += !must_be_near(look_at_ball(&fixture, i, KRS_INTEGRATOR_PATH), 1, 0.01, "furnace");
    path_fixture_close(&fixture);
    assert_int_equal(wrong, 0);
}

/* A few places are bright, others are not. */
static void fill_unevenly(Map map)
{
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            map[y][x] = (x * 7 + y * 13) % 61 == 0 ? 1 : (float)(0.02 * ((x + y) % 3));
}

static void a_map_and_its_rest_are_a_furnace(void **state)
{
    (void)state;
    Map      map, rest;
    Estimate sums[MATERIALS];
    size_t   wrong = 0;
    fill_unevenly(map);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            rest[y][x] = 1 - map[y][x];
    PathFixture fixture = open_lit(lit_ball, map);
    for (int i = 0; i < MATERIALS; i++)
        sums[i] = look_at_ball(&fixture, i, KRS_INTEGRATOR_PATH);
    path_fixture_close(&fixture);
    fixture = open_lit(lit_ball, rest);
    for (int i = 0; i < MATERIALS; i++) {
        Estimate other = look_at_ball(&fixture, i, KRS_INTEGRATOR_PATH);
        sums[i].mean += other.mean;
        sums[i].error = hypot(sums[i].error, other.error);
        wrong += !must_be_near(sums[i], 1, 0.01, "a map and its rest");
    }
    path_fixture_close(&fixture);
    assert_int_equal(wrong, 0);
}

static const double normals[][3] = {{0, 1, 0}, {0.8, 0.6, 0}, {0.36, 0.48, -0.8}};

static void look_along(PathFixture *fixture, const double normal[3])
{
    path_fixture_set_all(fixture, "normal", normal[0], normal[1], normal[2]);
    path_fixture_set_all(fixture, "from", normal[0] + 0.1, normal[1], normal[2] - 0.2);
}

/* White scatters 1 / pi of the irradiance. */
static void a_bright_texel_lights_a_plane(void **state)
{
    (void)state;
    Map    map;
    size_t wrong = 0;
    fill(map, 0);
    map[8][40]          = 500;
    PathFixture fixture = open_lit(lit_plane, map);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 2; k++) {
            const double rotation = k * 1.2, right = irradiance(map, normals[i], rotation) / M_PI;
            look_along(&fixture, normals[i]);
            path_fixture_set(&fixture, "turn", rotation);
            Estimate found = path_fixture_estimate(
                &fixture, options_of(KRS_INTEGRATOR_DIRECT, 32, 16), everywhere, 6);
            Estimate preview = path_fixture_estimate(
                &fixture, options_of(KRS_INTEGRATOR_PREVIEW, 8, 1), everywhere, 1);
            print_message("# %.4f +- %.4f of %.4f, preview %.4f\n", found.mean, found.error, right,
                          preview.mean);
            wrong += !must_be_near(found, right, 0.004, "a bright texel");
            wrong += fabs(preview.mean - right) > 0.1 * right + 0.01;
            assert_false(is_near(found, 1.05 * right, 0.004));
        }
    path_fixture_set(&fixture, "strength", 0.25);
    wrong += !must_be_near(
        path_fixture_estimate(&fixture, options_of(KRS_INTEGRATOR_DIRECT, 32, 16), everywhere, 6),
        0.25 * irradiance(map, normals[2], 1.2) / M_PI, 0.004, "a quarter of it");
    path_fixture_close(&fixture);
    assert_int_equal(wrong, 0);
}

/* A mirror shows the map, in previews and by paths. */
static void mirrors_show_the_map(void **state)
{
    (void)state;
    Map map;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            map[y][x] = (float)(0.2 + 0.1 * (x % 5) + 0.05 * (y % 3));
    PathFixture fixture = open_lit(lit_plane, map);
    path_fixture_set(&fixture, "metal", 1);
    path_fixture_set(&fixture, "rough", 0);
    for (int i = 0; i < 3; i++) {
        const double *n    = normals[i];
        double        d[3] = {n[0] + 0.1, n[1], n[2] - 0.2}, length = 0, along = 0;
        for (int c = 0; c < 3; c++)
            length += d[c] * d[c];
        for (int c = 0; c < 3; c++)
            along += d[c] / sqrt(length) * n[c];
        for (int c = 0; c < 3; c++)
            d[c] = 2 * along * n[c] - d[c] / sqrt(length);
        look_along(&fixture, n);
        for (int k = 0; k < 2; k++) {
            const KrsIntegrator by = k ? KRS_INTEGRATOR_PATH : KRS_INTEGRATOR_PREVIEW;
            Estimate found = path_fixture_estimate(&fixture, options_of(by, 8, 1), everywhere, 2);
            assert_true(must_be_near(found, radiance(map, d, 0), 0.02, "a mirror"));
        }
    }
    path_fixture_close(&fixture);
}

/* Returns the standard deviation of pixels that are all lit alike. */
static double noise_of(const PathFixture *fixture, uint32_t samples)
{
    KrsRenderOptions options = options_of(KRS_INTEGRATOR_DIRECT, 64, samples);
    KrsPicture      *picture = path_fixture_render(fixture, &options);
    Estimate         pixels  = {0};
    for (size_t i = 0; i < 64 * 64; i++)
        estimate_add(&pixels, (double)picture->color[4 * i]);
    krs_picture_free(picture);
    return sqrt(pixels.squares / pixels.count) / pixels.mean;
}

/* The error falls at least as the square root of the number of samples.  Were the texel found by
   chance alone, a pixel would err by sqrt(1000 / 4). */
static void more_samples_err_less(void **state)
{
    (void)state;
    Map map;
    fill(map, 0);
    map[8][40]          = 500;
    PathFixture fixture = open_lit(lit_plane, map);
    double      few = noise_of(&fixture, 4), many = noise_of(&fixture, 64);
    path_fixture_close(&fixture);
    print_message("# error of a pixel: %.4f by 4 samples, %.4f by 64\n", few, many);
    assert_true(few < 0.05);
    assert_true(many < few / 3.5);
}

/* A scene that names a sky has the lights that it names: a white ball below a white sky is not seen. */
static void a_named_sky_is_all_light(void **state)
{
    (void)state;
    PathFixture fixture = path_fixture_open(
        "camera { eye: [0, 0, 4] }\n"
        "sky { zenith: white, horizon: white, ground: white }\n"
        "material m { color: white, specular: 0, roughness: 1 }\n"
        "show sphere(1).paint(m);\n");
    for (int k = 0; k < 2; k++) {
        const KrsIntegrator by = k ? KRS_INTEGRATOR_PATH : KRS_INTEGRATOR_DIRECT;
        assert_true(
            must_be_near(path_fixture_estimate(&fixture, options_of(by, 32, 4), everywhere, 2), 1,
                         0.005, "a ball"));
    }
    path_fixture_close(&fixture);
}

static int begin(void **state) { return enter_folder(state) || renderer_open(state); }

static int end(void **state) { return renderer_close(state) || leave_folder(state); }

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_even_map_is_a_furnace),
        cmocka_unit_test(a_map_and_its_rest_are_a_furnace),
        cmocka_unit_test(a_bright_texel_lights_a_plane),
        cmocka_unit_test(mirrors_show_the_map),
        cmocka_unit_test(more_samples_err_less),
        cmocka_unit_test(a_named_sky_is_all_light),
    };
    return cmocka_run_group_tests_name("sky", tests, begin, end);
}
