/*
 * steps.c: how far the work of `krs mesh` has come, and whether it goes on.
 */
#include "cli/mesh/meshing.h"

void enter_step(Meshing *meshing, double goal)
{
    meshing->begun = meshing->done = meshing->goal;
    meshing->goal                  = goal;
}

double step_of(const Meshing *meshing, double goal, double steps)
{
    return meshing->goal + (goal - meshing->goal) / steps;
}

bool mesh_is_wanted(const Meshing *meshing)
{
    return !*interrupted() && !(meshing->outdated && meshing->outdated(meshing->user));
}
