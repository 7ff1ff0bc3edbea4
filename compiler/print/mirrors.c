/*
 * mirrors.c: mirrors (OP_fold) as statements.
 *
 * A mirror waits for the one before it, and processors with few threads wait with it: in a row of
 * mirrors that is all that a distance costs.  With p(k+1) = p(k) - 2 m(k) n(k) and how far the
 * point is beyond the mirror, m(k) = max(p(k) n(k) - w(k), 0), where n(j) n(k) is a number,
 *
 *     m(k) = max(p(k-2) n(k) - w(k) - 2 m(k-2) n(k-2) n(k) - 2 m(k-1) n(k-1) n(k), 0)
 *
 * of which only the last term waits for the mirror before: three operations deep instead of six.
 * It takes four more, which devices with many threads have no use for (KRS_BACK: one or the other).
 */
#include <math.h>
#include <stdlib.h>

#include "compiler/print/emitter.h"

/* 1 + the axis that a constant mirror is across, negative where its normal points down; 0: none. */
static int fold_axis(const Emitter *e, const Expr *fold)
{
    const Expr *normal = &e->graph->items[fold->operands[1]];
    if (normal->op != OP_CONSTANT)
        return 0;
    for (int i = 0; i < 3; i++)
        if (fabs(normal->number[i]) == 1)
            return (int)normal->number[i] * (i + 1);
    return 0;
}

/* Across an axis one coordinate becomes the lesser, or the greater, of itself and its image: two
   operations that what follows has to wait for, or one. */
static const char *across_axis(Emitter *e, const Expr *fold, int axis)
{
    Text        text  = {.arena = e->scratch};
    const char *point = e->text[fold->operands[0]], *offset = e->text[fold->operands[2]];
    const Expr *place  = &e->graph->items[fold->operands[2]];
    bool        middle = place->op == OP_CONSTANT && place->number[0] == 0;
    text_format(&text, "%s(", e->printer->types[TYPE_VEC3]);
    for (int i = 0; i < 3; i++) {
        char name = "xyz"[i];
        if (i > 0)
            text_add(&text, ", ");
        if (i + 1 != abs(axis)) {
            text_format(&text, "%s.%c", point, name);
            continue;
        }
        const char *sign = axis > 0 ? "" : "-";
        if (middle)
            text_format(&text, "%sabs(%s.%c)", axis > 0 ? "-" : "", point, name);
        else
            text_format(&text, "%s(%s.%c, %s2.0 * %s - %s.%c)", axis > 0 ? "KRS_MIN" : "KRS_MAX",
                        point, name, sign, offset, point, name);
    }
    text_add(&text, ")");
    return text.bytes;
}

/* ---- Rows ---- */

static bool is_tilted(const Emitter *e, const Expr *expr)
{
    return expr->op == OP_fold && e->graph->items[expr->operands[1]].op == OP_CONSTANT &&
           fold_axis(e, expr) == 0;
}

/* A use of the node by a mirror counts twice: so this is the only one. */
static bool only_feeds_mirror(const Emitter *e, Node n)
{
    return is_tilted(e, &e->graph->items[n]) && e->feeds_mirror[n] && e->uses[n] == 2 &&
           !e->given[n];
}

/* The mirror before this one in a row, or NODE_NONE. */
static Node mirror_before(const Emitter *e, Node n)
{
    Node before = e->graph->items[n].operands[0];
    return only_feeds_mirror(e, before) ? before : NODE_NONE;
}

/* Less what a mirror before has moved the point by, along the normal. */
static void subtract_move(Emitter *e, Text *text, const Expr *fold, Node mirror)
{
    const Expr   *items = e->graph->items;
    const double *n     = items[fold->operands[1]].number;
    const double *b     = items[items[mirror].operands[1]].number;
    text_format(text, " - KRS_BACK(%s * %s, 0.0)", e->excess[mirror],
                emit_number(e, 2 * (n[0] * b[0] + n[1] * b[1] + n[2] * b[2])));
}

/* How far beyond the mirror the point is, from where it was before the mirrors `first` and
   `before`; the term that waits for the last comes last. */
static const char *distance_beyond(Emitter *e, const Expr *fold, Node first, Node before)
{
    Text        text  = {.arena = e->scratch};
    const char *point = e->text[fold->operands[0]];
    emit_call(e, "krs_mirror_excess", TYPE_VEC3, 3);
    text_add(&text, "krs_mirror_excess(");
    if (before == NODE_NONE) {
        text_add(&text, point);
    } else {
        Node from = first != NODE_NONE ? first : before;
        text_format(&text, "KRS_BACK(%s, %s)", e->text[e->graph->items[from].operands[0]], point);
    }
    text_format(&text, ", %s, %s)", e->text[fold->operands[1]], e->text[fold->operands[2]]);
    if (first != NODE_NONE)
        subtract_move(e, &text, fold, first);
    if (before != NODE_NONE)
        subtract_move(e, &text, fold, before);
    return text.bytes;
}

static const char *in_row(Emitter *e, const Expr *fold, Node n, Node before)
{
    Node        first  = before == NODE_NONE ? NODE_NONE : mirror_before(e, before);
    const char *excess = distance_beyond(e, fold, first, before);
    Text        name = {.arena = e->scratch}, positive = name, text = name;
    text_format(&name, "t%u", e->next++);
    text_format(&positive, "max(%s, 0.0)", excess);
    emit_comment(e, fold->span);
    emit_local(e, TYPE_FLOAT, name.bytes, positive.bytes);
    e->excess[n] = name.bytes;
    text_format(&text, "(%s - %s * (2.0 * %s))", e->text[fold->operands[0]], name.bytes,
                e->text[fold->operands[1]]);
    return text.bytes;
}

const char *mirror_text(Emitter *e, const Expr *fold)
{
    int axis = fold_axis(e, fold);
    if (axis != 0)
        return across_axis(e, fold, axis);
    Node n      = (Node)(fold - e->graph->items);
    Node before = is_tilted(e, fold) ? mirror_before(e, n) : NODE_NONE;
    return before != NODE_NONE || only_feeds_mirror(e, n) ? in_row(e, fold, n, before) : NULL;
}

bool mirror_repeats(const Emitter *e, const Expr *fold)
{
    return fold_axis(e, fold) != 0 || is_tilted(e, fold);
}
