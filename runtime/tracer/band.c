/*
 * band.c: allocates the buffers of a band.
 */
#include "runtime/tracer/band.h"

#include "runtime/tracer/layouts.h"
#include "runtime/tracer/renderer.h"
#include "runtime/tracer/rendering.h"

/* The most pixels of a band.  On a graphics card that is a whole picture of a common size, in 560
   MB of buffers.  On a processor bands are half as large, as the pages of their buffers must be
   cleared.  Smaller ones would not be in its caches either, and more rows would be of their halos. */
#define BAND_PIXELS     (UINT64_C(1) << 21)
#define BAND_PIXELS_CPU (UINT64_C(1) << 20)
/* The buffers of a band take at most this fraction of the device's memory: 1 / PART_OF_MEMORY. */
#define PART_OF_MEMORY 4
/* The pixels of the smallest band: bands are halved down to this when the device lacks memory. */
#define BAND_PIXELS_MIN (UINT64_C(1) << 12)

static void band_destroy(Gpu *gpu, Band *band)
{
    Buffer *buffers[] = {&band->ends,  &band->hits,  &band->results, &band->fetched,
                         &band->queue, &band->taken, &band->tiles,   &band->surfaces};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++)
        buffer_destroy(gpu, buffers[i]);
    band->pixels = 0;
}

/* Returns the most beams of a band of this many pixels, whatever its shape and position.  There is
   a beam for every tile of 8x8 pixels, for each of its quarters, and for every tile of 32x32. */
static uint64_t max_beams(uint64_t pixels) { return 2 * (pixels / TILE + 2 * KRS_MAX_SIDE / TILE); }

/* The last rows are for noise.comp, and behind them those of lights. */
static uint64_t rows_of_results(bool noise, uint32_t lights)
{
    return lights > 0 ? ROW_OF_LIGHTS + lights : noise ? RESULT_ROWS : ROW_NOISE;
}

static bool band_create(KrsRendering *rendering, uint64_t pixels, uint32_t path_rows, bool noise,
                        uint32_t lights, uint32_t surface_rows)
{
    Gpu           *gpu           = &rendering->renderer->gpu;
    Band          *band          = &rendering->band;
    const bool     read_in_place = gpu_is_cpu(gpu); /* the host reads the device's buffer */
    const Where    shared        = read_in_place ? SHARED : ON_DEVICE;
    const uint64_t hit           = HIT_BYTES + path_rows * PATH_ROW_BYTES;
    const uint64_t beams = max_beams(pixels), tiles = ((path_rows ? pixels : beams) + 3) / 4 * 4;
    const uint64_t results = pixels * rows_of_results(noise, lights) * RESULT_BYTES;
    const struct {
        Buffer     *buffer;
        uint32_t    binding, texels; /* in set 1: as a buffer, as texels; 0: none */
        uint64_t    bytes;           /* 0: the buffer is not needed */
        Where       where;
        const char *name;
    } wanted[] = {
        {&band->ends, ENDS_BINDING, END_TEXELS_BINDING, (pixels + beams) * END_BYTES, shared,
         "rays"},
        {&band->hits, HITS_BINDING, HIT_TEXELS_BINDING, pixels * hit, shared, "hits"},
        {&band->results, RESULTS_BINDING, RESULT_TEXELS_BINDING, results, shared, "pixels"},
        {&band->queue, QUEUE_BINDING, PIXEL_LIST_TEXELS_BINDING, 2 * pixels * MARCH_BYTES, shared,
         "queue of rays"},
        {&band->taken, TAKEN_BINDING, 0, beams * sizeof(uint32_t), ON_DEVICE, "shares of groups"},
        {&band->tiles, TILES_BINDING, TILE_TEXELS_BINDING,
         (tiles + (noise ? beams : 0)) * sizeof(uint32_t), shared, "tiles"},
        {&band->surfaces, 0, SURFACE_TEXELS_BINDING, pixels * surface_rows * SURFACE_ROW_BYTES,
         shared, "surfaces"},
        {&band->fetched, 0, 0, read_in_place ? 0 : results, SHARED, "pixels to read"},
    };
    if (band->pixels >= pixels && band->path_rows >= path_rows && (band->has_noise || !noise) &&
        band->lights >= lights && band->surface_rows >= surface_rows)
        return true;
    band_destroy(gpu, band);
    for (size_t i = 0; i < sizeof wanted / sizeof wanted[0]; i++) {
        Buffer *buffer = wanted[i].buffer;
        if (wanted[i].bytes == 0)
            continue;
        uint64_t bytes = wanted[i].texels ? buffer_texel_bytes(wanted[i].bytes) : wanted[i].bytes;
        if (!buffer_create(gpu, buffer, bytes, wanted[i].where, wanted[i].name) ||
            (wanted[i].texels &&
             !layouts_view_texels(gpu, wanted[i].texels, buffer, wanted[i].name))) {
            band_destroy(gpu, band);
            return false;
        }
        if (wanted[i].binding)
            rendering_bind(rendering, rendering->band_set, wanted[i].binding, buffer);
        if (wanted[i].texels)
            rendering_bind(rendering, rendering->band_set, wanted[i].texels, buffer);
    }
    band->pixels       = pixels;
    band->path_rows    = path_rows;
    band->has_noise    = noise;
    band->lights       = lights;
    band->surface_rows = surface_rows;
    band->sampled_at   = (uint32_t)tiles;
    return true;
}

/* Rounds up to whole tiles, which are traced, so the last one may reach beyond the picture. */
static uint32_t round_to_tiles(uint32_t pixels) { return (pixels + TILE - 1) / TILE * TILE; }

/* Returns the rows of pixels in a band of at most `pixels` pixels: whole tiles, at least one. */
static uint32_t rows_within(uint32_t width, uint64_t pixels)
{
    uint64_t rows = pixels / width / TILE * TILE;
    return rows < TILE ? TILE : (uint32_t)rows;
}

/* Bytes of all buffers of a band for a pixel, about, with so many rows of results. */
#define BAND_BYTES(hit, rows) (END_BYTES + (hit) + 2 * (rows)*RESULT_BYTES + 2 * MARCH_BYTES + 4)

static uint64_t larger(uint64_t a, uint64_t b) { return a > b ? a : b; }

/* Returns the most pixels that a band may have on this device.  All of its buffers must fit into
   the device's memory, and none may be longer than shaders can read. */
static uint64_t max_pixels(const Gpu *gpu, uint32_t path_rows, uint32_t lights,
                           uint32_t surface_rows, uint32_t halvings)
{
    const uint64_t   rows     = RESULT_ROWS + lights;
    const uint64_t   hit      = HIT_BYTES + path_rows * PATH_ROW_BYTES;
    const uint64_t   surface  = surface_rows * SURFACE_ROW_BYTES;
    const uint64_t   usual    = gpu_is_cpu(gpu) ? BAND_PIXELS_CPU : BAND_PIXELS;
    const GpuLimits *limits   = &gpu->limits;
    const uint64_t   slack    = buffer_texel_bytes(1); /* what rounding adds at most */
    const uint64_t   in_range = (limits->storage_bytes - slack) /
                              larger(larger(hit, surface), rows * RESULT_BYTES);
    const uint64_t in_texels = (limits->texels - slack / sizeof(uint32_t)) /
                               (rows > 2 * MARCH_BYTES / sizeof(uint32_t)
                                    ? rows
                                    : 2 * MARCH_BYTES / sizeof(uint32_t));
    const uint64_t in_memory = gpu_memory(gpu) / PART_OF_MEMORY / (BAND_BYTES(hit, rows) + surface);
    uint64_t       most      = in_range < in_memory ? in_range : in_memory;
    most                     = gpu->texels && in_texels < most ? in_texels : most;
    most                     = (most < usual ? most : usual) >> halvings;
    return most > BAND_PIXELS_MIN ? most : BAND_PIXELS_MIN;
}

uint32_t band_allocate(KrsRendering *rendering, const KrsWindow *cover, uint32_t halo,
                       uint32_t path_rows, bool noise, uint32_t lights, uint32_t surface_rows)
{
    Gpu           *gpu    = &rendering->renderer->gpu;
    const uint64_t across = round_to_tiles(cover->width) + 2 * halo;
    for (uint64_t pixels = max_pixels(gpu, path_rows, lights, surface_rows,
                                      renderer_halvings(rendering->renderer));
         pixels >= BAND_PIXELS_MIN; pixels /= 2) {
        uint32_t rows = rows_within((uint32_t)across, pixels);
        rows          = rows > 2 * halo + TILE ? rows - 2 * halo : TILE;
        rows          = rows < cover->height ? rows : cover->height;
        if (band_create(rendering, (round_to_tiles(rows) + 2 * halo) * across, path_rows, noise,
                        lights, surface_rows)) {
            renderer_clear(rendering->renderer);
            return rows;
        }
        if (gpu->status != KRS_OUT_OF_MEMORY)
            return 0;
    }
    return 0;
}
