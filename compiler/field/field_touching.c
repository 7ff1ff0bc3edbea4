/*
 * field_touching.c: pieces that are opposite to each other.
 *
 * min(max(a, b), c) is max(min(a, c), min(b, c)).  If b + c is nowhere above 0, min(b, c) is not, so b can be left out where one asks
 * for the sign alone.  The same holds of maxima, with all signs reversed.
 *
 * min(max(a, b), max(c, d)) is below 0 where both a and d are, if b + c is nowhere above 0: where solids overlap by less than cells are
 * large, neither b nor c tells that.  So max(a, d) is joined.
 */
#include "compiler/field/field_touching.h"

#include <math.h>
#include <string.h>

#include "compiler/graph/lanes/lane_cuts.h"

/* ---- what pieces are sums of ---- */

enum { MAX_TERMS = 8 };

typedef struct Form {
    uint32_t operands[MAX_TERMS];
    double   weights[MAX_TERMS], offset, size; /* `size`: of all that was added to the offset */
    uint32_t count;
    bool     known;
} Form;

static void add_offset(Form *form, double offset)
{
    form->offset += offset;
    form->size += fabs(offset);
}

static void add_operand(Form *form, uint32_t operand, double weight)
{
    uint32_t k = 0;
    while (k < form->count && form->operands[k] != operand)
        k++;
    form->known = form->known && k < MAX_TERMS;
    if (!form->known)
        return;
    if (k == form->count) {
        form->operands[form->count++] = operand;
        form->weights[k]              = 0;
    }
    form->weights[k] += weight;
}

typedef struct Forms {
    const LaneTape   *tape;
    const LaneRanges *ranges;
} Forms;

static Range range_of_operand(const Forms *forms, uint32_t operand)
{
    return lane_range_at(forms->tape, forms->ranges, operand);
}

/* Returns the one that is the lesser or the greater all over the box; NODE_NONE: either may be, or
   the step is no choice. */
static uint32_t decided_operand(const Forms *forms, const LaneStep *step)
{
    if (!field_is_lesser(step) && !field_is_greater(step))
        return NODE_NONE;
    Range a = range_of_operand(forms, step->operands[0]),
          b = range_of_operand(forms, step->operands[1]);
    if (a.high <= b.low || b.high <= a.low)
        return step->operands[(a.high <= b.low) != field_is_lesser(step)];
    return NODE_NONE;
}

/* Returns the operand that a step is times the factor, all over the box; NODE_NONE: it is none. */
static uint32_t scaled_operand(const Forms *forms, const LaneStep *step, double *factor)
{
    uint32_t whole = lane_sum_of_cuts(forms->tape, forms->ranges, step);
    if (whole == NODE_NONE)
        whole = decided_operand(forms, step);
    *factor = 1;
    if (whole != NODE_NONE)
        return whole;
    if (step->op == OP_neg)
        *factor = -1;
    if (step->op == OP_abs && !(step->operands[0] & LANE_SCALAR)) {
        Range range = forms->ranges->ranges[step->operands[0]];
        *factor     = range.low >= 0 ? 1 : range.high <= 0 ? -1 : 0;
    }
    if (step->op == OP_neg || step->op == OP_abs)
        return *factor != 0 ? step->operands[0] : NODE_NONE;
    for (int k = 0; step->op == OP_mul && k < 2; k++)
        if (step->operands[k] & LANE_SCALAR) {
            *factor = forms->tape->scalars[step->operands[k] & ~LANE_SCALAR];
            return step->operands[1 - k];
        }
    return NODE_NONE;
}

/* Adds an operand times a weight, as a sum of what is no sum itself. */
static void add_form(const Forms *forms, Form *form, uint32_t operand, double weight, int depth)
{
    const LaneStep *step = depth > 0 ? lane_step_of(forms->tape, operand) : NULL;
    double          factor;
    if (operand & LANE_SCALAR) {
        add_offset(form, weight * forms->tape->scalars[operand & ~LANE_SCALAR]);
        return;
    }
    uint32_t scaled = step ? scaled_operand(forms, step, &factor) : NODE_NONE;
    if (scaled != NODE_NONE) {
        add_form(forms, form, scaled, weight * factor, depth - 1);
    } else if (step && (step->op == OP_add || step->op == OP_sub)) {
        double other = step->op == OP_sub ? -weight : weight;
        add_form(forms, form, step->operands[0], weight, depth - 1);
        add_form(forms, form, step->operands[1], other, depth - 1);
    } else
        add_operand(form, operand, weight);
}

static double length_of(const Form *form)
{
    double square = 0;
    for (uint32_t k = 0; k < form->count; k++)
        square += form->weights[k] * form->weights[k];
    return sqrt(square);
}

/* Makes the form of a piece with length 1, since the sign alone counts. */
static Form form_of(const Forms *forms, const FieldPieces *pieces, const uint32_t *operands,
                    size_t piece)
{
    enum { MAX_DEPTH = 8 };
    Form   form = {.known = true};
    double sign = pieces->signs[piece];
    for (uint32_t k = 0; k < pieces->values[piece]; k++)
        add_form(forms, &form, operands[k], sign * pieces->weights[piece][k], MAX_DEPTH);
    add_offset(&form, pieces->offsets[piece]);
    double length = length_of(&form);
    form.known    = form.known && length > 0 && isfinite(length);
    for (uint32_t k = 0; form.known && k < form.count; k++)
        form.weights[k] /= length;
    form.offset /= length;
    form.size /= length;
    return form;
}

/* Tells whether the sum of two is nowhere above 0, or, by the sign, nowhere below; but for what rounding explains. */
static bool are_opposite(const Form *a, const Form *b, double sign)
{
    static const double ROUNDING = 1e-13;
    Form                sum      = *a;
    for (uint32_t k = 0; k < b->count; k++)
        add_operand(&sum, b->operands[k], b->weights[k]);
    for (uint32_t k = 0; k < sum.count; k++)
        if (!(fabs(sum.weights[k]) <= ROUNDING))
            return false;
    return a->known && b->known && sum.known &&
           sign * (a->offset + b->offset) <= ROUNDING * (1 + a->size + b->size);
}

/* ---- the tree of minima and maxima ---- */

typedef struct Tree {
    const FieldPieces *pieces;
    Form               forms[MAX_PIECES];
    int                children[MAX_PIECE_STEPS][2]; /* of steps that choose */
    /* Of pieces that are left out -1, as if below all others, or 1, above them; else 0. */
    int sides[MAX_PIECE_STEPS];
    /* Steps that choose have a piece of each child, which are opposite to each other; -1: they have none. */
    int pairs[MAX_PIECE_STEPS][2];
    int root;
} Tree;

static void find_children(Tree *tree)
{
    int stack[MAX_PIECE_STEPS], depth = 0;
    for (int i = 0; i < (int)tree->pieces->step_count; i++) {
        if (tree->pieces->steps[i] < 0) {
            tree->children[i][1] = stack[--depth];
            tree->children[i][0] = stack[--depth];
        }
        stack[depth++] = i;
    }
    tree->root = stack[0];
}

/* Finds what one choice alone compares: pieces, and other choices. */
static void find_leaves(const Tree *tree, int at, int choice, int *leaves, int *count)
{
    if (tree->pieces->steps[at] != choice) {
        leaves[(*count)++] = at;
        return;
    }
    find_leaves(tree, tree->children[at][0], choice, leaves, count);
    find_leaves(tree, tree->children[at][1], choice, leaves, count);
}

static bool steps_are_opposite(const Tree *tree, int a, int b, double sign)
{
    int first = tree->pieces->steps[a], second = tree->pieces->steps[b];
    return first >= 0 && second >= 0 &&
           are_opposite(&tree->forms[first], &tree->forms[second], sign);
}

static void drop_opposite(Tree *tree, int at)
{
    int    choice = tree->pieces->steps[at], other = choice == PIECE_MIN ? PIECE_MAX : PIECE_MIN;
    double sign = choice == PIECE_MIN ? 1 : -1;
    int    leaves[2][MAX_PIECE_STEPS], counts[2] = {0, 0};
    for (int k = 0; k < 2; k++)
        find_leaves(tree, tree->children[at][k], other, leaves[k], &counts[k]);
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < counts[k]; i++) {
            int  own = leaves[k][i];
            bool all = tree->sides[own] == 0;
            for (int j = 0; all && j < counts[1 - k]; j++)
                all = steps_are_opposite(tree, own, leaves[1 - k][j], sign);
            if (all)
                tree->sides[own] = (int)-sign;
        }
    for (int i = 0; i < counts[0]; i++)
        for (int j = 0; j < counts[1]; j++)
            if (steps_are_opposite(tree, leaves[0][i], leaves[1][j], sign)) {
                tree->pairs[at][0] = leaves[0][i];
                tree->pairs[at][1] = leaves[1][j];
            }
}

/* ---- what is left ---- */

/* A choice that is nowhere on one side of 0 is as if below or above all others, too. */
static int side_of(const Tree *tree, int at)
{
    int strong = tree->pieces->steps[at] == PIECE_MIN ? -1 : 1;
    int first = tree->sides[tree->children[at][0]], second = tree->sides[tree->children[at][1]];
    if (first == strong || second == strong)
        return strong;
    return first != 0 && second != 0 ? -strong : 0;
}

typedef struct Left {
    const Tree *tree;
    FieldPieces pieces;
    uint32_t    operands[MAX_PIECES][PIECE_VALUES];
    int         numbers[MAX_PIECES]; /* of the pieces before; -1: not yet */
    bool        joins;               /* what is beside pairs is joined, */
    bool        full;                /* for which there was no room */
} Left;

static void leave_step(Left *left, int step)
{
    FieldPieces *to = &left->pieces;
    left->full      = left->full || to->step_count == MAX_PIECE_STEPS;
    if (!left->full)
        to->steps[to->step_count++] = step;
}

static void leave_piece(Left *left, int piece, const uint32_t operands[PIECE_VALUES])
{
    const FieldPieces *from = left->tree->pieces;
    FieldPieces       *to   = &left->pieces;
    if (left->numbers[piece] < 0) {
        size_t i             = to->count++;
        left->numbers[piece] = (int)i;
        to->signs[i]         = from->signs[piece];
        to->offsets[i]       = from->offsets[piece];
        to->values[i]        = from->values[piece];
        to->slopes[i]        = from->slopes[piece];
        to->hessians[i]      = from->hessians[piece];
        memcpy(to->weights[i], from->weights[piece], sizeof to->weights[i]);
        memcpy(left->operands[i], operands, sizeof left->operands[i]);
    }
    leave_step(left, left->numbers[piece]);
}

static void leave(Left *left, int at, uint32_t operands[MAX_PIECES][PIECE_VALUES]);

/* Joins what is beside a pair to a choice. */
static void join_beside(Left *left, int at, uint32_t operands[MAX_PIECES][PIECE_VALUES])
{
    const Tree *tree = left->tree;
    const int  *pair = tree->pairs[at];
    int choice = tree->pieces->steps[at], other = choice == PIECE_MIN ? PIECE_MAX : PIECE_MIN;
    int joined = 0;
    if (pair[0] < 0 || tree->sides[pair[0]] != 0 || tree->sides[pair[1]] != 0)
        return;
    for (int k = 0; k < 2; k++) {
        int leaves[MAX_PIECE_STEPS], count = 0;
        find_leaves(tree, tree->children[at][k], other, leaves, &count);
        for (int i = 0; i < count; i++) {
            if (leaves[i] == pair[k] || tree->sides[leaves[i]] != 0)
                continue;
            leave(left, leaves[i], operands);
            if (joined++ > 0)
                leave_step(left, other);
        }
    }
    if (joined > 0)
        leave_step(left, choice);
}

static void leave(Left *left, int at, uint32_t operands[MAX_PIECES][PIECE_VALUES])
{
    int step = left->tree->pieces->steps[at], kept = 0;
    if (step >= 0) {
        leave_piece(left, step, operands[step]);
        return;
    }
    for (int k = 0; k < 2; k++) {
        int child = left->tree->children[at][k];
        if (left->tree->sides[child] == 0) {
            leave(left, child, operands);
            kept++;
        }
    }
    if (kept == 2) {
        leave_step(left, step);
        if (left->joins)
            join_beside(left, at, operands);
    }
}

/* Finds all operands that are left, with those beside pairs as far as there is room. */
static Left find_left(const Tree *tree, uint32_t operands[MAX_PIECES][PIECE_VALUES])
{
    Left left;
    for (int joins = 1; joins >= 0; joins--) {
        left = (Left){.tree = tree, .joins = joins == 1};
        for (size_t i = 0; i < MAX_PIECES; i++)
            left.numbers[i] = -1;
        left.pieces.side = tree->sides[tree->root];
        if (left.pieces.side == 0)
            leave(&left, tree->root, operands);
        if (!left.full)
            break;
    }
    return left;
}

void field_drop_touching(const LaneTape *tape, const LaneRanges *ranges, FieldPieces *pieces,
                         uint32_t operands[MAX_PIECES][PIECE_VALUES])
{
    const Forms forms = {tape, ranges};
    Tree        tree  = {.pieces = pieces};
    bool        any   = false;
    for (size_t i = 0; i < pieces->count; i++)
        tree.forms[i] = form_of(&forms, pieces, operands[i], i);
    for (size_t i = 0; i < pieces->step_count; i++)
        tree.pairs[i][0] = -1;
    find_children(&tree);
    for (int i = 0; i < (int)pieces->step_count; i++) {
        if (pieces->steps[i] < 0)
            drop_opposite(&tree, i);
    }
    for (int i = 0; i < (int)pieces->step_count; i++) {
        if (pieces->steps[i] < 0)
            tree.sides[i] = side_of(&tree, i);
        any = any || tree.sides[i] != 0 || tree.pairs[i][0] >= 0;
    }
    if (!any)
        return;
    Left left = find_left(&tree, operands);
    *pieces   = left.pieces;
    memcpy(operands, left.operands, sizeof left.operands);
}
