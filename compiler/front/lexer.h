/*
 * lexer.h: what lexer.c and lex_literals.c share: where reading has come to, and what is made of
 * what was read.
 */
#ifndef KRS_LEXER_H
#define KRS_LEXER_H

#include "compiler/front/token.h"

typedef struct Lexer {
    const char *text;
    uint32_t    length, at;
    uint32_t    source;
    uint32_t    line_end; /* of the line that was last asked for; or 0 */
    Names      *names;
    Diags      *diags;
    Arena      *arena;
    Tokens      tokens;
    Text        doc;         /* the `///` lines since the last token */
    Text        scratch;     /* of the number or string being read */
    bool        begins[256]; /* find_beginnings */
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

/* The byte `ahead` of here; NUL behind the end. */
static inline char peek(const Lexer *lexer, uint32_t ahead)
{
    return ahead < lexer->length - lexer->at ? lexer->text[lexer->at + ahead] : '\0';
}

static inline Span span_from(const Lexer *lexer, uint32_t start)
{
    return (Span){lexer->source, start, lexer->at};
}

/* ---- lexer.c ---- */
/* The token from `start` up to here, with the documentation before it. */
Token *add_token(Lexer *lexer, TokenKind kind, uint32_t start);
/* Something wrong from `start` up to here; `help` may be NULL. */
Diag *report_from(Lexer *lexer, DiagCode code, uint32_t start, const char *message,
                  const char *help);
/* Moves to `end`.  The bytes up to there, the inside of a comment or string, must be UTF-8. */
void skip_text(Lexer *lexer, uint32_t end);
/* Where the line that is being read ends. */
uint32_t find_line_end(Lexer *lexer);

/* ---- lex_literals.c: each reads the token that begins here ---- */
void lex_number(Lexer *lexer);
void lex_colour(Lexer *lexer);
void lex_string(Lexer *lexer, char quote);

#endif
