/*
 * history.h: what was seen before, for undo and redo: cameras, values and the time.
 */
#ifndef KRS_HISTORY_H
#define KRS_HISTORY_H

#include "live/pictures/canvas.h"

typedef struct History History;

History *history_new(void); /* NULL: without memory */
void     history_free(History *history);

/* Notes what is seen, at this time in seconds.  Changes that follow each other without a pause are one
   step: a gesture of the mouse. */
void history_note(History *history, const View *view, double now);
/* Takes camera, time and, where they are of the same version, values from the step before, or after.
   False: there is none. */
bool history_undo(History *history, View *view);
bool history_redo(History *history, View *view);

#endif
