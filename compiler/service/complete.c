/*
 * complete.c: what may stand at a place.
 *
 * What kind of word that is follows from the tokens before it.  For names around the place, and for the value in front of
 * a dot, the statement there is read once more, with a name in the place.
 */
#include <string.h>

#include "compiler/base/embedded.h"
#include "compiler/front/parse.h"
#include "compiler/service/analysis.h"

/* Kinds of items of the protocol. */
typedef enum ItemKind {
    ITEM_METHOD   = 2,
    ITEM_FUNCTION = 3,
    ITEM_FIELD    = 5,
    ITEM_VARIABLE = 6,
    ITEM_CLASS    = 7,
    ITEM_PROPERTY = 10,
    ITEM_UNIT     = 11,
    ITEM_KEYWORD  = 14,
    ITEM_COLOUR   = 16,
    ITEM_FILE     = 17,
    ITEM_FOLDER   = 19,
    ITEM_CONSTANT = 21,
    ITEM_STRUCT   = 22,
    ITEM_KIND     = 25
} ItemKind;

typedef struct Completion {
    const Here  *here;
    Json        *json;
    Tokens       tokens;
    const Token *before;     /* the last token in front of the word, or NULL */
    uint32_t     start, end; /* of the word that is being written */
    const char **seen;       /* names that were added: a hash table by address */
    size_t       seen_capacity;
} Completion;

typedef struct Item {
    const char *label, *insert, *detail, *doc;
    ItemKind    kind;
    char        order; /* letters, those that are nearer first */
} Item;

static void add_item(const Completion *c, Item item)
{
    Json *json = c->json;
    json_open(json, NULL, "{");
    json_string(json, "label", item.label);
    json_whole(json, "kind", item.kind);
    if (item.detail)
        json_string(json, "detail", item.detail);
    if (item.doc)
        json_string(json, "documentation", item.doc);
    if (item.order) {
        Text sort = {.arena = &c->here->service->arena};
        text_format(&sort, "%c%s", item.order, item.label);
        json_string(json, "sortText", sort.bytes);
    }
    if (item.insert) { /* else the word at the place becomes the label */
        json_string(json, "filterText", item.insert);
        json_open(json, "textEdit", "{");
        diag_json_range(json, "range", c->here->source, c->start, c->end);
        json_string(json, "newText", item.insert);
        json_close(json, "}");
    }
    json_close(json, "}");
}

/* ---- words of tables ---- */

static const char *signature_text(const Completion *c, const BuiltinWord *word)
{
    Signature signature = {.label = {.arena = &c->here->service->arena}};
    signature_of_word(word, &signature);
    return signature.label.bytes;
}

static void add_methods(const Completion *c)
{
    for (const BuiltinWord *word = builtin_words; word->name; word++)
        if (is_method(word))
            add_item(c, (Item){word->name, NULL, signature_text(c, word), word->meaning,
                               ITEM_METHOD, 0});
}

static void add_words(const Completion *c, const char *const *words, ItemKind kind)
{
    for (; *words; words++)
        add_item(c, (Item){.label = *words, .kind = kind});
}

static const char *text_with(const Completion *c, const char *before, const char *behind)
{
    Text text = {.arena = &c->here->service->arena};
    text_format(&text, "%s%s", before, behind);
    return text.bytes;
}

/* ---- names ---- */

/* Tells whether a name is new, and notes it. */
static bool note_name(Completion *c, const char *name)
{
    size_t i = ((uintptr_t)name >> 3) & (c->seen_capacity - 1);
    for (; c->seen[i]; i = (i + 1) & (c->seen_capacity - 1))
        if (c->seen[i] == name)
            return false;
    c->seen[i] = name;
    return true;
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
    if (!note_name(c, syntax->name))
        return;
    if (syntax_is_function(syntax))
        signature_of_function(a, syntax, &signature);
    add_item(c,
             (Item){syntax->name, NULL,
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

/* Brackets that close what is open at the place. */
static void add_closers(const Completion *c, size_t first, Text *out)
{
    struct {
        TokenKind *items;
        size_t     count, capacity;
    } open       = {0};
    Arena *arena = &c->here->service->arena;
    for (size_t i = first; i < c->tokens.count && c->tokens.items[i].span.end <= c->start; i++) {
        const TokenKind kind = c->tokens.items[i].kind;
        if (kind == TOKEN_LEFT_PAREN || kind == TOKEN_LEFT_BRACKET || kind == TOKEN_LEFT_BRACE)
            array_push(arena, &open, kind);
        else if (open.count > 0 && (kind == TOKEN_RIGHT_PAREN || kind == TOKEN_RIGHT_BRACKET ||
                                    kind == TOKEN_RIGHT_BRACE))
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
            note_name(c, name_intern((Names *)&a->names, word->name, strlen(word->name))))
            add_item(c, (Item){word->name, NULL, signature_text(c, word), word->meaning,
                               is_called(word) ? ITEM_FUNCTION : ITEM_CONSTANT, 'd'});
    for (size_t i = 0; i < a->files.count; i++)
        if (a->files.items[i]->library)
            add_names_of(c, a->files.items[i], 'd', false);
}

/* ---- behind a dot ---- */

static void add_record(const Completion *c, const Record *record)
{
    for (size_t i = 0; i < record->count; i++)
        add_item(c, (Item){.label = record->names[i].string, .kind = ITEM_FIELD});
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
    case VALUE_MAP: add_words(c, of_maps, ITEM_METHOD); return;
    case VALUE_TEXTURE: add_words(c, of_textures, ITEM_METHOD); return;
    case VALUE_FUNCTION: add_words(c, of_functions, ITEM_METHOD); return;
    case VALUE_RECORD: add_record(c, asked->value.record); return;
    case VALUE_SHAPE:
    case VALUE_ERROR: add_methods(c); return;
    default: break;
    }
    for (uint32_t i = 0; size >= 2 && i < size; i++) {
        add_item(c, (Item){.label = of_points[i], .kind = ITEM_FIELD, .order = (char)('a' + i)});
        add_item(c, (Item){.label = of_colours[i], .kind = ITEM_FIELD, .order = (char)('f' + i)});
    }
}

static void complete_member(const Completion *c)
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

static void complete_expression(Completion *c)
{
    static const char *const words[] = {"if", "let", "krs", "not", "true", "false", NULL};
    CallHere                 call;
    Signature                signature;
    const TokenKind          before = c->before ? c->before->kind : TOKEN_END;
    if ((before == TOKEN_LEFT_PAREN || before == TOKEN_COMMA) &&
        find_call(&c->tokens, c->start, &call) && find_signature(c->here, &call, &signature))
        for (size_t i = 0; i < signature.count; i++)
            add_item(c, (Item){text_with(c, signature.items[i].name, ":"),
                               text_with(c, signature.items[i].name, ": "), signature.label.bytes,
                               NULL, ITEM_PROPERTY, '_'});
    add_names(c);
    add_words(c, words, ITEM_KEYWORD);
}

/* ---- strings ---- */

static void add_library(const Completion *c, const char *written)
{
    for (const EmbeddedFile *file = library_files; file->name; file++)
        if (strchr(file->name, '/') && strncmp(file->name, written, strlen(written)) == 0)
            add_item(c, (Item){file->name, file->name, "library", NULL, ITEM_FILE, 0});
}

static bool ends_in(const char *name, size_t length, const char *ending)
{
    const size_t size = strlen(ending);
    return length >= size && memcmp(name + length - size, ending, size) == 0;
}

/* Adds files in the folder that is written so far: scenes for a `use`, others for anything else. */
static void add_files(const Completion *c, const char *written, bool scenes)
{
    Service    *s      = c->here->service;
    Text        folder = {.arena = &s->arena};
    const char *own    = c->here->document->path;
    const char *slash = strrchr(own, '/'), *last = strrchr(written, '/');
    if (!s->host.list)
        return;
    if (written[0] != '/' && slash)
        text_add_bytes(&folder, own, (size_t)(slash - own) + 1);
    text_add_bytes(&folder, written, last ? (size_t)(last - written) + 1 : 0);
    const char *names = s->host.list(s->host.user, folder.bytes ? folder.bytes : "");
    while (names && *names) {
        const size_t length = strcspn(names, "\n");
        const bool   inner  = length > 0 && names[length - 1] == '/';
        Text         path   = {.arena = &s->arena};
        text_add_bytes(&path, written, last ? (size_t)(last - written) + 1 : 0);
        text_add_bytes(&path, names, length);
        const bool scene = ends_in(names, length, ".krs");
        if (length > 0 && (inner || scene == scenes))
            add_item(
                c, (Item){path.bytes, path.bytes, NULL, NULL, inner ? ITEM_FOLDER : ITEM_FILE, 0});
        names += length + (names[length] == '\n');
    }
}

/* ---- colours ---- */

/* Completes colours of the text and of the library, as they are written. */
static void complete_colour(Completion *c)
{
    const Analysis *a = c->here->analysis;
    for (size_t i = 0; i < a->files.count; i++) {
        const File   *file   = a->files.items[i];
        const Source *source = &a->sources.items[file->source];
        for (uint32_t k = 0; k < file->syntax->count; k++) {
            const Syntax *let = file->syntax->children[k];
            if (let->kind != SYNTAX_LET || let->children[0]->kind != SYNTAX_COLOUR)
                continue;
            const Span  span = let->children[0]->span;
            const char *hex  = arena_copy_text(&c->here->service->arena, source->text + span.start,
                                               span.end - span.start);
            add_item(c, (Item){hex, hex, let->name, hex, ITEM_COLOUR, file->library ? 'b' : 'a'});
        }
    }
    for (size_t i = 0; i < c->tokens.count; i++) {
        const Token *token = &c->tokens.items[i];
        if (token->kind != TOKEN_COLOUR || token->span.start == c->start)
            continue;
        const char *hex = name_intern((Names *)&a->names, c->here->source->text + token->span.start,
                                      token->span.end - token->span.start);
        if (note_name(c, hex))
            add_item(c, (Item){hex, hex, NULL, hex, ITEM_COLOUR, 'a'});
    }
}

/* ---- blocks and statements ---- */

/* Returns the bracket that is open at the place: its number among the tokens; SIZE_MAX: none is. */
static size_t open_bracket(const Completion *c)
{
    size_t depth = 0;
    for (size_t i = c->before ? (size_t)(c->before - c->tokens.items) + 1 : 0; i-- > 0;) {
        const TokenKind kind = c->tokens.items[i].kind;
        if (kind == TOKEN_RIGHT_BRACE || kind == TOKEN_RIGHT_PAREN || kind == TOKEN_RIGHT_BRACKET)
            depth++;
        else if (kind == TOKEN_LEFT_BRACE || kind == TOKEN_LEFT_PAREN ||
                 kind == TOKEN_LEFT_BRACKET) {
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

static void complete_property(const Completion *c, SyntaxKind block)
{
    const char *name;
    for (size_t i = 0; (name = property_of_block(block, i)) != NULL; i++)
        add_item(c, (Item){text_with(c, name, ":"), text_with(c, name, ": "),
                           syntax_kind_name(block), NULL, ITEM_PROPERTY, 0});
}

static void complete_kind(const Completion *c)
{
    for (int i = 1; i < KIND_COUNT; i++)
        add_item(c, (Item){.label = parameter_kind_name((ParameterKind)i), .kind = ITEM_KIND});
}

static void complete_statement(const Completion *c, SyntaxKind block)
{
    static const char *const of_krs[] = {"kernel", "reflect", "mobius", "let", "for",
                                         "if",     "print",   "assert", NULL};
    static const char *const words[]  = {"let",   "def", "param", "shape", "material", "camera",
                                         "light", "sky", "fog",   "image", "zone",     "show",
                                         "use",   "for", "if",    "print", "assert",   NULL};
    add_words(c, block == SYNTAX_KRS ? of_krs : words, ITEM_KEYWORD);
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
            add_library(c, written);
        add_files(c, written, use);
    } else if (c->start > 0 && text[c->start - 1] == '#') {
        c->start--;
        complete_colour(c);
    } else if (c->start < c->here->offset && text[c->start] >= '0' && text[c->start] <= '9') {
        while (c->start < c->here->offset && text[c->start] >= '0' && text[c->start] <= '9')
            c->start++;
        add_words(c, units, ITEM_UNIT);
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
