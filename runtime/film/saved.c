/*
 * saved.c: a film as bytes, for a later process.
 *
 * They are what the film has in host memory, in the order of the machine: a header, the AOVs, the
 * mattes, the light of each light, and what is kept for the estimate of errors.
 */
#include <string.h>

#include "compiler/base/fingerprints.h"
#include "runtime/film/sample_blocks.h"
#include "runtime/film/resident.h"
#include "runtime/film/lights.h"
#include "runtime/film/noise.h"
#include "runtime/film/picture.h"
#include "runtime/tracer/renderer.h"
#include "runtime/tracer/rendering.h"

/* Bytes go one way: to `write`, or from `read`. */
typedef struct Way {
    KrsWriteCallback *write;
    KrsReadCallback  *read;
    void             *user;
} Way;

static bool pass(const Way *way, void *bytes, size_t size)
{
    return size == 0 ||
           (way->write ? way->write(way->user, bytes, size) : way->read(way->user, bytes, size));
}

/* No member has bytes between it and the next. */
typedef struct Header {
    char      magic[8];
    char      sources[16];  /* fingerprint_film */
    uint64_t  kept, lights; /* numbers of four members */
    double    rebase_origin[3];
    float     world_to_camera[4][4], world_to_ndc[4][4];
    double    phase_ms[KRS_PHASE_COUNT], wall_ms;
    uint64_t  evaluations, unresolved, clamped, submissions;
    KrsWindow window;
    uint32_t  width, height;
    uint32_t  aovs, mattes; /* bits of KrsAov; whether there are mattes */
    uint32_t  samples, max_evaluations;
    uint32_t  first, closed;
} Header;

/* Describes the film as it is with samples or without. */
static Header describe(const KrsFilm *film)
{
    const KrsPicture *sums   = film->sums;
    Header            header = {.magic  = "krsfilm",
                                .kept   = film->kept ? resident_kept(&film->options) : 0,
                                .lights = lights_numbers(film),
                                .window = sums->window,
                                .width  = sums->width,
                                .height = sums->height,
                                .aovs   = film->options.aovs,
                                .mattes = film->options.mattes,
                                .first  = film->first};
    memcpy(header.sources, fingerprint_film, sizeof header.sources);
    return header;
}

static Header header_of(const KrsFilm *film)
{
    const KrsRenderStats *stats  = &film->sums->stats;
    Header                header = describe(film);
    memcpy(header.rebase_origin, film->rebase_origin, sizeof header.rebase_origin);
    memcpy(header.world_to_camera, film->sums->world_to_camera, sizeof header.world_to_camera);
    memcpy(header.world_to_ndc, film->sums->world_to_ndc, sizeof header.world_to_ndc);
    memcpy(header.phase_ms, stats->phase_ms, sizeof header.phase_ms);
    header.wall_ms         = stats->wall_ms;
    header.evaluations     = stats->evaluations;
    header.unresolved      = stats->unresolved;
    header.clamped         = stats->clamped;
    header.submissions     = stats->submissions;
    header.samples         = film->samples;
    header.closed          = film->closed;
    header.max_evaluations = stats->max_evaluations_per_ray;
    return header;
}

static void take_header(KrsFilm *film, const Header *header)
{
    KrsRenderStats *stats = &film->sums->stats;
    memcpy(film->rebase_origin, header->rebase_origin, sizeof header->rebase_origin);
    memcpy(film->sums->world_to_camera, header->world_to_camera, sizeof header->world_to_camera);
    memcpy(film->sums->world_to_ndc, header->world_to_ndc, sizeof header->world_to_ndc);
    memcpy(stats->phase_ms, header->phase_ms, sizeof header->phase_ms);
    stats->wall_ms                 = header->wall_ms;
    stats->evaluations             = header->evaluations;
    stats->unresolved              = header->unresolved;
    stats->clamped                 = header->clamped;
    stats->submissions             = header->submissions;
    stats->max_evaluations_per_ray = header->max_evaluations;
    film->samples                  = header->samples;
    film->closed                   = header->closed;
}

static bool fits(const KrsFilm *film, const Header *header)
{
    const Header own = describe(film);
    return memcmp(own.magic, header->magic, sizeof own.magic) == 0 &&
           memcmp(own.sources, header->sources, sizeof own.sources) == 0 &&
           own.kept == header->kept && own.lights == header->lights &&
           memcmp(&own.window, &header->window, sizeof own.window) == 0 &&
           own.width == header->width && own.height == header->height && own.aovs == header->aovs &&
           own.mattes == header->mattes && own.first == header->first &&
           header->samples > own.first && header->samples <= KRS_MAX_SAMPLES;
}

/* Passes all arrays of the film. */
static bool pass_arrays(const KrsFilm *film, const Way *way)
{
    const KrsPicture *sums   = film->sums;
    const size_t      pixels = picture_pixels(sums);
    void             *numbers;
    size_t            bytes;
    for (int i = 0; (bytes = picture_plane(sums, i, &numbers)) > 0; i++)
        if (numbers && !pass(way, numbers, pixels * bytes))
            return false;
    for (int kind = 0; kind < KRS_MATTE_COUNT; kind++)
        if (sums->mattes[kind] &&
            !pass(way, sums->mattes[kind], pixels * KRS_MATTE_RANKS * sizeof(KrsMatte)))
            return false;
    if (film->exact && !pass(way, film->exact, pixels * sizeof *film->exact))
        return false;
    if (film->doublings && !pass(way, film->doublings, pixels * sizeof *film->doublings))
        return false;
    return pass(way, film->lights, lights_numbers(film) * sizeof *film->lights) &&
           (!film->kept ||
            pass(way, film->kept, resident_kept(&film->options) * sizeof *film->kept));
}

KrsStatus krs_film_save(KrsFilm *film, KrsWriteCallback *write, void *user)
{
    Gpu      *gpu = &film->rendering->renderer->gpu;
    const Way way = {.write = write, .user = user};
    renderer_clear(film->rendering->renderer);
    if (krs_film_samples(film) == 0) {
        gpu_refuse(gpu, KRS_BAD_ARGUMENT, "the film has no samples yet");
        return gpu->status;
    }
    if (film->rendering->resident.film == film && !resident_store(film->rendering))
        return gpu->status;
    Header header = header_of(film);
    if (!pass(&way, &header, sizeof header) || !pass_arrays(film, &way))
        gpu_refuse(gpu, KRS_IO_ERROR, "the film cannot be written");
    return gpu->status;
}

KrsStatus krs_film_load(KrsFilm *film, KrsReadCallback *read, void *user)
{
    Gpu      *gpu    = &film->rendering->renderer->gpu;
    const Way way    = {.read = read, .user = user};
    Header    header = {0};
    renderer_clear(film->rendering->renderer);
    krs_film_clear(film);
    if (film->updates != film->rendering->updates)
        gpu_refuse(gpu, KRS_BAD_ARGUMENT,
                   "the film is of a scene that its rendering no longer has");
    else if (!pass(&way, &header, sizeof header))
        gpu_refuse(gpu, KRS_IO_ERROR, "the film cannot be read");
    else if (!fits(film, &header))
        gpu_refuse(gpu, KRS_BAD_ARGUMENT, "what was saved is no film like this one");
    else if (header.closed > header.first && !blocks_make_room(film))
        return gpu->status;
    else if (!pass_arrays(film, &way))
        gpu_refuse(gpu, KRS_IO_ERROR, "the film cannot be read");
    else
        take_header(film, &header);
    return gpu->status;
}
