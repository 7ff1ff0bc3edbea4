/*
 * csg.c: operators and built-in functions that make one shape of several.
 */
#include "compiler/eval/builtins/builtins.h"
#include "compiler/eval/declared/declare.h"
#include "compiler/eval/hulls/fillet.h"

/* The number of a fillet is behind the kinds of blends: fillets are unions of circular ones,
   cut. */
enum { FILLET = BLEND_COUNT };
static const char *const blend_spellings[] = {
#define BLEND(name, ...) #name,
#include "compiler/graph/blends.def"
    "fillet",
};
static const Choices blend_names = {
    .noun    = "blend",
    .wanted  = "the kind of a blend, a string",
    .unknown = "unknown kind of blend",
    .more    = "",
    .items   = blend_spellings,
    .count   = FILLET + 1,
};

static const char *const falloff_spellings[] = {
#define FALLOFF(name, spelling, steepest, meaning) spelling,
#include "compiler/shape/falloffs.def"
#undef FALLOFF
};
static const Choices falloff_names = {
    .noun    = "falloff",
    .wanted  = "the name of a falloff, a string",
    .unknown = "unknown falloff",
    .more    = "",
    .items   = falloff_spellings,
    .count   = FALLOFF_COUNT,
};

/* Finds the parameters `blend= kind= steps=`, of which `first` is the first.  False: reported. */
static bool blend_arguments(Elaboration *e, const Call *call, uint32_t first, Blend *blend,
                            bool *fillet)
{
    uint32_t kind, steps;
    *blend = blend_sharp;
    if (!want_name(e, &call->arguments[first + 1], &blend_names, &kind) ||
        !want_count(e, call, first + 2, 1, 64, 4, &steps))
        return false;
    *fillet      = kind == FILLET;
    blend->kind  = *fillet ? BLEND_circular : (BlendKind)kind;
    blend->steps = graph_number(e->graph, steps);
    if (!is_given(call, first))
        return true;
    Node width = want_number(e, call, first, 0);
    if (width == NODE_NONE ||
        !check_not_negative(e, width, call->arguments[first].syntax, "the width of a blend"))
        return false;
    if (node_range(e->builder, width, 0).high != 0)
        blend->width = width;
    return true;
}

/* Collects the shapes of a call: a shape, or the elements of a list.  False: reported, at
   `origin`. */
static bool collect_shapes(Elaboration *e, const Call *call, Value value, const Syntax *origin,
                           Values *shapes)
{
    if (value.type == VALUE_LIST) {
        if (!check_shape_count(e, value.list, origin->span))
            return false;
        for (size_t i = 0; i < value.list->count; i++)
            if (!collect_shapes(e, call, value.list->items[i], origin, shapes))
                return false;
        return true;
    }
    if (value.type != VALUE_SHAPE) {
        type_error(e, origin, value, "shapes");
        return false;
    }
    array_push_large(e->values, shapes, value);
    return true;
}

/* Returns the shapes of a call, if all are solids or all figures; NULL: reported. */
static const Shape **joinable_shapes(Elaboration *e, const Call *call, const Values *values)
{
    const Shape **shapes = arena_new_array(e->values, const Shape *, values->count + 1);
    const Shape  *first  = NULL; /* of those that are something */
    for (size_t i = 0; i < values->count; i++) {
        shapes[i] = values->items[i].shape;
        if (!first && !shapes[i]->nothing)
            first = shapes[i];
        if (first && !shapes[i]->nothing && shapes[i]->figure != first->figure) {
            Diag *diag = diag_add(e->diags, DIAG_TYPE_MISMATCH, call->syntax->span,
                                  "plane figures and solids cannot be joined");
            diag->help = "make figures solid with `.extrude(height)` or `.revolve()`";
            return NULL;
        }
    }
    return shapes;
}

/* The hull of its parts, which a fillet does not leave, says nothing about what is cut away. */
static bool refuse_fillet(Elaboration *e, const Call *call, uint32_t first_option)
{
    const Syntax *kind = call->arguments[first_option + 1].syntax;
    Diag         *diag = diag_add(e->diags, DIAG_BAD_VALUE, kind->span, "fillets are for unions");
    diag->label        = diag_text(e->diags, "this is `%s`", call->name);
    diag->help         = "edges that are cut are rounded by `kind: \"circular\"`";
    return false;
}

static Value join(Elaboration *e, const Call *call, ShapeKind kind, const Values *values,
                  uint32_t first_option)
{
    Blend blend;
    bool  fillet;
    if (!blend_arguments(e, call, first_option, &blend, &fillet) ||
        (fillet && kind != SHAPE_UNION && !refuse_fillet(e, call, first_option)))
        return value_error();
    if (values->count == 0 && kind != SHAPE_UNION) {
        diag_add(e->diags, DIAG_MISSING_ARGUMENT, call->syntax->span,
                 "`%s` needs at least one shape", call->name);
        return value_error();
    }
    const Shape **shapes = joinable_shapes(e, call, values);
    if (!shapes)
        return value_error();
    uint32_t count = (uint32_t)values->count;
    if (fillet && blend.width != NODE_NONE && count > 1) {
        const Shape *csg_node = make_fillet(e, call, shapes, count, blend);
        return csg_node ? value_shape(csg_node) : value_error();
    }
    return value_of_csg_node(
        e, make_csg_node(e->builder, kind, shapes, count, blend, call->syntax->span));
}

/* ---- two shapes ---- */

static bool can_be_joined(Elaboration *e, const Shape *a, const Shape *b, Span span)
{
    if (a->figure == b->figure || a->nothing || b->nothing)
        return true;
    Diag *diag = diag_add(e->diags, DIAG_TYPE_MISMATCH, span,
                          "a plane figure and a solid cannot be joined");
    diag->help = "make the figure solid with `.extrude(height)` or `.revolve()`";
    return false;
}

Value join_shapes(Elaboration *e, const Syntax *syntax, const Shape *a, const Shape *b)
{
    ShapeKind kind = syntax->op == TOKEN_BAR         ? SHAPE_UNION
                     : syntax->op == TOKEN_AMPERSAND ? SHAPE_INTERSECTION
                                                     : SHAPE_DIFFERENCE;
    if (!can_be_joined(e, a, b, syntax->name_span))
        return value_error();
    const Shape *shapes[] = {a, b};
    return value_of_csg_node(e,
                             make_csg_node(e->builder, kind, shapes, 2, blend_sharp, syntax->span));
}

Value choose_shape(Elaboration *e, const Syntax *syntax, Value condition, const Shape *yes,
                   const Shape *no)
{
    if (value_time(e, condition) == TIME_POINT) {
        point_error(e, syntax->children[0], "what chooses a shape");
        return value_error();
    }
    if (!can_be_joined(e, yes, no, syntax->span))
        return value_error();
    return value_shape(make_choice(e->builder, condition.node, yes, no, syntax->span));
}

/* ---- functions ---- */

static Value join_rest(Elaboration *e, Call *call, ShapeKind kind)
{
    Values shapes = {0};
    if (is_given(call, 0) &&
        !collect_shapes(e, call, call->arguments[0].value, call->arguments[0].syntax, &shapes))
        return value_error();
    for (uint32_t i = 0; i < call->rest_count; i++)
        if (!collect_shapes(e, call, call->rest[i].value, call->rest[i].syntax, &shapes))
            return value_error();
    return join(e, call, kind, &shapes, 1);
}

Value builtin_union(Elaboration *e, Call *call) { return join_rest(e, call, SHAPE_UNION); }

Value builtin_intersection(Elaboration *e, Call *call)
{
    return join_rest(e, call, SHAPE_INTERSECTION);
}

Value builtin_difference(Elaboration *e, Call *call)
{
    return join_rest(e, call, SHAPE_DIFFERENCE);
}

bool joins_shapes(const Builtin *builtin)
{
    return builtin->function == builtin_union || builtin->function == builtin_intersection ||
           builtin->function == builtin_difference;
}

Value builtin_xor(Elaboration *e, Call *call)
{
    const Shape *a = want_shape(e, call, 0), *b = want_shape(e, call, 1);
    if (!a || !b)
        return value_error();
    Value  pair[] = {call->arguments[0].value, call->arguments[1].value};
    Values values = {pair, 2, 2};
    return join(e, call, SHAPE_XOR, &values, 2);
}

Value builtin_morph(Elaboration *e, Call *call)
{
    const Shape *a = want_shape(e, call, 0), *b = want_shape(e, call, 1);
    Node         t = want_number(e, call, 2, 0);
    if (!a || !b || t == NODE_NONE)
        return value_error();
    Range range = node_range(e->builder, t, 0);
    if (range.low < 0 || range.high > 1) {
        Diag *diag  = diag_add(e->diags, DIAG_BAD_VALUE, call->arguments[2].syntax->span,
                               "`t` of `morph` must stay in [0, 1]");
        diag->label = diag_text(e->diags, "this goes from %g to %g", range.low, range.high);
        return value_error();
    }
    return value_shape(make_morph(e->builder, a, b, t, call->syntax->span));
}

/* Returns a number above 0; NODE_NONE: reported. */
static Node want_positive(Elaboration *e, const Call *call, uint32_t index, double otherwise,
                          const char *what)
{
    Node node = want_number(e, call, index, otherwise);
    if (node == NODE_NONE || !is_given(call, index) ||
        check_positive(e, node, call->arguments[index].syntax, what))
        return node;
    return NODE_NONE;
}

Value builtin_meta(Elaboration *e, Call *call)
{
    Values          values = {0};
    uint32_t        falloff;
    const Argument *list = &call->arguments[0];
    if (!collect_shapes(e, call, list->value, list->syntax, &values) ||
        !want_name(e, &call->arguments[2], &falloff_names, &falloff))
        return value_error();
    Node level = want_positive(e, call, 1, 0.5, "the level of a metasurface");
    Node reach = want_positive(e, call, 3, 0.5, "the reach of a falloff");
    if (level == NODE_NONE || reach == NODE_NONE)
        return value_error();
    const Shape **shapes = joinable_shapes(e, call, &values);
    if (!shapes)
        return value_error();
    return value_shape(make_meta(e->builder, shapes, (uint32_t)values.count, level, reach,
                                 (FalloffKind)falloff, call->syntax->span));
}
