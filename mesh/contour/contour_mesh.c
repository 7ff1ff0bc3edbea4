/* contour_mesh.c: makes the triangles of all patches. */
#include <string.h>

#include "mesh/contour/contour.h"

/* Orders patches as their tetrahedra, and drops those of tetrahedra that were bisected. */
static void arrange_patches(Contour *contour)
{
    Tets   *tets           = contour->tets;
    Patches swap           = contour->before;
    contour->before        = contour->patches;
    contour->patches       = swap;
    contour->patches.count = 0;
    for (size_t i = 0; i < tets->list.count; i++) {
        Tet *tet = &tets->list.items[i];
        if (tet->triangle_count == 0)
            continue;
        uint32_t before = tet->patch;
        tet->patch      = (uint32_t)contour->patches.count;
        array_push_large(contour->arena, &contour->patches, contour->before.items[before]);
    }
}

static uint32_t add_vertex(Contour *contour, const double at[3])
{
    array_reserve_large(contour->arena, &contour->vertices);
    memcpy(contour->vertices.items[contour->vertices.count], at, 3 * sizeof *at);
    return (uint32_t)contour->vertices.count++;
}

static void add_triangle(Contour *contour, uint32_t a, uint32_t b, uint32_t c)
{
    array_reserve_large(contour->arena, &contour->triangles);
    uint32_t *triangle = contour->triangles.items[contour->triangles.count++];
    triangle[0]        = a;
    triangle[1]        = b;
    triangle[2]        = c;
}

static uint32_t vertex_for(Contour *contour, uint32_t *number, const double at[3])
{
    if (*number == NO_NUMBER)
        *number = add_vertex(contour, at);
    return *number;
}

static uint32_t find_loop(Contour *contour, const Patch *patch, uint32_t loop[8])
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < patch->corner_count; i++) {
        const Crossing *crossing = &contour->crossings.items[patch->crossings[i]];
        const FaceLine *line     = &contour->lines.items[patch->lines[i]];
        loop[count++] = vertex_for(contour, &contour->vertex_of[patch->crossings[i]], crossing->at);
        if (line->bent)
            loop[count++] = vertex_for(
                contour, &contour->vertex_of[contour->crossings.count + patch->lines[i]], line->at);
    }
    return count;
}

static void add_triangles(Contour *contour, const Patch *patch)
{
    Tet     *tet = &contour->tets->list.items[patch->tet];
    uint32_t loop[8], count = find_loop(contour, patch, loop);
    tet->first_triangle = (uint32_t)contour->triangles.count;
    if (patch->fan) {
        uint32_t apex = add_vertex(contour, patch->apex);
        for (uint32_t i = 0; i < count; i++)
            add_triangle(contour, loop[i], loop[(i + 1) % count], apex);
        return;
    }
    uint32_t first = patch_diagonal(contour, patch);
    add_triangle(contour, loop[first], loop[first + 1], loop[first + 2]);
    if (count == 4)
        add_triangle(contour, loop[first], loop[first + 2], loop[(first + 3) % 4]);
}

void contour_find(Contour *contour)
{
    arrange_patches(contour);
    size_t numbers     = contour->crossings.count + contour->lines.count;
    contour->vertex_of = arena_new_array(contour->arena, uint32_t, numbers + 1);
    memset(contour->vertex_of, 0xff, (numbers + 1) * sizeof *contour->vertex_of);
    contour->vertices.count = contour->triangles.count = 0;
    for (size_t i = 0; i < contour->patches.count; i++)
        add_triangles(contour, &contour->patches.items[i]);
    arena_release(contour->arena, contour->vertex_of, (numbers + 1) * sizeof(uint32_t));
}
