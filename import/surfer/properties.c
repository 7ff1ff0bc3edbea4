/*
 * properties.c: lists of properties as Java writes them: `key=value`, with comments,
 * characters that a backslash protects, and lines that one continues.
 */
#include "import/surfer/properties.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_PROPERTIES = 10000 };

typedef struct Reader {
    const char *at;
    unsigned    line;
} Reader;

enum { END_OF_LINE = -1 };

static int hexadecimal(const char **at)
{
    int code = 0;
    for (int i = 0; i < 4 && isxdigit((unsigned char)**at); i++, (*at)++) {
        int digit = isdigit((unsigned char)**at) ? **at - '0' : tolower(**at) - 'a' + 10;
        code      = 16 * code + digit;
    }
    return code > 0 && code < 128 ? code : '?'; /* nothing that counts here is beyond ASCII */
}

/* Returns the next character of a line that backslashes may make several; *escaped: it means
   itself. */
static int next_character(Reader *reader, bool *escaped)
{
    *escaped = *reader->at == '\\' && reader->at[1] != '\0';
    if (*reader->at == '\0' || *reader->at == '\n')
        return END_OF_LINE;
    if (!*escaped)
        return *reader->at++;
    char next = reader->at[1];
    reader->at += 2;
    if (next == '\r' && *reader->at == '\n')
        next = *reader->at++;
    switch (next) {
    case '\n':
        reader->line++;
        reader->at += strspn(reader->at, " \t\f");
        return next_character(reader, escaped);
    case 't': return '\t';
    case 'n':
    case 'r':
    case 'f': return ' ';
    case 'u': return hexadecimal(&reader->at);
    default: return next;
    }
}

/* Reads everything up to a blank, `=` or `:`, or all of the line. */
static const char *read_piece(const JsurfSurface *surface, Reader *reader, bool key)
{
    Text text = {.arena = surface->import->arena};
    text_add(&text, "");
    for (;;) {
        Reader before = *reader;
        bool   escaped;
        int    character = next_character(reader, &escaped);
        if (character == END_OF_LINE)
            break;
        if (key && !escaped && strchr("=: \t\f\r", character)) {
            *reader = before;
            break;
        }
        if (character != '\r')
            text_add_bytes(&text, &(char){(char)character}, 1);
    }
    return text.bytes;
}

bool jsurf_read(JsurfSurface *surface)
{
    Reader reader = {surface->import->bytes, 1};
    while (*reader.at != '\0') {
        reader.at += strspn(reader.at, " \t\f\r");
        if (*reader.at == '#' || *reader.at == '!')
            reader.at += strcspn(reader.at, "\n");
        if (*reader.at == '\n') {
            reader.at++;
            reader.line++;
            continue;
        }
        if (*reader.at == '\0')
            break;
        if (surface->properties.count == MAX_PROPERTIES)
            return import_refuse(surface->import, reader.line, "more than %d properties",
                                 MAX_PROPERTIES);
        JsurfProperty property = {.line = reader.line};
        property.key           = read_piece(surface, &reader, true);
        reader.at += strspn(reader.at, " \t\f");
        reader.at += *reader.at == '=' || *reader.at == ':';
        reader.at += strspn(reader.at, " \t\f");
        property.value = read_piece(surface, &reader, false);
        array_push(surface->import->arena, &surface->properties, property);
    }
    return true;
}

const JsurfProperty *jsurf_property(const JsurfSurface *surface, const char *key)
{
    for (size_t i = surface->properties.count; i-- > 0;)
        if (strcmp(surface->properties.items[i].key, key) == 0)
            return &surface->properties.items[i];
    return NULL;
}

unsigned jsurf_line(const JsurfSurface *surface, const char *key)
{
    const JsurfProperty *property = jsurf_property(surface, key);
    return property ? property->line : 1;
}

bool jsurf_numbers(const JsurfSurface *surface, const char *key, double *numbers, int count)
{
    const double         MOST     = 1e6;
    const JsurfProperty *property = jsurf_property(surface, key);
    if (!property)
        return true;
    const char *at = property->value;
    for (int i = 0; i < count; i++) {
        char  *end;
        double number = strtod(at, &end);
        if (end == at || !isfinite(number) || fabs(number) > MOST)
            return import_refuse(surface->import, property->line, "`%s` needs %d number%s up to %g",
                                 key, count, count == 1 ? "" : "s", MOST);
        numbers[i] = number;
        at         = end;
    }
    at += strspn(at, " \t");
    return *at == '\0' ||
           import_refuse(surface->import, property->line, "`%s` has more than %d number%s", key,
                         count, count == 1 ? "" : "s");
}
