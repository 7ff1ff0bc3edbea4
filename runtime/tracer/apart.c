/*
 * apart.c: scenes of several heavy components, each marched by itself.
 *
 * The distance of a union costs as much as those of all components, at every step of every ray.
 * Marched one group after the other (KrsGroup), the nearest first, each by a kernel that has the
 * distance of that group alone, a ray is in the box of few of them, and ends at the latest where it
 * has hit another one.
 */
#include "runtime/tracer/phases.h"

#include <math.h>

/* A ray that begins inside of a solid sees the inner wall of the union, which no part of it knows;
   so the eye must be outside of everything. */
bool begins_outside(const Job *job, KrsFrame *frame)
{
    const KrsProgram *program = job->rendering->program;
    const KrsCamera  *camera  = &job->view.camera;
    double            room    = 0;
    if (camera->projection != KRS_ORTHOGRAPHIC)
        return krs_distance(frame, (const double(*)[3]) & camera->eye, 1, &room) == KRS_OK &&
               room > 0;
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
static double distance_to(const Job *job, const KrsGroup *group)
{
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        double eye   = job->view.camera.eye[i];
        double aside = fmax(fmax(group->low[i] - eye, eye - group->high[i]), 0);
        sum += aside * aside;
    }
    return sqrt(sum);
}

static bool find_kernels(Job *job, MarchPart *part)
{
    KrsRendering *r = job->rendering;
    part->schedule  = rendering_schedule_of_group(r, job->asked, part->group + 1);
    part->trace     = rendering_trace(r, job->options.trace, part->schedule, part->group + 1);
    if (job->options.normals == KRS_NORMALS_ANALYTIC)
        return part->trace != NULL;
    part->normals = rendering_around(r, job->options.normals, part->group + 1);
    return part->trace && part->normals;
}

bool apart_prepare(Job *job, KrsFrame *frame)
{
    const KrsProgram *program = job->rendering->program;
    double            distance[KRS_MOST_GROUPS];
    job->part_count = 0;
    if (!rendering_marches_apart(job->rendering, job->options.components) ||
        !begins_outside(job, frame))
        return true;
    for (uint32_t group = 0; group < program->group_count; group++) {
        MarchPart part = {.group = group};
        double    away = distance_to(job, &program->groups[group]);
        uint32_t  at   = job->part_count++;
        if (!find_kernels(job, &part))
            return false;
        for (; at > 0 && distance[at - 1] > away; at--) {
            distance[at]   = distance[at - 1];
            job->parts[at] = job->parts[at - 1];
        }
        distance[at]   = away;
        job->parts[at] = part;
    }
    return true;
}
