/*
 * sky_table.c: what shaders read of a sky that is a picture: directions are chosen by
 * their brightness, and means are means.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "runtime/tracer/sky_table.h"

typedef struct Table {
    KrsSkyMap map;
    float (*texels)[3], (*rows)[4];
    double irradiance;
} Table;

static Table make_table(uint32_t width, uint32_t height, float (*radiance)(uint32_t x, uint32_t y))
{
    Table table  = {.map = {width, height, 1, NULL}};
    table.texels = calloc((size_t)width * height, sizeof *table.texels);
    for (uint32_t i = 0; i < width * height; i++)
        for (int k = 0; k < 3; k++)
            table.texels[i][k] = radiance(i % width, i / width);
    table.map.texels = (const float(*)[3])table.texels;
    table.rows       = calloc(sky_table_rows(&table.map), sizeof *table.rows);
    table.irradiance = sky_table_fill(&table.map, table.rows);
    return table;
}

static void free_table(Table *table)
{
    free(table->texels);
    free(table->rows);
}

static float spotted(uint32_t x, uint32_t y)
{
    return (x * 7 + y * 13) % 61 == 0 ? 100 : (float)(x % 3);
}
static float even(uint32_t x, uint32_t y) { return x < 1000 && y < 1000 ? 2 : 0; }
static float black(uint32_t x, uint32_t y) { return x > 1000 && y > 1000 ? 2 : 0; }

/* Returns the solid angle between two latitudes, in rows from the top, as an integral by small
   steps. */
static double angle_of(const KrsSkyMap *map, double from, double to)
{
    enum { STEPS = 200 };
    double sum = 0;
    for (int i = 0; i < STEPS; i++)
        sum += sin(M_PI * (from + (to - from) * (i + 0.5) / STEPS) / map->height);
    return sum * M_PI * (to - from) / map->height / STEPS * 2 * M_PI / map->width;
}

/* Returns how likely the descent through the sums ends at a cell: from the coarsest on, the part of
   it that its quarter has. */
static double chance_of(const Table *table, uint32_t x, uint32_t y)
{
    const uint32_t w = table->map.width, h = table->map.height + 1;
    const float(*sums)[4] = (const float(*)[4])table->rows + SKY_ITSELF + w * (h - 1);
    double   chance       = 1;
    uint32_t side         = 1;
    while (side < w || side < h)
        side *= 2;
    for (; side > 1; side /= 2) {
        const uint32_t across = (w + side - 1) / side, down = (h + side - 1) / side;
        const float   *four    = sums[y / side * across + x / side];
        const uint32_t quarter = x / (side / 2) % 2 + 2 * (y / (side / 2) % 2);
        chance *= (double)four[quarter] /
                  ((double)four[0] + (double)four[1] + (double)four[2] + (double)four[3]);
        sums += across * down;
    }
    return chance;
}

/* The mean of what is bilinear between four texels, by points of the cell. */
static double mean_of_cell(const Table *table, uint32_t x, uint32_t y)
{
    const uint32_t w = table->map.width, last = table->map.height - 1;
    const uint32_t above = y > 0 ? y - 1 : 0, below = y > last ? last : y, left = (x + w - 1) % w;
    double         sum = 0;
    for (int i = 0; i < 64; i++) {
        const double a = (i % 8 + 0.5) / 8, b = (i / 8 + 0.5) / 8;
        sum += (1 - b) * ((1 - a) * (double)table->texels[above * w + left][0] +
                          a * (double)table->texels[above * w + x][0]) +
               b * ((1 - a) * (double)table->texels[below * w + left][0] +
                    a * (double)table->texels[below * w + x][0]);
    }
    return sum / 64;
}

/* Cells are as likely as they are bright and large, and one of them is chosen. */
static void chances_add_up(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{64, 32}, {50, 21}, {1, 1}, {7, 40}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        const uint32_t w = sizes[i][0], h = sizes[i][1];
        Table          table = make_table(w, h, spotted);
        double         sum   = 0;
        for (uint32_t y = 0; y <= h; y++)
            for (uint32_t x = 0; x < w; x++) {
                const double size  = angle_of(&table.map, fmax(y - 0.5, 0), fmin(y + 0.5, h));
                const double right = mean_of_cell(&table, x, y) * size / 4 / table.irradiance;
                assert_true(fabs(chance_of(&table, x, y) - right) <= 1e-4 * right);
                sum += right;
            }
        assert_true(fabs(sum - 1) < 1e-4);
        free_table(&table);
    }
}

static void means_of_an_even_sky_are_even(void **state)
{
    (void)state;
    Table table = make_table(16, 8, even);
    for (uint32_t i = 0; i < SKY_ITSELF; i++)
        assert_true(fabsf(table.rows[i][1] - 2) < 1e-5F);
    assert_true(fabs(table.irradiance - 2 * M_PI) < 1e-5); /* of any half */
    free_table(&table);
}

/* The mean around a normal, over the texels of the sky. */
static double mean_around(const Table *table, uint32_t column, uint32_t line)
{
    const double latitude  = M_PI * (line + 0.5) / (SKY_AROUND_WIDTH / 2);
    const double longitude = 2 * M_PI * (column + 0.5) / SKY_AROUND_WIDTH;
    double       sum = 0, weights = 0;
    for (uint32_t y = 0; y < table->map.height; y++)
        for (uint32_t x = 0; x < table->map.width; x++) {
            const double other  = M_PI * (y + 0.5) / table->map.height;
            const double across = 2 * M_PI * (x + 0.5) / table->map.width - longitude;
            const double cosine = cos(latitude) * cos(other) +
                                  sin(latitude) * sin(other) * cos(across);
            const double weight = fmax(cosine, 0) * angle_of(&table->map, y, y + 1);
            sum += weight * (double)table->texels[y * table->map.width + x][0];
            weights += weight;
        }
    return sum / weights;
}

static void means_around_normals_are_means(void **state)
{
    (void)state;
    Table  table = make_table(128, 64, spotted);
    double worst = 0;
    for (uint32_t i = 0; i < SKY_AROUND_WIDTH * SKY_AROUND_WIDTH / 2; i += 7) {
        double right = mean_around(&table, i % SKY_AROUND_WIDTH, i / SKY_AROUND_WIDTH);
        worst        = fmax(worst, fabs((double)table.rows[i][0] / right - 1));
    }
    print_message("# means around normals are off by %.4f\n", worst);
    assert_true(worst < 0.02);
    free_table(&table);
}

static void a_black_sky_is_black(void **state)
{
    (void)state;
    Table table = make_table(16, 8, black);
    assert_true(table.irradiance == 0);
    for (uint32_t i = 0; i < sky_table_rows(&table.map); i++)
        for (int k = 0; k < 4; k++)
            assert_true(table.rows[i][k] == 0);
    free_table(&table);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chances_add_up),
        cmocka_unit_test(means_of_an_even_sky_are_even),
        cmocka_unit_test(means_around_normals_are_means),
        cmocka_unit_test(a_black_sky_is_black),
    };
    return cmocka_run_group_tests_name("sky table", tests, NULL, NULL);
}
