/* chords.c: finds where the outline crosses the edges of cells, and joins these crossings in each
   cell. */
#include "slice/section.h"

#include <string.h>

/* ---- edges ---- */

/* Calls `visit` for the shortest edges of cells along an edge, from its lower end to its upper one
   or back: smaller cells beside it have corners on it. */
typedef void VisitEdge(Section *s, const uint32_t at[2], int axis, uint32_t side);

static void visit_edge(Section *s, const uint32_t at[2], int axis, uint32_t side, bool back,
                       VisitEdge *visit)
{
    uint32_t middle[2] = {at[0], at[1]};
    middle[axis] += side / 2;
    if (side < 2 || !find_corner(s, middle)) {
        visit(s, at, axis, side);
        return;
    }
    visit_edge(s, back ? middle : at, axis, side / 2, back, visit);
    visit_edge(s, back ? at : middle, axis, side / 2, back, visit);
}

/* Visits the edges of a cell counter-clockwise. */
static void visit_cell(Section *s, const Cell *cell, VisitEdge *visit)
{
    uint32_t x = cell->at[0], y = cell->at[1], side = cell->side;
    visit_edge(s, (uint32_t[2]){x, y}, 0, side, false, visit);
    visit_edge(s, (uint32_t[2]){x + side, y}, 1, side, false, visit);
    visit_edge(s, (uint32_t[2]){x, y + side}, 0, side, true, visit);
    visit_edge(s, (uint32_t[2]){x, y}, 1, side, true, visit);
}

/* ---- crossings ---- */

static uint32_t *crossing_slot(const Section *s, const uint32_t at[2], int axis)
{
    return &s->crossing_slots
                .items[hash_point(at, (uint32_t)axis + 1) & (s->crossing_slots.count - 1)];
}

/* Returns the crossing of an edge, or NULL; its length does not matter, since no two edges have the
   same beginning and axis. */
static Crossing *find_crossing(const Section *s, const uint32_t at[2], int axis)
{
    uint32_t next = *crossing_slot(s, at, axis);
    while (next > 0) {
        Crossing *crossing = &s->crossings.items[next - 1];
        if (crossing->at[0] == at[0] && crossing->at[1] == at[1] && crossing->axis == axis)
            return crossing;
        next = crossing->next;
    }
    return NULL;
}

static bool crosses(const Section *s, const uint32_t at[2], int axis, uint32_t side, bool *first)
{
    uint32_t end[2] = {at[0], at[1]};
    end[axis] += side;
    *first = is_inside(find_corner(s, at)->distance);
    return *first != is_inside(find_corner(s, end)->distance);
}

static void add_crossing(Section *s, const uint32_t at[2], int axis, uint32_t side)
{
    bool first;
    if (!crosses(s, at, axis, side, &first) || find_crossing(s, at, axis))
        return;
    uint32_t *slot     = crossing_slot(s, at, axis);
    Crossing  crossing = {.at           = {at[0], at[1]},
                          .side         = side,
                          .next         = *slot,
                          .axis         = (uint8_t)axis,
                          .inside_first = first};
    array_push_large(&s->arena, &s->crossings, crossing);
    *slot = (uint32_t)s->crossings.count;
}

static void crossing_ends(const Section *s, const Crossing *crossing, double low[2], double high[2])
{
    for (int k = 0; k < 2; k++) {
        low[k]  = coordinate_of(s, k, crossing->at[k]);
        high[k] = coordinate_of(s, k, crossing->at[k] + (k == crossing->axis ? crossing->side : 0));
    }
}

static void box_of_crossing(const Section *s, size_t item, double low[2], double high[2])
{
    crossing_ends(s, &s->crossings.items[item], low, high);
}

static void find_points(Section *s, size_t first, size_t count)
{
    PlaneRoot roots[MAX_FIELD_POINTS];
    for (size_t i = 0; i < count; i++) {
        const Crossing *crossing = &s->crossings.items[first + i];
        PlaneRoot      *root     = &roots[i];
        uint32_t        end[2]   = {crossing->at[0], crossing->at[1]};
        end[crossing->axis] += crossing->side;
        double at_low = find_corner(s, crossing->at)->distance;
        double at_end = find_corner(s, end)->distance;
        bool   ahead  = crossing->inside_first;
        crossing_ends(s, crossing, ahead ? root->inside : root->outside,
                      ahead ? root->outside : root->inside);
        root->at_inside  = ahead ? at_low : at_end;
        root->at_outside = ahead ? at_end : at_low;
    }
    slice_roots(s->field, &s->plane, roots, count, s->enough);
    for (size_t i = 0; i < count; i++)
        memcpy(s->crossings.items[first + i].point, roots[i].at, sizeof roots[i].at);
}

static void find_crossings(Section *s)
{
    size_t slots = 1024;
    while (slots < 2 * s->leaves.count)
        slots *= 2;
    s->crossing_slots.items = arena_new_array(&s->arena, uint32_t, slots);
    s->crossing_slots.count = slots;
    for (size_t i = 0; i < s->leaves.count; i++)
        visit_cell(s, &s->leaves.items[i], add_crossing);
    in_groups(s, s->crossings.count, box_of_crossing, find_points);
}

/* ---- chords ---- */

/* Lists a crossing of the present cell, in the order around it. */
static void note_crossing(Section *s, const uint32_t at[2], int axis, uint32_t side)
{
    bool first;
    if (crosses(s, at, axis, side, &first)) {
        uint32_t number = (uint32_t)(find_crossing(s, at, axis) - s->crossings.items);
        array_push(&s->arena, &s->around, number);
    }
}

/* Tells whether the border of a cell, counter-clockwise, leaves the solid at a crossing. */
static bool is_exit(const Cell *cell, const Crossing *crossing)
{
    bool ahead = crossing->axis == 0 ? crossing->at[1] == cell->at[1]
                                     : crossing->at[0] != cell->at[0];
    return crossing->inside_first == ahead;
}

static bool has_solid_middle(const Section *s, const Cell *cell)
{
    double at[2], distance;
    for (int k = 0; k < 2; k++)
        at[k] = coordinate_of(s, k, cell->at[k]) +
                0.5 * s->side * ((double)cell->side / WHOLE_SIDE);
    slice_distances(s->field, &s->plane, (const double(*)[2])at, 1, &distance);
    return is_inside(distance);
}

/* Adds chords from where the border leaves the solid to where it was entered before or, if the
   solid is connected in the middle, will be entered next. */
static void join_crossings(Section *s, const Cell *cell)
{
    size_t count = s->around.count;
    bool   ahead = count > 2 && has_solid_middle(s, cell);
    for (size_t i = 0; i < count; i++) {
        uint32_t from = s->around.items[i],
                 to   = s->around.items[(i + (ahead ? 1 : count - 1)) % count];
        if (!is_exit(cell, &s->crossings.items[from]))
            continue;
        Chord chord = {.from = from, .to = to};
        array_push_large(&s->arena, &s->chords, chord);
        s->crossings.items[from].chord = (uint32_t)s->chords.count;
    }
}

void find_chords(Section *s)
{
    find_crossings(s);
    for (size_t i = 0; i < s->leaves.count; i++) {
        s->around.count = 0;
        visit_cell(s, &s->leaves.items[i], note_crossing);
        join_crossings(s, &s->leaves.items[i]);
    }
}
