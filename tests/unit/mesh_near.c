/*
 * mesh_near.c: triangles that are found to be near to a mesh are, by dense points of them, and what is planted between is
 * found.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/base/vec.h"
#include "mesh/simplify/near.h"
#include "tests/support/random.h"

enum { SIDE = 24, ROWS = SIDE + 1, BELOW = ROWS * ROWS };

/* A sheet of squares, each cut in two, with heights, and a closed bottom below. */
typedef struct Sheet {
    Memory    memory;
    Arena     arena;
    double    vertices[2 * BELOW][3];
    uint32_t  triangles[8 * SIDE * SIDE][3];
    size_t    count;
    NearMesh  mesh;
    NearQuery query;
} Sheet;

static void add_triangle(Sheet *sheet, size_t a, size_t b, size_t c)
{
    memcpy(sheet->triangles[sheet->count++],
           (const uint32_t[3]){(uint32_t)a, (uint32_t)b, (uint32_t)c}, sizeof *sheet->triangles);
}

static void add_square(Sheet *sheet, size_t a, size_t b, size_t c, size_t d)
{
    add_triangle(sheet, a, b, c);
    add_triangle(sheet, a, c, d);
}

static size_t at(size_t x, size_t y) { return y * ROWS + x; }

static void add_sides(Sheet *sheet)
{
    for (size_t i = 0; i < SIDE; i++) {
        size_t edges[4][2] = {{at(i + 1, 0), at(i, 0)},
                              {at(i, SIDE), at(i + 1, SIDE)},
                              {at(0, i), at(0, i + 1)},
                              {at(SIDE, i + 1), at(SIDE, i)}};
        for (int k = 0; k < 4; k++)
            add_square(sheet, edges[k][0], edges[k][1], edges[k][1] + BELOW, edges[k][0] + BELOW);
    }
}

/* Heights are set; squares have sides of 1. */
static void build_sheet(Sheet *sheet, double height)
{
    for (size_t y = 0; y < ROWS; y++)
        for (size_t x = 0; x < ROWS; x++)
            for (size_t k = 0; k < 2; k++) {
                double *vertex = sheet->vertices[at(x, y) + k * BELOW];
                vertex[0]      = (double)x;
                vertex[1]      = (double)y;
                if (k == 1)
                    vertex[2] = -height;
            }
    for (size_t y = 0; y < SIDE; y++)
        for (size_t x = 0; x < SIDE; x++) {
            size_t a = at(x, y), b = at(x + 1, y), c = at(x + 1, y + 1), d = at(x, y + 1);
            add_square(sheet, a, b, c, d);
            add_square(sheet, d + BELOW, c + BELOW, b + BELOW, a + BELOW);
        }
    add_sides(sheet);
    sheet->arena.memory = &sheet->memory;
    near_mesh_new(&sheet->mesh, (const double(*)[3])sheet->vertices,
                  (const uint32_t(*)[3])sheet->triangles, sheet->count, &sheet->arena);
    for (size_t i = 0; i < sheet->count; i++)
        for (int c = 0; c < 3; c++)
            assert_int_not_equal(sheet->mesh.beyond[i][c], NO_TRIANGLE);
}

static Sheet *sheet_new(void)
{
    Sheet *sheet = calloc(1, sizeof *sheet);
    assert_non_null(sheet);
    return sheet;
}

static void sheet_free(Sheet *sheet)
{
    arena_free(&sheet->arena);
    free(sheet);
}

/* With the triangles around its corners to begin with. */
static bool is_found_near(Sheet *sheet, const size_t corners[3], double lift, double error)
{
    const TriangleEdges *edges = &sheet->mesh.edges;
    double               places[3][3];
    uint32_t             starts[64];
    size_t               count = 0;
    for (int c = 0; c < 3; c++) {
        memcpy(places[c], sheet->vertices[corners[c]], sizeof places[c]);
        places[c][2] += lift;
        for (uint32_t i = edges->begins[corners[c]]; i < edges->begins[corners[c] + 1]; i++)
            starts[count++] = edges->items[i].triangle;
    }
    return is_near_mesh(&sheet->mesh, (const double(*)[3])places, error, starts, count,
                        &sheet->query);
}

static void flat_sheets_are_near(void **state)
{
    (void)state;
    Sheet       *sheet      = sheet_new();
    const size_t corners[3] = {at(0, 0), at(SIDE, 0), at(3, SIDE)};
    const size_t back[3]    = {at(0, 0), at(3, SIDE), at(SIDE, 0)};
    build_sheet(sheet, 5);
    assert_true(is_found_near(sheet, corners, 0, 0.01));
    assert_true(sheet->query.faced_count > SIDE * SIDE / 2); /* those that it covers */
    assert_true(is_found_near(sheet, back, 0, 0.01));
    assert_true(is_found_near(sheet, corners, 0.009, 0.01));
    assert_false(is_found_near(sheet, corners, 0.011, 0.01));
    assert_false(is_found_near(sheet, corners, -0.011, 0.01));
    assert_true(is_found_near(sheet, corners, -4.995, 0.01));
    sheet_free(sheet);
}

/* A single vertex in the middle, or the sheet's border within the triangle. */
static void what_is_planted_is_found(void **state)
{
    (void)state;
    const size_t corners[3] = {at(0, 0), at(SIDE, 0), at(3, SIDE)}, inside = at(7, 9);
    for (int turn = 0; turn < 2; turn++) {
        Sheet *sheet               = sheet_new();
        sheet->vertices[inside][2] = turn == 0 ? 0.2 : -4;
        build_sheet(sheet, 5);
        /* A cone: beside it the sheet is flat, so the triangle is nearer to its sides than it is high. */
        assert_true(is_found_near(sheet, corners, 0, turn == 0 ? 0.21 : 4.1));
        assert_false(is_found_near(sheet, corners, 0, turn == 0 ? 0.1 : 0.2));
        sheet_free(sheet);
    }
    Sheet *sheet = sheet_new();
    build_sheet(sheet, 5);
    sheet->vertices[at(SIDE, 0)][0] = SIDE + 3;
    assert_false(is_found_near(sheet, corners, 0, 0.01));
    sheet_free(sheet);
}

static double farthest_of(const NearMesh *mesh, const double corners[3][3], double error)
{
    enum { STEPS = 24 };
    uint32_t last = 0;
    double   most = 0;
    for (int i = 0; i <= STEPS; i++)
        for (int k = 0; i + k <= STEPS; k++) {
            double point[3] = {0, 0, 0}, factor = 0.9;
            add_scaled3(point, point, (double)i / STEPS, corners[0]);
            add_scaled3(point, point, (double)k / STEPS, corners[1]);
            add_scaled3(point, point, (double)(STEPS - i - k) / STEPS, corners[2]);
            while (!bvh_is_near(&mesh->bvh, point, factor * error, &last))
                factor += 0.1 + 1e-9;
            most = fmax(most, factor);
        }
    return most;
}

/* On rough sheets, some of which are thin or folded. */
static void random_triangles_are_judged(void **state)
{
    (void)state;
    Random random   = {2026};
    size_t accepted = 0, refused = 0;
    for (int turn = 0; turn < 30; turn++) {
        Sheet *sheet = sheet_new();
        double rough = exp(random_between(&random, -4, 0.7));
        for (size_t i = 0; i < 2 * (size_t)BELOW; i++)
            sheet->vertices[i][2] = random_between(&random, -rough, rough);
        build_sheet(sheet, random_between(&random, 2 * rough, 8));
        for (int i = 0; i < 60; i++) {
            size_t corners[3];
            double places[3][3], error = rough * random_between(&random, 0.3, 3);
            for (int c = 0; c < 3; c++) {
                corners[c] = (size_t)random_below(&random, BELOW);
                memcpy(places[c], sheet->vertices[corners[c]], sizeof places[c]);
            }
            bool   near     = is_found_near(sheet, corners, 0, error);
            double farthest = farthest_of(&sheet->mesh, (const double(*)[3])places, error);
            if (near)
                assert_true(farthest < 1.01);
            accepted += near;
            refused += !near;
        }
        sheet_free(sheet);
    }
    assert_true(accepted > 300 && refused > 300);
}

/* Beyond a border of the sheet, where walls go down, or stand on it as the sides of a trough. */
static void triangles_beyond_rims_are_judged(void **state)
{
    (void)state;
    Random random   = {77};
    size_t accepted = 0, refused = 0;
    for (int turn = 0; turn < 20; turn++) {
        Sheet *sheet = sheet_new();
        double rough = random_between(&random, 0.01, 0.2);
        for (size_t i = 0; i < 2 * (size_t)BELOW; i++)
            sheet->vertices[i][2] = random_between(&random, -rough, rough);
        if (turn % 2)
            for (size_t i = 0; i <= SIDE; i++)
                sheet->vertices[at(i, 0)][2] = 5;
        build_sheet(sheet, 8);
        for (int i = 0; i < 60; i++) {
            double   places[3][3], error = random_between(&random, 0.3, 4) * rough;
            double   beyond     = random_between(&random, 0, 2) * error;
            size_t   row        = (size_t)(turn % 2);
            size_t   corners[3] = {at((size_t)random_below(&random, SIDE / 2), row),
                                   at(SIDE / 2 + (size_t)random_below(&random, SIDE / 2), row),
                                   at((size_t)random_below(&random, SIDE), SIDE / 2)};
            uint32_t start      = 0;
            for (int c = 0; c < 3; c++)
                memcpy(places[c], sheet->vertices[corners[c]], sizeof places[c]);
            places[0][1] -= beyond;
            places[1][1] -= beyond;
            start       = sheet->mesh.edges.items[sheet->mesh.edges.begins[corners[2]]].triangle;
            bool   near = is_near_mesh(&sheet->mesh, (const double(*)[3])places, error, &start, 1,
                                       &sheet->query);
            double farthest = farthest_of(&sheet->mesh, (const double(*)[3])places, error);
            if (near)
                assert_true(farthest < 1.01);
            else
                assert_true(farthest > 0.89);
            accepted += near;
            refused += !near;
        }
        sheet_free(sheet);
    }
    assert_true(accepted > 300 && refused > 300);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flat_sheets_are_near),
        cmocka_unit_test(what_is_planted_is_found),
        cmocka_unit_test(random_triangles_are_judged),
        cmocka_unit_test(triangles_beyond_rims_are_judged),
    };
    return cmocka_run_group_tests_name("near meshes", tests, NULL, NULL);
}
