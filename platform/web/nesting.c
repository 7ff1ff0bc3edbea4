/*
 * nesting.c: a worker has about 1 MB, of which a call takes 2.5 kB at worst.
 */
#include "compiler/base/nesting.h"

const Nesting nesting = {.calls = 200, .evaluations = 1000};
