/*
 * image.c: comparing pictures away from their edges, where rays that are permitted to differ by a
 * fraction of a pixel must still agree.
 */
#include "bench/image.h"

#include <math.h>
#include <stdlib.h>

#include "bench/measure.h"

bool image_create(Image *image, uint32_t width, uint32_t height)
{
    size_t pixels = (size_t)width * height;
    *image = (Image){width, height, calloc(pixels, sizeof(float)), calloc(pixels, sizeof(float))};
    return image->alpha && image->depth;
}

void image_destroy(Image *image)
{
    free(image->alpha);
    free(image->depth);
    *image = (Image){0};
}

double image_coverage(const Image *image)
{
    size_t pixels = (size_t)image->width * image->height;
    double sum    = 0;
    for (size_t i = 0; i < pixels; i++)
        sum += image->alpha[i];
    return sum / (double)pixels;
}

/* Returns how far two depths differ, in widths of a pixel at depth b. */
static double depth_difference(float a, float b, double pixel)
{
    return fabs((double)a - b) / (pixel * b);
}

typedef enum Difference { SAME, OTHER_FATE, OTHER_DEPTH } Difference;

static Difference difference(float a, float b, double pixel)
{
    if (isinf(a) || isinf(b))
        return isinf(a) && isinf(b) ? SAME : OTHER_FATE;
    return depth_difference(a, b, pixel) > DEPTH_STEP ? OTHER_DEPTH : SAME;
}

static bool is_inside(const Image *image, uint32_t x, uint32_t y, double pixel)
{
    if (x == 0 || y == 0 || x + 1 == image->width || y + 1 == image->height)
        return false;
    const float *middle = image->depth + (size_t)y * image->width + x;
    for (int across = -1; across <= 1; across++)
        for (int down = -1; down <= 1; down++)
            if (difference(middle[down * (int)image->width + across], *middle, pixel) != SAME)
                return false;
    return true;
}

Agreement image_compare(const Image *image, const Image *reference, double pixel)
{
    size_t    pixels = (size_t)image->width * image->height, both = 0;
    Agreement found  = {0};
    double   *errors = malloc(pixels * sizeof *errors);
    for (uint32_t y = 0; y < image->height; y++)
        for (uint32_t x = 0; x < image->width; x++) {
            size_t     i      = (size_t)y * image->width + x;
            Difference here   = difference(image->depth[i], reference->depth[i], pixel);
            bool       inside = is_inside(reference, x, y, pixel);
            found.hit_differs += here == OTHER_FATE;
            found.depth_differs += here == OTHER_DEPTH;
            found.inside_differs += inside && here != SAME;
            found.inside += inside;
            if (errors && inside && here != OTHER_FATE && !isinf(reference->depth[i]))
                errors[both++] = depth_difference(image->depth[i], reference->depth[i], pixel);
        }
    found.depth_error = both > 0 ? median(errors, both) : NAN;
    free(errors);
    found.hit_differs /= (double)pixels;
    found.depth_differs /= (double)pixels;
    found.inside_differs /= (double)pixels;
    found.inside /= (double)pixels;
    return found;
}
