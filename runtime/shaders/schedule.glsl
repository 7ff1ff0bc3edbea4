/*
 * schedule.glsl: main() of a kernel that works on many items, each for as many steps as it
 * needs, every step one call of the distance.
 *
 * The kernel that includes this says what an item is:
 *     void begin_group(uint first)         first of all: the group's items begin with this one
 *     void look_up_item(uint number)       what is to be had of an item from other lanes; these
 *                                          may have an item each, and must keep it
 *     void begin_item(uint number, bool saved)   takes an item up, or one that was saved
 *     bool item_wants_more()               it is not finished
 *     vec3 item_place()                    where it wants to know the distance
 *     float item_distance(vec3 place)      the distance there, or less
 *     void take_distance(float distance)   one step
 *     void end_item()                      stores what it has found
 *     void save_item()                     stores how far it is
 *     void end_group(uint steps)           last of all, after so many of them by this lane
 *     const uint HUNGRY                    lanes that are done, until they take up new items together
 *     const bool SAVES                     whether items are saved when the dispatch has had its
 *                                          steps; else those that are begun are finished
 *
 * On lavapipe, where a branch skips nothing and eight lanes go through a loop together, a lane that
 * is done takes the group's next item while the others march on (REFILL): the loop over steps ends
 * when so many lanes can do so.  What is in these loops stands on every lane's way, so saving and resuming
 * are outside.  On a graphics card a lane has one item.
 */
// Whether a lane may go on with its item after so many steps.
bool may_go_on(uint turns, uint allowed)
{
    return item_wants_more() && (!SAVES || turns < allowed);
}

#if REFILL
const uint LANES = uint(REFILL); // as many as go through a loop together: 4 or 8
layout(local_size_x = REFILL) in;
// How many of its items a group has taken up so far.
layout(std430, set = 1, binding = 7) buffer Taken { uint taken[]; };

// The bits of all lanes.  Of a vote lavapipe makes a loop over the lanes; of this, six
// instructions.
uint join_lanes(uint bits)
{
    bits |= subgroupShuffleXor(bits, 1u);
    bits |= subgroupShuffleXor(bits, 2u);
    return LANES > 4u ? bits | subgroupShuffleXor(bits, 4u) : bits;
}

bool any_lane(bool says) { return join_lanes(uint(says)) != 0u; }

// Turns are counted for lanes that wait as well: lavapipe counts them, and ends loops without a word
// when there are too many.
void work_on_items(uint group, uint turns_allowed, inout uint steps)
{
    uint turns = 0u;
    uint lane = gl_LocalInvocationIndex, first = group * LANES * control.share, next = first;
    uint limit = min(first + LANES * control.share, control.items);
    bool holding = false, going, hungry;
    if (control.source == ITEMS_QUEUED) {
        holding = first + lane < limit;
        if (holding)
            begin_item(first + lane, true);
        next = limit;
    }
    if (control.source == ITEMS_UNTAKEN)
        next += taken[group];
    do {
        do { // until each lane marches, or there is nothing left
            if (holding && !item_wants_more()) {
                end_item();
                holding = false;
            }
            bool asks = !holding && turns < turns_allowed; // and takes what is next, lane by lane
            uint asking = join_lanes(uint(asks) << lane);
            uint number = next + bitCount(asking & (1u << lane) - 1u);
            look_up_item(number);
            if (asks && number < limit) {
                begin_item(number, false);
                holding = true;
            }
            next += bitCount(asking);
            going = holding && may_go_on(turns, turns_allowed);
            hungry = !going && next < limit && turns < turns_allowed;
        } while (any_lane(hungry));
        uint wants;
        bool waiting;
        do { // until some are done while there is something left, or all are
            float distance = item_distance(item_place());
            if (going) {
                take_distance(distance);
                steps++;
            }
            turns++;
            going = going && may_go_on(turns, turns_allowed);
            hungry = !going && next < limit && turns < turns_allowed;
            wants = join_lanes((uint(going) | uint(hungry) << LANES) << lane);
            waiting = bitCount(wants >> LANES) < HUNGRY;
        } while (waiting && (wants & (1u << LANES) - 1u) != 0u);
        going = wants != 0u;
    } while (going);
    if (holding && item_wants_more())
        save_item();
    else if (holding)
        end_item();
    next = min(next, limit);
    if (lane == 0u && control.source != ITEMS_QUEUED) {
        taken[group] = next - first;
        if (next < limit)
            atomicAdd(counts.left, limit - next);
    }
}
#else
layout(local_size_x = 64) in;

void work_on_items(uint group, uint turns_allowed, inout uint steps)
{
    uint number = group * 64u + gl_LocalInvocationIndex;
    if (number >= control.items)
        return;
    look_up_item(number);
    begin_item(number, control.source == ITEMS_QUEUED);
    for (; may_go_on(steps, turns_allowed); steps++)
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
    uint steps = 0u, group = work.first + gl_WorkGroupID.x * work.stride % work.groups;
    begin_group(group * gl_WorkGroupSize.x * (REFILL != 0 ? control.share : 1u));
    work_on_items(group, work.steps, steps);
    end_group(steps);
}
