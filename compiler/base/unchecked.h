/*
 * unchecked.h: calls of libraries in C that use what they could not allocate, as fontconfig does with what
 * it reads of its files.  They crash at an address near 0, or wait for a lock that they hold, long after an
 * allocation has failed, when nothing tells of it any more.  Who looks at how a process ends asks here whether
 * such a call was running.
 */
#ifndef KRS_UNCHECKED_H
#define KRS_UNCHECKED_H

#include <stdatomic.h>
#include <stdbool.h>

/* Counts calls that are running there from now on, where another process may see them, too. */
void unchecked_count_at(atomic_int *count);
void unchecked_begin(void);
void unchecked_end(void);
/* Tells whether unchecked work runs in any thread; handlers of signals may ask it. */
bool unchecked_runs(void);

#endif
