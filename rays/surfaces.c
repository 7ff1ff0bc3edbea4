/*
 * surfaces.c: surfaces of a state of a scene at points: in balls, in balls within these, and then point by point.
 *
 * All components are on one tape.  At a point the nearest one decides, so a ball needs only those that may be the nearest
 * somewhere in it.
 */
#include "rays/surfaces.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "rays/ray_field.h"
#include "compiler/base/parallel.h"
#include "compiler/graph/lanes/lane_cells.h"
#include "compiler/scene/program.h"

/* Balls of balls of points.  A tape that is shorter than this is not made shorter. */
enum { LEVELS = 2, OF_BALL = 256, SHORT_TAPE = 96 };

/* Numbers of a surface, as outputs of a component; those of identities are integers. */
enum { DISTANCE, NORMAL, FIRST_IDENTITY = NORMAL + 3 };
enum { FIRST_MATERIAL = offsetof(FoundSurface, color) / sizeof(float) };

/* The rows of a candidate, and what it is a candidate for. */
typedef struct Rows {
    uint32_t *of; /* numbers of one candidate after the other, then the zone */
    size_t    candidates;
} Rows;

struct SurfaceField {
    Memory    memory;
    Arena     arena;
    KrsState *state;
    LaneTape  lanes;
    CellTape  cells;
    uint32_t *rows;    /* of all outputs */
    size_t    numbers; /* of a component */
    bool      cuts;    /* behind those of components is the zone */
    float     margin;  /* what rounding may make of coordinates */
    CellWork *works[MAX_PARTS];
    uint32_t *rows_of_part[MAX_PARTS][LEVELS + 1];
};

bool surface_field_suits(const KrsScene *scene)
{
    return scene->component_count > 0 && !scene->program.media && !scene->program.open_surfaces;
}

/* ---- tapes ---- */

/* Lists the roots of a component, in the order of the numbers. */
static void list_roots(const Node *of, bool layers, Node **next)
{
    *(*next)++ = of[ROOT_DISTANCE];
    *(*next)++ = of[ROOT_NORMAL];
    for (ComponentRoot r = ROOT_DISTANCE + 1; r < ROOT_NORMAL; r++)
        if (!root_info[r].material)
            *(*next)++ = of[r];
    for (ComponentRoot r = ROOT_DISTANCE + 1; r < ROOT_NORMAL; r++)
        if (root_info[r].material && (layers || r < ROOT_specular))
            *(*next)++ = of[r];
}

static void make_tape(SurfaceField *field, bool layers)
{
    const KrsScene *scene = field->state->scene;
    const size_t    count = scene->component_count;
    const Node      zone  = zone_root(scene);
    Node *roots = arena_new_array(&field->arena, Node, count * ROOT_COUNT + 1), *next = roots;
    for (size_t i = 0; i < count; i++)
        list_roots(surface_roots(&scene->roots, i), layers, &next);
    if (zone != NODE_NONE)
        *next++ = zone;
    field->numbers = layers ? SURFACE_NUMBERS : PLAIN_SURFACE_NUMBERS;
    field->cuts    = zone != NODE_NONE;
    field->lanes = lane_tape_new_steep(&field->state->tapes.surface, roots, (size_t)(next - roots),
                                       false, 0, &field->arena);
    field->lanes.scalars = arena_new_array(&field->arena, double, field->lanes.scalar_count + 1);
    lane_tape_scalars(&field->lanes, field->state->values, field->lanes.scalars);
    field->cells = cell_tape_new(&field->lanes, field->state->values, &field->arena);
    field->rows  = arena_new_array(&field->arena, uint32_t, field->lanes.output_count + 1);
    cell_outputs(&field->cells, field->rows);
    assert(field->lanes.output_count == count * field->numbers + field->cuts);
}

static void fill(SurfaceField *field, bool layers)
{
    state_refresh_points(field->state);
    make_tape(field, layers);
    for (size_t i = 0; i < parallel_parts(); i++) {
        field->works[i] = cell_work_new(
            &field->cells, LEVELS,
            field->lanes.reads_tables ? ray_copy_values(field->state, &field->arena) : NULL,
            &field->arena);
        for (int level = 0; level <= LEVELS; level++)
            field->rows_of_part[i][level] = arena_new_array(&field->arena, uint32_t,
                                                            field->lanes.output_count + 1);
    }
    field->margin = ray_margin(&field->state->scene->program);
}

SurfaceField *surface_field_new(KrsState *state, bool layers)
{
    const Memory *from  = &state->scene->memory;
    SurfaceField *field = from->allocate ? from->allocate(from->user, sizeof *field)
                                         : malloc(sizeof *field);
    jmp_buf       exhausted;
    if (!field)
        return NULL;
    *field = (SurfaceField){
        .memory = {.allocate = from->allocate, .release = from->release, .user = from->user},
        .state  = state};
    field->arena.memory     = &field->memory;
    field->memory.exhausted = &exhausted;
    if (setjmp(exhausted) != 0) {
        surface_field_free(field);
        return NULL;
    }
    fill(field, layers);
    field->memory.exhausted = NULL;
    return field;
}

void surface_field_free(SurfaceField *field)
{
    if (!field)
        return;
    const Memory memory = field->memory;
    arena_free(&field->arena);
    if (memory.allocate)
        memory.release(memory.user, field);
    else
        free(field);
}

/* ---- points ---- */

/* The question of each candidate: its distance and numbers [first, end), to be written there. */
typedef struct Question {
    const SurfaceField *field;
    CellWork           *work;
    uint32_t *const    *rows;    /* memory, of each level */
    size_t              numbers; /* of a candidate */
    const SurfacePoint *points;
    size_t              first, each; /* the first that is written, and how many are */
} Question;

static void place(CellPoints *to, int lane, const SurfacePoint *from)
{
    for (int k = 0; k < 3; k++) {
        to->point[k][lane]  = from->position[k];
        to->normal[k][lane] = from->normal[k];
        to->view[k][lane]   = from->view[k];
    }
    to->footprint[lane] = from->footprint;
}

/* Returns the nearest candidate of a lane. */
static size_t find_nearest(const Question *q, const Rows *rows, const float *values, int lane)
{
    float  least   = HUGE_VALF;
    size_t nearest = 0;
    for (size_t i = 0; i < rows->candidates; i++) {
        const float distance =
            values[(size_t)rows->of[i * q->numbers + DISTANCE] * CELL_LANES + lane];
        if (distance < least) {
            least   = distance;
            nearest = i;
        }
    }
    return nearest;
}

/* Stores a number.  Identities are shown as integers, though the graph may have numbers of them. */
static void put(float *to, size_t number, float value)
{
    static const GraphType identities[] = {
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends) TYPE_##type,
#include "krs/surface.def"
    };
    const bool  identity = number >= FIRST_IDENTITY && number < FIRST_MATERIAL;
    const bool  whole    = identity && identities[number - FIRST_IDENTITY] == TYPE_FLOAT;
    const float shown = whole ? lane_bits(value > 0 && value < 4294967040.0f ? (uint32_t)value : 0)
                              : value;
    memcpy(to, &shown, sizeof *to);
}

/* Cuts a surface by zones, which leave the normal as it is. */
static void cut(const Question *q, const Rows *rows, const float *values, int lane,
                const SurfacePoint *point, float *found)
{
    const float depth = values[(size_t)rows->of[rows->candidates * q->numbers] * CELL_LANES + lane];
    if (q->first > DISTANCE || !(depth > found[DISTANCE]))
        return;
    found[DISTANCE] = depth;
    memcpy(found + NORMAL, point->normal, sizeof point->normal);
}

/* Finds the surfaces of up to CELL_LANES points. */
static void find_points(const Question *q, const CellTape *tape, uint32_t level, const Rows *rows,
                        size_t first, size_t count)
{
    CellPoints points;
    for (size_t i = 0; i < CELL_LANES; i++)
        place(&points, (int)i, &q->points[first + (i < count ? i : count - 1)]);
    const float *values = cell_run_surfaces(tape, q->work, level, &points);
    for (size_t i = 0; i < count; i++) {
        const size_t    nearest = rows->candidates > 1 ? find_nearest(q, rows, values, (int)i) : 0;
        const uint32_t *of      = rows->of + nearest * q->numbers + (q->first > 0);
        float          *found   = q->points[first + i].found;
        for (size_t k = 0; k < q->each; k++)
            put(&found[k], q->first + k, values[(size_t)of[k] * CELL_LANES + i]);
        if (q->field->cuts)
            cut(q, rows, values, (int)i, &q->points[first + i], found);
    }
}

/* ---- balls ---- */

/* Points that are divided into up to CELL_LANES balls of as many. */
typedef struct Balls {
    CellPoints middles;
    float      radius[CELL_LANES];
} Balls;

static void measure(const SurfacePoint *points, size_t count, CellPoints *middles, int lane,
                    float *radius)
{
    float low[3], high[3], square = 0;
    place(middles, lane, points);
    memcpy(low, points->position, sizeof low);
    memcpy(high, points->position, sizeof high);
    for (size_t i = 1; i < count; i++)
        for (int k = 0; k < 3; k++) {
            low[k]  = fminf(low[k], points[i].position[k]);
            high[k] = fmaxf(high[k], points[i].position[k]);
        }
    for (int k = 0; k < 3; k++) {
        middles->point[k][lane] = 0.5f * (low[k] + high[k]);
        const float half        = 0.5f * (high[k] - low[k]);
        square += half * half;
    }
    *radius = 1.0001f * sqrtf(square);
}

/* Returns the least upper bound of distances of the candidates in a ball. */
static float min_bound(const Question *q, const CellTape *tape, const Rows *rows,
                       const float *values, float radius)
{
    float least = HUGE_VALF;
    for (size_t i = 0; i < rows->candidates; i++) {
        const uint32_t row   = rows->of[i * q->numbers + DISTANCE];
        const float    bound = values[(size_t)row * CELL_LANES] +
                            cell_row_reach(tape, row, radius, q->field->margin);
        least = bound < least ? bound : least;
    }
    return least;
}

/* Finds those that may be the nearest in the ball; there is at least one. */
static void find_candidates(const Question *q, const CellTape *tape, const Rows *rows,
                            const float *values, float radius, Rows *to)
{
    const float  least = min_bound(q, tape, rows, values, radius);
    const size_t bytes = q->numbers * sizeof *to->of;
    to->candidates     = 0;
    for (size_t i = 0; i < rows->candidates; i++) {
        const uint32_t *from = rows->of + i * q->numbers;
        const float     low  = values[(size_t)from[DISTANCE] * CELL_LANES] -
                          cell_row_reach(tape, from[DISTANCE], radius, q->field->margin);
        if (low > least)
            continue;
        memcpy(to->of + to->candidates * q->numbers, from, bytes);
        to->candidates++;
    }
    if (q->field->cuts)
        to->of[to->candidates * q->numbers] = rows->of[rows->candidates * q->numbers];
}

static void find(const Question *q, const CellTape *tape, uint32_t level, const Rows *rows,
                 size_t first, size_t count);

/* Divides points into balls of `size`, and goes on in each. */
static void divide(const Question *q, const CellTape *tape, uint32_t level, const Rows *rows,
                   size_t first, size_t count, size_t size)
{
    Balls        balls;
    const size_t many = (count + size - 1) / size;
    for (size_t i = 0; i < CELL_LANES; i++) {
        const size_t ball = i < many ? i : many - 1, at = ball * size;
        measure(q->points + first + at, count - at < size ? count - at : size, &balls.middles,
                (int)i, &balls.radius[i]);
    }
    const float *values = cell_run_surfaces(tape, q->work, level, &balls.middles);
    for (size_t i = 0; i < many; i++) {
        const CellMark mark = cell_mark(q->work);
        Rows           kept = {.of = q->rows[level]};
        find_candidates(q, tape, rows, values + i, balls.radius[i], &kept);
        const CellTape pruned = cell_prune_rows(tape, q->work, level, (uint32_t)i, balls.radius[i],
                                                q->field->margin, kept.of,
                                                kept.candidates * q->numbers + q->field->cuts);
        find(q, &pruned, level + 1, &kept, first + i * size,
             count - i * size < size ? count - i * size : size);
        cell_release(q->work, mark);
    }
}

static void find(const Question *q, const CellTape *tape, uint32_t level, const Rows *rows,
                 size_t first, size_t count)
{
    size_t size = OF_BALL;
    for (uint32_t i = level + 1; i < LEVELS; i++)
        size *= CELL_LANES;
    if (level < LEVELS && cell_cost(tape) > SHORT_TAPE) {
        for (size_t done = 0, now; done < count; done += now) {
            now = count - done < size * CELL_LANES ? count - done : size * CELL_LANES;
            divide(q, tape, level, rows, first + done, now, size);
        }
        return;
    }
    for (size_t done = 0, now; done < count; done += now) {
        now = count - done < CELL_LANES ? count - done : CELL_LANES;
        find_points(q, tape, level, rows, first + done, now);
    }
}

/* ---- order ---- */

enum { CELLS = 1024 }; /* in a row along an axis, 2^10 of them */

/* Two zeros between the ten bits of a number. */
static uint32_t spread_by_three(uint32_t bits)
{
    bits = (bits | bits << 16) & 0x030000ffu;
    bits = (bits | bits << 8) & 0x0300f00fu;
    bits = (bits | bits << 4) & 0x030c30c3u;
    return (bits | bits << 2) & 0x09249249u;
}

static int compare_orders(const void *a, const void *b)
{
    const uint32_t one = ((const SurfacePoint *)a)->order, other = ((const SurfacePoint *)b)->order;
    return (one > other) - (one < other);
}

/* Cells of the box around them are numbered by Morton's order, so an eighth of an eighth follows another. */
void surface_points_sort(SurfacePoint *points, size_t count)
{
    float low[3] = {HUGE_VALF, HUGE_VALF, HUGE_VALF}, side = 0;
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            low[k] = fminf(low[k], points[i].position[k]);
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            side = fmaxf(side, points[i].position[k] - low[k]);
    const float scale = side > 0 ? (CELLS - 0.5f) / side : 0;
    for (size_t i = 0; i < count; i++) {
        points[i].order = 0;
        for (int k = 0; k < 3; k++)
            points[i].order |= spread_by_three((uint32_t)((points[i].position[k] - low[k]) * scale))
                               << k;
    }
    qsort(points, count, sizeof *points, compare_orders);
}

/* ---- questions ---- */

static void ask(Question *q, size_t part, size_t count)
{
    const SurfaceField *field = q->field;
    const Rows          all   = {.of         = field->rows_of_part[part][LEVELS],
                                 .candidates = field->state->scene->component_count};
    q->work                   = field->works[part];
    q->rows                   = field->rows_of_part[part];
    q->numbers                = (q->first > 0) + q->each;
    for (size_t i = 0; i < all.candidates; i++) {
        const uint32_t *from = field->rows + i * field->numbers;
        uint32_t       *to   = all.of + i * q->numbers;
        to[DISTANCE]         = from[DISTANCE];
        memcpy(to + (q->first > 0), from + q->first, q->each * sizeof *to);
    }
    if (field->cuts)
        all.of[all.candidates * q->numbers] = field->rows[all.candidates * field->numbers];
    find(q, &field->cells, 0, &all, 0, count);
}

void surface_field_find(const SurfaceField *field, size_t part, const SurfacePoint *points,
                        size_t count)
{
    Question q = {.field = field, .points = points, .each = field->numbers};
    ask(&q, part, count);
}

void surface_field_find_colors(const SurfaceField *field, size_t part, const SurfacePoint *points,
                               size_t count)
{
    Question q = {.field = field, .points = points, .first = FIRST_MATERIAL, .each = 3};
    ask(&q, part, count);
}
