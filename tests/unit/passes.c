/*
 * passes.c: every pass of the compiler can be dumped and is timed, by whichever of its names.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "compiler/scene/program.h"

static const char example[] = "examples/03-machined-part.krs";

static char *dump(const char *path, const char *after, KrsStatus expected)
{
    char *text = NULL;
    assert_int_equal(krs_dump(NULL, 0, path, after, NULL, &text), expected);
    return text;
}

static void each_pass_prints(void **state)
{
    const KrsPass *pass;
    (void)state;
    for (size_t i = 0; (pass = krs_pass(i)); i++) {
        char *by_name = dump(example, pass->name, KRS_OK);
        char *by_form = dump(example, pass->form, KRS_OK);
        print_message("# %s: %zu bytes\n", pass->name, strlen(by_name));
        assert_string_not_equal(by_name, "");
        assert_string_equal(by_name, by_form);
        assert_string_not_equal(pass->meaning, "");
        free(by_name);
        free(by_form);
    }
}

/* A word means one pass, or none. */
static void words_are_unique(void **state)
{
    const KrsPass *pass;
    (void)state;
    for (size_t i = 0; (pass = krs_pass(i)); i++) {
        assert_ptr_equal(krs_find_pass(pass->name), pass);
        assert_ptr_equal(krs_find_pass(pass->form), pass);
    }
    assert_null(krs_find_pass("lowers"));
    assert_null(krs_find_pass(""));
    assert_null(dump(example, "lowers", KRS_BAD_ARGUMENT));
}

static const char *line_with(const char *text, const char *words)
{
    const char *found = strstr(text, words);
    if (!found)
        fail_msg("no `%s` in:\n%s", words, text);
    return found;
}

/* What some of them found. */
static void dumps_say_what_was_found(void **state)
{
    (void)state;
    char *text = dump(example, "use", KRS_OK);
    line_with(text, "  uses examples/parts/noise.krs\n");
    free(text);
    text = dump(example, "names", KRS_OK);
    line_with(text, "param fillet  examples/03-machined-part.krs:6:7\n");
    assert_true(line_with(text, "let casting") < line_with(text, "library:solids.krs"));
    free(text);
    text = dump(example, "limits", KRS_OK);
    line_with(text, "bush  30 operations\n");
    line_with(text, " operations of 20000\n");
    free(text);
    text = dump(example, "info", KRS_OK);
    line_with(text, "planes  yes\n");
    line_with(text, "march group 3  flops");
    free(text);
    text = dump(example, "frame", KRS_OK);
    line_with(text, "camera 1  perspective  eye 4.4 4.3 7  target");
    free(text);
}

static void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

/* A wrong scene has its passes before the mistake printed, and those behind it not. */
static void mistakes_end_the_passes(void **state)
{
    static const struct {
        const char *text, *last; /* the pass that finds the mistake */
    } scenes[]  = {{"show sphere(1;\n", "names"},
                   {"use \"nowhere.krs\"; show sphere(1);\n", "names"},
                   {"show nothing_like_it;\n", "names"},
                   {"show sphere(true);\n", "elaborate"},
                   {"show field(x * 1e39);\n", "limits"},
                   {"param a = 0 in [0, 1]; show field(x + 1 / a).within(sphere(2));\n", "check"}};
    char path[] = "/tmp/krs-passes-XXXXXX";
    int  file   = mkstemp(path);
    (void)state;
    assert_true(file >= 0);
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        const KrsPass *pass;
        bool           before = true;
        write_file(path, scenes[i].text);
        for (size_t k = 0; (pass = krs_pass(k)); k++) {
            before     = before && strcmp(pass->name, scenes[i].last) != 0;
            char *text = dump(path, pass->name, KRS_BAD_SCENE);
            assert_non_null(text);
            if ((strlen(text) > 0) != before)
                fail_msg("%s after %s: `%s`", scenes[i].text, pass->name, text);
            free(text);
        }
    }
    remove(path);
}

static double now_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

static void times_add_up(void **state)
{
    KrsScene *scene;
    double    start = now_ms(), sum = 0, front = 0, glsl = 0;
    (void)state;
    assert_int_equal(krs_compile_file(example, NULL, &scene), KRS_OK);
    double            all     = now_ms() - start;
    const KrsProgram *program = krs_scene_program(scene);
    for (size_t i = 0; krs_pass(i); i++) {
        double ms   = program->pass_ms[i];
        bool   emit = strcmp(krs_pass(i)->name, "emit") == 0;
        assert_true(ms >= 0);
        front += glsl == 0 && !emit ? ms : 0;
        glsl += emit ? ms : 0;
        sum += ms;
    }
    assert_true(sum > 0 && sum <= all);
    assert_true(glsl > 0 && front > 0);
    assert_true(program->glsl_ms == glsl && program->front_ms == front);
    krs_scene_free(scene);
}

/* Steps of research are lowered where they are asked for, and nothing else that is known of a scene changes. */
static void research_is_lowered_where_asked_for(void **state)
{
    static const char *const paths[] = {"examples/14-inversion.krs", "examples/21-sextic.krs"};
    (void)state;
    for (int inverts = 0; inverts < 2; inverts++) {
        size_t nodes[2];
        for (int asked = 0; asked < 2; asked++) {
            const KrsOptions options = {.research = asked};
            KrsScene        *scene;
            assert_int_equal(krs_compile_file(paths[!inverts], &options, &scene), KRS_OK);
            const KrsProgram *program = krs_scene_program(scene);
            assert_int_equal(roots_of(&scene->roots, ROOTS_RESEARCH).count,
                             asked * RESEARCH_COUNT * scene->component_count);
            assert_int_equal(program->research, asked);
            assert_int_equal(program->inverts, inverts);
            assert_int_equal(program->along, !inverts);
            nodes[asked] = scene->graph->count;
            krs_scene_free(scene);
        }
        assert_true(nodes[0] < nodes[1]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_pass_prints),
        cmocka_unit_test(words_are_unique),
        cmocka_unit_test(dumps_say_what_was_found),
        cmocka_unit_test(mistakes_end_the_passes),
        cmocka_unit_test(times_add_up),
        cmocka_unit_test(research_is_lowered_where_asked_for),
    };
    return cmocka_run_group_tests_name("passes of the compiler", tests, NULL, NULL);
}
