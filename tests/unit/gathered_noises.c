/*
 * gathered_noises.c: which noises become iterations of a loop, and how many turns there are.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "compiler/scene/compiled.h"

enum { MAX_TURNS = 256 }; /* times 64 surfaces of a lane: a quarter of what lavapipe permits */

/* Returns the text of a function of the scene, with noises gathered or not. */
static char *print(const char *scene_text, KrsFunction wanted, bool gathers)
{
    const KrsVariant variant = {.gathers_noises = gathers};
    KrsScene        *scene;
    assert_int_equal(krs_compile_text(scene_text, strlen(scene_text), "noises", NULL, &scene),
                     KRS_OK);
    char *text = krs_scene_text(scene, &variant, &wanted, 1, NULL);
    assert_non_null(text);
    krs_scene_free(scene);
    return text;
}

/* Returns the iterations of a loop in the text, and the text behind it; 0: there is no further
   one. */
static unsigned next_loop(const char **text)
{
    const char *end   = strstr(*text, "} while (++");
    unsigned    turns = 0;
    if (!end)
        return 0;
    assert_int_equal(sscanf(strchr(end, '<'), "< %uu", &turns), 1);
    *text = end + 1;
    return turns;
}

static int count_calls(const char *text)
{
    int count = -1; /* the function itself */
    for (; (text = strstr(text, "krs_noise3(")); text++)
        count++;
    return count;
}

static void assert_loops(const char *scene, KrsFunction wanted, const unsigned *turns, int calls)
{
    char       *text = print(scene, wanted, true);
    const char *at   = text;
    do
        assert_int_equal(next_loop(&at), *turns);
    while (*turns++);
    assert_int_equal(count_calls(text), calls);
    free(text);
}

static void octaves_are_a_loop(void **state)
{
    (void)state;
    assert_loops("show sphere(1).paint(mix(white, black, fbm(p, octaves: 5)));",
                 KRS_FUNCTION_SURFACE, (const unsigned[]){5, 0}, 1);
    assert_loops("show sphere(1).paint(mix(white, black, fbm(p, octaves: 3)));",
                 KRS_FUNCTION_SURFACE, (const unsigned[]){0}, 3);
}

/* Noises whose points need noises have a later loop; those beside them that do not, the first one. */
static void what_needs_noises_comes_later(void **state)
{
    (void)state;
    assert_loops(
        "show sphere(1).paint(mix(white, black, fbm(p + fbm(3 * p, octaves: 4), octaves: 6)"
        " * fbm(7 * p, octaves: 5)));",
        KRS_FUNCTION_SURFACE, (const unsigned[]){9, 6, 0}, 2);
}

/* Distances are marched by, in loops of their own. */
static void distances_have_no_loops(void **state)
{
    static const char scene[] = "show sphere(1).displace(0.1 * fbm(p, octaves: 6));";
    (void)state;
    assert_loops(scene, KRS_FUNCTION_DISTANCE, (const unsigned[]){0}, 6);
    char       *text = print(scene, KRS_FUNCTION_SURFACE, false);
    const char *at   = text;
    assert_int_equal(next_loop(&at), 0);
    free(text);
}

static void turns_are_few(void **state)
{
    char scene[4096] = "";
    (void)state;
    for (int i = 0; i < 40; i++)
        sprintf(scene + strlen(scene),
                "show sphere(1).move([%d, 0, 0]).paint(mix(white, black, fbm(%d * p)));", 3 * i,
                i + 2);
    char       *text = print("show sphere(1).paint(mix(white, black, sum([noise(i * p)"
                                   " for i in 1..300])));",
                             KRS_FUNCTION_SURFACE, true);
    const char *at   = text;
    assert_int_equal(next_loop(&at), 0);
    free(text);
    text            = print(scene, KRS_FUNCTION_SURFACE, true);
    at              = text;
    unsigned number = 0, all = 0;
    for (unsigned turns; (turns = next_loop(&at)) > 0; number++)
        all += turns;
    assert_true(number > 1);
    assert_in_range(all, MAX_TURNS / 2, MAX_TURNS);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(octaves_are_a_loop),
        cmocka_unit_test(what_needs_noises_comes_later),
        cmocka_unit_test(distances_have_no_loops),
        cmocka_unit_test(turns_are_few),
    };
    return cmocka_run_group_tests_name("gathered noises", tests, NULL, NULL);
}
