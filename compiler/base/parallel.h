/*
 * parallel.h: work that is shared by all processors.
 */
#ifndef KRS_BASE_PARALLEL_H
#define KRS_BASE_PARALLEL_H

#include <stddef.h>

enum { MAX_PARTS = 16 };

/*
 * Calls work(task, part, parts) once for each part from 0 to parts - 1, at the same time, and returns
 * when all have ended.  There are as many parts as processors that this process may use, 1 to MAX_PARTS.
 * Parts write to different places and allocate nothing.  Where no thread can be created the caller's
 * thread does the part.
 */
void run_in_parallel(void (*work)(void *task, size_t part, size_t parts), void *task);

/* Tells how many parts there are now. */
size_t parallel_parts(void);

/* Returns where a part of `count` items begins; part `parts` begins behind the last item. */
static inline size_t part_begin(size_t count, size_t part, size_t parts)
{
    return count / parts * part + count % parts * part / parts;
}

#endif
