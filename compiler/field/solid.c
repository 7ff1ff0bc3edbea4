/* solid.c: components as one solid. */
#include "compiler/field/solid.h"

#include "compiler/field/steps.h"

size_t solid_root_bytes(const KrsScene *scene)
{
    return (scene->component_count + 2) * sizeof(Node);
}

bool has_one_material(const KrsScene *scene, const bool *wanted)
{
    const Node *first = NULL;
    for (size_t i = 0; i < scene->component_count; i++) {
        const Node *roots = surface_roots(&scene->roots, i);
        if (wanted && !wanted[i])
            continue;
        first = first ? first : roots;
        for (size_t k = 0; k < ROOT_COUNT; k++)
            if (root_info[k].material &&
                (scene->graph->items[roots[k]].time == TIME_POINT || roots[k] != first[k]))
                return false;
    }
    return true;
}

void solid_of_components(const KrsScene *scene, const bool *wanted, MeshSolid *solid)
{
    Node zone   = zone_root(scene);
    solid->tape = NULL;
    solid->box  = box_empty;
    for (size_t i = 0; i < scene->component_count; i++)
        if (!wanted || wanted[i])
            solid->roots[solid->root_count++] = distance_root(&scene->roots, i);
    for (size_t i = 0; i < scene->shown_count; i++) {
        const KrsComponent *component = &scene->components[i];
        Box                 box;
        if (wanted && !wanted[scene->lowered[i]])
            continue;
        for (int k = 0; k < 3; k++)
            box.axis[k] = (Range){component->low[k], component->high[k]};
        solid->box      = box_hull(solid->box, box);
        solid->estimate = solid->estimate || component->estimate;
    }
    solid->roots[solid->root_count] = zone;
    solid->zoned                    = zone != NODE_NONE;
    solid->plain                    = has_one_material(scene, wanted);
    solid->steps                    = !solid->plain && materials_step(scene, wanted);
    solid->copy                     = NULL;
}
