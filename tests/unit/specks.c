/*
 * specks.c: pixels that are much brighter than those around.  What rough mirrors show of others is
 * blurred by their roughness, and shadows right behind an edge have no light from before it.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/unit/tracer_fixture.h"

/* A spring, whose turns mirror each other, between plates on a floor: no light, so the usual ones. */
static const char spring_text[] =
    "material steel { color: #8fa3b8, roughness: 0.25, metallic: 1 }\n"
    "material red { color: #b3332b, roughness: 0.4 }\n"
    "let plate = cylinder(0.95, 0.12).round(0.03) | cylinder(0.36, 0.5).round(0.04);\n"
    "show plate.move([0, 0.06, 0]).paint(red);\n"
    "show helix(radius: 0.6, pitch: 0.36, turns: 7, width: 0.12).move([0, 1.44, 0]).paint(steel);\n"
    "show plate.move([0, 2.82, 0]).paint(red);\n"
    "show plane([0, 1, 0], 0).paint(#b9b4a8);\n"
    "camera { eye: [2.6, 2.6, 4.4], target: [0, 1.35, 0], fov: 40deg }\n";
/* The thread of a nut, whose edges cast shadows right behind them. */
static const char nut_text[] =
    "def hexagon(height) = (prism(6, 16 / sqrt(3), height) &\n"
    "                       cone(30, 17.3).move([0, height / 2 - 4.2, 0])).round(0.1);\n"
    "material brass { color: #d0a658, roughness: 0.3, metallic: 1 }\n"
    "show (hexagon(8) - thread(10, 1.5, 10, chamfer: 0).offset(0.06) -\n"
    "      cone(6.2, 6.2).rotate([1, 0, 0], 180deg).move([0, 2.2, 0]))\n"
    "    .rotate([0, 1, 0], 12deg).move([25, 4, 12]).paint(brass);\n"
    "show plane([0, 1, 0], 0);\n"
    "light sun { direction: [-1, 2.4, 1.6], intensity: 3, softness: 6deg }\n"
    "camera { eye: [16, 34, 62], target: [6, 4, 3], fov: 42deg }\n";
enum { ACROSS = 200, DOWN = 120 };

/* Returns the second largest of the eight pixels around one. */
static float second_around(const float (*color)[4], int x, int y)
{
    float largest[2] = {0};
    for (int k = 0; k < 9; k++) {
        float value = color[(y + k / 3 - 1) * ACROSS + x + k % 3 - 1][1];
        for (int i = 0; i < 2 && k != 4; i++)
            if (value > largest[i]) {
                const float less = largest[i];
                largest[i]       = value;
                value            = less;
            }
    }
    return largest[1];
}

/* Returns how many pixels are `times` as bright as the second brightest around. */
static int count_specks(Fixture *fixture, uint32_t x, uint32_t y, uint32_t samples, float times)
{
    KrsRenderOptions options = {.width   = 960,
                                .height  = 540,
                                .crop    = {x, y, ACROSS, DOWN},
                                .samples = samples,
                                .aovs    = KRS_AOV_COLOR};
    KrsPicture      *picture = fixture_render(fixture, options);
    const float(*color)[4]   = (const float(*)[4])picture->color;
    int count                = 0;
    for (int row = 1; row < DOWN - 1; row++)
        for (int column = 1; column < ACROSS - 1; column++) {
            const float bright = color[row * ACROSS + column][1];
            count += bright > 0.05f && bright > times * second_around(color, column, row);
        }
    krs_picture_free(picture);
    return count;
}

static void highlights_in_mirrors_are_no_specks(void **state)
{
    Fixture fixture;
    (void)state;
    fixture_open(&fixture, spring_text, NULL);
    assert_in_range(count_specks(&fixture, 380, 80, 4, 1.1f), 1, 100000);
    assert_int_equal(count_specks(&fixture, 380, 80, 4, 2.5f),
                     0); /* as if mirrors were smooth: up to 5.9 */
    fixture_close(&fixture);
}

/* With means over as many neighbours as elsewhere there are 21. */
static void edges_shade_what_is_behind_them(void **state)
{
    Fixture fixture;
    (void)state;
    fixture_open(&fixture, nut_text, NULL);
    assert_in_range(count_specks(&fixture, 600, 250, 1, 1.5f), 0, 14);
    fixture_close(&fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(highlights_in_mirrors_are_no_specks),
                                       cmocka_unit_test(edges_shade_what_is_behind_them)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
