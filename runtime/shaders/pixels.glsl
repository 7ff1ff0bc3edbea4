/*
 * pixels.glsl: for kernels that do the same for every item.
 */
layout(local_size_x = 64) in;

// The number of this invocation's item; false when there is none.  The stride spreads neighbours
// over a device that deals out workgroups in contiguous halves.
bool find_item(out uint number)
{
    uint group = work.first + gl_WorkGroupID.x * work.stride % work.groups;
    number = group * 64u + gl_LocalInvocationIndex;
    return number < control.items;
}
