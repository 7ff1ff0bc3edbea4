/* voids.c: finds the components of the mesh by union-find, and drops some. */
#include "mesh/contour/voids.h"

#include <string.h>

#include "compiler/base/vec.h"

/* A component of the mesh. */
typedef struct Shell {
    double low[3], high[3], volume;
    bool   used, dropped;
} Shell;

typedef struct Shells {
    Contour  *contour;
    uint32_t *leaders; /* union-find of vertices: another one of the same component, or itself */
    Shell    *shells;  /* by leader */
    double    at[3];
} Shells;

static uint32_t leader_of(const Shells *s, uint32_t vertex)
{
    while (s->leaders[vertex] != vertex) {
        s->leaders[vertex] = s->leaders[s->leaders[vertex]];
        vertex             = s->leaders[vertex];
    }
    return vertex;
}

static void join_vertices(Shells *s)
{
    for (size_t i = 0; i < s->contour->vertices.count; i++)
        s->leaders[i] = (uint32_t)i;
    for (size_t i = 0; i < s->contour->triangles.count; i++) {
        const uint32_t *corners              = s->contour->triangles.items[i];
        uint32_t        leader               = leader_of(s, corners[0]);
        s->leaders[leader_of(s, corners[1])] = leader;
        s->leaders[leader_of(s, corners[2])] = leader;
    }
}

static void add_to_shell(Shell *shell, const double *const corners[3])
{
    double cross[3];
    for (int k = 0; !shell->used && k < 3; k++) {
        shell->low[k]  = INFINITY;
        shell->high[k] = -INFINITY;
    }
    shell->used = true;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            shell->low[k]  = min2(shell->low[k], corners[i][k]);
            shell->high[k] = max2(shell->high[k], corners[i][k]);
        }
    cross3(corners[1], corners[2], cross);
    shell->volume += dot3(corners[0], cross);
}

static void measure(Shells *s)
{
    const double(*at)[3] = (const double(*)[3])s->contour->vertices.items;
    for (size_t i = 0; i < s->contour->triangles.count; i++) {
        const uint32_t *triangle = s->contour->triangles.items[i];
        const double   *corners[3];
        for (int k = 0; k < 3; k++)
            corners[k] = at[triangle[k]];
        add_to_shell(&s->shells[leader_of(s, triangle[0])], corners);
    }
}

static bool is_tiny_void(const Shell *shell, double error)
{
    double least = INFINITY, most = 0;
    for (int k = 0; k < 3; k++) {
        least = min2(least, shell->high[k] - shell->low[k]);
        most  = max2(most, shell->high[k] - shell->low[k]);
    }
    return shell->used && shell->volume <= 0 && least < error && most <= 2 * error;
}

static size_t choose(Shells *s)
{
    size_t dropped = 0;
    for (size_t i = 0; i < s->contour->vertices.count; i++) {
        Shell *shell   = &s->shells[i];
        shell->dropped = is_tiny_void(shell, s->contour->error);
        if (shell->dropped && dropped++ == 0)
            memcpy(s->at, s->contour->vertices.items[i], sizeof s->at);
    }
    return dropped;
}

/* Removes what is dropped; numbers of triangles in tetrahedra are stale then. */
static void drop(Shells *s)
{
    Contour  *contour  = s->contour;
    uint32_t *numbers  = arena_new_array(contour->arena, uint32_t, contour->vertices.count);
    size_t    vertices = 0, triangles = 0;
    for (size_t i = 0; i < contour->vertices.count; i++) {
        numbers[i] = (uint32_t)vertices;
        if (!s->shells[leader_of(s, (uint32_t)i)].dropped)
            memmove(contour->vertices.items[vertices++], contour->vertices.items[i],
                    sizeof *contour->vertices.items);
    }
    for (size_t i = 0; i < contour->triangles.count; i++) {
        const uint32_t *from = contour->triangles.items[i];
        if (s->shells[leader_of(s, from[0])].dropped)
            continue;
        uint32_t *to = contour->triangles.items[triangles++];
        for (int k = 0; k < 3; k++)
            to[k] = numbers[from[k]];
    }
    contour->vertices.count  = vertices;
    contour->triangles.count = triangles;
}

size_t voids_close(Contour *contour, double at[3])
{
    size_t count = contour->vertices.count;
    Shells s     = {.contour = contour,
                    .leaders = arena_new_array(contour->arena, uint32_t, count + 1),
                    .shells  = arena_new_array(contour->arena, Shell, count + 1)};
    join_vertices(&s);
    measure(&s);
    size_t dropped = choose(&s);
    if (dropped > 0) {
        drop(&s);
        memcpy(at, s.at, sizeof s.at);
    }
    return dropped;
}
