/*
 * grid.c: runtime/shaders/grid.glsl finds the cell of every number, however badly a device divides
 * within Vulkan's rules.  The oracle is the division of integers.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

#include <cmocka.h>

#include "tests/support/random.h"

typedef struct uvec2 {
    uint x, y;
} uvec2;
#define uvec2(x, y) ((uvec2){(x), (y)})
#define uint(x)     ((uint)(x))
#define int(x) ((int)(x))
#define float(x) ((float)(x))
#include "runtime/shaders/grid.glsl"
#undef uvec2
#undef uint
#undef int
#undef float

#define MAX_ROWS (1u << 20)
#define WIDEST   16384u /* a picture's side */

/* As far as a quotient of two numbers, each rounded to a float, may be from the true one. */
static float worst_quotient(uint number, uint across, int side)
{
    const double rounded = 1 + ldexp(1, -24), divided = 1 + 2.5 * ldexp(1, -23);
    double       error = rounded * rounded * divided - 1;
    double       about = (double)number / across * (1 + side * error);
    return nextafterf((float)about, side < 0 ? 0 : INFINITY);
}

/* Numbers of a row's first cells and last ones, of rows from the first to the last. */
static size_t count_wrong(uint across, uvec2 (*find)(uint, uint, float))
{
    Random random = {across};
    size_t wrong  = 0;
    for (int i = 0; i < 4000; i++) {
        double   rows      = fmin(MAX_ROWS, floor(0x7fffffff / across));
        uint     row       = (uint)(rows * (i < 2000 ? i / 2000.0 : random_between(&random, 0, 1)));
        uint64_t first     = (uint64_t)row * across;
        uint64_t numbers[] = {first, first + 1, first + across / 2, first + across - 1};
        for (int k = 0; k < 4; k++)
            for (int side = -1; side <= 1 && numbers[k] < 0x7fffffff; side++) {
                uint  number = (uint)numbers[k];
                uvec2 cell   = find(number, across, worst_quotient(number, across, side));
                wrong += cell.x != number % across || cell.y != number / across;
            }
    }
    return wrong;
}

/* Widths from 1 to the widest. */
static size_t count_wrong_of_all(uvec2 (*find)(uint, uint, float))
{
    size_t wrong = 0;
    for (uint across = 1; across <= WIDEST; across += 1 + across / 16)
        wrong += count_wrong(across, find);
    return wrong + count_wrong(WIDEST, find) + count_wrong(2047, find) + count_wrong(2048, find);
}

static void every_cell_is_found(void **state)
{
    (void)state;
    assert_int_equal(count_wrong_of_all(cell_near), 0);
}

static void divided_exactly_cells_are_found(void **state)
{
    (void)state;
    for (uint across = 1; across <= WIDEST; across = 3 * across / 2 + 1)
        for (uint number = 0; number < 1u << 24; number += 1 + across / 7) {
            uvec2 cell = find_cell(number, across);
            assert_true(cell.x == number % across && cell.y == number / across);
        }
}

/* What was enough where division is rounded correctly. */
static uvec2 uncorrected(uint number, uint across, float about)
{
    uint row = (uint)(about + 0.5f / (float)across);
    return (uvec2){number - row * across, row};
}

static void bad_division_shows(void **state)
{
    (void)state;
    assert_true(count_wrong_of_all(uncorrected) > 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_cell_is_found),
        cmocka_unit_test(divided_exactly_cells_are_found),
        cmocka_unit_test(bad_division_shows),
    };
    return cmocka_run_group_tests_name("grid", tests, NULL, NULL);
}
