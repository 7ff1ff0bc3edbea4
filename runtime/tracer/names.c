/*
 * names.c: what the numbers of krs_vulkan.h are called, in options and statistics.
 */
#include "runtime/krs_vulkan.h"

const char *const krs_phase_names[KRS_PHASE_COUNT] = {
    "beams", "primary", "normals", "shadows", "occlusion", "shading", "resolve",
};
const char *const krs_trace_names[KRS_TRACE_COUNT] = {
    "default", "plain",     "relaxed",     "auto",   "exact",
    "taylor",  "root-free", "directional", "binary", "predicted"};
const char *const krs_schedule_names[KRS_SCHEDULE_COUNT] = {"default", "pixel", "refill", "queue"};
const char *const krs_components_names[KRS_COMPONENTS_COUNT] = {"default", "together", "apart",
                                                                "packed"};
const char *const krs_normals_names[KRS_NORMALS_COUNT]       = {
          "default", "forward",     "tetrahedron",  "octahedron",
          "cube",    "icosahedron", "dodecahedron", "analytic",
};
const char *const krs_shadows_names[KRS_SHADOWS_COUNT] = {"soft", "area"};
