/*
 * job.c: the description of a job, as JSON, and the names of its files.
 */
#include "cli/farm/job.h"

#include <errno.h>
#include <jansson.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/picture/frame_paths.h"
#include "cli/shell/console.h"
#include "cli/shell/supervise.h"
#include "runtime/film/doublings.h"

/* The version of the description: jobs of a later one are refused. */
enum { DESCRIPTION = 2 };

/* The numbers of a job, and what they may be. */
static const struct {
    const char *name;
    size_t      offset;
    uint32_t    low, high;
} numbers[] = {
    {"first", offsetof(FarmJob, first), 0, 1000000},
    {"last", offsetof(FarmJob, last), 0, 1000000},
    {"width", offsetof(FarmJob, width), 1, KRS_MAX_SIDE},
    {"height", offsetof(FarmJob, height), 1, KRS_MAX_SIDE},
    {"across", offsetof(FarmJob, across), 1, KRS_MAX_SIDE},
    {"down", offsetof(FarmJob, down), 1, KRS_MAX_SIDE},
    {"samples", offsetof(FarmJob, samples), 1, KRS_MAX_SAMPLES},
    {"ranges", offsetof(FarmJob, ranges), 1, KRS_MAX_SAMPLES / SAMPLES_OF_BLOCK},
    {"chunk", offsetof(FarmJob, chunk), 1, 1000001},
};

enum { NUMBERS = sizeof numbers / sizeof *numbers };

/* ---- names ---- */

const char *job_path(const FarmJob *job, Arena *arena, const char *name)
{
    Text path = {.arena = arena};
    text_format(&path, "%s/%s", job->folder, name);
    return path.bytes;
}

const char *job_part(const FarmJob *job, Arena *arena, uint32_t part, uint32_t frame)
{
    Text path = {.arena = arena};
    text_format(&path, "%s/parts/%u-%06u.exr", job->folder, part, frame);
    return path.bytes;
}

const char *job_picture(const FarmJob *job, const Options *options, uint32_t frame)
{
    return job->animated ? numbered_path(options, job->output, frame) : job->output;
}

const char *job_file(const FarmJob *job, Arena *arena, uint32_t piece, const char *ending)
{
    Text path = {.arena = arena};
    text_format(&path, "%s/pieces/%u.%s", job->folder, piece, ending);
    return path.bytes;
}

/* ---- pieces ---- */

bool job_fits(const FarmJob *job)
{
    const uint64_t parts  = (uint64_t)job->across * job->down * job->ranges;
    const uint64_t chunks = ((uint64_t)job_frames(job) + job->chunk - 1) / job->chunk;
    return parts <= MAX_PIECES && parts * chunks <= MAX_PIECES;
}

uint32_t job_frames(const FarmJob *job) { return job->last - job->first + 1; }

uint32_t job_parts(const FarmJob *job) { return job->across * job->down * job->ranges; }

uint32_t job_pieces(const FarmJob *job)
{
    return (job_frames(job) + job->chunk - 1) / job->chunk * job_parts(job);
}

/* All parts of some frames come before the next frames, so that pictures are complete early. */
FarmPiece job_piece(const FarmJob *job, uint32_t number)
{
    const uint32_t first = job->first + number / job_parts(job) * job->chunk;
    const uint32_t last  = job->last - first < job->chunk ? job->last : first + job->chunk - 1;
    return (FarmPiece){number, number % job_parts(job), first, last};
}

static uint32_t edge(uint32_t side, uint32_t number, uint32_t count)
{
    return (uint32_t)((uint64_t)side * number / count);
}

KrsWindow job_window(const FarmJob *job, uint32_t part)
{
    const uint32_t tile = part / job->ranges;
    const uint32_t i = tile % job->across, k = tile / job->across;
    const uint32_t x = edge(job->width, i, job->across), y = edge(job->height, k, job->down);
    return (KrsWindow){x, y, edge(job->width, i + 1, job->across) - x,
                       edge(job->height, k + 1, job->down) - y};
}

/* Ranges are whole blocks, but for the last. */
const char *job_samples(const FarmJob *job, Arena *arena, uint32_t part)
{
    const uint32_t blocks = (job->samples + SAMPLES_OF_BLOCK - 1) / SAMPLES_OF_BLOCK;
    const uint32_t number = part % job->ranges;
    const uint32_t first  = SAMPLES_OF_BLOCK * edge(blocks, number, job->ranges);
    const uint32_t end    = SAMPLES_OF_BLOCK * edge(blocks, number + 1, job->ranges);
    Text           range  = {.arena = arena};
    text_format(&range, "%u..%u/%u", first, (end < job->samples ? end : job->samples) - 1,
                job->samples);
    return range.bytes;
}

/* ---- the description ---- */

static KrsStatus make_folder(const char *path)
{
    OutputError error = {.status = KRS_OK};
    if (output_make_folder(path, &error) != KRS_OK)
        say("%s", error.message);
    return error.status;
}

KrsStatus job_make_folders(const FarmJob *job, Arena *arena)
{
    static const char *const names[] = {"parts", "pieces", "probes"};
    KrsStatus                status  = make_folder(job->folder);
    for (size_t i = 0; i < sizeof names / sizeof *names && status == KRS_OK; i++)
        status = make_folder(job_path(job, arena, names[i]));
    return status;
}

KrsStatus job_write(const FarmJob *job, Arena *arena)
{
    json_t *root  = json_pack("{s:i, s:s, s:b}", "description", DESCRIPTION, "output", job->output,
                              "animated", job->animated);
    json_t *words = json_array();
    for (size_t i = 0; i < NUMBERS; i++)
        json_object_set_new(
            root, numbers[i].name,
            json_integer(*(const uint32_t *)((const char *)job + numbers[i].offset)));
    for (size_t i = 0; i < job->word_count; i++)
        json_array_append_new(words, json_string(job->words[i]));
    json_object_set_new(root, "options", words);
    char     *text   = json_dumps(root, JSON_INDENT(2));
    KrsStatus status = text ? KRS_OK : say_status(KRS_OUT_OF_MEMORY, job->folder);
    if (status == KRS_OK)
        status = write_output_text(job_path(job, arena, "job.json"), text, strlen(text));
    free(text);
    json_decref(root);
    return status;
}

static bool read_numbers(const json_t *root, FarmJob *job)
{
    for (size_t i = 0; i < NUMBERS; i++) {
        const json_t *number = json_object_get(root, numbers[i].name);
        json_int_t    value  = json_integer_value(number);
        if (!json_is_integer(number) || value < numbers[i].low || value > numbers[i].high)
            return false;
        *(uint32_t *)((char *)job + numbers[i].offset) = (uint32_t)value;
    }
    return job->last >= job->first && job->across <= job->width && job->down <= job->height &&
           (job->ranges == 1 || (job->ranges - 1) * SAMPLES_OF_BLOCK < job->samples) &&
           job_fits(job);
}

static bool read_words(Arena *arena, const json_t *words, FarmJob *job)
{
    job->word_count = json_array_size(words);
    job->words      = arena_new_array(arena, const char *, job->word_count + 1);
    for (size_t i = 0; i < job->word_count; i++) {
        const char *word = json_string_value(json_array_get(words, i));
        if (!word)
            return false;
        job->words[i] = arena_copy_text(arena, word, strlen(word));
    }
    return true;
}

KrsStatus job_read(Arena *arena, const char *folder, FarmJob *job)
{
    *job               = (FarmJob){.folder = folder};
    json_t     *root   = json_load_file(job_path(job, arena, "job.json"), 0, NULL);
    const char *output = json_string_value(json_object_get(root, "output"));
    const bool  good   = json_integer_value(json_object_get(root, "description")) == DESCRIPTION &&
                      output && read_numbers(root, job) &&
                      read_words(arena, json_object_get(root, "options"), job);
    if (good) {
        job->output   = arena_copy_text(arena, output, strlen(output));
        job->animated = json_is_true(json_object_get(root, "animated"));
    } else {
        say("`%s` is no job of `krs farm submit`, or of a later krs", folder);
    }
    json_decref(root);
    return good ? KRS_OK : KRS_IO_ERROR;
}
