/*
 * cache.c: one file an entry: a header in which every byte is checked, and the content.
 *
 * An entry is written to a temporary file and renamed to its name.  It is not flushed to the
 * disk: after a power failure it may be damaged, which is found out by its hash.
 */
#include "runtime/device/cache.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#include <xxhash.h>

#include "compiler/base/allocator.h"
#include "compiler/base/fingerprints.h"

enum {
    KEY_DIGITS       = 2 * sizeof(CacheKey),
    NAME_SIZE        = 64,
    TOUCH_SECONDS    = 60,   /* uses closer together than this count as one */
    ORPHANED_SECONDS = 3600, /* nobody writes to a temporary file for so long */
};

static const char *const endings[CACHE_KIND_COUNT] = {
    [CACHE_SPIRV]     = ".spirv",
    [CACHE_PIPELINES] = ".pipelines",
    [CACHE_STRUCTURE] = ".structure",
    [CACHE_LOSS]      = ".loss",
};
static const char temporary_prefix[] = ".krs-cache-";

/* The header of a file, in the byte order of the machine: foreign numbers do not match.  It has no
   padding. */
typedef struct Header {
    char     magic[8];
    uint64_t kind;
    uint64_t length;    /* of the content */
    CacheKey key, hash; /* hash: of the content */
} Header;

_Static_assert(sizeof(Header) == 56, "a byte between the members would go unchecked");

static CacheKey hash_bytes(const void *bytes, size_t length)
{
    XXH128_canonical_t digest;
    CacheKey           hash;
    XXH128_canonicalFromHash(&digest, XXH3_128bits(bytes, length));
    memcpy(hash.bytes, digest.digest, sizeof hash.bytes);
    return hash;
}

/* A text of any length is hashed by itself, then with the words before it, and with the sources
   that make an entry of it and lay it out. */
CacheKey cache_key(const char *maker, const void *content, size_t length)
{
    CacheKey hashes[3] = {hash_bytes(maker, strlen(maker)), hash_bytes(content, length),
                          hash_bytes(fingerprint_cache, strlen(fingerprint_cache))};
    return hash_bytes(hashes, sizeof hashes);
}

static Header make_header(CacheKind kind, CacheKey key, const void *bytes, size_t length)
{
    return (Header){.magic  = "krskept",
                    .kind   = kind,
                    .length = length,
                    .key    = key,
                    .hash   = hash_bytes(bytes, length)};
}

static void make_name(char name[NAME_SIZE], CacheKind kind, CacheKey key)
{
    for (size_t i = 0; i < sizeof key.bytes; i++)
        snprintf(name + 2 * i, 3, "%02x", key.bytes[i]);
    snprintf(name + KEY_DIGITS, NAME_SIZE - KEY_DIGITS, "%s", endings[kind]);
}

/* ---- The folder ---- */

/* Makes a folder with those above it, where they are missing. */
static void make_folders(const char *folder)
{
    char path[PATH_MAX];
    if ((size_t)snprintf(path, sizeof path, "%s", folder) >= sizeof path)
        return;
    for (char *slash = strchr(path + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        mkdir(path, 0700);
        *slash = '/';
    }
    mkdir(path, 0700);
}

void cache_open(Cache *cache, const char *folder, KrsAllocator allocator)
{
    *cache = (Cache){.allocator = allocator};
    if (!folder || !*folder)
        return;
    cache->folder = opendir(folder);
    if (!cache->folder && errno == ENOENT) {
        make_folders(folder);
        cache->folder = opendir(folder);
    }
}

void cache_close(Cache *cache)
{
    if (cache->folder)
        closedir(cache->folder);
    *cache = (Cache){0};
}

/* ---- Reading ---- */

static bool read_fully(int fd, void *bytes, size_t length)
{
    char *next = bytes;
    while (length > 0) {
        ssize_t got = read(fd, next, length);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return false;
        next += got;
        length -= (size_t)got;
    }
    return true;
}

/* Marks a file as used, so that what is in use outlives what is not.  In the folder of another
   user, or on a disk that cannot be written, it has no effect. */
static void touch(int fd, const struct stat *info)
{
    if (time(NULL) - info->st_mtime > TOUCH_SECONDS)
        (void)futimens(fd, NULL);
}

/* Reads the content behind a header that the file must have; NULL when it does not. */
static void *read_entry(const Cache *cache, int fd, CacheKind kind, CacheKey key, size_t *length)
{
    struct stat info;
    Header      found;
    if (fstat(fd, &info) != 0 || !S_ISREG(info.st_mode) || info.st_uid != geteuid() ||
        !read_fully(fd, &found, sizeof found) || found.length > CACHE_ENTRY_BYTES ||
        (uint64_t)info.st_size != sizeof found + found.length)
        return NULL;
    *length     = (size_t)found.length;
    void *bytes = allocator_new(&cache->allocator, *length, 1);
    if (!bytes)
        return NULL;
    if (read_fully(fd, bytes, *length)) {
        Header expected = make_header(kind, key, bytes, *length);
        if (memcmp(&found, &expected, sizeof found) == 0) {
            touch(fd, &info);
            return bytes;
        }
    }
    allocator_release(&cache->allocator, bytes);
    return NULL;
}

void *cache_load(Cache *cache, CacheKind kind, CacheKey key, size_t *length)
{
    char name[NAME_SIZE];
    if (!cache->folder)
        return NULL;
    make_name(name, kind, key);
    int fd = openat(dirfd(cache->folder), name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0)
        return NULL;
    void *bytes = read_entry(cache, fd, kind, key, length);
    close(fd);
    return bytes;
}

/* ---- The bound ---- */

/* A file of ours, with what decides whether it stays. */
typedef struct Kept {
    char            name[NAME_SIZE];
    uint64_t        bytes;
    struct timespec used;
} Kept;

static bool is_entry(const char *name)
{
    if (strspn(name, "0123456789abcdef") != KEY_DIGITS)
        return false;
    for (int kind = 0; kind < CACHE_KIND_COUNT; kind++)
        if (strcmp(name + KEY_DIGITS, endings[kind]) == 0)
            return true;
    return false;
}

/* Tells whether a file is a temporary one whose writer did not live to rename it. */
static bool is_orphan(const char *name, const struct stat *info)
{
    return strncmp(name, temporary_prefix, strlen(temporary_prefix)) == 0 &&
           time(NULL) - info->st_mtime > ORPHANED_SECONDS;
}

/* Finds the next entry of the folder; orphans on the way are removed.  False at the end. */
static bool next_entry(const Cache *cache, Kept *kept)
{
    const struct dirent *found;
    struct stat          info;
    while ((found = readdir(cache->folder))) {
        const char *name  = found->d_name;
        bool        entry = is_entry(name);
        if ((!entry && name[0] != '.') ||
            fstatat(dirfd(cache->folder), name, &info, AT_SYMLINK_NOFOLLOW) != 0 ||
            !S_ISREG(info.st_mode))
            continue;
        if (entry) {
            *kept = (Kept){.bytes = (uint64_t)info.st_size, .used = info.st_mtim};
            memcpy(kept->name, name, strlen(name) + 1); /* as long as those of make_name */
            return true;
        }
        if (is_orphan(name, &info))
            unlinkat(dirfd(cache->folder), name, 0);
    }
    return false;
}

bool cache_is_empty(const char *folder)
{
    Cache cache;
    Kept  kept;
    cache_open(&cache, folder, (KrsAllocator){0});
    const bool empty = !cache.folder || !next_entry(&cache, &kept);
    cache_close(&cache);
    return empty;
}

static void count_entries(Cache *cache)
{
    Kept kept;
    cache->bytes = 0;
    cache->files = 0;
    rewinddir(cache->folder);
    while (next_entry(cache, &kept)) {
        cache->bytes += kept.bytes;
        cache->files++;
    }
}

static bool is_too_large(const Cache *cache)
{
    return cache->bytes > CACHE_BYTES || cache->files > CACHE_FILES;
}

static int oldest_first(const void *left, const void *right)
{
    const struct timespec *a = &((const Kept *)left)->used, *b = &((const Kept *)right)->used;
    if (a->tv_sec != b->tv_sec)
        return a->tv_sec < b->tv_sec ? -1 : 1;
    return (a->tv_nsec > b->tv_nsec) - (a->tv_nsec < b->tv_nsec);
}

/* Removes the oldest entries until a quarter of the room is free, so that it is not done anew
   with every entry. */
static void remove_oldest(Cache *cache)
{
    size_t capacity = cache->files, count = 0;
    Kept  *kept = allocator_new(&cache->allocator, capacity, sizeof *kept);
    if (!kept)
        return;
    cache->bytes = 0;
    rewinddir(cache->folder);
    while (count < capacity && next_entry(cache, &kept[count]))
        cache->bytes += kept[count++].bytes;
    cache->files = count;
    qsort(kept, count, sizeof *kept, oldest_first);
    for (size_t i = 0; i < count; i++) {
        if (cache->bytes <= CACHE_BYTES / 4 * 3 && cache->files <= CACHE_FILES / 4 * 3)
            break;
        unlinkat(dirfd(cache->folder), kept[i].name, 0);
        cache->bytes -= kept[i].bytes;
        cache->files--;
    }
    allocator_release(&cache->allocator, kept);
}

/* Removes files when one of `bytes` was added.  The folder is looked through for the first one and
   when it seems full: in between, what others write is not seen. */
static void keep_the_bound(Cache *cache, uint64_t bytes)
{
    bool first = cache->files == 0;
    cache->bytes += bytes;
    cache->files++;
    if (first || is_too_large(cache))
        count_entries(cache);
    if (is_too_large(cache))
        remove_oldest(cache);
}

/* ---- Writing ---- */

static bool write_fully(int fd, const void *bytes, size_t length)
{
    const char *next = bytes;
    while (length > 0) {
        ssize_t put = write(fd, next, length);
        if (put < 0 && errno == EINTR)
            continue;
        if (put <= 0)
            return false;
        next += put;
        length -= (size_t)put;
    }
    return true;
}

/* Returns a new file for the user alone, with a name that no other writer has; -1 when there is
   none. */
static int create_temporary(const Cache *cache, char name[NAME_SIZE])
{
    for (unsigned attempt = 0; attempt < 100; attempt++) {
        struct timespec now;
        clock_gettime(CLOCK_REALTIME, &now);
        snprintf(name, NAME_SIZE, "%s%ld-%ld-%u.tmp", temporary_prefix, (long)getpid(), now.tv_nsec,
                 attempt);
        int fd = openat(dirfd(cache->folder), name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
        if (fd >= 0 || errno != EEXIST)
            return fd;
    }
    return -1;
}

void cache_store(Cache *cache, CacheKind kind, CacheKey key, const void *bytes, size_t length)
{
    char name[NAME_SIZE], temporary[NAME_SIZE];
    if (!cache->folder || length > CACHE_ENTRY_BYTES)
        return;
    int fd = create_temporary(cache, temporary);
    if (fd < 0)
        return;
    Header header  = make_header(kind, key, bytes, length);
    bool   written = write_fully(fd, &header, sizeof header) && write_fully(fd, bytes, length);
    written        = close(fd) == 0 && written;
    make_name(name, kind, key);
    int folder = dirfd(cache->folder);
    if (written && renameat(folder, temporary, folder, name) == 0)
        keep_the_bound(cache, sizeof header + length);
    else
        unlinkat(folder, temporary, 0);
}
