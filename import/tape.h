/*
 * tape.h: tapes of operations, .vm, as fidget and libfive's kin write them.
 */
#ifndef KRS_IMPORT_TAPE_H
#define KRS_IMPORT_TAPE_H

#include "import/common/text.h"

/* Fills `scene`, or says what is wrong, and where, and returns false. */
bool import_tape(Import *import);

#endif
