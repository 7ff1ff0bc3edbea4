/*
 * retain.c: copies what a compiled scene needs.
 *
 * The elaborated scene, its shapes and their names are freed at the end of the run.  The tapes, and
 * the answers that program.c gives, are copied into the arena of the compiled scene.
 */
#include <string.h>

#include "compiler/passes/compilation.h"
#include "compiler/graph/instance_table.h"

static const char *retain_text(Compilation *c, const char *text)
{
    return text ? arena_copy_text(&c->scene->arena, text, strlen(text)) : NULL;
}

/* Returns where the author's texts have something; zeros for what a text of the library has.  Mostly it
   is in the same text as the location `before`, which may be NULL. */
static KrsLocation retain_location(Compilation *c, Span span, const KrsLocation *before)
{
    const Source *source = &c->sources.items[span.source];
    if (span.source == 0 || source->library)
        return (KrsLocation){0};
    const bool same     = before && before->source && !strcmp(before->source, source->name);
    Position   position = source_position(source, span.start);
    return (KrsLocation){same ? before->source : retain_text(c, source->name), span.start, span.end,
                         position.line, position.column};
}

static void retain_components(Compilation *c)
{
    KrsScene    *scene     = c->scene;
    const Scene *s         = &c->elaborated;
    scene->component_count = s->components.count;
    scene->shown_count     = s->shown.count;
    scene->components      = arena_new_array(&scene->arena, KrsComponent, s->shown.count + 1);
    scene->bounds          = arena_new_array(&scene->arena, KrsBounds, s->shown.count + 1);
    for (size_t i = 0; i < s->shown.count; i++) {
        const Component *from = &s->shown.items[i];
        KrsComponent    *to   = &scene->components[i];
        *to                   = (KrsComponent){.name       = retain_text(c, from->name),
                                               .slope      = from->shape->slope * from->shape->derived,
                                               .per_state  = from->shape->per_frame,
                                               .exact      = from->shape->exact,
                                               .estimate   = from->shape->estimate,
                                               .figure     = from->figure,
                                               .levels     = from->shape->levels,
                                               .instances  = from->shape->instances,
                                               .inversions = from->shape->inversions};
        to->location          = retain_location(c, from->span, i ? &to[-1].location : NULL);
        for (int k = 0; k < 3; k++) {
            to->low[k]  = from->shape->box.axis[k].low;
            to->high[k] = from->shape->box.axis[k].high;
        }
        scene->bounds[i] = bounds_of(from->shape, &c->sources, i ? &scene->bounds[i - 1] : NULL,
                                     &scene->arena, &c->scratch);
        arena_free(&c->scratch);
    }
}

static void retain_lowered(Compilation *c)
{
    KrsScene    *scene = c->scene;
    const Scene *s     = &c->elaborated;
    scene->lowered     = arena_new_array(&scene->arena, size_t, s->shown.count + 1);
    scene->rank        = arena_new_array(&scene->arena, size_t, s->shown.count + 1);
    for (size_t i = 0; i < s->shown.count; i++) {
        scene->lowered[i] = s->shown.items[i].lowered;
        scene->rank[i]    = s->shown.items[i].rank;
    }
}

/* Tells whether the graph uses a slope.  Those of shapes that were later cut to a smaller region may be
   unused. */
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
        const StateSlope *from = &s->slopes.items[i];
        if (!is_needed(scene->graph, from->slot))
            continue;
        const Source *source   = &c->sources.items[from->span.source];
        Position      position = source_position(source, from->span.start);
        Text          place    = {.arena = &scene->arena};
        text_format(&place, "%s:%u:%u", source->name, position.line, position.column);
        scene->slopes[scene->slope_count++] = (RetainedSlope){
            from->slot,
            slope_task(scene->graph, roots_of(&scene->roots, ROOTS_SLOPE).items[i], from->region,
                       state_slope_cells(from->region), &scene->arena),
            place.bytes};
    }
}

static void retain_boxes(Compilation *c)
{
    KrsScene    *scene      = c->scene;
    const Scene *s          = &c->elaborated;
    scene->boxes            = box_plan_copy(&s->boxes, &scene->arena);
    scene->floor            = s->floor;
    scene->floor.eyes.items = arena_new_array(&scene->arena, PlannedNumber,
                                              s->floor.eyes.count + 1);
    for (size_t i = 0; i < s->floor.eyes.count; i++)
        scene->floor.eyes.items[i] = s->floor.eyes.items[i];
}

static RetainedPlace retain_place(Compilation *c, Span span)
{
    const Source *source = &c->sources.items[span.source];
    return (RetainedPlace){retain_text(c, source->name), source_position(source, span.start)};
}

static void retain_parameters(Compilation *c)
{
    KrsScene         *scene = c->scene;
    Arena            *arena = &scene->arena;
    const Parameters *from  = &c->elaborated.parameters;
    scene->parameter_count  = from->count;
    scene->parameters       = arena_new_array(arena, Parameter, from->count + 1);
    scene->parameter_places = arena_new_array(arena, RetainedPlace, from->count + 1);
    for (size_t i = 0; i < from->count; i++) {
        Parameter *to              = &scene->parameters[i];
        *to                        = from->items[i];
        to->name                   = retain_text(c, to->name);
        to->doc                    = retain_text(c, to->doc);
        scene->parameter_places[i] = retain_place(c, to->name_span);
    }
}

/* Returns how many lowered components are shown before this one. */
static uint32_t components_before(const Scene *s, size_t shown)
{
    uint32_t count = 0;
    for (size_t i = 0; i < s->components.count; i++)
        count += s->components.items[i].first < shown;
    return count;
}

static void retain_volumes(Compilation *c)
{
    KrsScene    *scene  = c->scene;
    const Scene *s      = &c->elaborated;
    scene->volume_count = s->volumes.count;
    scene->volumes      = arena_new_array(&scene->arena, RetainedVolume, s->volumes.count + 1);
    for (size_t i = 0; i < s->volumes.count; i++) {
        const SceneVolume *from = &s->volumes.items[i];
        scene->volumes[i] = (RetainedVolume){from->within->box, components_before(s, from->before),
                                             retain_place(c, from->span)};
    }
}

static void retain_scene(Compilation *c)
{
    KrsScene    *scene = c->scene;
    const Scene *s     = &c->elaborated;
    Arena       *arena = &scene->arena;
    retain_components(c);
    retain_lowered(c);
    retain_slopes(c);
    retain_boxes(c);
    retain_parameters(c);
    retain_volumes(c);
    scene->camera_count  = s->cameras.count;
    scene->cameras       = arena_new_array(arena, SceneCamera, s->cameras.count + 1);
    scene->camera_places = arena_new_array(arena, RetainedPlace, s->cameras.count + 1);
    for (size_t i = 0; i < s->cameras.count; i++) {
        scene->cameras[i]      = s->cameras.items[i];
        scene->cameras[i].name = retain_text(c, s->cameras.items[i].name);
        if (!s->cameras.items[i].standing_in)
            scene->camera_places[i] = retain_place(c, s->cameras.items[i].block);
    }
    scene->material_count = s->materials.count;
    scene->materials      = arena_new_array(arena, const char *, s->materials.count + 1);
    for (size_t i = 0; i < s->materials.count; i++)
        scene->materials[i] = retain_text(c, s->materials.items[i]);
    scene->light_count = s->lights.count;
    scene->lights      = arena_new_array(arena, SceneLight, s->lights.count + 1);
    for (size_t i = 0; i < s->lights.count; i++) {
        scene->lights[i]      = s->lights.items[i];
        scene->lights[i].name = retain_text(c, s->lights.items[i].name);
    }
    scene->sky_map            = s->sky.map;
    scene->daylight           = s->sky.daylight;
    scene->daylight_by        = s->sky.light;
    scene->zone_count         = s->zone_count;
    scene->image              = s->image;
    scene->image.integrator   = retain_text(c, s->image.integrator);
    scene->image.tone_map     = retain_text(c, s->image.tone_map);
    scene->image.pixel_filter = retain_text(c, s->image.pixel_filter);
}

/* Returns a tape of one root of each component and, behind them, that of the zones. */
static Tape tape_with_zones(const KrsScene *scene, const Node *roots, bool guarded, Arena *arena,
                            Arena *scratch)
{
    size_t count = scene->component_count;
    Node   zone = zone_root(scene), *all = arena_new_array(scratch, Node, count + 1);
    memcpy(all, roots, count * sizeof *all);
    if (zone != NODE_NONE)
        all[count++] = zone;
    return guarded ? tape_new_guarded(scene->graph, all, count, arena)
                   : tape_new(scene->graph, all, count, arena);
}

static Tape tape_of(const KrsScene *scene, RootRange roots, Arena *arena)
{
    return tape_new(scene->graph, roots.items, roots.count, arena);
}

static void retain_tapes(Compilation *c)
{
    KrsScene    *scene     = c->scene;
    Arena       *arena     = &scene->arena;
    const Roots *roots     = &scene->roots;
    Node        *distances = arena_new_array(&c->scratch, Node, scene->component_count + 1);
    for (size_t i = 0; i < scene->component_count; i++)
        distances[i] = distance_root(roots, i);
    scene->guarded  = tape_with_zones(scene, roots_of(roots, ROOTS_GUARDED).items, true, arena,
                                      &c->scratch);
    scene->distance = tape_with_zones(scene, distances, false, arena, &c->scratch);
    if (c->additions.open_surfaces) {
        RootRange gradients = roots_of(roots, ROOTS_GRADIENT);
        gradients.count     = scene->component_count * NODES_OF(GradientRoots);
        scene->ahead     = tape_with_zones(scene, roots_of(roots, ROOTS_ALONG).items, false, arena,
                                           &c->scratch);
        scene->gradients = tape_of(scene, gradients, arena);
    }
    scene->surface = tape_of(scene, roots_from(roots, ROOTS_SURFACE, ROOTS_ZONE), arena);
    if (scene->assembly.items.count > 0)
        scene->assembly.tape = tape_of(scene, roots_of(roots, ROOTS_ASSEMBLY), arena);
    scene->volumes_tape = tape_of(scene, roots_of(roots, ROOTS_VOLUME), arena);
    scene->places       = tape_of(scene, roots_of(roots, ROOTS_PLACE), arena);
    scene->box_numbers  = tape_of(scene, roots_of(roots, ROOTS_BOX), arena);
    scene->view         = tape_of(scene, roots_from(roots, ROOTS_CAMERA, ROOTS_SKY), arena);

    const Instances *instances = scene->graph->instances;
    if (instances)
        scene->rows = tape_new(scene->graph, instances->frame_numbers.items,
                               instances->frame_numbers.count, arena);
}

/* Gathers the nodes of the frame that any tape has, so that they are run once for all tapes.  They are in
   the order of their numbers, since operands have smaller ones. */
static void retain_frame(Compilation *c)
{
    KrsScene         *scene   = c->scene;
    const Graph      *graph   = scene->graph;
    const Tape *const tapes[] = {&scene->distance,     &scene->guarded, &scene->ahead,
                                 &scene->gradients,    &scene->surface, &scene->places,
                                 &scene->volumes_tape, &scene->view,    &scene->rows,
                                 &scene->assembly.tape};
    bool             *needed  = arena_new_array(&c->scratch, bool, graph->count);
    size_t            count   = 0;
    for (size_t t = 0; t < sizeof tapes / sizeof *tapes; t++)
        for (size_t i = 0; i < tapes[t]->frame_count; i++)
            needed[tapes[t]->nodes[i]] = true;
    for (Node n = 0; n < graph->count; n++)
        count += needed[n];
    Node *nodes  = arena_new_array(&scene->arena, Node, count + 1);
    scene->frame = (Tape){.graph = graph, .nodes = nodes, .count = count, .frame_count = count};
    for (Node n = 0; n < graph->count; n++)
        if (needed[n])
            *nodes++ = n;
}

/* Keeps the options for updates of the scene. */
static void retain_options(Compilation *c)
{
    c->scene->name         = retain_text(c, c->name);
    c->scene->options      = *c->options;
    c->scene->options.root = retain_text(c, c->options->root);
    if (c->options->without) {
        KrsLocation *without      = arena_new(&c->scene->arena, KrsLocation);
        *without                  = *c->options->without;
        without->source           = retain_text(c, without->source);
        c->scene->options.without = without;
    }
}

KrsStatus pass_retain(Compilation *c)
{
    retain_options(c);
    sources_hash(&c->sources, c->scene->hash);
    retain_scene(c);
    retain_tapes(c);
    retain_frame(c);
    retain_emissive(c);
    return KRS_OK;
}

static void print_tape(const char *name, const Tape *tape, Text *out)
{
    text_format(out, "tape %s  %zu nodes, %zu of the frame\n", name, tape->count,
                tape->frame_count);
}

void print_retain(Compilation *c, Text *out)
{
    const KrsScene *scene = c->scene;
    text_format(out, "hash %s\ngraph  %zu nodes\nroots  %zu\n", scene->hash, scene->graph->count,
                scene->roots.first[ROOT_KINDS]);
    text_format(out, "components %zu\nparameters %zu\nslopes %zu\ncameras %zu\nlights %zu\n",
                scene->component_count, scene->parameter_count, scene->slope_count,
                scene->camera_count, scene->light_count);
    print_tape("distance", &scene->distance, out);
    print_tape("guarded", &scene->guarded, out);
    print_tape("ahead", &scene->ahead, out);
    print_tape("gradients", &scene->gradients, out);
    print_tape("surface", &scene->surface, out);
    print_tape("view", &scene->view, out);
}
