/*
 * schedule.glsl: main() of a shader whose items take different numbers of steps.  Each step
 * evaluates the distance once.
 *
 * The shader that includes this defines:
 *     void begin_group(uint first)         called first: `first` is the workgroup's first item
 *     void exchange_item(uint number)      gets from other lanes what they know of an item; lanes
 *                                          that have an item call it as well, and keep theirs
 *     void begin_item(uint number, bool saved)   begins an item, or resumes one that was saved
 *     bool item_needs_step()               whether the item is not finished
 *     vec3 item_position()                 where its distance is evaluated next
 *     float item_distance(vec3 position)   the distance there, or less
 *     void take_distance(float distance)   takes one step
 *     void end_item()                      stores the result of an item
 *     void save_item()                     stores the state of an item that is not finished
 *     void end_group(uint steps)           called last: `steps` is the number of this lane's steps
 *     const uint REFILL_THRESHOLD          how many idle lanes begin new items together
 *     SAVES                                1: items are saved when the steps of the dispatch are
 *                                          used up; 0: items that have begun are finished
 *
 * On lavapipe a branch skips nothing, and eight lanes go through a loop together.  So a lane whose
 * item has ended takes the workgroup's next item while the others march on (REFILL).  The loop over
 * steps ends when REFILL_THRESHOLD lanes can take an item.  All lanes execute whatever is in these
 * loops, so saving and resuming are outside.  On a graphics card a lane has one item.
 */
// Tells whether the lane's item takes another step, after this many iterations.
bool may_take_step(uint iterations, uint allowed)
{
    return item_needs_step() && (SAVES == 0 || iterations < allowed);
}

#if REFILL
const uint LANES = uint(REFILL); // lanes that go through a loop together: 4 or 8
layout(local_size_x = REFILL) in;
// The number of its items that each workgroup has begun so far.
layout(std430, set = 1, binding = TAKEN_BINDING) buffer Taken { uint taken[]; };

// Returns the union of the bits of all lanes. lavapipe compiles a vote to a loop over the lanes,
// but this to six instructions.
uint or_lanes(uint bits)
{
    bits |= subgroupShuffleXor(bits, 1u);
    bits |= subgroupShuffleXor(bits, 2u);
    return LANES > 4u ? bits | subgroupShuffleXor(bits, 4u) : bits;
}

bool any_lane(bool truth) { return or_lanes(uint(truth)) != 0u; }

// Works on a workgroup's items.  Iterations are counted for idle lanes as well: lavapipe ends a
// loop silently after too many.
void work_on_items(uint group, uint steps_allowed, inout uint steps)
{
    uint iterations = 0u;
    uint lane = gl_LocalInvocationIndex, first = group * LANES * control.items_per_lane,
         next = first;
    uint limit = min(first + LANES * control.items_per_lane, control.items);
    bool has_item = false, is_stepping, wants_item, saved = SAVES != 0 && control.source == ITEMS_QUEUED;
    if (control.source == ITEMS_UNTAKEN)
        next += taken[group];
    do {
        do { // until each lane has an item, or none is left
            if (has_item && !item_needs_step()) {
                end_item();
                has_item = false;
            }
            bool takes_item = !has_item && iterations < steps_allowed; // next items, in order
            uint takers = or_lanes(uint(takes_item) << lane);
            uint number = next + bitCount(takers & (1u << lane) - 1u);
            exchange_item(number);
            if (takes_item && number < limit) {
                begin_item(number, saved);
                has_item = true;
            }
            next += bitCount(takers);
            is_stepping = has_item && may_take_step(iterations, steps_allowed);
            wants_item = !is_stepping && next < limit && iterations < steps_allowed;
        } while (any_lane(wants_item));
        uint votes;
        bool goes_on;
        do { // until some lanes can take an item, or all are done
            float distance = item_distance(item_position());
            if (is_stepping) {
                take_distance(distance);
                steps++;
            }
            iterations++;
            is_stepping = is_stepping && may_take_step(iterations, steps_allowed);
            wants_item = !is_stepping && next < limit && iterations < steps_allowed;
            votes = or_lanes((uint(is_stepping) | uint(wants_item) << LANES) << lane);
            goes_on = bitCount(votes >> LANES) < REFILL_THRESHOLD;
        } while (goes_on && (votes & (1u << LANES) - 1u) != 0u);
        is_stepping = votes != 0u;
    } while (is_stepping);
    if (has_item && item_needs_step())
        save_item();
    else if (has_item)
        end_item();
    next = min(next, limit);
    if (lane == 0u && control.source != ITEMS_QUEUED) {
        taken[group] = next - first;
        if (next < limit)
            atomicAdd(counts.untaken, limit - next);
    }
}
#else
layout(local_size_x = 64) in;

void work_on_items(uint group, uint steps_allowed, inout uint steps)
{
    uint number = group * 64u + gl_LocalInvocationIndex;
    if (number < control.items) {
        exchange_item(number);
        begin_item(number, SAVES != 0 && control.source == ITEMS_QUEUED);
        for (; may_take_step(steps, steps_allowed); steps++)
            take_distance(item_distance(item_position()));
        if (item_needs_step())
            save_item();
        else
            end_item();
    }
}
#endif

void main()
{
    load_frame();
    krs_prepare();
    uint steps = 0u, group = find_group();
    begin_group(group * gl_WorkGroupSize.x * (REFILL != 0 ? control.items_per_lane : 1u));
    work_on_items(group, work.steps, steps);
    end_group(steps);
}
