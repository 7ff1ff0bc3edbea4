/*
 * diag_text.c: writes diagnostics for people, with the source lines that they are about.
 *
 * A source may have any bytes, which are made visible.  Of a very long line only the part around the
 * mark is shown.
 */
#include "compiler/base/diag.h"

#include <string.h>

#include "compiler/base/visible.h"

enum { LONG_LINE_BYTES = 120, WINDOW_BEFORE = 40, WINDOW_CHARACTERS = 100, LONG_TEXT_BYTES = 400 };

/* A span to be marked; one that goes over several lines is marked on its first line only. */
typedef struct Mark {
    Span        span;
    const char *label;
    bool        primary;
    uint32_t    line;       /* from 0 */
    uint32_t    start, end; /* bytes of the line to mark */
    bool        drawn;
} Mark;

typedef struct Excerpt {
    const Diags *diags;
    Text        *out;
    bool         color;
    DiagCode     code;
    int          gutter; /* columns of the largest line number */
    struct {
        Mark  *items;
        size_t count, capacity;
    } marks;
} Excerpt;

/* Adds bytes to `out` as a terminal may get them.  Returns how many columns they take.  `out` may be NULL, to
   measure only. */
static uint32_t add_visible(Text *out, const char *bytes, size_t length)
{
    uint32_t columns = 0;
    for (size_t i = 0; i < length;) {
        const Visible visible = visible_next(bytes + i, length - i);
        if (out)
            text_add_bytes(out, visible.text, visible.length);
        columns += visible.columns;
        i += visible.used;
    }
    return columns;
}

/* Adds the lines of a string, all but the first indented.  A name may be as long as a file, so each
   line is cut at LONG_TEXT_BYTES. */
static void add_lines(Text *out, const char *string, int indent)
{
    for (;;) {
        size_t length = strcspn(string, "\n"), shown = length;
        if (length > LONG_TEXT_BYTES)
            shown = LONG_TEXT_BYTES;
        while (shown < length && !text_begins_character(string[shown]))
            shown--; /* a character is not cut */
        add_visible(out, string, shown);
        text_add(out, shown < length ? "..." : "");
        if (string[length] == '\0')
            return;
        text_format(out, "\n%*s", indent, "");
        string += length + 1;
    }
}

/* ---- colours ---- */

static void paint(const Excerpt *excerpt, const char *code)
{
    if (excerpt->color)
        text_format(excerpt->out, "\033[%sm", code);
}

static void paint_severity(const Excerpt *excerpt)
{
    static const char *const colors[] = {
        [DIAG_ERROR] = "1;31", [DIAG_WARNING] = "1;33", [DIAG_NOTE] = "1;36"};
    paint(excerpt, colors[diag_info[excerpt->code].severity]);
}

static void paint_frame(const Excerpt *excerpt) { paint(excerpt, "1;34"); }
static void paint_nothing(const Excerpt *excerpt) { paint(excerpt, "0"); }

/* ---- marks ---- */

static const Source *source_of(const Excerpt *excerpt, Span span)
{
    return &excerpt->diags->sources->items[span.source];
}

/* Returns the offset of a line's end, before its line break. */
static uint32_t line_end(const Source *source, uint32_t line)
{
    uint32_t end = line + 1 < source->line_count ? source->lines[line + 1] - 1 : source->length;
    return end > source->lines[line] && source->text[end - 1] == '\r' ? end - 1 : end;
}

static void add_mark(Excerpt *excerpt, Span span, const char *label, bool primary)
{
    if (span.source == 0)
        return;
    const Source *source = source_of(excerpt, span);
    uint32_t      line   = source_position(source, span.start).line - 1;
    uint32_t      end    = line_end(source, line);
    Mark          mark   = {span, label, primary, line, span.start, span.end, false};
    if (mark.start < source->lines[line])
        mark.start = source->lines[line];
    if (mark.start > end)
        mark.start = end;
    if (mark.end > end)
        mark.end = end;
    if (mark.end < mark.start)
        mark.end = mark.start;
    array_push(excerpt->out->arena, &excerpt->marks, mark);
}

/* Bytes [start, end) of a source to show for a mark: the whole line unless it is long. */
typedef struct Window {
    uint32_t start, end;
    bool     cut_before, cut_after;
} Window;

static Window window_around(const Source *source, const Mark *mark)
{
    uint32_t first = source->lines[mark->line], last = line_end(source, mark->line);
    if (last - first <= LONG_LINE_BYTES)
        return (Window){first, last, false, false};
    uint32_t start = mark->start;
    for (int i = 0; i < WINDOW_BEFORE && start > first; i++)
        do
            start--;
        while (start > first && !text_begins_character(source->text[start]));
    uint32_t end = start;
    for (int i = 0; i < WINDOW_CHARACTERS && end < last; i++)
        do
            end++;
        while (end < last && !text_begins_character(source->text[end]));
    return (Window){start, end, start > first, end < last};
}

/* ---- drawing ---- */

static void draw_gutter(const Excerpt *excerpt, const char *sign)
{
    paint_frame(excerpt);
    text_format(excerpt->out, "%*s %s", excerpt->gutter, "", sign);
    paint_nothing(excerpt);
}

static void draw_source_line(const Excerpt *excerpt, const Mark *mark, Window window)
{
    const Source *source = source_of(excerpt, mark->span);
    paint_frame(excerpt);
    text_format(excerpt->out, "%*u |", excerpt->gutter, mark->line + 1);
    paint_nothing(excerpt);
    if (window.end > window.start)
        text_add(excerpt->out, " ");
    text_add(excerpt->out, window.cut_before ? "..." : "");
    add_visible(excerpt->out, source->text + window.start, window.end - window.start);
    text_add(excerpt->out, window.cut_after ? "...\n" : "\n");
}

static void draw_marks(const Excerpt *excerpt, const Mark *mark, Window window)
{
    const char *text  = source_of(excerpt, mark->span)->text;
    uint32_t    end   = mark->end < window.end ? mark->end : window.end;
    uint32_t    blank = add_visible(NULL, text + window.start, mark->start - window.start);
    uint32_t    bytes = end > mark->start ? end - mark->start : 0;
    uint32_t    width = add_visible(NULL, text + mark->start, bytes);
    draw_gutter(excerpt, "|");
    text_format(excerpt->out, " %*s", (int)blank + (window.cut_before ? 3 : 0), "");
    if (mark->primary)
        paint_severity(excerpt);
    else
        paint_frame(excerpt);
    for (uint32_t i = 0; i < (width ? width : 1); i++)
        text_add(excerpt->out, mark->primary ? "^" : "-");
    if (mark->label) {
        text_add(excerpt->out, " ");
        add_lines(excerpt->out, mark->label, excerpt->gutter + 4);
    }
    paint_nothing(excerpt);
    text_add(excerpt->out, "\n");
}

/* Draws a line with its marks, beginning with `first`.  Marks outside of the window around `first`
   are drawn later, below another copy of the line. */
static void draw_line(Excerpt *excerpt, Mark *first)
{
    Window window = window_around(source_of(excerpt, first->span), first);
    draw_source_line(excerpt, first, window);
    for (Mark *mark = first; mark < excerpt->marks.items + excerpt->marks.count; mark++) {
        bool here = mark->span.source == first->span.source && mark->line == first->line &&
                    mark->start >= window.start && mark->start <= window.end;
        if (here && !mark->drawn) {
            draw_marks(excerpt, mark, window);
            mark->drawn = true;
        }
    }
}

/* Returns the next mark to draw in a file: the first of those on the topmost line that has undrawn
   marks. */
static Mark *next_mark(const Excerpt *excerpt, uint32_t source)
{
    Mark *next = NULL;
    for (size_t i = 0; i < excerpt->marks.count; i++) {
        Mark *mark = &excerpt->marks.items[i];
        if (!mark->drawn && mark->span.source == source && (!next || mark->line < next->line))
            next = mark;
    }
    return next;
}

static void draw_file(Excerpt *excerpt, const Mark *named, const char *arrow)
{
    const Source *source   = source_of(excerpt, named->span);
    Position      position = source_position(source, named->span.start);
    paint_frame(excerpt);
    text_format(excerpt->out, "%*s%s ", excerpt->gutter, "", arrow);
    paint_nothing(excerpt);
    add_visible(excerpt->out, source->name, strlen(source->name));
    text_format(excerpt->out, ":%u:%u\n", position.line, position.column);
    draw_gutter(excerpt, "|");
    text_add(excerpt->out, "\n");
    const Mark *above = NULL;
    for (Mark *mark; (mark = next_mark(excerpt, named->span.source)) != NULL; above = mark) {
        if (above && mark->line > above->line + 1)
            text_add(excerpt->out, "...\n");
        draw_line(excerpt, mark);
    }
}

/* Writes a note or help below the source lines, with quoted code behind it unless `code` is
   NULL. */
static void draw_note(const Excerpt *excerpt, const char *kind, const char *text,
                      const char *separator, const char *code)
{
    draw_gutter(excerpt, "= ");
    paint(excerpt, "1");
    text_format(excerpt->out, "%s: ", kind);
    paint_nothing(excerpt);
    add_lines(excerpt->out, text, excerpt->gutter + 5 + (int)strlen(kind));
    if (code) {
        text_format(excerpt->out, "%s`", separator);
        add_lines(excerpt->out, code, excerpt->gutter + 5 + (int)strlen(kind));
        text_add(excerpt->out, "`");
    }
    text_add(excerpt->out, "\n");
}

/* Writes the help and, unless the help quotes it already, the replacement. */
static void draw_help(const Excerpt *excerpt, const Diag *diag)
{
    if (diag->help && (!diag->replacement || strstr(diag->help, diag->replacement)))
        draw_note(excerpt, "help", diag->help, "", NULL);
    else if (diag->help)
        draw_note(excerpt, "help", diag->help, ": ", diag->replacement);
    else if (diag->replacement && *diag->replacement)
        draw_note(excerpt, "help", "write", " ", diag->replacement);
    else if (diag->replacement)
        draw_note(excerpt, "help", "leave this out", "", NULL);
}

static void draw_title(const Excerpt *excerpt, const Diag *diag)
{
    paint_severity(excerpt);
    text_format(excerpt->out, "%s[%s]", diag_severity(diag->code), diag_info[diag->code].code);
    paint_nothing(excerpt);
    paint(excerpt, "1");
    text_add(excerpt->out, ": ");
    add_lines(excerpt->out, diag->message, 4);
    paint_nothing(excerpt);
    text_add(excerpt->out, "\n");
}

void diag_print_one(const Diags *diags, const Diag *diag, bool color, Text *out)
{
    Excerpt excerpt = {.diags = diags, .out = out, .color = color, .gutter = 1};
    excerpt.code    = diag->code;
    add_mark(&excerpt, diag->span, diag->label, true);
    for (size_t i = 0; i < diag->secondary.count; i++)
        add_mark(&excerpt, diag->secondary.items[i].span, diag->secondary.items[i].label, false);
    for (size_t i = 0; i < excerpt.marks.count; i++)
        for (uint32_t n = excerpt.marks.items[i].line + 1, digits = 1; n > 0; n /= 10, digits++)
            if ((int)digits > excerpt.gutter)
                excerpt.gutter = (int)digits;

    draw_title(&excerpt, diag);
    for (size_t i = 0; i < excerpt.marks.count; i++)
        if (!excerpt.marks.items[i].drawn)
            draw_file(&excerpt, &excerpt.marks.items[i], i == 0 ? "-->" : ":::");
    for (size_t i = 0; i < diag->notes.count; i++)
        draw_note(&excerpt, "note", diag->notes.items[i], "", NULL);
    draw_help(&excerpt, diag);
}

static void print_count(size_t count, const char *what, Text *out)
{
    text_format(out, "%zu %s%s", count, what, count == 1 ? "" : "s");
}

void diags_print_text(const Diags *diags, bool color, Text *out)
{
    for (size_t i = 0; i < diags->count; i++) {
        diag_print_one(diags, diags->items[i], color, out);
        text_add(out, "\n");
    }
    if (diags->errors > MAX_DIAGS)
        text_format(out, "too many errors, the first %d are shown", MAX_DIAGS);
    else if (diags->errors > 0)
        print_count(diags->errors, "error", out);
    if (diags->warnings > 0) {
        text_add(out, diags->errors > 0 ? ", " : "");
        print_count(diags->warnings, "warning", out);
    }
    if (diags->errors + diags->warnings > 0)
        text_add(out, "\n");
}
