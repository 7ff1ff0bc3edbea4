/*
 * vary.c: repeated content that depends on its cell.
 */
#include "compiler/family/vary.h"

#include "compiler/graph/evaluate.h"
#include "compiler/lower/join.h"

bool depends_on_leaf(const Graph *graph, Node root, Node leaf, Arena *scratch)
{
    if (root == NODE_NONE || leaf == NODE_NONE)
        return false;
    Tape tape = tape_new(graph, &root, 1, scratch);
    for (size_t i = 0; i < tape.count; i++)
        if (tape.nodes[i] == leaf)
            return true;
    return false;
}

bool content_varies(Lowering *l, const Shape *repeat)
{
    if (repeat->values[1] == NODE_NONE)
        return false;
    Lowering alone = {.graph = l->graph, .scratch = l->scratch, .most = l->most};
    Node     point = graph_leaf(l->graph, OP_POINT);
    Lowered  inner = lower_shape(&alone, repeat->children[0], context_new(point, true));
    l->overflow    = l->overflow || alone.overflow;
    return depends_on_leaf(l->graph, inner.distance, repeat->values[1], l->scratch);
}

static void replace(Lowering *l, Node *node, Node leaf, Node by)
{
    if (*node != NODE_NONE)
        *node = graph_replace_leaf(l->graph, *node, leaf, by, l->scratch);
}

static void replace_in_surface(Lowering *l, Surface *surface, Node leaf, Node by)
{
#define KRS_INNER(name, blends) replace(l, &surface->name, leaf, by);
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    KRS_INNER(name, blends)
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends) KRS_INNER(name, blends)
#include "compiler/shape/surface.def"
}

/* What counts as a constant in the content does so in its copies. */
static void replace_held(Lowering *l, size_t first, Node leaf, Node by)
{
    size_t end = l->held_constant ? l->held_constant->count : 0;
    for (size_t i = first; i < end; i++) {
        Node copy = l->held_constant->items[i];
        replace(l, &copy, leaf, by);
        array_push(l->scratch, l->held_constant, copy);
    }
}

/* Tables of crowds are for all cells alike, so varied content has none. */
Lowered lower_in_cell(Lowering *l, const Shape *repeat, LowerContext context, Node numbers,
                      bool operand)
{
    struct LoweredCrowds *crowds  = l->crowds;
    const Shape          *content = repeat->children[0];
    Node                  leaf    = repeat->values[1];
    size_t                held    = l->held_constant ? l->held_constant->count : 0;
    if (leaf != NODE_NONE)
        l->crowds = NULL;
    Lowered result = operand ? lower_operand(l, content, context)
                             : lower_shape(l, content, context);
    l->crowds      = crowds;
    if (leaf == NODE_NONE || result.distance == NODE_NONE)
        return result;
    replace(l, &result.distance, leaf, numbers);
    if (l->surfaces)
        replace_in_surface(l, &result.surface, leaf, numbers);
    replace_held(l, held, leaf, numbers);
    return result;
}
