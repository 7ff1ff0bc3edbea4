/*
 * integrators.h: integrators: how light is found.  Each has a row in choices.def and a file here.
 *
 * NAME_plan appends the passes of a frame to a plan, and sets the plan's halo.  It returns false
 * with the failure noted.
 */
#ifndef KRS_INTEGRATORS_H
#define KRS_INTEGRATORS_H

#include "runtime/tracer/plan.h"

typedef bool IntegratorPlan(Job *job, Plan *plan);

#define KRS_INTEGRATOR(id, name, about) IntegratorPlan name##_plan;
#include "krs/choices.def"

#endif
