/*
 * alike_copy.c: copies of templates, with other nodes in their slots and for their leaves.
 */
#include "compiler/graph/instances/alike.h"

/* ---- copies ---- */

/* The nodes that the wanted roots need. */
static bool *needed_nodes(const Template *template, const bool *wanted, Arena *scratch)
{
    bool *needed = arena_new_array(scratch, bool, template->node_count + 1);
    for (uint32_t i = 0; i < template->root_count; i++)
        if (wanted[i] && template->roots[i].kind == USE_NODE)
            needed[template->roots[i].index] = true;
    for (uint32_t i = template->node_count; i-- > 0;)
        for (int k = 0; needed[i] && k < MAX_OPERANDS; k++)
            if (template->nodes[i].uses[k].kind == USE_NODE)
                needed[template->nodes[i].uses[k].index] = true;
    return needed;
}

typedef struct TemplateCopy {
    const Template *template;
    const Node     *slots;
    const LeafPair *pairs;
    uint32_t        pair_count;
    Node           *copies;
} TemplateCopy;

static Node copy_use(const TemplateCopy *copy, TemplateUse use)
{
    if (use.kind == USE_NODE)
        return copy->copies[use.index];
    if (use.kind == USE_SLOT)
        return copy->slots[use.index];
    for (uint32_t i = 0; i < copy->pair_count; i++)
        if (copy->pairs[i].leaf == use.index)
            return copy->pairs[i].by;
    return use.index;
}

static Node copy_node(Graph *graph, const TemplateCopy *copy, const TemplateNode *made)
{
    Expr e = graph->items[made->node]; /* the graph grows meanwhile */
    for (int i = 0; i < e.operand_count; i++)
        e.operands[i] = copy_use(copy, made->uses[i]);
    graph->here = e.span;
    return e.op == OP_COMPONENT ? graph_component(graph, e.operands[0], e.index)
                                : graph_op(graph, (Op)e.op, e.operands);
}

void template_copy(Graph *graph, const Template *template, const Node *slots, const LeafPair *pairs,
                   uint32_t pair_count, const bool *wanted, Node *roots, Arena *scratch)
{
    Span         here   = graph->here;
    const bool  *needed = needed_nodes(template, wanted, scratch);
    TemplateCopy copy   = {template, slots, pairs, pair_count,
                           arena_new_array(scratch, Node, template->node_count + 1)};
    for (uint32_t i = 0; i < template->node_count; i++)
        if (needed[i])
            copy.copies[i] = copy_node(graph, &copy, &template->nodes[i]);
    for (uint32_t i = 0; i < template->root_count; i++)
        roots[i] = wanted[i] ? copy_use(&copy, template->roots[i]) : NODE_NONE;
    graph->here = here;
}

/* ---- what roots need ---- */

typedef void VisitUse(void *user, TemplateUse use);

static void visit_uses(const Template *template, const bool *wanted, VisitUse *visit, void *user,
                       Arena *scratch)
{
    const bool *needed = needed_nodes(template, wanted, scratch);
    for (uint32_t i = 0; i < template->root_count; i++)
        if (wanted[i])
            visit(user, template->roots[i]);
    for (uint32_t i = 0; i < template->node_count; i++)
        for (int k = 0; needed[i] && k < MAX_OPERANDS; k++)
            visit(user, template->nodes[i].uses[k]);
}

typedef struct LeafSearch {
    Node leaf;
    bool found;
} LeafSearch;

static void visit_leaf(void *user, TemplateUse use)
{
    LeafSearch *search = user;
    search->found      = search->found || (use.kind == USE_SAME && use.index == search->leaf);
}

bool template_needs(const Template *template, Node leaf, const bool *wanted, Arena *scratch)
{
    LeafSearch search = {leaf, false};
    visit_uses(template, wanted, visit_leaf, &search, scratch);
    return search.found;
}

static void visit_slot(void *user, TemplateUse use)
{
    if (use.kind == USE_SLOT)
        ((bool *)user)[use.index] = true;
}

void template_slots_of(const Template *template, const bool *wanted, bool *needed, Arena *scratch)
{
    visit_uses(template, wanted, visit_slot, needed, scratch);
}
