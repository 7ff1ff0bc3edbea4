/*
 * variants.c: for each shader, the functions of the scene that it calls, and the `#define`s for its
 * own text.
 *
 * Choices are made once, for the scene's text.  define_choices alone passes them on to the shader's
 * own text.
 */
#include "runtime/tracer/variants.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "runtime/tracer/methods.h"
#include "runtime/tracer/slots.h"

static void define(ShaderVariant *to, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static void define(ShaderVariant *to, const char *format, ...)
{
    size_t  length = strlen(to->defines);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(to->defines + length, sizeof to->defines - length, format, arguments);
    va_end(arguments);
}

static bool wants(const ShaderVariant *of, KrsFunction function)
{
    bool found = false;
    for (size_t i = 0; i < of->scene.wanted_count; i++)
        found = found || of->scene.wanted[i] == function;
    return found;
}

static void want(ShaderVariant *to, KrsFunction function)
{
    if (!wants(to, function))
        to->scene.wanted[to->scene.wanted_count++] = function;
}

/* Chooses that distances and surfaces are those that a ray sees from inside of glass, or from
   outside. */
static void want_media(ShaderVariant *to, const KrsRendering *rendering)
{
    if (!rendering->program->media)
        return;
    to->scene.variant.glass = KRS_GLASS_NESTED;
    if (wants(to, KRS_FUNCTION_SURFACE))
        want(to, KRS_FUNCTION_MEDIUM_AT);
}

/* Defines for the shader's own text what was chosen for the scene's.  It must be called last. */
static void define_choices(ShaderVariant *to)
{
    static const struct {
        KrsFunction function;
        const char *define;
    } choices[] = {
        {KRS_FUNCTION_DISTANCE_LOD, "#define EARLY_OUTS\n"},
        {KRS_FUNCTION_ALONG, "#define ALONG\n"},
        {KRS_FUNCTION_STEPS, "#define STEPS\n"},
        {KRS_FUNCTION_PLANE_T, "#define PLANES\n"},
        {KRS_FUNCTION_SCENE_PART_DISTANCE, "#define PACKED\n"},
        {KRS_FUNCTION_SINES, "#define KRS_SINES\n"}, /* the scene's text has sines.glsl */
        {KRS_FUNCTION_ARCS, "#define KRS_ARCS\n"},   /* and arcs.glsl */
    };
    for (size_t i = 0; i < sizeof choices / sizeof *choices; i++)
        if (wants(to, choices[i].function))
            define(to, "%s", choices[i].define);
    if (wants(to, KRS_FUNCTION_SURFACE) && krs_scene_program(to->scene.scene)->views)
        define(to, "#define KRS_VIEW\n"); /* the scene's text has krs_view */
    if (to->scene.variant.march_group > 0)
        define(to, "#define MARCH_GROUP %u\n", to->scene.variant.march_group);
    if (to->scene.variant.camera_relative)
        define(to, "#define CAMERA_RELATIVE\n");
    if (to->scene.variant.glass == KRS_GLASS_NESTED)
        define(to, "#define MEDIA\n"); /* the scene's text has krs_medium */
}

/* Chooses the distance to march by.  Where branches save work, it is the one that skips far shapes.
   Within a march group there is nothing far to skip. */
static void want_distance_to_march(ShaderVariant *to)
{
    bool lod = to->scene.variant.many_threads && to->scene.variant.march_group == 0;
    want(to, lod ? KRS_FUNCTION_DISTANCE_LOD : KRS_FUNCTION_DISTANCE);
}

/* The rays of panoramas and lenses need sines, in all shaders that include frame.glsl. */
static void want_rays(ShaderVariant *to, const KrsRendering *rendering)
{
    if (rendering->rays == RAYS_OF_PANORAMAS || rendering->rays == RAYS_OF_LENSES)
        want(to, KRS_FUNCTION_SINES);
}

/* A sky that is a picture is read by longitude and latitude. */
static void want_sky(ShaderVariant *to, const KrsRendering *rendering)
{
    if (!rendering->program->sky_map)
        return;
    define(to, SKY_MAP);
    want(to, KRS_FUNCTION_SINES);
    want(to, KRS_FUNCTION_ARCS);
}

/* Sets what a plate needs: where that of another renderer catches shadows, discs of lights need a
   tangent. */
static void want_plate(ShaderVariant *to, const KrsRendering *rendering)
{
    if (!rendering->catches)
        return;
    define(to, CATCHES);
    want(to, KRS_FUNCTION_SINES);
}

/* Sets what is known of materials before one is looked at.  Phases of waves need cosines. */
static void want_materials(ShaderVariant *to, const KrsRendering *rendering)
{
    if (rendering->program->anisotropic)
        define(to, "#define ANISOTROPIC\n");
    if (rendering->program->subsurface)
        define(to, "#define SUBSURFACE\n");
    if (!rendering->program->films)
        return;
    define(to, "#define FILM\n");
    want(to, KRS_FUNCTION_SINES);
}

/* ---- variants for a rendering ---- */

/* A graphics card has registers for what all lanes read from a block. */
ShaderReads variants_reads(const Gpu *gpu)
{
    return !gpu->texels ? READ_BUFFERS : gpu_is_cpu(gpu) ? READ_FRAME_TEXELS : READ_TEXELS;
}

/* Tells whether sums over lanes are worth it: lavapipe compiles one to a loop. */
static bool sums_lanes(const Gpu *gpu) { return !gpu_is_cpu(gpu) && gpu->sums_lanes; }

static const char *const ray_defines[RAY_KINDS] = {
    [RAYS_OF_CAMERAS] = "",        [RAYS_OF_PANORAMAS] = PANORAMIC, [RAYS_OF_LENSES] = LENS,
    [RAYS_OF_LISTS] = LISTED_RAYS, [RAYS_OF_PATHS] = PATH_RAYS,
};

static ShaderVariant begin_variant(const KrsRendering *rendering, KrsTrace trace,
                                   KrsSchedule schedule)
{
    static const char *const read_defines[SHADER_READS] = {
        [READ_BUFFERS] = NO_TEXELS, [READ_TEXELS] = "", [READ_FRAME_TEXELS] = FRAME_TEXELS};
    const Gpu    *gpu             = &rendering->renderer->gpu;
    bool          camera_relative = rendering->camera_relative;
    bool          by_ray          = trace >= KRS_TRACE_EXACT;
    ShaderVariant to              = {.scene = {.scene = rendering->scene}};
    to.scene.variant              = (KrsVariant){
                     .zones           = rendering->zone_slots,
                     .camera_relative = camera_relative,
                     .many_threads    = rendering->renderer->early_outs && !camera_relative,
                     .values          = rendering_value_slots(rendering) > 0,
                     .buffers         = !gpu->texels,
    };
    define(&to, "#define TRACE %du\n#define REFILL %d\n", (int)(by_ray ? KRS_TRACE_PLAIN : trace),
           schedule == KRS_SCHEDULE_REFILL ? (int)gpu->refill_lanes : 0);
    define(&to, "%s%s%s%s", read_defines[variants_reads(gpu)],
           sums_lanes(gpu) ? "#define SUBGROUPS\n" : "", ray_defines[rendering->rays],
           rendering->program->open_surfaces ? "#define OPEN_SURFACES\n" : "");
    return to;
}

/* Chooses how rays step by krs_along, or by krs_steps; false where they step by distances. */
static bool want_steps(ShaderVariant *to, const KrsRendering *rendering, KrsTrace trace,
                       KrsFunction function)
{
    const ResearchTrace *research = research_trace(trace);
    if (!rendering_goes_along(rendering, trace))
        return false;
    want(to, research ? research->function : function);
    if (research) {
        to->scene.variant.step = research->step;
        define(to, "%s", research->defines);
    }
    return true;
}

/* Sets what paths need: their rays may be within glass.  Shaders for all march groups are for
   these, too, where the picture has any. */
static void want_paths(ShaderVariant *to, const KrsRendering *rendering, bool whole)
{
    const bool mixed = whole && rendering->rays != RAYS_OF_PATHS && rendering_mixes_rays(rendering);
    if (mixed)
        define(to, MIXED_RAYS);
    if (mixed || rendering->rays == RAYS_OF_PATHS)
        want_media(to, rendering);
}

/* Leaves planes out of distances: rays intersect them instead. */
static void want_planes(ShaderVariant *to)
{
    to->scene.variant.planes = true;
    want(to, KRS_FUNCTION_PLANE_T);
    want(to, KRS_FUNCTION_PLANE_COSINE);
}

ShaderVariant variant_of_trace(const KrsRendering *rendering, KrsTrace trace, KrsSchedule schedule,
                               uint32_t group)
{
    ShaderVariant to    = begin_variant(rendering, trace, schedule);
    const bool    saves = group != MARCH_PACKED && rendering_saves_rays(rendering, schedule);
    define(&to, "#define SAVES %d\n#define SNAPS %d\n", saves, rendering->snaps);
    want_rays(&to, rendering);
    want_paths(&to, rendering, group == 0 || group == MARCH_WITHOUT_PLANES);
    if (group > 0 && rendering_knows_planes(rendering))
        want_planes(&to);
    to.scene.variant.march_group = group < MARCH_WITHOUT_PLANES ? group : 0;
    if (group == MARCH_PACKED) {
        want(&to, KRS_FUNCTION_SCENE_PART_DISTANCE);
        want(&to, KRS_FUNCTION_SCENE_PART_BOX);
    } else if (!want_steps(&to, rendering, trace, KRS_FUNCTION_STEPS)) {
        want_distance_to_march(&to);
    }
    define_choices(&to);
    return to;
}

/* The octahedron has no define: normals.comp uses it by default. */
ShaderVariant variant_of_normals(const KrsRendering *rendering, KrsNormals normals, uint32_t group)
{
    const KrsProgram *program    = rendering->program;
    ShaderVariant     to         = begin_variant(rendering, KRS_TRACE_PLAIN, KRS_SCHEDULE_PIXEL);
    to.scene.variant.march_group = group;
    want_rays(&to, rendering);
    want_paths(&to, rendering, group == 0);
    bool by_roots = program->along && !program->inverts;
    bool derived  = normals == KRS_NORMALS_ANALYTIC && !to.scene.variant.camera_relative;
    want(&to, derived && by_roots ? KRS_FUNCTION_TANGENT : KRS_FUNCTION_DISTANCE);
    if (derived && !by_roots)
        want(&to, KRS_FUNCTION_GRADIENT);
    if (derived)
        define(&to, by_roots ? "#define TANGENTS\n" : "#define GRADIENT\n");
    else if (normals != KRS_NORMALS_OCTAHEDRON && normals != KRS_NORMALS_ANALYTIC)
        define(&to, "#define STENCIL %d\n", (int)normals);
    /* Properties of the scene's distance around a hit. */
    define(&to, "%s%s", by_roots ? "#define ROOTS\n" : "", program->plain ? "#define PLAIN\n" : "");
    define_choices(&to);
    return to;
}

/* The random directions of rays need sines.  Rays of previews and of direct light pass through glass. */
ShaderVariant variant_of_secondary(const KrsRendering *rendering, KrsTrace trace,
                                   KrsSchedule schedule, KrsIntegrator integrator, bool planes)
{
    ShaderVariant to = begin_variant(rendering, trace, schedule);
    if (rendering->program->media)
        to.scene.variant.glass = integrator == KRS_INTEGRATOR_PATH ? KRS_GLASS_NESTED
                                                                   : KRS_GLASS_LEFT_OUT;
    if (rendering->program->mirrors && integrator == KRS_INTEGRATOR_PREVIEW)
        define(&to, MIXED_RAYS);
    want(&to, KRS_FUNCTION_SINES);
    if (planes)
        want_planes(&to);
    if (!want_steps(&to, rendering, trace, KRS_FUNCTION_STEPS))
        want(&to, KRS_FUNCTION_DISTANCE);
    define_choices(&to);
    return to;
}

/* Tells whether normals at hits are by derivatives, which tell the nearest component as well.  Boundaries
   of media are told by distances. */
static bool knows_tangents(const KrsRendering *rendering)
{
    return rendering_normals(rendering, KRS_NORMALS_DEFAULT) == KRS_NORMALS_ANALYTIC &&
           !rendering->camera_relative && !rendering->program->media;
}

ShaderVariant variant_of_shade(const KrsRendering *rendering)
{
    ShaderVariant to = begin_variant(rendering, KRS_TRACE_PLAIN, KRS_SCHEDULE_PIXEL);
    want_rays(&to, rendering);
    want(&to, KRS_FUNCTION_SURFACE);
    want_media(&to, rendering);
    to.scene.variant.tangents       = knows_tangents(rendering);
    to.scene.variant.gathers_noises = rendering_gathers_noises(rendering);
    if (rendering->program->media)
        want(&to, KRS_FUNCTION_GLASS);
    if (rendering->program->mirrors)
        define(&to, "#define MIRRORS\n" MIXED_RAYS);
    if (rendering->program->layers)
        define(&to, "#define LAYERS\n");
    want_materials(&to, rendering);
    want_plate(&to, rendering);
    want_sky(&to, rendering);
    define_choices(&to);
    return to;
}

/* The names of these defines are in those of files (Makefile), in this order. */
ShaderVariant variant_of_shade_found(const KrsRendering *rendering)
{
    ShaderVariant to = {0};
    define(&to, "#define SURFACES\n");
    if (rendering->program->mirrors)
        define(&to, "#define MIRRORS\n" MIXED_RAYS);
    if (rendering->program->layers)
        define(&to, "#define LAYERS\n");
    if (rendering->program->anisotropic)
        define(&to, "#define ANISOTROPIC\n");
    if (rendering->program->subsurface)
        define(&to, "#define SUBSURFACE\n");
    if (rendering->program->films)
        define(&to, "#define FILM\n");
    if (rendering->program->sky_map)
        define(&to, SKY_MAP);
    if (rendering->catches)
        define(&to, CATCHES);
    define(&to, "%s", ray_defines[rendering->rays]);
    if (variants_reads(&rendering->renderer->gpu) == READ_FRAME_TEXELS)
        define(&to, FRAME_TEXELS);
    return to;
}

/* The random directions of rays need sines.  What they pass through occludes nothing. */
ShaderVariant variant_of_occluders(const KrsRendering *rendering)
{
    ShaderVariant to = begin_variant(rendering, KRS_TRACE_PLAIN, KRS_SCHEDULE_PIXEL);
    if (rendering->program->media)
        to.scene.variant.glass = KRS_GLASS_LEFT_OUT;
    want(&to, KRS_FUNCTION_SINES);
    want(&to, KRS_FUNCTION_SURFACE);
    to.scene.variant.gathers_noises = rendering_gathers_noises(rendering);
    define_choices(&to);
    return to;
}

/* Sets what shaders need that go through media. */
static void want_volumes(ShaderVariant *to, const KrsRendering *rendering)
{
    if (rendering->program->volumes == 0)
        return;
    define(to, "#define VOLUMES %zuu\n", rendering->program->volumes);
    want(to, KRS_FUNCTION_DENSITY);
}

/* It is for rays of cameras and of paths; the medium of the former is that at the eye. */
ShaderVariant variant_of_track(const KrsRendering *rendering)
{
    ShaderVariant to = begin_variant(rendering, KRS_TRACE_PLAIN, KRS_SCHEDULE_PIXEL);
    if (rendering->rays != RAYS_OF_PATHS)
        define(&to, MIXED_RAYS);
    want(&to, KRS_FUNCTION_SINES);
    want_volumes(&to, rendering);
    want_media(&to, rendering);
    if (rendering->program->media)
        want(&to, KRS_FUNCTION_MEDIUM_AT);
    define_choices(&to);
    return to;
}

ShaderVariant variant_of_beam(const KrsRendering *rendering)
{
    ShaderVariant to = begin_variant(rendering, KRS_TRACE_PLAIN, KRS_SCHEDULE_PIXEL);
    want(&to, KRS_FUNCTION_SINES);
    want(&to, KRS_FUNCTION_ARCS);
    want_volumes(&to, rendering);
    want(&to, KRS_FUNCTION_ALBEDO);
    want(&to, KRS_FUNCTION_ANISOTROPY);
    want_media(&to, rendering);
    if (rendering->program->media)
        want(&to, KRS_FUNCTION_MEDIUM_AT);
    define_choices(&to);
    return to;
}

/* What glass absorbs on the way is known by its surface. */
ShaderVariant variant_of_collide(const KrsRendering *rendering, KrsIntegrator integrator)
{
    ShaderVariant to = begin_variant(rendering, KRS_TRACE_PLAIN, KRS_SCHEDULE_PIXEL);
    want(&to, KRS_FUNCTION_SINES);
    if (rendering->program->media)
        want(&to, KRS_FUNCTION_SURFACE);
    if (integrator == KRS_INTEGRATOR_DIRECT)
        define(&to, "#define DIRECT\n");
    want_volumes(&to, rendering);
    want(&to, KRS_FUNCTION_ALBEDO);
    want(&to, KRS_FUNCTION_ANISOTROPY);
    want(&to, KRS_FUNCTION_EMISSION);
    want_media(&to, rendering);
    want_sky(&to, rendering);
    want(&to, KRS_FUNCTION_ARCS);
    define_choices(&to);
    return to;
}

/* The random directions of paths need sines. */
ShaderVariant variant_of_scatter(const KrsRendering *rendering, KrsStarts starts,
                                 KrsIntegrator integrator, bool photons)
{
    ShaderVariant to = begin_variant(rendering, KRS_TRACE_PLAIN, KRS_SCHEDULE_PIXEL);
    want(&to, KRS_FUNCTION_SURFACE);
    want(&to, KRS_FUNCTION_SINES);
    if (rendering->program->emits)
        define(&to, "#define EMISSIVE\n");
    define(&to, "%s", research_starts(starts));
    if (rendering->program->media && integrator == KRS_INTEGRATOR_DIRECT) {
        define(&to, "#define DIRECT\n");
        want(&to, KRS_FUNCTION_GLASS);
    }
    if (photons)
        define(&to, "#define PHOTONS_GATHERED\n");
    if (rendering->program->subsurface)
        want(&to, KRS_FUNCTION_SUBSURFACE);
    want_volumes(&to, rendering);
    want_materials(&to, rendering);
    want_plate(&to, rendering);
    want_media(&to, rendering);
    want_sky(&to, rendering);
    define_choices(&to);
    return to;
}

/* Photons are marched by distances, and scattered as paths are. */
ShaderVariant variant_of_photons(const KrsRendering *rendering)
{
    ShaderVariant to = begin_variant(rendering, KRS_TRACE_PLAIN, KRS_SCHEDULE_PIXEL);
    want(&to, KRS_FUNCTION_DISTANCE);
    want(&to, KRS_FUNCTION_SURFACE);
    want(&to, KRS_FUNCTION_SINES);
    want_materials(&to, rendering);
    want_media(&to, rendering);
    define_choices(&to);
    return to;
}

ShaderVariant variant_of_research(const KrsRendering *rendering, const ResearchPass *pass)
{
    ShaderVariant to = begin_variant(rendering, KRS_TRACE_PLAIN, KRS_SCHEDULE_PIXEL);
    want_rays(&to, rendering);
    want(&to, pass->function);
    define_choices(&to);
    return to;
}

ShaderVariant variant_of_query(const KrsRendering *rendering, KrsTrace trace, KrsSchedule schedule)
{
    ShaderVariant to = begin_variant(rendering, trace, schedule);
    want_rays(&to, rendering);
    if (!want_steps(&to, rendering, trace, KRS_FUNCTION_ALONG))
        want_distance_to_march(&to);
    define_choices(&to);
    return to;
}

/* Differences of a distance see both sides of a sheet, so sheets need the gradient. */
ShaderVariant variant_of_point_query(const KrsRendering *rendering)
{
    ShaderVariant to = begin_variant(rendering, KRS_TRACE_PLAIN, KRS_SCHEDULE_PIXEL);
    want(&to, KRS_FUNCTION_DISTANCE);
    want(&to, KRS_FUNCTION_SURFACE);
    if (rendering->program->open_surfaces)
        want(&to, KRS_FUNCTION_GRADIENT);
    define_choices(&to);
    return to;
}

ShaderSource variant_source(const char *file, const ShaderVariant *variant)
{
    return (ShaderSource){file, variant->scene.scene ? &variant->scene : NULL, variant->defines};
}

/* ---- variants for any device ---- */

ShaderVariant variant_for_any(const KrsScene *scene, const char *file, const KrsVariant *variant)
{
    static const struct {
        const char *file;
        bool        marches;
        KrsFunction wanted[6];
        size_t      count;
    } shaders[] = {
        {"trace.comp", true, {0}, 0},
        {"query.comp", true, {0}, 0},
        {"normals.comp", false, {KRS_FUNCTION_DISTANCE}, 1},
        {"research/even_hits.comp", false, {KRS_FUNCTION_DISTANCE}, 1},
        {"secondary.comp", false, {KRS_FUNCTION_DISTANCE, KRS_FUNCTION_SINES}, 2},
        {"shade.comp", false, {KRS_FUNCTION_SURFACE}, 1},
        {"occluders.comp", false, {KRS_FUNCTION_SURFACE, KRS_FUNCTION_SINES}, 2},
        {"photons.comp",
         false,
         {KRS_FUNCTION_DISTANCE, KRS_FUNCTION_SURFACE, KRS_FUNCTION_SINES},
         3},
        {"scatter.comp", false, {KRS_FUNCTION_SURFACE, KRS_FUNCTION_SINES}, 2},
        {"track.comp", false, {KRS_FUNCTION_DENSITY, KRS_FUNCTION_SINES}, 2},
        {"beam.comp",
         false,
         {KRS_FUNCTION_DENSITY, KRS_FUNCTION_ALBEDO, KRS_FUNCTION_ANISOTROPY, KRS_FUNCTION_SINES,
          KRS_FUNCTION_ARCS},
         5},
        {"collide.comp",
         false,
         {KRS_FUNCTION_DENSITY, KRS_FUNCTION_ALBEDO, KRS_FUNCTION_ANISOTROPY, KRS_FUNCTION_EMISSION,
          KRS_FUNCTION_SINES, KRS_FUNCTION_ARCS},
         6},
        {"point_query.comp", false, {KRS_FUNCTION_DISTANCE, KRS_FUNCTION_SURFACE}, 2},
    };
    ShaderVariant to = {.scene = {.variant = *variant}};
    for (size_t i = 0; i < sizeof shaders / sizeof *shaders; i++) {
        if (strcmp(shaders[i].file, file) != 0)
            continue;
        to.scene.scene = scene;
        if (shaders[i].marches)
            want_distance_to_march(&to);
        for (size_t k = 0; k < shaders[i].count; k++)
            want(&to, shaders[i].wanted[k]);
    }
    define_choices(&to);
    return to;
}
