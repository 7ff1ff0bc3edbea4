/*
 * albedo.c: the table of how much light microfacets and sheen reflect, held against integrals in
 * double precision.
 *
 * The table is made of means over visible normals (tools/albedo_tables.c).  Here all normals count,
 * by the density of GGX as Walter et al. (2007) write it, with Smith's masking and shadowing; sheen
 * is integrated over the hemisphere of light.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "runtime/tracer/albedos.h"
#include "tests/oracle/brute.h"

enum { MIRRORED, AT_THE_EDGE, SHEEN };
static const char *const names[] = {"mirrored", "mirrored at the edge", "sheen"};

#define RIGHT 1e-3     /* what may be wrong in the table, of 1 */
enum { POINTS = 128 }; /* along each side of the domain of an integral */

static double square(double x) { return x * x; }

/* Returns how many times as much of the microfacets is hidden from a direction as is seen. */
static double find_hidden(Vec direction, double alpha)
{
    double tangent_squared = (1 - square(direction.z)) / square(direction.z);
    return (sqrt(1 + square(alpha) * tangent_squared) - 1) / 2;
}

/* Adds the light that a microfacet mirrors, over the probability of its normal: density times
   cosine. */
static void add_facet(Vec eye, Vec normal, double alpha, double weight, double sums[3])
{
    double facing = vec_dot(eye, normal);
    Vec    light  = vec_sub(vec_scale(2 * facing, normal), eye);
    if (facing <= 0 || light.z <= 0)
        return;
    double seen = 1 / (1 + find_hidden(eye, alpha) + find_hidden(light, alpha));
    double part = weight * seen * facing / (eye.z * normal.z);
    sums[MIRRORED] += part / square(POINTS);
    sums[AT_THE_EDGE] += part * pow(1 - facing, 5) / square(POINTS);
}

/* Adds the density of Estevez and Kulla (2017), with the visibility of Neubelt and Pettineo. */
static void add_fuzz(Vec eye, Vec light, double alpha, double sums[3])
{
    Vec    halfway = vec_unit(vec_add(eye, light));
    double density = (2 + 1 / alpha) * pow(1 - square(halfway.z), 0.5 / alpha) / (2 * M_PI);
    double part    = density * light.z / (4 * (light.z + eye.z - light.z * eye.z));
    sums[SHEEN] += 2 * M_PI * part / square(POINTS);
}

/* All three, for a cosine and a row of the table; sheen is at least 0.3 rough. */
static void integrate(double cosine, double roughness, double sums[3])
{
    const Vec    eye   = {sqrt(1 - square(cosine)), 0, cosine};
    const double alpha = fmax(square(roughness), 1e-3), fuzz = square(0.3 + 0.7 * roughness);
    sums[MIRRORED] = sums[AT_THE_EDGE] = sums[SHEEN] = 0;
    for (int i = 0; i < POINTS; i++)
        for (int k = 0; k < POINTS; k++) {
            double turn = M_PI * (i + 0.5) / POINTS, part = (k + 0.5) / POINTS; /* it is even */
            /* The share of normals that are steeper is part^6: steep ones count much, seen flatly. */
            double steeper = pow(part, 6), weight = 6 * pow(part, 5);
            double tangent = alpha * sqrt((1 - steeper) / steeper);
            double z = 1 / sqrt(1 + square(tangent)), ring = sqrt(1 - square(part));
            add_facet(eye, vec(tangent * z * cos(turn), tangent * z * sin(turn), z), alpha, weight,
                      sums);
            add_fuzz(eye, vec(ring * cos(turn), ring * sin(turn), part), fuzz, sums);
        }
}

static size_t compare(const float found[3], double cosine, double roughness, double permitted)
{
    double right[3];
    size_t wrong = 0;
    integrate(cosine, roughness, right);
    for (int i = 0; i < 3; i++) {
        wrong += !(fabs(found[i] - right[i]) <= permitted * fmax(right[i], 1));
        if (!(fabs(found[i] - right[i]) <= permitted * fmax(right[i], 1)))
            print_message("# %s, cosine %.4f, roughness %.3f: %.5f instead of %.5f\n", names[i],
                          cosine, roughness, found[i], right[i]);
    }
    return wrong;
}

static void the_table_is_right(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (int row = 0; row < (int)ALBEDO_SIDE; row++)
        for (int column = 0; column < (int)ALBEDO_SIDE; column++) {
            double cosine = square(column / (ALBEDO_SIDE - 1.0));
            wrong += compare(albedos[row * (int)ALBEDO_SIDE + column],
                             fmin(fmax(cosine, 1e-4), 0.999999), row / (ALBEDO_SIDE - 1.0), RIGHT);
        }
    assert_int_equal(wrong, 0);
}

static void a_wrong_number_is_found(void **state)
{
    (void)state;
    const float *middle    = albedos[ALBEDO_ROWS / 2 + ALBEDO_SIDE / 2];
    const double roughness = ALBEDO_SIDE / 2 / (ALBEDO_SIDE - 1.0), cosine = square(roughness);
    const float  wrong[3] = {middle[0], middle[1], middle[2] + 0.003F};
    assert_int_equal(compare(middle, cosine, roughness, RIGHT), 0);
    assert_int_equal(compare(wrong, cosine, roughness, RIGHT), 1);
}

/* Between rows and columns the shader takes the mean of four.  That is worst where a smooth surface
   is seen nearly along it. */
static double permitted_between(double cosine, double roughness)
{
    return cosine < 0.06 && roughness < 0.2 ? 0.03 : 0.002;
}

static void the_table_is_fine_enough(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (int row = 0; row + 1 < (int)ALBEDO_SIDE; row++)
        for (int column = 1; column + 1 < (int)ALBEDO_SIDE; column++) { /* no eye is lower */
            const float(*cell)[RESULT_NUMBERS] = &albedos[row * (int)ALBEDO_SIDE + column];
            float mean[3];
            for (int i = 0; i < 3; i++)
                mean[i] = (cell[0][i] + cell[1][i] + cell[ALBEDO_SIDE][i] +
                           cell[ALBEDO_SIDE + 1][i]) /
                          4;
            double cosine    = square((column + 0.5) / (ALBEDO_SIDE - 1.0));
            double roughness = (row + 0.5) / (ALBEDO_SIDE - 1.0);
            wrong += compare(mean, cosine, roughness, permitted_between(cosine, roughness));
        }
    assert_int_equal(wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_table_is_right),
        cmocka_unit_test(a_wrong_number_is_found),
        cmocka_unit_test(the_table_is_fine_enough),
    };
    return cmocka_run_group_tests_name("albedo", tests, NULL, NULL);
}
