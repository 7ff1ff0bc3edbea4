#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * next_dispatch.comp: computes how many items, and so workgroups, the next dispatch of a chain has,
 * from what the dispatches before it have counted.  Where dispatches form no chains, the host does
 * this.
 *
 * If a dispatch has more workgroups than may run at once, it and all behind it get none; the host
 * goes on from there.  The C side is in runtime/tracer/dispatch.c.
 */
#include "runtime/shared/blocks.h"

layout(local_size_x = 1) in;

layout(std140, set = 1, binding = WORK_BINDING) uniform NextDispatchBlock { NextDispatch next; };
layout(std430, set = 1, binding = CONTROL_BINDING) buffer ControlWords { uint words[]; };

void main()
{
    uint items = next.counter == 0u ? next.each : next.each * words[next.counter];
    uint groups = (items + next.in_group - 1u) / next.in_group;
    if (words[STOPPED_WORD] == 0u && groups > next.most)
        words[STOPPED_WORD] = next.number;
    bool runs = words[STOPPED_WORD] == 0u;
    if (runs && next.resets != 0u)
        words[next.counter] = 0u;
    if (runs && next.clears != 0u)
        words[next.clears] = 0u;
    words[ITEMS_WORD] = items;
    words[GROUPS_WORD] = runs ? groups : 0u;
    words[GROUPS_WORD + 1u] = 1u;
    words[GROUPS_WORD + 2u] = 1u;
    words[RAN_WORD + next.number - 1u] = runs ? groups : 0u;
}
