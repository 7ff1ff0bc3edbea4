/*
 * image.h: pictures read from files, PNG and OpenEXR, as linear numbers.
 */
#ifndef KRS_IMAGE_H
#define KRS_IMAGE_H

#include <stddef.h>
#include <stdint.h>

#include "compiler/base/arena.h"

/* The meaning of the numbers of a file as brightness. */
typedef enum ImageSpace {
    SPACE_OF_FILE, /* PNG: sRGB; EXR: linear */
    SPACE_SRGB,
    SPACE_LINEAR,
    SPACE_COUNT
} ImageSpace;

typedef struct Image {
    Arena     *arena; /* for the samples, and for what is needed while reading */
    ImageSpace space;
    uint32_t   max_side, max_pixels;
    uint32_t   width, height;
    bool       gray;
    float *samples; /* rows from the top; of a pixel gray and alpha, or red, green, blue and alpha.
                           Colours are linear, and multiplied by alpha; all are finite */
    const char *fault; /* why it cannot be read */
} Image;

/* Reads a picture; false: `fault` says why. */
bool image_read(Image *image, const unsigned char *bytes, size_t length);

/* ---- what the forms share ---- */

bool image_read_png(Image *image, const unsigned char *bytes, size_t length);
bool image_read_exr(Image *image, const unsigned char *bytes, size_t length);
bool image_fail(Image *image, const char *fault);
/* Makes the samples of an image whose size and `gray` are set; all are 0, alpha is 1. */
bool image_make(Image *image);
/* Tells how many floats a pixel has. */
static inline uint32_t image_channels(const Image *image) { return image->gray ? 2 : 4; }
static inline size_t   image_pixels(const Image *image)
{
    return (size_t)image->width * image->height;
}

#endif
