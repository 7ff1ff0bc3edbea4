/*
 * outlines.c: distances to outlines against brute force.
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

#include "compiler/graph/evaluate.h"
#include "compiler/lower/outline.h"
#include "compiler/base/fonts.h"
#include "compiler/outline/letters.h"
#include "compiler/scene/program.h"
#include "compiler/scene/tables.h"
#include "krs/vulkan.h"
#include "tests/oracle/outline_truth.h"
#include "tests/support/bench.h"
#include "tests/support/device.h"

enum { POINTS = 200 };

/* What the lines leave of curves whose control points are within 2 of each other. */
static const double OF_CURVES = 1e-4, OF_LINES = 1e-6;

/* ---- figures ---- */

typedef struct Figure {
    const char *name;
    FillRule    rule;
    void (*draw)(Path *path, Random *random);
    bool straight;
} Figure;

static void random_point(Random *random, double p[2])
{
    p[0] = random_between(random, -1, 1);
    p[1] = random_between(random, -1, 1);
}

static void draw_scribble(Path *path, Random *random)
{
    double p[2];
    random_point(random, p);
    path_move(path, p);
    for (int i = 0; i < 12; i++) {
        random_point(random, p);
        path_line(path, p);
    }
    path_close(path);
}

static void draw_knot(Path *path, Random *random)
{
    double p[2], q[2];
    random_point(random, p);
    path_move(path, p);
    for (int i = 0; i < 6; i++) {
        random_point(random, p);
        random_point(random, q);
        path_quadratic(path, p, q);
    }
    path_close(path);
}

static void draw_ring(Path *path, double x, double y, double radius, bool back)
{
    for (int i = 0; i <= 8; i++) {
        double turn = (back ? -1 : 1) * M_PI / 4, a = i * turn, m = a - 0.5 * turn;
        double far    = radius / cos(M_PI / 8);
        double to[2]  = {x + radius * cos(a), y + radius * sin(a)};
        double via[2] = {x + far * cos(m), y + far * sin(m)};
        if (i == 0)
            path_move(path, to);
        else
            path_quadratic(path, via, to);
    }
    path_close(path);
}

static void draw_rings(Path *path, Random *random)
{
    for (int i = 0; i < 5; i++) {
        double p[2];
        random_point(random, p);
        draw_ring(path, p[0], p[1], random_between(random, 0.2, 0.7), i % 2);
    }
}

/* Draws two rings that touch: a crescent whose tips are as sharp as can be. */
static void draw_crescent(Path *path, Random *random)
{
    (void)random;
    draw_ring(path, 0, 0, 0.9, false);
    draw_ring(path, 0.4, 0, 0.5, true);
}

/* Squares that have sides and corners in common. */
static void draw_tiles(Path *path, Random *random)
{
    for (int x = 0; x < 4; x++)
        for (int y = 0; y < 4; y++) {
            if (random_below(random, 2))
                continue;
            double corners[4][2] = {{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}};
            for (int i = 0; i < 4; i++)
                for (int k = 0; k < 2; k++)
                    corners[i][k] = 0.5 * corners[i][k] - 1;
            path_move(path, corners[0]);
            for (int i = 1; i < 4; i++)
                path_line(path, corners[i]);
            path_close(path);
        }
}

/* Tips and notches of a thousandth. */
static void draw_needles(Path *path, Random *random)
{
    (void)random;
    for (int i = 0; i < 24; i++) {
        double radius = i % 2 ? 1 : 0.3, angle = i / 2 * M_PI / 6 + (i % 2) * 0.0005;
        double p[2] = {radius * cos(angle), radius * sin(angle)};
        if (i == 0)
            path_move(path, p);
        else
            path_line(path, p);
    }
    path_close(path);
}

/* Many corners, each nearly straight on. */
static void draw_wheel(Path *path, Random *random)
{
    (void)random;
    for (int i = 0; i < 2000; i++) {
        double a = i * M_PI / 1000, radius = 0.8 + 0.1 * sin(25 * a);
        double p[2] = {radius * cos(a), radius * sin(a)};
        if (i == 0)
            path_move(path, p);
        else
            path_line(path, p);
    }
    path_close(path);
}

static void draw_cubics(Path *path, Random *random)
{
    double p[2], q[2], r[2];
    random_point(random, p);
    path_move(path, p);
    for (int i = 0; i < 2; i++) {
        random_point(random, p);
        random_point(random, q);
        random_point(random, r);
        path_cubic(path, p, q, r);
    }
    path_close(path);
}

/* Letters of a font, some of which touch. */
static void draw_letters(Path *path, Random *random)
{
    FoundFont            found;
    static unsigned char bytes[4 << 20];
    Lettering            lettering = {.size = 0.8, .spacing = -0.1, .align = ALIGN_CENTER};
    uint32_t             missing;
    (void)random;
    assert_int_equal(font_find(NULL, &found), FONT_FOUND);
    FILE *file = fopen(found.path, "rb");
    assert_non_null(file);
    Font font = {bytes, fread(bytes, 1, sizeof bytes, file), found.face};
    assert_true(letters_draw(path, &font, "R&g\n8Ww", &lettering, &missing));
    assert_int_equal(missing, 0);
    fclose(file);
    free(found.path);
}

static const Figure figures[] = {
    {"scribble", FILL_EVEN_ODD, draw_scribble, true},
    {"scribble of turns", FILL_NONZERO, draw_scribble, true},
    {"knot", FILL_EVEN_ODD, draw_knot, false},
    {"knot of turns", FILL_NONZERO, draw_knot, false},
    {"rings", FILL_NONZERO, draw_rings, false},
    {"rings in rings", FILL_EVEN_ODD, draw_rings, false},
    {"crescent", FILL_NONZERO, draw_crescent, false},
    {"tiles", FILL_NONZERO, draw_tiles, true},
    {"tiles in turn", FILL_EVEN_ODD, draw_tiles, true},
    {"needles", FILL_EVEN_ODD, draw_needles, true},
    {"wheel", FILL_EVEN_ODD, draw_wheel, true},
    {"letters", FILL_NONZERO, draw_letters, false},
    {"cubics", FILL_EVEN_ODD, draw_cubics, false},
};
enum { FIGURES = sizeof figures / sizeof *figures };

static OutlineShape *make_figure(Bench *bench, const Figure *figure, Truth *truth)
{
    Path   path = {.arena = &bench->arena, .tolerance = 1e-5};
    double at[2];
    figure->draw(&path, &bench->random);
    find_truth(truth, &path.curves, figure->rule);
    OutlineShape *shape = arena_new(&bench->arena, OutlineShape);
    if (outline_make(&shape->outline, &path.curves, figure->rule, &bench->arena, &bench->arena, at))
        fail_msg("%s: no outline at [%g, %g]", figure->name, at[0], at[1]);
    shape->instances = outline_instances(&shape->outline, &bench->arena, &bench->arena);
    return shape;
}

/* ---- distances on the host ---- */

typedef struct Judge {
    int  wrong_side, too_long, too_short;
    Tape tape;
} Judge;

static double look(const Judge *judge, Node root, const double p[2], NodeValue *values)
{
    tape_run_point(&judge->tape, (double[]){p[0], p[1], 0}, values);
    return values[root].v[0];
}

/* A distance is never more than the true one; where it is exact, also not less. */
static void judge_distance(Judge *judge, double found, double truth, double tolerance, bool exact)
{
    judge->wrong_side += fabs(truth) > tolerance && (found < 0) != (truth < 0);
    judge->too_long += fabs(found) > fabs(truth) + tolerance;
    judge->too_short += exact && fabs(found) < fabs(truth) - tolerance;
}

static double tolerance_of(const Figure *figure) { return figure->straight ? OF_LINES : OF_CURVES; }

static Judge judge_figure(Bench *bench, const Figure *figure, const Truth *truth, Node root,
                          bool by_cells)
{
    const Graph *graph  = bench->graph;
    Judge        judge  = {.tape = tape_new(graph, &root, 1, &bench->arena)};
    NodeValue   *values = arena_new_array(&bench->arena, NodeValue, graph->count);
    judge.tape.by_cells = by_cells;
    tape_run_frame(&judge.tape, &(NodeValue){{0}}, values);
    for (int i = 0; i < POINTS; i++) {
        double p[2]   = {random_between(&bench->random, -1.3, 1.3),
                         random_between(&bench->random, -1.3, 1.3)};
        double wanted = true_distance(truth, p), found = look(&judge, root, p, values);
        judge_distance(&judge, found, wanted, tolerance_of(figure), !by_cells);
    }
    return judge;
}

static void assert_right(const Judge *judge, const char *name)
{
    if (judge->wrong_side || judge->too_long || judge->too_short)
        fail_msg("%s: of %d points %d are on the wrong side, %d too far, %d too near", name, POINTS,
                 judge->wrong_side, judge->too_long, judge->too_short);
}

static void distances(void **state)
{
    static Truth truth;
    Bench       *bench = *state;
    for (int i = 0; i < FIGURES; i++) {
        bool          is_new;
        OutlineShape *shape = make_figure(bench, &figures[i], &truth);
        Node root = outline_distance(bench->graph, shape, 0, bench->point, &is_new, &bench->arena);
        for (int cells = 0; cells < 2; cells++) {
            Judge judge = judge_figure(bench, &figures[i], &truth, root, cells);
            assert_right(&judge, figures[i].name);
        }
    }
}

/* Cells hold what a margin asks for. */
static void margins(void **state)
{
    static Truth  truth;
    Bench        *bench  = *state;
    const double  margin = 0.3;
    bool          is_new;
    OutlineShape *shape = make_figure(bench, &figures[8], &truth);
    Node root = outline_distance(bench->graph, shape, margin, bench->point, &is_new, &bench->arena);
    Tape tape = tape_new(bench->graph, &root, 1, &bench->arena);
    NodeValue *values = arena_new_array(&bench->arena, NodeValue, bench->graph->count);
    tape.by_cells     = true;
    for (int i = 0; i < POINTS; i++) {
        double p[3]   = {random_between(&bench->random, -1.3, 1.3),
                         random_between(&bench->random, -1.3, 1.3), 0};
        double wanted = true_distance(&truth, p);
        tape_run_frame(&tape, &(NodeValue){{0}}, values);
        tape_run_point(&tape, p, values);
        if (fabs(wanted) < margin)
            assert_true(fabs(values[root].v[0] - wanted) < OF_LINES);
    }
}

/* ---- what breaks the rules is found ---- */

static int count_wrong(Bench *bench, const Figure *figure, const Truth *truth, Node root)
{
    Judge judge = judge_figure(bench, figure, truth, root, true);
    return judge.wrong_side + judge.too_long;
}

static void broken_corners_are_found(void **state)
{
    static Truth  truth;
    Bench        *bench = *state;
    bool          is_new;
    const Figure *figure = &figures[9];
    OutlineShape *shape  = make_figure(bench, figure, &truth);
    for (uint32_t i = 0; i < shape->instances.count; i++)
        for (int k = 0; k < 2; k++)
            shape->instances
                .numbers[i * shape->instances.columns + COLUMN_FIRST_CORNER + (uint32_t)k] = 0;
    Node root = outline_distance(bench->graph, shape, 0, bench->point, &is_new, &bench->arena);
    assert_true(count_wrong(bench, figure, &truth, root) > 0);
}

static void broken_clearances_are_found(void **state)
{
    static Truth  truth;
    Bench        *bench = *state;
    bool          is_new;
    const Figure *figure = &figures[10];
    OutlineShape *shape  = make_figure(bench, figure, &truth);
    Node  root = outline_distance(bench->graph, shape, 0, bench->point, &is_new, &bench->arena);
    Grid *grid = &bench->graph->instances->tables.items[0].grid;
    for (size_t i = 0; i < (size_t)grid->cells[0] * grid->cells[1]; i++)
        grid->clearance[i] = fabsf(grid->clearance[i]);
    assert_true(count_wrong(bench, figure, &truth, root) > 0);
    for (size_t i = 0; i < (size_t)grid->cells[0] * grid->cells[1]; i++)
        grid->clearance[i] *= 1.3F;
    assert_true(count_wrong(bench, figure, &truth, root) > 0);
}

/* ---- distances on the device ---- */

enum { DEVICE_POINTS = 1024 };

typedef struct Fixture {
    KrsRenderer *renderer;
    KrsScene    *scene;
    float        points[DEVICE_POINTS][3], found[DEVICE_POINTS];
} Fixture;

static void sample_figure(Fixture *fixture, Bench *bench, OutlineShape *shape)
{
    static const char text[] = "show sphere(1);";
    KrsState         *state;
    KrsRendering     *rendering;
    bool              is_new;
    assert_int_equal(krs_compile_text(text, strlen(text), "outline.krs", NULL, &fixture->scene),
                     KRS_OK);
    Graph     *graph = (Graph *)(uintptr_t)fixture->scene->graph;
    Node       root  = outline_distance(graph, shape, 0, graph_leaf(graph, OP_POINT), &is_new,
                                        &bench->arena);
    TableSizes sizes = tables_measure(graph->instances, NULL);
    fixture->scene->program.table_rows                      = sizes.rows;
    fixture->scene->program.table_cells                     = sizes.cells;
    surface_roots(&fixture->scene->roots, 0)[ROOT_DISTANCE] = root;
    assert_int_equal(krs_state_new(fixture->scene, &state), KRS_OK);
    assert_int_equal(
        krs_rendering_new(fixture->renderer, fixture->scene, KRS_FOR_PICTURES, &rendering), KRS_OK);
    assert_int_equal(krs_device_distance(rendering, state, (const float(*)[3])fixture->points,
                                         DEVICE_POINTS, fixture->found),
                     KRS_OK);
    krs_rendering_free(rendering);
    krs_state_free(state);
}

/* Single precision: a thousandth of a thousandth, and points beside a thin part are not counted. */
static void kernels(void **state)
{
    static Truth       truth;
    static Fixture     fixture;
    static const int   shown[] = {2, 6, 9, 10, 11};
    Bench             *bench   = *state;
    KrsRendererOptions options = {.device = tested_device()};
    assert_int_equal(krs_renderer_new(&options, &fixture.renderer), KRS_OK);
    for (int f = 0; f < 5; f++) {
        const Figure *figure = &figures[shown[f]];
        OutlineShape *shape  = make_figure(bench, figure, &truth);
        Judge         judge  = {0};
        for (int i = 0; i < DEVICE_POINTS; i++)
            for (int k = 0; k < 3; k++)
                fixture.points[i][k] = k < 2 ? (float)random_between(&bench->random, -1.3, 1.3) : 0;
        sample_figure(&fixture, bench, shape);
        for (int i = 0; i < DEVICE_POINTS; i++) {
            double p[2]   = {fixture.points[i][0], fixture.points[i][1]};
            double wanted = true_distance(&truth, p);
            judge_distance(&judge, fixture.found[i], wanted, tolerance_of(figure) + 5e-6, false);
        }
        assert_right(&judge, figure->name);
        krs_scene_free(fixture.scene);
    }
    krs_renderer_free(fixture.renderer);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(distances, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(margins, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(broken_corners_are_found, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(broken_clearances_are_found, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(kernels, bench_start, bench_stop),
    };
    return cmocka_run_group_tests_name("outlines", tests, NULL, NULL);
}
