/*
 * helpers.c: functions that texts call, from the printer's files.
 *
 * A helper is a function of such a file, with a comment above it, between blank lines.  It is printed
 * before the first that calls it, if any does.  Where there is one of floats alone, the same of
 * vectors is written here.  No two functions have one name: that of vectors ends with "_vec3".
 */
#include <assert.h>
#include <ctype.h>
#include <string.h>

#include "compiler/print/emitter.h"

/* ---- files ---- */

/* Skips the comment that text begins with, if any. */
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

static bool is_of_name(char c) { return isalnum((unsigned char)c) || c == '_'; }

static bool is_word(const char *word, size_t length, const char *text)
{
    return strlen(word) == length && strncmp(word, text, length) == 0;
}

/* Finds the type of the first operand: the first word between `from` and a comma or parenthesis
   that is one, "(float a" or "(a: f32"; or nothing. */
static void find_type(const Emitter *e, Helper *helper, const char *from)
{
    for (; *from && !strchr(",)", *from); from += helper->type_length) {
        from += strcspn(from, "abcdefghijklmnopqrstuvwxyz,)");
        helper->type        = from;
        helper->type_length = 0;
        while (is_of_name(from[helper->type_length]))
            helper->type_length++;
        for (GraphType type = TYPE_FLOAT; type <= TYPE_UINT; type++)
            if (is_word(e->printer->types[type], helper->type_length, from))
                return;
    }
    helper->type_length = 0;
}

/* Keeps a helper: text between blank lines of a file, such as "float krs_sin(float a)...". */
static void read_helper(Emitter *e, const char *text, size_t length, bool of_base)
{
    const char *from = skip_comment(text), *end = text + length;
    const char *name    = strstr(from, "krs_");
    Text        spelled = {.arena = e->scratch};
    if (from >= end || *from == '#' || !name || name >= end)
        return;
    if (of_base && e->printer->spell) {
        e->printer->spell(text, length, TYPE_FLOAT, &spelled);
        text   = spelled.bytes;
        length = spelled.length;
        name   = strstr(skip_comment(text), "krs_");
    }
    Helper helper      = {.text = text, .length = length, .name = name};
    helper.name_length = strcspn(name, "( ");
    find_type(e, &helper, name + helper.name_length);
    array_push(e->scratch, &e->helpers, helper);
}

static void read_file(Emitter *e, const EmbeddedFile *file, bool of_base)
{
    for (const char *text = file->text; *text;) {
        const char *blank  = strstr(text, "\n\n");
        size_t      length = blank ? (size_t)(blank - text) + 1 : strlen(text);
        read_helper(e, text, length, of_base);
        text += length + (blank != NULL);
    }
}

/* Reads the helpers of a printer before those of its base: the first of a name and type is found, so that the
   printer's own stands for that of the base. */
void helpers_read(Emitter *e)
{
    for (const Printer *printer = e->printer; printer; printer = printer->base)
        for (const EmbeddedFile *file = printer->helpers; file && file->name; file++)
            read_file(e, file, printer != e->printer);
}

/* Returns the helper of a name whose first operand has this type, if any; NULL: any type. */
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

/* Prints a helper behind those that it calls. */
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

static const char *text_of(Emitter *e, const char *bytes, size_t length)
{
    return arena_copy_text(e->scratch, bytes, length);
}

/* Prints an operation on vectors, component by component, by the `plain` one. */
static void print_spread(Emitter *e, const char *name, const char *plain, GraphType type,
                         uint32_t operands)
{
    const char *vector = e->printer->types[type];
    Text       *out    = &e->helper_text;
    Text        text   = {.arena = e->scratch};
    for (uint32_t k = 0; k < operands; k++) {
        Operands parameter = {vector, text_of(e, &"abcd"[k], 1)};
        text_add(&text, k ? ", " : "");
        text_add(&text, template_text(e, TEMPLATE_PARAMETER, parameter));
    }
    const char *head = template_text(e, TEMPLATE_FUNCTION, (Operands){vector, name, text.bytes});
    if (out->length > 0 && strstr(out->bytes, head))
        return;
    text_format(out, "%s\n{\n    return %s(", head, vector);
    for (uint32_t i = 0; i < (uint32_t)type; i++) {
        text_format(out, "%s%s(", i ? ", " : "", plain);
        for (uint32_t k = 0; k < operands; k++)
            text_format(out, "%s%c.%c", k ? ", " : "", 'a' + (int)k, "xyzw"[i]);
        text_add(out, ")");
    }
    text_add(out, ");\n}\n\n");
}

/* Prints the function that a call begins with, and returns its name; NULL: there is no such function. */
static const char *print_called(Emitter *e, const char *call, GraphType type, uint32_t operands)
{
    const size_t length     = name_length(call);
    const char  *name       = text_of(e, call, length);
    Text         of_vectors = {.arena = e->scratch};
    Helper      *exact      = find_helper(e, name, length, e->printer->types[type]);
    if (exact) {
        print_helper(e, exact);
        return name;
    }
    if (type < TYPE_VEC2 || type > TYPE_VEC4)
        return NULL;
    text_format(&of_vectors, "%s_vec%d", name, (int)type);
    exact          = find_helper(e, of_vectors.bytes, of_vectors.length, NULL);
    Helper *of_one = find_helper(e, name, length, e->printer->types[TYPE_FLOAT]);
    if (!exact && !of_one)
        return NULL;
    print_helper(e, exact ? exact : of_one);
    if (!exact)
        print_spread(e, of_vectors.bytes, name, type, operands);
    return of_vectors.bytes;
}

const char *emit_call(Emitter *e, const char *name, GraphType type, uint32_t operands)
{
    const char *called = print_called(e, name, type, operands);
    assert(called);
    return called;
}

bool module_print_helpers(const Printer *printer, Op op, GraphType type, uint32_t operands,
                          Text *out)
{
    const Printer whole = printer_with_base(printer, out->arena);
    const char   *call  = strstr(printer_operation(&whole, op, type, out->arena), "krs_");
    Emitter       e     = {.printer = &whole, .scratch = out->arena, .helper_text = *out};
    helpers_read(&e);
    bool found = !call || print_called(&e, call, type, operands);
    *out       = e.helper_text;
    return found;
}

void emit_helper_of(Emitter *e, const char *name, uint32_t component)
{
    const Helper *helper = find_helper(e, name, strlen(name), NULL);
    assert(helper);
    const char *from = helper->text, *end = from + helper->length;
    for (const char *at = from; (at = strstr(at, "_N")) && at < end; at += 2) {
        if (is_of_name(at[2]))
            continue;
        text_add_bytes(e->out, from, (size_t)(at - from));
        text_format(e->out, "_%u", component + 1);
        from = at + 2;
    }
    text_add_bytes(e->out, from, (size_t)(end - from));
    text_add(e->out, "\n");
}
