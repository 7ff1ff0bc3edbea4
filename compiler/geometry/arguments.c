/*
 * arguments.c: from the arguments of a call to what a function needs.
 */
#include "compiler/geometry/elaborate.h"

#include <math.h>
#include <string.h>

void point_at_definition(Elaboration *e, Diag *diag, const Syntax *syntax, const char *label)
{
    if (!syntax || syntax->kind != SYNTAX_NAME)
        return;
    for (size_t i = 0; i < e->scopes.count; i++) {
        const Scope *scope = e->scopes.items[i];
        if (!scope->file || scope->file->span.source != syntax->span.source)
            continue;
        const Definition *definition = scope_find(scope, syntax->name);
        if (definition && definition->syntax)
            diag_place(e->diags, diag, definition->syntax->name_span,
                       label ? label : diag_text(e->diags, "`%s` is defined here", syntax->name));
        return;
    }
}

Diag *type_error(Elaboration *e, const Syntax *syntax, Value found, const char *wanted)
{
    const char *name = value_type_name(e, found);
    Diag *diag = diag_add(e->diags, DIAG_TYPE_MISMATCH, syntax->span, "expected %s, found %s", wanted, name);
    diag->label = diag_text(e->diags, "this is %s", name);
    point_at_definition(e, diag, syntax, NULL);
    return diag;
}

/*
 * Ranges are those of the parameters, but a parameter without one counts with its default, and
 * time with a long animation: what is infinite then divides by zero somewhere, or overflows.
 */
bool check_finite(Elaboration *e, Node node, const Syntax *syntax)
{
    enum { LONGEST_SECONDS = 1000000 };
    Graph *g = e->graph;
    if (g->items[node].op == OP_CONSTANT || g->items[node].type > TYPE_VEC4)
        return true;
    size_t          count = g->parameters.count;
    GraphParameter *kept  = arena_new_array(e->arena, GraphParameter, count);
    memcpy(kept, g->parameters.items, count * sizeof *kept);
    for (size_t i = 0; i < e->scene->parameters.count; i++) {
        const Parameter *parameter = &e->scene->parameters.items[i];
        for (uint32_t k = 0; k < 4; k++)
            if (!isfinite(parameter->low[k]) || !isfinite(parameter->high[k]))
                g->parameters.items[parameter->slot].low[k] = g->parameters.items[parameter->slot].high[k] =
                    parameter->value[k];
    }
    g->parameters.items[0].low[0]  = -LONGEST_SECONDS;
    g->parameters.items[0].high[0] = LONGEST_SECONDS;
    bool finite = true;
    for (uint32_t k = 0; k < g->items[node].type; k++) {
        Range range = node_range(e, node, k);
        finite      = finite && isfinite(range.low) && isfinite(range.high);
    }
    memcpy(g->parameters.items, kept, count * sizeof *kept);
    if (finite)
        return true;
    Diag *diag  = diag_add(e->diags, DIAG_NOT_A_NUMBER, syntax->span, "this is not finite for every permitted parameter");
    diag->label = "a division by zero, or an overflow, is possible";
    diag->help  = "give the `param` a range that excludes it, or guard it, as in `1 / max(a, 0.001)`";
    point_at_definition(e, diag, syntax, NULL);
    return false;
}

/* Shapes are the same at every point: what may not depend on x, y, z or p. */
static Node frame_time(Elaboration *e, Node node, const Syntax *syntax, const char *what)
{
    if (node == NODE_NONE || e->graph->items[node].time == TIME_COMPILE)
        return node;
    if (e->graph->items[node].time == TIME_FRAME)
        return check_finite(e, node, syntax) ? node : NODE_NONE;
    Diag *diag  = diag_add(e->diags, DIAG_NOT_FRAME_TIME, syntax->span, "%s may not depend on the point", what);
    diag->label = "this depends on x, y, z or p";
    point_at_definition(e, diag, syntax, NULL);
    return NODE_NONE;
}

Node to_number(Elaboration *e, Value value, const Syntax *syntax, const char *what)
{
    if (value.type == VALUE_NUMBER)
        return graph_number(e->graph, value.number);
    if (value.type == VALUE_EXPRESSION && e->graph->items[value.node].type == TYPE_FLOAT)
        return frame_time(e, value.node, syntax, what);
    if (value.type != VALUE_ERROR)
        type_error(e, syntax, value, "a number");
    return NODE_NONE;
}

Node to_vector(Elaboration *e, Value value, const Syntax *syntax, const char *what)
{
    Node node = value.type == VALUE_LIST || value.type == VALUE_EXPRESSION ? value_node(e, value) : NODE_NONE;
    if (node != NODE_NONE && e->graph->items[node].type == TYPE_VEC3)
        return frame_time(e, node, syntax, what);
    if (value.type != VALUE_ERROR)
        type_error(e, syntax, value, "a vector of 3");
    return NODE_NONE;
}

bool check_direction(Elaboration *e, Node vector, const Syntax *syntax, const char *what)
{
    for (uint32_t i = 0; i < 3; i++) {
        Range range = node_range(e, vector, i);
        if (range.low != 0 || range.high != 0)
            return true;
    }
    diag_add(e->diags, DIAG_BAD_VALUE, syntax->span, "%s cannot be the zero vector", what)->label = "no direction";
    return false;
}

bool check_positive(Elaboration *e, Node number, const Syntax *syntax, const char *what)
{
    Range range = node_range(e, number, 0);
    if (range.low > 0)
        return true;
    Diag *diag  = diag_add(e->diags, DIAG_BAD_VALUE, syntax->span, "%s must be greater than 0", what);
    diag->label = range.low == range.high ? diag_text(e->diags, "this is %g", range.low)
                                          : diag_text(e->diags, "this can be %g", range.low);
    if (range.low != range.high)
        diag->help = "give the `param` a range that keeps it positive, or use `max(..., 0.001)`";
    return false;
}

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
        Diag *diag  = diag_add(e->diags, DIAG_NOT_COMPILE_TIME, argument->syntax->span,
                               "a count must be known at compile time");
        diag->label = "this depends on a `param`, on `time` or on a coordinate";
        point_at_definition(e, diag, argument->syntax, NULL);
        return false;
    }
    if (value.type != VALUE_NUMBER) {
        if (value.type != VALUE_ERROR)
            type_error(e, argument->syntax, value, "a whole number");
        return false;
    }
    if (value.number != floor(value.number) || value.number < least || value.number > most) {
        Diag *diag  = diag_add(e->diags, DIAG_BAD_VALUE, argument->syntax->span, "%g cannot be a count here", value.number);
        diag->label = diag_text(e->diags, "whole numbers from %u to %u are possible", least, most);
        return false;
    }
    *count = (uint32_t)value.number;
    return true;
}

const Shape *want_shape(Elaboration *e, const Call *call, uint32_t index)
{
    const Argument *argument = &call->arguments[index];
    if (argument->syntax && argument->value.type == VALUE_SHAPE)
        return argument->value.shape;
    if (argument->syntax && argument->value.type != VALUE_ERROR)
        type_error(e, argument->syntax, argument->value, "a shape");
    return NULL;
}

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
        size_t length = strcspn(parameters, " ");
        ParameterWord word = {parameters, length, false, false};
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

static Value no_such_parameter(Elaboration *e, const Syntax *argument, const char *name, const ParameterWord *words,
                               uint32_t count)
{
    const char *names[MAX_PARAMETERS];
    Text        list = {.arena = e->diags->arena};
    text_add(&list, "");
    for (uint32_t i = 0; i < count; i++) {
        names[i] = arena_copy_text(e->diags->arena, words[i].text, words[i].length);
        text_format(&list, "%s%s", i ? ", " : "", names[i]);
    }
    Diag *diag = diag_add(e->diags, DIAG_UNKNOWN_PARAMETER, argument->name_span, "`%s` has no parameter `%s`", name,
                          argument->name);
    diag->label       = "unknown parameter";
    diag->replacement = nearest_name(argument->name, names, count);
    if (diag->replacement)
        diag->help = "a parameter with a similar name exists";
    diag_note(e->diags, diag, diag_text(e->diags, "%s(%s)", name, list.bytes));
    return value_error();
}

static void too_many(Elaboration *e, const Syntax *argument, const char *name, uint32_t count)
{
    Diag *diag  = diag_add(e->diags, DIAG_TOO_MANY_ARGUMENTS, argument->span, "`%s` takes %u argument%s", name, count,
                           count == 1 ? "" : "s");
    diag->label = "one too many";
}

static bool store(Elaboration *e, Argument *slot, const Syntax *argument, Value value, const char *name)
{
    if (slot->syntax) {
        Diag *diag = diag_add(e->diags, DIAG_TOO_MANY_ARGUMENTS, argument->span, "an argument of `%s` is given twice", name);
        diag_place(e->diags, diag, slot->syntax->span, "given here first");
        return false;
    }
    *slot = (Argument){value, argument->children[0]};
    return true;
}

bool bind_arguments(Elaboration *e, const Environment *env, const Syntax *call_syntax, uint32_t first,
                    const char *name, const char *parameters, Call *call)
{
    ParameterWord words[MAX_PARAMETERS];
    uint32_t      count = split_parameters(parameters, words), next = 0;
    bool          good  = true;
    *call               = (Call){.syntax = call_syntax, .name = name};
    call->rest          = arena_new_array(e->arena, Argument, call_syntax->count + 1);
    for (uint32_t i = first; i < call_syntax->count; i++) {
        const Syntax *argument = call_syntax->children[i];
        if (argument->kind != SYNTAX_ARGUMENT)
            return false; /* reported by the parser */
        Value    value = evaluate(e, env, argument->children[0]);
        uint32_t slot  = next;
        if (argument->name) {
            for (slot = 0; slot < count; slot++)
                if (strlen(argument->name) == words[slot].length &&
                    strncmp(argument->name, words[slot].text, words[slot].length) == 0)
                    break;
            if (slot == count) {
                no_such_parameter(e, argument, name, words, count);
                good = false;
                continue;
            }
        } else if (next < count && words[next].variadic) {
            call->rest[call->rest_count++] = (Argument){value, argument->children[0]};
            good = good && value.type != VALUE_ERROR;
            continue;
        } else if (next++ >= count) {
            too_many(e, argument, name, count);
            good = false;
            continue;
        }
        good = store(e, &call->arguments[slot], argument, value, name) && value.type != VALUE_ERROR && good;
    }
    for (uint32_t i = 0; good && i < count; i++)
        if (!call->arguments[i].syntax && !words[i].optional && !words[i].variadic) {
            Diag *diag  = diag_add(e->diags, DIAG_MISSING_ARGUMENT, call_syntax->span, "`%s` needs an argument `%.*s`", name,
                                   (int)words[i].length, words[i].text);
            diag->label = "not given here";
            good        = false;
        }
    return good;
}
