/*
 * helpers.c: functions that texts call, from the printer's files.
 *
 * A helper is a function or a struct of such a file, with a comment above it, between blank lines.  It
 * is printed before the first that calls it, if any does.  Where there is one of floats alone, the
 * same of vectors is written here.
 */
#include <assert.h>
#include <string.h>

#include "compiler/print/emitter.h"

/* ---- files ---- */

/* Behind the comment that text begins with, if any. */
static const char *skip_comment(const char *text)
{
    if (strncmp(text, "/*", 2) == 0) {
        const char *end = strstr(text, "*/");
        text            = end ? end + 2 : text + strlen(text);
        return text + strspn(text, "\n");
    }
    while (strncmp(text, "//", 2) == 0) {
        text += strcspn(text, "\n");
        text += *text == '\n';
    }
    return text;
}

/* The part of a file between blank lines, unless it is none; "float krs_sin(float a)..." */
static void read_helper(Emitter *e, const char *text, size_t length)
{
    const char *from = skip_comment(text), *end = text + length;
    if (from >= end || *from == '#')
        return;
    const char *name   = from + strcspn(from, " ") + 1;
    Helper      helper = {.text = text, .length = length, .name = name};
    helper.name_length = strcspn(name, "( ");
    helper.type        = name + helper.name_length + 1;
    helper.type_length = strcspn(helper.type, " \n");
    array_push(e->scratch, &e->helpers, helper);
}

void helpers_read(Emitter *e)
{
    for (const EmbeddedFile *file = e->printer->helpers; file->name; file++)
        for (const char *text = file->text; *text;) {
            const char *blank  = strstr(text, "\n\n");
            size_t      length = blank ? (size_t)(blank - text) + 1 : strlen(text);
            read_helper(e, text, length);
            text += length + (blank != NULL);
        }
}

static bool is_word(const char *word, size_t length, const char *text)
{
    return strlen(word) == length && strncmp(word, text, length) == 0;
}

/* The one whose first operand has this type, if any; NULL: any type. */
static Helper *find_helper(Emitter *e, const char *name, size_t length, const char *type)
{
    for (size_t i = 0; i < e->helpers.count; i++) {
        Helper *helper = &e->helpers.items[i];
        if (helper->name_length == length && strncmp(helper->name, name, length) == 0 &&
            (!type || is_word(type, helper->type_length, helper->type)))
            return helper;
    }
    return NULL;
}

/* ---- what is called ---- */

static size_t name_length(const char *name)
{
    return strspn(name, "abcdefghijklmnopqrstuvwxyz_0123456789");
}

/* Those that it calls come first. */
static void print_helper(Emitter *e, Helper *helper)
{
    if (helper->printed)
        return;
    helper->printed = true;
    for (const char *call = helper->name + helper->name_length,
                    *end  = helper->text + helper->length;
         (call = strstr(call, "krs_")) && call < end; call += name_length(call)) {
        Helper *called = find_helper(e, call, name_length(call), NULL);
        if (called)
            print_helper(e, called);
    }
    text_add_bytes(&e->helper_text, helper->text, helper->length);
    text_add(&e->helper_text, "\n");
}

/* Of vectors, component by component. */
static void print_spread(Emitter *e, const char *name, size_t length, GraphType type,
                         uint32_t operands)
{
    const char *vector = e->printer->types[type];
    Text       *out    = &e->helper_text;
    Text        text   = {.arena = e->scratch};
    text_format(&text, "%s %.*s(", vector, (int)length, name);
    for (uint32_t k = 0; k < operands; k++)
        text_format(&text, "%s%s %c", k ? ", " : "", vector, 'a' + (int)k);
    text_add(&text, ")\n");
    if (out->length > 0 && strstr(out->bytes, text.bytes))
        return;
    text_format(out, "%s{\n    return %s(", text.bytes, vector);
    for (uint32_t i = 0; i < (uint32_t)type; i++) {
        text_format(out, "%s%.*s(", i ? ", " : "", (int)length, name);
        for (uint32_t k = 0; k < operands; k++)
            text_format(out, "%s%c.%c", k ? ", " : "", 'a' + (int)k, "xyzw"[i]);
        text_add(out, ")");
    }
    text_add(out, ");\n}\n\n");
}

/* False: there is no such function. */
static bool print_called(Emitter *e, const char *name, GraphType type, uint32_t operands)
{
    size_t  length = name_length(name);
    Helper *exact  = find_helper(e, name, length, e->printer->types[type]);
    Helper *of_one = find_helper(e, name, length, e->printer->types[TYPE_FLOAT]);
    if (!exact && (!of_one || type > TYPE_VEC4))
        return false;
    print_helper(e, exact ? exact : of_one);
    if (!exact)
        print_spread(e, name, length, type, operands);
    return true;
}

void emit_call(Emitter *e, const char *name, GraphType type, uint32_t operands)
{
    bool found = print_called(e, name, type, operands);
    assert(found);
    (void)found;
}

bool module_print_helpers(const Printer *printer, Op op, GraphType type, uint32_t operands,
                          Text *out)
{
    const char *call = strstr(printer->operation(op), "krs_");
    Emitter     e    = {.printer = printer, .scratch = out->arena, .helper_text = *out};
    helpers_read(&e);
    bool found = !call || print_called(&e, call, type, operands);
    *out       = e.helper_text;
    return found;
}
