/*
 * intern.c: equal expressions are one node.
 *
 * Every node is looked up in a hash table before it is made.
 */
#include "compiler/graph/graph.h"

#include <string.h>

static bool has_number(const Expr *e) { return e->op == OP_CONSTANT || e->op == OP_PARAMETERISED; }

/* Tells whether expressions are equal, wherever they were written.  They have operands or numbers,
   or neither. */
static bool expr_equal(const Expr *a, const Expr *b)
{
    if (a->op != b->op || a->type != b->type || a->index != b->index)
        return false;
    return has_number(a) ? !memcmp(a->number, b->number, sizeof a->number)
                         : !memcmp(a->operands, b->operands, sizeof a->operands);
}

static uint64_t hash_word(uint64_t hash, uint64_t word)
{
    hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
    return hash ^ (hash >> 32);
}

static uint32_t expr_hash(const Expr *e)
{
    uint64_t hash  = hash_word(e->op | (uint64_t)e->type << 8, e->index);
    int      count = has_number(e) ? MAX_OPERANDS : 0;
    for (int i = 0; i < e->operand_count; i++)
        hash = hash_word(hash, e->operands[i]);
    for (int i = 0; i < count; i++) {
        uint64_t bits;
        memcpy(&bits, &e->number[i], sizeof bits);
        hash = hash_word(hash, bits);
    }
    return (uint32_t)(hash >> 16);
}

/* Returns the node beside which an expression is looked for: its latest operand.  Leaves have
   none. */
static uint32_t near_of(const Expr *e, uint32_t hash)
{
    uint32_t near = e->op == OP_PARAMETERISED ? e->index : hash;
    for (int i = 0; i < e->operand_count; i++)
        near = i == 0 || e->operands[i] > near ? e->operands[i] : near;
    return near;
}

/* Returns the slot of an equal node, or the empty one where it belongs. */
static NearSlot *slot_find(const Graph *graph, const Expr *e, uint32_t hash)
{
    const uint32_t near = near_of(e, hash);
    for (size_t steps = 0;; steps++) {
        NearSlot *at = near_slot(&graph->slots, near, hash, steps);
        if (!at->number || (at->hash == hash && expr_equal(&graph->items[at->number - 1], e)))
            return at;
    }
}

/* Gives a slot to a node that is not in the table. */
static void slot_take(Graph *graph, Node node, uint32_t hash)
{
    const uint32_t near                        = near_of(&graph->items[node], hash);
    *near_slot_free(&graph->slots, near, hash) = (NearSlot){hash, node + 1};
}

static void slots_grow(Graph *graph)
{
    const NearSlots old = graph->slots;
    graph->slots.count  = old.count ? SLOTS_GROWTH * old.count : MIN_SLOTS;
    graph->slots.items  = arena_new_array(graph->arena, NearSlot, graph->slots.count);
    for (size_t i = 0; i < old.count; i++)
        if (old.items[i].number)
            slot_take(graph, old.items[i].number - 1, old.items[i].hash);
    arena_release(graph->arena, old.items, old.count * sizeof *old.items);
}

void graph_drop_older(Graph *graph)
{
    arena_release(graph->arena, graph->older, graph->capacity / 2 * sizeof *graph->items);
    graph->older = NULL;
}

/* An old array stays until the next one is full, since functions refer to nodes while they make a
   few more. */
static void add_item(Graph *graph, const Expr *e)
{
    if (graph->count == graph->capacity) {
        graph_drop_older(graph);
        graph->older = graph->items;
    }
    array_push(graph->arena, graph, *e);
}

Node node_intern(Graph *graph, Expr e)
{
    if (2 * (graph->count + 1) > graph->slots.count)
        slots_grow(graph);
    for (int i = e.operand_count; i < MAX_OPERANDS && !has_number(&e); i++)
        e.operands[i] = NODE_NONE;
    for (int i = 0; i < 4 && has_number(&e); i++)
        e.number[i] += 0.0; /* -0 and 0 are one constant */
    uint32_t  hash = expr_hash(&e);
    NearSlot *slot = slot_find(graph, &e, hash);
    if (!slot->number) {
        e.span = graph->here;
        add_item(graph, &e);
        *slot = (NearSlot){hash, (uint32_t)graph->count};
    }
    Node node = slot->number - 1;
    if (!graph->items[node].span.source && graph->here.source) { /* the compiler's own until now */
        graph->items[node].span = graph->here;
        if (graph->marks > 0)
            array_push(graph->arena, &graph->respanned, node);
    }
    return node;
}

GraphMark graph_mark(Graph *graph)
{
    graph->marks++;
    return (GraphMark){graph->count, graph->slots.count, graph->respanned.count};
}

/* Numbers of nodes that are dropped are given to others. */
static void ranges_forget(FrameRanges *ranges, size_t first)
{
    for (; ranges->used > first; ranges->used--)
        ranges->items[ranges->used - 1] = NULL;
}

void graph_keep(Graph *graph)
{
    if (--graph->marks == 0)
        graph->respanned.count = 0;
}

static void slots_fill(Graph *graph)
{
    memset(graph->slots.items, 0, graph->slots.count * sizeof *graph->slots.items);
    for (size_t i = 0; i < graph->count; i++)
        slot_take(graph, (Node)i, expr_hash(&graph->items[i]));
}

/* Releases nodes.  Slots are freed in the reverse order in which they were taken, so that none was
   passed over by a node that stays.  A larger table was filled in another order, and is filled
   again. */
void graph_release(Graph *graph, GraphMark mark)
{
    for (size_t i = graph->respanned.count; i-- > mark.respanned;)
        graph->items[graph->respanned.items[i]].span = (Span){0};
    graph->respanned.count = mark.respanned;
    if (graph->slots.count == mark.slot_count)
        for (size_t i = graph->count; i-- > mark.count;) {
            const Expr *e                      = &graph->items[i];
            *slot_find(graph, e, expr_hash(e)) = (NearSlot){0};
        }
    graph->count = mark.count;
    ranges_forget(graph->frame_ranges, mark.count);
    if (graph->slots.count != mark.slot_count)
        slots_fill(graph);
    graph_keep(graph);
}

/* The nodes since a mark, outside of the graph. */
typedef struct SavedNodes {
    size_t first, count;
    Expr  *items;
    bool  *needed;
    Node  *copies;
} SavedNodes;

static SavedNodes save_needed(const Graph *graph, size_t first, const Node *kept, size_t count,
                              Arena *scratch)
{
    SavedNodes saved = {.first = first, .count = graph->count - first};
    saved.items      = arena_new_array(scratch, Expr, saved.count + 1);
    saved.needed     = arena_new_array(scratch, bool, saved.count + 1);
    saved.copies     = arena_new_array(scratch, Node, saved.count + 1);
    for (size_t i = 0; i < count; i++)
        if (kept[i] >= first)
            saved.needed[kept[i] - first] = true;
    for (size_t i = saved.count; i-- > 0;) {
        const Expr *e  = &graph->items[first + i];
        saved.items[i] = *e;
        for (int k = 0; saved.needed[i] && k < e->operand_count; k++)
            if (e->operands[k] >= first)
                saved.needed[e->operands[k] - first] = true;
    }
    return saved;
}

static Node saved_copy(const SavedNodes *saved, Node node)
{
    return node < saved->first ? node : saved->copies[node - saved->first];
}

static void restore_needed(Graph *graph, const SavedNodes *saved)
{
    Span here = graph->here;
    for (size_t i = 0; i < saved->count; i++) {
        Expr e = saved->items[i];
        if (!saved->needed[i])
            continue;
        for (int k = 0; k < e.operand_count; k++)
            e.operands[k] = saved_copy(saved, e.operands[k]);
        graph->here      = e.span;
        saved->copies[i] = node_intern(graph, e);
    }
    graph->here = here;
}

void graph_release_but(Graph *graph, GraphMark mark, Node *kept, size_t count, Arena *scratch)
{
    bool any = false;
    for (size_t i = 0; i < count; i++)
        any = any || kept[i] >= mark.count;
    if (!any) {
        graph_release(graph, mark);
        return;
    }
    SavedNodes saved = save_needed(graph, mark.count, kept, count, scratch);
    graph_release(graph, mark);
    restore_needed(graph, &saved);
    for (size_t i = 0; i < count; i++)
        kept[i] = saved_copy(&saved, kept[i]);
}
