/*
 * pieces.c: renders pieces of a job by `krs render`, and puts pictures together.
 */
#include "cli/farm/pieces.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "cli/farm/spawn.h"
#include "cli/farm/tiles.h"
#include "cli/picture/whole.h"
#include "cli/shell/console.h"
#include "cli/shell/supervise.h"

/* ---- what is done ---- */

static bool is_there(const char *path) { return access(path, F_OK) == 0; }

bool frame_is_done(const FarmJob *job, const Options *options, uint32_t frame)
{
    return picture_is_whole(job_picture(job, options, frame));
}

static bool is_done(const FarmJob *job, const Options *options, const FarmPiece *piece)
{
    for (uint32_t frame = piece->first; frame <= piece->last; frame++)
        if (!is_there(job_part(job, options->arena, piece->part, frame)) &&
            !frame_is_done(job, options, frame))
            return false;
    return true;
}

unsigned piece_failures(const FarmJob *job, Arena *arena, uint32_t piece)
{
    FILE    *file     = fopen(job_file(job, arena, piece, "failed"), "r");
    unsigned failures = 0;
    for (int c; file && (c = getc(file)) != EOF;)
        failures += c == '\n';
    if (file)
        fclose(file);
    return failures;
}

enum { TAKEN = -1, REFUSED = -2 };

/* Opens a file that is locked as long as this process, or one that it starts, lives.  TAKEN: somebody else has it;
   REFUSED: there is none, for a reason that is told. */
static int lock(const char *path)
{
    struct flock whole = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    const int    file  = open(path, O_RDWR | O_CREAT, 0666); /* children keep it */
    if (file >= 0 && fcntl(file, F_OFD_SETLK, &whole) == 0)
        return file;
    const bool taken = file >= 0 && (errno == EAGAIN || errno == EACCES);
    if (!taken)
        say("cannot %s `%s`: %s", file < 0 ? "create" : "lock", path, strerror(errno));
    if (file >= 0)
        close(file);
    return taken ? TAKEN : REFUSED;
}

static bool is_locked(const char *path)
{
    struct flock whole = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    const int    file  = open(path, O_RDONLY | O_CLOEXEC);
    const bool   found = file >= 0 && fcntl(file, F_OFD_GETLK, &whole) == 0 &&
                       whole.l_type != F_UNLCK;
    if (file >= 0)
        close(file);
    return found;
}

PieceState piece_state(const FarmJob *job, const Options *options, const FarmPiece *piece)
{
    if (is_done(job, options, piece))
        return PIECE_DONE;
    if (is_locked(job_file(job, options->arena, piece->number, "lock")))
        return PIECE_RUNS;
    return piece_failures(job, options->arena, piece->number) >= MAX_TRIES ? PIECE_FAILED
                                                                           : PIECE_WAITS;
}

/* ---- pictures ---- */

/* Tells whether pieces are rendered in sandboxes. */
static bool is_of_stranger(const FarmJob *job)
{
    for (size_t i = 0; i < job->word_count; i++)
        if (strcmp(job->words[i], "--untrusted") == 0)
            return true;
    return false;
}

/* Lets another process put parts together, in its sandbox: who wrote them may have been taken over. */
static KrsStatus merge_confined(const FarmJob *job, const Options *options,
                                const char *const *parts, const char *picture)
{
    Words words = {0};
    spawn_begin(options->arena, &words, "merge", parts[0]);
    for (uint32_t part = 1; part < job_parts(job); part++)
        spawn_add(options->arena, &words, parts[part]);
    spawn_add(options->arena, &words, "--untrusted");
    spawn_add(options->arena, &words, "--quiet");
    spawn_add(options->arena, &words, "-o");
    spawn_add(options->arena, &words, picture);
    return (KrsStatus)spawn_run(options, &words, NULL);
}

static KrsStatus merge_here(const FarmJob *job, const Options *options, const char *const *parts,
                            const char *picture)
{
    Tiles     tiles;
    KrsStatus status = tiles_read(options, parts, job_parts(job), &tiles);
    if (status != KRS_OK)
        return status;
    status = tiles_write(&tiles, picture);
    tiles_free(&tiles);
    return status;
}

static KrsStatus merge(const FarmJob *job, const Options *options, const char *const *parts,
                       uint32_t frame)
{
    const char *picture = job_picture(job, options, frame);
    KrsStatus   status  = is_of_stranger(job) ? merge_confined(job, options, parts, picture)
                                              : merge_here(job, options, parts, picture);
    for (uint32_t part = 0; part < job_parts(job) && status == KRS_OK; part++)
        unlink(parts[part]);
    return status;
}

KrsStatus frame_finish(const FarmJob *job, const Options *options, uint32_t frame)
{
    const char **parts = arena_new_array(options->arena, const char *, job_parts(job));
    Text         path  = {.arena = options->arena};
    for (uint32_t part = 0; part < job_parts(job); part++) {
        parts[part] = job_part(job, options->arena, part, frame);
        if (!is_there(parts[part]))
            return KRS_OK;
    }
    text_format(&path, "%s/parts/%06u.lock", job->folder, frame);
    const int held = lock(path.bytes);
    if (held < 0)
        return held == TAKEN ? KRS_OK : KRS_CANNOT_CREATE; /* somebody else is writing it */
    KrsStatus status = frame_is_done(job, options, frame) ? KRS_OK
                                                          : merge(job, options, parts, frame);
    unlink(path.bytes);
    close(held);
    return status;
}

/* ---- rendering ---- */

static int run_render(const FarmJob *job, const Options *options, const FarmPiece *piece)
{
    const KrsWindow window = job_window(job, piece->part);
    Arena          *arena  = options->arena;
    Words           words  = {0};
    Text            frames = {.arena = arena}, crop = {.arena = arena}, part = {.arena = arena},
         samples = {.arena = arena};
    text_format(&crop, "--crop=%u,%u,%u,%u", window.x, window.y, window.width, window.height);
    text_format(&frames, "--frames=%u..%u", piece->first, piece->last);
    text_format(&part, "--output=%s/parts/%u-%s.exr", job->folder, piece->part,
                job->animated ? "%06d" : "000000");
    spawn_begin(arena, &words, "render", job_path(job, arena, "scene.krsz"));
    for (size_t i = 0; i < job->word_count; i++)
        if (job->ranges == 1 || strncmp(job->words[i], "--samples=", 10) != 0)
            spawn_add(arena, &words, job->words[i]);
    if (job->ranges > 1) {
        text_format(&samples, "--samples=%s", job_samples(job, arena, piece->part));
        spawn_add(arena, &words, samples.bytes);
    }
    spawn_add(arena, &words, crop.bytes);
    spawn_add(arena, &words, part.bytes);
    spawn_add(arena, &words, "--quiet");
    spawn_add(arena, &words, "--resume");
    if (job->animated) {
        spawn_add(arena, &words, frames.bytes);
        spawn_add(arena, &words, "--skip-existing");
    }
    return spawn_run(options, &words, job_file(job, arena, piece->number, "log"));
}

static void note_failure(const FarmJob *job, Arena *arena, uint32_t piece, int status)
{
    FILE *file      = fopen(job_file(job, arena, piece, "failed"), "a");
    char  host[256] = "";
    gethostname(host, sizeof host - 1);
    if (!file)
        return;
    fprintf(file, "%d %lld %s\n", status, (long long)time(NULL), host);
    fclose(file);
}

static KrsStatus finish_frames(const FarmJob *job, const Options *options, const FarmPiece *piece)
{
    KrsStatus status = KRS_OK;
    for (uint32_t frame = piece->first; frame <= piece->last && status == KRS_OK; frame++)
        status = frame_finish(job, options, frame);
    return status;
}

int piece_render(const FarmJob *job, const Options *options, const FarmPiece *piece)
{
    if (is_done(job, options, piece))
        return finish_frames(job, options, piece);
    const int held = lock(job_file(job, options->arena, piece->number, "lock"));
    if (held < 0)
        return held == TAKEN ? KRS_OK : KRS_CANNOT_CREATE;
    int status = is_done(job, options, piece) ? KRS_OK : run_render(job, options, piece);
    if (status != KRS_OK && status != KRS_RESUMABLE && status != KRS_INTERRUPTED)
        note_failure(job, options->arena, piece->number, status);
    if (status == KRS_OK)
        status = finish_frames(job, options, piece);
    close(held);
    return status;
}
