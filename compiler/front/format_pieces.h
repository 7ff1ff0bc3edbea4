/*
 * format_pieces.h: what format.c and format_pieces.c share: the words and comments of a text, in
 * order.
 */
#ifndef KRS_FORMAT_PIECES_H
#define KRS_FORMAT_PIECES_H

#include "compiler/front/token.h"

/* A TokenKind, or one of these. */
typedef uint32_t PieceKind;
enum { PIECE_LINE_COMMENT = TOKEN_KIND_COUNT, PIECE_BLOCK_COMMENT };

/* Columns count characters, from 0. */
typedef struct Piece {
    PieceKind kind;
    uint32_t  start, end; /* bytes of the text */
    uint32_t  newlines;   /* line ends before it; 0: it stands behind another piece */
    uint32_t  width;      /* in columns; of a comment of many lines, that of the last line */
    bool      many_lines;
    uint32_t  from, to; /* the column where it begins: as it was, and in the new layout */
    size_t    above;    /* 1 + the first piece of the line above (find_statements), or 0 */
    uint32_t  column;   /* 1 + index of the column of pieces that it belongs to, or 0 */
} Piece;

typedef struct Pieces {
    const char *text;
    Piece      *items;
    size_t      count, capacity;
} Pieces;

/* Tells whether nothing is seen of a character at the end of a line. */
bool is_line_blank(char c);

/* Reads the pieces of a source without mistakes. */
Pieces read_pieces(uint32_t source, const Sources *sources, Arena *arena);
/* Tells whether both texts have the same words and comments. */
bool pieces_equal(const Pieces *a, const Pieces *b);

/* Returns the word before piece `index`, past comments, or NULL. */
const Piece *word_before(const Pieces *pieces, size_t index);
/* Tells whether a line that begins with this goes on with the statement above, even behind a `}`. */
bool goes_on(PieceKind kind);
/* Blanks between piece `index` and the one before it in the same line: 0 or 1. */
uint32_t natural_gap(const Pieces *pieces, size_t index);
/* Tells whether a value begins with piece `index`, such that lines below may begin in its column. */
bool begins_value(const Pieces *pieces, size_t index);

#endif
