/*
 * field_pieces.c: the distance in a box, as minima and maxima of pieces.
 *
 * Only its sign is kept.  So the distance to a box, whose part outside is a length and whose part inside a
 * maximum, is the maximum of what its faces cut.
 */
#include <math.h>
#include <string.h>

#include "compiler/field/field.h"
#include "compiler/graph/lanes/lane_outlines.h"

typedef struct Finding {
    const MeshField *field;
    const LaneTape  *tape;
    FieldPieces     *pieces;
    uint32_t         operands[MOST_PIECES][PIECE_VALUES];
    int              depth;
} Finding;

static Range range_of_operand(const Finding *f, uint32_t operand)
{
    return operand & LANE_SCALAR ? range_of(f->tape->scalars[operand & ~LANE_SCALAR])
                                 : f->field->ranges.ranges[operand];
}

static bool add_step(Finding *f, int step)
{
    if (f->pieces->step_count == MOST_PIECE_STEPS)
        return false;
    f->pieces->steps[f->pieces->step_count++] = step;
    return true;
}

static bool has_slope(const LaneSlope *slope)
{
    for (int j = 0; j < 3; j++)
        if (!isfinite(slope->by[j].low) || !isfinite(slope->by[j].high))
            return false;
    return true;
}

/* A sum of operands times weights.  Those whose weight is 0 are left out. */
typedef struct Sum {
    uint32_t operands[PIECE_VALUES];
    double   weights[PIECE_VALUES];
    uint32_t count;
} Sum;

static bool sums_are_equal(const Sum *sum, const uint32_t *operands, const double *weights,
                           uint32_t count)
{
    bool equal = sum->count == count;
    for (uint32_t k = 0; equal && k < count; k++)
        equal = sum->operands[k] == operands[k] && sum->weights[k] == weights[k];
    return equal;
}

static LaneSlope slope_of_sum(const LaneSlope *slopes, const Sum *sum)
{
    LaneSlope slope = {{{0, 0}, {0, 0}, {0, 0}}};
    for (uint32_t k = 0; k < sum->count; k++)
        for (int j = 0; j < 3; j++) {
            Range by    = range_mul(range_of(sum->weights[k]), slopes[sum->operands[k]].by[j]);
            slope.by[j] = k == 0 ? by : range_add(slope.by[j], by);
        }
    return slope;
}

static LaneHessian hessian_of_sum(const LaneHessian *hessians, const Sum *sum)
{
    LaneHessian hessian = {.known = true, .flat = true};
    for (uint32_t k = 0; k < sum->count; k++) {
        const LaneHessian *of = &hessians[sum->operands[k]];
        hessian.known         = hessian.known && of->known;
        hessian.flat          = hessian.flat && of->flat;
        for (int j = 0; j < 6 && of->known; j++) {
            Range by      = range_mul(range_of(sum->weights[k]), of->by[j]);
            hessian.by[j] = k == 0 ? by : range_add(hessian.by[j], by);
        }
    }
    return hessian;
}

static bool has_derivatives(const Finding *f, uint32_t operand)
{
    return f->field->hessians[operand].known && f->field->ranges.sure[operand] &&
           has_slope(&f->field->slopes[operand]);
}

static bool add_sum(Finding *f, const Sum *sum, double sign, double offset)
{
    FieldPieces *pieces = f->pieces;
    size_t       i      = 0;
    for (uint32_t k = 0; k < sum->count; k++)
        if (!has_derivatives(f, sum->operands[k]))
            return false;
    while (i < pieces->count &&
           !(pieces->signs[i] == sign && pieces->offsets[i] == offset &&
             sums_are_equal(sum, f->operands[i], pieces->weights[i], pieces->values[i])))
        i++;
    if (i == MOST_PIECES || sum->count == 0)
        return false;
    if (i == pieces->count) {
        memcpy(f->operands[i], sum->operands, sizeof f->operands[i]);
        memcpy(pieces->weights[i], sum->weights, sizeof pieces->weights[i]);
        pieces->values[i]   = sum->count;
        pieces->signs[i]    = sign;
        pieces->offsets[i]  = offset;
        pieces->slopes[i]   = slope_of_sum(f->field->slopes, sum);
        pieces->hessians[i] = hessian_of_sum(f->field->hessians, sum);
        pieces->count++;
    }
    return add_step(f, (int)i);
}

static bool add_piece(Finding *f, uint32_t operand, double factor, double offset)
{
    const Sum sum = {{operand}, {fabs(factor)}, 1};
    return !(operand & LANE_SCALAR) && add_sum(f, &sum, copysign(1, factor), offset);
}

static bool is_greater(const LaneStep *step)
{
    return step->op == OP_max || step->op == LANE_GREATER;
}
static bool is_lesser(const LaneStep *step)
{
    return step->op == OP_min || step->op == LANE_LESSER;
}

/* ---- distances to boxes ---- */

static bool is_zero_in(const LaneTape *tape, const LaneRanges *ranges, uint32_t operand)
{
    return range_is_zero(operand & LANE_SCALAR ? range_of(tape->scalars[operand & ~LANE_SCALAR])
                                               : ranges->ranges[operand]);
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
    if (faces->count == MOST_FACES || (operand & LANE_SCALAR))
        return false;
    faces->operands[faces->count++] = operand;
    return true;
}

static bool find_greatest(const LaneTape *tape, uint32_t operand, FieldFaces *faces)
{
    const LaneStep *step = lane_step_of(tape, operand);
    if (step && is_greater(step))
        return find_greatest(tape, step->operands[0], faces) &&
               find_greatest(tape, step->operands[1], faces);
    return add_face(faces, operand);
}

/* What is the greatest of some numbers, of which one is 0. */
static bool find_above_zero(const LaneTape *tape, const LaneRanges *ranges, uint32_t operand,
                            FieldFaces *faces, bool *zero)
{
    const LaneStep *step = lane_step_of(tape, operand);
    if (is_zero_in(tape, ranges, operand))
        return *zero = true;
    if (step && is_greater(step))
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
    for (int k = 0; step && is_lesser(step) && k < 2; k++)
        if (!(step->operands[k] & LANE_SCALAR) && ranges->ranges[step->operands[k]].low >= 0)
            return field_outside(tape, ranges, step->operands[1 - k], faces);
    return step && is_greater(step) && find_above_zero(tape, ranges, operand, faces, &zero) && zero;
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
    for (int k = 0; step && is_lesser(step) && k < 2; k++)
        if (is_zero_in(tape, ranges, step->operands[1 - k]))
            return find_greatest(tape, step->operands[k], faces);
    return false;
}

/* length(max(q, 0)) + min(greatest q, 0) is above 0 where some q is, and else the greatest, if all that are not in the
   length are nowhere above 0.  So its sum with an offset has the sign of that of the greatest, unless the offset is below 0
   and the length has several: then it is rounded. */
static bool find_faces(const Finding *f, const LaneStep *step, double offset, FieldFaces *inside)
{
    for (int k = 0; k < 2; k++) {
        FieldFaces outside = {.count = 0};
        double     part    = 1;
        inside->count      = 0;
        if (!field_outside(f->tape, &f->field->ranges, step->operands[k], &outside))
            continue;
        bool fits = (offset >= 0 || outside.count == 1) &&
                    field_inside(f->tape, &f->field->ranges, step->operands[1 - k], inside,
                                 &part) &&
                    part == 1;
        for (size_t i = 0; fits && i < outside.count; i++)
            fits = field_has_face(inside, outside.operands[i]);
        for (size_t i = 0; fits && i < inside->count; i++)
            fits = field_has_face(&outside, inside->operands[i]) ||
                   range_of_operand(f, inside->operands[i]).high <= 0;
        if (fits)
            return true;
    }
    return false;
}

/* ---- all ---- */

/* A factor times an operand, and the offset. */
static bool find_pieces(Finding *f, uint32_t operand, double sign, double offset);

/* A number below 0 decides no sign of a maximum, and one above 0 none of a minimum. */
static bool decides_nothing(const Finding *f, uint32_t operand, double sign, double offset,
                            int choice)
{
    Range range = range_of_operand(f, operand);
    Range value = range_add(range_mul(range_of(sign), range), range_of(offset));
    bool  sure  = (operand & LANE_SCALAR) ? !isnan(range.low) : f->field->ranges.sure[operand];
    return sure && (choice == PIECE_MAX ? value.high < 0 : value.low > 0);
}

/* A minimum or maximum of two, of which one may be left out. */
static bool add_pair(Finding *f, const uint32_t operands[2], const double signs[2], double offset,
                     int choice)
{
    for (int k = 0; k < 2; k++)
        if (decides_nothing(f, operands[k], signs[k], offset, choice))
            return find_pieces(f, operands[1 - k], signs[1 - k], offset);
    return find_pieces(f, operands[0], signs[0], offset) &&
           find_pieces(f, operands[1], signs[1], offset) && add_step(f, choice);
}

static bool add_choice(Finding *f, const LaneStep *step, double sign, double offset, bool greater)
{
    const double signs[2] = {sign, sign};
    return add_pair(f, step->operands, signs, offset,
                    greater == (sign > 0) ? PIECE_MAX : PIECE_MIN);
}

/* The greater of a number and its complement. */
static bool add_size(Finding *f, const LaneStep *step, double sign, double offset)
{
    const uint32_t operands[2] = {step->operands[0], step->operands[0]};
    const double   signs[2]    = {sign, -sign};
    return add_pair(f, operands, signs, offset, sign > 0 ? PIECE_MAX : PIECE_MIN);
}

static bool add_box(Finding *f, const FieldFaces *faces, double sign, double offset)
{
    int    choice = sign > 0 ? PIECE_MAX : PIECE_MIN;
    size_t added  = 0;
    for (size_t i = 0; i < faces->count; i++) {
        bool last = added == 0 && i + 1 == faces->count;
        if (!last && decides_nothing(f, faces->operands[i], sign, offset, choice))
            continue;
        if (!find_pieces(f, faces->operands[i], sign, offset) ||
            (added++ > 0 && !add_step(f, choice)))
            return false;
    }
    return added > 0;
}

/* An operand that is the same everywhere is added to, or taken off, the other one. */
static bool add_shifted(Finding *f, const LaneStep *step, double sign, double offset)
{
    double way = step->op == OP_sub ? -1 : 1;
    if (step->operands[1] & LANE_SCALAR) {
        double shift = way * f->tape->scalars[step->operands[1] & ~LANE_SCALAR];
        return find_pieces(f, step->operands[0], sign, offset + sign * shift);
    }
    if (!(step->operands[0] & LANE_SCALAR))
        return false;
    double shift = f->tape->scalars[step->operands[0] & ~LANE_SCALAR];
    return find_pieces(f, step->operands[1], sign * way, offset + sign * shift);
}

static bool add_scaled(Finding *f, const LaneStep *step, double sign, double offset)
{
    for (int k = step->op == OP_div; k < 2; k++) {
        if (!(step->operands[k] & LANE_SCALAR))
            continue;
        double scalar = f->tape->scalars[step->operands[k] & ~LANE_SCALAR];
        double factor = sign * (step->op == OP_mul ? scalar : 1 / scalar);
        if (factor != 0 && isfinite(factor))
            return find_pieces(f, step->operands[1 - k], factor, offset);
    }
    return false;
}

/* A product or quotient with what is above 0, or a sign times what is nowhere below: a maximum of 0 and anything is a
   number, at least, whether that is sure or not. */
static bool add_signed(Finding *f, const LaneStep *step, double sign)
{
    for (int k = 0; k < (step->op == OP_div ? 1 : 2); k++) {
        uint32_t        other  = step->operands[1 - k];
        const LaneStep *factor = lane_step_of(f->tape, step->operands[k]);
        double          least  = range_of_operand(f, other).low;
        if (factor && factor->op == OP_sign && least >= 0)
            return find_pieces(f, factor->operands[0], sign, 0);
        if (least > 0 && ((other & LANE_SCALAR) || f->field->ranges.sure[other]))
            return find_pieces(f, step->operands[k], sign, 0);
    }
    return false;
}

/* Between numbers below and above 0. */
static bool add_clamped(Finding *f, const LaneStep *step, double sign)
{
    return range_of_operand(f, step->operands[1]).high < 0 &&
           range_of_operand(f, step->operands[2]).low > 0 &&
           find_pieces(f, step->operands[0], sign, 0);
}

/* A line of an outline is a weighted sum of the two coordinates. */
static bool add_line(Finding *f, const LaneStep *step, const double line[3], double factor,
                     double offset)
{
    const uint32_t *point = f->tape->calls[step->operands[0]].operands[1];
    Sum             sum   = {.count = 0};
    double          at    = line[2];
    for (int k = 0; k < 2; k++) {
        if (point[k] & LANE_SCALAR)
            at += line[k] * f->tape->scalars[point[k] & ~LANE_SCALAR];
        else if (line[k] != 0) {
            sum.operands[sum.count]  = point[k];
            sum.weights[sum.count++] = fabs(factor) * line[k];
        }
    }
    return add_sum(f, &sum, copysign(1, factor), offset + factor * at);
}

/* The distance to an outline, by one or two of its lines. */
static bool add_outline(Finding *f, const LaneStep *step, double factor, double offset)
{
    OutlineLines lines;
    if (!lane_outline_lines(f->tape, &f->field->ranges, (size_t)(step - f->tape->steps),
                            -offset / factor, &lines))
        return false;
    return add_line(f, step, lines.lines[0], factor, offset) &&
           (lines.count == 1 ||
            (add_line(f, step, lines.lines[1], factor, offset) &&
             add_step(f, lines.convex == (factor > 0) ? PIECE_MAX : PIECE_MIN)));
}

static bool find_pieces(Finding *f, uint32_t operand, double sign, double offset)
{
    enum { MOST_DEPTH = 40 };
    const LaneStep *step = lane_step_of(f->tape, operand);
    FieldFaces      faces;
    bool            found = false;
    if (!step || f->field->hessians[operand].known || f->depth == MOST_DEPTH)
        return add_piece(f, operand, sign, offset);
    if (step->op == LANE_CALL)
        return add_outline(f, step, sign, offset);
    f->depth++;
    if (step->op == OP_neg)
        found = find_pieces(f, step->operands[0], -sign, offset);
    else if (step->op == OP_abs)
        found = add_size(f, step, sign, offset);
    else if (is_greater(step) || is_lesser(step))
        found = add_choice(f, step, sign, offset, is_greater(step));
    else if (step->op == OP_add && find_faces(f, step, sign * offset, &faces))
        found = add_box(f, &faces, sign, offset);
    else if (step->op == OP_add || step->op == OP_sub)
        found = add_shifted(f, step, sign, offset);
    else if (step->op == OP_mul || step->op == OP_div)
        found = add_scaled(f, step, sign, offset) || (offset == 0 && add_signed(f, step, sign));
    else if (step->op == OP_clamp && offset == 0)
        found = add_clamped(f, step, sign);
    f->depth--;
    return found;
}

/* ---- how many there are at least ---- */

/* Whether it is never taken apart: it is a piece, or there are none. */
static bool is_whole(const LaneStep *step)
{
    return !is_greater(step) && !is_lesser(step) && step->op != OP_abs && step->op != OP_add &&
           step->op != OP_sub;
}

/* Of what is not chosen all over the box each number is a piece, or several are, and has derivatives.  Ranges tell
   that. */
static bool count_pieces(Finding *f, uint32_t operand, double sign, double offset)
{
    const LaneStep *step = lane_step_of(f->tape, operand);
    if (step && (is_greater(step) || is_lesser(step))) {
        Range a    = range_of_operand(f, step->operands[0]),
              b    = range_of_operand(f, step->operands[1]);
        int choice = is_greater(step) == (sign > 0) ? PIECE_MAX : PIECE_MIN;
        if (a.low < b.high && b.low < a.high) {
            for (int k = 0; k < 2; k++)
                if (decides_nothing(f, step->operands[k], sign, offset, choice))
                    return count_pieces(f, step->operands[1 - k], sign, offset);
            return count_pieces(f, step->operands[0], sign, offset) &&
                   count_pieces(f, step->operands[1], sign, offset);
        }
    }
    if (step && step->op == OP_neg)
        return count_pieces(f, step->operands[0], -sign, offset);
    size_t i = 0;
    while (i < f->pieces->count && f->operands[i][0] != operand)
        i++;
    if (i == MOST_PIECES ||
        (step && is_whole(step) && lane_is_boundless(f->tape, &f->field->ranges, operand)))
        return false;
    f->operands[i][0] = operand;
    f->pieces->count += i == f->pieces->count;
    return true;
}

static bool may_be_few(Finding *f)
{
    f->pieces->count = 0;
    return count_pieces(f, f->tape->outputs[0], 1, 0);
}

static uint32_t origin_of(const LaneTape *tape, uint32_t operand)
{
    bool step = !(operand & LANE_SCALAR) && operand >= LANE_INPUTS;
    return step ? tape->steps[operand - LANE_INPUTS].origin : 0;
}

uint32_t field_origin(const MeshField *field, Box box)
{
    const LaneTape *tape = &field->regions[field->region_count - 1].tape;
    return field_is_cut(field, box) ? 0 : origin_of(tape, tape->outputs[0]);
}

static bool keep_values(MeshField *field, const Finding *f)
{
    uint32_t outputs[MOST_PIECES * PIECE_VALUES];
    size_t   count = 0;
    for (size_t i = 0; i < f->pieces->count; i++)
        for (uint32_t k = 0; k < f->pieces->values[i]; k++)
            outputs[count++] = f->operands[i][k];
    return field_keep(field, outputs, count);
}

bool field_pieces(MeshField *field, Box box, FieldPieces *pieces)
{
    LaneSlope   slope;
    LaneHessian hessian;
    Finding     f = {.field = field, .pieces = pieces};
    if (field->region_count == 0 || field_is_cut(field, box))
        return false;
    f.tape = &field->regions[field->region_count - 1].tape;
    lane_ranges_run(f.tape, &field->ranges, box);
    if (!may_be_few(&f))
        return false;
    lane_slopes_run(f.tape, &field->ranges, field->slopes, &slope);
    lane_hessians_run(f.tape, &field->ranges, field->slopes, field->hessians, &hessian);
    pieces->count = pieces->step_count = 0;
    if (!find_pieces(&f, f.tape->outputs[0], 1, 0))
        return false;
    bool one = pieces->count == 1 && pieces->values[0] == 1 &&
               pieces->signs[0] * pieces->weights[0][0] == 1 && pieces->offsets[0] == 0;
    pieces->origin = one ? origin_of(f.tape, f.operands[0][0]) : 0;
    return keep_values(field, &f);
}

void field_piece_values(const MeshField *field, const FieldPieces *pieces,
                        const double (*points)[3], size_t point_count, double *values)
{
    double        all[MOST_FIELD_POINTS * MOST_PIECES * PIECE_VALUES];
    const double *value = all;
    lane_run(&field->pieces.tape, &field->work, LANE_DOUBLE,
             (LanePoints){.points = points, .count = point_count}, 0,
             field->pieces.tape.output_count, all);
    for (size_t i = 0; i < point_count * pieces->count; i++) {
        size_t piece = i % pieces->count;
        double sum   = 0;
        for (uint32_t k = 0; k < pieces->values[piece]; k++)
            sum += pieces->weights[piece][k] * *value++;
        values[i] = pieces->signs[piece] * sum + pieces->offsets[piece];
    }
}

bool field_piece_slope(const MeshField *field, const FieldPieces *pieces, Box part,
                       LaneSlope *slope)
{
    const LaneTape *tape = &field->pieces.tape;
    Sum             sum  = {.count = pieces->values[0]};
    lane_ranges_run(tape, &field->ranges, part);
    if (!lane_slopes_run(tape, &field->ranges, field->slopes, slope))
        return false;
    for (uint32_t k = 0; k < sum.count; k++) {
        sum.operands[k] = tape->outputs[k];
        sum.weights[k]  = pieces->weights[0][k];
        if ((sum.operands[k] & LANE_SCALAR) || !has_slope(&field->slopes[sum.operands[k]]))
            return false;
    }
    *slope = slope_of_sum(field->slopes, &sum);
    return true;
}
