/* grid.c: krs_grid_new checks what is asked for, and krs_grid_visit deals out runs of bricks to
   threads. */
#include "grid/grid.h"

#include <setjmp.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/vec.h"
#include "compiler/scene/points.h"
#include "slice/extent.h"

/* Cells around what is solid where there is no band. */
enum { MARGIN = 3 };
static const double MAX_BAND = 1e6;
/* The default error, in cells. */
static const double USUAL_ERROR = 0.1;
/* The length by which solids may reach beyond the box that is found, as a part of its side
   (narrow_box). */
static const double BEYOND = 0.0021;

/* ---- what is sampled ---- */

/* Finds the box of what is sampled; returns false if it is unbounded. */
static bool find_box(KrsGrid *grid, bool *empty)
{
    const KrsGridOptions *options = &grid->options;
    bool                  endless = false;
    *empty                        = grid->solid.root_count == 0;
    for (int k = 0; k < 3; k++) {
        Range range   = grid->solid.box.axis[k];
        grid->low[k]  = options->within ? max2(range.low, options->low[k]) : range.low;
        grid->high[k] = options->within ? min2(range.high, options->high[k]) : range.high;
        *empty        = *empty || grid->low[k] > grid->high[k];
        endless       = endless || !isfinite(grid->high[k] - grid->low[k]);
    }
    return *empty || !endless;
}

/* Narrows the box, but leaves a little room within the first one; returns false if nothing is
   solid. */
static bool narrow(KrsGrid *grid)
{
    double low[3], high[3];
    memcpy(low, grid->low, sizeof low);
    memcpy(high, grid->high, sizeof high);
    if (!narrow_box(&grid->fields[0], grid->low, grid->high))
        return false;
    for (int k = 0; k < 3; k++) {
        double beyond = BEYOND * (high[k] - low[k]);
        grid->low[k]  = max2(low[k], grid->low[k] - beyond);
        grid->high[k] = min2(high[k], grid->high[k] + beyond);
    }
    return true;
}

/* Finds the samples of the box; returns false if they are too many. */
static bool find_samples(KrsGrid *grid)
{
    const KrsGridOptions *options = &grid->options;
    KrsGridShape         *shape   = &grid->shape;
    double margin = options->fog ? 1 : options->band > 0 ? ceil(options->band) : MARGIN;
    for (int k = 0; k < 3; k++) {
        double first = floor(grid->low[k] / shape->cell) - margin;
        double last  = ceil(grid->high[k] / shape->cell) + margin;
        if (!(fabs(first) < KRS_MAX_CELLS && fabs(last) < KRS_MAX_CELLS &&
              last - first < KRS_MAX_CELLS))
            return false;
        if (options->aligned)
            first = floor(first / BRICK) * BRICK;
        shape->first[k] = (int64_t)first;
        shape->count[k] = (size_t)(last - first) + 1;
        grid->bricks[k] = (shape->count[k] + BRICK - 1) / BRICK;
    }
    return true;
}

/* Tells whether distances are exact outside: the least of such distances is. */
static bool is_exact_outside(const KrsGrid *grid, const KrsState *state)
{
    bool exact = !grid->options.within && state->zone_count == 0 && !grid->solid.zoned;
    for (size_t i = 0; i < state->scene->shown_count && exact; i++)
        if (grid->options.component == 0 || grid->options.component == i + 1)
            exact = state->scene->components[i].exact;
    return exact;
}

static KrsStatus find_mesh(KrsGrid *grid, KrsState *state)
{
    const KrsGridOptions *options = &grid->options;
    KrsMeshOptions        how     = {.component    = options->component,
                                     .within       = options->within,
                                     .memory_limit = options->memory_limit,
                                     .progress     = options->progress,
                                     .user         = options->user};
    memcpy(how.low, options->low, sizeof how.low);
    memcpy(how.high, options->high, sizeof how.high);
    /* The distance to the mesh may be off by half of the error, to either side. */
    how.error        = 0.5 * (options->error > 0 ? options->error : USUAL_ERROR * options->cell);
    KrsStatus status = krs_mesh(state, &how, &grid->mesh);
    if (status != KRS_OK)
        return status;
    grid->shape.error      = 2 * grid->mesh->error;
    grid->shape.unresolved = grid->mesh->unresolved;
    memcpy(grid->shape.unresolved_at, grid->mesh->unresolved_at, sizeof grid->shape.unresolved_at);
    if (grid->mesh->triangle_count == 0) {
        krs_mesh_free(grid->mesh);
        grid->mesh = NULL;
        return KRS_OK;
    }
    bvh_new(&grid->bvh, (const double(*)[3])grid->mesh->vertices,
            (const uint32_t(*)[3])grid->mesh->triangles, grid->mesh->triangle_count, &grid->arena);
    return KRS_OK;
}

static KrsStatus open_fields(KrsGrid *grid, KrsState *state)
{
    KrsStatus status = KRS_OK;
    for (size_t i = 0; i < grid->parts && status == KRS_OK; i++) {
        MeshField *field = &grid->fields[i];
        *field           = (MeshField){.solid = &grid->solid, .cut = grid->options.within};
        memcpy(field->low, grid->low, sizeof field->low);
        memcpy(field->high, grid->high, sizeof field->high);
        status = state_copy_of(state, &field->state);
        if (status != KRS_OK)
            return status;
        state_refresh_points(field->state);
        field_open(field, &grid->arena);
        if (grid->options.materials && !state_lanes(field->state))
            return KRS_OUT_OF_MEMORY;
    }
    return status;
}

static KrsStatus prepare(KrsGrid *grid, KrsState *state)
{
    jmp_buf            exhausted;
    bool               empty;
    volatile KrsStatus status = KRS_OK;
    if (!find_box(grid, &empty))
        return KRS_BAD_ARGUMENT;
    if (empty)
        return KRS_OK;
    grid->memory.exhausted = &exhausted;
    if (setjmp(exhausted) != 0)
        return KRS_OUT_OF_MEMORY;
    status = open_fields(grid, state);
    if (status != KRS_OK)
        return status;
    if (!narrow(grid))
        return KRS_OK;
    if (!find_samples(grid))
        return KRS_BAD_ARGUMENT;
    return grid->options.exact && !grid->options.fog ? find_mesh(grid, state) : KRS_OK;
}

static KrsStatus choose_components(KrsGrid *grid, const KrsScene *scene)
{
    size_t number     = grid->options.component;
    bool  *wanted     = number ? calloc(scene->component_count + 1, sizeof *wanted) : NULL;
    grid->solid.roots = malloc(solid_root_bytes(scene));
    if (!grid->solid.roots || (number && !wanted)) {
        free(wanted);
        return KRS_OUT_OF_MEMORY;
    }
    if (wanted) {
        wanted[scene->lowered[number - 1]] = true;
        grid->chosen                       = (uint32_t)scene->lowered[number - 1] + 1;
    }
    solid_of_components(scene, wanted, &grid->solid);
    free(wanted);
    return KRS_OK;
}

/* Returns the distance beyond which samples have one value, since the surface does not meet their
   cubes, or they are beyond the band. */
static double find_near(const KrsGridOptions *options)
{
    const double half_diagonal = 0.8661;
    if (options->fog)
        return half_diagonal * options->cell;
    return options->band > 0 ? options->band * options->cell : INFINITY;
}

static bool band_is_valid(double band) { return band >= 0 && band <= MAX_BAND; }

static bool options_are_valid(const KrsGridOptions *options, const KrsScene *scene)
{
    return options->cell > 0 && isfinite(options->cell) && band_is_valid(options->band) &&
           options->error >= 0 && isfinite(options->error) &&
           options->component <= scene->shown_count && !scene->program.open_surfaces;
}

static void take_band(KrsGrid *grid)
{
    const KrsGridOptions *options = &grid->options;
    grid->near                    = find_near(options);
    grid->shape.band              = options->fog ? 0 : options->band * options->cell;
}

KrsStatus krs_grid_new(KrsState *state, const KrsGridOptions *options, KrsGrid **result)
{
    const KrsScene *scene = state->scene;
    *result               = NULL;
    if (!options_are_valid(options, scene))
        return KRS_BAD_ARGUMENT;
    KrsGrid *grid = calloc(1, sizeof *grid);
    if (!grid)
        return KRS_OUT_OF_MEMORY;
    grid->options      = *options;
    grid->memory.limit = options->memory_limit ? options->memory_limit : KRS_USUAL_MEMORY;
    grid->arena.memory = &grid->memory;
    grid->parts        = parallel_parts();
    grid->shape.cell   = options->cell;
    take_band(grid);
    KrsStatus status = choose_components(grid, scene);
    if (status == KRS_OK)
        status = prepare(grid, state);
    grid->shape.estimate   = grid->solid.estimate;
    grid->shape.outside    = is_exact_outside(grid, state);
    grid->memory.exhausted = NULL;
    if (status == KRS_OK)
        *result = grid;
    else
        krs_grid_free(grid);
    return status;
}

void krs_grid_free(KrsGrid *grid)
{
    if (!grid)
        return;
    for (size_t i = 0; i < MAX_PARTS; i++)
        state_free(grid->fields[i].state);
    krs_mesh_free(grid->mesh);
    arena_free(&grid->arena);
    free(grid->solid.roots);
    free(grid);
}

KrsStatus krs_grid_set_band(KrsGrid *grid, double band, bool aligned)
{
    if (!band_is_valid(band))
        return KRS_BAD_ARGUMENT;
    grid->options.band    = band;
    grid->options.aligned = aligned;
    take_band(grid);
    return grid->shape.count[0] == 0 || find_samples(grid) ? KRS_OK : KRS_BAD_ARGUMENT;
}

KrsGridShape krs_grid_shape(const KrsGrid *grid) { return grid->shape; }

/* ---- samples ---- */

/* The runs that are made at once: some for each part, with at least so many bricks. */
enum { LONGEST_RUN = 64, RUNS_OF_PART = 4, ENOUGH_BRICKS = 1024, MAX_RUNS = 256 };

/* Runs that are made by all threads: each takes the next. */
typedef struct Runs {
    KrsGrid *grid;
    size_t   first, count;
    bool     count_only;
    Brick   *bricks[MAX_RUNS];
    float   *equal; /* the samples of a brick that is not near */
    float (*black)[3];
    uint32_t     *nothing;
    atomic_size_t next;
    KrsStatus     statuses[MAX_PARTS];
} Runs;

static size_t runs_of_row(const KrsGrid *grid)
{
    return (grid->bricks[0] + LONGEST_RUN - 1) / LONGEST_RUN;
}

static size_t longest_run(const KrsGrid *grid)
{
    return grid->bricks[0] < LONGEST_RUN ? grid->bricks[0] : LONGEST_RUN;
}

/* Returns a run by its number, in the order of x, y and z. */
static BrickRun run_of(const KrsGrid *grid, size_t number)
{
    const size_t each = runs_of_row(grid), x = number % each * LONGEST_RUN, row = number / each;
    const size_t left = grid->bricks[0] - x;
    return (BrickRun){{x, row % grid->bricks[1], row / grid->bricks[1]},
                      left < LONGEST_RUN ? left : LONGEST_RUN};
}

static void fill_some(void *task, size_t part, size_t parts)
{
    Runs      *runs   = task;
    KrsStatus *status = &runs->statuses[part];
    size_t     number;
    (void)parts;
    while (part < runs->grid->parts && *status == KRS_OK &&
           (number = atomic_fetch_add(&runs->next, 1)) < runs->count) {
        BrickRun run = run_of(runs->grid, runs->first + number);
        *status      = fill_run(runs->grid, &runs->grid->fields[part], &run, runs->count_only,
                                runs->bricks[number]);
    }
}

static void make_room(Runs *runs, size_t count)
{
    KrsGrid *grid = runs->grid;
    size_t   each = longest_run(grid);
    runs->equal   = arena_new_array(&grid->arena, float, BRICK_SAMPLES);
    runs->black   = arena_alloc(&grid->arena, BRICK_SAMPLES, sizeof *runs->black);
    runs->nothing = arena_new_array(&grid->arena, uint32_t, BRICK_SAMPLES);
    for (size_t r = 0; r < count; r++) {
        Brick *bricks   = arena_new_array(&grid->arena, Brick, each);
        runs->bricks[r] = bricks;
        for (size_t i = 0; i < each && !runs->count_only; i++) {
            bricks[i].values = arena_new_array(&grid->arena, float, BRICK_SAMPLES);
            if (!grid->options.materials)
                continue;
            bricks[i].colors = arena_alloc(&grid->arena, BRICK_SAMPLES, sizeof *bricks[i].colors);
            bricks[i].materials = arena_new_array(&grid->arena, uint32_t, BRICK_SAMPLES);
        }
    }
}

/* Gives all samples of a brick one value, and no colour. */
static void tell_far(const Runs *runs, const Brick *from, KrsGridBrick *brick)
{
    for (size_t i = 0; i < BRICK_SAMPLES && runs->equal[i] != from->far; i++)
        runs->equal[i] = from->far;
    brick->values    = runs->equal;
    brick->colors    = from->colors ? (const float(*)[3])runs->black : NULL;
    brick->materials = from->materials ? runs->nothing : NULL;
}

static bool give_run(const Runs *runs, size_t number, KrsVisitBrick *visit, void *user)
{
    const BrickRun run = run_of(runs->grid, runs->first + number);
    for (size_t i = 0; i < run.count; i++) {
        const Brick *from  = &runs->bricks[number][i];
        KrsGridBrick brick = {
            {(run.first[0] + i) * BRICK, run.first[1] * BRICK, run.first[2] * BRICK},
            from->near,
            from->values,
            (const float(*)[3])from->colors,
            from->materials};
        if (!from->near && !runs->count_only)
            tell_far(runs, from, &brick);
        if (!visit(user, &brick))
            return false;
    }
    return true;
}

static KrsStatus visit_some(Runs *runs, KrsVisitBrick *visit, void *user)
{
    KrsStatus status = KRS_OK;
    atomic_store(&runs->next, 0);
    run_in_parallel(fill_some, runs);
    for (size_t i = 0; i < runs->grid->parts && status == KRS_OK; i++)
        status = runs->statuses[i];
    for (size_t i = 0; i < runs->count && status == KRS_OK; i++)
        if (!give_run(runs, i, visit, user))
            status = KRS_IO_ERROR;
    return status;
}

static size_t runs_at_once(const KrsGrid *grid)
{
    size_t count = ENOUGH_BRICKS / longest_run(grid);
    if (count < RUNS_OF_PART * grid->parts)
        count = RUNS_OF_PART * grid->parts;
    return count < MAX_RUNS ? count : MAX_RUNS;
}

static KrsStatus visit_all(Runs *runs, KrsVisitBrick *visit, void *user)
{
    const KrsGridOptions *options = &runs->grid->options;
    const size_t all     = runs_of_row(runs->grid) * runs->grid->bricks[1] * runs->grid->bricks[2];
    const size_t at_once = runs_at_once(runs->grid);
    KrsStatus    status  = KRS_OK;
    make_room(runs, all < at_once ? all : at_once);
    for (; runs->first < all && status == KRS_OK; runs->first += runs->count) {
        runs->count = all - runs->first < at_once ? all - runs->first : at_once;
        if (options->progress &&
            !options->progress(options->user, (double)runs->first / (double)all))
            status = KRS_INTERRUPTED;
        else
            status = visit_some(runs, visit, user);
    }
    return status;
}

static KrsStatus visit_bricks(KrsGrid *grid, bool count_only, KrsVisitBrick *visit, void *user)
{
    jmp_buf            exhausted;
    Runs               runs   = {.grid = grid, .count_only = count_only};
    const ArenaMark    mark   = arena_mark(&grid->arena);
    volatile KrsStatus status = KRS_OUT_OF_MEMORY;
    if (grid->shape.count[0] == 0)
        return KRS_OK;
    grid->memory.exhausted = &exhausted;
    if (setjmp(exhausted) == 0)
        status = visit_all(&runs, visit, user);
    grid->memory.exhausted = NULL;
    arena_rewind(&grid->arena, mark);
    return status;
}

KrsStatus krs_grid_visit(KrsGrid *grid, KrsVisitBrick *visit, void *user)
{
    return visit_bricks(grid, false, visit, user);
}

static bool add_near(void *user, const KrsGridBrick *brick)
{
    *(size_t *)user += brick->near;
    return true;
}

KrsStatus krs_grid_count_near(KrsGrid *grid, size_t *count)
{
    *count = 0;
    return visit_bricks(grid, true, add_near, count);
}
