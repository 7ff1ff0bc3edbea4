/*
 * make_module.c: the pass `emit`: makes the module from which texts are printed.
 */
#include <string.h>

#include "compiler/passes/compilation.h"

/* Copies the names and the offsets of lines of the sources that nodes come from, without their
   texts.  Of the library's sources only names are copied. */
static Sources retain_lines(const Sources *from, const Graph *graph, Arena *arena)
{
    Sources retained = {.arena = arena, .count = from->count};
    retained.items   = arena_new_array(arena, Source, from->count + 1);
    for (Node n = 0; n < graph->count; n++) {
        uint32_t      number = graph->items[n].span.source;
        const Source *source = &from->items[number];
        Source       *copy   = &retained.items[number];
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
    return retained;
}

/* Returns the text of the entry points (krs_entry_points) for graphics cards. */
static Text print_entry_points(Compilation *c, bool shares)
{
    KrsScene        *scene = c->scene;
    const KrsVariant cards = {.many_threads = true,
                              .shares       = shares,
                              .values       = c->options->specialize == KRS_SPECIALIZE_STRUCTURE};
    KrsFunction      entry_points[KRS_MAX_ENTRY_POINTS];
    size_t           count = krs_entry_points(scene, cards.many_threads, entry_points);
    Text             glsl  = {.arena = &c->scratch};
    module_print(&scene->module, &cards, entry_points, count, &glsl_printer, &glsl);
    return glsl;
}

KrsStatus pass_emit(Compilation *c)
{
    KrsScene    *scene    = c->scene;
    KrsProgram  *program  = &scene->program;
    const Roots *roots    = &scene->roots;
    Arena       *arena    = &scene->arena;
    size_t       count    = scene->component_count;
    Box         *boxes    = arena_new_array(arena, Box, count + 1);
    bool        *is_plane = arena_new_array(arena, bool, count + 1);
    for (size_t i = 0; i < count; i++) {
        boxes[i]    = c->elaborated.components.items[i].shape->box;
        is_plane[i] = component_is_plane(&c->elaborated.components.items[i]);
    }
    scene->module = (Module){.graph           = scene->graph,
                             .sources         = retain_lines(&c->sources, scene->graph, arena),
                             .components      = count,
                             .surfaces        = roots_of(roots, ROOTS_SURFACE).items,
                             .guarded         = roots_of(roots, ROOTS_GUARDED).items,
                             .along           = roots_of(roots, ROOTS_ALONG).items,
                             .research        = roots_of(roots, ROOTS_RESEARCH).items,
                             .research_count  = roots_of(roots, ROOTS_RESEARCH).count,
                             .gradients       = roots_of(roots, ROOTS_GRADIENT).items,
                             .zone            = zone_root(scene),
                             .volumes         = roots_of(roots, ROOTS_VOLUME).items,
                             .volume_count    = scene->volume_count,
                             .planes          = roots_of(roots, ROOTS_PLANE).items,
                             .camera_relative = program->camera_relative
                                                    ? roots_of(roots, ROOTS_CAMERA_RELATIVE).items
                                                    : NULL,
                             .boxes           = boxes,
                             .box_nodes       = c->box_nodes,
                             .mirror_nodes    = c->mirror_nodes,
                             .march_groups    = program->march_group_count ? c->march_groups : NULL,
                             .is_plane        = program->planes ? is_plane : NULL,
                             .is_medium       = program->media ? c->is_medium : NULL,
                             .is_subsurface   = program->subsurface ? c->is_subsurface : NULL,
                             .has_slopes      = scene->slope_count > 0,
                             .derives         = program->gradients};
    module_lay_out(&scene->module, KRS_MAX_ZONES, arena, &c->scratch);
    program->value_slots           = scene->module.slots.plain.slots;
    program->camera_relative_slots = scene->module.slots.camera_relative.slots;
    if (c->of_shaders.count == 0)
        program->glsl_length = print_entry_points(c, false).length;
    return KRS_OK;
}

void print_emit(Compilation *c, Text *out) { text_add(out, print_entry_points(c, true).bytes); }
