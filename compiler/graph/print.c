/*
 * print.c: the graph as text, one node a line, for `krs dump`.
 */
#include "compiler/graph/instance_table.h"
#include "compiler/graph/evaluate.h"
#include "compiler/graph/graph.h"

static const char *const type_names[] = {
    [TYPE_FLOAT] = "float", [TYPE_VEC2] = "vec2", [TYPE_VEC3] = "vec3",
    [TYPE_VEC4] = "vec4",   [TYPE_BOOL] = "bool", [TYPE_UINT] = "uint",
};

static const char *const time_names[] = {
    [TIME_COMPILE] = "constant",
    [TIME_FRAME]   = "frame",
    [TIME_POINT]   = "point",
};

static void print_constant(const Expr *e, Text *out)
{
    if (e->type == TYPE_BOOL) {
        text_add(out, e->number[0] != 0 ? "true" : "false");
        return;
    }
    bool vector = e->type >= TYPE_VEC2 && e->type <= TYPE_VEC4;
    for (int i = 0; i < (vector ? e->type : 1); i++) {
        text_add(out, i ? ", " : vector ? "[" : "");
        text_number(out, e->number[i]);
    }
    text_add(out, vector ? "]" : "");
}

static void print_position(const Sources *sources, Span span, Text *out)
{
    if (!sources || span.source == 0 || span.source >= sources->count)
        return;
    const Source *source = &sources->items[span.source];
    Position      at     = source_position(source, span.start);
    text_format(out, "  ; %s:%u:%u", source->name, (unsigned)at.line, (unsigned)at.column);
}

static void print_node(const Graph *graph, Node node, const Sources *sources, Text *out)
{
    const Expr *e = &graph->items[node];
    text_format(out, "%%%u %s %s = ", (unsigned)node, type_names[e->type], time_names[e->time]);
    if (e->op == OP_CONSTANT)
        print_constant(e, out);
    else
        text_add(out, graph_op_name(e->op));
    for (int i = 0; i < e->operand_count; i++)
        text_format(out, " %%%u", (unsigned)e->operands[i]);
    if (e->op == OP_COMPONENT || e->op == OP_PARAMETER || is_of_instances(e->op))
        text_format(out, " %u", (unsigned)e->index);
    print_position(sources, e->span, out);
    text_add(out, "\n");
}

static void print_functions(const Tape *tape, Text *out)
{
    const Instances *instances = tape->graph->instances;
    for (uint32_t id = 0; id < tape->function_count; id++) {
        const InstanceFunction *function = &instances->functions.items[id];
        if (!tape->functions[id].graph)
            continue;
        const InstanceTable *table = &instances->tables.items[function->table_number];
        text_format(out, "function %u of table %u, %u rows of %u:", (unsigned)id,
                    (unsigned)function->table_number, (unsigned)table->rows,
                    (unsigned)table->columns);
        for (uint32_t i = 0; i < body_count(function); i++)
            text_format(out, " %%%u", (unsigned)instances->bodies.items[function->first_body + i]);
        text_add(out, "\n");
    }
}

static void mark(const Tape *tape, bool *needed)
{
    for (size_t i = 0; i < tape->count; i++)
        needed[tape->nodes[i]] = true;
}

void graph_print(const Graph *graph, const Sources *sources, const Node *roots, size_t root_count,
                 Text *out)
{
    Tape  tape   = tape_new(graph, roots, root_count, out->arena);
    bool *needed = arena_new_array(out->arena, bool, graph->count);
    mark(&tape, needed);
    for (uint32_t id = 0; id < tape.function_count; id++)
        mark(&tape.functions[id], needed);
    for (Node node = 0; node < graph->count; node++)
        if (needed[node])
            print_node(graph, node, sources, out);
    print_functions(&tape, out);
    for (size_t i = 0; i < root_count; i++)
        text_format(out, "root %%%u\n", (unsigned)roots[i]);
}
