/*
 * sets_plain.c: rays are compiled as plain C.
 */
#include "rays/lanes.h"

const RaySet *ray_set_of_lanes(void) { return &ray_set_plain; }
