/*
 * resident.c: copies samples between the buffers of a band and the film that the band belongs to.
 */
#include "runtime/film/resident.h"

#include <math.h>
#include <string.h>

#include "runtime/film/mattes.h"
#include "runtime/film/picture.h"

KrsWindow resident_cover(const KrsRenderOptions *options)
{
    const KrsWindow *crop   = &options->crop;
    KrsWindow        cover  = {crop->x / TILE * TILE, crop->y / TILE * TILE, 0, 0};
    uint32_t         right  = (crop->x + crop->width + TILE - 1) / TILE * TILE;
    uint32_t         bottom = (crop->y + crop->height + TILE - 1) / TILE * TILE;
    cover.width             = (right < options->width ? right : options->width) - cover.x;
    cover.height            = (bottom < options->height ? bottom : options->height) - cover.y;
    return cover;
}

size_t resident_kept(const KrsRenderOptions *options)
{
    const KrsWindow cover = resident_cover(options);
    return (size_t)KEPT_ROWS * cover.width * cover.height;
}

uint32_t resident_samples(const KrsFilm *film, uint32_t from)
{
    return film->samples + film->more[from / TILE];
}

/* Returns the rows for the light of lights in the buffers.  They go along with the row of colours. */
static uint32_t rows_of_lights(const ResidentBand *resident, uint32_t rows)
{
    return rows & 1u << ROW_COLORS ? resident->film->light_count : 0;
}

/* Records copies of rows of results from one buffer to another: those whose bit ROW_... is set in
   `rows`, and those of so many lights. */
static void record_copies(Gpu *gpu, const Buffer *from, const Buffer *to, uint32_t rows,
                          uint32_t lights, uint64_t row_bytes)
{
    const uint64_t at_lights = ROW_OF_LIGHTS * row_bytes;
    for (uint64_t row = 0; row < RESULT_ROWS; row++)
        if (rows >> row & 1)
            gpu_copy(gpu, from, row * row_bytes, to, row * row_bytes, row_bytes);
    if (lights > 0)
        gpu_copy(gpu, from, at_lights, to, at_lights, lights * row_bytes);
}

static uint64_t row_bytes_of(const ResidentBand *resident)
{
    return (uint64_t)resident->traced.height * resident->traced.width * RESULT_BYTES;
}

/* Makes some rows of results readable by the host; NULL with the failure noted. */
static float *fetch(KrsRendering *rendering, uint32_t rows)
{
    Gpu   *gpu  = &rendering->renderer->gpu;
    Band  *band = &rendering->band;
    double ms   = 0; /* the time of copies belongs to no phase */
    if (band->results.bytes)
        return band->results.bytes;
    if (!gpu_begin(gpu))
        return NULL;
    record_copies(gpu, &band->results, &band->fetched, rows,
                  rows_of_lights(&rendering->resident, rows), row_bytes_of(&rendering->resident));
    return gpu_finish(gpu, &ms) ? band->fetched.bytes : NULL;
}

/* Clears rows of results.  They are 0, since colours are sums and pixels without a hit have no
   values.  Positions are infinite where nothing is hit. */
static bool clear_results(KrsRendering *rendering, uint32_t rows, uint64_t row_bytes)
{
    const uint32_t infinite = 0x7f800000;
    Gpu           *gpu      = &rendering->renderer->gpu;
    double         ms       = 0;
    if (!gpu_begin(gpu))
        return false;
    for (uint64_t row = 0; row < RESULT_ROWS; row++)
        if (rows >> row & 1)
            gpu_fill(gpu, &rendering->band.results, row * row_bytes, row_bytes,
                     row == ROW_POSITIONS ? infinite : 0);
    const uint32_t lights = rows_of_lights(&rendering->resident, rows);
    if (lights > 0)
        gpu_fill(gpu, &rendering->band.results, ROW_OF_LIGHTS * row_bytes, lights * row_bytes, 0);
    return gpu_finish(gpu, &ms);
}

bool resident_clear(KrsRendering *rendering, uint32_t rows)
{
    return clear_results(rendering, rows, row_bytes_of(&rendering->resident));
}

/* Finds where row `y` of the picture begins, among the pixels of the band and of the film.  False
   where the row is outside of the crop. */
static bool find_row(const KrsFilm *film, const ResidentBand *resident, uint32_t y, size_t *in_band,
                     size_t *in_film)
{
    const KrsWindow *crop = &film->options.crop, *traced = &resident->traced;
    if (y < crop->y || y >= crop->y + crop->height)
        return false;
    *in_band = (size_t)(y - traced->y) * traced->width + (crop->x - traced->x);
    *in_film = (size_t)(y - crop->y) * crop->width;
    return true;
}

/* Finds the rows of pixels of the resident band: [first, end). */
static void rows_of_resident(const KrsFilm *film, const ResidentBand *resident, uint32_t *first,
                             uint32_t *end)
{
    *first = film->options.crop.y / TILE * TILE + resident->from;
    *end   = *first + resident->rows;
}

/* Turns camera-relative positions into positions in the world, and those of pixels without a hit
   into 0.  `position_row` is their row of results, which has their depths, too. */
static void place_positions(KrsFilm *film, const float *position_row, size_t first, size_t count)
{
    float *position = film->sums->position;
    for (size_t k = 0; position && k < count; k++)
        for (int i = 0; i < 3; i++) {
            float *number = &position[3 * (first + k) + i];
            bool   is_hit = isfinite(position_row[k * RESULT_NUMBERS + DEPTH_NUMBER]);
            *number       = is_hit ? (float)(*number + film->rebase_origin[i]) : 0;
        }
}

/* Returns the rows of results that samples add to. */
static uint32_t rows_of_sums(const KrsFilm *film)
{
    return 1u << ROW_COLORS | (film->kept ? 1u << ROW_NOISE | 1u << ROW_EARLIER : 0);
}

/* Copies the rows of sums of the whole tiles in the buffers to what the film keeps, or back. */
static void copy_kept(const KrsFilm *film, const ResidentBand *resident, float *results, bool back)
{
    static const uint32_t kept_rows[KEPT_ROWS] = {
        [KEPT_COLORS] = ROW_COLORS, [KEPT_NOISE] = ROW_NOISE, [KEPT_EARLIER] = ROW_EARLIER};
    const KrsWindow cover = resident_cover(&film->options), *traced = &resident->traced;
    const size_t    band  = (size_t)traced->height * traced->width;
    const size_t    whole = (size_t)cover.height * cover.width;
    for (size_t row = 0; row < KEPT_ROWS; row++)
        for (size_t y = resident->from; y < resident->from + resident->rows; y++) {
            const size_t in_band = (cover.y + y - traced->y) * traced->width + cover.x - traced->x;
            float       *numbers = results + (kept_rows[row] * band + in_band) * RESULT_NUMBERS;
            float       *kept    = film->kept[row * whole + y * cover.width];
            memcpy(back ? numbers : kept, back ? kept : numbers, cover.width * RESULT_BYTES);
        }
}

/* Copies a row of pixels of the light of all lights from results to the film, or back. */
static void copy_lights(const KrsFilm *film, float *results, size_t band, size_t in_band,
                        size_t in_film, bool back)
{
    const KrsWindow *crop = &film->options.crop;
    for (size_t light = 0; light < film->light_count; light++) {
        float *numbers = results + ((ROW_OF_LIGHTS + light) * band + in_band) * RESULT_NUMBERS;
        float *kept    = film->lights[light * crop->width * crop->height + in_film];
        memcpy(back ? numbers : kept, back ? kept : numbers, crop->width * RESULT_BYTES);
    }
}

/* Returns the rows of results that the film lacks. */
static uint32_t rows_to_store(const ResidentBand *resident)
{
    const KrsFilm *film = resident->film;
    return rows_of_sums(film) | (resident->has_aovs ? picture_rows(film->sums) : 0);
}

/* Copies rows that the host can read. */
static void store(ResidentBand *resident, float *results)
{
    KrsFilm       *film = resident->film;
    const uint32_t aovs = resident->has_aovs ? KRS_AOV_ALL : KRS_AOV_COLOR | KRS_AOV_NOISE;
    const size_t   band = (size_t)resident->traced.height * resident->traced.width;
    uint32_t       y, end;
    for (rows_of_resident(film, resident, &y, &end); y < end; y++) {
        size_t in_band, in_film;
        if (!find_row(film, resident, y, &in_band, &in_film))
            continue;
        picture_take(film->sums, aovs, results + in_band * RESULT_NUMBERS, band, in_film,
                     film->options.crop.width);
        copy_lights(film, results, band, in_band, in_film, false);
        if (resident->has_aovs)
            place_positions(film, results + (ROW_POSITIONS * band + in_band) * RESULT_NUMBERS,
                            in_film, film->options.crop.width);
    }
    if (film->kept)
        copy_kept(film, resident, results, false);
    resident->has_colors = resident->has_aovs = false;
}

bool resident_store(KrsRendering *rendering)
{
    ResidentBand *resident = &rendering->resident;
    if (!resident->film || !(resident->has_colors || resident->has_aovs))
        return true;
    float *results = fetch(rendering, rows_to_store(resident));
    if (results)
        store(resident, results);
    return results != NULL;
}

bool resident_take_mattes(KrsRendering *rendering)
{
    ResidentBand *resident = &rendering->resident;
    KrsFilm      *film     = resident->film;
    float        *results  = fetch(rendering, MATTE_ROWS | rows_to_store(resident));
    const size_t  band     = (size_t)resident->traced.height * resident->traced.width;
    uint32_t      y, end;
    if (!results)
        return false;
    for (rows_of_resident(film, resident, &y, &end); y < end; y++) {
        size_t in_band, in_film;
        if (find_row(film, resident, y, &in_band, &in_film))
            mattes_take(film->sums, results + in_band * RESULT_NUMBERS, band, in_film,
                        film->options.crop.width);
    }
    store(resident, results);
    return true;
}

/* Copies the sums of a film back to the buffers, whose colours are 0. */
static bool load_sums(const KrsFilm *film)
{
    KrsRendering *rendering = film->rendering;
    Gpu          *gpu       = &rendering->renderer->gpu;
    Band         *buffers   = &rendering->band;
    ResidentBand *resident  = &rendering->resident;
    double        ms        = 0;
    uint32_t      y, end;
    const size_t  band = (size_t)resident->traced.height * resident->traced.width;
    float *results     = buffers->results.bytes ? buffers->results.bytes : buffers->fetched.bytes;
    for (size_t row = 0; row < RESULT_ROWS && !buffers->results.bytes; row++)
        if (rows_of_sums(film) >> row & 1)
            memset(results + row * band * RESULT_NUMBERS, 0, row_bytes_of(resident));
    if (!buffers->results.bytes)
        memset(results + ROW_OF_LIGHTS * band * RESULT_NUMBERS, 0,
               film->light_count * row_bytes_of(resident));
    for (rows_of_resident(film, resident, &y, &end); y < end; y++) {
        size_t in_band, in_film;
        if (!find_row(film, resident, y, &in_band, &in_film))
            continue;
        memcpy(results + in_band * RESULT_NUMBERS, film->sums->color + in_film * RESULT_NUMBERS,
               film->options.crop.width * RESULT_BYTES);
        copy_lights(film, results, band, in_band, in_film, true);
    }
    if (film->kept)
        copy_kept(film, resident, results, true);
    if (buffers->results.bytes)
        return true;
    if (!gpu_begin(gpu))
        return false;
    record_copies(gpu, &buffers->fetched, &buffers->results, rows_of_sums(film), film->light_count,
                  row_bytes_of(resident));
    return gpu_finish(gpu, &ms);
}

bool resident_change(KrsFilm *film, const ResidentBand *wanted)
{
    KrsRendering *rendering = film->rendering;
    ResidentBand *resident  = &rendering->resident;
    const bool    empty     = resident_samples(film, wanted->from) == 0;
    if (resident->film == film && resident->from == wanted->from &&
        resident->rows == wanted->rows && !empty) {
        resident->has_colors = true;
        return true;
    }
    if (!resident_store(rendering))
        return false;
    uint32_t rows = empty ? picture_rows(film->sums) : rows_of_sums(film);
    *resident     = *wanted;
    return clear_results(rendering, rows, row_bytes_of(resident)) && (empty || load_sums(film));
}
