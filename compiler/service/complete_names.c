/*
 * complete_names.c: names that are known at a place.
 *
 * For names around the place, and for the value in front of a dot, the statement there is read once more, with a name in
 * the place.
 */
#include <string.h>

#include "compiler/front/parse.h"
#include "compiler/service/completion.h"

static const char *signature_text(const Completion *c, const BuiltinWord *word)
{
    Signature signature = {.label = {.arena = &c->here->service->arena}};
    signature_of_word(word, &signature);
    return signature.label.bytes;
}

static ItemKind kind_of_item(const Syntax *syntax)
{
    switch (syntax->kind) {
    case SYNTAX_DEF: return ITEM_FUNCTION;
    case SYNTAX_SHAPE: return ITEM_CLASS;
    case SYNTAX_MATERIAL: return ITEM_STRUCT;
    case SYNTAX_PARAM: return ITEM_PROPERTY;
    default: return ITEM_VARIABLE;
    }
}

static void add_name(Completion *c, const Analysis *a, const Syntax *syntax, char order)
{
    Signature signature = {.label = {.arena = &c->here->service->arena}};
    if (!completion_notes(c, syntax->name))
        return;
    if (syntax_is_function(syntax))
        signature_of_function(a, syntax, &signature);
    completion_add(
        c, (Item){syntax->name, NULL,
                  signature.label.bytes ? signature.label.bytes : syntax_kind_name(syntax->kind),
                  syntax->doc, kind_of_item(syntax), order});
}

/* ---- the statement at the place, with a name there ---- */

static const char placeholder[] = "krs_here";

/* The statement of the file at a place, read by itself. */
typedef struct Probe {
    const Syntax *tree;
    NameUses      uses;
    uint32_t      at; /* where the name stands in it */
    Way           way;
} Probe;

/* Tells whether a statement of the file begins with a token: a word at the beginning of a line. */
static bool begins_in_file(const Completion *c, const Token *token)
{
    const bool word = (token_is_statement_word(token->kind) && token->kind != TOKEN_KRS) ||
                      token->kind == TOKEN_FOR || token->kind == TOKEN_IF;
    return word && (token->span.start == 0 || c->here->source->text[token->span.start - 1] == '\n');
}

/* Finds the number of the token that begins the statement at the place, and the one behind it. */
static void find_statement(const Completion *c, size_t *first, size_t *last)
{
    *first = 0;
    for (*last = 0; c->tokens.items[*last].kind != TOKEN_END; ++*last)
        if (begins_in_file(c, &c->tokens.items[*last])) {
            if (c->tokens.items[*last].span.start >= c->end)
                break;
            *first = *last;
        }
}

/* Adds the brackets that close what is open at the place. */
static void add_closers(const Completion *c, size_t first, Text *out)
{
    struct {
        TokenKind *items;
        size_t     count, capacity;
    } open       = {0};
    Arena *arena = &c->here->service->arena;
    for (size_t i = first; i < c->tokens.count && c->tokens.items[i].span.end <= c->start; i++) {
        const TokenKind kind = c->tokens.items[i].kind;
        if (opens_bracket(kind))
            array_push(arena, &open, kind);
        else if (open.count > 0 && closes_bracket(kind))
            open.count--;
    }
    while (open.count > 0) {
        const TokenKind kind = open.items[--open.count];
        text_add(out, kind == TOKEN_LEFT_PAREN ? ")" : kind == TOKEN_LEFT_BRACKET ? "]" : ";}");
    }
    text_add(out, ";");
}

static void read_text(const Completion *c, const Text *text, Probe *probe)
{
    Analysis      *a      = c->here->analysis;
    Arena         *arena  = &c->here->service->arena;
    Diags          diags  = {.arena = arena, .sources = &a->sources};
    const uint32_t source = source_add(&a->sources, "", text->bytes, text->length, false);
    const Tokens   tokens = lex(source, &a->sources, &a->names, &diags, arena);
    probe->uses           = (NameUses){0};
    probe->tree           = parse(&tokens, &diags, arena);
    probe->way            = find_way(arena, probe->tree, probe->at + 1);
    names_check(probe->tree, &(NameScope){.incomplete = true}, &diags, arena, &probe->uses, arena);
}

/* Reads the statement with a name in the place.  Where that is not read, nothing behind the place counts, and what is open
   is closed. */
static Probe read_probe(const Completion *c)
{
    const Source *source = c->here->source;
    Probe         probe  = {0};
    size_t        first, last;
    find_statement(c, &first, &last);
    const uint32_t from = c->tokens.items[first].span.start < c->start
                              ? c->tokens.items[first].span.start
                              : c->start;
    const uint32_t to   = c->tokens.items[last].span.start;
    for (int closed = 0; closed < 2; closed++) {
        Text text = {.arena = &c->here->service->arena};
        text_add_bytes(&text, source->text + from, c->start - from);
        probe.at = (uint32_t)text.length;
        text_add(&text, placeholder);
        if (closed)
            add_closers(c, first, &text);
        else if (to > c->end)
            text_add_bytes(&text, source->text + c->end, to - c->end);
        read_text(c, &text, &probe);
        const Syntax *node = probe.way.items[probe.way.count - 1];
        if (node->name && node->name_span.start == probe.at)
            break;
    }
    return probe;
}

/* ---- names of the place ---- */

static void add_names_of(Completion *c, const File *file, char order, bool all)
{
    for (uint32_t i = 0; i < file->syntax->count; i++) {
        const Syntax *syntax = file->syntax->children[i];
        if (syntax_defines(syntax) && (all || syntax->name[0] != '_'))
            add_name(c, c->here->analysis, syntax, order);
    }
}

/* Adds all names that an expression at the place may use, the nearest first. */
static void add_names(Completion *c)
{
    const Analysis *a     = c->here->analysis;
    const Probe     probe = read_probe(c);
    for (size_t i = probe.uses.count; i-- > 0;) {
        const NameUse *use = &probe.uses.items[i];
        if (use->defines && use->seen.end != UINT32_MAX && use->seen.start <= probe.at &&
            probe.at <= use->seen.end)
            add_name(c, a, use->meaning, 'a');
    }
    add_names_of(c, c->here->file, 'b', true);
    for (size_t i = 0; i < c->here->file->used.count; i++)
        add_names_of(c, c->here->file->used.items[i], 'c', false);
    for (const BuiltinWord *word = builtin_words; word->name; word++)
        if (word->parameters && !is_method(word) &&
            completion_notes(c, name_intern((Names *)&a->names, word->name, strlen(word->name))))
            completion_add(c, (Item){word->name, NULL, signature_text(c, word), word->meaning,
                                     is_called(word) ? ITEM_FUNCTION : ITEM_CONSTANT, 'd'});
    for (size_t i = 0; i < a->files.count; i++)
        if (a->files.items[i]->library)
            add_names_of(c, a->files.items[i], 'd', false);
}

/* ---- behind a dot ---- */

static void add_methods(const Completion *c)
{
    for (const BuiltinWord *word = builtin_words; word->name; word++)
        if (is_method(word))
            completion_add(c, (Item){word->name, NULL, signature_text(c, word), word->meaning,
                                     ITEM_METHOD, 0});
}

static void add_record(const Completion *c, const Record *record)
{
    for (size_t i = 0; i < record->count; i++)
        completion_add(c, (Item){.label = record->names[i].string, .kind = ITEM_FIELD});
}

static void add_members_of(const Completion *c, const Asked *asked)
{
    static const char *const of_points[] = {"x", "y", "z", "w"}, *const of_colours[] = {"r", "g",
                                                                                        "b", "a"};
    static const char *const of_maps[] = {"inverse", NULL}, *const of_textures[] = {"alpha", "size",
                                                                                    NULL};
    static const char *const of_functions[] = {"repeat", "repeat_polar", NULL};
    const uint32_t           size           = ask_size(asked->asking, asked->value);
    switch (asked->value.type) {
    case VALUE_MAP: completion_add_words(c, of_maps, ITEM_METHOD); return;
    case VALUE_TEXTURE: completion_add_words(c, of_textures, ITEM_METHOD); return;
    case VALUE_FUNCTION: completion_add_words(c, of_functions, ITEM_METHOD); return;
    case VALUE_RECORD: add_record(c, asked->value.record); return;
    case VALUE_SHAPE:
    case VALUE_ERROR: add_methods(c); return;
    default: break;
    }
    for (uint32_t i = 0; size >= 2 && i < size; i++) {
        completion_add(c,
                       (Item){.label = of_points[i], .kind = ITEM_FIELD, .order = (char)('a' + i)});
        completion_add(
            c, (Item){.label = of_colours[i], .kind = ITEM_FIELD, .order = (char)('f' + i)});
    }
}

void complete_member(const Completion *c)
{
    const Probe   probe    = read_probe(c);
    Way           receiver = probe.way;
    const Syntax *member   = receiver.items[receiver.count - 1];
    if (member->kind == SYNTAX_METHOD && member->name_span.start == probe.at)
        array_push(&c->here->service->arena, &receiver, member->children[0]);
    else
        receiver.count = 0;
    const Asked asked = value_on(c->here, &receiver);
    add_members_of(c, &asked);
}

/* ---- where names of values stand ---- */

void complete_expression(Completion *c)
{
    static const char *const words[] = {"if", "let", "krs", "not", "true", "false", NULL};
    CallHere                 call;
    Signature                signature;
    const TokenKind          before = c->before ? c->before->kind : TOKEN_END;
    if ((before == TOKEN_LEFT_PAREN || before == TOKEN_COMMA) &&
        find_call(&c->tokens, c->start, &call) && find_signature(c->here, &call, &signature))
        for (size_t i = 0; i < signature.count; i++)
            completion_add(c, (Item){completion_text(c, signature.items[i].name, ":"),
                                     completion_text(c, signature.items[i].name, ": "),
                                     signature.label.bytes, NULL, ITEM_PROPERTY, '_'});
    add_names(c);
    completion_add_words(c, words, ITEM_KEYWORD);
}
