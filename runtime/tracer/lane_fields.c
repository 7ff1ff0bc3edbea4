/*
 * lane_fields.c: what lanes of the host ask of a state, kept from picture to picture.
 */
#include "runtime/tracer/lane_fields.h"

void lane_fields_free(LaneFields *fields)
{
    ray_field_free(fields->rays);
    surface_field_free(fields->surfaces);
    *fields = (LaneFields){0};
}

/* Frees the fields of other values. */
static LaneFields *fields_of(KrsRendering *rendering, KrsState *state)
{
    LaneFields    *fields = &rendering->lane_fields;
    const uint64_t stamp  = krs_state_stamp(state);
    if (fields->stamp != stamp)
        lane_fields_free(fields);
    fields->stamp = stamp;
    return fields;
}

RayField *lane_fields_rays(KrsRendering *rendering, KrsState *state, bool planes)
{
    LaneFields *fields = fields_of(rendering, state);
    if (fields->rays && fields->planes == planes) {
        ray_field_begin(fields->rays);
        return fields->rays;
    }
    ray_field_free(fields->rays);
    fields->planes = planes;
    fields->rays   = ray_field_new(state, planes);
    if (!fields->rays)
        gpu_refuse(&rendering->renderer->gpu, KRS_OUT_OF_MEMORY, "%s",
                   "cannot make room for the rays of the picture");
    return fields->rays;
}

SurfaceField *lane_fields_surfaces(KrsRendering *rendering, KrsState *state, bool layers)
{
    LaneFields *fields = fields_of(rendering, state);
    if (!fields->surfaces)
        fields->surfaces = surface_field_new(state, layers);
    if (!fields->surfaces)
        gpu_refuse(&rendering->renderer->gpu, KRS_OUT_OF_MEMORY, "%s",
                   "cannot make room for the surfaces of the picture");
    return fields->surfaces;
}
