/*
 * points.c: queries in many points at once, by lane tapes and on all processors.
 */
#include "compiler/scene/points.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/parallel.h"
#include "compiler/base/vec.h"
#include "compiler/graph/lanes/lanes.h"

/* The lane tapes for many points of one state. */
struct StateLanes {
    Memory memory;
    Arena  arena;
    Tape bound; /* the scene's tape of distances, where instance groups have the list of one cell */
    LaneTape distance, surface;
    size_t  *surface_outputs; /* the first one of each component */
    LaneWork distance_work, surface_work;
};

static LaneWork new_work(struct StateLanes *lanes, const LaneTape *tape, NodeValue *values)
{
    return lane_work_in(arena_alloc(&lanes->arena, lane_work_bytes(tape), 1), values);
}

static void room_for_scalars(struct StateLanes *lanes, LaneTape *tape)
{
    tape->scalars = arena_new_array(&lanes->arena, double, tape->scalar_count + 1);
}

/* Makes the distances of all components, and the zones, whose least is output 0. */
static void make_distance(struct StateLanes *lanes, KrsState *state)
{
    const KrsScene *scene = state->scene;
    size_t          count = scene->component_count;
    Node            zone  = zone_root(scene);
    Node           *roots = arena_new_array(&lanes->arena, Node, count + 1);
    for (size_t i = 0; i < count; i++)
        roots[i] = distance_root(&scene->roots, i);
    roots[count]          = zone;
    size_t cuts           = zone != NODE_NONE;
    lanes->distance       = lane_tape_new(&state->tapes.distance, roots, count + cuts, true, cuts,
                                          &lanes->arena);
    lanes->bound          = state->tapes.distance;
    lanes->bound.by_cells = true;
    room_for_scalars(lanes, &lanes->distance);
    lanes->distance_work = new_work(lanes, &lanes->distance, state->values);
}

static uint32_t outputs_of(const KrsScene *scene, Node root)
{
    GraphType type = (GraphType)scene->graph->items[root].type;
    return type <= TYPE_VEC4 ? (uint32_t)type : 1;
}

static void make_surface(struct StateLanes *lanes, KrsState *state)
{
    const KrsScene *scene = state->scene;
    size_t          count = scene->component_count, outputs = 0;
    Node           *roots  = arena_new_array(&lanes->arena, Node, count * ROOT_COUNT + 1);
    lanes->surface_outputs = arena_new_array(&lanes->arena, size_t, count + 1);
    for (size_t i = 0; i < count; i++) {
        const Node *of            = surface_roots(&scene->roots, i);
        lanes->surface_outputs[i] = outputs;
        for (size_t k = 0; k < ROOT_COUNT; k++) {
            roots[i * ROOT_COUNT + k] = of[k];
            outputs += outputs_of(scene, of[k]);
        }
    }
    lanes->surface = lane_tape_new(&state->tapes.surface, roots, count * ROOT_COUNT, false, 0,
                                   &lanes->arena);
    room_for_scalars(lanes, &lanes->surface);
    lanes->surface_work = new_work(lanes, &lanes->surface, state->values);
}

void state_lanes_refresh(KrsState *state)
{
    if (!state->lanes)
        return;
    lane_tape_scalars(&state->lanes->distance, state->values, state->lanes->distance.scalars);
    lane_tape_scalars(&state->lanes->surface, state->values, state->lanes->surface.scalars);
}

bool state_lanes(KrsState *state)
{
    const Memory *from = &state->scene->memory;
    if (state->lanes)
        return true;
    struct StateLanes *lanes = from->allocate ? from->allocate(from->user, sizeof *lanes)
                                              : malloc(sizeof *lanes);
    if (!lanes)
        return false;
    *lanes = (struct StateLanes){
        .memory = {.allocate = from->allocate, .release = from->release, .user = from->user}};
    lanes->arena = (Arena){.memory = &lanes->memory};
    state->lanes = lanes;
    jmp_buf exhausted;
    lanes->memory.exhausted = &exhausted;
    if (setjmp(exhausted) != 0) {
        state_lanes_free(state);
        return false;
    }
    make_distance(state->lanes, state);
    make_surface(state->lanes, state);
    state->lanes->memory.exhausted = NULL;
    state_lanes_refresh(state);
    return true;
}

void state_lanes_free(KrsState *state)
{
    const Memory *from = &state->scene->memory;
    if (!state->lanes)
        return;
    arena_free(&state->lanes->arena);
    if (from->allocate)
        from->release(from->user, state->lanes);
    else
        free(state->lanes);
    state->lanes = NULL;
}

/* ---- zones of the caller ---- */

static double cut_by_zones(const KrsState *state, const double point[3], double least)
{
    double depth = -INFINITY;
    for (size_t i = 0; i < state->zone_count; i++)
        depth = fmax(depth, state->zones[i][3] - distance3(point, state->zones[i]));
    return least < depth ? depth : least;
}

/* ---- many processors ---- */

/* The steps of single points from which threads are worth their making. */
#define STEPS_FOR_THREADS 4e6

/* Points that are dealt out; what each part needs to run its own. */
typedef struct Deal {
    const KrsState *state;
    const LaneTape *tape;
    const double (*points)[3];
    size_t    count;
    double   *distances;
    LaneWork *works;
} Deal;

static void deal_part(void *task, size_t part, size_t parts)
{
    const Deal *deal  = task;
    size_t      begin = part_begin(deal->count, part, parts);
    size_t      end   = part_begin(deal->count, part + 1, parts);
    lane_run(deal->tape, &deal->works[part], LANE_DOUBLE,
             (LanePoints){.points = deal->points + begin, .count = end - begin}, 0, 1,
             deal->distances + begin);
    for (size_t i = begin; i < end && deal->state->zone_count > 0; i++)
        deal->distances[i] = cut_by_zones(deal->state, deal->points[i], deal->distances[i]);
}

/* Gives each part but the first its rows and, if it reads tables, values of the state. */
static void give_works(struct StateLanes *lanes, const KrsState *state, LaneWork *works)
{
    size_t parts = parallel_parts(), count = state->scene->graph->count;
    for (size_t i = 1; i < parts; i++) {
        NodeValue *values = NULL;
        if (lanes->distance.reads_tables) {
            values = arena_new_array(&lanes->arena, NodeValue, count);
            memcpy(values, state->values, count * sizeof *values);
        }
        works[i] = new_work(lanes, &lanes->distance, values);
    }
}

static bool worth_threads(const Deal *deal)
{
    return (double)deal->count * (double)(deal->tape->count + 1) >= STEPS_FOR_THREADS;
}

static bool deal_out(struct StateLanes *lanes, Deal *deal)
{
    const ArenaMark mark = arena_mark(&lanes->arena);
    volatile bool   done = false; /* it lives through a jump */
    jmp_buf         exhausted;
    lanes->memory.exhausted = &exhausted;
    if (setjmp(exhausted) == 0) {
        give_works(lanes, deal->state, deal->works);
        run_in_parallel(deal_part, deal);
        done = true;
    }
    lanes->memory.exhausted = NULL;
    arena_rewind(&lanes->arena, mark);
    return done;
}

/* ---- distances and normals ---- */

KrsStatus points_distances(KrsState *state, const double (*points)[3], size_t count, bool bound,
                           double *distances)
{
    LaneWork works[MAX_PARTS];
    if (!state_lanes(state))
        return KRS_OUT_OF_MEMORY;
    LaneTape tape = state->lanes->distance;
    if (bound)
        tape.tape = &state->lanes->bound;
    works[0]  = state->lanes->distance_work;
    Deal deal = {state, &tape, points, count, distances, works};
    if (!worth_threads(&deal))
        deal_part(&deal, 0, 1);
    else if (!deal_out(state->lanes, &deal))
        return KRS_OUT_OF_MEMORY;
    return KRS_OK;
}

enum { BESIDE = 6, AT_ONCE = 1024 };

/* Places points where a normal needs distances: behind and before the point along each axis. */
static double place_beside(const double point[3], double (*to)[3])
{
    double step = 1e-6 * (1 + largest3(point));
    for (int k = 0; k < BESIDE; k++) {
        memcpy(to[k], point, 3 * sizeof *point);
        to[k][k / 2] += k % 2 ? step : -step;
    }
    return step;
}

static void normal_of_differences(const double *beside, double step, double normal[3])
{
    for (int k = 0; k < 3; k++)
        normal[k] = beside[2 * k + 1] - beside[2 * k];
    double length = length3(normal);
    for (int k = 0; k < 3; k++)
        normal[k] = length > 1e-3 * step ? normal[k] / length : 0;
}

KrsStatus points_normals(KrsState *state, const double (*points)[3], size_t count,
                         double (*normals)[3])
{
    double    places[AT_ONCE * BESIDE][3], found[AT_ONCE * BESIDE], steps[AT_ONCE];
    KrsStatus status = KRS_OK;
    for (size_t begin = 0; begin < count && status == KRS_OK; begin += AT_ONCE) {
        size_t now = count - begin < AT_ONCE ? count - begin : AT_ONCE;
        for (size_t i = 0; i < now; i++)
            steps[i] = place_beside(points[begin + i], &places[i * BESIDE]);
        status = points_distances(state, (const double(*)[3])places, now * BESIDE, false, found);
        for (size_t i = 0; i < now && status == KRS_OK; i++)
            normal_of_differences(&found[i * BESIDE], steps[i], normals[begin + i]);
    }
    return status;
}

/* ---- surfaces ---- */

static double output_of(const LaneTape *tape, const LaneWork *work, size_t output, size_t lane)
{
    uint32_t row = tape->output_rows[output];
    if (row & LANE_SCALAR)
        return tape->scalars[row & ~LANE_SCALAR];
    return ((const double *)work->rows)[(size_t)row * LANES + lane];
}

/* Finds the nearest component as distance_by of query.c does: behind output 0 are the distances of
   the components. */
static uint32_t nearest_component(const KrsState *state, size_t lane)
{
    const struct StateLanes *lanes   = state->lanes;
    double                   least   = INFINITY;
    uint32_t                 nearest = 0;
    for (size_t i = 0; i < state->scene->component_count; i++) {
        double distance = output_of(&lanes->distance, &lanes->distance_work, 1 + i, lane);
        if (distance < least || i == 0) {
            least   = distance;
            nearest = (uint32_t)i + 1;
        }
    }
    return nearest;
}

void points_look(KrsState *state, const double (*points)[3], const double (*normals)[3],
                 size_t count, double *distances, uint32_t *nearest)
{
    struct StateLanes *lanes = state->lanes;
    LanePoints         all   = {.points = points, .normals = normals, .count = count};
    lane_run(&lanes->distance, &lanes->distance_work, LANE_DOUBLE, all, 0, 1, distances);
    for (size_t i = 0; i < count; i++) {
        distances[i] = cut_by_zones(state, points[i], distances[i]);
        nearest[i]   = nearest_component(state, i);
    }
    lane_run(&lanes->surface, &lanes->surface_work, LANE_DOUBLE, all, 0, 0, NULL);
}

void points_surface(KrsState *state, size_t point, uint32_t nearest)
{
    const KrsScene          *scene  = state->scene;
    const struct StateLanes *lanes  = state->lanes;
    const Node              *roots  = surface_roots(&scene->roots, nearest - 1);
    size_t                   output = lanes->surface_outputs[nearest - 1];
    for (size_t k = 0; k < ROOT_COUNT; k++)
        for (uint32_t c = 0; c < outputs_of(scene, roots[k]); c++)
            state->values[roots[k]].v[c] = output_of(&lanes->surface, &lanes->surface_work,
                                                     output++, point);
}
