/*
 * where.c: where what a name means is defined, and where it is used; new names.
 */
#include <stdlib.h>
#include <string.h>

#include "compiler/service/analysis.h"

/* A definition, by the path of its file and where its name stands there. */
typedef struct Target {
    const char   *path, *name;
    Span          span; /* of the name where the question was asked */
    const Syntax *syntax;
} Target;

static void set_target(const Here *here, Target *target, const Syntax *syntax)
{
    target->syntax = syntax;
    target->path   = here->analysis->sources.items[syntax->name_span.source].name;
    target->name   = syntax->name;
}

/* Finds what is named at the position of a question; where its statement could not be read, by the name alone. */
static bool find_target(const Here *here, Target *target)
{
    const NameUse *use = find_use(here->file, here->offset);
    if (use) {
        target->span = use->span;
        if (use->meaning)
            set_target(here, target, use->meaning);
        return use->meaning != NULL;
    }
    const Tokens tokens = here->file->tokens;
    const Token *token  = find_pointed(&tokens, here->offset);
    Meaning      meaning;
    if (!token || token->kind != TOKEN_NAME ||
        (token->span.start > 0 && here->source->text[token->span.start - 1] == '.') ||
        !find_meaning(here->analysis, token->name, here->offset, &meaning) || !meaning.syntax)
        return false;
    target->span = token->span;
    set_target(here, target, meaning.syntax);
    return true;
}

/* ---- definition ---- */

/* Returns the file that the `use` at the position names, or NULL. */
static const File *used_file(const Here *here)
{
    const Syntax *tree = here->file->syntax;
    for (uint32_t i = 0; i < tree->count; i++) {
        const Syntax *use = tree->children[i];
        if (use->kind == SYNTAX_USE && span_has(use->name_span, here->offset))
            return files_used(&here->analysis->files, here->file, use);
    }
    return NULL;
}

void answer_definition(const Here *here, const ServiceQuestion *about, Json *json)
{
    Target      target;
    const File *file = used_file(here);
    (void)about;
    if (file) {
        const Source *source = &here->analysis->sources.items[file->source];
        add_location(here->service, json, NULL, source, (Span){file->source, 0, 0});
    } else if (find_target(here, &target)) {
        const Span name = target.syntax->name_span;
        add_location(here->service, json, NULL, &here->analysis->sources.items[name.source], name);
    } else
        json_text(json, NULL, NULL);
}

/* ---- references ---- */

/* A name in a file, as the files of an analysis have it. */
typedef struct Place {
    const Source *source;
    Span          span;
    bool          defines;
} Place;

typedef struct Places {
    Place *items;
    size_t count, capacity;
} Places;

static bool is_target(const Analysis *a, const Syntax *meaning, const Target *target)
{
    return meaning && meaning->name_span.start == target->syntax->name_span.start &&
           meaning->name == name_intern((Names *)&a->names, target->name, strlen(target->name)) &&
           strcmp(a->sources.items[meaning->name_span.source].name, target->path) == 0;
}

static bool is_gathered(const Places *places, const char *path, size_t before)
{
    for (size_t i = 0; i < before; i++)
        if (strcmp(places->items[i].source->name, path) == 0)
            return true;
    return false;
}

/* Gathers from the files of an analysis that are not gathered yet: several documents may use one file. */
static void gather_from(const Here *here, const Analysis *a, const Target *target, Places *places)
{
    const size_t before = places->count;
    for (size_t i = 0; i < a->files.count; i++) {
        const File   *file   = a->files.items[i];
        const Source *source = &a->sources.items[file->source];
        if (is_gathered(places, source->name, before))
            continue;
        for (size_t k = 0; k < file->uses.count; k++) {
            const NameUse *use   = &file->uses.items[k];
            Place          place = {source, use->span, use->defines};
            if (is_target(a, use->meaning, target))
                array_push(&here->service->arena, places, place);
        }
    }
}

static int compare_places(const void *a, const void *b)
{
    const Place *left = a, *right = b;
    const int    path = strcmp(left->source->name, right->source->name);
    if (path)
        return path;
    return left->span.start < right->span.start ? -1 : left->span.start > right->span.start;
}

typedef void UseOther(const Here *here, const Analysis *a, const Target *target, void *user);

/* Calls for what is read of each document that is open but for this one, and of files beside the target that may use
   it. */
static void each_other(const Here *here, const Target *target, UseOther *call, void *user)
{
    Service *service = here->service;
    for (Document *other = service->documents; other; other = other->next)
        if (other != here->document)
            call(here, analyse(service, other), target, user);
    if (here->analysis->sources.items[target->syntax->name_span.source].library)
        return;
    for (Document *other = find_neighbours(service, target->path); other; other = other->next)
        call(here, analyse(service, other), target, user);
}

static void gather_other(const Here *here, const Analysis *a, const Target *target, void *user)
{
    gather_from(here, a, target, user);
}

/* Gathers all places of a target in the documents that are open, the files that these use, and those
   beside it that use it, by paths and offsets. */
static Places gather(const Here *here, const Target *target)
{
    Places places = {0};
    gather_from(here, here->analysis, target, &places);
    each_other(here, target, gather_other, &places);
    if (places.count)
        qsort(places.items, places.count, sizeof *places.items, compare_places);
    return places;
}

void answer_references(const Here *here, const ServiceQuestion *about, Json *json)
{
    Target target;
    Places places = {0};
    if (find_target(here, &target))
        places = gather(here, &target);
    json_open(json, NULL, "[");
    for (size_t i = 0; i < places.count; i++)
        if (about->definition || !places.items[i].defines)
            add_location(here->service, json, NULL, places.items[i].source, places.items[i].span);
    json_close(json, "]");
}

void answer_highlights(const Here *here, const ServiceQuestion *about, Json *json)
{
    const NameUse *use = find_use(here->file, here->offset);
    (void)about;
    json_open(json, NULL, "[");
    for (size_t i = 0; use && i < here->file->uses.count; i++) {
        const NameUse *other = &here->file->uses.items[i];
        if (other->meaning != use->meaning || (!use->meaning && other->name != use->name))
            continue;
        json_open(json, NULL, "{");
        diag_json_range(json, "range", here->source, other->span.start, other->span.end);
        json_ready(json, "kind", other->defines ? "3" : "2"); /* write, read */
        json_close(json, "}");
    }
    json_close(json, "]");
}

/* ---- rename ---- */

static bool find_renamed(const Here *here, Target *target)
{
    if (!find_target(here, target)) {
        refuse_question(here, "only what scenes define has a name that can be changed");
        return false;
    }
    if (here->analysis->sources.items[target->syntax->name_span.source].library) {
        refuse_question(here, "names of the library are not changed");
        return false;
    }
    return true;
}

void answer_renamed(const Here *here, const ServiceQuestion *about, Json *json)
{
    Target target;
    (void)about;
    if (!find_renamed(here, &target))
        return;
    json_open(json, NULL, "{");
    diag_json_range(json, "range", here->source, target.span.start, target.span.end);
    json_text(json, "placeholder", target.name);
    json_close(json, "}");
}

/* Tells whether a word is one token, a name. */
static bool is_name(const Here *here, const char *word)
{
    Arena       *arena   = &here->service->arena;
    Sources      sources = {.arena = arena};
    Diags        diags   = {.arena = arena, .sources = &sources};
    const size_t length  = strlen(word);
    if (length == 0 || length > 200)
        return false;
    source_add(&sources, "", "", 0, true);
    const uint32_t source = source_add(&sources, "", word, length, false);
    const Tokens   tokens = lex(source, &sources, &here->analysis->names, &diags, arena);
    return tokens.count == 2 && tokens.items[0].kind == TOKEN_NAME && diags.errors == 0 &&
           tokens.items[0].span.start == 0 && tokens.items[0].span.end == length;
}

/* Returns the text of a source with a name in place of another. */
static Text renamed_text(const Here *here, const Source *source, const Places *places,
                         const char *word)
{
    Text     text = {.arena = &here->service->arena};
    uint32_t from = 0;
    text_add(&text, "");
    for (size_t i = 0; i < places->count; i++) {
        const Place *place = &places->items[i];
        if (strcmp(place->source->name, source->name) != 0)
            continue;
        text_add_bytes(&text, source->text + from, place->span.start - from);
        text_add(&text, word);
        from = place->span.end;
    }
    text_add_bytes(&text, source->text + from, source->length - from);
    return text;
}

/* Returns where an offset is behind the change, of a text that has all the places. */
static uint32_t moved(const Places *places, uint32_t offset, size_t length)
{
    size_t low = 0, high = places->count; /* those before `low` are before the offset */
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (places->items[middle].span.start < offset)
            low = middle + 1;
        else
            high = middle;
    }
    const size_t old = low ? places->items[0].span.end - places->items[0].span.start : 0;
    return (uint32_t)(offset + low * length - low * old);
}

/* Tells whether all names of a document mean what they did before. */
static bool same_meanings(const Here *here, const Analysis *after, const Places *places,
                          const char *word)
{
    const Analysis *before = here->analysis;
    const File     *old = before->files.items[0], *new = after->files.items[0];
    if (old->uses.count != new->uses.count || before->diags.errors != after->diags.errors)
        return false;
    for (size_t i = 0; i < old->uses.count; i++) {
        const Syntax *a = old->uses.items[i].meaning, *b = new->uses.items[i].meaning;
        if (!a && !b)
            continue;
        if (!a || !b)
            return false;
        const Source *from = &before->sources.items[a->name_span.source];
        if (strcmp(from->name, after->sources.items[b->name_span.source].name) != 0)
            return false;
        const bool own = a->name_span.source == old->source; /* others are read as they were */
        if (b->name_span.start !=
            (own ? moved(places, a->name_span.start, strlen(word)) : a->name_span.start))
            return false;
    }
    return true;
}

/* Tells whether one of some documents, or a file that it uses, has a name. */
static bool has_name(const Here *here, Document *documents, const char *word)
{
    for (Document *other = documents; other; other = other->next) {
        const Analysis *a = analyse(here->service, other);
        for (size_t i = 0; i < a->files.count; i++)
            for (size_t k = 0; !a->files.items[i]->library && k < a->files.items[i]->uses.count;
                 k++)
                if (strcmp(a->files.items[i]->uses.items[k].name, word) == 0)
                    return true;
    }
    return false;
}

/* Tells whether the new name hides no other, and is hidden by none, in the document where the definition and its uses
   are.  Where these are in several files, the new name must be new in all that are
   looked at. */
static bool is_safe(const Here *here, const Places *places, const char *word)
{
    Meaning meaning;
    bool    alone = true;
    for (size_t i = 0; i < places->count; i++)
        alone = alone && strcmp(places->items[i].source->name, here->source->name) == 0;
    if (!alone) {
        return !has_name(here, here->service->documents, word) &&
               !has_name(here, here->service->neighbours, word) &&
               !find_meaning(here->analysis, word, here->offset, &meaning);
    }
    const Text text = renamed_text(here, here->source, places, word);
    return same_meanings(here,
                         analyse_instead(here->service, here->document, text.bytes, text.length),
                         places, word);
}

/* Tells whether the name stands where a text cannot be read, so that nobody knows what it means. */
static bool is_unread(const File *file, const Source *source, const char *name)
{
    for (size_t i = 0; i < file->tokens.count; i++) {
        const Token *token  = &file->tokens.items[i];
        const bool   member = token->span.start > 0 && source->text[token->span.start - 1] == '.';
        if (token->kind == TOKEN_NAME && !member && strcmp(token->name, name) == 0 &&
            !find_use(file, token->span.start))
            return true;
    }
    return false;
}

static void find_unread(const Here *here, const Analysis *a, const Target *target, void *user)
{
    bool *found = user;
    (void)here;
    for (size_t i = 0; i < a->files.count && !*found; i++) {
        const File   *file   = a->files.items[i];
        const Source *source = &a->sources.items[file->source];
        *found = !source->library && has_unread(a, file) && is_unread(file, source, target->name);
    }
}

void answer_rename(const Here *here, const ServiceQuestion *about, Json *json)
{
    Target target;
    if (!find_renamed(here, &target))
        return;
    if (!about->word || !is_name(here, about->word)) {
        refuse_question(here, "this is not a name: letters, digits and `_`, a letter first, and no "
                              "word of the language");
        return;
    }
    const Places places = gather(here, &target);
    bool         unread = false;
    find_unread(here, here->analysis, &target, &unread);
    each_other(here, &target, find_unread, &unread);
    if (unread) {
        refuse_question(here,
                        "a statement that cannot be read has this name, too: mend that first");
        return;
    }
    if (!is_safe(here, &places, about->word)) {
        refuse_question(here, "names would mean something else then: another thing is called so");
        return;
    }
    json_open(json, NULL, "{");
    json_open(json, "changes", "{");
    for (size_t i = 0; i < places.count;) {
        const Source *source = places.items[i].source;
        json_open(json, uri_of(here->service, source->name), "[");
        for (; i < places.count && strcmp(places.items[i].source->name, source->name) == 0; i++) {
            json_open(json, NULL, "{");
            diag_json_range(json, "range", source, places.items[i].span.start,
                            places.items[i].span.end);
            json_text(json, "newText", about->word);
            json_close(json, "}");
        }
        json_close(json, "]");
    }
    json_close(json, "}");
    json_close(json, "}");
}

/* ---- links ---- */

void answer_links(const Here *here, const ServiceQuestion *about, Json *json)
{
    (void)about;
    json_open(json, NULL, "[");
    for (uint32_t i = 0; i < here->file->syntax->count; i++) {
        const Syntax *use  = here->file->syntax->children[i];
        const File   *file = use->kind == SYNTAX_USE
                                 ? files_used(&here->analysis->files, here->file, use)
                                 : NULL;
        if (!file)
            continue;
        const Span    span   = use->name_span;
        const Source *source = &here->analysis->sources.items[file->source];
        json_open(json, NULL, "{");
        diag_json_range(json, "range", here->source, span.start, span.end);
        json_text(json, "target", uri_of(here->service, path_of(here->service, source)));
        json_close(json, "}");
    }
    json_close(json, "]");
}
