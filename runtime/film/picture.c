/*
 * picture.c: makes pictures in host memory, fills them and frees them.
 */
#include "runtime/film/picture.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "compiler/base/allocator.h"
#include "runtime/film/mattes.h"

/* The arrays of all AOVs; all numbers have 32 bits. */
static const struct Plane {
    size_t   member; /* offset of its pointer in a KrsPicture */
    uint32_t bit;
    size_t   bytes;  /* per pixel */
    uint32_t row;    /* the row of results that it comes from: ROW_... */
    size_t   number; /* the first of its numbers in that row */
} aovs[] = {
#define KRS_AOV(id, bit, aov, about, arrays) arrays
#define KRS_ARRAY(aov, member, type, numbers, row, first, sample, ...) \
    {offsetof(KrsPicture, member), KRS_AOV_##aov, sizeof(type[numbers]), row, first},
#include "krs/aovs.def"
#undef KRS_ARRAY
#undef KRS_AOV
};
enum { ARRAY_COUNT = sizeof aovs / sizeof aovs[0] };

/* Checks that no number of a row is in two arrays: only then the sum of their bits equals the
   union. */
#define KRS_AOV(id, bit, aov, about, arrays) arrays
#define BITS(row, first, numbers)            ((UINT64_C(1) << (numbers)) - 1) << (4 * (row) + (first))
static_assert((0
#define KRS_ARRAY(aov, member, type, numbers, row, first, sample, ...) +(BITS(row, first, numbers))
#include "krs/aovs.def"
#undef KRS_ARRAY
               ) == (0
#define KRS_ARRAY(aov, member, type, numbers, row, first, sample, ...) | (BITS(row, first, numbers))
#include "krs/aovs.def"
#undef KRS_ARRAY
                     ),
              "aovs.def");
#undef BITS
#undef KRS_AOV

/* The members point to different types, so pointers are copied as bytes, not converted. */
static void *aov_get(const KrsPicture *picture, int aov)
{
    void *values;
    memcpy(&values, (const char *)picture + aovs[aov].member, sizeof values);
    return values;
}

static void aov_set(KrsPicture *picture, int aov, void *values)
{
    memcpy((char *)picture + aovs[aov].member, &values, sizeof values);
}

size_t picture_plane(const KrsPicture *picture, int index, void **numbers)
{
    *numbers = index < ARRAY_COUNT ? aov_get(picture, index) : NULL;
    return index < ARRAY_COUNT ? aovs[index].bytes : 0;
}

KrsPicture *picture_new(Gpu *gpu, uint32_t width, uint32_t height, KrsWindow window,
                        uint32_t wanted)
{
    KrsPicture *picture = gpu_alloc(gpu, 1, sizeof *picture, "make a picture");
    if (!picture)
        return NULL;
    picture->width     = width;
    picture->height    = height;
    picture->window    = window;
    picture->allocator = gpu->allocator;

    const size_t pixels = picture_pixels(picture);
    for (int i = 0; i < ARRAY_COUNT; i++) {
        if (!(wanted & aovs[i].bit))
            continue;
        void *values = gpu_alloc(gpu, pixels, aovs[i].bytes, "make a picture of this size");
        if (!values) {
            krs_picture_free(picture);
            return NULL;
        }
        aov_set(picture, i, values);
        picture->stats.peak_memory_bytes += pixels * aovs[i].bytes;
    }
    return picture;
}

uint32_t picture_rows(const KrsPicture *picture)
{
    uint32_t rows = 1u << ROW_COLORS;
    for (int i = 0; i < ARRAY_COUNT; i++)
        if (aov_get(picture, i))
            rows |= 1u << aovs[i].row;
    return rows;
}

/* Copies one AOV from a row of results.  Some AOVs are no floats, so bytes are copied.  Where
   the AOV is the whole row one copy is enough.  Where the size is a constant the compiler needs
   no call. */
static void take_aov(void *aov, const float *from, size_t first, size_t count, size_t bytes)
{
    enum { NUMBER = 4, VECTOR = 12 };
    char *to = (char *)aov + first * bytes;
    if (bytes == RESULT_BYTES) {
        memcpy(to, from, count * RESULT_BYTES);
        return;
    }
    assert(bytes == NUMBER || bytes == VECTOR);
    for (size_t k = 0; k < count && bytes == NUMBER; k++)
        memcpy(to + k * NUMBER, from + k * RESULT_NUMBERS, NUMBER);
    for (size_t k = 0; k < count && bytes == VECTOR; k++)
        memcpy(to + k * VECTOR, from + k * RESULT_NUMBERS, VECTOR);
}

void picture_take(KrsPicture *picture, uint32_t wanted, const float *results, size_t row_pixels,
                  size_t first, size_t count)
{
    const size_t row = row_pixels * RESULT_NUMBERS;
    for (int i = 0; i < ARRAY_COUNT; i++) {
        void *aov = wanted & aovs[i].bit ? aov_get(picture, i) : NULL;
        if (aov)
            take_aov(aov, results + aovs[i].row * row + aovs[i].number, first, count,
                     aovs[i].bytes);
    }
}

static bool copy_mattes(Gpu *gpu, const KrsPicture *from, KrsPicture *to)
{
    const size_t bytes = picture_pixels(from) * KRS_MATTE_RANKS * sizeof(KrsMatte);
    if (!from->mattes[0])
        return true;
    if (!mattes_new(gpu, to))
        return false;
    for (int kind = 0; kind < KRS_MATTE_COUNT; kind++)
        memcpy(to->mattes[kind], from->mattes[kind], bytes);
    return true;
}

KrsPicture *picture_copy(Gpu *gpu, const KrsPicture *picture, uint32_t wanted)
{
    KrsPicture *copy = picture_new(gpu, picture->width, picture->height, picture->window, wanted);
    if (!copy)
        return NULL;
    memcpy(copy->world_to_camera, picture->world_to_camera, sizeof copy->world_to_camera);
    memcpy(copy->world_to_ndc, picture->world_to_ndc, sizeof copy->world_to_ndc);
    if (!copy_mattes(gpu, picture, copy)) {
        krs_picture_free(copy);
        return NULL;
    }
    const uint64_t own_bytes = copy->stats.peak_memory_bytes;
    copy->stats              = picture->stats;
    copy->stats.peak_memory_bytes += own_bytes;
    for (int i = 0; i < ARRAY_COUNT; i++)
        if (aov_get(copy, i))
            memcpy(aov_get(copy, i), aov_get(picture, i), picture_pixels(copy) * aovs[i].bytes);
    return copy;
}

void picture_drop(KrsPicture *picture, uint32_t unwanted)
{
    for (int i = 0; i < ARRAY_COUNT; i++)
        if (unwanted & aovs[i].bit) {
            allocator_release(&picture->allocator, aov_get(picture, i));
            aov_set(picture, i, NULL);
        }
}

void picture_divide(KrsPicture *picture, const uint32_t *ended, uint32_t samples)
{
    const size_t count = picture->color ? picture_pixels(picture) : 0;
    for (size_t k = 0; samples > 1 && k < count; k++) {
        const float by = (float)(ended && ended[k] > 0 ? ended[k] : samples);
        for (int i = 0; i < 4; i++)
            picture->color[4 * k + (size_t)i] /= by;
    }
}

void picture_compose(KrsPicture *picture, const float *depth, const float (*plate)[4])
{
    const KrsWindow *window = &picture->window;
    for (size_t k = 0; k < picture_pixels(picture); k++) {
        size_t x = window->x + k % window->width, y = window->y + k / window->width;
        size_t whole = y * picture->width + x;
        float *color = picture->color ? &picture->color[4 * k] : NULL;
        float  left  = color ? 1 - color[3] : 0;
        for (int i = 0; plate && color && i < 4; i++) {
            const float caught   = picture->caught && i < 3 ? picture->caught[k][i] : 1;
            const float mirrored = picture->mirrored && i < 3 ? picture->mirrored[k][i] : 0;
            color[i] += fmaxf(left * caught * plate[whole][i] + mirrored, 0);
        }
        if (depth && picture->depth && isinf(picture->depth[k]))
            picture->depth[k] = depth[whole];
    }
}

/* ---- two pictures as one ---- */

static bool is_whole(const KrsPicture *picture)
{
    return picture->window.width == picture->width && picture->window.height == picture->height;
}

static bool can_join(const KrsPicture *a, const KrsPicture *b)
{
    bool same = is_whole(a) && is_whole(b) && a->width == b->width && a->height == b->height &&
                a->samples == b->samples && !a->mattes[0] == !b->mattes[0] && !a->lights &&
                !b->lights && !a->caught && !b->caught;
    for (int i = 0; i < ARRAY_COUNT; i++)
        same = same && !aov_get(a, i) == !aov_get(b, i);
    return same;
}

static KrsRenderStats sum_of(const KrsRenderStats *a, const KrsRenderStats *b)
{
    KrsRenderStats sum = *a;
    for (int phase = 0; phase < KRS_PHASE_COUNT; phase++)
        sum.phase_ms[phase] += b->phase_ms[phase];
    sum.total_ms += b->total_ms;
    sum.wall_ms += b->wall_ms;
    sum.rays += b->rays;
    sum.evaluations += b->evaluations;
    sum.evaluations_per_ray = (double)sum.evaluations / (double)sum.rays;
    sum.unresolved += b->unresolved;
    sum.clamped += b->clamped;
    sum.submissions += b->submissions;
    if (b->max_evaluations_per_ray > sum.max_evaluations_per_ray)
        sum.max_evaluations_per_ray = b->max_evaluations_per_ray;
    if (b->peak_memory_bytes > sum.peak_memory_bytes)
        sum.peak_memory_bytes = b->peak_memory_bytes;
    if (b->executor != sum.executor)
        sum.executor = KRS_EXECUTOR_DEFAULT;
    sum.gflops = 0.5 * (a->gflops + b->gflops);
    return sum;
}

/* Copies an array, row by row, to where a picture begins in the joined one; NULL: there is none. */
static void place_rows(const KrsPicture *from, const char *rows, KrsPicture *to, char *start,
                       size_t bytes, size_t column, size_t row)
{
    for (size_t y = 0; rows && y < from->height; y++)
        memcpy(start + ((row + y) * to->width + column) * bytes, rows + y * from->width * bytes,
               from->width * bytes);
}

/* Copies all that a picture has to a place in the joined one. */
static void place_picture(const KrsPicture *from, KrsPicture *to, size_t column, size_t row)
{
    for (int i = 0; i < ARRAY_COUNT; i++)
        place_rows(from, aov_get(from, i), to, aov_get(to, i), aovs[i].bytes, column, row);
    for (int kind = 0; kind < KRS_MATTE_COUNT; kind++)
        place_rows(from, (const char *)from->mattes[kind], to, (char *)to->mattes[kind],
                   KRS_MATTE_RANKS * sizeof(KrsMatte), column, row);
}

KrsStatus krs_picture_join(const KrsPicture *first, const KrsPicture *second, bool below,
                           KrsPicture **joined)
{
    Gpu      allocating = {.allocator = first->allocator};
    uint32_t wanted = 0, width = first->width * (below ? 1 : 2);
    uint32_t height = first->height * (below ? 2 : 1);
    *joined         = NULL;
    if (!can_join(first, second))
        return KRS_BAD_ARGUMENT;
    for (int i = 0; i < ARRAY_COUNT; i++)
        wanted |= aov_get(first, i) ? aovs[i].bit : 0;
    *joined = picture_new(&allocating, width, height, (KrsWindow){0, 0, width, height}, wanted);
    if (*joined && first->mattes[0] && !mattes_new(&allocating, *joined)) {
        krs_picture_free(*joined);
        *joined = NULL;
    }
    if (!*joined)
        return KRS_OUT_OF_MEMORY;
    (*joined)->samples = first->samples;
    place_picture(first, *joined, 0, 0);
    place_picture(second, *joined, below ? 0 : first->width, below ? first->height : 0);
    for (int i = 0; i < 4; i++)
        (*joined)->world_to_camera[i][i] = (*joined)->world_to_ndc[i][i] = 1;
    (*joined)->stats = sum_of(&first->stats, &second->stats);
    return KRS_OK;
}

void krs_picture_free(KrsPicture *picture)
{
    if (!picture)
        return;
    const KrsAllocator allocator = picture->allocator;
    for (int i = 0; i < ARRAY_COUNT; i++)
        allocator_release(&allocator, aov_get(picture, i));
    for (int kind = 0; kind < KRS_MATTE_COUNT; kind++)
        allocator_release(&allocator, picture->mattes[kind]);
    allocator_release(&allocator, picture->lights);
    allocator_release(&allocator, picture->caught);
    allocator_release(&allocator, picture->mirrored);
    allocator_release(&allocator, picture);
}
