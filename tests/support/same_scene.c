/*
 * same_scene.c: whether two compiled scenes are the same, to the last bit.
 */
#include "tests/support/same_scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/support/random.h"

/* Prints the text of the functions that shaders call, without comments. */
static void print_shaders(const KrsScene *scene, bool card, char *to, size_t capacity)
{
    const KrsVariant  variant  = {.values = true, .many_threads = card};
    const KrsFunction wanted[] = {card ? KRS_FUNCTION_DISTANCE_LOD : KRS_FUNCTION_DISTANCE,
                                  KRS_FUNCTION_SURFACE, KRS_FUNCTION_SCENE_PART_BOX};
    char  *text   = krs_scene_text(scene, &variant, wanted, 3, NULL);
    size_t length = 0;
    assert_non_null(text);
    for (const char *from = text; *from && length + 1 < capacity;) {
        if (from[0] == '/' && from[1] == '/')
            from += strcspn(from, "\n");
        else
            to[length++] = *from++;
    }
    to[length] = '\0';
    free(text);
}

bool same_shaders(const KrsScene *a, const KrsScene *b)
{
    static char x[1 << 16], y[1 << 16];
    bool        same = true;
    for (int card = 0; card < 2; card++) {
        print_shaders(a, card, x, sizeof x);
        print_shaders(b, card, y, sizeof y);
        same = same && strcmp(x, y) == 0;
    }
    return same;
}

/* The numbers of parts that are alike, and which of them are near a point. */
static void assert_same_tables(const KrsState *a, const KrsState *b, size_t rows, size_t cells)
{
    float(*x)[4] = calloc(rows + 1, sizeof *x), (*y)[4] = calloc(rows + 1, sizeof *y);
    uint32_t(*near)[2] = calloc(cells + 1, sizeof *near),
    (*same)[2]         = calloc(cells + 1, sizeof *same);
    assert_true(x && y && near && same);
    krs_state_tables(a, x, near);
    krs_state_tables(b, y, same);
    assert_memory_equal(x, y, (rows + 1) * sizeof *x);
    assert_memory_equal(near, same, (cells + 1) * sizeof *near);
    free(x);
    free(y);
    free(near);
    free(same);
}

void assert_same_distances(const KrsScene *a, const KrsScene *b)
{
    KrsState *first, *second;
    Random    random = {7};
    assert_int_equal(krs_state_new(a, &first), KRS_OK);
    assert_int_equal(krs_state_new(b, &second), KRS_OK);
    for (int i = 0; i < 200; i++) {
        double point[1][3], near[1], same[1];
        random_vector(&random, 4, point[0]);
        assert_int_equal(krs_distance(first, (const double(*)[3])point, 1, near), KRS_OK);
        assert_int_equal(krs_distance(second, (const double(*)[3])point, 1, same), KRS_OK);
        assert_true(near[0] == same[0]);
    }
    krs_state_free(first);
    krs_state_free(second);
}

void assert_same_scene(const KrsScene *a, const KrsScene *b)
{
    KrsState *first, *second;
    KrsCamera x, y;
    assert_same_distances(a, b);
    assert_true(same_shaders(a, b));
    assert_int_equal(krs_table_rows(a), krs_table_rows(b));
    assert_int_equal(krs_table_cells(a), krs_table_cells(b));
    assert_int_equal(krs_value_slots(a), krs_value_slots(b));
    assert_int_equal(krs_state_new(a, &first), KRS_OK);
    assert_int_equal(krs_state_new(b, &second), KRS_OK);
    assert_int_equal(krs_state_camera(first, 0, &x), KRS_OK);
    assert_int_equal(krs_state_camera(second, 0, &y), KRS_OK);
    assert_memory_equal(x.eye, y.eye, sizeof x.eye);
    assert_same_tables(first, second, krs_table_rows(a), krs_table_cells(a));
    krs_state_free(first);
    krs_state_free(second);
}
