/*
 * read.c: which form a file has, and that its numbers are finite.
 */
#include "compiler/image/image.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Sets what is no number to 0, and what is infinite to the largest number. */
static void make_finite(Image *image)
{
    const size_t count = image_pixels(image) * image_channels(image);
    for (size_t i = 0; i < count; i++) {
        float *sample = &image->samples[i];
        if (isnan(*sample))
            *sample = 0;
        else if (isinf(*sample))
            *sample = *sample > 0 ? FLT_MAX : -FLT_MAX;
    }
}

bool image_read(Image *image, const unsigned char *bytes, size_t length)
{
    static const unsigned char png[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    static const unsigned char exr[] = {0x76, 0x2f, 0x31, 0x01};
    bool                       read  = false;
    if (length >= sizeof png && memcmp(bytes, png, sizeof png) == 0)
        read = image_read_png(image, bytes, length);
    else if (length >= sizeof exr && memcmp(bytes, exr, sizeof exr) == 0)
        read = image_read_exr(image, bytes, length);
    else
        image_fail(image, "it is neither a PNG nor an OpenEXR file");
    if (read)
        make_finite(image);
    return read;
}
