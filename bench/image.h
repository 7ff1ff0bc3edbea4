/*
 * image.h: what pictures are compared by: what share of a pixel is covered, and how far away.
 */
#ifndef KRS_BENCH_IMAGE_H
#define KRS_BENCH_IMAGE_H

#include "krs/vulkan.h"

typedef struct Image {
    uint32_t width, height;
    float   *alpha; /* 0 to 1 */
    float   *depth; /* along the view axis; infinite where nothing is hit */
} Image;

/* Room for a picture; false when there is none. */
bool image_create(Image *image, uint32_t width, uint32_t height);
void image_destroy(Image *image);

/* The mean of alpha. */
double image_coverage(const Image *image);

/*
 * Tells where a picture differs from the reference, as shares of all pixels: in whether there is a
 * hit, or by more than DEPTH_STEP widths of a pixel in depth.  A pixel is inside where, in the
 * reference, neither its own eight neighbours nor those of another tracer could see past an edge:
 * all of the nine are hit, or all missed, with no such step in depth between them.
 */
#define DEPTH_STEP 8.0
typedef struct Agreement {
    double hit_differs, depth_differs; /* anywhere */
    double inside_differs;             /* inside, in either way */
    double inside;                     /* how much of the picture is inside */
    double depth_error; /* median of the difference in depth inside, in widths of a pixel there */
} Agreement;

/* `pixel` is the width of a pixel at depth 1. */
Agreement image_compare(const Image *image, const Image *reference, double pixel);

#endif
