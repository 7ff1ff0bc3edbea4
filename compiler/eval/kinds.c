/*
 * kinds.c: what a parameter takes: values of its kind (kinds.def), numbers in its range, and in the
 * library values like its default.
 */
#include "compiler/eval/kinds.h"

#include <math.h>

typedef bool KindCheck(Elaboration *e, Value value);

/* ---- one value ---- */

static bool is_number(Elaboration *e, Value value) { return value_size(e, value) == 1; }
static bool is_pair(Elaboration *e, Value value) { return value_size(e, value) == 2; }
static bool is_point(Elaboration *e, Value value) { return value_size(e, value) == 3; }
static bool is_value(Elaboration *e, Value value) { return value_size(e, value) > 0; }
static bool is_place(Elaboration *e, Value value)
{
    return is_pair(e, value) || is_point(e, value);
}

static bool is_flag(Elaboration *e, Value value)
{
    (void)e;
    return value.type == VALUE_BOOLEAN;
}

static bool is_count(Elaboration *e, Value value)
{
    (void)e;
    return value.type == VALUE_NUMBER && value.number >= 0 && value.number == floor(value.number);
}

static bool is_shape(Elaboration *e, Value value)
{
    (void)e;
    return value.type == VALUE_SHAPE;
}

static bool is_region(Elaboration *e, Value value)
{
    return is_shape(e, value) && box_is_finite(value.shape->box);
}

static bool is_figure(Elaboration *e, Value value)
{
    return is_region(e, value) && value.shape->figure;
}

static bool is_solid(Elaboration *e, Value value)
{
    return is_shape(e, value) && !value.shape->figure;
}

static bool is_material(Elaboration *e, Value value)
{
    return value.type == VALUE_MATERIAL || is_point(e, value);
}

static bool is_any(Elaboration *e, Value value)
{
    (void)e;
    return value.type != VALUE_ERROR;
}

static bool is_pattern(Elaboration *e, Value value)
{
    (void)e;
    return value.type == VALUE_TEXTURE || value.type == VALUE_FUNCTION;
}

/* Returns the first element that a check refuses, or SIZE_MAX. */
static size_t first_refused(Elaboration *e, const List *list, KindCheck *check)
{
    for (size_t i = 0; i < list->count; i++)
        if (!check(e, list->items[i]))
            return i;
    return SIZE_MAX;
}

static bool is_list_of(Elaboration *e, Value value, KindCheck *check, size_t least)
{
    return value.type == VALUE_LIST && value.list->count >= least &&
           first_refused(e, value.list, check) == SIZE_MAX;
}

static bool is_radius(Elaboration *e, Value value)
{
    return is_number(e, value) && !(value.type == VALUE_NUMBER && value.number < 0);
}

static bool is_radii(Elaboration *e, Value value)
{
    return is_radius(e, value) || is_list_of(e, value, is_radius, 2);
}

static bool is_mirror(Elaboration *e, Value value)
{
    return value.type == VALUE_LIST && value.list->count == 2 &&
           is_point(e, value.list->items[0]) && is_number(e, value.list->items[1]);
}

static bool is_curve(Elaboration *e, Value value)
{
    return is_list_of(e, value, is_point, 3) && value.list->count == 3;
}

static bool is_polyline(Elaboration *e, Value value) { return is_list_of(e, value, is_point, 2); }

static bool is_path(Elaboration *e, Value value)
{
    return is_polyline(e, value) || is_list_of(e, value, is_curve, 1);
}

/* ---- rows ---- */

typedef struct Kind {
    BindingTime latest;
    size_t      many;
    KindCheck  *check;
    const char *wanted;
} Kind;

static const Kind kinds[] = {
    [KIND_ANY] = {0},
#define KIND(name, latest, many, check, wanted) \
    [KIND_##name] = {TIME_##latest, many, check, wanted},
#include "compiler/front/kinds.def"
#undef KIND
};

static bool fits_row(Elaboration *e, const Kind *kind, Value value)
{
    return kind->many ? is_list_of(e, value, kind->check, kind->many - 1) : kind->check(e, value);
}

/* Returns what of a list is not as the rest has to be, or why a shape has no bounds. */
static const char *label_of(Elaboration *e, const Kind *kind, Value value)
{
    KindCheck *check = kind->many                ? kind->check
                       : kind->check == is_path  ? is_point
                       : kind->check == is_radii ? is_radius
                                                 : NULL;
    size_t     index = check && value.type == VALUE_LIST ? first_refused(e, value.list, check)
                                                         : SIZE_MAX;
    Value      found = index == SIZE_MAX ? value : value.list->items[index];
    Text       text  = {.arena = e->diags->arena};
    if (index == SIZE_MAX)
        text_add(&text, "this is ");
    else
        text_format(&text, "element %zu is ", index);
    if (found.type == VALUE_NUMBER)
        text_number(&text, found.number);
    else if (found.type == VALUE_SHAPE && !box_is_finite(found.shape->box))
        text_add(&text, "endless or empty; cut it with `.within`");
    else if (found.type == VALUE_SHAPE)
        text_add(&text, found.shape->figure ? "a plane figure" : "a solid");
    else
        text_add(&text, value_type_name(e, found));
    return text.bytes;
}

/* ---- the parameters of a function ---- */

static const char *called(Elaboration *e, const Syntax *parameter, const Function *function)
{
    return diag_text(e->diags, "`%s` of `%s`", parameter->name, function->name);
}

static Diag *refuse_argument(Elaboration *e, const Function *function, const Syntax *parameter,
                             Value value, const Syntax *origin, const char *wanted)
{
    const char *found = value_type_name(e, value);
    Diag *diag  = diag_add(e->diags, DIAG_TYPE_MISMATCH, origin->span, "%s must be %s, found %s",
                           called(e, parameter, function), wanted, found);
    diag->label = diag_text(e->diags, "this is %s", found);
    return diag;
}

static bool is_early(Elaboration *e, const Function *function, const Syntax *parameter,
                     BindingTime latest, Value value, const Syntax *origin)
{
    if (value_time(e, value) <= latest)
        return true;
    const char *what = called(e, parameter, function);
    if (latest == TIME_FRAME)
        point_error(e, origin, what);
    else
        constant_error(e, origin, diag_text(e->diags, "%s must be known at compile time", what));
    return false;
}

Value value_as_kind(Elaboration *e, ParameterKind kind, Value value, const Syntax *origin)
{
    if (kind == KIND_path && is_polyline(e, value))
        return call_library(e, "polyline", value, origin);
    if (kind != KIND_radii || value.type == VALUE_LIST)
        return value;
    Value *radius = arena_new_array(e->values, Value, 1);
    *radius       = value;
    return value_list(e, radius, 1);
}

static bool fits_kind(Elaboration *e, const Function *function, const Syntax *parameter,
                      Value *value, const Syntax *origin)
{
    const ParameterKind kind = (ParameterKind)parameter->number[0];
    const Kind         *row  = &kinds[kind];
    if (kind == KIND_ANY)
        return true;
    const bool number = row->check == is_count || row->check == is_flag;
    if (number && value->type == VALUE_EXPRESSION &&
        !is_early(e, function, parameter, row->latest, *value, origin))
        return false;
    if (!fits_row(e, row, *value)) {
        Diag *diag  = refuse_argument(e, function, parameter, *value, origin, row->wanted);
        diag->label = label_of(e, row, *value);
        return false;
    }
    if (!is_early(e, function, parameter, row->latest, *value, origin))
        return false;
    *value = value_as_kind(e, kind, *value, origin);
    return value->type != VALUE_ERROR;
}

/* Tells whether a value is of the type of another; of those that no default shows, any is. */
static bool is_alike(Elaboration *e, Value usual, Value value)
{
    const bool shown = usual.type == VALUE_BOOLEAN || usual.type == VALUE_STRING ||
                       usual.type == VALUE_SHAPE;
    if (value_size(e, usual) > 0)
        return value_size(e, usual) == value_size(e, value);
    return !shown || value.type == usual.type;
}

/* Tells whether the default of a parameter shows what it must be.  Functions of a scene may take more than
   that, those of the library say it by a kind, and shapes that a default makes need not be made. */
static bool is_shown_by_default(const Elaboration *e, const Function *function, const Syntax *call,
                                const Syntax *parameter)
{
    if (parameter->count == 0 || parameter->number[0] != KIND_ANY)
        return false;
    const SyntaxKind usual = parameter->children[0]->kind;
    return function->syntax->kind == SYNTAX_SHAPE ||
           (!is_of_author(e, function->syntax) && is_of_author(e, call) && usual != SYNTAX_CALL &&
            usual != SYNTAX_METHOD);
}

bool fits_type(Elaboration *e, const Environment *env, const Function *function, const Syntax *call,
               const Syntax *parameter, Value *value, const Syntax *origin)
{
    const size_t errors = e->diags->errors;
    Diag        *diag   = NULL;
    if (!fits_kind(e, function, parameter, value, origin))
        diag = e->diags->errors > errors && e->diags->count ? e->diags->items[e->diags->count - 1]
                                                            : &e->diags->scrap;
    if (!diag && is_shown_by_default(e, function, call, parameter)) {
        Value usual = evaluate(e, env, parameter->children[0]);
        if (!is_alike(e, usual, *value))
            diag = refuse_argument(e, function, parameter, *value, origin,
                                   value_type_name(e, usual));
    }
    if (!diag)
        return true;
    note_signature(e, diag, function->syntax);
    explain_library(e, diag, call, function->syntax);
    point_at_definition(e, diag, origin);
    return false;
}

/* Finds an end of a range: a number that is known now or, where shaders read numbers, the end of what all
   of their values permit. */
static bool range_end(Elaboration *e, Value value, bool high, double *end)
{
    if (value.type == VALUE_NUMBER) {
        *end = value.number;
        return true;
    }
    if (!e->parameterises || value_size(e, value) != 1 || value_time(e, value) == TIME_POINT)
        return false;
    Range may = node_range(e->builder, value_node(e, value), 0);
    *end      = high ? may.low : may.high;
    return true;
}

/* Tells whether a parameter takes whole numbers, as 0..3 has them. */
static bool takes_whole(const Syntax *parameter)
{
    return parameter->children[1]->kind == SYNTAX_RANGE;
}

/* Finds the range of a parameter, two numbers; false: reported. */
static bool parameter_range(Elaboration *e, const Environment *env, const Syntax *parameter,
                            Range *range)
{
    const Syntax *syntax  = parameter->children[1];
    const bool    whole   = takes_whole(parameter);
    Value         ends[2] = {{.type = VALUE_LIST}, {.type = VALUE_LIST}};
    if (whole || (syntax->kind == SYNTAX_LIST && syntax->count == 2)) {
        for (int i = 0; i < 2; i++)
            ends[i] = evaluate(e, env, syntax->children[i]);
    } else {
        Value value = evaluate(e, env, syntax);
        if (value.type == VALUE_ERROR)
            return false;
        for (size_t i = 0; i < 2 && value.type == VALUE_LIST && value.list->count == 2; i++)
            ends[i] = value.list->items[i];
    }
    if (ends[0].type == VALUE_ERROR || ends[1].type == VALUE_ERROR)
        return false;
    if (range_end(e, ends[0], false, &range->low) && range_end(e, ends[1], true, &range->high)) {
        range->high -= whole;
        return true;
    }
    Diag *diag  = diag_add(e->diags, DIAG_RANGE_OF_PARAM, syntax->span,
                           "the range of `%s` is not two numbers", parameter->name);
    diag->label = "[low, high], known at compile time";
    return false;
}

/* Returns "18", or "from 0deg to 18deg" of what is known in frames only. */
static const char *range_text(Elaboration *e, Range range, bool degrees)
{
    Text text = {.arena = e->diags->arena};
    text_add(&text, range.low < range.high ? "from " : "");
    add_number(&text, range.low, degrees);
    text_add(&text, range.low < range.high ? " to " : "");
    if (range.low < range.high)
        add_number(&text, range.high, degrees);
    return text.bytes;
}

bool fits_range(Elaboration *e, const Environment *env, const Function *function,
                const Syntax *parameter, Value value, const Syntax *origin, bool given)
{
    Range range, found;
    if (parameter->count < 2)
        return true;
    if (!parameter_range(e, env, parameter, &range))
        return false;
    const bool  whole   = takes_whole(parameter);
    const bool  degrees = written_in_degrees(e, parameter), also = written_in_degrees(e, origin);
    const char *wanted = diag_text(e->diags, "%s%s", whole ? "a whole number " : "",
                                   range_text(e, range, degrees));
    if (value_size(e, value) != 1) {
        wanted = diag_text(e->diags, "a%s number %s", whole ? " whole" : "",
                           range_text(e, range, degrees));
        note_signature(e, refuse_argument(e, function, parameter, value, origin, wanted),
                       function->syntax);
        return false;
    }
    if (value_time(e, value) == TIME_POINT) {
        point_error(e, origin,
                    diag_text(e->diags, "`%s` of `%s`, which has a range,", parameter->name,
                              function->name));
        return false;
    }
    if (whole && !is_early(e, function, parameter, TIME_COMPILE, value, origin))
        return false;
    found = value.type == VALUE_NUMBER ? (Range){value.number, value.number}
                                       : node_range(e->builder, value_node(e, value), 0);
    if (range.low <= found.low && found.high <= range.high && !(whole && fmod(found.low, 1) != 0))
        return true;
    Diag *diag  = diag_add(e->diags, DIAG_BAD_VALUE, origin->span, "`%s` of `%s` must be %s",
                           parameter->name, function->name, wanted);
    diag->label = diag_text(e->diags, "%s %s %s%s", given ? "this" : "unless given, it",
                            found.low < found.high ? "can be" : "is", range_text(e, found, also),
                            degrees && !also ? " radians" : "");
    if (degrees && (diag->replacement = degrees_instead(e, origin)))
        diag->help = "degrees have their unit behind the number";
    note_signature(e, diag, function->syntax);
    point_at_definition(e, diag, origin);
    return false;
}
