/*
 * image.c: what all forms of files have in common.
 */
#include "compiler/image/image.h"

bool image_fail(Image *image, const char *fault)
{
    image->fault = fault;
    return false;
}

bool image_make(Image *image)
{
    if (image->width == 0 || image->height == 0)
        return image_fail(image, "it has no pixels");
    if (image->width > image->max_side || image->height > image->max_side ||
        image_pixels(image) > image->max_pixels)
        return image_fail(image, "it has too many pixels");
    uint32_t channels = image_channels(image);
    image->samples    = arena_new_array(image->arena, float, image_pixels(image) * channels);
    for (size_t i = 0; i < image_pixels(image); i++)
        image->samples[i * channels + channels - 1] = 1;
    return true;
}
