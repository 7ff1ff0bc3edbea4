/*
 * sky_table.c: what shaders read of a sky that is a picture (blocks.h).
 *
 * Between the middles of texels radiance is bilinear.  So directions are chosen by cells whose corners
 * these middles are: in each the mean luminance is that of its corners.
 */
#include "runtime/tracer/sky_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "runtime/tracer/layouts.h"

#define TABLE "table of the sky"

/* A picture of all directions: rows of red, green, blue and more. */
typedef struct Directions {
    uint32_t width, height;
    float (*rows)[4];
} Directions;

static size_t count_of(const Directions *of) { return (size_t)of->width * of->height; }

static float *texel_of(const Directions *of, uint32_t x, uint32_t y)
{
    return of->rows[(size_t)y * of->width + x];
}

/* Returns the solid angle of a texel of a row. */
static double texel_angle(const Directions *of, uint32_t y)
{
    return 2 * M_PI / of->width * (cos(M_PI * y / of->height) - cos(M_PI * (y + 1) / of->height));
}

/* ---- The sky itself, and sums to choose by ---- */

static double luminance(const float color[3])
{
    return 0.2126 * (double)color[0] + 0.7152 * (double)color[1] + 0.0722 * (double)color[2];
}

/* Returns the mean between line - 1 and `line` of the texels, and between column - 1 and
   `column`. */
static double mean_of_cell(const Directions *sky, uint32_t column, uint32_t line)
{
    const uint32_t left  = column > 0 ? column - 1 : sky->width - 1;
    const uint32_t above = line > 0 ? line - 1 : 0;
    const uint32_t below = line < sky->height ? line : sky->height - 1;
    return 0.25 * (luminance(texel_of(sky, left, above)) + luminance(texel_of(sky, column, above)) +
                   luminance(texel_of(sky, left, below)) + luminance(texel_of(sky, column, below)));
}

/* Returns the solid angle of a cell. */
static double cell_angle(const Directions *of, uint32_t line)
{
    const double from = fmax(line - 0.5, 0), to = fmin(line + 0.5, of->height);
    return 2 * M_PI / of->width * (cos(M_PI * from / of->height) - cos(M_PI * to / of->height));
}

/* Sets the weight of each cell.  Returns the sum of all. */
static double weigh(const Directions *sky, double *weights)
{
    double sum = 0;
    for (uint32_t line = 0; line <= sky->height; line++)
        for (uint32_t column = 0; column < sky->width; column++) {
            double *weight = &weights[(size_t)line * sky->width + column];
            *weight        = mean_of_cell(sky, column, line) * cell_angle(sky, line);
            sum += *weight;
        }
    return sum;
}

/* Tells how many cells of a side there are in a width. */
static uint32_t cells_in(uint32_t width, uint32_t side) { return (width + side - 1) / side; }

static uint32_t coarsest_side(uint32_t width, uint32_t height)
{
    uint32_t side = 1;
    while (side < width || side < height)
        side *= 2;
    return side;
}

static size_t sums_before(uint32_t width, uint32_t height, uint32_t side)
{
    size_t rows = 0;
    for (uint32_t s = coarsest_side(width, height); s > side; s /= 2)
        rows += (size_t)cells_in(width, s) * cells_in(height, s);
    return rows;
}

/* Sums four weights to a row of sums and their sum, which replaces them: it is not needed yet where
   it is stored. */
static void add_up(uint32_t width, uint32_t height, double *weights, float (*sums)[4])
{
    const uint32_t across = cells_in(width, 2), down = cells_in(height, 2);
    for (uint32_t y = 0; y < down; y++)
        for (uint32_t x = 0; x < across; x++) {
            double sum = 0;
            for (uint32_t k = 0; k < 4; k++) {
                const uint32_t column = 2 * x + k % 2, line = 2 * y + k / 2;
                const bool     inside = column < width && line < height;
                const double   weight = inside ? weights[(size_t)line * width + column] : 0;
                sums[(size_t)y * across + x][k] = (float)weight;
                sum += weight;
            }
            weights[(size_t)y * across + x] = sum;
        }
}

static void make_sums(uint32_t width, uint32_t height, double *weights, float (*rows)[4])
{
    const uint32_t coarsest = coarsest_side(width, height);
    for (uint32_t side = 2; side <= coarsest; side *= 2)
        add_up(cells_in(width, side / 2), cells_in(height, side / 2), weights,
               rows + sums_before(width, height, side));
}

/* ---- Means of the sky ---- */

/* Interpolates bilinearly between the middles of texels, at a place in texels. */
static void read_between(const Directions *from, double x, double y, double color[3])
{
    const double   left = floor(x - 0.5), top = floor(y - 0.5);
    const double   across = x - 0.5 - left, down = y - 0.5 - top;
    const uint32_t w = from->width, last = from->height - 1;
    const uint32_t columns[2] = {(uint32_t)(left + w) % w, (uint32_t)(left + w + 1) % w};
    const uint32_t lines[2]   = {top < 0 ? 0 : (uint32_t)top,
                               (uint32_t)(top + 1) > last ? last : (uint32_t)(top + 1)};
    for (int k = 0; k < 3; k++) {
        color[k] = 0;
        for (int i = 0; i < 4; i++)
            color[k] += (i % 2 ? across : 1 - across) * (i / 2 ? down : 1 - down) *
                        (double)texel_of(from, columns[i % 2], lines[i / 2])[k];
    }
}

/* Copies a sky to other texels, each a mean over some points in it. */
static void resample(const Directions *from, const Directions *to)
{
    const uint32_t across = cells_in(from->width, to->width);
    const uint32_t down   = cells_in(from->height, to->height);
    for (size_t i = 0; i < count_of(to); i++) {
        double sum[3] = {0}, color[3];
        for (uint32_t k = 0; k < across * down; k++) {
            const double x = (double)(i % to->width) + (k % across + 0.5) / across;
            const double y = (double)(i / to->width) + (k / across + 0.5) / down;
            read_between(from, x * from->width / to->width, y * from->height / to->height, color);
            for (int c = 0; c < 3; c++)
                sum[c] += color[c] / (across * down);
        }
        for (int c = 0; c < 3; c++)
            to->rows[i][c] = (float)sum[c];
        to->rows[i][3] = 0;
    }
}

/* Tells how much light counts from an angle.  Around a normal (roughness below 0) it is the cosine, else what
   microfacets mirror that are seen along the normal: GGX's lobe at half the angle. */
static double lobe(double cosine, double roughness)
{
    const double width = roughness * roughness, square = width * width;
    const double half = 0.5 * (1 + cosine), spread = half * (square - 1) + 1;
    if (cosine <= 0)
        return 0;
    return roughness < 0 ? cosine : cosine / (spread * spread);
}

#define MIN_OF_LOBE 1e-5 /* of its peak: less is left out */

/* Finds the weights of the texels of all rows, by their distance in columns, as seen from the
   middle of a texel of row `at`. */
static void find_lobe(const Directions *of, uint32_t at, double roughness, double *weights)
{
    const double latitude = M_PI * (at + 0.5) / of->height;
    double       sum      = 0;
    for (uint32_t y = 0; y < of->height; y++)
        for (uint32_t x = 0; x < of->width; x++) {
            const double other  = M_PI * (y + 0.5) / of->height;
            const double cosine = cos(latitude) * cos(other) +
                                  sin(latitude) * sin(other) * cos(2 * M_PI * x / of->width);
            double *weight = &weights[(size_t)y * of->width + x];
            *weight        = lobe(fmin(cosine, 1), roughness);
            *weight = *weight > MIN_OF_LOBE * lobe(1, roughness) ? *weight * texel_angle(of, y) : 0;
            sum += *weight;
        }
    for (size_t i = 0; i < count_of(of); i++)
        weights[i] /= sum;
}

/* Blurs one texel of `to`, by the weights of its row. */
static void blur_texel(const Directions *from, uint32_t at, const double *weights, float color[4])
{
    const uint32_t w      = from->width;
    double         sum[3] = {0};
    for (size_t i = 0; i < count_of(from); i++) {
        if (weights[i] == 0)
            continue;
        const float *texel = from->rows[i - i % w + (i % w + at) % w];
        for (int k = 0; k < 3; k++)
            sum[k] += weights[i] * (double)texel[k];
    }
    for (int k = 0; k < 4; k++)
        color[k] = k < 3 ? (float)sum[k] : 0;
}

/* Blurs directions; both have the same size. */
static void blur(const Directions *from, const Directions *to, double roughness, double *weights)
{
    for (uint32_t y = 0; y < to->height; y++) {
        find_lobe(from, y, roughness, weights);
        for (uint32_t x = 0; x < to->width; x++)
            blur_texel(from, x, weights, texel_of(to, x, y));
    }
}

static Directions directions_at(float (*rows)[4], uint32_t first, uint32_t width)
{
    return (Directions){width, width / 2, rows + first};
}

/* Room for a sky of SKY_SMOOTH_WIDTH, and for as many weights. */
typedef struct Workroom {
    float (*rows)[4];
    double *weights;
} Workroom;

static void make_means(const Directions *sky, float (*rows)[4], const Workroom *room)
{
    const uint32_t   level    = SKY_ROUGH_WIDTH * SKY_ROUGH_WIDTH / 2;
    const Directions smoother = directions_at(rows, SKY_SMOOTHER, SKY_SMOOTHER_WIDTH);
    const Directions smooth   = directions_at(rows, SKY_SMOOTH, SKY_SMOOTH_WIDTH);
    const Directions around   = directions_at(rows, 0, SKY_AROUND_WIDTH);
    Directions       coarse   = directions_at(room->rows, 0, SKY_SMOOTH_WIDTH);
    resample(sky, &smoother);
    resample(&smoother, &coarse);
    blur(&coarse, &smooth, 0.2, room->weights);
    coarse = directions_at(room->rows, 0, SKY_ROUGH_WIDTH);
    resample(&smoother, &coarse);
    for (uint32_t i = 0; i < SKY_ROUGH_LEVELS; i++) {
        const Directions to = directions_at(rows, SKY_ROUGH + i * level, SKY_ROUGH_WIDTH);
        blur(&coarse, &to, 1 - 0.2 * i, room->weights);
    }
    coarse = directions_at(room->rows, 0, SKY_AROUND_WIDTH);
    resample(&smoother, &coarse);
    blur(&coarse, &around, -1, room->weights);
}

/* ---- The table ---- */

size_t sky_table_rows(const KrsSkyMap *map)
{
    return SKY_ITSELF + (size_t)map->width * map->height +
           sums_before(map->width, map->height + 1, 1);
}

double sky_table_fill(const KrsSkyMap *map, float (*rows)[4])
{
    const Directions sky    = {map->width, map->height, rows + SKY_ITSELF};
    const size_t     coarse = SKY_SMOOTH_WIDTH * SKY_SMOOTH_WIDTH / 2, count = count_of(&sky);
    const Workroom   room    = {calloc(coarse, sizeof *rows), calloc(coarse, sizeof(double))};
    double          *weights = calloc(count + map->width, sizeof *weights);
    double           sum     = -4;
    if (room.rows && room.weights && weights) {
        for (size_t i = 0; i < count; i++) {
            memcpy(sky.rows[i], map->texels[i], sizeof map->texels[i]);
            sky.rows[i][3] = 0;
        }
        sum = weigh(&sky, weights);
        make_sums(map->width, map->height + 1, weights, sky.rows + count);
        make_means(&sky, rows, &room);
    }
    free(room.rows);
    free(room.weights);
    free(weights);
    return sum / 4;
}

static bool refuse(Gpu *gpu)
{
    gpu_refuse(gpu, KRS_OUT_OF_MEMORY, "there is no memory for the " TABLE);
    return false;
}

/* Makes room on the device for so many bytes. */
static bool make_room(KrsRendering *rendering, uint64_t bytes)
{
    Gpu             *gpu    = &rendering->renderer->gpu;
    const GpuLimits *limits = &gpu->limits;
    const uint64_t   row    = sizeof(float[4]);
    const uint64_t   most   = gpu->texels ? limits->texels * row : limits->storage_bytes;
    if (bytes > most) {
        gpu_refuse(gpu, KRS_NO_DEVICE,
                   "the device has no room for the " TABLE ": it has %llu bytes of %llu",
                   (unsigned long long)bytes, (unsigned long long)most);
        return false;
    }
    if (rendering->sky_table.size >= bytes)
        return true;
    if (!gpu_wait(gpu)) /* shaders may still be prewarming, with the table that is bound */
        return false;
    buffer_destroy(gpu, &rendering->sky_table);
    if (!buffer_create(gpu, &rendering->sky_table, bytes, ON_DEVICE, TABLE) ||
        !layouts_view_table(gpu, SKY_TABLE_BINDING, &rendering->sky_table, TABLE))
        return false;
    sky_table_bind(rendering);
    return true;
}

/* Fills a buffer of the host's and copies it. */
static bool fill_and_copy(KrsRendering *rendering, const KrsSkyMap *map, Buffer *staged)
{
    Gpu   *gpu                = &rendering->renderer->gpu;
    double ms                 = 0;
    rendering->sky_irradiance = sky_table_fill(map, staged->bytes);
    if (rendering->sky_irradiance < 0)
        return refuse(gpu);
    if (!gpu_begin(gpu))
        return false;
    gpu_copy(gpu, staged, 0, &rendering->sky_table, 0, staged->size);
    return gpu_finish(gpu, &ms);
}

bool sky_table_upload(KrsRendering *rendering, const KrsSkyMap *map)
{
    Gpu   *gpu    = &rendering->renderer->gpu;
    Buffer staged = {0};
    if (!map || (rendering->sky_table.buffer && rendering->sky_version == map->version))
        return true;
    const uint64_t bytes = buffer_texel_bytes(sky_table_rows(map) * sizeof(float[4]));
    bool done = make_room(rendering, bytes) && buffer_create(gpu, &staged, bytes, SHARED, TABLE) &&
                fill_and_copy(rendering, map, &staged);
    buffer_destroy(gpu, &staged);
    rendering->sky_version = done ? map->version : 0;
    return done;
}

void sky_table_bind(KrsRendering *rendering)
{
    const KrsRenderer *renderer = rendering->renderer;
    const Buffer      *table    = rendering->sky_table.buffer
                                      ? &rendering->sky_table
                                      : layouts_idle_table(renderer, SKY_TABLE_BINDING);
    layouts_bind_scene(&rendering->renderer->gpu, rendering->scene_set, SKY_TABLE_BINDING, table);
}

double sky_table_irradiance(const KrsRendering *rendering) { return rendering->sky_irradiance; }
