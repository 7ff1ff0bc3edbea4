/*
 * png.h: writes a finished 8-bit picture as a PNG file.
 *
 * It is RGB without alpha.  The sky is part of the picture, and a PNG is for looking at; for
 * compositing there is EXR.  Of a cropped picture only the crop is written, with its offset in an
 * oFFs chunk.
 */
#ifndef KRS_PNG_H
#define KRS_PNG_H

#include "runtime/writer/picture.h"

/* Writes `rgb` (three bytes a pixel, sRGB, rows from the top, of the size of the picture's crop),
   with the picture's texts.  Its channels and matrices are not used.  All else is as for
   exr_write. */
bool png_write(const Picture *picture, const uint8_t *rgb, OutputFile *file, OutputError *error);

/* Writes one byte a pixel, linear, of `per_metre` pixels in a metre if that can be told. */
bool png_write_mask(const Picture *picture, const uint8_t *gray, double per_metre, OutputFile *file,
                    OutputError *error);

#endif
