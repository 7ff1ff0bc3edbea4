/*
 * module_print.c: the text of a variant: what is wanted of a module, what that calls, and no more.
 *
 * Functions are printed first, since they tell which helpers they call; then all is put together.
 */
#include <assert.h>
#include <string.h>

#include "compiler/graph/instance_table.h"
#include "compiler/lower/research/research.h"
#include "compiler/print/emitter.h"

_Static_assert(KRS_STEP_DIRECTIONAL - KRS_STEP_TAYLOR == (int)RESEARCH_DIRECTIONAL &&
                   KRS_STEP_ROOT_FREE - KRS_STEP_TAYLOR == (int)RESEARCH_ROOT_FREE,
               "steps of research have the order of its methods");

/* The functions of the scene, with what each needs of components, and what is inside of it. */
static const struct {
    void (*need)(Emitter *e);
    void (*emit)(Emitter *e);
} scene_functions[KRS_FUNCTION_COUNT] = {
    [KRS_FUNCTION_DISTANCE]            = {need_distance, emit_distance},
    [KRS_FUNCTION_PLANE_T]             = {NULL, emit_plane_t},
    [KRS_FUNCTION_PLANE_COSINE]        = {NULL, emit_plane_cosine},
    [KRS_FUNCTION_ALONG]               = {need_along, emit_along},
    [KRS_FUNCTION_STEPS]               = {need_along, emit_separate_steps},
    [KRS_FUNCTION_PROBE]               = {need_probe, emit_probe},
    [KRS_FUNCTION_DISTANCE_LOD]        = {need_lod, emit_lod},
    [KRS_FUNCTION_SCENE_PART_DISTANCE] = {need_scene_parts, emit_scene_part_distance},
    [KRS_FUNCTION_SCENE_PART_BOX]      = {NULL, emit_scene_part_box},
    [KRS_FUNCTION_GRADIENT]            = {need_gradient, emit_gradient},
    [KRS_FUNCTION_TANGENT]             = {need_tangent, emit_tangent},
    [KRS_FUNCTION_SURFACE]             = {need_surface, emit_surface},
    [KRS_FUNCTION_MEDIUM_AT]           = {need_media, emit_medium_at},
    [KRS_FUNCTION_GLASS]               = {need_media, emit_glass},
    [KRS_FUNCTION_SUBSURFACE]          = {need_subsurface, emit_subsurface},
    [KRS_FUNCTION_DENSITY]             = {NULL, emit_density},
    [KRS_FUNCTION_ALBEDO]              = {NULL, emit_albedo},
    [KRS_FUNCTION_ANISOTROPY]          = {NULL, emit_anisotropy},
    [KRS_FUNCTION_EMISSION]            = {NULL, emit_emission},
};

static void (*const component_functions[FUNCTION_KINDS])(Emitter              *e,
                                                         const ModuleFunction *function) = {
    [OF_DISTANCE] = emit_distance_of, [OF_ALONG] = emit_along_of,
    [OF_PROBE] = emit_along_of,       [OF_LOD] = emit_lod_of,
    [OF_GRADIENT] = emit_gradient_of, [OF_SURFACE] = emit_surface_of,
};

/* ---- what there is ---- */

Emitter emitter_new(const Module *module, Arena *scratch)
{
    size_t  count  = module->graph->count + 1;
    Emitter e      = {.module = module, .graph = module->graph, .scratch = scratch};
    e.operations   = arena_new_array(scratch, const char *, OP_COUNT *TYPES);
    e.text         = arena_new_array(scratch, const char *, count);
    e.frame        = arena_new_array(scratch, const char *, count);
    e.nesting      = arena_new_array(scratch, uint8_t, count);
    e.uses         = arena_new_array(scratch, uint32_t, count);
    e.excess       = arena_new_array(scratch, const char *, count);
    e.place        = arena_new_array(scratch, uint32_t, count);
    e.feeds_mirror = arena_new_array(scratch, uint8_t, count);
    e.given        = arena_new_array(scratch, const char *, count);
    e.rank         = arena_new_array(scratch, uint32_t, count);
    e.mark         = arena_new_array(scratch, uint8_t, count);
    return e;
}

/* Returns the roots of components, or of camera-relative ones. */
static const Node *surface_roots(const Emitter *e)
{
    return e->variant->camera_relative ? e->module->camera_relative : e->module->surfaces;
}

const Node *emit_planes(const Emitter *e)
{
    return e->variant->camera_relative
               ? e->module->camera_relative + e->module->components * ROOT_COUNT
               : e->module->planes;
}

bool emit_has_tangent(const Emitter *e, uint32_t component)
{
    return e->variant->tangents && emit_has_gradient(e, component) &&
           box_is_finite(e->module->boxes[component]);
}

/* Returns the roots of a surface, with the distance to the plane that has its gradient, if that is asked for. */
static const Node *tangent_roots(const Emitter *e, uint32_t component, const Node *surface)
{
    const Node *gradient = e->module->gradients + 2 * component;
    if (!emit_has_tangent(e, component))
        return surface;
    Node *roots = arena_new_array(e->scratch, Node, ROOT_COUNT);
    memcpy(roots, surface, ROOT_COUNT * sizeof *roots);
    roots[ROOT_DISTANCE] = gradient[1];
    return roots;
}

/* Returns the root of a method in a scene that was compiled with `research`. */
static const Node *research_root(const Module *module, ResearchMethod method, uint32_t component)
{
    const size_t at = method * module->components + component;
    assert(at < module->research_count);
    return module->research + at;
}

static const Node *step_root(const Emitter *e, uint32_t component)
{
    const KrsRayStep step = e->variant->step;
    return step == KRS_STEP_EXACT
               ? e->module->along + component
               : research_root(e->module, (ResearchMethod)(step - KRS_STEP_TAYLOR), component);
}

ModuleFunction emit_function(const Emitter *e, FunctionKind kind, uint32_t component)
{
    const Module *m = e->module;
    switch (kind) {
    case OF_ALONG: return (ModuleFunction){kind, component, step_root(e, component), 1};
    case OF_PROBE:
        return (ModuleFunction){kind, component, research_root(m, RESEARCH_PROBE, component), 1};
    case OF_LOD: return (ModuleFunction){kind, component, m->guarded + component, 1};
    case OF_GRADIENT: return (ModuleFunction){kind, component, m->gradients + 2 * component, 2};
    default: break;
    }
    const Node *surface = surface_roots(e) + component * ROOT_COUNT;
    return kind == OF_SURFACE
               ? (ModuleFunction){kind, component, tangent_roots(e, component, surface), ROOT_COUNT}
               : (ModuleFunction){kind, component, surface + ROOT_DISTANCE, 1};
}

Node emit_root(const Emitter *e, FunctionKind kind, uint32_t component)
{
    return *emit_function(e, kind, component).roots;
}

bool emit_is_of_group(const Emitter *e, uint32_t component)
{
    const uint32_t group = e->variant->march_group;
    return e->module->march_groups[component] == (group == KRS_MARCH_GROUP_OF_PLANES ? 0 : group);
}

bool emit_leaves_out(const Emitter *e, uint32_t component)
{
    if (e->variant->march_group > 0)
        return !emit_is_of_group(e, component);
    if (e->variant->glass == KRS_GLASS_LEFT_OUT && e->module->is_medium &&
        e->module->is_medium[component])
        return true;
    return e->variant->planes && e->module->is_plane && e->module->is_plane[component];
}

/* ---- slots ---- */

static void add_nodes(Emitter *e, NodeList *list, const Node *nodes, size_t count)
{
    for (size_t i = 0; i < count; i++)
        array_push(e->scratch, list, nodes[i]);
}

/* Adds the boxes of components or of scene parts, where they are numbers of the frame. */
static void add_boxes(Emitter *e, NodeList *list, bool around, bool parts)
{
    const size_t   count = e->module->components;
    const BoxNodes nodes = e->module->box_nodes;
    add_nodes(e, list, nodes.around, nodes.around && around ? 2 * count : 0);
    add_nodes(e, list, nodes.parts,
              nodes.parts && parts ? 2 * (size_t)module_scene_part_count(count) : 0);
}

static void lay_out(Emitter *e, NodeList *roots, StateValues *values, Arena *arena)
{
    emit_find_called(e, roots);
    emit_count_uses(e, roots->items, roots->count, false);
    state_values_assign(values, e->graph, e->needed.items, e->needed.count, arena, e->scratch);
}

void module_lay_out(Module *module, uint32_t zone_slots, Arena *arena, Arena *scratch)
{
    Emitter  e     = emitter_new(module, scratch);
    size_t   count = module->components, planes = module->is_plane ? 2 : 0;
    NodeList all = {0}, camera_relative = {0};
    add_nodes(&e, &all, module->surfaces, count * ROOT_COUNT);
    add_nodes(&e, &all, &module->zone, module->zone != NODE_NONE);
    add_nodes(&e, &all, module->volumes, module->volume_count * VOLUME_FUNCTIONS);
    add_nodes(&e, &all, module->guarded, count);
    add_nodes(&e, &all, module->along, count);
    add_nodes(&e, &all, module->research, module->research_count);
    add_nodes(&e, &all, module->planes, planes);
    add_boxes(&e, &all, true, true);
    add_nodes(&e, &all, module->gradients, module->derives ? 2 * (count + 1) : 0);
    StateSlots *slots       = &module->slots;
    slots->plain.first_slot = (uint32_t)module->graph->parameters.count;
    lay_out(&e, &all, &slots->plain, arena);
    slots->camera_relative.first_slot = slots->plain.first_slot + slots->plain.slots + zone_slots;
    if (!module->camera_relative)
        return;
    add_nodes(&e, &camera_relative, module->camera_relative,
              count * ROOT_COUNT + 2 + (module->zone != NODE_NONE));
    lay_out(&e, &camera_relative, &slots->camera_relative, arena);
}

/* ---- what is called ---- */

/* Tells whether a function that is wanted is cut by zones. */
static bool needs_cut(const Emitter *e)
{
    static const KrsFunction cut[] = {
        KRS_FUNCTION_DISTANCE,     KRS_FUNCTION_ALONG, KRS_FUNCTION_STEPS,
        KRS_FUNCTION_DISTANCE_LOD, KRS_FUNCTION_PROBE, KRS_FUNCTION_SCENE_PART_DISTANCE,
        KRS_FUNCTION_MEDIUM_AT,    KRS_FUNCTION_GLASS, KRS_FUNCTION_SUBSURFACE};
    bool needed = e->wanted[KRS_FUNCTION_SURFACE] && e->module->components > 0;
    for (size_t i = 0; i < sizeof cut / sizeof *cut; i++)
        needed = needed || e->wanted[cut[i]];
    return needed;
}

static void find_needs(Emitter *e)
{
    for (int kind = 0; kind < FUNCTION_KINDS; kind++)
        e->needed_of[kind] = arena_new_array(e->scratch, bool, e->module->components + 1);
    for (int f = 0; f < KRS_FUNCTION_COUNT; f++)
        if (e->wanted[f] && scene_functions[f].need)
            scene_functions[f].need(e);
}

/* Adds the boxes around components whose planes are kept from overflow. */
static void add_kept_boxes(Emitter *e, NodeList *list)
{
    const Node *nodes = e->module->box_nodes.around;
    for (uint32_t i = 0; nodes && i < e->module->components; i++)
        if ((e->needed_of[OF_SURFACE][i] && emit_has_tangent(e, i)) || emit_keeps_plane(e, i))
            add_nodes(e, list, nodes + (size_t)2 * i, 2);
}

/* Gathers the roots of all functions. */
static NodeList gather_roots(Emitter *e)
{
    NodeList roots = {0};
    for (FunctionKind kind = 0; kind < FUNCTION_KINDS; kind++)
        for (uint32_t i = 0; i < e->module->components; i++)
            if (e->needed_of[kind][i]) {
                ModuleFunction function = emit_function(e, kind, i);
                add_nodes(e, &roots, function.roots, function.root_count);
            }
    const Node zone = emit_zone(e);
    add_nodes(e, &roots, &zone, zone != NODE_NONE && e->cuts);
    add_nodes(e, &roots, e->module->gradients + 2 * e->module->components,
              zone != NODE_NONE && emit_wants_gradient(e) ? 2 : 0);
    for (uint32_t i = 0; i < e->module->volume_count * VOLUME_FUNCTIONS; i++)
        add_nodes(e, &roots, e->module->volumes + i, emit_wants_volume(e, i % VOLUME_FUNCTIONS));
    add_boxes(e, &roots, e->wanted[KRS_FUNCTION_DISTANCE_LOD],
              e->wanted[KRS_FUNCTION_SCENE_PART_BOX] && !e->variant->camera_relative);
    add_kept_boxes(e, &roots);
    add_nodes(e, &roots, emit_planes(e), e->wanted[KRS_FUNCTION_PLANE_T]);
    add_nodes(e, &roots, emit_planes(e) + 1, e->wanted[KRS_FUNCTION_PLANE_COSINE]);
    emit_find_called(e, &roots);
    return roots;
}

/* ---- text ---- */

static void emit_functions(Emitter *e)
{
    static const char *const sines[] = {"krs_sin", "krs_cos", "krs_tan"};
    emit_instances(e);
    emit_zones(e);
    emit_volumes(e);
    for (FunctionKind kind = 0; kind < FUNCTION_KINDS; kind++)
        for (uint32_t i = 0; i < e->module->components; i++)
            if (e->needed_of[kind][i]) {
                ModuleFunction function = emit_function(e, kind, i);
                component_functions[kind](e, &function);
            }
    for (int f = 0; f < KRS_FUNCTION_COUNT; f++) {
        if (!e->wanted[f] || !scene_functions[f].emit)
            continue;
        emit_head(e, (KrsFunction)f);
        scene_functions[f].emit(e);
        text_add(e->out, "}\n\n");
    }
    for (size_t i = 0; e->wanted[KRS_FUNCTION_SINES] && i < sizeof sines / sizeof *sines; i++)
        emit_call(e, sines[i], TYPE_FLOAT, 1);
    if (e->wanted[KRS_FUNCTION_ARCS])
        emit_call(e, "krs_atan2", TYPE_FLOAT, 2);
}

static void emit_about_textures(Emitter *e)
{
    text_add(e->out,
             "// Textures are in krs_cells, two words each (RG32UI), and equal in all frames:\n"
             "// krs_state_tables in krs.h.\n");
}

static void emit_about_tables(Emitter *e)
{
    bool vary = instances_vary(e->graph->instances);
    text_add(
        e->out,
        "// Parts that are alike are rows of krs_rows, four floats each (RGBA32F).  krs_cells,\n"
        "// two words each (RG32UI), says which of them are near a point.  ");
    text_add(e->out, vary ? "Both are\n// found for each frame: krs_state_tables in krs.h.\n"
                          : "Both are\n// equal in all frames: krs_state_tables in krs.h.\n");
    text_add(e->out,
             "// Far from all of them krs_distance may be less than the distance, never more.\n");
}

/* Emits the parameter block. */
static void emit_block(Emitter *e)
{
    const KrsVariant *v     = e->variant;
    uint32_t          slots = emit_slot_count(e);
    text_add(e->out, "// Distance code of a scene; "
                     "slot 0 holds the time, then one slot for each `param`.\n");
    if (e->module->has_slopes)
        text_add(e->out, "// Behind them slopes that the host finds for each frame: "
                         "krs_state_parameters in krs.h.\n");
    if (v->values && e->module->slots.plain.slots > 0)
        text_format(e->out,
                    "// %u more slots hold what else depends on the frame alone: "
                    "krs_state_values in krs.h.\n",
                    e->module->slots.plain.slots);
    if (v->zones > 0)
        text_format(e->out, "// %u hold zones: center and radius.\n", v->zones);
    if (v->camera_relative)
        text_add(e->out,
                 "// Points are relative to an origin near them, of which the last slots tell.\n");
    if (emit_reads_tables(e))
        emit_about_tables(e);
    if (emit_reads_textures(e))
        emit_about_textures(e);
    emit_template(e, TEMPLATE_PARAMETER_BLOCK, (Operands){emit_count(e, slots)});
    if (emit_reads_zones(e))
        emit_template(e, TEMPLATE_ZONES, (Operands){emit_count(e, v->zones)});
    if (emit_reads_tables(e))
        emit_template(e, v->buffers ? TEMPLATE_BUFFER_TABLES : TEMPLATE_TEXEL_TABLES,
                      (Operands){0});
    else if (emit_reads_textures(e))
        emit_template(e, v->buffers ? TEMPLATE_BUFFER_CELLS : TEMPLATE_TEXEL_CELLS, (Operands){0});
    if (emit_reads_tables(e))
        emit_template(e, TEMPLATE_TABLES, (Operands){0});
    if (emit_reads_textures(e))
        emit_template(e, TEMPLATE_TEXTURES, (Operands){0});
}

/* Emits prototypes of the entry points, which may then be called in any order. */
static void emit_entry_points(Emitter *e)
{
    if (e->wanted[KRS_FUNCTION_SURFACE])
        emit_struct(e);
    emit_media_globals(e);
    emit_prepare_entry_point(e);
    for (int f = 0; f < KRS_FUNCTION_COUNT; f++)
        if (e->wanted[f])
            emit_entry_point(e, (KrsFunction)f);
    if (e->wanted[KRS_FUNCTION_SCENE_PART_DISTANCE]) {
        uint32_t parts = module_scene_part_count(e->module->components);
        emit_template(e, TEMPLATE_CONSTANT_UINT,
                      (Operands){"KRS_SCENE_PARTS", emit_count(e, parts)});
    }
}

void module_print(const Module *module, const KrsVariant *variant, const KrsFunction *wanted,
                  size_t count, const Printer *printer, Text *out)
{
    const Printer whole   = printer_with_base(printer, out->arena);
    Emitter       e       = emitter_new(module, out->arena);
    Text          prepare = {.arena = out->arena}, functions = prepare;
    e.variant           = variant;
    e.printer           = &whole;
    e.helper_text.arena = out->arena;
    for (size_t i = 0; i < count; i++)
        e.wanted[wanted[i]] = true;
    e.cuts = (variant->zones > 0 || module->zone != NODE_NONE) && needs_cut(&e);
    helpers_read(&e);
    find_needs(&e);
    NodeList roots = gather_roots(&e);
    e.out          = &prepare;
    emit_prepare(&e, roots.items, roots.count,
                 variant->camera_relative ? &module->slots.camera_relative : &module->slots.plain);
    e.out = &functions;
    emit_functions(&e);
    e.out = out;
    emit_block(&e);
    emit_entry_points(&e);
    text_add_bytes(out, e.helper_text.bytes, e.helper_text.length);
    text_add_bytes(out, prepare.bytes, prepare.length);
    text_add_bytes(out, functions.bytes, functions.length);
}

uint64_t krs_variant_hash(const KrsVariant *variant, const KrsFunction *wanted, size_t count)
{
    const uint64_t numbers[] = {variant->zones,  variant->march_group,     variant->step,
                                variant->planes, variant->camera_relative, variant->many_threads,
                                variant->values, variant->shares,          variant->buffers,
                                variant->glass,  variant->tangents,        variant->gathers_noises};
    uint64_t       set = 0, h = 0xcbf29ce484222325u; /* FNV-1a */
    for (size_t i = 0; i < count; i++)
        set |= (uint64_t)1 << wanted[i];
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        h = (h ^ numbers[i]) * 0x100000001b3u;
    return (h ^ set) * 0x100000001b3u;
}
