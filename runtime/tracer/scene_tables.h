/*
 * scene_tables.h: the tables of a scene on a device.
 */
#ifndef KRS_SCENE_TABLES_H
#define KRS_SCENE_TABLES_H

#include "runtime/tracer/handles.h"

/* Makes room for the tables, and binds it in the scene's set. */
bool scene_tables_create(KrsRendering *rendering);
/* Brings the tables to the device, unless they are there.  They are the same for all frames. */
bool scene_tables_upload(KrsRendering *rendering, const KrsFrame *frame);

#endif
