/*
 * lane_fields.h: what lanes of the host ask of a state, kept from picture to picture.
 *
 * Cells of space and their tapes are those of the values of a state, wherever the camera is.  So they are kept until other values
 * are rendered.
 */
#ifndef KRS_LANE_FIELDS_H
#define KRS_LANE_FIELDS_H

#include "rays/rays.h"
#include "rays/surfaces.h"
#include "runtime/tracer/handles.h"

/* Return fields of a state, which belong to the rendering; NULL with the failure noted. */
RayField     *lane_fields_rays(KrsRendering *rendering, KrsState *state, bool planes);
SurfaceField *lane_fields_surfaces(KrsRendering *rendering, KrsState *state, bool layers);
void          lane_fields_free(LaneFields *fields);

#endif
