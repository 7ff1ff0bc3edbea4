/*
 * schedule.glsl: main() of a kernel that works on many items, each for as many steps as it
 * needs, every step one call of the distance.
 *
 * The kernel that includes this says what an item is:
 *     void begin_group()                   first of all
 *     void begin_item(uint number, bool saved)   takes an item up, or one that was saved
 *     bool item_wants_more()               it is not finished
 *     vec3 item_place()                    where it wants to know the distance
 *     float item_distance(vec3 place)      the distance there, or less
 *     void take_distance(float distance)   one step
 *     void end_item()                      stores what it has found
 *     void save_item()                     stores how far it is
 *     void end_group(uint turns)           last of all, after so many steps
 *     const bool SAVES                     whether items are saved when the dispatch has had its
 *                                          steps; else those that are begun are finished
 *
 * A group deals its items out to its lanes in turn.  On lavapipe, where a branch skips nothing
 * and eight lanes go through a loop together, a lane that is done takes its next item while the
 * others march on (REFILL): the loop over steps ends when a lane can do so.  What is in these
 * loops stands on every lane's way, so saving and resuming are outside.  On a graphics card a lane
 * has one item.
 */
// Whether a lane may go on with its item after so many steps.
bool may_go_on(uint turns, uint allowed)
{
    return item_wants_more() && (!SAVES || turns < allowed);
}

const uint FRESH = 0u, QUEUED = 1u, REST = 2u; // control.source: where items come from

#if REFILL
layout(local_size_x = 8) in;
// How many of its items a lane has taken up so far, by the number of the lane.
layout(std430, set = 1, binding = 7) buffer Taken { uint taken[]; };

void work_on_items(uint group, uint turns_allowed, inout uint turns)
{
    uint number = group * 8u * control.share + gl_LocalInvocationIndex;
    uint lane = group * 8u + gl_LocalInvocationIndex;
    uint left = number < control.items
              ? min(control.share, (control.items - number + 7u) / 8u) : 0u;
    bool holding = false, going = false;
    if (control.source == QUEUED && left > 0u) {
        begin_item(number, true);
        holding = true;
        going = true;
        left = 0u;
    }
    uint before = control.source == REST && left > 0u ? taken[lane] : 0u;
    left -= before;
    number += 8u * before;
    uint all = left;
    bool hungry = left > 0u;
    if (!subgroupAny(holding || hungry))
        return;
    do {
        do { // until each lane marches, or has nothing left
            if (holding && !item_wants_more()) {
                end_item();
                holding = false;
            }
            if (!holding && hungry) {
                begin_item(number, false);
                holding = true;
                number += 8u;
                left--;
            }
            going = holding && may_go_on(turns, turns_allowed);
            hungry = !going && left > 0u && turns < turns_allowed;
        } while (subgroupAny(hungry));
        do { // until one is done that has something left, or all are
            float distance = item_distance(item_place());
            if (going) {
                take_distance(distance);
                turns++;
                going = may_go_on(turns, turns_allowed);
            }
            hungry = !going && left > 0u && turns < turns_allowed;
        } while (subgroupAny(going) && !subgroupAny(hungry));
    } while (subgroupAny(going || hungry));
    if (holding && item_wants_more())
        save_item();
    else if (holding)
        end_item();
    taken[lane] = before + all - left;
    if (left > 0u)
        atomicAdd(counts.left, left);
}
#else
layout(local_size_x = 64) in;

void work_on_items(uint group, uint turns_allowed, inout uint turns)
{
    uint number = group * 64u + gl_LocalInvocationIndex;
    if (number >= control.items)
        return;
    begin_item(number, control.source == QUEUED);
    for (; may_go_on(turns, turns_allowed); turns++)
        take_distance(item_distance(item_place()));
    if (item_wants_more())
        save_item();
    else
        end_item();
}
#endif

void main()
{
    load_frame();
    krs_prepare();
    begin_group();
    uint turns = 0u;
    work_on_items(work.first + gl_WorkGroupID.x * work.stride % work.groups, work.steps, turns);
    end_group(turns);
}
