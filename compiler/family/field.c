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
 * Banach.)  So it may be blended and offset, and stand in sequences and under maps.  Where all zeros
 * are in a box (zeros.h), points outside of it go by their nearest point in it, as below.
 *
 * Other expressions are divided by their slope.  Where that has no bound, or a bad one, a region
 * C is needed: `.within` hands it down.  At a point q with its nearest point c in C,
 *     hypot(|q - c|, max(f(c) / L, 0)),   L the slope over C,
 * is below the distance to what is in C, since |q - s|^2 >= |q - c|^2 + |c - s|^2 for s in C, and
 * 1-Lipschitz.  Where f(c) < 0 the solid ends at the sides of C: within it the value is
 * max(f / L, -distance to them), so that nothing jumps there.  In place of f / L there may be
 * another distance, by which rays reach the surface sooner (field_bounds.c).
 */

#include "compiler/family/family.h"

#include <math.h>

#include "compiler/family/field_bounds.h"
#include "compiler/graph/build.h"
#include "compiler/graph/symbolic/series.h"
#include "compiler/lower/box_distance.h"

/* ---- polynomials ---- */

/* The radius is no less than 0; meshes are told so, since then the sign is that of a smooth number. */
static Node series_distance(const ShapeBuilder *builder, const Series *s)
{
    Graph *g      = builder->graph;
    Node   sign   = graph_op1(g, OP_sign, s->c[0]);
    Node   radius = series_radius(g, s);
    if (builder->for_meshes)
        radius = graph_op2(g, OP_max, radius, graph_number(g, 0));
    return graph_op2(g, OP_mul, sign, radius);
}

static const Shape *refuse_polynomial(ShapeBuilder *builder, SeriesFault fault, Span span)
{
    Span blame = builder->graph->items[fault.blame].span;
    blame      = blame.source ? blame : span;
    if (fault.degree > 0) {
        Diag *diag  = diag_add(builder->diags, DIAG_NOT_POLYNOMIAL, blame,
                               "a polynomial of degree %u is too high", fault.degree);
        diag->label = diag_text(builder->diags, "at most %d are possible", MAX_DEGREE);
        return NULL;
    }
    Diag       *diag = diag_add(builder->diags, DIAG_NOT_POLYNOMIAL, blame,
                                "the equation is not a polynomial");
    const char *name = graph_op_name(builder->graph->items[fault.blame].op);
    diag->label      = diag_text(builder->diags, "`%s` of coordinates is none", name);
    diag_secondary(builder->diags, diag, span, "in this equation");
    diag->help = "`field(...)` takes any expression";
    return NULL;
}

/* ---- other expressions ---- */

/* Returns where a point of all space is looked at: the nearest in C. */
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

/* Returns a bound on the distance at the point's nearest point in C, brought out to the point. */
static Node extend_from_box(Graph *g, Node bound, Box box)
{
    if (!box_is_finite(box))
        return bound;
    Node point = graph_leaf(g, OP_POINT), zero = graph_number(g, 0);
    Node excess  = box_distance(g, point, box);
    Node outside = graph_op2(g, OP_max, bound, zero);
    Node sides   = box_excess(g, point, box);
    Node inside  = graph_op2(g, OP_min, graph_op2(g, OP_max, bound, sides), zero);
    Node both    = graph_op1(g, OP_length, graph_op2(g, OP_vec2, excess, outside));
    return graph_op2(g, OP_add, both, inside);
}

static Node at_nearest(ShapeBuilder *builder, Node formula, Box box)
{
    if (!box_is_finite(box))
        return formula;
    Node         point = nearest_in(builder->graph, graph_leaf(builder->graph, OP_POINT), box);
    Substitution with  = {.point = point, .instance = NODE_NONE, .level = NODE_NONE};
    return graph_substitute(builder->graph, formula, with, builder->scratch);
}

/* Bounds the distance outside of the box that holds all zeros.  The polynomial is not looked at
   there: thousands of units away its value is too large for single precision, or what is left of
   numbers that cancel. */
static Node near_zeros(ShapeBuilder *builder, Node distance, ZeroBox zeros)
{
    Graph *g = builder->graph;
    if (!box_is_finite(zeros.box))
        return distance;
    const Box region = builder_region(builder, zeros.box);
    distance         = at_nearest(builder, distance, region);
    return zeros.sign > 0 ? extend_from_box(g, distance, region)
                          : neg(g, extend_from_box(g, neg(g, distance), region));
}

/* Sets the distance by the series, and the box where all zeros are in one. */
static void bound_polynomial(ShapeBuilder *builder, Shape *shape, const Series *series)
{
    Node        distance = series_distance(builder, series);
    FieldFacts *field    = own_field_facts(builder, shape);
    field->degree        = series->degree;
    field->zeros         = graph_zero_box(builder->graph, shape->formula, builder->scratch);
    shape->distance      = near_zeros(builder, distance, field->zeros);
    shape->fields        = !box_is_finite(field->zeros.box);
    if (field->zeros.sign > 0)
        shape->box = field->zeros.box;
}

Node extend_from_region(ShapeBuilder *builder, Node formula, const Steepness *slope)
{
    Node inner = at_nearest(builder, formula, slope->region);
    return extend_from_box(builder->graph, divide_by_steepness(builder->graph, inner, slope),
                           slope->region);
}

/* Sets the distance by the slope over a region, which may be all space.  Where the slope has no bound, that
   of the shape is infinite. */
static void bound_field(ShapeBuilder *builder, Shape *shape, Box box, bool uniform)
{
    Steepness   slope;
    bool        bounded = find_slope(builder, shape->formula, &box, 1, shape->span, &slope);
    FieldFacts *field   = own_field_facts(builder, shape);
    field->region       = box;
    field->blame        = slope.blame;
    shape->derived      = slope.bound;
    shape->slope        = bounded ? 1 : slope.bound;
    shape->per_frame    = slope.slot != NODE_NONE;
    if (!bounded)
        return;
    shape->distance = extend_from_region(builder, shape->formula, &slope);
    if (shape->per_frame)
        return;
    FieldBounds bounds = field_bounds(builder, shape->formula, slope.bound, box, uniform);
    shape->distance    = extend_from_box(builder->graph, at_nearest(builder, bounds.lipschitz, box),
                                         box);
    if (bounds.sharp != NODE_NONE)
        shape->bound = extend_from_box(builder->graph, at_nearest(builder, bounds.sharp, box), box);
}

/* ---- the solids ---- */

static bool depends_on_point(const ShapeBuilder *builder, Node node)
{
    return builder->graph->items[node].time == TIME_POINT;
}

/* Tells whether nothing of the point is left, as in x - x. */
static bool series_is_constant(const Graph *g, const Series *s)
{
    uint32_t k = s->degree;
    while (k > 0 && g->items[s->c[k]].op == OP_CONSTANT && g->items[s->c[k]].number[0] == 0)
        k--;
    return k == 0;
}

static const Shape *refuse_constant(ShapeBuilder *builder, const Shape *shape)
{
    Diag *diag  = diag_add(builder->diags, DIAG_BAD_VALUE, shape->span,
                           "`%s` needs an expression of the point", shape->name);
    diag->label = "the same everywhere";
    diag->help  = "use x, y, z or p in it";
    return NULL;
}

const Shape *make_field(ShapeBuilder *builder, Node formula, bool algebraic, Span span)
{
    Series      series;
    SeriesFault fault;
    Shape      *shape = shape_new(builder, SHAPE_PRIMITIVE, algebraic ? "algebraic" : "field", span,
                                  NULL, 0);
    if (!depends_on_point(builder, formula))
        return refuse_constant(builder, shape);
    own_field_facts(builder, shape)->region = box_infinite;
    shape->box                              = box_infinite;
    shape->exact                            = false;
    shape->formula                          = formula;
    shape->fields                           = true;
    Node point                              = graph_leaf(builder->graph, OP_POINT);
    if (graph_ball_series(builder->graph, formula, point, &series, &fault, builder->scratch)) {
        if (series_is_constant(builder->graph, &series))
            return refuse_constant(builder, shape);
        bound_polynomial(builder, shape, &series);
    } else if (algebraic) {
        return refuse_polynomial(builder, fault, span);
    } else {
        bound_field(builder, shape, box_infinite, false);
    }
    arena_free(builder->scratch);
    return shape;
}

/* ---- regions ---- */

/* An endless polynomial is looked at in the region alone, too: the distance at the nearest point
   there is none to more than is in the region, and as steep. */
static void restrict_polynomial(ShapeBuilder *builder, Shape *restricted, Box box)
{
    Box region                                   = box_grow(box, 1e-3 * box_diagonal(box));
    own_field_facts(builder, restricted)->region = region;
    restricted->fields                           = false;
    restricted->distance = at_nearest(builder, restricted->distance, region);
}

static const Shape *restrict_primitive(ShapeBuilder *builder, const Shape *shape, Box box,
                                       bool uniform)
{
    if (!box_is_finite(box))
        return shape;
    Shape *restricted = arena_new(builder->arena, Shape);
    *restricted       = *shape;
    restricted->bound = NODE_NONE;
    if (shape->field->degree > 0) {
        restrict_polynomial(builder, restricted, box);
        return restricted;
    }
    bound_field(builder, restricted, box, uniform);
    arena_free(builder->scratch);
    return restricted;
}

/* Returns the children over the same box, grown by what the CSG node may reach around. */
static const Shape *restrict_csg_node(ShapeBuilder *builder, const Shape *shape, Box box,
                                      bool uniform)
{
    const Shape **children = arena_new_array(builder->arena, const Shape *, shape->child_count + 1);
    double        reach    = shape->blend.width == NODE_NONE
                                 ? 0
                                 : node_range(builder, shape->blend.width, 0).high;
    for (uint32_t i = 0; i < shape->child_count; i++)
        children[i] = restrict_shape(builder, shape->children[i], box_grow(box, reach), uniform);
    return make_csg_node(builder, shape->kind, children, shape->child_count, shape->blend,
                         shape->span);
}

static const Shape *restrict_clip(ShapeBuilder *builder, const Shape *shape, Box box, bool uniform)
{
    const Shape *content = restrict_shape(builder, shape->children[0], box, uniform);
    const Shape *region  = shape->child_count > 1 ? shape->children[1] : NULL;
    return make_clip(builder, content, region, shape->corners, shape->span);
}

static const Shape *restrict_offset(ShapeBuilder *builder, const Shape *shape, Box box,
                                    bool uniform)
{
    double       r     = range_largest(node_range(builder, shape->values[0], 0));
    const Shape *child = restrict_shape(builder, shape->children[0], box_grow(box, r), uniform);
    return make_offset(builder, child, shape->values[0], shape->span);
}

static const Shape *restrict_shell(ShapeBuilder *builder, const Shape *shape, Box box, bool uniform)
{
    double       t     = range_largest(node_range(builder, shape->values[0], 0));
    const Shape *child = restrict_shape(builder, shape->children[0], box_grow(box, 0.5 * t),
                                        uniform);
    return make_shell(builder, child, shape->values[0], shape->span);
}

static const Shape *restrict_paint(ShapeBuilder *builder, const Shape *shape, Box box, bool uniform)
{
    const Shape *child = restrict_shape(builder, shape->children[0], box, uniform);
    return make_paint(builder, child, shape->material, shape->span);
}

static const Shape *restrict_transform(ShapeBuilder *builder, const Shape *shape, Box box,
                                       bool uniform)
{
    Box          before = map_box(builder, map_inverse(builder, &shape->map), box);
    const Shape *child  = restrict_shape(builder, shape->children[0], before, uniform);
    return make_transform(builder, child, &shape->map, shape->span);
}

/* Others hide their fields from the region. */
static const Shape *restrict_none(ShapeBuilder *builder, const Shape *shape, Box box, bool uniform)
{
    (void)builder;
    (void)box;
    (void)uniform;
    return shape;
}

typedef const Shape *Restrict(ShapeBuilder *builder, const Shape *shape, Box box, bool uniform);

const Shape *restrict_shape(ShapeBuilder *builder, const Shape *shape, Box box, bool uniform)
{
    static Restrict *const rules[SHAPE_COUNT] = {
#define SHAPE(KIND, name, parts, curved, divided, own, leaves, box, rays, step, image, restrict, \
              rule)                                                                              \
    restrict_##restrict,
#include "compiler/shape/shapes.def"
    };
    if (!shape->fields || box_is_empty(box))
        return shape;
    return rules[shape->kind](builder, shape, box, uniform);
}

/* Returns a field in a tree of infinite slope that has no bound. */
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

bool check_bounded(ShapeBuilder *builder, const Shape *shape)
{
    if (isfinite(shape->slope))
        return true;
    const Shape *field = find_unbounded(shape);
    Span         span  = field->field->blame.span.source ? field->field->blame.span : field->span;
    Diag *diag  = diag_add(builder->diags, DIAG_STEEP, span, "the slope of a field has no bound");
    diag->label = "this can change arbitrarily fast";
    diag_secondary(builder->diags, diag, field->span, "in this field");
    explain_steep(builder, diag, field->field->blame);
    diag->help = box_is_finite(field->field->region)
                     ? "keep this part away from divisions by zero and jumps"
                     : "cut it to a region: `.within(box([4, 4, 4]))`; or keep this part away "
                       "from divisions by zero and jumps";
    return false;
}
