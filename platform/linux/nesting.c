/*
 * nesting.c: a thread has 8 MiB.
 */
#include "compiler/base/nesting.h"

const Nesting nesting = {.calls = 1000, .evaluations = 4000};
