/*
 * lexer.h: what lexer.c and lex_literals.c share: the position in the text and the tokens so far.
 */
#ifndef KRS_LEXER_H
#define KRS_LEXER_H

#include "compiler/front/token.h"

typedef struct Lexer {
    const char *text;
    uint32_t    length, at; /* bytes of the text; offset of the next byte */
    uint32_t    source;
    uint32_t    line_end; /* result of the last find_line_end, or 0 */
    Names      *names;
    Diags      *diags;
    Arena      *arena;
    Tokens      tokens;
    Text        doc;     /* the `///` lines since the last token */
    Text        scratch; /* the number or string being read */
    /* By the first byte: find_beginnings. */
    bool    begins[256];    /* whether something can begin with it */
    bool    lookalike[256]; /* whether a lookalike can */
    uint8_t sign[256];      /* the first kind of token that is a sign and begins with it */
} Lexer;

/* ---- characters ---- */

/* ASCII only, whatever the locale. */
static inline bool is_digit(char c) { return c >= '0' && c <= '9'; }
static inline bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
static inline bool is_word(char c) { return is_letter(c) || is_digit(c); }
static inline bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/* The byte that is `ahead` bytes behind the next one; NUL beyond the end. */
static inline char peek(const Lexer *lexer, uint32_t ahead)
{
    return ahead < lexer->length - lexer->at ? lexer->text[lexer->at + ahead] : '\0';
}

static inline Span span_from(const Lexer *lexer, uint32_t start)
{
    return (Span){lexer->source, start, lexer->at};
}

/* ---- lexer.c ---- */
/* Adds the token from `start` up to here, with the documentation before it. */
Token *add_token(Lexer *lexer, TokenKind kind, uint32_t start);
/* Reports a mistake in the bytes from `start` up to here; `help` may be NULL. */
Diag *report_from(Lexer *lexer, DiagCode code, uint32_t start, const char *message,
                  const char *help);
/* Skips the inside of a comment or string, up to `end`.  Bytes that are not UTF-8 are reported. */
void skip_text(Lexer *lexer, uint32_t end);
/* The offset of the end of the line that is being read. */
uint32_t find_line_end(Lexer *lexer);

/* ---- lex_literals.c: each reads the token that begins here ---- */
void lex_number(Lexer *lexer);
void lex_colour(Lexer *lexer);
void lex_string(Lexer *lexer, char quote);

#endif
