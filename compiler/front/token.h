/*
 * token.h: tokens, and the lexer that makes them.
 */
#ifndef KRS_TOKEN_H
#define KRS_TOKEN_H

#include "compiler/base/diag.h"

typedef enum TokenKind {
#define TOKEN(name, spelling, class) TOKEN_##name,
#include "compiler/front/token.def"
#undef TOKEN
    TOKEN_KIND_COUNT
} TokenKind;

typedef struct Token {
    TokenKind   kind;
    Span        span;
    const char *doc; /* text of the `///` comment lines just before, or NULL */
    union {
        const char *name;   /* names and keywords: interned; STRING: the text, unescaped */
        double      number; /* NUMBER */
        uint32_t    rgb;    /* COLOUR: 0xrrggbb */
    };
} Token;

/* Returns what messages call a token: "`let`", "a number", "the end of the file". */
const char *token_kind_text(TokenKind kind);

/* Tells whether a keyword begins a statement; behind `.` and before `:` such words are names. */
bool token_is_statement_word(TokenKind kind);

/* Tells whether a token is a bracket of one of the three kinds. */
bool token_opens(TokenKind kind);
bool token_closes(TokenKind kind);

/* Returns the words that may begin a statement, in the order of token.def; how many there are: at most
   TOKEN_KIND_COUNT. */
size_t token_statements(const char **words);

typedef struct Tokens {
    Token *items; /* the last one is TOKEN_END */
    size_t count, capacity;
} Tokens;

/* Splits a source into tokens.  A run of bytes that are no token is reported once and becomes one
   TOKEN_ERROR.  `kernel`, `reflect` and `mobius` are ordinary names here: they begin statements
   only where the parser expects them. */
Tokens lex(uint32_t source, const Sources *sources, Names *names, Diags *diags, Arena *arena);

/* Converts 0xrrggbb to linear light. */
void linear_from_srgb(uint32_t rgb, double linear[3]);

/* Writes a token in each line, for `krs dump --after=lex`. */
void tokens_print(const Tokens *tokens, const Sources *sources, Text *out);

#endif
