/*
 * complete.c: what may stand at a place: what kind of word that is follows from the tokens before it.
 */
#include <string.h>

#include "compiler/service/completion.h"

/* ---- blocks and statements ---- */

/* Returns the bracket that is open at the place: its number among the tokens; SIZE_MAX: none is. */
static size_t open_bracket(const Completion *c)
{
    size_t depth = 0;
    for (size_t i = c->before ? (size_t)(c->before - c->tokens.items) + 1 : 0; i-- > 0;) {
        const TokenKind kind = c->tokens.items[i].kind;
        if (closes_bracket(kind))
            depth++;
        else if (opens_bracket(kind)) {
            if (depth-- == 0)
                return i;
        }
    }
    return SIZE_MAX;
}

/* Returns the kind of the declaration whose properties or parameters a bracket opens; SYNTAX_ERROR:
   of none. */
static SyntaxKind declaration_of(const Completion *c, size_t bracket)
{
    size_t depth = 0;
    for (size_t i = bracket, steps = 0; i-- > 0 && steps < 1000; steps++) {
        const TokenKind kind = c->tokens.items[i].kind;
        if (kind == TOKEN_RIGHT_PAREN || kind == TOKEN_RIGHT_BRACKET)
            depth++;
        else if ((kind == TOKEN_LEFT_PAREN || kind == TOKEN_LEFT_BRACKET) && depth > 0)
            depth--;
        else if (depth == 0)
            switch (kind) {
            case TOKEN_NAME: break;
            case TOKEN_CAMERA: return SYNTAX_CAMERA;
            case TOKEN_LIGHT: return SYNTAX_LIGHT;
            case TOKEN_SKY: return SYNTAX_SKY;
            case TOKEN_FOG: return SYNTAX_FOG;
            case TOKEN_MEDIUM: return SYNTAX_MEDIUM;
            case TOKEN_IMAGE: return SYNTAX_IMAGE;
            case TOKEN_ZONE: return SYNTAX_ZONE;
            case TOKEN_MATERIAL: return SYNTAX_MATERIAL;
            case TOKEN_SHAPE: return SYNTAX_SHAPE;
            case TOKEN_DEF: return SYNTAX_DEF;
            case TOKEN_KRS: return SYNTAX_KRS;
            default: return SYNTAX_ERROR;
            }
    }
    return SYNTAX_ERROR;
}

/* Tells whether a statement begins at the place. */
static bool begins_statement(const Completion *c, size_t bracket)
{
    if (bracket != SIZE_MAX && c->tokens.items[bracket].kind != TOKEN_LEFT_BRACE)
        return false;
    return !c->before || c->before->kind == TOKEN_SEMICOLON ||
           c->before->kind == TOKEN_LEFT_BRACE || c->before->kind == TOKEN_RIGHT_BRACE;
}

/* Tells whether a new name stands at the place. */
static bool names_something(const Completion *c)
{
    const TokenKind kind = c->before ? c->before->kind : TOKEN_END;
    return kind == TOKEN_LET || kind == TOKEN_DEF || kind == TOKEN_PARAM || kind == TOKEN_SHAPE ||
           kind == TOKEN_MATERIAL || kind == TOKEN_LIGHT || kind == TOKEN_CAMERA ||
           kind == TOKEN_FOR;
}

static bool is_block(SyntaxKind kind)
{
    return kind != SYNTAX_ERROR && kind != SYNTAX_DEF && kind != SYNTAX_KRS;
}

static void complete_word(Completion *c)
{
    const size_t     bracket = open_bracket(c);
    const TokenKind  before  = c->before ? c->before->kind : TOKEN_END;
    const TokenKind  opener  = bracket == SIZE_MAX ? TOKEN_END : c->tokens.items[bracket].kind;
    const SyntaxKind owner   = bracket == SIZE_MAX ? SYNTAX_ERROR : declaration_of(c, bracket);
    if (before == TOKEN_DOT)
        complete_member(c);
    else if (names_something(c))
        return;
    else if (opener == TOKEN_LEFT_BRACE && is_block(owner)) {
        if (before == TOKEN_LEFT_BRACE || before == TOKEN_COMMA)
            complete_property(c, owner);
        else
            complete_expression(c);
    } else if (opener == TOKEN_LEFT_PAREN && before == TOKEN_COLON &&
               (owner == SYNTAX_DEF || owner == SYNTAX_SHAPE || owner == SYNTAX_MATERIAL))
        complete_kind(c);
    else if (begins_statement(c, bracket))
        complete_statement(c, owner);
    else
        complete_expression(c);
}

/* ---- the place ---- */

static bool is_word(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/* Returns what of the line before the place is open there: '"', '/' for a comment, or nothing.
   *from is behind the quote. */
static char open_text(const Completion *c, uint32_t *from)
{
    const char *text = c->here->source->text;
    uint32_t    at   = c->here->source->lines[source_line(c->here->source, c->here->offset) - 1];
    char        open = 0;
    for (; at < c->here->offset; at++) {
        if (open == '"' && text[at] == '\\')
            at++;
        else if (text[at] == '"') {
            open  = open ? 0 : '"';
            *from = at + 1;
        } else if (!open && text[at] == '/' && at + 1 < c->here->offset && text[at + 1] == '/')
            return '/';
    }
    return open;
}

/* Tells whether the place is in a comment of several lines. */
static bool in_comment(const Completion *c)
{
    const char *text = c->here->source->text;
    uint32_t    at   = c->before ? c->before->span.end : 0;
    bool        open = false;
    for (; at + 1 < c->here->offset; at++) {
        if (!open && text[at] == '/' && text[at + 1] == '/')
            at += (uint32_t)strcspn(text + at, "\n");
        else if (text[at] == (open ? '*' : '/') && text[at + 1] == (open ? '/' : '*')) {
            open = !open;
            at++;
        }
    }
    return open;
}

static void set_place(Completion *c)
{
    const char *text = c->here->source->text;
    c->start = c->end = c->here->offset;
    while (c->start > 0 && is_word(text[c->start - 1]))
        c->start--;
    while (c->end < c->here->source->length && is_word(text[c->end]))
        c->end++;
    for (size_t i = 0; i < c->tokens.count && c->tokens.items[i].span.end <= c->start; i++)
        if (c->tokens.items[i].kind != TOKEN_END)
            c->before = &c->tokens.items[i];
    c->seen_capacity = 2048;
    while (c->seen_capacity < 4 * (c->here->file->uses.count + c->tokens.count))
        c->seen_capacity *= 2;
    c->seen = arena_new_array(&c->here->service->arena, const char *, c->seen_capacity);
}

static void complete(Completion *c)
{
    static const char *const units[] = {"deg", NULL};
    const char              *text    = c->here->source->text;
    uint32_t                 from    = 0;
    const char               open    = open_text(c, &from);
    if (open == '/' || in_comment(c))
        return;
    if (open == '"') {
        const char *written = arena_copy_text(&c->here->service->arena, text + from,
                                              c->here->offset - from);
        const bool  use     = c->before && c->before->kind == TOKEN_USE;
        c->start            = from;
        c->end              = c->here->offset;
        if (use)
            complete_library_file(c, written);
        complete_file(c, written, use);
    } else if (c->start > 0 && text[c->start - 1] == '#') {
        c->start--;
        complete_colour(c);
    } else if (c->start < c->here->offset && text[c->start] >= '0' && text[c->start] <= '9') {
        while (c->start < c->here->offset && text[c->start] >= '0' && text[c->start] <= '9')
            c->start++;
        completion_add_words(c, units, ITEM_UNIT);
    } else
        complete_word(c);
}

void answer_completion(const Here *here, const ServiceQuestion *about, Json *json)
{
    Completion c = {.here = here, .json = json, .tokens = here->file->tokens};
    (void)about;
    set_place(&c);
    json_open(json, NULL, "[");
    complete(&c);
    json_close(json, "]");
}
