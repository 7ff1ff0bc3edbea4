/*
 * files.c: files that arguments of functions name.
 */
#include <stdlib.h>
#include <string.h>

#include "compiler/eval/elaborate.h"

static bool is_too_large(Elaboration *e, const Syntax *syntax, size_t length)
{
    if (length <= MAX_FILE_BYTES)
        return false;
    diag_add(e->diags, DIAG_LIMIT, syntax->span, "too large a file: 64 MiB are possible");
    return true;
}

static bool find_read(const Elaboration *e, const char *path, FileBytes *bytes)
{
    for (size_t i = 0; i < e->read.count; i++)
        if (strcmp(e->read.items[i].path, path) == 0) {
            *bytes = e->read.items[i];
            return true;
        }
    return false;
}

static void keep_bytes(Elaboration *e, const char *path, const Loaded *loaded, int face,
                       FileBytes *bytes)
{
    const char *copy = arena_copy_text(e->arena, loaded->text, loaded->length);
    bytes->path      = arena_copy_text(e->arena, path, strlen(path));
    bytes->bytes     = (const unsigned char *)copy;
    bytes->length    = loaded->length;
    bytes->face      = face;
    array_push(e->arena, &e->read, *bytes);
}

bool read_beside(Elaboration *e, const Argument *argument, const char *name, FileBytes *bytes)
{
    const Span  span = argument->syntax->span;
    const char *path = files_beside(e->files, e->sources->items[span.source].name, name);
    if (find_read(e, path, bytes))
        return true;
    Loaded loaded = loader_read(e->loader, path);
    if (!loaded.text) {
        files_refuse(e->files, span, path, &loaded, "named here");
        return false;
    }
    bool large = is_too_large(e, argument->syntax, loaded.length);
    if (!large) {
        keep_bytes(e, path, &loaded, 0, bytes);
        sources_note_file(e->sources, path, bytes->bytes, bytes->length);
    }
    free(loaded.owned);
    return !large;
}

void refuse_picture(Elaboration *e, const Syntax *named, const char *path, const char *fault)
{
    Diag *diag  = diag_add(e->diags, DIAG_BAD_TEXTURE, named->span, "%s: %s", path, fault);
    diag->label = "this picture cannot be read";
}

/* ---- fonts ---- */

/* Notes the bytes of a font.  Neither its name nor its folder counts: a scene is the same with the
   same letters. */
static void note_font(Elaboration *e, const FileBytes *bytes)
{
    sources_note(e->sources, "font", bytes->bytes, bytes->length);
    sources_note(e->sources, "face", &bytes->face, sizeof bytes->face);
}

static bool keep_font(Elaboration *e, const char *path, Loaded loaded, int face, FileBytes *bytes)
{
    if (loaded.reason == source_no_memory)
        arena_exhausted(e->arena);
    const bool read = loaded.text && loaded.length <= MAX_FILE_BYTES;
    if (read) {
        keep_bytes(e, path, &loaded, face, bytes);
        note_font(e, bytes);
    }
    free(loaded.owned);
    return read;
}

static bool read_supplied_font(Elaboration *e, const char *name, FileBytes *bytes)
{
    Loaded loaded = {0};
    int    face   = 0;
    Text   path   = {.arena = e->arena};
    text_format(&path, "font:%s", name ? name : "");
    if (find_read(e, path.bytes, bytes))
        return true;
    loaded.text = e->loader->fonts(e->loader->fonts_user, name, &loaded.length, &face);
    return keep_font(e, path.bytes, loaded, face, bytes);
}

static bool read_system_font(Elaboration *e, const FoundFont *font, FileBytes *bytes)
{
    Text path = {.arena = e->arena};
    text_format(&path, "font:%s:%d", font->path, font->face);
    return find_read(e, path.bytes, bytes) ||
           keep_font(e, path.bytes, disk_read(font->path), font->face, bytes);
}

FontSearch read_font(Elaboration *e, const char *name, FileBytes *bytes)
{
    FoundFont found;
    if (e->loader->fonts)
        return read_supplied_font(e, name, bytes) ? FONT_FOUND : name ? FONT_UNKNOWN : FONT_NONE;
    FontSearch search = font_find(name, &found);
    if (search == FONT_NO_MEMORY)
        arena_exhausted(e->arena); /* as any other want of memory */
    if (search == FONT_FOUND && !read_system_font(e, &found, bytes))
        search = FONT_NONE;
    free(found.path);
    return search;
}
