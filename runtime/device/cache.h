/*
 * cache.h: what takes long to make and is often wanted again, in a folder, from run to run.
 *
 * Nothing here fails.  Where an entry cannot be read or written (no folder, a full disk, no
 * memory) or is not what was written, there is none, nobody is told, and the caller makes it
 * anew.  Entries appear whole or not at all, and any number of processes may share the folder.
 * When it grows beyond CACHE_BYTES or CACHE_FILES, what was not used for longest goes.
 *
 * The hashes find damage, not malice: whoever may write to the folder decides what the device
 * runs.  So it is made for the user alone, and files of other users are left unread.
 */
#ifndef KRS_CACHE_H
#define KRS_CACHE_H

#include <dirent.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "krs/krs.h"

#define CACHE_BYTES (UINT64_C(64) << 20)
enum { CACHE_FILES = 4096, CACHE_ENTRY_BYTES = 16 << 20 /* a longer one is not kept */ };

/* The kind of an entry; a file is called by its key and one of these. */
typedef enum CacheKind {
    CACHE_SPIRV,
    CACHE_PIPELINES,
    CACHE_STRUCTURE, /* whether scenes of a structure are edited; it is compiled from nothing */
    CACHE_LOSS,      /* what pictures without a shader have lost (film/executor.c) */
    CACHE_KIND_COUNT
} CacheKind;

/* A folder of entries that one thread at a time uses; zero is a cache that keeps nothing. */
typedef struct Cache {
    KrsAllocator allocator;
    DIR         *folder;
    uint64_t     bytes; /* of its files, as far as is known after the first entry written */
    size_t       files;
} Cache;

typedef struct CacheKey {
    unsigned char bytes[16];
} CacheKey;

/* Opens the folder, which is made if it is missing; NULL or "" is a cache that keeps nothing. */
void cache_open(Cache *cache, const char *folder, KrsAllocator allocator);
void cache_close(Cache *cache);
/* Tells whether nothing is kept in a folder, as before the first picture. */
bool cache_is_empty(const char *folder);

/* Returns the key of what is made from `content` by whatever `maker` names, versions included. */
CacheKey cache_key(const char *maker, const void *content, size_t length);

/* Returns the entry as it was written, in memory of the allocator that is the caller's; NULL when
   there is none. */
void *cache_load(Cache *cache, CacheKind kind, CacheKey key, size_t *length);
/* Writes an entry, or replaces it. */
void cache_store(Cache *cache, CacheKind kind, CacheKey key, const void *bytes, size_t length);

#endif
