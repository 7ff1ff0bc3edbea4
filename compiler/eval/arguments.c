/*
 * arguments.c: from the arguments of a call to what a function needs.
 */
#include "compiler/eval/elaborate.h"

#include <math.h>
#include <string.h>

/* ---- checks ---- */

/*
 * Refuses values that may be infinite.  Ranges are those of the parameters, but a parameter without
 * one counts with its default, and time with a long animation: what is infinite then divides by
 * zero somewhere, or overflows.
 */
bool check_finite(Elaboration *e, Node node, const Syntax *syntax)
{
    enum { LONGEST_SECONDS = 1000000 };
    Graph *g = e->graph;
    if (g->items[node].type > TYPE_VEC4 || graph_known_finite(g, node))
        return true;
    size_t          count = g->parameters.count;
    GraphParameter *copy  = arena_new_array(e->values, GraphParameter, count);
    memcpy(copy, g->parameters.items, count * sizeof *copy);
    for (size_t i = 0; i < e->scene->parameters.count; i++) {
        const Parameter *parameter = &e->scene->parameters.items[i];
        GraphParameter  *range     = &g->parameters.items[parameter->slot];
        for (uint32_t k = 0; k < 4; k++)
            if (!isfinite(parameter->low[k]) || !isfinite(parameter->high[k]))
                range->low[k] = range->high[k] = parameter->value[k];
    }
    g->parameters.items[0].low[0]  = -LONGEST_SECONDS;
    g->parameters.items[0].high[0] = LONGEST_SECONDS;
    bool finite                    = true;
    for (uint32_t k = 0; k < g->items[node].type; k++) {
        Range range = node_range(e->builder, node, k);
        finite      = finite && isfinite(range.low) && isfinite(range.high);
    }
    memcpy(g->parameters.items, copy, count * sizeof *copy);
    if (finite)
        return true;
    Diag *diag  = diag_add(e->diags, DIAG_NOT_A_NUMBER, syntax->span,
                           "this is not finite for every permitted parameter");
    diag->label = "a division by zero, or an overflow, is possible";
    diag->help  = "give the `param` a range that excludes it, or guard it, "
                  "as in `1 / max(a, 0.001)`";
    point_at_definition(e, diag, syntax);
    return false;
}

/* Refuses nodes that depend on x, y, z or p: shapes are the same at every point. */
static Node frame_time(Elaboration *e, Node node, const Syntax *syntax, const char *what)
{
    if (node == NODE_NONE || e->graph->items[node].time == TIME_COMPILE)
        return node;
    if (e->graph->items[node].time == TIME_FRAME)
        return check_finite(e, node, syntax) ? node : NODE_NONE;
    point_error(e, syntax, what);
    return NODE_NONE;
}

Node to_number(Elaboration *e, Value value, const Syntax *syntax, const char *what)
{
    if (value.type == VALUE_NUMBER)
        return value_node(e, value);
    if (value.type == VALUE_EXPRESSION && e->graph->items[value.node].type == TYPE_FLOAT)
        return frame_time(e, value.node, syntax, what);
    type_error(e, syntax, value, "a number");
    return NODE_NONE;
}

static Node to_components(Elaboration *e, Value value, GraphType type, const Syntax *syntax,
                          const char *what)
{
    Node node = value.type == VALUE_LIST || value.type == VALUE_EXPRESSION ? value_node(e, value)
                                                                           : NODE_NONE;
    if (node != NODE_NONE && e->graph->items[node].type == type)
        return frame_time(e, node, syntax, what);
    type_error(e, syntax, value, type == TYPE_VEC2 ? "two numbers" : "a vector of 3");
    return NODE_NONE;
}

Node to_vector(Elaboration *e, Value value, const Syntax *syntax, const char *what)
{
    return to_components(e, value, TYPE_VEC3, syntax, what);
}

Node to_pair(Elaboration *e, Value value, const Syntax *syntax, const char *what)
{
    return to_components(e, value, TYPE_VEC2, syntax, what);
}

bool check_direction(Elaboration *e, Node vector, const Syntax *syntax, const char *what)
{
    return require_direction(e->builder, vector, syntax->span, what);
}

bool check_positive(Elaboration *e, Node number, const Syntax *syntax, const char *what)
{
    return require_positive(e->builder, number, syntax->span, what);
}

bool check_not_negative(Elaboration *e, Node node, const Syntax *syntax, const char *what)
{
    for (uint32_t i = 0; i < e->graph->items[node].type; i++) {
        Range range = node_range(e->builder, node, i);
        if (range.low >= 0)
            continue;
        bool  known = range.low == range.high;
        Diag *diag  = diag_add(e->diags, DIAG_BAD_VALUE, syntax->span, "%s cannot be negative",
                               what);
        diag->label = known ? "negative" : diag_text(e->diags, "this can be %g", range.low);
        if (!known)
            diag->help = "give the `param` a range that is not negative, or use `max(..., 0)`";
        return false;
    }
    return true;
}

/* ---- what an argument must be ---- */

bool is_given(const Call *call, uint32_t index) { return call->arguments[index].syntax != NULL; }

Node want_number(Elaboration *e, const Call *call, uint32_t index, double otherwise)
{
    const Argument *argument = &call->arguments[index];
    if (!argument->syntax)
        return graph_number(e->graph, otherwise);
    return to_number(e, argument->value, argument->syntax, "this argument");
}

Node want_vector(Elaboration *e, const Call *call, uint32_t index, const double otherwise[3])
{
    const Argument *argument = &call->arguments[index];
    if (!argument->syntax)
        return graph_constant(e->graph, TYPE_VEC3, otherwise);
    return to_vector(e, argument->value, argument->syntax, "this argument");
}

bool want_count(Elaboration *e, const Call *call, uint32_t index, uint32_t least, uint32_t most,
                uint32_t otherwise, uint32_t *count)
{
    const Argument *argument = &call->arguments[index];
    *count                   = otherwise;
    if (!argument->syntax)
        return true;
    Value value = argument->value;
    if (value.type == VALUE_EXPRESSION) {
        constant_error(e, argument->syntax, "a count must be known at compile time");
        return false;
    }
    if (value.type != VALUE_NUMBER) {
        type_error(e, argument->syntax, value, "a whole number");
        return false;
    }
    if (value.number != floor(value.number) || value.number < least || value.number > most) {
        Diag *diag  = diag_add(e->diags, DIAG_BAD_VALUE, argument->syntax->span,
                               "%g cannot be a count here", value.number);
        diag->label = diag_text(e->diags, "whole numbers from %u to %u are possible", least, most);
        return false;
    }
    *count = (uint32_t)value.number;
    return true;
}

Node want_numeric(Elaboration *e, const Call *call, uint32_t index)
{
    const Argument *argument = &call->arguments[index];
    Node            node     = value_node(e, argument->value);
    if (node != NODE_NONE && e->graph->items[node].type <= TYPE_VEC4)
        return node;
    type_error(e, argument->syntax, argument->value, "a vector");
    return NODE_NONE;
}

const List *want_list(Elaboration *e, const Call *call, uint32_t index)
{
    const Argument *argument = &call->arguments[index];
    if (argument->value.type == VALUE_LIST)
        return argument->value.list;
    type_error(e, argument->syntax, argument->value, "a list");
    return NULL;
}

bool want_constant(Elaboration *e, const Call *call, uint32_t index, double *number)
{
    const Argument *argument = &call->arguments[index];
    if (!argument->syntax)
        return true;
    if (argument->value.type == VALUE_NUMBER) {
        *number = argument->value.number;
        return true;
    }
    if (argument->value.type == VALUE_EXPRESSION)
        constant_error(
            e, argument->syntax,
            diag_text(e->diags, "`%s` needs a number that is known at compile time", call->name));
    else
        type_error(e, argument->syntax, argument->value, "a number");
    return false;
}

bool want_flag(Elaboration *e, const Call *call, uint32_t index, bool *flag)
{
    const Argument *argument = &call->arguments[index];
    if (!argument->syntax)
        return true;
    if (argument->value.type == VALUE_BOOLEAN) {
        *flag = argument->value.boolean;
        return true;
    }
    if (argument->value.type == VALUE_EXPRESSION)
        constant_error(e, argument->syntax,
                       "this must be true or false when the scene is compiled");
    else
        type_error(e, argument->syntax, argument->value, "true or false");
    return false;
}

const Shape *want_shape(Elaboration *e, const Call *call, uint32_t index)
{
    const Argument *argument = &call->arguments[index];
    if (argument->syntax && argument->value.type == VALUE_SHAPE)
        return argument->value.shape;
    if (argument->syntax)
        type_error(e, argument->syntax, argument->value, "a shape");
    return NULL;
}

bool want_plane(Elaboration *e, const Call *call, Node *normal, Node *offset)
{
    const Shape *plane = want_shape(e, call, 0);
    if (!plane || shape_plane(e->builder, plane, normal, offset))
        return plane != NULL;
    Diag *diag  = diag_add(e->diags, DIAG_NEEDS_PLANE, call->arguments[0].syntax->span,
                           "`%s` needs a plane, found a shape", call->name);
    diag->label = "this is not a plane";
    diag->help  = "write `plane(normal, offset)`";
    return false;
}

const Map *want_translation(Elaboration *e, const Call *call)
{
    Node by = want_vector(e, call, 0, ORIGIN);
    return by == NODE_NONE ? NULL : map_translation(e->builder, by);
}

const Map *want_rotation(Elaboration *e, const Call *call)
{
    Node axis = want_vector(e, call, 0, ORIGIN), angle = want_number(e, call, 1, 0);
    if (is_given(call, 1))
        warn_of_angle(e, call->arguments[1].syntax, call->arguments[1].value);
    if (axis == NODE_NONE || angle == NODE_NONE ||
        !check_direction(e, axis, call->arguments[0].syntax, "the axis of a rotation"))
        return NULL;
    return map_rotation(e->builder, axis, angle);
}

const Map *want_scaling(Elaboration *e, const Call *call)
{
    Node by = want_number(e, call, 0, 1);
    if (by == NODE_NONE || !check_positive(e, by, call->arguments[0].syntax, "a scale"))
        return NULL;
    return map_scaling(e->builder, by);
}

/* ---- sorting arguments ---- */

/* One word of "a b= rest...". */
typedef struct ParameterWord {
    const char *text;
    size_t      length;
    bool        optional, variadic;
} ParameterWord;

static uint32_t split_parameters(const char *parameters, ParameterWord *words)
{
    uint32_t count = 0;
    while (*parameters) {
        size_t        length = strcspn(parameters, " ");
        ParameterWord word   = {parameters, length, false, false};
        if (length > 3 && strncmp(parameters + length - 3, "...", 3) == 0) {
            word.variadic = true;
            word.length -= 3;
        } else if (parameters[length - 1] == '=') {
            word.optional = true;
            word.length--;
        }
        words[count++] = word;
        parameters += length;
        parameters += *parameters == ' ';
    }
    return count;
}

/* Returns the parameter that a named argument is for; UINT32_MAX: reported. */
static uint32_t find_word(Elaboration *e, const Syntax *call, const Syntax *argument,
                          const char *name, const ParameterWord *words, uint32_t count)
{
    const char *names[MAX_PARAMETERS];
    for (uint32_t i = 0; i < count; i++)
        if (strlen(argument->name) == words[i].length &&
            strncmp(argument->name, words[i].text, words[i].length) == 0)
            return i;
    for (uint32_t i = 0; i < count; i++)
        names[i] = arena_copy_text(e->diags->arena, words[i].text, words[i].length);
    unknown_parameter(e, call, argument, name, names, count);
    return UINT32_MAX;
}

/* Puts an argument in its place; false: that was taken. */
static bool store(Elaboration *e, Argument *slot, const Syntax *argument, Value value,
                  const char *name)
{
    if (slot->syntax) {
        Diag *diag = diag_add(e->diags, DIAG_TOO_MANY_ARGUMENTS, argument->span,
                              "an argument of `%s` is given twice", name);
        diag_secondary(e->diags, diag, slot->syntax->span, "given here first");
        return false;
    }
    *slot = (Argument){value, argument->children[0]};
    return true;
}

static bool has_rest(const ParameterWord *words, uint32_t count)
{
    bool rest = false;
    for (uint32_t i = 0; i < count; i++)
        rest = rest || words[i].variadic;
    return rest;
}

bool bind_arguments(Elaboration *e, const Environment *env, const Syntax *call_syntax,
                    uint32_t first, const char *name, const char *parameters, Call *call)
{
    ParameterWord words[MAX_PARAMETERS];
    uint32_t      count = split_parameters(parameters, words), next = 0;
    bool          good = true;
    *call              = (Call){.syntax = call_syntax, .name = name};
    if (has_rest(words, count))
        call->rest = arena_new_array(e->values, Argument, call_syntax->count);
    for (uint32_t i = first; i < call_syntax->count; i++) {
        const Syntax *argument = call_syntax->children[i];
        if (argument->kind != SYNTAX_ARGUMENT)
            return false; /* reported by the parser */
        Value    value = evaluate(e, env, argument->children[0]);
        uint32_t slot  = next;
        if (argument->name) {
            slot = find_word(e, call_syntax, argument, name, words, count);
            if (slot == UINT32_MAX) {
                good = false;
                continue;
            }
        } else if (next < count && words[next].variadic) {
            call->rest[call->rest_count++] = (Argument){value, argument->children[0]};
            good                           = good && value.type != VALUE_ERROR;
            continue;
        } else if (next++ >= count) {
            explain_usage(e, too_many_arguments(e, argument, name, count), call_syntax, name);
            return false;
        }
        good = store(e, &call->arguments[slot], argument, value, name) &&
               value.type != VALUE_ERROR && good;
    }
    for (uint32_t i = 0; good && i < count; i++)
        if (!call->arguments[i].syntax && !words[i].optional && !words[i].variadic) {
            const char *missing = diag_text(e->diags, "%.*s", (int)words[i].length, words[i].text);
            explain_usage(e, missing_argument(e, call_syntax, name, missing), call_syntax, name);
            good = false;
        }
    return good;
}
