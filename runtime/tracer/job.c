/*
 * job.c: reads a state: where its rays come from, its lights and parameters.
 */
#include "runtime/tracer/job.h"

#include <math.h>
#include <string.h>

#include "runtime/tracer/emissive.h"
#include "runtime/tracer/methods.h"
#include "runtime/tracer/origin.h"
#include "runtime/tracer/rendering.h"
#include "runtime/tracer/sky_table.h"
#include "runtime/tracer/view.h"

bool job_refuse(Job *job, const char *words)
{
    gpu_refuse(job->gpu, KRS_BAD_ARGUMENT, "%s", words);
    return false;
}

const Shader *job_pixel_shader(const Job *job, PixelShader shader)
{
    return &job->rendering->renderer->pixels[job->rendering->rays][shader];
}

bool job_has_beams(const Job *job)
{
    const uint32_t least = MAX_BEAM_STEPS / 2;
    return !job->options.methods.no_beams && !job->rays &&
           job->view.camera.projection != KRS_PANORAMA &&
           job->view.camera.aperture == 0 && /* else the rays of a tile do not meet in the eye */
           rendering_has_beams(job->rendering, job->options.methods.trace) &&
           rendering_steps_within(job->rendering, least) == least;
}

uint32_t tiles_of_band(const WorkBlock *work)
{
    return ((work->extent[0] + TILE - 1) / TILE) * ((work->extent[1] + TILE - 1) / TILE);
}

/* Returns the radius of the taps for a normal, in pixels.  Beyond half a pixel they also filter
   detail that is finer than a pixel, which several samples do by themselves. bench/minify found the
   number. */
static float normal_reach(const KrsRenderOptions *options)
{
    bool one_sided = options->methods.normals == KRS_NORMALS_FORWARD ||
                     options->methods.normals == KRS_NORMALS_ANALYTIC;
    return options->methods.no_filter || options->samples > 1 || one_sided ? 0.5f : 0.7f;
}

/* Tells whether the rectangle in which rays of an orthographic camera begin is outside of all solids: balls around
   its parts must be.  The frame is prepared. */
static bool rectangle_is_outside(const Job *job, KrsState *state)
{
    enum { SIDE = 16 };
    const FrameBlock *frame = &job->frame;
    double            points[SIDE * SIDE][3], clearances[SIDE * SIDE], square = 0;
    for (int k = 0; k < 3; k++) {
        const double right = (double)frame->right[k] / SIDE, up = (double)frame->up[k] / SIDE;
        square += right * right + up * up;
        for (int i = 0; i < SIDE * SIDE; i++)
            points[i][k] = job->view.camera.eye[k] + (2 * (i % SIDE) + 1 - SIDE) * right +
                           (2 * (i / SIDE) + 1 - SIDE) * up;
    }
    if (job->view.camera.shift[0] != 0 || job->view.camera.shift[1] != 0 ||
        krs_distance(state, (const double(*)[3])points, SIDE * SIDE, clearances) != KRS_OK)
        return false;
    for (int i = 0; i < SIDE * SIDE; i++)
        if (!(clearances[i] > 1.01 * sqrt(square)))
            return false;
    return true;
}

/* Tells whether all rays begin outside of all solids.  A ray from inside of a solid hits the inner wall
   of the union, which no march group or scene part knows by itself.  Rays of a list may begin
   anywhere, and are not tested one by one. */
static bool begins_outside(const Job *job, KrsState *state)
{
    const KrsProgram *program   = job->rendering->program;
    const KrsCamera  *camera    = &job->view.camera;
    double            clearance = 0, reach = camera->aperture + fabs(camera->eyes);
    if (job->rays)
        return false;
    if (camera->projection != KRS_ORTHOGRAPHIC)
        return krs_distance(state, (const double(*)[3]) & camera->eye, 1, &clearance) == KRS_OK &&
               clearance > reach;
    for (int corner = 0; corner < 8; corner++) {
        double ahead = 0;
        for (int i = 0; i < 3; i++) {
            double side = corner >> i & 1 ? program->high[i] : program->low[i];
            ahead += (side - camera->eye[i]) * (camera->target[i] - camera->eye[i]);
        }
        if (!(ahead > 0)) /* a lens lies across the view */
            return rectangle_is_outside(job, state);
    }
    return true;
}

/* Fills in the block of the frame for the shaders, with points relative to the rebase origin. */
static bool prepare_frame_block(Job *job)
{
    const KrsProgram *program = job->rendering->program;
    KrsView           view    = job->view;
    double            low[3], high[3];
    for (int i = 0; i < 3; i++) {
        view.camera.eye[i] -= job->rebase_origin[i];
        view.camera.target[i] -= job->rebase_origin[i];
        low[i]  = program->low[i] - job->rebase_origin[i];
        high[i] = program->high[i] - job->rebase_origin[i];
    }
    view.fog.base -= job->rebase_origin[1];
    if (!view_prepare(&view, low, high, job->options.width, job->options.height, &job->frame))
        return job_refuse(job, "the camera sees nothing: its eye is at its target, its focus behind"
                               " it, or its angle, height or aperture is not one");
    if (job->rays && job->rays->farthest > 0)
        job->frame.farthest = (float)fmin(job->rays->farthest, (double)job->frame.farthest);
    if (view.sky.map)
        job->frame.sky_power = (float)(view.sky.intensity * sky_table_irradiance(job->rendering));
    job->frame.error        = (float)job->options.error;
    job->frame.max_steps    = job->options.methods.max_steps;
    job->frame.normal_reach = normal_reach(&job->options);
    job->frame.snaps        = job->rendering->snaps;
    return true;
}

bool job_light_meets_planes(const Job *job)
{
    return job->begins_outside &&
           rendering_light_meets_planes(job->rendering, job->options.integrator);
}

void job_find_rest(const Job *job, double low[3], double high[3])
{
    const KrsProgram *program = job->rendering->program;
    for (int i = 0; i < 3; i++) {
        low[i]  = program->rest_low[i] - job->rebase_origin[i];
        high[i] = program->rest_high[i] - job->rebase_origin[i];
    }
}

/* Uploads the block of the frame.  Rays to lights are clipped to its box; marches have boxes of their
   own. */
static void upload_frame_block(Job *job)
{
    double low[3], high[3];
    job_find_rest(job, low, high);
    if (job_light_meets_planes(job))
        view_place_box(&job->view, low, high, &job->frame);
    memcpy(job->rendering->frame.bytes, &job->frame, sizeof job->frame);
}

static RayKind kind_of_rays(const Job *job)
{
    const KrsCamera *camera = &job->view.camera;
    bool lens = camera->aperture > 0 || camera->shift[0] != 0 || camera->shift[1] != 0 ||
                job->options.eye != KRS_EYE_OF_BOTH;
    return job->rays                                     ? RAYS_OF_LISTS
           : lens                                        ? RAYS_OF_LENSES
           : job->view.camera.projection == KRS_PANORAMA ? RAYS_OF_PANORAMAS
                                                         : RAYS_OF_CAMERAS;
}

/* Chooses the light that alone is asked for: then the sky is black. */
static bool choose_light(Job *job)
{
    const uint32_t light = job->options.light;
    if (light != 0) {
        job->view.sky = (KrsSky){.zenith = {0}};
        memset(job->view.fog.color, 0, sizeof job->view.fog.color);
    }
    return light == KRS_NO_LIGHT || light <= job->view.light_count;
}

bool job_read_frame(Job *job, KrsState *state, const KrsCamera *camera)
{
    job->rendering->snaps = job->options.integrator != KRS_INTEGRATOR_PREVIEW;
    if (krs_state_view(state, camera || job->rays ? 0 : job->options.camera, &job->view) != KRS_OK)
        return job_refuse(job, "the scene has no such camera");
    if (!choose_light(job))
        return job_refuse(job, "the scene has no such light");
    if (camera)
        job->view.camera = *camera;
    view_choose_eye(&job->view.camera, job->options.eye, job->options.width, job->options.height);
    if (job->rays && !view_of_rays(job->rays, (size_t)job->options.width * job->options.height,
                                   &job->view.camera))
        return job_refuse(job, "rays have finite origins, directions that are not 0, and a width "
                               "or a spread above 0");
    job->state = state;
    origin_choose(job->rendering, state,
                  &(Viewer){&job->view.camera, job->rays, job->options.width, job->options.height},
                  job->rebase_origin);
    if (!sky_table_upload(job->rendering, job->view.sky.map) || !prepare_frame_block(job))
        return false;
    job->begins_outside = begins_outside(job, state);
    if (job->rendering->program->emits && job->options.integrator != KRS_INTEGRATOR_PREVIEW)
        job->frame.emissive_count = emissive_find(job->rendering->program, &job->view.camera, state,
                                                  job->rebase_origin, job->emissive);
    const double *rebase_origin = job_is_camera_relative(job) ? job->rebase_origin : NULL;
    if (!rendering_set_parameters(job->rendering, state, rebase_origin) ||
        !rendering_set_rays(job->rendering, kind_of_rays(job)) ||
        (rebase_origin && !rendering_rebase(job->rendering, state, rebase_origin)))
        return false;
    upload_frame_block(job);
    return true;
}
