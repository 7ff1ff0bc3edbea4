/*
 * pages.c: large pages.
 */
#include "compiler/base/pages.h"

#include <stdint.h>
#include <sys/mman.h>

/* Large blocks are filled from one end to the other, and are looked up everywhere: each page less is a fault less. */
enum { LARGE_PAGE = 2 << 20 };

void pages_enlarge(void *block, size_t size)
{
    const uintptr_t first = ((uintptr_t)block + LARGE_PAGE - 1) / LARGE_PAGE * LARGE_PAGE;
    const uintptr_t end   = ((uintptr_t)block + size) / LARGE_PAGE * LARGE_PAGE;
    if (end > first)
        madvise((void *)first, end - first, MADV_HUGEPAGE);
}
