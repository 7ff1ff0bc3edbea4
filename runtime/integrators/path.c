/*
 * path.c: integrators that follow random paths of light, from the eye to its sources.
 *
 * Each sample of a pixel follows one path.  At each surface it asks one light what it adds
 * (secondary.comp), and goes on in a direction from which much of the light comes
 * (scatter.comp).  What its rays meet before surfaces is added where they end (escape.comp).  All
 * paths take a step together: each pass is over those that are left.
 */
#include "runtime/integrators/integrators.h"
#include "runtime/integrators/photons.h"
#include "runtime/tracer/shaders.h"
#include "runtime/tracer/methods.h"
#include "runtime/tracer/primary.h"
#include "runtime/tracer/renderer.h"

/* The fractions of the time that passes take, about. */
#define WEIGHT_PRIMARY 0.3f
#define WEIGHT_BOUNCES 0.7f

typedef struct Paths {
    Job          *job;
    Plan         *plan;
    PathShaders   shaders;
    const Shader *plate;  /* NULL: no plate catches shadows */
    const Shader *escape; /* of rays that surfaces have scattered */
    uint32_t      bounces;
    float         weight; /* of the passes of a bounce */
} Paths;

static void add_items(const Paths *paths, KrsPhase phase, const Shader *shader, ListId in,
                      ListId out, PassConstants constants)
{
    plan_add(paths->plan, (Pass){.kind      = PASS_ITEMS,
                                 .phase     = phase,
                                 .weight    = 0.1f * paths->weight,
                                 .shader    = shader,
                                 .in        = in,
                                 .out       = out,
                                 .constants = constants});
}

static void add_rays_to_lights(const Paths *paths)
{
    plan_add(paths->plan, (Pass){.kind      = PASS_RAYS,
                                 .phase     = KRS_PHASE_SHADOWS,
                                 .weight    = 0.3f * paths->weight,
                                 .shader    = paths->shaders.shadows,
                                 .in        = LIST_TO_LIGHTS,
                                 .out       = NO_LIST,
                                 .constants = {.phase = RAYS_AS_CHOSEN}});
}

/* Adds the light of lamps that media scatter into the rays of a camera. */
static void add_beams(const Paths *paths)
{
    const KrsView *view  = &paths->job->view;
    bool           lamps = false;
    for (size_t i = 0; i < view->light_count; i++)
        lamps = lamps || view->lights[i].positional;
    if (!lamps)
        return;
    add_items(paths, KRS_PHASE_BOUNCES, paths->shaders.beam, LIST_OF_PIXELS, LIST_TO_LIGHTS,
              (PassConstants){0});
    add_rays_to_lights(paths);
}

/* Adds what happens where the rays of paths end: at surface `number`, from 0, or at none. */
static void add_surface(const Paths *paths, uint32_t number)
{
    const bool         volumes   = paths->shaders.track != NULL;
    const KrsRenderer *renderer  = paths->job->rendering->renderer;
    const RayKind      rays      = paths->job->rendering->rays;
    const bool         ends      = number == paths->bounces;
    PassConstants      constants = {.phase = ends ? PATHS_END : PATHS_GO_ON, .value = number};
    if (volumes && number == 0)
        add_beams(paths);
    if (volumes)
        add_items(paths, KRS_PHASE_BOUNCES, paths->shaders.track,
                  number == 0 ? LIST_OF_PIXELS : LIST_OF_PATHS, LIST_IN_VOLUMES,
                  (PassConstants){.value = number, .of_paths = number > 0});
    add_items(paths, KRS_PHASE_RESOLVE, number == 0 ? &renderer->escapes[rays] : paths->escape,
              number == 0 ? LIST_OF_BAND : LIST_OF_PATHS, LIST_ALL,
              (PassConstants){.value = number});
    /* The list of rays to lights is emptied ahead of the pass that writes two. */
    add_items(paths, KRS_PHASE_NORMALS, paths->shaders.normals, LIST_ALL, LIST_TO_LIGHTS,
              (PassConstants){0});
    if (number == 0 && paths->plate)
        add_items(paths, KRS_PHASE_NORMALS, paths->plate, LIST_ALL, NO_LIST, (PassConstants){0});
    add_items(paths, KRS_PHASE_SHADING, paths->shaders.scatter, LIST_ALL, LIST_OF_PATHS, constants);
    if (volumes)
        add_items(paths, KRS_PHASE_SHADING, paths->shaders.collide, LIST_IN_VOLUMES, NO_LIST,
                  constants);
    if (!ends && (paths->job->view.light_count > 0 || paths->job->view.sky.map))
        add_rays_to_lights(paths);
}

static bool add_paths(Job *job, Plan *plan, uint32_t bounces)
{
    const KrsRenderOptions *o     = &job->options;
    KrsRendering           *r     = job->rendering;
    Paths                   paths = {.job = job, .plan = plan, .bounces = bounces};
    paths.weight                  = WEIGHT_BOUNCES / (float)(bounces + 1);
    plan->has_paths               = true;
    if (!primary_add_marches(job, plan, WEIGHT_PRIMARY, NULL) ||
        !renderer_create_escapes(r->renderer, r->rays, &r->spirv_ms, &r->pipeline_ms) ||
        !rendering_paths(r, o, KRS_FOR_PATHS, job_light_meets_planes(job), &paths.shaders) ||
        !primary_find_plate(job, &paths.plate))
        return false;
    paths.escape = renderer_escape_of_paths(r);
    if (o->caustics == KRS_CAUSTICS_PHOTONS && r->program->mirrors) {
        plan->before = photons_new(job);
        if (!plan->before.own)
            return false;
    }
    const March march = primary_march_of_paths(job, paths.shaders.march);
    for (uint32_t number = 0; number <= bounces; number++) {
        add_surface(&paths, number);
        if (number == 0 && bounces > 0)
            plan_add_march(plan, &march, 0.4f * paths.weight);
        else if (number < bounces)
            plan_add_march_again(plan, 0.4f * paths.weight);
    }
    return paths.escape && !plan->failed;
}

/* Glass does not count as a surface, but paths go through so many boundaries at most. */
#define MAX_BOUNDARIES 8

bool direct_plan(Job *job, Plan *plan)
{
    return add_paths(job, plan, job->rendering->program->media ? 1 + MAX_BOUNDARIES : 1);
}

bool path_plan(Job *job, Plan *plan) { return add_paths(job, plan, job->options.bounces); }
