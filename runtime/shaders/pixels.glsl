/*
 * pixels.glsl: main() of a shader whose items all cost the same.
 *
 * The shader that includes this defines:
 *     void begin_group()              called first
 *     void do_item(uint number)       called for each item
 * A lane takes several items, for which the frame is loaded once.
 */
layout(local_size_x = 64) in;

void main()
{
    load_frame();
    begin_group();
    uint group = find_group();
    // Eight lanes, which lavapipe runs together, take items in their order.  So memory is read in
    // its order, and arrives before it is asked for.
    uint lane = gl_LocalInvocationIndex & 7u;
    uint number = (group * 64u + gl_LocalInvocationIndex - lane) * control.items_per_lane + lane;
    uint done = 0u;
    do { // do-while: lavapipe executes the body of other loops once more than needed
        if (number < control.items)
            do_item(number);
        number += 8u;
        done++;
    } while (done < control.items_per_lane);
}
