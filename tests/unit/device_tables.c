/*
 * device_tables.c: the tables of a scene are on the device, word for word as krs_state_tables gives
 * them for the state, when a picture or a query has begun.  They are texels, or storage buffers where
 * the device reads too few texels; a device that has no room for them says so.  All of it under the
 * validation layers.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <math.h>

#include "compiler/graph/instances/grid_build.h"
#include "compiler/scene/program.h"
#include "compiler/scene/tables.h"
#include "runtime/device/gpu.h"
#include "runtime/tracer/handles.h"
#include "runtime/tracer/renderer.h"
#include "tests/support/agreement.h"
#include "tests/support/bench.h"
#include "tests/support/device.h"

static char validation_message[2048]; /* the last */

static void note_validation_message(void *user, const char *message)
{
    (void)user;
    snprintf(validation_message, sizeof validation_message, "%s", message);
}

typedef struct Fixture {
    KrsRenderer *renderer;
    KrsScene    *scene;
    KrsState    *state;
    Instances   *instances;
} Fixture;

#define CAMERA "camera { eye: [20, 0, 3], target: [20, 0, 0] }"

/* A scene whose tables have numbers of the frame, instead of tables that are added. */
static const char moving[] = "param height = 0.5 in [0, 2];\n"
                             "show union([sphere(0.2).move([i, height * sin(time + i), 0]) "
                             "for i in 0..80]);" CAMERA;

/* Two tables for a scene that reads none. */
static void add_tables(Bench *bench, Fixture *fixture, uint32_t rows)
{
    fixture->instances        = arena_new(&bench->arena, Instances);
    fixture->instances->arena = &bench->arena;
    for (uint32_t t = 0; t < 2; t++) {
        InstanceTable table = {.rows = rows, .columns = 5 + t};
        Box          *boxes = arena_new_array(&bench->arena, Box, rows);
        table.numbers       = arena_new_array(&bench->arena, double, (size_t)rows *table.columns);
        for (uint32_t i = 0; i < rows * table.columns; i++)
            table.numbers[i] = random_between(&bench->random, -1, 1);
        for (uint32_t r = 0; r < rows; r++)
            for (int k = 0; k < 3; k++) {
                double at        = random_between(&bench->random, -20, 20);
                boxes[r].axis[k] = (Range){at, at + 0.1};
            }
        grid_build(&table.grid, boxes, rows, 0, 0, 1, &bench->arena, &bench->arena);
        table.cells = table.grid;
        array_push(&bench->arena, &fixture->instances->tables, table);
    }
    Graph     *graph                    = (Graph *)(uintptr_t)fixture->scene->graph;
    TableSizes sizes                    = tables_measure(fixture->instances, NULL);
    graph->instances                    = fixture->instances;
    fixture->scene->program.table_rows  = sizes.rows;
    fixture->scene->program.table_cells = sizes.cells;
}

static Fixture open_scene(const char *text, unsigned emulation)
{
    KrsRendererOptions options = {.device             = tested_device(),
                                  .validation         = true,
                                  .validation_message = note_validation_message};
    Fixture            fixture;
    if (renderer_new_emulating(&options, emulation, &fixture.renderer) != KRS_OK)
        fail_msg("%s", krs_renderer_message(fixture.renderer));
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", NULL, &fixture.scene),
                     KRS_OK);
    assert_int_equal(krs_state_new(fixture.scene, &fixture.state), KRS_OK);
    return fixture;
}

static Fixture open_fixture(Bench *bench, uint32_t rows, unsigned emulation)
{
    Fixture fixture = open_scene("show sphere(1);", emulation);
    add_tables(bench, &fixture, rows);
    return fixture;
}

static void close_fixture(Fixture *fixture)
{
    if (krs_renderer_validation_messages(fixture->renderer) != 0)
        fail_msg("the validation layers complain: %s", validation_message);
    krs_state_free(fixture->state);
    krs_scene_free(fixture->scene);
    krs_renderer_free(fixture->renderer);
}

/* Tells whether a buffer on the device begins with these bytes. */
static bool device_has(Gpu *gpu, const Buffer *buffer, const void *bytes, size_t count)
{
    Buffer copy;
    double ms = 0;
    assert_true(buffer->size >= count);
    assert_true(buffer_create(gpu, &copy, buffer->size, SHARED, "copy") && gpu_begin(gpu));
    gpu_copy(gpu, buffer, 0, &copy, 0, buffer->size);
    assert_true(gpu_finish(gpu, &ms));
    bool same = memcmp(copy.bytes, bytes, count) == 0;
    buffer_destroy(gpu, &copy);
    return same;
}

static bool device_has_tables(const Fixture *fixture, const KrsRendering *rendering)
{
    Gpu   *gpu  = &fixture->renderer->gpu;
    size_t rows = krs_table_rows(fixture->scene), cells = krs_table_cells(fixture->scene);
    float(*wanted_rows)[4]     = calloc(rows, sizeof *wanted_rows);
    uint32_t(*wanted_cells)[2] = calloc(cells, sizeof *wanted_cells);
    krs_state_tables_in_use(fixture->state, NULL, wanted_rows, wanted_cells, &rows, &cells);
    bool same = device_has(gpu, &rendering->table_rows, wanted_rows, rows * sizeof *wanted_rows) &&
                device_has(gpu, &rendering->table_cells, wanted_cells,
                           cells * sizeof *wanted_cells);
    free(wanted_rows);
    free(wanted_cells);
    return same;
}

static void a_query_brings_tables(void **context)
{
    Fixture       fixture      = open_fixture(*context, 2000, 0);
    const float   points[1][3] = {{0, 0, 3}};
    float         distance;
    KrsRendering *rendering;
    assert_int_equal(
        krs_rendering_new(fixture.renderer, fixture.scene, KRS_FOR_PICTURES, &rendering), KRS_OK);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(krs_device_distance(rendering, fixture.state, points, 1, &distance),
                         KRS_OK);
        assert_true(device_has_tables(&fixture, rendering));
    }
    /* Other numbers are found out. */
    fixture.instances->tables.items[1].numbers[7] += 1;
    assert_false(device_has_tables(&fixture, rendering));
    krs_rendering_free(rendering);
    close_fixture(&fixture);
}

static void a_picture_brings_tables(void **context)
{
    Fixture          fixture = open_fixture(*context, 300, EMULATE_MIN_LIMITS);
    KrsRenderOptions options = {.width = 16, .height = 16};
    KrsPicture      *picture;
    KrsRendering    *rendering;
    assert_int_equal(
        krs_rendering_new(fixture.renderer, fixture.scene, KRS_FOR_PICTURES, &rendering), KRS_OK);
    assert_int_equal(krs_render(rendering, fixture.state, &options, &picture), KRS_OK);
    assert_true(device_has_tables(&fixture, rendering));
    krs_picture_free(picture);
    krs_rendering_free(rendering);
    close_fixture(&fixture);
}

enum { MOVING_POINTS = 400 };

/* Returns the distance of balls as the scene's formula has it. */
static double moving_distance(const float p[3], double time, double height)
{
    double nearest = HUGE_VAL;
    for (int i = 0; i < 80; i++) {
        double y = height * sin(time + i);
        nearest  = fmin(nearest, hypot(hypot(p[0] - i, p[1] - y), (double)p[2]) - 0.2);
    }
    return nearest;
}

/* Points about balls that are there in this state. */
static void points_near(Bench *bench, double time, double height, float points[][3])
{
    for (int n = 0; n < MOVING_POINTS; n++) {
        int    i = n % 80;
        double y = height * sin(time + i), centre[3] = {i, y, 0};
        for (int k = 0; k < 3; k++)
            points[n][k] = (float)(centre[k] + random_between(&bench->random, -0.2, 0.2));
    }
}

static void assert_state_is_seen(Bench *bench, const Fixture *fixture, KrsRendering *rendering,
                                 double time, double height)
{
    static float points[MOVING_POINTS][3], found[MOVING_POINTS];
    points_near(bench, time, height, points);
    assert_int_equal(krs_device_distance(rendering, fixture->state, (const float(*)[3])points,
                                         MOVING_POINTS, found),
                     KRS_OK);
    assert_true(device_has_tables(fixture, rendering));
    for (int n = 0; n < MOVING_POINTS; n++) {
        double wanted = moving_distance(points[n], time, height);
        assert_true(wanted > 0.15 || fabs((double)found[n] - wanted) < 1e-5);
    }
}

static void rows_are_those_of_the_state(Bench *bench, unsigned emulation)
{
    static const double frames[][2] = {{0, 0.5}, {0, 0.5},   {1.5, 0.5},
                                       {1.5, 2}, {-8, 1.25}, {0, 0.5}};
    Fixture             fixture     = open_scene(moving, emulation);
    KrsRendering       *rendering;
    assert_true(fixture.scene->program.rows_vary);
    assert_int_equal(fixture.renderer->gpu.texels, emulation == 0);
    assert_int_equal(
        krs_rendering_new(fixture.renderer, fixture.scene, KRS_FOR_PICTURES, &rendering), KRS_OK);
    for (size_t i = 0; i < sizeof frames / sizeof *frames; i++) {
        bool same = i > 0 && frames[i][0] == frames[i - 1][0] && frames[i][1] == frames[i - 1][1];
        assert_int_equal(krs_state_set_time(fixture.state, frames[i][0]), KRS_OK);
        assert_int_equal(krs_state_set(fixture.state, "height", &frames[i][1], 1), KRS_OK);
        assert_true(i == 0 || device_has_tables(&fixture, rendering) == same);
        assert_state_is_seen(bench, &fixture, rendering, frames[i][0], frames[i][1]);
    }
    assert_int_equal(krs_rendering_update(rendering, fixture.scene), KRS_OK);
    assert_state_is_seen(bench, &fixture, rendering, 0, 0.5);
    krs_rendering_free(rendering);
    close_fixture(&fixture);
}

static void rows_of_texels_are_those_of_the_state(void **context)
{
    rows_are_those_of_the_state(*context, 0);
}

static void rows_of_buffers_are_those_of_the_state(void **context)
{
    rows_are_those_of_the_state(*context, EMULATE_MIN_LIMITS);
}

/* A picture of a state is that of a scene without time, whose numbers are those of the state. */
static void pictures_are_those_of_the_state(void **context)
{
    (void)context;
    static const char *const still[] = {"-1", "2.5"};
    static const double      times[] = {-1, 2.5};
    KrsRenderOptions         options = {.width = 192, .height = 96, .aovs = AGREEMENT_AOVS};
    Fixture                  fixture = open_scene(moving, 0);
    KrsRendering            *rendering;
    assert_int_equal(
        krs_rendering_new(fixture.renderer, fixture.scene, KRS_FOR_PICTURES, &rendering), KRS_OK);
    for (int i = 0; i < 2; i++) {
        char text[512];
        snprintf(text, sizeof text,
                 "show union([sphere(0.2).move([i, 0.5 * sin(%s + i), 0]) for i in 0..80]);" CAMERA,
                 still[i]);
        Fixture     other = open_scene(text, 0);
        KrsPicture *pictures[2];
        assert_false(other.scene->program.rows_vary);
        assert_int_equal(krs_state_set_time(fixture.state, times[i]), KRS_OK);
        assert_int_equal(krs_render(rendering, fixture.state, &options, &pictures[0]), KRS_OK);
        KrsRendering *of_other;
        assert_int_equal(
            krs_rendering_new(other.renderer, other.scene, KRS_FOR_PICTURES, &of_other), KRS_OK);
        assert_int_equal(krs_render(of_other, other.state, &options, &pictures[1]), KRS_OK);
        Agreement agreement = agreement_of(pictures[0], pictures[1], 1);
        assert_true(agreement.solid > agreement.pixels / 50);
        assert_int_equal(agreement_faults(&agreement), 0);
        krs_picture_free(pictures[0]);
        krs_picture_free(pictures[1]);
        krs_rendering_free(of_other);
        close_fixture(&other);
    }
    krs_rendering_free(rendering);
    close_fixture(&fixture);
}

/* A device with room for as much as the tables have, or for less. */
static void compare_with_room(Bench *bench, unsigned emulation, bool enough)
{
    Fixture       fixture = open_fixture(bench, 2000, emulation);
    GpuLimits    *limits  = &fixture.renderer->gpu.limits;
    size_t        rows    = krs_table_rows(fixture.scene) * 16;
    size_t        cells   = krs_table_cells(fixture.scene) * 8;
    size_t        page = 4096, most = (rows > cells ? rows : cells) + 2 * page;
    KrsRendering *rendering;
    assert_true(rows > 64 * page && rows / 16 < cells / 8);
    limits->storage_bytes = (uint32_t)(enough ? most : most - 4 * page);
    limits->texels        = (uint32_t)(cells / 8 + 2 * page / 8 - (enough ? 0 : page / 2));
    if (enough) {
        assert_int_equal(
            krs_rendering_new(fixture.renderer, fixture.scene, KRS_FOR_PICTURES, &rendering),
            KRS_OK);
        krs_rendering_free(rendering);
    } else {
        assert_int_equal(
            krs_rendering_new(fixture.renderer, fixture.scene, KRS_FOR_PICTURES, &rendering),
            KRS_NO_DEVICE);
        assert_null(rendering);
        const char *message = krs_renderer_message(fixture.renderer);
        if (!strstr(message, "no room for the tables of the scene"))
            fail_msg("%s", message);
    }
    close_fixture(&fixture);
}

static void too_large_tables_are_refused(void **context)
{
    compare_with_room(*context, 0, true);
    compare_with_room(*context, 0, false);
    compare_with_room(*context, EMULATE_MIN_LIMITS, true);
    compare_with_room(*context, EMULATE_MIN_LIMITS, false);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_query_brings_tables, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(a_picture_brings_tables, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(rows_of_texels_are_those_of_the_state, bench_start,
                                        bench_stop),
        cmocka_unit_test_setup_teardown(rows_of_buffers_are_those_of_the_state, bench_start,
                                        bench_stop),
        cmocka_unit_test_setup_teardown(pictures_are_those_of_the_state, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(too_large_tables_are_refused, bench_start, bench_stop),
    };
    return cmocka_run_group_tests_name("tables on a device", tests, NULL, NULL);
}
