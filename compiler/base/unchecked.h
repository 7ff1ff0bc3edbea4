/*
 * unchecked.h: calls of libraries in C that use what they could not allocate, as fontconfig does with what
 * it reads of its files.  They crash at an address near 0, long after an allocation has failed, when nothing
 * tells of it any more.  Who looks at crashes asks here whether such a call was running.
 */
#ifndef KRS_UNCHECKED_H
#define KRS_UNCHECKED_H

#include <stdbool.h>

void unchecked_begin(void);
void unchecked_end(void);
/* Of any thread; may be asked by handlers of signals. */
bool unchecked_runs(void);

#endif
