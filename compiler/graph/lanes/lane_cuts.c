/* lane_cuts.c: parts of numbers above and below 0, and their sums. */
#include "compiler/graph/lanes/lane_cuts.h"
#include "compiler/graph/lanes/lane_steps.h"

uint32_t lane_only_operand(const LaneTape *tape, const LaneRanges *ranges, const LaneStep *step)
{
    uint32_t only = NODE_NONE;
    for (uint32_t k = 0; k < step->operand_count; k++)
        if (!range_is_zero(lane_range_at(tape, ranges, step->operands[k]))) {
            if (only != NODE_NONE)
                return NODE_NONE;
            only = step->operands[k];
        }
    return only;
}

/* Returns what an operand cuts at 0: above, for a minimum, or below. */
static uint32_t cut_at_zero(const LaneTape *tape, const LaneRanges *ranges, uint32_t operand,
                            Op least, uint32_t lane)
{
    const LaneStep *step = lane_step_of(tape, operand);
    return step && (step->op == least || step->op == lane) ? lane_only_operand(tape, ranges, step)
                                                           : NODE_NONE;
}

/* The part above 0 is its own length. */
static uint32_t within_length(const LaneTape *tape, const LaneRanges *ranges, uint32_t operand)
{
    const LaneStep *step = lane_step_of(tape, operand);
    return step && step->op == OP_length ? lane_only_operand(tape, ranges, step) : operand;
}

uint32_t lane_sum_of_cuts(const LaneTape *tape, const LaneRanges *ranges, const LaneStep *step)
{
    for (int k = 0; step->op == OP_add && k < 2; k++) {
        uint32_t outside = within_length(tape, ranges, step->operands[k]);
        uint32_t a       = cut_at_zero(tape, ranges, outside, OP_max, LANE_GREATER);
        if (a != NODE_NONE &&
            a == cut_at_zero(tape, ranges, step->operands[1 - k], OP_min, LANE_LESSER))
            return a;
    }
    return NODE_NONE;
}
