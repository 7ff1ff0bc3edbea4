/* lane_waves.c: distances to the nearest multiple of a period. */
#include "compiler/graph/lanes/lane_waves.h"

#include <math.h>

/* Returns the other operand of a step of this kind that has a scalar above 0; NODE_NONE: it is no
   such step. */
static uint32_t beside_scalar(const LaneTape *tape, uint32_t operand, uint16_t op, double *scalar)
{
    const LaneStep *step = lane_step_of(tape, operand);
    for (int k = op == OP_div; step && step->op == op && k < 2; k++)
        if ((step->operands[k] & LANE_SCALAR) &&
            (*scalar = tape->scalars[step->operands[k] & ~LANE_SCALAR]) > 0)
            return step->operands[1 - k];
    return NODE_NONE;
}

/* Tells whether an operand is the number of periods in `a`: a quotient, or a product with the
   reciprocal. */
static bool counts_periods(const LaneTape *tape, uint32_t operand, uint32_t a, double period)
{
    static const double ROUNDING = 0x1p-51;
    double              scalar   = 0;
    if (beside_scalar(tape, operand, OP_div, &scalar) == a)
        return scalar == period;
    return beside_scalar(tape, operand, OP_mul, &scalar) == a &&
           fabs(scalar * period - 1) <= ROUNDING;
}

/* Returns the number whose distance to multiples a step is; NODE_NONE: it is no such distance. */
static uint32_t waving(const LaneTape *tape, const LaneStep *step, double *period)
{
    const LaneStep *offset = step->op == OP_abs ? lane_step_of(tape, step->operands[0]) : NULL;
    if (!offset || offset->op != OP_sub || (offset->operands[0] & LANE_SCALAR))
        return NODE_NONE;
    uint32_t        nearest = beside_scalar(tape, offset->operands[1], OP_mul, period);
    const LaneStep *count   = nearest != NODE_NONE ? lane_step_of(tape, nearest) : NULL;
    if (!count || count->op != OP_round ||
        !counts_periods(tape, count->operands[0], offset->operands[0], *period))
        return NODE_NONE;
    return offset->operands[0];
}

/* Returns more than what rounding moves the steps by. */
static double slack_of(Range a, double period) { return 0x1p-48 * (range_largest(a) + period); }

LaneWave lane_wave(const LaneTape *tape, const LaneRanges *ranges, const LaneStep *step)
{
    LaneWave wave = {.period = 0};
    wave.number   = waving(tape, step, &wave.period);
    Range a       = wave.number == NODE_NONE ? ANYTHING : ranges->ranges[wave.number];
    if (!isfinite(a.low) || !isfinite(a.high))
        return (LaneWave){.number = NODE_NONE};
    double slack = slack_of(a, wave.period);
    wave.first   = round((a.low - slack) / wave.period);
    wave.last    = round((a.high + slack) / wave.period);
    return wave;
}

Range lane_wave_range(const LaneTape *tape, const LaneRanges *ranges, const LaneStep *step)
{
    LaneWave wave = lane_wave(tape, ranges, step);
    if (wave.number == NODE_NONE)
        return ANYTHING;
    Range  a     = ranges->ranges[wave.number];
    double slack = slack_of(a, wave.period), half = wave.period / 2;
    Range  ends = {(a.low - slack) / wave.period - wave.first,
                   (a.high + slack) / wave.period - wave.last};
    bool   zero = wave.last - wave.first > 1 ||
                (wave.first == wave.last ? ends.low <= 0 && ends.high >= 0
                                         : ends.low <= 0 || ends.high >= 0);
    double low = wave.period * fabs(ends.low), high = wave.period * fabs(ends.high);
    return (Range){zero ? 0 : max2(min2(low, high) - slack, 0),
                   (wave.last > wave.first ? half : max2(low, high)) + slack};
}
