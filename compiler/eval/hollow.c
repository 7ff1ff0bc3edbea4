/*
 * hollow.c: a scene without a part, to see what that costs.
 *
 * Shapes of an expression become empty but keep their boxes, so that cameras, floors and all that
 * follows from the size of the scene stay as they are.
 */
#include "compiler/eval/elaborate.h"

#include <string.h>

Span location_span(const Sources *sources, const KrsLocation *location)
{
    for (uint32_t i = 1; i < sources->count; i++)
        if (!sources->items[i].library && strcmp(sources->items[i].name, location->source) == 0)
            return (Span){i, location->start, location->end};
    return (Span){0};
}

static const Shape *hollow(Elaboration *e, const Shape *shape)
{
    Shape *empty  = shape_new(e->builder, SHAPE_UNION, shape->name, shape->span, NULL, 0);
    empty->box    = shape->box;
    empty->figure = shape->figure;
    empty->given  = shape->given;
    return empty;
}

Value value_hollow(Elaboration *e, Value value)
{
    if (value.type == VALUE_SHAPE)
        return value_shape(hollow(e, value.shape));
    if (value.type != VALUE_LIST)
        return value;
    Value *items = arena_new_array(e->values, Value, value.list->count + 1);
    for (size_t i = 0; i < value.list->count; i++)
        items[i] = value_hollow(e, value.list->items[i]);
    return value_list(e, items, value.list->count);
}
