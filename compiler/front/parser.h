/*
 * parser.h: what the parse functions share: the token at hand, errors, recovery, nodes.
 *
 * When a rule fails, it reports once and sets `failed`.  From then on every look at the token
 * at hand shows TOKEN_ERROR, so that all rules in progress come to their end without reading
 * on or complaining; the loop over statements (or properties) in which this happened skips to
 * a place where it can continue, and takes the mark away.
 *
 * This header is for parser.c, parse_expression.c, parse_declaration.c and parse.c.
 */
#ifndef KRS_PARSER_H
#define KRS_PARSER_H

#include "compiler/front/syntax.h"

enum { MOST_NESTING = 200 };

/* Where a statement began, and what was open there. */
typedef struct Level {
    size_t   at;
    uint32_t brackets; /* of all three kinds */
    uint32_t braces;
} Level;

typedef struct Parser {
    const Token *tokens;
    size_t       count;
    const char  *text;
    Diags       *diags;
    Arena       *arena;
    Level        here;
    bool         failed;
    bool         abandoned; /* nested too deeply: only the file goes on, no block within */
    uint32_t     depth;     /* nesting now */
    size_t       unclosed;  /* the token at which something unclosed was last noticed */
    struct {
        Syntax **items;
        size_t   count, capacity;
    } pending; /* children of unfinished nodes */
} Parser;

typedef Syntax *ParseFunction(Parser *p);

typedef enum BlockKind { SCENE_BLOCK, KRS_BLOCK } BlockKind;

/* ---- tokens ---- */
TokenKind    kind_here(const Parser *p); /* TOKEN_ERROR after a failure */
TokenKind    kind_after(const Parser *p);
const Token *token_here(const Parser *p); /* the real one */
const Token *token_before(const Parser *p);
const Token *advance(Parser *p);
bool         accept(Parser *p, TokenKind kind);
/* A name, or a word that begins statements elsewhere. */
bool is_label(const Parser *p);
bool is_word_here(const Parser *p, const char *word);
/* Whether the token at hand begins a statement that cannot be part of an expression. */
bool begins_declaration(const Parser *p);

/* ---- errors ---- */
/* Reports something at a place without failing; after a failure it is not kept. */
Diag *report_at(Parser *p, DiagCode code, Span span, const char *message);
/* Fails with "expected WHAT, found ...". */
Diag *expected(Parser *p, const char *what);
/* The token, or NULL after failing with "expected WHAT". */
const Token *expect(Parser *p, TokenKind kind, const char *what, const char *help);
/* The name being defined; `of` is "of a `let`" and the like. */
const Token *expect_name(Parser *p, const char *of);
/* A label behind `.` or before `:`. */
const Token *expect_label(Parser *p, const char *what);
/* The end of what token number `opener` opened; `what` is all that could stand here. */
void expect_closer(Parser *p, TokenKind closer, size_t opener, const char *what);
/* The end of a statement; a forgotten one at the end of a line is reported and not needed. */
void expect_semicolon(Parser *p, const char *after);
/* `wanted` where `written` is often typed instead: reported, and read as if it were right. */
void expect_or_mend(Parser *p, TokenKind wanted, TokenKind written, const char *what);
/* Counts a level of nesting; leave() even when this fails. */
void enter(Parser *p);
void leave(Parser *p);

/* ---- recovery ---- */
/* Whether a statement that cannot stand in this block begins here, because the block was never
   closed. */
bool block_is_left(const Parser *p, size_t opener, BlockKind kind);
void recover_statement(Parser *p, Level start);
void recover_property(Parser *p, Level start);

/* ---- nodes ---- */
size_t begin_children(const Parser *p);
void   add_child(Parser *p, Syntax *child);
/* A node from `start` to the last token read, with the children added since `first`.  An
   expression in which something failed is a SYNTAX_ERROR as a whole. */
Syntax *finish(Parser *p, SyntaxKind kind, Span start, size_t first, const Token *name);
/* The same for a kind that has a name: a SYNTAX_ERROR without one. */
Syntax *finish_named(Parser *p, SyntaxKind kind, Span start, size_t first, const Token *name);
Syntax *error_node(Parser *p);

/* ---- the rules that others begin with ---- */
Syntax *parse_expression(Parser *p);
Syntax *parse_krs(Parser *p);
Syntax *parse_let(Parser *p);
Syntax *parse_def(Parser *p);
Syntax *parse_param(Parser *p);
Syntax *parse_shape(Parser *p);
Syntax *parse_material(Parser *p);
Syntax *parse_surroundings(Parser *p); /* a camera, a light and what else is around the scene */

#endif
