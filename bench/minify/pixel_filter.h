/*
 * pixel_filter.h: what a wider filter than the box would make of the error of few samples.
 */
#ifndef KRS_BENCH_PIXEL_FILTER_H
#define KRS_BENCH_PIXEL_FILTER_H

#include "bench/sheet.h"

enum { FINE = 8 }; /* samples along each side of a pixel */

void pixel_filter_titles(const Sheet *sheet);

/* Of one sample a pixel and of four, taken from a picture with FINE x FINE, which is also what they
   are held against, each filter against itself. */
void pixel_filter_rows(const Sheet *sheet, const char *scene, const KrsPicture *fine);

#endif
