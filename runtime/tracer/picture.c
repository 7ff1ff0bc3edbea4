/*
 * picture.c: making pictures, filling them and freeing them.
 */
#include "runtime/tracer/picture.h"

#include <math.h>
#include <string.h>

/* The planes: all are arrays of 32-bit numbers. */
static const struct Plane {
    size_t   member;  /* offset of its pointer in a KrsPicture */
    uint32_t bit;
    size_t   bytes;   /* per pixel */
    size_t   offset;  /* in a PixelBlock */
} planes[] = {
#define PLANE(name, bit, numbers)                                                               \
    {offsetof(KrsPicture, name), bit, 4 * numbers, offsetof(PixelBlock, name)}
    PLANE(color, KRS_PLANE_COLOR, 4),
    PLANE(depth, KRS_PLANE_DEPTH, 1),
    PLANE(position, KRS_PLANE_POSITION, 3),
    PLANE(normal, KRS_PLANE_NORMAL, 3),
    PLANE(albedo, KRS_PLANE_ALBEDO, 3),
    PLANE(component, KRS_PLANE_IDS, 1),
    PLANE(level, KRS_PLANE_IDS, 1),
    PLANE(instance, KRS_PLANE_IDS, 1),
    PLANE(steps, KRS_PLANE_STEPS, 1),
#undef PLANE
};
enum { PLANE_COUNT = sizeof planes / sizeof planes[0] };

/* The members differ in what they point to, so they are copied, not converted. */
static void *plane_get(const KrsPicture *picture, int plane)
{
    void *values;
    memcpy(&values, (const char *)picture + planes[plane].member, sizeof values);
    return values;
}

static void plane_set(KrsPicture *picture, int plane, void *values)
{
    memcpy((char *)picture + planes[plane].member, &values, sizeof values);
}

KrsPicture *picture_new(Gpu *gpu, uint32_t width, uint32_t height, KrsWindow window,
                        uint32_t wanted)
{
    KrsPicture *picture = gpu_alloc(gpu, 1, sizeof *picture, "make a picture");
    if (!picture)
        return NULL;
    picture->width = width;
    picture->height = height;
    picture->window = window;
    picture->allocator = gpu->allocator;

    size_t pixels = (size_t)window.width * window.height;
    for (int i = 0; i < PLANE_COUNT; i++) {
        if (!(wanted & planes[i].bit))
            continue;
        void *values = gpu_alloc(gpu, pixels, planes[i].bytes, "make a picture of this size");
        if (!values) {
            krs_picture_free(picture);
            return NULL;
        }
        plane_set(picture, i, values);
        picture->stats.peak_memory_bytes += pixels * planes[i].bytes;
    }
    return picture;
}

static void take_plane(void *plane, const PixelBlock *pixels, size_t first, size_t count,
                       const struct Plane *description)
{
    size_t          numbers = description->bytes / 4, stride = sizeof *pixels / 4;
    uint32_t       *to = (uint32_t *)plane + first * numbers;
    const uint32_t *from = (const uint32_t *)((const char *)pixels + description->offset);
    for (size_t k = 0; k < count; k++)
        for (size_t n = 0; n < numbers; n++)
            memcpy(&to[k * numbers + n], &from[k * stride + n], sizeof *to);
}

void picture_take(KrsPicture *picture, const PixelBlock *pixels, size_t first, size_t count,
                  uint32_t samples)
{
    /* In pieces that stay in the cache while plane after plane is filled. */
    enum { PIECE = 256 };
    for (size_t k = 0; k < count; k += PIECE)
        for (int i = 0; i < PLANE_COUNT; i++) {
            void *plane = plane_get(picture, i);
            if (plane)
                take_plane(plane, pixels + k, first + k, count - k < PIECE ? count - k : PIECE,
                           &planes[i]);
        }
    for (size_t k = 4 * first; picture->color && samples > 1 && k < 4 * (first + count); k++)
        picture->color[k] /= (float)samples;

    for (size_t k = 0; picture->depth && k < count; k++)
        if (pixels[k].component == 0)
            picture->depth[first + k] = INFINITY;

    KrsRenderStats *stats = &picture->stats;
    for (size_t k = 0; k < count; k++) {
        uint32_t most = pixels[k].most > pixels[k].steps ? pixels[k].most : pixels[k].steps;
        stats->evaluations += (uint64_t)pixels[k].steps + pixels[k].evaluations;
        if (most > stats->most_evaluations_per_ray)
            stats->most_evaluations_per_ray = most;
    }
}

void krs_picture_free(KrsPicture *picture)
{
    if (!picture)
        return;
    Gpu allocating = {.allocator = picture->allocator};
    for (int i = 0; i < PLANE_COUNT; i++)
        gpu_release(&allocating, plane_get(picture, i));
    gpu_release(&allocating, picture);
}
