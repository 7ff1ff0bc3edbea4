/*
 * reload.c: scenes that are read again from their files, and where editors find their parameters.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "krs/krs.h"

static KrsScene *compile(const char *text)
{
    KrsScene *scene;
    assert_int_equal(krs_compile_text(text, strlen(text), "edited.krs", NULL, &scene), KRS_OK);
    return scene;
}

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    fclose(file);
}

static void count_file(void *user, const char *path)
{
    (void)path;
    ++*(int *)user;
}

static void files_are_read_again(void **state)
{
    (void)state;
    char             path[] = "/tmp/krs-update-XXXXXX";
    int              opened = 0;
    const int        fd     = mkstemp(path);
    const KrsOptions with   = {.opened = count_file, .opened_user = &opened};
    KrsScene        *scene, *again;
    KrsChanges       changes;
    assert_true(fd >= 0);
    close(fd);
    write_text(path, "show sphere(1);");
    assert_int_equal(krs_compile_file(path, &with, &scene), KRS_OK);
    const int once = opened;
    write_text(path, "show sphere(1); camera { eye: [0, 0, 9] }");
    assert_int_equal(krs_scene_reload(scene, &again, &changes), KRS_OK);
    assert_int_equal(opened, 2 * once);
    assert_true(changes.cameras && !changes.lights);
    krs_scene_free(again);
    remove(path);
    assert_int_equal(krs_scene_reload(scene, &again, &changes), KRS_IO_ERROR);
    assert_null(again);
    krs_scene_free(scene);
}

/* Bytes of the text, line and column of parameters; what a viewer shows them by. */
static void parameters_have_places(void **state)
{
    (void)state;
    const char   text[] = "// \xc3\xa4\n/// How wide.\nparam r = 1 + 1 in [0, 9];\n"
                          "show sphere(r).paint(c); /* \xc3\xa4 */ param c = #ff8000;";
    KrsScene    *scene  = compile(text);
    KrsParameter r, c;
    assert_int_equal(krs_parameter(scene, 0, &r), KRS_OK);
    assert_int_equal(krs_parameter(scene, 1, &c), KRS_OK);
    if (strcmp(r.name, "r") != 0) {
        KrsParameter other = r;
        r                  = c;
        c                  = other;
    }
    assert_string_equal(r.source, "edited.krs");
    assert_int_equal(r.end - r.start, 5);
    assert_memory_equal(text + r.start, "1 + 1", 5);
    assert_int_equal(r.line, 3);
    assert_int_equal(r.column, 7);
    assert_string_equal(r.doc, "How wide.");
    assert_false(r.color);
    assert_memory_equal(text + c.start, "#ff8000;", c.end - c.start + 1);
    assert_int_equal(c.line, 4);
    assert_int_equal(c.column, 40);
    assert_null(c.doc);
    assert_true(c.color);
    krs_scene_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_are_read_again),
        cmocka_unit_test(parameters_have_places),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
