/*
 * extract.c: a part of a graph as a graph of its own, so that arrays by node are as small as the
 * part.
 */
#include "compiler/graph/instance_table.h"
#include "compiler/graph/evaluate.h"

static Node copy_node(Graph *part, const Tape *tape, const Node *copies, Node node)
{
    const Expr *e = &tape->graph->items[node];
    Node        operands[MAX_OPERANDS];
    part->here = e->span;
    if (e->operand_count == 0)
        return graph_copy_leaf(part, e);
    for (int i = 0; i < e->operand_count; i++)
        operands[i] = copies[tape_index(tape, e->operands[i])];
    return graph_like(part, e, operands);
}

/* Copies nodes in their order: of the two that come next on the tape, of the frame and of the
   point, the older one is copied first. */
static void copy_nodes(Graph *part, const Tape *tape, Node *copies)
{
    size_t frame = 0, point = tape->frame_count;
    while (frame < tape->frame_count || point < tape->count) {
        bool older = point == tape->count ||
                     (frame < tape->frame_count && tape->nodes[frame] < tape->nodes[point]);
        size_t i  = older ? frame++ : point++;
        copies[i] = copy_node(part, tape, copies, tape->nodes[i]);
    }
}

Graph *graph_extract(const Graph *graph, Node *roots, size_t root_count, Arena *arena)
{
    Tape   tape            = tape_new(graph, roots, root_count, arena);
    Node  *copies          = arena_new_array(arena, Node, tape.count + 1);
    Graph *part            = graph_new(arena);
    part->textures         = graph->textures;
    part->parameters.count = 0;
    for (size_t i = 0; i < graph->parameters.count; i++)
        array_push(arena, &part->parameters, graph->parameters.items[i]);
    copy_nodes(part, &tape, copies);
    for (size_t i = 0; i < root_count; i++)
        roots[i] = copies[tape_index(&tape, roots[i])];
    part->here = (Span){0};
    return part;
}

Graph *graph_extract_along(const Graph *graph, const Node *roots, size_t root_count, Node leaf,
                           Node *copies, Arena *arena)
{
    Tape   tape = tape_new(graph, roots, root_count, arena);
    Node  *all  = arena_new_array(arena, Node, tape.count + 1);
    Graph *part = graph_new(arena);
    for (size_t i = 0; i < tape.count; i++)
        all[i] = tape.nodes[i] == leaf ? graph_component(part, graph_leaf(part, OP_POINT), 0)
                                       : copy_node(part, &tape, all, tape.nodes[i]);
    for (size_t i = 0; i < root_count; i++)
        copies[i] = all[tape_index(&tape, roots[i])];
    return part;
}

Graph *graph_extract_with_instances(const Graph *graph, Node *roots, size_t root_count,
                                    Arena *arena)
{
    size_t count;
    Node  *all  = roots_with_bodies(graph, roots, root_count, &count, arena);
    Graph *part = graph_extract(graph, all, count, arena);
    hand_on_instances(part, graph, all, roots, root_count);
    return part;
}
