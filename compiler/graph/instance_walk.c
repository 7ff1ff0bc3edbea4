/*
 * instance_walk.c: which instances of an instance group count at a point.
 */
#include "compiler/graph/instance_walk.h"

#include <math.h>

#include "compiler/base/bits.h"
#include "compiler/base/elementary.h"
#include "compiler/base/far.h"

void instance_walk_begin(InstanceWalk *walk, const InstanceFunction *function,
                         const InstanceTable *table, const double point[3], bool by_cells)
{
    walk->function   = function;
    walk->table      = table;
    walk->to_nearest = function->distance != NO_DISTANCE && !by_cells;
    walk->by_list    = true;
    for (int k = 0; k < 3; k++)
        walk->point[k] = point[k];
    walk->list   = grid_find(&table->cells, point, &walk->left, &walk->clearance);
    walk->radius = fabs(walk->clearance);
    walk->clear  = function->either ? walk->radius * (1 - 0x1p-20) : 0;
    walk->wider  = table->grid.size;
}

void instance_walk_along(InstanceWalk *walk, const InstanceFunction *function,
                         const uint32_t *instances, uint32_t count)
{
    walk->function   = function;
    walk->to_nearest = false;
    walk->by_list    = true;
    walk->list       = instances;
    walk->left       = count;
    walk->clearance  = INFINITY;
}

/* Returns the distance beyond which nothing is nearer than what is found. */
static double how_far(const InstanceWalk *walk, double distance)
{
    return (walk->function->either ? fabs(distance) : distance) * walk->table->stretch;
}

/* Tells whether an instance may be nearer than what is found. */
static bool may_count(const InstanceWalk *walk, uint32_t instance, double distance)
{
    const Box *boxes = walk->table->boxes;
    return !boxes || distance_to_box(&boxes[instance], walk->point) <= how_far(walk, distance);
}

/* Finds instances from near.first on; false: there are none. */
static bool find_near(InstanceWalk *walk)
{
    uint32_t rows = walk->table->rows;
    if (walk->near.first >= rows)
        return false;
    walk->near.count = rows - walk->near.first < NEAR_AT_ONCE ? rows - walk->near.first
                                                              : NEAR_AT_ONCE;
    grid_near(&walk->table->grid, walk->point, walk->radius, walk->clear, &walk->near);
    walk->word = 0;
    walk->bits = walk->near.bits[0];
    return true;
}

/* Finds the next bits that are not all 0; false: there are none. */
static bool find_bits(InstanceWalk *walk)
{
    while (walk->bits == 0)
        if (++walk->word < (walk->near.count + 63) / 64) {
            walk->bits = walk->near.bits[walk->word];
        } else {
            walk->near.first += walk->near.count;
            if (!find_near(walk))
                return false;
        }
    return true;
}

static bool next_near(InstanceWalk *walk, double distance, uint32_t *instance)
{
    while (find_bits(walk)) {
        *instance = walk->near.first + 64 * walk->word + lowest_bit(walk->bits);
        walk->bits &= walk->bits - 1;
        if (may_count(walk, *instance, distance))
            return true;
    }
    return false;
}

/* Goes on from what was looked at to all that may be as near as what is found.  The second time
   that is enough: each further instance only makes a distance less. */
InstanceStep instance_walk_widen(InstanceWalk *walk, double distance)
{
    if (!walk->to_nearest || !(how_far(walk, distance) > walk->radius && walk->radius < NOWHERE) ||
        grid_is_within(&walk->table->grid, walk->point, walk->radius))
        return INSTANCE_DONE;
    walk->radius = fabs(distance) < NOWHERE ? how_far(walk, distance) : walk->radius + walk->wider;
    walk->wider *= 2;
    walk->near.first = 0;
    walk->by_list    = false;
    find_near(walk);
    return INSTANCE_AGAIN;
}

bool instance_walk_find(InstanceWalk *walk, double distance, uint32_t *instance)
{
    if (walk->left > 0) {
        walk->left--;
        *instance = *walk->list++;
        return true;
    }
    return !walk->by_list && next_near(walk, distance, instance);
}

InstanceStep instance_walk_next(InstanceWalk *walk, double distance, uint32_t *instance)
{
    return instance_walk_find(walk, distance, instance) ? INSTANCE_NEXT
                                                        : instance_walk_widen(walk, distance);
}

/* Returns what the operation behind the bodies makes of the states. */
static double joined(const InstanceFunction *function, const Graph *graph, const NodeValue *states)
{
    const Node  body = graph->instances->bodies.items[function->first_body + function->state_count];
    const Expr *e    = &graph->items[body];
    GraphType   types[MAX_OPERANDS];
    for (uint32_t k = 0; k < e->operand_count; k++)
        types[k] = function->states[k].type;
    return op_evaluate((Op)e->op, (GraphType)e->type, 0, types, states).v[0];
}

/* Returns the value when the states have ended; without an instance a sum is 0. */
static double end_of_states(const InstanceFunction *function, const Graph *graph,
                            const NodeValue *states)
{
    return function->joins  ? joined(function, graph, states)
           : function->sums ? states[0].v[0] - states[2].v[0] * real_log(fmax(states[1].v[0], 1))
                            : states[0].v[0];
}

static NodeValue listed_state(const InstanceWalk *walk, const Graph *graph, const NodeValue *states)
{
    const InstanceFunction *function = walk->function;
    const InstanceState    *state    = &function->states[function->listed];
    NodeValue               none     = {{0}};
    if (walk->to_nearest || !function->clear ||
        end_of_states(function, graph, states) < walk->clearance)
        return states[function->listed];
    for (uint32_t c = 0; c < components(state->type); c++)
        none.v[c] = function->listed == 0 && c == 0 ? walk->clearance : state->first[c];
    return none;
}

NodeValue instance_walk_result(const InstanceWalk *walk, const Graph *graph,
                               const NodeValue *states)
{
    const InstanceFunction *function = walk->function;
    NodeValue               result   = states[0];
    if (function->joins && function->listed != NOT_LISTED)
        return listed_state(walk, graph, states);
    result.v[0] = end_of_states(function, graph, states);
    if (walk->to_nearest || !function->clear)
        return result;
    if (function->either)
        result.v[0] = fabs(result.v[0]) < fabs(walk->clearance) ? result.v[0] : walk->clearance;
    else
        result.v[0] = fmin(result.v[0], walk->clearance);
    return result;
}

double instance_arc_min_distance(const InstanceArc *arc, const double point[2])
{
    double chord[2], from[2], square = 0, along = 0;
    for (int k = 0; k < 2; k++) {
        chord[k] = 2 * arc->tangent[k] + arc->bend[k];
        from[k]  = point[k] - arc->start[k];
        square += chord[k] * chord[k];
        along += chord[k] * from[k];
    }
    const double t = square > 0 ? min2(max2(along / square, 0), 1) : 0;
    const double x = from[0] - t * chord[0], y = from[1] - t * chord[1];
    return sqrt(x * x + y * y) -
           0.25 * sqrt(arc->bend[0] * arc->bend[0] + arc->bend[1] * arc->bend[1]);
}
