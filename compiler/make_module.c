/*
 * make_module.c: what texts are printed from, and how long they are.
 */
#include <string.h>

#include "compiler/compilation.h"

/* `boxes` of all components, and which of them are `flat`; the program gets the box of the rest. */
static void find_rest(Compilation *c, Box *boxes, bool *flat)
{
    KrsProgram *program = &c->scene->program;
    Box         rest    = box_empty;
    for (size_t i = 0; i < c->scene->component_count; i++) {
        const Component *component = &c->elaborated.components.items[i];
        boxes[i]                   = component->shape->box;
        flat[i]                    = component_is_plane(component);
        rest                       = flat[i] ? rest : box_hull(rest, boxes[i]);
    }
    for (int k = 0; k < 3; k++) {
        program->rest_low[k]  = box_is_empty(rest) ? 0 : rest.axis[k].low;
        program->rest_high[k] = box_is_empty(rest) ? 0 : rest.axis[k].high;
    }
}

/* Names and lines of the texts that nodes come from, names alone of the library's; the texts go. */
static Sources keep_lines(const Sources *from, const Graph *graph, Arena *arena)
{
    Sources kept = {.arena = arena, .count = from->count};
    kept.items   = arena_new_array(arena, Source, from->count + 1);
    for (Node n = 0; n < graph->count; n++) {
        uint32_t      number = graph->items[n].span.source;
        const Source *source = &from->items[number];
        Source       *copy   = &kept.items[number];
        if (number == 0 || copy->name)
            continue;
        copy->name    = arena_copy_text(arena, source->name, strlen(source->name));
        copy->library = source->library;
        if (source->library)
            continue;
        copy->line_count = source->line_count;
        copy->lines      = arena_new_array(arena, uint32_t, source->line_count);
        memcpy(copy->lines, source->lines, source->line_count * sizeof *copy->lines);
    }
    return kept;
}

/* What is promised, for graphics cards. */
static Text print_promised(Compilation *c, bool shares)
{
    KrsScene        *scene = c->scene;
    const KrsVariant cards = {.many_threads = true, .shares = shares};
    KrsFunction      promised[KRS_MOST_PROMISED];
    size_t           count = krs_promised_functions(scene, cards.many_threads, promised);
    Text             glsl  = {.arena = &c->scratch};
    module_print(&scene->module, &cards, promised, count, &glsl_printer, &glsl);
    return glsl;
}

void make_module(Compilation *c)
{
    KrsScene    *scene   = c->scene;
    KrsProgram  *program = &scene->program;
    const Roots *roots   = &scene->roots;
    Arena       *arena   = &scene->arena;
    size_t       count   = scene->component_count;
    Box         *boxes   = arena_new_array(arena, Box, count + 1);
    bool        *flat    = arena_new_array(arena, bool, count + 1);
    uint32_t    *groups  = arena_new_array(arena, uint32_t, count + 1);
    find_rest(c, boxes, flat);
    form_march_groups(c, groups);
    scene->module = (Module){.graph           = scene->graph,
                             .sources         = keep_lines(&c->sources, scene->graph, arena),
                             .components      = count,
                             .surfaces        = roots->components,
                             .guarded         = roots->guarded,
                             .along           = roots->along,
                             .gradients       = roots->gradients,
                             .zone            = zone_root(scene),
                             .planes          = roots->planes,
                             .camera_relative = program->camera_relative ? roots->camera_relative
                                                                         : NULL,
                             .boxes           = boxes,
                             .march_groups    = program->march_group_count ? groups : NULL,
                             .is_plane        = program->planes ? flat : NULL,
                             .has_slopes      = scene->slope_count > 0,
                             .derives         = program->gradients};
    module_lay_out(&scene->module, KRS_MOST_ZONES, arena, &c->scratch);
    program->scene_parts           = module_scene_part_count(count);
    program->parameter_slots       = (uint32_t)scene->graph->parameters.count;
    program->value_slots           = scene->module.slots.plain.slots;
    program->camera_relative_slots = scene->module.slots.camera_relative.slots;
    program->glsl_length           = print_promised(c, false).length;
    if (c->request->stage == DUMP_GLSL)
        text_add(&c->dump, print_promised(c, true).bytes);
}
