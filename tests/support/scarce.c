/*
 * scarce.c: memory that runs out when a test wants it to.
 */
#include "tests/support/scarce.h"

#include <stdlib.h>

static void *allocate(void *user, size_t size)
{
    Scarce *scarce = user;
    scarce->made++;
    bool later = scarce->failing > 0 && scarce->made > scarce->failing;
    if (scarce->made == scarce->failing || (later && scarce->lasting))
        return NULL;
    scarce->held++;
    return malloc(size);
}

static void release(void *user, void *block)
{
    ((Scarce *)user)->held -= block != NULL;
    free(block);
}

KrsAllocator scarce_allocator(Scarce *scarce) { return (KrsAllocator){allocate, release, scarce}; }
