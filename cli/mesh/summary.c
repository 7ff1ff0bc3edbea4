/* summary.c: how large meshes are, and how near to the surface. */
#include <math.h>
#include <string.h>

#include "cli/mesh/meshing.h"

static void add_mesh(void *user, const KrsMesh *mesh, const KrsItem *item)
{
    Summary *all    = user;
    double   copies = item ? item->copies : 1;
    double   scale  = item ? sqrt(item->first_copy[0][0] * item->first_copy[0][0] +
                                  item->first_copy[0][1] * item->first_copy[0][1] +
                                  item->first_copy[0][2] * item->first_copy[0][2])
                           : 1;
    if (mesh->unresolved > 0 && all->unresolved == 0)
        memcpy(all->unresolved_at, mesh->unresolved_at, sizeof all->unresolved_at);
    all->unresolved += mesh->unresolved;
    all->error    = fmax(all->error, scale * mesh->error);
    all->estimate = all->estimate || mesh->estimate;
    all->colored  = all->colored || mesh->colored;
    all->triangles += copies * (double)mesh->triangle_count;
    all->vertices += copies * (double)mesh->vertex_count;
    all->copies += copies;
    for (size_t i = 0; !item && i < mesh->vertex_count; i++)
        for (int k = 0; k < 3; k++) {
            all->low[k]  = fmin(all->low[k], mesh->vertices[i][k]);
            all->high[k] = fmax(all->high[k], mesh->vertices[i][k]);
        }
}

static void add_body_beams(const Body *body, Summary *all)
{
    all->beams += body->beam_count;
    for (size_t i = 0; i < 2 * body->beam_count; i++)
        for (int k = 0; k < 3; k++) {
            const KrsBeam *beam = &body->beams[i / 2];
            all->low[k]         = fmin(all->low[k], beam->ends[i % 2][k] - beam->radii[i % 2]);
            all->high[k]        = fmax(all->high[k], beam->ends[i % 2][k] + beam->radii[i % 2]);
        }
}

Summary summarize(const Bodies *bodies)
{
    Summary all = {.low  = {INFINITY, INFINITY, INFINITY},
                   .high = {-INFINITY, -INFINITY, -INFINITY}};
    for (size_t i = 0; i < bodies->count; i++) {
        const KrsAssembly *assembly = bodies->items[i].assembly;
        visit_meshes(&bodies->items[i], add_mesh, &all);
        add_body_beams(&bodies->items[i], &all);
        for (int k = 0; assembly && k < 3; k++) {
            all.low[k]  = fmin(all.low[k], assembly->low[k]);
            all.high[k] = fmax(all.high[k], assembly->high[k]);
        }
    }
    return all;
}

double longest_side(const Bodies *bodies)
{
    Summary all     = summarize(bodies);
    double  longest = 0;
    for (int k = 0; k < 3; k++)
        longest = fmax(longest, all.high[k] - all.low[k]);
    return longest;
}

double assembly_error(const KrsAssembly *assembly)
{
    Summary all = {.error = 0};
    for (size_t i = 0; i < assembly->item_count; i++)
        if (assembly->items[i].mesh)
            add_mesh(&all, assembly->items[i].mesh, &assembly->items[i]);
    return all.error;
}
