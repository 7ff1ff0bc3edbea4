/*
 * beams.c: components that are sharp unions of capsules and balls, as beams.
 *
 * A capsule is the convex hull of two balls, and the declarations of the library tell of which.
 */
#include "compiler/eval/hulls/extents.h"

typedef struct Beams {
    Elaboration *e;
    struct {
        SceneBeam *items;
        size_t     count, capacity;
    } list;
} Beams;

static bool add_beams(Beams *b, const Shape *shape);

/* Adds a primitive, or one that is moved. */
static bool add_beam(Beams *b, const Shape *shape)
{
    Extents extents = {0};
    extents_add(b->e, shape, &extents);
    if (extents.endless || extents.figure || extents.half_spaces.count > 0 || extents.count == 0 ||
        extents.count > 2)
        return false;
    SceneBeam beam;
    for (size_t i = 0; i < 2; i++) {
        const Extent *end = &extents.items[i % extents.count];
        if (end->rim != NODE_NONE)
            return false;
        beam.ends[i]  = end->centre;
        beam.radii[i] = end->radius;
    }
    array_push(b->e->arena, &b->list, beam);
    return true;
}

/* Adds the parts of a moved shape, each of which is moved. */
static bool add_moved(Beams *b, const Shape *shape)
{
    const Shape *inner = shape->children[0];
    if (inner->kind == SHAPE_PRIMITIVE)
        return add_beam(b, shape);
    if ((inner->kind != SHAPE_UNION && inner->kind != SHAPE_PAINT && inner->kind != SHAPE_SMOOTH) ||
        inner->blend.width != NODE_NONE)
        return false;
    for (uint32_t i = 0; i < inner->child_count; i++) {
        const Shape *moved = make_transform(b->e->builder, inner->children[i], &shape->map,
                                            shape->span);
        if (!moved || !add_beams(b, moved))
            return false;
    }
    return true;
}

static bool add_beams(Beams *b, const Shape *shape)
{
    switch (shape->kind) {
    case SHAPE_PRIMITIVE: return add_beam(b, shape);
    case SHAPE_TRANSFORM: return add_moved(b, shape);
    case SHAPE_ITERATION: shape = iteration_alone(b->e, shape); return shape && add_beams(b, shape);
    case SHAPE_UNION:
        if (shape->blend.width != NODE_NONE)
            return false;
        break;
    case SHAPE_EMPTY:
    case SHAPE_PAINT:
    case SHAPE_SMOOTH: break;
    default: return false;
    }
    for (uint32_t i = 0; i < shape->child_count; i++)
        if (!add_beams(b, shape->children[i]))
            return false;
    return true;
}

void find_beams(Elaboration *e, Component *component)
{
    Beams b = {.e = e};
    if (!e->beams || component->figure || !add_beams(&b, component->shape))
        return;
    component->beams      = b.list.items;
    component->beam_count = b.list.count;
}
