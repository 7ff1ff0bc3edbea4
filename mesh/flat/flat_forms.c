/*
 * flat_forms.c: makes forms of the steps of a lane tape.
 */
#include "mesh/flat/flat_forms.h"

#include <string.h>

#include "compiler/base/vec.h"

/* ---- forms ---- */

Form form_constant(double number) { return (Form){.known = isfinite(number), .at = number}; }

Form form_of_operand(const Finding *f, uint32_t operand)
{
    return operand & LANE_SCALAR ? form_constant(f->tape->scalars[operand & ~LANE_SCALAR])
                                 : f->forms[operand];
}

static bool is_level(const Form *form)
{
    return form->by[0] == 0 && form->by[1] == 0 && form->by[2] == 0;
}

bool form_is_constant(const Form *form)
{
    return form->known && !form->divided && form->kink_count == 0 && is_level(form);
}

void form_drop_kink(Form *form, int i)
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
            form_drop_kink(form, i);
        return;
    }
    if (form->kink_count == MAX_KINKS) {
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

/* Returns the same number, whose linear part is a constant, over a divisor. */
static Form level_over(const Divisor *divisor, Form form)
{
    for (int k = 0; k < 3; k++)
        form.by[k] = form.at * divisor->by[k];
    form.at *= divisor->at;
    form.divided = true;
    form.divisor = *divisor;
    return form;
}

static bool same_divisor(const Form *a, const Form *b)
{
    return a->divided == b->divided && a->divisor.at == b->divisor.at &&
           memcmp(a->divisor.by, b->divisor.by, sizeof a->divisor.by) == 0;
}

/* Divides a plain form by another's divisor, if it has no slope but what the rounding of a rotation
   leaves. */
static void divide_plain(Form *plain, const Form *divided, double factor)
{
    static const double NEGLIGIBLE = 1e-14;
    if (length3(plain->by) <= NEGLIGIBLE * factor * length3(divided->by))
        *plain = level_over(&divided->divisor, *plain);
}

Form form_sum(Form a, double factor, const Form *b)
{
    Form other = *b;
    if (b->divided && !a.divided)
        divide_plain(&a, b, fabs(factor));
    if (a.divided && !b->divided)
        divide_plain(&other, &a, factor != 0 ? 1 / fabs(factor) : INFINITY);
    b       = &other;
    a.known = a.known && b->known && isfinite(factor) && same_divisor(&a, b);
    for (int k = 0; k < 3; k++)
        a.by[k] += factor * b->by[k];
    a.at += factor * b->at;
    for (int i = 0; i < b->kink_count && a.known && factor != 0; i++)
        add_kink(&a, b->kinks[i], factor * b->factors[i]);
    return a;
}

Form form_scaled(double factor, const Form *form)
{
    return form_sum(form_constant(0), factor, form);
}

static Range linear_range(const Finding *f, const double by[3], double at)
{
    Range range = range_of(at);
    for (int k = 0; k < 3; k++) {
        double a = by[k] * f->box.axis[k].low, b = by[k] * f->box.axis[k].high;
        range.low += min2(a, b);
        range.high += max2(a, b);
    }
    return range;
}

Range form_divisor(const Finding *f, const Form *form)
{
    return form->divided ? linear_range(f, form->divisor.by, form->divisor.at) : range_of(1);
}

static Range range_of_linear(const Finding *f, const Form *form)
{
    Range linear = linear_range(f, form->by, form->at), divisor = form_divisor(f, form);
    return (Range){linear.low / (linear.low < 0 ? divisor.low : divisor.high),
                   linear.high / (linear.high > 0 ? divisor.low : divisor.high)};
}

double form_slope(const Finding *f, const Form *form)
{
    double slope = length3(form->by);
    if (!form->divided)
        return slope;
    double size = range_largest(range_of_linear(f, form));
    return (slope + size * length3(form->divisor.by)) / form_divisor(f, form).low;
}

Range form_range(const Finding *f, const Form *form)
{
    Range  linear = range_of_linear(f, form);
    double low = linear.low, high = linear.high;
    for (int i = 0; i < form->kink_count; i++) {
        Range  kink = f->field->ranges.ranges[form->kinks[i]];
        double a = form->factors[i] * kink.low, b = form->factors[i] * kink.high;
        low += min2(a, b);
        high += max2(a, b);
    }
    return (Range){low, high};
}

/* ---- steps ---- */

static Range range_of_operand(const Finding *f, uint32_t operand)
{
    return lane_range_at(f->tape, &f->field->ranges, operand);
}

static Form kink_form(uint32_t operand)
{
    Form form = form_constant(0);
    add_kink(&form, operand, 1);
    return form;
}

static bool is_kink(const Form *form, uint32_t value)
{
    return form->kink_count == 1 && form->kinks[0] == value;
}

/* Returns the one of two forms that is the lesser, or the greater, all over the box; else a
   kink. */
static Form chosen(const Finding *f, const Form *a, const Form *b, bool greater, uint32_t value)
{
    if (!a->known || !b->known)
        return (Form){.known = false};
    Form  difference = form_sum(*a, -1, b);
    Range range      = form_range(f, &difference);
    if (difference.known && (greater ? range.low >= 0 : range.high <= 0))
        return *a;
    if (difference.known && (greater ? range.high <= 0 : range.low >= 0))
        return *b;
    return kink_form(value);
}

static Form size_form(const Finding *f, const Form *a, uint32_t value)
{
    Form negative = form_scaled(-1, a);
    return chosen(f, a, &negative, true, value);
}

/* Returns the form of a clamped number, if it is one of the operands all over the box; else a
   kink. */
static Form clamped_form(const Finding *f, const LaneStep *step, uint32_t value)
{
    Form number = form_of_operand(f, step->operands[0]);
    for (uint32_t k = 1; k < 3 && number.known; k++) {
        Form limit = form_of_operand(f, step->operands[k]);
        number     = chosen(f, &number, &limit, k == 1, value);
        if (is_kink(&number, value))
            return number;
    }
    return number;
}

/* Returns a form over a linear number that is above 0 in the box. */
static Form quotient_of(const Finding *f, const Form *a, const Form *b)
{
    if (!a->known || !b->known || a->divided || b->divided || a->kink_count + b->kink_count > 0 ||
        !(form_range(f, b).low > 0))
        return (Form){.known = false};
    Form form    = *a;
    form.divided = true;
    memcpy(form.divisor.by, b->by, sizeof form.divisor.by);
    form.divisor.at = b->at;
    return form;
}

/* Tells whether a form is a constant over a divisor. */
static bool is_reciprocal(const Form *form)
{
    return form->divided && form->kink_count == 0 && is_level(form);
}

static Form product_of(const Form *a, const Form *b)
{
    if (form_is_constant(a))
        return form_scaled(a->at, b);
    if (form_is_constant(b))
        return form_scaled(b->at, a);
    if (is_reciprocal(a) == is_reciprocal(b) || (a->divided && b->divided) ||
        a->kink_count + b->kink_count > 0)
        return (Form){.known = false};
    const Form *number = is_reciprocal(a) ? b : a, *over = is_reciprocal(a) ? a : b;
    Form        product = form_scaled(over->at, number);
    product.divided     = true;
    product.divisor     = over->divisor;
    return product;
}

/* Returns one of two numbers by a condition that is true all over the box, or nowhere in it. */
static Form select_form(const Finding *f, const LaneStep *step)
{
    Range condition = range_of_operand(f, step->operands[0]);
    if (condition.low > 0 || condition.high <= 0)
        return form_of_operand(f, step->operands[condition.low > 0 ? 1 : 2]);
    return (Form){.known = false};
}

/* Returns the length of a vector; that of one number is its absolute value. */
static Form length_form(const Finding *f, const LaneStep *step, uint32_t value)
{
    int one = -1;
    for (uint32_t k = 0; k < step->operand_count; k++) {
        Form form = form_of_operand(f, step->operands[k]);
        if (form_is_constant(&form) && form.at == 0)
            continue;
        if (one >= 0)
            return kink_form(value);
        one = (int)k;
    }
    Form form = one < 0 ? form_constant(0) : form_of_operand(f, step->operands[one]);
    return size_form(f, &form, value);
}

/* Tells whether a step is the sum that is a distance to a box. */
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

/* Returns the form of a step; a step that is not linear is a kink. */
static Form form_of_step(const Finding *f, size_t i)
{
    const LaneStep *step  = &f->tape->steps[i];
    uint32_t        value = (uint32_t)(LANE_INPUTS + i);
    Form            a = {.known = false}, b = {.known = false};
    Range           range = f->field->ranges.ranges[value];
    if (range_is_single(range) && f->field->ranges.sure[value])
        return form_constant(range.low);
    if (step->op == LANE_CALL || step->op == LANE_PART)
        return kink_form(value);
    if (step->operand_count > 0)
        a = form_of_operand(f, step->operands[0]);
    if (step->operand_count > 1)
        b = form_of_operand(f, step->operands[1]);
    Form form = {.known = false};
    if (step->op == OP_neg)
        form = form_scaled(-1, &a);
    else if (step->op == OP_precise)
        form = a;
    else if (step->op == OP_add && !is_box_distance(f, step))
        form = form_sum(a, 1, &b);
    else if (step->op == OP_sub)
        form = form_sum(a, -1, &b);
    else if (step->op == OP_mul)
        form = product_of(&a, &b);
    else if (step->op == OP_div)
        form = form_is_constant(&b) && b.at != 0 ? form_scaled(1 / b.at, &a)
                                                 : quotient_of(f, &a, &b);
    else if (step->op == OP_abs)
        form = size_form(f, &a, value);
    else if (is_greater(step) || is_lesser(step))
        form = chosen(f, &a, &b, is_greater(step), value);
    else if (step->op == OP_clamp)
        form = clamped_form(f, step, value);
    else if (step->op == OP_select)
        form = select_form(f, step);
    else if (step->op == OP_length)
        form = length_form(f, step, value);
    return form.known ? form : kink_form(value);
}

void find_forms(Finding *f)
{
    for (uint32_t i = 0; i < LANE_INPUTS; i++)
        f->forms[i] = (Form){.known = i < 3};
    for (int k = 0; k < 3; k++)
        f->forms[LANE_POINT + k].by[k] = 1;
    for (size_t i = 0; i < f->tape->count; i++)
        f->forms[LANE_INPUTS + i] = form_of_step(f, i);
}

bool form_is_kink_alone(const Form *form) { return form->kink_count == 1 && is_level(form); }
