/*
 * report.c: how far a job is.
 */
#include "cli/farm/report.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "cli/farm/pieces.h"
#include "compiler/base/json.h"
#include "cli/shell/console.h"
#include "compiler/base/disk.h"

typedef struct Report {
    uint32_t pieces[PIECE_STATES];
    uint32_t frames; /* whose pictures are there */
    bool     cancelled;
    double   begun,
        latest; /* when the first piece was taken, and the last picture written, seconds; 0: not yet */
} Report;

static double time_of_file(const char *path)
{
    struct stat about;
    return stat(path, &about) == 0
               ? (double)about.st_mtim.tv_sec + 1e-9 * (double)about.st_mtim.tv_nsec
               : 0;
}

static Report make_report(const FarmJob *job, const Options *options)
{
    Report report = {.cancelled = access(job_path(job, options->arena, "cancelled"), F_OK) == 0};
    for (uint32_t number = 0; number < job_pieces(job); number++) {
        const FarmPiece piece = job_piece(job, number);
        const double    begun = time_of_file(job_file(job, options->arena, number, "lock"));
        report.pieces[piece_state(job, options, &piece)]++;
        if (begun > 0 && (report.begun == 0 || begun < report.begun))
            report.begun = begun;
    }
    for (uint32_t frame = job->first; frame <= job->last; frame++)
        if (frame_is_done(job, options, frame)) {
            report.frames++;
            report.latest = fmax(report.latest, time_of_file(job_picture(job, options, frame)));
        }
    return report;
}

/* Returns the frames in an hour; 0: not known. */
static double speed_of(const Report *report)
{
    const double seconds = report->latest - report->begun;
    return report->frames > 0 && report->begun > 0 && seconds > 0 ? 3600 * report->frames / seconds
                                                                  : 0;
}

/* Returns the first line that was said while a piece was rendered last: what went wrong. */
static const char *first_words(const FarmJob *job, const Options *options, uint32_t piece)
{
    Loaded      log   = disk_read(job_file(job, options->arena, piece, "log"));
    const char *words = "";
    if (log.text)
        words = arena_copy_text(options->arena, log.text, strcspn(log.text, "\n"));
    free(log.owned);
    return words;
}

static void print_json(const FarmJob *job, const Options *options, const Report *report)
{
    Json json = {.text = {.arena = options->arena}, .spaced = true};
    json_open(&json, NULL, "{");
    json_whole(&json, "frames", job_frames(job));
    json_whole(&json, "frames_done", report->frames);
    json_whole(&json, "pieces", job_pieces(job));
    json_whole(&json, "done", report->pieces[PIECE_DONE]);
    json_whole(&json, "running", report->pieces[PIECE_RUNS]);
    json_whole(&json, "waiting", report->pieces[PIECE_WAITS]);
    json_whole(&json, "failed", report->pieces[PIECE_FAILED]);
    json_truth(&json, "cancelled", report->cancelled);
    json_rounded(&json, "frames_per_hour", speed_of(report));
    json_open(&json, "failures", "[");
    for (uint32_t number = 0; number < job_pieces(job); number++) {
        const FarmPiece piece = job_piece(job, number);
        if (piece_state(job, options, &piece) != PIECE_FAILED)
            continue;
        json_open(&json, NULL, "{");
        json_whole(&json, "piece", number);
        json_text(&json, "said", first_words(job, options, number));
        json_close(&json, "}");
    }
    json_close(&json, "]");
    json_close(&json, "}");
    puts(json.text.bytes);
}

static void print_text(const FarmJob *job, const Options *options, const Report *report)
{
    const double speed = speed_of(report);
    printf("%s: %u of %u frame%s; of %u pieces %u done, %u running, %u waiting, %u failed%s\n",
           console_name(options, job->folder), report->frames, job_frames(job),
           job_frames(job) == 1 ? "" : "s", job_pieces(job), report->pieces[PIECE_DONE],
           report->pieces[PIECE_RUNS], report->pieces[PIECE_WAITS], report->pieces[PIECE_FAILED],
           report->cancelled ? "; cancelled" : "");
    if (speed > 0)
        printf("%.0f frames an hour", speed);
    if (speed > 0 && report->frames < job_frames(job))
        printf("; about %.1f minutes are left", 60 * (job_frames(job) - report->frames) / speed);
    if (speed > 0)
        putchar('\n');
    for (uint32_t number = 0; number < job_pieces(job); number++) {
        const FarmPiece piece = job_piece(job, number);
        if (piece_state(job, options, &piece) == PIECE_FAILED)
            printf("piece %u, part %u of frames %u to %u, has failed: %s\n", number, piece.part,
                   piece.first, piece.last, first_words(job, options, number));
    }
}

/* Tells of a folder whose disk is full: workers cannot note it there. */
static void print_full(const Options *options, const char *path)
{
    enum { FEW = 1 << 20 }; /* bytes */
    struct statvfs disk;
    if (statvfs(path, &disk) == 0 && (uint64_t)disk.f_bavail * disk.f_frsize < FEW)
        printf("%s: less than 1 MiB is free on this disk\n", console_name(options, path));
}

/* Tells of a frame whose parts are all there, as when the disk was full when its picture was to be written. */
static void print_unwritten(const FarmJob *job, const Options *options, const Report *report)
{
    const bool all_done = report->pieces[PIECE_DONE] == job_pieces(job);
    for (uint32_t frame = job->first; frame <= job->last && all_done; frame++)
        if (!frame_is_done(job, options, frame)) {
            printf("frame %u has all its parts, but no picture; `krs farm work` writes it\n",
                   frame);
            return;
        }
}

KrsStatus report_status(const FarmJob *job, const Options *options)
{
    const Report report = make_report(job, options);
    (options->json ? print_json : print_text)(job, options, &report);
    if (!options->json)
        print_unwritten(job, options, &report);
    if (!options->json && report.frames < job_frames(job))
        print_full(options, job->folder);
    const KrsStatus status = console_finish();
    return status == KRS_OK && report.pieces[PIECE_FAILED] > 0 ? KRS_BAD_SCENE : status;
}

KrsStatus report_logs(const FarmJob *job, const Options *options)
{
    for (uint32_t number = 0; number < job_pieces(job); number++) {
        Loaded log = piece_failures(job, options->arena, number) > 0
                         ? disk_read(job_file(job, options->arena, number, "log"))
                         : (Loaded){0};
        if (log.text) {
            printf("==== piece %u ====\n", number);
            fwrite(log.text, 1, log.length, stdout);
        }
        free(log.owned);
    }
    return console_finish();
}
