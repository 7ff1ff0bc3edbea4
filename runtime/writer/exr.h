/*
 * exr.h: a picture as an OpenEXR file: scanlines, ZIP, any number of channels.
 */
#ifndef KRS_EXR_H
#define KRS_EXR_H

#include "runtime/writer/picture.h"

/* Writes the picture to a file of output_open; the caller commits it.  False, with the reason in
   the *error that was given to output_open, when it cannot: a full disk, no memory.  Equal pictures
   make equal bytes. */
bool exr_write(const Picture *picture, OutputFile *file, OutputError *error);

/* The nearest half-precision number, ties to even.  Finite numbers beyond the largest half become
   65504, that half.  So a very bright pixel does not become infinite, which no filter survives.
   Infinities and NaN stay as they are. */
uint16_t half_from_float(float number);

#endif
