/*
 * settings.c: completes the options of a picture, and checks them.
 */
#include "runtime/film/settings.h"

#include <math.h>
#include <string.h>

#include "runtime/film/noise.h"
#include "runtime/tracer/methods.h"
#include "runtime/tracer/research/research.h"

#define MAX_STEPS 16384
/* The most steps of a lane in a dispatch.  All loops of an invocation together stay under 32768
   iterations: some devices end them silently after 65535. */
#define MAX_STEPS_AT_ONCE 8192
/* The steps of a pass of the schedule `queue`.  More steps leave lanes idle, fewer need more
   passes. */
#define QUEUE_STEPS 16

static bool refuse(KrsRendering *rendering, const char *words)
{
    gpu_refuse(&rendering->renderer->gpu, KRS_BAD_ARGUMENT, "%s", words);
    return false;
}

static uint32_t first_nonzero(uint32_t asked, uint32_t scene, uint32_t otherwise)
{
    return asked ? asked : scene ? scene : otherwise;
}

/* Returns the number of a name that the compiler knows; NULL: the scene has none. */
static int find_name(const char *const *names, const char *name, int otherwise)
{
    for (int i = 0; name && names[i]; i++)
        if (strcmp(name, names[i]) == 0)
            return i;
    return otherwise;
}

/* Tells whether methods have nothing that only later libraries know. */
static bool methods_are_known(const KrsMethods *methods)
{
    for (size_t i = 0; i < sizeof methods->reserved / sizeof *methods->reserved; i++)
        if (methods->reserved[i] != 0)
            return false;
    return methods->reserved_half == 0;
}

/* Checks the choices of choices.def, and replaces defaults among them. */
static bool choose(KrsRendering *rendering, KrsRenderOptions *o, KrsSchedule *asked)
{
    if ((unsigned)o->methods.trace >= KRS_TRACE_COUNT ||
        (unsigned)o->methods.schedule >= KRS_SCHEDULE_COUNT ||
        (unsigned)o->shadows >= KRS_SHADOWS_COUNT || (unsigned)o->caustics >= KRS_CAUSTICS_COUNT ||
        (unsigned)o->methods.components >= KRS_COMPONENTS_COUNT ||
        (unsigned)o->methods.normals >= KRS_NORMALS_COUNT ||
        (unsigned)o->pixel_filter >= KRS_PIXEL_FILTER_COUNT ||
        (unsigned)o->methods.starts >= KRS_STARTS_COUNT ||
        (unsigned)o->methods.executor >= KRS_EXECUTOR_COUNT ||
        (unsigned)o->catcher >= KRS_CATCHER_COUNT || o->methods.even_hits > KRS_MAX_EVEN_HITS ||
        (unsigned)o->integrator >= KRS_INTEGRATOR_COUNT || !methods_are_known(&o->methods))
        return refuse(rendering, "there is no such method, schedule, stencil, kind of shadow, "
                                 "filter or integrator");
    if (research_trace(o->methods.trace) && !rendering->program->research)
        return refuse(rendering, "this method wants a scene that was compiled with `research`");
    if (o->methods.normals == KRS_NORMALS_ANALYTIC && !rendering->program->gradients)
        return refuse(rendering,
                      "analytic normals need a scene that was compiled with `gradients`");
    o->methods.normals = rendering_normals(rendering, o->methods.normals);
    *asked             = o->methods.schedule;
    rendering_choose(rendering, &o->methods.trace, &o->methods.schedule);
    if (o->methods.schedule == KRS_SCHEDULE_REFILL && rendering->renderer->gpu.refill_lanes == 0)
        return refuse(rendering,
                      "the device's lanes cannot exchange numbers, which `refill` needs");
    return true;
}

/* Sets when samples end by noise.  What is seen as black depends on the exposure. */
static void put_noise(const KrsImage *image, KrsRenderOptions *o)
{
    o->noise = o->noise != 0 ? o->noise : image->noise;
    if (o->noise_floor == 0)
        o->noise_floor = KRS_DEFAULT_NOISE_FLOOR * exp2(-image->exposure);
}

static void put_defaults(const KrsImage *image, bool too_large, KrsRenderOptions *o)
{
    o->width  = first_nonzero(o->width, image->width, KRS_DEFAULT_WIDTH);
    o->height = first_nonzero(o->height, image->height, KRS_DEFAULT_HEIGHT);
    put_noise(image, o);
    o->samples = first_nonzero(o->samples, image->samples,
                               o->noise > 0 ? KRS_DEFAULT_NOISY_SAMPLES : KRS_DEFAULT_SAMPLES);
    o->bounces = first_nonzero(o->bounces, image->bounces, KRS_DEFAULT_BOUNCES);
    o->aovs    = first_nonzero(o->aovs, 0, KRS_AOV_ALL & ~KRS_AOV_NOISE) |
              (o->noise > 0 ? KRS_AOV_NOISE : 0);
    o->methods.max_steps     = first_nonzero(o->methods.max_steps, 0, MAX_STEPS);
    o->methods.steps_at_once = first_nonzero(
        o->methods.steps_at_once, 0, o->methods.schedule == KRS_SCHEDULE_QUEUE ? QUEUE_STEPS : 512);
    o->error = o->error != 0 ? o->error : image->error != 0 ? image->error : KRS_DEFAULT_ERROR;
    if (o->pixel_filter == KRS_PIXEL_FILTER_DEFAULT)
        o->pixel_filter = (KrsPixelFilter)find_name(krs_pixel_filter_names, image->pixel_filter,
                                                    KRS_PIXEL_FILTER_BOX);
    o->slice_ms = o->slice_ms != 0 ? o->slice_ms : 50;
    if (o->integrator == KRS_INTEGRATOR_DEFAULT)
        o->integrator = (KrsIntegrator)find_name(krs_integrator_names, image->integrator,
                                                 KRS_INTEGRATOR_PREVIEW);
    if (o->methods.executor == KRS_EXECUTOR_DEFAULT && too_large &&
        o->integrator == KRS_INTEGRATOR_PREVIEW)
        o->methods.executor = KRS_EXECUTOR_LANES;
    if (o->catcher == KRS_CATCHER_DEFAULT)
        o->catcher = o->depth && o->plate ? KRS_CATCHER_SHADOWS : KRS_CATCHER_NONE;
    if (o->catcher_reflectance == 0)
        o->catcher_reflectance = KRS_DEFAULT_REFLECTANCE;
    if (o->crop.width == 0)
        o->crop = (KrsWindow){0, 0, o->width, o->height};
}

static bool check(KrsRendering *rendering, const KrsRenderOptions *o)
{
    if (o->width > KRS_MAX_SIDE || o->height > KRS_MAX_SIDE)
        return refuse(rendering, "a picture has at most 16384 pixels a side");
    if (o->crop.height == 0 || o->crop.x >= o->width || o->crop.width > o->width - o->crop.x ||
        o->crop.y >= o->height || o->crop.height > o->height - o->crop.y)
        return refuse(rendering, "the crop is not inside of the picture");
    if (o->samples > KRS_MAX_SAMPLES)
        return refuse(rendering, "there are at most 65536 samples per pixel");
    if (o->bounces > KRS_MAX_BOUNCES)
        return refuse(rendering, "a path has at most 1000 bounces");
    if (!(o->error > 0) || !(o->error <= KRS_MAX_ERROR))
        return refuse(rendering, "the permitted error must be above 0 and at most 1000 pixels");
    if (!(o->noise >= 0) || !(o->noise_floor > 0))
        return refuse(rendering, "noise at which samples end, and its floor, must be above 0");
    if (o->light_groups && (o->max_radiance > 0 || noise_is_wanted(o)))
        return refuse(rendering, "what is clamped, or ends by noise, has no groups of lights");
    if (o->light_groups && krs_light_count(rendering->scene) > KRS_MAX_LIGHT_GROUPS)
        return refuse(rendering, "there are groups for at most 240 lights");
    if (o->catcher != KRS_CATCHER_NONE && !o->depth)
        return refuse(rendering, "shadows fall on a plate whose depths are known");
    if (o->catcher == KRS_CATCHER_GLOSSY && o->integrator == KRS_INTEGRATOR_PREVIEW)
        return refuse(rendering, "a plate is glossy with the integrators direct and path");
    if (!(o->catcher_roughness >= 0) || !(o->catcher_roughness <= 1) ||
        !(o->catcher_reflectance > 0) || !(o->catcher_reflectance <= KRS_MAX_REFLECTANCE))
        return refuse(rendering, "the roughness of a plate is at most 1, its reflectance 0.99");
    if (o->caustics == KRS_CAUSTICS_PHOTONS &&
        (o->integrator != KRS_INTEGRATOR_PATH || o->light_groups ||
         o->catcher != KRS_CATCHER_NONE || rendering->program->volumes > 0))
        return refuse(rendering, "photons are for the integrator path, without groups of lights, a "
                                 "plate that catches shadows, or media that scatter light");
    if (!(o->max_radiance >= 0))
        return refuse(rendering, "the most radiance of a ray must be above 0");
    if (!(o->slice_ms > 0) || o->methods.max_steps > MAX_STEPS ||
        o->methods.steps_at_once > MAX_STEPS_AT_ONCE)
        return refuse(rendering,
                      "slices must be longer than nothing, and rays have at most 16384 steps");
    return true;
}

bool settings_complete(KrsRendering *rendering, KrsRenderOptions *options, KrsSchedule *asked)
{
    const KrsImage image = krs_scene_image(rendering->scene);
    if (!choose(rendering, options, asked))
        return false;
    put_defaults(&image, krs_scene_too_large(rendering->scene) != NULL, options);
    return check(rendering, options);
}
