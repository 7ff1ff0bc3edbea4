/*
 * retain.c: what stays of a scene when it has been compiled.
 *
 * The elaborated scene, its shapes and their names go with the memory of the run; the program, its
 * tapes and what callers may ask (program.c) are copied into the scene's own.
 */
#include <string.h>

#include "compiler/compilation.h"

static const char *retain_text(Compilation *c, const char *text)
{
    return text ? arena_copy_text(&c->scene->arena, text, strlen(text)) : NULL;
}

static void retain_components(Compilation *c)
{
    KrsScene    *scene     = c->scene;
    const Scene *s         = &c->elaborated;
    scene->component_count = s->components.count;
    scene->components      = arena_new_array(&scene->arena, KrsComponent, s->components.count + 1);
    scene->bounds          = arena_new_array(&scene->arena, KrsBounds, s->components.count + 1);
    scene->program.plain   = true;
    for (size_t i = 0; i < s->components.count; i++) {
        const Component *from = &s->components.items[i];
        KrsComponent    *to   = &scene->components[i];
        *to                   = (KrsComponent){.name       = retain_text(c, from->name),
                                               .slope      = from->shape->slope * from->shape->derived,
                                               .per_frame  = from->shape->per_frame,
                                               .exact      = from->shape->exact,
                                               .estimate   = from->shape->estimate,
                                               .levels     = from->shape->levels,
                                               .instances  = from->shape->instances,
                                               .inversions = from->shape->inversions};
        for (int k = 0; k < 3; k++) {
            to->low[k]  = from->shape->box.axis[k].low;
            to->high[k] = from->shape->box.axis[k].high;
        }
        scene->program.plain = scene->program.plain && !shape_is_curved(from->shape);
        bounds_of(from->shape, &c->sources, &scene->bounds[i], &scene->arena, &c->scratch);
        arena_free(&c->scratch);
    }
}

/* Shapes that were cut again leave slopes behind that nothing is divided by. */
static bool is_needed(const Graph *graph, uint32_t slot)
{
    for (Node n = 0; n < graph->count; n++)
        if (graph->items[n].op == OP_PARAMETER && graph->items[n].index == slot)
            return true;
    return false;
}

static void retain_slopes(Compilation *c)
{
    KrsScene    *scene = c->scene;
    const Scene *s     = &c->elaborated;
    scene->slopes      = arena_new_array(&scene->arena, RetainedSlope, s->slopes.count + 1);
    for (size_t i = 0; i < s->slopes.count; i++) {
        const FrameSlope *from = &s->slopes.items[i];
        if (!is_needed(scene->graph, from->slot))
            continue;
        const Source *source   = &c->sources.items[from->span.source];
        Position      position = source_position(source, from->span.start);
        Text          place    = {.arena = &scene->arena};
        text_format(&place, "%s:%u:%u", source->name, position.line, position.column);
        scene->slopes[scene->slope_count++] = (RetainedSlope){
            from->slot,
            slope_task(scene->graph, scene->roots.slopes[i], from->region,
                       frame_slope_cells(from->region), &scene->arena),
            place.bytes};
    }
}

void retain_scene(Compilation *c)
{
    KrsScene    *scene = c->scene;
    const Scene *s     = &c->elaborated;
    Arena       *arena = &scene->arena;
    retain_components(c);
    retain_slopes(c);
    scene->parameter_count = s->parameters.count;
    scene->parameters      = arena_new_array(arena, Parameter, s->parameters.count + 1);
    for (size_t i = 0; i < s->parameters.count; i++) {
        scene->parameters[i]      = s->parameters.items[i];
        scene->parameters[i].name = retain_text(c, s->parameters.items[i].name);
    }
    scene->camera_count = s->cameras.count;
    scene->cameras      = arena_new_array(arena, SceneCamera, s->cameras.count + 1);
    for (size_t i = 0; i < s->cameras.count; i++) {
        scene->cameras[i]      = s->cameras.items[i];
        scene->cameras[i].name = retain_text(c, s->cameras.items[i].name);
    }
    scene->light_count = s->lights.count;
    scene->lights      = arena_new_array(arena, SceneLight, s->lights.count + 1);
    memcpy(scene->lights, s->lights.items, s->lights.count * sizeof *scene->lights);
    for (size_t i = 0; i < s->lights.count; i++)
        scene->program.shadows = scene->program.shadows || s->lights.items[i].shadow;
    scene->zone_count       = s->zone_count;
    scene->image            = s->image;
    scene->image.integrator = retain_text(c, s->image.integrator);
    scene->image.tone_map   = retain_text(c, s->image.tone_map);
    for (int k = 0; k < 3; k++) {
        scene->program.low[k]  = s->box.axis[k].low;
        scene->program.high[k] = s->box.axis[k].high;
    }
}

/* Of which components there are steps along rays, and which of those are for inversions. */
static void find_steps(KrsScene *scene, const Node *distances)
{
    const Node *polynomial  = scene->roots.along;
    const Node *directional = polynomial + ALONG_DIRECTIONAL * scene->component_count;
    for (size_t i = 0; i < scene->component_count; i++) {
        scene->program.along   = scene->program.along || polynomial[i] != distances[i];
        scene->program.inverts = scene->program.inverts || directional[i] != distances[i];
    }
}

void retain_tapes(Compilation *c)
{
    KrsScene    *scene     = c->scene;
    const Roots *roots     = &scene->roots;
    size_t       count     = scene->component_count;
    Node        *distances = arena_new_array(&c->scratch, Node, count + 1);
    Node        *guarded   = arena_new_array(&c->scratch, Node, count + 1);
    for (size_t i = 0; i < count; i++)
        distances[i] = roots->components[i * ROOT_COUNT + ROOT_DISTANCE];
    find_steps(scene, distances);
    memcpy(guarded, roots->guarded, count * sizeof *guarded);
    if (scene->zone_count > 0)
        guarded[count] = distances[count] = zone_root(scene);
    count += scene->zone_count > 0;
    scene->guarded  = tape_new_guarded(scene->graph, guarded, count, &scene->arena);
    scene->distance = tape_new(scene->graph, distances, count, &scene->arena);
    if (scene->program.sheets) {
        memcpy(guarded, roots->along + ALONG_EXACT * scene->component_count,
               scene->component_count * sizeof *guarded);
        scene->ahead  = tape_new(scene->graph, guarded, count, &scene->arena);
        scene->turned = tape_new(scene->graph, roots->gradients,
                                 scene->component_count * GRADIENT_ROOTS, &scene->arena);
    }
    scene->surface = tape_new(scene->graph, roots->components,
                              (size_t)(roots->cameras - roots->components), &scene->arena);
    scene->view = tape_new(scene->graph, roots->cameras, (size_t)(roots->guarded - roots->cameras),
                           &scene->arena);
    scene->program.operations = scene->distance.count - scene->distance.frame_count;
    scene->program.flops      = tape_flops(&scene->distance);
    scene->program.loops      = tape_loops(&scene->distance);
}
