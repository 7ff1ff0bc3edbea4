/* mesh_simplify.c: --simplify and --lods. */
#include <math.h>

#include "cli/meshing.h"

double mesher_part(const Options *options) { return options->mesh_simplify ? 0.5 : 1; }

static KrsStatus simplify_mesh(KrsMesh **mesh)
{
    KrsMesh  *simplified;
    KrsStatus status = krs_mesh_simplify(*mesh, (*mesh)->error, &simplified);
    if (status != KRS_OK)
        return status;
    krs_mesh_free(*mesh);
    *mesh = simplified;
    return KRS_OK;
}

/* The assembly's number of triangles changes as well. */
static KrsStatus simplify_items(KrsAssembly *assembly)
{
    KrsStatus status    = KRS_OK;
    assembly->triangles = 0;
    for (size_t i = 0; i < assembly->item_count && status == KRS_OK; i++) {
        KrsItem *item = &assembly->items[i];
        if (!item->mesh)
            continue;
        status = simplify_mesh(&item->mesh);
        assembly->triangles += item->copies * (double)item->mesh->triangle_count;
    }
    return status;
}

/* Each has four times the error of the one before, and they are made of the first. */
static KrsStatus make_lods(const Meshing *meshing, Body *body)
{
    double error = 3 * body->mesh->error;
    for (size_t i = 0; i < meshing->options->mesh_lods;
         i++, error = 4 * error + 3 * body->mesh->error) {
        KrsStatus status = krs_mesh_simplify(body->mesh, error, &body->lods[i]);
        if (status != KRS_OK)
            return status;
        body->lod_count++;
    }
    return KRS_OK;
}

KrsStatus simplify_body(const Meshing *meshing, Body *body)
{
    KrsStatus status = KRS_OK;
    if (meshing->options->mesh_simplify && body->mesh && body->mesh->triangle_count > 0)
        status = simplify_mesh(&body->mesh);
    if (meshing->options->mesh_simplify && body->assembly)
        status = simplify_items(body->assembly);
    if (status == KRS_OK && body->mesh && body->mesh->triangle_count > 0)
        status = make_lods(meshing, body);
    return status;
}
