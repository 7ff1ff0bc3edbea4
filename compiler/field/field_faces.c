/* field_faces.c: the faces of boxes, in distances that add a length outside and a maximum inside. */
#include "compiler/field/field.h"

bool field_is_greater(const LaneStep *step)
{
    return step->op == OP_max || step->op == LANE_GREATER;
}

bool field_is_lesser(const LaneStep *step) { return step->op == OP_min || step->op == LANE_LESSER; }

static bool is_zero_in(const LaneTape *tape, const LaneRanges *ranges, uint32_t operand)
{
    return range_is_zero(lane_range_at(tape, ranges, operand));
}

bool field_has_face(const FieldFaces *faces, uint32_t operand)
{
    for (size_t i = 0; i < faces->count; i++)
        if (faces->operands[i] == operand)
            return true;
    return false;
}

static bool add_face(FieldFaces *faces, uint32_t operand)
{
    if (field_has_face(faces, operand))
        return true;
    if (faces->count == MAX_FACES || (operand & LANE_SCALAR))
        return false;
    faces->operands[faces->count++] = operand;
    return true;
}

static bool find_greatest(const LaneTape *tape, uint32_t operand, FieldFaces *faces)
{
    const LaneStep *step = lane_step_of(tape, operand);
    if (step && field_is_greater(step))
        return find_greatest(tape, step->operands[0], faces) &&
               find_greatest(tape, step->operands[1], faces);
    return add_face(faces, operand);
}

/* Finds the greatest of some numbers, of which one is 0. */
static bool find_above_zero(const LaneTape *tape, const LaneRanges *ranges, uint32_t operand,
                            FieldFaces *faces, bool *zero)
{
    const LaneStep *step = lane_step_of(tape, operand);
    if (is_zero_in(tape, ranges, operand))
        return *zero = true;
    if (step && field_is_greater(step))
        return find_above_zero(tape, ranges, step->operands[0], faces, zero) &&
               find_above_zero(tape, ranges, step->operands[1], faces, zero);
    return add_face(faces, operand);
}

bool field_outside(const LaneTape *tape, const LaneRanges *ranges, uint32_t operand,
                   FieldFaces *faces)
{
    const LaneStep *step = lane_step_of(tape, operand);
    bool            zero = false;
    if (step && step->op == OP_length) {
        for (uint32_t k = 0; k < step->operand_count; k++)
            if (!is_zero_in(tape, ranges, step->operands[k]) &&
                !field_outside(tape, ranges, step->operands[k], faces))
                return false;
        return true;
    }
    for (int k = 0; step && field_is_lesser(step) && k < 2; k++)
        if (!(step->operands[k] & LANE_SCALAR) && ranges->ranges[step->operands[k]].low >= 0)
            return field_outside(tape, ranges, step->operands[1 - k], faces);
    return step && field_is_greater(step) && find_above_zero(tape, ranges, operand, faces, &zero) &&
           zero;
}

bool field_inside(const LaneTape *tape, const LaneRanges *ranges, uint32_t operand,
                  FieldFaces *faces, double *part)
{
    const LaneStep *step   = lane_step_of(tape, operand);
    bool            scaled = step && (step->op == OP_mul || step->op == OP_div);
    for (int k = scaled && step->op == OP_div; scaled && k < 2; k++) {
        double number = step->operands[k] & LANE_SCALAR
                            ? tape->scalars[step->operands[k] & ~LANE_SCALAR]
                            : 0;
        if (!(number > 0))
            continue;
        *part *= step->op == OP_mul ? number : 1 / number;
        return field_inside(tape, ranges, step->operands[1 - k], faces, part);
    }
    for (int k = 0; step && field_is_lesser(step) && k < 2; k++)
        if (is_zero_in(tape, ranges, step->operands[1 - k]))
            return find_greatest(tape, step->operands[k], faces);
    return false;
}
