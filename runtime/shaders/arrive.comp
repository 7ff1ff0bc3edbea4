#version 440
#extension GL_GOOGLE_include_directive : enable
#extension GL_EXT_control_flow_attributes : enable
/*
 * arrive.comp: ends the rays of aim.comp, by what lanes of the host have found.
 */
#define AIMS
#include "frame.glsl"
#include "hit_lists.glsl"
#include "secondary_ends.glsl"

void begin_group() {}

void do_item(uint number)
{
    uint  listed = find_listed(control.reading + number);
    vec4  scale = load_lane(LANE_SCALE, number), light = load_lane(LANE_LIGHT, number);
    vec4  found = load_lane(LANE_FOUND, number);
    uint  begun = uint(load_lane(LANE_CONE, number).w);
    bool  marches = begun == LANE_MARCHES;
    bool  blocked = marches ? found.y > 0.0 : begun == LANE_IS_BLOCKED;
    bool  gives_up = marches && found.z > 0.0;
    if (control.phase == RAYS_CONES) {
        if (!blocked && !gives_up)
            store_shared(RAYS_SHARED, cone_of_quarter(listed), light.x, LIT);
        return;
    }
    store_end(listed, light.x,
              RayOfHit(blocked, begun == LANE_BELOW_HORIZON, marches ? found.x : 0.0, scale.y, light.y, light.z));
    if (gives_up)
        atomicAdd(counts.unresolved, 1u);
}

#include "pixels.glsl"
