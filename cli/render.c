/*
 * render.c: `krs render`: compile, render frame by frame, write.
 *
 * Whatever can be wrong with the command line or the outputs is found before the work begins.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/shell/commands.h"
#include "cli/options/choices.h"
#include "cli/shell/console.h"
#include "cli/picture/denoised.h"
#include "cli/picture/frame_paths.h"
#include "cli/picture/picture.h"
#include "cli/picture/read_exr.h"
#include "cli/picture/render.h"
#include "cli/picture/render_stats.h"
#include "cli/shell/supervise.h"
#include "cli/picture/whole.h"

static bool show_progress(void *user, double done)
{
    Render *render = user;
    stage_note_progress();
    progress_show(&render->progress, render->checkpoint.done + render->checkpoint.share * done);
    return !*interrupted() && !(render->outdated && render->outdated(render->user));
}

/* Refuses more than --limit permits if the scene asks for it, and as wrong usage if the command
   line does. */
static KrsStatus check_limit(const Options *options, const char *name, uint64_t asked,
                             uint64_t most, bool by_scene)
{
    if (most == 0 || asked <= most)
        return KRS_OK;
    if (!by_scene)
        return say_usage(options, "%llu %s are more than --limit %s=%llu",
                         (unsigned long long)asked, name, name, (unsigned long long)most);
    say("the scene asks for %llu %s, of which --limit %s=%llu allows fewer",
        (unsigned long long)asked, name, name, (unsigned long long)most);
    return KRS_BAD_SCENE;
}

static uint32_t first_of(uint32_t asked, uint32_t scene, uint32_t otherwise)
{
    return asked ? asked : scene ? scene : otherwise;
}

/* Returns the integrator that is asked for, or the one that the scene says, or the preview. */
static KrsIntegrator find_integrator(KrsIntegrator asked, const char *scene)
{
    if (asked != KRS_INTEGRATOR_DEFAULT)
        return asked;
    const int found = scene ? find_choice(scene, integrator_choices) : -1;
    return found > 0 ? (KrsIntegrator)found : KRS_INTEGRATOR_PREVIEW;
}

/* Returns all AOVs but the noise, which needs samples to be compared, unless it is asked for by its
   name. */
static uint32_t known_aovs(const Options *options)
{
    return options->aovs == KRS_AOV_ALL ? KRS_AOV_ALL & ~KRS_AOV_NOISE : KRS_AOV_ALL;
}

/* Chooses the size of the picture and its samples, which --limit may be too few for. */
static KrsStatus choose_size(Render *render, const KrsImage *image)
{
    const Options    *options = render->options;
    const Limits     *limits  = &options->limits;
    KrsRenderOptions *how     = &render->how;
    const uint32_t    asked   = options->how.samples;
    how->width                = first_of(how->width, image->width, KRS_DEFAULT_WIDTH);
    how->height               = first_of(how->height, image->height, KRS_DEFAULT_HEIGHT);
    render->samples           = first_of(asked, image->samples,
                               render->noise > 0 ? KRS_DEFAULT_NOISY_SAMPLES : KRS_DEFAULT_SAMPLES);
    KrsStatus status          = check_limit(options, "pixels", (uint64_t)how->width * how->height,
                                            limits->pixels, options->how.width == 0);
    if (status == KRS_OK)
        status = check_limit(options, "samples", render->samples, limits->samples, asked == 0);
    return status;
}

/* Refuses options that exclude each other, when the size and the AOVs are chosen. */
static KrsStatus check_how(const Render *render)
{
    const Options          *options = render->options;
    const KrsRenderOptions *how     = &render->how;
    const KrsWindow        *crop    = &how->crop;
    if (crop->x + crop->width > how->width || crop->y + crop->height > how->height)
        return say_usage(options, "--crop %u,%u,%u,%u is not inside of a picture of %ux%u", crop->x,
                         crop->y, crop->width, crop->height, how->width, how->height);
    if (options->light_groups && render->noise > 0)
        return say_usage(options,
                         "--light-groups add up to the picture; where samples end by noise "
                         "they do not");
    if (options->light_groups && how->aovs & KRS_AOV_NOISE)
        return say_usage(options, "--light-groups have no estimate of their noise");
    return KRS_OK;
}

static bool writes_exr(const Render *render)
{
    for (size_t i = 0; i < render->output_count; i++)
        if (file_form(render->outputs[i]) == FORM_EXR)
            return true;
    return false;
}

/* Chooses size, crop and the rest from the options and the scene's image block. */
static KrsStatus choose_how(Render *render)
{
    const Options    *options = render->options;
    KrsRenderOptions *how     = &render->how;
    KrsView           view;
    size_t            camera;
    KrsStatus         status = scene_camera(options, render->scene, &camera);
    if (status == KRS_OK)
        status = krs_state_view(render->state, camera, &view);
    if (status != KRS_OK)
        return status;
    *how          = options->how;
    render->noise = options->how.noise > 0 ? options->how.noise : view.image.noise;
    status        = choose_size(render, &view.image);
    if (status != KRS_OK)
        return status;
    how->camera        = camera;
    how->seed          = options->seed;
    how->frame_seconds = 1 / options->fps;
    how->aovs          = picture_aovs(options, writes_exr(render));
    if (render->noise <= 0)
        how->aovs &= known_aovs(options);
    if (options->denoise)
        how->aovs |= DENOISING_AOVS;
    if (!isnan(options->exposure))
        how->noise_floor = KRS_DEFAULT_NOISE_FLOOR * exp2(-options->exposure);
    how->light_groups = options->light_groups;
    how->integrator   = find_integrator(how->integrator, view.image.integrator);
    if (how->integrator == KRS_INTEGRATOR_PREVIEW &&
        krs_scene_program(render->scene)->volumes > 0 && !options->quiet)
        say("`preview` shows no media; `--integrator path` does");
    how->progress = show_progress;
    how->user     = render;
    if (options->first_sample > 0)
        how->aovs = KRS_AOV_COLOR; /* the others come from the first sample */
    status = check_how(render);
    if (status == KRS_OK && options->denoise)
        status = denoised_check(options, how->light_groups);
    return status == KRS_OK ? samples_check(options, how, render->noise) : status;
}

static void show_stats(Render *render, const KrsRenderStats *stats, uint32_t frame)
{
    const Options *options = render->options;
    if (options->stats != STATS_NONE)
        progress_end(&render->progress);
    render_stats_show(options, render->rendering, krs_scene_program(render->scene), stats, frame);
}

static KrsStatus make_groups(Render *render, const KrsPicture *picture, LightGroups *groups)
{
    KrsStatus status = light_groups_make(render->options->arena, render->scene, picture, groups);
    if (status != KRS_OK)
        say("%s", "out of memory for the groups of lights");
    return status;
}

static KrsStatus write_outputs(Render *render, const KrsPicture *picture, double time,
                               uint32_t frame)
{
    const Options *options = render->options;
    KrsView        view;
    KrsStatus      status  = krs_state_view(render->state, render->how.camera, &view);
    PictureNotes   notes   = {.scene = render->scene, .time = time, .sums = render->sums};
    notes.display.exposure = isnan(options->exposure) ? view.image.exposure : options->exposure;
    notes.display.white_balance = options->white_balance;
    if (!(options->white_balance.kelvins > 0))
        notes.display.white_balance = (WhiteBalance){view.image.white_balance[0],
                                                     view.image.white_balance[1]};
    if (options->tone_map >= 0)
        notes.display.tone_map = options->tone_map;
    else if (view.image.tone_map)
        tone_map_find(view.image.tone_map,
                      &notes.display.tone_map); /* the compiler knows its name */
    notes.noise_floor = render->how.noise_floor > 0
                            ? render->how.noise_floor
                            : KRS_DEFAULT_NOISE_FLOOR * exp2(-view.image.exposure);
    if (options->denoise && status == KRS_OK)
        status = denoised_frame(options, picture, notes.noise_floor, &notes.denoised);
    if (options->raw && status == KRS_OK)
        status = picture_write_raw(picture, &notes);
    if (options->light_groups && status == KRS_OK)
        status = make_groups(render, picture, &notes.groups);
    for (size_t i = 0; i < render->output_count && status == KRS_OK; i++)
        status = picture_write(options, picture, &notes,
                               frame_path(options, render->outputs[i], frame));
    free(notes.groups.values);
    free(notes.denoised);
    return status;
}

/* Renders what each eye sees, and joins the two. */
static KrsStatus render_eyes(Render *render, KrsPicture **picture)
{
    KrsPicture      *eyes[2] = {NULL, NULL};
    KrsRenderOptions how     = render->how;
    KrsStatus        status  = KRS_OK;
    for (int i = 0; i < 2 && status == KRS_OK; i++) {
        how.eye = i == 0 ? KRS_EYE_ON_LEFT : KRS_EYE_ON_RIGHT;
        status  = krs_render(render->rendering, render->state, &how, &eyes[i]);
    }
    if (status == KRS_OK)
        status = krs_picture_join(eyes[0], eyes[1], render->options->stereo == 1, picture);
    krs_picture_free(eyes[0]);
    krs_picture_free(eyes[1]);
    return status;
}

static KrsStatus render_picture(Render *render, uint32_t frame, KrsPicture **picture)
{
    if (render->options->stereo >= 0)
        return render_eyes(render, picture);
    if (!render->options->resume && !render->options->samples_divided)
        return krs_render(render->rendering, render->state, &render->how, picture);
    const CheckpointFrame resumed = {
        render->rendering,
        render->state,
        &render->how,
        render->options->samples_divided ? render->options->last_sample + 1 : render->samples,
        frame,
        &render->sums};
    return checkpoint_render(&render->checkpoint, &resumed, picture);
}

/* Reads what another renderer has made of the frame; free_others frees it. */
static KrsStatus read_others(Render *render, uint32_t frame)
{
    const Options    *options = render->options;
    KrsRenderOptions *how     = &render->how;
    KrsStatus         status  = KRS_OK;
    if (options->depth_in)
        status = read_depth(options, frame_path(options, options->depth_in, frame), how->width,
                            how->height, &render->depth);
    if (status == KRS_OK && options->plate)
        status = read_plate(options, frame_path(options, options->plate, frame), how->width,
                            how->height, &render->plate);
    how->depth = render->depth;
    how->plate = (const float(*)[4])render->plate;
    return status;
}

static void free_others(Render *render)
{
    free(render->depth);
    free(render->plate);
    render->depth = NULL;
    render->plate = NULL;
}

static KrsStatus render_frame(Render *render, uint32_t frame)
{
    const Options *options = render->options;
    double         time    = options->time + (options->animated ? frame / options->fps : 0);
    KrsPicture    *picture = NULL;
    KrsStatus      status  = scene_set_time(options, render->state, time);
    if (status != KRS_OK)
        return status;
    status = read_others(render, frame);
    if (status != KRS_OK) {
        free_others(render);
        return status;
    }
    stage_enter(STAGE_RENDER);
    if (status == KRS_OK)
        status = render_picture(render, frame, &picture);
    if (status != KRS_OK) {
        free_others(render);
        progress_end(&render->progress);
        if (status != KRS_INTERRUPTED && !render->checkpoint.failed)
            say_renderer(options, render->scene, render->renderer, status);
        return status;
    }
    status = write_outputs(render, picture, time, frame);
    free_others(render);
    free(render->sums.numbers);
    render->sums.numbers = NULL;
    if (status == KRS_OK)
        show_stats(render, &picture->stats, frame);
    render_faults_add(&render->faults, picture, render->noise);
    krs_picture_free(picture);
    return status;
}

/* Samples of so many pixels in all frames. */
static double count_samples(const Render *render, double pixels)
{
    const Options *options = render->options;
    const double   frames  = (double)options->last_frame - options->first_frame + 1;
    return pixels * frames * render->samples;
}

static double pixels_of_window(const KrsRenderOptions *how)
{
    const KrsWindow *crop = &how->crop;
    return crop->width > 0 ? (double)crop->width * crop->height : (double)how->width * how->height;
}

/* Samples of all pixels from which shaders that take longer to compile are better even if they are
   new.  Their faster frames repay the compilation after ten pictures of 640x360 of
   examples/05-rock.krs and 06-temple.krs, after one and a half of 08-reef.krs and 29-logo.krs, and
   at once of 07-grove.krs (bench/measurements.md). */
#define SAMPLES_OF_SMALL_PICTURES (1.0 * 640 * 360)

/* A crop has the shaders of the picture that it is a part of, so its pixels are the same.  `krs watch` will
   render more pictures by the same shaders. */
static KrsPurpose purpose_of(const Render *render)
{
    const KrsRenderOptions *how   = &render->how;
    const double            whole = count_samples(render, (double)how->width * how->height);
    const bool              small = whole <= SAMPLES_OF_SMALL_PICTURES &&
                       render->options->command != COMMAND_WATCH;
    const KrsExecutor executor = how->methods.executor;
    const bool        lanes    = executor == KRS_EXECUTOR_LANES ||
                       (executor == KRS_EXECUTOR_DEFAULT && krs_scene_too_large(render->scene));
    return how->integrator != KRS_INTEGRATOR_PREVIEW ? KRS_FOR_PATHS
           : lanes                                   ? KRS_FOR_LANES
           : small                                   ? KRS_FOR_SMALL_PICTURES
                                                     : KRS_FOR_FIRST_PICTURES;
}

/* The scene has literals so far. */
static KrsStatus specialize(Render *render)
{
    const Options *options = render->options;
    KrsScene      *edited  = NULL;
    if (options->specialize == KRS_SPECIALIZE_AUTO && purpose_of(render) != KRS_FOR_LANES)
        edited = specialize_edited(options, render->scene,
                                   count_samples(render, pixels_of_window(&render->how)));
    if (!edited)
        return KRS_OK;
    krs_state_free(render->state);
    krs_scene_free(render->scene);
    render->state = NULL;
    render->scene = edited;
    return scene_state(options, edited, &render->state);
}

KrsStatus render_choose(Render *render)
{
    KrsStatus status = scene_state(render->options, render->scene, &render->state);
    return status == KRS_OK ? choose_how(render) : status;
}

KrsStatus render_compile(Render *render)
{
    const Options *options = render->options;
    stage_enter(STAGE_SHADERS);
    console_doing(options, "compiling the shaders");
    const KrsPurpose purpose = purpose_of(render);
    KrsStatus        status  = krs_rendering_new(render->renderer, render->scene, purpose,
                                                 &render->rendering);
    console_doing(options, NULL);
    if (status != KRS_OK)
        say_renderer(options, render->scene, render->renderer, status);
    else if (purpose == KRS_FOR_LANES && render->how.methods.executor == KRS_EXECUTOR_DEFAULT &&
             !options->quiet)
        say("the scene is too large for shaders (%s): lanes of the host march its rays",
            krs_scene_too_large(render->scene)->code);
    return status;
}

static KrsStatus make_ready(Render *render)
{
    const Options *options = render->options;
    KrsStatus      opened  = open_renderer_early(options, &render->renderer);
    KrsStatus      status  = scene_open(options, options->files.items[0], &render->scene);
    if (status == KRS_OK)
        status = render_choose(render);
    if (status == KRS_OK)
        status = specialize(render);
    if (status == KRS_OK)
        status = opened_renderer(opened, &render->renderer);
    return status == KRS_OK ? render_compile(render) : status;
}

/* Tells whether all files of a frame are there already, and whole. */
static bool is_there(const Render *render, uint32_t frame)
{
    bool there = render->output_count > 0;
    for (size_t i = 0; i < render->output_count; i++)
        there = there && picture_is_whole(frame_path(render->options, render->outputs[i], frame));
    return there;
}

/* Renders the frames, except for those that are there if options say so. */
KrsStatus render_frames(Render *render)
{
    const Options *options = render->options;
    KrsStatus      status  = KRS_OK;
    uint32_t       skipped = 0;
    const uint32_t resumed = options->resume ? checkpoint_find(&render->checkpoint, render->scene,
                                                               render->renderer)
                                             : options->first_frame;
    progress_start(&render->progress, options,
                   (size_t)options->last_frame - options->first_frame + 1);
    for (uint32_t frame = options->first_frame; frame <= options->last_frame && status == KRS_OK;
         frame++) {
        render->progress.frame = frame - options->first_frame;
        if ((options->skip_existing || frame < resumed) && is_there(render, frame))
            skipped++;
        else
            status = render_frame(render, frame);
        if (options->resume && status == KRS_OK && frame >= resumed)
            status = checkpoint_advance(&render->checkpoint, frame);
    }
    progress_end(&render->progress);
    render_faults_say(&render->faults, options);
    render->faults = (RenderFaults){0};
    if (skipped > 0 && !options->quiet)
        say("left out %u frame%s whose files are there", skipped, skipped > 1 ? "s" : "");
    return status;
}

void render_free(Render *render)
{
    krs_rendering_free(render->rendering);
    krs_renderer_free(render->renderer);
    krs_state_free(render->state);
    krs_scene_free(render->scene);
}

KrsStatus command_render(Options *options)
{
    Render   *render = arena_new(options->arena, Render);
    KrsStatus status = render_begin(render, options);
    if (status == KRS_OK)
        status = make_ready(render);
    if (status == KRS_OK)
        status = render_frames(render);
    progress_end(&render->progress);
    if (status == KRS_OK)
        render_say_written(render, 0);
    render_free(render);
    return status;
}
