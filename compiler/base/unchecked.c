/*
 * unchecked.c: calls of libraries in C that use what they could not allocate.
 */
#include "compiler/base/unchecked.h"

static atomic_int  own;
static atomic_int *running = &own;

void unchecked_count_at(atomic_int *count) { running = count; }

void unchecked_begin(void) { atomic_fetch_add(running, 1); }

void unchecked_end(void) { atomic_fetch_sub(running, 1); }

bool unchecked_runs(void) { return atomic_load(running) > 0; }
