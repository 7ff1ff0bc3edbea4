/*
 * lane_steps.h: what all evaluators over boxes ask of a step and its operands.
 */
#ifndef KRS_LANE_STEPS_H
#define KRS_LANE_STEPS_H

#include "compiler/graph/bounds/numbers.h"
#include "compiler/graph/lanes/lanes.h"

/* Returns the row of ops.def for a step; LANE_LESSER and LANE_GREATER are as min and max are of
   numbers.  Of others nothing is known, as of a leaf. */
static inline const NumberRow *lane_row(const LaneStep *step)
{
    if (step->op < OP_COUNT)
        return &number_rows[step->op];
    return &number_rows[step->op == LANE_LESSER    ? OP_min
                        : step->op == LANE_GREATER ? OP_max
                                                   : OP_CONSTANT];
}

static inline bool lane_is_sure(const LaneTape *tape, const LaneRanges *ranges, uint32_t operand)
{
    if (operand & LANE_SCALAR)
        return !isnan(tape->scalars[operand & ~LANE_SCALAR]);
    return ranges->sure[operand];
}

/* Finds the ranges of all operands; 0 where there is none. */
static inline void lane_operands(const LaneTape *tape, const LaneRanges *ranges,
                                 const LaneStep *step, Range o[MAX_OPERANDS])
{
    for (uint32_t k = 0; k < MAX_OPERANDS; k++)
        o[k] = k < step->operand_count ? lane_range_at(tape, ranges, step->operands[k]) : ZERO;
}

/* Returns which operands a step may be in the box, where all are numbers, as bits; 0: it may be
   another number. */
static inline unsigned lane_chooses(const LaneTape *tape, const LaneRanges *ranges,
                                    const LaneStep *step)
{
    Range o[MAX_OPERANDS];
    if (!lane_row(step)->chooses)
        return 0;
    lane_operands(tape, ranges, step, o);
    return lane_row(step)->chooses(o);
}

/* Returns the only operand among these; NODE_NONE: there are none, or several. */
static inline uint32_t lane_only_of(const LaneStep *step, unsigned chosen)
{
    for (uint32_t k = 0; k < step->operand_count; k++)
        if (chosen == 1u << k)
            return step->operands[k];
    return NODE_NONE;
}

#endif
