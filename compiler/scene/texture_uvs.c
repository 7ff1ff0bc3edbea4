/*
 * texture_uvs.c: where surfaces read their textures, which meshes have as coordinates.
 */
#include <math.h>
#include <string.h>

#include "compiler/scene/program.h"

static bool reads_normals(const Graph *graph, const Tape *tape)
{
    for (size_t i = 0; i < tape->count; i++)
        if (graph->items[tape->nodes[i]].op == OP_NORMAL)
            return true;
    return false;
}

static size_t nearest_component(KrsState *state, const double point[3])
{
    return state->scene->component_count == 1 ? 0 : state_nearest_component(state, point) - 1;
}

/* Finds the place in a texture; false: nothing there reads one. */
static bool place_at(KrsState *state, const double point[3], bool normals, double place[2])
{
    const KrsScene *scene     = state->scene;
    const Node     *roots     = roots_of(&scene->roots, ROOTS_PLACE).items;
    Node            root      = roots[nearest_component(state, point)];
    double          normal[3] = {0, 0, 0};
    if (scene->graph->items[root].type != TYPE_VEC2)
        return false;
    if (normals && krs_normal(state, (const double(*)[3])point, 1, &normal) != KRS_OK)
        return false;
    tape_run_surface(&state->tapes.places, point, normal, 0, state->values);
    memcpy(place, state->values[root].v, 2 * sizeof *place);
    return true;
}

KrsStatus krs_texture_uvs(KrsState *state, const double (*points)[3], size_t count,
                          double (*places)[2])
{
    const KrsScene *scene   = state->scene;
    bool            any     = roots_of(&scene->roots, ROOTS_PLACE).count > 0;
    bool            normals = reads_normals(scene->graph, &scene->places);
    for (size_t i = 0; i < count; i++)
        if (!points || !isfinite(points[i][0]) || !isfinite(points[i][1]) ||
            !isfinite(points[i][2]))
            return KRS_BAD_ARGUMENT;
    state_refresh_points(state);
    for (size_t i = 0; i < count; i++)
        if (!any || !place_at(state, points[i], normals, places[i]))
            places[i][0] = places[i][1] = NAN;
    return KRS_OK;
}
