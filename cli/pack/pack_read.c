/*
 * pack_read.c: reads packs: jansson reads pack.json, and libzip the archive.
 */
#include <jansson.h>
#include <stdio.h>
#include <string.h>
#include <zip.h>

#include "cli/pack/pack.h"

typedef struct Reading {
    Arena *arena;
    Pack  *pack;
    Text  *why;
    zip_t *archive;
    size_t limit, left; /* bytes that what is in the pack may have, in all and still */
} Reading;

/* Notes why the pack cannot be read. */
static bool refuse(Reading *r, const char *why, const char *name)
{
    text_add(r->why, why);
    if (name)
        text_format(r->why, " `%s`", name);
    return false;
}

/* Returns the bytes of a file of the archive, with a zero behind them; NULL: it has been refused. */
static const char *read_member(Reading *r, const char *member, const char *name, size_t *length)
{
    zip_stat_t  about;
    zip_file_t *file;
    if (zip_stat(r->archive, member, ZIP_FL_ENC_UTF_8, &about) != 0 ||
        !(about.valid & ZIP_STAT_SIZE)) {
        refuse(r, "it is damaged, or no pack; it lacks", name);
        return NULL;
    }
    if (about.size > r->left) {
        text_format(r->why, "what is in it has more than %zu MiB; --limit memory=%zuM allows more",
                    r->limit >> 20, r->limit >> 18);
        return NULL;
    }
    *length     = (size_t)about.size;
    r->left     = r->left - *length;
    char *bytes = arena_new_array(r->arena, char, *length + 1);
    file        = zip_fopen(r->archive, member, ZIP_FL_ENC_UTF_8);
    /* One byte more makes libzip compare its checksum. */
    const bool whole = file && zip_fread(file, bytes, *length + 1) == (zip_int64_t)*length;
    if (file)
        zip_fclose(file);
    if (!whole) {
        refuse(r, "it is damaged:", name);
        return NULL;
    }
    bytes[*length] = '\0';
    return bytes;
}

/* Reads what a row of pack.json names. */
static bool read_entry(Reading *r, const json_t *row, bool font, PackEntries *entries)
{
    const char *name = json_string_value(json_object_get(row, "name"));
    const char *hash = json_string_value(json_object_get(row, "hash"));
    const int   face = (int)json_integer_value(json_object_get(row, "face"));
    char        member[sizeof "files/" + PACK_HASH], found[PACK_HASH];
    if (!hash || strlen(hash) != PACK_HASH - 1 || (!name && !font))
        return refuse(r, "it is no pack, or made by a later krs", NULL);
    snprintf(member, sizeof member, "files/%s", hash);
    PackEntry entry = {.name = name ? arena_copy_text(r->arena, name, strlen(name)) : NULL,
                       .face = face};
    entry.bytes     = read_member(r, member, name ? name : "font", &entry.length);
    if (!entry.bytes)
        return false;
    pack_hash(entry.bytes, entry.length, found);
    if (strcmp(found, hash) != 0)
        return refuse(r, "it is damaged:", name);
    array_push(r->arena, entries, entry);
    return true;
}

static bool read_entries(Reading *r, const json_t *rows, bool font, PackEntries *entries)
{
    size_t  i;
    json_t *row;
    json_array_foreach(rows, i, row)
    {
        if (!read_entry(r, row, font, entries))
            return false;
    }
    return true;
}

static bool read_contents(Reading *r, const json_t *root)
{
    const char *scene = json_string_value(json_object_get(root, "scene"));
    if (!scene || json_integer_value(json_object_get(root, "layout")) != PACK_LAYOUT)
        return refuse(r, "it is no pack, or made by a later krs", NULL);
    r->pack->scene = arena_copy_text(r->arena, scene, strlen(scene));
    return read_entries(r, json_object_get(root, "files"), false, &r->pack->files) &&
           read_entries(r, json_object_get(root, "fonts"), true, &r->pack->fonts) &&
           (pack_find(&r->pack->files, r->pack->scene) || refuse(r, "it lacks", r->pack->scene));
}

static bool read_archive(Reading *r)
{
    size_t      length;
    const char *text = read_member(r, PACK_CONTENTS, PACK_CONTENTS, &length);
    json_t     *root = text ? json_loadb(text, length, 0, NULL) : NULL;
    const bool  good = root ? read_contents(r, root)
                            : text && refuse(r, "it is damaged:", PACK_CONTENTS);
    json_decref(root);
    return good;
}

Pack *pack_read(Arena *arena, const char *path, size_t limit, Text *why)
{
    int     code;
    Pack   *pack = arena_new(arena, Pack);
    Reading r    = {.arena = arena, .pack = pack, .why = why, .limit = limit, .left = limit};
    *pack        = (Pack){.path = path};
    r.archive    = zip_open(path, ZIP_RDONLY, &code);
    if (!r.archive) {
        zip_error_t error;
        zip_error_init_with_code(&error, code);
        refuse(&r, zip_error_strerror(&error), NULL);
        zip_error_fini(&error);
        return NULL;
    }
    const bool good = read_archive(&r);
    zip_discard(r.archive);
    return good ? pack : NULL;
}
