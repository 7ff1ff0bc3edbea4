#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * plate.comp: stores the normals of hits of the plate, which no distance tells.
 *
 * An item is a hit.
 */
#include "frame.glsl"
#include "hit_lists.glsl"
#include "plate.glsl"

void begin_group() {}

void do_item(uint number)
{
    uint slot = find_listed(control.reading + number), index = index_of(pixel_of(slot));
    if (is_of_plate(find_end(index)))
        store_hit(FACING, slot, vec4(find_plate_plane(index).xyz, 1.0));
}

#include "pixels.glsl"
