/*
 * pixels.glsl: main() of a kernel that does the same for every item.
 *
 * The kernel that includes this says what that is:
 *     void begin_group()              first of all
 *     void do_item(uint number)
 * A lane does several, for which the frame is loaded once.
 */
layout(local_size_x = 64) in;

void main()
{
    load_frame();
    begin_group();
    // The stride spreads neighbours over a device that assigns workgroups in contiguous halves.
    uint group = work.first + gl_WorkGroupID.x * work.stride % work.groups;
    uint number = group * 64u * control.items_per_lane + gl_LocalInvocationIndex;
    uint done = 0u;
    do { // lavapipe goes through the body of another loop once more
        if (number < control.items)
            do_item(number);
        number += 64u;
        done++;
    } while (done < control.items_per_lane);
}
