/*
 * png.h: a finished 8-bit picture as a PNG file.
 *
 * RGB without alpha: the sky is part of the picture, and a PNG is for looking at; compositing
 * wants the EXR.  Of a cropped picture only the crop is written, its place in an oFFs chunk.
 */
#ifndef KRS_PNG_H
#define KRS_PNG_H

#include "runtime/writer/picture.h"

/* Writes `rgb` (three bytes a pixel, sRGB, rows from the top, of the picture's crop size) with
   the picture's words as text; channels and matrices are not looked at.  As exr_write in all
   else. */
bool png_write(const Picture *picture, const uint8_t *rgb, OutputFile *file, OutputError *error);

#endif
