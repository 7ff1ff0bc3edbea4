/*
 * early_outs.c: krs_distance_lod: the distance, less what is far for its size, by branches.
 *
 * A guard stands for a region of the graph that is evaluated only where the guard cannot do
 * without it (graph/regions.h); boxes around components do the same between them.
 */
#include <math.h>

#include "compiler/shader/emitter.h"

static const char *emit_region(Emitter *e, const Regions *regions, uint32_t region, Node result,
                               bool returns);

/* Where nothing has been found yet, the bound alone counts. */
static bool nothing_found(const Emitter *e, Node least)
{
    const Expr *expr = &e->graph->items[least];
    return expr->op == OP_CONSTANT && expr->number[0] >= 1e30;
}

/* The condition of OP_guard, shorter where some of it is known. */
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

/* A guard within an expression: what it may leave out stands in a block. */
static void emit_guard(Emitter *e, const Regions *regions, Node guard)
{
    const Node *o     = e->graph->items[guard].operands;
    const char *bound = e->text[o[0]], *least = e->text[o[1]];
    Text        name = {.arena = e->scratch};
    text_format(&name, "t%u", e->next++);
    text_format(e->out, "    float %s = min(%s, %s);\n    if (!(%s)) {\n", name.bytes, bound, least,
                guard_text(e, o));
    const char *rest = emit_region(e, regions, regions->body[guard], o[2], false);
    text_format(e->out, "    %s = %s;\n    }\n", name.bytes, rest);
    e->text[guard]    = name.bytes;
    e->nesting[guard] = 0;
}

static void emit_return(Emitter *e, const Node *o)
{
    const char *bound = e->text[o[0]];
    text_format(e->out, "    if (%s)\n        return ", guard_text(e, o));
    if (nothing_found(e, o[1]))
        text_format(e->out, "%s;\n", bound);
    else
        text_format(e->out, "min(%s, %s);\n", bound, e->text[o[1]]);
}

/* Statements of a region; returns its result.  Where that is all that the function is about, a
   guard can return. */
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

/* Where it has no guards, it is the distance. */
static void emit_guarded(Emitter *e, size_t component, Node root, Node distance)
{
    text_format(e->out, "float krs_distance_lod_%zu(vec3 p, float footprint)\n{\n", component + 1);
    if (root == distance) {
        text_format(e->out, "    return krs_distance_%zu(p);\n}\n\n", component + 1);
        return;
    }
    graph_regions(&e->regions, e->graph, &root, 1, e->scratch);
    emit_begin(e, &root, 1);
    const char *result = emit_region(e, &e->regions, REGION_ALWAYS, root, true);
    text_format(e->out, "    return %s;\n}\n\n", result);
}

/* A component whose box is not nearer than what has been found is left out. */
static void emit_guarded_component(Emitter *e, size_t component, Box box, bool first)
{
    if (first) {
        text_format(e->out, "    float d = krs_distance_lod_%zu(p, footprint);\n", component + 1);
        return;
    }
    double centre[3], half[3];
    box_centre(box, centre);
    for (int i = 0; i < 3; i++)
        half[i] = (0.5 + 1e-6) * (box.axis[i].high - box.axis[i].low) + 1e-6 * fabs(centre[i]);
    if (box_is_finite(box))
        text_format(e->out, "    if (krs_box_distance(p, %s, %s) < max(d, 1e-30))\n    ",
                    emit_vector(e, centre), emit_vector(e, half));
    text_format(e->out, "    d = min(d, krs_distance_lod_%zu(p, footprint));\n", component + 1);
}

/* What marches by branches: endless components first, then the others where they may be nearer. */
void emit_early_outs(Emitter *e, const EmitMarch *march, const Node *roots, size_t components)
{
    text_add(e->out, "#ifdef EARLY_OUTS\n");
    for (size_t i = 0; i < components; i++)
        emit_guarded(e, i, march->guarded[i], roots[i * ROOT_COUNT + ROOT_DISTANCE]);
    text_add(e->out,
             "float krs_box_distance(vec3 p, vec3 center, vec3 half_sides)\n{\n"
             "    return length(max(abs(p - center) - half_sides, 0.0));\n}\n\n"
             "// To march by: never above the distance to the nearest surface, and not above 0 in\n"
             "// the same places as krs_distance.  What is far for its size is not looked at, nor\n"
             "// what is smaller than the footprint.\n"
             "float krs_distance_lod(vec3 p, float footprint)\n{\n");
    size_t count = march->is_plane != NULL;
    if (march->is_plane)
        text_add(e->out, "    float d = 1e30;\n");
    for (int finite = 0; finite < 2; finite++)
        for (size_t i = 0; i < components; i++) {
            bool is_plane = march->is_plane && march->is_plane[i];
            if (box_is_empty(march->boxes[i]) || box_is_finite(march->boxes[i]) != finite)
                continue;
            text_add(e->out, is_plane ? "#ifndef PLANES\n" : "");
            emit_guarded_component(e, i, march->boxes[i], count++ == 0);
            text_add(e->out, is_plane ? "#endif\n" : "");
        }
    if (count == 0)
        text_add(e->out, "    float d = 1e30;\n");
    text_add(e->out, "    return krs_cut(p, d);\n}\n#endif\n\n");
}
