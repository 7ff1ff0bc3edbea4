/*
 * photons.c: photons are sent from lights, sorted into cells by where they end, and put among the inputs.
 *
 * Each light has a square whose points are rays: of the sun those through a square across its direction, of a lamp its
 * directions.  Photons of a first pass fill all squares evenly.  Where these come to light something, the photons of
 * samples go more often, and each has less of the light (Jensen 1995, with maps of cells).  The rest of them stay
 * spread evenly, so nothing is left out.
 *
 * The radius of the blur shrinks from sample to sample, so that the mean of all comes to what is right, both noise and
 * blur (Knaus and Zwicker 2011).  It depends on the number of the sample alone.
 */
#include "runtime/integrators/photons.h"

#include <math.h>
#include <string.h>

#include "runtime/tracer/layouts.h"
#include "runtime/tracer/renderer.h"
#include "runtime/tracer/rendering.h"
#include "runtime/tracer/shaders.h"

enum {
    SIDE         = 64, /* cells in a row of a square */
    SQUARE_CELLS = SIDE * SIDE,
    IN_SLICE     = 8192 /* photons of a dispatch */
};
/* Stands for the number of a sample. */
#define FIRST_PASS UINT32_MAX
/* The part of photons that are spread evenly. */
#define EVEN 0.1
/* Photons within the first radius, where light is spread over all of the region and is not gathered. */
#define WITHIN_RADIUS 16.0
/* The part of new photons that a radius keeps (Hachisuka et al. 2008). */
#define KEPT 0.7
/* The radius of the region that suns shine on, in distances of the target from the eye, where it has no end. */
#define REACH 4.0

typedef struct PhotonMap {
    Shader  *shader;
    uint32_t lights;
    double   middle[3], radius; /* of the region, relative to the rebase origin */
    double   lit; /* radius of a disc as large as what photons start from that end somewhere */
    bool     learned, idle; /* idle: no photon of the first pass has come to light something */
    double  *chances; /* of cells of squares, light by light; before that what they have brought */
    uint32_t starts[PHOTON_BUCKETS + 1], filled[PHOTON_BUCKETS];
    float    from[PHOTONS][PHOTON_ROWS][4]; /* as they have ended */
} PhotonMap;

static uint32_t hash_bits(uint32_t bits) /* as in samples.glsl */
{
    bits = bits * 747796405U + 2891336453U;
    bits = (bits >> ((bits >> 28) + 4) ^ bits) * 277803737U;
    return bits >> 22 ^ bits;
}

static double length_of(const double v[3]) { return hypot(hypot(v[0], v[1]), v[2]); }

/* ---- the region ---- */

static void find_region(const Job *job, PhotonMap *map)
{
    const KrsProgram *program = job->rendering->program;
    const KrsCamera  *camera  = &job->view.camera;
    double            low[3], high[3], half[3], way[3];
    bool              ends = !program->planes;
    job_find_rest(job, low, high);
    for (int k = 0; k < 3; k++) {
        ends    = ends && isfinite(low[k]) && isfinite(high[k]) && high[k] >= low[k];
        half[k] = 0.5 * (high[k] - low[k]);
        way[k]  = camera->target[k] - camera->eye[k];
    }
    for (int k = 0; k < 3; k++)
        map->middle[k] = ends ? low[k] + half[k] : camera->target[k] - job->rebase_origin[k];
    map->radius = 1.001 * (ends ? length_of(half) : REACH * length_of(way));
}

/* ---- rays of photons ---- */

typedef struct Chances {
    uint32_t state;
} Chances;

static double find_chance(Chances *chances)
{
    chances->state += 0x9e3779b9U;
    return (hash_bits(chances->state) + 0.5) / 4294967296.0;
}

static void find_frame(const double axis[3], double right[3], double up[3])
{
    const double side = axis[2] < 0 ? -1 : 1, a = -1 / (side + axis[2]), b = axis[0] * axis[1] * a;
    right[0] = 1 + side * axis[0] * axis[0] * a, right[1] = side * b, right[2] = -side * axis[0];
    up[0] = b, up[1] = side + axis[1] * axis[1] * a, up[2] = -axis[1];
}

/* Finds a ray of the sun: its direction is one to its disc, and it begins before the region.  Returns the area that the
   square stands for, weighted as the light across it is. */
static double find_ray_of_sun(const PhotonMap *map, const KrsLight *light, const double at[2],
                              Chances *chances, double origin[3], double direction[3])
{
    const double sine = sin(0.5 * fmin(fmax(light->softness, 0), 3));
    const double all = sine * sine / (1 + sqrt(1 - sine * sine)), gap = all * find_chance(chances);
    const double ring = sqrt(gap * (2 - gap)), angle = 2 * M_PI * find_chance(chances);
    double       right[3], up[3];
    find_frame(light->vector, right, up);
    for (int k = 0; k < 3; k++) {
        const double toward = ring * (cos(angle) * right[k] + sin(angle) * up[k]) +
                              (1 - gap) * light->vector[k];
        direction[k] = -toward;
        origin[k]    = map->middle[k] + map->radius * ((2 * at[0] - 1) * right[k] +
                                                    (2 * at[1] - 1) * up[k] + 2 * toward);
    }
    return 4 * map->radius * map->radius * (1 - gap) * 2 / (2 - all);
}

/* Finds a ray of a lamp: it begins at a point of what its directions see of it, evenly.  Returns the solid angle that
   the square stands for: that of the region, where the lamp is outside of it. */
static double find_ray_of_lamp(const Job *job, const PhotonMap *map, const KrsLight *light,
                               const double at[2], Chances *chances, double origin[3],
                               double direction[3])
{
    double axis[3], right[3], up[3], x = find_chance(chances), y = find_chance(chances);
    for (int k = 0; k < 3; k++) {
        origin[k] = light->vector[k] - job->rebase_origin[k];
        axis[k]   = map->middle[k] - origin[k];
    }
    const double far = length_of(axis), size = map->radius + fmax(light->softness, 0);
    const double sine = far > size ? size / far : 1;
    const double all  = far > size ? sine * sine / (1 + sqrt(1 - sine * sine)) : 2;
    const double gap = all * at[1], ring = sqrt(gap * (2 - gap)), angle = 2 * M_PI * at[0];
    for (int k = 0; k < 3; k++)
        axis[k] = far > 0 ? axis[k] / far : k == 1;
    find_frame(axis, right, up);
    for (int k = 0; k < 3; k++)
        direction[k] = ring * (cos(angle) * right[k] + sin(angle) * up[k]) + (1 - gap) * axis[k];
    if (light->type != 0) {
        for (int k = 0; k < 3; k++)
            origin[k] += (x - 0.5) * light->size[0] * light->right[k] +
                         (y - 0.5) * light->size[1] * light->up[k];
        return 2 * M_PI * all;
    }
    find_frame(direction, right, up);
    const double radius = fmax(light->softness, 0), beside = radius * sqrt(x);
    for (int k = 0; k < 3; k++)
        origin[k] += beside * (cos(2 * M_PI * y) * right[k] + sin(2 * M_PI * y) * up[k]) +
                     sqrt(fmax(radius * radius - beside * beside, 0)) * direction[k];
    return 2 * M_PI * all;
}

/* Writes the ray of a photon from a cell of the square of a light, to which about so many `photons` go. */
static void write_ray(const Job *job, const PhotonMap *map, uint32_t cell, double photons,
                      Chances *chances, float to[PHOTON_ROWS][4])
{
    const uint32_t  number = cell / SQUARE_CELLS, in_square = cell % SQUARE_CELLS;
    const KrsLight *light = &job->view.lights[number];
    const double    x = find_chance(chances), y = find_chance(chances);
    const double    at[2] = {(in_square % SIDE + x) / SIDE, (in_square / SIDE + y) / SIDE};
    double          origin[3], direction[3];
    const double    whole = light->positional
                                ? find_ray_of_lamp(job, map, light, at, chances, origin, direction)
                                : find_ray_of_sun(map, light, at, chances, origin, direction);
    for (int k = 0; k < 3; k++) {
        to[0][k] = (float)origin[k];
        to[1][k] = (float)direction[k];
    }
    memcpy(&to[0][3], &number, sizeof number);
    to[1][3] = light->shadow ? (float)(whole / SQUARE_CELLS / photons) : 0;
}

/* Writes the rays of all photons; `cells` has the number of the cell of each then. */
static void write_rays(const Job *job, const PhotonMap *map, uint32_t sample, uint32_t *cells)
{
    float(*to)[PHOTON_ROWS][4] = job->rendering->photons.bytes;
    const uint32_t all         = map->lights * SQUARE_CELLS,
                   seed        = (uint32_t)(job->options.seed ^ job->options.seed >> 32);
    Chances  own               = {hash_bits(sample + hash_bits(seed))};
    double   sum               = 0;
    uint32_t cell              = 0;
    for (uint32_t i = 0; i < PHOTONS; i++) {
        Chances      chances = {hash_bits(i + hash_bits(sample + hash_bits(seed + 1)))};
        const double choice  = (i + find_chance(&own)) / PHOTONS;
        while (cell + 1 < all && sum + map->chances[cell] <= choice)
            sum += map->chances[cell++];
        cells[i] = cell;
        write_ray(job, map, cell, map->chances[cell] * PHOTONS, &chances, to[i]);
    }
}

/* ---- tracing ---- */

static bool prepare(Job *job)
{
    KrsRendering *r      = job->rendering;
    Buffer       *buffer = &r->photons;
    if (!buffer->buffer &&
        (!buffer_create(job->gpu, buffer, buffer_texel_bytes(PHOTONS * PHOTON_ROWS * RESULT_BYTES),
                        SHARED, "photons") ||
         !layouts_view_texels(job->gpu, HIT_TEXELS_BINDING, buffer, "photons")))
        return false;
    rendering_bind_frame(r, r->points_set);
    rendering_bind(r, r->points_set, HITS_BINDING, buffer);
    rendering_bind(r, r->points_set, HIT_TEXELS_BINDING, buffer);
    rendering_bind(r, r->points_set, job->gpu->texels ? INPUT_TEXELS_BINDING : INPUT_ROWS_BINDING,
                   &r->inputs);
    return true;
}

/* Follows the photons whose rays are written. */
static bool run(Job *job, PhotonMap *map)
{
    KrsRendering *r         = job->rendering;
    ControlBlock *control   = r->control.bytes;
    WorkBlock     work      = {.groups = PHOTONS / 64, .stride = 1};
    control->items          = PHOTONS;
    control->items_per_lane = 1;
    control->value          = 0;
    for (work.first = 0; work.first < PHOTONS / 64; work.first += IN_SLICE / 64) {
        double ms   = 0;
        work.groups = IN_SLICE / 64;
        if (!rendering_begin(r))
            return false;
        rendering_dispatch(r, map->shader, r->points_set, &work, sizeof work, work.groups);
        if (!rendering_finish(r, &ms))
            return false;
        job->stats->phase_ms[KRS_PHASE_BOUNCES] += ms;
    }
    memcpy(map->from, r->photons.bytes, sizeof map->from);
    return true;
}

static bool has_ended(const PhotonMap *map, uint32_t photon)
{
    const float *power = map->from[photon][1];
    return power[0] > 0 || power[1] > 0 || power[2] > 0;
}

/* ---- where photons go ---- */

static void spread_evenly(PhotonMap *map)
{
    const uint32_t all = map->lights * SQUARE_CELLS;
    for (uint32_t i = 0; i < all; i++)
        map->chances[i] = 1.0 / all;
}

/* Adds what a cell has brought to the cells around it, too: what is beside may light something as well. */
static void add_around(double *sums, uint32_t cell, double brought)
{
    const int at = (int)(cell % SQUARE_CELLS), x = at % SIDE, y = at / SIDE;
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++)
            if (x + dx >= 0 && x + dx < SIDE && y + dy >= 0 && y + dy < SIDE)
                sums[(int)(cell - (uint32_t)at) + at + dy * SIDE + dx] += brought / 9;
}

/* Learns from the photons of the first pass, which came from these cells.  The root of what cells bring evens out what
   few photons tell. */
static bool learn(Job *job, PhotonMap *map, const uint32_t *cells)
{
    const uint32_t all     = map->lights * SQUARE_CELLS;
    double         sum     = 0;
    double        *brought = gpu_alloc(job->gpu, all + 1, sizeof *brought, "follow photons");
    if (!brought)
        return false;
    for (uint32_t i = 0; i < PHOTONS; i++) {
        const float *power = map->from[i][1];
        if (has_ended(map, i))
            add_around(brought, cells[i],
                       0.2126 * (double)power[0] + 0.7152 * (double)power[1] +
                           0.0722 * (double)power[2]);
    }
    uint32_t used = 0;
    for (uint32_t i = 0; i < all; i++) {
        brought[i] = sqrt(brought[i]);
        sum += brought[i];
        used += brought[i] > 0;
    }
    map->idle = sum == 0;
    map->lit  = 2 * map->radius * sqrt((double)used / all / M_PI);
    for (uint32_t i = 0; i < all && !map->idle; i++)
        map->chances[i] = EVEN / all + (1 - EVEN) * brought[i] / sum;
    gpu_release(job->gpu, brought);
    map->learned = true;
    return true;
}

/* ---- among the inputs ---- */

/* Returns the radius of a sample: the product of (i + KEPT) / (i + 1) falls as a power of the number. */
static double radius_of(const PhotonMap *map, uint32_t sample)
{
    return map->lit * sqrt(WITHIN_RADIUS / PHOTONS) *
           exp(0.5 * (lgamma(sample + 1 + KEPT) - lgamma(1 + KEPT) - lgamma(sample + 2)));
}

static uint32_t bucket_of(const float place[3], float cells) /* as in photons.glsl */
{
    const uint32_t x = (uint32_t)(int32_t)floorf(place[0] * cells),
                   y = (uint32_t)(int32_t)floorf(place[1] * cells),
                   z = (uint32_t)(int32_t)floorf(place[2] * cells);
    return hash_bits(x + hash_bits(y + hash_bits(z))) & (PHOTON_BUCKETS - 1);
}

/* Sorts photons by buckets, and each bucket by their numbers. */
static void sort_photons(PhotonMap *map, float radius, uint32_t (*rows)[4])
{
    const float    cells   = 0.5F / radius;
    const uint32_t head[4] = {0, 0, PHOTON_BUCKETS - 1, PHOTONS_AT};
    memset(map->starts, 0, sizeof map->starts);
    memset(map->filled, 0, sizeof map->filled);
    for (uint32_t i = 0; i < PHOTONS; i++)
        if (has_ended(map, i))
            map->starts[bucket_of(map->from[i][0], cells) + 1]++;
    for (uint32_t i = 0; i < PHOTON_BUCKETS; i++)
        map->starts[i + 1] += map->starts[i];
    memcpy(rows[0], head, sizeof head);
    memcpy(&rows[0][0], &radius, sizeof radius);
    memcpy(&rows[0][1], &cells, sizeof cells);
    memcpy(rows[PHOTON_STARTS_AT], map->starts, sizeof map->starts);
    for (uint32_t i = 0; i < PHOTONS; i++) {
        if (!has_ended(map, i))
            continue;
        const uint32_t bucket = bucket_of(map->from[i][0], cells);
        const uint32_t place  = map->starts[bucket] + map->filled[bucket]++;
        memcpy(rows[PHOTONS_AT + PHOTON_ROWS * place], map->from[i], sizeof map->from[i]);
    }
}

static bool trace(Job *job, PhotonMap *map, uint32_t sample)
{
    ControlBlock *control = job->rendering->control.bytes;
    uint32_t     *cells   = gpu_alloc(job->gpu, PHOTONS, sizeof *cells, "follow photons");
    bool          good    = cells && prepare(job);
    if (good && !map->learned) {
        spread_evenly(map);
        control->ray = FIRST_PASS;
        write_rays(job, map, FIRST_PASS, cells);
        good         = run(job, map) && learn(job, map, cells);
        control->ray = sample;
    }
    if (good && !map->idle) {
        write_rays(job, map, sample, cells);
        good = run(job, map);
    }
    gpu_release(job->gpu, cells);
    return good;
}

static bool trace_sample(Job *job, void *own, uint32_t sample)
{
    PhotonMap    *map     = own;
    ControlBlock *control = job->rendering->control.bytes;
    control->photons      = 0;
    if (map->lights == 0 || map->idle)
        return true;
    if (!trace(job, map, sample))
        return false;
    if (!map->idle) {
        sort_photons(map, (float)radius_of(map, sample),
                     (uint32_t(*)[4])job->rendering->inputs.bytes + job->photons_at);
        control->photons = job->photons_at;
    }
    return true;
}

static void free_map(Gpu *gpu, void *own)
{
    PhotonMap *map = own;
    if (map)
        gpu_release(gpu, map->chances);
    gpu_release(gpu, map);
}

Before photons_new(Job *job)
{
    PhotonMap *map = gpu_alloc(job->gpu, 1, sizeof *map, "follow photons");
    if (!map)
        return (Before){0};
    map->lights  = (uint32_t)job->view.light_count;
    map->chances = gpu_alloc(job->gpu, (size_t)map->lights * SQUARE_CELLS + 1, sizeof *map->chances,
                             "follow photons");
    map->shader  = rendering_photons(job->rendering);
    if (map->chances && map->shader) {
        find_region(job, map);
        return (Before){trace_sample, free_map, map};
    }
    free_map(job->gpu, map);
    return (Before){0};
}
