/*
 * program.c: the properties of a compiled scene, and scene_free.
 */
#include "compiler/scene/program.h"

#include <stdlib.h>
#include <string.h>

#include "compiler/scene/tables.h"

const KrsProgram *krs_scene_program(const KrsScene *scene) { return &scene->program; }

const KrsDiagnostic *krs_scene_too_large(const KrsScene *scene) { return scene->too_large; }

bool krs_scene_is_panoramic(const KrsScene *scene)
{
    bool panoramic = false;
    for (size_t i = 0; i < scene->camera_count; i++)
        panoramic = panoramic || scene->cameras[i].projection == KRS_PANORAMA;
    return panoramic;
}
bool krs_scene_has_lens(const KrsScene *scene)
{
    bool lens = false;
    for (size_t i = 0; i < scene->camera_count; i++)
        lens = lens || scene->cameras[i].lens;
    return lens;
}
size_t      krs_camera_count(const KrsScene *scene) { return scene->camera_count; }
size_t      krs_material_count(const KrsScene *scene) { return scene->material_count; }
size_t      krs_light_count(const KrsScene *scene) { return scene->light_count; }
size_t      krs_zone_count(const KrsScene *scene) { return scene->zone_count; }
const char *krs_scene_hash(const KrsScene *scene) { return scene->hash; }
size_t      krs_parameter_count(const KrsScene *scene) { return scene->parameter_count; }
size_t      krs_parameter_slots(const KrsScene *scene) { return scene->program.parameter_slots; }
size_t      krs_value_slots(const KrsScene *scene) { return scene->program.value_slots; }
size_t      krs_table_rows(const KrsScene *scene) { return scene->program.table_rows; }
size_t      krs_table_cells(const KrsScene *scene) { return scene->program.table_cells; }
size_t      krs_state_slope_count(const KrsScene *scene) { return scene->slope_count; }
size_t      krs_component_count(const KrsScene *scene) { return scene->shown_count; }
size_t      krs_joined_rank(const KrsScene *scene, size_t index) { return scene->rank[index]; }

const char *krs_material_name(const KrsScene *scene, size_t number)
{
    return number > 0 && number <= scene->material_count ? scene->materials[number - 1] : NULL;
}

const char *krs_light_name(const KrsScene *scene, size_t index)
{
    return index < scene->light_count ? scene->lights[index].name : NULL;
}

const char *krs_camera_name(const KrsScene *scene, size_t index)
{
    return index < scene->camera_count ? scene->cameras[index].name : NULL;
}

KrsStatus krs_camera_location(const KrsScene *scene, size_t index, KrsLocation *place)
{
    if (index >= scene->camera_count || scene->cameras[index].standing_in)
        return KRS_BAD_ARGUMENT;
    const RetainedPlace *from = &scene->camera_places[index];
    const Span           span = scene->cameras[index].block;
    *place                    = (KrsLocation){.source = from->source,
                                              .start  = span.start,
                                              .end    = span.end,
                                              .line   = from->position.line,
                                              .column = from->position.column};
    return KRS_OK;
}

size_t krs_texture_count(const KrsScene *scene) { return scene->program.texture_count; }

KrsStatus krs_texture(const KrsScene *scene, size_t index, KrsTexture *texture)
{
    const Textures *all = scene->graph->textures;
    if (index >= scene->program.texture_count)
        return KRS_BAD_ARGUMENT;
    const Texture *from = &all->list.items[index];
    *texture            = (KrsTexture){.file   = from->name,
                                       .width  = from->levels[0].width,
                                       .height = from->levels[0].height,
                                       .levels = from->level_count,
                                       .gray   = from->gray};
    tables_place_texture(scene->graph->instances, all, index, &texture->header, &texture->first);
    return KRS_OK;
}

KrsStatus krs_parameter(const KrsScene *scene, size_t index, KrsParameter *parameter)
{
    if (index >= scene->parameter_count)
        return KRS_BAD_ARGUMENT;
    const Parameter     *from  = &scene->parameters[index];
    const RetainedPlace *place = &scene->parameter_places[index];
    *parameter                 = (KrsParameter){.name       = from->name,
                                                .components = from->components,
                                                .degrees    = from->degrees,
                                                .color      = from->color,
                                                .whole      = from->whole,
                                                .doc        = from->doc,
                                                .source     = place->source,
                                                .start      = from->default_span.start,
                                                .end        = from->default_span.end,
                                                .line       = place->position.line,
                                                .column     = place->position.column};
    memcpy(parameter->value, from->value, sizeof parameter->value);
    memcpy(parameter->low, from->low, sizeof parameter->low);
    memcpy(parameter->high, from->high, sizeof parameter->high);
    return KRS_OK;
}

KrsStatus krs_state_slope(const KrsScene *scene, size_t index, KrsStateSlope *slope)
{
    if (index >= scene->slope_count)
        return KRS_BAD_ARGUMENT;
    const RetainedSlope *from = &scene->slopes[index];
    *slope                    = (KrsStateSlope){.slot = from->slot, .location = from->place};
    for (int i = 0; i < 3; i++) {
        slope->low[i]  = from->task.box.axis[i].low;
        slope->high[i] = from->task.box.axis[i].high;
    }
    return KRS_OK;
}

size_t krs_bound_count(const KrsScene *scene, size_t component, size_t *more)
{
    bool exists = component < scene->shown_count;
    if (more)
        *more = exists ? scene->bounds[component].more : 0;
    return exists ? scene->bounds[component].count : 0;
}

KrsStatus krs_bound(const KrsScene *scene, size_t component, size_t index, KrsBound *bound)
{
    if (index >= krs_bound_count(scene, component, NULL))
        return KRS_BAD_ARGUMENT;
    const BoundEntry *entry = &scene->bounds[component].items[index];
    *bound                  = *entry->about;
    memcpy(bound->low, entry->low, sizeof bound->low);
    memcpy(bound->high, entry->high, sizeof bound->high);
    return KRS_OK;
}

KrsStatus krs_component(const KrsScene *scene, size_t index, KrsComponent *component)
{
    if (index >= scene->shown_count)
        return KRS_BAD_ARGUMENT;
    *component = scene->components[index];
    return KRS_OK;
}

void scene_free(KrsScene *scene)
{
    if (!scene)
        return;
    Memory memory = scene->memory;
    arena_free(&scene->arena);
    if (memory.allocate)
        memory.release(memory.user, scene);
    else
        free(scene);
}

void krs_scene_free(KrsScene *scene) { scene_free(scene); }

/* Drivers keep the values of the state in registers, and need minutes where there are thousands:
   bench/measurements.md. */
enum { MAX_VALUE_SLOTS = 1000 };

bool krs_structure_is_affordable(const KrsScene *scene)
{
    return scene->program.value_slots <= MAX_VALUE_SLOTS;
}
