/*
 * text_edit.h: from the viewer back to the text of the scene.
 */
#ifndef KRS_TEXT_EDIT_H
#define KRS_TEXT_EDIT_H

#include "krs/krs.h"

/* Writes values into the defaults of the scene's parameters, where they differ, and changes nothing
   else of its files.  *written is how many were.  KRS_BAD_ARGUMENT: a file is not what the scene was
   compiled of; KRS_IO_ERROR. */
KrsStatus write_defaults(const KrsScene *scene, const double (*values)[4], size_t *written);

#endif
