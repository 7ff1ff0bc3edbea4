/*
 * allocator.h: memory of the caller's allocator, for what the library hands out.
 */
#ifndef KRS_BASE_ALLOCATOR_H
#define KRS_BASE_ALLOCATOR_H

#include <stdlib.h>
#include <string.h>

#include "krs/krs.h"

/* Returns count * size zeroed bytes, by malloc without an allocator; NULL: memory has run out. */
static inline void *allocator_new(const KrsAllocator *allocator, size_t count, size_t size)
{
    if (!allocator->allocate)
        return calloc(count + 1, size);
    if (size > 0 && count >= SIZE_MAX / size)
        return NULL;
    void *block = allocator->allocate(allocator->user, (count + 1) * size);
    return block ? memset(block, 0, (count + 1) * size) : NULL;
}

static inline void allocator_release(const KrsAllocator *allocator, void *block)
{
    if (!allocator->allocate)
        free(block);
    else if (block)
        allocator->release(allocator->user, block);
}

#endif
