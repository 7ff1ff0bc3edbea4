/*
 * specks.c: what rough mirrors show of others is blurred by their roughness, so that highlights in it
 * are no specks.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/unit/tracer_stage.h"

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
enum { ACROSS = 200, DOWN = 120 };

/* The second largest of the eight pixels around one. */
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

static void highlights_in_mirrors_are_no_specks(void **state)
{
    Stage           *stage   = *state;
    KrsRenderOptions options = {.width   = 960,
                                .height  = 540,
                                .crop    = {380, 80, ACROSS, DOWN},
                                .samples = 4,
                                .planes  = KRS_PLANE_COLOR};
    KrsPicture      *picture = stage_render(stage, options);
    const float(*color)[4]   = (const float(*)[4])picture->color;
    float worst              = 0;
    for (int y = 1; y < DOWN - 1; y++)
        for (int x = 1; x < ACROSS - 1; x++)
            if (color[y * ACROSS + x][1] > 0.05f)
                worst = fmaxf(worst, color[y * ACROSS + x][1] / second_around(color, x, y));
    krs_picture_free(picture);
    assert_true(worst > 1.1f && worst < 2.5f); /* as if mirrors were smooth: 5.9 */
}

static int open_spring(void **state)
{
    static Stage stage;
    stage_open(&stage, spring_text, NULL);
    *state = &stage;
    return 0;
}

static int close_spring(void **state)
{
    stage_close(*state);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(highlights_in_mirrors_are_no_specks)};
    return cmocka_run_group_tests(tests, open_spring, close_spring);
}
