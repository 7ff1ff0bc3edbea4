/*
 * settings.h: what is asked for, with nothing left to be defaulted.
 */
#ifndef KRS_SETTINGS_H
#define KRS_SETTINGS_H

#include "runtime/tracer/handles.h"

/* Puts the scene's wishes and the defaults where the caller has none, and checks all; *asked is the
   schedule as it was asked for.  False with the reason noted. */
bool settings_complete(KrsRendering *rendering, KrsRenderOptions *options, KrsSchedule *asked);

#endif
