/*
 * token.h: the words of the language.
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
    const char *name;      /* words: interned; STRING: the text, unescaped */
    double      number[3]; /* NUMBER: [0]; COLOUR: linear Rec.709 */
    const char *doc;       /* text of the `///` comment lines just before, or NULL */
} Token;

/* "`let`", "a number", "the end of the file": how messages call a token. */
const char *token_kind_text(TokenKind kind);

/* Words that begin a statement; behind a point and before a `:` they are ordinary names. */
bool token_is_statement_word(TokenKind kind);

typedef struct Tokens {
    Token *items; /* the last one is TOKEN_END */
    size_t count, capacity;
} Tokens;

/* Splits a source into tokens.  A bad run of bytes is reported once and becomes one
   TOKEN_ERROR.  `kernel`, `reflect` and `mobius` are plain names here: only the parser knows
   where they begin a statement. */
Tokens lex(uint32_t source, const Sources *sources, Names *names, Diags *diags, Arena *arena);

/* 0xrrggbb as linear light. */
void linear_from_srgb(uint32_t rgb, double linear[3]);

/* One token a line, for `krs dump --after=tokens`. */
void tokens_print(const Tokens *tokens, const Sources *sources, Text *out);

#endif
