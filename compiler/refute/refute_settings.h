/*
 * refute_settings.h: values of parameters at which distances are searched.
 */
#ifndef KRS_REFUTE_SETTINGS_H
#define KRS_REFUTE_SETTINGS_H

#include "compiler/refute/refuter.h"

/* These prepare the slopes and the state of a scene, before any parameters are chosen. */
void prepare_slopes(Refuter *r);
void prepare_frames(Refuter *r);

/* Tells whether what a tape computes depends on parameters of the scene. */
bool needs_parameters(const Tape *tape);
/* Chooses the defaults in the first trial, then anything that is permitted. */
void choose_parameters(Refuter *r, uint32_t trial, NodeValue *values);
/* Chooses parameters that a state can have, by several attempts except in the first trial.  False: none were
   found; in the first trial, whose parameters are given, that is a finding. */
bool choose_possible(Refuter *r, uint32_t trial, NodeValue *parameters);

#endif
