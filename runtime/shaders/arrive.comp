#version 440
#extension GL_GOOGLE_include_directive : enable
#extension GL_EXT_control_flow_attributes : enable
/*
 * arrive.comp: ends the rays of aim.comp, by what lanes of the host have found.
 */
#define AIMS
#include "frame.glsl"
#include "secondary.glsl"

void begin_group() { begin_group(0u); }

void do_item(uint number)
{
    begin_item(number, false);
    if (step_limit > 0u) {
        vec4 found = load_lane(LANE_FOUND, number);
        t = found.x;
        blocked = found.y > 0.0;
        step_limit = found.z > 0.0 ? 1u : 0u;
    }
    unresolved = 0u;
    end_item();
    if (unresolved > 0u)
        atomicAdd(counts.unresolved, unresolved);
}

#include "pixels.glsl"
