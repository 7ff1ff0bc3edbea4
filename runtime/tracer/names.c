/*
 * names.c: the names of the enumerators of krs/vulkan.h, in options and statistics.
 */
#include "krs/vulkan.h"

const char *const krs_phase_names[KRS_MAX_CHOICES] = {
#define KRS_PHASE(id, name) name,
#include "krs/choices.def"
};

const char *const krs_integrator_names[KRS_MAX_CHOICES] = {
    "default",
#define KRS_INTEGRATOR(id, name, about) #name,
#include "krs/choices.def"
};

const char *const krs_trace_names[KRS_MAX_CHOICES] = {
#define KRS_TRACE(id, name, about) name,
#include "krs/choices.def"
};

const char *const krs_schedule_names[KRS_MAX_CHOICES] = {
#define KRS_SCHEDULE(id, name, about) name,
#include "krs/choices.def"
};

const char *const krs_components_names[KRS_MAX_CHOICES] = {
#define KRS_COMPONENTS(id, name, about) name,
#include "krs/choices.def"
};

const char *const krs_normals_names[KRS_MAX_CHOICES] = {
#define KRS_NORMALS(id, name, about) name,
#include "krs/choices.def"
};

const char *const krs_shadows_names[KRS_MAX_CHOICES] = {
#define KRS_SHADOWS(id, name, about) name,
#include "krs/choices.def"
};

const char *const krs_caustics_names[KRS_MAX_CHOICES] = {
#define KRS_CAUSTICS(id, name, about) name,
#include "krs/choices.def"
};

const char *const krs_executor_names[KRS_MAX_CHOICES] = {
#define KRS_EXECUTOR(id, name, about) name,
#include "krs/choices.def"
};

const char *const krs_starts_names[KRS_MAX_CHOICES] = {
#define KRS_STARTS(id, name, about) name,
#include "krs/choices.def"
};

const char *const krs_catcher_names[KRS_MAX_CHOICES] = {
#define KRS_CATCHER(id, name, about) name,
#include "krs/choices.def"
};

const char *const krs_pixel_filter_names[KRS_MAX_CHOICES] = {
#define KRS_PIXEL_FILTER(id, name, reach, integral, about) name,
#include "krs/choices.def"
};
