/*
 * watcher.c: which changes of files are told of, and which are not.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "live/text/watcher.h"

static void put(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static int enter_folder(void **state)
{
    static char folder[] = "/tmp/krs-watcher-XXXXXX";
    *state               = folder;
    return mkdtemp(folder) && chdir(folder) == 0 ? 0 : -1;
}

static int leave_folder(void **state)
{
    static const char *const names[] = {"a",          "b",   "c", "link", "late/parts/x",
                                        "late/parts", "late"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        remove(names[i]);
    return chdir("/") == 0 ? rmdir(*state) : -1;
}

static Watcher *watch(const char *path)
{
    Watcher *watcher = watcher_new();
    assert_non_null(watcher);
    assert_true(watcher_add(watcher, path));
    assert_false(watcher_changed(watcher));
    return watcher;
}

static void files_that_are_written_have_changed(void **state)
{
    (void)state;
    put("a", "1");
    Watcher *watcher = watch("a");
    put("a", "2");
    assert_true(watcher_changed(watcher));
    assert_false(watcher_changed(watcher)); /* told once */
    put("b", "another file");
    assert_false(watcher_changed(watcher));
    assert_int_equal(rename("b", "a"), 0); /* as most editors save */
    assert_true(watcher_changed(watcher));
    assert_int_equal(remove("a"), 0);
    assert_true(watcher_changed(watcher));
    put("a", "3");
    assert_true(watcher_changed(watcher));
    watcher_free(watcher);
}

static void reading_changes_nothing(void **state)
{
    (void)state;
    put("a", "1");
    Watcher *watcher = watch("a");
    FILE    *file    = fopen("a", "r");
    assert_non_null(file);
    assert_int_equal(fgetc(file), '1');
    assert_int_equal(fclose(file), 0);
    assert_false(watcher_changed(watcher));
    watcher_free(watcher);
}

static void what_a_link_leads_to_is_watched(void **state)
{
    (void)state;
    put("c", "1");
    assert_int_equal(mkdir("late", 0700), 0);
    assert_int_equal(symlink("../c", "late/link"), 0);
    Watcher *watcher = watch("late/link");
    put("c", "2");
    assert_true(watcher_changed(watcher));
    assert_int_equal(remove("late/link"), 0);
    assert_true(watcher_changed(watcher));
    watcher_free(watcher);
    assert_int_equal(rmdir("late"), 0);
}

/* Each time another folder is there, and the file is added again as it would be by who reads it. */
static void folders_may_be_missing(void **state)
{
    (void)state;
    Watcher *watcher = watch("late/parts/x");
    assert_int_equal(mkdir("late", 0700), 0);
    assert_true(watcher_changed(watcher));
    assert_true(watcher_add(watcher, "late/parts/x"));
    assert_int_equal(mkdir("late/parts", 0700), 0);
    assert_true(watcher_changed(watcher));
    assert_true(watcher_add(watcher, "late/parts/x"));
    put("late/parts/x", "1");
    assert_true(watcher_changed(watcher));
    watcher_free(watcher);
}

static void waiting_ends_by_a_change_or_in_time(void **state)
{
    (void)state;
    put("a", "1");
    Watcher *watcher = watch("a");
    assert_false(watcher_wait(watcher, 0.01));
    put("b", "another file");
    assert_false(watcher_wait(watcher, 0.01));
    put("a", "2");
    assert_true(watcher_wait(watcher, 10));
    assert_false(watcher_wait(watcher, 0.01));
    watcher_free(watcher);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_that_are_written_have_changed),
        cmocka_unit_test(reading_changes_nothing),
        cmocka_unit_test(what_a_link_leads_to_is_watched),
        cmocka_unit_test(folders_may_be_missing),
        cmocka_unit_test(waiting_ends_by_a_change_or_in_time),
    };
    return cmocka_run_group_tests(tests, enter_folder, leave_folder);
}
