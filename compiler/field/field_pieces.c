/*
 * field_pieces.c: the distance in a box, as minima and maxima of pieces.
 *
 * Only its sign is kept.  So the distance to a box, whose part outside is a length and whose part inside a
 * maximum, is the maximum of what its faces cut.
 */
#include <math.h>
#include <string.h>

#include "compiler/field/field.h"
#include "compiler/field/field_touching.h"
#include "compiler/graph/lanes/lane_outlines.h"
#include "compiler/graph/lanes/lane_waves.h"

typedef struct Finding {
    const MeshField *field;
    const LaneTape  *tape;
    FieldPieces     *pieces;
    uint32_t         operands[MAX_PIECES][PIECE_VALUES];
    int              depth;
} Finding;

static Range range_of_operand(const Finding *f, uint32_t operand)
{
    return lane_range_at(f->tape, &f->field->ranges, operand);
}

static bool add_step(Finding *f, int step)
{
    if (f->pieces->step_count == MAX_PIECE_STEPS)
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

/* A sum of operands times weights, and what is added.  Those whose weight is 0 are left out. */
typedef struct Sum {
    uint32_t operands[PIECE_VALUES];
    double   weights[PIECE_VALUES];
    uint32_t count;
    double   offset;
} Sum;

static Sum sum_of(uint32_t operand, double weight, double offset)
{
    return (Sum){{operand}, {weight}, 1, offset};
}

static void remove_term(Sum *sum, uint32_t k)
{
    sum->count--;
    for (; k < sum->count; k++) {
        sum->operands[k] = sum->operands[k + 1];
        sum->weights[k]  = sum->weights[k + 1];
    }
}

/* Adds a term; false: there is no room, or it is no number. */
static bool add_term(const LaneTape *tape, Sum *sum, uint32_t operand, double weight)
{
    if (operand & LANE_SCALAR) {
        sum->offset += weight * tape->scalars[operand & ~LANE_SCALAR];
        return isfinite(sum->offset);
    }
    for (uint32_t k = 0; k < sum->count; k++)
        if (sum->operands[k] == operand) {
            sum->weights[k] += weight;
            if (sum->weights[k] == 0)
                remove_term(sum, k);
            return true;
        }
    if (sum->count == PIECE_VALUES)
        return false;
    sum->operands[sum->count]  = operand;
    sum->weights[sum->count++] = weight;
    return true;
}

static bool piece_is(const Finding *f, size_t i, const Sum *sum, double sign)
{
    const FieldPieces *pieces = f->pieces;
    bool               equal  = pieces->values[i] == sum->count && pieces->signs[i] == sign &&
                 pieces->offsets[i] == sum->offset;
    for (uint32_t k = 0; equal && k < sum->count; k++)
        equal = f->operands[i][k] == sum->operands[k] &&
                sign * pieces->weights[i][k] == sum->weights[k];
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

static void set_piece(Finding *f, size_t i, const Sum *sum, double sign)
{
    FieldPieces *pieces = f->pieces;
    Sum          own    = *sum;
    for (uint32_t k = 0; k < sum->count; k++)
        own.weights[k] *= sign;
    memcpy(f->operands[i], own.operands, sizeof f->operands[i]);
    memcpy(pieces->weights[i], own.weights, sizeof pieces->weights[i]);
    pieces->values[i]   = own.count;
    pieces->signs[i]    = sign;
    pieces->offsets[i]  = own.offset;
    pieces->slopes[i]   = slope_of_sum(f->field->slopes, &own);
    pieces->hessians[i] = hessian_of_sum(f->field->hessians, &own);
}

static bool add_piece(Finding *f, const Sum *sum)
{
    double sign = copysign(1, sum->weights[0]);
    size_t i    = 0;
    for (uint32_t k = 0; k < sum->count; k++)
        if (!has_derivatives(f, sum->operands[k]))
            return false;
    while (i < f->pieces->count && !piece_is(f, i, sum, sign))
        i++;
    if (i == MAX_PIECES || sum->count == 0)
        return false;
    if (i == f->pieces->count) {
        set_piece(f, i, sum, sign);
        f->pieces->count++;
    }
    return add_step(f, (int)i);
}

/* ---- distances to boxes ---- */

/* Finds the faces of a distance.  length(max(q, 0)) + min(greatest q, 0) is above 0 where some q
   is, and else the greatest, if all that are not in the length are nowhere above 0.  So its sum
   with an offset has the sign of that of the greatest, unless the offset is below 0 and the length
   has several: then it is rounded. */
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

static bool find_pieces(Finding *f, const Sum *sum);

static bool find_signs(Finding *f, uint32_t operand, double sign)
{
    Sum sum = sum_of(operand, sign, 0);
    return !(operand & LANE_SCALAR) && find_pieces(f, &sum);
}

/* A number below 0 decides no sign of a maximum, and one above 0 none of a minimum. */
static bool decides_nothing(const Finding *f, const Sum *sum, int choice)
{
    Range value = range_of(sum->offset);
    bool  sure  = !isnan(sum->offset);
    for (uint32_t k = 0; k < sum->count; k++) {
        uint32_t operand = sum->operands[k];
        Range    range   = range_of_operand(f, operand);
        value            = range_add(value, range_mul(range_of(sum->weights[k]), range));
        sure             = sure &&
               ((operand & LANE_SCALAR) ? !isnan(range.low) : f->field->ranges.sure[operand]);
    }
    return sure && (choice == PIECE_MAX ? value.high < 0 : value.low > 0);
}

/* Adds a minimum or maximum of two, of which one may be left out. */
static bool add_pair(Finding *f, const Sum sums[2], int choice)
{
    for (int k = 0; k < 2; k++)
        if (decides_nothing(f, &sums[k], choice))
            return find_pieces(f, &sums[1 - k]);
    return find_pieces(f, &sums[0]) && find_pieces(f, &sums[1]) && add_step(f, choice);
}

/* Adds the sum with another term in the place of one; false: there is no room. */
static bool replace_term(const Finding *f, const Sum *sum, uint32_t k, uint32_t operand,
                         double factor, Sum *replaced)
{
    double weight = factor * sum->weights[k];
    *replaced     = *sum;
    remove_term(replaced, k);
    return add_term(f->tape, replaced, operand, weight);
}

/* Adds the lesser or greater of two sums, where a term is that of two numbers times factors. */
static bool add_choice(Finding *f, const Sum *sum, uint32_t k, const uint32_t operands[2],
                       const double factors[2], bool greater)
{
    Sum sums[2];
    return replace_term(f, sum, k, operands[0], factors[0], &sums[0]) &&
           replace_term(f, sum, k, operands[1], factors[1], &sums[1]) &&
           add_pair(f, sums, greater == (sum->weights[k] > 0) ? PIECE_MAX : PIECE_MIN);
}

/* Adds a term that is how far a number is from another one, at least or at most. */
static bool add_distance(Finding *f, const Sum *sum, uint32_t k, uint32_t number, double from)
{
    Range range = range_of_operand(f, number);
    Sum   sums[2];
    for (int i = 0; i < 2; i++) {
        if (!replace_term(f, sum, k, number, i == 0 ? 1 : -1, &sums[i]))
            return false;
        sums[i].offset -= (i == 0 ? 1 : -1) * from * sum->weights[k];
    }
    if (range.low >= from || range.high <= from)
        return find_pieces(f, &sums[range.low >= from ? 0 : 1]);
    return add_pair(f, sums, sum->weights[k] > 0 ? PIECE_MAX : PIECE_MIN);
}

/* Adds the distance of a number from the nearer one of two multiples of a period. */
static bool add_wave(Finding *f, const Sum *sum, uint32_t k, const LaneWave *wave)
{
    return wave->last - wave->first == 1 &&
           add_distance(f, sum, k, wave->number, wave->first * wave->period) &&
           add_distance(f, sum, k, wave->number, wave->last * wave->period) &&
           add_step(f, sum->weights[k] > 0 ? PIECE_MIN : PIECE_MAX);
}

static bool add_size(Finding *f, const Sum *sum, uint32_t k, const LaneStep *step)
{
    LaneWave wave = lane_wave(f->tape, &f->field->ranges, step);
    return wave.number != NODE_NONE && wave.last > wave.first
               ? add_wave(f, sum, k, &wave)
               : add_distance(f, sum, k, step->operands[0], 0);
}

static bool add_box(Finding *f, const FieldFaces *faces, double sign, double offset)
{
    int    choice = sign > 0 ? PIECE_MAX : PIECE_MIN;
    size_t added  = 0;
    for (size_t i = 0; i < faces->count; i++) {
        bool last = added == 0 && i + 1 == faces->count;
        Sum  face = sum_of(faces->operands[i], sign, offset);
        if (!last && decides_nothing(f, &face, choice))
            continue;
        if (!find_pieces(f, &face) || (added++ > 0 && !add_step(f, choice)))
            return false;
    }
    return added > 0;
}

/* Returns the operand that a product or quotient has beside a scalar, which is multiplied to the
   factor; NODE_NONE: there is none. */
static uint32_t scaled_operand(const Finding *f, const LaneStep *step, double *factor)
{
    for (int k = step->op == OP_div; k < 2; k++) {
        if (!(step->operands[k] & LANE_SCALAR))
            continue;
        double scalar = f->tape->scalars[step->operands[k] & ~LANE_SCALAR];
        double scaled = *factor * (step->op == OP_mul ? scalar : 1 / scalar);
        if (scaled == 0 || !isfinite(scaled))
            continue;
        *factor = scaled;
        return step->operands[1 - k];
    }
    return NODE_NONE;
}

/* Returns the one that a choice takes all over the box; NODE_NONE: either may be. */
static uint32_t chosen_operand(const Finding *f, const LaneStep *step)
{
    Range condition = range_of_operand(f, step->operands[0]);
    return condition.low > 0     ? step->operands[1]
           : condition.high <= 0 ? step->operands[2]
                                 : NODE_NONE;
}

/* Adds a term that is a sum, or a number times a scalar. */
static bool add_linear(Finding *f, const Sum *sum, uint32_t k, const LaneStep *step)
{
    double   weight = sum->weights[k];
    uint32_t scaled;
    Sum      parts;
    if (step->op == OP_add || step->op == OP_sub)
        return replace_term(f, sum, k, step->operands[0], 1, &parts) &&
               add_term(f->tape, &parts, step->operands[1],
                        step->op == OP_sub ? -weight : weight) &&
               find_pieces(f, &parts);
    double factor = step->op == OP_neg ? -1 : 1;
    if (step->op == OP_neg)
        scaled = step->operands[0];
    else if (step->op == OP_mul || step->op == OP_div)
        scaled = scaled_operand(f, step, &factor);
    else if (step->op == OP_select)
        scaled = chosen_operand(f, step);
    else
        return false;
    return scaled != NODE_NONE && replace_term(f, sum, k, scaled, factor, &parts) &&
           find_pieces(f, &parts);
}

/* Returns the operand that has the sign of a step, or NODE_NONE: of a product or quotient with what
   is above 0, of a sign times what is nowhere below, since a maximum of 0 and anything is a number,
   at least, whether that is sure or not; and of what is clamped between numbers below and above 0. */
static uint32_t operand_of_sign(const Finding *f, const LaneStep *step)
{
    if (step->op == OP_clamp)
        return range_of_operand(f, step->operands[1]).high < 0 &&
                       range_of_operand(f, step->operands[2]).low > 0
                   ? step->operands[0]
                   : NODE_NONE;
    for (int k = 0; k < (step->op == OP_mul ? 2 : step->op == OP_div ? 1 : 0); k++) {
        uint32_t        other  = step->operands[1 - k];
        const LaneStep *factor = lane_step_of(f->tape, step->operands[k]);
        double          least  = range_of_operand(f, other).low;
        if (factor && factor->op == OP_sign && least >= 0)
            return factor->operands[0];
        if (least > 0 && ((other & LANE_SCALAR) || f->field->ranges.sure[other]))
            return step->operands[k];
    }
    return NODE_NONE;
}

/* Returns 1 if a choice is nowhere above 0 where its condition holds and nowhere below 0 elsewhere,
   -1 if it is the other way round; 0: the condition does not tell its sign. */
static double sign_of_choice(const Finding *f, const LaneStep *step)
{
    Range chosen = range_of_operand(f, step->operands[1]),
          other  = range_of_operand(f, step->operands[2]);
    for (int k = 1; k < 3; k++)
        if (!(step->operands[k] & LANE_SCALAR) && !f->field->ranges.sure[step->operands[k]])
            return 0;
    if (chosen.high <= 0 && other.low >= 0)
        return 1;
    return chosen.low >= 0 && other.high <= 0 ? -1 : 0;
}

static bool add_condition(Finding *f, uint32_t operand, double sign);

/* Leaves out one of two that holds all over the box, or nowhere in it, where the other one decides. */
static bool add_conditions(Finding *f, const LaneStep *step, double sign)
{
    bool both = step->op == OP_and;
    for (int k = 0; k < 2; k++) {
        Range range = range_of_operand(f, step->operands[k]);
        if (both ? range.low > 0 : range.high <= 0)
            return add_condition(f, step->operands[1 - k], sign);
    }
    return add_condition(f, step->operands[0], sign) && add_condition(f, step->operands[1], sign) &&
           add_step(f, both == (sign > 0) ? PIECE_MAX : PIECE_MIN);
}

/* Adds a number that is below 0 where a condition holds and above 0 where it does not. */
static bool add_condition(Finding *f, uint32_t operand, double sign)
{
    const LaneStep *step       = lane_step_of(f->tape, operand);
    Sum             difference = {.count = 0};
    if (step && (step->op == OP_less || step->op == OP_less_equal))
        return add_term(f->tape, &difference, step->operands[0], sign) &&
               add_term(f->tape, &difference, step->operands[1], -sign) && difference.count > 0 &&
               find_pieces(f, &difference);
    if (step && step->op == OP_not)
        return add_condition(f, step->operands[0], -sign);
    return step && (step->op == OP_and || step->op == OP_or) && add_conditions(f, step, sign);
}

/* Adds the pieces of a choice whose condition tells the sign. */
static bool add_chosen(Finding *f, const LaneStep *step, double sign)
{
    double side = sign_of_choice(f, step);
    return side != 0 && add_condition(f, step->operands[0], sign * side);
}

/* A line of an outline is a weighted sum of the two coordinates. */
static bool add_line(Finding *f, const LaneStep *step, const double line[3], double factor,
                     double offset)
{
    const uint32_t *point = f->tape->calls[step->operands[0]].operands[1];
    Sum             sum   = {.offset = offset + factor * line[2]};
    for (int k = 0; k < 2; k++)
        if (line[k] != 0 && !add_term(f->tape, &sum, point[k], factor * line[k]))
            return false;
    return sum.count > 0 && find_pieces(f, &sum);
}

/* Adds the distance to an outline, by one or two of its lines. */
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

/* Adds a number times a factor alone: its sign, if nothing is added, may be that of simpler ones. */
static bool add_alone(Finding *f, const LaneStep *step, double factor, double offset)
{
    FieldFaces faces;
    if (step->op == LANE_CALL)
        return add_outline(f, step, factor, offset);
    if (step->op == OP_add && find_faces(f, step, factor * offset, &faces))
        return add_box(f, &faces, factor, offset);
    if (offset != 0)
        return false;
    if (step->op == OP_select)
        return add_chosen(f, step, factor);
    uint32_t same = operand_of_sign(f, step);
    return same != NODE_NONE && find_signs(f, same, factor);
}

/* Adds a sum whose term has no second derivatives. */
static bool add_split(Finding *f, const Sum *sum, uint32_t k, const LaneStep *step)
{
    static const double both[2] = {1, 1};
    if (field_is_lesser(step) || field_is_greater(step))
        return add_choice(f, sum, k, step->operands, both, field_is_greater(step));
    return step->op == OP_abs ? add_size(f, sum, k, step) : add_linear(f, sum, k, step);
}

static bool find_pieces(Finding *f, const Sum *sum)
{
    enum { MAX_DEPTH = 40 };
    uint32_t k = 0;
    while (k < sum->count && f->field->hessians[sum->operands[k]].known)
        k++;
    const LaneStep *step = k < sum->count ? lane_step_of(f->tape, sum->operands[k]) : NULL;
    if (!step || f->depth == MAX_DEPTH)
        return add_piece(f, sum);
    f->depth++;
    size_t steps = f->pieces->step_count, count = f->pieces->count;
    bool   found = sum->count == 1 && add_alone(f, step, sum->weights[0], sum->offset);
    if (!found) {
        f->pieces->step_count = steps;
        f->pieces->count      = count;
        found                 = add_split(f, sum, k, step);
    }
    f->depth--;
    return found;
}

/* ---- how many there are at least ---- */

/* Tells whether a step is never taken apart: it is a piece, or there are none. */
static bool is_whole(const LaneStep *step)
{
    return !field_is_greater(step) && !field_is_lesser(step) && step->op != OP_abs &&
           step->op != OP_add && step->op != OP_sub;
}

/* Counts the pieces of what is not chosen all over the box: each number that has derivatives is one.  Ranges
   tell that. */
static bool count_pieces(Finding *f, uint32_t operand, double sign, double offset)
{
    const LaneStep *step = lane_step_of(f->tape, operand);
    if (step && (field_is_greater(step) || field_is_lesser(step))) {
        Range a    = range_of_operand(f, step->operands[0]),
              b    = range_of_operand(f, step->operands[1]);
        int choice = field_is_greater(step) == (sign > 0) ? PIECE_MAX : PIECE_MIN;
        if (a.low < b.high && b.low < a.high) {
            for (int k = 0; k < 2; k++) {
                Sum sum = sum_of(step->operands[k], sign, offset);
                if (decides_nothing(f, &sum, choice))
                    return count_pieces(f, step->operands[1 - k], sign, offset);
            }
            return count_pieces(f, step->operands[0], sign, offset) &&
                   count_pieces(f, step->operands[1], sign, offset);
        }
    }
    if (step && step->op == OP_neg)
        return count_pieces(f, step->operands[0], -sign, offset);
    if (step && step->op == OP_select && offset == 0 && sign_of_choice(f, step) != 0)
        return true;
    uint32_t scaled = step && (step->op == OP_mul || step->op == OP_div)
                          ? scaled_operand(f, step, &sign)
                          : NODE_NONE;
    if (scaled == NODE_NONE && step && offset == 0)
        scaled = operand_of_sign(f, step);
    if (scaled != NODE_NONE)
        return count_pieces(f, scaled, sign, offset);
    size_t i = 0;
    while (i < f->pieces->count && f->operands[i][0] != operand)
        i++;
    if (i == MAX_PIECES ||
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
    uint32_t outputs[MAX_PIECES * PIECE_VALUES];
    size_t   count = 0;
    for (size_t i = 0; i < f->pieces->count; i++)
        for (uint32_t k = 0; k < f->pieces->values[i]; k++)
            outputs[count++] = f->operands[i][k];
    return field_keep(field, outputs, count);
}

static bool find_all(MeshField *field, Box box, Finding *f)
{
    FieldPieces *pieces = f->pieces;
    LaneSlope    slope;
    LaneHessian  hessian;
    if (field->region_count == 0 || field_is_cut(field, box))
        return false;
    f->field = field;
    f->tape  = &field->regions[field->region_count - 1].tape;
    lane_ranges_run(f->tape, &field->ranges, box);
    if (!may_be_few(f))
        return false;
    lane_slopes_run(f->tape, &field->ranges, field->slopes, &slope);
    lane_hessians_run(f->tape, &field->ranges, field->slopes, field->hessians, &hessian);
    pieces->side  = 0;
    pieces->count = pieces->step_count = 0;
    Sum whole                          = sum_of(f->tape->outputs[0], 1, 0);
    if ((whole.operands[0] & LANE_SCALAR) || !find_pieces(f, &whole))
        return false;
    if (pieces->count > 1)
        field_drop_touching(f->tape, &field->ranges, pieces, f->operands);
    return true;
}

bool field_pieces(MeshField *field, Box box, FieldPieces *pieces)
{
    Finding f = {.pieces = pieces};
    if (!find_all(field, box, &f))
        return false;
    bool one = pieces->count == 1 && pieces->values[0] == 1 &&
               pieces->signs[0] * pieces->weights[0][0] == 1 && pieces->offsets[0] == 0;
    pieces->origin = one ? origin_of(f.tape, f.operands[0][0]) : 0;
    return pieces->side != 0 || keep_values(field, &f);
}

int field_side(MeshField *field, Box box)
{
    FieldPieces pieces;
    Finding     f     = {.pieces = &pieces};
    Range       range = field_range(field, box);
    if (range.low > 0 || range.high < 0)
        return range.low > 0 ? 1 : -1;
    return find_all(field, box, &f) ? pieces.side : 0;
}

void field_piece_values(const MeshField *field, const FieldPieces *pieces,
                        const double (*points)[3], size_t point_count, double *values)
{
    double        all[MAX_FIELD_POINTS * MAX_PIECES * PIECE_VALUES];
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
