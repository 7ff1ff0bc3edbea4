/*
 * slots.h: how much room there is in the parameter block.
 */
#ifndef KRS_SLOTS_H
#define KRS_SLOTS_H

#include "runtime/tracer/handles.h"

/* How many slots of values of the frame the host fills in: all, or none where the device has no
   room. */
uint32_t rendering_value_slots(const KrsRendering *rendering);
/* The slots of the whole block; 0 with the failure noted where the device has no room. */
uint32_t rendering_slots(const KrsRendering *rendering);

#endif
