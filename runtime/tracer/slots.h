/*
 * slots.h: the size of the parameter block, in slots of four numbers.
 */
#ifndef KRS_SLOTS_H
#define KRS_SLOTS_H

#include "runtime/tracer/handles.h"

/* Tells whether points may be camera-relative: the scene may need it, and the device has room for the slots. */
bool rendering_rebases(const KrsRendering *rendering);
/* Returns the slots of state values that the host computes.  Where the device has no room for all
   of them it is 0, and shaders compute them. */
uint32_t rendering_value_slots(const KrsRendering *rendering);
/* Returns all slots of the block; 0, with the failure noted, where the device has no room for
   them. */
uint32_t rendering_slots(const KrsRendering *rendering);

#endif
