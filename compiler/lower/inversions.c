/*
 * inversions.c: where there are maps that invert, below kinds in whose parts rays have images.
 *
 * Such a map makes arcs of rays: the scene's distance is no longer that of roots along them.
 */
#include "compiler/lower/lower.h"

/* Each of these is what the column `image` of shapes.def says of a kind. */

static bool inverts_none(const Shape *shape)
{
    (void)shape;
    return false;
}

static bool inverts_inversion(const Shape *shape)
{
    (void)shape;
    return true;
}

static bool inverts_part(const Shape *shape)
{
    for (uint32_t i = 0; i < shape->child_count; i++)
        if (reaches_inversion(shape->children[i]))
            return true;
    return false;
}

static bool inverts_map(const Shape *shape) { return inverts_part(shape); }

static bool inverts_union(const Shape *shape)
{
    return shape->blend.width == NODE_NONE && inverts_part(shape);
}

/* A sphere that is a mirror has no image of a ray: what is in front of it and what is behind it are
   each other's images.  There the distance serves. */
static bool inverts_krs(const Shape *shape)
{
    bool inverts = inverts_part(shape);
    for (uint32_t i = 0; i < shape->stage_count; i++) {
        const SequenceStage *stage = &shape->stages[i];
        if (stage->kind == SEQUENCE_SPHERE)
            return false;
        inverts = inverts || (stage->kind == SEQUENCE_MAP && stage->map.pole != NODE_NONE);
    }
    return inverts;
}

bool reaches_inversion(const Shape *shape)
{
    static bool (*const rules[SHAPE_COUNT])(const Shape *shape) = {
#define SHAPE(KIND, name, parts, curved, divided, own, leaves, box, rays, step, image, ...) \
    inverts_##image,
#include "compiler/shape/shapes.def"
    };
    return rules[shape->kind](shape);
}
