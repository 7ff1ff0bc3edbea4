/*
 * instance_shaders.c: shaders give what tapes give, for functions of instance groups in the place of a scene's
 * distance.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <string.h>

#include "compiler/scene/program.h"
#include "compiler/scene/tables.h"
#include "krs/vulkan.h"
#include "tests/support/device.h"
#include "tests/unit/instance_scene.h"

enum { POINTS = 4096 };

/* Single precision in coordinates up to this one. */
static const double FARTHEST = 8, TOLERANCE = 1e-5;

typedef struct Fixture {
    KrsRenderer *renderer;
    KrsScene    *scene;
    Many         many;
    float        points[POINTS][3], found[POINTS];
} Fixture;

/* Opens a scene whose graph gets the functions. */
static void open_fixture(Fixture *fixture, Bench *bench)
{
    static const char  text[]  = "show sphere(1);";
    KrsRendererOptions options = {.device = tested_device()};
    if (krs_renderer_new(&options, &fixture->renderer) != KRS_OK)
        fail_msg("%s", krs_renderer_message(fixture->renderer));
    assert_int_equal(
        krs_compile_text(text, strlen(text), "instance group.krs", NULL, &fixture->scene), KRS_OK);
    Graph *graph                        = (Graph *)(uintptr_t)fixture->scene->graph;
    bench->graph                        = graph;
    bench->point                        = graph_leaf(graph, OP_POINT);
    fixture->many                       = make_many(bench);
    TableSizes sizes                    = tables_measure(graph->instances, NULL);
    fixture->scene->program.table_rows  = sizes.rows;
    fixture->scene->program.table_cells = sizes.cells;
    for (int i = 0; i < POINTS; i++)
        for (int k = 0; k < 3; k++)
            fixture->points[i][k] = (float)random_between(&bench->random, -FARTHEST, FARTHEST);
}

/* What shaders find where a root of the graph is the scene's distance. */
static void sample_root(Fixture *fixture, Node root)
{
    KrsState     *state;
    KrsRendering *rendering;
    surface_roots(&fixture->scene->roots, 0)[ROOT_DISTANCE] = root;
    assert_int_equal(krs_state_new(fixture->scene, &state), KRS_OK);
    assert_int_equal(krs_state_set_time(state, TIME), KRS_OK);
    assert_int_equal(
        krs_rendering_new(fixture->renderer, fixture->scene, KRS_FOR_PICTURES, &rendering), KRS_OK);
    assert_int_equal(krs_device_distance(rendering, state, (const float(*)[3])fixture->points,
                                         POINTS, fixture->found),
                     KRS_OK);
    krs_rendering_free(rendering);
    krs_state_free(state);
}

/* At how many points the tape finds something else. */
static int count_differences(const Fixture *fixture, Node root, Bench *bench)
{
    const Graph    *graph      = fixture->scene->graph;
    Tape            tape       = tape_new(graph, &root, 1, &bench->arena);
    NodeValue      *values     = arena_new_array(&bench->arena, NodeValue, graph->count);
    const NodeValue parameters = {{TIME}};
    int             count      = 0;
    tape.by_cells              = true;
    tape_run_frame(&tape, &parameters, values);
    for (int i = 0; i < POINTS; i++) {
        const float *point = fixture->points[i];
        tape_run_point(&tape, (double[]){point[0], point[1], point[2]}, values);
        count += !(fabs(values[root].v[0] - (double)fixture->found[i]) <= TOLERANCE);
    }
    return count;
}

/* Shaders may choose another cell, or nearest instance, at very few points on the border between. */
static void shaders_give_what_tapes_give(void **state)
{
    static const int roots[] = {SHARP, SMOOTH, NESTED, SHADED};
    static Fixture   fixture;
    Bench           *bench = *state;
    open_fixture(&fixture, bench);
    for (int i = 0; i < 4; i++) {
        Node root = fixture.many.roots[roots[i]];
        sample_root(&fixture, root);
        assert_in_range(count_differences(&fixture, root, bench), 0, 2);
        Node other = fixture.many.roots[roots[(i + 1) % 4]];
        assert_in_range(count_differences(&fixture, other, bench), POINTS / 2, POINTS);
    }
    krs_scene_free(fixture.scene);
    krs_renderer_free(fixture.renderer);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(shaders_give_what_tapes_give, bench_start, bench_stop),
    };
    return cmocka_run_group_tests_name("shaders of instance groups", tests, NULL, NULL);
}
