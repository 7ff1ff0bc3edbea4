/*
 * exr.h: a picture as an OpenEXR file: scanlines, ZIP, any number of channels.
 */
#ifndef KRS_EXR_H
#define KRS_EXR_H

#include <OpenEXR/openexr.h>

#include "runtime/writer/picture.h"

/* Writes the picture to a file of output_open; the caller commits it.  False, with the reason in
   the *error that was given to output_open, when it cannot: a full disk, no memory.  Equal pictures
   make equal bytes. */
bool exr_write(const Picture *picture, OutputFile *file, OutputError *error);
/* Does the same with the windows and attributes of a file that is open, which may be of any program, in place of the
   picture's own. */
bool exr_write_like(const Picture *picture, exr_const_context_t like, OutputFile *file,
                    OutputError *error);

#endif
