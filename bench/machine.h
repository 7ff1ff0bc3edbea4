/*
 * machine.h: what the figures were taken on.
 */
#ifndef KRS_BENCH_MACHINE_H
#define KRS_BENCH_MACHINE_H

#include "bench/bench.h"

/* What is written down, in this order: a name and a text each. */
typedef struct Machine {
    struct MachineFact {
        const char *name, *text;
    } facts[16];
    size_t      count;
    const char *slug; /* of the device, for file names */
} Machine;

void machine_describe(Bench *bench, Machine *machine);

#endif
