/*
 * scene_tables.h: the tables of a scene on a device.
 */
#ifndef KRS_SCENE_TABLES_H
#define KRS_SCENE_TABLES_H

#include "runtime/tracer/handles.h"

/* Makes room for the tables of the scene, if it has some. */
bool scene_tables_create(KrsRendering *rendering);
/* Binds them, or idle ones, in the scene's set. */
void scene_tables_bind(KrsRendering *rendering);
/* Brings the tables of the state to the device, unless they are there; for points that are relative to an
   origin, or NULL.  Frames differ in what their tables depend on (krs_state_table_inputs), and in nothing else. */
bool scene_tables_upload(KrsRendering *rendering, const KrsState *state,
                         const double *rebase_origin);

#endif
