/*
 * hover.c: what is shown of what the mouse points at: how it is written, what it is for, its value.
 */
#include <string.h>

#include "compiler/service/analysis.h"

/* ---- pieces ---- */

static void add_code(const char *code, Text *out) { text_format(out, "```krs\n%s\n```\n", code); }

static void add_paragraph(const char *text, Text *out)
{
    if (text && *text)
        text_format(out, "\n%s\n", text);
}

static void add_value(Asked asked, Text *out)
{
    Text text = {.arena = out->arena};
    ask_text(asked.asking, asked.value, &text);
    if (text.length)
        text_format(out, "\n= %s\n", text.bytes);
}

/* Adds a picture of a colour, 0xrrggbb, with its linear components. */
static void add_swatch(uint32_t rgb, Text *out)
{
    double linear[3];
    linear_from_srgb(rgb, linear);
    text_format(
        out,
        "\n![#%06x](data:image/svg+xml,%%3Csvg%%20xmlns='http://www.w3.org/2000/svg'%%20"
        "width='48'%%20height='24'%%3E%%3Crect%%20width='48'%%20height='24'%%20fill='%%23%06x'"
        "/%%3E%%3C/svg%%3E)\n\nlinear [%.3g, %.3g, %.3g]\n",
        rgb, rgb, linear[0], linear[1], linear[2]);
}

/* Finds the colour that a definition gives a name, as it is written; false: none. */
static bool find_colour(const Here *here, const Syntax *definition, uint32_t *rgb)
{
    const Syntax *value = definition->count ? definition->children[0] : NULL;
    const char   *text  = here->analysis->sources.items[definition->span.source].text;
    if (!value || value->kind != SYNTAX_COLOUR)
        return false;
    *rgb = 0;
    for (uint32_t i = value->span.start + 1; i < value->span.end; i++) {
        const char digit = text[i];
        *rgb             = 16 * *rgb + (uint32_t)(digit <= '9' ? digit - '0' : (digit & 31) + 9);
    }
    return true;
}

/* ---- what is defined ---- */

/* Adds how a definition is written, without the body of what is called. */
static void add_head(const Here *here, const Syntax *syntax, Text *out)
{
    enum { LONGEST = 300 };
    Text head = {.arena = out->arena};
    if (syntax->kind == SYNTAX_FOR_CLAUSE)
        text_add(&head, "for ");
    else if (syntax->kind == SYNTAX_LET_IN)
        text_add(&head, "let ");
    else if (syntax->kind != SYNTAX_PARAMETER)
        text_format(&head, "%s ", syntax_kind_name(syntax->kind));
    if (syntax_is_function(syntax)) {
        Signature signature = {.label = {.arena = out->arena}};
        signature_of_function(here->analysis, syntax, &signature);
        text_add(&head, signature.label.bytes);
    } else if (syntax->kind == SYNTAX_MATERIAL || syntax->kind == SYNTAX_CAMERA ||
               syntax->kind == SYNTAX_LIGHT)
        text_add(&head, syntax->name);
    else {
        const char *text  = here->analysis->sources.items[syntax->span.source].text;
        uint32_t    start = syntax->name_span.start, end = syntax->span.end;
        if (syntax->kind == SYNTAX_FOR || syntax->kind == SYNTAX_LET_IN)
            end = syntax->children[0]->span.end;
        while (end > start && (text[end - 1] == ';' || text[end - 1] == ' '))
            end--;
        const bool cut = end - start > LONGEST;
        for (end = cut ? start + LONGEST : end; cut && !text_begins_character(text[end]);)
            end--;
        text_add_bytes(&head, text + start, end - start);
        text_add(&head, cut ? " ..." : "");
    }
    add_code(head.bytes, out);
}

/* Tells whether a definition is its own value: a number or a text. */
static bool is_literal(const Syntax *syntax)
{
    const SyntaxKind value = syntax->count > 0 ? syntax->children[0]->kind : SYNTAX_ERROR;
    return syntax->kind == SYNTAX_LET &&
           (value == SYNTAX_NUMBER || value == SYNTAX_STRING || value == SYNTAX_BOOLEAN);
}

static void add_definition(const Here *here, const Syntax *syntax, Text *out)
{
    uint32_t rgb;
    add_head(here, syntax, out);
    add_paragraph(syntax->doc, out);
    const Source *source = &here->analysis->sources.items[syntax->span.source];
    if (syntax->span.source != here->file->source)
        text_format(out, "\nof `%s`\n", source->name);
    if (find_colour(here, syntax, &rgb))
        add_swatch(rgb, out);
    else if (!syntax_is_function(syntax) && !is_literal(syntax))
        add_value(value_of(here, syntax), out);
}

static void add_builtin(const Here *here, const BuiltinWord *word, Text *out)
{
    Signature signature = {.label = {.arena = &here->service->arena}};
    signature_of_word(word, &signature);
    add_code(signature.label.bytes, out);
    add_paragraph(word->meaning, out);
}

/* ---- what is neither ---- */

/* Adds a number in degrees, in radians. */
static bool add_angle(const Here *here, const Token *token, Text *out)
{
    const char *text = here->source->text + token->span.start;
    size_t      size = token->span.end - token->span.start;
    if (size < 4 || memcmp(text + size - 3, "deg", 3) != 0)
        return false;
    Text code = {.arena = &here->service->arena};
    text_add_bytes(&code, text, size);
    add_code(code.bytes, out);
    text_add(out, "\n= ");
    text_number(out, token->number);
    text_add(out, " in radians\n");
    return true;
}

/* Adds what stands behind a dot: a method of shapes, or a part of what is before it; with its
   value. */
static bool add_member(const Here *here, const Way *way, size_t at, Text *out)
{
    const BuiltinWord *word = find_word(way->items[at]->name, true);
    Way                part = {way->items, at + 1, way->capacity};
    if (word)
        add_builtin(here, word, out);
    else
        add_code(way->items[at]->name, out);
    add_value(value_on(here, &part), out);
    return true;
}

static bool add_property(const Here *here, const Way *way, size_t at, Text *out)
{
    const Syntax *property = way->items[at], *block = at ? way->items[at - 1] : NULL;
    Text          head = {.arena = &here->service->arena};
    Way           part = {0};
    if (!block)
        return false;
    text_format(&head, "%s { %s: }", syntax_kind_name(block->kind), property->name);
    add_code(head.bytes, out);
    for (size_t i = 0; i <= at; i++)
        array_push(&here->service->arena, &part, way->items[i]);
    array_push(&here->service->arena, &part, property->children[0]);
    add_value(value_on(here, &part), out);
    return true;
}

/* Adds what is known of a name behind a dot or of a property, which is no name of a value. */
static bool add_label(const Here *here, Text *out, Span *span)
{
    const Way way = find_way(&here->service->arena, here->file->syntax, here->offset);
    for (size_t i = way.count; i-- > 0;) {
        const Syntax *node = way.items[i];
        if (!node->name || !span_has(node->name_span, here->offset))
            continue;
        *span = node->name_span;
        if (node->kind == SYNTAX_METHOD)
            return add_member(here, &way, i, out);
        if (node->kind == SYNTAX_PROPERTY)
            return add_property(here, &way, i, out);
    }
    return false;
}

static bool add_token(const Here *here, Text *out, Span *span)
{
    const Tokens tokens = here->file->tokens;
    const Token *token  = find_pointed(&tokens, here->offset);
    Meaning      meaning;
    if (!token)
        return false;
    *span = token->span;
    if (token->kind == TOKEN_COLOUR)
        return add_swatch(token->rgb, out), true;
    if (token->kind == TOKEN_NUMBER)
        return add_angle(here, token, out);
    if (token->kind != TOKEN_NAME ||
        !find_meaning(here->analysis, token->name, here->offset, &meaning))
        return false;
    if (meaning.syntax)
        add_definition(here, meaning.syntax, out);
    else
        add_builtin(here, meaning.word, out);
    return true;
}

/* ---- the answer ---- */

static bool write_hover(const Here *here, Text *out, Span *span)
{
    const NameUse *use = find_use(here->file, here->offset);
    if (!use)
        return add_label(here, out, span) || add_token(here, out, span);
    *span = use->span;
    if (use->meaning)
        add_definition(here, use->meaning, out);
    else if (find_word(use->name, false))
        add_builtin(here, find_word(use->name, false), out);
    return out->length > 0;
}

void answer_hover(const Here *here, const ServiceQuestion *about, Json *json)
{
    Text text = {.arena = &here->service->arena};
    Span span;
    (void)about;
    if (!write_hover(here, &text, &span)) {
        json_text(json, NULL, NULL);
        return;
    }
    json_open(json, NULL, "{");
    json_open(json, "contents", "{");
    json_text(json, "kind", "markdown");
    json_text(json, "value", text.bytes);
    json_close(json, "}");
    diag_json_range(json, "range", here->source, span.start, span.end);
    json_close(json, "}");
}
