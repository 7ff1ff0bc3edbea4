/*
 * settings.h: completes the options of a picture, and checks them.
 */
#ifndef KRS_SETTINGS_H
#define KRS_SETTINGS_H

#include "runtime/tracer/handles.h"

/* Fills in what the caller has left open, from the scene or by default, and checks all options.
   *asked is the schedule as the caller asked for it.  False with the reason noted. */
bool settings_complete(KrsRendering *rendering, KrsRenderOptions *options, KrsSchedule *asked);

#endif
