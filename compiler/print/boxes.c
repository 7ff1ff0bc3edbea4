/*
 * boxes.c: boxes around components and scene parts, as shaders have them: grown by what single
 * precision may lose.
 */
#include <math.h>

#include "compiler/base/far.h"
#include "compiler/print/emitter.h"

/* Beyond so many, neighbours share a part. */
enum { MAX_SCENE_PARTS = 64 };

uint32_t module_scene_part_count(size_t components)
{
    return components < MAX_SCENE_PARTS ? (uint32_t)components : MAX_SCENE_PARTS;
}

uint32_t module_scene_part_first(size_t part, size_t components)
{
    return (uint32_t)(part * components / module_scene_part_count(components));
}

void module_box_vectors(Box box, double centre[3], double half[3])
{
    box_centre(box, centre);
    for (int i = 0; i < 3; i++)
        half[i] = (0.5 + 1e-6) * (box.axis[i].high - box.axis[i].low) + 1e-6 * fabs(centre[i]);
}

Box module_scene_part_box(const Box *boxes, size_t components, size_t part)
{
    Box      box = box_empty;
    uint32_t end = module_scene_part_first(part + 1, components);
    for (uint32_t i = module_scene_part_first(part, components); i < end; i++)
        box = box_hull(box, boxes[i]);
    return box;
}

void module_part_corners(Box box, double low[3], double high[3])
{
    double size = box_is_finite(box) ? box_diagonal(box) : 0;
    for (int i = 0; i < 3; i++) {
        double reach  = fmax(fabs(box.axis[i].low), fabs(box.axis[i].high));
        double margin = isfinite(reach) ? 1e-4 * size + 1e-6 * reach : 0;
        low[i]        = fmax(box.axis[i].low - margin, -FAR_SIDE);
        high[i]       = fmin(box.axis[i].high + margin, FAR_SIDE);
    }
}

/* Returns a vector of the frame that is known now (graph_parameterised). */
static Node parameterise_vector(Graph *graph, const double v[3], uint32_t *number)
{
    return graph_parameterised(graph, TYPE_VEC3, v, (*number)++);
}

BoxNodes module_parameterise_boxes(Graph *graph, const Box *boxes, size_t components,
                                   uint32_t first, Arena *arena)
{
    const size_t parts = module_scene_part_count(components);
    BoxNodes     nodes = {.around = arena_new_array(arena, Node, 2 * components + 1),
                          .parts  = arena_new_array(arena, Node, 2 * parts + 1)};
    double       a[3], b[3];
    for (size_t i = 0; i < components; i++) {
        module_box_vectors(box_is_finite(boxes[i]) ? boxes[i] : (Box){0}, a, b);
        nodes.around[2 * i]     = parameterise_vector(graph, a, &first);
        nodes.around[2 * i + 1] = parameterise_vector(graph, b, &first);
    }
    for (size_t i = 0; i < parts; i++) {
        module_part_corners(module_scene_part_box(boxes, components, i), a, b);
        nodes.parts[2 * i]     = parameterise_vector(graph, a, &first);
        nodes.parts[2 * i + 1] = parameterise_vector(graph, b, &first);
    }
    return nodes;
}

const char *emit_box_vector(Emitter *e, const Node *nodes, size_t index, const double v[3])
{
    return nodes ? e->frame[nodes[index]] : emit_vector(e, v);
}
