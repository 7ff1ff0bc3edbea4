/*
 * camera_text.h: cameras as text of the language.
 */
#ifndef KRS_CAMERA_TEXT_H
#define KRS_CAMERA_TEXT_H

#include "krs/krs.h"

/* Returns a `camera` block, with its newline; the caller frees it.  NULL: without memory. */
char *camera_text(const KrsCamera *camera);

/* Returns a block with what a camera has in place of what is `before`: properties that differ get
   other values, are added, or go; all else, comments as well, stays.  The caller frees it.  NULL:
   this is no block of a camera, or without memory. */
char *camera_text_edit(const char *block, const KrsCamera *before, const KrsCamera *camera);

/* Changes the block of the scene's camera of this number in its file, or, where the scene has none,
   adds one to the end of the file `path`; changes nothing else.  `before` is the scene's camera.
   KRS_BAD_ARGUMENT: the file is not what the scene was compiled of; KRS_IO_ERROR;
   KRS_OUT_OF_MEMORY. */
KrsStatus camera_text_write(const KrsScene *scene, size_t index, const KrsCamera *before,
                            const KrsCamera *camera, const char *path);

#endif
