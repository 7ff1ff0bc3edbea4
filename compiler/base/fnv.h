/*
 * fnv.h: the hash FNV-1a (Fowler, Noll, Vo) of 64 bits.
 */
#ifndef KRS_FNV_H
#define KRS_FNV_H

#include <stddef.h>
#include <stdint.h>

#define FNV_START 0xcbf29ce484222325u

/* Returns the hash of what has been hashed so far, or FNV_START, and of these bytes. */
static inline uint64_t fnv_bytes(uint64_t hash, const void *bytes, size_t length)
{
    const unsigned char *byte = bytes;
    for (size_t i = 0; i < length; i++)
        hash = (hash ^ byte[i]) * 0x100000001b3u;
    return hash;
}

/* Returns a number for hash tables, whose low bits count. */
static inline size_t fnv_slot(const char *bytes, size_t length)
{
    const uint64_t hash = fnv_bytes(FNV_START, bytes, length);
    return (size_t)(hash ^ hash >> 32);
}

#endif
