/*
 * pixel_filter.h: what a wider filter than the box would make of the error of few samples.
 */
#ifndef KRS_BENCH_PIXEL_FILTER_H
#define KRS_BENCH_PIXEL_FILTER_H

#include "bench/sheet.h"

enum { FINE = 8 }; /* samples along each side of a pixel */

void pixel_filter_titles(const Sheet *sheet);

/* Prints rows for one sample a pixel and for four.  Both are taken from a picture with FINE x FINE, and each
   filter is compared with what it makes of that. */
void pixel_filter_rows(const Sheet *sheet, const char *scene, const KrsPicture *fine);

#endif
