/*
 * source.h: the texts of a compilation and places in them.
 */
#ifndef KRS_SOURCE_H
#define KRS_SOURCE_H

#include <stdbool.h>
#include <stdint.h>

#include "compiler/base/arena.h"

/* Bytes [start, end) of source number `source`.  Source 0 is "no place" (values that the
   compiler makes itself), so a zero Span is always valid. */
typedef struct Span {
    uint32_t source, start, end;
} Span;

typedef struct Source {
    const char *name; /* as the user gave it; shown in diagnostics */
    const char *text; /* NUL-terminated; may hold NUL bytes before its end */
    uint32_t    length;
    bool        library; /* part of the standard library */
    uint32_t   *lines;   /* offset of the first byte of each line */
    uint32_t    line_count;
    uint32_t   *characters; /* how many begin before each SOURCE_BLOCK-th byte */
} Source;

enum { SOURCE_BLOCK = 256 }; /* bytes that are looked through to find a column, at most twice */

typedef struct Sources {
    Arena  *arena;
    Source *items; /* items[0] is the empty source */
    size_t  count, capacity;
} Sources;

/* Line and column of a byte, both from 1; columns count UTF-8 characters. */
typedef struct Position {
    uint32_t line, column;
} Position;

enum { MOST_SOURCE_BYTES = 16 << 20 };

/* The whole of a file, which the caller frees with free(); NULL, and *reason is a static text.  Of
   one that is longer than a source, no more than shows that. */
char *source_read(const char *path, size_t *length, const char **reason);
/* The same of an open file, which is closed. */
char *source_read_open(int fd, size_t *length, const char **reason);

/* Adds a copy of a text of at most MOST_SOURCE_BYTES and returns its number. */
uint32_t source_add(Sources *sources, const char *name, const char *text, size_t length,
                    bool library);
/* 64 bits of the text of all sources that are not the library's, in hexadecimal digits. */
void     sources_hash(const Sources *sources, char hash[17]);
uint32_t source_line(const Source *source, uint32_t offset);
Position source_position(const Source *source, uint32_t offset);

/* From the start of one place to the end of another in the same source. */
Span span_join(Span from, Span to);

#endif
