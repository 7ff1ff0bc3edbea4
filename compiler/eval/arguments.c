/*
 * arguments.c: from the arguments of a call to what a function needs.
 */
#include "compiler/eval/elaborate.h"

#include <math.h>
#include <string.h>

static const double ORIGIN[3] = {0, 0, 0};

/* ---- reports ---- */

/* The top-level definition that a name refers to, as far as its file tells. */
static const Definition *definition_of(const Elaboration *e, const Syntax *name)
{
    for (size_t i = 0; i < e->scopes.count; i++) {
        const Scope *scope = e->scopes.items[i];
        if (scope->file && scope->file->span.source == name->span.source)
            return scope_find(scope, name->name);
    }
    return NULL;
}

/* The first name in an expression whose value is later than compile time. */
static const Syntax *find_late_name(const Elaboration *e, const Syntax *syntax)
{
    if (syntax->kind == SYNTAX_NAME) {
        const Definition *definition = definition_of(e, syntax);
        return definition && value_time(e, definition->value) != TIME_COMPILE ? syntax : NULL;
    }
    const Syntax *found = NULL;
    for (uint32_t i = 0; !found && i < syntax->count; i++)
        found = find_late_name(e, syntax->children[i]);
    return found;
}

void point_at_definition(Elaboration *e, Diag *diag, const Syntax *syntax)
{
    enum { LONGEST_CHAIN = 8 };
    bool late = diag->code == DIAG_NOT_COMPILE_TIME || diag->code == DIAG_NOT_FRAME_TIME;
    if (syntax && late)
        syntax = find_late_name(e, syntax);
    for (int i = 0; i < LONGEST_CHAIN && syntax && syntax->kind == SYNTAX_NAME; i++) {
        const Definition *definition = definition_of(e, syntax);
        if (!definition || !definition->syntax)
            return;
        diag_secondary(e->diags, diag, definition->syntax->name_span,
                       diag_text(e->diags, "`%s` is defined here", syntax->name));
        /* The chain of definitions, down to the `param` that began it. */
        bool on = late && definition->syntax->kind == SYNTAX_LET;
        syntax  = on ? find_late_name(e, definition->syntax->children[0]) : NULL;
    }
}

void type_error(Elaboration *e, const Syntax *syntax, Value found, const char *wanted)
{
    if (found.type == VALUE_ERROR)
        return;
    const char *name = value_type_name(e, found);
    Diag       *diag = diag_add(e->diags, DIAG_TYPE_MISMATCH, syntax->span, "expected %s, found %s",
                                wanted, name);
    diag->label      = diag_text(e->diags, "this is %s", name);
    point_at_definition(e, diag, syntax);
}

void constant_error(Elaboration *e, const Syntax *syntax, const char *message)
{
    Diag *diag  = diag_add(e->diags, DIAG_NOT_COMPILE_TIME, syntax->span, "%s", message);
    diag->label = "this depends on a `param`, on `time` or on a coordinate";
    point_at_definition(e, diag, syntax);
}

void point_error(Elaboration *e, const Syntax *syntax, const char *what)
{
    Diag *diag  = diag_add(e->diags, DIAG_NOT_FRAME_TIME, syntax->span,
                           "%s may not depend on the point", what);
    diag->label = "this depends on `x`, `y`, `z` or `p`";
    point_at_definition(e, diag, syntax);
}

void not_supported(Elaboration *e, Span span, const char *what)
{
    Diag *diag  = diag_add(e->diags, DIAG_NOT_SUPPORTED, span,
                           "this version of krs does not have %s", what);
    diag->label = "not in this version";
}

const char *signature(Elaboration *e, const char *name, const char *const *parameters,
                      uint32_t count)
{
    Text text = {.arena = e->diags->arena};
    text_format(&text, "%s(", name);
    for (uint32_t i = 0; i < count; i++)
        text_format(&text, "%s%s", i ? ", " : "", parameters[i]);
    text_add(&text, ")");
    return text.bytes;
}

void note_names(Elaboration *e, Diag *diag, const char *what, const char *const *names,
                size_t count)
{
    Text text = {.arena = e->diags->arena};
    text_format(&text, "%s:", what);
    for (size_t i = 0; i < count; i++)
        text_format(&text, "%s %s", i ? "," : "", names[i]);
    diag_note(e->diags, diag, text.bytes);
}

void unknown_parameter(Elaboration *e, const Syntax *argument, const char *name,
                       const char *const *parameters, uint32_t count)
{
    Diag *diag        = diag_add(e->diags, DIAG_UNKNOWN_PARAMETER, argument->name_span,
                                 "`%s` has no parameter `%s`", name, argument->name);
    diag->label       = "unknown parameter";
    diag->replacement = nearest_name(argument->name, parameters, count);
    if (diag->replacement)
        diag->help = "a parameter with a similar name exists";
    diag_note(e->diags, diag, signature(e, name, parameters, count));
}

/* "a", "b" and "c" */
static const char *listed_names(Elaboration *e, const Choices *names)
{
    Text list = {.arena = e->diags->arena};
    for (uint32_t i = 0; i < names->count; i++) {
        const char *join = i == 0 ? "" : i + 1 < names->count ? ", " : " and ";
        text_format(&list, "%s\"%s\"", join, names->items[i]);
    }
    return list.bytes;
}

bool want_name(Elaboration *e, const Argument *argument, const Choices *names, uint32_t *chosen)
{
    *chosen = 0;
    if (!argument->syntax)
        return true;
    if (argument->value.type != VALUE_STRING) {
        type_error(e, argument->syntax, argument->value, names->wanted);
        return false;
    }
    const char *name = argument->value.string;
    for (; *chosen < names->count; ++*chosen)
        if (strcmp(names->items[*chosen], name) == 0)
            return true;
    Diag       *diag = diag_add(e->diags, DIAG_BAD_VALUE, argument->syntax->span,
                                "no %s is called \"%s\"", names->noun, name);
    const char *near = nearest_name(name, names->items, names->count);
    diag->label      = names->unknown;
    if (near)
        diag->replacement = diag_text(e->diags, "\"%s\"", near);
    diag->help = diag_text(e->diags, "there are %s%s", listed_names(e, names), names->more);
    return false;
}

Diag *too_many_arguments(Elaboration *e, const Syntax *argument, const char *name, uint32_t count)
{
    Diag *diag  = diag_add(e->diags, DIAG_TOO_MANY_ARGUMENTS, argument->span,
                           "`%s` takes %u argument%s", name, count, count == 1 ? "" : "s");
    diag->label = "one too many";
    return diag;
}

Diag *missing_argument(Elaboration *e, const Syntax *call, const char *name, const char *parameter)
{
    Diag *diag  = diag_add(e->diags, DIAG_MISSING_ARGUMENT, call->span,
                           "`%s` needs an argument `%s`", name, parameter);
    diag->label = "not given here";
    return diag;
}

/* ---- checks ---- */

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
    GraphParameter *copy  = arena_new_array(e->arena, GraphParameter, count);
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

/* Shapes are the same at every point: what may not depend on x, y, z or p. */
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

Node to_vector(Elaboration *e, Value value, const Syntax *syntax, const char *what)
{
    Node node = value.type == VALUE_LIST || value.type == VALUE_EXPRESSION ? value_node(e, value)
                                                                           : NODE_NONE;
    if (node != NODE_NONE && e->graph->items[node].type == TYPE_VEC3)
        return frame_time(e, node, syntax, what);
    type_error(e, syntax, value, "a vector of 3");
    return NODE_NONE;
}

bool check_direction(Elaboration *e, Node vector, const Syntax *syntax, const char *what)
{
    return require_direction(e->builder, vector, syntax->span, what);
}

bool check_positive(Elaboration *e, Node number, const Syntax *syntax, const char *what)
{
    return require_positive(e->builder, number, syntax->span, what);
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

/* The parameter that a named argument is for; UINT32_MAX: reported. */
static uint32_t find_word(Elaboration *e, const Syntax *argument, const char *name,
                          const ParameterWord *words, uint32_t count)
{
    const char *names[MAX_PARAMETERS];
    for (uint32_t i = 0; i < count; i++)
        if (strlen(argument->name) == words[i].length &&
            strncmp(argument->name, words[i].text, words[i].length) == 0)
            return i;
    for (uint32_t i = 0; i < count; i++)
        names[i] = arena_copy_text(e->diags->arena, words[i].text, words[i].length);
    unknown_parameter(e, argument, name, names, count);
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
        call->rest = arena_new_array(e->arena, Argument, call_syntax->count);
    for (uint32_t i = first; i < call_syntax->count; i++) {
        const Syntax *argument = call_syntax->children[i];
        if (argument->kind != SYNTAX_ARGUMENT)
            return false; /* reported by the parser */
        Value    value = evaluate(e, env, argument->children[0]);
        uint32_t slot  = next;
        if (argument->name) {
            slot = find_word(e, argument, name, words, count);
            if (slot == UINT32_MAX) {
                good = false;
                continue;
            }
        } else if (next < count && words[next].variadic) {
            call->rest[call->rest_count++] = (Argument){value, argument->children[0]};
            good                           = good && value.type != VALUE_ERROR;
            continue;
        } else if (next++ >= count) {
            too_many_arguments(e, argument, name, count);
            good = false;
            continue;
        }
        good = store(e, &call->arguments[slot], argument, value, name) &&
               value.type != VALUE_ERROR && good;
    }
    for (uint32_t i = 0; good && i < count; i++)
        if (!call->arguments[i].syntax && !words[i].optional && !words[i].variadic) {
            missing_argument(e, call_syntax, name,
                             diag_text(e->diags, "%.*s", (int)words[i].length, words[i].text));
            good = false;
        }
    return good;
}
