/*
 * info_cost.c: `krs info --cost`: which parts of a scene take how much of a frame.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/info.h"
#include "cli/options/choices.h"
#include "cli/shell/supervise.h"
#include "profile/profile.h"

typedef struct Costing {
    const Options  *options;
    const KrsScene *scene;
    Profile         profile;
    Progress        progress;
    const char     *device;
} Costing;

static bool report_progress(void *user, double fraction)
{
    Costing *costing = user;
    stage_note_progress();
    progress_show(&costing->progress, fraction);
    return !*interrupted();
}

static bool note_progress(void *user, double fraction)
{
    (void)user;
    (void)fraction;
    stage_note_progress();
    return !*interrupted();
}

/* Compiles without diagnostics: all were printed when the scene was compiled. */
static KrsStatus compile_without(void *user, const KrsLocation *without, KrsScene **scene)
{
    const Costing *costing = user;
    const char    *path    = costing->options->files.items[0];
    DiagnosticSink sink    = {.options = costing->options};
    KrsOptions     with    = scene_options(&sink, path);
    with.diagnostic        = NULL;
    with.without           = without;
    stage_note_progress();
    return scene_compile(costing->options, path, &with, scene);
}

static KrsStatus make_state(void *user, const KrsScene *scene, KrsState **state)
{
    const Costing *costing = user;
    return scene_state(costing->options, scene, state);
}

/* ---- text ---- */

/* Returns text such as "gear.krs:14:5". */
static const char *place_of(const Costing *costing, const Part *part)
{
    Text               text     = {.arena = costing->options->arena};
    const KrsLocation *location = &part->location;
    text_format(&text, "%s:%u:%u", location->source, location->line, location->column);
    return text.bytes;
}

/* Returns text such as "rest of union, 12 times". */
static const char *name_of(const Costing *costing, const ProfileRow *row)
{
    enum { LENGTH = 48 };
    Text text = {.arena = costing->options->arena};
    if (!row->part)
        return costing->profile.untimed > 0
                   ? "others: light, background, parts that were not timed"
                   : "others: light, background, all that is less than 2 %";
    if (row->rest)
        text_add(&text, "rest of ");
    text_add(&text, row->part->name);
    if (row->part->count > 1)
        text_format(&text, ", %zu times", row->part->count);
    text_format(&text, "  %s", part_words(row->part, LENGTH, costing->options->arena));
    return text.bytes;
}

static int width_of_places(const Costing *costing)
{
    size_t width = strlen("place");
    for (size_t i = 0; i < costing->profile.row_count; i++)
        if (costing->profile.rows[i].part)
            width = (size_t)fmax((double)width,
                                 (double)strlen(place_of(costing, costing->profile.rows[i].part)));
    return (int)width;
}

static double share_of(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

static void print_row(const Costing *costing, const ProfileRow *row, int width)
{
    printf("%5.1f %%  %8.2f  %8.1f  %10.0f  %3.0f %%  %-*s  %s\n", 100 * row->share, row->ms,
           row->cost.flops, row->cost.operations,
           share_of(row->cost.glsl_bytes, costing->profile.whole.glsl_bytes), width,
           row->part ? place_of(costing, row->part) : "", name_of(costing, row));
}

static void print_text(const Costing *costing)
{
    const Profile *profile = &costing->profile;
    const int      width   = width_of_places(costing);
    printf("frame   %.4g ms%s at %ux%u on %s\npoint   %.1f flops, %.0f operations, %.0f bytes of "
           "text\n\n  share        ms     flops  operations   text  %-*s  part\n",
           profile->frame_ms, profile->of_processors ? " of processors" : "", profile->width,
           profile->height, costing->device, profile->whole.flops, profile->whole.operations,
           profile->whole.glsl_bytes, width, "place");
    for (size_t i = 0; i < profile->row_count; i++) {
        print_row(costing, &profile->rows[i], width);
        if (i == profile->others && i + 1 < profile->row_count)
            puts("\nwhat several of these have in common:");
    }
}

/* ---- JSON ---- */

static void add_cost(Json *json, const PartCost *cost)
{
    json_number(json, "flops", cost->flops);
    json_number(json, "operations", cost->operations);
    json_number(json, "glsl_bytes", cost->glsl_bytes);
}

static void add_part(Json *json, const ProfileRow *row)
{
    const KrsLocation *location = &row->part->location;
    json_open(json, NULL, "{");
    json_text(json, "name", row->part->name);
    json_text(json, "source", location->source);
    json_whole(json, "line", location->line);
    json_whole(json, "column", location->column);
    json_whole(json, "start", location->start);
    json_whole(json, "end", location->end);
    json_whole(json, "count", row->part->count);
    json_truth(json, "rest", row->rest);
    json_number(json, "share", row->share);
    json_number(json, "ms", row->ms);
    add_cost(json, &row->cost);
    json_close(json, "}");
}

static void add_parts(Json *json, const char *name, const ProfileRow *rows, size_t count)
{
    json_open(json, name, "[");
    for (size_t i = 0; i < count; i++)
        add_part(json, &rows[i]);
    json_close(json, "]");
}

static void print_json(const Costing *costing)
{
    const Profile    *profile = &costing->profile;
    const ProfileRow *others  = &profile->rows[profile->others];
    Json              json    = {.text = {.arena = costing->options->arena}, .spaced = true};
    json_open(&json, NULL, "{");
    info_begin_json(&json, costing->scene);
    json_open(&json, "cost", "{");
    json_text(&json, "device", costing->device);
    json_whole(&json, "width", profile->width);
    json_whole(&json, "height", profile->height);
    json_truth(&json, "of_processors", profile->of_processors);
    json_number(&json, "frame_ms", profile->frame_ms);
    add_cost(&json, &profile->whole);
    add_parts(&json, "parts", profile->rows, profile->others);
    add_parts(&json, "shared", others + 1, profile->row_count - profile->others - 1);
    json_open(&json, "others", "{");
    json_number(&json, "share", others->share);
    json_number(&json, "ms", others->ms);
    add_cost(&json, &others->cost);
    json_close(&json, "}");
    json_whole(&json, "timed", profile->timed);
    json_whole(&json, "untimed", profile->untimed);
    json_close(&json, "}");
    json_close(&json, "}");
    puts(json.text.bytes);
}

/* ---- what is asked for ---- */

static KrsStatus profile(Costing *costing, KrsRenderer *renderer)
{
    const Options *options = costing->options;
    const KrsImage image   = krs_scene_image(costing->scene);
    ProfileOptions how     = {.renderer = renderer,
                              .how      = options->how,
                              .seconds  = options->cost_seconds,
                              .alone    = true,
                              .compile  = compile_without,
                              .state    = make_state,
                              .progress = report_progress,
                              .user     = costing};
    KrsStatus      status  = scene_camera(options, costing->scene, &how.how.camera);
    const double   width   = image.width > 0 ? image.width : KRS_DEFAULT_WIDTH;
    const double   height  = image.height > 0 ? image.height : KRS_DEFAULT_HEIGHT;
    how.aspect             = width / height;
    how.how.integrator     = KRS_INTEGRATOR_PREVIEW;
    how.how.progress       = note_progress;
    how.purpose            = options->how.methods.executor == KRS_EXECUTOR_LANES ? KRS_FOR_LANES
                                                                                 : KRS_FOR_PICTURES;
    if (status != KRS_OK)
        return status;
    stage_enter(STAGE_RENDER);
    progress_start(&costing->progress, options, 1);
    status = profile_make(&how, costing->scene, options->arena, &costing->profile);
    progress_end(&costing->progress);
    if (status != KRS_OK && status != KRS_INTERRUPTED)
        say_renderer(options, costing->scene, renderer, status);
    return status;
}

KrsStatus info_cost(const Options *options, const KrsScene *scene)
{
    Costing      costing = {.options = options, .scene = scene};
    KrsRenderer *renderer;
    KrsStatus    status = open_renderer(options, &renderer);
    if (status != KRS_OK)
        return status;
    const KrsDevice device = krs_renderer_device(renderer);
    costing.device         = device.name;
    status                 = profile(&costing, renderer);
    if (status == KRS_OK && options->json)
        print_json(&costing);
    else if (status == KRS_OK)
        print_text(&costing);
    if (status == KRS_OK && costing.profile.untimed > 0 && !options->quiet)
        say("%zu part%s not timed in %g s; a larger --seconds times more%s",
            costing.profile.untimed, costing.profile.untimed == 1 ? " was" : "s were",
            options->cost_seconds,
            costing.profile.timed == 0 ? ", and --rays lanes compiles no shaders" : "");
    profile_free(&costing.profile);
    krs_renderer_free(renderer);
    return status;
}
