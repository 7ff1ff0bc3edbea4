#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * clear_shared.comp: clears the words that neighbours share (shared.glsl).  In a chain a shader does
 * this, since a chain that stops must not clear what the host goes on with.
 *
 * An item is a quarter of a tile of 8x8 pixels.
 */
#include "frame.glsl"
#include "hit_lists.glsl"

void begin_group() {}

void do_item(uint quarter)
{
    uint first = slot_of_quarter(quarter);
    for (uint i = 0u; i < 16u; i++)
        for (uint list = 0u; list < SHARED_LISTS; list++)
            pixel_lists[shared_at(list, first + 8u * (i >> 2u) + (i & 3u))] = 0u;
}

#include "pixels.glsl"
