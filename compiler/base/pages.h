/*
 * pages.h: how the system lays out memory.
 */
#ifndef KRS_PAGES_H
#define KRS_PAGES_H

#include <stddef.h>

/* Asks for large pages below a block, where the system has some: a hint, on which nothing depends. */
void pages_enlarge(void *block, size_t size);

#endif
