/*
 * frames.c: a text without globals that change, for languages that have none.
 *
 * What krs_prepare finds is a struct that it returns.  A function that reads some of it, or calls one that does, is given the
 * struct; as a text has each function before those that call it, one pass finds which these are.
 */
#include "export/parts.h"

#include <ctype.h>
#include <string.h>

typedef struct Words {
    const char **items;
    size_t       count, capacity;
} Words;

typedef struct Frames {
    Text       *to;
    const char *given;    /* parameters of krs_prepare */
    const char *prepared; /* statements that fill slots of parameters in */
    size_t      slots;
    Text        members;
    Words       globals, readers; /* names */
} Frames;

static bool has_word(const Words *words, const char *at, size_t length)
{
    for (size_t i = 0; i < words->count; i++)
        if (strncmp(words->items[i], at, length) == 0 && words->items[i][length] == '\0')
            return true;
    return false;
}

static void add_word(Frames *f, Words *words, const char *from, size_t length)
{
    array_push(f->to->arena, words, arena_copy_text(f->to->arena, from, length));
}

static size_t word_length(const char *at, const char *end)
{
    size_t length = 0;
    while (at + length < end && is_of_word(at[length]))
        length++;
    return length;
}

static bool is_parameter(const char *at, size_t length)
{
    static const char name[] = "krs_parameter";
    return length == sizeof name - 1 && memcmp(at, name, length) == 0;
}

/* Adds statements; false: nothing in there is of the frame. */
static bool add_body(Frames *f, Text *to, const char *from, const char *end)
{
    static const char prefix[] = "krs_";
    bool              reads    = false;
    while (from < end) {
        const size_t length = word_length(from, end);
        if (length == 0) {
            text_add_bytes(to, from++, 1);
            continue;
        }
        const bool member = is_parameter(from, length) || has_word(&f->globals, from, length);
        const bool called = has_word(&f->readers, from, length);
        text_add(to, member ? "krs." : "");
        text_add_bytes(to, from + (member ? sizeof prefix - 1 : 0),
                       length - (member ? sizeof prefix - 1 : 0));
        from += length;
        reads = reads || member || called;
        if (called && from < end && *from == '(') {
            text_add(to, from[1] == ')' ? "(krs" : "(krs, ");
            from++;
        }
    }
    return reads;
}

static void add_frame(Frames *f)
{
    text_format(f->to, "struct KrsFrame {\n    vec4 parameter[%zu];\n%s};\n\n", f->slots,
                f->members.bytes ? f->members.bytes : "");
}

/* Adds "float krs_distance(vec3 p)", and its body to the end. */
static void add_function(Frames *f, const char *from, const char *end)
{
    static const char prepare[] = "krs_prepare";
    const char       *open = strchr(from, '('), *name = open, *brace = strchr(open, '{');
    Text              body = {.arena = f->to->arena};
    while (name > from && is_of_word(name[-1]))
        name--;
    const size_t length = (size_t)(open - name);
    const bool   reads  = add_body(f, &body, brace + 1, end);
    if (length == sizeof prepare - 1 && memcmp(name, prepare, length) == 0) {
        add_frame(f);
        const char *last = strrchr(body.bytes, '}');
        text_format(f->to,
                    "KrsFrame krs_prepare(%s)\n{\n    KrsFrame krs;\n%s%.*s    return krs;\n}\n",
                    f->given, f->prepared, (int)(last - body.bytes - 1), body.bytes + 1);
        return;
    }
    text_add_bytes(f->to, from, (size_t)(open + 1 - from));
    const bool given = reads && strncmp(name, "krs_", 4) == 0; /* not an entry point */
    text_add(f->to, !given ? "" : open[1] == ')' ? "KrsFrame krs" : "KrsFrame krs, ");
    text_add_bytes(f->to, open + 1, (size_t)(brace + 1 - open - 1));
    text_add(f->to, body.bytes);
    if (given)
        add_word(f, &f->readers, name, length);
}

/* Notes "vec3 krs_frame0;". */
static void add_global(Frames *f, const char *from, const char *end)
{
    const size_t type = word_length(from, end), length = word_length(from + type + 1, end);
    add_word(f, &f->globals, from + type + 1, length);
    text_format(&f->members, "    %.*s %.*s;\n", (int)type, from, (int)length - 4,
                from + type + 1 + 4);
}

/* Returns where what begins here ends: behind its last line. */
static const char *end_of_item(const char *from)
{
    const char *line  = strchr(from, '\n');
    const char *brace = strchr(from, '{'), *semicolon = strchr(from, ';');
    if (!line)
        return from + strlen(from);
    if (*from == '\n' || strncmp(from, "//", 2) == 0 || !brace || (semicolon && semicolon < brace))
        return line + 1;
    const char *close = strchr(brace, '\n') && memchr(brace, '}', strcspn(brace, "\n"))
                            ? brace
                            : strstr(brace, "\n}");
    const char *last  = close ? strchr(close + (*close == '\n'), '\n') : NULL;
    return last ? last + 1 : from + strlen(from);
}

void add_without_globals(Text *to, const char *text, size_t slots, const char *given,
                         const char *prepared)
{
    Frames frames        = {.to = to, .given = given, .prepared = prepared, .slots = slots};
    frames.members.arena = to->arena;
    const char *comment  = NULL;  /* of what comes */
    bool        blank    = false; /* a line before it */
    for (const char *from = text, *end; *from; from = end) {
        end               = end_of_item(from);
        const char *open  = memchr(from, '(', (size_t)(end - from));
        const bool  body  = memchr(from, '{', (size_t)(end - from)) != NULL;
        const bool  plain = *from == '\n' || begins(from, "struct ") || begins(from, "const ") ||
                           begins(from, "uniform ");
        if (*from == '\n' && blank)
            continue;
        blank = *from == '\n';
        if (begins(from, "//")) {
            comment = comment ? comment : from;
            continue;
        }
        const bool prototype = !plain && !body && open;
        if (comment && !prototype)
            text_add_bytes(to, comment, (size_t)(from - comment));
        comment = NULL;
        if (plain)
            text_add_bytes(to, from, (size_t)(end - from));
        else if (body)
            add_function(&frames, from, end);
        else if (!prototype)
            add_global(&frames, from, end);
    }
}
