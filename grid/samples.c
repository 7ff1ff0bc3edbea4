/* samples.c: computes the samples of a brick. */
#include "grid/grid.h"

#include <string.h>

#include "compiler/base/vec.h"
#include "compiler/scene/points.h"

/* Finds the point of sample `i` of a brick, x first. */
static void sample_point(const KrsGrid *grid, const size_t at[3], size_t i, double point[3])
{
    point[0] = grid_coordinate(grid, 0, at[0] + i % BRICK);
    point[1] = grid_coordinate(grid, 1, at[1] + i / BRICK % BRICK);
    point[2] = grid_coordinate(grid, 2, at[2] + i / (BRICK * BRICK));
}

/* Rounds a distance so that it becomes no longer. */
static float rounded(double value)
{
    float number = (float)value;
    return fabs((double)number) > fabs(value) ? nextafterf(number, 0) : number;
}

static double banded(const KrsGrid *grid, double distance)
{
    double band = grid->shape.band;
    return band > 0 ? min2(max2(distance, -band), band) : distance;
}

float far_value(const KrsGrid *grid, double distance)
{
    if (grid->options.fog)
        return distance < 0 ? 1 : 0;
    return rounded(distance < 0 ? -grid->shape.band : grid->shape.band);
}

/* Returns the distance to the mesh, less its error: it is no longer than the true one, and at most
   twice the error shorter. */
static double exact_distance(const KrsGrid *grid, const double point[3], double distance,
                             uint32_t *triangle)
{
    double nearest[3], radius = INFINITY;
    if (!grid->mesh)
        return distance;
    if (bvh_triangle_is_near(&grid->bvh, *triangle, point, INFINITY, nearest))
        radius = distance3(nearest, point);
    double least = bvh_distance(&grid->bvh, point, radius, triangle) - grid->mesh->error;
    return copysign(max2(fabs(distance), least), distance);
}

static float value_at(const KrsGrid *grid, const MeshField *field, const double point[3],
                      double distance, uint32_t *triangle)
{
    if (grid->options.fog)
        return fabs(distance) > grid->near ? far_value(grid, distance)
                                           : (float)coverage(field, point, grid->shape.cell);
    return rounded(banded(grid, exact_distance(grid, point, distance, triangle)));
}

void fill_brick(const KrsGrid *grid, MeshField *field, const size_t at[3], uint32_t *triangle,
                Brick *brick)
{
    for (size_t first = 0; first < BRICK_SAMPLES; first += MAX_FIELD_POINTS) {
        double points[MAX_FIELD_POINTS][3], distances[MAX_FIELD_POINTS];
        for (size_t i = 0; i < MAX_FIELD_POINTS; i++)
            sample_point(grid, at, first + i, points[i]);
        field_distances(field, (const double(*)[3])points, MAX_FIELD_POINTS, distances);
        for (size_t i = 0; i < MAX_FIELD_POINTS; i++)
            brick->values[first + i] = value_at(grid, field, points[i], distances[i], triangle);
    }
}

/* ---- materials ---- */

/* Finds normals by differences, as queries do. */
static void find_normals(const MeshField *field, const double (*points)[3], double (*normals)[3])
{
    for (int i = 0; i < MAX_FIELD_POINTS; i++)
        field_normal(field, points[i], 1e-6 * (1 + largest3(points[i])), normals[i]);
}

static void take_material(const KrsGrid *grid, KrsState *state, size_t point, uint32_t nearest,
                          float color[3], uint32_t *material)
{
    const Node *roots = surface_roots(&state->scene->roots,
                                      (grid->chosen ? grid->chosen : nearest) - 1);
    points_surface(state, point, grid->chosen ? grid->chosen : nearest);
    for (int k = 0; k < 3; k++) {
        double part = state->values[roots[ROOT_color]].v[k];
        color[k]    = (float)(part > 0 ? min2(part, 1) : 0);
    }
    *material = (uint32_t)state->values[roots[ROOT_material]].v[0];
}

KrsStatus add_materials(const KrsGrid *grid, MeshField *field, const size_t at[3], Brick *brick)
{
    if (!state_lanes(field->state))
        return KRS_OUT_OF_MEMORY;
    for (size_t first = 0; first < BRICK_SAMPLES; first += MAX_FIELD_POINTS) {
        double   points[MAX_FIELD_POINTS][3], normals[MAX_FIELD_POINTS][3];
        double   distances[MAX_FIELD_POINTS];
        uint32_t nearest[MAX_FIELD_POINTS];
        for (size_t i = 0; i < MAX_FIELD_POINTS; i++)
            sample_point(grid, at, first + i, points[i]);
        find_normals(field, (const double(*)[3])points, normals);
        points_look(field->state, (const double(*)[3])points, (const double(*)[3])normals,
                    MAX_FIELD_POINTS, distances, nearest);
        for (size_t i = 0; i < MAX_FIELD_POINTS; i++)
            take_material(grid, field->state, i, nearest[i], brick->colors[first + i],
                          &brick->materials[first + i]);
    }
    return KRS_OK;
}
