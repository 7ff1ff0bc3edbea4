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

#include "compiler/base/vec.h"
#include "compiler/print/emitter.h"

/* Returns 1 + the axis that a constant normal is along, negative where it points down; 0: none. */
static int axis_of(const Expr *normal)
{
    for (int i = 0; normal->op == OP_CONSTANT && i < 3; i++)
        if (fabs(normal->number[i]) == 1)
            return (int)normal->number[i] * (i + 1);
    return 0;
}

/* Returns the same of the normal of a mirror. */
static int fold_axis(const Emitter *e, const Expr *fold)
{
    return axis_of(&e->graph->items[fold->operands[1]]);
}

/* Returns a mirror across an axis.  One coordinate becomes the lesser, or the greater, of itself
   and its image: two operations that what follows has to wait for, or one. */
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

const MirrorNodes *mirror_nodes(const Emitter *e, Node fold)
{
    const MirrorNodes *nodes = e->module->mirror_nodes;
    return nodes && nodes[fold].in_row ? &nodes[fold] : NULL;
}

static bool is_tilted(const Emitter *e, const Expr *expr)
{
    return expr->op == OP_fold &&
           (mirror_nodes(e, (Node)(expr - e->graph->items)) ||
            (e->graph->items[expr->operands[1]].op == OP_CONSTANT && fold_axis(e, expr) == 0));
}

/* Tells whether a mirror is used by the next mirror alone, whose use counts twice. */
static bool only_feeds_mirror(const Emitter *e, Node n)
{
    return is_tilted(e, &e->graph->items[n]) && e->feeds_mirror[n] && e->uses[n] == 2 &&
           !e->given[n];
}

/* Returns the mirror before this one in a row, or NODE_NONE. */
static Node mirror_before(const Emitter *e, Node n)
{
    Node before = e->graph->items[n].operands[0];
    return only_feeds_mirror(e, before) ? before : NODE_NONE;
}

/* Returns a value of the frame, or a literal where it is the same in all frames. */
static const char *frame_text(Emitter *e, Node node)
{
    const Expr *expr = &e->graph->items[node];
    return expr->op == OP_CONSTANT ? emit_constant(e, expr) : e->frame[node];
}

/* Returns twice the product of the normals of a mirror and of the one `back` places before it, 1 or
   2. */
static const char *product_text(Emitter *e, Node fold, Node mirror, int back)
{
    const Expr        *items = e->graph->items;
    const MirrorNodes *nodes = mirror_nodes(e, fold);
    if (nodes)
        return frame_text(e, nodes->products[back - 1]);
    const double *n = items[items[fold].operands[1]].number;
    const double *b = items[items[mirror].operands[1]].number;
    return emit_number(e, 2 * dot3(n, b));
}

/* Subtracts what a mirror before has moved the point by, along the normal. */
static void subtract_move(Emitter *e, Text *text, const Expr *fold, Node mirror, int back)
{
    Node n = (Node)(fold - e->graph->items);
    text_format(text, " - KRS_BACK(%s * %s, 0.0)", e->excess[mirror],
                product_text(e, n, mirror, back));
}

/* Returns how far beyond the mirror the point is, from where it was before the mirrors `first` and
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
        subtract_move(e, &text, fold, first, 2);
    if (before != NODE_NONE)
        subtract_move(e, &text, fold, before, 1);
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
    text_format(&text, mirror_nodes(e, n) ? "(%s - (%s * 2.0) * %s)" : "(%s - %s * (2.0 * %s))",
                e->text[fold->operands[0]], name.bytes, e->text[fold->operands[1]]);
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

/* ---- numbers of the frame ---- */

/* Rows need two or three more numbers of the frame for each mirror.  A driver takes ever longer for
   those that do not fit into registers, so scenes with more mirrors go without rows. */
enum { MAX_MIRRORS = 64 };

static const MirrorNodes no_nodes = {false, {NODE_NONE, NODE_NONE}};

/* Tells whether a mirror may be in a row, which may have mirrors with literal normals among the
   others. */
static bool may_be_in_row(const Graph *graph, Node node)
{
    const Expr *e = &graph->items[node];
    return e->op == OP_fold && graph->items[e->operands[1]].time != TIME_POINT &&
           axis_of(&graph->items[e->operands[1]]) == 0;
}

static MirrorNodes parameterise_mirror(Graph *graph, Node fold)
{
    MirrorNodes nodes  = no_nodes;
    const Node  normal = graph->items[fold].operands[1];
    const Node  two    = graph_number(graph, 2);
    Node        before = graph->items[fold].operands[0];
    for (int back = 0; back < 2 && graph->items[before].op == OP_fold; back++) {
        Node product         = graph_op2(graph, OP_dot, normal, graph->items[before].operands[1]);
        nodes.products[back] = graph_op2(graph, OP_mul, product, two);
        before               = graph->items[before].operands[0];
    }
    nodes.in_row = true;
    return nodes;
}

MirrorNodes *module_parameterise_mirrors(Graph *graph, Arena *arena)
{
    const size_t count   = graph->count;
    size_t       mirrors = 0;
    for (Node n = 0; n < count; n++)
        mirrors += may_be_in_row(graph, n);
    if (mirrors == 0 || mirrors > MAX_MIRRORS)
        return NULL;
    MirrorNodes *nodes = arena_new_array(arena, MirrorNodes, count);
    for (Node n = 0; n < count; n++)
        nodes[n] = may_be_in_row(graph, n) ? parameterise_mirror(graph, n) : no_nodes;
    return nodes;
}
