/* tiles.c: deals out the tiles of a picture to threads. */
#include "denoise/tile.h"

#include <stdatomic.h>
#include <stdlib.h>

#include "compiler/base/parallel.h"

typedef struct Denoising {
    const DenoisePicture *picture;
    float (*result)[3];
    DenoiseProgress *progress;
    void            *user;
    Tile            *tiles; /* one for each part */
    size_t           columns, count;
    atomic_size_t    next;
    atomic_bool      stopped;
} Denoising;

static void denoise_tile(const Denoising *d, Tile *tile, size_t number)
{
    tile->picture = d->picture;
    tile->x       = number % d->columns * TILE_SIDE;
    tile->y       = number / d->columns * TILE_SIDE;
    tile_load(tile);
    tile_filter(tile);
    tile_choose(tile, d->result);
}

static void denoise_tiles(void *task, size_t part, size_t parts)
{
    (void)parts;
    Denoising *d = task;
    for (size_t number; (number = atomic_fetch_add(&d->next, 1)) < d->count;) {
        if (part == 0 && d->progress && !d->progress(d->user, (double)number / (double)d->count))
            atomic_store(&d->stopped, true);
        if (atomic_load(&d->stopped))
            return;
        denoise_tile(d, &d->tiles[part], number);
    }
}

static size_t tiles_along(size_t pixels) { return (pixels + TILE_SIDE - 1) / TILE_SIDE; }

KrsStatus denoise(const DenoisePicture *picture, DenoiseProgress *progress, void *user,
                  float (*result)[3])
{
    Denoising d = {.picture  = picture,
                   .result   = result,
                   .progress = progress,
                   .user     = user,
                   .tiles    = malloc(parallel_parts() * sizeof(Tile)),
                   .columns  = tiles_along(picture->width)};
    d.count     = d.columns * tiles_along(picture->height);
    if (!d.tiles)
        return KRS_OUT_OF_MEMORY;
    d.stopped = progress && !progress(user, 0);
    run_in_parallel(denoise_tiles, &d);
    free(d.tiles);
    return d.stopped ? KRS_INTERRUPTED : KRS_OK;
}
