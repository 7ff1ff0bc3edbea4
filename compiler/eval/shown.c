/*
 * shown.c: what a `show` in a loop shows, as one component.
 *
 * A component has functions of its own in the shaders.  Thousands of them would be as slow to compile as
 * thousands of shapes; all turns of one `show` are as fast as a union.  Users still see each turn as a
 * component with a name and a number.
 */
#include <string.h>

#include "compiler/eval/elaborate.h"

/* Fewer turns stay apart: each is then marched for itself, and left out where it is far. */
enum { LEAST_GATHERED = 32 };

static bool can_be_gathered(const Component *component)
{
    return component->plane_normal == NODE_NONE && box_is_finite(component->shape->box);
}

/* How many components from this one on are turns of the same `show`. */
static size_t count_turns(const Component *components, size_t count)
{
    size_t turns = 0;
    while (turns < count && can_be_gathered(&components[turns]) &&
           !memcmp(&components[turns].span, &components->span, sizeof(Span)))
        turns++;
    return turns;
}

/* The union of turns, in which each knows its number. */
static const Shape *join_turns(Elaboration *e, const Component *turns, size_t count)
{
    const Shape **shapes = arena_new_array(e->values, const Shape *, count);
    for (size_t i = 0; i < count; i++) {
        Shape *shape = arena_new(e->arena, Shape);
        *shape       = *turns[i].shape;
        shape->shown = (uint32_t)turns[i].first + 1;
        shapes[i]    = shape;
    }
    return make_joint(e->builder, SHAPE_UNION, shapes, (uint32_t)count, blend_sharp, turns->span);
}

void gather_shown(Elaboration *e)
{
    Scene *scene            = e->scene;
    scene->shown            = scene->components;
    scene->components.items = NULL;
    scene->components.count = scene->components.capacity = 0;
    for (size_t i = 0; i < scene->shown.count;) {
        Component component = scene->shown.items[i];
        size_t    turns     = count_turns(&scene->shown.items[i], scene->shown.count - i);
        if (turns >= LEAST_GATHERED) {
            component.shape = join_turns(e, &scene->shown.items[i], turns);
            component.count = turns;
        }
        array_push_large(e->arena, &scene->components, component);
        i += component.count;
    }
}
