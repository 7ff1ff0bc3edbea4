/*
 * checkpoint.c: a file beside the first output that says how far `krs render --resume` has come.
 *
 * It has a key, which is a hash of the program's sources, the options that change pictures, the scene and the device; the
 * number of the frame at hand; and the film of that frame, unless the frame has not begun.  A hash of all stands at the
 * end.  The file is written whenever rendering has gone on for some seconds, as every output: it appears whole or not at
 * all.
 */
#include "cli/picture/checkpoint.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#define XXH_STATIC_LINKING_ONLY /* for the size of a state */
#include <xxhash.h>

#include "cli/shell/console.h"
#include "cli/picture/frame_paths.h"
#include "cli/shell/supervise.h"
#include "compiler/base/fingerprints.h"

/* Returns the seconds of work that may be lost, unless a sample of each pixel takes longer.  For
   the tests, the environment variable KRS_TEST_CHECKPOINT says how many. */
static double seconds_between(void)
{
    const char *setting = getenv("KRS_TEST_CHECKPOINT");
    return setting && atof(setting) > 0 ? atof(setting) : 2;
}

typedef struct Header {
    char     magic[8];
    uint64_t key, others; /* `others`: a hash of what another renderer has made of the frame */
    uint32_t frame;
    uint32_t has_film;
} Header;

static const char magic[8] = "krspart";

KrsStatus checkpoint_begin(Checkpoint *checkpoint, const Options *options, const char *output)
{
    *checkpoint = (Checkpoint){.options = options, .share = 1};
    if (!options->resume)
        return KRS_OK;
    if (options->stereo >= 0)
        return say_usage(options, "--resume has no checkpoints of two eyes");
    if (!output || strcmp(output, STANDARD_OUTPUT) == 0)
        return say_usage(options,
                         "--resume puts its checkpoint beside the first output, which must "
                         "be a file");
    struct stat about;
    Text        path = {.arena = options->arena};
    text_format(&path, "%s.part", frame_path(options, output, options->first_frame));
    checkpoint->path = path.bytes;
    if (stat(path.bytes, &about) != 0 || S_ISREG(about.st_mode))
        return KRS_OK;
    say("cannot create `%s`: there is something else than a file", path.bytes);
    return KRS_CANNOT_CREATE;
}

/* ---- the key ---- */

static void hash_word(XXH64_state_t *hash, const char *word)
{
    XXH64_update(hash, word, strlen(word) + 1);
}

/* Options in any order, but those that may repeat in theirs. */
static void hash_options(XXH64_state_t *hash, const Options *options)
{
    for (OptionId id = 0; id < OPTION_COUNT; id++)
        for (size_t i = 0; option_changes_pictures(id) && i < options->given.count; i++)
            if (options->given.items[i].id == id) {
                hash_word(hash, option_info[id].name);
                hash_word(hash, options->given.items[i].value ? options->given.items[i].value : "");
            }
}

static uint64_t key_of(const Options *options, const KrsScene *scene, const KrsRenderer *renderer)
{
    const KrsDevice device = krs_renderer_device(renderer);
    XXH64_state_t   hash;
    XXH64_reset(&hash, 0);
    hash_word(&hash, fingerprint_checkpoint);
    hash_options(&hash, options);
    hash_word(&hash, krs_scene_hash(scene));
    hash_word(&hash, device.name);
    return XXH64_digest(&hash);
}

static uint64_t hash_others(const KrsRenderOptions *how)
{
    const size_t  pixels = (size_t)how->width * how->height;
    XXH64_state_t hash;
    XXH64_reset(&hash, 0);
    if (how->depth)
        XXH64_update(&hash, how->depth, pixels * sizeof *how->depth);
    if (how->plate)
        XXH64_update(&hash, how->plate, pixels * sizeof *how->plate);
    return XXH64_digest(&hash);
}

/* ---- writing ---- */

/* A file and the hash of what goes there. */
typedef struct Passage {
    OutputFile   *output;
    XXH64_state_t hash;
} Passage;

static bool put(void *user, const void *bytes, size_t size)
{
    Passage *passage = user;
    XXH64_update(&passage->hash, bytes, size);
    return output_append(passage->output, bytes, size);
}

typedef struct Content {
    Header   header;
    KrsFilm *film; /* NULL: the frame has not begun */
} Content;

static bool fill(const void *user, OutputFile *file, OutputError *error)
{
    const Content *content = user;
    Header         header  = content->header;
    Passage        passage = {.output = file};
    XXH64_reset(&passage.hash, 0);
    bool good = put(&passage, &header, sizeof header);
    if (good && content->film) {
        const KrsStatus status = krs_film_save(content->film, put, &passage);
        if (status != KRS_OK && error->status == KRS_OK) {
            error->status = status;
            snprintf(error->message, sizeof error->message, "the checkpoint cannot be made");
        }
        good = status == KRS_OK;
    }
    const uint64_t sum = XXH64_digest(&passage.hash);
    return good && output_append(file, &sum, sizeof sum);
}

/* Writes a checkpoint of a frame that has not begun, or, if that is not NULL, of one with a film. */
static KrsStatus write_checkpoint(Checkpoint *checkpoint, uint32_t number,
                                  const KrsRenderOptions *how, KrsFilm *film)
{
    Content content = {{.key = checkpoint->key, .frame = number}, film};
    memcpy(content.header.magic, magic, sizeof magic);
    content.header.has_film = film != NULL;
    content.header.others   = film ? hash_others(how) : 0;
    const KrsStatus status  = write_output(checkpoint->path, fill, &content);
    if (status == KRS_OK)
        stage_resumable(true);
    checkpoint->failed = status != KRS_OK && status != KRS_INTERRUPTED;
    stage_enter(STAGE_RENDER);
    return status;
}

/* ---- reading ---- */

static void say_anew(const Checkpoint *checkpoint, const char *why)
{
    if (!checkpoint->options->quiet)
        say("`%s` %s; rendering begins anew", checkpoint->path, why);
}

/* Tells whether the sum at the end of a file is that of what is before it. */
static bool is_whole(FILE *file)
{
    static unsigned char piece[1 << 16];
    uint64_t             sum;
    size_t               got, left = 0; /* bytes that may be the sum */
    XXH64_state_t        hash;
    XXH64_reset(&hash, 0);
    while ((got = fread(piece + left, 1, sizeof piece - left, file)) > 0) {
        const size_t all = left + got;
        left             = all < sizeof sum ? all : sizeof sum;
        XXH64_update(&hash, piece, all - left);
        memmove(piece, piece + all - left, left);
    }
    memcpy(&sum, piece, sizeof sum);
    return left == sizeof sum && sum == XXH64_digest(&hash) && fseek(file, 0, SEEK_SET) == 0;
}

/* A pipe would be waited for. */
static FILE *open_regular(const char *path)
{
    struct stat about;
    const int   fd   = output_read(path);
    FILE       *file = NULL;
    if (fd >= 0 && fstat(fd, &about) == 0 && S_ISREG(about.st_mode))
        file = fdopen(fd, "rb");
    if (fd >= 0 && !file)
        close(fd);
    return file;
}

/* Opens the checkpoint and reads its header.  NULL: there is none, or, which is said, it is damaged. */
static FILE *open_checkpoint(const Checkpoint *checkpoint, Header *header)
{
    FILE *file = open_regular(checkpoint->path);
    if (!file)
        return NULL;
    if (is_whole(file) && fread(header, 1, sizeof *header, file) == sizeof *header &&
        memcmp(header->magic, magic, sizeof magic) == 0)
        return file;
    fclose(file);
    say_anew(checkpoint, "is damaged, or no checkpoint");
    return NULL;
}

uint32_t checkpoint_find(Checkpoint *checkpoint, const KrsScene *scene, const KrsRenderer *renderer)
{
    const Options *options = checkpoint->options;
    Header         header;
    checkpoint->key = key_of(options, scene, renderer);
    FILE *file      = open_checkpoint(checkpoint, &header);
    if (!file)
        return options->first_frame;
    fclose(file);
    if (header.key == checkpoint->key && header.frame >= options->first_frame &&
        header.frame <= options->last_frame) {
        checkpoint->found = true;
        stage_resumable(true);
        return header.frame;
    }
    say_anew(checkpoint, "is of another scene, command line or device");
    return options->first_frame;
}

static bool get(void *user, void *bytes, size_t size)
{
    return fread(bytes, 1, size, user) == size;
}

/* Gives the film the samples of the checkpoint, if that has some of this frame. */
static void load(Checkpoint *checkpoint, const CheckpointFrame *frame, KrsFilm *film)
{
    Header header;
    FILE  *file       = checkpoint->found ? open_checkpoint(checkpoint, &header) : NULL;
    checkpoint->found = false; /* the next is of this process */
    if (!file)
        return;
    if (header.frame == frame->number && header.has_film) {
        if (header.others != hash_others(frame->how))
            say_anew(checkpoint, "is of another --depth-in or --plate");
        else if (krs_film_load(film, get, file) != KRS_OK)
            say_anew(checkpoint, "does not fit");
        else if (!checkpoint->options->quiet)
            say("going on after %u samples of `%s`", krs_film_samples(film), checkpoint->path);
    }
    fclose(file);
}

/* ---- rendering ---- */

/* Adds all samples that are left, so many at once that a checkpoint is due after them. */
static KrsStatus add_samples(Checkpoint *checkpoint, const CheckpointFrame *frame, KrsFilm *film)
{
    const double   between = seconds_between();
    const Options *options = checkpoint->options;
    const uint32_t end = frame->end, first = options->first_sample;
    const double   all     = end - first;
    double         seconds = between; /* of one sample */
    double         written = clock_now();
    KrsStatus      status  = KRS_OK;
    while (status == KRS_OK && krs_film_samples(film) < end) {
        const double   start = clock_now(), due = between / seconds;
        const uint32_t before = krs_film_samples(film), left = end - before;
        const uint32_t portion = due < 1 ? 1 : due < left ? (uint32_t)due : left;
        checkpoint->done       = (before - first) / all;
        checkpoint->share      = portion / all;
        status                 = krs_film_add(film, frame->state, NULL, portion);
        const double now       = clock_now();
        seconds                = fmax((now - start) / portion, 1e-9);
        if (status == KRS_OK && options->resume && portion < left && now - written >= between) {
            status  = write_checkpoint(checkpoint, frame->number, frame->how, film);
            written = clock_now();
        }
    }
    checkpoint->done  = 0;
    checkpoint->share = 1;
    return status;
}

/* Keeps the sums of a film that has been read. */
static KrsStatus keep_sums(const CheckpointFrame *frame, const KrsFilm *film, KrsPicture **picture)
{
    *frame->sums = film_sums(film);
    if (frame->sums->numbers)
        return KRS_OK;
    krs_picture_free(*picture);
    *picture = NULL;
    return KRS_OUT_OF_MEMORY;
}

KrsStatus checkpoint_render(Checkpoint *checkpoint, const CheckpointFrame *frame,
                            KrsPicture **picture)
{
    KrsFilm  *film;
    KrsStatus status = krs_film_new(frame->rendering, frame->how, &film);
    *picture         = NULL;
    if (status != KRS_OK)
        return status;
    if (checkpoint->options->samples_divided)
        film_begin_at(film, checkpoint->options->first_sample);
    load(checkpoint, frame, film);
    status = add_samples(checkpoint, frame, film);
    if (status == KRS_OK)
        status = krs_film_read(film, 0, picture);
    if (status == KRS_OK && checkpoint->options->samples_divided)
        status = keep_sums(frame, film, picture);
    krs_film_free(film);
    return status;
}

KrsStatus checkpoint_advance(Checkpoint *checkpoint, uint32_t frame)
{
    if (frame < checkpoint->options->last_frame)
        return write_checkpoint(checkpoint, frame + 1, NULL, NULL);
    stage_resumable(false);
    if (output_remove(checkpoint->path) != 0 && errno != ENOENT)
        say("warning: cannot remove `%s`: %s", checkpoint->path, strerror(errno));
    return KRS_OK;
}
