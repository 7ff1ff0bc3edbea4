/*
 * emissive.h: balls around what emits light in a state, for paths.
 */
#ifndef KRS_TRACER_EMISSIVE_H
#define KRS_TRACER_EMISSIVE_H

#include "runtime/tracer/handles.h"

/* Finds them, relative to the origin of points.  Returns how many. */
uint32_t emissive_find(const KrsProgram *program, const KrsCamera *camera, KrsState *state,
                       const double rebase_origin[3], EmissiveBlock balls[MAX_EMISSIVE]);

#endif
