/* field.c: the distance of the meshed components, cut by a box and by zones. */
#include "compiler/field/field.h"

#include <string.h>

#include "compiler/base/vec.h"

/* ---- lane tapes ---- */

/* Makes the tape of the least distance of what is meshed, cut by the zones of the scene. */
static LaneTape make_tape(const MeshField *field, Arena *arena)
{
    const MeshSolid *solid = field->solid;
    const Tape      *of    = solid->tape ? solid->tape : &field->state->tapes.distance;
    LaneTape tape = lane_tape_new_steep(of, solid->roots, solid->root_count + solid->zoned, true,
                                        solid->zoned, arena);
    tape.output_count = 1;
    tape.scalars      = arena_new_array(arena, double, tape.scalar_count + 1);
    lane_tape_scalars(&tape, field->state->values, tape.scalars);
    return tape;
}

/* Returns the bytes that a pruned tape may take while it is made. */
static size_t bytes_of_region(const LaneTape *tape)
{
    return 65536 +
           2 * (lane_max_steps(tape) + tape->scalar_count) *
               (sizeof(LaneStep) + sizeof(LaneCode) + 4 * sizeof(LaneScalar)) +
           tape->call_count * (2 * sizeof(LaneCall) + LANE_BYTES_OF_INSTANCES);
}

void field_open(MeshField *field, Arena *arena)
{
    field->tape          = make_tape(field, arena);
    field->work          = lane_work_in(arena_alloc(arena, lane_work_bytes(&field->tape), 1),
                                        field->state->values);
    field->ranges        = lane_ranges_new(&field->tape, arena);
    field->ranges.values = field->state->values;
    field->slopes        = lane_slopes_new(&field->tape, arena);
    field->hessians      = lane_hessians_new(&field->tape, arena);
    field->region_bytes  = bytes_of_region(&field->tape);
    for (int i = 0; i < MAX_REGIONS; i++)
        field->regions[i].memory = arena_alloc(arena, field->region_bytes, 1);
    field->pieces.memory = arena_alloc(arena, field->region_bytes, 1);
    field->spare         = arena_alloc(arena, field->region_bytes, 1);
}

/* ---- regions ---- */

typedef struct Pool {
    FieldRegion *region;
    size_t       size;
} Pool;

static void *take_bytes(void *user, size_t bytes)
{
    const Pool *pool  = user;
    size_t      begin = (pool->region->used + 15) & ~(size_t)15;
    if (bytes > pool->size || begin > pool->size - bytes)
        return NULL;
    pool->region->used = begin + bytes;
    return pool->region->memory + begin;
}

static void give_bytes(void *user, void *block) { (void)user, (void)block; }

const LaneTape *field_tape(const MeshField *field)
{
    return field->region_count ? &field->regions[field->region_count - 1].tape : &field->tape;
}

/* Threads take no memory from the arenas of others; without room the tape stays as it is. */
static bool prune(MeshField *field, const LaneTape *outer, FieldRegion *region)
{
    Pool    pool = {region, field->region_bytes};
    jmp_buf exhausted;
    Memory  memory = {take_bytes, give_bytes, &pool, 0, 0, &exhausted};
    Arena   arena  = {.memory = &memory};
    region->used   = 0;
    region->tape   = *outer;
    if (setjmp(exhausted) != 0)
        return false;
    region->tape = lane_prune(outer, &field->ranges, outer->output_count, &arena);
    return true;
}

bool field_keep(MeshField *field, uint32_t *outputs, size_t count)
{
    LaneTape tape     = *field_tape(field);
    tape.outputs      = outputs;
    tape.output_count = count;
    return prune(field, &tape, &field->pieces) &&
           field->pieces.tape.rows <= lane_max_rows(&field->tape);
}

static bool box_has(const Box *box, const double point[3])
{
    for (int k = 0; k < 3; k++)
        if (!(point[k] >= box->axis[k].low && point[k] <= box->axis[k].high))
            return false;
    return true;
}

/* Returns the shortest tape that is right at all points. */
static const LaneTape *tape_at(const MeshField *field, const double (*points)[3], size_t count)
{
    for (size_t r = field->region_count; r > 0; r--) {
        const FieldRegion *region = &field->regions[r - 1];
        size_t             inside = 0;
        while (inside < count && box_has(&region->box, points[inside]))
            inside++;
        if (inside == count)
            return &region->tape;
    }
    return &field->tape;
}

static const LaneTape *tape_in(const MeshField *field, const Box *box)
{
    double corners[2][3];
    for (int k = 0; k < 3; k++) {
        corners[0][k] = box->axis[k].low;
        corners[1][k] = box->axis[k].high;
    }
    return tape_at(field, (const double(*)[3])corners, 2);
}

/* ---- points ---- */

/* Returns the distance to the surface of the box, negative inside. */
static double distance_to_cut(const MeshField *field, const double point[3])
{
    double outside = 0, inside = -INFINITY;
    for (int k = 0; k < 3; k++) {
        double excess = max2(field->low[k] - point[k], point[k] - field->high[k]);
        outside += excess > 0 ? excess * excess : 0;
        inside = max2(inside, excess);
    }
    return outside > 0 ? sqrt(outside) : inside;
}

static double cut_by_zones(const KrsState *state, const double point[3], double distance)
{
    for (size_t i = 0; i < state->zone_count; i++)
        distance = max2(distance, state->zones[i][3] - distance3(point, state->zones[i]));
    return distance;
}

void field_distances(const MeshField *field, const double (*points)[3], size_t count,
                     double *distances)
{
    lane_run(tape_at(field, points, count), &field->work, LANE_DOUBLE,
             (LanePoints){.points = points, .count = count}, 0, 1, distances);
    for (size_t i = 0; i < count; i++) {
        distances[i] = cut_by_zones(field->state, points[i], distances[i]);
        if (field->cut)
            distances[i] = max2(distances[i], distance_to_cut(field, points[i]));
        distances[i] -= field->skin;
    }
}

double field_distance(const MeshField *field, const double point[3])
{
    double distance;
    field_distances(field, (const double(*)[3])point, 1, &distance);
    return distance;
}

bool field_normal(const MeshField *field, const double point[3], double step, double normal[3])
{
    double beside[6][3], distances[6];
    for (int i = 0; i < 6; i++) {
        memcpy(beside[i], point, sizeof beside[i]);
        beside[i][i / 2] += i % 2 ? step : -step;
    }
    field_distances(field, (const double(*)[3])beside, 6, distances);
    for (int k = 0; k < 3; k++)
        normal[k] = distances[2 * k + 1] - distances[2 * k];
    if (normalize3(normal))
        return true;
    normal[0] = normal[1] = normal[2] = 0;
    return false;
}

/* ---- boxes ---- */

/* Holds all values, within a box around a middle, of what changes no faster than the point moves. */
static Range range_around(double middle, Box box)
{
    double radius = 0;
    for (int k = 0; k < 3; k++)
        radius = hypot_upward(radius, 0.5 * (box.axis[k].high - box.axis[k].low));
    radius *= 1 + 1e-12;
    return (Range){middle - radius, middle + radius};
}

/* Returns the range in a box of what cuts the components. */
static Range range_of_cuts(const MeshField *field, Box box)
{
    double middle[3];
    for (int k = 0; k < 3; k++)
        middle[k] = 0.5 * (box.axis[k].low + box.axis[k].high);
    double cut = cut_by_zones(field->state, middle, -INFINITY);
    if (field->cut)
        cut = max2(cut, distance_to_cut(field, middle));
    return cut > -INFINITY ? range_around(cut, box) : range_of(-INFINITY);
}

bool field_is_cut(const MeshField *field, Box box)
{
    return (field->cut || field->state->zone_count > 0) &&
           lane_ranges_run(tape_in(field, &box), &field->ranges, box).low <
               range_of_cuts(field, box).high;
}

Range field_range(const MeshField *field, Box box)
{
    return range_max(lane_ranges_run(tape_in(field, &box), &field->ranges, box),
                     range_of_cuts(field, box));
}

/* Finds the slope of the cutting box, of which one side is the nearest inside; false: one does not
   know which. */
static bool slope_of_cut(const MeshField *field, Box box, LaneSlope *slope)
{
    Range nearest = range_of(-INFINITY);
    int   side    = 0, axis;
    for (int i = 0; i < 6; i++) {
        int   k     = i / 2;
        Range depth = i % 2 ? range_sub(box.axis[k], range_of(field->high[k]))
                            : range_sub(range_of(field->low[k]), box.axis[k]);
        if (depth.low >= nearest.high) {
            nearest = depth;
            side    = i;
        } else if (depth.high > nearest.low)
            return false;
    }
    axis = side / 2;
    for (int k = 0; k < 3; k++) {
        slope->by[k] = range_of(k != axis ? 0 : side % 2 ? 1 : -1);
        if (k != axis && (box.axis[k].low < field->low[k] || box.axis[k].high > field->high[k]))
            return false;
    }
    return true;
}

bool field_slope(const MeshField *field, Box box, Range *range, LaneSlope *slope)
{
    const LaneTape *tape = tape_in(field, &box);
    Range           own  = lane_ranges_run(tape, &field->ranges, box);
    Range           cut  = range_of_cuts(field, box);
    *range               = range_max(own, cut);
    if (range->low > 0 || range->high < 0)
        return false;
    if (own.high <= cut.low && field->state->zone_count == 0)
        return slope_of_cut(field, box, slope);
    if (lane_is_boundless(tape, &field->ranges, tape->outputs[0]) ||
        !lane_slopes_run(tape, &field->ranges, field->slopes, slope))
        return false;
    for (int k = 0; own.low < cut.high && k < 3; k++)
        slope->by[k] = range_hull(slope->by[k], (Range){-1, 1});
    return true;
}

bool field_hessian(const MeshField *field, Box box, Range *range, LaneSlope *slope,
                   LaneHessian *hessian)
{
    const LaneTape *tape = tape_in(field, &box);
    Range           own  = lane_ranges_run(tape, &field->ranges, box);
    Range           cut  = range_of_cuts(field, box);
    *range               = range_max(own, cut);
    *hessian             = (LaneHessian){.known = true, .flat = true};
    if (own.high <= cut.low && field->state->zone_count == 0)
        return slope_of_cut(field, box, slope);
    return own.low >= cut.high && !lane_is_undecided(tape, &field->ranges) &&
           !lane_is_boundless(tape, &field->ranges, tape->outputs[0]) &&
           lane_slopes_run(tape, &field->ranges, field->slopes, slope) &&
           lane_hessians_run(tape, &field->ranges, field->slopes, field->hessians, hessian);
}

/* Prunes once more where steps have taken the place of a call: nothing is known of them yet. */
static void prune_again(MeshField *field, FieldRegion *region)
{
    FieldRegion again = {.box = region->box, .memory = field->spare};
    lane_ranges_run(&region->tape, &field->ranges, region->box);
    if (!prune(field, &region->tape, &again))
        return;
    field->spare = region->memory;
    *region      = again;
}

/* The ranges of the box are known. */
static void enter(MeshField *field, const LaneTape *outer, Box box)
{
    FieldRegion *region = &field->regions[field->region_count];
    region->box         = box;
    if (prune(field, outer, region) && region->tape.call_count < outer->call_count)
        prune_again(field, region);
    field->region_count++;
}

/* The steps up to which a tape is short.  To enter a box takes several runs of the tape around it,
   so the new tape must be much shorter: it is not where it was short, nor in boxes of about the
   same size. */
enum { SHORT = 40 };

/* Tells whether the tape that was entered last is short, and has no call that may become steps. */
static bool is_short(const MeshField *field)
{
    const LaneTape *tape = &field->regions[field->region_count - 1].tape;
    return tape->count <= SHORT && !(field->ranges.unroll && tape->call_count > 0);
}

static bool is_worth_entering(const MeshField *field, Box box)
{
    static const double MUCH_SMALLER = 0.05;
    double              part         = 1;
    if (field->region_count == 0)
        return true;
    const FieldRegion *outer = &field->regions[field->region_count - 1];
    for (int k = 0; k < 3; k++)
        part *= (box.axis[k].high - box.axis[k].low) /
                (outer->box.axis[k].high - outer->box.axis[k].low);
    return !is_short(field) && part < MUCH_SMALLER;
}

static void stay(MeshField *field)
{
    FieldRegion *region = &field->regions[field->region_count++];
    region->box         = region[-1].box;
    region->tape        = region[-1].tape;
}

bool field_enter(MeshField *field, Box box)
{
    if (!is_worth_entering(field, box)) {
        stay(field);
        return true;
    }
    const LaneTape *outer = field_tape(field);
    Range           own   = lane_ranges_run_closer(outer, &field->ranges, box);
    Range           range = range_max(own, range_of_cuts(field, box));
    if (range.low > 0 || range.high < 0)
        return false;
    enter(field, outer, box);
    return true;
}

void field_focus(MeshField *field, Box box)
{
    lane_ranges_run_closer(field_tape(field), &field->ranges, box);
    enter(field, field_tape(field), box);
}

void field_narrow(MeshField *field, Box box)
{
    if (field->region_count > 0 && is_short(field))
        stay(field);
    else
        field_focus(field, box);
}

void field_leave(MeshField *field) { field->region_count--; }
