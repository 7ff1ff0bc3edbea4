/*
 * functions.c: calls of functions, of shape declarations and of materials with parameters.
 */
#include "compiler/eval/elaborate.h"

#include <string.h>

enum { MOST_CALLS = 1000 };

static uint32_t parameter_count(const Syntax *definition)
{
    uint32_t count = 0;
    while (count < definition->count && definition->children[count]->kind == SYNTAX_PARAMETER)
        count++;
    return count;
}

/* The names of the parameters of a definition. */
static const char **parameter_names(Elaboration *e, const Syntax *definition)
{
    uint32_t     count = parameter_count(definition);
    const char **names = arena_new_array(e->diags->arena, const char *, count + 1);
    for (uint32_t i = 0; i < count; i++)
        names[i] = definition->children[i]->name;
    return names;
}

static void note_signature(Elaboration *e, Diag *diag, const Syntax *definition)
{
    const char **names = parameter_names(e, definition);
    diag_note(e->diags, diag, signature(e, definition->name, names, parameter_count(definition)));
}

/* Says how a function of the library is called; how others are, only their author knows. */
static void explain_library(Elaboration *e, Diag *diag, const Syntax *call,
                            const Syntax *definition)
{
    if (e->sources->items[definition->span.source].library)
        explain_usage(e, diag, call, definition->name);
}

/* The parameter that a named argument is for; UINT32_MAX: reported. */
static uint32_t find_parameter(Elaboration *e, const Syntax *call, const Syntax *definition,
                               const Syntax *argument)
{
    uint32_t count = parameter_count(definition);
    for (uint32_t i = 0; i < count; i++)
        if (definition->children[i]->name == argument->name)
            return i;
    unknown_parameter(e, call, argument, definition->name, parameter_names(e, definition), count);
    return UINT32_MAX;
}

/* Arguments that are given, evaluated in the caller's environment, by parameter. */
static bool gather_arguments(Elaboration *e, const Environment *env, const Syntax *call,
                             const Syntax *definition, Value *values, const Syntax **origins)
{
    uint32_t count = parameter_count(definition), next = 0;
    bool     good = true;
    for (uint32_t i = 1; i < call->count; i++) {
        const Syntax *argument = call->children[i];
        if (argument->kind != SYNTAX_ARGUMENT)
            return false;
        uint32_t slot  = argument->name ? find_parameter(e, call, definition, argument) : next++;
        Value    value = evaluate(e, env, argument->children[0]);
        if (slot == UINT32_MAX) {
            good = false;
            continue;
        }
        if (slot >= count) {
            Diag *diag = too_many_arguments(e, argument, definition->name, count);
            note_signature(e, diag, definition);
            explain_library(e, diag, call, definition);
            return false;
        }
        if (origins[slot]) {
            Diag *diag = diag_add(e->diags, DIAG_TOO_MANY_ARGUMENTS, argument->span,
                                  "`%s` is given twice", definition->children[slot]->name);
            diag_secondary(e->diags, diag, origins[slot]->span, "given here first");
            good = false;
            continue;
        }
        values[slot]  = value;
        origins[slot] = argument->children[0];
        good          = good && value.type != VALUE_ERROR;
    }
    return good;
}

/* The default of a shape's parameter shows what it must be: a number or a vector, how long. */
static bool fits_default(Elaboration *e, const Environment *env, const Function *function,
                         const Syntax *call, const Syntax *parameter, Value value,
                         const Syntax *origin)
{
    if (function->syntax->kind != SYNTAX_SHAPE || parameter->count == 0)
        return true;
    Value usual = evaluate(e, env, parameter->children[0]);
    if (value_size(e, usual) == 0 || value_size(e, usual) == value_size(e, value))
        return true;
    const char *found = value_type_name(e, value);
    Diag       *diag  = diag_add(e->diags, DIAG_TYPE_MISMATCH, origin->span,
                                 "`%s` of `%s` must be %s, found %s", parameter->name, function->name,
                                 value_type_name(e, usual), found);
    diag->label       = diag_text(e->diags, "this is %s", found);
    note_signature(e, diag, function->syntax);
    explain_library(e, diag, call, function->syntax);
    point_at_definition(e, diag, origin);
    return false;
}

/* The range of a parameter, two numbers; false: reported. */
/* An end of a range is a number now; where kernels read numbers, the end of what they all allow. */
static bool range_end(Elaboration *e, Value value, bool high, double *end)
{
    if (value.type == VALUE_NUMBER) {
        *end = value.number;
        return true;
    }
    if (!e->hoists || value_size(e, value) != 1 || value_time(e, value) == TIME_POINT)
        return false;
    Range may = node_range(e->builder, value_node(e, value), 0);
    *end      = high ? may.low : may.high;
    return true;
}

static bool parameter_range(Elaboration *e, const Environment *env, const Syntax *parameter,
                            Range *range)
{
    const Syntax *syntax = parameter->children[1];
    Value         value  = evaluate(e, env, syntax);
    if (value.type == VALUE_ERROR)
        return false;
    if (value.type == VALUE_LIST && value.list->count == 2 &&
        range_end(e, value.list->items[0], false, &range->low) &&
        range_end(e, value.list->items[1], true, &range->high))
        return true;
    Diag *diag  = diag_add(e->diags, DIAG_RANGE_OF_PARAM, syntax->span,
                           "the range of `%s` is not two numbers", parameter->name);
    diag->label = "[low, high], known at compile time";
    return false;
}

/* "18", or "from 0deg to 18deg" of what is known in frames only. */
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

/* A parameter with a range takes numbers in it; `origin` is the argument, or the default. */
static bool fits_range(Elaboration *e, const Environment *env, const Function *function,
                       const Syntax *parameter, Value value, const Syntax *origin)
{
    Range range, found;
    if (parameter->count < 2)
        return true;
    if (!parameter_range(e, env, parameter, &range))
        return false;
    if (value_size(e, value) != 1) {
        type_error(e, origin, value, "a number");
        return false;
    }
    if (value_time(e, value) == TIME_POINT) {
        point_error(e, origin,
                    diag_text(e->diags, "`%s` of `%s`, which has a range,", parameter->name,
                              function->name));
        return false;
    }
    found = value.type == VALUE_NUMBER ? (Range){value.number, value.number}
                                       : node_range(e->builder, value_node(e, value), 0);
    if (range.low <= found.low && found.high <= range.high)
        return true;
    bool  degrees = written_in_degrees(e, parameter), also = written_in_degrees(e, origin);
    Diag *diag  = diag_add(e->diags, DIAG_BAD_VALUE, origin->span, "`%s` of `%s` must be %s",
                           parameter->name, function->name, range_text(e, range, degrees));
    diag->label = diag_text(e->diags, "this %s %s%s", found.low < found.high ? "can be" : "is",
                            range_text(e, found, also), degrees && !also ? " radians" : "");
    if (degrees && (diag->replacement = degrees_instead(e, origin)))
        diag->help = "degrees have their unit behind the number";
    note_signature(e, diag, function->syntax);
    point_at_definition(e, diag, origin);
    return false;
}

/* A parameter is an angle by its name, or by a default in degrees. */
static void warn_of_wrong_unit(Elaboration *e, const Syntax *parameter, Value value,
                               const Syntax *origin)
{
    if (strcmp(parameter->name, "angle") == 0 || written_in_degrees(e, parameter))
        warn_of_angle(e, origin, value);
}

/* Binds given values and defaults; a default, and a range, sees the parameters before it. */
static bool bind_parameters(Elaboration *e, const Function *function, const Value *values,
                            const Syntax *const *origins, const Syntax *call, Environment *env)
{
    const Syntax *definition = function->syntax;
    *env                     = *function->closure;
    for (uint32_t i = 0; i < parameter_count(definition); i++) {
        const Syntax *parameter = definition->children[i];
        Value         value;
        if (origins[i]) {
            value = values[i];
            if (!fits_default(e, env, function, call, parameter, value, origins[i]))
                return false;
        } else if (parameter->count)
            value = evaluate(e, env, parameter->children[0]);
        else {
            Diag *diag = missing_argument(e, call, definition->name, parameter->name);
            note_signature(e, diag, definition);
            return false;
        }
        if (value.type == VALUE_ERROR ||
            !fits_range(e, env, function, parameter, value,
                        origins[i] ? origins[i] : parameter->children[0]))
            return false;
        if (origins[i])
            warn_of_wrong_unit(e, parameter, value, origins[i]);
        *env = bind(e, env, parameter->name, value);
    }
    return true;
}

/* A shape's sizes are the same at every point. */
static bool check_shape_arguments(Elaboration *e, const Function *function, const Value *values,
                                  const Syntax *const *origins)
{
    for (uint32_t i = 0; i < parameter_count(function->syntax); i++) {
        if (!origins[i])
            continue;
        BindingTime time = value_time(e, values[i]);
        Node        node = time == TIME_FRAME ? value_node(e, values[i]) : NODE_NONE;
        if (node != NODE_NONE && !check_finite(e, node, origins[i]))
            return false;
        if (time == TIME_POINT) {
            const char *name = function->syntax->children[i]->name;
            point_error(e, origins[i], diag_text(e->diags, "`%s` of `%s`", name, function->name));
            return false;
        }
    }
    return true;
}

static bool add_value(Text *text, const Elaboration *e, Value value)
{
    if (value.type == VALUE_NUMBER) {
        text_number(text, value.number);
        return true;
    }
    if (value.type != VALUE_LIST || value_size(e, value) < 2 || value_time(e, value) > TIME_COMPILE)
        return false;
    for (size_t i = 0; i < value.list->count; i++) {
        text_add(text, i ? ", " : "[");
        add_value(text, e, value.list->items[i]);
    }
    text_add(text, "]");
    return true;
}

/* "called with levels = 18, size = [1, 2, 1]": numbers and vectors that are known. */
static void note_arguments(Elaboration *e, Diag *diag, const Function *function,
                           const Value *values, const Syntax *const *origins)
{
    Text text = {.arena = e->diags->arena};
    for (uint32_t i = 0; i < parameter_count(function->syntax); i++) {
        Text value = {.arena = e->diags->arena};
        if (!origins[i] || !add_value(&value, e, values[i]))
            continue;
        text_format(&text, "%s%s = %s", text.length ? ", " : "called with ",
                    function->syntax->children[i]->name, value.bytes);
    }
    if (text.length)
        diag_note(e->diags, diag, text.bytes);
}

/*
 * A mistake that comes to light inside the library is the caller's: its diagnostics are moved
 * to the call, and the place in the library becomes the second one.
 */
static void blame_caller(Elaboration *e, size_t first, const Syntax *syntax,
                         const Function *function, const Value *values,
                         const Syntax *const *origins)
{
    const Source *sources = e->sources->items;
    if (sources[syntax->span.source].library)
        return;
    size_t retained = first;
    for (size_t i = first; i < e->diags->count; i++) {
        Diag *diag  = e->diags->items[i];
        bool  error = diag_info[diag->code].severity == DIAG_ERROR;
        bool  ours  = sources[diag->span.source].library && diag->span.source;
        if (ours && error && retained > first) { /* one mistake at the call, one report */
            e->diags->errors--;
            continue;
        }
        e->diags->items[retained++] = diag;
        if (!ours)
            continue;
        diag_secondary(e->diags, diag, diag->span, diag->label ? diag->label : "found here");
        diag->span        = syntax->span;
        diag->label       = diag_text(e->diags, "in this call of `%s`", function->name);
        diag->replacement = NULL;
        note_arguments(e, diag, function, values, origins);
    }
    e->diags->count = retained;
}

/* What a function asserts is about how it is called. */
static void mark_call(Elaboration *e, size_t first, const Syntax *syntax, const char *name)
{
    for (size_t i = first; i < e->diags->count; i++) {
        Diag *diag = e->diags->items[i];
        if (diag->code == DIAG_ASSERTION && diag->secondary.count == 0)
            diag_secondary(e->diags, diag, syntax->span,
                           diag_text(e->diags, "in this call of `%s`", name));
    }
}

/* The value of a body whose parameters `env` binds. */
static Value call_body(Elaboration *e, const Function *function, const Environment *env, Span span)
{
    const Syntax *syntax = function->syntax;
    switch (syntax->kind) {
    case SYNTAX_SHAPE: return declare_instance(e, function, env, span);
    case SYNTAX_MATERIAL: return elaborate_material(e, env, syntax);
    default: return evaluate(e, env, syntax->children[syntax->count - 1]);
    }
}

/* A call that is evaluated now. */
typedef struct CalledFunction {
    const Function              *function;
    const Syntax                *syntax; /* of the call */
    const struct CalledFunction *outer;
} CalledFunction;

/* The innermost call of a function that is called within itself: others may be met in the last of its
   turns alone. */
static const CalledFunction *call_within_itself(const CalledFunction *innermost)
{
    for (const CalledFunction *call = innermost; call; call = call->outer)
        for (const CalledFunction *outer = call->outer; outer; outer = outer->outer)
            if (outer->function->syntax == call->function->syntax)
                return call;
    return innermost;
}

static void report_depth(Elaboration *e, const CalledFunction *innermost)
{
    const CalledFunction *call = call_within_itself(innermost);
    Diag                 *diag = diag_add(e->diags, DIAG_LIMIT, call->syntax->span,
                                          "`%s` is called within itself more than 1,000 deep",
                                          call->function->name);
    diag->help =
        "a function that calls itself ends by an `if`, as in `def tower(n) = if n == 0 then "
        "sphere(1) else box([1, 1, 1]) | tower(n - 1).move([0, 1, 0]);`";
}

/* What a function, shape declaration or material gives for arguments in order. */
static Value call_values(Elaboration *e, const Function *function, const Value *values,
                         const Syntax *const *origins, const Syntax *syntax)
{
    const CalledFunction call = {function, syntax, e->called};
    if (e->calls >= MOST_CALLS) {
        if (!is_stopped(e))
            report_depth(e, &call);
        e->builder->stopped = true;
        return value_error();
    }
    Environment env;
    size_t      said   = e->diags->count;
    Value       result = value_error();
    e->calls++;
    e->called = &call;
    if (bind_parameters(e, function, values, origins, syntax, &env))
        result = call_body(e, function, &env, syntax->span);
    e->called = call.outer;
    e->calls--;
    mark_call(e, said, syntax, function->name);
    blame_caller(e, said, syntax, function, values, origins);
    return result;
}

static bool joins(const Builtin *builtin)
{
    return builtin->function == builtin_union || builtin->function == builtin_intersection ||
           builtin->function == builtin_difference;
}

static Value call_builtin(Elaboration *e, const Environment *env, const Syntax *syntax,
                          const Builtin *builtin)
{
    Call          call;
    const Syntax *outer = e->joining;
    e->joining          = joins(builtin) ? syntax : NULL;
    const bool bound = bind_arguments(e, env, syntax, 1, builtin->name, builtin->parameters, &call);
    e->joining       = outer;
    if (!bound)
        return value_error();
    if (builtin->function)
        return builtin->function(e, &call);
    Value     values[MAX_OPERANDS];
    GraphType types[MAX_OPERANDS];
    uint32_t  arity = 0;
    bool      angle = builtin->op == OP_sin || builtin->op == OP_cos || builtin->op == OP_tan;
    for (; call.arguments[arity].syntax; arity++) {
        values[arity] = call.arguments[arity].value;
        if (angle)
            warn_of_turns(e, call.arguments[arity].syntax, values[arity]);
        Node node    = value_node(e, values[arity]);
        types[arity] = node == NODE_NONE ? TYPE_UINT : e->graph->items[node].type;
        if (types[arity] > TYPE_VEC4) {
            type_error(e, call.arguments[arity].syntax, values[arity], "a number or a vector");
            return value_error();
        }
    }
    if (!graph_op_type(builtin->op, types, arity)) {
        diag_add(e->diags, DIAG_LENGTH_MISMATCH, syntax->span, "`%s` needs vectors of one length",
                 builtin->name);
        return value_error();
    }
    return value_map_op(e, builtin->op, values, arity, syntax);
}

Value call_function(Elaboration *e, const Environment *env, const Syntax *syntax,
                    const Function *function)
{
    if (function->builtin)
        return call_builtin(e, env, syntax, function->builtin);
    enum { FEW = 8 };
    Value          few_values[FEW];
    const Syntax  *few_origins[FEW] = {0};
    uint32_t       count            = parameter_count(function->syntax);
    bool           few              = count <= FEW; /* need no memory that stays */
    Value         *values           = few ? few_values : arena_new_array(e->values, Value, count);
    const Syntax **origins = few ? few_origins : arena_new_array(e->values, const Syntax *, count);
    if (!gather_arguments(e, env, syntax, function->syntax, values, origins))
        return value_error();
    if (function->syntax->kind == SYNTAX_SHAPE &&
        !check_shape_arguments(e, function, values, origins))
        return value_error();
    return call_values(e, function, values, origins, syntax);
}

Value call_with(Elaboration *e, const Function *function, Value first, const Syntax *call)
{
    uint32_t       count   = parameter_count(function->syntax);
    Value         *values  = arena_new_array(e->arena, Value, count);
    const Syntax **origins = arena_new_array(e->arena, const Syntax *, count);
    values[0]              = first;
    origins[0]             = call;
    return call_values(e, function, values, origins, call);
}

Value call_library(Elaboration *e, const char *name, Value first, const Syntax *call)
{
    Definition *found = NULL;
    for (size_t i = 0; !found && i < e->library->used.count; i++) {
        const Scope *scope = e->library->used.items[i];
        for (size_t k = 0; !found && k < scope->definitions.count; k++)
            if (strcmp(scope->definitions.items[k]->name, name) == 0)
                found = scope->definitions.items[k];
    }
    Value function = found ? run_definition(e, found, call->span) : value_error();
    return function.type == VALUE_FUNCTION ? call_with(e, function.function, first, call)
                                           : value_error();
}
