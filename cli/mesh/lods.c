/* lods.c: levels of detail. */
#include <math.h>

#include "cli/mesh/meshing.h"

/* Makes the levels of detail from the first, each with four times the error of the one before. */
KrsStatus make_lods(Meshing *meshing, Body *body, double goal)
{
    double error = 3 * body->mesh->error;
    for (size_t i = 0; i < meshing->options->mesh_lods;
         i++, error = 4 * error + 3 * body->mesh->error) {
        KrsMeshOptions options = meshing->how;
        options.error          = error;
        enter_step(meshing, step_of(meshing, goal, (double)(meshing->options->mesh_lods - i)));
        KrsStatus status = krs_mesh_simplify(body->mesh, &options, &body->lods[i]);
        if (status != KRS_OK)
            return status;
        body->lod_count++;
    }
    return KRS_OK;
}
