/*
 * sample_blocks.c: sums over blocks of samples, which are added exactly.
 */
#include "runtime/film/sample_blocks.h"

#include <stdlib.h>
#include <string.h>

#include "runtime/film/resident.h"
#include "runtime/tracer/renderer.h"
#include "runtime/tracer/rendering.h"

bool film_has_blocks(const KrsFilm *film)
{
    return film->light_count == 0 && film->options.noise == 0;
}

void film_begin_at(KrsFilm *film, uint32_t first)
{
    film->first   = first;
    film->divided = true;
    krs_film_clear(film);
}

uint32_t blocks_room(const KrsFilm *film, uint32_t samples)
{
    const uint32_t room = SAMPLES_OF_BLOCK - film->samples % SAMPLES_OF_BLOCK;
    return film_has_blocks(film) && room < samples ? room : samples;
}

void blocks_free(KrsFilm *film)
{
    Gpu *gpu = &film->rendering->renderer->gpu;
    gpu_release(gpu, film->exact);
    gpu_release(gpu, film->doublings);
    film->exact     = NULL;
    film->doublings = NULL;
}

void blocks_clear(KrsFilm *film)
{
    blocks_free(film);
    film->closed = film->first;
    memset(film->sums->color, 0, film_pixels(film) * sizeof(float[4]));
}

/* ---- errors ---- */

/* Keeps what noise.comp has found of the first block. */
static void begin_doublings(KrsFilm *film)
{
    const KrsWindow cover = resident_cover(&film->options), *crop = &film->options.crop;
    float(*earlier)[4] = film->kept +
                         (size_t)KEPT_EARLIER * cover.width * cover.height; /* whole tiles */
    for (size_t k = 0; k < film_pixels(film); k++) {
        const size_t x = crop->x - cover.x + k % crop->width,
                     y = crop->y - cover.y + k / crop->width;
        memcpy(film->doublings[k].earlier, film->exact[k], sizeof film->doublings[k].earlier);
        film->doublings[k].variance = earlier[y * cover.width + x][3];
        film->doublings[k].error    = film->sums->noise[k];
    }
}

/* ---- blocks ---- */

bool blocks_make_room(KrsFilm *film)
{
    Gpu *gpu = &film->rendering->renderer->gpu;
    if (!film->exact)
        film->exact = gpu_alloc(gpu, film_pixels(film), sizeof *film->exact, "add samples");
    if (film->exact && film->kept && !film->doublings)
        film->doublings = gpu_alloc(gpu, film_pixels(film), sizeof *film->doublings, "add samples");
    return film->exact && (!film->kept || film->doublings);
}

/* Makes the sums of the block at hand 0, wherever they are. */
static bool clear_block(KrsFilm *film)
{
    const KrsWindow cover = resident_cover(&film->options);
    memset(film->sums->color, 0, film_pixels(film) * sizeof(float[4]));
    if (film->kept)
        memset(film->kept, 0, (size_t)cover.width * cover.height * sizeof *film->kept);
    return film->rendering->resident.film != film ||
           resident_clear(film->rendering, 1u << ROW_COLORS) ||
           film->rendering->renderer->gpu.lost; /* then the device has none */
}

bool blocks_close(KrsFilm *film)
{
    if (!film_has_blocks(film) || film->samples % SAMPLES_OF_BLOCK != 0 ||
        film->samples == film->closed)
        return true;
    if (!blocks_make_room(film) ||
        (film->rendering->resident.film == film && !resident_store(film->rendering)))
        return false;
    for (size_t k = 0; k < film_pixels(film); k++)
        for (size_t i = 0; i < 4; i++)
            film->exact[k][i] = exact_sum(film->exact[k][i],
                                          exact_of(film->sums->color[4 * k + i]));
    film->closed = film->samples;
    if (film->kept && film->samples == SAMPLES_OF_BLOCK)
        begin_doublings(film);
    for (size_t k = 0; film->kept && doubling_is_due(film->samples) && k < film_pixels(film); k++)
        doubling_take(&film->doublings[k], film->exact[k], film->samples,
                      (float)film->options.noise_floor);
    return clear_block(film);
}

static void find_sums(const KrsFilm *film, size_t pixel, Exact sums[4])
{
    for (size_t i = 0; i < 4; i++) {
        sums[i] = exact_of(film->sums->color[4 * pixel + i]);
        if (film->exact)
            sums[i] = exact_sum(film->exact[pixel][i], sums[i]);
    }
}

void blocks_finish(const KrsFilm *film, KrsPicture *picture)
{
    Exact sums[4];
    for (size_t k = 0; film->closed > film->first && picture->color && k < film_pixels(film); k++) {
        find_sums(film, k, sums);
        for (size_t i = 0; i < 4; i++)
            picture->color[4 * k + i] = exact_float(sums[i]);
    }
    for (size_t k = 0; film->closed > film->first && picture->noise && k < film_pixels(film); k++)
        picture->noise[k] = film->doublings[k].error;
}

/* ---- all sums ---- */

SampleSums film_sums(const KrsFilm *film)
{
    static const Doubling none;
    SampleSums            all = {.noise       = film->doublings != NULL,
                                 .noise_floor = (float)film->options.noise_floor};
    Exact                 sums[4];
    all.numbers = malloc(film_pixels(film) * sizeof *all.numbers);
    for (size_t k = 0; all.numbers && k < film_pixels(film); k++) {
        find_sums(film, k, sums);
        sums_to_numbers(sums, film->doublings ? &film->doublings[k] : &none, all.numbers[k]);
    }
    return all;
}
