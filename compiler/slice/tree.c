/* tree.c: the cells of a plane that the outline goes through. */
#include "compiler/slice/section.h"

#include <string.h>

#include "compiler/base/vec.h"

enum {
    COARSEST    = WHOLE_SIDE / 16, /* side of the largest leaves */
    ENTER_EVERY = 3,               /* halvings until the field is pruned again */
    ASK_EVERY   = 256
};
/* Derivatives below that count as 0: a face that was turned by a right angle is straight. */
static const double STRAIGHT = 1e-9;

void section_root(Section *s, const double low[3], const double high[3])
{
    /* Not in the middle, so that faces and corners of what is symmetric or of whole sizes are on no edges of cells. */
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
}

/* ---- corners ---- */

uint64_t hash_place(const uint32_t at[2], uint32_t more)
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
        uint32_t *slot   = &s->corner_slots.items[hash_place(corner->at, 0) & (count - 1)];
        corner->next     = *slot;
        *slot            = (uint32_t)i + 1;
    }
}

const Corner *find_corner(const Section *s, const uint32_t at[2])
{
    if (s->corner_slots.count == 0)
        return NULL;
    uint32_t next = s->corner_slots.items[hash_place(at, 0) & (s->corner_slots.count - 1)];
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
    uint32_t *slot   = &s->corner_slots.items[hash_place(at, 0) & (s->corner_slots.count - 1)];
    Corner    corner = {{at[0], at[1]}, *slot, distance};
    array_push_large(&s->arena, &s->corners, corner);
    *slot = (uint32_t)s->corners.count;
}

/* Finds the distance at those that are new. */
static void make_corners(Section *s, const uint32_t (*places)[2], size_t count)
{
    enum { MOST = 5 };
    double   points[MOST][2], distances[MOST];
    uint32_t made[MOST][2];
    size_t   fresh = 0;
    for (size_t i = 0; i < count; i++) {
        if (find_corner(s, places[i]))
            continue;
        memcpy(made[fresh], places[i], sizeof *made);
        for (int k = 0; k < 2; k++)
            points[fresh][k] = place_of(s, k, places[i][k]);
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
        low[k]  = place_of(s, k, cell->at[k]);
        high[k] = place_of(s, k, cell->at[k] + cell->side);
    }
}

/* Distances change no faster than points move, so some corner may tell that there is no outline in a cell. */
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

typedef enum CellState { CELL_EMPTY, CELL_LEAF, CELL_SPLIT } CellState;

static CellState find_state(const Section *s, const Cell *cell, Box box)
{
    Range     range;
    LaneSlope slope;
    if (is_far(s, cell))
        return CELL_EMPTY;
    bool known = field_slope(s->field, box, &range, &slope);
    if (range.low > s->skin || range.high < s->skin)
        return CELL_EMPTY;
    if (cell->side <= s->finest)
        return CELL_LEAF;
    return known && cell->side <= COARSEST && is_monotone(&slope, s->plane.right) &&
                   is_monotone(&slope, s->plane.up)
               ? CELL_LEAF
               : CELL_SPLIT;
}

static bool goes_on(Section *s)
{
    if (s->go_on && s->looked++ % ASK_EVERY == 0 && !s->go_on(s->user))
        atomic_store(s->stopped, true);
    return !atomic_load_explicit(s->stopped, memory_order_relaxed);
}

static bool look_at_cell(Section *s, Cell cell, int depth);

static bool look_at_parts(Section *s, const Cell *cell, int depth)
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
        done = look_at_cell(s, (Cell){{x + i % 2 * half, y + i / 2 * half}, half}, depth + 1);
    return done;
}

static bool look_at_cell(Section *s, Cell cell, int depth)
{
    double low[2], high[2];
    bool   enter = depth % ENTER_EVERY == 0 && s->field->region_count < MOST_REGIONS - 1;
    if (!goes_on(s))
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
    bool done = look_at_parts(s, &cell, depth);
    if (enter)
        field_leave(s->field);
    return done;
}

bool find_leaves(Section *s)
{
    const uint32_t corners[4][2] = {
        {0, 0}, {WHOLE_SIDE, 0}, {0, WHOLE_SIDE}, {WHOLE_SIDE, WHOLE_SIDE}};
    make_corners(s, corners, 4);
    return look_at_cell(s, (Cell){{0, 0}, WHOLE_SIDE}, 0);
}

/* ---- groups ---- */

enum { FEW = MOST_FIELD_POINTS, PARTS_OF_GROUP = 16, SHORT_TAPE = 48 };

static void enter_group(Section *s, size_t first, size_t count, BoxOfItem *box)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (size_t i = 0; i < count; i++) {
        double from[2], to[2];
        box(s, first + i, from, to);
        for (int k = 0; k < 2; k++) {
            low[k]  = min2(low[k], from[k]);
            high[k] = max2(high[k], to[k]);
        }
    }
    field_focus(s->field, slice_box(&s->plane, low, high, s->enough));
}

static void in_group(Section *s, size_t first, size_t count, BoxOfItem *box, WorkOnItems *work)
{
    size_t part  = count <= FEW ? count : max2(FEW, ceil((double)count / PARTS_OF_GROUP));
    bool   enter = s->field->tape.count > SHORT_TAPE && s->field->region_count < MOST_REGIONS;
    if (count == 0)
        return;
    if (enter)
        enter_group(s, first, count, box);
    if (count <= FEW)
        work(s, first, count);
    for (size_t i = 0; count > FEW && i < count; i += part)
        in_group(s, first + i, count - i < part ? count - i : part, box, work);
    if (enter)
        field_leave(s->field);
}

void in_groups(Section *s, size_t count, BoxOfItem *box, WorkOnItems *work)
{
    in_group(s, 0, count, box, work);
}
