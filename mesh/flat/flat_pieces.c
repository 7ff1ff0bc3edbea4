/*
 * flat_pieces.c: finds half-spaces from the steps of a lane tape.
 *
 * A sum with a kink is the minimum or the maximum of two sums without it, by the sign of its
 * factor.  Lengths and outlines are kinks, too (flat_circles.h, flat_outlines.h).
 *
 * One thing is assumed without a proof: that a distance to a box is 0 or less where none of its
 * faces is above 0.  So flat.c checks that the surface is on the faces that come out
 * (is_on_surface).
 */
#include "mesh/flat/flat_pieces.h"

#include "compiler/base/vec.h"
#include "mesh/flat/flat_circles.h"
#include "mesh/flat/flat_outlines.h"

enum { UNKNOWN = -3 };

/* ---- distances to boxes ---- */

static void join_faces(FieldFaces *faces, const FieldFaces *others)
{
    for (size_t i = 0; i < others->count; i++)
        if (!field_has_face(faces, others->operands[i]) && faces->count < MAX_FACES)
            faces->operands[faces->count++] = others->operands[i];
}

/* Finds the faces of length(max(q, 0)) + min(greatest of some q, 0), a distance to a box: it is
   above 0 where some q is.  What is added to it must not be below 0, unless there is one q
   alone. */
static bool find_box_faces(const Finding *f, uint32_t value, double added, FieldFaces *faces,
                           double *part)
{
    const LaneStep *step = &f->tape->steps[value - LANE_INPUTS];
    for (int k = 0; step->op == OP_add && k < 2; k++) {
        FieldFaces outside = {.count = 0};
        faces->count       = 0;
        *part              = 1;
        if (!field_outside(f->tape, &f->field->ranges, step->operands[k], &outside) ||
            !field_inside(f->tape, &f->field->ranges, step->operands[1 - k], faces, part))
            continue;
        if (added == 0)
            join_faces(faces, &outside);
        return added >= 0 || (outside.count == 1 && faces->count == 1 &&
                              outside.operands[0] == faces->operands[0]);
    }
    return false;
}

static int solid_of_faces(Finding *f, const FieldFaces *faces, double factor, double added)
{
    int solid = factor > 0 ? FLAT_ALL : FLAT_NONE;
    for (size_t i = 0; i < faces->count; i++) {
        Form own  = form_of_operand(f, faces->operands[i]);
        Form form = form_sum(form_constant(added), factor, &own);
        int  face = flat_solid(f, &form);
        solid     = factor > 0 ? flat_both(f, solid, face) : flat_either(f, solid, face);
    }
    return solid;
}

/* ---- conditions ---- */

/* Returns the solid where the first number is below the second; it has no slack of lengths around
   it. */
static int solid_of_less(Finding *f, uint32_t first, uint32_t second)
{
    Form a = form_of_operand(f, first), b = form_of_operand(f, second),
         difference   = form_sum(a, -1, &b);
    bool      chooses = f->chooses;
    FlatSlack slack   = f->slack;
    f->chooses        = true;
    f->slack          = (FlatSlack){0, 0};
    int solid         = flat_solid(f, &difference);
    f->chooses        = chooses;
    f->slack          = slack;
    return solid;
}

/* Returns the solid where a condition is true. */
static int solid_of_condition(Finding *f, uint32_t operand)
{
    const LaneStep *step  = lane_step_of(f->tape, operand);
    Range           range = step ? f->field->ranges.ranges[operand]
                                 : range_of(f->tape->scalars[operand & ~LANE_SCALAR]);
    if (f->failed || range.low > 0 || range.high <= 0)
        return range.low > 0 ? FLAT_ALL : FLAT_NONE;
    int *known = &f->conditions[operand];
    if (*known != UNKNOWN)
        return *known;
    int solid = FLAT_NONE;
    if (step->op == OP_less || step->op == OP_less_equal)
        solid = solid_of_less(f, step->operands[0], step->operands[1]);
    else if (step->op == OP_not)
        solid = flat_complement(f, solid_of_condition(f, step->operands[0]));
    else if (step->op == OP_and || step->op == OP_or) {
        int first  = solid_of_condition(f, step->operands[0]);
        int second = solid_of_condition(f, step->operands[1]);
        solid = step->op == OP_and ? flat_both(f, first, second) : flat_either(f, first, second);
    } else
        f->failed = true;
    return *known = solid;
}

static bool is_number(const Finding *f, uint32_t operand, double sign)
{
    return (operand & LANE_SCALAR) && sign * f->tape->scalars[operand & ~LANE_SCALAR] > 0;
}

/* Returns the symmetric difference of two solids. */
static int one_only(Finding *f, int a, int b)
{
    if (a < 0 || b < 0)
        return a == FLAT_NONE || b == FLAT_NONE ? (a == FLAT_NONE ? b : a)
                                                : flat_complement(f, a == FLAT_ALL ? b : a);
    int common = flat_both(f, a, b), any = flat_either(f, a, b);
    if (common == FLAT_NONE || any == FLAT_ALL)
        return common == FLAT_NONE ? any : flat_complement(f, common);
    int first = flat_both(f, a, flat_complement(f, b));
    return flat_either(f, first, flat_both(f, flat_complement(f, a), b));
}

/* Finds the solid where a product is below 0 whose factors have known signs, or choose between a
   positive and a negative number. */
static bool find_sign(Finding *f, uint32_t operand, int *solid)
{
    const LaneStep *step  = lane_step_of(f->tape, operand);
    Range           range = step ? f->field->ranges.ranges[operand]
                                 : range_of(operand & LANE_SCALAR ? f->tape->scalars[operand & ~LANE_SCALAR]
                                                                  : NAN);
    if (range.low >= 0 || range.high <= 0) {
        *solid = range.low >= 0 ? FLAT_NONE : FLAT_ALL;
        return true;
    }
    if (step && step->op == OP_mul) {
        int  first, second;
        bool found = find_sign(f, step->operands[0], &first) &&
                     find_sign(f, step->operands[1], &second);
        if (found)
            *solid = one_only(f, first, second);
        return found;
    }
    for (int sign = -1; step && step->op == OP_select && sign <= 1; sign += 2)
        if (is_number(f, step->operands[1], sign) && is_number(f, step->operands[2], -sign)) {
            *solid = solid_of_condition(f, step->operands[0]);
            if (sign > 0)
                *solid = flat_complement(f, *solid);
            return true;
        }
    Form form = form_of_operand(f, operand);
    *solid    = flat_solid(f, &form);
    return !f->failed;
}

static int solid_of_pair(Finding *f, const Form *rest, double factor, const Form pair[2],
                         bool greater)
{
    Form a = form_sum(*rest, factor, &pair[0]), b = form_sum(*rest, factor, &pair[1]);
    int  first = flat_solid(f, &a), second = flat_solid(f, &b);
    return greater == (factor > 0) ? flat_both(f, first, second) : flat_either(f, first, second);
}

/* Returns the solid of one of two forms, chosen by a condition. */
static int solid_of_choice(Finding *f, const Form *rest, double factor, const LaneStep *step)
{
    Form first  = form_of_operand(f, step->operands[1]),
         second = form_of_operand(f, step->operands[2]);
    Form a = form_sum(*rest, factor, &first), b = form_sum(*rest, factor, &second);
    int  condition = solid_of_condition(f, step->operands[0]);
    int  where     = flat_both(f, condition, flat_solid(f, &a));
    return flat_either(f, where, flat_both(f, flat_complement(f, condition), flat_solid(f, &b)));
}

/* Returns the solid of a clamped number: the greater of the lower limit, and of the lesser of the
   number and the upper limit. */
static int solid_of_clamped(Finding *f, const Form *rest, double factor, const LaneStep *step)
{
    int solids[3];
    for (int k = 0; k < 3; k++) {
        Form own  = form_of_operand(f, step->operands[k]);
        Form form = form_sum(*rest, factor, &own);
        solids[k] = flat_solid(f, &form);
    }
    return factor > 0 ? flat_both(f, flat_either(f, solids[0], solids[2]), solids[1])
                      : flat_either(f, flat_both(f, solids[0], solids[2]), solids[1]);
}

/* Returns the solid of a distance to a box, as the sum of both its terms. */
static int solid_of_sum(Finding *f, const Form *rest, double factor, const LaneStep *step)
{
    Form first   = form_of_operand(f, step->operands[0]),
         second  = form_of_operand(f, step->operands[1]);
    Form both_of = form_sum(*rest, factor, &first);
    both_of      = form_sum(both_of, factor, &second);
    return flat_solid(f, &both_of);
}

/* Splits a form at its last kink, on which no other depends. */
static int solid_of_kink(Finding *f, const Form *form)
{
    uint32_t   value  = form->kinks[0];
    double     factor = form->factors[0];
    Form       rest   = *form, pair[2];
    FieldFaces faces;
    form_drop_kink(&rest, 0);
    if (value < LANE_INPUTS) {
        f->failed = true;
        return FLAT_NONE;
    }
    const LaneStep *step = &f->tape->steps[value - LANE_INPUTS];
    if (is_greater(step) || is_lesser(step)) {
        pair[0] = form_of_operand(f, step->operands[0]);
        pair[1] = form_of_operand(f, step->operands[1]);
        return solid_of_pair(f, &rest, factor, pair, is_greater(step));
    }
    if (step->op == OP_abs) {
        pair[0] = form_of_operand(f, step->operands[0]);
        pair[1] = form_scaled(-1, &pair[0]);
        return solid_of_pair(f, &rest, factor, pair, true);
    }
    if (step->op == OP_clamp)
        return solid_of_clamped(f, &rest, factor, step);
    if (step->op == OP_length)
        return flat_solid_of_length(f, &rest, factor, step);
    double part;
    if (form_is_kink_alone(form) && find_box_faces(f, value, rest.at / factor, &faces, &part))
        return solid_of_faces(f, &faces, factor * part, rest.at);
    if (step->op == OP_add)
        return solid_of_sum(f, &rest, factor, step);
    if (step->op == OP_select)
        return solid_of_choice(f, &rest, factor, step);
    int solid;
    if (form_is_kink_alone(form) && rest.at == 0 && step->op == LANE_CALL) {
        solid = flat_solid_of_outline(f, value);
        return factor > 0 ? solid : flat_complement(f, solid);
    }
    if (form_is_kink_alone(form) && rest.at == 0 && step->op == OP_mul &&
        find_sign(f, value, &solid))
        return factor > 0 ? solid : flat_complement(f, solid);
    f->failed = true;
    return FLAT_NONE;
}

int flat_solid(Finding *f, const Form *form)
{
    Range range = form_range(f, form);
    if (f->failed || !form->known || isnan(range.low) || isnan(range.high)) {
        f->failed = true;
        return FLAT_NONE;
    }
    double moved = form_is_constant(form) ? 0 : form_slope(f, form) * flat_moved(f);
    if (range.low >= moved || range.high <= -moved)
        return range.low >= moved ? FLAT_NONE : FLAT_ALL;
    return form->kink_count == 0 ? flat_half_space(f, form) : solid_of_kink(f, form);
}

/* Intersects a solid with the box to which the field is cut. */
static int cut(Finding *f, int solid)
{
    for (int i = 0; f->field->cut && i < 6; i++) {
        int  k     = i / 2;
        Form form  = form_constant(i % 2 ? -f->field->high[k] : f->field->low[k]);
        form.by[k] = i % 2 ? 1 : -1;
        solid      = flat_both(f, solid, flat_half_space(f, &form));
    }
    return solid;
}

FlatWork flat_work_new(const MeshField *field, Arena *arena)
{
    size_t most = LANE_INPUTS + lane_max_steps(&field->tape);
    return (FlatWork){arena_new_array(arena, Form, most), arena_new_array(arena, int, most)};
}

bool flat_pieces(MeshField *field, Box box, double size, FlatRounds *rounds, FlatUse use,
                 FlatWork *work, FlatPieces *pieces)
{
    static const uint32_t MAX_USED[] = {8, 24}, MAX_AROUND[] = {100, 100};
    Finding f    = {.field = field, .box = box, .size = size, .rounds = rounds, .pieces = pieces};
    f.use        = use;
    f.max_used   = MAX_USED[use];
    f.max_around = MAX_AROUND[use];
    f.tape       = &field->regions[field->region_count - 1].tape;
    f.forms      = work->forms;
    f.conditions = work->conditions;
    for (size_t i = 0; i < LANE_INPUTS + f.tape->count; i++)
        f.conditions[i] = UNKNOWN;
    pieces->count = pieces->node_count = 0;
    pieces->round                      = false;
    lane_ranges_run(f.tape, &field->ranges, box);
    find_forms(&f);
    Form root    = form_of_operand(&f, f.tape->outputs[0]);
    pieces->root = cut(&f, flat_solid(&f, &root));
    return !f.failed && field->state->zone_count == 0;
}
