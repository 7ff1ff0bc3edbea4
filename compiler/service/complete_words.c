/*
 * complete_words.c: words of tables, files and colours that may stand at a place.
 */
#include <string.h>

#include "compiler/base/embedded.h"
#include "compiler/service/completion.h"

void completion_add(const Completion *c, Item item)
{
    Json *json = c->json;
    json_open(json, NULL, "{");
    json_text(json, "label", item.label);
    json_whole(json, "kind", item.kind);
    if (item.detail)
        json_text(json, "detail", item.detail);
    if (item.doc)
        json_text(json, "documentation", item.doc);
    if (item.order) {
        Text sort = {.arena = &c->here->service->arena};
        text_format(&sort, "%c%s", item.order, item.label);
        json_text(json, "sortText", sort.bytes);
    }
    if (item.insert) { /* else the word at the place becomes the label */
        json_text(json, "filterText", item.insert);
        json_open(json, "textEdit", "{");
        diag_json_range(json, "range", c->here->source, c->start, c->end);
        json_text(json, "newText", item.insert);
        json_close(json, "}");
    }
    json_close(json, "}");
}

void completion_add_words(const Completion *c, const char *const *words, ItemKind kind)
{
    for (; *words; words++)
        completion_add(c, (Item){.label = *words, .kind = kind});
}

const char *completion_text(const Completion *c, const char *before, const char *behind)
{
    Text text = {.arena = &c->here->service->arena};
    text_format(&text, "%s%s", before, behind);
    return text.bytes;
}

bool completion_notes(Completion *c, const char *name)
{
    size_t i = ((uintptr_t)name >> 3) & (c->seen_capacity - 1);
    for (; c->seen[i]; i = (i + 1) & (c->seen_capacity - 1))
        if (c->seen[i] == name)
            return false;
    c->seen[i] = name;
    return true;
}

/* ---- tables ---- */

void complete_property(const Completion *c, SyntaxKind block)
{
    const char *name;
    for (size_t i = 0; (name = property_of_block(block, i)) != NULL; i++)
        completion_add(c, (Item){completion_text(c, name, ":"), completion_text(c, name, ": "),
                                 syntax_kind_name(block), NULL, ITEM_PROPERTY, 0});
}

void complete_kind(const Completion *c)
{
    for (int i = 1; i < KIND_COUNT; i++)
        completion_add(c,
                       (Item){.label = parameter_kind_name((ParameterKind)i), .kind = ITEM_KIND});
}

void complete_statement(const Completion *c, SyntaxKind block)
{
    static const char *const of_krs[] = {"kernel", "reflect", "mobius", "let", "for",
                                         "if",     "print",   "assert", NULL};
    static const char *const words[]  = {
         "let",   "def",  "param", "shape", "material", "camera", "light", "sky",    "fog", "medium",
         "image", "zone", "show",  "use",   "for",      "if",     "print", "assert", NULL};
    completion_add_words(c, block == SYNTAX_KRS ? of_krs : words, ITEM_KEYWORD);
}

/* ---- strings ---- */

void complete_library_file(const Completion *c, const char *written)
{
    for (const EmbeddedFile *file = library_files; file->name; file++)
        if (strchr(file->name, '/') && strncmp(file->name, written, strlen(written)) == 0)
            completion_add(c, (Item){file->name, file->name, "library", NULL, ITEM_FILE, 0});
}

static bool ends_in(const char *name, size_t length, const char *ending)
{
    const size_t size = strlen(ending);
    return length >= size && memcmp(name + length - size, ending, size) == 0;
}

void complete_file(const Completion *c, const char *written, bool scenes)
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
            completion_add(
                c, (Item){path.bytes, path.bytes, NULL, NULL, inner ? ITEM_FOLDER : ITEM_FILE, 0});
        names += length + (names[length] == '\n');
    }
}

/* ---- colours ---- */

/* Completes colours of the text and of the library, as they are written. */
void complete_colour(Completion *c)
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
            completion_add(
                c, (Item){hex, hex, let->name, hex, ITEM_COLOUR, file->library ? 'b' : 'a'});
        }
    }
    for (size_t i = 0; i < c->tokens.count; i++) {
        const Token *token = &c->tokens.items[i];
        if (token->kind != TOKEN_COLOUR || token->span.start == c->start)
            continue;
        const char *hex = name_intern((Names *)&a->names, c->here->source->text + token->span.start,
                                      token->span.end - token->span.start);
        if (completion_notes(c, hex))
            completion_add(c, (Item){hex, hex, NULL, hex, ITEM_COLOUR, 'a'});
    }
}
