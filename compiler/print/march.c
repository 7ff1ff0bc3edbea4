/*
 * march.c: what some marches need beside a distance: where rays meet planes, parts of the scene by
 * themselves, steps along a ray.
 */
#include <math.h>

#include "compiler/base/far.h"
#include "compiler/print/emitter.h"

/* ---- planes ---- */

static void emit_plane(Emitter *e, Node root)
{
    emit_body(e, &root, 1);
    emit_line(e, "    return %s;\n", e->text[root]);
}

void emit_plane_t(Emitter *e) { emit_plane(e, emit_planes(e)[0]); }
void emit_plane_cosine(Emitter *e) { emit_plane(e, emit_planes(e)[1]); }

/* ---- parts ---- */

/* Tells whether parts are marched by krs_distance_lod: its branches save work, but of camera-relative points
   nobody knows what is far. */
static bool goes_by_lod(const Emitter *e)
{
    return e->variant->many_threads && !e->variant->camera_relative;
}

void need_scene_parts(Emitter *e)
{
    for (uint32_t i = 0; i < e->module->components; i++) {
        if (emit_leaves_out(e, i))
            continue;
        if (goes_by_lod(e))
            need_lod_of(e, i);
        else
            e->needed_of[OF_DISTANCE][i] = true;
    }
}

/* Emits what is inside of a switch over parts. */
static void emit_part_case(Emitter *e, size_t part)
{
    FunctionKind kind     = goes_by_lod(e) ? OF_LOD : OF_DISTANCE;
    const char  *operands = goes_by_lod(e) ? "p, 0.0" : "p";
    size_t       count    = e->module->components;
    emit_template(e, TEMPLATE_CASE, (Operands){emit_count(e, part)});
    for (uint32_t i = module_scene_part_first(part, count);
         i < module_scene_part_first(part + 1, count); i++)
        if (!emit_leaves_out(e, i))
            text_format(e->out, "        d = min(d, %s);\n", emit_call_with(e, kind, i, operands));
    emit_template(e, TEMPLATE_CASE_END, (Operands){0});
}

void emit_scene_part_distance(Emitter *e)
{
    size_t parts = module_scene_part_count(e->module->components);
    emit_variable(e, TYPE_FLOAT, "d", NOWHERE_TEXT);
    emit_template(e, TEMPLATE_SWITCH, (Operands){"scene_part"});
    for (size_t part = 0; part < parts; part++)
        emit_part_case(e, part);
    emit_template(e, TEMPLATE_SWITCH_END, (Operands){0});
    text_format(e->out, "    return %s;\n", emit_cut(e, "d"));
}

static void emit_box_case(Emitter *e, size_t part)
{
    static const char *const names[2] = {"low", "high"};
    const Module            *module   = e->module;
    const bool  infinite = e->variant->camera_relative; /* of such points no box is known */
    const Box   box      = infinite ? box_infinite
                                    : module_scene_part_box(module->boxes, module->components, part);
    const Node *nodes    = infinite ? NULL : module->box_nodes.parts;
    double      corner[2][3];
    if (box_is_empty(box))
        return;
    module_part_corners(box, corner[0], corner[1]);
    emit_template(e, TEMPLATE_CASE, (Operands){emit_count(e, part)});
    for (size_t end = 0; end < 2; end++)
        text_format(e->out, "        %s = %s;\n",
                    template_text(e, TEMPLATE_CHANGED, (Operands){names[end]}),
                    emit_box_vector(e, nodes, 2 * part + end, corner[end]));
    emit_template(e, TEMPLATE_CASE_END, (Operands){0});
}

void emit_scene_part_box(Emitter *e)
{
    size_t count = e->module->components, parts = module_scene_part_count(count);
    emit_template(e, TEMPLATE_SWITCH, (Operands){"scene_part"});
    for (size_t part = 0; part < parts; part++) {
        bool some = false;
        for (uint32_t i = module_scene_part_first(part, count);
             i < module_scene_part_first(part + 1, count); i++)
            some = some || !emit_leaves_out(e, i);
        if (some)
            emit_box_case(e, part);
    }
    emit_template(e, TEMPLATE_SWITCH_END, (Operands){0});
}

/* ---- along rays ---- */

/* Tells whether a component has more to tell than its distance. */
static bool has_own_step(const Emitter *e, FunctionKind kind, uint32_t component)
{
    return emit_root(e, kind, component) != emit_root(e, OF_DISTANCE, component);
}

static void need_steps(Emitter *e, FunctionKind kind)
{
    for (uint32_t i = 0; i < e->module->components; i++)
        if (!emit_leaves_out(e, i))
            e->needed_of[has_own_step(e, kind, i) ? kind : OF_DISTANCE][i] = true;
}

void need_along(Emitter *e) { need_steps(e, OF_ALONG); }
void need_probe(Emitter *e) { need_steps(e, OF_PROBE); }

/* Emits what a component tells of a ray beside its distance. */
void emit_along_of(Emitter *e, const ModuleFunction *function)
{
    emit_head_of(e, function->kind, function->component);
    emit_body(e, function->roots, 1);
    emit_line(e, "    return %s;\n}\n\n", e->text[*function->roots]);
}

/* Emits the least step of all components, of which some have no more than a distance. */
static void emit_steps(Emitter *e, FunctionKind kind)
{
    emit_variable(e, TYPE_FLOAT, "t", NOWHERE_TEXT);
    for (uint32_t i = 0; i < e->module->components; i++) {
        FunctionKind called   = has_own_step(e, kind, i) ? kind : OF_DISTANCE;
        bool         separate = kind == OF_ALONG && emit_is_medium(e, i);
        if (!emit_leaves_out(e, i) && !separate)
            text_format(e->out, "    t = min(t, %s);\n", emit_call_of(e, called, i));
    }
}

static FunctionKind kind_of_step(const Emitter *e, uint32_t component)
{
    return has_own_step(e, OF_ALONG, component) ? OF_ALONG : OF_DISTANCE;
}

void emit_along(Emitter *e)
{
    emit_steps(e, OF_ALONG);
    emit_media_steps(e, kind_of_step, "t");
}

/* Emits both steps; where zones or media cut, whose steps are lengths along the ray, the first has all. */
void emit_separate_steps(Emitter *e)
{
    const bool fused = e->cuts || emit_has_media(e);
    emit_variable(e, TYPE_FLOAT, "t", NOWHERE_TEXT);
    emit_variable(e, TYPE_FLOAT, "d", NOWHERE_TEXT);
    for (uint32_t i = 0; i < e->module->components; i++) {
        const FunctionKind kind = kind_of_step(e, i);
        const char        *into = kind == OF_ALONG || fused ? "t" : "d";
        if (!emit_leaves_out(e, i) && !emit_is_medium(e, i))
            text_format(e->out, "    %s = min(%s, %s);\n", into, into, emit_call_of(e, kind, i));
    }
    if (fused)
        emit_seen_steps(e, kind_of_step, "t");
    text_format(e->out, "    return %s(t, d);\n", e->printer->types[TYPE_VEC2]);
}

void emit_probe(Emitter *e)
{
    emit_steps(e, OF_PROBE);
    text_format(e->out, "    return %s / footprint;\n", emit_cut(e, "t"));
}
