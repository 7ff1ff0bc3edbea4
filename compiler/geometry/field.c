/*
 * field.c: solids given by an expression that is negative inside: `field` and `algebraic`.
 *
 * Polynomials need no bound from outside.  About every point their series says how fast they can
 * change at most, and the distance is the radius within which that cannot make up for the value:
 *     S(r) = c1 r + c2 r^2 + ... + cn r^n = |c0|       (series.h; math.md, section 3)
 * The root r* is below the distance to the surface, and it changes no faster than the point moves:
 * the series about p + h is at most the one about p, shifted by |h|, so a ball around p holds the
 * balls around its points.  (The k-th order of the shifted series is bounded by derivatives of
 * the orders above, and sup |D Q| = k sup |Q| on the unit sphere for a form Q of degree k, by
 * Banach.)  So it may be blended and offset, and stand in sequences and under maps.
 *
 * Other expressions are divided by their slope.  Where that has no bound, or a bad one, a region
 * C is needed: `.within` hands it down.  At a point q with its nearest point c in C,
 *     hypot(|q - c|, max(f(c) / L, 0)),   L the slope over C,
 * is below the distance to what is in C, since |q - s|^2 >= |q - c|^2 + |c - s|^2 for s in C, and
 * 1-Lipschitz.  Where f(c) < 0 the solid ends at the sides of C: within it the value is
 * max(f / L, -distance to them), so that nothing jumps there.  A second, sharper bound counts with the slope where the point is:
 *     |f| = |grad f| r + H r^2 / 2,   H the slope of the gradient over C.
 */
#include "compiler/geometry/elaborate.h"

#include <math.h>

#include "compiler/geometry/lower.h"
#include "compiler/graph/derive.h"
#include "compiler/graph/evaluate.h"
#include "compiler/graph/series.h"

enum { CELLS = 512 };

/* Keeps quotients finite; below every coefficient that counts in single precision. */
static const double TINY = 1e-30;

/* ---- polynomials ---- */

static Node at_least(Graph *g, Node node, double least)
{
    return graph_op2(g, OP_max, node, graph_number(g, least));
}

static Node series_distance(Graph *g, const Series *s)
{
    Node sign = graph_op1(g, OP_sign, s->c[0]);
    return graph_op2(g, OP_mul, sign, series_radius(g, s));
}

static const Shape *refuse_polynomial(Elaboration *e, SeriesFault fault, const Syntax *place)
{
    Span span = e->graph->items[fault.blame].span;
    span      = span.source ? span : place->span;
    if (fault.degree > 0) {
        Diag *diag  = diag_add(e->diags, DIAG_NOT_POLYNOMIAL, span,
                               "a polynomial of degree %u is too high", fault.degree);
        diag->label = diag_text(e->diags, "at most %d are possible", MOST_DEGREE);
        return NULL;
    }
    Diag *diag = diag_add(e->diags, DIAG_NOT_POLYNOMIAL, span, "the equation is not a polynomial");
    const char *name = graph_op_name(e->graph->items[fault.blame].op);
    diag->label      = diag_text(e->diags, "`%s` of coordinates is none", name);
    diag_place(e->diags, diag, place->span, "in this equation");
    diag->help = "`field(...)` takes any expression";
    return NULL;
}

/* ---- other expressions ---- */

/* Where a point of all space is looked at: the nearest in C. */
static Node nearest_in(Graph *g, Node point, Box box)
{
    double low[3], high[3];
    for (int i = 0; i < 3; i++) {
        low[i]  = box.axis[i].low;
        high[i] = box.axis[i].high;
    }
    Node least = graph_constant(g, TYPE_VEC3, low), most = graph_constant(g, TYPE_VEC3, high);
    return graph_op3(g, OP_clamp, point, least, most);
}

/* A bound on the distance at the point's nearest point in C, brought out to the point. */
static Node brought_out(Graph *g, Node bound, Box box)
{
    if (!box_is_finite(box))
        return bound;
    Node point   = graph_leaf(g, OP_POINT), zero = graph_number(g, 0);
    Node away    = box_distance(g, point, box);
    Node outside = graph_op2(g, OP_max, bound, zero);
    Node sides   = beyond_sides(g, point, box);
    Node inside  = sides == NODE_NONE ? bound : graph_op2(g, OP_max, bound, sides);
    inside       = graph_op2(g, OP_min, inside, zero);
    Node both    = graph_op1(g, OP_length, graph_op2(g, OP_vec2, away, outside));
    return graph_op2(g, OP_add, both, inside);
}

static Node at_nearest(Elaboration *e, Node formula, Box box)
{
    if (!box_is_finite(box))
        return formula;
    Node         point = nearest_in(e->graph, graph_leaf(e->graph, OP_POINT), box);
    Substitution with  = {.point = point, .instance = NODE_NONE, .level = NODE_NONE};
    return graph_substitute(e->graph, formula, with, e->scratch);
}

Node bring_out(Elaboration *e, Node formula, double slope, Box box)
{
    Node inner = at_nearest(e, formula, box);
    return brought_out(e->graph, divide_by_slope(e->graph, inner, slope), box);
}

/* r of |f| = |grad f| r + H r^2 / 2, with the sign of f. */
static Node second_order(Graph *g, Node f, Node gradient, double bend)
{
    Node size    = graph_op1(g, OP_abs, f);
    Node steep   = graph_op1(g, OP_length, gradient);
    Node squared = graph_op2(g, OP_dot, gradient, gradient);
    Node room    = graph_op2(g, OP_mul, size, graph_number(g, 2 * bend));
    Node root    = graph_op1(g, OP_sqrt, graph_op2(g, OP_add, squared, room));
    Node sum     = at_least(g, graph_op2(g, OP_add, steep, root), TINY);
    Node twice   = graph_op2(g, OP_mul, f, graph_number(g, 2));
    return graph_op2(g, OP_div, twice, sum);
}

/* How much longer the steps of `sharp` are than those of `plain`, on average over a box; both are
   evaluated at the parameters' defaults. */
static double gain_of(Elaboration *e, Node sharp, Node plain, Box box)
{
    enum { SAMPLES = 200 };
    Node       roots[2]   = {sharp, plain};
    Tape       tape       = tape_new(e->graph, roots, 2, e->scratch);
    NodeValue *values     = arena_new_array(e->scratch, NodeValue, e->graph->count);
    NodeValue *parameters = arena_new_array(e->scratch, NodeValue, e->graph->parameters.count);
    for (size_t i = 0; i < e->scene->parameters.count; i++) {
        const Parameter *parameter = &e->scene->parameters.items[i];
        for (int k = 0; k < 4; k++)
            parameters[parameter->slot].v[k] = parameter->value[k];
    }
    tape_run_frame(&tape, parameters, values);
    double sum = 0;
    int    count = 0;
    for (uint32_t i = 0; i < SAMPLES; i++) {
        /* Roberts' sequence in three dimensions. */
        static const double steps[3] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
        double              point[3];
        for (int k = 0; k < 3; k++) {
            double t = fmod(0.5 + (i + 1) * steps[k], 1);
            point[k] = box.axis[k].low + t * (box.axis[k].high - box.axis[k].low);
        }
        tape_run_point(&tape, point, values);
        double gain = fabs(values[sharp].v[0]) / fabs(values[plain].v[0]);
        if (isfinite(gain)) {
            sum += gain;
            count++;
        }
    }
    return count ? sum / count : 0;
}

/* The second bound costs about twice as much as the first. */
static void sharpen(Elaboration *e, Shape *shape, Node inner, double slope, Box box)
{
    const double WORTH = 2;
    Graph *g = e->graph;
    Node   gradient, blame;
    if (graph_gradient(g, shape->formula, &gradient, &blame, e->scratch) != DERIVED_SMOOTH)
        return;
    Node   root  = gradient;
    Graph *plain = graph_simplify(g, &root, 1, e->scratch);
    double bend  = graph_slope(plain, root, box, NULL, CELLS, NULL, e->scratch);
    if (!isfinite(bend))
        return;
    gradient   = at_nearest(e, gradient, box);
    Node sharp = second_order(g, inner, gradient, bend);
    Box  tried = box_is_finite(box) ? box : (Box){{{-10, 10}, {-10, 10}, {-10, 10}}};
    if (gain_of(e, sharp, divide_by_slope(g, inner, slope), tried) >= WORTH)
        shape->bound = brought_out(g, sharp, box);
}

/* Finds the slope over a region, which may be all space; false when there is no bound. */
static bool settle(Elaboration *e, Shape *shape, Box box, Node *blame)
{
    Node   root  = shape->formula;
    Graph *plain = graph_simplify(e->graph, &root, 1, e->scratch);
    double slope = graph_slope(plain, root, box, NULL, box_is_finite(box) ? CELLS : 1, blame,
                               e->scratch);
    shape->slope = shape->derived = slope;
    shape->region = box;
    if (*blame != NODE_NONE) /* a node of `plain`: the same expression's place in the text */
        shape->blame = plain->items[*blame].span;
    if (!isfinite(slope))
        return false;
    shape->distance = bring_out(e, shape->formula, slope, box);
    shape->slope    = 1;
    sharpen(e, shape, at_nearest(e, shape->formula, box), slope, box);
    return true;
}

/* ---- the solids ---- */

static bool depends_on_point(const Elaboration *e, Node node)
{
    return e->graph->items[node].time == TIME_POINT;
}

const Shape *make_field(Elaboration *e, Node formula, bool algebraic, const Syntax *place)
{
    Series      series;
    SeriesFault fault;
    Shape      *shape = shape_new(e, SHAPE_PRIMITIVE, algebraic ? "algebraic" : "field",
                                  place->span, NULL, 0);
    if (!depends_on_point(e, formula)) {
        Diag *diag  = diag_add(e->diags, DIAG_BAD_VALUE, place->span,
                               "`%s` needs an expression of the point", shape->name);
        diag->label = "the same everywhere";
        diag->help  = "use x, y, z or p in it";
        return NULL;
    }
    shape->box     = box_infinite;
    shape->exact   = false;
    shape->formula = formula;
    shape->fields  = true;
    Node point     = graph_leaf(e->graph, OP_POINT);
    if (graph_ball_series(e->graph, formula, point, &series, &fault, e->scratch)) {
        shape->distance = series_distance(e->graph, &series);
        shape->degree   = series.degree;
        shape->fields   = false;
    } else if (algebraic) {
        return refuse_polynomial(e, fault, place);
    } else {
        Node blame = NODE_NONE;
        settle(e, shape, box_infinite, &blame);
    }
    arena_free(e->scratch);
    return shape;
}

/* ---- regions ---- */

static const Shape *restrict_field(Elaboration *e, const Shape *shape, Box box)
{
    Node blame = NODE_NONE;
    if (shape->degree > 0 || !box_is_finite(box))
        return shape;
    Shape *restricted = arena_new(e->arena, Shape);
    *restricted       = *shape;
    restricted->bound = NODE_NONE;
    settle(e, restricted, box, &blame);
    arena_free(e->scratch);
    return restricted;
}

/* The children over the same box, grown by what the joint may reach around. */
static const Shape *restrict_joint(Elaboration *e, const Shape *shape, Box box)
{
    const Shape **children = arena_new_array(e->arena, const Shape *, shape->child_count + 1);
    double reach = shape->blend.width == NODE_NONE ? 0 : node_range(e, shape->blend.width, 0).high;
    for (uint32_t i = 0; i < shape->child_count; i++)
        children[i] = restrict_shape(e, shape->children[i], box_grow(box, reach));
    return make_joint(e, shape->kind, children, shape->child_count, shape->blend, shape->span);
}

const Shape *restrict_shape(Elaboration *e, const Shape *shape, Box box)
{
    if (!shape->fields || box_is_empty(box))
        return shape;
    const Shape *child = shape->child_count ? shape->children[0] : NULL;
    switch (shape->kind) {
    case SHAPE_PRIMITIVE: return restrict_field(e, shape, box);
    case SHAPE_UNION: case SHAPE_INTERSECTION: case SHAPE_DIFFERENCE: case SHAPE_XOR:
        return restrict_joint(e, shape, box);
    case SHAPE_OFFSET: {
        double r = range_largest(node_range(e, shape->values[0], 0));
        child    = restrict_shape(e, child, box_grow(box, r));
        return make_offset(e, child, shape->values[0], shape->span);
    }
    case SHAPE_SHELL: {
        double t = range_largest(node_range(e, shape->values[0], 0));
        child    = restrict_shape(e, child, box_grow(box, 0.5 * t));
        return make_shell(e, child, shape->values[0], shape->span);
    }
    case SHAPE_PAINT:
        return make_paint(e, restrict_shape(e, child, box), shape->material, shape->span);
    case SHAPE_TRANSFORM: {
        Box before = map_box(e, map_inverse(e, &shape->map), box);
        child      = restrict_shape(e, child, before);
        return make_transform(e, child, &shape->map, shape->span);
    }
    default: return shape;
    }
}

/* A field in a tree of infinite slope that has no bound. */
static const Shape *find_unbounded(const Shape *shape)
{
    while (shape->child_count > 0) {
        uint32_t i = 0;
        while (i + 1 < shape->child_count && isfinite(shape->children[i]->slope))
            i++;
        shape = shape->children[i];
    }
    return shape;
}

bool check_bounded(Elaboration *e, const Shape *shape)
{
    if (isfinite(shape->slope))
        return true;
    const Shape *field = find_unbounded(shape);
    Span  span  = field->blame.source ? field->blame : field->span;
    Diag *diag  = diag_add(e->diags, DIAG_STEEP, span, "the slope of a field has no bound");
    diag->label = "this can change arbitrarily fast";
    diag_place(e->diags, diag, field->span, "in this field");
    diag->help  = "cut it to a region: `.within(box([4, 4, 4]))`; or keep this part away from "
                  "divisions by zero and jumps";
    return false;
}
