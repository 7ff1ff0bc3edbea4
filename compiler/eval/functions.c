/*
 * functions.c: calls of functions, of shape declarations and of materials with parameters.
 */
#include "compiler/base/nesting.h"
#include "compiler/eval/elaborate.h"
#include "compiler/eval/kinds.h"

#include <string.h>

uint32_t parameter_count(const Syntax *definition)
{
    uint32_t count = 0;
    while (count < definition->count && definition->children[count]->kind == SYNTAX_PARAMETER)
        count++;
    return count;
}

/* Returns the names of the parameters of a definition. */
static const char **parameter_names(Elaboration *e, const Syntax *definition)
{
    uint32_t     count = parameter_count(definition);
    const char **names = arena_new_array(e->diags->arena, const char *, count + 1);
    for (uint32_t i = 0; i < count; i++)
        names[i] = definition->children[i]->name;
    return names;
}

void note_signature(Elaboration *e, Diag *diag, const Syntax *definition)
{
    const char **names = parameter_names(e, definition);
    diag_note(e->diags, diag, signature(e, definition->name, names, parameter_count(definition)));
}

void explain_library(Elaboration *e, Diag *diag, const Syntax *call, const Syntax *definition)
{
    if (!is_of_author(e, definition))
        explain_usage(e, diag, call, definition->name);
}

/* Returns the parameter that a named argument is for; UINT32_MAX: reported. */
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
            if (!fits_type(e, env, function, call, parameter, &value, origins[i]))
                return false;
        } else if (parameter->count)
            value = value_as_kind(e, (ParameterKind)parameter->number[0],
                                  evaluate(e, env, parameter->children[0]), parameter);
        else {
            Diag *diag = missing_argument(e, call, definition->name, parameter->name);
            note_signature(e, diag, definition);
            return false;
        }
        if (value.type == VALUE_ERROR ||
            !fits_range(e, env, function, parameter, value,
                        origins[i]                          ? origins[i]
                        : is_of_author(e, function->syntax) ? parameter->children[0]
                                                            : call,
                        origins[i] != NULL))
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

/* Marks the call in what a function asserts, which is about how it is called. */
static void mark_call(Elaboration *e, size_t first, const Syntax *syntax, const Function *function)
{
    for (size_t i = first; i < e->diags->count; i++) {
        Diag *diag = e->diags->items[i];
        if (diag->code == DIAG_ASSERTION && diag->secondary.count == 0 &&
            is_of_author(e, function->syntax))
            diag_secondary(e->diags, diag, syntax->span,
                           diag_text(e->diags, "in this call of `%s`", function->name));
    }
}

/* Returns the value of a body whose parameters `env` binds. */
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

/* Returns the innermost call of a function that is called within itself: others may be met in the
   last of its iterations alone. */
static const CalledFunction *call_within_itself(const CalledFunction *innermost)
{
    for (const CalledFunction *call = innermost; call; call = call->outer)
        for (const CalledFunction *outer = call->outer; outer; outer = outer->outer)
            if (outer->function->syntax == call->function->syntax)
                return call;
    return innermost;
}

/* Returns the innermost call that is written in the scene. */
static const CalledFunction *call_of_author(const Elaboration *e)
{
    const CalledFunction *call = e->called;
    while (call && !is_of_author(e, call->syntax))
        call = call->outer;
    return call;
}

bool made_for_author(const Elaboration *e, const char **name, Span *span)
{
    const CalledFunction *call = call_of_author(e);
    if (!call || call == e->called)
        return false;
    *name = call->function->name;
    *span = call->syntax->span;
    return true;
}

static void report_depth(Elaboration *e, const CalledFunction *innermost)
{
    const CalledFunction *call = call_within_itself(innermost);
    if (!is_of_author(e, call->syntax) && call_of_author(e)) {
        call = call_of_author(e);
        diag_add(e->diags, DIAG_LIMIT, call->syntax->span,
                 "`%s` needs more steps for these arguments than are possible",
                 call->function->name);
        return;
    }
    Diag *diag = diag_add(e->diags, DIAG_LIMIT, call->syntax->span,
                          "`%s` is called within itself more than %u deep", call->function->name,
                          nesting.calls);
    diag->help =
        "a function that calls itself ends by an `if`, as in `def tower(n) = if n == 0 then "
        "sphere(1) else box([1, 1, 1]) | tower(n - 1).move([0, 1, 0]);`";
}

/* Returns the value of a function, shape declaration or material for arguments in order. */
static Value call_values(Elaboration *e, const Function *function, const Value *values,
                         const Syntax *const *origins, const Syntax *syntax)
{
    const CalledFunction call = {function, syntax, e->called};
    if (e->calls >= nesting.calls) {
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
    mark_call(e, said, syntax, function);
    blame_caller(e, said, syntax, function, values, origins);
    return result;
}

static Value call_builtin(Elaboration *e, const Environment *env, const Syntax *syntax,
                          const Builtin *builtin)
{
    Call          call;
    const Syntax *outer = e->joining;
    e->joining          = joins_shapes(builtin) ? syntax : NULL;
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
            warn_of_revolutions(e, call.arguments[arity].syntax, values[arity]);
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
    name                 = name_intern(e->files->names, name, strlen(name));
    Definition *found    = scope_find(e->library, name);
    Value       function = found ? run_definition(e, found, call->span) : value_error();
    return function.type == VALUE_FUNCTION ? call_with(e, function.function, first, call)
                                           : value_error();
}
