/*
 * source.c: the texts of a compilation and places in them.
 */
#include "compiler/base/source.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/fnv.h"
#include "compiler/base/paths.h"
#include "compiler/base/text.h"

static const char byte_order_mark[] = "\xEF\xBB\xBF";

/* The first line begins behind a byte order mark, which is no character of the scene. */
static void find_lines(Arena *arena, Source *source)
{
    uint32_t count = 1;
    for (uint32_t i = 0; i < source->length; i++)
        count += source->text[i] == '\n';
    source->lines      = arena_new_array(arena, uint32_t, count);
    source->line_count = 1;
    if (strncmp(source->text, byte_order_mark, sizeof byte_order_mark - 1) == 0)
        source->lines[0] = sizeof byte_order_mark - 1;
    for (uint32_t i = 0; i < source->length; i++)
        if (source->text[i] == '\n')
            source->lines[source->line_count++] = i + 1;
}

static void count_characters(Arena *arena, Source *source)
{
    uint32_t count     = 0;
    source->characters = arena_new_array(arena, uint32_t, source->length / SOURCE_BLOCK + 1);
    for (uint32_t i = 0; i < source->length; i++) {
        if (i % SOURCE_BLOCK == 0)
            source->characters[i / SOURCE_BLOCK] = count;
        count += text_begins_character(source->text[i]);
    }
    if (source->length % SOURCE_BLOCK == 0)
        source->characters[source->length / SOURCE_BLOCK] = count;
}

/* Returns the number of characters that begin before a byte. */
static uint32_t characters_before(const Source *source, uint32_t offset)
{
    offset         = offset < source->length ? offset : source->length;
    uint32_t block = offset / SOURCE_BLOCK, count = source->characters[block];
    for (uint32_t i = block * SOURCE_BLOCK; i < offset; i++)
        count += text_begins_character(source->text[i]);
    return count;
}

static void push_source(Sources *sources, const char *name, const char *text, size_t length,
                        bool library)
{
    Source source = {
        .name    = arena_copy_text(sources->arena, name, strlen(name)),
        .text    = arena_copy_text(sources->arena, text, length),
        .length  = (uint32_t)length,
        .library = library,
    };
    find_lines(sources->arena, &source);
    count_characters(sources->arena, &source);
    array_push(sources->arena, sources, source);
}

uint32_t source_add(Sources *sources, const char *name, const char *text, size_t length,
                    bool library)
{
    if (sources->count == 0)
        push_source(sources, "", "", 0, true);
    push_source(sources, name, text, length, library);
    return (uint32_t)(sources->count - 1);
}

uint32_t source_line(const Source *source, uint32_t offset)
{
    uint32_t low = 0, high = source->line_count; /* the line is in [low, high) */
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (source->lines[middle] <= offset)
            low = middle;
        else
            high = middle;
    }
    return low + 1;
}

Position source_position(const Source *source, uint32_t offset)
{
    uint32_t line = source_line(source, offset), first = source->lines[line - 1];
    uint32_t column = 1;
    if (offset > first)
        column += characters_before(source, offset) - characters_before(source, first);
    /* An offset in the middle of a character has the column of that character. */
    if (offset < source->length && !text_begins_character(source->text[offset]) && column > 1)
        column--;
    return (Position){line, column};
}

uint32_t utf16_units(const char *text, uint32_t start, uint32_t end)
{
    uint32_t units = 0;
    while (start < end) {
        uint32_t character;
        size_t   length = text_character(text + start, end - start, &character);
        units += character > 0xFFFF ? 2 : 1;
        start += length ? (uint32_t)length : 1;
    }
    return units;
}

Utf16Position source_utf16_position(const Source *source, uint32_t offset)
{
    uint32_t line = source_line(source, offset) - 1;
    return (Utf16Position){line, utf16_units(source->text, source->lines[line], offset)};
}

uint32_t utf16_offset(const char *text, size_t length, Utf16Position position)
{
    size_t at = length >= 3 && memcmp(text, byte_order_mark, 3) == 0 ? 3 : 0;
    for (uint32_t line = 0; line < position.line; line++) {
        const char *newline = memchr(text + at, '\n', length - at);
        if (!newline)
            return (uint32_t)length;
        at = (size_t)(newline - text) + 1;
    }
    for (uint32_t units = 0; at < length && text[at] != '\n' && units < position.character;) {
        uint32_t character;
        size_t   bytes = text_character(text + at, length - at, &character);
        if (text[at] == '\r' && at + 1 < length && text[at + 1] == '\n')
            break;
        units += character > 0xFFFF ? 2 : 1;
        at += units > position.character ? 0 : bytes ? bytes : 1;
    }
    return (uint32_t)at;
}

Span span_join(Span from, Span to)
{
    if (from.source != to.source)
        return from.source == 0 ? to : from;
    return (Span){from.source, from.start < to.start ? from.start : to.start,
                  from.end > to.end ? from.end : to.end};
}

const char source_no_memory[] = "there is not enough memory";

/* ---- the hash ---- */

/* Hashes the length before the content: bytes that go from one file to the next change the hash. */
static uint64_t hash_file(uint64_t hash, const char *path, const void *bytes, size_t length)
{
    unsigned char size[8];
    for (size_t i = 0; i < sizeof size; i++)
        size[i] = (unsigned char)((uint64_t)length >> 8 * i);
    hash = fnv_bytes(hash, path, strlen(path) + 1);
    hash = fnv_bytes(hash, size, sizeof size);
    return fnv_bytes(hash, bytes, length);
}

/* Hashes a file by the path from the folder of a scene that is called `scene`, which is the same wherever
   that is compiled; the scene itself by "". */
static uint64_t hash_named(uint64_t hash, const char *scene, const char *path, const void *bytes,
                           size_t length)
{
    char *from = strdup(scene), *to = strdup(path), *relative = NULL;
    if (from && to) {
        path_simplify(from);
        path_simplify(to);
        relative = strcmp(from, to) == 0 ? NULL : path_relative(from, to);
    }
    const bool own = from && to && strcmp(from, to) == 0;
    hash           = hash_file(hash, own ? "" : relative ? relative : path, bytes, length);
    free(from);
    free(to);
    free(relative);
    return hash;
}

/* The scene is the first of its files. */
static const char *scene_name(const Sources *sources)
{
    for (size_t i = 0; i < sources->count; i++)
        if (!sources->items[i].library)
            return sources->items[i].name;
    return "";
}

void sources_note_file(Sources *sources, const char *path, const void *bytes, size_t length)
{
    const uint64_t before = sources->noted ? sources->noted : FNV_START;
    sources->noted        = hash_named(before, scene_name(sources), path, bytes, length);
}

void sources_note(Sources *sources, const char *word, const void *bytes, size_t length)
{
    sources->noted = hash_file(sources->noted ? sources->noted : FNV_START, word, bytes, length);
}

void sources_hash(const Sources *sources, char hash[17])
{
    uint64_t h = FNV_START;
    for (size_t i = 1; i < sources->count; i++) {
        const Source *source = &sources->items[i];
        if (!source->library)
            h = hash_named(h, scene_name(sources), source->name, source->text, source->length);
    }
    h = fnv_bytes(h, &sources->noted, sizeof sources->noted);
    snprintf(hash, 17, "%016llx", (unsigned long long)h);
}
