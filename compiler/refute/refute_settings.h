/*
 * refute_settings.h: values of parameters at which distances are searched.
 */
#ifndef KRS_REFUTE_SETTINGS_H
#define KRS_REFUTE_SETTINGS_H

#include "compiler/refute/refuter.h"

/* Slopes and state of the scene, before any parameters are chosen. */
void prepare_slopes(Refuter *r);
void prepare_frames(Refuter *r);

/* Tells whether what it computes depends on parameters of the scene. */
bool needs_parameters(const Tape *tape);
/* Defaults in the first trial, then anything that is permitted. */
void choose_parameters(Refuter *r, uint32_t trial, NodeValue *values);
/* Chooses parameters that a state can have, as good as any others but for the first; false: there
   are none to be found, or those of the first trial cannot be had, which is a finding. */
bool choose_possible(Refuter *r, uint32_t trial, NodeValue *parameters);

#endif
