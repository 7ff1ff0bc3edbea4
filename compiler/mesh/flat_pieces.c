/*
 * flat_pieces.c: half-spaces from the steps of a lane tape.
 *
 * Each linear step is a form: a sum of coordinates, and of kinks, which are minima, maxima and absolute values of forms.
 * A sum with a kink is the minimum or the maximum of two sums without it, by the sign of its factor.  A length is a kink, too:
 * that of a pair of numbers is the maximum of what the sides of a polygon tell, and that of three is the length of a pair of which
 * one is the length of a pair.  So balls have bands.
 *
 * One thing is taken for granted and not proven: that a distance to a box is 0 or less where none of its faces is above 0.  So
 * who uses the half-spaces looks whether the surface is on the faces that come out (flat.c: is_on_surface).
 */
#include "compiler/mesh/flat_pieces.h"

#include <string.h>

#include "compiler/base/vec.h"
#include "compiler/graph/crowd.h"
#include "compiler/graph/lane_outlines.h"

enum { MOST_KINKS = 6 };

/* by . p + at, and kinks: results of steps, by their numbers as operands, the last ones first. */
typedef struct Form {
    bool     known;
    double   by[3], at;
    uint32_t kinks[MOST_KINKS];
    double   factors[MOST_KINKS];
    int      kink_count;
} Form;

typedef struct Finding {
    const MeshField *field;
    const LaneTape  *tape;
    Box              box;
    double           size;
    Form            *forms;      /* of inputs and steps */
    int             *conditions; /* of each operand, where it is true; UNKNOWN: not looked at */
    FlatRounds      *rounds;
    FlatPieces      *pieces;
    FlatSlack        slack;                  /* of what is being taken apart */
    uint32_t         most_used, most_around; /* of the sides of a polygon */
    bool             failed;
} Finding;

enum { UNKNOWN = -3 };

static const double ROUNDING = 1e-11; /* parts of the size */

/* ---- forms ---- */

static Form constant_form(double number) { return (Form){.known = isfinite(number), .at = number}; }

static Form form_of(const Finding *f, uint32_t operand)
{
    return operand & LANE_SCALAR ? constant_form(f->tape->scalars[operand & ~LANE_SCALAR])
                                 : f->forms[operand];
}

static bool is_constant(const Form *form)
{
    return form->known && form->kink_count == 0 && form->by[0] == 0 && form->by[1] == 0 &&
           form->by[2] == 0;
}

static void drop_kink(Form *form, int i)
{
    form->kink_count--;
    for (; i < form->kink_count; i++) {
        form->kinks[i]   = form->kinks[i + 1];
        form->factors[i] = form->factors[i + 1];
    }
}

static void add_kink(Form *form, uint32_t kink, double factor)
{
    int i = 0;
    while (i < form->kink_count && form->kinks[i] > kink)
        i++;
    if (i < form->kink_count && form->kinks[i] == kink) {
        form->factors[i] += factor;
        if (fabs(form->factors[i]) <= 1e-14 * fabs(factor))
            drop_kink(form, i);
        return;
    }
    if (form->kink_count == MOST_KINKS) {
        form->known = false;
        return;
    }
    for (int k = form->kink_count++; k > i; k--) {
        form->kinks[k]   = form->kinks[k - 1];
        form->factors[k] = form->factors[k - 1];
    }
    form->kinks[i]   = kink;
    form->factors[i] = factor;
}

/* a + factor b */
static Form sum_of(Form a, double factor, const Form *b)
{
    a.known = a.known && b->known && isfinite(factor);
    for (int k = 0; k < 3; k++)
        a.by[k] += factor * b->by[k];
    a.at += factor * b->at;
    for (int i = 0; i < b->kink_count && a.known && factor != 0; i++)
        add_kink(&a, b->kinks[i], factor * b->factors[i]);
    return a;
}

static Form scaled(double factor, const Form *form)
{
    return sum_of(constant_form(0), factor, form);
}

/* The values of a form in the box, by the ranges of its kinks. */
static Range range_of_form(const Finding *f, const Form *form)
{
    double low = form->at, high = form->at;
    for (int k = 0; k < 3; k++) {
        double a = form->by[k] * f->box.axis[k].low, b = form->by[k] * f->box.axis[k].high;
        low += min2(a, b);
        high += max2(a, b);
    }
    for (int i = 0; i < form->kink_count; i++) {
        Range  kink = f->field->ranges.ranges[form->kinks[i]];
        double a = form->factors[i] * kink.low, b = form->factors[i] * kink.high;
        low += min2(a, b);
        high += max2(a, b);
    }
    return (Range){low, high};
}

/* ---- steps ---- */

static Form kink_form(uint32_t operand)
{
    Form form = constant_form(0);
    add_kink(&form, operand, 1);
    return form;
}

static bool is_greater(const LaneStep *step)
{
    return step->op == OP_max || step->op == LANE_GREATER;
}
static bool is_lesser(const LaneStep *step)
{
    return step->op == OP_min || step->op == LANE_LESSER;
}

static bool is_kink(const Form *form, uint32_t value)
{
    return form->kink_count == 1 && form->kinks[0] == value;
}

/* One of two forms that is the lesser, or the greater, all over the box; else a kink. */
static Form chosen(const Finding *f, const Form *a, const Form *b, bool greater, uint32_t value)
{
    if (!a->known || !b->known)
        return (Form){.known = false};
    Form  difference = sum_of(*a, -1, b);
    Range range      = range_of_form(f, &difference);
    if (difference.known && (greater ? range.low >= 0 : range.high <= 0))
        return *a;
    if (difference.known && (greater ? range.high <= 0 : range.low >= 0))
        return *b;
    return kink_form(value);
}

static Form size_form(const Finding *f, const Form *a, uint32_t value)
{
    Form negative = scaled(-1, a);
    return chosen(f, a, &negative, true, value);
}

/* A number between two others where it is one of them, or itself, all over the box. */
static Form clamped_form(const Finding *f, const LaneStep *step, uint32_t value)
{
    Form number = form_of(f, step->operands[0]);
    for (uint32_t k = 1; k < 3 && number.known; k++) {
        Form limit = form_of(f, step->operands[k]);
        number     = chosen(f, &number, &limit, k == 1, value);
        if (is_kink(&number, value))
            return number;
    }
    return number;
}

static Form product_of(const Form *a, const Form *b)
{
    if (is_constant(a))
        return scaled(a->at, b);
    if (is_constant(b))
        return scaled(b->at, a);
    return (Form){.known = false};
}

/* The length of one number is its size. */
static Form length_form(const Finding *f, const LaneStep *step, uint32_t value)
{
    int one = -1;
    for (uint32_t k = 0; k < step->operand_count; k++) {
        Form form = form_of(f, step->operands[k]);
        if (is_constant(&form) && form.at == 0)
            continue;
        if (one >= 0)
            return kink_form(value);
        one = (int)k;
    }
    Form form = one < 0 ? constant_form(0) : form_of(f, step->operands[one]);
    return size_form(f, &form, value);
}

/* Whether it is what a distance to a box is the sum of. */
static bool is_box_distance(const Finding *f, const LaneStep *step)
{
    for (int k = 0; k < 2; k++) {
        FieldFaces outside = {.count = 0}, inside = {.count = 0};
        double     part = 1;
        if (field_outside(f->tape, &f->field->ranges, step->operands[k], &outside) &&
            field_inside(f->tape, &f->field->ranges, step->operands[1 - k], &inside, &part))
            return true;
    }
    return false;
}

/* What is not linear is a kink: its sign may be known. */
static Form form_of_step(const Finding *f, size_t i)
{
    const LaneStep *step  = &f->tape->steps[i];
    uint32_t        value = (uint32_t)(LANE_INPUTS + i);
    Form            a = {.known = false}, b = {.known = false};
    Range           range = f->field->ranges.ranges[value];
    if (range_is_single(range) && f->field->ranges.sure[value])
        return constant_form(range.low);
    if (step->op == LANE_CALL || step->op == LANE_PART)
        return kink_form(value);
    if (step->operand_count > 0)
        a = form_of(f, step->operands[0]);
    if (step->operand_count > 1)
        b = form_of(f, step->operands[1]);
    Form form = {.known = false};
    if (step->op == OP_neg)
        form = scaled(-1, &a);
    else if (step->op == OP_precise)
        form = a;
    else if (step->op == OP_add && !is_box_distance(f, step))
        form = sum_of(a, 1, &b);
    else if (step->op == OP_sub)
        form = sum_of(a, -1, &b);
    else if (step->op == OP_mul)
        form = product_of(&a, &b);
    else if (step->op == OP_div && is_constant(&b) && b.at != 0)
        form = scaled(1 / b.at, &a);
    else if (step->op == OP_abs)
        form = size_form(f, &a, value);
    else if (is_greater(step) || is_lesser(step))
        form = chosen(f, &a, &b, is_greater(step), value);
    else if (step->op == OP_clamp)
        form = clamped_form(f, step, value);
    else if (step->op == OP_length)
        form = length_form(f, step, value);
    return form.known ? form : kink_form(value);
}

static void find_forms(Finding *f)
{
    for (uint32_t i = 0; i < LANE_INPUTS; i++)
        f->forms[i] = (Form){.known = i < 3};
    for (int k = 0; k < 3; k++)
        f->forms[LANE_POINT + k].by[k] = 1;
    for (size_t i = 0; i < f->tape->count; i++)
        f->forms[LANE_INPUTS + i] = form_of_step(f, i);
}

/* ---- solids ---- */

static int add_node(Finding *f, FlatNode node)
{
    if (f->pieces->node_count == MOST_FLAT_NODES) {
        f->failed = true;
        return FLAT_NONE;
    }
    f->pieces->nodes[f->pieces->node_count] = node;
    return (int)f->pieces->node_count++;
}

static int join(Finding *f, int kind, int a, int b)
{
    int all  = kind == FLAT_BOTH ? FLAT_ALL : FLAT_NONE,
        none = kind == FLAT_BOTH ? FLAT_NONE : FLAT_ALL;
    if (a == none || b == none)
        return none;
    if (a == all || b == all || a == b)
        return a == all ? b : a;
    return add_node(f, (FlatNode){kind, a, b});
}

/* How two half-spaces lie whose planes are parallel. */
typedef enum Placing { APART, COVERING, WITHIN, AROUND, CROSSING } Placing;

static Placing find_placing(const Finding *f, const FlatNode *a, const FlatNode *b)
{
    const HalfSpace *first = &f->pieces->list[a->first], *second = &f->pieces->list[b->first];
    double           off[3], turned = a->second * b->second * dot3(first->normal, second->normal);
    double           sign = turned < 0 ? -1 : 1, margin = ROUNDING * f->size;
    for (int k = 0; k < 3; k++)
        off[k] = a->second * first->normal[k] - sign * b->second * second->normal[k];
    double depth = a->second * first->offset - sign * b->second * second->offset;
    if (!(largest3(off) < ROUNDING) || !isfinite(depth))
        return CROSSING;
    if (turned < 0)
        return depth >= -margin ? APART : COVERING;
    return depth >= -margin ? WITHIN : AROUND;
}

/* A solid where a half-space is, or else where it is not. */
static int given(Finding *f, const FlatNode *known, bool inside, int solid)
{
    if (solid < 0 || f->failed)
        return solid;
    FlatNode node = f->pieces->nodes[solid];
    if (node.kind == FLAT_HALF_SPACE) {
        Placing placing = find_placing(f, &node, known);
        if (inside)
            return placing == APART ? FLAT_NONE : placing == AROUND ? FLAT_ALL : solid;
        return placing == WITHIN ? FLAT_NONE : placing == COVERING ? FLAT_ALL : solid;
    }
    int first = given(f, known, inside, node.first), second = given(f, known, inside, node.second);
    return first == node.first && second == node.second ? solid : join(f, node.kind, first, second);
}

/* The second solid where the half-spaces are that the first is an intersection with, or not those of a union. */
static int given_solid(Finding *f, int kind, int known, int solid)
{
    if (known < 0 || solid < 0)
        return solid;
    FlatNode node = f->pieces->nodes[known];
    if (node.kind == FLAT_HALF_SPACE)
        return given(f, &node, kind == FLAT_BOTH, solid);
    return (int)node.kind != kind
               ? solid
               : given_solid(f, kind, node.second, given_solid(f, kind, node.first, solid));
}

/* Leaves out what makes no difference: faces of parts within others, and where parts touch. */
static int join_solids(Finding *f, int kind, int a, int b)
{
    b = given_solid(f, kind, a, b);
    a = given_solid(f, kind, b, a);
    return join(f, kind, a, b);
}

static int both(Finding *f, int a, int b) { return join_solids(f, FLAT_BOTH, a, b); }

static int either(Finding *f, int a, int b) { return join_solids(f, FLAT_EITHER, a, b); }

/* The number of a half-space, or of the one on its other side, whose sign is then -1. */
static int find_half_space(Finding *f, const HalfSpace *plane, int *sign)
{
    FlatPieces *pieces = f->pieces;
    for (size_t i = 0; i < pieces->count; i++) {
        *sign = dot3(plane->normal, pieces->list[i].normal) < 0 ? -1 : 1;
        double off[3];
        add_scaled3(off, plane->normal, -*sign, pieces->list[i].normal);
        if (largest3(off) < ROUNDING &&
            fabs(plane->offset - *sign * pieces->list[i].offset) < ROUNDING * f->size)
            return (int)i;
    }
    *sign = 1;
    if (pieces->count == MOST_FLATS) {
        f->failed = true;
        return 0;
    }
    pieces->list[pieces->count]  = *plane;
    pieces->slack[pieces->count] = (FlatSlack){0, 0};
    return (int)pieces->count++;
}

static void add_slack(Finding *f, int number, double below, double above, double length)
{
    FlatSlack *slack = &f->pieces->slack[number];
    slack->below     = max2(slack->below, below / length);
    slack->above     = max2(slack->above, above / length);
}

/* Where a form without kinks is below 0. */
static int half_space(Finding *f, const Form *form)
{
    Range     range  = range_of_form(f, form);
    double    length = length3(form->by);
    HalfSpace plane;
    int       sign;
    if (range.low > 0 || range.high < 0)
        return range.low > 0 ? FLAT_NONE : FLAT_ALL;
    if (!(length > 0)) {
        f->failed = true;
        return FLAT_NONE;
    }
    for (int k = 0; k < 3; k++)
        plane.normal[k] = form->by[k] / length;
    plane.offset = form->at / length;
    int number   = find_half_space(f, &plane, &sign);
    add_slack(f, number, sign > 0 ? f->slack.below : f->slack.above,
              sign > 0 ? f->slack.above : f->slack.below, length);
    return add_node(f, (FlatNode){FLAT_HALF_SPACE, number, sign});
}

static int solid_of(Finding *f, const Form *form);

/* ---- distances to boxes ---- */

static void join_faces(FieldFaces *faces, const FieldFaces *others)
{
    for (size_t i = 0; i < others->count; i++)
        if (!field_has_face(faces, others->operands[i]) && faces->count < MOST_FACES)
            faces->operands[faces->count++] = others->operands[i];
}

/* length(max(q, 0)) + min(greatest of some q, 0) is above 0 where one of the latter is, and else, as distances go, where one
   of the former is.  What is added to it must not be below 0, unless there is one q alone. */
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

/* ---- outlines ---- */

/* The line of a straight arc, below 0 on its left. */
static void find_line(const CrowdArc *arc, const Form *x, const Form *y, Form *line)
{
    double length = hypot(arc->way[0], arc->way[1]);
    *line = constant_form((arc->start[1] * arc->way[0] - arc->start[0] * arc->way[1]) / length);
    *line = sum_of(*line, arc->way[1] / length, x);
    *line = sum_of(*line, -arc->way[0] / length, y);
}

/* Whether a straight arc does not come into a place. */
static bool lies_beyond(const Finding *f, const CrowdArc *arc, const Range place[2])
{
    double from[2], to[2], middle[2], half[2], normal[2];
    for (int k = 0; k < 2; k++) {
        from[k]   = arc->start[k];
        to[k]     = arc->start[k] + 2 * arc->way[k];
        middle[k] = 0.5 * (place[k].low + place[k].high);
        half[k]   = 0.5 * (place[k].high - place[k].low) + ROUNDING * f->size;
        if (min2(from[k], to[k]) > middle[k] + half[k] ||
            max2(from[k], to[k]) < middle[k] - half[k])
            return true;
    }
    normal[0]  = arc->way[1];
    normal[1]  = -arc->way[0];
    double off = normal[0] * (middle[0] - from[0]) + normal[1] * (middle[1] - from[1]);
    return fabs(off) > fabs(normal[0]) * half[0] + fabs(normal[1]) * half[1];
}

/* The same of a curve: the box around its control points does not. */
static bool curve_lies_beyond(const Finding *f, const CrowdArc *arc, const Range place[2])
{
    for (int k = 0; k < 2; k++) {
        double from = arc->start[k], via = from + arc->way[k],
               to     = via + arc->way[k] + arc->bend[k];
        double margin = ROUNDING * f->size;
        if (min2(min2(from, via), to) > place[k].high + margin ||
            max2(max2(from, via), to) < place[k].low - margin)
            return true;
    }
    return false;
}

/* Whether one arc ends where the next begins. */
static bool meet(const CrowdArc *before, const CrowdArc *behind, double tolerance)
{
    return hypot(before->start[0] + 2 * before->way[0] - behind->start[0],
                 before->start[1] + 2 * before->way[1] - behind->start[1]) <= tolerance;
}

/* Where no part of an outline goes through, the side of the middle is that of all.  Ranges are uncertain by more than the
   distance there is. */
static int solid_beside_outline(Finding *f, uint32_t value)
{
    static const double SINGLE = 1e-6; /* of coordinates: what the outline is known to */
    Range               range  = f->field->ranges.ranges[value];
    double              middle = 0.5 * (range.low + range.high);
    f->failed |= !(fabs(middle) > SINGLE * f->size);
    return middle > 0 ? FLAT_NONE : FLAT_ALL;
}

/* In a place that one or two straight parts of an outline go through. */
static int solid_of_outline(Finding *f, uint32_t value)
{
    const LaneCall *call = &f->tape->calls[f->tape->steps[value - LANE_INPUTS].operands[0]];
    uint32_t        members[MOST_LANE_MEMBERS], count;
    const CrowdArc *arcs[2];
    size_t          here = 0;
    Form            lines[2], at[2];
    Range           place[2];
    if (!lane_outline_members(f->tape, &f->field->ranges, value - LANE_INPUTS, members, &count)) {
        f->failed = true;
        return FLAT_NONE;
    }
    const Crowd *table = &f->tape->tape->graph->crowds->tables.items[call->body->table];
    for (int k = 0; k < 2; k++) {
        at[k]    = form_of(f, call->operands[1][k]);
        place[k] = range_of_form(f, &at[k]);
        f->failed |= !at[k].known || at[k].kink_count > 0;
    }
    for (uint32_t i = 0; i < count && !f->failed; i++) {
        const CrowdArc *arc = &table->arcs[members[i]];
        if (arc->bend[0] != 0 || arc->bend[1] != 0)
            f->failed |= !curve_lies_beyond(f, arc, place);
        else if (here == 2)
            f->failed |= !lies_beyond(f, arc, place);
        else if (!lies_beyond(f, arc, place)) {
            find_line(arc, &at[0], &at[1], &lines[here]);
            arcs[here++] = arc;
        }
    }
    if (f->failed || here == 0)
        return solid_beside_outline(f, value);
    int first = half_space(f, &lines[0]);
    if (here == 1)
        return first;
    int  second  = half_space(f, &lines[1]);
    bool swapped = meet(arcs[1], arcs[0], ROUNDING * f->size);
    if (!swapped && !meet(arcs[0], arcs[1], ROUNDING * f->size)) {
        f->failed = true;
        return FLAT_NONE;
    }
    const CrowdArc *a = arcs[swapped], *b = arcs[!swapped];
    double          turn = a->way[0] * b->way[1] - a->way[1] * b->way[0];
    return turn >= 0 ? both(f, first, second) : either(f, first, second);
}

/* Whether a form is a kink and what is added to it. */
static bool is_single_kink(const Form *form)
{
    return form->kink_count == 1 && form->by[0] == 0 && form->by[1] == 0 && form->by[2] == 0;
}

static int solid_of_faces(Finding *f, const FieldFaces *faces, double factor, double added)
{
    int solid = factor > 0 ? FLAT_ALL : FLAT_NONE;
    for (size_t i = 0; i < faces->count; i++) {
        Form own  = form_of(f, faces->operands[i]);
        Form form = sum_of(constant_form(added), factor, &own);
        int  face = solid_of(f, &form);
        solid     = factor > 0 ? both(f, solid, face) : either(f, solid, face);
    }
    return solid;
}

static int complement(Finding *f, int solid)
{
    if (solid == FLAT_ALL || solid == FLAT_NONE)
        return solid == FLAT_ALL ? FLAT_NONE : FLAT_ALL;
    FlatNode node = f->pieces->nodes[solid];
    if (node.kind == FLAT_HALF_SPACE)
        return add_node(f, (FlatNode){FLAT_HALF_SPACE, node.first, -node.second});
    int first = complement(f, node.first), second = complement(f, node.second);
    return node.kind == FLAT_BOTH ? either(f, first, second) : both(f, first, second);
}

/* ---- conditions ---- */

static const LaneStep *step_of(const Finding *f, uint32_t operand)
{
    return (operand & LANE_SCALAR) || operand < LANE_INPUTS
               ? NULL
               : &f->tape->steps[operand - LANE_INPUTS];
}

/* Where the first number is below the second one. */
static int solid_of_less(Finding *f, uint32_t first, uint32_t second)
{
    Form a = form_of(f, first), b = form_of(f, second), difference = sum_of(a, -1, &b);
    return solid_of(f, &difference);
}

/* Where a condition is true. */
static int solid_of_condition(Finding *f, uint32_t operand)
{
    const LaneStep *step  = step_of(f, operand);
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
        solid = complement(f, solid_of_condition(f, step->operands[0]));
    else if (step->op == OP_and || step->op == OP_or) {
        int first  = solid_of_condition(f, step->operands[0]);
        int second = solid_of_condition(f, step->operands[1]);
        solid      = step->op == OP_and ? both(f, first, second) : either(f, first, second);
    } else
        f->failed = true;
    return *known = solid;
}

static bool is_number(const Finding *f, uint32_t operand, double sign)
{
    return (operand & LANE_SCALAR) && sign * f->tape->scalars[operand & ~LANE_SCALAR] > 0;
}

/* Where one of two solids is, but not the other. */
static int one_only(Finding *f, int a, int b)
{
    if (a < 0 || b < 0)
        return a == FLAT_NONE || b == FLAT_NONE ? (a == FLAT_NONE ? b : a)
                                                : complement(f, a == FLAT_ALL ? b : a);
    int first = both(f, a, complement(f, b));
    return either(f, first, both(f, complement(f, a), b));
}

/* Where a product is below 0 whose factors have known signs, or choose between two numbers: sizes times signs. */
static bool find_sign(Finding *f, uint32_t operand, int *solid)
{
    const LaneStep *step  = step_of(f, operand);
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
    for (int way = -1; step && step->op == OP_select && way <= 1; way += 2)
        if (is_number(f, step->operands[1], way) && is_number(f, step->operands[2], -way)) {
            *solid = solid_of_condition(f, step->operands[0]);
            if (way > 0)
                *solid = complement(f, *solid);
            return true;
        }
    return false;
}

static int solid_of_pair(Finding *f, const Form *rest, double factor, const Form pair[2],
                         bool greater)
{
    Form a = sum_of(*rest, factor, &pair[0]), b = sum_of(*rest, factor, &pair[1]);
    int  first = solid_of(f, &a), second = solid_of(f, &b);
    return greater == (factor > 0) ? both(f, first, second) : either(f, first, second);
}

/* One of two forms, by a condition. */
static int solid_of_choice(Finding *f, const Form *rest, double factor, const LaneStep *step)
{
    Form first = form_of(f, step->operands[1]), second = form_of(f, step->operands[2]);
    Form a = sum_of(*rest, factor, &first), b = sum_of(*rest, factor, &second);
    int  condition = solid_of_condition(f, step->operands[0]);
    int  where     = both(f, condition, solid_of(f, &a));
    return either(f, where, both(f, complement(f, condition), solid_of(f, &b)));
}

/* The greater of the least, and of the lesser of a number and the most. */
static int solid_of_clamped(Finding *f, const Form *rest, double factor, const LaneStep *step)
{
    int solids[3];
    for (int k = 0; k < 3; k++) {
        Form own  = form_of(f, step->operands[k]);
        Form form = sum_of(*rest, factor, &own);
        solids[k] = solid_of(f, &form);
    }
    return factor > 0 ? both(f, either(f, solids[0], solids[2]), solids[1])
                      : either(f, both(f, solids[0], solids[2]), solids[1]);
}

/* A distance to a box that is not the sum of its faces' kinks. */
static int solid_of_sum(Finding *f, const Form *rest, double factor, const LaneStep *step)
{
    Form first = form_of(f, step->operands[0]), second = form_of(f, step->operands[1]);
    Form both_of = sum_of(*rest, factor, &first);
    both_of      = sum_of(both_of, factor, &second);
    return solid_of(f, &both_of);
}

/* ---- what is round ---- */

/* The polygon that stands for a circle, and those of its sides that are the farthest ones in directions of a rectangle. */
typedef struct Sides {
    double   angle, stretch; /* that of a side, and the radius over the distance to it */
    uint32_t count, used;
    int64_t  first;
} Sides;

static void find_sides(Range a, Range b, uint32_t count, Sides *sides)
{
    static const double SLACK  = 1e-9;
    const double        around = 2 * acos(-1);
    sides->count               = count;
    sides->angle               = around / count;
    sides->stretch             = 1 / cos(0.5 * sides->angle);
    sides->first               = 0;
    sides->used                = count;
    if (a.low <= 0 && a.high >= 0 && b.low <= 0 && b.high >= 0)
        return;
    double middle = atan2(b.low + b.high, a.low + a.high), low = 0, high = 0;
    for (int i = 0; i < 4; i++) {
        double turn = atan2(i / 2 ? b.high : b.low, i % 2 ? a.high : a.low) - middle;
        turn -= around * round(turn / around);
        low  = min2(low, turn);
        high = max2(high, turn);
    }
    sides->first = (int64_t)floor((middle + low) / sides->angle - SLACK);
    double last  = floor((middle + high) / sides->angle + SLACK);
    sides->used  = (uint32_t)min2(last - (double)sides->first + 1, count);
}

/* What a side tells of two numbers: that of the first, or of the second. */
static double side_factor(const Sides *sides, uint32_t i, bool second)
{
    double angle = ((double)sides->first + i + 0.5) * sides->angle;
    return sides->stretch * (second ? sin(angle) : cos(angle));
}

/* Where the first number is a length, only sides to the right count. */
static void leave_out_behind(Sides *sides)
{
    while (sides->used > 0 && side_factor(sides, 0, false) < 0) {
        sides->first++;
        sides->used--;
    }
    while (sides->used > 0 && side_factor(sides, sides->used - 1, false) < 0)
        sides->used--;
}

/* Whether a form has a length of several numbers in it. */
static bool has_round(const Finding *f, const Form *form, int depth)
{
    enum { DEEPEST = 6 };
    for (int i = 0; i < form->kink_count; i++) {
        const LaneStep *step = step_of(f, form->kinks[i]);
        if (!step || depth == DEEPEST || step->op == OP_length)
            return true;
        for (uint32_t k = 0; k < step->operand_count && step->op != LANE_CALL; k++) {
            Form operand = form_of(f, step->operands[k]);
            if (has_round(f, &operand, depth + 1))
                return true;
        }
    }
    return false;
}

/* How fast a form changes, about. */
static double steepness(const Finding *f, const Form *form, int depth)
{
    enum { DEEPEST = 6 };
    double slope = length3(form->by);
    for (int i = 0; i < form->kink_count && depth < DEEPEST; i++) {
        const LaneStep *step = step_of(f, form->kinks[i]);
        for (uint32_t k = 0; step && step->op != LANE_CALL && k < step->operand_count; k++) {
            Form operand = form_of(f, step->operands[k]);
            slope        = max2(slope, fabs(form->factors[i]) * steepness(f, &operand, depth + 1));
        }
    }
    return slope;
}

typedef struct Rounded {
    Form     forms[3];
    uint32_t count;
} Rounded;

/* Its numbers that are not 0, the one up as the last, so that balls have their poles there. */
static Rounded rounded_of(const Finding *f, const LaneStep *step)
{
    static const uint32_t ORDER[3] = {0, 2, 1};
    Rounded               rounded  = {.count = 0};
    for (uint32_t i = 0; i < 3; i++) {
        if (ORDER[i] >= step->operand_count)
            continue;
        Form form = form_of(f, step->operands[ORDER[i]]);
        if (!is_constant(&form) || form.at != 0)
            rounded.forms[rounded.count++] = form;
    }
    return rounded;
}

/* How large the circle is where the form is 0, in lengths of the scene; what the rest is says that. */
static void note_round(Finding *f, const Form *rest, double factor, const LaneStep *step,
                       const Rounded *rounded, double slope)
{
    Form   of_length = scaled(-1 / factor, rest);
    Range  needed    = range_of_form(f, &of_length);
    Range  known     = f->field->ranges.ranges[LANE_INPUTS + (size_t)(step - f->tape->steps)];
    double radius    = min2(needed.high, known.high);
    bool   shared    = rounded->count > 2 || has_round(f, rest, 0);
    for (uint32_t i = 0; i < rounded->count; i++)
        shared |= has_round(f, &rounded->forms[i], 0);
    if (radius > 0 && slope > 0)
        flat_rounds_note(f->rounds, step->kin, radius / slope, shared);
}

/* What one side, or one side of a band, tells; `across` and `up` are the factors of the band. */
static int solid_of_side(Finding *f, const Form *rest, double factor, const Rounded *rounded,
                         const double band[2], const Sides *sides, uint32_t i)
{
    double across = factor * band[0];
    Form   form   = sum_of(*rest, across * side_factor(sides, i, false), &rounded->forms[0]);
    form          = sum_of(form, across * side_factor(sides, i, true), &rounded->forms[1]);
    if (rounded->count > 2)
        form = sum_of(form, factor * band[1], &rounded->forms[2]);
    return solid_of(f, &form);
}

/* The length of a pair is the largest distance that the sides of its polygon tell; of `part` of that. */
static int solid_of_pair_length(Finding *f, const Form *rest, double factor, const Rounded *rounded,
                                const double band[2], uint32_t count)
{
    Sides sides;
    find_sides(range_of_form(f, &rounded->forms[0]), range_of_form(f, &rounded->forms[1]), count,
               &sides);
    bool around = sides.used == count;
    if (sides.used > (around ? f->most_around : f->most_used)) {
        f->failed = true;
        return FLAT_NONE;
    }
    int solid = factor > 0 ? FLAT_ALL : FLAT_NONE;
    for (uint32_t i = 0; i < sides.used; i++) {
        int side = solid_of_side(f, rest, factor, rounded, band, &sides, i);
        solid    = factor > 0 ? both(f, solid, side) : either(f, solid, side);
    }
    return solid;
}

/* Half as many, or a quarter, where that is enough for a band whose radius is this part of the largest: where numbers of
   neighbours differ edges have more corners. */
static uint32_t sides_of_band(uint32_t count, double part)
{
    uint32_t sides = count;
    for (uint32_t fewer = count; fewer >= 4 && fewer >= count * part;
         fewer          = 4 * ((fewer + 7) / 8)) {
        sides = fewer;
        if (fewer == 4)
            break;
    }
    return sides;
}

/* A band of a ball: its factors, its number of sides, and how much longer lengths are by it. */
typedef struct Band {
    double   factors[2], longer;
    uint32_t sides;
} Band;

/* That of three numbers is the length of a pair of which one is the length of a pair.  So balls have bands; those near
   poles are shorter, and have fewer sides.  Where numbers of sides differ bands reach a bit farther. */
static Sides find_bands(const Finding *f, const Rounded *rounded, uint32_t count)
{
    Range pair = range_sqrt(range_add(range_square(range_of_form(f, &rounded->forms[0])),
                                      range_square(range_of_form(f, &rounded->forms[1]))));
    Sides bands;
    find_sides(pair, range_of_form(f, &rounded->forms[2]), count, &bands);
    bands.first--;
    bands.used = (uint32_t)min2(bands.used + 2, count);
    leave_out_behind(&bands);
    return bands;
}

static Band find_band(const Sides *bands, uint32_t i)
{
    Band   band    = {.factors = {side_factor(bands, i, false), side_factor(bands, i, true)}};
    double part    = band.factors[0] / bands->stretch;
    band.sides     = sides_of_band(bands->count, part);
    double farther = 1 / cos(acos(-1) / band.sides) - 1;
    band.longer    = bands->stretch * (1 + farther * part * min2(part + 0.5 * bands->angle, 1)) - 1;
    return band;
}

/* What is too large, or too small, by a number at most. */
static FlatSlack slack_with(FlatSlack slack, double excess)
{
    return (FlatSlack){slack.below + max2(excess, 0), slack.above - min2(excess, 0)};
}

static int solid_of_three(Finding *f, const Form *rest, double factor, const Rounded *rounded,
                          uint32_t count, double reach)
{
    FlatSlack slack = f->slack;
    Sides     bands = find_bands(f, rounded, count);
    int       solid = factor > 0 ? FLAT_ALL : FLAT_NONE;
    f->failed |= bands.used > f->most_used;
    for (uint32_t i = 0; i < bands.used && !f->failed; i++) {
        Band band = find_band(&bands, i);
        f->slack  = slack_with(slack, factor * reach * band.longer);
        int parts = solid_of_pair_length(f, rest, factor, rounded, band.factors, band.sides);
        solid     = factor > 0 ? both(f, solid, parts) : either(f, solid, parts);
    }
    f->slack = slack;
    return solid;
}

/* A length is longer by its part of stretch - 1 at most, and the direction of a side is half its angle off at most. */
static int solid_of_length(Finding *f, const Form *rest, double factor, const LaneStep *step)
{
    static const double NO_BAND[2] = {1, 0};
    Rounded             rounded    = rounded_of(f, step);
    uint32_t            count      = flat_rounds_sides(f->rounds, step->kin);
    FlatSlack           slack      = f->slack;
    double              slope = 0, angle = 2 * acos(-1) / max2(count, 1);
    double reach = f->field->ranges.ranges[LANE_INPUTS + (size_t)(step - f->tape->steps)].high;
    if (rounded.count < 2 || count == 0 || step->kin == 0) {
        f->failed = true;
        return FLAT_NONE;
    }
    for (uint32_t i = 0; i < rounded.count; i++)
        slope = max2(slope, steepness(f, &rounded.forms[i], 0));
    note_round(f, rest, factor, step, &rounded, slope);
    f->pieces->round = true;
    int solid;
    if (rounded.count > 2)
        solid = solid_of_three(f, rest, factor, &rounded, count, reach);
    else {
        double longer = 1 / cos(0.5 * angle);
        f->slack      = slack_with(slack, factor * reach * (longer - 1) * longer);
        solid         = solid_of_pair_length(f, rest, factor, &rounded, NO_BAND, count);
    }
    f->slack = slack;
    return solid;
}

/* Takes the last kink apart: no other depends on it. */
static int solid_of_kink(Finding *f, const Form *form)
{
    uint32_t   value  = form->kinks[0];
    double     factor = form->factors[0];
    Form       rest   = *form, pair[2];
    FieldFaces faces;
    drop_kink(&rest, 0);
    if (value < LANE_INPUTS) {
        f->failed = true;
        return FLAT_NONE;
    }
    const LaneStep *step = &f->tape->steps[value - LANE_INPUTS];
    if (is_greater(step) || is_lesser(step)) {
        pair[0] = form_of(f, step->operands[0]);
        pair[1] = form_of(f, step->operands[1]);
        return solid_of_pair(f, &rest, factor, pair, is_greater(step));
    }
    if (step->op == OP_abs) {
        pair[0] = form_of(f, step->operands[0]);
        pair[1] = scaled(-1, &pair[0]);
        return solid_of_pair(f, &rest, factor, pair, true);
    }
    if (step->op == OP_clamp)
        return solid_of_clamped(f, &rest, factor, step);
    if (step->op == OP_length)
        return solid_of_length(f, &rest, factor, step);
    double part;
    if (is_single_kink(form) && find_box_faces(f, value, rest.at / factor, &faces, &part))
        return solid_of_faces(f, &faces, factor * part, rest.at);
    if (step->op == OP_add)
        return solid_of_sum(f, &rest, factor, step);
    if (step->op == OP_select)
        return solid_of_choice(f, &rest, factor, step);
    int solid;
    if (is_single_kink(form) && rest.at == 0 && step->op == LANE_CALL) {
        solid = solid_of_outline(f, value);
        return factor > 0 ? solid : complement(f, solid);
    }
    if (is_single_kink(form) && rest.at == 0 && step->op == OP_mul && find_sign(f, value, &solid))
        return factor > 0 ? solid : complement(f, solid);
    f->failed = true;
    return FLAT_NONE;
}

/* Where a form is below 0. */
static int solid_of(Finding *f, const Form *form)
{
    Range range = range_of_form(f, form);
    if (f->failed || !form->known || isnan(range.low) || isnan(range.high)) {
        f->failed = true;
        return FLAT_NONE;
    }
    if (range.low >= 0 || range.high < 0)
        return range.low >= 0 ? FLAT_NONE : FLAT_ALL;
    return form->kink_count == 0 ? half_space(f, form) : solid_of_kink(f, form);
}

/* What the field is cut by. */
static int cut(Finding *f, int solid)
{
    for (int i = 0; f->field->cut && i < 6; i++) {
        int  k     = i / 2;
        Form form  = constant_form(i % 2 ? -f->field->high[k] : f->field->low[k]);
        form.by[k] = i % 2 ? 1 : -1;
        solid      = both(f, solid, half_space(f, &form));
    }
    return solid;
}

FlatWork flat_work_new(const MeshField *field, Arena *arena)
{
    size_t most = LANE_INPUTS + lane_most_steps(&field->tape);
    return (FlatWork){arena_new_array(arena, Form, most), arena_new_array(arena, int, most)};
}

bool flat_pieces(MeshField *field, Box box, double size, FlatRounds *rounds, FlatUse use,
                 FlatWork *work, FlatPieces *pieces)
{
    static const uint32_t MOST_USED[] = {8, 24}, MOST_AROUND[] = {100, 100};
    Finding f     = {.field = field, .box = box, .size = size, .rounds = rounds, .pieces = pieces};
    f.most_used   = MOST_USED[use];
    f.most_around = MOST_AROUND[use];
    f.tape        = &field->regions[field->region_count - 1].tape;
    f.forms       = work->forms;
    f.conditions  = work->conditions;
    for (size_t i = 0; i < LANE_INPUTS + f.tape->count; i++)
        f.conditions[i] = UNKNOWN;
    pieces->count = pieces->node_count = 0;
    pieces->round                      = false;
    lane_ranges_run(f.tape, &field->ranges, box);
    find_forms(&f);
    Form root    = form_of(&f, f.tape->outputs[0]);
    pieces->root = cut(&f, solid_of(&f, &root));
    return !f.failed && field->frame->zone_count == 0;
}

int flat_side(const FlatPieces *pieces, int root, const signed char *sides, int *unknown)
{
    if (root == FLAT_ALL || root == FLAT_NONE)
        return root == FLAT_ALL ? -1 : 1;
    const FlatNode *node = &pieces->nodes[root];
    if (node->kind == FLAT_HALF_SPACE) {
        if (sides[node->first] == 0)
            *unknown = node->first;
        return node->second * sides[node->first];
    }
    int decides = node->kind == FLAT_BOTH ? 1 : -1, missing = -1;
    int second = flat_side(pieces, node->second, sides, &missing);
    if (second == decides)
        return second;
    int first = flat_side(pieces, node->first, sides, second == 0 ? unknown : &missing);
    if (first == decides || first == second)
        return first;
    if (missing >= 0)
        *unknown = missing;
    return 0;
}
