/*
 * csg.h: trees of solids as OpenSCAD writes them, .csg.
 */
#ifndef KRS_IMPORT_CSG_H
#define KRS_IMPORT_CSG_H

#include "import/common/text.h"

/* Fills `scene`, or says what is wrong, and where, and returns false. */
bool import_csg(Import *import);

#endif
