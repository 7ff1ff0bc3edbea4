/*
 * any_exr.h: all channels of an OpenEXR file, of any program.
 */
#ifndef KRS_CLI_ANY_EXR_H
#define KRS_CLI_ANY_EXR_H

#include <OpenEXR/openexr.h>

#include "cli/shell/commands.h"
#include "runtime/writer/picture.h"

typedef struct AnyExr {
    const char      *path;
    exr_context_t    context; /* open, for its attributes */
    exr_attr_box2i_t display, data;
    PictureChannel  *channels; /* with room for three more */
    float          **planes;   /* their samples; of integers, as such */
    size_t           count, width, height;
} AnyExr;

/* Reads a file with one picture, in scanlines or tiles.  On any other status than KRS_OK, it has said why. */
KrsStatus any_exr_read(const Options *options, const char *path, AnyExr *exr);
void      any_exr_free(AnyExr *exr);

#endif
