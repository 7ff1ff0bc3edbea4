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
    uint begun = step_limit > 0u ? LANE_MARCHES
                 : below_horizon ? LANE_BELOW_HORIZON
                 : blocked       ? LANE_IS_BLOCKED
                                 : LANE_IS_FREE;
    store_lane(LANE_START, number, vec4(start, end));
    store_lane(LANE_AHEAD, number, vec4(direction, facing));
    store_lane(LANE_SCALE, number, vec4(lift, hit.width, hit.rounding, hit.side));
    store_lane(LANE_CONE, number, vec4(spread, margin, min_step, float(begun)));
    store_lane(LANE_LIGHT, number, vec4(find_depth(hit), radius, find_light_distance(), 0.0));
}

#include "pixels.glsl"
