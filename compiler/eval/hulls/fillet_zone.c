/*
 * fillet_zone.c: where a fillet can add something to two parts.  The box is halved as long as distances
 * in the middle of a half do not tell that it is all inside of a part, or all outside of the blend.
 */
#include "compiler/eval/hulls/fillet_zone.h"

#include <math.h>

#include "compiler/base/elementary.h"
#include "compiler/base/vec.h"
#include "compiler/graph/evaluate.h"
#include "compiler/lower/context.h"

/* Larger trees are not tried: distances would cost too much. */
enum { MAX_TREE = 64 };

/* Cells are halved until they are so small, in widths. */
static const double FINE = 0.1;

/* The distances of two parts, with the slopes that they have. */
typedef struct Distances {
    Tape       tape;
    Node       roots[2];
    double     slopes[2];
    NodeValue *values;
} Distances;

/* Finds the distances of two parts; false: they depend on the frame, or are too large. */
static bool find_distances(Elaboration *e, const Shape *const parts[2], Distances *distances)
{
    Graph   *g = e->graph;
    Lowering l = {.graph = g, .scratch = e->scratch, .most = g->count + MAX_LOWERED};
    for (int k = 0; k < 2; k++) {
        if (parts[k]->tree_shapes > MAX_TREE || parts[k]->open_surfaces || parts[k]->per_frame)
            return false;
        distances->roots[k] =
            lower_shape(&l, parts[k], context_new(graph_leaf(g, OP_POINT), true)).distance;
        distances->slopes[k] = parts[k]->slope;
        if (distances->roots[k] == NODE_NONE || l.overflow)
            return false;
    }
    Graph *alone          = graph_extract_with_instances(g, distances->roots, 2, e->scratch);
    distances->tape       = tape_new(alone, distances->roots, 2, e->scratch);
    distances->values     = arena_new_array(e->scratch, NodeValue, alone->count);
    NodeValue *parameters = arena_new_array(e->scratch, NodeValue, g->parameters.count);
    tape_run_frame(&distances->tape, parameters, distances->values);
    return !tape_needs_frame(&distances->tape);
}

/* Tells whether something may be added in a ball. */
static bool adds_in(const Distances *distances, double width, const ZoneCell *cell)
{
    double away[2];
    tape_run_point(&distances->tape, cell->centre, distances->values);
    for (int k = 0; k < 2; k++) {
        const double there = distances->values[distances->roots[k]].v[0];
        const double slack = distances->slopes[k] * cell->radius;
        away[k]            = width - (there - slack);
        if (there + slack < 0 || away[k] < 0)
            return false;
    }
    return !(real_hypot(away[0], away[1]) < width); /* of the least distances in it */
}

static ZoneCell ball_of_box(Box box)
{
    ZoneCell cell = {.radius = 0.5 * box_diagonal(box)};
    box_centre(box, cell.centre);
    return cell;
}

typedef struct Boxes {
    Box   *items;
    size_t count, capacity;
} Boxes;

static void halve(Elaboration *e, Boxes *boxes, Box box)
{
    Box halves[2];
    box_halve(box, halves);
    array_push(e->values, boxes, halves[0]);
    array_push(e->values, boxes, halves[1]);
}

FilletZone fillet_zone(Elaboration *e, const Shape *a, const Shape *b, double width, Box box,
                       size_t most)
{
    const Shape *parts[]   = {a, b};
    FilletZone   zone      = {.box = box};
    Boxes        boxes     = {0};
    Distances    distances = {0};
    if (!box_is_finite(box))
        return zone;
    for (uint32_t k = 0; k < 3; k++)
        if (a->figure && k == 2)
            box.axis[k] = range_of(0);
    const GraphMark mark = graph_mark(e->graph);
    zone.known           = find_distances(e, parts, &distances);
    graph_release(e->graph, mark);
    if (zone.known)
        array_push(e->values, &boxes, box);
    for (size_t i = 0; i < boxes.count; i++) {
        const ZoneCell cell = ball_of_box(boxes.items[i]);
        if (i < most && !adds_in(&distances, width, &cell))
            continue;
        if (i < most && cell.radius > FINE * width)
            halve(e, &boxes, boxes.items[i]);
        else
            array_push(e->values, &zone.cells, cell);
    }
    arena_clear(e->scratch);
    return zone;
}

/* ---- what acts there ---- */

static double greatest_at(Elaboration *e, Node distance, const double point[3])
{
    const Node at    = graph_constant(e->graph, TYPE_VEC3, point);
    const Node there = graph_substitute(e->graph, distance, substitute_point(at), e->scratch);
    return node_range(e->builder, there, 0).high;
}

/* Tells whether a distance is above 0 somewhere in a box; it is greatest at a corner. */
static bool box_goes_beyond(Elaboration *e, const Box *box, Node distance)
{
    bool beyond = !box_is_finite(*box);
    for (int corner = 0; corner < 8 && !beyond; corner++) {
        double point[3];
        for (int k = 0; k < 3; k++)
            point[k] = corner >> k & 1 ? box->axis[k].high : box->axis[k].low;
        beyond = greatest_at(e, distance, point) > 0;
    }
    return beyond;
}

bool zone_goes_beyond(Elaboration *e, const FilletZone *zone, Node distance)
{
    const GraphMark mark   = graph_mark(e->graph);
    bool            beyond = box_goes_beyond(e, &zone->box, distance);
    bool            near   = !zone->known;
    for (size_t i = 0; i < zone->cells.count && beyond && !near; i++) {
        const ZoneCell *cell = &zone->cells.items[i];
        near                 = greatest_at(e, distance, cell->centre) + cell->radius > 0;
    }
    graph_release(e->graph, mark);
    return beyond && near;
}

bool zone_goes_beyond_plane(const FilletZone *zone, const double normal[3], double offset)
{
    double most = -offset;
    for (int k = 0; k < 3; k++)
        most += fmax(normal[k] * zone->box.axis[k].low, normal[k] * zone->box.axis[k].high);
    bool near = !zone->known;
    for (size_t i = 0; i < zone->cells.count && !near; i++) {
        const ZoneCell *cell = &zone->cells.items[i];
        near                 = dot3(normal, cell->centre) + cell->radius > offset;
    }
    return !(most <= 0) && near;
}
