/*
 * deform.c: what the deformations share: their boxes, and how they are undone.
 *
 * Each has a position of its own: a twist and a taper go along y, a bend curves what stands along
 * y in the plane of y and z, about x.  Other axes are rotated there and back.  A deformation is
 * undone only where the deformed solid may be, so that must be a bounded region, which follows
 * from the shape's box.
 *
 * A deformation F is undone by its inverse T, which is steep where F makes things small, and far
 * from the axis it is arbitrarily steep.  So it is used in a convex region C only that surely
 * holds the deformed solid.  For a point q let c be the nearest point of C, and let g be an
 * expression whose slope over C is 1, negative in the solid: then the distance is at least
 *
 *     hypot(|q - c|, max(g(c), 0)) + min(g(c), 0)
 *
 * for |q - s|^2 >= |q - c|^2 + |c - s|^2 for every s in C; and its slope is 1, as g(c) does not
 * change in the direction of q - c.  With the child's distance d, cut to at most `most` in size
 * where that makes it smaller, g is m(c) d(T(c)) / L: the weight m evens out where T is steep and
 * where it is not, and L >= m |T'| + |m'| most.  What depends on parameters in this is a frame-time
 * node, so it follows them from frame to frame, and no range of them is needed for the slope.
 *
 * A smaller d that is still positive makes a smaller bound.  So d must be right near the surface alone,
 * and an instance group in there may leave out all parts that are far from T(c).
 */
#include "compiler/family/deform.h"

#include <math.h>

#include "compiler/base/elementary.h"
#include "compiler/graph/build.h"

/* ---- how they are made ---- */

bool check_solid(ShapeBuilder *builder, const Shape *shape, const DeformArguments *asked)
{
    if (!shape->figure)
        return check_bounded(builder, shape);
    Diag *diag  = diag_add(builder->diags, DIAG_TYPE_MISMATCH, asked->shape_span,
                           "`.%s` needs a solid, found a plane figure", asked->name);
    diag->label = "this is a plane figure";
    diag->help  = "make it solid with `.extrude(height)` or `.revolve()`";
    return false;
}

bool check_deformable(ShapeBuilder *builder, const Shape *shape, const DeformArguments *asked)
{
    if (!check_solid(builder, shape, asked))
        return false;
    if (box_is_finite(shape->box) || box_is_empty(shape->box))
        return true;
    Diag *diag  = diag_add(builder->diags, DIAG_ENDLESS_DEFORMED, asked->shape_span,
                           "`.%s` needs a shape that ends somewhere", asked->name);
    diag->label = "this is endless, or can be for some value of a `param`";
    diag->help  = "cut it first, as in `plane([0, 1, 0], 0).within(box([4, 1, 4]))`";
    return false;
}

const Map *raise_axis(ShapeBuilder *builder, Node axis)
{
    Node up = graph_vec3(builder->graph, 0, 1, 0);
    return axis == up ? NULL : map_alignment(builder, axis, up);
}

Shape *deformed_shape(ShapeBuilder *builder, ShapeKind kind, const char *name, const Shape *shape,
                      const DeformArguments *asked)
{
    Shape *deformed = shape_new(builder, kind, name, asked->span, &shape, 1);
    deformed->slope = 1; /* what it lowers to has been divided by all slopes */
    deformed->exact = false;
    check_lipschitz(builder, deformed, "a deformation", asked->span);
    return deformed;
}

void note_slope(Shape *deformed, double slope)
{
    const Shape *child = deformed->children[0];
    if (isfinite(slope))
        deformed->derived = child->derived * child->slope * slope;
}

double region_room(const ShapeBuilder *builder, Box box)
{
    return builder_region(builder, box).axis[1].high - box.axis[1].high;
}

const Shape *in_region(ShapeBuilder *builder, const Shape *shape, double most)
{
    double room = fmin(region_room(builder, shape->box), most);
    if (!(room > 0))
        return shape;
    Shape *wider = arena_new(builder->arena, Shape);
    *wider       = *shape;
    wider->box   = box_grow(shape->box, room);
    return wider;
}

double shear_slope(double b) { return 0.5 * (b + real_hypot(b, 2)); }

Range range_cell(Range range, int i)
{
    double width = (range.high - range.low) / DEFORM_CELLS, low = range.low + i * width;
    return (Range){low, i + 1 == DEFORM_CELLS ? range.high : range.low + (i + 1) * width};
}

double box_radius(Box box)
{
    return hypot_upward(range_largest(box.axis[0]), range_largest(box.axis[2]));
}

const Shape *deform_rotated(ShapeBuilder *builder, const Shape *shape, const Map *rotation,
                            MakeDeformed *deform, const DeformArguments *asked)
{
    if (box_is_empty(shape->box))
        return shape;
    if (rotation)
        shape = make_transform(builder, shape, rotation, asked->span);
    const Shape *deformed = deform(builder, shape, asked);
    if (!deformed || !rotation)
        return deformed;
    return make_transform(builder, deformed, map_inverse(builder, rotation), asked->span);
}

/* ---- how they are lowered ---- */

Node shear_norm(Graph *g, Node b)
{
    Node four = graph_number(g, 4), half = graph_number(g, 0.5);
    Node root = add(g, graph_op1(g, OP_square, b), four);
    Node sum  = add(g, graph_op1(g, OP_sqrt, root), b);
    return mul(g, sum, half);
}

static Node times_rows(Graph *g, const Node rows[3], Node vector)
{
    Node products[3];
    for (int i = 0; i < 3; i++)
        products[i] = graph_op2(g, OP_dot, rows[i], vector);
    return graph_op(g, OP_vec3, products);
}

Lowered lower_undone(Lowering *l, const Shape *shape, LowerContext context,
                     const InverseDeformation *inverse)
{
    Graph       *g     = l->graph;
    const Shape *child = shape->children[0];
    LowerContext inner = context_divided(context_at(context, inverse->point),
                                         shape->divided * child->slope);
    if (l->surfaces) {
        inner.normal = graph_op1(g, OP_normalize, times_rows(g, inverse->in, context.normal));
        if (inverse->shrink != NODE_NONE)
            inner.footprint = mul(g, inner.footprint, inverse->shrink);
        if (inverse->shrink != NODE_NONE && inner.smoothing != NODE_NONE)
            inner.smoothing = mul(g, inner.smoothing, inverse->shrink);
    }
    Lowered result = lower_shape(l, child, inner);
    if (result.distance == NODE_NONE)
        return result;
    result.distance = divide_by_slope(g, result.distance, child->slope);
    if (!l->surfaces || result.surface.normal == inner.normal)
        result.surface.normal = context.normal;
    else {
        Node back             = times_rows(g, inverse->out, result.surface.normal);
        result.surface.normal = graph_op1(g, OP_normalize, back);
    }
    return result;
}

Lowered with_region(Lowering *l, Lowered result, Node offset, Node is_inside)
{
    Graph *g       = l->graph;
    Node   zero    = graph_number(g, 0);
    Node   outside = length_of(g, offset, most(g, result.distance, zero));
    if (is_inside == NODE_NONE)
        is_inside = graph_op2(g, OP_less_equal, offset, zero);
    result.distance = graph_op3(g, OP_select, is_inside, result.distance, outside);
    return result;
}

Node cut_distance(Graph *g, Node distance, double width, Node steep, Node *cost)
{
    Node fraction = graph_number(g, COST_OF_WEIGHT);
    Node whole    = graph_number(g, COST_OF_WEIGHT / fmax(width, 1e-9));
    Node limit    = over(g, fraction, most(g, steep, whole));
    Node low      = neg(g, limit);
    *cost         = mul(g, steep, limit);
    return graph_op3(g, OP_clamp, distance, low, limit);
}

double axis_radius(Box box)
{
    double x = range_largest(box.axis[0]), z = range_largest(box.axis[2]);
    return fmax(real_hypot(x, z), 1e-9);
}

Node across_scaled(Graph *g, Node point, Node y, Node factor)
{
    Node x = mul(g, graph_component(g, point, 0), factor);
    Node z = mul(g, graph_component(g, point, 2), factor);
    return row(g, x, y, z);
}

Node radius_of(Graph *g, Node point)
{
    Node x = graph_component(g, point, 0), z = graph_component(g, point, 2);
    return length_of(g, x, z);
}
