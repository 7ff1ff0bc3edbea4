/*
 * picture_file.h: pictures as files.
 */
#ifndef KRS_PICTURE_FILE_H
#define KRS_PICTURE_FILE_H

#include "live/pictures/canvas.h"

/* Writes the picture of a view: as EXR with all its AOVs where the name ends in .exr, else as PNG.
   The file appears whole or not at all.  On any status but KRS_OK `why` is one line. */
KrsStatus picture_file_write(const KrsPicture *picture, const View *view, const char *path,
                             char why[300]);

#endif
