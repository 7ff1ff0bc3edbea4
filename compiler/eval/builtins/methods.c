/*
 * methods.c: what can be done to shapes and maps with a dot.
 */
#include "compiler/eval/builtins/builtins.h"

#include <math.h>
#include <string.h>

#include "compiler/eval/data/from_files.h"
#include "compiler/eval/declared/claims.h"
#include "compiler/eval/declared/declare.h"
#include "compiler/eval/hulls/hull.h"
#include "compiler/eval/view/material.h"

typedef Value Method(Elaboration *e, const Shape *shape, Call *call);

static bool lies_in_plane(const Shape *shape) { return shape->figure || shape->nothing; }

/* Returns a vector of three.  Figures take two as well: `otherwise` is the third. */
static Node want_extent(Elaboration *e, const Shape *shape, const Call *call, double otherwise)
{
    Value value = call->arguments[0].value;
    Call  whole = *call;
    if (lies_in_plane(shape) && value_size(e, value) == 2) {
        Node flat                = value_node(e, value);
        Node third               = graph_number(e->graph, otherwise);
        Node one                 = graph_component(e->graph, flat, 0);
        Node two                 = graph_component(e->graph, flat, 1);
        Node node                = graph_op3(e->graph, OP_vec3, one, two, third);
        whole.arguments[0].value = value_of_node(e, node);
    }
    return want_vector(e, &whole, 0, ORIGIN);
}

/* Returns the shape after a map; NULL, whose reason has been reported, is VALUE_ERROR. */
static Value moved(Elaboration *e, const Shape *shape, const Map *map, const Call *call)
{
    return map ? value_shape(make_transform(e->builder, shape, map, call->syntax->span))
               : value_error();
}

static Value method_move(Elaboration *e, const Shape *shape, Call *call)
{
    Node by = want_extent(e, shape, call, 0);
    return by == NODE_NONE ? value_error() : moved(e, shape, map_translation(e->builder, by), call);
}

/* Figures turn in their plane: a number alone is the angle, about z. */
static void give_axis(Elaboration *e, Call *call)
{
    static const double TOWARDS[3] = {0, 0, 1};
    Argument           *axis = &call->arguments[0], *angle = &call->arguments[1];
    if (!angle->syntax && axis->syntax && value_size(e, axis->value) == 1) {
        *angle       = *axis;
        axis->syntax = NULL;
    }
    if (angle->syntax && !axis->syntax)
        *axis = (Argument){value_vector(e, TOWARDS, 3), call->syntax};
}

static Value method_rotate(Elaboration *e, const Shape *shape, Call *call)
{
    if (lies_in_plane(shape))
        give_axis(e, call);
    const Argument *axis = &call->arguments[0];
    if (is_given(call, 0) && is_given(call, 1) && value_size(e, axis->value) == 1) {
        explain_usage(e, type_error(e, axis->syntax, axis->value, "an axis, a vector of 3"),
                      call->syntax, "rotate");
        return value_error();
    }
    if (is_given(call, 0) && is_given(call, 1))
        return moved(e, shape, want_rotation(e, call), call);
    Diag *diag = missing_argument(e, call->syntax, "rotate",
                                  shape->figure || is_given(call, 0) ? "angle" : "axis");
    if (shape->figure)
        diag->help = "a figure turns in its plane: `.rotate(30deg)`";
    else
        explain_usage(e, diag, call->syntax, "rotate");
    return value_error();
}

static Value method_scale(Elaboration *e, const Shape *shape, Call *call)
{
    const Argument *by = &call->arguments[0];
    if (value_size(e, by->value) == 1)
        return moved(e, shape, want_scaling(e, call), call);
    Node factors = want_extent(e, shape, call, 1);
    if (factors == NODE_NONE)
        return value_error();
    for (uint32_t i = 0; i < 3; i++)
        if (!check_positive(e, graph_component(e->graph, factors, i), by->syntax, "a scale"))
            return value_error();
    return value_shape(make_stretch(e->builder, shape, factors, call->syntax->span));
}

static Value method_align(Elaboration *e, const Shape *shape, Call *call)
{
    Node from = want_vector(e, call, 0, ORIGIN), to = want_vector(e, call, 1, ORIGIN);
    if (from == NODE_NONE || to == NODE_NONE ||
        !check_direction(e, from, call->arguments[0].syntax, "a direction") ||
        !check_direction(e, to, call->arguments[1].syntax, "a direction"))
        return value_error();
    return moved(e, shape, map_alignment(e->builder, from, to), call);
}

static Value method_mirror(Elaboration *e, const Shape *shape, Call *call)
{
    Node normal, offset;
    if (!want_plane(e, call, &normal, &offset))
        return value_error();
    return value_of_csg_node(e, make_mirror(e->builder, shape, normal, offset, call->syntax->span));
}

static Value method_transform(Elaboration *e, const Shape *shape, Call *call)
{
    const Argument *map = &call->arguments[0];
    if (map->value.type != VALUE_MAP) {
        type_error(e, map->syntax, map->value, "a map of space");
        return value_error();
    }
    return moved(e, shape, map->value.map, call);
}

static Value method_repeat(Elaboration *e, const Shape *shape, Call *call)
{
    uint32_t cells[3];
    Node     period;
    if (!want_lattice(e, call, &period, cells))
        return value_error();
    return value_of_csg_node(
        e, make_repeat(e->builder, shape, period, cells, NODE_NONE, call->syntax->span));
}

static Value method_repeat_polar(Elaboration *e, const Shape *shape, Call *call)
{
    static const double UP[3] = {0, 1, 0};
    uint32_t            count;
    Node                axis = want_vector(e, call, 1, UP);
    if (!want_count(e, call, 0, 1, 100000, 1, &count) || axis == NODE_NONE)
        return value_error();
    if (count == 1)
        return value_shape(shape);
    Node up = graph_constant(e->graph, TYPE_VEC3, UP);
    if (axis == up)
        return value_shape(make_repeat_polar(e->builder, shape, count, call->syntax->span));
    /* About another axis: turn it up, repeat, turn it back. */
    if (!check_direction(e, axis, call->arguments[1].syntax, "an axis"))
        return value_error();
    const Map   *raise  = map_alignment(e->builder, axis, up);
    const Shape *raised = make_transform(e->builder, shape, raise, call->syntax->span);
    const Shape *copies = make_repeat_polar(e->builder, raised, count, call->syntax->span);
    return value_shape(
        make_transform(e->builder, copies, map_inverse(e->builder, raise), call->syntax->span));
}

static Value method_offset(Elaboration *e, const Shape *shape, Call *call)
{
    Node r = want_number(e, call, 0, 0);
    if (r == NODE_NONE)
        return value_error();
    return value_shape(
        grown_outline(e, shape, make_offset(e->builder, shape, r, call->syntax->span)));
}

/* Returns the shape that, grown by r, is `shape` with round edges; NULL when it does not know one.
   *good becomes false where it knows a wrong one. */
static const Shape *core_of(Elaboration *e, const Shape *shape, Node r, const Call *call,
                            bool *good)
{
    if (shape->declaration && shape->declaration->core) {
        const Shape *core = declared_core(e, shape, r);
        *good             = core &&
                (!needs_check(e, shape->declaration->core) || check_core(e, shape, core, r));
        return core;
    }
    if (shape->kind != SHAPE_TRANSFORM)
        return NULL;
    Node         smaller = graph_op2(e->graph, OP_div, r, shape->map.scale);
    const Shape *core    = core_of(e, shape->children[0], smaller, call, good);
    return core ? make_transform(e->builder, core, &shape->map, call->syntax->span) : NULL;
}

static Value method_round(Elaboration *e, const Shape *shape, Call *call)
{
    Node r = want_number(e, call, 0, 0);
    if (r == NODE_NONE ||
        !check_not_negative(e, r, call->arguments[0].syntax, "the radius of `round`"))
        return value_error();
    bool         good = true;
    const Shape *core = core_of(e, shape, r, call, &good);
    if (!good)
        return value_error();
    Span span = call->syntax->span;
    return value_shape(core ? make_rounded(e->builder, shape, core, r, span)
                            : grown_outline(e, shape, make_offset(e->builder, shape, r, span)));
}

static Value method_shell(Elaboration *e, const Shape *shape, Call *call)
{
    Node t = want_number(e, call, 0, 0);
    if (t == NODE_NONE ||
        !check_positive(e, t, call->arguments[0].syntax, "the thickness of a shell"))
        return value_error();
    return value_shape(make_shell(e->builder, shape, t, call->syntax->span));
}

static Value method_elongate(Elaboration *e, const Shape *shape, Call *call)
{
    Node v = want_vector(e, call, 0, ORIGIN);
    if (v == NODE_NONE)
        return value_error();
    Node half = graph_number(e->graph, 0.5);
    half      = graph_op2(e->graph, OP_scale, v, half);
    if (!check_not_negative(e, half, call->arguments[0].syntax, "`elongate`"))
        return value_error();
    return value_shape(make_elongate(e->builder, shape, half, call->syntax->span));
}

static bool check_figure(Elaboration *e, const Shape *shape, const Call *call)
{
    if (lies_in_plane(shape))
        return true;
    Diag *diag  = diag_add(e->diags, DIAG_TYPE_MISMATCH, call->syntax->children[0]->span,
                           "`%s` needs a plane figure, found a solid", call->name);
    diag->label = "this is a solid";
    diag->help  = "plane figures are `circle`, `rectangle`, `polygon`, `regular`, `star`, "
                  "`segment`, `arc` and `bezier`";
    return false;
}

static Value method_extrude(Elaboration *e, const Shape *shape, Call *call)
{
    Node height = want_number(e, call, 0, 1);
    if (height == NODE_NONE || !check_figure(e, shape, call))
        return value_error();
    if (is_given(call, 0) &&
        !check_positive(e, height, call->arguments[0].syntax, "the height of an extrusion"))
        return value_error();
    return value_shape(make_extrude(e->builder, shape, height, call->syntax->span));
}

static Value method_revolve(Elaboration *e, const Shape *shape, Call *call)
{
    Node offset = want_number(e, call, 0, 0);
    if (offset == NODE_NONE || !check_figure(e, shape, call))
        return value_error();
    return value_of_csg_node(e, make_revolve(e->builder, shape, offset, call->syntax->span));
}

static Value method_paint(Elaboration *e, const Shape *shape, Call *call)
{
    const Material *material = to_material(e, call->arguments[0].value, call->arguments[0].syntax);
    return material ? value_shape(make_paint(e->builder, shape, material, call->syntax->span))
                    : value_error();
}

static Value method_smooth_mirrors(Elaboration *e, const Shape *shape, Call *call)
{
    Node width = is_given(call, 0) ? want_number(e, call, 0, 0) : NODE_NONE;
    if (is_given(call, 0) &&
        (width == NODE_NONE || !check_not_negative(e, width, call->arguments[0].syntax, "a width")))
        return value_error();
    return value_shape(make_smooth(e->builder, shape, width, call->syntax->span));
}

/* Chooses how thick an open surface is where a distance to it is needed and none is given, so that it looks
   like a surface. */
static Node open_surface_thickness(Elaboration *e, const Shape *region, const Call *call)
{
    if (is_given(call, 2))
        return want_number(e, call, 2, 0);
    return graph_number(e->graph, 1e-3 * box_diagonal(region->box));
}

/* Returns the surface alone. */
static const Shape *open_surface_of(Elaboration *e, const Shape *shape, const Shape *region,
                                    Node thickness, const Call *call)
{
    if (!box_is_finite(region->box)) {
        Diag *diag  = diag_add(e->diags, DIAG_BAD_VALUE, call->arguments[0].syntax->span,
                               "a surface is cut open by a bounded region");
        diag->label = "endless";
        return NULL;
    }
    return make_open_surface(e->builder, shape, thickness, call->syntax->span);
}

static Value method_within(Elaboration *e, const Shape *shape, Call *call)
{
    const Shape *region = want_shape(e, call, 0);
    if (!region)
        return value_error();
    bool open = false;
    if (!want_flag(e, call, 1, &open))
        return value_error();
    Box box = region->box;
    open    = open && !box_is_empty(box); /* nothing of a surface is nothing of its solid, too */
    Node thickness = open_surface_thickness(e, region, call);
    if (thickness == NODE_NONE ||
        (is_given(call, 2) &&
         !check_not_negative(e, thickness, call->arguments[2].syntax, "a thickness")))
        return value_error();
    /* A field's solid ends at the sides of its box, where no open surface shall be. */
    if (open && box_is_finite(box))
        box = box_grow(
            box, 2 * fmax(node_range(e->builder, thickness, 0).high, 1e-3 * box_diagonal(box)));
    shape = restrict_shape(e->builder, shape, box, open);
    if (open && !(shape = open_surface_of(e, shape, region, thickness, call)))
        return value_error();
    const Shape *both[] = {shape, region};
    return value_of_csg_node(
        e, make_csg_node(e->builder, SHAPE_INTERSECTION, both, 2, blend_sharp, call->syntax->span));
}

static MakeDeformed *deformation(const char *name)
{
    static const struct {
        const char   *name;
        MakeDeformed *make;
    } all[] = {
#define DEFORMATION(KIND, name, parameters, rule, meaning) {#name, make_##name},
#include "compiler/shape/shapes.def"
    };
    size_t i = 0;
    while (strcmp(all[i].name, name) != 0)
        i++;
    return all[i].make;
}

/* Evaluates one of the deformations of shapes.def: an axis, and one or two numbers after it. */
static Value method_deform(Elaboration *e, const Shape *shape, Call *call)
{
    DeformArguments asked = {.name       = call->name,
                             .span       = call->syntax->span,
                             .shape_span = call->syntax->children[0]->span};
    asked.axis            = want_vector(e, call, 0, ORIGIN);
    bool good = asked.axis != NODE_NONE && check_direction(e, asked.axis, call->arguments[0].syntax,
                                                           "the axis of a deformation");
    for (uint32_t i = 0; i < 2 && is_given(call, 1 + i); i++) {
        asked.numbers[i]      = want_number(e, call, 1 + i, 0);
        asked.number_spans[i] = call->arguments[1 + i].syntax->span;
        good                  = good && asked.numbers[i] != NODE_NONE;
    }
    return good ? value_shape(deformation(call->name)(e->builder, shape, &asked)) : value_error();
}

static Value method_displace(Elaboration *e, const Shape *shape, Call *call)
{
    const Argument *formula   = &call->arguments[0];
    Node            amplitude = want_number(e, call, 1, 1);
    if (value_size(e, formula->value) != 1) {
        type_error(e, formula->syntax, formula->value, "a number");
        return value_error();
    }
    if (amplitude == NODE_NONE)
        return value_error();
    DeformArguments asked = {.name       = call->name,
                             .numbers    = {amplitude},
                             .span       = call->syntax->span,
                             .shape_span = call->syntax->children[0]->span};
    return value_shape(make_displace(e->builder, shape, value_node(e, formula->value),
                                     formula->syntax->span, &asked));
}

/* ---- dispatch ---- */

static const struct {
    const char *name, *parameters;
    Method     *method;
} methods[] = {
#define METHOD(name, parameters, function, meaning) {#name, parameters, method_##function},
#include "compiler/eval/builtins/methods.def"
#undef METHOD
};
enum { METHOD_COUNT = sizeof methods / sizeof *methods };

static bool is_method(const char *name)
{
    for (size_t i = 0; i < METHOD_COUNT; i++)
        if (strcmp(methods[i].name, name) == 0)
            return true;
    return false;
}

/* Returns help for a method that something other than a shape does not have; NULL: nothing is
   known. */
static const char *method_help(Elaboration *e, const Syntax *syntax, Value receiver)
{
    if (receiver.type == VALUE_FUNCTION)
        return "call it first: write parentheses after the name";
    if (receiver.type == VALUE_LIST && is_method(syntax->name))
        return form_help(e->diags, FORM_LIST_METHOD);
    if (value_size(e, receiver) >= 2)
        return "components of a vector are `x y z w` or `r g b a`, as in `v.xz`";
    return NULL;
}

static Value unknown_method(Elaboration *e, const Syntax *syntax, Value receiver)
{
    static const char *const of_maps[] = {"inverse"};
    const char              *names[METHOD_COUNT];
    size_t                   count = 0;
    for (size_t i = 0; i < METHOD_COUNT; i++)
        names[count++] = methods[i].name;
    const char *type = value_type_name(e, receiver);
    Diag *diag = diag_add(e->diags, DIAG_UNKNOWN_METHOD, syntax->name_span, "%s has no method `%s`",
                          type, syntax->name);
    diag->label    = "unknown method";
    bool explained = receiver.type == VALUE_SHAPE &&
                     explain_word(e->diags, diag, SYNONYM_METHOD, syntax->name, "");
    if (receiver.type == VALUE_SHAPE && !explained)
        diag->replacement = nearest_name(syntax->name, names, count);
    if (diag->replacement && !explained)
        diag->help = "a method with a similar name exists";
    diag_secondary(e->diags, diag, syntax->children[0]->span,
                   diag_text(e->diags, "this is %s", type));
    if (receiver.type == VALUE_SHAPE && !diag->replacement && !explained)
        note_names(e, diag, "its methods", names, count);
    else if (receiver.type == VALUE_MAP)
        note_names(e, diag, "its methods", of_maps, 1);
    else if (receiver.type != VALUE_SHAPE)
        diag->help = method_help(e, syntax, receiver);
    return value_error();
}

Value call_method(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    Value receiver = evaluate(e, env, syntax->children[0]);
    if (receiver.type == VALUE_ERROR)
        return receiver;
    if (receiver.type == VALUE_MAP && strcmp(syntax->name, "inverse") == 0 && syntax->count == 1)
        return value_map(map_inverse(e->builder, receiver.map));
    if (receiver.type == VALUE_FUNCTION && repeats_functions(syntax->name))
        return repeat_function(e, env, syntax, receiver.function);
    if (receiver.type == VALUE_RECORD && syntax->count == 1)
        return record_member(e, receiver.record, syntax->name, syntax->name_span);
    if (receiver.type == VALUE_TEXTURE)
        return texture_method(e, env, syntax, receiver.texture);
    if (is_component(e, receiver, syntax))
        return value_components(e, syntax, receiver);
    for (size_t i = 0; receiver.type == VALUE_SHAPE && i < METHOD_COUNT; i++) {
        Call call;
        if (strcmp(methods[i].name, syntax->name) != 0)
            continue;
        bool outer     = e->in_material;
        e->in_material = outer || methods[i].method == method_paint || /* a colour is a material */
                         methods[i].method == method_color_by;
        bool bound     = bind_arguments(e, env, syntax, 1, methods[i].name, methods[i].parameters,
                                        &call);
        e->in_material = outer;
        if (!bound)
            return value_error();
        return methods[i].method(e, receiver.shape, &call);
    }
    return unknown_method(e, syntax, receiver);
}
