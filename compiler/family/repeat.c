/*
 * repeat.c: copies in the cells of a lattice, and in sectors around an axis.
 */
#include "compiler/base/far.h"
#include "compiler/family/family.h"
#include "compiler/family/vary.h"

#include <math.h>

#include "compiler/base/elementary.h"
#include "compiler/graph/symbolic/parity.h"
#include "compiler/lower/boundary.h"
#include "compiler/lower/box_distance.h"
#include "compiler/lower/join.h"
#include "compiler/lower/map_chain.h"

/* ---- how it is made ---- */

const Shape *make_repeat(ShapeBuilder *builder, const Shape *shape, Node period,
                         const uint32_t cells[3], Node cell, Span span)
{
    if (box_is_empty(shape->box))
        return shape;
    Shape *repeat     = shape_around(builder, SHAPE_REPEAT, "repeat", shape, span);
    repeat->values[0] = period;
    repeat->values[1] = cell;
    repeat->exact     = false; /* walls of cells are bounds */
    for (uint32_t i = 0; i < 3; i++) {
        Range range      = node_range(builder, period, i);
        bool  repeats    = cells[i] != 1 && range.high > 0;
        repeat->cells[i] = repeats ? cells[i] : 1;
        if (!repeats)
            continue;
        double margin = cell_margin(shape->box.axis[i], range.low);
        if (!(margin >= -1e-9 * range.low)) {
            Range is    = shape->box.axis[i];
            Diag *diag  = diag_add(builder->diags, DIAG_OUTSIDE_CELL, span,
                                   "the shape reaches from %.4g to %.4g on the %c axis, "
                                    "its cell from %.4g to %.4g",
                                   is.low, is.high, "xyz"[i], -0.5 * range.low, 0.5 * range.low);
            diag->label = "does not fit its cell";
            diag->help  = cell == NODE_NONE
                              ? "use a larger period, or a smaller shape that is centred in its cell"
                              : "this is around what any cell can have; use a larger period, or let "
                                "less differ";
            return NULL;
        }
    }
    repeat->box = builder_box(builder, repeat);
    if (repeat->figure)
        repeat->boundary = boundary_new(builder->arena);
    return repeat;
}

const Shape *make_repeat_polar(ShapeBuilder *builder, const Shape *shape, uint32_t count, Span span)
{
    if (box_is_empty(shape->box))
        return shape;
    Shape *repeat    = shape_around(builder, SHAPE_REPEAT_POLAR, "repeat_polar", shape, span);
    repeat->cells[0] = count;
    repeat->exact    = false;
    repeat->box      = builder_box(builder, repeat);
    return repeat;
}

/* ---- how it is lowered ---- */

/*
 * The walls of cells go on for ever, and far away would still hold rays up and throw false
 * penumbras; the distance to the box of all copies is a bound as well, and there the larger one.
 */
static Lowered outside_of_box(Lowering *l, const Shape *shape, LowerContext context, Lowered result)
{
    Graph *g = l->graph;
    if (result.distance == NODE_NONE || !box_is_finite(shape->box))
        return result;
    Node around     = box_distance(g, context.point, shape->box);
    Node zero       = graph_number(g, 0);
    Node outside    = graph_op2(g, OP_less, zero, around);
    Node larger     = graph_op2(g, OP_max, result.distance, around);
    result.distance = graph_op3(g, OP_select, outside, larger, result.distance);
    return result;
}

/* Tells whether the content looks the same mirrored in the middle of its cell on an axis; `mapped`
   is OP_POINT seen by the content, which may stand rotated in its cell. */
static bool is_symmetric(Lowering *l, const Shape *content, Node mapped, uint32_t axis)
{
    Lowering alone = {.graph = l->graph, .scratch = l->scratch, .most = l->most};
    Lowered  inner = lower_shape(&alone, content, context_new(mapped, true));
    l->overflow    = l->overflow || alone.overflow;
    return inner.distance != NODE_NONE && graph_is_even(l->graph, inner.distance, axis, l->scratch);
}

/*
 * On an axis that repeats, the content lies in its cell; what are the other copies to a point?
 *   SYMMETRIC  content that is its own mirror image: the copies beyond a wall are the image of
 *              this one, and never nearer.
 *   WALLS      content that keeps a margin from the walls: the next copy is at least as far as
 *              the wall plus the margin.  The least of that and the distance inside is safe and
 *              continuous, but it is a bound only: not where a blend or an offset lies above.
 *   NEIGHBOURS else: the copy on the nearer side is evaluated as well, which is exact
 *              (math.md, section 4, "repetition").
 * Content that varies is no mirror image of its neighbours.  The farther of two may be larger, and
 * so the nearer one: its box, around the content of any cell, limits the distance (needs_limit).
 */
typedef enum CellRule { SYMMETRIC, WALLS, NEIGHBOURS } CellRule;

static CellRule choose_cell_rule(Lowering *l, const Shape *content, Node mapped, uint32_t axis,
                                 double margin, double size, bool varies, LowerContext context)
{
    if (!varies && is_symmetric(l, content, mapped, axis))
        return SYMMETRIC;
    return margin >= 0.05 * size && !context.lipschitz ? WALLS : NEIGHBOURS;
}

typedef struct Lattice {
    Node   period;    /* of the axis */
    Node   shifted;   /* coordinate, moved so that cells have whole numbers */
    Node   low, high; /* numbers of the first and the last cell; NODE_NONE: endless */
    double margin;    /* of the content */
    double min_period;
    bool   repeats;
} Lattice;

static Range frame_range(Lowering *l, Node node)
{
    if (graph_is_constant(l->graph, node))
        return (Range){l->graph->items[node].number[0], l->graph->items[node].number[0]};
    return graph_frame_range(l->graph, node, 0, l->scratch);
}

static Lattice lattice_of(Lowering *l, const Shape *shape, LowerContext context, uint32_t axis)
{
    Graph  *g     = l->graph;
    Lattice cells = {.repeats = shape->cells[axis] != 1};
    cells.shifted = graph_component(g, context.point, axis);
    if (!cells.repeats)
        return cells;
    cells.period     = graph_component(g, shape->values[0], axis);
    cells.min_period = frame_range(l, cells.period).low;
    Range content    = shape->children[0]->box.axis[axis];
    cells.margin     = cell_margin(content, cells.min_period);
    uint32_t count   = shape->cells[axis];
    /* An even number of copies is centred between two of them. */
    if (count && count % 2 == 0) {
        Node half     = graph_number(g, 0.5);
        Node offset   = graph_op2(g, OP_mul, cells.period, half);
        cells.shifted = graph_op2(g, OP_add, cells.shifted, offset);
    }
    double last = floor(count / 2);
    cells.high  = count ? graph_number(g, last) : NODE_NONE;
    cells.low   = count ? graph_number(g, last + 1 - count) : NODE_NONE;
    return cells;
}

static Node within_lattice(Graph *g, const Lattice *cells, Node number)
{
    return cells->low == NODE_NONE ? number
                                   : graph_op3(g, OP_clamp, number, cells->low, cells->high);
}

/* Returns the coordinate within the nearest cell. */
static Node in_cell(Graph *g, const Lattice *cells, Node *number)
{
    Node ratio = graph_op2(g, OP_div, cells->shifted, cells->period);
    ratio      = graph_op1(g, OP_round, ratio);
    *number    = within_lattice(g, cells, ratio);
    Node start = graph_op2(g, OP_mul, *number, cells->period);
    return graph_op2(g, OP_sub, cells->shifted, start);
}

/* Returns the coordinate within the neighbour cell on the side where the point is; the same cell
   again where there is no neighbour. */
static Node in_neighbour(Graph *g, const Lattice *cells, Node local, Node number, Node *next)
{
    Node zero = graph_number(g, 0), one = graph_number(g, 1), minus = graph_number(g, -1);
    Node left  = graph_op2(g, OP_less, local, zero);
    Node side  = graph_op3(g, OP_select, left, minus, one);
    *next      = within_lattice(g, cells, graph_op2(g, OP_add, number, side));
    Node start = graph_op2(g, OP_mul, *next, cells->period);
    return graph_op2(g, OP_sub, cells->shifted, start);
}

/* Returns the distance to the wall of the nearest existing neighbour, plus the margin behind it. */
static Node wall_distance(Graph *g, const Lattice *cells, Node local, Node number)
{
    Node half  = graph_number(g, 0.5);
    Node wall  = graph_op2(g, OP_mul, cells->period, half);
    Node right = graph_op2(g, OP_sub, wall, local);
    Node left  = graph_op2(g, OP_add, wall, local);
    if (cells->low != NODE_NONE) {
        Node far   = graph_number(g, NOWHERE);
        Node first = graph_op2(g, OP_less_equal, number, cells->low);
        Node last  = graph_op2(g, OP_less_equal, cells->high, number);
        left       = graph_op3(g, OP_select, first, far, left);
        right      = graph_op3(g, OP_select, last, far, right);
    }
    Node nearer = graph_op2(g, OP_min, left, right);
    Node margin = graph_number(g, cells->margin);
    return graph_op2(g, OP_add, nearer, margin);
}

/*
 * Tells whether the distance of copies needs a limit.  Which neighbour counts changes in the middle
 * of a cell.  Of exact distances the cell's own is the least there.  Of bounds either neighbour's
 * may be, and where something above needs the slope, the distance must not jump.  So it is limited:
 * in the middle of a cell to the distance to the sides of the next copy's box, and copies'
 * distances are made no less than that.  From there the limit grows with the coordinate, and it is
 * the same on both sides of a wall.
 */
static bool needs_limit(const Shape *content, LowerContext context)
{
    return context.lipschitz && !content->exact;
}

/* Returns the number of a cell: whole numbers from 0 on an axis with a count, in the range of the
   leaf.  NODE_NONE: nobody asks. */
static Node cell_number(Graph *g, const Shape *shape, const Lattice *cells, Node number)
{
    if (shape->values[1] == NODE_NONE)
        return NODE_NONE;
    if (!cells->repeats)
        return graph_number(g, 0);
    if (cells->low != NODE_NONE)
        return graph_op2(g, OP_sub, number, cells->low);
    Node end = graph_number(g, MAX_CELL_NUMBER), start = graph_number(g, -MAX_CELL_NUMBER);
    return graph_op3(g, OP_clamp, number, start, end);
}

/* The cells of one axis: where the point is in its own cell and in the neighbour's, and what these
   are called. */
typedef struct CellAxis {
    Node own, other, own_number, other_number;
    bool neighbour; /* counts */
} CellAxis;

/* Bounds by the walls and by what is not looked at; NODE_NONE: there is none. */
typedef struct CellBounds {
    Node walls, limit;
} CellBounds;

static Node limit_in_cell(Graph *g, const Lattice *cells, Range content, Node local)
{
    Node half   = graph_number(g, fmax(-content.low, content.high));
    Node offset = graph_op1(g, OP_abs, local);
    Node next   = graph_op2(g, OP_sub, cells->period, half);
    return graph_op2(g, OP_add, offset, next);
}

/* Cuts a distance to its limit.  With limits it is small far from all copies; that to the sides of
   their box is not, and it is a bound. */
static Lowered cut_to_limit(Lowering *l, const Shape *shape, LowerContext context, Lowered result,
                            Node limit)
{
    Graph *g = l->graph;
    if (limit == NODE_NONE || result.distance == NODE_NONE)
        return result;
    result.distance = graph_op2(g, OP_min, result.distance, limit);
    if (box_is_finite(shape->box))
        return outside_of_box(l, shape, context, result);
    Node excess = sides_excess(g, context.point, shape->box);
    if (excess != NODE_NONE)
        result.distance = graph_op2(g, OP_max, result.distance, excess);
    return result;
}

/* Joins the copy in the point's own cell with those in the neighbour cells that count: at most one
   on each axis, so the cells of a corner. */
static Lowered join_neighbours(Lowering *l, const Shape *shape, LowerContext context,
                               const CellAxis axes[3])
{
    Graph  *g       = l->graph;
    bool    operand = needs_limit(shape->children[0], context);
    Lowered result  = lowered_nothing;
    for (uint32_t corner = 0; corner < 8; corner++) {
        Node coordinates[3], numbers[3];
        bool exists = true;
        for (uint32_t i = 0; i < 3; i++) {
            bool across    = corner >> i & 1;
            exists         = exists && (!across || axes[i].neighbour);
            coordinates[i] = across ? axes[i].other : axes[i].own;
            numbers[i]     = across ? axes[i].other_number : axes[i].own_number;
        }
        if (!exists)
            continue;
        LowerContext there = context_at(context, graph_op(g, OP_vec3, coordinates));
        bool         named = shape->values[1] != NODE_NONE;
        Node         cell  = named ? graph_op(g, OP_vec3, numbers) : NODE_NONE;
        Lowered      copy  = lower_in_cell(l, shape, there, cell, operand);
        result             = join_two(l, blend_sharp, result, copy);
    }
    return result;
}

static CellAxis lower_axis(Lowering *l, const Shape *shape, LowerContext context, uint32_t i,
                           bool varies, CellBounds *bounds)
{
    Graph       *g       = l->graph;
    const Shape *content = shape->children[0];
    Lattice      cells   = lattice_of(l, shape, context, i);
    CellAxis     axis    = {.own = cells.shifted};
    Node         number  = NODE_NONE, next;
    if (cells.repeats)
        axis.own = in_cell(g, &cells, &number);
    axis.own_number = cell_number(g, shape, &cells, number);
    if (!cells.repeats)
        return axis;
    CellRule rule  = choose_cell_rule(l, content, graph_leaf(g, OP_POINT), i, cells.margin,
                                      cells.min_period, varies, context);
    axis.neighbour = rule == NEIGHBOURS;
    if (axis.neighbour) {
        axis.other        = in_neighbour(g, &cells, axis.own, number, &next);
        axis.other_number = cell_number(g, shape, &cells, next);
    }
    if (axis.neighbour && (varies || needs_limit(content, context)))
        bounds->limit = nearer_of(g, bounds->limit,
                                  limit_in_cell(g, &cells, content->box.axis[i], axis.own));
    if (rule == WALLS)
        bounds->walls = nearer_of(g, bounds->walls, wall_distance(g, &cells, axis.own, number));
    return axis;
}

static Lowered repeat_by_cells(Lowering *l, const Shape *shape, LowerContext context)
{
    CellBounds bounds = {NODE_NONE, NODE_NONE};
    CellAxis   axes[3];
    bool       varies = content_varies(l, shape);
    for (uint32_t i = 0; i < 3; i++)
        axes[i] = lower_axis(l, shape, context, i, varies, &bounds);
    Lowered result = join_neighbours(l, shape, context, axes);
    result         = cut_to_limit(l, shape, context, result, bounds.limit);
    if (bounds.walls == NODE_NONE || result.distance == NODE_NONE)
        return result;
    result.distance = graph_op2(l->graph, OP_min, result.distance, bounds.walls);
    return outside_of_box(l, shape, context, result);
}

Lowered lower_repeat(Lowering *l, const Shape *shape, LowerContext context)
{
    return lower_within_boundary(l, shape, context, context.point, repeat_by_cells);
}

static bool range_is_finite(Range range) { return isfinite(range.low) && isfinite(range.high); }

/* Tells whether a box ends in all directions across y. */
static bool ends_across(Box box)
{
    return range_is_finite(box.axis[0]) && range_is_finite(box.axis[2]);
}

/* Returns a rotation about y that brings an angle to the x axis. */
static Node rotate_about_y(Graph *g, Node point, double angle)
{
    double c = real_cos(angle), s = real_sin(angle);
    Node   r0 = graph_vec3(g, c, 0, s), r1 = graph_vec3(g, 0, 1, 0), r2 = graph_vec3(g, -s, 0, c);
    return angle == 0 ? point : graph_op4(g, OP_rotate, point, r0, r1, r2);
}

/* Tells how far the content, rotated by -angle, stays from the walls of the sector around +x.  What
   has no end across the axis is taken to cross them. */
static double sector_margin(Box content, double angle, double half_sector)
{
    double least = INFINITY, c = real_cos(angle), s = real_sin(angle);
    if (!ends_across(content))
        return -INFINITY;
    for (int corner = 0; corner < 4; corner++) {
        double x     = corner & 1 ? content.axis[0].high : content.axis[0].low;
        double z     = corner & 2 ? content.axis[2].high : content.axis[2].low;
        double along = c * x + s * z, across = -s * x + c * z;
        least = fmin(least, along * real_sin(half_sector) - fabs(across) * real_cos(half_sector));
    }
    return least;
}

/* Lowers a copy that stands rotated about y. */
static Lowered lower_rotated(Lowering *l, const Shape *content, LowerContext context, Node point)
{
    NormalPath path = normal_path(l, context, 1);
    normal_rotate_about_y(l, &path, context.point, point);
    return lower_behind(l, content, context, &path, point);
}

static Lowered all_around(Lowering *l, const Shape *shape, LowerContext context, uint32_t first,
                          uint32_t count)
{
    if (count == 1) {
        Node point = rotate_about_y(l->graph, context.point, 2 * M_PI * first / shape->cells[0]);
        return lower_rotated(l, shape->children[0], context, point);
    }
    Lowered a = all_around(l, shape, context, first, count / 2);
    Lowered b = all_around(l, shape, context, first + count / 2, count - count / 2);
    return join_two(l, blend_sharp, a, b);
}

/* Returns where a point is, seen from the sector next to its own on its side, rotated towards
   +x. */
static Node in_next_sector(Graph *g, const Shape *shape, Node local)
{
    double sector = 2 * (M_PI / shape->cells[0]);
    Node   z = graph_component(g, local, 2), zero = graph_number(g, 0);
    Node   right = graph_op2(g, OP_less, zero, z);
    Node   plus  = rotate_about_y(g, local, sector);
    Node   minus = rotate_about_y(g, local, -sector);
    return graph_op3(g, OP_select, right, plus, minus);
}

/* A sector around +x and its content, which stands rotated by `angle` and keeps a margin from both
   walls. */
typedef struct Sector {
    double half, angle, margin;
} Sector;

/* Returns x sin(half) + factor |z| cos(half): with -1 the distance to the nearer wall, and with 1
   what is the same in the middle and grows from there. */
static Node across_sector(Graph *g, const Sector *sector, Node local, double factor)
{
    Node z = graph_component(g, local, 2), x = graph_component(g, local, 0);
    Node sine    = graph_number(g, real_sin(sector->half));
    Node cosine  = graph_number(g, factor * real_cos(sector->half));
    Node along   = graph_op2(g, OP_mul, x, sine);
    Node lateral = graph_op1(g, OP_abs, z);
    lateral      = graph_op2(g, OP_mul, lateral, cosine);
    return graph_op2(g, OP_add, along, lateral);
}

/* Returns the distance to the nearer wall, plus the margin behind it; or what takes its place as a
   limit. */
static Node sector_wall(Graph *g, const Sector *sector, Node local, double factor)
{
    Node wall = across_sector(g, sector, local, factor);
    return graph_op2(g, OP_add, wall, graph_number(g, sector->margin));
}

/* Lowers the content, seen from a place in its sector or next to it. */
static Lowered lower_in_sector(Lowering *l, const Shape *shape, LowerContext context,
                               const Sector *sector, Node local)
{
    Graph  *g      = l->graph;
    Node    point  = rotate_about_y(g, local, -sector->angle);
    Lowered result = lower_rotated(l, shape->children[0], context, point);
    if (result.distance == NODE_NONE || !needs_limit(shape->children[0], context))
        return result;
    Node wall       = across_sector(g, sector, local, -1);
    Node excess     = graph_op2(g, OP_sub, graph_number(g, sector->margin), wall);
    result.distance = graph_op2(g, OP_max, result.distance, excess);
    return result;
}

/* Copies around y: the point is rotated into the sector of the content, and the sectors join as
   cells do.  Content that crosses the walls is written out, copy by copy. */
Lowered lower_repeat_polar(Lowering *l, const Shape *shape, LowerContext context)
{
    Graph       *g       = l->graph;
    const Shape *content = shape->children[0];
    double       centre[3];
    box_centre(content->box, centre);
    Sector sector = {.half = M_PI / shape->cells[0]};
    sector.angle  = ends_across(content->box) ? real_atan2(centre[2], centre[0]) : 0;
    sector.margin = sector_margin(content->box, sector.angle, sector.half);
    if (shape->cells[0] < 3 || sector.margin < 0)
        return all_around(l, shape, context, 0, shape->cells[0]);

    Node     facing = rotate_about_y(g, context.point, sector.angle);
    Node     count  = graph_number(g, shape->cells[0]);
    Node     local  = graph_op2(g, OP_cell_polar, facing, count);
    Lowered  result = lower_in_sector(l, shape, context, &sector, local);
    Node     mapped = rotate_about_y(g, graph_leaf(g, OP_POINT), -sector.angle);
    double   width  = real_hypot(centre[0], centre[2]) * real_sin(sector.half);
    CellRule rule   = choose_cell_rule(l, content, mapped, 2, sector.margin, width, false, context);
    if (rule == SYMMETRIC || result.distance == NODE_NONE)
        return result;
    if (rule == NEIGHBOURS) {
        Node    next  = in_next_sector(g, shape, local);
        Lowered copy  = lower_in_sector(l, shape, context, &sector, next);
        bool    cut   = needs_limit(content, context);
        Node    limit = cut ? sector_wall(g, &sector, local, 1) : NODE_NONE;
        return cut_to_limit(l, shape, context, join_two(l, blend_sharp, result, copy), limit);
    }
    Node wall       = sector_wall(g, &sector, local, -1);
    result.distance = graph_op2(g, OP_min, result.distance, wall);
    return outside_of_box(l, shape, context, result);
}
