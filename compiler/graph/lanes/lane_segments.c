/* lane_segments.c: lengths from a point to the nearest one of a segment. */
#include "compiler/graph/lanes/lane_segments.h"

#include <math.h>

#include "compiler/graph/lanes/lane_steps.h"

typedef struct Segment {
    const LaneTape *tape;
    uint32_t        size, from[3];  /* components of q */
    double          direction[3];   /* d */
    uint32_t        along;          /* the clamped t; NODE_NONE: not found yet */
    double          weights[3], at; /* t before it is clamped is weights . q + at */
} Segment;

static double number_of(const LaneTape *tape, uint32_t operand)
{
    return tape->scalars[operand & ~LANE_SCALAR];
}

static bool is_clamp(const LaneTape *tape, uint32_t operand)
{
    const LaneStep *step = lane_step_of(tape, operand);
    return step && step->op == OP_clamp && (step->operands[1] & LANE_SCALAR) &&
           (step->operands[2] & LANE_SCALAR);
}

/* Tells whether an operand is a clamped number times a scalar. */
static bool split_product(const LaneTape *tape, uint32_t operand, uint32_t *clamped, double *factor)
{
    const LaneStep *step = lane_step_of(tape, operand);
    *clamped             = operand;
    *factor              = 1;
    for (int k = 0; step && step->op == OP_mul && k < 2; k++)
        if (step->operands[k] & LANE_SCALAR) {
            *factor  = number_of(tape, step->operands[k]);
            *clamped = step->operands[1 - k];
        }
    return is_clamp(tape, *clamped);
}

/* Adds a component of q, where d is 0: it has no clamped number. */
static bool add_component(Segment *s, uint32_t operand)
{
    const LaneStep *step = lane_step_of(s->tape, operand);
    uint32_t        clamped, k = s->size++;
    double          factor;
    s->from[k]      = operand;
    s->direction[k] = 0;
    if (!step || step->op != OP_sub ||
        !split_product(s->tape, step->operands[1], &clamped, &factor))
        return true;
    s->from[k]      = step->operands[0];
    s->direction[k] = factor;
    if (s->along == NODE_NONE)
        s->along = clamped;
    return s->along == clamped;
}

static bool add_weights(Segment *s, uint32_t operand, double factor, int depth);

/* Tells whether a range is a number that is known but for rounding. */
static bool is_number(Range range, double *number)
{
    *number = 0.5 * (range.low + range.high);
    return range.high - range.low <= 0x1p-51 * range_largest(range);
}

/* Does the same of a step whose derivatives by all but scalars are known whatever these are. */
static bool add_weights_of_step(Segment *s, const LaneStep *step, double factor, int depth)
{
    const NumberRow *row             = lane_row(step);
    Range            o[MAX_OPERANDS] = {0}, by[MAX_OPERANDS];
    double           number;
    if (row->arity == 0)
        return false;
    for (uint32_t k = 0; k < step->operand_count; k++)
        o[k] = step->operands[k] & LANE_SCALAR ? range_of(number_of(s->tape, step->operands[k]))
                                               : ANYTHING;
    row->first(o, ANYTHING, by);
    for (uint32_t k = 0; k < step->operand_count; k++)
        if (!(step->operands[k] & LANE_SCALAR)) {
            if (!is_number(by[k], &number) ||
                !add_weights(s, step->operands[k], factor * number, depth + 1))
                return false;
            o[k] = range_of(0);
        }
    if (!is_number(row->range(o), &number))
        return false;
    s->at += factor * number;
    return true;
}

/* Adds factor times an operand to the weights; false: it is no weighted sum of the components. */
static bool add_weights(Segment *s, uint32_t operand, double factor, int depth)
{
    enum { MAX_DEPTH = 12 };
    const LaneStep *step = lane_step_of(s->tape, operand);
    for (uint32_t k = 0; k < s->size; k++)
        if (operand == s->from[k]) {
            s->weights[k] += factor;
            return true;
        }
    if (operand & LANE_SCALAR) {
        s->at += factor * number_of(s->tape, operand);
        return true;
    }
    return step && depth < MAX_DEPTH && add_weights_of_step(s, step, factor, depth);
}

/* Tells whether t is q.d / d.d, but for rounding. */
static bool is_projection(const Segment *s)
{
    double square = 0, length;
    for (uint32_t k = 0; k < s->size; k++)
        square += s->direction[k] * s->direction[k];
    length = sqrt(square);
    for (uint32_t k = 0; k < s->size; k++)
        if (!(fabs(s->weights[k] * square - s->direction[k]) <= 1e-12 * length))
            return false;
    return fabs(s->at) * length <= 1e-12;
}

bool lane_from_segment(const LaneTape *tape, const LaneStep *step, uint32_t from[MAX_OPERANDS])
{
    Segment s = {.tape = tape, .along = NODE_NONE};
    if (step->op != OP_length || step->operand_count > 3)
        return false;
    for (uint32_t k = 0; k < step->operand_count; k++)
        if (!add_component(&s, step->operands[k]))
            return false;
    if (s.along == NODE_NONE || !add_weights(&s, lane_step_of(tape, s.along)->operands[0], 1, 0) ||
        !is_projection(&s))
        return false;
    for (uint32_t k = 0; k < s.size; k++)
        from[k] = s.from[k];
    return true;
}
