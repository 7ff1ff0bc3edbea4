/*
 * pack_write.c: writes packs.
 */
#include <stdio.h>
#include <string.h>

#include "cli/pack/pack.h"
#include "compiler/base/json.h"

typedef struct ArchiveFiles {
    ArchiveFile *items;
    size_t       count, capacity;
} ArchiveFiles;

/* Adds what has that hash, once. */
static void add_content(Arena *arena, ArchiveFiles *files, const PackEntry *entry, const char *hash)
{
    Text name = {.arena = arena};
    text_format(&name, "files/%s", hash);
    for (size_t i = 0; i < files->count; i++)
        if (strcmp(files->items[i].name, name.bytes) == 0)
            return;
    array_push(arena, files, ((ArchiveFile){name.bytes, entry->bytes, entry->length}));
}

static void add_entries(Arena *arena, Json *json, const char *heading, const PackEntries *entries,
                        bool fonts, ArchiveFiles *files)
{
    json_open(json, heading, "[");
    for (size_t i = 0; i < entries->count; i++) {
        const PackEntry *entry = &entries->items[i];
        char             hash[PACK_HASH];
        pack_hash(entry->bytes, entry->length, hash);
        json_open(json, NULL, "{");
        json_text(json, "name", entry->name);
        if (fonts)
            json_whole(json, "face", (uint64_t)entry->face);
        json_text(json, "hash", hash);
        json_close(json, "}");
        add_content(arena, files, entry, hash);
    }
    json_close(json, "]");
}

bool pack_write(Arena *arena, const Pack *pack, ArchiveSink *sink, void *user)
{
    ArchiveFiles files = {0};
    Json         json  = {.text = {.arena = arena}, .spaced = true};
    array_push(arena, &files, (ArchiveFile){.name = PACK_CONTENTS});
    json_open(&json, NULL, "{");
    json_whole(&json, "layout", PACK_LAYOUT);
    json_text(&json, "scene", pack->scene);
    add_entries(arena, &json, "files", &pack->files, false, &files);
    add_entries(arena, &json, "fonts", &pack->fonts, true, &files);
    json_close(&json, "}");
    files.items[0].bytes  = json.text.bytes;
    files.items[0].length = json.text.length;
    return archive_write(files.items, files.count, sink, user);
}
