/*
 * band.c: the buffers of a band.
 */
#include "runtime/tracer/band.h"

#include "runtime/tracer/layouts.h"
#include "runtime/tracer/renderer.h"
#include "runtime/tracer/rendering.h"

/* Pixels of a band: on a graphics card all of a common picture, in 560 MB of buffers, or as many
   as a part of its memory has room for; on a processor few, which stay near to it, and are made of
   pages that must be cleared. */
#define BAND_PIXELS     (UINT64_C(1) << 21)
#define BAND_PIXELS_CPU (UINT64_C(1) << 19)
#define PART_OF_MEMORY  4
/* Bands are halved when the device lacks memory, down to this. */
#define BAND_PIXELS_MIN (UINT64_C(1) << 12)

static void band_destroy(Gpu *gpu, Band *band)
{
    Buffer *buffers[] = {&band->ends,  &band->hits,  &band->results, &band->fetched,
                         &band->queue, &band->taken, &band->tiles};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++)
        buffer_destroy(gpu, buffers[i]);
    band->pixels = 0;
}

/* Room for the beams of a band of so many pixels, whatever its shape and place: every tile of 8x8
   pixels, its quarters, and every tile of 32x32. */
static VkDeviceSize most_beams(uint64_t pixels)
{
    return 2 * (pixels / TILE + 2 * KRS_MOST_SIDE / TILE);
}

static bool band_create(KrsRendering *rendering, uint64_t pixels)
{
    Gpu               *gpu     = &rendering->renderer->gpu;
    Band              *band    = &rendering->band;
    const bool         near    = gpu_is_cpu(gpu); /* the host reads the results where they are */
    const Where        shared  = near ? SHARED : ON_DEVICE;
    const VkDeviceSize results = pixels * RESULT_ROWS * RESULT_BYTES, beams = most_beams(pixels);
    const struct {
        Buffer      *buffer;
        uint32_t     binding, texels; /* of set 1; 0: of none */
        VkDeviceSize bytes;           /* 0: none is made */
        Where        where;
        const char  *name;
    } wanted[] = {
        {&band->ends, ENDS_BINDING, END_TEXELS, (pixels + beams) * END_BYTES, ON_DEVICE, "rays"},
        {&band->hits, HITS_BINDING, HIT_TEXELS, pixels * HIT_BYTES, ON_DEVICE, "hits"},
        {&band->results, RESULTS_BINDING, RESULT_TEXELS, results, shared, "pixels"},
        {&band->queue, QUEUE_BINDING, PIXEL_LIST_TEXELS, 2 * pixels * MARCH_BYTES, ON_DEVICE,
         "queue of rays"},
        {&band->taken, TAKEN_BINDING, 0, beams * sizeof(uint32_t), ON_DEVICE, "shares of groups"},
        {&band->tiles, TILES_BINDING, 0, beams * sizeof(uint32_t), ON_DEVICE, "tiles"},
        {&band->fetched, 0, 0, near ? 0 : results, SHARED, "pixels to read"},
    };
    if (band->pixels >= pixels)
        return true;
    band_destroy(gpu, band);
    for (size_t i = 0; i < sizeof wanted / sizeof wanted[0]; i++) {
        Buffer *buffer = wanted[i].buffer;
        if (wanted[i].bytes == 0)
            continue;
        VkDeviceSize bytes = wanted[i].texels ? buffer_texel_bytes(wanted[i].bytes)
                                              : wanted[i].bytes;
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
    band->pixels = pixels;
    return true;
}

/* Tiles may end outside of the picture. */
static uint32_t round_to_tiles(uint32_t pixels) { return (pixels + TILE - 1) / TILE * TILE; }

/* Rows of a band of at most `pixels`: whole tiles, and at least one. */
static uint32_t rows_within(uint32_t width, uint64_t pixels)
{
    uint64_t rows = pixels / width / TILE * TILE;
    return rows < TILE ? TILE : (uint32_t)rows;
}

/* What the buffers of a band hold for a pixel, about. */
#define BAND_BYTES (END_BYTES + HIT_BYTES + 2 * RESULT_ROWS * RESULT_BYTES + 2 * MARCH_BYTES + 4)

/* As many pixels as a band may have, for it to fit into the device's memory and for none of its
   buffers to be longer than kernels may read. */
static uint64_t most_pixels(const Gpu *gpu)
{
    const uint64_t                usual    = gpu_is_cpu(gpu) ? BAND_PIXELS_CPU : BAND_PIXELS;
    const VkPhysicalDeviceLimits *limits   = &gpu->properties.limits;
    const uint64_t                slack    = buffer_texel_bytes(1); /* what rounding adds at most */
    const uint64_t                in_range = (limits->maxStorageBufferRange - slack) /
                              (RESULT_ROWS * RESULT_BYTES);
    const uint64_t in_texels = (limits->maxTexelBufferElements - slack / sizeof(uint32_t)) /
                               (2 * MARCH_BYTES / sizeof(uint32_t));
    const uint64_t in_memory = gpu_memory(gpu) / PART_OF_MEMORY / BAND_BYTES;
    uint64_t       most      = in_range < in_memory ? in_range : in_memory;
    most                     = gpu->texels && in_texels < most ? in_texels : most;
    most                     = most < usual ? most : usual;
    return most > BAND_PIXELS_MIN ? most : BAND_PIXELS_MIN;
}

uint32_t band_allocate(KrsRendering *rendering, const KrsWindow *cover, uint32_t halo)
{
    Gpu           *gpu    = &rendering->renderer->gpu;
    const uint64_t across = round_to_tiles(cover->width) + 2 * halo;
    for (uint64_t pixels = most_pixels(gpu); pixels >= BAND_PIXELS_MIN; pixels /= 2) {
        uint32_t rows = rows_within((uint32_t)across, pixels);
        rows          = rows > 2 * halo + TILE ? rows - 2 * halo : TILE;
        rows          = rows < cover->height ? rows : cover->height;
        if (band_create(rendering, (round_to_tiles(rows) + 2 * halo) * across)) {
            renderer_clear(rendering->renderer);
            return rows;
        }
        if (gpu->status != KRS_OUT_OF_MEMORY)
            return 0;
    }
    return 0;
}
