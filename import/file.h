/*
 * file.h: from a file of another program to a scene that checks.
 */
#ifndef KRS_IMPORT_FILE_H
#define KRS_IMPORT_FILE_H

#include "import/common/text.h"
#include "krs/krs.h"

/* Returns the endings that are known, a blank between two. */
const char *import_endings(void);
/* Tells whether the name has one of these endings. */
bool import_knows(const char *path);

/* Fills `scene` with a text that compiles without a mistake.  KRS_BAD_SCENE: `refusal` says which
   line of the file is in the way, and why. */
KrsStatus import_file(Import *import);

#endif
