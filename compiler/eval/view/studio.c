/*
 * studio.c: lights, walls and a floor (compiler/library/studio.krs) for a scene that names neither
 * lights nor a sky nor fog.  Only bounded scenes get them, and only if no camera can be below the floor.
 * The floor is below what is shown at the values of a state.
 */
#include <math.h>
#include <string.h>

#include "compiler/eval/elaborate.h"

void plan_boxes(Elaboration *e)
{
    const Scene  *scene  = e->scene;
    const size_t  count  = scene->components.count;
    const Shape **shapes = arena_new_array(e->arena, const Shape *, count + 1);
    for (size_t i = 0; i < count; i++)
        shapes[i] = scene->components.items[i].shape;
    box_plan_states(e->builder, shapes, count, &e->scene->boxes);
}

/* Returns the box around all boxes, which is infinite if one of them is. */
static Box box_around(const Box *boxes, size_t count)
{
    Box box = box_empty;
    for (size_t i = 0; i < count; i++) {
        if (!box_is_empty(boxes[i]) && !box_is_finite(boxes[i]))
            return box_infinite;
        box = box_hull(box, boxes[i]);
    }
    return box;
}

/* Returns the box around the scene for all values of the parameters. */
static Box box_of_all_frames(Elaboration *e)
{
    const Scene *scene = e->scene;
    Box         *boxes = arena_new_array(e->arena, Box, scene->components.count + 1);
    for (size_t i = 0; i < scene->components.count; i++)
        boxes[i] = scene->components.items[i].shape->box;
    return box_around(boxes, scene->components.count);
}

static Box box_of_defaults(Elaboration *e)
{
    const BoxPlan *plan  = &e->scene->boxes;
    Box           *boxes = arena_new_array(e->arena, Box, plan->shapes.count + 1);
    box_plan_default(e->builder, plan, boxes);
    return box_around(boxes, e->scene->components.count);
}

/* Tells whether all cameras are above a height, in all states. */
static bool cameras_are_above(Elaboration *e, double height)
{
    for (size_t i = 0; i < e->scene->cameras.count; i++) {
        Node up = graph_component(e->graph, e->scene->cameras.items[i].nodes.eye, 1);
        if (!(node_range(e->builder, up, 0).low > height))
            return false;
    }
    return true;
}

/* Returns how low rays begin, and a tenth of the picture lower, where all cameras are orthographic and level, so that nobody
   sees the top of a floor; else infinity. */
static double lowest_of_level_rays(Elaboration *e)
{
    double lowest = INFINITY;
    for (size_t i = 0; i < e->scene->cameras.count; i++) {
        const SceneCamera *camera = &e->scene->cameras.items[i];
        const Range eye    = node_range(e->builder, graph_component(e->graph, camera->nodes.eye, 1),
                                        0),
                    target = node_range(e->builder,
                                        graph_component(e->graph, camera->nodes.target, 1), 0),
                    height = node_range(e->builder, camera->nodes.height, 0);
        if (camera->projection != KRS_ORTHOGRAPHIC || eye.low != eye.high ||
            target.low != eye.low || target.high != eye.low)
            return INFINITY;
        lowest = fmin(lowest, eye.low - 0.6 * height.high);
    }
    return lowest;
}

/* Returns a height that is found for each state, in this box as a rule. */
static Node state_floor(Elaboration *e, Box box)
{
    StateFloor          *floor = &e->scene->floor;
    const GraphParameter range = {{box.axis[1].low}, {box.axis[1].high}};
    floor->slot                = (uint32_t)e->graph->parameters.count;
    floor->otherwise           = box.axis[1].low;
    for (size_t i = 0; i < e->scene->cameras.count; i++) {
        const Node          eye    = e->scene->cameras.items[i].nodes.eye;
        const PlannedNumber number = box_plan_number(e->builder, eye, &e->scene->boxes);
        array_push(e->arena, &floor->eyes, number);
    }
    array_push(e->builder->arena, &e->graph->parameters, range);
    return graph_parameter(e->graph, floor->slot, TYPE_FLOAT);
}

/* Returns the scope of the library's file, whose statements are run like those of the scene. */
static Scope *find_studio(const Elaboration *e)
{
    const Files *files = e->files;
    for (size_t i = 0; i < files->count; i++)
        if (files->items[i]->library && strcmp(files->items[i]->path, "library:studio.krs") == 0)
            return e->scopes.items[i];
    return NULL;
}

/* Gives a definition of the file another value than it is written with. */
static void set_value(Elaboration *e, const Scope *scope, const char *name, Value value)
{
    Definition *definition = scope_find(scope, name_intern(e->files->names, name, strlen(name)));
    definition->value      = value;
    definition->state      = DEFINITION_DONE;
}

void run_studio(Elaboration *e)
{
    Scene     *scene  = e->scene;
    Scope     *scope  = find_studio(e);
    const bool varies = scene->boxes.nodes.count > 0;
    if (!e->studio || !scope || e->diags->errors > 0 || scene->lights.count > 0 ||
        scene->sky.zenith != NODE_NONE || scene->fog.color != NODE_NONE)
        return;
    Box box = box_of_all_frames(e);
    if (varies && !box_is_finite(box) && !box_is_empty(box))
        box = box_of_defaults(e);
    if (box_is_empty(box) || !box_is_finite(box) || !cameras_are_above(e, box.axis[1].low))
        return;
    /* Rays that begin inside of a floor, and along it, would never leave it. */
    const double bottom = fmin(box.axis[1].low, lowest_of_level_rays(e));
    set_value(e, scope, "_bottom",
              varies ? value_of_node(e, state_floor(e, box)) : value_number(bottom));
    set_value(e, scope, "_size", value_number(fmax(box_diagonal(box), 1e-9)));
    run_file(e, scope);
    scene->components.items[scene->components.count - 1].name = "floor";
}
