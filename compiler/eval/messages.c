/*
 * messages.c: `print` and `assert`, and the texts of values.
 */
#include "compiler/eval/elaborate.h"

#include <math.h>
#include <string.h>

enum {
    MAX_PRINTED = 100, /* notes of one scene */
    MAX_LINE    = 400, /* bytes of a value that is printed; the rest is left out */
    MAX_STRING  = 64 * 1024
};

/* ---- values as text ---- */

static void add_range(Elaboration *e, Text *text, Value value)
{
    text_add(text, value_type_name(e, value));
    Range range = {-INFINITY, INFINITY};
    if (value_size(e, value) == 1 && value_time(e, value) == TIME_FRAME)
        range = node_range(e->builder, value_node(e, value), 0);
    if (isfinite(range.low) && isfinite(range.high)) {
        text_add(text, " from ");
        text_number(text, range.low);
        text_add(text, " to ");
        text_number(text, range.high);
    }
    text_add(text, value_time(e, value) == TIME_FRAME ? ", known in frames" : ", known at points");
}

static void add_corner(Text *text, const Shape *shape, bool high)
{
    for (int i = 0; i < 3; i++) {
        text_add(text, i ? ", " : "[");
        text_number(text, high ? shape->box.axis[i].high : shape->box.axis[i].low);
    }
    text_add(text, "]");
}

static void add_shape(Text *text, const Shape *shape)
{
    text_format(text, "a shape, `%s`, ", shape->name);
    if (box_is_empty(shape->box)) {
        text_add(text, "empty");
        return;
    }
    text_add(text, "from ");
    add_corner(text, shape, false);
    text_add(text, " to ");
    add_corner(text, shape, true);
}

static void add_string(Text *text, const char *string, bool quoted)
{
    if (quoted)
        text_json(text, string);
    else
        text_add(text, string);
}

static void add_value(Elaboration *e, Text *text, Value value, bool quoted, size_t most);

static void add_record(Elaboration *e, Text *text, const Record *record, size_t most)
{
    text_add(text, "{");
    for (size_t i = 0; i < record->count && text->length <= most; i++) {
        text_add(text, i ? ", " : "");
        text_json(text, record->names[i].string);
        text_add(text, ": ");
        add_value(e, text, record->values[i], true, most);
    }
    text_add(text, "}");
}

/* Adds a value; nothing more once the text is longer than `most`. */
static void add_value(Elaboration *e, Text *text, Value value, bool quoted, size_t most)
{
    if (text->length > most)
        return;
    switch (value.type) {
    case VALUE_NUMBER: text_number(text, value.number); break;
    case VALUE_BOOLEAN: text_add(text, value.boolean ? "true" : "false"); break;
    case VALUE_STRING: add_string(text, value.string, quoted); break;
    case VALUE_EXPRESSION: add_range(e, text, value); break;
    case VALUE_SHAPE: add_shape(text, value.shape); break;
    case VALUE_RECORD: add_record(e, text, value.record, most); break;
    case VALUE_LIST:
        text_add(text, "[");
        for (size_t i = 0; i < value.list->count && text->length <= most; i++) {
            text_add(text, i ? ", " : "");
            add_value(e, text, value.list->items[i], true, most);
        }
        text_add(text, "]");
        break;
    default: text_add(text, value_type_name(e, value)); break;
    }
}

void value_text(Elaboration *e, Value value, Text *text, size_t most)
{
    add_value(e, text, value, true, most);
}

/* Joins all positional arguments, with a separator between; "" without any. */
static Text join_arguments(Elaboration *e, const Call *call, const char *separator, size_t most)
{
    Text text = {.arena = e->diags->arena};
    text_add(&text, "");
    for (uint32_t i = 0; i < call->rest_count; i++) {
        text_add(&text, i ? separator : "");
        add_value(e, &text, call->rest[i].value, false, most);
    }
    return text;
}

Value builtin_str(Elaboration *e, Call *call)
{
    for (uint32_t i = 0; i < call->rest_count; i++)
        if (value_time(e, call->rest[i].value) != TIME_COMPILE) {
            constant_error(e, call->rest[i].syntax, "a string must be known at compile time");
            return value_error();
        }
    Text text = join_arguments(e, call, "", MAX_STRING);
    if (text.length <= MAX_STRING)
        return value_string(e, text.bytes, text.length);
    Diag *diag  = diag_add(e->diags, DIAG_LIMIT, call->syntax->span, "a string of more than 64 KB");
    diag->label = "this is too long";
    return value_error();
}

Value value_string(Elaboration *e, const char *bytes, size_t length)
{
    return (Value){.type = VALUE_STRING, .string = name_intern(e->files->names, bytes, length)};
}

/* ---- messages ---- */

/* Returns the line that is printed or said: the values with blanks between, cut if it is long. */
static const char *line_of(Elaboration *e, const Call *call)
{
    Text text = join_arguments(e, call, " ", MAX_LINE);
    if (text.length > MAX_LINE)
        text_add(&text, " ...");
    return text.bytes;
}

static void run_print(Elaboration *e, const Call *call)
{
    if (++e->printed > MAX_PRINTED + 1)
        return;
    bool        more = e->printed > MAX_PRINTED;
    const char *line = more ? "more is printed, and left out here" : line_of(e, call);
    diag_add(e->diags, DIAG_PRINTED, call->syntax->span, "%s", line);
}

/* Notes the two numbers of a comparison that does not hold. */
static void note_sides(Elaboration *e, const Environment *env, Diag *diag, const Syntax *condition)
{
    if (condition->kind != SYNTAX_BINARY || diag == &e->diags->scrap)
        return;
    Value left  = evaluate(e, env, condition->children[0]);
    Value right = evaluate(e, env, condition->children[1]);
    if (left.type != VALUE_NUMBER || right.type != VALUE_NUMBER)
        return;
    Text text = {.arena = e->diags->arena};
    text_add(&text, "the left side is ");
    text_number(&text, left.number);
    text_add(&text, ", the right side is ");
    text_number(&text, right.number);
    diag_note(e->diags, diag, text.bytes);
}

static bool run_assert(Elaboration *e, const Environment *env, const Call *call)
{
    const Argument *condition = &call->arguments[0];
    if (condition->value.type == VALUE_BOOLEAN && condition->value.boolean)
        return true;
    if (condition->value.type == VALUE_BOOLEAN) {
        const char *line = line_of(e, call);
        Diag       *diag = diag_add(e->diags, DIAG_ASSERTION, condition->syntax->span, "%s",
                              *line ? line : "what the scene asserts is false");
        diag->label      = "this is false";
        note_sides(e, env, diag, condition->syntax);
    } else if (condition->value.type == VALUE_EXPRESSION)
        constant_error(e, condition->syntax, "what is asserted must be known at compile time");
    else
        type_error(e, condition->syntax, condition->value, "a truth value");
    return false;
}

bool run_message(Elaboration *e, const Environment *env, const Syntax *syntax)
{
    bool        print      = strcmp(syntax->name, "print") == 0;
    const char *parameters = print ? "values..." : "condition message...";
    Call        call;
    if (!bind_arguments(e, env, syntax, 0, syntax->name, parameters, &call))
        return false;
    if (!print)
        return run_assert(e, env, &call);
    run_print(e, &call);
    return true;
}
