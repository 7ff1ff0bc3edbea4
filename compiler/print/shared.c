/*
 * shared.c: what the distance and the surface of a component have in common, printed once.
 *
 * The distance hands over those of its values that the rest of the surface needs, by operands of a
 * function krs_shared_N, which krs_distance_N and krs_surface_N call.
 */
#include "compiler/print/emitter.h"

/* With more values than this a function of its own is shorter to read. */
enum { MOST_SHARED = 12 };

/* What is known of a node here. */
enum { UNKNOWN, OF_THE_DISTANCE, SEEN };

/* What costs nothing is not handed over, but written again. */
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
    if (!e->variant->shares || !e->needed_of[OF_DISTANCE][component] ||
        !e->needed_of[OF_SURFACE][component])
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
    return shared->count <= MOST_SHARED;
}

/* "type sN", of each. */
static void add_shared(Emitter *e, const NodeList *shared, const char *before, const char *after)
{
    for (size_t i = 0; i < shared->count; i++)
        text_format(e->out, "%s%s s%zu%s", before,
                    e->printer->types[e->graph->items[shared->items[i]].type], i, after);
}

static void add_call(Emitter *e, const NodeList *shared, uint32_t number)
{
    text_format(e->out, shared->count ? "krs_shared_%u(p" : "krs_distance_%u(p", number);
    for (size_t i = 0; i < shared->count; i++)
        text_format(e->out, ", s%zu", i);
    text_add(e->out, ");\n");
}

void emit_shared_distance(Emitter *e, const ModuleFunction *distance, const NodeList *shared)
{
    Node     root   = *distance->roots;
    uint32_t number = distance->component + 1;
    NodeList roots  = {0};
    array_push(e->scratch, &roots, root);
    for (size_t i = 0; i < shared->count; i++)
        array_push(e->scratch, &roots, shared->items[i]);
    text_format(e->out, "float krs_shared_%u(vec3 p", number);
    add_shared(e, shared, ", out ", "");
    text_add(e->out, ")\n{\n");
    emit_body(e, roots.items, roots.count);
    for (size_t i = 0; i < shared->count; i++)
        emit_line(e, "    s%zu = %s;\n", i, emit_bare(e, e->text[shared->items[i]]));
    emit_line(e, "    return %s;\n}\n\nfloat krs_distance_%u(vec3 p)\n{\n", e->text[root], number);
    add_shared(e, shared, "    ", ";\n");
    text_add(e->out, "    return ");
    add_call(e, shared, number);
    text_add(e->out, "}\n\n");
}

/* In a list of statements of the rest; the distance is `d`. */
void emit_shared_rest(Emitter *e, const ModuleFunction *surface, const NodeList *shared)
{
    add_shared(e, shared, "    ", ";\n");
    text_add(e->out, "    float d = ");
    add_call(e, shared, surface->component + 1);
    e->given[surface->roots[ROOT_DISTANCE]] = "d";
    for (size_t i = 0; i < shared->count; i++) {
        Text name = {.arena = e->scratch};
        text_format(&name, "s%zu", i);
        e->given[shared->items[i]] = name.bytes;
    }
    emit_body(e, surface->roots, surface->root_count);
    e->given[surface->roots[ROOT_DISTANCE]] = NULL;
    for (size_t i = 0; i < shared->count; i++)
        e->given[shared->items[i]] = NULL;
}
