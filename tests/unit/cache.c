/*
 * cache.c: what was written to the cache comes back, whatever else lies there is as good as nothing
 * and is replaced, and trouble of every kind stays without words.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "runtime/device/pipelines.h"
#include "tests/support/scarce.h"
#include "tests/unit/cache_folder.h"

static void what_was_written_comes_back(void **state)
{
    (void)state;
    assert_false(holds(key_of(1), "one"));
    put_entry(key_of(1), "one");
    put_entry(key_of(2), "two");
    put_entry(key_of(3), "");
    assert_true(holds(key_of(1), "one"));
    assert_true(holds(key_of(2), "two"));
    assert_true(holds(key_of(3), ""));
    put_entry(key_of(1), "another");
    assert_true(holds(key_of(1), "another"));
    assert_int_equal(count_entries(NULL), 3);

    Cache later;
    cache_open(&later, folder, (KrsAllocator){0});
    size_t length;
    char  *bytes = cache_load(&later, CACHE_SPIRV, key_of(2), &length);
    assert_non_null(bytes);
    assert_memory_equal(bytes, "two", 3);
    free(bytes);
    assert_null(cache_load(&later, CACHE_PIPELINES, key_of(2), &length));
    cache_close(&later);
}

static void keys_tell_everything_apart(void **state)
{
    static const char *const makers[] = {"", "a", "ab", "abc", "krs 1", "krs 2"};
    static const char *const texts[]  = {"", "a", "bc", "c", "abc", "main"};
    CacheKey                 keys[36];
    size_t                   count = 0;
    (void)state;
    for (int m = 0; m < 6; m++)
        for (int t = 0; t < 6; t++)
            keys[count++] = cache_key(makers[m], texts[t], strlen(texts[t]));
    for (size_t i = 0; i < count; i++)
        for (size_t j = 0; j < i; j++)
            assert_memory_not_equal(&keys[i], &keys[j], sizeof keys[i]);
    CacheKey again = cache_key("krs 1", "abc", 3);
    assert_memory_equal(&again, &keys[4 * 6 + 4], sizeof again);
}

static void every_damage_is_found_and_repaired(void **state)
{
    static const char content[] = "the words of a shader";
    char              name[NAME_MAX + 1], good[512], bad[513];
    (void)state;
    put_entry(key_of(1), content);
    assert_int_equal(count_entries(name), 1);
    size_t length = read_whole(name, good, sizeof good);
    assert_true(length > strlen(content) && length < sizeof good);

    for (size_t bit = 0; bit < 8 * length; bit++) {
        memcpy(bad, good, length);
        bad[bit / 8] ^= (char)(1 << bit % 8);
        write_whole(name, bad, length);
        assert_false(holds(key_of(1), content));
    }
    for (size_t shorter = 0; shorter < length; shorter++) {
        write_whole(name, good, shorter);
        assert_false(holds(key_of(1), content));
    }
    memcpy(bad, good, length);
    bad[length] = 0;
    write_whole(name, bad, length + 1);
    assert_false(holds(key_of(1), content));

    put_entry(key_of(1), content);
    assert_true(holds(key_of(1), content));
    assert_int_equal(count_entries(NULL), 1);
    char repaired[512];
    assert_int_equal(read_whole(name, repaired, sizeof repaired), length);
    assert_memory_equal(repaired, good, length);
}

static void a_file_under_a_false_name_is_a_miss(void **state)
{
    char one[NAME_MAX + 1], bytes[512], other[NAME_MAX + 1];
    (void)state;
    put_entry(key_of(1), "one");
    count_entries(one);
    size_t length = read_whole(one, bytes, sizeof bytes);
    cache_store(&cache, CACHE_PIPELINES, key_of(1), "data", 4);
    put_entry(key_of(2), "two");

    struct dirent **found;
    int             count = scandir(".", &found, is_not_dot, NULL);
    assert_int_equal(count, 3);
    for (int i = 0; i < count; i++) { /* all of them are now the first */
        snprintf(other, sizeof other, "%s", found[i]->d_name);
        write_whole(other, bytes, length);
        free(found[i]);
    }
    free(found);
    assert_true(holds(key_of(1), "one"));
    assert_false(holds(key_of(2), "two"));
    assert_null(cache_load(&cache, CACHE_PIPELINES, key_of(1), &length));
    put_entry(key_of(2), "two");
    assert_true(holds(key_of(2), "two"));
}

static void a_folder_is_empty_until_something_is_written(void **state)
{
    (void)state;
    assert_true(cache_is_empty(NULL));
    assert_true(cache_is_empty(folder));
    put_entry(key_of(1), "one");
    assert_false(cache_is_empty(folder));
}

static void what_is_no_file_is_a_miss(void **state)
{
    char name[NAME_MAX + 1];
    (void)state;
    put_entry(key_of(1), "one");
    count_entries(name);
    assert_int_equal(rename(name, "kept"), 0);

    assert_int_equal(symlink("kept", name), 0);
    assert_false(holds(key_of(1), "one"));
    put_entry(key_of(1), "one");
    assert_true(holds(key_of(1), "one"));

    assert_int_equal(unlink(name), 0);
    assert_int_equal(mkfifo(name, 0600), 0); /* must not wait for a writer */
    assert_false(holds(key_of(1), "one"));
    put_entry(key_of(1), "one");
    assert_true(holds(key_of(1), "one"));

    assert_int_equal(unlink(name), 0);
    assert_int_equal(mkdir(name, 0700), 0);
    assert_false(holds(key_of(1), "one"));
    put_entry(key_of(1), "one"); /* cannot be */
    assert_false(holds(key_of(1), "one"));
    assert_int_equal(count_entries(NULL), 2); /* the folder and what was kept; no temporary */

    if (geteuid() == 0) { /* nobody else can give files away */
        assert_int_equal(rmdir(name), 0);
        assert_int_equal(rename("kept", name), 0);
        assert_true(holds(key_of(1), "one"));
        assert_int_equal(chown(name, 65534, 65534), 0);
        assert_false(holds(key_of(1), "one"));
    }
}

/* ---- Several writers ---- */

enum { WRITERS = 4, ROUNDS = 40, LARGE = 300000 };

static void fill_large(char *bytes, int writer)
{
    for (int i = 0; i < LARGE; i++)
        bytes[i] = (char)(i * 7 + i / 256 + writer);
}

/* What is there, if anything, is the whole of what one of the writers wrote. */
static bool holds_one_of_them(void)
{
    char   expected[LARGE];
    size_t length;
    char  *bytes = cache_load(&cache, CACHE_SPIRV, key_of(1), &length);
    if (!bytes)
        return false;
    bool same = false;
    for (int writer = 0; writer < WRITERS && length == LARGE; writer++) {
        fill_large(expected, writer);
        same = same || memcmp(bytes, expected, LARGE) == 0;
    }
    free(bytes);
    assert_true(same);
    return true;
}

static void writers_do_not_disturb_each_other(void **state)
{
    pid_t writers[WRITERS];
    bool  seen = false;
    (void)state;
    for (int i = 0; i < WRITERS; i++) {
        writers[i] = fork();
        assert_true(writers[i] >= 0);
        if (writers[i] == 0) {
            char  bytes[LARGE];
            Cache own;
            cache_open(&own, folder, (KrsAllocator){0});
            fill_large(bytes, i);
            for (int round = 0; round < ROUNDS; round++)
                cache_store(&own, CACHE_SPIRV, key_of(1), bytes, sizeof bytes);
            _exit(0);
        }
    }
    for (int i = 0; i < WRITERS; i++) {
        int ended;
        while (waitpid(writers[i], &ended, WNOHANG) == 0) {
            bool there = holds_one_of_them();
            assert_true(there || !seen); /* replaced, it is never away */
            seen = seen || there;
        }
        assert_true(WIFEXITED(ended) && WEXITSTATUS(ended) == 0);
    }
    assert_true(holds_one_of_them());
    assert_int_equal(count_entries(NULL), 1);
}

/* ---- Trouble ---- */

/* Where nothing can be kept, nothing is found and nothing is said. */
static void nothing_is_kept_in(const char *place)
{
    Cache  nowhere;
    size_t length;
    fflush(NULL);
    int said       = open("said", O_RDWR | O_CREAT | O_TRUNC, 0600);
    int streams[2] = {dup(1), dup(2)};
    assert_true(said >= 0 && dup2(said, 1) == 1 && dup2(said, 2) == 2);
    cache_open(&nowhere, place, (KrsAllocator){0});
    cache_store(&nowhere, CACHE_SPIRV, key_of(1), "one", 3);
    void *found = cache_load(&nowhere, CACHE_SPIRV, key_of(1), &length);
    cache_close(&nowhere);
    fflush(NULL);
    dup2(streams[0], 1);
    dup2(streams[1], 2);
    close(streams[0]);
    close(streams[1]);
    off_t words = lseek(said, 0, SEEK_END);
    close(said);
    assert_null(found);
    assert_int_equal(words, 0);
}

static void places_that_keep_nothing(void **state)
{
    char long_name[5000];
    (void)state;
    nothing_is_kept_in(NULL);
    nothing_is_kept_in("");
    nothing_is_kept_in("/dev/null");
    nothing_is_kept_in("/dev/null/krs");
    nothing_is_kept_in("/proc/self"); /* is there, but takes no files, not even of root */
    memset(long_name, 'a', sizeof long_name - 1);
    long_name[sizeof long_name - 1] = '\0';
    nothing_is_kept_in(long_name);
    if (geteuid() != 0) {
        assert_int_equal(mkdir("locked", 0500), 0);
        nothing_is_kept_in("locked");
        nothing_is_kept_in("locked/krs");
    }
}

static void missing_folders_are_made(void **state)
{
    Cache       deep;
    struct stat info;
    (void)state;
    cache_open(&deep, "a/b/c", (KrsAllocator){0});
    cache_store(&deep, CACHE_SPIRV, key_of(1), "one", 3);
    size_t length;
    void  *bytes = cache_load(&deep, CACHE_SPIRV, key_of(1), &length);
    assert_non_null(bytes);
    free(bytes);
    cache_close(&deep);
    static const char *const made[] = {"a", "a/b", "a/b/c"};
    for (int i = 0; i < 3; i++) {
        assert_int_equal(stat(made[i], &info), 0);
        assert_int_equal(info.st_mode & 0777, 0700);
    }
}

/* A disk that is full, in the way of a process that may not write so much. */
static void a_full_disk_leaves_nothing(void **state)
{
    (void)state;
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        static const char bytes[100000];
        struct rlimit     limit = {50000, 50000};
        signal(SIGXFSZ, SIG_IGN);
        setrlimit(RLIMIT_FSIZE, &limit);
        cache_store(&cache, CACHE_SPIRV, key_of(1), bytes, sizeof bytes);
        cache_store(&cache, CACHE_SPIRV, key_of(2), "two", 3);
        _exit(0);
    }
    int ended;
    assert_int_equal(waitpid(child, &ended, 0), child);
    assert_true(WIFEXITED(ended) && WEXITSTATUS(ended) == 0);
    assert_true(holds(key_of(2), "two"));
    assert_int_equal(count_entries(NULL), 1);
}

static void memory_that_runs_out_is_a_miss(void **state)
{
    Scarce scarce = {.failing = 1, .lasting = true};
    Cache  poor;
    size_t length;
    char   name[NAME_MAX + 1];
    (void)state;
    for (int i = 0; i < 7; i++) /* full, so that making room needs memory too */
        make_large(i, 1000 + 100 * i, name);
    cache_open(&poor, folder, scarce_allocator(&scarce));
    cache_store(&poor, CACHE_SPIRV, key_of(8), "new", 3);
    assert_null(cache_load(&poor, CACHE_SPIRV, key_of(8), &length));
    assert_int_equal(count_entries(NULL), 8);

    scarce.failing = scarce.made + 2; /* one is enough for either */
    void *bytes    = cache_load(&poor, CACHE_SPIRV, key_of(8), &length);
    assert_non_null(bytes);
    assert_int_equal(scarce.held, 1);
    scarce_allocator(&scarce).release(&scarce, bytes);
    scarce.failing = scarce.made + 2;
    cache_store(&poor, CACHE_SPIRV, key_of(9), "new", 3);
    assert_true(count_entries(NULL) < 8);
    cache_close(&poor);
    assert_int_equal(scarce.held, 0);
}

static void data_of_another_device_is_refused(void **state)
{
    (void)state;
    VkPhysicalDeviceProperties device = {
        .vendorID = 0x10de, .deviceID = 0x2330, .pipelineCacheUUID = {1, 2, 3, 4, 5}};
    struct {
        VkPipelineCacheHeaderVersionOne header;
        char                            data[8];
    } blob = {.header = {.headerSize        = sizeof blob.header,
                         .headerVersion     = VK_PIPELINE_CACHE_HEADER_VERSION_ONE,
                         .vendorID          = 0x10de,
                         .deviceID          = 0x2330,
                         .pipelineCacheUUID = {1, 2, 3, 4, 5}}};
    assert_true(pipelines_fit(&device, &blob, sizeof blob));
    for (size_t length = 0; length <= sizeof blob.header; length++)
        assert_false(pipelines_fit(&device, &blob, length));
    for (size_t byte = 0; byte < sizeof blob.header; byte++) {
        ((char *)&blob)[byte] ^= 1;
        assert_false(pipelines_fit(&device, &blob, sizeof blob));
        ((char *)&blob)[byte] ^= 1;
    }
    assert_true(pipelines_fit(&device, &blob, sizeof blob));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        in_cache(what_was_written_comes_back),
        cmocka_unit_test(keys_tell_everything_apart),
        in_cache(every_damage_is_found_and_repaired),
        in_cache(a_file_under_a_false_name_is_a_miss),
        in_cache(a_folder_is_empty_until_something_is_written),
        in_cache(what_is_no_file_is_a_miss),
        in_cache(writers_do_not_disturb_each_other),
        in_cache(places_that_keep_nothing),
        in_cache(missing_folders_are_made),
        in_cache(a_full_disk_leaves_nothing),
        in_cache(memory_that_runs_out_is_a_miss),
        cmocka_unit_test(data_of_another_device_is_refused),
    };
    return cmocka_run_group_tests_name("cache", tests, NULL, NULL);
}
