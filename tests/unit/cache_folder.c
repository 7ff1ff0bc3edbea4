/*
 * cache_folder.c: a cache in an empty folder for each test of a group, and its files.
 */
#include "tests/unit/cache_folder.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

Cache cache;

int enter_cache(void **state)
{
    if (enter_folder(state) != 0)
        return -1;
    cache_open(&cache, folder, (KrsAllocator){0});
    return cache.folder ? 0 : -1;
}

int leave_cache(void **state)
{
    cache_close(&cache);
    return leave_folder(state);
}

int is_not_dot(const struct dirent *entry)
{
    return strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
}

int count_entries(char name[NAME_MAX + 1])
{
    struct dirent **found;
    int             count = scandir(".", &found, is_not_dot, NULL);
    for (int i = 0; i < count; i++) {
        if (name)
            snprintf(name, NAME_MAX + 1, "%s", found[i]->d_name);
        free(found[i]);
    }
    free(found);
    return count;
}

CacheKey key_of(int number) { return cache_key("test", &number, sizeof number); }

bool holds(CacheKey key, const char *content)
{
    size_t length = 0;
    char  *bytes  = cache_load(&cache, CACHE_SPIRV, key, &length);
    bool   same   = bytes && length == strlen(content) && memcmp(bytes, content, length) == 0;
    assert_true(!bytes || same); /* never anything else */
    free(bytes);
    return same;
}

void put_entry(CacheKey key, const char *content)
{
    cache_store(&cache, CACHE_SPIRV, key, content, strlen(content));
}

size_t read_whole(const char *name, char *bytes, size_t size)
{
    FILE *file = fopen(name, "r");
    assert_non_null(file);
    size_t length = fread(bytes, 1, size, file);
    fclose(file);
    return length;
}

void write_whole(const char *name, const char *bytes, size_t length)
{
    FILE *file = fopen(name, "w");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, length, file), length);
    assert_int_equal(fclose(file), 0);
}

void set_age(const char *name, time_t seconds)
{
    struct timespec used = {.tv_sec = time(NULL) - seconds};
    assert_int_equal(utimensat(AT_FDCWD, name, (struct timespec[]){used, used}, 0), 0);
}

void make_large(int number, time_t age, char name[NAME_MAX + 1])
{
    char last[NAME_MAX + 1];
    put_entry(key_of(number), "x");
    count_entries(last);
    struct dirent **found;
    int             count = scandir(".", &found, is_not_dot, NULL);
    for (int i = 0; i < count; i++) {
        struct stat info;
        assert_int_equal(stat(found[i]->d_name, &info), 0);
        if (info.st_size < 1000) /* the new one is the only small one */
            snprintf(name, NAME_MAX + 1, "%s", found[i]->d_name);
        free(found[i]);
    }
    free(found);
    assert_int_equal(truncate(name, 10 << 20), 0);
    set_age(name, age);
}
