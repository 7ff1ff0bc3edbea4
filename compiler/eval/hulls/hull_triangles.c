/*
 * hull_triangles.c: convex hulls of points, by Qhull (Barber, Dobkin and Huhdanpaa, "The Quickhull algorithm
 * for convex hulls", 1996).
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <libqhull_r/qhull_ra.h>

#include "compiler/base/vec.h"
#include "compiler/eval/hulls/hull.h"
#include "compiler/eval/hulls/hull_normals.h"

enum { MAX_POINTS = 4096 };

static Value refuse(Elaboration *e, const Call *call, const char *what)
{
    Diag *diag = diag_add(e->diags, DIAG_BAD_VALUE, call->arguments[0].syntax->span, "%s", what);
    diag->help = "give points such as `[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]`";
    return value_error();
}

/* Reads a point, three numbers that are known now. */
static bool read_point(Value value, coordT *point)
{
    if (value.type != VALUE_LIST || value.list->count != 3)
        return false;
    for (int k = 0; k < 3; k++) {
        if (value.list->items[k].type != VALUE_NUMBER || !isfinite(value.list->items[k].number))
            return false;
        point[k] = value.list->items[k].number;
    }
    return true;
}

static Value point_value(Elaboration *e, const coordT *point)
{
    Value *numbers = arena_new_array(e->values, Value, 3);
    for (int k = 0; k < 3; k++)
        numbers[k] = value_number(point[k]);
    return value_list(e, numbers, 3);
}

/* Tells whether the corners are counterclockwise as seen from where the normal points. */
static bool faces_outwards(coordT *const corners[3], const coordT *normal)
{
    double first[3], second[3], across[3];
    for (int k = 0; k < 3; k++) {
        first[k]  = corners[1][k] - corners[0][k];
        second[k] = corners[2][k] - corners[0][k];
    }
    cross3(first, second, across);
    return dot3(across, normal) > 0;
}

/* Returns the three corners of a facet, counterclockwise as seen from outside. */
static Value triangle_value(Elaboration *e, const facetT *facet)
{
    Value  *corners = arena_new_array(e->values, Value, 3);
    coordT *found[3];
    for (int k = 0; k < 3; k++)
        found[k] = SETelemt_(facet->vertices, k, vertexT)->point;
    bool outwards = faces_outwards(found, facet->normal);
    for (int k = 0; k < 3; k++)
        corners[k] = point_value(e, found[outwards ? k : 2 - k]);
    return value_list(e, corners, 3);
}

typedef void EachFacet(const facetT *facet, void *user);

/* Runs Qhull and hands the facets of the hull to a function, which keeps nothing of them.  What Qhull says of
   mistakes goes nowhere.  False: the points lie in a plane. */
static bool run_qhull(coordT *points, size_t count, const char *options, EachFacet *each,
                      void *user)
{
    qhT   state, *qh = &state;
    FILE *silent = fopencookie(NULL, "w", (cookie_io_functions_t){0});
    FILE *said   = silent ? silent : stderr;
    char  command[32];
    snprintf(command, sizeof command, "%s", options);
    qh_zero(qh, said);
    const int status = qh_new_qhull(qh, 3, (int)count, points, False, command, said, said);
    if (status == 0) /* the last facet is a sentinel */
        for (const facetT *facet = qh->facet_list; facet && facet->next; facet = facet->next)
            each(facet, user);
    int current, total;
    qh_freeqhull(qh, !qh_ALL);
    qh_memfreeshort(qh, &current, &total);
    if (silent)
        fclose(silent);
    return status == 0;
}

typedef struct Triangles {
    Elaboration *e;
    Values       found;
} Triangles;

static void add_triangle(const facetT *facet, void *user)
{
    Triangles *triangles = user;
    array_push(triangles->e->values, &triangles->found, triangle_value(triangles->e, facet));
}

Value builtin_hull_triangles(Elaboration *e, Call *call)
{
    const List *points = want_list(e, call, 0);
    if (!points)
        return value_error();
    if (points->count < 4 || points->count > MAX_POINTS)
        return refuse(e, call, "a hull has from 4 to 4096 points");
    coordT *numbers = arena_new_array(e->scratch, coordT, 3 * points->count);
    for (size_t i = 0; i < points->count; i++)
        if (!read_point(points->items[i], numbers + 3 * i))
            return refuse(e, call, "a point of a hull is three numbers, known at compile time");

    Triangles triangles = {.e = e};
    if (!run_qhull(numbers, points->count, "qhull Qt", add_triangle, &triangles))
        return refuse(e, call, "these points lie in a plane, or nearly so");
    return value_list(e, triangles.found.items, triangles.found.count);
}

static void add_normal(const facetT *facet, void *user)
{
    HullNormals *normals = user;
    double      *numbers = arena_new_array(normals->arena, double, 3);
    for (int k = 0; k < 3; k++)
        numbers[k] = facet->normal[k];
    array_push(normals->arena, normals, numbers);
}

void hull_normals(const double *points, size_t count, HullNormals *normals)
{
    coordT *numbers = arena_new_array(normals->arena, coordT, 3 * count + 1);
    for (size_t i = 0; i < 3 * count; i++)
        numbers[i] = points[i];
    if (count >= 4)
        run_qhull(numbers, count, "qhull", add_normal, normals);
}
