#version 440
/*
 * plan.comp: what the host does between two dispatches where it waits for each: how many items the
 * next one has, by what those before it have counted, and so how many groups.
 *
 * One with more groups than may run at once, and all behind it, have none: the host goes on there.
 * The C side is in runtime/tracer/dispatch.c.
 */
layout(local_size_x = 1) in;

layout(push_constant) uniform Plan {
    uint counter;  // items are `each` times this word of the control block; 0: just `each`
    uint each;
    uint resets;   // 1: the counter is 0 from then on
    uint in_group; // items of a group
    uint most;     // groups that may run at once
    uint number;   // of the dispatch in its chain, from 1
} plan;

// The control block (blocks.h) as words, and where in it these begin.
layout(std430, set = 1, binding = 4) buffer ControlWords { uint words[]; };
const uint ITEMS = 10u, GROUPS = 42u, STOPPED = 45u, RAN = 46u;

void main()
{
    uint items = plan.counter == 0u ? plan.each : plan.each * words[plan.counter];
    uint groups = (items + plan.in_group - 1u) / plan.in_group;
    if (words[STOPPED] == 0u && groups > plan.most)
        words[STOPPED] = plan.number;
    bool runs = words[STOPPED] == 0u;
    if (runs && plan.resets != 0u)
        words[plan.counter] = 0u;
    words[ITEMS] = items;
    words[GROUPS] = runs ? groups : 0u;
    words[GROUPS + 1u] = 1u;
    words[GROUPS + 2u] = 1u;
    words[RAN + plan.number - 1u] = runs ? groups : 0u;
}
