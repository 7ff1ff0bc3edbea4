/*
 * render.c: `krs render`: compile, render frame by frame, write.
 *
 * Whatever can be wrong with the command line or the outputs is found before the work begins.
 */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/commands.h"
#include "cli/choices.h"
#include "cli/console.h"
#include "cli/picture.h"
#include "cli/supervise.h"

typedef struct Render {
    const Options   *options;
    const char     **outputs;
    size_t           output_count;
    KrsScene        *scene;
    KrsFrame        *frame;
    KrsRenderer     *renderer;
    KrsRendering    *rendering;
    KrsRenderOptions how;
    uint32_t         samples; /* of a pixel, also where `how` leaves it to the scene */
    Progress         progress;
} Render;

/* Where the frame's number goes in the name of an output: "%d", "%04d".  NULL without one. */
static const char *find_pattern(const char *path, int *width, size_t *length)
{
    for (const char *percent = path; (percent = strchr(percent, '%')); percent++) {
        size_t digits = strspn(percent + 1, "0123456789");
        if (digits <= 2 && percent[1 + digits] == 'd') {
            *width  = atoi(percent + 1);
            *length = digits + 2;
            return percent;
        }
    }
    return NULL;
}

/* Whether a name has places for several numbers, of which only one would be the frame's. */
static bool has_two_patterns(const char *path)
{
    int         width;
    size_t      length;
    const char *first = find_pattern(path, &width, &length);
    return first && find_pattern(first + length, &width, &length);
}

/* The name of an output for a frame; without --frames, names are taken as they are. */
static const char *frame_path(const Options *options, const char *path, uint32_t frame)
{
    int         width   = 0;
    size_t      length  = 0;
    const char *pattern = options->animated ? find_pattern(path, &width, &length) : NULL;
    if (!pattern)
        return path;
    Text text = {.arena = options->arena};
    text_add_bytes(&text, path, (size_t)(pattern - path));
    text_format(&text, "%0*u", width, frame);
    text_add(&text, pattern + length);
    return text.bytes;
}

static void choose_outputs(Render *render)
{
    const Options *options = render->options;
    render->outputs        = options->outputs.items;
    render->output_count   = options->outputs.count;
    if (render->output_count > 0)
        return;
    static const char *const endings[] = {".exr", ".png"};
    enum { DEFAULT_OUTPUTS = 2 };
    render->outputs = arena_new_array(options->arena, const char *, DEFAULT_OUTPUTS);
    for (; render->output_count < DEFAULT_OUTPUTS; render->output_count++) {
        Text text = {.arena = options->arena};
        text_format(&text, "%s%s%s", scene_name(options->arena, options->files.items[0]),
                    options->animated ? "-%04d" : "", endings[render->output_count]);
        render->outputs[render->output_count] = text.bytes;
    }
}

/* "wrote `a.exr` and `a.png`"; of an animation once for all frames. */
static void say_written(const Render *render)
{
    const Options *options = render->options;
    Text           names   = {.arena = options->arena};
    if (options->quiet)
        return;
    for (size_t i = 0; i < render->output_count; i++)
        text_format(&names, "%s`%s`",
                    i == 0                         ? ""
                    : i + 1 < render->output_count ? ", "
                                                   : " and ",
                    render->outputs[i]);
    if (strcmp(render->outputs[0], STANDARD_OUTPUT) == 0)
        return; /* who reads it knows */
    if (options->animated)
        say("wrote frames %u to %u to %s", options->first_frame, options->last_frame, names.bytes);
    else
        say("wrote %s", names.bytes);
}

/* Whether two outputs are one file in some frame.  Names that differ in the number's width only are
   equal from some power of ten on. */
static bool are_one_file(const Options *options, const char *a, const char *b)
{
    uint32_t first = options->first_frame, last = options->last_frame;
    if (output_is_same(frame_path(options, a, first), frame_path(options, b, first)) ||
        output_is_same(frame_path(options, a, last), frame_path(options, b, last)))
        return true;
    for (uint32_t frame = 10; frame < last; frame *= 10)
        if (frame > first &&
            output_is_same(frame_path(options, a, frame), frame_path(options, b, frame)))
            return true;
    return false;
}

static KrsStatus check_name(const Render *render, size_t index)
{
    const Options *options = render->options;
    const char    *path    = render->outputs[index];
    int            width;
    size_t         length;
    if (file_form(path) == FORM_UNKNOWN)
        return say_usage(options, "the output `%s` ends in neither .exr nor .png", path);
    if (strcmp(path, STANDARD_OUTPUT) == 0 && (options->stats != STATS_NONE || isatty(1)))
        return say_usage(options, "the picture would go to %s; write it to a file",
                         isatty(1) ? "the terminal" : "where --stats goes");
    if (options->animated && !find_pattern(path, &width, &length))
        return say_usage(options, "with --frames, `%s` needs a place for the number: %%04d", path);
    if (options->animated && has_two_patterns(path))
        return say_usage(options, "`%s` has more than one place for the number of the frame", path);
    for (size_t other = 0; other < index; other++)
        if (are_one_file(options, render->outputs[other], path))
            return say_usage(options, "the output `%s` is asked for twice", path);
    return KRS_OK;
}

static KrsStatus check_outputs(const Render *render)
{
    const Options *options = render->options;
    for (size_t i = 0; i < render->output_count; i++) {
        const char *path = frame_path(options, render->outputs[i], options->first_frame);
        OutputError error;
        KrsStatus   status = check_name(render, i);
        if (status == KRS_OK)
            status = check_scene_not_overwritten(options, path);
        if (status != KRS_OK)
            return status;
        if (output_check(path, &error) != KRS_OK) {
            say("%s", error.message);
            return error.status;
        }
    }
    return KRS_OK;
}

static KrsStatus say_unknown_camera(const Options *options, const char *const *names, size_t count)
{
    const char *nearest = nearest_name(options->camera, names, count);
    Text        known   = {.arena = options->arena};
    for (size_t i = 0; i < count; i++)
        text_format(&known, "%s`%s`", i ? ", " : "", names[i]);
    if (nearest)
        return say_usage(options, "the scene has no camera `%s`; did you mean `%s`?%s%s",
                         options->camera, nearest, count > 1 ? " It has " : "",
                         count > 1 ? known.bytes : "");
    return say_usage(options, "the scene has no camera `%s`; it has %s", options->camera,
                     count ? known.bytes : "none with a name; give it one: `camera side { ... }`");
}

static KrsStatus find_camera(const Options *options, const KrsScene *scene, size_t *camera)
{
    size_t       count = krs_camera_count(scene), named = 0;
    const char **names = arena_new_array(options->arena, const char *, count + 1);
    *camera            = 0;
    for (size_t i = 0; options->camera && i < count; i++) {
        const char *name = krs_camera_name(scene, i);
        if (name && strcmp(name, options->camera) == 0) {
            *camera = i;
            return KRS_OK;
        }
        if (name)
            names[named++] = name;
    }
    if (!options->camera)
        return KRS_OK;
    return say_unknown_camera(options, names, named);
}

static bool show_progress(void *user, double done)
{
    Render *render = user;
    stage_goes_on();
    progress_show(&render->progress, done);
    return !*interrupted();
}

/* What --limit allows beats what the scene asks for; what the command line asks for beyond it makes no
   sense. */
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

/* As asked for, or as the scene says, or preview. */
static KrsIntegrator find_integrator(KrsIntegrator asked, const char *scene)
{
    if (asked != KRS_INTEGRATOR_DEFAULT)
        return asked;
    const int found = scene ? find_choice(scene, integrator_choices) : -1;
    return found > 0 ? (KrsIntegrator)found : KRS_INTEGRATOR_PREVIEW;
}

/* Size, crop and what else the options and the scene's image block say together. */
static KrsStatus choose_how(Render *render)
{
    const Options *options = render->options;
    KrsView        view;
    size_t         camera;
    KrsStatus      status = find_camera(options, render->scene, &camera);
    if (status == KRS_OK)
        status = krs_frame_view(render->frame, camera, &view);
    if (status != KRS_OK)
        return status;
    KrsRenderOptions *how     = &render->how;
    const uint32_t    asked   = options->how.samples;
    const uint32_t    samples = first_of(asked, view.image.samples, KRS_DEFAULT_SAMPLES);
    const KrsWindow  *crop    = &options->how.crop;
    *how                      = options->how;
    how->width                = first_of(how->width, view.image.width, KRS_DEFAULT_WIDTH);
    how->height               = first_of(how->height, view.image.height, KRS_DEFAULT_HEIGHT);
    status                    = check_limit(options, "pixels", (uint64_t)how->width * how->height,
                                            options->limits.pixels, options->how.width == 0);
    if (status == KRS_OK)
        status = check_limit(options, "samples", samples, options->limits.samples, asked == 0);
    if (status != KRS_OK)
        return status;
    if (crop->x + crop->width > how->width || crop->y + crop->height > how->height)
        return say_usage(options, "--crop %u,%u,%u,%u is not inside of a picture of %ux%u", crop->x,
                         crop->y, crop->width, crop->height, how->width, how->height);
    bool exr = false;
    for (size_t i = 0; i < render->output_count; i++)
        exr = exr || file_form(render->outputs[i]) == FORM_EXR;
    render->samples = samples;
    how->camera     = camera;
    how->seed       = options->seed;
    how->planes     = picture_planes(options, exr);
    how->integrator = find_integrator(how->integrator, view.image.integrator);
    how->progress   = show_progress;
    how->user       = render;
    return KRS_OK;
}

static void add_stats_json(Text *json, const KrsRenderStats *stats, const KrsProgram *program)
{
    text_format(json,
                "\"compile\": {\"front\": %.3f, \"glsl\": %.3f, \"spirv\": %.3f, "
                "\"pipeline\": %.3f, \"passes\": {",
                program->front_ms, program->glsl_ms, stats->spirv_ms, stats->pipeline_ms);
    for (size_t i = 0; krs_pass(i); i++)
        text_format(json, "%s\"%s\": %.3f", i ? ", " : "", krs_pass(i)->name, program->pass_ms[i]);
    text_add(json, "}}, \"render\": {");
    for (int phase = 0; phase < KRS_PHASE_COUNT; phase++)
        text_format(json, "\"%s\": %.3f, ", krs_phase_names[phase], stats->phase_ms[phase]);
    text_format(json,
                "\"total\": %.3f, \"wall\": %.3f}, \"device_time\": %s, \"rays\": %llu, "
                "\"evaluations\": %llu, \"evaluations_per_ray\": {\"mean\": %.3f, "
                "\"maximum\": %u}, \"flops_per_evaluation\": %.3f, \"gflops\": %.3f, "
                "\"unresolved\": %llu, \"submissions\": %llu, \"device\": ",
                stats->total_ms, stats->wall_ms, stats->device_time ? "true" : "false",
                (unsigned long long)stats->rays, (unsigned long long)stats->evaluations,
                stats->evaluations_per_ray, stats->most_evaluations_per_ray,
                stats->flops_per_evaluation, stats->gflops, (unsigned long long)stats->unresolved,
                (unsigned long long)stats->submissions);
    text_json(json, stats->device);
    text_format(json, ", \"peak_memory_bytes\": %llu",
                (unsigned long long)stats->peak_memory_bytes);
}

/* The most kernels that statistics list: those of a picture are fewer. */
enum { MOST_KERNELS = 64 };

static size_t read_kernels(const KrsRendering *rendering, KrsKernelStats kernels[MOST_KERNELS])
{
    const size_t count = krs_rendering_kernels(rendering, kernels, MOST_KERNELS);
    return count < MOST_KERNELS ? count : MOST_KERNELS;
}

static void add_kernels_json(Text *json, const KrsRendering *rendering)
{
    KrsKernelStats kernels[MOST_KERNELS];
    const size_t   count = read_kernels(rendering, kernels);
    text_add(json, ", \"kernels\": [");
    for (size_t i = 0; i < count; i++)
        text_format(json,
                    "%s{\"name\": \"%s\", \"glsl_bytes\": %llu, \"spirv_ms\": %.3f, "
                    "\"driver_ms\": %.3f, \"cached\": %s}",
                    i ? ", " : "", kernels[i].name, (unsigned long long)kernels[i].glsl_bytes,
                    kernels[i].spirv_ms, kernels[i].driver_ms,
                    kernels[i].cached ? "true" : "false");
    text_add(json, "]");
}

static void print_kernels(const KrsRendering *rendering)
{
    KrsKernelStats kernels[MOST_KERNELS];
    const size_t   count    = read_kernels(rendering, kernels);
    size_t         compiled = 0;
    double         spirv_ms = 0, driver_ms = 0;
    for (size_t i = 0; i < count; i++) {
        compiled += !kernels[i].cached;
        spirv_ms += kernels[i].spirv_ms;
        driver_ms += kernels[i].driver_ms;
    }
    printf("kernels        %zu, %zu compiled; one after the other SPIR-V %.1f ms, driver %.1f ms\n",
           count, compiled, spirv_ms, driver_ms);
}

static void print_stats(const KrsRenderStats *stats, const KrsProgram *program)
{
    printf("device         %s\n", stats->device);
    printf("compile        front end %.1f ms, GLSL %.1f ms, SPIR-V %.1f ms, pipelines %.1f ms\n",
           program->front_ms, program->glsl_ms, stats->spirv_ms, stats->pipeline_ms);
    printf("render         %.1f ms%s, %.1f ms in all:", stats->total_ms,
           stats->device_time ? " on the device" : "", stats->wall_ms);
    for (int phase = 0; phase < KRS_PHASE_COUNT; phase++)
        printf(" %s %.1f", krs_phase_names[phase], stats->phase_ms[phase]);
    printf("\nrays           %llu, %llu evaluations, %.1f per ray, at most %u\n",
           (unsigned long long)stats->rays, (unsigned long long)stats->evaluations,
           stats->evaluations_per_ray, stats->most_evaluations_per_ray);
    printf("arithmetic     %.0f flops per evaluation, %.2f Gflop/s\n", stats->flops_per_evaluation,
           stats->gflops);
    printf("unresolved     %llu\nsubmissions    %llu\npeak memory    %.1f MiB\n",
           (unsigned long long)stats->unresolved, (unsigned long long)stats->submissions,
           (double)stats->peak_memory_bytes / (1 << 20));
}

/* One object a frame, each on a line of its own. */
static void show_stats(Render *render, const KrsRenderStats *stats, uint32_t frame)
{
    const Options    *options = render->options;
    const KrsProgram *program = krs_scene_program(render->scene);
    if (options->stats != STATS_NONE)
        progress_end(&render->progress);
    if (options->stats == STATS_TEXT)
        print_stats(stats, program);
    if (options->stats == STATS_TEXT)
        print_kernels(render->rendering);
    if (options->stats != STATS_JSON)
        return;
    Text json = {.arena = options->arena};
    text_add(&json, "{");
    if (options->animated)
        text_format(&json, "\"frame\": %u, ", frame);
    add_stats_json(&json, stats, program);
    add_kernels_json(&json, render->rendering);
    text_add(&json, "}");
    puts(json.bytes);
}

static KrsStatus write_outputs(const Render *render, const KrsPicture *picture, double time,
                               uint32_t frame)
{
    const Options *options = render->options;
    KrsView        view;
    KrsStatus      status  = krs_frame_view(render->frame, render->how.camera, &view);
    PictureNotes   notes   = {.scene = render->scene, .time = time};
    notes.display.exposure = isnan(options->exposure) ? view.image.exposure : options->exposure;
    if (options->tone_map >= 0)
        notes.display.tone_map = options->tone_map;
    else if (view.image.tone_map)
        tone_map_find(view.image.tone_map,
                      &notes.display.tone_map); /* the compiler knows its name */
    for (size_t i = 0; i < render->output_count && status == KRS_OK; i++)
        status = picture_write(options, picture, &notes,
                               frame_path(options, render->outputs[i], frame));
    return status;
}

static KrsStatus render_frame(Render *render, uint32_t frame)
{
    const Options *options = render->options;
    double         time    = options->time + (options->animated ? frame / options->fps : 0);
    KrsPicture    *picture = NULL;
    KrsStatus      status  = scene_set_time(options, render->frame, time);
    if (status != KRS_OK)
        return status;
    stage_enter(STAGE_RENDER);
    if (status == KRS_OK)
        status = krs_render(render->rendering, render->frame, &render->how, &picture);
    if (status != KRS_OK) {
        progress_end(&render->progress);
        if (status != KRS_INTERRUPTED)
            say("%s", krs_renderer_message(render->renderer));
        return status;
    }
    status = write_outputs(render, picture, time, frame);
    if (status == KRS_OK)
        show_stats(render, &picture->stats, frame);
    krs_picture_free(picture);
    return status;
}

/* Samples of all pixels in all frames. */
static double count_samples(const Render *render)
{
    const Options          *options = render->options;
    const KrsRenderOptions *how     = &render->how;
    const KrsWindow        *crop    = &how->crop;
    const double            pixels  = crop->width > 0 ? (double)crop->width * crop->height
                                                      : (double)how->width * how->height;
    const double            frames  = (double)options->last_frame - options->first_frame + 1;
    return pixels * frames * render->samples;
}

/* The scene has literals so far. */
static KrsStatus specialize(Render *render)
{
    const Options *options = render->options;
    KrsScene      *edited  = NULL;
    if (options->specialize == KRS_SPECIALIZE_AUTO)
        edited = specialize_edited(options, render->scene, count_samples(render));
    if (!edited)
        return KRS_OK;
    krs_frame_free(render->frame);
    krs_scene_free(render->scene);
    render->frame = NULL;
    render->scene = edited;
    return scene_frame(options, edited, &render->frame);
}

static KrsPurpose purpose_of(const Render *render)
{
    return render->how.integrator == KRS_INTEGRATOR_PREVIEW ? KRS_FOR_PICTURES : KRS_FOR_PATHS;
}

static KrsStatus make_ready(Render *render)
{
    const Options *options = render->options;
    KrsStatus      status  = scene_open(options, options->files.items[0], &render->scene);
    if (status == KRS_OK)
        status = scene_frame(options, render->scene, &render->frame);
    if (status == KRS_OK)
        status = choose_how(render);
    if (status == KRS_OK)
        status = specialize(render);
    if (status == KRS_OK)
        status = open_renderer(options, &render->renderer);
    if (status != KRS_OK)
        return status;
    stage_enter(STAGE_SHADERS);
    console_doing(options, "compiling the shaders");
    status = krs_rendering_new_for(render->renderer, render->scene, purpose_of(render),
                                   &render->rendering);
    console_doing(options, NULL);
    if (status != KRS_OK)
        say("%s", krs_renderer_message(render->renderer));
    return status;
}

KrsStatus command_render(Options *options)
{
    Render *render  = arena_new(options->arena, Render);
    render->options = options;
    choose_outputs(render);
    KrsStatus status = check_outputs(render);
    if (status == KRS_OK)
        status = make_ready(render);
    progress_start(&render->progress, options,
                   (size_t)options->last_frame - options->first_frame + 1);
    for (uint32_t frame = options->first_frame; frame <= options->last_frame && status == KRS_OK;
         frame++) {
        render->progress.frame = frame - options->first_frame;
        status                 = render_frame(render, frame);
    }
    progress_end(&render->progress);
    if (status == KRS_OK)
        say_written(render);
    krs_rendering_free(render->rendering);
    krs_renderer_free(render->renderer);
    krs_frame_free(render->frame);
    krs_scene_free(render->scene);
    return status;
}
