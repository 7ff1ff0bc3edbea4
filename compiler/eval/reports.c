/*
 * reports.c: mistakes in what values a scene gives, told at their place.
 */
#include "compiler/eval/elaborate.h"

#include <math.h>
#include <string.h>

const Definition *definition_of(const Elaboration *e, const Syntax *name)
{
    for (size_t i = 0; i < e->scopes.count; i++) {
        const Scope *scope = e->scopes.items[i];
        if (scope->file && scope->file->span.source == name->span.source)
            return scope_find(scope, name->name);
    }
    return NULL;
}

/* Returns the first name in an expression whose value is later than compile time. */
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

/* Returns what is wanted of a value; a property whose whole value it is has a name. */
static const char *wanted_of(Elaboration *e, const Syntax *syntax, const char *wanted)
{
    for (uint32_t i = 0; e->block && i < e->block->count; i++) {
        const Syntax *property = e->block->children[i];
        if (property->kind == SYNTAX_PROPERTY && property->children[0] == syntax)
            return diag_text(e->diags, "`%s` of %s must be %s", property->name,
                             block_name(e->block->kind), wanted);
    }
    return diag_text(e->diags, "expected %s", wanted);
}

Diag *type_error(Elaboration *e, const Syntax *syntax, Value found, const char *wanted)
{
    if (found.type == VALUE_ERROR)
        return &e->diags->scrap;
    const char *name = value_type_name(e, found);
    Diag       *diag = diag_add(e->diags, DIAG_TYPE_MISMATCH, syntax->span, "%s, found %s",
                                wanted_of(e, syntax, wanted), name);
    diag->label      = diag_text(e->diags, "this is %s", name);
    point_at_definition(e, diag, syntax);
    return diag;
}

/* Returns help where a value must be known: a `let`, if it is a `param` that it depends on. */
static const char *constant_help(Elaboration *e, const Syntax *syntax)
{
    enum { LONGEST_CHAIN = 8 };
    for (int i = 0; i < LONGEST_CHAIN && syntax; i++) {
        const Syntax     *name       = find_late_name(e, syntax);
        const Definition *definition = name ? definition_of(e, name) : NULL;
        if (!definition || !definition->syntax)
            return NULL;
        if (definition->syntax->kind == SYNTAX_PARAM)
            return diag_text(e->diags, "`let %s = ...;` in place of the `param` is known",
                             name->name);
        syntax = definition->syntax->children[0];
    }
    return NULL;
}

void constant_error(Elaboration *e, const Syntax *syntax, const char *message)
{
    Diag *diag  = diag_add(e->diags, DIAG_NOT_COMPILE_TIME, syntax->span, "%s", message);
    diag->label = "this depends on a `param`, on `time` or on a coordinate";
    diag->help  = constant_help(e, syntax);
    point_at_definition(e, diag, syntax);
}

void point_error(Elaboration *e, const Syntax *syntax, const char *what)
{
    Diag *diag  = diag_add(e->diags, DIAG_NOT_FRAME_TIME, syntax->span,
                           "%s may not depend on the point", what);
    diag->label = "this depends on `x`, `y`, `z` or `p`";
    point_at_definition(e, diag, syntax);
}

bool check_extent(Elaboration *e, Range range, uint32_t axis, const Syntax *syntax,
                  const char *what)
{
    double reach = fmax(isfinite(range.low) ? fabs(range.low) : 0,
                        isfinite(range.high) ? fabs(range.high) : 0);
    if (reach <= MAX_EXTENT)
        return true;
    Diag *diag  = diag_add(e->diags, DIAG_BAD_VALUE, syntax->span,
                           "%s reaches to %.3g on the %c axis", what, reach, "xyz"[axis]);
    diag->label = "farther than 1e12, which devices cannot compute with";
    return false;
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

void explain_usage(Elaboration *e, Diag *diag, const Syntax *call, const char *name)
{
    explain_word(e->diags, diag, SYNONYM_CALL, name, call->kind == SYNTAX_METHOD ? "." : "");
}

void unknown_parameter(Elaboration *e, const Syntax *call, const Syntax *argument, const char *name,
                       const char *const *parameters, uint32_t count)
{
    const char *owner = call->kind == SYNTAX_METHOD ? diag_text(e->diags, ".%s", name) : name;
    Diag       *diag  = diag_add(e->diags, DIAG_UNKNOWN_PARAMETER, argument->name_span,
                                 "`%s` has no parameter `%s`", name, argument->name);
    diag->label       = "unknown parameter";
    bool explained    = explain_parameter(e->diags, diag, argument->name, owner, parameters, count);
    if (!explained)
        diag->replacement = nearest_name(argument->name, parameters, count);
    if (diag->replacement && !explained)
        diag->help = "a parameter with a similar name exists";
    diag_note(e->diags, diag, signature(e, name, parameters, count));
}

/* Returns text such as "`a`, `b` and `c`". */
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
