/*
 * shared.c: what the distance and the surface of a component have in common, printed once.
 *
 * The distance hands over those of its values that the rest of the surface needs, by operands of a
 * function krs_shared_N, which krs_distance_N and krs_surface_N call.
 */
#include "compiler/print/emitter.h"

/* The number of values beyond which a function of its own is shorter to read. */
enum { MAX_SHARED = 12 };

/* The state of a node. */
enum { UNKNOWN, OF_THE_DISTANCE, SEEN };

/* Tells whether a value costs nothing: it is not handed over, but written again. */
static bool is_plain(const Expr *expr)
{
    return expr->operand_count == 0 || expr->op == OP_COMPONENT;
}

/* Follows what the rest needs up to what the distance has. */
static void visit(Emitter *e, NodeList *path, NodeList *shared)
{
    for (size_t i = 0; i < path->count; i++) {
        Node        n    = path->items[i];
        const Expr *expr = &e->graph->items[n];
        if (expr->time != TIME_POINT || e->mark[n] == SEEN)
            continue;
        if (e->mark[n] == OF_THE_DISTANCE && !is_plain(expr))
            array_push(e->scratch, shared, n);
        else
            for (uint32_t k = 0; k < expr->operand_count; k++)
                array_push(e->scratch, path, expr->operands[k]);
        e->mark[n] = SEEN;
    }
}

static void forget(Emitter *e, const Node *nodes, size_t count)
{
    for (size_t i = 0; i < count; i++)
        e->mark[nodes[i]] = UNKNOWN;
}

bool emit_find_shared(Emitter *e, uint32_t component, NodeList *shared)
{
    if (!e->variant->shares || emit_has_tangent(e, component) ||
        !e->needed_of[OF_DISTANCE][component] || !e->needed_of[OF_SURFACE][component])
        return false;
    ModuleFunction surface = emit_function(e, OF_SURFACE, component);
    NodeList       path    = {0};
    emit_count_uses(e, &surface.roots[ROOT_DISTANCE], 1, false);
    for (size_t i = 0; i < e->needed.count; i++)
        e->mark[e->needed.items[i]] = OF_THE_DISTANCE;
    for (uint32_t k = 0; k < surface.root_count; k++)
        if (k != ROOT_DISTANCE)
            array_push(e->scratch, &path, surface.roots[k]);
    visit(e, &path, shared);
    forget(e, path.items, path.count);
    forget(e, e->needed.items, e->needed.count);
    return shared->count <= MAX_SHARED;
}

static const char *name_of(Emitter *e, const char *what, size_t number)
{
    Text text = {.arena = e->scratch};
    text_format(&text, "%s%zu", what, number);
    return text.bytes;
}

static const char *type_text(Emitter *e, GraphType type) { return e->printer->types[type]; }

/* Returns the line, or the parameter, of a value that is handed over. */
static const char *variable_text(Emitter *e, TextTemplate template, const NodeList *shared,
                                 size_t i)
{
    GraphType type = (GraphType)e->graph->items[shared->items[i]].type;
    return template_text(e, template, (Operands){type_text(e, type), name_of(e, "s", i)});
}

static void emit_variables(Emitter *e, const NodeList *shared)
{
    for (size_t i = 0; i < shared->count; i++)
        text_add(e->out, variable_text(e, TEMPLATE_LOCAL_UNSET, shared, i));
}

static void emit_shared_head(Emitter *e, const NodeList *shared, uint32_t number)
{
    Text           parameters = {.arena = e->scratch};
    const Operands point      = {type_text(e, TYPE_VEC3), "p"};
    text_add(&parameters, template_text(e, TEMPLATE_PARAMETER, point));
    for (size_t i = 0; i < shared->count; i++)
        text_format(&parameters, ", %s", variable_text(e, TEMPLATE_PARAMETER_OUT, shared, i));
    const Operands head = {type_text(e, TYPE_FLOAT), name_of(e, "krs_shared_", number),
                           parameters.bytes};
    text_format(e->out, "%s\n{\n", template_text(e, TEMPLATE_FUNCTION, head));
}

static const char *call_text(Emitter *e, const NodeList *shared, uint32_t component)
{
    Text text = {.arena = e->scratch};
    if (shared->count == 0)
        return emit_call_of(e, OF_DISTANCE, component);
    text_format(&text, "krs_shared_%u(p", component + 1);
    for (size_t i = 0; i < shared->count; i++)
        text_format(&text, ", %s",
                    template_text(e, TEMPLATE_ARGUMENT_OUT, (Operands){name_of(e, "s", i)}));
    text_add(&text, ")");
    return text.bytes;
}

void emit_shared_distance(Emitter *e, const ModuleFunction *distance, const NodeList *shared)
{
    Node     root  = *distance->roots;
    NodeList roots = {0};
    array_push(e->scratch, &roots, root);
    for (size_t i = 0; i < shared->count; i++)
        array_push(e->scratch, &roots, shared->items[i]);
    emit_shared_head(e, shared, distance->component + 1);
    emit_body(e, roots.items, roots.count);
    for (size_t i = 0; i < shared->count; i++)
        emit_line(e, "    %s = %s;\n",
                  template_text(e, TEMPLATE_CHANGED, (Operands){name_of(e, "s", i)}),
                  emit_bare(e, e->text[shared->items[i]]));
    emit_line(e, "    return %s;\n}\n\n", e->text[root]);
    emit_head_of(e, OF_DISTANCE, distance->component);
    emit_variables(e, shared);
    text_format(e->out, "    return %s;\n}\n\n", call_text(e, shared, distance->component));
}

/* Emits the statements of the rest, in a list; the distance is `d`. */
void emit_shared_rest(Emitter *e, const ModuleFunction *surface, const NodeList *shared)
{
    emit_variables(e, shared);
    emit_local(e, TYPE_FLOAT, "d", call_text(e, shared, surface->component));
    e->given[surface->roots[ROOT_DISTANCE]] = "d";
    for (size_t i = 0; i < shared->count; i++)
        e->given[shared->items[i]] = name_of(e, "s", i);
    emit_body(e, surface->roots, surface->root_count);
    e->given[surface->roots[ROOT_DISTANCE]] = NULL;
    for (size_t i = 0; i < shared->count; i++)
        e->given[shared->items[i]] = NULL;
}
