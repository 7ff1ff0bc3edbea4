/*
 * text.c: words about an imported file, and numbers as scenes have them.
 */
#include "import/common/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/passes/compile.h"

enum { MAX_NOTES = 100 };

/* Returns what a file says so that it moves no cursor, and ends no comment. */
static const char *harmless(Arena *arena, const char *format, va_list arguments)
{
    Text words = {.arena = arena};
    text_format_list(&words, format, arguments);
    for (char *at = words.bytes; *at != '\0'; at++)
        if ((unsigned char)*at < ' ' || *at == 0x7f)
            *at = '?';
    return words.bytes;
}

bool import_refuse(Import *import, unsigned line, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    if (import->refusal.length == 0)
        text_format(&import->refusal, "%s:%u: %s", import->path, line,
                    harmless(import->arena, format, arguments));
    va_end(arguments);
    return false;
}

static void add_note(Import *import, ImportNote note)
{
    if (import->notes.count >= MAX_NOTES - 1)
        note = (ImportNote){"more is left out than can be listed", note.line, false};
    for (size_t i = 0; i < import->notes.count; i++)
        if (strcmp(import->notes.items[i].words, note.words) == 0)
            return;
    if (import->notes.count < MAX_NOTES)
        array_push(import->arena, &import->notes, note);
}

void import_note(Import *import, unsigned line, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    add_note(import, (ImportNote){harmless(import->arena, format, arguments), line, false});
    va_end(arguments);
}

void import_blame(Import *import, unsigned line, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    ImportNote note = {harmless(import->arena, format, arguments), line, false};
    va_end(arguments);
    array_push(import->arena, &import->blames, note);
}

bool import_leaves_out(Import *import, unsigned line)
{
    if (!import->keep_going || import->refusal.length == 0)
        return false;
    ImportNote note  = {import->refusal.bytes, line, true};
    Text       words = {.arena = import->arena};
    import->refusal  = (Text){.arena = import->arena};
    for (size_t i = 0; i < import->left_out.count; i++)
        if (import->left_out.items[i].line == line &&
            strcmp(import->left_out.items[i].words, note.words) == 0)
            return true;
    array_push(import->arena, &import->left_out, note);
    text_format(&words, "a part is left out: %s", strchr(note.words, ':') + 1);
    add_note(import, (ImportNote){words.bytes, line, true});
    return true;
}

bool import_was_left_out(const Import *import, unsigned line)
{
    for (size_t i = 0; i < import->no_scene.count; i++)
        if (import->no_scene.items[i] == line)
            return true;
    return false;
}

void import_write_head(Import *import)
{
    text_format(&import->scene, "// From %s.\n", import->name);
    for (size_t i = 0; i < import->notes.count; i++)
        text_format(&import->scene, "// Line %u: %s.\n", import->notes.items[i].line,
                    import->notes.items[i].words);
    text_add(&import->scene, "\n");
}

static const char *supply_own(void *user, const char *path, size_t *length)
{
    const Import *import = user;
    char         *named = realpath(path, NULL), *own = realpath(import->path, NULL);
    const bool    same = named && own && strcmp(named, own) == 0;
    free(named);
    free(own);
    *length = import->length;
    return same ? import->bytes : NULL;
}

KrsOptions import_options(Import *import)
{
    return (KrsOptions){.memory_limit = import->memory,
                        .load         = import->root ? supply_own : NULL,
                        .load_user    = import};
}

bool import_compiles(Import *import, const char *scene)
{
    KrsOptions options = import_options(import);
    return krs_check_text(scene, strlen(scene), "scene.krs", &options) == KRS_OK;
}

void import_mark(Import *import, unsigned line)
{
    ImportMark mark = {import->scene.length, line};
    array_push(import->arena, &import->marks, mark);
}

unsigned import_origin(const Import *import, unsigned scene_line)
{
    size_t offset = 0;
    for (unsigned line = 1; line < scene_line && offset < import->scene.length; offset++)
        line += import->scene.bytes[offset] == '\n';
    unsigned origin = 1;
    for (size_t i = 0; i < import->marks.count && import->marks.items[i].offset <= offset; i++)
        origin = import->marks.items[i].line;
    return origin;
}

double import_rounded(double number)
{
    char digits[32];
    snprintf(digits, sizeof digits, "%.12g", number);
    return strtod(digits, NULL);
}

void import_add_number(Text *text, double number)
{
    text_number(text, number == 0 ? 0 : number); /* never -0 */
}

void import_add_vector(Text *text, const double *numbers, int count)
{
    for (int i = 0; i < count; i++) {
        text_add(text, i == 0 ? "[" : ", ");
        import_add_number(text, numbers[i]);
    }
    text_add(text, "]");
}
