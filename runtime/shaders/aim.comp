#version 440
#extension GL_GOOGLE_include_directive : enable
#extension GL_EXT_control_flow_attributes : enable
/*
 * aim.comp: begins rays of hits that lanes of the host march (runtime/tracer/lane_rays.c).
 */
#define AIMS
#include "frame.glsl"
#include "secondary.glsl"

void begin_group() { begin_group(0u); }

void do_item(uint number)
{
    begin_item(number, false);
    store_lane(LANE_START, number, vec4(start, end));
    store_lane(LANE_AHEAD, number, vec4(direction, facing));
    store_lane(LANE_SCALE, number, vec4(lift, hit.width, hit.rounding, hit.side));
    store_lane(LANE_CONE, number, vec4(spread, margin, min_step, step_limit > 0u ? 1.0 : 0.0));
}

#include "pixels.glsl"
