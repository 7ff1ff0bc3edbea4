/*
 * parse.c: statements other than definitions and declarations, blocks, and the whole file.
 *
 * The comment above each function is its rule in grammar/krs.ebnf, word for word; a test
 * compares them.
 */
#include "compiler/front/parse.h"

#include "compiler/front/parser.h"
#include "compiler/front/synonyms.h"

/* ---- statements of a word and an expression ---- */

static Syntax *parse_simple(Parser *p, SyntaxKind kind, const char *after)
{
    Span   start = token_here(p)->span;
    size_t first = begin_children(p);
    advance(p);
    add_child(p, parse_expression(p));
    expect_semicolon(p, after);
    return finish(p, kind, start, first, NULL);
}

/* show = "show" expression ";" ; */
static Syntax *parse_show(Parser *p) { return parse_simple(p, SYNTAX_SHOW, "a `show`"); }

/* use = "use" STRING ";" ; */
static Syntax *parse_use(Parser *p)
{
    Span   start = token_here(p)->span;
    size_t first = begin_children(p);
    advance(p);
    const Token *path = expect(p, TOKEN_STRING, "the name of a file in quotes after `use`",
                               "for example `use \"std/trees.krs\";`");
    expect_semicolon(p, "a `use`");
    return finish_named(p, SYNTAX_USE, start, first, path);
}

/* message_statement = message ";" ; */
static Syntax *parse_message_statement(Parser *p)
{
    Syntax *message = parse_message(p);
    expect_semicolon(p, "a `print` or `assert`");
    return message;
}

/* Skips a `;` behind a closing brace, a habit from other languages, with a warning. */
static bool skip_needless_semicolon(Parser *p)
{
    if (kind_here(p) != TOKEN_SEMICOLON)
        return false;
    Diag *diag = report_at(p, DIAG_NO_EFFECT, token_here(p)->span, "a `;` without a statement");
    diag->replacement = "";
    advance(p);
    return true;
}

/* Parses the statements of a block and its closing brace.  A mistake loses one statement only. */
static void parse_statements(Parser *p, size_t opener, ParseFunction *statement, BlockKind kind)
{
    while (!p->failed && kind_here(p) != TOKEN_RIGHT_BRACE && kind_here(p) != TOKEN_END &&
           !block_is_left(p, opener, kind)) {
        if (skip_needless_semicolon(p))
            continue;
        Level start = p->here;
        add_child(p, statement(p));
        if (p->failed && !p->abandoned)
            recover_statement(p, start);
    }
    expect_closer(p, TOKEN_RIGHT_BRACE, opener, "a statement or `}`");
}

/* The differences between a `for` or `if` in a krs block and one elsewhere. */
typedef struct BlockRules {
    ParseFunction *block, *branch; /* parse the `{ ... }`, and an `if` behind `else` */
    const char    *for_example, *if_example;
} BlockRules;

static Syntax *parse_braces(Parser *p, ParseFunction *statement, BlockKind kind)
{
    Span   start = token_here(p)->span;
    size_t first = begin_children(p), opener = p->here.at;
    enter(p);
    if (expect(p, TOKEN_LEFT_BRACE, "`{`", NULL))
        parse_statements(p, opener, statement, kind);
    leave(p);
    return finish(p, SYNTAX_BLOCK, start, first, NULL);
}

static Syntax *parse_loop(Parser *p, const BlockRules *rules)
{
    Span   start = token_here(p)->span;
    size_t first = begin_children(p);
    advance(p);
    const Token *name = NULL;
    if (kind_here(p) == TOKEN_NAME)
        name = advance(p);
    else
        expected(p, "the name of the variable of a `for`")->help = rules->for_example;
    expect(p, TOKEN_IN, "`in` after the variable of a `for`", rules->for_example);
    add_child(p, parse_expression(p));
    if (kind_here(p) != TOKEN_LEFT_BRACE)
        expected(p, "`{` after the list of a `for`")->help = rules->for_example;
    add_child(p, rules->block(p));
    return finish_named(p, SYNTAX_FOR, start, first, name);
}

static Syntax *parse_choice(Parser *p, const BlockRules *rules)
{
    Span   start = token_here(p)->span;
    size_t first = begin_children(p);
    enter(p);
    advance(p);
    add_child(p, parse_expression(p));
    if (kind_here(p) != TOKEN_LEFT_BRACE)
        expected(p, "`{` after the condition of an `if`")->help = rules->if_example;
    add_child(p, rules->block(p));
    if (accept(p, TOKEN_ELSE))
        add_child(p, kind_here(p) == TOKEN_IF ? rules->branch(p) : rules->block(p));
    leave(p);
    return finish(p, SYNTAX_IF_STATEMENT, start, first, NULL);
}

/* ---- blocks of the scene ---- */

static Syntax *parse_block_statement(Parser *p);
static Syntax *parse_if(Parser *p);

/* block = "{" { block_statement } "}" ; */
static Syntax *parse_block(Parser *p)
{
    return parse_braces(p, parse_block_statement, SCENE_BLOCK);
}

static const BlockRules scene_rules = {
    parse_block,
    parse_if,
    "for example `for i in 0..5 { show sphere(0.3).move([i, 0, 0]); }`",
    "as a statement: `if n > 3 { show a; } else { show b; }`",
};

/* for = "for" NAME "in" expression block ; */
static Syntax *parse_for(Parser *p) { return parse_loop(p, &scene_rules); }

/* if = "if" expression block [ "else" ( if | block ) ] ; */
static Syntax *parse_if(Parser *p) { return parse_choice(p, &scene_rules); }

static Syntax *no_block_statement(Parser *p)
{
    const Token *token = token_here(p);
    Diag        *diag  = expected(p, "`let`, `show`, `for`, `if` or `}` in a block");
    if (token->kind == TOKEN_NAME)
        explain_word(p->diags, diag, SYNONYM_STATEMENT, token->name, "");
    return error_node(p);
}

/* block_statement = let | def | shape | surroundings | show | message_statement | for | if ; */
static Syntax *parse_block_statement(Parser *p)
{
    if (at_message(p))
        return parse_message_statement(p);
    switch (kind_here(p)) {
    case TOKEN_LET: return parse_let(p);
    case TOKEN_DEF: return parse_def(p);
    case TOKEN_SHAPE: return parse_shape(p);
    case TOKEN_CAMERA:
    case TOKEN_LIGHT:
    case TOKEN_SKY:
    case TOKEN_FOG:
    case TOKEN_MEDIUM:
    case TOKEN_IMAGE:
    case TOKEN_ZONE: return parse_surroundings(p);
    case TOKEN_SHOW: return parse_show(p);
    case TOKEN_FOR: return parse_for(p);
    case TOKEN_IF: return parse_if(p);
    default: return no_block_statement(p);
    }
}

/* ---- reflection sequences ---- */

static Syntax *parse_krs_statement(Parser *p);
static Syntax *parse_krs_if(Parser *p);

/* krs_block = "{" { krs_statement } "}" ; */
static Syntax *parse_krs_block(Parser *p)
{
    return parse_braces(p, parse_krs_statement, KRS_BLOCK);
}

static const BlockRules krs_rules = {
    parse_krs_block,
    parse_krs_if,
    "for example `for i in 0..5 { reflect plane([1, 0, 0], i); }`",
    "as a statement: `if i > 3 { kernel a; } else { kernel b; }`",
};

/* krs_for = "for" NAME "in" expression krs_block ; */
static Syntax *parse_krs_for(Parser *p) { return parse_loop(p, &krs_rules); }

/* krs_if = "if" expression krs_block [ "else" ( krs_if | krs_block ) ] ; */
static Syntax *parse_krs_if(Parser *p) { return parse_choice(p, &krs_rules); }

/* kernel = "kernel" expression ";" ; */
static Syntax *parse_kernel(Parser *p) { return parse_simple(p, SYNTAX_KERNEL, "a `kernel`"); }

/* reflect = "reflect" expression ";" ; */
static Syntax *parse_reflect(Parser *p) { return parse_simple(p, SYNTAX_REFLECT, "a `reflect`"); }

/* mobius = "mobius" expression ";" ; */
static Syntax *parse_mobius(Parser *p) { return parse_simple(p, SYNTAX_MOBIUS, "a `mobius`"); }

/* krs_statement = kernel | reflect | mobius | let | message_statement | krs_for | krs_if ; */
static Syntax *parse_krs_statement(Parser *p)
{
    if (is_word_here(p, "kernel"))
        return parse_kernel(p);
    if (is_word_here(p, "reflect"))
        return parse_reflect(p);
    if (is_word_here(p, "mobius"))
        return parse_mobius(p);
    if (at_message(p))
        return parse_message_statement(p);
    switch (kind_here(p)) {
    case TOKEN_LET: return parse_let(p);
    case TOKEN_FOR: return parse_krs_for(p);
    case TOKEN_IF: return parse_krs_if(p);
    default: {
        Diag *diag = expected(p, "`kernel`, `reflect`, `mobius`, `let`, `for`, `if` or `}`");
        diag_note(p->diags, diag, "the statements of a `krs` block build one set, in order");
        return error_node(p);
    }
    }
}

/* krs = "krs" "{" { krs_statement } "}" ; */
Syntax *parse_krs(Parser *p)
{
    Span   start = token_here(p)->span;
    size_t first = begin_children(p);
    enter(p);
    advance(p);
    size_t opener = p->here.at;
    if (expect(p, TOKEN_LEFT_BRACE, "`{` after `krs`", "for example `krs { kernel sphere(1); }`"))
        parse_statements(p, opener, parse_krs_statement, KRS_BLOCK);
    leave(p);
    return finish(p, SYNTAX_KRS, start, first, NULL);
}

/* ---- the file ---- */

/* Parses `size = 2;` as a definition, after reporting that `let` is missing. */
static Syntax *parse_forgotten_let(Parser *p)
{
    const Token *name = token_here(p);
    Diag *diag = report_at(p, DIAG_UNEXPECTED_TOKEN, name->span, "a definition without `let`");
    diag->replacement = diag_text(p->diags, "let %s", name->name);
    return parse_let(p);
}

/* Reports a `}` without a `{`, and continues behind it without recovery: the statements there are
   probably right. */
static Syntax *stray_brace(Parser *p)
{
    Syntax *error = error_node(p);
    report_at(p, DIAG_UNEXPECTED_TOKEN, token_here(p)->span, "a `}` without a `{`");
    advance(p);
    return error;
}

/* Tells whether a token behind a name begins a change of its value, as in `a += 1`. */
static bool is_change(TokenKind kind)
{
    return kind == TOKEN_PLUS || kind == TOKEN_MINUS || kind == TOKEN_STAR || kind == TOKEN_SLASH;
}

static Syntax *no_statement(Parser *p)
{
    const char  *words[TOKEN_KIND_COUNT];
    const char  *help  = "a scene consists of statements like `let a = 1;` and `show sphere(a);`";
    const Token *token = token_here(p);
    const char  *meant = NULL;
    bool         call  = kind_after(p) == TOKEN_LEFT_PAREN || kind_after(p) == TOKEN_DOT;
    if (is_word_here(p, "kernel") || is_word_here(p, "reflect") || is_word_here(p, "mobius"))
        help = "`kernel`, `reflect` and `mobius` stand in a `krs { ... }`";
    else if (kind_here(p) == TOKEN_NAME && call)
        help = "to put a shape into the picture write `show` in front of it";
    else if (kind_here(p) == TOKEN_NAME)
        meant = nearest_name(token->name, words, token_statements(words));
    bool  shape       = kind_after(p) == TOKEN_LEFT_BRACE;
    bool  changed     = is_change(kind_after(p));
    Diag *diag        = expected(p, "a statement");
    diag->help        = meant ? "did you mean" : help;
    diag->replacement = meant;
    if (token->kind == TOKEN_NAME &&
        !explain_word(p->diags, diag, SYNONYM_STATEMENT, token->name, "") && !meant)
        diag->help = changed ? form_help(p->diags, FORM_CHANGE)
                     : shape ? form_help(p->diags, FORM_BRACES)
                             : help;
    return error_node(p);
}

/* definition = let | def | param | shape | material ; */
static Syntax *parse_definition(Parser *p)
{
    switch (kind_here(p)) {
    case TOKEN_LET: return parse_let(p);
    case TOKEN_DEF: return parse_def(p);
    case TOKEN_PARAM: return parse_param(p);
    case TOKEN_SHAPE: return parse_shape(p);
    default: return parse_material(p);
    }
}

/* statement = definition | surroundings | show | use | message_statement | for | if ; */
static Syntax *parse_statement(Parser *p)
{
    if (at_message(p))
        return parse_message_statement(p);
    switch (kind_here(p)) {
    case TOKEN_LET:
    case TOKEN_DEF:
    case TOKEN_PARAM:
    case TOKEN_SHAPE:
    case TOKEN_MATERIAL: return parse_definition(p);
    case TOKEN_CAMERA:
    case TOKEN_LIGHT:
    case TOKEN_SKY:
    case TOKEN_FOG:
    case TOKEN_MEDIUM:
    case TOKEN_IMAGE:
    case TOKEN_ZONE: return parse_surroundings(p);
    case TOKEN_SHOW: return parse_show(p);
    case TOKEN_USE: return parse_use(p);
    case TOKEN_FOR: return parse_for(p);
    case TOKEN_IF: return parse_if(p);
    case TOKEN_RIGHT_BRACE: return stray_brace(p);
    case TOKEN_NAME:
        return kind_after(p) == TOKEN_ASSIGN ? parse_forgotten_let(p) : no_statement(p);
    default: return no_statement(p);
    }
}

/* file = { statement } ; */
static Syntax *parse_file(Parser *p)
{
    Span   start = token_here(p)->span;
    size_t first = begin_children(p);
    while (kind_here(p) != TOKEN_END) {
        if (skip_needless_semicolon(p))
            continue;
        Level       level     = p->here;
        const char *doc       = token_here(p)->doc;
        Syntax     *statement = parse_statement(p);
        if (syntax_defines(statement))
            statement->doc = doc;
        add_child(p, statement);
        if (p->failed)
            recover_statement(p, level);
        if (diags_full(p->diags))
            break;
    }
    return finish(p, SYNTAX_BLOCK, start, first, NULL);
}

Syntax *parse(const Tokens *tokens, Diags *diags, Arena *arena)
{
    Parser p = {.tokens = tokens->items, .count = tokens->count, .diags = diags, .arena = arena};
    p.text   = diags->sources->items[tokens->items[0].span.source].text;
    return parse_file(&p);
}
