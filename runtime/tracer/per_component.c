/*
 * per_component.c: scenes of several heavy components, each marched by itself.
 *
 * The distance of a union costs as much as those of all components, at every step of every ray.
 * Instead, groups (KrsMarchGroup) are marched one after the other, the nearest first, each by a
 * kernel that has the distance of that group alone.  A ray is in the box of few of them, and ends
 * at the latest where it has hit another one.
 */
#include "runtime/tracer/phases.h"

#include <math.h>

/* A ray that begins inside of a solid sees the inner wall of the union, which no part of it knows;
   so the eye must be outside of everything. */
bool begins_outside(const Job *job, KrsFrame *frame)
{
    const KrsProgram *program   = job->rendering->program;
    const KrsCamera  *camera    = &job->view.camera;
    double            clearance = 0;
    if (camera->projection != KRS_ORTHOGRAPHIC)
        return krs_distance(frame, (const double(*)[3]) & camera->eye, 1, &clearance) == KRS_OK &&
               clearance > 0;
    for (int corner = 0; corner < 8; corner++) {
        double ahead = 0;
        for (int i = 0; i < 3; i++) {
            double side = corner >> i & 1 ? program->high[i] : program->low[i];
            ahead += (side - camera->eye[i]) * (camera->target[i] - camera->eye[i]);
        }
        if (!(ahead > 0))
            return false;
    }
    return true;
}

/* From the eye to the box. */
static double distance_to(const Job *job, const KrsMarchGroup *march_group)
{
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        double eye     = job->view.camera.eye[i];
        double lateral = fmax(fmax(march_group->low[i] - eye, eye - march_group->high[i]), 0);
        sum += lateral * lateral;
    }
    return sqrt(sum);
}

static bool find_kernels(Job *job, GroupMarch *march)
{
    KrsRendering *r = job->rendering;
    march->schedule = rendering_schedule_of_march_group(r, job->asked, march->march_group + 1);
    march->trace = rendering_trace(r, job->options.trace, march->schedule, march->march_group + 1);
    if (job->options.normals == KRS_NORMALS_ANALYTIC)
        return march->trace != NULL;
    march->normals = rendering_normals_kernel(r, job->options.normals, march->march_group + 1);
    return march->trace && march->normals;
}

bool per_component_prepare(Job *job, KrsFrame *frame)
{
    const KrsProgram *program = job->rendering->program;
    double            distance[KRS_MOST_MARCH_GROUPS];
    job->group_march_count = 0;
    if (!rendering_marches_per_component(job->rendering, job->options.components) ||
        !begins_outside(job, frame))
        return true;
    for (uint32_t march_group = 0; march_group < program->march_group_count; march_group++) {
        GroupMarch march        = {.march_group = march_group};
        double     box_distance = distance_to(job, &program->march_groups[march_group]);
        uint32_t   at           = job->group_march_count++;
        if (!find_kernels(job, &march))
            return false;
        for (; at > 0 && distance[at - 1] > box_distance; at--) {
            distance[at]           = distance[at - 1];
            job->group_marches[at] = job->group_marches[at - 1];
        }
        distance[at]           = box_distance;
        job->group_marches[at] = march;
    }
    return true;
}
