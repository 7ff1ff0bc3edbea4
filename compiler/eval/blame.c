/*
 * blame.c: mistakes that come to light inside of a function of the library are its caller's: they are
 * marked at the call, in words of what was called.
 */
#include <string.h>

#include "compiler/eval/elaborate.h"
#include "compiler/eval/kinds.h"

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

/* Notes "called with levels = 18, size = [1, 2, 1]", of the numbers and vectors that are known. */
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

/* Notes the first sentence of the comment before a definition. */
static void note_meaning(Elaboration *e, Diag *diag, const Syntax *definition)
{
    size_t length = 0;
    if (!definition->doc)
        return;
    while (definition->doc[length] &&
           !(definition->doc[length] == '.' && strchr(" \n", definition->doc[length + 1])))
        length++;
    diag_note(e->diags, diag, diag_text(e->diags, "%.*s", (int)length, definition->doc));
}

/* Reports a mistake in the library to its caller.  What a function of the library asserts is said
   in its own words; other mistakes inside of it are not described, since their words are of what
   the caller does not see. */
static void say_for_caller(Elaboration *e, Diag *diag, const char *name)
{
    diag->notes.count = 0;
    if (diag->code == DIAG_ASSERTION)
        diag->code = DIAG_BAD_VALUE;
    else if (diag_info[diag->code].severity == DIAG_ERROR && diag->code != DIAG_LIMIT) {
        diag->code    = DIAG_BAD_VALUE;
        diag->message = diag_text(e->diags, "`%s` cannot work with these arguments", name);
    }
    diag->label           = diag_text(e->diags, "in this call of `%s`", name);
    diag->help            = NULL;
    diag->replacement     = NULL;
    diag->secondary.count = 0;
}

void blame_caller(Elaboration *e, size_t first, const Syntax *syntax, const Function *function,
                  const Value *values, const Syntax *const *origins)
{
    const Source *sources  = e->sources->items;
    size_t        retained = first;
    Diag         *blamed   = NULL;
    if (!is_of_author(e, syntax))
        return;
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
        say_for_caller(e, diag, function->name);
        diag->span = syntax->span;
        blamed     = error ? diag : blamed;
    }
    e->diags->count = retained;
    if (!blamed)
        return;
    note_meaning(e, blamed, function->syntax);
    note_signature(e, blamed, function->syntax);
    note_arguments(e, blamed, function, values, origins);
}
