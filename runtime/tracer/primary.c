/*
 * primary.c: passes that find what the rays of pixels hit.
 *
 * The distance of a union costs as much as those of all components together, at every step of every
 * ray.  So scenes of several expensive components are split into march groups (KrsMarchGroup).
 * These are marched one after the other, the nearest first, each by a shader with the distance of
 * that group alone.  A ray meets the boxes of few groups, and ends at the latest where it has hit
 * another one.
 */
#include "runtime/tracer/primary.h"

#include <math.h>
#include <string.h>

#include "runtime/tracer/shaders.h"
#include "runtime/tracer/lane_fields.h"
#include "runtime/tracer/lane_rays.h"
#include "runtime/tracer/methods.h"
#include "runtime/tracer/renderer.h"
#include "runtime/tracer/research/research.h"

/* Returns the distance from the eye to the box of a group. */
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

/* Lists the numbers of the march groups, counted from 1, the nearest first.  Returns how many. */
static size_t sort_groups(const Job *job, uint32_t groups[KRS_MAX_MARCH_GROUPS])
{
    const KrsProgram *program = job->rendering->program;
    double            distance[KRS_MAX_MARCH_GROUPS];
    for (uint32_t number = 0; number < program->march_group_count; number++) {
        double   own = distance_to(job, &program->march_groups[number]);
        uint32_t at  = number;
        for (; at > 0 && distance[at - 1] > own; at--) {
            distance[at] = distance[at - 1];
            groups[at]   = groups[at - 1];
        }
        distance[at] = own;
        groups[at]   = number + 1;
    }
    return program->march_group_count;
}

/* Makes the march of a group by itself.  The first group's rays also find the planes, which may be
   anywhere, so they are not confined to a window. */
static bool march_of_group(Job *job, uint32_t group, bool first, March *march)
{
    KrsRendering        *r   = job->rendering;
    const KrsMarchGroup *own = &r->program->march_groups[group - 1];
    KrsSchedule schedule     = rendering_schedule_of_march_group(r, job->asked_schedule, group);
    Shader     *shader       = rendering_trace(r, job->options.methods.trace, schedule, group);
    *march                   = (March){.rays     = shader,
                                       .beams    = job_has_beams(job) ? shader : NULL,
                                       .schedule = schedule,
                                       .phase    = KRS_PHASE_PRIMARY,
                                       .flops    = own->flops,
                                       .boxed    = true,
                                       .windowed = !first || !rendering_knows_planes(r)};
    memcpy(march->low, own->low, sizeof march->low);
    memcpy(march->high, own->high, sizeof march->high);
    return shader != NULL;
}

/* Finds the shader of normals for all components, if they are wanted. */
static bool find_normals(Job *job, Primary *primary)
{
    if (!primary)
        return true;
    primary->normals = rendering_normals_shader(job->rendering, job->options.methods.normals, 0);
    return primary->normals != NULL;
}

/* Adds the planes, which need no march, as a group with normals of its own. */
static bool add_planes(Job *job, Primary *primary)
{
    OwnGroup *group = &primary->groups[primary->group_count];
    if (!rendering_knows_planes(job->rendering))
        return true;
    *group = (OwnGroup){0, rendering_normals_shader(job->rendering, job->options.methods.normals,
                                                    KRS_MARCH_GROUP_OF_PLANES)};
    primary->group_count++;
    return group->normals != NULL;
}

/* Finds the shader of normals for a march group. */
static bool find_own_normals(Job *job, uint32_t march_group, OwnGroup *group)
{
    *group = (OwnGroup){
        march_group,
        rendering_normals_shader(job->rendering, job->options.methods.normals, march_group)};
    return group->normals != NULL;
}

static bool add_groups(Job *job, Plan *plan, float weight, Primary *primary)
{
    uint32_t     groups[KRS_MAX_MARCH_GROUPS];
    const size_t count       = sort_groups(job, groups);
    const bool   own_normals = primary && job->options.methods.normals != KRS_NORMALS_ANALYTIC;
    for (size_t i = 0; i < count; i++) {
        March march;
        if (!march_of_group(job, groups[i], i == 0, &march))
            return false;
        plan_add_march(plan, &march, weight / (float)count);
        if (own_normals && !find_own_normals(job, groups[i], &primary->groups[i]))
            return false;
    }
    if (own_normals)
        primary->group_count = count;
    return own_normals ? add_planes(job, primary) : find_normals(job, primary);
}

/* Clips rays to the box around all components but planes, which rays intersect without a march. */
static void clip_to_rest(const Job *job, March *march)
{
    march->boxed = true;
    job_find_rest(job, march->low, march->high);
}

/* Adds one march of all components: together, or scene part by scene part within each ray. */
static bool add_whole(Job *job, Plan *plan, float weight)
{
    const KrsRenderOptions *options = &job->options;
    KrsRendering           *r       = job->rendering;
    const bool     outside = job->begins_outside, planes = rendering_knows_planes(r) && outside;
    const bool     packed = outside && rendering_marches_packed(r, options->methods.components,
                                                                options->methods.trace);
    const uint32_t group  = packed ? MARCH_PACKED : planes ? MARCH_WITHOUT_PLANES : 0;
    March          march  = {.schedule = options->methods.schedule,
                             .phase    = KRS_PHASE_PRIMARY,
                             .flops    = r->program->flops};
    march.rays = rendering_trace(r, options->methods.trace, options->methods.schedule, group);
    if (job_has_beams(job))
        march.beams = rendering_beams(r, options->methods.trace, options->methods.schedule, group);
    if (planes)
        clip_to_rest(job, &march);
    plan_add_march(plan, &march, weight);
    return march.rays && (march.beams || !job_has_beams(job));
}

March primary_march_of_paths(const Job *job, Shader *shader)
{
    March march = {.rays     = shader,
                   .schedule = job->options.methods.schedule,
                   .phase    = KRS_PHASE_BOUNCES,
                   .of_paths = true,
                   .flops    = job->rendering->program->flops};
    if (rendering_knows_planes(job->rendering))
        clip_to_rest(job, &march);
    return march;
}

static bool add_research(Job *job, Plan *plan)
{
    KrsRendering *r = job->rendering;
    ResearchPass  research;
    if (!research_pass(&job->options, r->program, &research))
        return true;
    const Shader *shader = rendering_research(r, &research);
    plan_add(plan, (Pass){.kind      = PASS_ITEMS,
                          .phase     = KRS_PHASE_PRIMARY,
                          .shader    = shader,
                          .in        = LIST_OF_BAND,
                          .out       = NO_LIST,
                          .constants = {.value = research.value}});
    return shader != NULL;
}

/* Adds the caller's depths, behind which there are no hits. */
static bool add_limit(Job *job, Plan *plan)
{
    KrsRendering *r = job->rendering;
    if (!job->options.depth)
        return true;
    const Shader *shader = renderer_limit(r->renderer, r->rays, &r->spirv_ms, &r->pipeline_ms);
    plan_add(plan, (Pass){.kind   = PASS_ITEMS,
                          .phase  = KRS_PHASE_RESOLVE,
                          .shader = shader,
                          .in     = LIST_OF_BAND,
                          .out    = NO_LIST});
    return shader != NULL;
}

bool primary_find_plate(Job *job, const Shader **shader)
{
    KrsRendering *r = job->rendering;
    *shader         = NULL;
    if (!r->catches)
        return true;
    *shader = renderer_plate(r->renderer, &r->spirv_ms, &r->pipeline_ms);
    return *shader != NULL;
}

/* Refuses lanes: no shader marches the rays of a scene that is too large. */
static void refuse_lanes(Job *job, const char *reason)
{
    const KrsDiagnostic *why = krs_scene_too_large(job->rendering->scene);
    if (why)
        gpu_refuse(job->gpu, KRS_BAD_SCENE,
                   "%s, so no shader is made of it (%s), and lanes cannot march these rays: %s",
                   why->message, why->code, reason);
    else
        gpu_refuse(job->gpu, KRS_BAD_ARGUMENT, "lanes cannot march these rays: %s", reason);
}

/* Adds the pass in which lanes of the host march all components. */
static bool add_lanes(Job *job, Plan *plan, float weight)
{
    const char *reason = lane_rays_refuse(job);
    if (reason) {
        refuse_lanes(job, reason);
        return false;
    }
    plan->field  = lane_fields_rays(job->rendering, job->state, lane_rays_know_planes(job));
    plan->failed = plan->failed || !plan->field;
    plan_add(plan, (Pass){.kind = PASS_LANES, .phase = KRS_PHASE_PRIMARY, .weight = weight});
    return !plan->failed;
}

bool primary_add_marches(Job *job, Plan *plan, float weight, Primary *primary)
{
    KrsRendering *r             = job->rendering;
    const bool    per_component = job->begins_outside &&
                               rendering_marches_per_component(r, job->options.methods.components);
    if (primary)
        *primary = (Primary){0};
    const ResearchTrace *research = research_trace(job->options.methods.trace);
    if (research && !job->begins_outside)
        job->options.methods.trace = research->from_inside;
    if (job->options.methods.executor == KRS_EXECUTOR_LANES)
        return (lane_rays_find_normals(job) || find_normals(job, primary)) &&
               add_lanes(job, plan, weight);
    if (per_component || job_has_beams(job))
        plan_add(plan, (Pass){.kind = PASS_CLEAR, .phase = KRS_PHASE_BEAMS});
    bool added = per_component ? add_groups(job, plan, weight, primary)
                               : find_normals(job, primary) && add_whole(job, plan, weight);
    return added && add_research(job, plan) && add_limit(job, plan);
}

void primary_add_normals(Plan *plan, float weight, const Primary *primary)
{
    Pass pass = {.kind        = PASS_ITEMS,
                 .phase       = KRS_PHASE_NORMALS,
                 .weight      = weight,
                 .shader      = primary->normals,
                 .in          = LIST_ALL,
                 .out         = NO_LIST,
                 .short_items = true};
    /* Each group's own shader finds the normals there: at the surface of one group the distances of
       the others do not matter. */
    plan->by_march_group = primary->group_count > 0;
    if (primary->group_count == 0 && primary->normals)
        plan_add(plan, pass);
    for (size_t i = 0; i < primary->group_count; i++) {
        pass.shader        = primary->groups[i].normals;
        pass.in            = LIST_OF_MARCH_GROUP + primary->groups[i].march_group;
        pass.weight        = weight / (float)primary->group_count;
        pass.with_previous = i > 0;
        plan_add(plan, pass);
    }
}
