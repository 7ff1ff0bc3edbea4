/*
 * parser.h: what the parse functions share: the current token, errors, recovery, nodes.
 *
 * When a rule fails, it reports once and sets `failed`.  From then on the current token appears to
 * be TOKEN_ERROR.  So all rules in progress return without reading or reporting more.  Then the
 * innermost loop over statements or properties skips to the next one and clears `failed`.
 *
 * This header is for parser.c, parse_expression.c, parse_declaration.c and parse.c.
 */
#ifndef KRS_PARSER_H
#define KRS_PARSER_H

#include "compiler/front/syntax.h"

enum { MAX_NESTING = 200 };

/* A position, and how many brackets are open there. */
typedef struct Level {
    size_t   at;       /* index of the next token */
    uint32_t brackets; /* open brackets of all three kinds */
    uint32_t braces;   /* open braces */
} Level;

typedef struct Parser {
    const Token *tokens;
    size_t       count;
    const char  *text;
    Diags       *diags;
    Arena       *arena;
    Level        here; /* of the current token, the next one to be read */
    bool         failed;
    bool         abandoned;  /* nested too deeply: recovery is at the next top-level statement */
    uint32_t     depth;      /* of nesting */
    size_t       bare_range; /* index of the `[` of a range that lacks its `in`; 0: none */
    size_t       unclosed;   /* index of the token before which an unclosed bracket was reported */
    struct {
        Syntax **items;
        size_t   count, capacity;
    } pending; /* children of unfinished nodes */
} Parser;

typedef Syntax *ParseFunction(Parser *p);

typedef enum BlockKind { SCENE_BLOCK, KRS_BLOCK } BlockKind;

/* ---- tokens ---- */
/* These return the kinds of the current token and of the one after it; TOKEN_ERROR after a
   failure. */
TokenKind kind_here(const Parser *p);
TokenKind kind_after(const Parser *p);
/* These return the current token and the one before it, even after a failure. */
const Token *token_here(const Parser *p);
const Token *token_before(const Parser *p);
/* Moves to the next token and returns the one that was current; accept() only if it has a kind. */
const Token *advance(Parser *p);
bool         accept(Parser *p, TokenKind kind);
/* Tells whether the current token can name a property or argument: a name, or a word that begins
   statements elsewhere. */
bool is_label(const Parser *p);
bool is_word_here(const Parser *p, const char *word);
/* Tells whether `print(` or `assert(` is next; without a parenthesis these are names. */
bool at_message(const Parser *p);
bool names_message(const char *name);
/* Tells whether the current token begins a statement that cannot be part of an expression. */
bool begins_declaration(const Parser *p);

/* ---- errors ---- */
/* Reports a mistake without failing; after a failure it is not stored. */
Diag *report_at(Parser *p, DiagCode code, Span span, const char *message);
/* Fails with "expected WHAT, found ...". */
Diag *expected(Parser *p, const char *what);
/* Reads a token of this kind and returns it; NULL after failing with "expected WHAT". */
const Token *expect(Parser *p, TokenKind kind, const char *what, const char *help);
/* Reads the name that is being defined; `of` tells of what, as in "of a `let`". */
const Token *expect_name(Parser *p, const char *of);
/* Reads a label, behind `.` or before `:`. */
const Token *expect_label(Parser *p, const char *what);
/* Reads the bracket that closes token number `opener`; `what` names all that is permitted here. */
void expect_closer(Parser *p, TokenKind closer, size_t opener, const char *what);
/* Reads the `;` behind a statement.  Where it is missing at the end of a line this is reported, and
   parsing continues as if it were there. */
void expect_semicolon(Parser *p, const char *after);
/* Reads the token `wanted`.  `written` is a common mistake: it is reported and accepted. */
void expect_or_mend(Parser *p, TokenKind wanted, TokenKind written, const char *what);
/* Counts a level of nesting; leave() must be called even when this fails. */
void enter(Parser *p);
void leave(Parser *p);

/* ---- recovery ---- */
/* Tells whether a statement begins here that this block cannot have, because its brace is missing. */
bool block_is_left(const Parser *p, size_t opener, BlockKind kind);
/* Goes, after a mistake, behind a declaration with a block that stands where none may. */
void skip_declaration(Parser *p);
/* Skips, after a failure, the rest of the statement, or property, that began at `start`. */
void recover_statement(Parser *p, Level start);
void recover_property(Parser *p, Level start);

/* ---- nodes ---- */
size_t begin_children(const Parser *p);
void   add_child(Parser *p, Syntax *child);
/* Returns a node from `start` to the last token that was read, with the children added since
   `first`.  An expression in which something failed is a SYNTAX_ERROR. */
Syntax *finish(Parser *p, SyntaxKind kind, Span start, size_t first, const Token *name);
/* Returns the same for a kind that needs a name: a SYNTAX_ERROR if that is NULL. */
Syntax *finish_named(Parser *p, SyntaxKind kind, Span start, size_t first, const Token *name);
Syntax *error_node(Parser *p);

/* ---- rules that other files use ---- */
Syntax *parse_expression(Parser *p);
Syntax *parse_krs(Parser *p);
Syntax *parse_message(Parser *p);
Syntax *parse_let(Parser *p);
Syntax *parse_def(Parser *p);
Syntax *parse_param(Parser *p);
Syntax *parse_shape(Parser *p);
Syntax *parse_material(Parser *p);
Syntax *parse_surroundings(Parser *p); /* a camera, light, sky, fog, image or zone */

#endif
