/*
 * exr.h: a picture as an OpenEXR file: scanlines, ZIP, any number of channels.
 */
#ifndef KRS_EXR_H
#define KRS_EXR_H

#include "runtime/writer/picture.h"

/* Writes the picture to a file that output_open began; the caller commits it.  False, with the
   reason in *error (the one given to output_open), when it cannot: a full disk, no memory.
   Equal pictures make equal bytes. */
bool exr_write(const Picture *picture, OutputFile *file, OutputError *error);

/* The nearest half-precision number, ties to even.  Finite numbers beyond the largest half
   become that (65504), so that a very bright pixel does not turn into an infinite one, which
   no filter survives; infinities and NaN stay what they are. */
uint16_t half_from_float(float number);

#endif
