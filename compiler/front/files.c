/*
 * files.c: reads the scene, the library, and the files that a `use` names.
 */
#include "compiler/front/files.h"

#include <stdlib.h>
#include <string.h>

#include "compiler/base/embedded.h"
#include "compiler/base/paths.h"
#include "compiler/front/names.h"
#include "compiler/front/parse.h"
#include "compiler/front/synonyms.h"

enum { MAX_TOTAL_BYTES = 64 << 20, MAX_FILES = 1024 };

/* ---- texts, tokens, trees ---- */

static File *add_file(Files *files, const char *path, uint32_t source, bool library)
{
    File *file = arena_new(files->arena, File);
    *file      = (File){.path = path, .source = source, .number = files->count, .library = library};
    array_push(files->arena, files, file);
    return file;
}

static void lex_file(Files *files, File *file)
{
    file->tokens = lex(file->source, files->sources, files->names, files->diags, files->trees);
}

static void parse_file(Files *files, File *file)
{
    file->syntax = parse(&file->tokens, files->diags, files->trees);
    if (files->tells_uses)
        return;
    arena_release(files->trees, file->tokens.items,
                  file->tokens.capacity * sizeof *file->tokens.items);
    file->tokens = (Tokens){0};
}

const char *files_beside(const Files *files, const char *from, const char *path)
{
    Text text = {.arena = files->arena};
    text_add_bytes(&text, from, path[0] == '/' ? 0 : path_folder_length(from));
    text_add(&text, path);
    path_simplify(text.bytes);
    return text.bytes;
}

/* Adds the files of compiler/library.  Those in its folder std/ are read only when a `use` names
   them. */
static void load_library(Files *files)
{
    for (const EmbeddedFile *file = library_files; file->name; file++) {
        if (strchr(file->name, '/'))
            continue;
        const char *path   = diag_text(files->diags, "library:%s", file->name);
        uint32_t    source = source_add(files->sources, path, file->text, file->length, true);
        add_file(files, path, source, true);
    }
}

void files_load(Files *files, const char *path, const char *text, size_t length)
{
    uint32_t source = source_add(files->sources, path, text, length, false);
    files->bytes    = length;
    add_file(files, files_beside(files, "", path), source, false);
    load_library(files);
}

void files_lex(Files *files)
{
    for (size_t i = 0; i < files->count; i++)
        lex_file(files, files->items[i]);
}

void files_parse(Files *files)
{
    for (size_t i = 0; i < files->count; i++)
        parse_file(files, files->items[i]);
}

/* ---- files that are used ---- */

static File *find_file(const Files *files, const char *path)
{
    for (size_t i = 0; i < files->count; i++)
        if (strcmp(files->items[i]->path, path) == 0)
            return files->items[i];
    return NULL;
}

static bool names_library(const Syntax *use) { return strncmp(use->name, "std/", 4) == 0; }

/* Reads the text of a file of the library. */
static Loaded read_library(const char *path)
{
    const EmbeddedFile *file = embedded_find(library_files, path);
    return file ? (Loaded){.text = file->text, .length = file->length}
                : (Loaded){.reason = "there is no such file in the library"};
}

Diag *files_refuse(const Files *files, Span place, const char *path, const Loaded *loaded,
                   const char *label)
{
    if (loaded->reason == source_no_memory)
        arena_exhausted(files->arena);
    Diag *diag  = loaded->outside
                      ? diag_add(files->diags, DIAG_OUTSIDE_ROOT, place,
                                 "`%s` is outside of the folder that scenes may read from", path)
                      : diag_add(files->diags, DIAG_CANNOT_READ, place, "cannot read `%s`: %s", path,
                                 loaded->reason);
    diag->label = label;
    return diag;
}

/* Reports a text that could not be read, and suggests one of the library. */
static void refuse_text(Files *files, Span place, const char *path, const Loaded *text,
                        const char *label)
{
    Diag *diag = files_refuse(files, place, path, text, label);
    if (!text->outside)
        explain_file(files->diags, diag, path);
}

/* Tells whether one more text may be added; false: reported. */
static bool check_length(Files *files, size_t length, Span place)
{
    files->bytes += length;
    if (length <= MAX_SOURCE_BYTES && files->bytes <= MAX_TOTAL_BYTES &&
        files->count + files->data.count < MAX_FILES)
        return true;
    diag_add(files->diags, DIAG_LIMIT, place,
             "too much text: a file may have 16 MiB, all together 64 MiB in 1,024 files");
    return false;
}

/* Adds a used file; NULL if it cannot be read, which is then reported. */
static File *load_text(Files *files, const Syntax *use, const char *path)
{
    const bool library = names_library(use);
    Loaded     text    = library ? read_library(path) : loader_read(files->loader, path);
    File      *file    = NULL;
    if (!text.text) {
        refuse_text(files, use->name_span, path, &text, "used here");
        return NULL;
    }
    if (check_length(files, text.length, use->name_span)) {
        uint32_t source = source_add(files->sources, path, text.text, text.length, library);
        file            = add_file(files, files_beside(files, "", path), source, false);
    }
    free(text.owned);
    return file;
}

/* Tells whether names may be missing in a file, because something in another file could not be read.
   Then unknown names are not reported. */
static bool may_miss_names(const Files *files, const File *file)
{
    for (size_t i = 0; i < files->diags->count; i++) {
        const Diag *diag      = files->diags->items[i];
        bool        elsewhere = diag->span.source != file->source;
        bool        grammar   = diag->code < DIAG_UNKNOWN_NAME;
        if ((elsewhere && grammar) || diag->code == DIAG_CANNOT_READ || diag->code == DIAG_LIMIT ||
            diag->code == DIAG_CIRCULAR_USE)
            return true;
    }
    return false;
}

static void load_all_used(Files *files, File *file);

static const char *path_of_use(Files *files, const File *from, const Syntax *use)
{
    return names_library(use) ? use->name : files_beside(files, from->path, use->name);
}

const File *files_used(Files *files, const File *from, const Syntax *use)
{
    return find_file(files, path_of_use(files, from, use));
}

static void load_one_used(Files *files, File *file, const Syntax *use)
{
    const char *path = path_of_use(files, file, use);
    File       *used = find_file(files, path);
    if (used && used->reading) {
        Diag *diag  = diag_add(files->diags, DIAG_CIRCULAR_USE, use->name_span, "`%s` uses itself",
                               path);
        diag->label = "this closes the circle";
        return;
    }
    if (!used) {
        used = load_text(files, use, path);
        if (!used)
            return;
        lex_file(files, used);
        parse_file(files, used);
        load_all_used(files, used);
    }
    array_push(files->arena, &file->used, used);
}

static void load_all_used(Files *files, File *file)
{
    file->reading = true;
    for (uint32_t i = 0; i < file->syntax->count; i++)
        if (file->syntax->children[i]->kind == SYNTAX_USE)
            load_one_used(files, file, file->syntax->children[i]);
    file->reading    = false;
    file->incomplete = may_miss_names(files, file);
}

void files_load_used(Files *files) { load_all_used(files, files->items[0]); }

/* ---- data ---- */

static const char *path_of(const Files *files, uint32_t source)
{
    for (size_t i = 0; i < files->count; i++)
        if (files->items[i]->source == source)
            return files->items[i]->path;
    return "";
}

/* Reads a file of data; 0: reported. */
static uint32_t read_data(Files *files, const char *path, Span place)
{
    Loaded   text   = loader_read(files->loader, path);
    uint32_t source = 0;
    if (!text.text)
        refuse_text(files, place, path, &text, "read here");
    else if (check_length(files, text.length, place))
        source = source_add(files->sources, path, text.text, text.length, false);
    free(text.owned);
    return source;
}

/* A file is read once, also one that cannot be read. */
uint32_t files_load_data(Files *files, uint32_t from, const char *name, Span place)
{
    const char *path = files_beside(files, path_of(files, from), name);
    for (size_t i = 0; i < files->data.count; i++)
        if (strcmp(files->data.items[i].path, path) == 0)
            return files->data.items[i].source;
    DataFile file = {path, read_data(files, path, place)};
    array_push(files->arena, &files->data, file);
    return file.source;
}

/* ---- names ---- */

typedef struct KnownNames {
    KnownName *items;
    size_t     count, capacity;
} KnownNames;

/* Adds the names that a file offers to others: all but private ones (_name). */
static void add_names(const Files *files, const File *file, KnownNames *known)
{
    for (uint32_t i = 0; i < file->syntax->count; i++) {
        const Syntax *syntax = file->syntax->children[i];
        if (syntax_defines(syntax) && syntax->name[0] != '_') {
            KnownName name = {syntax->name, syntax};
            array_push(files->scratch, known, name);
        }
    }
}

static void check_file(Files *files, File *file, const char *const *builtin, size_t count)
{
    KnownNames known = {0};
    for (size_t i = 0; i < count; i++) {
        KnownName name = {name_intern(files->names, builtin[i], strlen(builtin[i])), NULL};
        array_push(files->scratch, &known, name);
    }
    for (size_t i = 0; i < files->count; i++)
        if (files->items[i]->library && files->items[i] != file)
            add_names(files, files->items[i], &known);
    for (size_t i = 0; i < file->used.count; i++)
        add_names(files, file->used.items[i], &known);
    NameScope scope = {known.items, known.count, file->incomplete};
    names_check(file->syntax, &scope, files->diags, files->scratch,
                files->tells_uses ? &file->uses : NULL, files->arena);
    file->checked = true;
}

/* Checks a file after all files that it uses. */
static void check_used_first(Files *files, File *file, const char *const *builtin, size_t count)
{
    for (size_t i = 0; i < file->used.count; i++)
        if (!file->used.items[i]->checked)
            check_used_first(files, file->used.items[i], builtin, count);
    check_file(files, file, builtin, count);
}

void files_check_names(Files *files, const char *const *builtin, size_t count)
{
    for (size_t i = 0; i < files->count; i++)
        if (files->items[i]->library)
            check_file(files, files->items[i], builtin, count);
    check_used_first(files, files->items[0], builtin, count);
}

/* ---- dumps ---- */

void files_print_texts(const Files *files, Text *out)
{
    for (size_t i = 0; i < files->count; i++) {
        const Source *source = &files->sources->items[files->items[i]->source];
        text_format(out, "%s  %u bytes, %u lines\n", source->name, source->length,
                    source->line_count);
    }
}

void files_print_uses(const Files *files, Text *out)
{
    for (size_t i = 0; i < files->count; i++) {
        const File *file = files->items[i];
        text_format(out, "%s%s\n", file->path, file->library ? "  seen by all" : "");
        for (size_t k = 0; k < file->used.count; k++)
            text_format(out, "  uses %s\n", file->used.items[k]->path);
    }
}

static void print_names_of(const Files *files, const File *file, Text *out)
{
    const Source *source = &files->sources->items[file->source];
    for (uint32_t i = 0; i < file->syntax->count; i++) {
        const Syntax *syntax = file->syntax->children[i];
        if (!syntax_defines(syntax))
            continue;
        Position position = source_position(source, syntax->name_span.start);
        text_format(out, "%s %s  %s:%u:%u\n", syntax_kind_name(syntax->kind), syntax->name,
                    source->name, position.line, position.column);
    }
}

void files_print_names(const Files *files, Text *out)
{
    for (int library = 0; library <= 1; library++)
        for (size_t i = 0; i < files->count; i++)
            if (files->items[i]->library == (library > 0))
                print_names_of(files, files->items[i], out);
}
