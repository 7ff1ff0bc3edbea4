/*
 * kernels.c: a map of the kernels that contain functions of the scene.
 *
 * The key of a kernel is what it is made from: its file, the scene's variant, the functions that it
 * calls and its defines (variants.c).  So an option that changes none of these needs no new kernel.
 * An option that changes some of them needs no change here.
 */
#include "runtime/tracer/kernels.h"

#include <stdio.h>
#include <string.h>

#include "runtime/tracer/methods.h"
#include "runtime/tracer/renderer.h"
#include "runtime/tracer/variants.h"
#include "runtime/tracer/prewarm.h"

struct KernelEntry {
    const char   *file;
    KernelVariant variant;
    Kernel        kernel; /* zero until it is made */
    KernelEntry  *next;
};

static bool is_of(const KernelEntry *entry, const char *file, const KernelVariant *variant)
{
    const KernelScene *a = &entry->variant.scene, *b = &variant->scene;
    return strcmp(entry->file, file) == 0 &&
           krs_variant_hash(&a->variant, a->wanted, a->wanted_count) ==
               krs_variant_hash(&b->variant, b->wanted, b->wanted_count) &&
           strcmp(entry->variant.defines, variant->defines) == 0;
}

/* Finds the entry of a kernel, or adds one; NULL with the failure noted. */
static KernelEntry *find_entry(KrsRendering *rendering, const char *file, KernelVariant variant)
{
    KernelEntry *entry = rendering->kernels.first;
    while (entry && !is_of(entry, file, &variant))
        entry = entry->next;
    if (entry)
        return entry;
    entry = gpu_alloc(&rendering->renderer->gpu, 1, sizeof *entry, "prepare the scene");
    if (entry) {
        *entry                   = (KernelEntry){file, variant, {0}, rendering->kernels.first};
        rendering->kernels.first = entry;
    }
    return entry;
}

static KernelRequest request_of(KernelEntry *entry)
{
    return (KernelRequest){&entry->kernel, variant_source(entry->file, &entry->variant)};
}

static Kernel *find_kernel(KrsRendering *rendering, const char *file, KernelVariant variant)
{
    KernelEntry *entry = find_entry(rendering, file, variant);
    if (!entry || entry->kernel.pipeline)
        return entry ? &entry->kernel : NULL;
    KernelRequest request = request_of(entry);
    if (!kernels_make(rendering->renderer, rendering->scene_set, &request, 1, &rendering->spirv_ms,
                      &rendering->pipeline_ms))
        return NULL;
    return &entry->kernel;
}

/* ---- each kernel ---- */

/* The schedule `queue` uses the kernel of `pixel`, with fewer steps in a dispatch. */
static KrsSchedule schedule_of_kernel(KrsSchedule schedule)
{
    return schedule == KRS_SCHEDULE_QUEUE ? KRS_SCHEDULE_PIXEL : schedule;
}

Kernel *rendering_trace(KrsRendering *rendering, KrsTrace trace, KrsSchedule schedule,
                        uint32_t march_group)
{
    schedule = schedule_of_kernel(schedule);
    return find_kernel(rendering, "trace.comp",
                       variant_of_trace(rendering, trace, schedule, march_group));
}

Kernel *rendering_beams(KrsRendering *rendering, KrsTrace trace, KrsSchedule schedule,
                        uint32_t march_group)
{
    return rendering_trace(rendering, trace >= KRS_TRACE_EXACT ? KRS_TRACE_PLAIN : trace, schedule,
                           march_group);
}

static KernelVariant variant_of_rays(const KrsRendering *rendering, KrsSchedule schedule,
                                     bool by_roots, KrsIntegrator integrator)
{
    return variant_of_secondary(rendering, by_roots ? KRS_TRACE_EXACT : KRS_TRACE_PLAIN,
                                schedule_of_kernel(schedule), integrator);
}

Kernel *rendering_secondary(KrsRendering *rendering, KrsSchedule schedule, bool by_roots)
{
    return find_kernel(rendering, "secondary.comp",
                       variant_of_rays(rendering, schedule, by_roots, KRS_INTEGRATOR_PREVIEW));
}

Kernel *rendering_occluders(KrsRendering *rendering)
{
    return find_kernel(rendering, "occluders.comp", variant_of_occluders(rendering));
}

Kernel *rendering_normals_kernel(KrsRendering *rendering, KrsNormals normals, uint32_t march_group)
{
    return find_kernel(
        rendering, "normals.comp",
        variant_of_normals(rendering, rendering_normals(rendering, normals), march_group));
}

static KernelVariant variant_of_questions(const KrsRendering *rendering, KrsSchedule schedule)
{
    return variant_of_query(rendering,
                            rendering->program->sheets ? KRS_TRACE_EXACT : KRS_TRACE_AUTO,
                            schedule_of_kernel(schedule));
}

Kernel *rendering_query(KrsRendering *rendering, KrsSchedule schedule)
{
    return find_kernel(rendering, "query.comp", variant_of_questions(rendering, schedule));
}

Kernel *rendering_even_hits(KrsRendering *rendering)
{
    return find_kernel(rendering, "even_hits.comp", variant_of_even_hits(rendering));
}

Kernel *rendering_shade(KrsRendering *rendering)
{
    return find_kernel(rendering, "shade.comp", variant_of_shade(rendering));
}

Kernel *rendering_point_query(KrsRendering *rendering)
{
    return find_kernel(rendering, "point_query.comp", variant_of_point_query(rendering));
}

/* ---- paths ---- */

/* Methods that try balls work outside of solids only, and from a start that is far from surfaces. */
static KrsTrace trace_of_paths(KrsTrace trace)
{
    return trace >= KRS_TRACE_DIRECTIONAL ? KRS_TRACE_AUTO : trace;
}

static uint32_t group_of_paths(const KrsRendering *rendering)
{
    return rendering_knows_planes(rendering) ? MARCH_WITHOUT_PLANES : 0;
}

bool rendering_paths(KrsRendering *rendering, const KrsRenderOptions *options, KrsPurpose purpose,
                     PathKernels *kernels)
{
    const RayKind rays  = rendering->rays;
    const bool    roots = rendering_has_roots(rendering, options->trace);
    const bool    paths = purpose == KRS_FOR_PATHS;
    rendering->rays     = rendering_mixes_rays(rendering) ? rays : RAYS_OF_PATHS;
    kernels->march   = rendering_trace(rendering, trace_of_paths(options->trace), options->schedule,
                                       group_of_paths(rendering));
    rendering->rays  = paths ? RAYS_OF_PATHS : rendering->rays;
    kernels->normals = rendering_normals_kernel(rendering, options->normals, 0);
    rendering->rays  = paths ? RAYS_OF_PATHS : rays; /* those of pictures are for paths, too */
    kernels->scatter = paths ? find_kernel(rendering, "scatter.comp",
                                           variant_of_scatter(rendering, options->starts,
                                                              options->integrator))
                             : rendering_shade(rendering);
    kernels->shadows = find_kernel(
        rendering, "secondary.comp",
        variant_of_rays(rendering, options->schedule, roots, options->integrator));
    rendering->rays = rays;
    return kernels->march && kernels->normals && kernels->scatter && kernels->shadows;
}

/* ---- kernels that are made at the same time ---- */

typedef struct Requests {
    KrsRendering *rendering;
    KernelRequest items[KERNELS_AT_ONCE];
    size_t        count;
    bool          failed; /* the failure is noted */
} Requests;

static bool is_requested(const Requests *requests, const Kernel *kernel)
{
    bool found = false;
    for (size_t i = 0; i < requests->count; i++)
        found = found || requests->items[i].kernel == kernel;
    return found;
}

static void request(Requests *requests, const char *file, KernelVariant variant)
{
    KernelEntry *entry = find_entry(requests->rendering, file, variant);
    requests->failed   = requests->failed || !entry;
    if (entry && !entry->kernel.pipeline && !is_requested(requests, &entry->kernel))
        requests->items[requests->count++] = request_of(entry);
}

static bool is_for_pictures(KrsPurpose purpose)
{
    return purpose == KRS_FOR_PICTURES || purpose == KRS_FOR_SMALL_PICTURES;
}

/* Requests the kernels that march.  Where march groups are marched one after the other, each has
   its own kernel for rays and its own for normals. */
static void request_marches(Requests *requests, KrsTrace trace, KrsSchedule schedule)
{
    KrsRendering *rendering = requests->rendering;
    KrsNormals    usual     = rendering_normals(rendering, KRS_NORMALS_DEFAULT);
    bool     per_component  = rendering_marches_per_component(rendering, KRS_COMPONENTS_DEFAULT);
    bool     packed         = rendering_marches_packed(rendering, KRS_COMPONENTS_DEFAULT, trace);
    uint32_t whole          = packed                              ? MARCH_PACKED
                              : rendering_knows_planes(rendering) ? MARCH_WITHOUT_PLANES
                                                                  : 0;
    uint32_t groups         = per_component ? (uint32_t)rendering->program->march_group_count : 0;
    if (trace == KRS_TRACE_EXACT && rendering_has_beams(rendering, trace))
        request(requests, "trace.comp",
                variant_of_trace(rendering, KRS_TRACE_PLAIN, schedule, whole));
    if (!per_component)
        request(requests, "trace.comp", variant_of_trace(rendering, trace, schedule, whole));
    for (uint32_t march_group = 1; march_group <= groups; march_group++) {
        KrsSchedule own = schedule_of_kernel(
            rendering_schedule_of_march_group(rendering, KRS_SCHEDULE_DEFAULT, march_group));
        request(requests, "trace.comp", variant_of_trace(rendering, trace, own, march_group));
        if (is_for_pictures(rendering->purpose))
            request(requests, "normals.comp", variant_of_normals(rendering, usual, march_group));
    }
}

/* Requests the kernels of the rays of paths. */
static void request_paths(Requests *requests, KrsTrace trace, KrsSchedule schedule)
{
    KrsRendering *rendering = requests->rendering;
    const RayKind rays      = rendering->rays;
    const bool    paths     = rendering->purpose == KRS_FOR_PATHS;
    rendering->rays         = rendering_mixes_rays(rendering) ? rays : RAYS_OF_PATHS;
    request(
        requests, "trace.comp",
        variant_of_trace(rendering, trace_of_paths(trace), schedule, group_of_paths(rendering)));
    rendering->rays = paths ? RAYS_OF_PATHS : rendering->rays;
    request(requests, "normals.comp",
            variant_of_normals(rendering, rendering_normals(rendering, KRS_NORMALS_DEFAULT), 0));
    if (paths) {
        request(requests, "scatter.comp",
                variant_of_scatter(rendering, KRS_STARTS_PRECISION, KRS_INTEGRATOR_PATH));
        request(requests, "secondary.comp",
                variant_of_rays(rendering, schedule, rendering_has_roots(rendering, trace),
                                KRS_INTEGRATOR_PATH));
    }
    rendering->rays = rays;
}

/* Requests the kernels without a scene. */
static void request_sceneless(Requests *requests, KrsPurpose purpose)
{
    KrsRendering *rendering = requests->rendering;
    KrsRenderer  *renderer  = rendering->renderer;
    if (is_for_pictures(purpose))
        requests->count += renderer_request_pixels(rendering, requests->items + requests->count);
    const bool paths = purpose == KRS_FOR_PATHS;
    if (paths || (is_for_pictures(purpose) && rendering->program->mirrors))
        requests->count += renderer_request_escapes(
            renderer, paths ? rendering->rays : RAYS_OF_PATHS, requests->items + requests->count);
}

static void request_pictures(Requests *requests, KrsTrace trace, KrsSchedule schedule)
{
    KrsRendering *rendering = requests->rendering;
    KrsNormals    usual     = rendering_normals(rendering, KRS_NORMALS_DEFAULT);
    bool          by_group  = usual != KRS_NORMALS_ANALYTIC &&
                    rendering_marches_per_component(rendering, KRS_COMPONENTS_DEFAULT);
    if (!by_group || rendering_knows_planes(rendering))
        request(requests, "normals.comp",
                variant_of_normals(rendering, usual, by_group ? KRS_MARCH_GROUP_OF_PLANES : 0));
    request(requests, "shade.comp", variant_of_shade(rendering));
    request(requests, "occluders.comp", variant_of_occluders(rendering));
    request(requests, "secondary.comp",
            variant_of_rays(rendering, schedule, rendering_has_roots(rendering, trace),
                            KRS_INTEGRATOR_PREVIEW));
    request_marches(requests, trace, schedule);
    if (rendering->program->mirrors)
        request_paths(requests, trace, schedule);
}

bool kernels_create(KrsRendering *rendering, KrsPurpose purpose)
{
    KrsTrace    trace    = KRS_TRACE_DEFAULT;
    KrsSchedule schedule = KRS_SCHEDULE_DEFAULT;
    Requests    requests = {.rendering = rendering};
    rendering_choose(rendering, &trace, &schedule);
    request_sceneless(&requests, purpose);
    if (is_for_pictures(purpose)) {
        request_pictures(&requests, trace, schedule_of_kernel(schedule));
    } else if (purpose == KRS_FOR_PATHS) {
        request_marches(&requests, trace, schedule_of_kernel(schedule));
        request_paths(&requests, trace, schedule_of_kernel(schedule));
    } else {
        request(&requests, "query.comp", variant_of_questions(rendering, schedule));
        request(&requests, "point_query.comp", variant_of_point_query(rendering));
    }
    return !requests.failed &&
           kernels_make(rendering->renderer, rendering->scene_set, requests.items, requests.count,
                        &rendering->spirv_ms, &rendering->pipeline_ms);
}

/* ---- statistics ---- */

typedef struct KernelListing {
    const Gpu      *gpu;
    KrsKernelStats *items;
    size_t          capacity, count;
} KernelListing;

static void describe(const Gpu *gpu, const Kernel *kernel, KrsKernelStats *stats)
{
    char group[16] = "";
    if (kernel->march_group == KRS_MARCH_GROUP_OF_PLANES)
        snprintf(group, sizeof group, " planes");
    else if (kernel->march_group > 0)
        snprintf(group, sizeof group, " %u", kernel->march_group);
    *stats = (KrsKernelStats){.glsl_bytes = kernel->glsl_bytes,
                              .spirv_ms   = kernel->spirv_ms,
                              .driver_ms  = kernel_driver_ms(gpu, kernel),
                              .cached     = kernel->cached};
    snprintf(stats->name, sizeof stats->name, "%s%s", kernel->file, group);
}

static void list_kernel(KernelListing *listing, const Kernel *kernel)
{
    if (!kernel->pipeline)
        return;
    if (listing->count < listing->capacity)
        describe(listing->gpu, kernel, &listing->items[listing->count]);
    listing->count++;
}

size_t krs_rendering_kernels(const KrsRendering *rendering, KrsKernelStats *kernels,
                             size_t capacity)
{
    const KrsRenderer *renderer = rendering->renderer;
    KernelListing      listing  = {&renderer->gpu, kernels, capacity, 0};
    for (int kind = 0; kind < RAY_KINDS; kind++) {
        for (int i = 0; i < PIXEL_KERNELS; i++)
            list_kernel(&listing, &renderer->pixels[kind][i]);
        list_kernel(&listing, &renderer->escapes[kind]);
    }
    list_kernel(&listing, &renderer->escapes_to_plate);
    list_kernel(&listing, &renderer->noise);
    list_kernel(&listing, &renderer->plate);
    list_kernel(&listing, &renderer->next_dispatch);
    list_kernel(&listing, &renderer->clear_shared);
    for (const KernelEntry *entry = rendering->kernels.first; entry; entry = entry->next)
        list_kernel(&listing, &entry->kernel);
    return listing.count;
}

/* A kernel that the scene before had already, as if it had been found. */
static Kernel found_kernel(const Kernel *kernel)
{
    return (Kernel){.pipeline    = kernel->pipeline,
                    .file        = kernel->file,
                    .march_group = kernel->march_group,
                    .glsl_bytes  = kernel->glsl_bytes,
                    .cached      = true,
                    .shared      = kernel->shared};
}

void kernels_adopt(KernelMap *map, const KrsScene *scene)
{
    for (KernelEntry *entry = map->first; entry; entry = entry->next) {
        entry->variant.scene.scene = scene;
        entry->kernel              = found_kernel(&entry->kernel);
    }
}

void kernels_destroy(Gpu *gpu, KernelMap *map)
{
    for (KernelEntry *entry = map->first, *next; entry; entry = next) {
        next = entry->next;
        kernel_destroy(gpu, &entry->kernel);
        gpu_release(gpu, entry);
    }
    map->first = NULL;
}
