/*
 * methods.c: which method, schedule and grouping of components suit a scene on a device.
 */
#include "runtime/tracer/methods.h"

#include "rays/surfaces.h"
#include "runtime/tracer/research/research.h"

/* The operations of a distance below which refilling lanes costs more than it gains: in frames, and
   in a small first picture, for which its shaders compile longer. */
#define FLOPS_WORTH_REFILL          20
#define FLOPS_WORTH_REFILL_OF_SMALL 150
/* The threshold for a march group, which is higher, as few rays of its tiles meet it. */
#define FLOPS_WORTH_REFILL_OF_GROUP 350
/* The operations from which shaders of march groups take longer to compile than they save in a
   hundred small pictures with mirrors. */
#define FLOPS_WORTH_MIXED_RAYS 1200
/* The march groups that take longer to compile than they save in a single small picture. */
#define GROUPS_FOR_LARGE_PICTURES 3

static bool finds_roots(KrsTrace trace)
{
    const ResearchTrace *research = research_trace(trace);
    return trace == KRS_TRACE_EXACT || (research && !research->inverts);
}

void rendering_choose(const KrsRendering *rendering, KrsTrace *trace, KrsSchedule *schedule)
{
    const Gpu *gpu      = &rendering->renderer->gpu;
    bool       small    = rendering->purpose == KRS_FOR_SMALL_PICTURES;
    double     worth    = small ? FLOPS_WORTH_REFILL_OF_SMALL : FLOPS_WORTH_REFILL;
    bool       software = gpu_is_cpu(gpu);
    bool       refills  = rendering->program->flops >= worth && gpu->refill_lanes > 0;
    if (*trace == KRS_TRACE_DEFAULT)
        *trace = rendering->program->along ? KRS_TRACE_EXACT : KRS_TRACE_AUTO;
    /* Open surfaces have no thickness, so rays find them by roots alone. */
    if (rendering->program->open_surfaces && !finds_roots(*trace))
        *trace = KRS_TRACE_EXACT;
    if (*schedule == KRS_SCHEDULE_DEFAULT)
        *schedule = !software ? KRS_SCHEDULE_QUEUE
                    : refills ? KRS_SCHEDULE_REFILL
                              : KRS_SCHEDULE_PIXEL;
}

/* The most iterations of all loops of an invocation together.  Some devices end loops silently
   after 65,535 iterations, and there must be enough left to finish an item that is begun. */
#define MAX_ITERATIONS 24576

uint32_t rendering_steps_within(const KrsRendering *rendering, uint32_t wanted)
{
    uint32_t most = MAX_ITERATIONS / (1 + rendering->program->loops);
    return wanted < most ? wanted : most > 0 ? most : 1;
}

/* Tells whether saving rays is worth it.  Where lanes take new items anyway, it makes shaders
   larger and saves nothing. */
bool rendering_saves_rays(const KrsRendering *rendering, KrsSchedule schedule)
{
    return schedule != KRS_SCHEDULE_REFILL || rendering->program->loops > 0;
}

KrsSchedule rendering_schedule_of_march_group(const KrsRendering *rendering, KrsSchedule asked,
                                              uint32_t march_group)
{
    KrsTrace trace = KRS_TRACE_DEFAULT;
    bool     cheap = rendering->program->march_groups[march_group - 1].flops <
                 FLOPS_WORTH_REFILL_OF_GROUP;
    if (asked == KRS_SCHEDULE_DEFAULT && cheap && gpu_is_cpu(&rendering->renderer->gpu))
        return KRS_SCHEDULE_PIXEL;
    rendering_choose(rendering, &trace, &asked);
    return asked;
}

/* Tells whether planes are met at once.  Zones cut holes into planes, which are then marched like
   all else. */
bool rendering_knows_planes(const KrsRendering *rendering)
{
    return rendering->program->planes && rendering->zone_slots == 0;
}

/* Tells whether rays of light meet planes at once.  In media of previews, and from surfaces in
   their mirrors, rays may begin inside of a plane.  Those of paths begin some roundings above their
   surface. */
bool rendering_light_meets_planes(const KrsRendering *rendering, KrsIntegrator integrator)
{
    const KrsProgram *program = rendering->program;
    return rendering_knows_planes(rendering) &&
           (integrator != KRS_INTEGRATOR_PREVIEW || (!program->mirrors && !program->media));
}

bool rendering_lanes_find_surfaces(const KrsRendering *rendering)
{
    return rendering->renderer->gpu.texels && surface_field_suits(rendering->scene);
}

/* The rays of mirrors need shaders for the whole scene.  If those are for the picture, too, the first
   picture is earlier; march groups make up for their own shaders where flops are few. */
static bool prefers_mixed_rays(const KrsRendering *rendering)
{
    return rendering->program->mirrors && (rendering->purpose == KRS_FOR_SMALL_PICTURES ||
                                           (rendering->purpose == KRS_FOR_PICTURES &&
                                            rendering->program->flops >= FLOPS_WORTH_MIXED_RAYS));
}

static bool prefers_few_shaders(const KrsRendering *rendering)
{
    return rendering->purpose == KRS_FOR_SMALL_PICTURES &&
           rendering->program->march_group_count >= GROUPS_FOR_LARGE_PICTURES;
}

/* Drivers of devices of type CPU copy functions to where they are called.  Where nothing would be
   gathered, pictures of all sizes have the same shaders. */
bool rendering_gathers_noises(const KrsRendering *rendering)
{
    return rendering->purpose == KRS_FOR_SMALL_PICTURES && gpu_is_cpu(&rendering->renderer->gpu) &&
           rendering->program->noises >= KRS_MIN_FUSED_NOISES;
}

/* Tells whether components are marched one by one: by default only on devices of type CPU, since
   others skip far components by branches. */
bool rendering_marches_per_component(const KrsRendering *rendering, KrsComponents components)
{
    bool by_default = rendering->program->per_component && gpu_is_cpu(&rendering->renderer->gpu) &&
                      !rendering->renderer->early_outs && !prefers_mixed_rays(rendering) &&
                      !prefers_few_shaders(rendering);
    bool holes = rendering->program->planes && !rendering_knows_planes(rendering);
    return rendering->program->march_group_count > 0 && !rendering->program->along && !holes &&
           !rendering->camera_relative &&
           (components == KRS_COMPONENTS_DEFAULT ? by_default : components == KRS_COMPONENTS_APART);
}

bool rendering_mixes_rays(const KrsRendering *rendering)
{
    return (rendering->program->mirrors || rendering->purpose == KRS_FOR_PATHS) &&
           !rendering_marches_per_component(rendering, KRS_COMPONENTS_DEFAULT);
}

/* Beams step by distances.  Where rays go from root to root that takes a shader of its own. */
bool rendering_has_beams(const KrsRendering *rendering, KrsTrace trace)
{
    return trace < KRS_TRACE_EXACT || rendering->purpose != KRS_FOR_SMALL_PICTURES;
}

bool rendering_goes_along(const KrsRendering *rendering, KrsTrace trace)
{
    const KrsProgram    *program  = rendering->program;
    const ResearchTrace *research = research_trace(trace);
    const bool           known    = research ? research_applies(program, research)
                                             : trace == KRS_TRACE_EXACT && program->along;
    return known && !rendering->camera_relative;
}

bool rendering_marches_packed(const KrsRendering *rendering, KrsComponents components,
                              KrsTrace trace)
{
    bool by_default = rendering->program->expensive >= 2 && !gpu_is_cpu(&rendering->renderer->gpu);
    return rendering->program->scene_parts >= 2 && !rendering_goes_along(rendering, trace) &&
           (components == KRS_COMPONENTS_DEFAULT ? by_default
                                                 : components == KRS_COMPONENTS_PACKED);
}

KrsNormals rendering_normals(const KrsRendering *rendering, KrsNormals normals)
{
    if (rendering->program->open_surfaces)
        return KRS_NORMALS_ANALYTIC; /* differences see both sides of a sheet */
    if (normals != KRS_NORMALS_DEFAULT)
        return normals;
    return rendering->program->algebraic ? KRS_NORMALS_ANALYTIC : KRS_NORMALS_OCTAHEDRON;
}

bool rendering_has_roots(const KrsRendering *rendering, KrsTrace trace)
{
    return (trace == KRS_TRACE_EXACT || rendering->program->open_surfaces) &&
           rendering->program->along && !rendering->camera_relative;
}
