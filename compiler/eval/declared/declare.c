/*
 * declare.c: shapes declared in the language, the library's and the users' own.
 *
 * A declaration gives the distance as an expression of the point.  What it claims is put to the
 * test when it is first used (claims.c).  Where no slope is claimed one is derived and the distance
 * divided by it, so that every primitive is 1-Lipschitz from here on.
 */
#include "compiler/eval/declared/declare.h"

#include <math.h>
#include <string.h>

#include "compiler/eval/declared/claims.h"

static const char *const property_names[] = {"distance", "bound", "exact",  "slope",  "within",
                                             "uv",       "plane", "ball",   "figure", "core",
                                             "outline",  "hull",  "example"};
enum { PROPERTY_COUNT = sizeof property_names / sizeof *property_names };

/* The property by which figures of the library say what their outlines are: `outline` for those with arcs. */
static const char border_name[] = "border";

const char *property_of_shape(size_t index)
{
    return index < PROPERTY_COUNT ? property_names[index] : NULL;
}

static bool check_properties(Elaboration *e, const Syntax *declaration)
{
    bool good = true;
    for (uint32_t i = 0; i < declaration->count; i++) {
        const Syntax *property = declaration->children[i];
        bool          known    = property->kind != SYNTAX_PROPERTY ||
                     (strcmp(property->name, border_name) == 0 && !is_of_author(e, declaration));
        for (size_t k = 0; !known && k < PROPERTY_COUNT; k++)
            known = strcmp(property->name, property_names[k]) == 0;
        if (known)
            continue;
        Diag *diag        = diag_add(e->diags, DIAG_UNKNOWN_PROPERTY, property->name_span,
                                     "a shape has no property `%s`", property->name);
        diag->label       = "unknown property";
        diag->replacement = nearest_name(property->name, property_names, PROPERTY_COUNT);
        if (diag->replacement)
            diag->help = "a property with a similar name exists";
        note_names(e, diag, "its properties", property_names, PROPERTY_COUNT);
        good = false;
    }
    return good;
}

/* Returns a property that is a number at every point. */
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
    /* A claim must be true for all values of the parameters. */
    if (value.type != VALUE_EXPRESSION || e->graph->items[value.node].type != TYPE_BOOL)
        type_error(e, syntax, value, "true or false");
    return false;
}

/* Reads `slope`: a claimed bound on how fast the distance changes; 0 when there is none. */
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

/* Finds a corner of `within`, for all values of the parameters; false: reported. */
static bool corner_property(Elaboration *e, Value value, const Syntax *syntax, uint32_t side,
                            Shape *shape)
{
    double     numbers[4];
    const bool known = value_numbers(value, numbers) == 3; /* needs no node */
    const Node node  = known ? NODE_NONE : to_vector(e, value, syntax, "`within`");
    if (!known && node == NODE_NONE)
        return false;
    for (uint32_t i = 0; i < 3; i++) {
        const Range where = known ? range_of(numbers[i]) : node_range(e->builder, node, i);
        if (side == 0)
            shape->box.axis[i].low = where.low;
        else
            shape->box.axis[i].high = where.high;
    }
    shape->corners[side] = node;
    return true;
}

/* Reads `within`: a shape, or two corners. */
static bool within_property(Elaboration *e, const Environment *env, const Syntax *declaration,
                            Shape *shape)
{
    const Syntax *syntax = find_property(declaration, "within");
    shape->box           = box_infinite;
    if (!syntax)
        return true;
    Value value = evaluate(e, env, syntax);
    if (value.type == VALUE_SHAPE) {
        shape->within = value.shape;
        shape->box    = builder_box(e->builder, shape);
        return true;
    }
    if (value.type == VALUE_LIST && value.list->count == 2)
        return corner_property(e, value.list->items[0], syntax, 0, shape) &&
               corner_property(e, value.list->items[1], syntax, 1, shape);
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

/* Reads `ball`: a radius.  The box follows from it, unless there is a `within`. */
static bool ball_property(Elaboration *e, const Environment *env, const Syntax *declaration,
                          Shape *shape)
{
    const Syntax *syntax = find_property(declaration, "ball");
    if (!syntax)
        return true;
    shape->ball_radius = to_number(e, evaluate(e, env, syntax), syntax, "the radius of a ball");
    if (shape->ball_radius == NODE_NONE)
        return false;
    shape->ball_box = !find_property(declaration, "within");
    shape->box      = builder_box(e->builder, shape);
    return true;
}

static void require_order(Elaboration *e, Node low, Node high)
{
    const Node ordered = graph_op2(e->graph, OP_less, low, high);
    if (!graph_is_constant(e->graph, ordered))
        iterations_require(e, ordered);
}

/* Requires the ends of a box in order.  If iterations of a loop are evaluated at once, none may be
   empty: that one earns a warning. */
static void require_sizes(Elaboration *e, const Shape *shape)
{
    if (shape->ball_box)
        require_order(e, graph_number(e->graph, 0), shape->ball_radius);
    for (uint32_t i = 0; !shape->ball_box && i < (shape->figure ? 2 : 3); i++) {
        const double ends[2] = {shape->box.axis[i].low, shape->box.axis[i].high};
        Node         nodes[2];
        for (int k = 0; k < 2; k++)
            nodes[k] = shape->corners[k] == NODE_NONE
                           ? graph_number(e->graph, ends[k])
                           : graph_component(e->graph, shape->corners[k], i);
        require_order(e, nodes[0], nodes[1]);
    }
}

/* A size of 0 or less leaves nothing to see, or a surface without an inside. */
static void warn_if_empty(Elaboration *e, const Shape *shape, Span call)
{
    bool flat = false;
    for (int i = 0; i < (shape->figure ? 2 : 3); i++)
        flat = flat || !(shape->box.axis[i].low < shape->box.axis[i].high);
    if (e->sources->items[call.source].library)
        return;
    if (e->iterated)
        require_sizes(e, shape);
    if (!flat)
        return;
    Diag *diag = diag_add(e->diags, DIAG_NO_EFFECT, shape->span, "this `%s` is empty", shape->name);
    diag->label = "a size is 0 or less";
}

/* ---- slopes ---- */

static void report_steep(Elaboration *e, const Syntax *declaration, const Syntax *distance,
                         Blame blame)
{
    Span  span  = blame.span.source ? blame.span : distance->span;
    Diag *diag  = diag_add(e->diags, DIAG_STEEP, span, "the slope of `%s` has no bound",
                           declaration->name);
    diag->label = "this can change arbitrarily fast";
    diag_secondary(e->diags, diag, distance->span, "the distance is this expression");
    explain_steep(e->builder, diag, blame);
    diag->help = "give the shape a bounded `within`, or keep this part away from divisions by "
                 "zero and jumps";
}

bool needs_check(Elaboration *e, const Syntax *syntax)
{
    for (size_t i = 0; i < e->checked.count; i++)
        if (e->checked.items[i] == syntax)
            return false;
    array_push(e->arena, &e->checked, syntax);
    return true;
}

/* Reads the two coordinates on the surface, which materials know as `u` and `v`.  Thousands of
   shapes need not compute what none asks for; the first of a declaration shows its mistakes. */
static bool uv_property(Elaboration *e, const Environment *env, const Syntax *declaration,
                        bool first, Shape *shape)
{
    const Syntax *syntax = find_property(declaration, "uv");
    shape->without_uv    = syntax ? NULL : shape;
    if (!syntax || !(first || e->uses_uv))
        return true;
    Value value = evaluate(e, env, syntax);
    if (value_size(e, value) == 2)
        shape->uv = value_node(e, value);
    else
        type_error(e, syntax, value, "a list of two numbers");
    return shape->uv != NODE_NONE;
}

/* ---- outlines ---- */

/* Fewer corners are a formula, unless all outlines are wanted: a loop over a list costs as much as some. */
enum { MIN_CORNERS = 64 };

/* Finds a corner that is known now, where no arc begins. */
static bool known_corner(Value value, double corner[4])
{
    uint32_t count = value_numbers(value, corner);
    return count == 2 || (count == 3 && corner[2] == 0);
}

/* Returns the syntax of an outline.  Where outlines are wanted, figures of the library that cannot
   be rounded better by their `core` have one, too: their formulas fold the plane, and meshes do not
   see where that is smooth. */
static const Syntax *outline_syntax(const Elaboration *e, const Syntax *declaration)
{
    const Syntax *outline = find_property(declaration, "outline");
    bool          wanted  = !outline && e->outlines && !is_of_author(e, declaration);
    return wanted && !find_property(declaration, "core") ? find_property(declaration, border_name)
                                                         : outline;
}

/* Reads `outline`: the corners of a polygon.  If they are many and known now, its distance comes
   from a table, not from the property `distance`; false: they are not. */
static bool outline_property(Elaboration *e, const Environment *env, const Syntax *declaration,
                             Path *path)
{
    const Syntax *syntax = outline_syntax(e, declaration);
    Value         points = syntax ? evaluate(e, env, syntax) : value_error();
    if (points.type != VALUE_LIST || points.list->count < (e->outlines ? 3 : MIN_CORNERS))
        return false;
    for (size_t i = 0; i < points.list->count; i++) {
        double corner[4];
        if (!known_corner(points.list->items[i], corner))
            return false;
        if (i == 0)
            path_move(path, corner);
        path_line(path, corner);
    }
    path_close(path);
    return true;
}

/* ---- borders ---- */

static const Syntax *border_property(const Elaboration *e, const Syntax *declaration)
{
    if (is_of_author(e, declaration))
        return NULL;
    const Syntax *border = find_property(declaration, border_name);
    return border ? border : find_property(declaration, "outline");
}

/* Reads [x, y] or [x, y, bulge]; false: it is no such corner. */
static bool border_corner(Elaboration *e, Value value, BorderCorner *corner)
{
    double   numbers[4];
    uint32_t known = value_numbers(value, numbers), size = known ? known : value_size(e, value);
    *corner = (BorderCorner){{0, 0, 0}, {NODE_NONE, NODE_NONE, NODE_NONE}};
    if (size != 2 && size != 3)
        return false;
    const Node node = known ? NODE_NONE : value_node(e, value);
    if (!known && node == NODE_NONE)
        return false;
    for (uint32_t k = 0; k < size; k++)
        if (known)
            corner->numbers[k] = numbers[k];
        else
            corner->nodes[k] = graph_component(e->graph, node, k);
    return true;
}

static void find_border(Elaboration *e, const Shape *shape)
{
    Border      *border = shape->border;
    const size_t said = e->diags->count, errors = e->diags->errors, warnings = e->diags->warnings;
    border->found = true;
    Value value   = evaluate(e, &shape->declaration->names, shape->declaration->border);
    if (e->diags->count > said && !is_stopped(e)) { /* a parameter says which corners there are */
        e->diags->count    = said;
        e->diags->errors   = errors;
        e->diags->warnings = warnings;
        return;
    }
    if (value.type != VALUE_LIST)
        return;
    border->corners = arena_new_array(e->arena, BorderCorner, value.list->count + 1);
    for (size_t i = 0; i < value.list->count; i++)
        if (!border_corner(e, value.list->items[i], &border->corners[i]))
            return;
    border->count = (uint32_t)value.list->count;
}

/* Finds the borders of a shape; CSG nodes below have theirs already. */
void find_borders(Elaboration *e, const Shape *shape)
{
    if (shape->border && !shape->border->found)
        find_border(e, shape);
    if (shape->iterated)
        find_borders(e, shape->iterated);
    for (uint32_t i = 0; i < shape->child_count; i++)
        if (!shape->children[i]->boundary)
            find_borders(e, shape->children[i]);
}

Value value_of_csg_node(Elaboration *e, const Shape *csg_node)
{
    if (csg_node && csg_node->boundary)
        find_borders(e, csg_node);
    return value_shape(csg_node);
}

/* ---- properties ---- */

/* Reads the shape out of its properties. */
static bool read_properties(Elaboration *e, const Environment *env, const Syntax *declaration,
                            bool first, Span call, Shape *shape)
{
    const Syntax *bound = find_property(declaration, "bound");
    shape->distance     = field_property(e, env, find_property(declaration, "distance"));
    shape->figure       = flag_property(e, env, declaration, "figure");
    shape->exact        = flag_property(e, env, declaration, "exact");
    if (bound)
        shape->bound = field_property(e, env, bound);
    bool good = within_property(e, env, declaration, shape) &&
                plane_property(e, env, declaration, shape) &&
                ball_property(e, env, declaration, shape) &&
                uv_property(e, env, declaration, first, shape) && shape->distance != NODE_NONE &&
                (!bound || shape->bound != NODE_NONE);
    if (good)
        warn_if_empty(e, shape, call);
    return good;
}

/* Makes the distance safe: by its claimed slope, which is put to the test, or a derived one. */
static bool bound_slope(Elaboration *e, const Environment *env, const Syntax *declaration,
                        bool first, Shape *shape)
{
    const Syntax *distance = find_property(declaration, "distance");
    double        slope;
    Blame         blame;
    shape->declared = shape->distance;
    if (!slope_property(e, env, declaration, &slope))
        return false;
    slope = shape->exact ? 1 : slope;
    if (slope > 0)
        claim_slope(e->builder, shape, slope);
    else if (!derive_slope(e->builder, shape, distance->span, &blame)) {
        report_steep(e, declaration, distance, blame);
        return false;
    }
    return !first || check_claims(e, shape, slope);
}

/* A core that no `.round` asks for yet is tried by a radius that is a tenth of the least side. */
static bool try_core(Elaboration *e, const Shape *shape)
{
    double least = HUGE_VAL;
    for (int i = 0; i < (shape->figure ? 2 : 3); i++)
        least = fmin(least, shape->box.axis[i].high - shape->box.axis[i].low);
    if (!(least > 0) || is_of_library(e, shape))
        return true;
    Node         radius = graph_number(e->graph, isfinite(least) ? 0.1 * least : 0.1);
    const Shape *core   = declared_core(e, shape, radius);
    return core && check_core(e, shape, core, radius);
}

const Shape *declared_core(Elaboration *e, const Shape *shape, Node rounding)
{
    Node outer  = e->rounding;
    e->rounding = rounding;
    Value core  = evaluate(e, &shape->declaration->names, shape->declaration->core);
    e->rounding = outer;
    if (core.type == VALUE_SHAPE && core.shape->figure == shape->figure)
        return core.shape;
    type_error(e, shape->declaration->core, core, shape->figure ? "a plane figure" : "a solid");
    return NULL;
}

Value declared_hull(Elaboration *e, const Shape *shape)
{
    return evaluate(e, &shape->declaration->names, shape->declaration->hull);
}

static const struct Declaration *declaration_new(Elaboration *e, const Function *function,
                                                 const Environment *env)
{
    struct Declaration *known = arena_new(e->arena, struct Declaration);
    *known       = (struct Declaration){function->syntax, find_property(function->syntax, "core"),
                                        find_property(function->syntax, "hull"),
                                        border_property(e, function->syntax), *env};
    known->names = known->core || known->hull || known->border
                       ? keep_names(e, env, function->closure)
                       : (Environment){NULL, env->scope};
    return known;
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
    Path path = {.arena = e->arena};
    if (outline_property(e, env, declaration, &path))
        return value_shape(
            make_outline(e->builder, function->name, &path.curves, FILL_EVEN_ODD, span));
    bool first = needs_check(e, declaration);
    if (first && !check_properties(e, declaration))
        return value_error();

    /* The author asked for what the library makes of other shapes. */
    const char *name = function->name;
    Span        call = span, caller = e->graph->here;
    made_for_author(e, &name, &span);
    Shape *shape       = shape_new(e->builder, SHAPE_PRIMITIVE, name, span, NULL, 0);
    shape->declaration = declaration_new(e, function, env);
    if (shape->declaration->border)
        shape->border = arena_new(e->arena, Border);
    if (!read_properties(e, env, declaration, first, call, shape) ||
        !bound_slope(e, env, declaration, first, shape))
        return value_error();
    if (!e->uses_uv)
        shape->uv = NODE_NONE; /* of the first as of the others: they are alike */
    arena_clear(e->scratch);
    if (first && shape->declaration->core && !try_core(e, shape))
        return value_error();
    if (shape->plane_normal != NODE_NONE && !is_of_library(e, shape))
        array_push(e->arena, &e->scene->half_spaces, shape);
    e->graph->here = caller;
    return value_shape(shape);
}
