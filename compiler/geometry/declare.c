/*
 * declare.c: shapes declared in the language, the library's and the users' own.
 *
 * A declaration gives the distance as an expression of the point.  Where it claims `exact`, the
 * claim is put to the test by sampling when it is first used; otherwise a slope is derived and
 * the distance divided by it, so that every primitive is 1-Lipschitz from here on.
 */
#include "compiler/geometry/elaborate.h"

#include <math.h>
#include <string.h>

#include "compiler/geometry/lower.h"
#include "compiler/graph/evaluate.h"

static const char *const property_names[] = {
    "distance", "bound", "exact", "slope", "within", "uv", "plane", "figure", "core", "example"};
enum { PROPERTY_COUNT = sizeof property_names / sizeof *property_names };

static bool check_properties(Elaboration *e, const Syntax *declaration)
{
    bool good = true;
    for (uint32_t i = 0; i < declaration->count; i++) {
        const Syntax *property = declaration->children[i];
        bool          known    = property->kind != SYNTAX_PROPERTY;
        for (size_t k = 0; !known && k < PROPERTY_COUNT; k++)
            known = strcmp(property->name, property_names[k]) == 0;
        if (known)
            continue;
        Diag *diag        = diag_add(e->diags, DIAG_UNKNOWN_PROPERTY, property->name_span,
                                     "a shape has no property `%s`", property->name);
        diag->label       = "unknown property";
        diag->replacement = nearest_name(property->name, property_names, PROPERTY_COUNT);
        good              = false;
    }
    return good;
}

/* A property that is a number at every point. */
static Node field_property(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    Value value = evaluate(e, env, syntax);
    if (value_size(e, value) == 1)
        return value_node(e, value);
    type_error(e, syntax, value, "a number");
    return NODE_NONE;
}

static bool flag_property(Elaboration *e, const Environment *env, const Syntax *declaration,
                          const char *name)
{
    const Syntax *syntax = find_property(declaration, name);
    if (!syntax)
        return false;
    Value value = evaluate(e, env, syntax);
    if (value.type == VALUE_BOOLEAN)
        return value.boolean;
    /* What is true for some values of the parameters only cannot be claimed. */
    if (value.type != VALUE_EXPRESSION || e->graph->items[value.node].type != TYPE_BOOL)
        type_error(e, syntax, value, "true or false");
    return false;
}

/* `slope`: a claimed bound on how fast the distance changes; 0 when there is none. */
static bool slope_property(Elaboration *e, const Environment *env, const Syntax *declaration,
                           double *slope)
{
    const Syntax *syntax = find_property(declaration, "slope");
    *slope               = 0;
    if (!syntax)
        return true;
    Value value = evaluate(e, env, syntax);
    if (value.type == VALUE_NUMBER && value.number > 0) {
        *slope = value.number;
        return true;
    }
    type_error(e, syntax, value, "a constant number above 0");
    return false;
}

/* `within`: a shape, or two corners. */
static bool within_property(Elaboration *e, const Environment *env, const Syntax *declaration,
                            Box *box)
{
    const Syntax *syntax = find_property(declaration, "within");
    *box                 = box_infinite;
    if (!syntax)
        return true;
    Value value = evaluate(e, env, syntax);
    if (value.type == VALUE_SHAPE) {
        *box = value.shape->box;
        return true;
    }
    if (value.type == VALUE_LIST && value.list->count == 2) {
        Node low  = to_vector(e, value.list->items[0], syntax, "`within`");
        Node high = to_vector(e, value.list->items[1], syntax, "`within`");
        for (uint32_t i = 0; low != NODE_NONE && high != NODE_NONE && i < 3; i++)
            box->axis[i] = (Range){node_range(e, low, i).low, node_range(e, high, i).high};
        return low != NODE_NONE && high != NODE_NONE;
    }
    type_error(e, syntax, value, "a shape or a list of two corners");
    return false;
}

static bool plane_property(Elaboration *e, const Environment *env, const Syntax *declaration,
                           Shape *shape)
{
    const Syntax *syntax = find_property(declaration, "plane");
    if (!syntax)
        return true;
    Value value = evaluate(e, env, syntax);
    if (value.type == VALUE_LIST && value.list->count == 2) {
        shape->plane_normal = to_vector(e, value.list->items[0], syntax, "the normal of a plane");
        shape->plane_offset = to_number(e, value.list->items[1], syntax, "the offset of a plane");
        return shape->plane_normal != NODE_NONE && shape->plane_offset != NODE_NONE &&
               check_direction(e, shape->plane_normal, syntax, "the normal of a plane");
    }
    type_error(e, syntax, value, "a list of a normal and an offset");
    return false;
}

/* A size of 0 or less leaves nothing to see, or a surface without an inside. */
static void warn_if_empty(Elaboration *e, const Shape *shape)
{
    bool flat = false;
    for (int i = 0; i < (shape->figure ? 2 : 3); i++)
        flat = flat || !(shape->box.axis[i].low < shape->box.axis[i].high);
    if (!flat || e->sources->items[shape->span.source].library)
        return;
    Diag *diag =
        diag_add(e->diags, DIAG_NO_EFFECT, shape->span, "this `%s` is empty", shape->name);
    diag->label = "a size is 0 or less";
}

/* ---- slopes ---- */

static void report_steep(Elaboration *e, const Syntax *declaration, const Syntax *distance,
                         Span blame)
{
    Span  span  = blame.source ? blame : distance->span;
    Diag *diag =
        diag_add(e->diags, DIAG_STEEP, span, "the slope of `%s` has no bound", declaration->name);
    diag->label = "this can change arbitrarily fast";
    diag_place(e->diags, diag, distance->span, "the distance is this expression");
    diag->help  = "give the shape a bounded `within`, or keep this part away from divisions by "
                  "zero and jumps";
}

/* The slope is derived over all space; where that has no bound, over `within`, and the distance
   outside of that from the nearest point in it (field.c). */
static bool derive_slope(Elaboration *e, Shape *shape, const Syntax *declaration,
                         const Syntax *syntax)
{
    Box       regions[2] = {box_infinite, shape->box};
    Steepness slope;
    if (!find_slope(e, shape->distance, regions, box_is_finite(shape->box) ? 2 : 1, syntax->span,
                    &slope)) {
        report_steep(e, declaration, syntax, slope.blame);
        return false;
    }
    shape->derived   = slope.bound;
    shape->region    = slope.region;
    shape->per_frame = slope.slot != NODE_NONE;
    shape->distance  = bring_out(e, shape->distance, &slope);
    return true;
}

/* ---- claims ---- */

/* Points for sampling: a fixed sequence (Roberts' R3), spread over a box. */
static void sample_point(uint32_t index, Box box, double point[3])
{
    static const double steps[3] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
    for (int i = 0; i < 3; i++) {
        double t = fmod(0.5 + (index + 1) * steps[i], 1);
        point[i] = box.axis[i].low + t * (box.axis[i].high - box.axis[i].low);
    }
}

static void parameter_values(const Elaboration *e, NodeValue *values)
{
    for (size_t i = 0; i < e->scene->parameters.count; i++) {
        const Parameter *parameter = &e->scene->parameters.items[i];
        memcpy(values[parameter->slot].v, parameter->value, sizeof parameter->value);
    }
}

static void refuse_claim(Elaboration *e, const Syntax *declaration, const char *claim,
                         const char *found, const double point[3])
{
    const Syntax *syntax = find_property(declaration, claim);
    Diag *diag  = diag_add(e->diags, DIAG_FALSE_CLAIM, syntax->span, "`%s` of `%s` is not true",
                           claim, declaration->name);
    diag->label = "claimed here";
    diag_note(e->diags, diag,
              diag_text(e->diags, "%s at [%.4g, %.4g, %.4g]", found, point[0], point[1], point[2]));
    if (strcmp(claim, "exact") == 0)
        diag->help = "leave `exact` out: the compiler then derives a safe slope";
}

/* Whether a point lies farther than `rounding` from the box of the shape. */
static bool is_outside(const Shape *shape, const double point[3], double rounding)
{
    for (int i = 0; i < (shape->figure ? 2 : 3); i++) {
        Range side = shape->box.axis[i];
        if (point[i] < side.low - rounding || point[i] > side.high + rounding)
            return true;
    }
    return false;
}

/* Pairs of near points refute a claimed slope (0: none is claimed), single points a solid
   outside of `within`. */
static bool check_claims(Elaboration *e, const Syntax *declaration, const Shape *shape,
                         Node distance, double slope)
{
    enum { SAMPLES = 400 };
    Tape       tape       = tape_new(e->graph, &distance, 1, e->scratch);
    NodeValue *values     = arena_new_array(e->scratch, NodeValue, e->graph->count);
    NodeValue *parameters = arena_new_array(e->scratch, NodeValue, e->graph->parameters.count);
    parameter_values(e, parameters);
    tape_run_frame(&tape, parameters, values);
    Box around  = box_is_finite(shape->box)
                      ? box_grow(shape->box, 0.3 * box_diagonal(shape->box) + 0.1)
                      : (Box){{{-10, 10}, {-10, 10}, {-10, 10}}};
    double size = box_diagonal(around), rounding = 1e-9 * (1 + size);
    bool   bounded = find_property(declaration, "within") != NULL;
    if (!(size < 1e100)) /* check_extent refuses what is so large, in better words */
        return true;
    for (uint32_t i = 0; i < SAMPLES; i++) {
        double a[3], b[3], moved = 0;
        sample_point(i, around, a);
        sample_point(i + 7 * SAMPLES, (Box){{{-1, 1}, {-1, 1}, {-1, 1}}}, b);
        for (int k = 0; k < 3; k++) {
            b[k] = shape->figure && k == 2 ? a[k] : a[k] + b[k] * size * (i % 2 ? 0.1 : 1e-4);
            moved += (b[k] - a[k]) * (b[k] - a[k]);
        }
        tape_run_point(&tape, a, values);
        double at_a = values[distance].v[0];
        tape_run_point(&tape, b, values);
        double at_b = values[distance].v[0];
        if (slope > 0 && !(fabs(at_a - at_b) <= slope * sqrt(moved) * (1 + 1e-6) + rounding)) {
            const char *found =
                diag_text(e->diags, "its slope is %.4g", fabs(at_a - at_b) / sqrt(moved));
            refuse_claim(e, declaration, shape->exact ? "exact" : "slope", found, a);
            return false;
        }
        if (bounded && at_a < -rounding && is_outside(shape, a, rounding)) {
            refuse_claim(e, declaration, "within", "there is something outside of it", a);
            return false;
        }
    }
    return true;
}

/* Once per declaration, at the sizes of its first use. */
static bool needs_check(Elaboration *e, const Syntax *declaration)
{
    for (size_t i = 0; i < e->checked.count; i++)
        if (e->checked.items[i] == declaration)
            return false;
    array_push(e->arena, &e->checked, declaration);
    return true;
}

/* Two coordinates on the surface, which materials know as `u` and `v`. */
static bool uv_property(Elaboration *e, const Environment *env, const Syntax *declaration,
                        Shape *shape)
{
    const Syntax *syntax = find_property(declaration, "uv");
    shape->without_uv    = syntax ? NULL : shape;
    if (!syntax)
        return true;
    Value value = evaluate(e, env, syntax);
    if (value_size(e, value) == 2)
        shape->uv = value_node(e, value);
    else
        type_error(e, syntax, value, "a list of two numbers");
    return shape->uv != NODE_NONE;
}

/* What the shape is, out of its properties. */
static bool read_properties(Elaboration *e, const Environment *env, const Syntax *declaration,
                            Shape *shape)
{
    const Syntax *bound = find_property(declaration, "bound");
    shape->distance     = field_property(e, env, find_property(declaration, "distance"));
    shape->figure       = flag_property(e, env, declaration, "figure");
    shape->exact        = flag_property(e, env, declaration, "exact");
    if (bound)
        shape->bound = field_property(e, env, bound);
    bool good = within_property(e, env, declaration, &shape->box) &&
                plane_property(e, env, declaration, shape) &&
                uv_property(e, env, declaration, shape) && shape->distance != NODE_NONE &&
                (!bound || shape->bound != NODE_NONE);
    if (good)
        warn_if_empty(e, shape);
    return good;
}

/* Makes the distance safe: by its claimed slope, which is put to the test, or a derived one. */
static bool settle_slope(Elaboration *e, const Environment *env, const Syntax *declaration,
                         bool first, Shape *shape)
{
    Node   plain = shape->distance;
    double slope;
    if (!slope_property(e, env, declaration, &slope))
        return false;
    slope          = shape->exact ? 1 : slope;
    shape->claimed = slope > 0;
    if (slope > 0) {
        shape->derived  = slope;
        shape->distance = divide_by_slope(e->graph, plain, slope);
    } else if (!derive_slope(e, shape, declaration, find_property(declaration, "distance")))
        return false;
    return !first || check_claims(e, declaration, shape, plain, slope);
}

Value declare_instance(Elaboration *e, const Function *function, const Environment *env, Span span)
{
    const Syntax *declaration = function->syntax;
    if (!find_property(declaration, "distance")) {
        Diag *diag = diag_add(e->diags, DIAG_MISSING_ARGUMENT, declaration->name_span,
                              "the shape `%s` has no `distance`", function->name);
        diag->help = "add `distance: ...`, an expression of x, y, z that is negative inside";
        return value_error();
    }
    bool first = needs_check(e, declaration);
    if (first && !check_properties(e, declaration))
        return value_error();

    Shape *shape  = shape_new(e, SHAPE_PRIMITIVE, function->name, span, NULL, 0);
    Span   caller = e->graph->here;
    if (!read_properties(e, env, declaration, shape) ||
        !settle_slope(e, env, declaration, first, shape))
        return value_error();
    arena_free(e->scratch);
    shape->core = find_property(declaration, "core");
    if (shape->core) {
        Environment *kept = arena_new(e->arena, Environment);
        *kept             = *env;
        shape->core_names = kept;
    }
    e->graph->here = caller;
    return value_shape(shape);
}
