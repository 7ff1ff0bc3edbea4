/*
 * scope.c: files, the names they define, and the files they use.
 */
#include "compiler/eval/elaborate.h"

#include <stdlib.h>
#include <string.h>

#include "compiler/base/embedded.h"
#include "compiler/front/names.h"
#include "compiler/front/parse.h"

enum { MOST_TOTAL_BYTES = 64 << 20, MOST_FILES = 1024 };

static size_t slot_of(const Scope *scope, const char *name)
{
    return (size_t)(((uintptr_t)name >> 3) * 0x9E3779B97F4A7C15u >> 32) % scope->slot_count;
}

static Definition *find_own(const Scope *scope, const char *name)
{
    if (scope->slot_count == 0)
        return NULL;
    for (size_t i = slot_of(scope, name);; i = (i + 1) % scope->slot_count) {
        if (!scope->slots[i])
            return NULL;
        if (scope->slots[i]->name == name)
            return scope->slots[i];
    }
}

Definition *scope_find(const Scope *scope, const char *name)
{
    Definition *definition = find_own(scope, name);
    for (size_t i = 0; !definition && i < scope->used.count; i++)
        definition = find_own(scope->used.items[i], name);
    return definition;
}

static void define_all(Elaboration *e, Scope *scope)
{
    for (uint32_t i = 0; i < scope->file->count; i++) {
        const Syntax *syntax = scope->file->children[i];
        if (!syntax_defines(syntax))
            continue;
        Definition *definition = arena_new(e->arena, Definition);
        *definition = (Definition){.name = syntax->name, .syntax = syntax, .scope = scope};
        array_push(e->arena, &scope->definitions, definition);
    }
    scope->slot_count = 2 * scope->definitions.count + 1;
    scope->slots      = arena_new_array(e->arena, Definition *, scope->slot_count);
    for (size_t i = 0; i < scope->definitions.count; i++) {
        Definition *definition = scope->definitions.items[i];
        size_t      slot       = slot_of(scope, definition->name);
        while (scope->slots[slot] && scope->slots[slot]->name != definition->name)
            slot = (slot + 1) % scope->slot_count;
        if (!scope->slots[slot]) /* of two definitions the first counts; names_check reports */
            scope->slots[slot] = definition;
    }
}

typedef struct KnownNames {
    const char **items;
    size_t       count, capacity;
} KnownNames;

/* Names of another file that this one may use: all but private ones (_name). */
static void add_names(Elaboration *e, const Scope *scope, KnownNames *known)
{
    for (size_t i = 0; i < scope->definitions.count; i++)
        if (scope->definitions.items[i]->name[0] != '_')
            array_push(e->scratch, known, scope->definitions.items[i]->name);
}

static void check_names(Elaboration *e, const Scope *scope)
{
    KnownNames  known = {0};
    const char *builtin[512];
    size_t      count = builtin_names(builtin, sizeof builtin / sizeof *builtin);
    for (size_t i = 0; i < count; i++)
        array_push(e->scratch, &known, name_intern(e->names, builtin[i], strlen(builtin[i])));
    for (size_t i = 0; i < e->library->used.count; i++)
        if (e->library->used.items[i] != scope)
            add_names(e, e->library->used.items[i], &known);
    for (size_t i = 0; i < scope->used.count; i++)
        add_names(e, scope->used.items[i], &known);
    NameScope names = {known.items, known.count};
    names_check(scope->file, &names, e->diags, e->scratch);
}

static Scope *find_loaded(const Elaboration *e, const char *path)
{
    for (size_t i = 0; i < e->scopes.count; i++)
        if (strcmp(e->scopes.items[i]->path, path) == 0)
            return e->scopes.items[i];
    return NULL;
}

/* "folder/used.krs" for a `use "used.krs"` in "folder/file.krs". */
static const char *resolve_path(Elaboration *e, const char *from, const char *path)
{
    const char *slash = path[0] == '/' ? NULL : strrchr(from, '/');
    Text        text  = {.arena = e->arena};
    text_add_bytes(&text, from, slash ? (size_t)(slash - from + 1) : 0);
    text_add(&text, path);
    path_simplify(text.bytes);
    return text.bytes;
}

/* A file of the library, or NULL. */
static const char *read_library(const char *path, size_t *length)
{
    for (const EmbeddedFile *file = library_files; file->name; file++)
        if (strcmp(file->name, path) == 0) {
            *length = file->length;
            return file->text;
        }
    return NULL;
}

static bool is_library(const Syntax *use) { return strncmp(use->name, "std/", 4) == 0; }

/* The name that a used file has in this run. */
static const char *used_path(Elaboration *e, const Scope *from, const Syntax *use)
{
    return is_library(use) ? use->name : resolve_path(e, from->path, use->name);
}

static void refuse_used(Elaboration *e, const Syntax *use, const char *path, const Loaded *file)
{
    Diag *diag  = file->outside
                      ? diag_add(e->diags, DIAG_OUTSIDE_ROOT, use->name_span,
                                 "`%s` is outside of the folder that scenes may read from", path)
                      : diag_add(e->diags, DIAG_CANNOT_READ, use->name_span, "cannot read `%s`: %s",
                                 path, file->reason);
    diag->label = "used here";
}

/* Reads a used file into e->sources; false: reported. */
static bool read_used(Elaboration *e, const Syntax *use, const char *path, uint32_t *source)
{
    Loaded file = {.reason = "there is no such file in the library"};
    if (is_library(use))
        file.text = read_library(path, &file.length);
    else
        file = loader_read(e->loader, path);
    if (!file.text) {
        refuse_used(e, use, path, &file);
        return false;
    }
    e->text_total += file.length;
    bool fits = file.length <= MOST_SOURCE_BYTES && e->text_total <= MOST_TOTAL_BYTES &&
                e->scopes.count < MOST_FILES;
    if (fits)
        *source = source_add(e->sources, path, file.text, file.length, is_library(use));
    else
        diag_add(e->diags, DIAG_LIMIT, use->name_span,
                 "too much text: a file may have 16 MiB, all together 64 MiB in 1,024 files");
    free(file.owned);
    return fits;
}

static void load_used(Elaboration *e, Scope *scope, const Syntax *use)
{
    uint32_t    source;
    const char *path = used_path(e, scope, use);
    Scope      *used = find_loaded(e, path);
    if (used && used->loading) {
        Diag *diag  = diag_add(e->diags, DIAG_CIRCULAR_USE, use->name_span, "`%s` uses itself",
                               path);
        diag->label = "this closes the circle";
        return;
    }
    if (!used) {
        if (!read_used(e, use, path, &source))
            return;
        used = scope_load(e, source, path);
    }
    array_push(e->arena, &scope->used, used);
}

static Scope *scope_new(Elaboration *e, const char *path)
{
    Scope *scope       = arena_new(e->arena, Scope);
    scope->path        = path;
    scope->environment = (Environment){NULL, scope};
    return scope;
}

static Scope *scope_parse(Elaboration *e, uint32_t source, const char *path)
{
    Scope *scope = scope_new(e, path);
    array_push(e->arena, &e->scopes, scope);

    Tokens tokens = lex(source, e->sources, e->names, e->diags, e->syntax);
    scope->file   = parse(&tokens, e->diags, e->syntax);
    define_all(e, scope);
    return scope;
}

Scope *scope_load(Elaboration *e, uint32_t source, const char *path)
{
    Scope *scope   = scope_parse(e, source, resolve_path(e, "", path));
    scope->loading = true;
    for (uint32_t i = 0; i < scope->file->count; i++)
        if (scope->file->children[i]->kind == SYNTAX_USE)
            load_used(e, scope, scope->file->children[i]);
    scope->loading = false;
    check_names(e, scope);
    return scope;
}

/* The files of compiler/library/ itself; those in its folder std/ wait for a `use`. */
void scope_load_library(Elaboration *e)
{
    e->library = scope_new(e, "library");
    for (const EmbeddedFile *file = library_files; file->name; file++) {
        if (strchr(file->name, '/'))
            continue;
        const char *path   = diag_text(e->diags, "library:%s", file->name);
        uint32_t    source = source_add(e->sources, path, file->text, file->length, true);
        Scope      *scope  = scope_parse(e, source, path);
        array_push(e->arena, &e->library->used, scope);
    }
    for (size_t i = 0; i < e->library->used.count; i++)
        check_names(e, e->library->used.items[i]);
}
