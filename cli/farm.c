/*
 * farm.c: `krs farm`: a render that several processes or machines share.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/farm/job.h"
#include "cli/farm/kubernetes.h"
#include "cli/farm/pieces.h"
#include "cli/farm/probe.h"
#include "cli/farm/report.h"
#include "cli/farm/slurm.h"
#include "cli/farm/spawn.h"
#include "cli/picture/frame_paths.h"
#include "cli/options/values.h"
#include "cli/picture/picture.h"
#include "cli/shell/commands.h"
#include "cli/shell/console.h"
#include "cli/shell/supervise.h"
#include "runtime/film/doublings.h"

/* ---- submit ---- */

/* Tells whether an option of the command line is one that each piece is rendered with. */
static bool is_passed_on(OptionId id)
{
    switch (id) {
    case OPTION_FARM_FILE:
    case OPTION_FRAMES:
    case OPTION_QUIET: return false;
    default: return option_belongs(id, COMMAND_RENDER);
    }
}

/* Refuses options that name files which are not in a pack, or what a piece has of its own. */
static KrsStatus check_passed_on(const Options *options, OptionId id)
{
    switch (id) {
    case OPTION_CROP:
    case OPTION_STEREO:
    case OPTION_STAMP:
    case OPTION_STATS:
    case OPTION_DEPTH_IN:
    case OPTION_DENOISE:
    case OPTION_PLATE:
        return say_usage(options, "farm cannot divide a render with --%s", option_info[id].name);
    default: return KRS_OK;
    }
}

static KrsStatus collect_words(const Options *options, FarmJob *job)
{
    KrsStatus status = KRS_OK;
    job->words       = arena_new_array(options->arena, const char *, options->given.count + 2);
    for (size_t i = 0; i < options->given.count && status == KRS_OK; i++) {
        const GivenOption *given = &options->given.items[i];
        Text               word  = {.arena = options->arena};
        status                   = check_passed_on(options, given->id);
        if (!is_passed_on(given->id))
            continue;
        text_format(&word, "--%s", option_info[given->id].name);
        if (given->value)
            text_format(&word, "=%s", given->value);
        job->words[job->word_count++] = word.bytes;
    }
    return status;
}

/* Returns a path that other processes can use, in other folders. */
static const char *whole_path(Arena *arena, const char *path)
{
    Text  whole  = {.arena = arena};
    char *folder = path[0] == '/' ? NULL : getcwd(NULL, 0);
    text_format(&whole, "%s%s%s", folder ? folder : "", folder ? "/" : "", path);
    free(folder);
    return whole.bytes;
}

/* Refuses to divide samples where `krs render` would refuse it. */
static KrsStatus check_ranges(const Options *options, const FarmJob *job, double noise)
{
    const uint32_t blocks = (job->samples + SAMPLES_OF_BLOCK - 1) / SAMPLES_OF_BLOCK;
    if (job->ranges > blocks)
        return say_usage(options, "%u samples are at most %u range%s, of %d each", job->samples,
                         blocks, blocks == 1 ? "" : "s", SAMPLES_OF_BLOCK);
    KrsRenderOptions how    = options->how;
    KrsStatus        status = KRS_OK;
    how.samples             = job->samples;
    for (uint32_t range = 0; range < job->ranges && status == KRS_OK; range++) {
        Options piece = *options;
        piece.command = COMMAND_RENDER;
        if (!read_samples(&piece, job_samples(job, options->arena, range)))
            return KRS_INTERNAL;
        piece.command = options->command;
        status        = samples_check(&piece, &how, how.noise > 0 ? how.noise : noise);
    }
    return status;
}

/* Packs the scene; that of a stranger is read by another process, in its sandbox. */
static KrsStatus pack(const Options *options, const char *path, const char *output)
{
    Words words = {0};
    Text  root  = {.arena = options->arena};
    if (options->untrusted != UNTRUSTED)
        return pack_scene(options, path, output);
    spawn_begin(options->arena, &words, "pack", path);
    text_format(&root, "--root=%s", scene_root(options, path));
    spawn_add(options->arena, &words, root.bytes);
    spawn_add(options->arena, &words, "--untrusted");
    spawn_add(options->arena, &words, "--quiet");
    spawn_add(options->arena, &words, "-o");
    spawn_add(options->arena, &words, output);
    return (KrsStatus)spawn_run(options, &words, NULL);
}

/* Finds what the scene says; a stranger's is not read for it.  Who marches rays is chosen by times otherwise, which
   differ between machines. */
static KrsStatus read_scene(const Options *options, const char *path, FarmJob *job)
{
    if (options->untrusted == UNTRUSTED) {
        job->width   = options->how.width;
        job->height  = options->how.height;
        job->samples = options->how.samples;
        if (job->width == 0 || job->samples == 0 || !option_is_given(options, OPTION_RAYS))
            return say_usage(options, "farm does not read a stranger's scene itself, so it needs "
                                      "to know --size, --samples and --rays");
        return job->ranges > 1 ? check_ranges(options, job, 0) : KRS_OK;
    }
    KrsScene *scene;
    KrsState *state = NULL;
    KrsView   view;
    size_t    camera;
    KrsStatus status = scene_open(options, path, &scene);
    if (status != KRS_OK)
        return status;
    status = scene_state(options, scene, &state);
    if (status == KRS_OK)
        status = scene_camera(options, scene, &camera);
    if (status == KRS_OK)
        status = krs_state_view(state, camera, &view);
    if (status == KRS_OK) {
        const KrsRenderOptions *how = &options->how;
        job->width                  = how->width         ? how->width
                                      : view.image.width ? view.image.width
                                                         : KRS_DEFAULT_WIDTH;
        job->height                 = how->height         ? how->height
                                      : view.image.height ? view.image.height
                                                          : KRS_DEFAULT_HEIGHT;
        job->samples                = how->samples         ? how->samples
                                      : view.image.samples ? view.image.samples
                                                           : KRS_DEFAULT_SAMPLES;
        if (job->ranges > 1)
            status = check_ranges(options, job, view.image.noise);
    }
    if (!option_is_given(options, OPTION_RAYS) && !krs_scene_too_large(scene))
        job->words[job->word_count++] = "--rays=kernels";
    krs_state_free(state);
    krs_scene_free(scene);
    return status;
}

static KrsStatus check_submission(const Options *options, const FarmJob *job)
{
    if (options->outputs.count != 1 || file_form(job->output) != FORM_EXR)
        return say_usage(options, "farm submit writes EXR files: -o 'ring-%%04d.exr'");
    if (job->animated != (frame_places(job->output) == 1))
        return say_usage(options,
                         job->animated ? "with --frames, `%s` needs one place for the number: %%04d"
                                       : "without --frames, `%s` has a place for a number",
                         job->output);
    if (access(job_path(job, options->arena, "job.json"), F_OK) == 0)
        return say_usage(options, "`%s` is a job already; give another --job", job->folder);
    return check_output(options, frame_path(options, job->output, job->first));
}

static KrsStatus submit(const Options *options, const char *path)
{
    Text    folder = {.arena = options->arena};
    FarmJob job    = {.animated = options->animated,
                      .first    = options->animated ? options->first_frame : 0,
                      .last     = options->animated ? options->last_frame : 0,
                      .across   = options->farm_tiles[0] ? options->farm_tiles[0] : 1,
                      .down     = options->farm_tiles[1] ? options->farm_tiles[1] : 1,
                      .ranges   = options->split_samples,
                      .chunk    = options->chunk};
    text_format(&folder, "%s.farm", scene_name(options->arena, path));
    job.folder = whole_path(options->arena, options->farm_job ? options->farm_job : folder.bytes);
    job.output = options->outputs.count ? whole_path(options->arena, options->outputs.items[0])
                                        : "";
    KrsStatus status = check_submission(options, &job);
    if (status == KRS_OK)
        status = collect_words(options, &job);
    if (status == KRS_OK)
        status = read_scene(options, path, &job);
    if (status == KRS_OK && (job.across > job.width || job.down > job.height))
        status = say_usage(options, "a picture of %ux%u has not so many tiles", job.width,
                           job.height);
    if (status == KRS_OK && !job_fits(&job))
        status = say_usage(options, "a job has at most %d pieces", MAX_PIECES);
    if (status == KRS_OK)
        status = job_make_folders(&job, options->arena);
    if (status == KRS_OK)
        status = pack(options, path, job_path(&job, options->arena, "scene.krsz"));
    if (status == KRS_OK)
        status = job_write(&job, options->arena);
    if (status == KRS_OK && options->kubernetes)
        status = kubernetes_write(&job, options, options->kubernetes);
    if (status == KRS_OK && options->slurm)
        status = slurm_submit(&job, options, options->slurm);
    if (status == KRS_OK && !options->quiet)
        say(options->slurm ? "`%s` has %u pieces; `krs farm status` tells how far they are"
                           : "`%s` has %u pieces; `krs farm work` renders them, on each machine "
                             "that sees the folder",
            job.folder, job_pieces(&job));
    return status;
}

/* ---- work ---- */

/* Returns the piece that this process is to render, as the option or a batch system says; the count: none does. */
static uint32_t own_piece(const FarmJob *job, const Options *options)
{
    static const char *const names[] = {"SLURM_ARRAY_TASK_ID", "JOB_COMPLETION_INDEX",
                                        "OMPI_COMM_WORLD_RANK"};
    const char              *first   = getenv("KRS_FARM_FIRST");
    if (options->piece < UINT32_MAX)
        return options->piece;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const char *number = getenv(names[i]);
        if (number)
            return (uint32_t)(strtoul(number, NULL, 10) + (first ? strtoul(first, NULL, 10) : 0));
    }
    return job_pieces(job);
}

static bool is_cancelled(const FarmJob *job, const Options *options)
{
    return access(job_path(job, options->arena, "cancelled"), F_OK) == 0;
}

/* A crash is no reason to run the same command again, as an interruption is. */
static KrsStatus settle(KrsStatus status)
{
    if (status == KRS_INTERNAL && !*interrupted())
        stage_resumable(false);
    return status;
}

static KrsStatus begin(const FarmJob *job, const Options *options)
{
    const KrsStatus status = check_output(options, job_picture(job, options, job->first));
    if (status != KRS_OK)
        return status; /* pieces would fail on this machine alone */
    stage_enter(STAGE_RENDER);
    stage_resumable(true);
    return settle(probe(job, options));
}

static KrsStatus run(const FarmJob *job, const Options *options)
{
    const uint32_t number = own_piece(job, options);
    if (number >= job_pieces(job))
        return say_usage(options,
                         "no piece is named: --piece from 0 to %u, or a variable of a batch system",
                         job_pieces(job) - 1);
    const FarmPiece piece  = job_piece(job, number);
    KrsStatus       status = is_cancelled(job, options) ? KRS_OK : begin(job, options);
    return status == KRS_OK && !is_cancelled(job, options)
               ? settle((KrsStatus)piece_render(job, options, &piece))
               : status;
}

/* Renders pieces as long as there are some that nobody is at.  Each is tried three times. */
static KrsStatus work(const FarmJob *job, const Options *options)
{
    KrsStatus status = begin(job, options);
    bool      more   = status == KRS_OK;
    while (more) {
        more = false;
        for (uint32_t number = 0; number < job_pieces(job) && status == KRS_OK; number++) {
            const FarmPiece piece = job_piece(job, number);
            if (is_cancelled(job, options))
                return KRS_OK;
            if (piece_state(job, options, &piece) != PIECE_WAITS)
                continue;
            const unsigned failures = piece_failures(job, options->arena, number);
            const int      ended    = piece_render(job, options, &piece);
            stage_enter(STAGE_RENDER);
            more = true;
            if (*interrupted())
                status = KRS_INTERRUPTED;
            else if (ended != KRS_OK)
                say("piece %u has failed with status %d", number, ended);
            /* Where a failure cannot be noted, as on a full disk, the piece would be tried for ever. */
            if (status == KRS_OK && ended != KRS_OK &&
                piece_failures(job, options->arena, number) == failures)
                status = settle((KrsStatus)ended);
        }
        more = more && status == KRS_OK;
    }
    for (uint32_t frame = job->first; frame <= job->last && status == KRS_OK; frame++)
        status = frame_finish(job, options, frame);
    return status == KRS_OK && !options->quiet ? report_status(job, options) : status;
}

/* ---- the rest ---- */

static KrsStatus cancel(const FarmJob *job, const Options *options)
{
    KrsStatus status = write_output_text(job_path(job, options->arena, "cancelled"), "", 0);
    return status == KRS_OK ? slurm_cancel(job, options) : status;
}

/* Forgets failures, and that the job was cancelled. */
static KrsStatus retry(const FarmJob *job, const Options *options)
{
    unlink(job_path(job, options->arena, "cancelled"));
    for (uint32_t number = 0; number < job_pieces(job); number++)
        unlink(job_file(job, options->arena, number, "failed"));
    return KRS_OK;
}

static const struct {
    const char *verb;
    KrsStatus (*function)(const FarmJob *job, const Options *options);
} verbs[] = {{"work", work},     {"run", run},     {"status", report_status},
             {"cancel", cancel}, {"retry", retry}, {"logs", report_logs}};

KrsStatus command_farm(Options *options)
{
    const char *verb = options->files.items[0], *path = options->files.items[1];
    FarmJob     job;
    if (strcmp(verb, "submit") == 0)
        return submit(options, path);
    for (size_t i = 0; i < sizeof verbs / sizeof *verbs; i++)
        if (strcmp(verb, verbs[i].verb) == 0) {
            KrsStatus status = job_read(options->arena, whole_path(options->arena, path), &job);
            return status == KRS_OK ? verbs[i].function(&job, options) : status;
        }
    return say_usage(options,
                     "farm cannot `%s`; it can submit, work, run, status, cancel, retry and logs",
                     verb);
}
