/*
 * integrators.h: how light is found: a row of choices.def and a file each.
 *
 * NAME_plan appends the passes of a frame to a plan, and fills in its halo; false with the failure
 * noted.
 */
#ifndef KRS_INTEGRATORS_H
#define KRS_INTEGRATORS_H

#include "runtime/tracer/plan.h"

typedef bool IntegratorPlan(Job *job, Plan *plan);

#define KRS_INTEGRATOR(id, name, about) IntegratorPlan name##_plan;
#include "runtime/choices.def"

#endif
