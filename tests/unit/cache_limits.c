/*
 * cache_limits.c: the cache stays within its bounds: files, bytes, and how long they lie there.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/unit/cache_folder.h"

static void there_are_never_too_many_files(void **state)
{
    (void)state;
    write_whole("notes.txt", "not ours", 8);
    set_age("notes.txt", 1000000);
    for (int number = 0; number < CACHE_FILES + 8; number++) {
        char content[16];
        snprintf(content, sizeof content, "%d", number);
        put_entry(key_of(number), content);
    }
    int count = count_entries(NULL) - 1;
    assert_true(count <= CACHE_FILES && count >= CACHE_FILES / 2);
    assert_int_equal(access("notes.txt", F_OK), 0);
    char newest[16];
    snprintf(newest, sizeof newest, "%d", CACHE_FILES + 7);
    assert_true(holds(key_of(CACHE_FILES + 7), newest));
    assert_false(holds(key_of(0), "0"));
}

static void there_are_never_too_many_bytes(void **state)
{
    char names[7][NAME_MAX + 1];
    (void)state;
    for (int i = 0; i < 7; i++) /* 70 MiB, the youngest first */
        make_large(i, 1000 + 100 * i, names[i]);
    Cache later; /* knows nothing of them yet */
    cache_open(&later, folder, (KrsAllocator){0});
    cache_store(&later, CACHE_SPIRV, key_of(7), "new", 3);
    cache_close(&later);
    for (int i = 0; i < 7; i++)
        assert_int_equal(access(names[i], F_OK), i < 4 ? 0 : -1);
    assert_true(holds(key_of(7), "new"));
}

static void what_is_used_stays_young(void **state)
{
    char        name[NAME_MAX + 1];
    struct stat info;
    (void)state;
    put_entry(key_of(1), "one");
    count_entries(name);
    set_age(name, 100000);
    assert_true(holds(key_of(1), "one"));
    assert_int_equal(stat(name, &info), 0);
    assert_true(time(NULL) - info.st_mtime < 1000);
    set_age(name, 10); /* young enough: a hit writes nothing */
    assert_int_equal(stat(name, &info), 0);
    time_t before = info.st_mtime;
    assert_true(holds(key_of(1), "one"));
    assert_int_equal(stat(name, &info), 0);
    assert_int_equal(info.st_mtime, before);
}

static void temporaries_of_the_dead_go(void **state)
{
    (void)state;
    write_whole(".krs-cache-1-2-0.tmp", "dead", 4);
    write_whole(".krs-cache-1-3-0.tmp", "alive", 5);
    write_whole(".other", "not ours", 8);
    set_age(".krs-cache-1-2-0.tmp", 100000);
    set_age(".other", 100000);
    put_entry(key_of(1), "one");
    assert_int_equal(access(".krs-cache-1-2-0.tmp", F_OK), -1);
    assert_int_equal(access(".krs-cache-1-3-0.tmp", F_OK), 0);
    assert_int_equal(access(".other", F_OK), 0);
}

static void what_is_too_long_is_not_kept(void **state)
{
    (void)state;
    char *bytes = calloc(CACHE_ENTRY_BYTES + 1, 1);
    assert_non_null(bytes);
    cache_store(&cache, CACHE_SPIRV, key_of(1), bytes, CACHE_ENTRY_BYTES + 1);
    assert_int_equal(count_entries(NULL), 0);
    cache_store(&cache, CACHE_SPIRV, key_of(1), bytes, CACHE_ENTRY_BYTES);
    assert_int_equal(count_entries(NULL), 1);
    free(bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        in_cache(there_are_never_too_many_files), in_cache(there_are_never_too_many_bytes),
        in_cache(what_is_used_stays_young),       in_cache(temporaries_of_the_dead_go),
        in_cache(what_is_too_long_is_not_kept),
    };
    return cmocka_run_group_tests_name("limits of the cache", tests, NULL, NULL);
}
