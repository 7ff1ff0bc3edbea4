/*
 * parse_expression.c: expressions, with a function for each level of precedence.
 *
 * The comment above each function is its rule in grammar/krs.ebnf, word for word; a test
 * compares them.
 */
#include "compiler/front/parser.h"
#include "compiler/front/synonyms.h"

/* ---- expressions that begin with a keyword ---- */

/* let_in = "let" NAME "=" expression "in" expression ; */
static Syntax *parse_let_in(Parser *p)
{
    enter(p);
    Span        start   = token_here(p)->span;
    size_t      first   = begin_children(p);
    const char *example = "for example `let r = 2 in r * r`";
    advance(p);
    const Token *name = expect_name(p, "of a `let`");
    expect_or_mend(p, TOKEN_ASSIGN, TOKEN_COLON, "`=` after the name of a `let`");
    add_child(p, parse_expression(p));
    expect(p, TOKEN_IN, "`in` after the value of a `let` within an expression", example);
    add_child(p, parse_expression(p));
    leave(p);
    return finish_named(p, SYNTAX_LET_IN, start, first, name);
}

/* message_in = message "in" expression ; */
static Syntax *parse_message_in(Parser *p)
{
    enter(p);
    Span   start = token_here(p)->span;
    size_t first = begin_children(p);
    add_child(p, parse_message(p));
    expect(p, TOKEN_IN, "`in` after a `print` or `assert` within an expression",
           "for example `assert(r > 0, \"a radius\") in sphere(r)`");
    add_child(p, parse_expression(p));
    leave(p);
    return finish(p, SYNTAX_MESSAGE_IN, start, first, NULL);
}

/* if_then_else = "if" expression "then" expression "else" expression ; */
static Syntax *parse_if_then_else(Parser *p)
{
    enter(p);
    Span        start   = token_here(p)->span;
    size_t      first   = begin_children(p);
    const char *example = "for example `if a < b then a else b`";
    advance(p);
    add_child(p, parse_expression(p));
    expect(p, TOKEN_THEN, "`then` after the condition of an `if`", example);
    add_child(p, parse_expression(p));
    if (!accept(p, TOKEN_ELSE)) {
        Diag *diag  = expected(p, "`else`");
        diag->label = "an `if` needs a value for either case";
        diag->help  = example;
        diag_secondary(p->diags, diag, start, "the `if` begins here");
    }
    add_child(p, parse_expression(p));
    leave(p);
    return finish(p, SYNTAX_IF, start, first, NULL);
}

/* ---- operators ---- */

/* Returns a node of the operator that was just read and its two operands. */
static Syntax *binary(Parser *p, const Token *op, Syntax *left, Syntax *right)
{
    size_t first = begin_children(p);
    add_child(p, left);
    add_child(p, right);
    SyntaxKind kind = op->kind == TOKEN_DOT_DOT ? SYNTAX_RANGE : SYNTAX_BINARY;
    Syntax    *node = finish(p, kind, left->span, first, NULL);
    node->op        = op->kind;
    node->name_span = op->span;
    return node;
}

/* Parses operands with any of three left-associative operators between them. */
static Syntax *parse_left(Parser *p, ParseFunction *operand, TokenKind a, TokenKind b, TokenKind c)
{
    Syntax *left = operand(p);
    while (kind_here(p) == a || kind_here(p) == b || kind_here(p) == c) {
        const Token *op    = advance(p);
        Syntax      *right = operand(p);
        left               = binary(p, op, left, right);
    }
    return left;
}

static Syntax *unary(Parser *p, ParseFunction *operand)
{
    enter(p);
    size_t       first = begin_children(p);
    const Token *op    = advance(p);
    add_child(p, operand(p));
    leave(p);
    Syntax *node    = finish(p, SYNTAX_UNARY, op->span, first, NULL);
    node->op        = op->kind;
    node->name_span = op->span;
    return node;
}

static Syntax *parse_postfix(Parser *p);
static Syntax *parse_unary(Parser *p);

/* power = postfix [ "^" unary ] ; */
static Syntax *parse_power(Parser *p)
{
    Syntax *base = parse_postfix(p);
    if (kind_here(p) != TOKEN_CARET)
        return base;
    const Token *op = advance(p);
    enter(p);
    Syntax *exponent = parse_unary(p);
    leave(p);
    return binary(p, op, base, exponent);
}

/* unary = "-" unary | power ; */
static Syntax *parse_unary(Parser *p)
{
    return kind_here(p) == TOKEN_MINUS ? unary(p, parse_unary) : parse_power(p);
}

/* product = unary { ( "*" | "/" | "%" ) unary } ; */
static Syntax *parse_product(Parser *p)
{
    return parse_left(p, parse_unary, TOKEN_STAR, TOKEN_SLASH, TOKEN_PERCENT);
}

/* sum = product { ( "+" | "-" ) product } ; */
static Syntax *parse_sum(Parser *p)
{
    return parse_left(p, parse_product, TOKEN_PLUS, TOKEN_MINUS, TOKEN_MINUS);
}

/* intersection = sum { "&" sum } ; */
static Syntax *parse_intersection(Parser *p)
{
    return parse_left(p, parse_sum, TOKEN_AMPERSAND, TOKEN_AMPERSAND, TOKEN_AMPERSAND);
}

/* union = intersection { "|" intersection } ; */
static Syntax *parse_union(Parser *p)
{
    return parse_left(p, parse_intersection, TOKEN_BAR, TOKEN_BAR, TOKEN_BAR);
}

/* range = union [ ".." union ] ; */
static Syntax *parse_range(Parser *p)
{
    Syntax *from = parse_union(p);
    if (kind_here(p) != TOKEN_DOT_DOT)
        return from;
    const Token *op = advance(p);
    Syntax      *to = parse_union(p);
    return binary(p, op, from, to);
}

/* Tells whether a comparison operator is next.  A single `=` is reported and counts as `==`: behind an
   expression it cannot be a definition, since only names are defined. */
static bool at_comparison(Parser *p)
{
    switch (kind_here(p)) {
    case TOKEN_EQUAL_EQUAL:
    case TOKEN_NOT_EQUAL:
    case TOKEN_LESS:
    case TOKEN_GREATER:
    case TOKEN_LESS_EQUAL:
    case TOKEN_GREATER_EQUAL: return true;
    case TOKEN_ASSIGN: {
        Diag *diag        = report_at(p, DIAG_UNEXPECTED_TOKEN, token_here(p)->span,
                                      "`=` within an expression");
        diag->help        = "`=` defines names; equations and comparisons are written";
        diag->replacement = "==";
        return true;
    }
    default: return false;
    }
}

/* comparison = range [ ( "==" | "!=" | "<" | "<=" | ">" | ">=" ) range ] ; */
static Syntax *parse_comparison(Parser *p)
{
    Syntax      *left     = parse_range(p);
    const Token *previous = NULL;
    while (at_comparison(p)) {
        const Token *op    = advance(p);
        Syntax      *right = parse_range(p);
        if (previous) {
            Diag *diag = report_at(p, DIAG_CHAINED_COMPARISON, op->span,
                                   "comparisons do not chain");
            diag->help = "write `a < b and b < c`";
            diag_secondary(p->diags, diag, previous->span, "the comparison before");
        }
        previous = op;
        left     = binary(p, op, left, right);
        if (op->kind == TOKEN_ASSIGN)
            left->op = TOKEN_EQUAL_EQUAL;
    }
    return left;
}

/* not = "not" not | comparison ; */
static Syntax *parse_not(Parser *p)
{
    return kind_here(p) == TOKEN_NOT ? unary(p, parse_not) : parse_comparison(p);
}

/* and = not { "and" not } ; */
static Syntax *parse_and(Parser *p)
{
    return parse_left(p, parse_not, TOKEN_AND, TOKEN_AND, TOKEN_AND);
}

/* or = and { "or" and } ; */
static Syntax *parse_or(Parser *p)
{
    return parse_left(p, parse_and, TOKEN_OR, TOKEN_OR, TOKEN_OR);
}

/* expression = let_in | message_in | if_then_else | or ; */
Syntax *parse_expression(Parser *p)
{
    if (at_message(p))
        return parse_message_in(p);
    switch (kind_here(p)) {
    case TOKEN_LET: return parse_let_in(p);
    case TOKEN_IF: return parse_if_then_else(p);
    default: return parse_or(p);
    }
}

/* ---- calls, methods, indices ---- */

/* named = label ":" expression ; */
static Syntax *parse_named(Parser *p)
{
    Span         start = token_here(p)->span;
    size_t       first = begin_children(p);
    const Token *name  = advance(p);
    if (!accept(p, TOKEN_COLON)) {
        Diag *diag        = report_at(p, DIAG_UNEXPECTED_TOKEN, token_here(p)->span,
                                      "expected `:` after the name of an argument, found `=`");
        diag->help        = "arguments are named like `radius: 2`; to compare write `==`";
        diag->replacement = ":";
        advance(p);
    }
    add_child(p, parse_expression(p));
    return finish(p, SYNTAX_ARGUMENT, start, first, name);
}

static Syntax *parse_positional(Parser *p, const Token *named_before)
{
    Span   start = token_here(p)->span;
    size_t first = begin_children(p);
    add_child(p, parse_expression(p));
    Syntax *argument = finish(p, SYNTAX_ARGUMENT, start, first, NULL);
    if (named_before) {
        Diag *diag  = report_at(p, DIAG_UNEXPECTED_TOKEN, argument->span,
                                "an argument without a name behind one with a name");
        diag->label = "name this one too";
        diag_secondary(p->diags, diag, named_before->span, "arguments have names from here on");
    }
    return argument;
}

static bool at_name_of_argument(const Parser *p)
{
    TokenKind after = kind_after(p);
    return (is_label(p) && after == TOKEN_COLON) ||
           (kind_here(p) == TOKEN_NAME && after == TOKEN_ASSIGN); /* parse_named reports the `=` */
}

/* arguments = "(" [ ( named | expression { "," expression } ) { "," named } [ "," ] ] ")" ; */
static void parse_arguments(Parser *p)
{
    const Token *named  = NULL; /* the name of the first argument that has one */
    size_t       opener = p->here.at;
    enter(p);
    advance(p);
    while (!p->failed && kind_here(p) != TOKEN_RIGHT_PAREN) {
        bool is_named = at_name_of_argument(p);
        if (is_named && !named)
            named = token_here(p);
        add_child(p, is_named ? parse_named(p) : parse_positional(p, named));
        if (!accept(p, TOKEN_COMMA))
            break;
    }
    expect_closer(p, TOKEN_RIGHT_PAREN, opener, "`,` or `)` after an argument");
    leave(p);
}

/* message = ( "print" | "assert" ) arguments ; */
Syntax *parse_message(Parser *p)
{
    Span         start = token_here(p)->span;
    size_t       first = begin_children(p);
    const Token *word  = advance(p);
    parse_arguments(p);
    return finish(p, SYNTAX_MESSAGE, start, first, word);
}

/* call = arguments ; */
static Syntax *parse_call(Parser *p, Syntax *callee)
{
    size_t first = begin_children(p);
    add_child(p, callee);
    parse_arguments(p);
    return finish(p, SYNTAX_CALL, callee->span, first, NULL);
}

/* method = "." label [ arguments ] ; */
static Syntax *parse_method(Parser *p, Syntax *receiver)
{
    size_t first = begin_children(p);
    advance(p);
    const Token *name = expect_label(p, "the name of a method after `.`");
    add_child(p, receiver);
    if (kind_here(p) == TOKEN_LEFT_PAREN)
        parse_arguments(p);
    return finish_named(p, SYNTAX_METHOD, receiver->span, first, name);
}

/* index = "[" expression "]" ; */
static Syntax *parse_index(Parser *p, Syntax *list)
{
    size_t first = begin_children(p), opener = p->here.at;
    enter(p);
    advance(p);
    add_child(p, list);
    add_child(p, parse_expression(p));
    expect_closer(p, TOKEN_RIGHT_BRACKET, opener, "`]` after an index");
    leave(p);
    return finish(p, SYNTAX_INDEX, list->span, first, NULL);
}

static Syntax *parse_primary(Parser *p);

/* postfix = primary { call | method | index } ; */
static Syntax *parse_postfix(Parser *p)
{
    Syntax *node = parse_primary(p);
    for (;;) {
        switch (kind_here(p)) {
        case TOKEN_LEFT_PAREN: node = parse_call(p, node); break;
        case TOKEN_DOT: node = parse_method(p, node); break;
        case TOKEN_LEFT_BRACKET:
            if (p->here.at == p->bare_range)
                return node;
            node = parse_index(p, node);
            break;
        default: return node;
        }
    }
}

/* ---- lists, parentheses, single tokens ---- */

/* for_clause = "for" NAME "in" expression ; */
static Syntax *parse_for_clause(Parser *p)
{
    Span   start = token_here(p)->span;
    size_t first = begin_children(p);
    advance(p);
    const Token *name = expect_name(p, "of the variable of a `for`");
    expect(p, TOKEN_IN, "`in` after the variable of a `for`",
           "for example `[2 * i for i in 0..5]`");
    add_child(p, parse_expression(p));
    return finish_named(p, SYNTAX_FOR_CLAUSE, start, first, name);
}

/* if_clause = "if" expression ; */
static Syntax *parse_if_clause(Parser *p)
{
    Span   start = token_here(p)->span;
    size_t first = begin_children(p);
    advance(p);
    add_child(p, parse_expression(p));
    if (kind_here(p) == TOKEN_THEN)
        expected(p, "`for`, `if` or `]`")->help =
            "put an `if` with a value into parentheses, in front of the `for`";
    return finish(p, SYNTAX_IF_CLAUSE, start, first, NULL);
}

/* clauses = for_clause { for_clause | if_clause } ; */
static void parse_clauses(Parser *p)
{
    add_child(p, parse_for_clause(p));
    while (kind_here(p) == TOKEN_FOR || kind_here(p) == TOKEN_IF)
        add_child(p, kind_here(p) == TOKEN_FOR ? parse_for_clause(p) : parse_if_clause(p));
}

/* list = "[" [ expression ( clauses | { "," expression } [ "," ] ) ] "]" ; */
static Syntax *parse_list(Parser *p)
{
    Span        start = token_here(p)->span;
    size_t      first = begin_children(p), opener = p->here.at;
    SyntaxKind  kind = SYNTAX_LIST;
    const char *what = "`,` or `]` after an element of a list";
    enter(p);
    advance(p);
    while (!p->failed && kind_here(p) != TOKEN_RIGHT_BRACKET) {
        add_child(p, parse_expression(p));
        if (kind_here(p) == TOKEN_FOR && begin_children(p) == first + 1) {
            parse_clauses(p);
            kind = SYNTAX_COMPREHENSION;
            what = "`for`, `if` or `]` in a list comprehension";
            break;
        }
        if (kind_here(p) == TOKEN_COLON)
            expected(p, what)->help = form_help(p->diags, FORM_COLON_RANGE);
        if (!accept(p, TOKEN_COMMA))
            break;
    }
    expect_closer(p, TOKEN_RIGHT_BRACKET, opener, what);
    leave(p);
    return finish(p, kind, start, first, NULL);
}

/* parentheses = "(" expression ")" ; */
static Syntax *parse_parentheses(Parser *p)
{
    Span   start  = token_here(p)->span;
    size_t opener = p->here.at;
    enter(p);
    advance(p);
    Syntax *inside = parse_expression(p);
    if (kind_here(p) == TOKEN_COMMA || kind_here(p) == TOKEN_NUMBER)
        expected(p, "an operator or `)`")->help = form_help(
            p->diags, kind_here(p) == TOKEN_COMMA ? FORM_ROUND_VECTOR : FORM_LISP_CALL);
    expect_closer(p, TOKEN_RIGHT_PAREN, opener, "an operator or `)`");
    leave(p);
    if (!p->failed) /* so that the span of a call or an operator begins at the parenthesis */
        inside->span = span_join(start, token_before(p)->span);
    return inside;
}

/* Parses an expression of one token: a number, colour, string, truth value or name. */
static Syntax *parse_token(Parser *p, SyntaxKind kind)
{
    const Token *token = advance(p);
    bool         named = kind == SYNTAX_NAME || kind == SYNTAX_STRING;
    Syntax      *node  = finish(p, kind, token->span, begin_children(p), named ? token : NULL);
    if (token->kind == TOKEN_NUMBER)
        node->number[0] = token->number;
    else if (token->kind == TOKEN_COLOUR)
        linear_from_srgb(token->rgb, node->number);
    else
        node->number[0] = token->kind == TOKEN_TRUE;
    return node;
}

/* Reports that no expression begins here, with help for common mistakes. */
static Syntax *no_expression(Parser *p)
{
    TokenKind found   = kind_here(p);
    bool      keyword = token_is_statement_word(found) && !begins_declaration(p);
    Diag     *diag    = expected(p, "an expression");
    if (found == TOKEN_IF || found == TOKEN_LET || found == TOKEN_NOT)
        diag->help = "put it in parentheses, as in `1 + (if a < b then a else b)`";
    else if (found == TOKEN_PLUS)
        diag->help = "a positive number has no sign";
    else if (found == TOKEN_LEFT_BRACE)
        diag->help = "lists have brackets `[1, 2]`; a reflection sequence begins with `krs {`";
    else if (found == TOKEN_LESS)
        diag->help = form_help(p->diags, FORM_ANGLE_VECTOR);
    else if (found == TOKEN_GREATER)
        diag->help = form_help(p->diags, FORM_PIPE);
    else if (found == TOKEN_FOR)
        diag->help = form_help(p->diags, FORM_LOOP_AHEAD);
    else if (found == TOKEN_DOT_DOT)
        diag->help = "a range has both ends, as in `0..5`";
    else if (found == TOKEN_MATERIAL) {
        diag->help = form_help(p->diags, FORM_MATERIAL_VALUE);
        skip_declaration(p);
    } else if (keyword)
        diag->help = "this is a word of the language, not a name";
    return error_node(p);
}

/* primary = NUMBER | COLOUR | STRING | "true" | "false" | NAME | list | krs | parentheses ; */
static Syntax *parse_primary(Parser *p)
{
    switch (kind_here(p)) {
    case TOKEN_NUMBER: return parse_token(p, SYNTAX_NUMBER);
    case TOKEN_COLOUR: return parse_token(p, SYNTAX_COLOUR);
    case TOKEN_STRING: return parse_token(p, SYNTAX_STRING);
    case TOKEN_TRUE:
    case TOKEN_FALSE: return parse_token(p, SYNTAX_BOOLEAN);
    case TOKEN_NAME: return parse_token(p, SYNTAX_NAME);
    case TOKEN_LEFT_BRACKET: return parse_list(p);
    case TOKEN_KRS: return parse_krs(p);
    case TOKEN_LEFT_PAREN: return parse_parentheses(p);
    default: return no_expression(p);
    }
}
