/* mesh_tets.c: however tetrahedra were bisected, all meet in whole faces when that is asked for. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/contour/tets.h"
#include "tests/support/random.h"

static Random chance = {71};

static const double ORIGIN[3] = {0, 0, 0};

/* Where there are points, on a grid of its own. */
enum { PLACES = 64 };
static const uint32_t STEP = CUBE_STEPS / PLACES;
static uint8_t        taken[PLACES + 1][PLACES + 1][PLACES + 1];

/* Edges with a point in the middle. */
static size_t count_hanging(const Tets *tets)
{
    size_t hanging = 0;
    memset(taken, 0, sizeof taken);
    for (size_t i = 0; i < tets->points.count; i++) {
        const uint32_t *at = tets->points.items[i].at;
        for (int k = 0; k < 3; k++)
            assert_int_equal(at[k] % STEP, 0);
        taken[at[0] / STEP][at[1] / STEP][at[2] / STEP] = 1;
    }
    for (size_t i = 0; i < tets->list.count; i++)
        for (int a = 0; a < 4; a++)
            for (int b = 0; b < a; b++) {
                uint32_t middle[3];
                bool     whole = true;
                for (int k = 0; k < 3; k++) {
                    uint32_t sum = tets->points.items[tets->list.items[i].points[a]].at[k] +
                                   tets->points.items[tets->list.items[i].points[b]].at[k];
                    whole     = whole && sum % (2 * STEP) == 0;
                    middle[k] = sum / (2 * STEP);
                }
                hanging += whole && taken[middle[0]][middle[1]][middle[2]];
            }
    return hanging;
}

/* Its parts, and those of what is bisected with it, have corners on the grid. */
static bool is_large(const Tets *tets, size_t i)
{
    return tets_longest_edge(tets, &tets->list.items[i]) > 3.0 / PLACES;
}

static void all_meet_in_whole_faces(void **context)
{
    Memory memory = {0};
    Arena  arena  = {.memory = &memory};
    (void)context;
    for (int trial = 0; trial < 20; trial++) {
        Tets   tets;
        size_t hanging = 0;
        tets_new(&tets, ORIGIN, 1, &arena);
        for (int turn = 0; turn < 9; turn++) {
            double part  = random_between(&chance, 0.02, 0.6);
            size_t count = tets.list.count;
            for (size_t i = 0; i < count; i++)
                if (is_large(&tets, i) && random_between(&chance, 0, 1) < part)
                    tets_bisect(&tets, i);
            hanging += count_hanging(&tets);
            tets_close(&tets);
            assert_int_equal(count_hanging(&tets), 0);
        }
        assert_true(hanging > 100);
    }
    arena_free(&arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(all_meet_in_whole_faces)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
