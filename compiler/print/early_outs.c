/*
 * early_outs.c: krs_distance_lod: the distance, less what is far for its size, by branches.
 *
 * A guard stands for a region of the graph that is evaluated only where the guard cannot do
 * without it (graph/regions.h); boxes around components do the same between them.
 */
#include <math.h>

#include "compiler/base/far.h"
#include "compiler/print/emitter.h"

static const char *emit_region(Emitter *e, const Regions *regions, uint32_t region, Node result,
                               bool returns);

/* Tells whether nothing has been found yet: then the bound alone counts. */
static bool nothing_found(const Emitter *e, Node least)
{
    const Expr *expr = &e->graph->items[least];
    return expr->op == OP_CONSTANT && expr->number[0] >= NOWHERE;
}

/* Returns the condition of OP_guard, shorter where some of it is known. */
static const char *guard_text(Emitter *e, const Node *o)
{
    const Expr *limit = &e->graph->items[o[3]];
    const char *bound = e->text[o[0]], *far = e->text[o[3]];
    Text        text = {.arena = e->scratch};
    if (nothing_found(e, o[1]))
        text_format(&text, "%s >= %s", bound, far);
    else
        text_format(&text, "%s >= min(%s, %s)", bound, e->text[o[1]], emit_bare(e, far));
    if (limit->op != OP_CONSTANT)
        text_format(&text, " && %s > min(%s, 0.0)", bound, emit_bare(e, far));
    else if (limit->number[0] >= 0)
        text_format(&text, " && %s > 0.0", bound);
    return text.bytes;
}

/* Emits a guard within an expression: what it may leave out stands in a block. */
static void emit_guard(Emitter *e, const Regions *regions, Node guard)
{
    const Node *o     = e->graph->items[guard].operands;
    const char *bound = e->text[o[0]], *least = e->text[o[1]];
    Text        name = {.arena = e->scratch}, found = name;
    text_format(&name, "t%u", e->next++);
    text_format(&found, "min(%s, %s)", bound, least);
    emit_variable(e, TYPE_FLOAT, name.bytes, found.bytes);
    emit_line(e, "    if (!(%s)) {\n", guard_text(e, o));
    size_t      outside = e->row_texels.count;
    const char *rest    = emit_region(e, regions, regions->body[guard], o[2], false);
    emit_line(e, "    %s = %s;\n    }\n", name.bytes, rest);
    e->row_texels.count = outside;
    e->text[guard]      = name.bytes;
    e->nesting[guard]   = 0;
}

static void emit_return(Emitter *e, const Node *o)
{
    Text found = {.arena = e->scratch};
    if (nothing_found(e, o[1]))
        text_add(&found, e->text[o[0]]);
    else
        text_format(&found, "min(%s, %s)", e->text[o[0]], e->text[o[1]]);
    emit_template(e, TEMPLATE_RETURN_IF, (Operands){guard_text(e, o), found.bytes});
}

/* Emits the statements of a region; returns its result.  If that is all that the function is about,
   a guard can return. */
static const char *emit_region(Emitter *e, const Regions *regions, uint32_t region, Node result,
                               bool returns)
{
    for (Node n = regions->list.items[region].first; n != NODE_NONE; n = regions->next[n]) {
        const Node *o = e->graph->items[n].operands;
        if (regions->body[n] == NO_REGION) {
            emit_node(e, n);
        } else if (n != result || !returns) {
            emit_comment(e, e->graph->items[n].span);
            emit_guard(e, regions, n);
        } else {
            emit_return(e, o);
            return emit_region(e, regions, regions->body[n], o[2], true);
        }
    }
    return e->text[result];
}

/* Tells whether a component has guards; one without has the distance alone. */
static bool is_guarded(const Emitter *e, uint32_t component)
{
    return emit_root(e, OF_LOD, component) != emit_root(e, OF_DISTANCE, component);
}

/* Tells whether distances have a component: not one that is nowhere, nor a plane that rays know. */
static bool is_looked_at(const Emitter *e, uint32_t component)
{
    return !box_is_empty(e->module->boxes[component]) && !emit_leaves_out(e, component);
}

void need_lod(Emitter *e)
{
    for (uint32_t i = 0; i < e->module->components; i++)
        if (is_looked_at(e, i))
            need_lod_of(e, i);
}

void need_lod_of(Emitter *e, uint32_t component)
{
    e->needed_of[OF_LOD][component] = true;
    e->needed_of[OF_DISTANCE][component] |= !is_guarded(e, component);
}

void emit_lod_of(Emitter *e, const ModuleFunction *function)
{
    emit_head_of(e, OF_LOD, function->component);
    if (!is_guarded(e, function->component)) {
        text_format(e->out, "    return %s;\n}\n\n",
                    emit_call_of(e, OF_DISTANCE, function->component));
        return;
    }
    graph_regions(&e->regions, e->graph, function->roots, 1, e->scratch);
    emit_begin(e, function->roots, 1);
    const char *result = emit_region(e, &e->regions, REGION_ALWAYS, *function->roots, true);
    emit_line(e, "    return %s;\n}\n\n", result);
}

const char *emit_box_distance(Emitter *e, uint32_t component)
{
    const Node *nodes = e->module->box_nodes.around;
    Text        call  = {.arena = e->scratch};
    double      centre[3], half[3];
    module_box_vectors(e->module->boxes[component], centre, half);
    emit_call(e, "krs_box_distance", TYPE_VEC3, 3);
    text_format(&call, "krs_box_distance(p, %s, %s)",
                emit_box_vector(e, nodes, (size_t)2 * component, centre),
                emit_box_vector(e, nodes, (size_t)2 * component + 1, half));
    return call.bytes;
}

/* Emits a component, which is left out where its box is not nearer than what has been found. */
static void emit_guarded_component(Emitter *e, uint32_t component, bool first)
{
    const char *call = emit_call_of(e, OF_LOD, component);
    if (first) {
        emit_variable(e, TYPE_FLOAT, "d", call);
        return;
    }
    Text least = {.arena = e->scratch}, nearer = least;
    text_format(&least, "min(d, %s)", call);
    if (!box_is_finite(e->module->boxes[component])) {
        text_format(e->out, "    d = %s;\n", least.bytes);
        return;
    }
    text_format(&nearer, "%s < max(d, 1e-30)", emit_box_distance(e, component));
    emit_template(e, TEMPLATE_SET_IF, (Operands){nearer.bytes, "d", least.bytes});
}

static FunctionKind kind_of_lod(const Emitter *e, uint32_t component)
{
    (void)e;
    (void)component;
    return OF_LOD;
}

/* Emits endless components first, then the others where they may be nearer. */
void emit_lod(Emitter *e)
{
    bool   found = e->module->is_plane == NULL; /* by the first component */
    size_t count = 0;
    if (!found)
        emit_variable(e, TYPE_FLOAT, "d", NOWHERE_TEXT);
    for (int finite = 0; finite < 2; finite++)
        for (uint32_t i = 0; i < e->module->components; i++)
            if (is_looked_at(e, i) && box_is_finite(e->module->boxes[i]) == finite &&
                !emit_is_medium(e, i))
                emit_guarded_component(e, i, found && count++ == 0);
    if (found && count == 0)
        emit_variable(e, TYPE_FLOAT, "d", NOWHERE_TEXT);
    emit_media_steps(e, kind_of_lod, "d");
}
