/*
 * nesting.h: how deep a scene may be nested, which platform/ says: the stacks of pages are small.
 */
#ifndef KRS_NESTING_H
#define KRS_NESTING_H

#include <stdint.h>

typedef struct Nesting {
    uint32_t calls;       /* of functions within each other */
    uint32_t evaluations; /* of expressions, through calls */
} Nesting;
extern const Nesting nesting;

#endif
