/*
 * parser.c: the current token, errors, recovery, and nodes of the tree.
 */
#include "compiler/front/parser.h"

#include <string.h>

#include "compiler/front/synonyms.h"

/* ---- tokens ---- */

static TokenKind kind_at(const Parser *p, size_t at)
{
    return p->tokens[at < p->count ? at : p->count - 1].kind;
}

const Token *token_here(const Parser *p) { return &p->tokens[p->here.at]; }
const Token *token_before(const Parser *p) { return &p->tokens[p->here.at ? p->here.at - 1 : 0]; }

TokenKind kind_here(const Parser *p) { return p->failed ? TOKEN_ERROR : token_here(p)->kind; }

TokenKind kind_after(const Parser *p)
{
    return p->failed ? TOKEN_ERROR : kind_at(p, p->here.at + 1);
}

const Token *advance(Parser *p)
{
    const Token *token = token_here(p);
    p->here.brackets += token_opens(token->kind);
    p->here.braces += token->kind == TOKEN_LEFT_BRACE;
    p->here.brackets -= token_closes(token->kind) && p->here.brackets > 0;
    p->here.braces -= token->kind == TOKEN_RIGHT_BRACE && p->here.braces > 0;
    if (token->kind != TOKEN_END)
        p->here.at++;
    return token;
}

bool accept(Parser *p, TokenKind kind)
{
    if (kind_here(p) != kind)
        return false;
    advance(p);
    return true;
}

bool is_label(const Parser *p)
{
    return kind_here(p) == TOKEN_NAME || token_is_statement_word(kind_here(p));
}

bool is_word_here(const Parser *p, const char *word)
{
    return kind_here(p) == TOKEN_NAME && strcmp(token_here(p)->name, word) == 0;
}

bool names_message(const char *name)
{
    return strcmp(name, "print") == 0 || strcmp(name, "assert") == 0;
}

bool at_message(const Parser *p)
{
    return kind_here(p) == TOKEN_NAME && names_message(token_here(p)->name) &&
           kind_after(p) == TOKEN_LEFT_PAREN;
}

/* Tells whether the current token is the first on its line. */
static bool begins_line(const Parser *p)
{
    if (p->here.at == 0)
        return true;
    uint32_t end = token_before(p)->span.end;
    return memchr(p->text + end, '\n', token_here(p)->span.start - end) != NULL;
}

bool begins_declaration(const Parser *p)
{
    TokenKind kind = token_here(p)->kind, before = token_before(p)->kind;
    bool      free = before == TOKEN_SEMICOLON || before == TOKEN_RIGHT_BRACE || begins_line(p);
    return token_is_statement_word(kind) && kind != TOKEN_LET && kind != TOKEN_KRS && free &&
           kind_at(p, p->here.at + 1) != TOKEN_COLON && before != TOKEN_DOT;
}

/* Tells whether a brace is closed anywhere.  This reads up to the end of the file, but only after a
   mistake. */
static bool brace_is_closed(const Parser *p, size_t opener)
{
    size_t open = 0;
    for (size_t at = opener; at < p->count; at++) {
        open += kind_at(p, at) == TOKEN_LEFT_BRACE;
        open -= kind_at(p, at) == TOKEN_RIGHT_BRACE;
        if (open == 0)
            return true;
    }
    return false;
}

/* ---- errors ---- */

Diag *report_at(Parser *p, DiagCode code, Span span, const char *message)
{
    return p->failed ? &p->diags->scrap : diag_add(p->diags, code, span, "%s", message);
}

/* Returns the span of the current token; at the end of the file, the end of the last token. */
static Span span_here(const Parser *p)
{
    Span span = token_here(p)->span;
    if (token_here(p)->kind == TOKEN_END)
        span.start = span.end = token_before(p)->span.end;
    return span;
}

static Span end_of_previous(const Parser *p)
{
    Span span  = token_before(p)->span;
    span.start = span.end;
    return span;
}

static const char *describe(Parser *p, const Token *token)
{
    enum { LONGEST = 40 };
    if (token->kind == TOKEN_NAME && strlen(token->name) <= LONGEST)
        return diag_text(p->diags, "the name `%s`", token->name);
    return token_kind_text(token->kind);
}

/* Explains what follows a call in other languages: the shapes that it is for. */
static void explain_call(Parser *p, Diag *diag, TokenKind found)
{
    if (found == TOKEN_LEFT_BRACE)
        diag->help = form_help(p->diags, FORM_BLOCK_OF_CALL);
    else if (found == TOKEN_NAME &&
             !explain_word(p->diags, diag, SYNONYM_STATEMENT, token_here(p)->name, ""))
        diag->help = form_help(p->diags, FORM_SHAPE_BEHIND);
}

static void fail(Parser *p) { p->failed = true; }

Diag *expected(Parser *p, const char *what)
{
    const Token *found    = token_here(p);
    bool         reported = p->failed || found->kind == TOKEN_ERROR; /* by the lexer */
    Diag        *diag     = &p->diags->scrap;
    if (!reported) {
        const char *text = describe(p, found);
        diag             = report_at(p, DIAG_UNEXPECTED_TOKEN, span_here(p),
                                     diag_text(p->diags, "expected %s, found %s", what, text));
        bool unit        = found->kind == TOKEN_NAME && strcmp(found->name, "deg") == 0;
        if (unit && p->here.at > 0 && token_before(p)->kind == TOKEN_NUMBER)
            diag->help = "`deg` touches its number: `30deg`";
        else if (found->kind == TOKEN_LEFT_BRACE && p->here.at > 0 &&
                 token_before(p)->kind == TOKEN_NAME)
            diag->help = form_help(p->diags, FORM_BRACES);
        else if (p->here.at > 0 && token_before(p)->kind == TOKEN_RIGHT_PAREN)
            explain_call(p, diag, found->kind);
    }
    fail(p);
    return diag;
}

const Token *expect(Parser *p, TokenKind kind, const char *what, const char *help)
{
    if (kind_here(p) == kind)
        return advance(p);
    Diag *diag = expected(p, what);
    if (!diag->help)
        diag->help = help;
    return NULL;
}

const Token *expect_name(Parser *p, const char *of)
{
    if (kind_here(p) == TOKEN_NAME)
        return advance(p);
    TokenKind found = kind_here(p);
    Diag     *diag  = expected(p, diag_text(p->diags, "the name %s", of));
    if (found >= TOKEN_LET && found < TOKEN_LEFT_PAREN)
        diag->help = "this is a word of the language; choose another name";
    return NULL;
}

const Token *expect_label(Parser *p, const char *what)
{
    if (is_label(p))
        return advance(p);
    expected(p, what);
    return NULL;
}

/* Reports a bracket that is not closed before the current token.  Of several brackets that lack
   their end at one token, only the first is reported. */
static void report_unclosed(Parser *p, TokenKind closer, size_t opener)
{
    if (p->unclosed != p->here.at || p->here.at == 0) {
        const Token *open    = &p->tokens[opener];
        const char  *message = diag_text(p->diags, "%s is not closed", token_kind_text(open->kind));
        Diag        *diag    = report_at(p, DIAG_UNCLOSED, open->span, message);
        diag->label          = "opened here";
        diag_secondary(p->diags, diag, span_here(p),
                       diag_text(p->diags, "%s is missing before this", token_kind_text(closer)));
    }
    p->unclosed = p->here.at;
}

void expect_closer(Parser *p, TokenKind closer, size_t opener, const char *what)
{
    TokenKind found = kind_here(p);
    if (p->failed || accept(p, closer))
        return;
    bool unclosed = found == TOKEN_END || begins_declaration(p);
    if (closer == TOKEN_RIGHT_BRACE)
        unclosed = unclosed && !brace_is_closed(p, opener);
    else
        unclosed = unclosed || token_closes(found) || found == TOKEN_SEMICOLON;
    if (!unclosed) {
        diag_secondary(p->diags, expected(p, what), p->tokens[opener].span, "opened here");
        return;
    }
    report_unclosed(p, closer, opener);
    if (found == TOKEN_SEMICOLON)
        p->here.brackets -= p->here.brackets > 0; /* counts as closed */
    else
        fail(p);
}

void expect_semicolon(Parser *p, const char *after)
{
    if (p->failed || accept(p, TOKEN_SEMICOLON))
        return;
    TokenKind found = kind_here(p);
    bool next = found == TOKEN_END || found == TOKEN_RIGHT_BRACE || token_is_statement_word(found);
    if (found == TOKEN_ERROR || (!next && !begins_line(p))) {
        expected(p, diag_text(p->diags, "`;` after %s", after));
        return;
    }
    Diag *diag        = report_at(p, DIAG_UNEXPECTED_TOKEN, end_of_previous(p),
                                  diag_text(p->diags, "`;` is missing after %s", after));
    diag->replacement = ";";
}

void expect_or_mend(Parser *p, TokenKind wanted, TokenKind written, const char *what)
{
    if (accept(p, wanted))
        return;
    const Token *found = token_here(p);
    Diag        *diag;
    if (kind_here(p) == written) {
        const char *text  = token_kind_text(written);
        diag              = report_at(p, DIAG_UNEXPECTED_TOKEN, found->span,
                                      diag_text(p->diags, "expected %s, found %s", what, text));
        diag->replacement = wanted == TOKEN_COLON ? ":" : "=";
        diag->help        = wanted == TOKEN_COLON ? "`:` gives a property or an argument its value"
                                                  : "`=` defines a name";
        advance(p);
    } else
        expected(p, what);
}

void enter(Parser *p)
{
    if (++p->depth <= MAX_NESTING || p->failed)
        return;
    Diag *diag = report_at(p, DIAG_TOO_DEEP, span_here(p), "nested more than 200 levels deep");
    diag->help = "name a part with `let` and use the name";
    fail(p);
    p->abandoned = true;
}

void leave(Parser *p) { p->depth--; }

/* ---- recovery ---- */

bool block_is_left(const Parser *p, size_t opener, BlockKind kind)
{
    if (p->failed || !begins_declaration(p))
        return false;
    TokenKind here = kind_here(p);
    bool      fits = here != TOKEN_PARAM && here != TOKEN_MATERIAL && here != TOKEN_USE;
    return (kind == KRS_BLOCK || !fits) && !brace_is_closed(p, opener);
}

void skip_declaration(Parser *p)
{
    const size_t outer = p->here.braces;
    advance(p);
    if (token_here(p)->kind == TOKEN_NAME)
        advance(p);
    if (token_here(p)->kind != TOKEN_LEFT_BRACE)
        return;
    do
        advance(p);
    while (p->here.braces > outer && token_here(p)->kind != TOKEN_END);
}

/* Tells whether recovery may end here, because a statement begins.  `let`, `for` and `if` may also begin
   parts of expressions.  So they must begin a line, outside of brackets opened after `start`. */
static bool may_resume(const Parser *p, Level start)
{
    TokenKind kind = token_here(p)->kind;
    if (begins_declaration(p))
        return begins_line(p) || p->here.braces <= start.braces;
    bool flexible = kind == TOKEN_LET || kind == TOKEN_FOR || kind == TOKEN_IF;
    return flexible && begins_line(p) && p->here.brackets <= start.brackets;
}

/* Clears `failed`.  Reads a token if none was read since `start`, so that parsing terminates. */
static void begin_recovery(Parser *p, Level start)
{
    p->failed = p->abandoned = false;
    if (p->here.at == start.at)
        advance(p);
}

static void end_recovery(Parser *p, Level start)
{
    p->here.brackets = start.brackets;
    p->here.braces   = start.braces;
}

void recover_statement(Parser *p, Level start)
{
    begin_recovery(p, start);
    while (token_here(p)->kind != TOKEN_END && !may_resume(p, start)) {
        bool outside = p->here.braces <= start.braces;
        if (outside && kind_here(p) == TOKEN_RIGHT_BRACE)
            break; /* this is the end of the block around the statement */
        TokenKind kind = advance(p)->kind;
        if (outside && kind == TOKEN_SEMICOLON)
            break;
        if (!outside && p->here.braces <= start.braces) { /* a block of the statement has ended */
            accept(p, TOKEN_SEMICOLON);
            break;
        }
    }
    end_recovery(p, start);
}

void recover_property(Parser *p, Level start)
{
    begin_recovery(p, start);
    while (token_here(p)->kind != TOKEN_END && !begins_declaration(p)) {
        bool outside = p->here.braces <= start.braces;
        if (outside && kind_here(p) == TOKEN_RIGHT_BRACE)
            break;
        bool      bare = p->here.brackets <= start.brackets;
        TokenKind kind = advance(p)->kind;
        if ((bare && kind == TOKEN_COMMA) || (outside && kind == TOKEN_SEMICOLON))
            break;
    }
    end_recovery(p, start);
}

/* ---- nodes ---- */

size_t begin_children(const Parser *p) { return p->pending.count; }
void   add_child(Parser *p, Syntax *child) { array_push_large(p->arena, &p->pending, child); }

Syntax *error_node(Parser *p)
{
    Syntax *node = arena_new(p->arena, Syntax);
    node->kind   = SYNTAX_ERROR;
    node->span   = token_here(p)->span;
    node->height = 1;
    return node;
}

/* Refuses expressions whose tree is too deep.  A long chain like 1+1+1+... makes a deep tree,
   although nothing is nested. */
static Syntax *check_height(Parser *p, Syntax *node)
{
    if (node->height <= SYNTAX_MAX_LEVELS || node->kind > SYNTAX_KRS)
        return node;
    Diag *diag  = report_at(p, DIAG_TOO_DEEP, token_before(p)->span,
                            "an expression of more than 1,000 levels");
    diag->label = "this is too much";
    diag->help  = "name a part with `let` and use the name, or join a list, as in `union([...])`";
    fail(p);
    return error_node(p);
}

Syntax *finish(Parser *p, SyntaxKind kind, Span start, size_t first, const Token *name)
{
    if (p->failed && kind <= SYNTAX_KRS) {
        p->pending.count = first;
        return error_node(p);
    }
    Syntax *node = arena_new(p->arena, Syntax);
    node->kind   = kind;
    node->span   = start;
    node->count  = (uint32_t)(p->pending.count - first);
    if (token_before(p)->span.end > start.end)
        node->span.end = token_before(p)->span.end;
    if (name) {
        node->name      = name->name;
        node->name_span = name->span;
    }
    if (node->count > 0)
        node->children = arena_new_array(p->arena, Syntax *, node->count);
    for (uint32_t i = 0; i < node->count; i++) {
        node->children[i] = p->pending.items[first + i];
        if (node->children[i]->height > node->height)
            node->height = node->children[i]->height;
    }
    node->height++;
    p->pending.count = first;
    return check_height(p, node);
}

Syntax *finish_named(Parser *p, SyntaxKind kind, Span start, size_t first, const Token *name)
{
    Syntax *node = finish(p, kind, start, first, name);
    return name ? node : error_node(p);
}
