/*
 * convex.h: rays through convex solids, from inside and from behind.
 */
#ifndef KRS_BENCH_CONVEX_H
#define KRS_BENCH_CONVEX_H

#include "bench/sheet.h"

/* Prints a table: how many distances a ray takes from the surface of a convex solid to where it
   leaves it, by steps through the inside, and from the exit of a ball around it back (Keinert et al.
   2014, 3.5).  On the host, in double precision. */
void compare_convex(const Sheet *sheet);

#endif
