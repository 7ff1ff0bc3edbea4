/*
 * scarce.h: memory that runs out when a test wants it to.
 */
#ifndef SUPPORT_SCARCE_H
#define SUPPORT_SCARCE_H

#include <stdbool.h>
#include <stdint.h>

#include "krs/krs.h"

/* Zero it: then no allocation fails. */
typedef struct Scarce {
    int64_t made;    /* allocations so far */
    int64_t failing; /* the number of the one that fails, from 1 */
    bool    lasting; /* all after it fail, too */
    int64_t held;    /* blocks that nobody has given back */
} Scarce;

/* Lives as long as `scarce`. */
KrsAllocator scarce_allocator(Scarce *scarce);

#endif
