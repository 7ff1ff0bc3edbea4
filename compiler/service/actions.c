/*
 * actions.c: changes of a text that are offered: quick fixes, a number as a param, an expression as a definition; colours;
 * the canonical layout.
 */
#include <string.h>

#include "compiler/front/format.h"
#include "compiler/service/analysis.h"

/* ---- colours ---- */

void answer_colors(const Here *here, const ServiceQuestion *about, Json *json)
{
    static const char *const names[] = {"red", "green", "blue"};
    const Tokens             tokens  = here->file->tokens;
    (void)about;
    json_open(json, NULL, "[");
    for (size_t i = 0; i < tokens.count; i++) {
        const Token *token = &tokens.items[i];
        if (token->kind != TOKEN_COLOUR)
            continue;
        json_open(json, NULL, "{");
        diag_json_range(json, "range", here->source, token->span.start, token->span.end);
        json_open(json, "color", "{");
        for (int k = 0; k < 3; k++) {
            Text number = {.arena = &here->service->arena};
            text_number(&number, (double)(token->rgb >> (16 - 8 * k) & 255) / 255);
            json_ready(json, names[k], number.bytes);
        }
        json_whole(json, "alpha", 1);
        json_close(json, "}");
        json_close(json, "}");
    }
    json_close(json, "]");
}

static unsigned byte_of(double part)
{
    return part > 0 ? part < 1 ? (unsigned)(part * 255 + 0.5) : 255 : 0;
}

void answer_color(const Here *here, const ServiceQuestion *about, Json *json)
{
    Text label = {.arena = &here->service->arena};
    text_format(&label, "#%02x%02x%02x", byte_of(about->color[0]), byte_of(about->color[1]),
                byte_of(about->color[2]));
    json_open(json, NULL, "[");
    json_open(json, NULL, "{");
    json_text(json, "label", label.bytes);
    json_close(json, "}");
    json_close(json, "]");
}

/* ---- edits ---- */

static void add_edit(const Here *here, Json *json, uint32_t start, uint32_t end, const char *text)
{
    json_open(json, NULL, "{");
    diag_json_range(json, "range", here->source, start, end);
    json_text(json, "newText", text);
    json_close(json, "}");
}

/* Begins an action whose edits of the document follow. */
static void begin_action(const Here *here, Json *json, const char *title, const char *kind,
                         const char *diagnostic)
{
    json_open(json, NULL, "{");
    json_text(json, "title", title);
    json_text(json, "kind", kind);
    if (diagnostic) {
        json_open(json, "diagnostics", "[");
        json_ready(json, NULL, diagnostic);
        json_close(json, "]");
        json_truth(json, "isPreferred", true);
    }
    json_open(json, "edit", "{");
    json_open(json, "changes", "{");
    json_open(json, uri_of(here->service, here->document->path), "[");
}

static void end_action(Json *json)
{
    json_close(json, "]");
    json_close(json, "}");
    json_close(json, "}");
    json_close(json, "}");
}

/* ---- quick fixes ---- */

static void add_fix(const Here *here, const ServiceFix *fix, Json *json)
{
    const Source  *source = here->source;
    const uint32_t start  = utf16_offset(source->text, source->length, fix->from);
    const uint32_t end    = utf16_offset(source->text, source->length, fix->to);
    Text           title  = {.arena = &here->service->arena};
    if (!*fix->replacement)
        text_add(&title, "leave this out");
    else
        text_format(&title, "write `%s`", fix->replacement);
    begin_action(here, json, title.bytes, "quickfix", fix->diagnostic);
    add_edit(here, json, start, end < start ? start : end, fix->replacement);
    end_action(json);
}

/* ---- names ---- */

/* Returns a name that nothing in the document has yet: `wanted`, or that with a number. */
static const char *new_name(const Here *here, const char *wanted)
{
    Meaning meaning;
    Text    name = {.arena = &here->service->arena};
    text_add(&name, wanted);
    for (int number = 2;; number++) {
        bool taken = find_meaning(here->analysis, name.bytes, 0, &meaning);
        for (size_t i = 0; !taken && i < here->file->uses.count; i++)
            taken = strcmp(here->file->uses.items[i].name, name.bytes) == 0;
        if (!taken)
            return name.bytes;
        name.length = 0;
        text_format(&name, "%s_%d", wanted, number);
    }
}

/* Returns the start of the line in which a statement of the file begins, with the comment before it
   that documents it. */
static uint32_t line_before(const Here *here, const Syntax *statement)
{
    const Source *source = here->source;
    uint32_t      line   = source_line(source, statement->span.start) - 1;
    while (line > 0) {
        const char *above = source->text + source->lines[line - 1];
        above += strspn(above, " \t");
        if (strncmp(above, "//", 2) != 0)
            break;
        line--;
    }
    return source->lines[line];
}

/* ---- a number becomes a param ---- */

/* Returns the purpose of a number: the property or parameter that gets it. */
static const char *purpose(const Here *here, const Way *way)
{
    const Syntax *node = way->items[way->count - 1];
    for (size_t i = way->count; i-- > 1;) {
        const Syntax *outer = way->items[i - 1];
        if (outer->kind == SYNTAX_UNARY)
            continue;
        if (outer->kind == SYNTAX_PROPERTY || outer->kind == SYNTAX_LET)
            return outer->name;
        if (outer->kind != SYNTAX_ARGUMENT || i < 2)
            return NULL;
        if (outer->name)
            return outer->name;
        const Tokens tokens = here->file->tokens;
        CallHere     call;
        Signature    signature;
        if (find_call(&tokens, node->span.start, &call) &&
            find_signature(here, &call, &signature) && call.argument < signature.count)
            return signature.items[call.argument].name;
        return NULL;
    }
    return NULL;
}

/* Tells whether a number may depend on a param: not where a count or a range needs it when the scene is compiled. */
static bool may_vary(const Here *here, const Way *way)
{
    for (size_t i = 0; i < way->count; i++)
        if (way->items[i]->kind == SYNTAX_RANGE || way->items[i]->kind == SYNTAX_IMAGE ||
            way->items[i]->kind == SYNTAX_PARAM || way->items[i]->kind == SYNTAX_INDEX ||
            way->items[i]->kind == SYNTAX_ERROR)
            return false;
    return way->count > 1 && here->file->syntax == way->items[0];
}

/* A range for a number. */
typedef struct Reach {
    double low, high;
} Reach;

/* Returns the text with a line at an offset and a name in place of a number behind it. */
static Text with_param(const Here *here, uint32_t at, const Text *line, Span number,
                       const char *name)
{
    const Source *source = here->source;
    Text          text   = {.arena = &here->service->arena};
    text_add_bytes(&text, source->text, at);
    text_add(&text, line->bytes);
    text_add_bytes(&text, source->text + at, number.start - at);
    text_add(&text, name);
    text_add_bytes(&text, source->text + number.end, source->length - number.end);
    return text;
}

/* Finds the line of a param with the first range that makes no mistake; false: a count, for example, cannot be one. */
static bool find_param_line(const Here *here, const Way *way, const char *name, uint32_t at,
                            Text *line)
{
    const Syntax *number    = way->items[way->count - 1];
    const char   *text      = here->source->text + number->span.start;
    const int     length    = (int)(number->span.end - number->span.start);
    const bool    angle     = length > 3 && memcmp(text + length - 3, "deg", 3) == 0;
    const double  value     = angle ? text_decimal(text, (size_t)length - 3) : number->number[0];
    const Reach   reaches[] = {
          {0, 2 * value}, {0.5 * value, 2 * value}, {0.5 * value, angle ? 0.5 * (value + 180) : 1}};
    const size_t before = mistakes_instead(here, here->source->text, here->source->length);
    for (size_t i = 0; i < sizeof reaches / sizeof *reaches; i++) {
        const Reach reach = value > 0 ? reaches[i] : (Reach){-1, 1};
        if (reach.high < value || (value <= 0 && i > 0))
            continue;
        line->length = 0;
        text_format(line, "param %s = %.*s in [", name, length, text);
        text_number(line, reach.low);
        text_add(line, angle ? "deg, " : ", ");
        text_number(line, reach.high);
        text_add(line, angle ? "deg];\n" : "];\n");
        const Text changed = with_param(here, at, line, number->span, name);
        if (mistakes_instead(here, changed.bytes, changed.length) <= before)
            return true;
    }
    return false;
}

static void add_param(const Here *here, const Way *way, Json *json)
{
    const Syntax  *number = way->items[way->count - 1];
    Arena         *arena  = &here->service->arena;
    const char    *use    = purpose(here, way);
    const char    *name   = new_name(here, use && strlen(use) > 1 ? use : "size");
    const uint32_t at     = line_before(here, way->items[1]);
    Text           line = {.arena = arena}, title = {.arena = arena};
    if (!find_param_line(here, way, name, at, &line))
        return;
    text_format(&title, "make this a param, `%s`", name);
    begin_action(here, json, title.bytes, "refactor.extract", NULL);
    add_edit(here, json, at, at, line.bytes);
    add_edit(here, json, number->span.start, number->span.end, name);
    end_action(json);
}

/* ---- an expression becomes a definition ---- */

static bool is_expression(const Syntax *syntax)
{
    return syntax->kind > SYNTAX_BOOLEAN && syntax->kind <= SYNTAX_KRS &&
           syntax->kind != SYNTAX_ARGUMENT && syntax->kind != SYNTAX_FOR_CLAUSE &&
           syntax->kind != SYNTAX_IF_CLAUSE && syntax->kind != SYNTAX_NAME;
}

/* Cuts a way at the node that a selection has from its first to its last character; false: there is none. */
static bool find_selected(const Here *here, Way *way)
{
    const char *text  = here->source->text;
    uint32_t    start = here->offset, end = here->end;
    while (start < end && strchr(" \t\r\n", text[start]))
        start++;
    while (end > start && strchr(" \t\r\n;", text[end - 1]))
        end--;
    *way = find_way(&here->service->arena, here->file->syntax, start);
    if (start == end)
        return false;
    while (way->count > 0 && (way->items[way->count - 1]->span.start != start ||
                              way->items[way->count - 1]->span.end != end ||
                              !is_expression(way->items[way->count - 1])))
        way->count--;
    return way->count > 2;
}

typedef struct Locals {
    const Syntax **items;
    size_t         count, capacity;
} Locals;

/* Returns the names of the expression that are defined around it, and not in the whole file: a loop
   defines its own in itself. */
static Locals locals_of(const Here *here, const Syntax *node)
{
    Locals found = {0};
    for (size_t i = 0; i < here->file->uses.count; i++) {
        const NameUse *use = &here->file->uses.items[i];
        if (use->defines || !use->meaning || use->span.start < node->span.start ||
            use->span.end > node->span.end || use->meaning->span.source != here->file->source)
            continue;
        const Span name = use->meaning->name_span;
        bool       skip = name.start >= node->span.start && name.end <= node->span.end;
        for (uint32_t k = 0; !skip && k < here->file->syntax->count; k++)
            skip = here->file->syntax->children[k] == use->meaning &&
                   use->meaning->kind != SYNTAX_FOR;
        for (size_t k = 0; !skip && k < found.count; k++)
            skip = found.items[k] == use->meaning;
        /* The name of an argument means a parameter of what is called. */
        const char *behind = here->source->text + use->span.end;
        behind += strspn(behind, " \t\r\n");
        if (!skip && !(use->meaning->kind == SYNTAX_PARAMETER && *behind == ':'))
            array_push(&here->service->arena, &found, use->meaning);
    }
    return found;
}

static void add_extraction(const Here *here, const Way *way, Json *json)
{
    const Syntax *node   = way->items[way->count - 1];
    const Locals  locals = locals_of(here, node);
    const char   *name   = new_name(here, "part");
    Arena        *arena  = &here->service->arena;
    Text          line = {.arena = arena}, call = {.arena = arena}, title = {.arena = arena};
    text_format(&title, "extract to `%s`", locals.count ? "def" : "let");
    text_format(&line, "%s %s", locals.count ? "def" : "let", name);
    text_add(&call, name);
    for (size_t i = 0; i < locals.count; i++) {
        text_format(&line, "%s%s", i ? ", " : "(", locals.items[i]->name);
        text_format(&call, "%s%s", i ? ", " : "(", locals.items[i]->name);
    }
    text_add(&line, locals.count ? ") = " : " = ");
    text_add(&call, locals.count ? ")" : "");
    text_add_bytes(&line, here->source->text + node->span.start, node->span.end - node->span.start);
    text_add(&line, ";\n");
    const uint32_t at = line_before(here, way->items[1]);
    begin_action(here, json, title.bytes, "refactor.extract", NULL);
    add_edit(here, json, at, at, line.bytes);
    add_edit(here, json, node->span.start, node->span.end, call.bytes);
    end_action(json);
}

void answer_actions(const Here *here, const ServiceQuestion *about, Json *json)
{
    Way way = find_way(&here->service->arena, here->file->syntax, here->offset);
    json_open(json, NULL, "[");
    for (size_t i = 0; i < about->fix_count; i++)
        add_fix(here, &about->fixes[i], json);
    if (way.items[way.count - 1]->kind == SYNTAX_NUMBER && may_vary(here, &way))
        add_param(here, &way, json);
    if (find_selected(here, &way))
        add_extraction(here, &way, json);
    json_close(json, "]");
}

/* ---- layout ---- */

/* Answers one edit, of what differs; none where the text has mistakes. */
void answer_formatting(const Here *here, const ServiceQuestion *about, Json *json)
{
    const Source *source = here->source;
    Text          text   = {.arena = &here->service->arena};
    (void)about;
    text_add(&text, "");
    json_open(json, NULL, "[");
    if (!has_unread(here->analysis, here->file) &&
        format_source(here->file->source, &here->analysis->sources, &here->service->arena, &text)) {
        uint32_t start = 0, end = source->length, last = (uint32_t)text.length;
        while (start < end && start < last && source->text[start] == text.bytes[start])
            start++;
        while (end > start && last > start && source->text[end - 1] == text.bytes[last - 1]) {
            end--;
            last--;
        }
        /* No edit begins or ends within a character. */
        while (start > 0 && !text_begins_character(source->text[start]))
            start--;
        while (end < source->length && !text_begins_character(source->text[end])) {
            end++;
            last++;
        }
        if (start < end || start < last)
            add_edit(here, json, start, end,
                     arena_copy_text(&here->service->arena, text.bytes + start, last - start));
    }
    json_close(json, "]");
}
