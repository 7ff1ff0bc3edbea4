/*
 * jsurf.h: surfaces of SURFER and jsurf, .jsurf.
 */
#ifndef KRS_IMPORT_JSURF_H
#define KRS_IMPORT_JSURF_H

#include "import/common/text.h"

/* Fills `scene`, or says what is wrong, and where, and returns false. */
bool import_jsurf(Import *import);

#endif
