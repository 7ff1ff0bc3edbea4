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

/* The arguments of a copy. */
typedef struct Copying {
    Lowering     *l;
    CopyWithLeaf *copy;
    const void   *user;
} Copying;

static void copy_node(const Copying *c, Node *node)
{
    if (*node != NODE_NONE)
        *node = c->copy(c->l, *node, c->user);
}

static void copy_surface(const Copying *c, Surface *surface)
{
#define KRS_INNER(name, blends) copy_node(c, &surface->name);
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    KRS_INNER(name, blends)
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends) KRS_INNER(name, blends)
#include "krs/surface.def"
}

/* Marks copies of what counts as a constant in the content. */
static void copy_held(const Copying *c, size_t first)
{
    Nodes *held = c->l->held_constant;
    size_t end  = held ? held->count : 0;
    for (size_t i = first; i < end; i++) {
        Node copy = held->items[i];
        copy_node(c, &copy);
        array_push(c->l->scratch, held, copy);
    }
}

void copy_lowered(Lowering *l, Lowered *lowered, size_t held, CopyWithLeaf *copy, const void *user)
{
    const Copying c = {l, copy, user};
    copy_node(&c, &lowered->distance);
    if (l->surfaces)
        copy_surface(&c, &lowered->surface);
    copy_held(&c, held);
}

typedef struct CellNumbers {
    Node leaf, numbers;
} CellNumbers;

static Node in_cell_with(Lowering *l, Node node, const void *user)
{
    const CellNumbers *cell = user;
    return graph_replace_leaf(l->graph, node, cell->leaf, cell->numbers, l->scratch);
}

/* Lowers varied content, which has no tables of instance groups, since these are for all cells
   alike. */
Lowered lower_in_cell(Lowering *l, const Shape *repeat, LowerContext context, Node numbers,
                      bool operand)
{
    struct LoweredGroups *groups  = l->groups;
    const Shape          *content = repeat->children[0];
    Node                  leaf    = repeat->values[1];
    size_t                held    = l->held_constant ? l->held_constant->count : 0;
    if (leaf != NODE_NONE)
        l->groups = NULL;
    Lowered result = operand ? lower_operand(l, content, context)
                             : lower_shape(l, content, context);
    l->groups      = groups;
    if (leaf == NODE_NONE || result.distance == NODE_NONE)
        return result;
    copy_lowered(l, &result, held, in_cell_with, &(CellNumbers){leaf, numbers});
    return result;
}
