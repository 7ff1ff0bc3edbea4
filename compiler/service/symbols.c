/*
 * symbols.c: what a text defines, as a list; what of it can be folded; what can be selected around a place.
 */
#include <string.h>

#include "compiler/service/analysis.h"

/* ---- symbols ---- */

/* Kinds of symbols of the protocol. */
typedef enum SymbolKind {
    SYMBOL_CLASS    = 5,
    SYMBOL_PROPERTY = 7,
    SYMBOL_FUNCTION = 12,
    SYMBOL_VARIABLE = 13,
    SYMBOL_OBJECT   = 19,
    SYMBOL_STRUCT   = 23,
    SYMBOL_EVENT    = 24
} SymbolKind;

/* Returns the kind of a symbol; 0: a statement that is none. */
static SymbolKind kind_of_symbol(SyntaxKind kind)
{
    switch (kind) {
    case SYNTAX_LET: return SYMBOL_VARIABLE;
    case SYNTAX_DEF: return SYMBOL_FUNCTION;
    case SYNTAX_PARAM: return SYMBOL_PROPERTY;
    case SYNTAX_SHAPE: return SYMBOL_CLASS;
    case SYNTAX_MATERIAL: return SYMBOL_STRUCT;
    case SYNTAX_CAMERA:
    case SYNTAX_LIGHT:
    case SYNTAX_SKY:
    case SYNTAX_FOG:
    case SYNTAX_MEDIUM:
    case SYNTAX_IMAGE:
    case SYNTAX_ZONE: return SYMBOL_OBJECT;
    case SYNTAX_SHOW: return SYMBOL_EVENT;
    default: return 0;
    }
}

/* Returns what of a statement stands in a list: its name, or its word and what follows, on one
   line. */
static const char *title_of(const Here *here, const Syntax *syntax)
{
    enum { LONGEST = 40 };
    if (syntax->name && syntax->kind != SYNTAX_SHOW)
        return syntax->name;
    if (syntax->kind != SYNTAX_SHOW)
        return syntax_kind_name(syntax->kind);
    const char *text   = here->source->text + syntax->span.start;
    size_t      length = strcspn(text, ";\r\n");
    if (length > syntax->span.end - syntax->span.start)
        length = syntax->span.end - syntax->span.start;
    bool cut = length > LONGEST;
    for (length = cut ? LONGEST : length;
         cut && length > 0 && !text_begins_character(text[length]);)
        length--;
    Text title = {.arena = &here->service->arena};
    text_add_bytes(&title, text, length);
    text_add(&title, cut ? " ..." : "");
    return title.bytes;
}

static void add_symbol(const Here *here, const Syntax *syntax, SymbolKind kind, Json *json)
{
    const Span name      = syntax->name ? syntax->name_span : syntax->span;
    Signature  signature = {.label = {.arena = &here->service->arena}};
    if (syntax_is_function(syntax))
        signature_of_function(here->analysis, syntax, &signature);
    json_open(json, NULL, "{");
    json_text(json, "name", title_of(here, syntax));
    json_text(json, "detail",
              signature.label.bytes ? signature.label.bytes : syntax_kind_name(syntax->kind));
    json_whole(json, "kind", kind);
    diag_json_range(json, "range", here->source, syntax->span.start, syntax->span.end);
    diag_json_range(json, "selectionRange", here->source, name.start, name.end);
    json_close(json, "}");
}

/* Adds the symbols of a block, and of the blocks in it. */
static void add_symbols(const Here *here, const Syntax *block, Json *json)
{
    for (uint32_t i = 0; i < block->count; i++) {
        const Syntax    *syntax = block->children[i];
        const SymbolKind kind   = kind_of_symbol(syntax->kind);
        if (kind)
            add_symbol(here, syntax, kind, json);
        else if (syntax->kind == SYNTAX_FOR || syntax->kind == SYNTAX_IF_STATEMENT ||
                 syntax->kind == SYNTAX_BLOCK)
            add_symbols(here, syntax, json);
    }
}

void answer_symbols(const Here *here, const ServiceQuestion *about, Json *json)
{
    (void)about;
    json_open(json, NULL, "[");
    add_symbols(here, here->file->syntax, json);
    json_close(json, "]");
}

/* ---- folding ---- */

static void add_fold(const Source *source, uint32_t start, uint32_t end, const char *kind,
                     bool keeps_last, Json *json)
{
    const uint32_t first = source_line(source, start) - 1;
    uint32_t       last  = source_line(source, end) - 1;
    last -= keeps_last && last > first; /* the line with the bracket that closes */
    if (last <= first)
        return;
    json_open(json, NULL, "{");
    json_whole(json, "startLine", first);
    json_whole(json, "endLine", last);
    if (kind)
        json_text(json, "kind", kind);
    json_close(json, "}");
}

/* Folds the comments between two tokens: lines that follow each other are one. */
static void fold_comments(const Source *source, uint32_t from, uint32_t to, Json *json)
{
    uint32_t begun = UINT32_MAX, end = 0; /* of lines of `//` */
    for (uint32_t at = from; at + 1 < to;) {
        const char *text = source->text + at;
        if (text[0] == '/' && text[1] == '*') {
            const char    *close = strstr(text + 2, "*/");
            const uint32_t stop  = close && close < source->text + to
                                       ? (uint32_t)(close - source->text) + 2
                                       : to;
            add_fold(source, at, stop, "comment", false, json);
            at = stop;
        } else if (text[0] == '/' && text[1] == '/') {
            const char *newline = memchr(text, '\n', to - at);
            begun               = begun == UINT32_MAX ? at : begun;
            end                 = newline ? (uint32_t)(newline - source->text) : to;
            at                  = end;
        } else
            at++;
    }
    if (begun != UINT32_MAX)
        add_fold(source, begun, end ? end - 1 : 0, "comment", false, json);
}

void answer_folding(const Here *here, const ServiceQuestion *about, Json *json)
{
    const Tokens tokens = here->file->tokens;
    uint32_t    *open   = arena_new_array(&here->service->arena, uint32_t, tokens.count + 1);
    size_t       depth  = 0;
    uint32_t     before = 0;
    (void)about;
    json_open(json, NULL, "[");
    for (size_t i = 0; i < tokens.count; i++) {
        const Token *token = &tokens.items[i];
        if (token->span.start > before + 3)
            fold_comments(here->source, before, token->span.start, json);
        before = token->span.end;
        if (opens_bracket(token->kind))
            open[depth++] = token->span.start;
        if (depth > 0 && closes_bracket(token->kind))
            add_fold(here->source, open[--depth], token->span.start, NULL, true, json);
    }
    json_close(json, "]");
}

/* ---- selections ---- */

static void add_selection(const Here *here, const Way *way, size_t count, Json *json)
{
    const Span span = way->items[count - 1]->span;
    json_open(json, count == way->count ? NULL : "parent", "{");
    diag_json_range(json, "range", here->source, span.start, span.end);
    if (count > 1)
        add_selection(here, way, count - 1, json);
    json_close(json, "}");
}

/* Answers the selection of one position. */
void answer_selection(const Here *here, const ServiceQuestion *about, Json *json)
{
    const Way way = find_way(&here->service->arena, here->file->syntax, here->offset);
    (void)about;
    json_open(json, NULL, "[");
    add_selection(here, &way, way.count, json);
    json_close(json, "]");
}
