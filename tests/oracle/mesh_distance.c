/*
 * mesh_distance.c: distances between meshes and surfaces, found by looking at many points.
 */
#include "tests/oracle/mesh_distance.h"

#include <stdlib.h>
#include <string.h>

#include "tests/support/triangles.h"

/* ---- triangles by where they are ---- */

enum { CELLS = 32 }; /* along a side */

struct MeshGrid {
    const KrsMesh *mesh;
    double         reach, low[3], scale[3];
    uint32_t      *first; /* of each cell, and the end */
    uint32_t      *items;
};

static Vec vertex(const KrsMesh *mesh, size_t triangle, int corner)
{
    const double *v = mesh->vertices[mesh->triangles[triangle][corner]];
    return vec(v[0], v[1], v[2]);
}

static int cell_of(const MeshGrid *grid, double x, int axis)
{
    return (int)fmax(0, fmin(CELLS - 1, floor((x - grid->low[axis]) * grid->scale[axis])));
}

static void find_box(MeshGrid *grid)
{
    double high[3];
    for (int k = 0; k < 3; k++) {
        grid->low[k] = HUGE_VAL;
        high[k]      = -HUGE_VAL;
        for (size_t i = 0; i < grid->mesh->vertex_count; i++) {
            grid->low[k] = fmin(grid->low[k], grid->mesh->vertices[i][k]);
            high[k]      = fmax(high[k], grid->mesh->vertices[i][k]);
        }
        grid->scale[k] = CELLS / fmax(high[k] - grid->low[k], grid->reach);
    }
}

/* Counts what a triangle may be near to, or puts it there. */
static void visit_cells(MeshGrid *grid, size_t triangle, bool put)
{
    int low[3], high[3];
    for (int k = 0; k < 3; k++) {
        double least = HUGE_VAL, most = -HUGE_VAL;
        for (int i = 0; i < 3; i++) {
            double x = grid->mesh->vertices[grid->mesh->triangles[triangle][i]][k];
            least    = fmin(least, x);
            most     = fmax(most, x);
        }
        low[k]  = cell_of(grid, least - grid->reach, k);
        high[k] = cell_of(grid, most + grid->reach, k);
    }
    for (int x = low[0]; x <= high[0]; x++)
        for (int y = low[1]; y <= high[1]; y++)
            for (int z = low[2]; z <= high[2]; z++) {
                uint32_t *count = &grid->first[(x * CELLS + y) * CELLS + z];
                if (put)
                    grid->items[--*count] = (uint32_t)triangle;
                else
                    ++*count;
            }
}

MeshGrid *mesh_grid_new(const KrsMesh *mesh, double reach)
{
    enum { ALL = CELLS * CELLS * CELLS };
    MeshGrid *grid = calloc(1, sizeof *grid);
    grid->mesh     = mesh;
    grid->reach    = reach;
    grid->first    = calloc(ALL + 1, sizeof *grid->first);
    find_box(grid);
    for (size_t i = 0; i < mesh->triangle_count; i++)
        visit_cells(grid, i, false);
    for (size_t i = 1; i <= ALL; i++)
        grid->first[i] += grid->first[i - 1];
    grid->items = malloc((grid->first[ALL] + 1) * sizeof *grid->items);
    for (size_t i = 0; i < mesh->triangle_count; i++)
        visit_cells(grid, i, true);
    return grid;
}

void mesh_grid_free(MeshGrid *grid)
{
    free(grid->first);
    free(grid->items);
    free(grid);
}

double mesh_grid_distance(const MeshGrid *grid, Vec p)
{
    const double at[3] = {p.x, p.y, p.z};
    double       least = HUGE_VAL;
    size_t       cell  = 0;
    for (int k = 0; k < 3; k++)
        cell = cell * CELLS + (size_t)cell_of(grid, at[k], k);
    for (uint32_t i = grid->first[cell]; i < grid->first[cell + 1]; i++) {
        double corners[3][3];
        for (int c = 0; c < 3; c++)
            memcpy(corners[c], grid->mesh->vertices[grid->mesh->triangles[grid->items[i]][c]],
                   sizeof corners[c]);
        least = fmin(least, distance_to_triangle((const double(*)[3])corners, at));
    }
    return least <= grid->reach ? least : HUGE_VAL;
}

/* ---- from the surface to the mesh ---- */

enum { SAMPLES = 300, HALVINGS = 50, REACH = 3 };

static bool is_inside(const Surface *surface, Vec p)
{
    return surface->value(surface->user, p) < 0;
}

/* Returns where the sign changes between two points. */
static Vec crossing(const Surface *surface, Vec outer, Vec inner)
{
    for (int i = 0; i < HALVINGS; i++) {
        Vec middle = vec_mix(outer, inner, 0.5);
        if (is_inside(surface, middle))
            inner = middle;
        else
            outer = middle;
    }
    return vec_mix(outer, inner, 0.5);
}

static bool ball_is_of_one_side(const Surface *surface, Vec center, double radius, bool inside,
                                Random *random)
{
    enum { AROUND = 60 };
    for (int i = 0; i < AROUND; i++)
        if (is_inside(surface, vec_add(center, vec_scale(radius, random_unit(random)))) != inside)
            return false;
    return is_inside(surface, center) == inside;
}

/* Tells whether a ball as thick as the error fits on this side, no farther away than the error. */
static bool is_thick(const Surface *surface, Vec hit, double error, bool inside, Random *random)
{
    enum { BALLS = 400 };
    for (int i = 0; i < BALLS; i++) {
        double away   = error * cbrt(random_between(random, 0, 1));
        Vec    center = vec_add(hit, vec_scale(away, random_unit(random)));
        if (ball_is_of_one_side(surface, center, 0.5 * error, inside, random))
            return true;
    }
    return false;
}

static void judge_hit(const Surface *surface, const MeshGrid *grid, Vec hit, double error,
                      Random *random, Apart *apart)
{
    double distance     = mesh_grid_distance(grid, hit);
    apart->farthest_hit = fmax(apart->farthest_hit, distance / error);
    apart->hits++;
    if (distance <= error)
        return;
    bool thick = is_thick(surface, hit, error, true, random) &&
                 is_thick(surface, hit, error, false, random);
    if (thick || apart->thick == 0)
        apart->lost_at = hit;
    apart->lost++;
    apart->thick += thick;
}

static Vec random_in_box(const Surface *surface, Random *random)
{
    return vec(random_between(random, surface->low.x, surface->high.x),
               random_between(random, surface->low.y, surface->high.y),
               random_between(random, surface->low.z, surface->high.z));
}

/* With a box around those of many points that are inside, and some errors more, so that most rays hit;
   where none is inside, with the same box. */
static Surface aimed_at(const Surface *surface, double error, Random *random)
{
    enum { AIMS = 4000 };
    Surface aimed = *surface;
    bool    any   = false;
    for (int i = 0; i < AIMS; i++) {
        Vec p = random_in_box(surface, random);
        if (!is_inside(surface, p))
            continue;
        Vec low = any ? aimed.low : p, high = any ? aimed.high : p;
        aimed.low  = vec(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z));
        aimed.high = vec(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z));
        any        = true;
    }
    Vec margin = vec(2 * error, 2 * error, 2 * error);
    aimed.low  = any ? vec_sub(aimed.low, margin) : aimed.low;
    aimed.high = any ? vec_add(aimed.high, margin) : aimed.high;
    return aimed;
}

/* Casts all crossings of a ray that are farther apart than the samples. */
static void cast_ray(const Surface *surface, const MeshGrid *grid, double error, Random *random,
                     Apart *apart)
{
    double reach     = vec_distance(surface->low, surface->high);
    Vec    through   = random_in_box(surface, random);
    Vec    direction = random_unit(random);
    Vec    from      = vec_add(through, vec_scale(-reach, direction));
    double step = 2 * reach / SAMPLES, shift = random_between(random, 0, step);
    Vec    before = vec_add(from, vec_scale(shift - step, direction));
    bool   inside = is_inside(surface, before);
    for (int i = 0; i <= SAMPLES; i++) {
        Vec  here = vec_add(from, vec_scale(shift + i * step, direction));
        bool now  = is_inside(surface, here);
        if (now != inside) {
            judge_hit(surface, grid,
                      now ? crossing(surface, before, here) : crossing(surface, here, before),
                      error, random, apart);
            apart->crossings[inside]++;
        }
        before = here;
        inside = now;
    }
}

/* ---- from the mesh to the surface ---- */

enum { TRIES = 4000, STEPS = 6 };

/* By Newton's method, from a point to where the number is 0, no farther than the error. */
static bool sign_changes_downhill(const Surface *surface, Vec from, double error, bool inside)
{
    Vec p = from;
    for (int i = 0; i < STEPS; i++) {
        double h = 1e-5 * error, value = surface->value(surface->user, p);
        Vec    slope = vec(surface->value(surface->user, vec_add(p, vec(h, 0, 0))) - value,
                           surface->value(surface->user, vec_add(p, vec(0, h, 0))) - value,
                           surface->value(surface->user, vec_add(p, vec(0, 0, h))) - value);
        double steep = vec_length(slope) / h;
        if (!(steep > 1e-9))
            return false;
        p           = vec_add(p, vec_scale((-1.02 * value / steep) / (steep * h), slope));
        double away = vec_distance(p, from);
        if (away > error)
            p = vec_mix(from, p, error / away);
        if (is_inside(surface, p) != inside)
            return true;
    }
    return false;
}

/* A corner may be seen in few directions, so many are tried. */
static bool is_near_surface(const Surface *surface, Vec p, Vec normal, double error, Random *random)
{
    bool inside = is_inside(surface, p);
    if (is_inside(surface, vec_add(p, vec_scale(error, normal))) != inside ||
        is_inside(surface, vec_add(p, vec_scale(-error, normal))) != inside ||
        sign_changes_downhill(surface, p, error, inside))
        return true;
    for (int i = 0; i < TRIES; i++) {
        double away = error * sqrt(random_between(random, 0, 1));
        if (is_inside(surface, vec_add(p, vec_scale(away, random_unit(random)))) != inside)
            return true;
    }
    return false;
}

static void judge_point(const Surface *surface, Vec p, Vec normal, double error, Random *random,
                        Apart *apart)
{
    apart->points++;
    if (!is_near_surface(surface, p, normal, error, random)) {
        apart->off_surface++;
        apart->off_surface_at = p;
    }
}

static double area_of(const KrsMesh *mesh, size_t i)
{
    Vec a = vertex(mesh, i, 0);
    return vec_length(vec_cross(vec_sub(vertex(mesh, i, 1), a), vec_sub(vertex(mesh, i, 2), a))) /
           2;
}

/* Corners, the middle, and points as many as the area asks for. */
static void judge_triangle(const KrsMesh *mesh, size_t i, const Surface *surface, double error,
                           double points, Random *random, Apart *apart)
{
    Vec    a = vertex(mesh, i, 0), b = vertex(mesh, i, 1), c = vertex(mesh, i, 2);
    Vec    normal = vec_cross(vec_sub(b, a), vec_sub(c, a));
    double size   = vec_length(normal);
    int    count  = (int)(points + random_between(random, 0, 1));
    normal        = size > 0 ? vec_scale(1 / size, normal) : vec(1, 0, 0);
    judge_point(surface, a, normal, error, random, apart);
    judge_point(surface, vec_scale(1. / 3, vec_add(vec_add(a, b), c)), normal, error, random,
                apart);
    for (int k = 0; k < count; k++) {
        double u = sqrt(random_between(random, 0, 1)), v = random_between(random, 0, 1);
        judge_point(surface, vec_mix(a, vec_mix(b, c, v), u), normal, error, random, apart);
    }
}

Apart mesh_apart(const KrsMesh *mesh, const Surface *surface, double error, size_t rays,
                 size_t points, Random *random)
{
    Apart     apart = {0};
    MeshGrid *grid  = mesh_grid_new(mesh, REACH * error);
    Surface   aimed = aimed_at(surface, error, random);
    double    area  = 0;
    for (size_t i = 0; i < rays; i++)
        cast_ray(&aimed, grid, error, random, &apart);
    for (size_t i = 0; i < mesh->triangle_count; i++)
        area += area_of(mesh, i);
    for (size_t i = 0; i < mesh->triangle_count; i++)
        judge_triangle(mesh, i, surface, error, (double)points * area_of(mesh, i) / area, random,
                       &apart);
    mesh_grid_free(grid);
    return apart;
}
