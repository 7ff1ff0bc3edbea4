/*
 * cache_folder.h: a cache in an empty folder for each test of a group, and its files.
 */
#ifndef UNIT_CACHE_FOLDER_H
#define UNIT_CACHE_FOLDER_H

#include <dirent.h>
#include <limits.h>
#include <time.h>

#include "runtime/device/cache.h"
#include "tests/support/folder.h"

extern Cache cache;

/* For cmocka's groups. */
int enter_cache(void **state);
int leave_cache(void **state);

int is_not_dot(const struct dirent *entry);
/* Returns how many files are in the folder; `name` becomes that of one of them. */
int count_entries(char name[NAME_MAX + 1]);
/* Entries are told apart by a number. */
CacheKey key_of(int number);
bool     holds(CacheKey key, const char *content);
void     put_entry(CacheKey key, const char *content);
size_t   read_whole(const char *name, char *bytes, size_t size);
void     write_whole(const char *name, const char *bytes, size_t length);
/* How long ago a file was used, by its own account. */
void set_age(const char *name, time_t seconds);
/* An entry's place taken by a file of many bytes that need no room on the disk. */
void make_large(int number, time_t age, char name[NAME_MAX + 1]);

#define in_cache(test) cmocka_unit_test_setup_teardown(test, enter_cache, leave_cache)

#endif
