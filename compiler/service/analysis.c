/*
 * analysis.c: documents that are open, and what is known of each.
 */
#include "compiler/service/analysis.h"

#include <stdlib.h>
#include <string.h>

#include "compiler/base/paths.h"
#include "compiler/eval/elaborate.h"

/* ---- texts ---- */

Document *find_document(const Service *service, const char *path)
{
    Document *document = service->documents;
    while (document && strcmp(document->path, path) != 0)
        document = document->next;
    return document;
}

/* Supplies a text; those of documents come before those of files. */
static const char *supply(void *user, const char *path, size_t *length)
{
    Service        *service  = user;
    const Document *document = find_document(service, path);
    if (document && document == service->probed) {
        *length = service->probe_length;
        return service->probe_text;
    }
    if (document) {
        *length = document->length;
        return document->text;
    }
    if (service->host.read)
        return service->host.read(service->host.user, path, length);
    const Loaded loaded = disk_read(path);
    const char  *text   = NULL;
    if (loaded.text && loaded.length <= MAX_SOURCE_BYTES) {
        text    = arena_copy_text(&service->arena, loaded.text, loaded.length);
        *length = loaded.length;
    }
    free(loaded.owned);
    return text;
}

/* ---- reading ---- */

static void begin(Service *service, Analysis *a)
{
    *a         = (Analysis){.made = true};
    a->arena   = (Arena){.memory = &service->memory};
    a->trees   = a->arena;
    a->scratch = a->arena;
    a->sources = (Sources){.arena = &a->arena};
    a->names   = (Names){.arena = &a->arena};
    a->diags   = (Diags){.arena = &a->arena, .sources = &a->sources};
    a->loader  = (Loader){.supplier = supply, .user = service, .root = -1};
    a->files   = (Files){.arena      = &a->arena,
                         .trees      = &a->trees,
                         .scratch    = &a->scratch,
                         .diags      = &a->diags,
                         .names      = &a->names,
                         .sources    = &a->sources,
                         .loader     = &a->loader,
                         .tells_uses = true};
}

void analysis_free(Analysis *a)
{
    arena_free(&a->arena);
    arena_free(&a->trees);
    arena_free(&a->scratch);
    *a = (Analysis){0};
}

static void read_files(Service *service, Analysis *a, const char *path, const char *text,
                       size_t length)
{
    const char *builtin[MAX_BUILTIN_NAMES];
    begin(service, a);
    source_add(&a->sources, "", "", 0, true); /* source 0: no place */
    files_load(&a->files, path, text, length);
    files_lex(&a->files);
    files_parse(&a->files);
    files_load_used(&a->files);
    files_check_names(&a->files, builtin, builtin_names(builtin, MAX_BUILTIN_NAMES));
    arena_free(&a->scratch);
    diags_sort(&a->diags);
}

Analysis *analyse(Service *service, Document *document)
{
    Analysis *a = &document->analysis;
    if (!a->made)
        read_files(service, a, document->path, document->text, document->length);
    return a;
}

Analysis *analyse_instead(Service *service, const Document *document, const char *text,
                          size_t length)
{
    analysis_free(&service->probe);
    read_files(service, &service->probe, document->path, text, length);
    return &service->probe;
}

static bool ends_with(const char *name, size_t length, const char *ending)
{
    return length > strlen(ending) &&
           memcmp(name + length - strlen(ending), ending, strlen(ending)) == 0;
}

static void add_neighbour(Service *service, const char *path, const char *wanted)
{
    size_t      length;
    const char *text = find_document(service, path) ? NULL : supply(service, path, &length);
    if (!text || !memmem(text, length, wanted, strlen(wanted)))
        return;
    Document *found = calloc(1, sizeof *found);
    if (found) {
        found->path         = strdup(path);
        found->text         = strndup(text, length);
        found->length       = found->text ? strlen(found->text) : 0;
        found->next         = service->neighbours;
        service->neighbours = found;
    }
    if (found && (!found->path || !found->text)) {
        service->neighbours = found->next;
        found->next         = NULL;
        documents_free(&found);
    }
}

Document *find_neighbours(Service *service, const char *path)
{
    enum { MOST = 500 };
    const char  *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const size_t start  = (size_t)(name - path);
    const char  *folder = arena_copy_text(&service->arena, path, start > 1 ? start - 1 : start);
    const char  *names = service->host.list ? service->host.list(service->host.user, folder) : NULL;
    names = names && !service->neighbours ? arena_copy_text(&service->arena, names, strlen(names))
                                          : "";
    for (int count = 0; *names && count < MOST; count++) {
        const size_t length = strcspn(names, "\n");
        Text         own    = {.arena = &service->arena};
        text_add_bytes(&own, path, start);
        text_add_bytes(&own, names, length);
        if (ends_with(names, length, ".krs"))
            add_neighbour(service, own.bytes, name);
        names += length + (names[length] == '\n');
    }
    return service->neighbours;
}

void documents_free(Document **documents)
{
    while (*documents) {
        Document *document = *documents;
        *documents         = document->next;
        analysis_free(&document->analysis);
        free(document->path);
        free(document->uri);
        free(document->text);
        free(document);
    }
}

const File *file_of(const Analysis *a, uint32_t source)
{
    for (size_t i = 0; i < a->files.count; i++)
        if (a->files.items[i]->source == source)
            return a->files.items[i];
    return NULL;
}

bool has_unread(const Analysis *a, const File *file)
{
    for (size_t i = 0; i < a->diags.count; i++)
        if (a->diags.items[i]->code < DIAG_UNKNOWN_NAME &&
            a->diags.items[i]->span.source == file->source)
            return true;
    return false;
}

/* ---- places in trees ---- */

/* Returns the child at an offset; of two that touch there, the second. */
static const Syntax *child_at(const Syntax *syntax, uint32_t offset)
{
    const Syntax *found = NULL;
    for (uint32_t i = 0; i < syntax->count; i++)
        if (span_has(syntax->children[i]->span, offset))
            found = syntax->children[i];
    return found;
}

Way find_way(Arena *arena, const Syntax *tree, uint32_t offset)
{
    Way way = {0};
    for (const Syntax *node = tree; node; node = child_at(node, offset))
        array_push(arena, &way, node);
    return way;
}

Way find_way_to(Arena *arena, const Syntax *tree, const Syntax *node)
{
    Way           way  = {0};
    const Syntax *here = tree;
    while (here && here != node) {
        const Syntax *next = NULL;
        array_push(arena, &way, here);
        for (uint32_t i = 0; i < here->count && next != node; i++)
            if (here->children[i] == node || (span_has(here->children[i]->span, node->span.start) &&
                                              span_has(here->children[i]->span, node->span.end)))
                next = here->children[i];
        here = next;
    }
    if (!here)
        return (Way){0};
    array_push(arena, &way, node);
    return way;
}

const Syntax *last_of_kind(const Way *way, SyntaxKind kind, size_t *index)
{
    for (size_t i = way->count; i-- > 0;)
        if (way->items[i]->kind == kind) {
            *index = i;
            return way->items[i];
        }
    return NULL;
}

size_t find_token(const Tokens *tokens, uint32_t offset)
{
    size_t low = 0, high = tokens->count;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (tokens->items[middle].span.start <= offset && tokens->items[middle].kind != TOKEN_END)
            low = middle;
        else
            high = middle;
    }
    return low;
}

const Token *find_pointed(const Tokens *tokens, uint32_t offset)
{
    const Token *token = &tokens->items[find_token(tokens, offset)];
    const bool   sign  = token->kind >= TOKEN_LEFT_PAREN || token->kind == TOKEN_END;
    if (sign && token > tokens->items && token[-1].span.end == offset)
        token--;
    return span_has(token->span, offset) && token->kind != TOKEN_END ? token : NULL;
}

/* ---- meanings ---- */

bool is_method(const BuiltinWord *word) { return strcmp(word->kind, "method") == 0; }
bool is_called(const BuiltinWord *word) { return strcmp(word->kind, "value") != 0; }

const BuiltinWord *find_word(const char *name, bool method)
{
    for (const BuiltinWord *word = builtin_words; word->name; word++)
        if (word->parameters && is_method(word) == method && strcmp(word->name, name) == 0)
            return word;
    return NULL;
}

const NameUse *find_use(const File *file, uint32_t offset)
{
    const NameUse *found = NULL;
    for (size_t i = 0; i < file->uses.count; i++) {
        const NameUse *use = &file->uses.items[i];
        if (span_has(use->span, offset) && (!found || use->span.start == offset))
            found = use;
    }
    return found;
}

static const Syntax *defined_in(const File *file, const char *name)
{
    for (uint32_t i = 0; i < file->syntax->count; i++)
        if (syntax_defines(file->syntax->children[i]) && file->syntax->children[i]->name == name)
            return file->syntax->children[i];
    return NULL;
}

/* Returns the definition that is seen; of several, the one that is seen in the least. */
static const Syntax *defined_around(const File *file, const char *name, uint32_t offset)
{
    const NameUse *found = NULL;
    for (size_t i = 0; i < file->uses.count; i++) {
        const NameUse *use = &file->uses.items[i];
        if (use->defines && use->name == name && span_has(use->seen, offset) &&
            (!found || use->seen.end - use->seen.start <= found->seen.end - found->seen.start))
            found = use;
    }
    return found ? found->meaning : NULL;
}

bool find_meaning(const Analysis *a, const char *name, uint32_t offset, Meaning *meaning)
{
    const File *file = a->files.items[0];
    name             = name_intern((Names *)&a->names, name, strlen(name));
    *meaning         = (Meaning){.syntax = defined_around(file, name, offset)};
    for (size_t i = 0; !meaning->syntax && name[0] != '_' && i < file->used.count; i++)
        meaning->syntax = defined_in(file->used.items[i], name);
    if (meaning->syntax || (meaning->word = find_word(name, false)) != NULL)
        return true;
    for (size_t i = 0; !meaning->syntax && name[0] != '_' && i < a->files.count; i++)
        if (a->files.items[i]->library)
            meaning->syntax = defined_in(a->files.items[i], name);
    return meaning->syntax != NULL;
}

/* ---- signatures ---- */

/* Adds text of one line, of what may have several. */
static void add_line(const char *text, size_t length, Text *out)
{
    bool blank = false;
    for (size_t i = 0; i < length; i++) {
        const bool space = text[i] == ' ' || text[i] == '\n' || text[i] == '\r' || text[i] == '\t';
        if (space && !blank)
            text_add(out, " ");
        else if (!space)
            text_add_bytes(out, text + i, 1);
        blank = space;
    }
}

static void add_part(Signature *s, Arena *arena, const char *name, size_t start)
{
    struct Part part = {name, (uint32_t)start, (uint32_t)s->label.length};
    array_push(arena, s, part);
}

void signature_of_function(const Analysis *a, const Syntax *function, Signature *s)
{
    const char *text = a->sources.items[function->span.source].text;
    text_format(&s->label, "%s(", function->name);
    for (uint32_t i = 0; i < function->count; i++) {
        const Syntax *parameter = function->children[i];
        if (parameter->kind != SYNTAX_PARAMETER)
            continue;
        text_add(&s->label, s->count ? ", " : "");
        const size_t start = s->label.length;
        add_line(text + parameter->span.start, parameter->span.end - parameter->span.start,
                 &s->label);
        add_part(s, s->label.arena, parameter->name, start);
    }
    text_add(&s->label, ")");
    s->doc = function->doc;
}

void signature_of_word(const BuiltinWord *word, Signature *s)
{
    text_add(&s->label, word->name);
    s->doc = word->meaning;
    if (!is_called(word))
        return;
    text_add(&s->label, "(");
    for (const char *at = word->parameters; *at;) {
        const size_t length = strcspn(at, " "), name = strcspn(at, " =.");
        text_add(&s->label, s->count ? ", " : "");
        const size_t start = s->label.length;
        text_add_bytes(&s->label, at, name);
        text_add(&s->label, at[name] == '=' ? "?" : at[name] == '.' ? "..." : "");
        add_part(s, s->label.arena, arena_copy_text(s->label.arena, at, name), start);
        at += length + strspn(at + length, " ");
    }
    text_add(&s->label, ")");
}

/* ---- values ---- */

static Asking *ask_for(const Here *here)
{
    Service *s = here->service;
    return asking_new(&here->analysis->files, &here->analysis->loader, &s->arena, &s->values,
                      &s->scratch);
}

size_t mistakes_instead(const Here *here, const char *text, size_t length)
{
    Here other     = *here;
    other.analysis = analyse_instead(here->service, here->document, text, length);
    return other.analysis->diags.errors + ask_mistakes(ask_for(&other));
}

Asked value_on(const Here *here, const Way *way)
{
    Asked asked = {ask_for(here), value_error()};
    if (way->count > 1)
        asked.value = ask_value(asked.asking, here->file->number, way->items, way->count);
    return asked;
}

Asked value_of(const Here *here, const Syntax *definition)
{
    const File *file  = file_of(here->analysis, definition->span.source);
    const Way   way   = find_way_to(&here->service->arena, file->syntax, definition);
    Asked       asked = {ask_for(here), value_error()};
    if (way.count > 1)
        asked.value = ask_definition(asked.asking, file->number, way.items, way.count);
    return asked;
}

/* ---- JSON ---- */

const char *uri_of(Service *service, const char *path)
{
    const Document *document = find_document(service, path);
    const char     *uri      = document ? document->uri : NULL;
    if (!uri && service->host.uri)
        uri = service->host.uri(service->host.user, path);
    return uri ? uri : path;
}

const char *path_of(Service *service, const Source *source)
{
    Text path = {.arena = &service->arena};
    if (source->library && strncmp(source->name, "library:", 8) != 0)
        text_add(&path, "library:");
    text_add(&path, source->name);
    return path.bytes;
}

void add_location(Service *service, Json *json, const char *name, const Source *source, Span span)
{
    json_open(json, name, "{");
    json_text(json, "uri", uri_of(service, path_of(service, source)));
    diag_json_range(json, "range", source, span.start, span.end);
    json_close(json, "}");
}
