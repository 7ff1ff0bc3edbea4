/*
 * tokens.c: what colours the words of a text get: by what names mean, where the grammar of an editor sees only words.
 */
#include <stdlib.h>
#include <string.h>

#include "compiler/service/analysis.h"

/* The legend: types and modifiers are told by their numbers. */
typedef enum TokenType {
    TYPE_KEYWORD,
    TYPE_VARIABLE,
    TYPE_PARAMETER,
    TYPE_PROPERTY,
    TYPE_FUNCTION,
    TYPE_METHOD,
    TYPE_CLASS,
    TYPE_STRUCT,
    TYPE_NUMBER,
    TYPE_STRING,
    TYPE_COMMENT,
    TYPE_OPERATOR,
    TYPE_NONE
} TokenType;
enum { MODIFIER_DECLARATION = 1, MODIFIER_LIBRARY = 2 };

void add_token_legend(Json *json, const char *name)
{
    json_ready(json, name,
               "{\"legend\":{\"tokenTypes\":[\"keyword\",\"variable\",\"parameter\",\"property\","
               "\"function\",\"method\",\"class\",\"struct\",\"number\",\"string\",\"comment\","
               "\"operator\"],\"tokenModifiers\":[\"declaration\",\"defaultLibrary\"]},"
               "\"full\":true,\"range\":true}");
}

typedef struct Colours {
    const Here     *here;
    Json           *json;
    const NameUse **uses; /* of the file, by their places */
    size_t          count, next;
    uint32_t        line, line_start;       /* of the last token that was written, */
    uint32_t        told_line, told_column; /* and where that began */
    uint32_t        column_at, column;      /* the column of an offset of the line */
    uint32_t        from, to;               /* what is asked for */
} Colours;

/* ---- writing ---- */

/* Goes on to the line of an offset. */
static void go_to(Colours *c, uint32_t offset)
{
    const Source *source = c->here->source;
    uint32_t      line   = c->line;
    while (line + 1 < source->line_count && source->lines[line + 1] <= offset)
        line++;
    if (line != c->line || c->column_at > offset) {
        c->line      = line;
        c->column_at = source->lines[line];
        c->column    = 0;
    }
    c->column += utf16_units(source->text, c->column_at, offset);
    c->column_at = offset;
}

/* Writes a part of one line. */
static void add_part(Colours *c, uint32_t start, uint32_t end, TokenType type, uint32_t modifiers)
{
    if (end <= start || end <= c->from || start >= c->to)
        return;
    go_to(c, start);
    const uint32_t lines = c->line - c->told_line;
    json_whole(c->json, NULL, lines);
    json_whole(c->json, NULL, lines ? c->column : c->column - c->told_column);
    json_whole(c->json, NULL, utf16_units(c->here->source->text, start, end));
    json_whole(c->json, NULL, type);
    json_whole(c->json, NULL, modifiers);
    c->told_line   = c->line;
    c->told_column = c->column;
}

/* Does the same of what may have several lines. */
static void add_token(Colours *c, uint32_t start, uint32_t end, TokenType type, uint32_t modifiers)
{
    const char *text = c->here->source->text;
    while (start < end) {
        const char *newline = memchr(text + start, '\n', end - start);
        uint32_t    stop    = newline ? (uint32_t)(newline - text) : end;
        uint32_t    last    = stop;
        while (last > start && text[last - 1] == '\r')
            last--;
        add_part(c, start, last, type, modifiers);
        start = newline ? stop + 1 : end;
    }
}

/* ---- comments ---- */

static void add_comments(Colours *c, uint32_t from, uint32_t to)
{
    const char *text = c->here->source->text;
    for (uint32_t at = from; at + 1 < to;) {
        uint32_t end = at;
        if (text[at] == '/' && text[at + 1] == '/')
            while (end < to && text[end] != '\n')
                end++;
        else if (text[at] == '/' && text[at + 1] == '*')
            for (end += 2;
                 end < to && !(text[end - 1] == '/' && text[end - 2] == '*' && end > at + 3);)
                end++;
        if (end > at)
            add_token(c, at, end, TYPE_COMMENT, 0);
        at = end > at ? end : at + 1;
    }
}

/* ---- names ---- */

static int compare_uses(const void *a, const void *b)
{
    const NameUse *left = *(const NameUse *const *)a, *right = *(const NameUse *const *)b;
    return left->span.start < right->span.start ? -1 : left->span.start > right->span.start;
}

static void sort_uses(Colours *c)
{
    const NameUses *uses = &c->here->file->uses;
    c->uses = arena_new_array(&c->here->service->arena, const NameUse *, uses->count + 1);
    for (size_t i = 0; i < uses->count; i++)
        c->uses[i] = &uses->items[i];
    c->count = uses->count;
    qsort(c->uses, c->count, sizeof *c->uses, compare_uses);
}

static const NameUse *use_at(Colours *c, uint32_t offset)
{
    while (c->next < c->count && c->uses[c->next]->span.start < offset)
        c->next++;
    return c->next < c->count && c->uses[c->next]->span.start == offset ? c->uses[c->next] : NULL;
}

static TokenType type_of_meaning(const Syntax *syntax)
{
    switch (syntax->kind) {
    case SYNTAX_DEF: return TYPE_FUNCTION;
    case SYNTAX_SHAPE: return TYPE_CLASS;
    case SYNTAX_MATERIAL: return TYPE_STRUCT;
    case SYNTAX_PARAMETER: return TYPE_PARAMETER;
    default: return TYPE_VARIABLE;
    }
}

/* Adds a name; `next` is the token behind it. */
static void add_name(Colours *c, const Token *token, const Token *before, const Token *next)
{
    const NameUse *use       = use_at(c, token->span.start);
    TokenType      type      = TYPE_VARIABLE;
    uint32_t       modifiers = 0;
    if (use && use->meaning) {
        type      = type_of_meaning(use->meaning);
        modifiers = use->defines ? MODIFIER_DECLARATION : 0;
        if (c->here->analysis->sources.items[use->meaning->span.source].library)
            modifiers |= MODIFIER_LIBRARY;
    } else if (use) {
        modifiers               = MODIFIER_LIBRARY;
        const BuiltinWord *word = find_word(use->name, false);
        type                    = word && is_called(word) ? TYPE_FUNCTION : TYPE_VARIABLE;
    } else if (before && before->kind == TOKEN_DOT)
        type = next->kind == TOKEN_LEFT_PAREN ? TYPE_METHOD : TYPE_PROPERTY;
    else if (next->kind == TOKEN_COLON)
        type = TYPE_PROPERTY;
    else if (strcmp(token->name, "kernel") == 0 || strcmp(token->name, "reflect") == 0 ||
             strcmp(token->name, "mobius") == 0 || strcmp(token->name, "print") == 0 ||
             strcmp(token->name, "assert") == 0)
        type = TYPE_KEYWORD;
    add_token(c, token->span.start, token->span.end, type, modifiers);
}

static TokenType type_of_token(const Token *token, const Token *next)
{
    switch (token->kind) {
    case TOKEN_NUMBER:
    case TOKEN_COLOUR: return TYPE_NUMBER;
    case TOKEN_STRING: return TYPE_STRING;
    case TOKEN_END:
    case TOKEN_ERROR: return TYPE_NONE;
    default: break;
    }
    if (token->kind >= TOKEN_LET &&
        token->kind < TOKEN_LEFT_PAREN) /* a word before `:` is a name */
        return next->kind == TOKEN_COLON ? TYPE_PROPERTY : TYPE_KEYWORD;
    return token->kind >= TOKEN_DOT_DOT && token->kind != TOKEN_DOT ? TYPE_OPERATOR : TYPE_NONE;
}

static void write_tokens(const Here *here, uint32_t from, uint32_t to, Json *json)
{
    const Tokens tokens = here->file->tokens;
    Colours      c      = {.here = here, .json = json, .from = from, .to = to};
    uint32_t     before = here->source->lines[0];
    c.column_at         = before;
    sort_uses(&c);
    json_open(json, NULL, "{");
    json_open(json, "data", "[");
    for (size_t i = 0; i < tokens.count; i++) {
        const Token *token = &tokens.items[i], *next = token + (i + 1 < tokens.count);
        if (token->span.start > before + 1)
            add_comments(&c, before, token->span.start);
        before = token->span.end;
        if (token->kind == TOKEN_NAME)
            add_name(&c, token, i ? token - 1 : NULL, next);
        else if (type_of_token(token, next) != TYPE_NONE)
            add_token(&c, token->span.start, token->span.end, type_of_token(token, next), 0);
    }
    json_close(json, "]");
    json_close(json, "}");
}

void answer_tokens(const Here *here, const ServiceQuestion *about, Json *json)
{
    (void)about;
    write_tokens(here, 0, UINT32_MAX, json);
}

void answer_tokens_of_range(const Here *here, const ServiceQuestion *about, Json *json)
{
    (void)about;
    write_tokens(here, here->offset, here->end, json);
}
