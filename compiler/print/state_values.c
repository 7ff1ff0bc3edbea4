/*
 * state_values.c: packs values of the state into slots, and finds them.
 */
#include "compiler/print/state_values.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "compiler/graph/bounds/facts.h"

static uint32_t width_of(const Graph *graph, Node node)
{
    GraphType type = graph->items[node].type;
    return type <= TYPE_VEC4 ? (uint32_t)type : 1;
}

bool state_value_is_given(const Graph *graph, Node node)
{
    const Expr *e = &graph->items[node];
    return e->op == OP_PARAMETER ||
           (e->op == OP_COMPONENT && graph->items[e->operands[0]].op == OP_PARAMETER);
}

bool state_value_is_arranged(const Graph *graph, Node node)
{
    Op op = (Op)graph->items[node].op;
    return op_has_traits(op, BUILDS) || op == OP_neg;
}

typedef struct StateNodes {
    Node  *items;
    size_t count, capacity;
} StateNodes;

/* Finds what is wanted, or what that arranges. */
static StateNodes find_values(const Graph *graph, const Node *wanted, size_t count, Arena *scratch)
{
    bool      *seen = arena_new_array(scratch, bool, graph->count + 1);
    StateNodes rest = {0}, found = {0};
    for (size_t i = count; i-- > 0;)
        array_push(scratch, &rest, wanted[i]);
    while (rest.count > 0) {
        Node        node     = rest.items[--rest.count];
        const Expr *e        = &graph->items[node];
        bool        arranged = state_value_is_arranged(graph, node);
        if (seen[node] || e->time != TIME_FRAME || state_value_is_given(graph, node))
            continue;
        seen[node] = true;
        for (uint32_t k = e->operand_count; k-- > 0 && arranged;)
            array_push(scratch, &rest, e->operands[k]);
        if (!arranged)
            array_push(scratch, &found, node);
    }
    return found;
}

/* Returns the range of a node of the tape, whatever the parameters are; `facts` has those before. */
static Fact find_fact(const Tape *tape, size_t at, const Fact *facts)
{
    const Expr *e = &tape->graph->items[tape->nodes[at]];
    GraphType   types[MAX_OPERANDS];
    Fact        operands[MAX_OPERANDS], fact = {0};
    for (uint32_t k = 0; k < e->operand_count; k++) {
        types[k]    = (GraphType)tape->graph->items[e->operands[k]].type;
        operands[k] = facts[tape_index(tape, e->operands[k])];
    }
    if (e->op == OP_PARAMETERISED) { /* another text of the same structure has another */
        for (uint32_t k = 0; k < 4; k++)
            fact.value[k] = (Range){-HUGE_VAL, HUGE_VAL};
        return fact;
    }
    if (e->op != OP_PARAMETER)
        return op_fact((Op)e->op, (GraphType)e->type, e->index, types, operands, e->number);
    const GraphParameter *range = &tape->graph->parameters.items[e->index];
    for (uint32_t k = 0; k < 4; k++)
        fact.value[k] = (Range){range->low[k], range->high[k]};
    return fact;
}

void state_values_assign(StateValues *values, const Graph *graph, const Node *wanted, size_t count,
                         Arena *arena, Arena *scratch)
{
    StateNodes found = find_values(graph, wanted, count, scratch);
    uint32_t   used  = 4 * values->first_slot;
    values->count    = found.count;
    values->items    = arena_new_array(arena, StateValue, found.count + 1);
    values->tape     = tape_new(graph, found.items, found.count, arena);
    Fact *facts      = arena_new_array(scratch, Fact, values->tape.count + 1);
    for (size_t i = 0; i < values->tape.count; i++)
        facts[i] = find_fact(&values->tape, i, facts);
    for (size_t i = 0; i < found.count; i++) {
        StateValue *value = &values->items[i];
        const Fact *fact  = &facts[tape_index(&values->tape, found.items[i])];
        *value = (StateValue){.node = found.items[i], .width = width_of(graph, found.items[i])};
        for (uint32_t k = 0; k < value->width; k++) {
            bool same          = range_is_single(fact->value[k]) && isfinite(fact->value[k].low);
            value->at[k]       = same ? NO_PLACE : used++;
            value->constant[k] = fact->value[k].low;
        }
    }
    values->slots = (used + 3) / 4 - values->first_slot;
}

/* Rounds to single precision as literals are: what that does not have is the largest number that it
   has. */
static float to_single(double number)
{
    return (float)(number > FLT_MAX ? FLT_MAX : number < -FLT_MAX ? -FLT_MAX : number);
}

void state_values_find(const StateValues *values, const NodeValue *parameters, NodeValue *room,
                       float (*block)[4])
{
    const Graph *graph = values->tape.graph;
    tape_run_frame(&values->tape, parameters, room);
    memset(block, 0, values->slots * sizeof *block);
    for (size_t i = 0; i < values->count; i++) {
        const StateValue *value = &values->items[i];
        const double     *found = room[value->node].v;
        for (uint32_t k = 0; k < value->width; k++) {
            if (value->at[k] == NO_PLACE)
                continue;
            uint32_t at     = value->at[k] - 4 * values->first_slot;
            bool     whole  = graph->items[value->node].type == TYPE_UINT;
            uint32_t bits   = whole ? (uint32_t)found[k] : 0; /* others may be beyond its range */
            float    number = to_single(found[k]);
            memcpy(&block[at / 4][at % 4], whole ? (void *)&bits : (void *)&number, sizeof number);
        }
    }
}
