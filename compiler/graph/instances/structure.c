/*
 * structure.c: expressions of one structure, which differ in numbers only.
 *
 * A hash that leaves numbers out finds the template.  Then both are walked together, users before
 * operands: each node of the template gets an image, and one that would get two has none.
 */
#include "compiler/graph/instances/structure.h"

#include <math.h>
#include <string.h>

/* There is one for each node of the graph, and mostly the value stands in the node. */
typedef struct NodeNote {
    uint64_t hash;
    uint32_t value; /* IN_NODE, or where in `values`: it is a finite number that is known now; or
                       UNKNOWN */
} NodeNote;

enum { UNKNOWN, IN_NODE, FIRST_VALUE };

struct Structures {
    Graph *graph;
    Arena *arena;
    struct {
        NodeNote *items;
        size_t    count, capacity;
    } notes; /* of the first nodes of the graph */
    struct {
        NodeValue *items;
        size_t     count, capacity;
    } values;
};

Structures *structures_new(Graph *graph, Arena *arena)
{
    Structures *structures = arena_new(arena, Structures);
    *structures            = (Structures){.graph = graph, .arena = arena};
    return structures;
}

void structures_forget(Structures *structures, size_t first)
{
    while (structures->notes.count > first) {
        uint32_t value = structures->notes.items[--structures->notes.count].value;
        if (value >= FIRST_VALUE)
            structures->values.count = value - FIRST_VALUE;
    }
}

static bool is_known(const Structures *structures, Node node)
{
    return structures->notes.items[node].value != UNKNOWN;
}

static NodeValue known_value(const Structures *structures, Node node)
{
    uint32_t  value = structures->notes.items[node].value;
    NodeValue number;
    if (value >= FIRST_VALUE)
        return structures->values.items[value - FIRST_VALUE];
    memcpy(number.v, structures->graph->items[node].number, sizeof number.v);
    return number;
}

/* ---- what operands are ---- */

static bool is_number(GraphType type) { return type <= TYPE_VEC4; }

static bool is_operation(const Expr *e) { return e->time == TIME_POINT && e->operand_count > 0; }

/* Returns what a node is where `user` has it as an operand; user NULL: it is a root. */
static int use_kind(const Structures *structures, const Expr *user, int operand, Node node)
{
    if (node == NODE_NONE)
        return USE_SAME;
    const Expr *e = &structures->graph->items[node];
    if (is_operation(e))
        return USE_NODE;
    bool known  = is_known(structures, node);
    bool number = (is_number((GraphType)e->type) && (known || e->time == TIME_FRAME)) ||
                  (!user && e->type == TYPE_UINT && known);
    return number && !(user && op_has_setting((Op)user->op, operand)) ? USE_SLOT : USE_SAME;
}

/* ---- notes ---- */

static uint64_t hash_word(uint64_t hash, uint64_t word)
{
    hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
    return hash ^ (hash >> 29);
}

static uint64_t hash_value(NodeValue value)
{
    uint64_t hash = 0, bits;
    for (int i = 0; i < 4; i++) {
        memcpy(&bits, &value.v[i], sizeof bits);
        hash = hash_word(hash, bits);
    }
    return hash;
}

/* Hashes a use without numbers where a slot would be.  Nodes are not told apart by where they
   stand: others may have stood there before (graph_release). */
static uint64_t hash_use(const Structures *structures, const Expr *user, int operand, Node node)
{
    if (node == NODE_NONE)
        return NODE_NONE;
    bool slot = !user || is_operation(user);
    if (slot && use_kind(structures, user, operand, node) == USE_SLOT)
        return structures->graph->items[node].type;
    return is_known(structures, node) ? hash_value(known_value(structures, node))
                                      : structures->notes.items[node].hash;
}

static uint64_t hash_expression(const Structures *structures, const Expr *e)
{
    uint64_t hash = hash_word(hash_word(e->op, e->type), e->index);
    for (int i = 0; i < e->operand_count; i++)
        hash = hash_word(hash, hash_use(structures, e, i, e->operands[i]));
    return hash;
}

static bool is_finite(const Expr *e, const double *value)
{
    for (int i = 0; i < (is_number((GraphType)e->type) ? e->type : 1); i++)
        if (!isfinite(value[i]))
            return false;
    return true;
}

/* Returns the value of an operation on what is known; UNKNOWN: it is not. */
static uint32_t note_value(Structures *structures, const Expr *e)
{
    GraphType types[MAX_OPERANDS]    = {0};
    NodeValue operands[MAX_OPERANDS] = {0};
    for (int i = 0; i < e->operand_count; i++) {
        if (!is_known(structures, e->operands[i]))
            return UNKNOWN;
        types[i]    = structures->graph->items[e->operands[i]].type;
        operands[i] = known_value(structures, e->operands[i]);
    }
    NodeValue value = op_evaluate((Op)e->op, (GraphType)e->type, e->index, types, operands);
    if (!is_finite(e, value.v))
        return UNKNOWN;
    array_push_large(structures->arena, &structures->values, value);
    return FIRST_VALUE + (uint32_t)structures->values.count - 1;
}

static uint32_t find_value(Structures *structures, const Expr *e)
{
    if (e->op == OP_CONSTANT || e->op == OP_PARAMETERISED)
        return is_finite(e, e->number) ? IN_NODE : UNKNOWN;
    return e->operand_count == 0 || is_operation(e) ? UNKNOWN : note_value(structures, e);
}

static void note_all(Structures *structures)
{
    for (size_t n = structures->notes.count; n < structures->graph->count; n++) {
        const Expr *e    = &structures->graph->items[n];
        NodeNote    note = {.value = find_value(structures, e)};
        if (note.value == UNKNOWN)
            note.hash = hash_expression(structures, e);
        array_push_large(structures->arena, &structures->notes, note);
    }
}

uint64_t structure_hash(Structures *structures, const Node *roots, uint32_t count)
{
    uint64_t hash = count;
    note_all(structures);
    for (uint32_t i = 0; i < count; i++)
        hash = hash_word(hash, hash_use(structures, NULL, 0, roots[i]));
    return hash;
}

/* ---- templates ---- */

typedef struct TemplateMaker {
    const Structures *structures;
    Arena            *arena;
    Template *template;
    struct {
        TemplateNode *items;
        size_t        count, capacity;
    } nodes;
    struct {
        Node  *items;
        size_t count, capacity;
    } slots;
    struct {
        GraphType *items;
        size_t     count, capacity;
    } slot_types;
    /* Nodes whose operands are not all made yet; and of those made, where they are: by hashing. */
    struct {
        Node  *items;
        size_t count, capacity;
    } open;
    uint32_t *places; /* 1 + index in `nodes`, or 0 */
    size_t    place_count;
} TemplateMaker;

static size_t place_of(const TemplateMaker *maker, Node node)
{
    size_t at = (node * 0x9e3779b1u) & (maker->place_count - 1);
    while (maker->places[at] && maker->nodes.items[maker->places[at] - 1].node != node)
        at = (at + 1) & (maker->place_count - 1);
    return at;
}

static void grow_places(TemplateMaker *maker)
{
    if (2 * (maker->nodes.count + 1) <= maker->place_count)
        return;
    maker->place_count = maker->place_count ? 2 * maker->place_count : 64;
    maker->places      = arena_new_array(maker->arena, uint32_t, maker->place_count);
    for (size_t i = 0; i < maker->nodes.count; i++)
        maker->places[place_of(maker, maker->nodes.items[i].node)] = (uint32_t)i + 1;
}

static TemplateUse make_use(TemplateMaker *maker, const Expr *user, int operand, Node node)
{
    switch (use_kind(maker->structures, user, operand, node)) {
    case USE_NODE: return (TemplateUse){USE_NODE, maker->places[place_of(maker, node)] - 1};
    case USE_SLOT:
        array_push(maker->arena, &maker->slots, node);
        array_push(maker->arena, &maker->slot_types,
                   (GraphType)maker->structures->graph->items[node].type);
        return (TemplateUse){USE_SLOT, (uint32_t)maker->slots.count - 1};
    default: return (TemplateUse){USE_SAME, node};
    }
}

/* Opens the operands of a node that are not made yet; false: there are none. */
static bool open_operands(TemplateMaker *maker, Node node)
{
    const Expr *e      = &maker->structures->graph->items[node];
    size_t      before = maker->open.count;
    for (int i = e->operand_count; i-- > 0;) {
        Node operand = e->operands[i];
        if (use_kind(maker->structures, e, i, operand) == USE_NODE &&
            !maker->places[place_of(maker, operand)])
            array_push(maker->arena, &maker->open, operand);
    }
    return maker->open.count > before;
}

static void make_node(TemplateMaker *maker, Node node)
{
    grow_places(maker);
    size_t place = place_of(maker, node);
    if (maker->places[place])
        return;
    const Expr  *e    = &maker->structures->graph->items[node];
    TemplateNode made = {.node = node, .op = e->op, .type = e->type, .index = e->index};
    for (int i = 0; i < MAX_OPERANDS; i++)
        made.uses[i] = i < e->operand_count ? make_use(maker, e, i, e->operands[i])
                                            : (TemplateUse){USE_SAME, NODE_NONE};
    array_push(maker->arena, &maker->nodes, made);
    maker->places[place] = (uint32_t)maker->nodes.count;
}

/* Makes the nodes that a root needs, operands first. */
static void make_nodes(TemplateMaker *maker, Node root)
{
    grow_places(maker);
    array_push(maker->arena, &maker->open, root);
    while (maker->open.count > 0) {
        Node node = maker->open.items[maker->open.count - 1];
        if (open_operands(maker, node))
            continue;
        maker->open.count--;
        make_node(maker, node);
    }
}

Template *template_new(Structures *structures, const Node *roots, uint32_t count, Arena *arena)
{
    TemplateMaker maker  = {.structures = structures, .arena = arena};
    Template *template   = arena_new(arena, Template);
    template->hash       = structure_hash(structures, roots, count);
    template->roots      = arena_new_array(arena, TemplateUse, count);
    template->root_count = count;
    grow_places(&maker);
    for (uint32_t i = 0; i < count; i++) {
        if (use_kind(structures, NULL, 0, roots[i]) == USE_NODE)
            make_nodes(&maker, roots[i]);
        template->roots[i] = make_use(&maker, NULL, 0, roots[i]);
    }
    template->nodes      = maker.nodes.items;
    template->node_count = (uint32_t)maker.nodes.count;
    template->slots      = maker.slots.items;
    template->slot_types = maker.slot_types.items;
    template->slot_count = (uint32_t)maker.slots.count;
    template->images     = arena_new_array(arena, Node, maker.nodes.count);
    return template;
}

static bool detach_use(Structures *structures, Template *template, TemplateUse *use, size_t first,
                       Arena *arena)
{
    if (use->kind != USE_SAME || use->index < first || use->index == NODE_NONE)
        return true;
    if (!is_known(structures, use->index))
        return false;
    TemplateKnown known = {(GraphType)structures->graph->items[use->index].type,
                           known_value(structures, use->index)};
    array_push(arena, &template->known, known);
    *use = (TemplateUse){USE_KNOWN, (uint32_t) template->known.count - 1};
    return true;
}

bool template_detach(Structures *structures, Template *template, size_t first, Arena *arena)
{
    bool good = true;
    for (uint32_t i = 0; good && i < template->root_count; i++)
        good = detach_use(structures, template, &template->roots[i], first, arena);
    for (uint32_t i = 0; i < template->node_count; i++)
        for (int k = 0; good && k < MAX_OPERANDS; k++)
            good = detach_use(structures, template, &template->nodes[i].uses[k], first, arena);
    return good;
}

/* ---- matching ---- */

static bool has_value(const Structures *structures, Node node, GraphType type, NodeValue value)
{
    if (node == NODE_NONE || !is_known(structures, node) ||
        structures->graph->items[node].type != type)
        return false;
    NodeValue own = known_value(structures, node);
    return !memcmp(&own, &value, sizeof own);
}

static bool same_node(const Structures *structures, Node a, Node b)
{
    if (a == b || a == NODE_NONE || b == NODE_NONE)
        return a == b;
    return is_known(structures, a) &&
           has_value(structures, b, (GraphType)structures->graph->items[a].type,
                     known_value(structures, a));
}

/* Returns the number, or node of the frame, that is an element of a node. */
static Node element_node(Graph *graph, Node node, uint32_t element)
{
    const Expr *e = &graph->items[node];
    if (op_has_traits((Op)e->op, BUILDS))
        return e->operands[e->operand_count > 1 ? element : 0];
    return graph_component(graph, node, element);
}

static SlotContent content_of(const Structures *structures, Node node)
{
    const uint32_t elements = structures->graph->items[node].type;
    SlotContent    content  = {.nodes = {NODE_NONE, NODE_NONE, NODE_NONE, NODE_NONE}};
    if (is_known(structures, node)) {
        NodeValue value = known_value(structures, node);
        memcpy(content.numbers, value.v, sizeof content.numbers);
        return content;
    }
    for (uint32_t k = 0; k < elements; k++) {
        Node element = element_node(structures->graph, node, k);
        if (element < structures->notes.count && is_known(structures, element))
            content.numbers[k] = known_value(structures, element).v[0];
        else
            content.nodes[k] = element;
    }
    return content;
}

static bool match_use(const Structures *structures, const Template *template, TemplateUse use,
                      const Expr *user, int operand, Node node, SlotContent *contents)
{
    int kind = use_kind(structures, user, operand, node);
    if (use.kind == USE_KNOWN) {
        const TemplateKnown *known = &template->known.items[use.index];
        return kind == USE_SAME && has_value(structures, node, known->type, known->value);
    }
    if (kind != (int)use.kind)
        return false;
    if (use.kind == USE_SAME)
        return same_node(structures, use.index, node);
    if (use.kind == USE_SLOT) {
        if (structures->graph->items[node].type != template->slot_types[use.index])
            return false;
        contents[use.index] = content_of(structures, node);
        return true;
    }
    Node *image = &template->images[use.index];
    if (*image == NODE_NONE)
        *image = node;
    return *image == node;
}

static bool match_node(const Structures *structures, const Template *template, uint32_t index,
                       SlotContent *contents)
{
    const TemplateNode *made = &template->nodes[index];
    const Expr         *e    = &structures->graph->items[template->images[index]];
    if (e->op != made->op || e->type != made->type || e->index != made->index)
        return false;
    for (int i = 0; i < e->operand_count; i++)
        if (!match_use(structures, template, made->uses[i], e, i, e->operands[i], contents))
            return false;
    return true;
}

bool template_match(Structures *structures, const Template *template, const Node *roots,
                    SlotContent *contents)
{
    note_all(structures);
    for (uint32_t i = 0; i < template->node_count; i++)
        template->images[i] = NODE_NONE;
    for (uint32_t i = 0; i < template->root_count; i++)
        if (!match_use(structures, template, template->roots[i], NULL, 0, roots[i], contents))
            return false;
    for (uint32_t i = template->node_count; i-- > 0;)
        if (!match_node(structures, template, i, contents))
            return false;
    return true;
}

/* ---- copies ---- */

/* Returns the nodes that the wanted roots need. */
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
    return graph_like(graph, &e, e.operands);
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
