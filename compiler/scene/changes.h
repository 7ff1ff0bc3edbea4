/*
 * changes.h: what is different in a scene that was edited.
 */
#ifndef KRS_CHANGES_H
#define KRS_CHANGES_H

#include "compiler/scene/program.h"

/* From `a` to `b`; KRS_OUT_OF_MEMORY: it is not known. */
KrsStatus scene_changes(const KrsScene *a, const KrsScene *b, KrsChanges *changes);

#endif
