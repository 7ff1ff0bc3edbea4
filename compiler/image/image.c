/*
 * image.c: which form a file has, and what all have in common.
 */
#include "compiler/image/image.h"

#include <float.h>
#include <math.h>
#include <string.h>

bool image_fail(Image *image, const char *fault)
{
    image->fault = fault;
    return false;
}

bool image_make(Image *image)
{
    if (image->width == 0 || image->height == 0)
        return image_fail(image, "it has no pixels");
    if (image->width > image->most_side || image->height > image->most_side ||
        image_pixels(image) > image->most_pixels)
        return image_fail(image, "it has too many pixels");
    uint32_t channels = image_channels(image);
    image->samples    = arena_new_array(image->arena, float, image_pixels(image) * channels);
    for (size_t i = 0; i < image_pixels(image); i++)
        image->samples[i * channels + channels - 1] = 1;
    return true;
}

/* What is no number is 0, and what is infinite is the largest. */
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
