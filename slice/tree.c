/* tree.c: finds the cells of a quadtree that the outline goes through. */
#include "slice/section.h"

#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/base/vec.h"

enum {
    COARSEST    = WHOLE_SIDE / 16, /* side of the largest leaves */
    ENTER_EVERY = 3,               /* halvings until the field is pruned again */
    ASK_EVERY   = 256
};
/* The number of times that cells are halved again where something is thinner than the smallest;
   what is still thinner is counted. */
enum { THIN_HALVINGS = 4 };
/* Derivatives below this count as 0, so that a face that was rotated by a right angle is
   straight. */
static const double STRAIGHT = 1e-9;

void section_root(Section *s, const double low[3], const double high[3])
{
    /* The root is off the middle, so that faces and corners of symmetric solids and whole sizes are
       on no edges of cells. */
    static const double WIDER = 1.0973, OFF[2] = {0.0131, 0.0173};
    double              least[2] = {INFINITY, INFINITY}, most[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < 8; i++) {
        const double point[3] = {i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1],
                                 i & 4 ? high[2] : low[2]};
        const double at[2] = {dot3(point, s->plane.right), dot3(point, s->plane.up)};
        for (int k = 0; k < 2; k++) {
            least[k] = min2(least[k], at[k]);
            most[k]  = max2(most[k], at[k]);
        }
    }
    s->side = WIDER * max2(max2(most[0] - least[0], most[1] - least[1]), 4 * s->error);
    for (int k = 0; k < 2; k++)
        s->low[k] = 0.5 * (least[k] + most[k]) - (0.5 - OFF[k]) * s->side;
    s->finest = WHOLE_SIDE;
    while (s->finest > 2 && s->side * s->finest > s->error * WHOLE_SIDE)
        s->finest /= 2;
    s->thinnest = s->finest >> THIN_HALVINGS > 2 ? s->finest >> THIN_HALVINGS : 2;
}

/* ---- corners ---- */

uint64_t hash_point(const uint32_t at[2], uint32_t more)
{
    uint64_t hash = (at[0] * 0x9E3779B97F4A7C15u) ^ (at[1] * 0xC2B2AE3D27D4EB4Fu) ^
                    (more * 0xD6E8FEB86659FD93u);
    return (hash ^ hash >> 31) * 0x9E3779B97F4A7C15u >> 20;
}

static void grow_slots(Section *s)
{
    size_t count = max2(1024, 4 * (double)s->corner_slots.count);
    arena_release(&s->arena, s->corner_slots.items, s->corner_slots.count * sizeof(uint32_t));
    s->corner_slots.items = arena_new_array(&s->arena, uint32_t, count);
    s->corner_slots.count = count;
    for (size_t i = 0; i < s->corners.count; i++) {
        Corner   *corner = &s->corners.items[i];
        uint32_t *slot   = &s->corner_slots.items[hash_point(corner->at, 0) & (count - 1)];
        corner->next     = *slot;
        *slot            = (uint32_t)i + 1;
    }
}

const Corner *find_corner(const Section *s, const uint32_t at[2])
{
    if (s->corner_slots.count == 0)
        return NULL;
    uint32_t next = s->corner_slots.items[hash_point(at, 0) & (s->corner_slots.count - 1)];
    while (next > 0) {
        const Corner *corner = &s->corners.items[next - 1];
        if (corner->at[0] == at[0] && corner->at[1] == at[1])
            return corner;
        next = corner->next;
    }
    return NULL;
}

static void add_corner(Section *s, const uint32_t at[2], double distance)
{
    if (s->corners.count >= s->corner_slots.count)
        grow_slots(s);
    uint32_t *slot   = &s->corner_slots.items[hash_point(at, 0) & (s->corner_slots.count - 1)];
    Corner    corner = {{at[0], at[1]}, *slot, distance};
    array_push_large(&s->arena, &s->corners, corner);
    *slot = (uint32_t)s->corners.count;
}

/* Adds those corners that are new, with their distances. */
static void make_corners(Section *s, const uint32_t (*wanted)[2], size_t count)
{
    enum { MOST = 5 };
    double   points[MOST][2], distances[MOST];
    uint32_t made[MOST][2];
    size_t   fresh = 0;
    for (size_t i = 0; i < count; i++) {
        if (find_corner(s, wanted[i]))
            continue;
        memcpy(made[fresh], wanted[i], sizeof *made);
        for (int k = 0; k < 2; k++)
            points[fresh][k] = coordinate_of(s, k, wanted[i][k]);
        fresh++;
    }
    if (fresh > 0)
        slice_distances(s->field, &s->plane, (const double(*)[2])points, fresh, distances);
    for (size_t i = 0; i < fresh; i++)
        add_corner(s, made[i], distances[i]);
}

/* ---- cells ---- */

static void cell_square(const Section *s, const Cell *cell, double low[2], double high[2])
{
    for (int k = 0; k < 2; k++) {
        low[k]  = coordinate_of(s, k, cell->at[k]);
        high[k] = coordinate_of(s, k, cell->at[k] + cell->side);
    }
}

/* Tells whether a corner proves that a cell has no outline, since distances change no faster than
   points move. */
static bool is_far(const Section *s, const Cell *cell)
{
    double diagonal = 1.0001 * M_SQRT2 * s->side * ((double)cell->side / WHOLE_SIDE);
    for (uint32_t i = 0; i < 4; i++) {
        const uint32_t at[2] = {cell->at[0] + i % 2 * cell->side, cell->at[1] + i / 2 * cell->side};
        if (fabs(find_corner(s, at)->distance) > diagonal)
            return true;
    }
    return false;
}

static bool is_monotone(const LaneSlope *slope, const double direction[3])
{
    Range along = range_of(0);
    for (int k = 0; k < 3; k++)
        along = range_add(along, range_mul(slope->by[k], range_of(direction[k])));
    return along.low >= -STRAIGHT || along.high <= STRAIGHT;
}

/* ---- what is thinner than cells ---- */

/* Tells whether a value is on the other side by more than solids are thickened. */
static bool is_other(const Section *s, double distance, bool inside)
{
    return inside ? distance > s->skin : distance < -2 * s->skin;
}

/* Goes from a point of a cell along the gradient through the surface, up to a side of the cell.
   Returns a bound of the thickness of what is there, INFINITY if it is no thinner than the cell,
   and 0 if nothing is found; `at` becomes a point in it. */
static double probe_thickness(const Section *s, double side, const double from[2], double distance,
                              double at[2])
{
    enum { STEPS = 3, POINTS = 16, NOWHERE = 1000 };
    static const int halvings[POINTS] = {0,  1,  2,  3,  4,  5,  6,  8,
                                         10, 12, 14, 16, 18, 20, 22, NOWHERE};
    const bool       inside           = is_inside(distance);
    double           points[POINTS][2], distances[POINTS], gradients[2][2], pair[2][2];
    memcpy(pair[0], from, sizeof pair[0]);
    for (int step = 0; step < STEPS; step++) {
        memcpy(pair[1], pair[0], sizeof pair[1]);
        slice_gradients(s->field, &s->plane, (const double(*)[2])pair, 1e-4 * side, gradients);
        double steep = real_hypot(gradients[0][0], gradients[0][1]);
        if (!(fabs(distance) < 2 * steep * side))
            return 0;
        for (int i = 0; i < POINTS; i++) {
            double on = ldexp(side, -halvings[i]);
            for (int k = 0; k < 2; k++)
                points[i][k] = pair[0][k] -
                               gradients[0][k] / steep * (distance / steep + (inside ? -on : on));
        }
        slice_distances(s->field, &s->plane, (const double(*)[2])points, POINTS, distances);
        for (int i = 0; i < POINTS; i++)
            if (is_other(s, distances[i], inside)) {
                memcpy(at, points[i], sizeof points[i]);
                return i == 0 ? INFINITY : ldexp(side, -halvings[i - 1]);
            }
        if (!(fabs(distances[POINTS - 1]) < 0.5 * fabs(distance)))
            return 0;
        memcpy(pair[0], points[POINTS - 1], sizeof pair[0]);
        distance = distances[POINTS - 1];
    }
    return 0;
}

/* Tells whether points all along a line are on the other side. */
static bool is_joined(const Section *s, const double from[2], const double to[2], bool inside)
{
    enum { POINTS = 8 };
    double points[POINTS][2], distances[POINTS];
    bool   joined = true;
    for (int i = 0; i < POINTS; i++)
        for (int k = 0; k < 2; k++)
            points[i][k] = from[k] + (to[k] - from[k]) * (i + 1.0) / (POINTS + 1);
    slice_distances(s->field, &s->plane, (const double(*)[2])points, POINTS, distances);
    for (int i = 0; i < POINTS && joined; i++)
        joined = is_other(s, distances[i], inside);
    return joined;
}

/* Directions from a point, up to `spread` to either side of `angle`; then the angle and the point
   that were found. */
typedef struct Fan {
    double at[2], angle, spread;
    int    rounds; /* each refines the deepest direction of the one before */
} Fan;

/* Tells whether what is thin at the fan's point is joined to a point at the distance `reach` that
   is deeper than `depth`; then the fan moves to the deepest of these, and its angle leads there. */
static bool leads_to(const Section *s, Fan *fan, bool inside, double reach, double depth)
{
    enum { DIRECTIONS = MAX_FIELD_POINTS };
    double points[DIRECTIONS][2], distances[DIRECTIONS];
    double middle = fan->angle, step = 2 * fan->spread / DIRECTIONS;
    for (int round = 0; round < fan->rounds; round++, step *= 2.0 / DIRECTIONS) {
        int deepest = 0, found = -1;
        for (int i = 0; i < DIRECTIONS; i++) {
            double angle = middle + step * (i - DIRECTIONS / 2);
            points[i][0] = fan->at[0] + reach * real_cos(angle);
            points[i][1] = fan->at[1] + reach * real_sin(angle);
        }
        slice_distances(s->field, &s->plane, (const double(*)[2])points, DIRECTIONS, distances);
        for (int i = 0; i < DIRECTIONS; i++) {
            if (is_other(s, distances[i], inside) && fabs(distances[i]) > depth &&
                (found < 0 || fabs(distances[i]) > fabs(distances[found])) &&
                is_joined(s, fan->at, points[i], inside))
                found = i;
            if (inside ? distances[i] > distances[deepest] : distances[i] < distances[deepest])
                deepest = i;
        }
        fan->angle = middle += step * ((found < 0 ? deepest : found) - DIRECTIONS / 2);
        if (found < 0)
            continue;
        memcpy(fan->at, points[found], sizeof fan->at);
        return true;
    }
    return false;
}

static const double WIDER = 16; /* thicknesses away, where what is thin may be thick */

/* Tells whether what is thin at a point leads to where it is thicker; `angle` becomes the
   direction. */
static bool is_end(const Section *s, const double at[2], bool inside, double thick, double *angle)
{
    static const double DEEP = 0.6; /* a wall is half as deep as it is thick */
    Fan                 fan  = {{at[0], at[1]}, 0, M_PI, 2};
    bool                end  = leads_to(s, &fan, inside, WIDER * thick, DEEP * thick);
    *angle                   = fan.angle;
    return end;
}

/* Tells whether it leads only there, as at corners: a neck between two thick parts also continues
   behind the point, and so does a wall on a thick part. */
static bool is_tip(const Section *s, const double at[2], bool inside, double thick)
{
    enum { STEPS = 4 };
    static const double LEAST = 0.02;
    double              angle;
    if (!is_end(s, at, inside, thick, &angle))
        return false;
    Fan fan = {{at[0], at[1]}, angle + M_PI, 0.5 * M_PI, 3};
    for (int i = 0; i < STEPS; i++)
        if (!leads_to(s, &fan, inside, WIDER / STEPS * thick, LEAST * thick))
            return true;
    return false;
}

/* Probes the thickness in front of a point, and where that is thick, back from there: the point
   itself may be in what is thin. */
static double probe_both_ways(const Section *s, double side, const double from[2], double distance,
                              double at[2])
{
    double there, behind[2], thick = probe_thickness(s, side, from, distance, at);
    if (!isinf(thick))
        return thick;
    slice_distances(s->field, &s->plane, (const double(*)[2])at, 1, &there);
    double back = probe_thickness(s, side, at, there, behind);
    if (back == 0 || isinf(back))
        return thick;
    memcpy(at, behind, sizeof behind);
    return back;
}

/* Returns the least thickness that is found from the middles of the four quarters of a cell; `at`
   becomes a point there. */
static double find_thinnest(const Section *s, const Cell *cell, bool same, double at[2])
{
    const double side = s->side * ((double)cell->side / WHOLE_SIDE);
    /* A quarter without an outline has nothing to find, but where corners differ the thickness may
       show from farther away. */
    const double reach = same ? 1.0001 * 0.25 * M_SQRT2 * side : 2 * side;
    double       middles[4][2], distances[4], thinnest = 0;
    for (uint32_t i = 0; i < 4; i++) {
        middles[i][0] = coordinate_of(s, 0, cell->at[0]) + (0.25 + 0.5 * (i % 2)) * side;
        middles[i][1] = coordinate_of(s, 1, cell->at[1]) + (0.25 + 0.5 * (i / 2)) * side;
    }
    slice_distances(s->field, &s->plane, (const double(*)[2])middles, 4, distances);
    for (int i = 0; i < 4; i++) {
        double found[2];
        double thick = fabs(distances[i]) > reach
                           ? 0
                           : probe_both_ways(s, side, middles[i], distances[i], found);
        if (thick > 0 && (thinnest == 0 || thick < thinnest)) {
            thinnest = thick;
            memcpy(at, found, sizeof found);
        }
    }
    return thinnest;
}

/* Tells whether a smallest cell is split for something thinner, which corners do not tell.  Counts
   what no split would find. */
static bool hides_thin(Section *s, const Cell *cell)
{
    const bool inside = is_inside(find_corner(s, cell->at)->distance);
    bool       same   = true;
    double     at[2];
    for (uint32_t i = 1; i < 4; i++) {
        const uint32_t corner[2] = {cell->at[0] + i % 2 * cell->side,
                                    cell->at[1] + i / 2 * cell->side};
        same                     = same && is_inside(find_corner(s, corner)->distance) == inside;
    }
    const double side  = s->side * ((double)cell->side / WHOLE_SIDE);
    const double least = s->side * ((double)s->thinnest / WHOLE_SIDE);
    double       distance, angle, thick = find_thinnest(s, cell, same, at);
    if (thick == 0 || (isinf(thick) && !same))
        return false;
    slice_distances(s->field, &s->plane, (const double(*)[2])at, 1, &distance);
    const bool solid = is_inside(distance), known = !isinf(thick);
    const bool splits = cell->side > s->thinnest && 0.5 * min2(thick, side) >= least;
    if (splits && known ? is_tip(s, at, !solid, thick)
                        : is_end(s, at, !solid, min2(thick, side), &angle))
        return false;
    s->split_thin = s->split_thin || splits;
    if (!splits && same && s->lost++ == 0)
        memcpy(s->lost_at, at, sizeof at);
    return splits;
}

/* ---- the tree ---- */

typedef enum CellState { CELL_EMPTY, CELL_LEAF, CELL_SPLIT } CellState;

/* Tells whether the outline is proven to cross an edge of a cell only as its ends tell: not at all,
   or once at most. */
static bool is_plain_edge(const Section *s, const Cell *cell, int axis, uint32_t across)
{
    double    low[2], high[2];
    Range     range;
    LaneSlope slope;
    cell_square(s, cell, low, high);
    low[1 - axis] = high[1 - axis] = coordinate_of(s, 1 - axis, cell->at[1 - axis] + across);
    bool known = field_slope(s->field, slice_box(&s->plane, low, high, s->enough), &range, &slope);
    return range.low > s->skin || range.high < s->skin ||
           (known && is_monotone(&slope, axis == 0 ? s->plane.right : s->plane.up));
}

/* Tells whether signs at corners tell the topology: both derivatives keep their sign; or one does,
   so that each line along its axis is crossed once at most, and both edges across it are plain. */
static bool is_told_by_corners(const Section *s, const Cell *cell, const LaneSlope *slope)
{
    bool right = is_monotone(slope, s->plane.right), up = is_monotone(slope, s->plane.up);
    int  across = right ? 1 : 0;
    return (right && up) || ((right || up) && is_plain_edge(s, cell, across, 0) &&
                             is_plain_edge(s, cell, across, cell->side));
}

static CellState find_state(Section *s, const Cell *cell, Box box)
{
    Range     range;
    LaneSlope slope;
    if (is_far(s, cell))
        return CELL_EMPTY;
    bool known = field_slope(s->field, box, &range, &slope);
    if (range.low > s->skin || range.high < s->skin)
        return CELL_EMPTY;
    if (cell->side <= s->finest)
        return hides_thin(s, cell) ? CELL_SPLIT : CELL_LEAF;
    return known && cell->side <= COARSEST && is_told_by_corners(s, cell, &slope) ? CELL_LEAF
                                                                                  : CELL_SPLIT;
}

static bool report_progress(Section *s)
{
    if (s->progress && s->visited++ % ASK_EVERY == 0 && !s->progress(s->user, s->fraction))
        atomic_store(s->stopped, true);
    return !atomic_load_explicit(s->stopped, memory_order_relaxed);
}

static bool refine_cell(Section *s, Cell cell, int depth);

static bool refine_parts(Section *s, const Cell *cell, int depth)
{
    uint32_t       half = cell->side / 2, x = cell->at[0], y = cell->at[1];
    const uint32_t middles[5][2] = {{x + half, y},
                                    {x, y + half},
                                    {x + half, y + half},
                                    {x + cell->side, y + half},
                                    {x + half, y + cell->side}};
    make_corners(s, middles, 5);
    bool done = true;
    for (uint32_t i = 0; i < 4 && done; i++)
        done = refine_cell(s, (Cell){{x + i % 2 * half, y + i / 2 * half}, half}, depth + 1);
    return done;
}

static bool refine_cell(Section *s, Cell cell, int depth)
{
    double low[2], high[2];
    bool   enter = depth % ENTER_EVERY == 0 && s->field->region_count < MAX_REGIONS - 1;
    if (!report_progress(s))
        return false;
    cell_square(s, &cell, low, high);
    Box       box   = slice_box(&s->plane, low, high, s->enough);
    CellState state = find_state(s, &cell, box);
    if (state == CELL_LEAF)
        array_push_large(&s->arena, &s->leaves, cell);
    if (state != CELL_SPLIT)
        return true;
    if (enter)
        field_focus(s->field, box);
    bool done = refine_parts(s, &cell, depth);
    if (enter)
        field_leave(s->field);
    return done;
}

bool find_leaves(Section *s)
{
    const uint32_t corners[4][2] = {
        {0, 0}, {WHOLE_SIDE, 0}, {0, WHOLE_SIDE}, {WHOLE_SIDE, WHOLE_SIDE}};
    make_corners(s, corners, 4);
    return refine_cell(s, (Cell){{0, 0}, WHOLE_SIDE}, 0);
}

/* ---- groups ---- */

enum { FEW = MAX_FIELD_POINTS, PARTS_OF_GROUP = 16, SHORT_TAPE = 48, FEWEST = 3 };

typedef struct Square {
    double low[2], high[2];
} Square;

static Square square_of_nothing(void)
{
    return (Square){{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
}

static void widen(Square *square, const Square *by)
{
    for (int k = 0; k < 2; k++) {
        square->low[k]  = min2(square->low[k], by->low[k]);
        square->high[k] = max2(square->high[k], by->high[k]);
    }
}

static Square square_of_items(const Section *s, size_t first, size_t count, BoxOfItem *box)
{
    Square square = square_of_nothing();
    for (size_t i = 0; i < count; i++) {
        Square item;
        box(s, first + i, item.low, item.high);
        widen(&square, &item);
    }
    return square;
}

static double size_of(const Square *square)
{
    return square->high[0] - square->low[0] + square->high[1] - square->low[1];
}

/* Returns where to split items so that both halves are small: with the least sum of items times the
   size of their square. */
static size_t find_split(const Section *s, size_t first, size_t count, BoxOfItem *box)
{
    Square parts[PARTS_OF_GROUP], ahead = square_of_nothing(), behind = square_of_nothing();
    size_t part = (count + PARTS_OF_GROUP - 1) / PARTS_OF_GROUP, number = (count + part - 1) / part;
    double costs[PARTS_OF_GROUP] = {0};
    size_t best                  = 1;
    for (size_t i = 0; i < number; i++) {
        size_t from = i * part;
        parts[i] = square_of_items(s, first + from, count - from < part ? count - from : part, box);
    }
    for (size_t i = 1; i < number; i++) {
        widen(&ahead, &parts[i - 1]);
        widen(&behind, &parts[number - i]);
        costs[i] += size_of(&ahead) * (double)i;
        costs[number - i] += size_of(&behind) * (double)i;
    }
    for (size_t i = 2; i < number; i++)
        if (costs[i] < costs[best])
            best = i;
    return best * part;
}

/* Tells whether the present tape is so long that pruning it to smaller boxes pays. */
static bool is_long(const MeshField *field)
{
    const LaneTape *tape = field_tape(field);
    return tape->count > SHORT_TAPE || tape->call_count > 0;
}

static double size_of_box(const Box *box)
{
    double size = 0;
    for (int k = 0; k < 3; k++)
        size += box->axis[k].high - box->axis[k].low;
    return size;
}

bool enter_square(Section *s, const double low[2], const double high[2])
{
    static const double MUCH_SMALLER = 0.5;
    MeshField          *field        = s->field;
    Box                 box          = slice_box(&s->plane, low, high, s->enough);
    if (!is_long(field) || field->region_count == MAX_REGIONS ||
        (field->region_count > 0 &&
         size_of_box(&box) >
             MUCH_SMALLER * size_of_box(&field->regions[field->region_count - 1].box)))
        return false;
    field_focus(field, box);
    return true;
}

static void in_group(Section *s, size_t first, size_t count, BoxOfItem *box, WorkOnItems *work)
{
    Square square = square_of_items(s, first, count, box);
    bool   enter  = enter_square(s, square.low, square.high);
    if (count <= (is_long(s->field) ? FEWEST : FEW))
        work(s, first, count);
    else {
        size_t half = find_split(s, first, count, box);
        in_group(s, first, half, box, work);
        in_group(s, first + half, count - half, box, work);
    }
    if (enter)
        field_leave(s->field);
}

void in_groups(Section *s, size_t count, BoxOfItem *box, WorkOnItems *work)
{
    if (count > 0)
        in_group(s, 0, count, box, work);
}
