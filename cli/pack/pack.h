/*
 * pack.h: a scene and all that it reads as one file, a .krsz.
 *
 * It is a ZIP archive.  pack.json names the scene, and for each path that the scene reads the hash of what is there,
 * likewise for fonts; files/HASH is what has that hash.  Paths are from the folder of the scene, in which the pack
 * stands for nothing: whoever reads a scene from it reads nothing from the disk but the pack.
 */
#ifndef KRS_PACK_H
#define KRS_PACK_H

#include <stdbool.h>
#include <stddef.h>

#include "cli/pack/archive.h"
#include "compiler/base/text.h"
#include "krs/krs.h"

#define PACK_ENDING ".krsz"

/* A file of a pack, or a font. */
typedef struct PackEntry {
    const char
        *name; /* path from the folder of the scene, or the name of a font; NULL: the usual font */
    int  face; /* of several in a font */
    const char *bytes;
    size_t      length;
} PackEntry;

typedef struct PackEntries {
    PackEntry *items;
    size_t     count, capacity;
} PackEntries;

typedef struct Pack Pack;
struct Pack {
    const char *path;  /* of the pack itself */
    const char *scene; /* the scene's name, which is that of an entry of `files` */
    PackEntries files, fonts;
    Pack       *next; /* of those that a command has opened */
};

/* Tells whether a file of this name is a pack. */
bool pack_is_named(const char *path);

/* Reads a pack, of which what is in it may have so many bytes in all.  NULL: it cannot be read, for the reason in `why`. */
Pack *pack_read(Arena *arena, const char *path, size_t limit, Text *why);

/* Returns the entry of a name, which NULL is as well; NULL: there is none. */
const PackEntry *pack_find(const PackEntries *entries, const char *name);
/* Functions for KrsOptions, which supply what is in the pack that they are handed. */
KrsLoadCallback pack_load;
KrsFontCallback pack_font;

/* Writes a pack; false: the sink failed, or memory has run out. */
bool pack_write(Arena *arena, const Pack *pack, ArchiveSink *sink, void *user);

/* ---- what the reader and the writer share ---- */

/* The file of the archive that says what is in it. */
#define PACK_CONTENTS "pack.json"

enum {
    PACK_LAYOUT = 1, /* the version of the layout: packs of a later one are refused */
    PACK_HASH   = 33 /* bytes of a hash as a text */
};

/* Writes the hash of bytes in hexadecimal digits: XXH3 of 128 bits. */
void pack_hash(const char *bytes, size_t length, char text[PACK_HASH]);

#endif
