/*
 * processors.c: a page's worker has one thread.
 */
#include "compiler/base/parallel.h"

size_t parallel_parts(void) { return 1; }

void run_in_parallel(void (*work)(void *task, size_t part, size_t parts), void *task)
{
    work(task, 0, 1);
}
