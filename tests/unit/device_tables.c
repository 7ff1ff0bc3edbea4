/*
 * device_tables.c: the tables of a scene are on the device, word for word as krs_frame_tables gives
 * them, when a picture or a query has begun; a device that cannot read so many texels says so.  All of
 * it under the validation layers.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/program.h"
#include "compiler/tables.h"
#include "runtime/device/gpu.h"
#include "runtime/tracer/handles.h"
#include "tests/support/bench.h"
#include "tests/support/device.h"

static char complaint[2048]; /* the last */

static void note_complaint(void *user, const char *message)
{
    (void)user;
    snprintf(complaint, sizeof complaint, "%s", message);
}

typedef struct Stage {
    KrsRenderer *renderer;
    KrsScene    *scene;
    KrsFrame    *frame;
    Crowds      *crowds;
} Stage;

/* Two tables for a scene that reads none. */
static void add_tables(Bench *bench, Stage *stage, uint32_t rows)
{
    stage->crowds        = arena_new(&bench->arena, Crowds);
    stage->crowds->arena = &bench->arena;
    for (uint32_t t = 0; t < 2; t++) {
        Crowd table   = {.rows = rows, .columns = 5 + t};
        Box  *boxes   = arena_new_array(&bench->arena, Box, rows);
        table.numbers = arena_new_array(&bench->arena, double, (size_t)rows *table.columns);
        for (uint32_t i = 0; i < rows * table.columns; i++)
            table.numbers[i] = random_between(&bench->random, -1, 1);
        for (uint32_t r = 0; r < rows; r++)
            for (int k = 0; k < 3; k++) {
                double at        = random_between(&bench->random, -20, 20);
                boxes[r].axis[k] = (Range){at, at + 0.1};
            }
        grid_build(&table.grid, boxes, rows, 0, 0, &bench->arena, &bench->arena);
        array_push(&bench->arena, &stage->crowds->tables, table);
    }
    Graph     *graph                  = (Graph *)(uintptr_t)stage->scene->graph;
    TableSizes sizes                  = tables_measure(stage->crowds);
    graph->crowds                     = stage->crowds;
    stage->scene->program.table_rows  = sizes.rows;
    stage->scene->program.table_cells = sizes.cells;
}

static Stage open_stage(Bench *bench, uint32_t rows, unsigned pretence)
{
    static const char  text[]  = "show sphere(1);";
    KrsRendererOptions options = {.device     = tested_device(),
                                  .validation = true,
                                  .complaint  = note_complaint,
                                  .pretence   = pretence};
    Stage              stage;
    if (krs_renderer_new(&options, &stage.renderer) != KRS_OK)
        fail_msg("%s", krs_renderer_message(stage.renderer));
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", NULL, &stage.scene), KRS_OK);
    add_tables(bench, &stage, rows);
    assert_int_equal(krs_frame_new(stage.scene, &stage.frame), KRS_OK);
    return stage;
}

static void close_stage(Stage *stage)
{
    if (krs_renderer_complaints(stage->renderer) != 0)
        fail_msg("the validation layers complain: %s", complaint);
    krs_frame_free(stage->frame);
    krs_scene_free(stage->scene);
    krs_renderer_free(stage->renderer);
}

/* Whether a buffer on the device begins with these bytes. */
static bool device_has(Gpu *gpu, const Buffer *buffer, const void *bytes, size_t count)
{
    Buffer copy;
    double ms = 0;
    assert_true(buffer->size >= count);
    assert_true(buffer_create(gpu, &copy, buffer->size, SHARED, "copy") && gpu_begin(gpu));
    vkCmdCopyBuffer(gpu->commands, buffer->buffer, copy.buffer, 1,
                    &(VkBufferCopy){0, 0, buffer->size});
    assert_true(gpu_finish(gpu, &ms));
    bool same = memcmp(copy.bytes, bytes, count) == 0;
    buffer_destroy(gpu, &copy);
    return same;
}

static bool device_has_tables(const Stage *stage, const KrsRendering *rendering)
{
    Gpu   *gpu  = &stage->renderer->gpu;
    size_t rows = krs_table_rows(stage->scene), cells = krs_table_cells(stage->scene);
    float(*wanted_rows)[4]     = calloc(rows, sizeof *wanted_rows);
    uint32_t(*wanted_cells)[2] = calloc(cells, sizeof *wanted_cells);
    krs_frame_tables(stage->frame, wanted_rows, wanted_cells);
    bool same = device_has(gpu, &rendering->table_rows, wanted_rows, rows * sizeof *wanted_rows) &&
                device_has(gpu, &rendering->table_cells, wanted_cells,
                           cells * sizeof *wanted_cells);
    free(wanted_rows);
    free(wanted_cells);
    return same;
}

static void a_query_brings_tables(void **state)
{
    Stage         stage        = open_stage(*state, 2000, 0);
    const float   points[1][3] = {{0, 0, 3}};
    float         distance;
    KrsRendering *rendering;
    assert_int_equal(krs_rendering_new(stage.renderer, stage.scene, &rendering), KRS_OK);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(krs_sample(rendering, stage.frame, points, 1, &distance, NULL), KRS_OK);
        assert_true(device_has_tables(&stage, rendering));
    }
    /* Other numbers are found out. */
    stage.crowds->tables.items[1].numbers[7] += 1;
    assert_false(device_has_tables(&stage, rendering));
    krs_rendering_free(rendering);
    close_stage(&stage);
}

static void a_picture_brings_tables(void **state)
{
    Stage            stage   = open_stage(*state, 300, KRS_PRETEND_LEAST_LIMITS);
    KrsRenderOptions options = {.width = 16, .height = 16};
    KrsPicture      *picture;
    KrsRendering    *rendering;
    assert_int_equal(krs_rendering_new(stage.renderer, stage.scene, &rendering), KRS_OK);
    assert_int_equal(krs_render(rendering, stage.frame, &options, &picture), KRS_OK);
    assert_true(device_has_tables(&stage, rendering));
    krs_picture_free(picture);
    krs_rendering_free(rendering);
    close_stage(&stage);
}

static void too_many_texels_are_refused(void **state)
{
    Stage         stage = open_stage(*state, 20000, KRS_PRETEND_LEAST_LIMITS);
    KrsRendering *rendering;
    assert_true(krs_table_cells(stage.scene) > 65536);
    assert_int_equal(krs_rendering_new(stage.renderer, stage.scene, &rendering), KRS_NO_DEVICE);
    assert_null(rendering);
    const char *message = krs_renderer_message(stage.renderer);
    if (!strstr(message, "no room for the tables of the scene"))
        fail_msg("%s", message);
    close_stage(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_query_brings_tables, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(a_picture_brings_tables, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(too_many_texels_are_refused, bench_start, bench_stop),
    };
    return cmocka_run_group_tests_name("tables on a device", tests, NULL, NULL);
}
