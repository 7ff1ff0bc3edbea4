/*
 * cryptomatte.c: the specification 1.2 of Cryptomatte (Friedman and Jones, Psyop 2015).
 *
 * A layer has a name, and channels NAME00.R, .G, .B, .A, NAME01.R and so on: pairs of an identifier
 * and the share of the pixel that it covers.  An identifier is the hash of a name, whose bits are
 * those of a float.  The manifest tells the names.
 */
#include "cli/picture/cryptomatte.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/json.h"

static const char *const layer_names[KRS_MATTE_COUNT] = {[KRS_MATTE_COMPONENTS] = "CryptoComponent",
                                                         [KRS_MATTE_INSTANCES]  = "CryptoInstance",
                                                         [KRS_MATTE_MATERIALS]  = "CryptoMaterial"};

/* ---- identifiers ---- */

static uint32_t rotate(uint32_t word, int by) { return word << by | word >> (32 - by); }

static uint32_t mixed(uint32_t word) { return rotate(word * 0xcc9e2d51, 15) * 0x1b873593; }

/* Returns up to four bytes as a word, the first lowest. */
static uint32_t word_of(const unsigned char *bytes, size_t count)
{
    uint32_t word = 0;
    for (size_t i = 0; i < count; i++)
        word |= (uint32_t)bytes[i] << 8 * i;
    return word;
}

uint32_t murmur_hash(const char *text)
{
    const unsigned char *bytes  = (const unsigned char *)text;
    const size_t         length = strlen(text), whole = length / 4 * 4;
    uint32_t             hash = 0;
    for (size_t i = 0; i < whole; i += 4)
        hash = rotate(hash ^ mixed(word_of(bytes + i, 4)), 13) * 5 + 0xe6546b64;
    hash ^= mixed(word_of(bytes + whole, length - whole));
    hash ^= (uint32_t)length;
    hash = (hash ^ hash >> 16) * 0x85ebca6b;
    hash = (hash ^ hash >> 13) * 0xc2b2ae35;
    return hash ^ hash >> 16;
}

uint32_t matte_identifier(uint32_t hash)
{
    const uint32_t exponent = hash >> 23 & 255;
    return exponent == 0 || exponent == 255 ? hash ^ 1u << 23 : hash;
}

/* ---- names ---- */

/* The parts in a picture, without repetition, and the identifier of each. */
typedef struct Parts {
    struct Part {
        KrsMatte part;
        uint32_t identifier;
    } * items;
    size_t count;
} Parts;

static int compare_parts(const void *a, const void *b)
{
    const KrsMatte *first = a, *second = b; /* each is the first member */
    if (first->part != second->part)
        return first->part < second->part ? -1 : 1;
    return (first->instance > second->instance) - (first->instance < second->instance);
}

static void name_of(const KrsScene *scene, const KrsMatte *part, KrsMatteKind kind, Text *name)
{
    KrsComponent component;
    const char  *material = krs_material_name(scene, part->part);
    if (kind == KRS_MATTE_MATERIALS) {
        text_add(name, material ? material : "unpainted");
        return;
    }
    krs_component(scene, part->part - 1, &component);
    text_add(name, component.name);
    if (kind == KRS_MATTE_INSTANCES)
        text_format(name, "/%u", part->instance);
}

static size_t entries_of(const KrsPicture *picture)
{
    return (size_t)picture->window.width * picture->window.height * KRS_MATTE_RANKS;
}

/* Lists what is in the picture; `items` is for free(), NULL: out of memory. */
static Parts list_parts(const KrsPicture *picture, KrsMatteKind kind)
{
    Parts parts = {.items = malloc((entries_of(picture) + 1) * sizeof *parts.items)};
    for (size_t i = 0; parts.items && i < entries_of(picture); i++)
        if (picture->mattes[kind][i].rays > 0)
            parts.items[parts.count++].part = picture->mattes[kind][i];
    if (!parts.items)
        return parts;
    size_t listed = parts.count;
    qsort(parts.items, listed, sizeof *parts.items, compare_parts);
    parts.count = 0;
    for (size_t i = 0; i < listed; i++)
        if (i == 0 || compare_parts(&parts.items[parts.count - 1], &parts.items[i]) != 0)
            parts.items[parts.count++] = parts.items[i];
    return parts;
}

/* A name of the manifest. */
typedef struct NamedPart {
    const char *name;
    uint32_t    identifier;
} NamedPart;

static int compare_names(const void *a, const void *b)
{
    const NamedPart *x = a, *y = b;
    return strcmp(x->name, y->name);
}

/* Returns the manifest, {"tree": "1a2b3c4d", ...}, by the names, so that those of parts of a picture can be put
   together; sets the identifiers. */
static const char *manifest_of(Arena *arena, const KrsScene *scene, Parts *parts, KrsMatteKind kind)
{
    Json       manifest = {.text = {.arena = arena}, .spaced = true};
    NamedPart *named    = arena_new_array(arena, NamedPart, parts->count + 1);
    for (size_t i = 0; i < parts->count; i++) {
        Text name = {.arena = arena};
        name_of(scene, &parts->items[i].part, kind, &name);
        parts->items[i].identifier = matte_identifier(murmur_hash(name.bytes));
        named[i]                   = (NamedPart){name.bytes, parts->items[i].identifier};
    }
    qsort(named, parts->count, sizeof *named, compare_names);
    json_open(&manifest, NULL, "{");
    for (size_t i = 0; i < parts->count; i++) {
        char identifier[9];
        snprintf(identifier, sizeof identifier, "%08x", named[i].identifier);
        json_text(&manifest, named[i].name, identifier);
    }
    json_close(&manifest, "}");
    return manifest.text.bytes;
}

/* Adds the texts of a layer under keys such as "cryptomatte/1a2b3c4/name", whose digits are the
   first seven of the layer's hash. */
static void add_texts(Arena *arena, const char *layer, const char *manifest, PictureText texts[4])
{
    static const char *const members[] = {"name", "hash", "conversion", "manifest"};
    const char              *values[]  = {layer, "MurmurHash3_32", "uint32_to_float32", manifest};
    for (int i = 0; i < 4; i++) {
        Text name = {.arena = arena};
        text_format(&name, "cryptomatte/%07x/%s", murmur_hash(layer) >> 4, members[i]);
        texts[i] = (PictureText){name.bytes, values[i]};
    }
}

/* ---- channels ---- */

/* Fills an identifier and a share for each rank, pixel by pixel. */
static void fill_values(const KrsPicture *picture, KrsMatteKind kind, const Parts *parts,
                        float *values)
{
    for (size_t i = 0; i < entries_of(picture); i++) {
        const KrsMatte *entry = &picture->mattes[kind][i];
        values[2 * i] = values[2 * i + 1] = 0;
        if (entry->rays == 0)
            continue;
        const uint32_t     samples = picture->pixel_samples
                                         ? picture->pixel_samples[i / KRS_MATTE_RANKS]
                                         : picture->samples;
        const struct Part *part = bsearch(entry, parts->items, parts->count, sizeof *parts->items,
                                          compare_parts);
        memcpy(&values[2 * i], &part->identifier, sizeof part->identifier);
        values[2 * i + 1] = (float)entry->rays / (float)samples;
    }
}

static void add_channels(Arena *arena, const char *layer, const float *values,
                         PictureChannel *channels)
{
    for (uint32_t i = 0; i < 2 * KRS_MATTE_RANKS; i++) {
        Text name = {.arena = arena};
        text_format(&name, "%s%02u.%c", layer, i / 4, "RGBA"[i % 4]);
        channels[i] = (PictureChannel){.name    = name.bytes,
                                       .type    = SAMPLE_FLOAT,
                                       .samples = values + i,
                                       .stride  = 2 * KRS_MATTE_RANKS};
    }
}

bool cryptomatte_make(Arena *arena, const KrsPicture *picture, const KrsScene *scene,
                      Cryptomatte *matte)
{
    const size_t numbers = 2 * entries_of(picture);
    matte->values        = malloc(KRS_MATTE_COUNT * numbers * sizeof(float));
    for (int kind = 0; kind < KRS_MATTE_COUNT && matte->values; kind++) {
        Parts parts = list_parts(picture, kind);
        if (!parts.items) {
            free(matte->values);
            return false;
        }
        const char *manifest = manifest_of(arena, scene, &parts, kind);
        float      *values   = matte->values + kind * numbers;
        add_texts(arena, layer_names[kind], manifest, matte->texts + 4 * kind);
        fill_values(picture, kind, &parts, values);
        add_channels(arena, layer_names[kind], values,
                     matte->channels + kind * 2 * KRS_MATTE_RANKS);
        free(parts.items);
    }
    return matte->values != NULL;
}
