/*
 * plate_map.c: the map by which rays of paths meet the plate of another renderer
 * (shaders/plate_rays.glsl).
 *
 * How near a surface is, is told by a number that is linear in the picture on every plane: 1 / depth in
 * perspective, and the depth with its sign changed in parallel projection.  Neighbours belong to the same
 * surface where it differs as little between them as beside them, or less than a steep surface would.
 */
#include "runtime/film/plate_map.h"

#include <math.h>
#include <string.h>

/* The nearness where there is no surface: all rays are before it. */
#define NOWHERE (-1e30f)
/* The difference of neighbours, relative to those beside them, or to pixels, up to which they are of the
   same surface. */
#define MAX_BEND   2
#define STEEP_RISE 2

bool plate_map_exists(const Job *job)
{
    const KrsRenderOptions *o = &job->options;
    return o->catcher != KRS_CATCHER_NONE && o->plate && o->depth && !job->rays &&
           job->view.camera.projection != KRS_PANORAMA;
}

static size_t blocks_across(uint32_t pixels) { return (pixels + PLATE_BLOCK - 1) / PLATE_BLOCK; }

size_t plate_map_rows(const Job *job)
{
    const KrsRenderOptions *o = &job->options;
    return (size_t)o->width * o->height + blocks_across(o->width) * blocks_across(o->height);
}

typedef struct Map {
    const Job *job;
    size_t     width, height;
    bool       perspective;
    uint32_t (*rows)[4];
} Map;

static float nearness_of(const Map *map, size_t x, size_t y)
{
    const float depth = map->job->options.depth[y * map->width + x];
    if (!(depth > 0) || isinf(depth))
        return NOWHERE;
    return map->perspective ? 1 / depth : -depth;
}

/* Tells how much the nearness of a surface changes from pixel to pixel that rises by one of its widths. */
static float change_of_pixel(const Map *map, float nearness)
{
    const FrameBlock *frame = &map->job->frame;
    return map->perspective ? frame->pixel_slope * nearness : frame->pixel_base;
}

/* Returns the change from one number to the next; 0 where one is of no surface. */
static float change_of(float from, float to)
{
    return from == NOWHERE || to == NOWHERE ? 0 : fabsf(to - from);
}

/* Tells whether the middle two of four pixels in a row belong to the same surface. */
static bool are_joined(const Map *map, const float row[4])
{
    if (row[1] == NOWHERE || row[2] == NOWHERE)
        return false;
    const float beside = fmaxf(change_of(row[0], row[1]), change_of(row[2], row[3]));
    const float steep  = change_of_pixel(map, fmaxf(row[1], row[2]));
    return change_of(row[1], row[2]) <= MAX_BEND * beside + STEEP_RISE * steep;
}

/* Returns the nearness of a neighbour; pixels beyond the picture have no surface. */
static float nearness_beside(const Map *map, size_t x, size_t y)
{
    return x < map->width && y < map->height ? nearness_of(map, x, y) : NOWHERE;
}

static uint32_t find_joins(const Map *map, size_t x, size_t y)
{
    float across[4], down[4];
    for (size_t i = 0; i < 4; i++) { /* what is left of the first wraps round */
        across[i] = nearness_beside(map, x + i - 1, y);
        down[i]   = nearness_beside(map, x, y + i - 1);
    }
    return (are_joined(map, across) ? PLATE_JOINS_RIGHT : 0u) |
           (are_joined(map, down) ? PLATE_JOINS_BELOW : 0u);
}

static void put_pixel(const Map *map, size_t x, size_t y)
{
    const size_t k        = y * map->width + x;
    const float  nearness = nearness_of(map, x, y);
    uint32_t     bits;
    memcpy(map->rows[k], map->job->options.plate[k], 3 * sizeof(float));
    memcpy(&bits, &nearness, sizeof bits);
    map->rows[k][3] = (bits & ~(PLATE_JOINS_RIGHT | PLATE_JOINS_BELOW)) | find_joins(map, x, y);
}

/* Returns the nearest pixel of a block, or of those around it, which a ray reads that has just left
   it. */
static float nearest_of_block(const Map *map, size_t left, size_t top)
{
    const size_t from_x = left > 0 ? left - 1 : 0, from_y = top > 0 ? top - 1 : 0;
    float        nearest = NOWHERE;
    for (size_t y = from_y; y <= top + PLATE_BLOCK + 1 && y < map->height; y++)
        for (size_t x = from_x; x <= left + PLATE_BLOCK + 1 && x < map->width; x++)
            nearest = fmaxf(nearest, nearness_of(map, x, y));
    return nearest;
}

void plate_map_make(const Job *job, uint32_t (*rows)[4])
{
    const Map map       = {job, job->options.width, job->options.height,
                           job->view.camera.projection == KRS_PERSPECTIVE, rows};
    uint32_t(*block)[4] = rows + map.width * map.height;
    for (size_t y = 0; y < map.height; y++)
        for (size_t x = 0; x < map.width; x++)
            put_pixel(&map, x, y);
    for (size_t y = 0; y < map.height; y += PLATE_BLOCK)
        for (size_t x = 0; x < map.width; x += PLATE_BLOCK, block++) {
            const float nearest = nearest_of_block(&map, x, y);
            memset(*block, 0, sizeof *block);
            memcpy(*block, &nearest, sizeof nearest);
        }
}
