/*
 * changes.h: what is different in a scene that was edited.
 */
#ifndef KRS_CHANGES_H
#define KRS_CHANGES_H

#include "compiler/scene/program.h"

/* Finds the changes from `a` to `b`; KRS_OUT_OF_MEMORY: they are not known. */
KrsStatus scene_changes(const KrsScene *a, const KrsScene *b, KrsChanges *changes);

#endif
