/*
 * saving.h: what the viewer saves, and under which names.
 */
#ifndef KRS_SAVING_H
#define KRS_SAVING_H

#include "live/viewing.h"

/* Keeps the picture that is seen, as a PNG in the current folder. */
void saving_keep_shot(Viewing *viewing);
/* Begins to save in the background what the panel says; if it is being saved, gives that up. */
void saving_start_or_stop(Viewing *viewing);

#endif
