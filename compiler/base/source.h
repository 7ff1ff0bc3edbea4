/*
 * source.h: the texts of a compilation and places in them.
 */
#ifndef KRS_SOURCE_H
#define KRS_SOURCE_H

#include <stdbool.h>
#include <stdint.h>

#include "compiler/base/arena.h"

/* Bytes [start, end) of source number `source`.  Source 0 is empty: its spans are for values that
   the compiler makes itself.  So a zero Span is valid. */
typedef struct Span {
    uint32_t source, start, end;
} Span;

typedef struct Source {
    const char *name; /* as the user gave it; shown in diagnostics */
    const char *text; /* NUL-terminated; may hold NUL bytes before its end */
    uint32_t    length;
    bool        library; /* part of the standard library */
    uint32_t   *lines;   /* offset of the first byte of each line, behind a byte order mark */
    uint32_t    line_count;
    uint32_t   *characters; /* number of characters that begin before each block */
} Source;

/* Bytes of a block.  To find a column at most two blocks are read, however long the line is. */
enum { SOURCE_BLOCK = 256 };

typedef struct Sources {
    Arena   *arena;
    Source  *items; /* items[0] is the empty source */
    size_t   count, capacity;
    uint64_t noted; /* a hash of the files that were read and are no texts; 0: there are none */
} Sources;

/* Line and column of a byte, both from 1; columns count UTF-8 characters. */
typedef struct Position {
    uint32_t line, column;
} Position;

/* A position as editors have it: both from 0; characters count UTF-16 units, of which one above U+FFFF has two. */
typedef struct Utf16Position {
    uint32_t line, character;
} Utf16Position;

enum { MAX_SOURCE_BYTES = 16 << 20 };

/* The reason that memory has run out. */
extern const char source_no_memory[];

/* Adds a copy of a text of at most MAX_SOURCE_BYTES and returns its number. */
uint32_t source_add(Sources *sources, const char *name, const char *text, size_t length,
                    bool library);
/* Notes a file that is no text, such as a picture, for the hash; and what has no path, under a word. */
void sources_note_file(Sources *sources, const char *path, const void *bytes, size_t length);
void sources_note(Sources *sources, const char *word, const void *bytes, size_t length);
/* Finds a hash of 64 bits, as hexadecimal digits, of all files that were read but the library's: of
   the path of each from the scene's folder, its length and its content. */
void          sources_hash(const Sources *sources, char hash[17]);
uint32_t      source_line(const Source *source, uint32_t offset);
Position      source_position(const Source *source, uint32_t offset);
Utf16Position source_utf16_position(const Source *source, uint32_t offset);
/* Returns the UTF-16 units between two offsets of a text. */
uint32_t utf16_units(const char *text, uint32_t start, uint32_t end);
/* Returns the offset of a position in a text; behind the end of a line, that end; behind the last
   line, the end of the text. */
uint32_t utf16_offset(const char *text, size_t length, Utf16Position position);

/* Returns the smallest span that contains both.  Of spans in different sources: `from`, unless that
   is in source 0. */
Span span_join(Span from, Span to);

#endif
