/*
 * deform.c: twist, bend, taper and displace: their methods, and the box of what they make.
 *
 * Each has a position of its own: a twist and a taper go along y, a bend curves what stands along
 * y in the plane of y and z, about x.  Other axes are turned there and back.  A deformation is
 * undone only where the deformed solid may be, so that must be a bounded region, which follows
 * from the shape's box; lower_deform.c has the distances and why they are safe.
 */
#include "compiler/eval/elaborate.h"

#include <math.h>

enum { CELLS = 64 };

/* ---- what is deformed ---- */

/* A solid, whose distance is one; false: reported. */
static bool check_solid(Elaboration *e, const Shape *shape, const Call *call)
{
    if (!shape->figure)
        return check_bounded(e, shape);
    Diag *diag  = diag_add(e->diags, DIAG_TYPE_MISMATCH, call->syntax->children[0]->span,
                           "`.%s` needs a solid, found a plane figure", call->name);
    diag->label = "this is a plane figure";
    diag->help  = "make it solid with `.extrude(height)` or `.revolve()`";
    return false;
}

/* A solid with an end in every direction. */
static bool check_deformable(Elaboration *e, const Shape *shape, const Call *call)
{
    if (!check_solid(e, shape, call))
        return false;
    if (box_is_finite(shape->box) || box_is_empty(shape->box))
        return true;
    Diag *diag  = diag_add(e->diags, DIAG_ENDLESS_DEFORMED, call->syntax->children[0]->span,
                           "`.%s` needs a shape that ends somewhere", call->name);
    diag->label = "this is endless, or can be for some value of a `param`";
    diag->help  = "cut it first, as in `plane([0, 1, 0], 0).within(box([4, 1, 4]))`";
    return false;
}

/* A direction of frame time; NODE_NONE: reported. */
static Node want_axis(Elaboration *e, const Call *call)
{
    static const double UP[3] = {0, 1, 0};
    Node                axis  = want_vector(e, call, 0, UP);
    if (axis == NODE_NONE ||
        !check_direction(e, axis, call->arguments[0].syntax, "the axis of a deformation"))
        return NODE_NONE;
    return axis;
}

/* Deformed in the position to which a turn brings it, and turned back; `make` may report. */
typedef const Shape *Deform(Elaboration *e, const Shape *shape, const Call *call,
                            const Node *values);

static Value deform_turned(Elaboration *e, const Shape *shape, const Call *call, const Map *turn,
                           Deform *make, const Node *values)
{
    Span span = call->syntax->span;
    if (box_is_empty(shape->box))
        return value_shape(shape);
    if (turn)
        shape = make_transform(e, shape, turn, span);
    const Shape *deformed = make(e, shape, call, values);
    if (!deformed || !turn)
        return value_shape(deformed);
    return value_shape(make_transform(e, deformed, map_inverse(e, turn), span));
}

/* The turn that brings an axis to y; NULL: it is y. */
static const Map *raise_axis(Elaboration *e, Node axis)
{
    Node up = graph_vec3(e->graph, 0, 1, 0);
    return axis == up ? NULL : map_alignment(e, axis, up);
}

static Shape *deformed_shape(Elaboration *e, ShapeKind kind, const char *name, const Shape *shape,
                             const Call *call)
{
    Shape *deformed = shape_new(e, kind, name, call->syntax->span, &shape, 1);
    deformed->slope = 1; /* what it lowers to has been divided by all slopes */
    deformed->exact = false;
    check_lipschitz(e, deformed, "a deformation", call->syntax->span);
    return deformed;
}

/* What the deformation was divided by, at most, if there is a limit: for reports. */
static void note_slope(Shape *deformed, double slope)
{
    const Shape *child = deformed->children[0];
    if (isfinite(slope))
        deformed->derived = child->derived * child->slope * slope;
}

/* (b + sqrt(b^2 + 4)) / 2, the norm of a shear by b. */
static double shear_norm(double b) { return 0.5 * (b + hypot(b, 2)); }

/* Cell `i` of the CELLS of a range. */
static Range range_cell(Range range, int i)
{
    double width = (range.high - range.low) / CELLS, low = range.low + i * width;
    return (Range){low, i + 1 == CELLS ? range.high : range.low + (i + 1) * width};
}

/* The largest distance from the y axis in a box. */
static double box_radius(Box box)
{
    return hypot_upward(range_largest(box.axis[0]), range_largest(box.axis[2]));
}

/* ---- twist ---- */

/* Each slice of the box turns by angles of its own, in any case within a cylinder. */
static Box twist_box(Box box, Range rate)
{
    double radius = box_radius(box);
    Range  across = {-radius, radius};
    Box    whole = {{across, box.axis[1], across}}, hull = box_empty;
    for (int i = 0; i < CELLS; i++) {
        Range angle = range_mul(rate, range_cell(box.axis[1], i));
        Range c = range_cos(angle), s = range_sin(angle), one = range_of(1), zero = range_of(0);
        Range rows[3][3] = {{c, zero, s}, {zero, one, zero}, {range_neg(s), zero, c}};
        hull             = box_hull(hull, box_turn(box, rows));
    }
    return box_common(whole, hull);
}

static const Shape *make_twist(Elaboration *e, const Shape *shape, const Call *call,
                               const Node *values)
{
    Shape *twisted     = deformed_shape(e, SHAPE_TWIST, "twist", shape, call);
    twisted->values[0] = values[0];
    Range rate         = node_range(e, values[0], 0);
    twisted->box       = twist_box(shape->box, rate);
    note_slope(twisted, shear_norm(range_largest(rate) * box_radius(shape->box)));
    return twisted;
}

Value method_twist(Elaboration *e, const Shape *shape, Call *call)
{
    Node axis = want_axis(e, call), rate = want_number(e, call, 1, 0);
    if (axis == NODE_NONE || rate == NODE_NONE || !check_deformable(e, shape, call))
        return value_error();
    if (rate == graph_number(e->graph, 0))
        return value_shape(shape);
    return deform_turned(e, shape, call, raise_axis(e, axis), make_twist, &rate);
}

/* ---- bend ---- */

/* sin(a) / a, whose slope is below 1/2 everywhere. */
static Range range_sinc(Range a)
{
    double middle = 0.5 * (a.low + a.high), half = 0.5 * (a.high - a.low);
    if (!isfinite(half))
        return (Range){-0.2173, 1};
    double value = middle == 0 ? 1 : sin(middle) / middle, rise = 0.5 * half + 1e-15;
    return (Range){fmax(value - rise, -0.2173), fmin(value + rise, 1)};
}

/* y and z of the bent box: where its cells go, for all cells of the range of the rate. */
static Box bend_box(Box box, Range rate)
{
    Range z = box.axis[2], half = range_of(0.5);
    Box   bent  = box_empty;
    int   rates = range_is_single(rate) ? 1 : CELLS;
    for (int i = 0; i < rates * CELLS; i++) {
        Range k = rates == 1 ? rate : range_cell(rate, i / CELLS);
        Range y = range_cell(box.axis[1], i % CELLS), angle = range_mul(k, y);
        Range lean = range_mul(half, angle), sinc = range_sinc(lean);
        Range along   = range_mul(y, range_sinc(angle)); /* of the line z = 0 */
        Range lateral = range_mul(range_mul(y, lean), range_square(sinc));
        Box   cell    = {{box.axis[0], range_sub(along, range_mul(z, range_sin(angle))),
                          range_add(lateral, range_mul(z, range_cos(angle)))}};
        bent          = box_hull(bent, cell);
    }
    return bent;
}

/* Segments of a quarter turn each, for the largest rate. */
static uint32_t bend_segments(Box box, Range rate)
{
    double turn = range_largest(rate) * (box.axis[1].high - box.axis[1].low);
    double most = ceil(turn / (0.5 * M_PI) - 1e-9);
    return most > 1 ? (uint32_t)fmin(most, MOST_BEND_SEGMENTS + 1) : 1;
}

/* A bend with the rate k has its axis at z = 1 / k, where all lengths vanish; this much must be
   left of them. */
static const double LEAST_LENGTH = 0.01;

static bool check_bend(Elaboration *e, const Call *call, Box box, Range rate)
{
    Range z = box.axis[2], shrink = range_mul(rate, z);
    bool  reaches = !(shrink.high <= 1 - LEAST_LENGTH);
    if (!reaches && bend_segments(box, rate) <= MOST_BEND_SEGMENTS)
        return true;
    double most = 0.5 * M_PI * MOST_BEND_SEGMENTS / (box.axis[1].high - box.axis[1].low);
    double high = z.high > 0 ? (1 - LEAST_LENGTH) / z.high : INFINITY;
    double low  = z.low < 0 ? (1 - LEAST_LENGTH) / z.low : -INFINITY;
    Diag  *diag = diag_add(e->diags, DIAG_BAD_VALUE, call->arguments[1].syntax->span,
                          reaches ? "so bent, the shape would reach the axis of the bend"
                                   : "so bent, the shape would turn around more than %d times",
                           MOST_BEND_SEGMENTS / 4);
    diag->label = range_is_single(rate) ? diag_text(e->diags, "this is %g", rate.low)
                  : isinf(rate.low) && isinf(rate.high)
                      ? "this can be any number"
                      : diag_text(e->diags, "this can be from %g to %g", rate.low, rate.high);
    diag->help  = diag_text(e->diags, "from %.4g to %.4g is possible here", fmax(low, -most),
                            fmin(high, most));
    return false;
}

static const Shape *make_bend(Elaboration *e, const Shape *shape, const Call *call,
                              const Node *values)
{
    Range rate = node_range(e, values[0], 0);
    if (!check_bend(e, call, shape->box, rate))
        return NULL;
    Shape *bent     = deformed_shape(e, SHAPE_BEND, "bend", shape, call);
    bent->values[0] = values[0];
    bent->cells[0]  = bend_segments(shape->box, rate);
    bent->box       = bend_box(shape->box, rate);
    /* Segments overlap by the depth of the solid, so that they have no walls between them. */
    double depth  = 0.5 * (shape->box.axis[2].high - shape->box.axis[2].low);
    bent->overlap = fmin(depth, 0.6 / fmax(range_largest(rate), 1e-9));
    return bent;
}

/* The turn that brings the axis to x, and to y what stands upright: y, or x where that is the
   axis. */
static const Map *bend_turn(Elaboration *e, Node axis)
{
    Graph *g = e->graph;
    Node   x = graph_vec3(g, 1, 0, 0), y = graph_vec3(g, 0, 1, 0);
    if (axis == x)
        return NULL;
    Map *turn     = map_new(e);
    Node unit     = graph_op1(g, OP_normalize, axis);
    Node height   = graph_component(g, unit, 1);
    Node steep    = graph_op1(g, OP_abs, height);
    Node upright  = graph_op2(g, OP_less, graph_number(g, 0.999), steep);
    Node stands   = graph_op3(g, OP_select, upright, x, y);
    Node along    = graph_op2(g, OP_dot, stands, unit);
    Node parallel = graph_op2(g, OP_scale, unit, along);
    Node across   = graph_op2(g, OP_sub, stands, parallel);
    turn->rows[0] = unit;
    turn->rows[1] = graph_op1(g, OP_normalize, across);
    turn->rows[2] = graph_op2(g, OP_cross, unit, turn->rows[1]);
    return turn;
}

Value method_bend(Elaboration *e, const Shape *shape, Call *call)
{
    Node axis = want_axis(e, call), rate = want_number(e, call, 1, 0);
    if (axis == NODE_NONE || rate == NODE_NONE || !check_deformable(e, shape, call))
        return value_error();
    if (rate == graph_number(e->graph, 0))
        return value_shape(shape);
    return deform_turned(e, shape, call, bend_turn(e, axis), make_bend, &rate);
}

/* ---- taper ---- */

static const Shape *make_taper(Elaboration *e, const Shape *shape, const Call *call,
                               const Node *values)
{
    Shape *tapered     = deformed_shape(e, SHAPE_TAPER, "taper", shape, call);
    tapered->values[0] = values[0];
    tapered->values[1] = values[1];
    Range scale        = range_hull(node_range(e, values[0], 0), node_range(e, values[1], 0));
    for (int i = 0; i < 3; i += 2)
        tapered->box.axis[i] = range_mul(shape->box.axis[i], scale);
    double height = shape->box.axis[1].high - shape->box.axis[1].low;
    note_slope(tapered, shear_norm((scale.high - scale.low) / height * box_radius(shape->box)));
    return tapered;
}

Value method_taper(Elaboration *e, const Shape *shape, Call *call)
{
    Node axis      = want_axis(e, call);
    Node values[2] = {want_number(e, call, 1, 1), want_number(e, call, 2, 1)};
    if (axis == NODE_NONE || values[0] == NODE_NONE || values[1] == NODE_NONE ||
        !check_positive(e, values[0], call->arguments[1].syntax, "a factor of a taper") ||
        !check_positive(e, values[1], call->arguments[2].syntax, "a factor of a taper") ||
        !check_deformable(e, shape, call))
        return value_error();
    return deform_turned(e, shape, call, raise_axis(e, axis), make_taper, values);
}

/* ---- displace ---- */

/* The expression as a graph of its own, which is quick to analyse. */
typedef struct Bump {
    Graph *graph;
    Node   root;
    Range  amplitude;
} Bump;

static double bump_size(Elaboration *e, const Bump *bump, Box box)
{
    return range_largest(graph_facts(bump->graph, box, NULL, e->scratch)[bump->root].value[0]);
}

/* How large the expression can be where the displaced surface can be; that grows with it. */
static double bump_reach(Elaboration *e, const Bump *bump, Box box)
{
    enum { TRIALS = 40 };
    double most = bump_size(e, bump, box_infinite), amplitude = range_largest(bump->amplitude);
    if (isfinite(most) || !isfinite(amplitude))
        return most;
    most = bump_size(e, bump, box);
    for (int i = 0; i < TRIALS; i++) {
        double next = bump_size(e, bump, box_grow(box, amplitude * most));
        if (next <= most)
            return most;
        most = 1.05 * next;
    }
    return INFINITY;
}

static void report_large_bump(Elaboration *e, const Call *call)
{
    Diag *diag  = diag_add(e->diags, DIAG_STEEP, call->arguments[0].syntax->span,
                           "the size of this displacement has no bound");
    diag->label = "this can become arbitrarily large";
    diag->help  = "keep it in limits with `clamp`, cut the shape with `.within`, give a `param` in "
                  "it a range, or take what grows as the `amplitude`";
}

static void report_bump(Elaboration *e, const Call *call, Span blame)
{
    Span  whole = call->arguments[0].syntax->span;
    Diag *diag  = diag_add(e->diags, DIAG_STEEP, blame.source ? blame : whole,
                           "the slope of this displacement has no bound");
    diag->label = "this can change arbitrarily fast";
    diag->help  = "keep it in limits with `clamp`, cut the shape with `.within`, and give a "
                  "`param` in it a range";
}

Value method_displace(Elaboration *e, const Shape *shape, Call *call)
{
    const Argument *expression = &call->arguments[0];
    Node            amplitude  = want_number(e, call, 1, 1);
    if (value_size(e, expression->value) != 1) {
        type_error(e, expression->syntax, expression->value, "a number");
        return value_error();
    }
    if (amplitude == NODE_NONE || !check_solid(e, shape, call))
        return value_error();
    if (box_is_empty(shape->box))
        return value_shape(shape);
    Shape *displaced     = deformed_shape(e, SHAPE_DISPLACE, "displace", shape, call);
    displaced->formula   = value_node(e, expression->value);
    displaced->values[0] = amplitude;
    Bump bump            = {.root = displaced->formula, .amplitude = node_range(e, amplitude, 0)};
    bump.graph           = graph_simplify(e->graph, &bump.root, 1, e->scratch);
    displaced->reach     = bump_reach(e, &bump, shape->box);
    double grown         = product_upward(range_largest(bump.amplitude), displaced->reach);
    displaced->box       = isfinite(grown) ? box_grow(shape->box, grown) : box_infinite;
    /* The slope everywhere or, failing that, where the displaced surface can be. */
    Box       regions[2] = {box_infinite, displaced->box};
    Steepness slope;
    bool bounded = find_slope(e, displaced->formula, regions, box_is_finite(displaced->box) ? 2 : 1,
                              expression->syntax->span, &slope);
    if (!bounded || !isfinite(displaced->reach)) {
        if (bounded)
            report_large_bump(e, call);
        else
            report_bump(e, call, slope.blame);
        arena_free(e->scratch);
        return value_error();
    }
    displaced->values[1] = steepness_node(e->graph, &slope);
    displaced->per_frame = displaced->per_frame || slope.slot != NODE_NONE;
    note_slope(displaced, 1 + range_largest(bump.amplitude) * slope.bound);
    arena_free(e->scratch);
    return value_shape(displaced);
}
