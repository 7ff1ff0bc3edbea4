/*
 * pack.c: what is in a pack.
 */
#include <stdio.h>
#include <string.h>
#include <xxhash.h>

#include "cli/pack/pack.h"

bool pack_is_named(const char *path)
{
    const size_t length = strlen(path), ending = strlen(PACK_ENDING);
    return length > ending && strcmp(path + length - ending, PACK_ENDING) == 0;
}

void pack_hash(const char *bytes, size_t length, char text[PACK_HASH])
{
    XXH128_canonical_t hash;
    XXH128_canonicalFromHash(&hash, XXH3_128bits(bytes, length));
    for (size_t i = 0; i < sizeof hash.digest; i++)
        snprintf(text + 2 * i, 3, "%02x", hash.digest[i]);
}

static bool is_same_name(const char *a, const char *b)
{
    return a && b ? strcmp(a, b) == 0 : a == b;
}

const PackEntry *pack_find(const PackEntries *entries, const char *name)
{
    for (size_t i = 0; i < entries->count; i++)
        if (is_same_name(entries->items[i].name, name))
            return &entries->items[i];
    return NULL;
}

const char *pack_load(void *user, const char *path, size_t *length)
{
    const Pack      *pack = user;
    const PackEntry *file = pack_find(&pack->files, path);
    *length               = file ? file->length : 0;
    return file ? file->bytes : NULL;
}

const char *pack_font(void *user, const char *name, size_t *length, int *face)
{
    const Pack      *pack = user;
    const PackEntry *font = pack_find(&pack->fonts, name);
    *length               = font ? font->length : 0;
    *face                 = font ? font->face : 0;
    return font ? font->bytes : NULL;
}
