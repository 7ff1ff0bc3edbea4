/*
 * shaders.c: a map of the shaders that contain functions of the scene.
 *
 * The key of a shader is what it is made from: its file, the scene's variant, the functions that it
 * calls and its defines (variants.c).  So an option that changes none of these needs no new shader.
 * An option that changes some of them needs no change here.
 */
#include "runtime/tracer/shaders.h"

#include <stdio.h>
#include <string.h>

#include "runtime/tracer/methods.h"
#include "runtime/tracer/renderer.h"
#include "runtime/tracer/variants.h"
#include "runtime/tracer/prewarm.h"

struct ShaderEntry {
    const char   *file;
    ShaderVariant variant;
    Shader        shader; /* zero until it is made */
    ShaderEntry  *next;
};

static bool is_of(const ShaderEntry *entry, const char *file, const ShaderVariant *variant)
{
    const ShaderScene *a = &entry->variant.scene, *b = &variant->scene;
    return strcmp(entry->file, file) == 0 &&
           krs_variant_hash(&a->variant, a->wanted, a->wanted_count) ==
               krs_variant_hash(&b->variant, b->wanted, b->wanted_count) &&
           strcmp(entry->variant.defines, variant->defines) == 0;
}

/* Tells whether a shader may contain this scene; false, and the failure is noted: drivers would
   take minutes for it. */
static bool may_contain(const KrsRendering *rendering, const ShaderVariant *variant)
{
    const KrsDiagnostic *why = krs_scene_too_large(rendering->scene);
    if (!why || !variant->scene.scene)
        return true;
    gpu_refuse(&rendering->renderer->gpu, KRS_BAD_SCENE, "%s, so no shader is made of it (%s)",
               why->message, why->code);
    return false;
}

/* Finds the entry of a shader, or adds one; NULL with the failure noted. */
static ShaderEntry *find_entry(KrsRendering *rendering, const char *file, ShaderVariant variant)
{
    ShaderEntry *entry = rendering->shaders.first;
    while (entry && !is_of(entry, file, &variant))
        entry = entry->next;
    if (entry || !may_contain(rendering, &variant))
        return entry;
    entry = gpu_alloc(&rendering->renderer->gpu, 1, sizeof *entry, "prepare the scene");
    if (entry) {
        *entry                   = (ShaderEntry){file, variant, {0}, rendering->shaders.first};
        rendering->shaders.first = entry;
    }
    return entry;
}

static ShaderRequest request_of(ShaderEntry *entry)
{
    return (ShaderRequest){&entry->shader, variant_source(entry->file, &entry->variant)};
}

static Shader *find_shader(KrsRendering *rendering, const char *file, ShaderVariant variant)
{
    ShaderEntry *entry = find_entry(rendering, file, variant);
    if (!entry || entry->shader.pipeline)
        return entry ? &entry->shader : NULL;
    ShaderRequest request = request_of(entry);
    if (!shaders_make(rendering->renderer, rendering->scene_set, &request, 1, &rendering->spirv_ms,
                      &rendering->pipeline_ms))
        return NULL;
    return &entry->shader;
}

/* ---- each shader ---- */

/* The schedule `queue` uses the shader of `pixel`, with fewer steps in a dispatch. */
static KrsSchedule schedule_of_shader(KrsSchedule schedule)
{
    return schedule == KRS_SCHEDULE_QUEUE ? KRS_SCHEDULE_PIXEL : schedule;
}

Shader *rendering_trace(KrsRendering *rendering, KrsTrace trace, KrsSchedule schedule,
                        uint32_t march_group)
{
    schedule = schedule_of_shader(schedule);
    return find_shader(rendering, "trace.comp",
                       variant_of_trace(rendering, trace, schedule, march_group));
}

Shader *rendering_beams(KrsRendering *rendering, KrsTrace trace, KrsSchedule schedule,
                        uint32_t march_group)
{
    return rendering_trace(rendering, trace >= KRS_TRACE_EXACT ? KRS_TRACE_PLAIN : trace, schedule,
                           march_group);
}

static ShaderVariant variant_of_rays(const KrsRendering *rendering, KrsSchedule schedule,
                                     bool by_roots, KrsIntegrator integrator, bool planes)
{
    return variant_of_secondary(rendering, by_roots ? KRS_TRACE_EXACT : KRS_TRACE_PLAIN,
                                schedule_of_shader(schedule), integrator, planes);
}

Shader *rendering_secondary(KrsRendering *rendering, KrsSchedule schedule, bool by_roots,
                            bool planes)
{
    return find_shader(
        rendering, "secondary.comp",
        variant_of_rays(rendering, schedule, by_roots, KRS_INTEGRATOR_PREVIEW, planes));
}

Shader *rendering_occluders(KrsRendering *rendering)
{
    return find_shader(rendering, "occluders.comp", variant_of_occluders(rendering));
}

Shader *rendering_normals_shader(KrsRendering *rendering, KrsNormals normals, uint32_t march_group)
{
    return find_shader(
        rendering, "normals.comp",
        variant_of_normals(rendering, rendering_normals(rendering, normals), march_group));
}

static ShaderVariant variant_of_questions(const KrsRendering *rendering, KrsSchedule schedule)
{
    return variant_of_query(rendering,
                            rendering->program->open_surfaces ? KRS_TRACE_EXACT : KRS_TRACE_AUTO,
                            schedule_of_shader(schedule));
}

Shader *rendering_query(KrsRendering *rendering, KrsSchedule schedule)
{
    return find_shader(rendering, "query.comp", variant_of_questions(rendering, schedule));
}

Shader *rendering_research(KrsRendering *rendering, const ResearchPass *pass)
{
    return find_shader(rendering, pass->shader, variant_of_research(rendering, pass));
}

Shader *rendering_shade(KrsRendering *rendering)
{
    return find_shader(rendering, "shade.comp", variant_of_shade(rendering));
}

Shader *rendering_shade_found(KrsRendering *rendering)
{
    return find_shader(rendering, "shade.comp", variant_of_shade_found(rendering));
}

Shader *rendering_point_query(KrsRendering *rendering)
{
    return find_shader(rendering, "point_query.comp", variant_of_point_query(rendering));
}

/* ---- paths ---- */

Shader *rendering_photons(KrsRendering *rendering)
{
    const RayKind rays   = rendering->rays;
    rendering->rays      = RAYS_OF_PATHS;
    Shader *const shader = find_shader(rendering, "photons.comp", variant_of_photons(rendering));
    rendering->rays      = rays;
    return shader;
}

static KrsTrace trace_of_paths(KrsTrace trace)
{
    const ResearchTrace *research = research_trace(trace);
    return research ? research->of_paths : trace;
}

static uint32_t group_of_paths(const KrsRendering *rendering)
{
    return rendering_knows_planes(rendering) ? MARCH_WITHOUT_PLANES : 0;
}

bool rendering_paths(KrsRendering *rendering, const KrsRenderOptions *options, KrsPurpose purpose,
                     bool planes, PathShaders *shaders)
{
    const RayKind rays  = rendering->rays;
    const bool    roots = rendering_has_roots(rendering, options->methods.trace);
    const bool    paths = purpose == KRS_FOR_PATHS;
    rendering->rays     = rendering_mixes_rays(rendering) ? rays : RAYS_OF_PATHS;
    shaders->march      = rendering_trace(rendering, trace_of_paths(options->methods.trace),
                                          options->methods.schedule, group_of_paths(rendering));
    rendering->rays     = paths ? RAYS_OF_PATHS : rendering->rays;
    shaders->normals    = rendering_normals_shader(rendering, options->methods.normals, 0);
    rendering->rays     = paths ? RAYS_OF_PATHS : rays; /* those of pictures are for paths, too */
    shaders->scatter    = paths ? find_shader(
                                      rendering, "scatter.comp",
                                      variant_of_scatter(rendering, options->methods.starts,
                                                         options->integrator,
                                                         options->caustics == KRS_CAUSTICS_PHOTONS))
                                : rendering_shade(rendering);
    const bool volumes  = paths && rendering->program->volumes > 0;
    if (volumes)
        shaders->collide = find_shader(rendering, "collide.comp",
                                       variant_of_collide(rendering, options->integrator));
    shaders->shadows = find_shader(
        rendering, "secondary.comp",
        variant_of_rays(rendering, options->methods.schedule, roots, options->integrator, planes));
    rendering->rays = rays;
    if (volumes)
        shaders->track = find_shader(rendering, "track.comp", variant_of_track(rendering));
    if (volumes)
        shaders->beam = find_shader(rendering, "beam.comp", variant_of_beam(rendering));
    return shaders->march && shaders->normals && shaders->scatter && shaders->shadows &&
           (!volumes || (shaders->track && shaders->collide && shaders->beam));
}

/* ---- shaders that are made at the same time ---- */

typedef struct Requests {
    KrsRendering *rendering;
    ShaderRequest items[SHADERS_AT_ONCE];
    size_t        count;
    bool          failed; /* the failure is noted */
} Requests;

static bool is_requested(const Requests *requests, const Shader *shader)
{
    bool found = false;
    for (size_t i = 0; i < requests->count; i++)
        found = found || requests->items[i].shader == shader;
    return found;
}

static void request(Requests *requests, const char *file, ShaderVariant variant)
{
    ShaderEntry *entry = find_entry(requests->rendering, file, variant);
    requests->failed   = requests->failed || !entry;
    if (entry && !entry->shader.pipeline && !is_requested(requests, &entry->shader))
        requests->items[requests->count++] = request_of(entry);
}

static bool is_for_pictures(KrsPurpose purpose)
{
    return purpose == KRS_FOR_PICTURES || purpose == KRS_FOR_SMALL_PICTURES ||
           purpose == KRS_FOR_LANES;
}

/* Requests the shaders that march.  Where march groups are marched one after the other, each has
   its own shader for rays and its own for normals. */
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
        KrsSchedule own = schedule_of_shader(
            rendering_schedule_of_march_group(rendering, KRS_SCHEDULE_DEFAULT, march_group));
        request(requests, "trace.comp", variant_of_trace(rendering, trace, own, march_group));
        if (is_for_pictures(rendering->purpose))
            request(requests, "normals.comp", variant_of_normals(rendering, usual, march_group));
    }
}

/* Requests the shaders of the rays of paths. */
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
                variant_of_scatter(rendering, KRS_STARTS_PRECISION, KRS_INTEGRATOR_PATH, false));
        request(requests, "secondary.comp",
                variant_of_rays(rendering, schedule, rendering_has_roots(rendering, trace),
                                KRS_INTEGRATOR_PATH,
                                rendering_light_meets_planes(rendering, KRS_INTEGRATOR_PATH)));
    }
    if (paths && rendering->program->volumes > 0) {
        request(requests, "collide.comp", variant_of_collide(rendering, KRS_INTEGRATOR_PATH));
        rendering->rays = rays;
        request(requests, "track.comp", variant_of_track(rendering));
        request(requests, "beam.comp", variant_of_beam(rendering));
    }
    rendering->rays = rays;
}

/* Requests the shaders without a scene. */
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
                            KRS_INTEGRATOR_PREVIEW,
                            rendering_light_meets_planes(rendering, KRS_INTEGRATOR_PREVIEW)));
    request_marches(requests, trace, schedule);
    if (rendering->program->mirrors)
        request_paths(requests, trace, schedule);
}

/* Requests the shaders for a purpose. */
static void request_all(Requests *requests, KrsPurpose purpose)
{
    KrsRendering *rendering = requests->rendering;
    KrsTrace      trace     = KRS_TRACE_DEFAULT;
    KrsSchedule   schedule  = KRS_SCHEDULE_DEFAULT;
    rendering_choose(rendering, &trace, &schedule);
    request_sceneless(requests, purpose);
    if (purpose == KRS_FOR_LANES ||
        (is_for_pictures(purpose) && krs_scene_too_large(rendering->scene))) {
        const bool found = rendering_lanes_find_surfaces(rendering);
        requests->count += renderer_request_lane_rays(rendering, requests->items + requests->count);
        request(requests, "shade.comp",
                found ? variant_of_shade_found(rendering) : variant_of_shade(rendering));
        if (!found)
            request(requests, "occluders.comp", variant_of_occluders(rendering));
    } else if (is_for_pictures(purpose)) {
        request_pictures(requests, trace, schedule_of_shader(schedule));
    } else if (purpose == KRS_FOR_PATHS) {
        request_marches(requests, trace, schedule_of_shader(schedule));
        request_paths(requests, trace, schedule_of_shader(schedule));
    } else {
        request(requests, "query.comp", variant_of_questions(rendering, schedule));
        request(requests, "point_query.comp", variant_of_point_query(rendering));
    }
}

bool shaders_are_known(KrsRendering *rendering, CacheKey *key)
{
    Requests      requests = {.rendering = rendering};
    ShaderSource *last     = NULL;
    *key                   = (CacheKey){0};
    request_all(&requests, rendering->purpose);
    for (size_t i = 0; i < requests.count; i++)
        last = requests.items[i].source.scene ? &requests.items[i].source : last;
    return !requests.failed && last && shader_is_known(&rendering->renderer->gpu, last, key);
}

bool shaders_create(KrsRendering *rendering, KrsPurpose purpose)
{
    Requests requests = {.rendering = rendering};
    if (rendering->deferred && purpose == rendering->purpose)
        return true;
    request_all(&requests, purpose);
    return !requests.failed &&
           shaders_make(rendering->renderer, rendering->scene_set, requests.items, requests.count,
                        &rendering->spirv_ms, &rendering->pipeline_ms);
}

/* ---- statistics ---- */

typedef struct ShaderListing {
    const Gpu      *gpu;
    KrsShaderStats *items;
    size_t          capacity, count;
} ShaderListing;

static void describe(const Gpu *gpu, const Shader *shader, KrsShaderStats *stats)
{
    char group[16] = "";
    if (shader->march_group == KRS_MARCH_GROUP_OF_PLANES)
        snprintf(group, sizeof group, " planes");
    else if (shader->march_group > 0)
        snprintf(group, sizeof group, " %u", shader->march_group);
    *stats = (KrsShaderStats){.glsl_bytes = shader->glsl_bytes,
                              .spirv_ms   = shader->spirv_ms,
                              .driver_ms  = shader_driver_ms(gpu, shader),
                              .cached     = shader->cached};
    snprintf(stats->name, sizeof stats->name, "%s%s", shader->file, group);
}

static void list_shader(void *user, Shader *shader)
{
    ShaderListing *listing = user;
    if (!shader->pipeline)
        return;
    if (listing->count < listing->capacity)
        describe(listing->gpu, shader, &listing->items[listing->count]);
    listing->count++;
}

size_t krs_rendering_shaders(const KrsRendering *rendering, KrsShaderStats *shaders,
                             size_t capacity)
{
    KrsRenderer  *renderer = rendering->renderer;
    ShaderListing listing  = {&renderer->gpu, shaders, capacity, 0};
    renderer_visit(renderer, list_shader, &listing);
    for (ShaderEntry *entry = rendering->shaders.first; entry; entry = entry->next)
        list_shader(&listing, &entry->shader);
    return listing.count;
}

/* Returns a shader that the scene before had already, as if it had been found. */
static Shader found_shader(const Shader *shader)
{
    return (Shader){.pipeline    = shader->pipeline,
                    .file        = shader->file,
                    .march_group = shader->march_group,
                    .glsl_bytes  = shader->glsl_bytes,
                    .cached      = true,
                    .shared      = shader->shared};
}

void shaders_adopt(ShaderMap *map, const KrsScene *scene)
{
    for (ShaderEntry *entry = map->first; entry; entry = entry->next) {
        if (entry->variant.scene.scene)
            entry->variant.scene.scene = scene;
        entry->shader = found_shader(&entry->shader);
    }
}

void shaders_destroy(Gpu *gpu, ShaderMap *map)
{
    for (ShaderEntry *entry = map->first, *next; entry; entry = next) {
        next = entry->next;
        shader_destroy(gpu, &entry->shader);
        gpu_release(gpu, entry);
    }
    map->first = NULL;
}
