/*
 * empty.c: components of which nothing can be seen, as nothing is left of them.
 *
 * A box tells it, or the distance: where it is more than half the diagonal of a cell at the middle
 * of the cell, nothing is in there.  Cells are halved until each is empty, or one has something in
 * its middle.  What stays open is taken to be there.
 */
#include <math.h>

#include "compiler/eval/elaborate.h"
#include "compiler/graph/evaluate.h"
#include "compiler/lower/context.h"
#include "compiler/shape/slope.h"

/* A component may have so many operations on numbers, and so many cells that are open at once. */
enum { MAX_OPERATIONS = 500000, MAX_CELLS = 64 };

/* Returns the shape inside of placings and paint, which make nothing empty. */
static const Shape *inside_wrappers(const Shape *shape)
{
    while (shape_info[shape->kind].leaves == LEAVES_ALL)
        shape = shape->children[0];
    return shape;
}

static bool can_vanish(const Shape *shape)
{
    Leaves leaves = shape_info[shape->kind].leaves;
    return leaves == LEAVES_SOME || leaves == LEAVES_MIRRORED;
}

bool may_vanish(const Shape *shape) { return can_vanish(inside_wrappers(shape)); }

static double value_at(const Tape *tape, Node distance, const double point[3], NodeValue *values)
{
    tape_run_point(tape, point, values);
    return values[distance].v[0];
}

static bool cells_are_empty(const Tape *tape, Node distance, Box box, NodeValue *values)
{
    Box    cells[MAX_CELLS] = {box};
    size_t count            = 1;
    for (size_t i = 0; count > 0 && i * tape->count < MAX_OPERATIONS; i++) {
        Box    cell = cells[--count];
        double middle[3];
        box_centre(cell, middle);
        double at = value_at(tape, distance, middle, values);
        if (at > 0.5 * box_diagonal(cell))
            continue;
        if (!(at > 0) || count + 2 > MAX_CELLS)
            return false;
        box_halve(cell, &cells[count]);
        count += 2;
    }
    return count == 0;
}

/* Tells whether a sharp union of distances has this one. */
static bool min_has(const Graph *g, Node least, Node distance)
{
    const Expr *e = &g->items[least];
    return least == distance || (e->op == OP_min && (min_has(g, e->operands[0], distance) ||
                                                     min_has(g, e->operands[1], distance)));
}

/* Tells whether a shape is taken from itself: that leaves its surface, by which rays would be caught. */
static bool is_cancelled(const Graph *g, Node distance)
{
    const Expr *e     = &g->items[distance];
    const Expr *least = e->op == OP_neg ? &g->items[e->operands[0]] : e;
    if (e->op != OP_neg || least->op != OP_min)
        return false;
    for (int k = 0; k < 2; k++) {
        const Expr *from = &g->items[least->operands[k]];
        if (from->op == OP_neg && min_has(g, least->operands[1 - k], from->operands[0]))
            return true;
    }
    return false;
}

/* Tells whether the distance proves a shape to be empty; only what no parameter changes is looked
   at. */
static bool is_nowhere(Elaboration *e, const Shape *shape)
{
    Graph   *g     = e->graph;
    Lowering l     = {.graph = g, .scratch = e->scratch, .most = g->count + MAX_LOWERED};
    Lowered  all   = lower_shape(&l, shape, context_new(graph_leaf(g, OP_POINT), true));
    bool     empty = all.distance == NODE_NONE || is_cancelled(g, all.distance);
    if (!l.overflow && !empty) {
        Node       distance   = divide_by_slope(g, all.distance, shape->slope);
        Graph     *alone      = graph_extract_with_instances(g, &distance, 1, e->scratch);
        Tape       tape       = tape_new(alone, &distance, 1, e->scratch);
        NodeValue *values     = arena_new_array(e->scratch, NodeValue, alone->count);
        NodeValue *parameters = arena_new_array(e->scratch, NodeValue, g->parameters.count);
        tape_run_frame(&tape, parameters, values);
        empty = !tape_needs_frame(&tape) && cells_are_empty(&tape, distance, shape->box, values);
    }
    arena_free(e->scratch);
    return empty;
}

/* Returns the innermost shape of which nothing is left, although something of its parts is. */
static const Shape *where_it_vanishes(const Shape *shape)
{
    for (uint32_t i = 0; i < shape->child_count; i++)
        if (box_is_empty(shape->children[i]->box))
            return where_it_vanishes(shape->children[i]);
    return shape;
}

/* Tells whether an offset takes all of a shape off.  Rounding is an offset of a smaller part, whose
   box tells it; the box of what shrinks is that of its part. */
static bool is_taken_off(Elaboration *e, const Shape *shape)
{
    if (shape->kind != SHAPE_OFFSET || shape->estimate)
        return false;
    return box_is_empty(shape->box) || (node_range(e->builder, shape->values[0], 0).high < 0 &&
                                        box_is_finite(shape->box) && is_nowhere(e, shape));
}

/* Warns of parts of a sharp union that an offset leaves nothing of. */
static void warn_of_offsets(Elaboration *e, const Shape *shape)
{
    if (is_taken_off(e, shape)) {
        Diag *diag  = diag_add(e->diags, DIAG_NO_EFFECT, shape->span, "nothing is left of this");
        diag->label = "rounding or an offset takes off more than half of its smallest size";
    } else if (shape->kind == SHAPE_UNION || shape_info[shape->kind].leaves == LEAVES_ALL)
        for (uint32_t i = 0; i < shape->child_count; i++)
            warn_of_offsets(e, shape->children[i]);
}

void warn_if_nothing_is_left(Elaboration *e, const Shape *shape, const char *name, Span span)
{
    warn_of_offsets(e, shape);
    const Shape *inner = inside_wrappers(shape);
    bool         gone  = box_is_empty(shape->box);
    if (gone)
        inner = where_it_vanishes(shape);
    else if (!can_vanish(inner) || inner->estimate || !box_is_finite(inner->box) ||
             !is_nowhere(e, inner))
        return;
    const bool letters = inner->kind == SHAPE_EMPTY && inner->figure; /* a text without any */
    if (shape_info[inner->kind].parts == 0 && !letters)
        return; /* what has no parts is warned of where it is made */
    Diag *diag  = diag_add(e->diags, DIAG_NO_EFFECT, span, "`%s` is empty", name);
    diag->label = "nothing of this can be seen";
    if (shape_info[inner->kind].leaves == LEAVES_MIRRORED)
        diag_secondary(e->diags, diag, inner->span, "the mirrors discard all of its kernels");
    else if (letters)
        diag_secondary(e->diags, diag, inner->span,
                       diag_text(e->diags, "this `%s` is empty", inner->name));
    else
        diag_secondary(e->diags, diag, inner->span,
                       diag_text(e->diags, "nothing is left by this `%s`", inner->name));
}
