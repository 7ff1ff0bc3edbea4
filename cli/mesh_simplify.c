/* mesh_simplify.c: --simplify and --lods. */
#include <math.h>

#include "cli/meshing.h"

double mesher_part(const Options *options) { return options->mesh_simplify ? 0.5 : 1; }

static KrsStatus make_simpler(const Meshing *meshing, const KrsMesh *mesh, double error,
                              KrsMesh **simplified)
{
    KrsMeshOptions options = meshing->how;
    options.error          = error;
    return krs_mesh_simplify(mesh, &options, simplified);
}

static KrsStatus simplify_mesh(const Meshing *meshing, KrsMesh **mesh)
{
    KrsMesh  *simplified;
    KrsStatus status = make_simpler(meshing, *mesh, (*mesh)->error, &simplified);
    if (status != KRS_OK)
        return status;
    krs_mesh_free(*mesh);
    *mesh = simplified;
    return KRS_OK;
}

/* The assembly's number of triangles changes as well. */
static KrsStatus simplify_items(Meshing *meshing, KrsAssembly *assembly, double goal)
{
    KrsStatus status    = KRS_OK;
    assembly->triangles = 0;
    for (size_t i = 0; i < assembly->item_count && status == KRS_OK; i++) {
        KrsItem *item = &assembly->items[i];
        if (!item->mesh)
            continue;
        enter_step(meshing, step_of(meshing, goal, (double)(assembly->item_count - i)));
        status = simplify_mesh(meshing, &item->mesh);
        assembly->triangles += item->copies * (double)item->mesh->triangle_count;
    }
    return status;
}

/* Each has four times the error of the one before, and they are made of the first. */
static KrsStatus make_lods(Meshing *meshing, Body *body, double goal)
{
    double error = 3 * body->mesh->error;
    for (size_t i = 0; i < meshing->options->mesh_lods;
         i++, error = 4 * error + 3 * body->mesh->error) {
        enter_step(meshing, step_of(meshing, goal, (double)(meshing->options->mesh_lods - i)));
        KrsStatus status = make_simpler(meshing, body->mesh, error, &body->lods[i]);
        if (status != KRS_OK)
            return status;
        body->lod_count++;
    }
    return KRS_OK;
}

/* Where there are levels of detail as well, they take about as long as what comes before. */
KrsStatus simplify_body(Meshing *meshing, Body *body, double goal)
{
    KrsStatus status = KRS_OK;
    bool      solid  = body->mesh && body->mesh->triangle_count > 0;
    double    first  = step_of(meshing, goal, meshing->options->mesh_lods > 0 ? 2 : 1);
    if (meshing->options->mesh_simplify && solid) {
        enter_step(meshing, first);
        status = simplify_mesh(meshing, &body->mesh);
    }
    if (meshing->options->mesh_simplify && body->assembly)
        status = simplify_items(meshing, body->assembly, first);
    if (status == KRS_OK && solid)
        status = make_lods(meshing, body, goal);
    return status;
}
