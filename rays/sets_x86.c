/*
 * sets_x86.c: the instruction sets of x86-64 that rays are compiled for.
 */
#include <string.h>

#include "compiler/graph/lanes/lanes.h"
#include "rays/lanes.h"

const RaySet *ray_set_of_lanes(void)
{
    static const RaySet *const sets[] = {&ray_set_plain, &ray_set_avx2, &ray_set_avx512};
    const char                *name   = lane_used_set()->name;
    for (size_t i = 0; i < sizeof sets / sizeof *sets; i++)
        if (strcmp(sets[i]->name, name) == 0)
            return sets[i];
    return &ray_set_plain;
}
