/*
 * scarce_malloc.c: in front of the C library, lets allocations fail: that with the number SCARCE_AT, or with
 * SCARCE_LASTING all from there on.  Processes tell by SCARCE_COUNT, a descriptor, how many they made.
 */
#include <dlfcn.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

typedef void *Allocate(size_t size);
typedef void *AllocateZero(size_t count, size_t size);
typedef void *Reallocate(void *block, size_t size);

static long made, failing, lasting;

__attribute__((constructor)) static void begin(void)
{
    const char *at = getenv("SCARCE_AT");
    lasting        = getenv("SCARCE_LASTING") != NULL;
    failing        = at ? atol(at) : 0;
}

__attribute__((destructor)) static void tell(void)
{
    const char *count = getenv("SCARCE_COUNT");
    char        line[32];
    int         length = snprintf(line, sizeof line, "%ld\n", made);
    if (count && write(atoi(count), line, (size_t)length) != length)
        _exit(99);
}

static int fails(void)
{
    long number = __atomic_add_fetch(&made, 1, __ATOMIC_RELAXED);
    if (!failing || number < failing || (number > failing && !lasting))
        return 0;
    errno = ENOMEM;
    return 1;
}

void *malloc(size_t size)
{
    static Allocate *next;
    if (!next)
        *(void **)&next = dlsym(RTLD_NEXT, "malloc");
    return fails() ? NULL : next(size);
}

/* dlsym itself may ask for zeros, before it has found who gives them. */
void *calloc(size_t count, size_t size)
{
    static AllocateZero *next;
    static char          early[4096];
    static size_t        used;
    static int           asking;
    if (!next && asking) {
        used += (count * size + 15) / 16 * 16;
        return used <= sizeof early ? early + used - (count * size + 15) / 16 * 16 : NULL;
    }
    if (!next) {
        asking          = 1;
        *(void **)&next = dlsym(RTLD_NEXT, "calloc");
        asking          = 0;
    }
    return fails() ? NULL : next(count, size);
}

void *realloc(void *block, size_t size)
{
    static Reallocate *next;
    if (!next)
        *(void **)&next = dlsym(RTLD_NEXT, "realloc");
    return fails() ? NULL : next(block, size);
}
