/*
 * pov.h: scenes of POV-Ray, .pov.
 */
#ifndef KRS_IMPORT_POV_H
#define KRS_IMPORT_POV_H

#include "import/common/text.h"

/* Fills `scene`, or says what is wrong, and where, and returns false. */
bool import_pov(Import *import);

#endif
