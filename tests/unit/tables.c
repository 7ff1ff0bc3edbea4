/*
 * tables.c: what shaders read of tables (compiler/scene/tables.h) is what the compiler has: rows, cells, lists
 * and headers are read back in the way of shaders.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/base/far.h"
#include "compiler/graph/instances/grid_build.h"
#include "compiler/scene/tables.h"
#include "tests/support/bench.h"

/* Tables of so many rows and columns, the last one without bounds. */
static const uint32_t shapes[][2] = {{40, 3}, {1, 4}, {777, 9}, {25, 64}, {5, 0}, {17, 1}};
enum { TABLES = sizeof shapes / sizeof *shapes };

static void make_table(Bench *bench, InstanceTable *table, uint32_t rows, uint32_t columns,
                       bool infinite)
{
    Box *boxes = arena_new_array(&bench->arena, Box, rows);
    *table     = (InstanceTable){.rows = rows, .columns = columns};
    for (uint32_t r = 0; r < rows; r++)
        for (int k = 0; k < 3; k++) {
            double at        = random_between(&bench->random, -7, 9);
            boxes[r].axis[k] = (Range){at, infinite && r == 0 ? HUGE_VAL : at + 1};
        }
    table->numbers = arena_new_array(&bench->arena, double, (size_t)rows *columns + 1);
    for (uint32_t i = 0; i < rows * columns; i++)
        table->numbers[i] = random_between(&bench->random, -1e3, 1e3);
    grid_build(&table->grid, boxes, rows, 0.1, 0, 1, &bench->arena, &bench->arena);
    table->cells = table->grid;
}

typedef struct Packed {
    Instances instances;
    float (*rows)[4];
    uint32_t (*cells)[2];
    TableSizes sizes;
} Packed;

/* Texels behind the arrays must stay. */
#define UNTOUCHED 0xabcdef01u

static Packed pack(Bench *bench)
{
    Packed packed = {.instances = {.arena = &bench->arena}};
    for (int t = 0; t < TABLES; t++) {
        InstanceTable table;
        make_table(bench, &table, shapes[t][0], shapes[t][1], t == TABLES - 1);
        array_push(&bench->arena, &packed.instances.tables, table);
    }
    packed.sizes = tables_measure(&packed.instances, NULL);
    packed.rows  = arena_alloc(&bench->arena, packed.sizes.rows + 1, sizeof *packed.rows);
    packed.cells = arena_alloc(&bench->arena, packed.sizes.cells + 1, sizeof *packed.cells);
    memset(packed.rows, 0xff, (packed.sizes.rows + 1) * sizeof *packed.rows);
    for (size_t i = 0; i <= packed.sizes.cells; i++)
        packed.cells[i][0] = packed.cells[i][1] = UNTOUCHED;
    tables_pack(&packed.instances, NULL, NULL, false, packed.rows, packed.cells);
    return packed;
}

static float float_of(uint32_t bits)
{
    float number;
    memcpy(&number, &bits, sizeof number);
    return number;
}

static void numbers_are_read_back(void **state)
{
    Packed packed = pack(*state);
    size_t needed = 0;
    for (int t = 0; t < TABLES; t++) {
        const InstanceTable *table = &packed.instances.tables.items[t];
        const Grid          *grid  = &table->grid;
        uint32_t row_0 = packed.cells[GRID_HEADER * t + 7][0], texels = (table->columns + 3) / 4;
        uint32_t copy_0 = packed.cells[GRID_HEADER * t + 7][1];
        uint32_t listed = grid->first[grid->cells[0] * grid->cells[1] * grid->cells[2]];
        for (uint32_t r = 0; r < table->rows; r++)
            for (uint32_t c = 0; c < table->columns; c++)
                assert_true(packed.rows[row_0 + r * texels + c / 4][c % 4] ==
                            (float)table->numbers[r * table->columns + c]);
        assert_int_equal(copy_0, row_0 + table->rows * texels);
        for (uint32_t i = 0; i < listed; i++)
            assert_memory_equal(packed.rows[copy_0 + i * texels],
                                packed.rows[row_0 + grid->instances[i] * texels],
                                texels * sizeof *packed.rows);
        needed += ((size_t)table->rows + listed) * texels;
    }
    assert_int_equal(packed.sizes.rows, needed);
    assert_true(isnan(packed.rows[packed.sizes.rows][0]));
    assert_true(isnan(packed.rows[packed.sizes.rows][3]));
}

static void grids_are_read_back(void **state)
{
    Packed packed = pack(*state);
    size_t next   = (size_t)GRID_HEADER * TABLES;
    for (int t = 0; t < TABLES; t++) {
        const Grid *grid       = &packed.instances.tables.items[t].cells;
        uint32_t(*header)[2]   = packed.cells + GRID_HEADER * t;
        const uint32_t cells[] = {header[2][0], header[2][1], header[3][0]};
        uint32_t       first   = header[3][1];
        size_t         count = (size_t)cells[0] * cells[1] * cells[2], lists = first + count + 1;
        assert_memory_equal(cells, grid->cells, sizeof cells);
        assert_int_equal(first, next);
        for (size_t c = 0; c < count; c++) {
            uint32_t from = packed.cells[first + c][0], to = packed.cells[first + c + 1][0];
            assert_true(float_of(packed.cells[first + c][1]) == grid->clearance[c]);
            assert_int_equal(to - from, grid->first[c + 1] - grid->first[c]);
            for (uint32_t i = from; i < to; i++)
                assert_int_equal(packed.cells[lists + i / 2][i % 2], grid->instances[i]);
        }
        next = lists + (grid->first[count] + 1) / 2;
    }
    assert_int_equal(packed.sizes.cells, next);
    assert_int_equal(packed.cells[next][0], UNTOUCHED);
    for (size_t i = 0; i < next; i++)
        assert_true(packed.cells[i][0] != UNTOUCHED && packed.cells[i][1] != UNTOUCHED);
}

static void places_of_grids_are_read_back(void **state)
{
    Packed packed = pack(*state);
    for (int t = 0; t < TABLES; t++) {
        const Grid *grid     = &packed.instances.tables.items[t].cells;
        uint32_t(*header)[2] = packed.cells + GRID_HEADER * t;
        const float low[]    = {float_of(header[0][0]), float_of(header[0][1]),
                                float_of(header[1][0])};
        const float center[] = {float_of(header[4][0]), float_of(header[4][1]),
                                float_of(header[5][0])};
        const float half[]   = {float_of(header[5][1]), float_of(header[6][0]),
                                float_of(header[6][1])};
        bool        infinite = t == TABLES - 1;
        assert_true(float_of(header[1][1]) == (float)(infinite ? 0 : 1 / grid->size));
        for (int k = 0; k < 3; k++) {
            assert_true(low[k] == grid->low[k]);
            if (infinite) {
                assert_true(center[k] == 0 && half[k] == (float)NOWHERE);
                continue;
            }
            Range inner = grid->inner.axis[k];
            assert_true((double)center[k] - half[k] <= inner.low);
            assert_true((double)center[k] + half[k] >= inner.high);
            assert_true(2.0 * half[k] - (inner.high - inner.low) < 1e-5);
            assert_true((double)center[k] - half[k] > grid->low[k]);
        }
    }
}

static void no_tables(void **state)
{
    (void)state;
    Instances  none  = {0};
    TableSizes sizes = tables_measure(NULL, NULL), empty = tables_measure(&none, NULL);
    assert_true(sizes.rows == 0 && sizes.cells == 0 && empty.rows == 0 && empty.cells == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(numbers_are_read_back, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(grids_are_read_back, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(places_of_grids_are_read_back, bench_start, bench_stop),
        cmocka_unit_test(no_tables),
    };
    return cmocka_run_group_tests_name("tables for shaders", tests, NULL, NULL);
}
