/* lane_segments.c: lengths from a point to the nearest one of a segment. */
#include "compiler/graph/lanes/lane_segments.h"

#include <math.h>

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

/* What has no clamped number is a component of q where d is 0. */
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
    if (!step || depth == MAX_DEPTH)
        return false;
    const uint32_t *a = step->operands;
    switch (step->op) {
    case OP_neg: return add_weights(s, a[0], -factor, depth + 1);
    case OP_add:
        return add_weights(s, a[0], factor, depth + 1) && add_weights(s, a[1], factor, depth + 1);
    case OP_sub:
        return add_weights(s, a[0], factor, depth + 1) && add_weights(s, a[1], -factor, depth + 1);
    case OP_mul:
        for (int k = 0; k < 2; k++)
            if (a[k] & LANE_SCALAR)
                return add_weights(s, a[1 - k], factor * number_of(s->tape, a[k]), depth + 1);
        return false;
    case OP_div:
        return (a[1] & LANE_SCALAR) &&
               add_weights(s, a[0], factor / number_of(s->tape, a[1]), depth + 1);
    default: return false;
    }
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
