/*
 * studio.c: lights, walls and a floor (compiler/library/studio.krs) for a scene that names neither
 * lights nor a sky nor fog.  Only bounded scenes get them, and only if no camera can be below the floor.
 */
#include <math.h>
#include <string.h>

#include "compiler/eval/elaborate.h"

static bool box_of_scene(const Scene *scene, Box *box)
{
    *box = box_empty;
    for (size_t i = 0; i < scene->components.count; i++) {
        if (!box_is_finite(scene->components.items[i].shape->box))
            return false;
        *box = box_hull(*box, scene->components.items[i].shape->box);
    }
    return !box_is_empty(*box);
}

/* Whether all cameras are above a height, in all frames. */
static bool cameras_are_above(Elaboration *e, double height)
{
    for (size_t i = 0; i < e->scene->cameras.count; i++) {
        Node up = graph_component(e->graph, e->scene->cameras.items[i].eye, 1);
        if (!(node_range(e->builder, up, 0).low > height))
            return false;
    }
    return true;
}

/* The scope of the library's file, whose statements are run like those of the scene. */
static Scope *find_studio(const Elaboration *e, const Files *files)
{
    for (size_t i = 0; i < files->count; i++)
        if (files->items[i]->library && strcmp(files->items[i]->path, "library:studio.krs") == 0)
            return e->scopes.items[i];
    return NULL;
}

static void set_number(Scope *scope, const char *name, double number)
{
    for (size_t i = 0; i < scope->definitions.count; i++) {
        Definition *definition = scope->definitions.items[i];
        if (strcmp(definition->name, name) != 0)
            continue;
        definition->value = value_number(number);
        definition->state = DEFINITION_DONE;
    }
}

void run_studio(Elaboration *e, const Files *files)
{
    Scene *scene = e->scene;
    Scope *scope = find_studio(e, files);
    Box    box;
    if (!scope || e->diags->errors > 0 || scene->lights.count > 0 ||
        scene->sky.zenith != NODE_NONE || scene->fog.color != NODE_NONE ||
        !box_of_scene(scene, &box) || !cameras_are_above(e, box.axis[1].low))
        return;
    set_number(scope, "_bottom", box.axis[1].low);
    set_number(scope, "_size", fmax(box_diagonal(box), 1e-9));
    run_file(e, scope);
    scene->components.items[scene->components.count - 1].name = "floor";
}
