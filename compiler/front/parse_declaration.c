/*
 * parse_declaration.c: definitions, and declarations with properties.
 *
 * The comment above each function is its rule in grammar/krs.ebnf, word for word; a test
 * compares them.
 */
#include "compiler/front/parser.h"
#include "compiler/front/synonyms.h"

#include <string.h>

/* ---- definitions ---- */

/* Returns the index of a `[` that begins a range whose `in` is missing, as in `1 [0, 2]`: behind a
   number, and with a comma, which no index has. 0: there is none in the value that begins here. */
static size_t find_bare_range(const Parser *p)
{
    size_t   found = 0;
    uint32_t depth = 0;
    for (size_t at = p->here.at; at < p->count; at++) {
        TokenKind kind = p->tokens[at].kind;
        depth += kind == TOKEN_LEFT_PAREN || kind == TOKEN_LEFT_BRACKET;
        if (kind == TOKEN_LEFT_BRACKET && depth == 1 && p->tokens[at - 1].kind == TOKEN_NUMBER)
            found = at;
        if (kind == TOKEN_COMMA && depth == 1 && found)
            return found;
        if (kind == TOKEN_SEMICOLON || kind == TOKEN_LEFT_BRACE ||
            (depth == 0 && (kind == TOKEN_COMMA || kind == TOKEN_RIGHT_PAREN)))
            return 0;
        depth -= depth > 0 && (kind == TOKEN_RIGHT_PAREN || kind == TOKEN_RIGHT_BRACKET);
        if (depth == 0)
            found = 0;
    }
    return 0;
}

/* Parses the range of a parameter, if there is one; that its `in` is missing is reported. */
static void read_limits(Parser *p)
{
    if (kind_here(p) == TOKEN_LEFT_BRACKET && p->here.at == p->bare_range) {
        Diag *diag        = report_at(p, DIAG_UNEXPECTED_TOKEN, token_here(p)->span,
                                      "`in` is missing before a range");
        diag->help        = form_help(p->diags, FORM_RANGE_OF_PARAM);
        diag->replacement = "in [";
        add_child(p, parse_expression(p));
    } else if (accept(p, TOKEN_IN))
        add_child(p, parse_expression(p));
}

/* Parses the default of a parameter and its range, if there is one.  That its `in` is missing is
   reported. */
static void read_default(Parser *p)
{
    p->bare_range = find_bare_range(p);
    add_child(p, parse_expression(p));
    read_limits(p);
}

static void report_kind(Parser *p, const Token *word)
{
    const char *names[KIND_COUNT];
    for (int i = 1; i < KIND_COUNT; i++)
        names[i - 1] = parameter_kind_name((ParameterKind)i);
    Diag *diag        = report_at(p, DIAG_UNKNOWN_NAME, word->span,
                                  diag_text(p->diags, "no kind of value is called `%s`", word->name));
    diag->label       = "unknown kind";
    diag->replacement = nearest_name(word->name, names, KIND_COUNT - 1);
    diag->help        = diag->replacement ? "a kind with a similar name exists"
                                          : "the default of a parameter stands behind `=`";
}

/* Parses the kind behind the colon. */
static ParameterKind parse_kind(Parser *p)
{
    const Token *word = expect_label(p, "a kind of value");
    for (int i = 1; word && i < KIND_COUNT; i++)
        if (strcmp(parameter_kind_name((ParameterKind)i), word->name) == 0)
            return (ParameterKind)i;
    if (word)
        report_kind(p, word);
    return KIND_ANY;
}

/* Tells whether a kind of value follows, not a default behind a wrong sign. */
static bool is_kind_next(const Parser *p)
{
    const TokenKind after = kind_after(p);
    return kind_here(p) == TOKEN_COLON &&
           (after == TOKEN_NAME || after == TOKEN_SHAPE || after == TOKEN_MATERIAL);
}

/* parameter = NAME [ ":" KIND ] [ "=" expression [ "in" expression ] ] ; */
static Syntax *parse_parameter(Parser *p)
{
    Span          start = token_here(p)->span;
    size_t        first = begin_children(p);
    const Token  *name  = expect_name(p, "of a parameter");
    ParameterKind kind  = KIND_ANY;
    if (is_kind_next(p)) {
        advance(p);
        kind = parse_kind(p);
    }
    if (kind_here(p) == TOKEN_ASSIGN || kind_here(p) == TOKEN_COLON) {
        expect_or_mend(p, TOKEN_ASSIGN, TOKEN_COLON, "`=` before the default of a parameter");
        read_default(p);
    }
    Syntax *parameter    = finish_named(p, SYNTAX_PARAMETER, start, first, name);
    parameter->number[0] = kind;
    return parameter;
}

/* parameters = "(" [ parameter { "," parameter } [ "," ] ] ")" ; */
static void parse_parameters(Parser *p, const char *what, const char *example)
{
    size_t       opener = p->here.at;
    const Token *name   = token_before(p);
    if (!expect(p, TOKEN_LEFT_PAREN, what, example))
        return;
    if (name->kind == TOKEN_NAME && names_message(name->name))
        report_at(p, DIAG_UNEXPECTED_TOKEN, name->span, "`print(` and `assert(` have a meaning")
            ->help = "choose another name for what is called";
    while (!p->failed && kind_here(p) != TOKEN_RIGHT_PAREN) {
        add_child(p, parse_parameter(p));
        if (!accept(p, TOKEN_COMMA))
            break;
    }
    expect_closer(p, TOKEN_RIGHT_PAREN, opener, "`,` or `)` after a parameter");
}

/* Parses what follows the parameters of a function. */
static Syntax *finish_value(Parser *p, Span start, size_t first, const Token *name)
{
    if (kind_here(p) == TOKEN_LEFT_BRACE)
        expected(p, "`=` before the value of a function")->help = form_help(p->diags,
                                                                            FORM_DEF_BODY);
    expect_or_mend(p, TOKEN_ASSIGN, TOKEN_COLON, "`=` before the value of a function");
    add_child(p, parse_expression(p));
    expect_semicolon(p, "a `def`");
    return finish_named(p, SYNTAX_DEF, start, first, name);
}

/* Parses what follows the name of a function. */
static Syntax *finish_def(Parser *p, Span start, size_t first, const Token *name)
{
    parse_parameters(p, "`(` after the name of a function",
                     "for example `def ball(r = 1) = sphere(r);`; without parameters write `let`");
    return finish_value(p, start, first, name);
}

/* def = "def" NAME parameters "=" expression ";" ; */
Syntax *parse_def(Parser *p)
{
    Span   start = token_here(p)->span;
    size_t first = begin_children(p);
    advance(p);
    return finish_def(p, start, first, expect_name(p, "of a function"));
}

/* Reports that `let f(x) = ...;` or `shape f(x) = ...;` is a function, and goes on as if it began
   with `def`. */
static void report_function(Parser *p, Span start, SynonymForm form)
{
    Diag *diag = report_at(p, DIAG_UNEXPECTED_TOKEN, start, "a function is defined by `def`");
    diag->help = form_help(p->diags, form);
    diag->replacement = "def";
}

/* let = "let" NAME "=" expression ";" ; */
Syntax *parse_let(Parser *p)
{
    Span   start = token_here(p)->span;
    size_t first = begin_children(p);
    accept(p, TOKEN_LET); /* it may be missing: see parse_forgotten_let */
    const Token *name = expect_name(p, "of a `let`");
    if (name && kind_here(p) == TOKEN_LEFT_PAREN) {
        report_function(p, start, FORM_LET_FUNCTION);
        return finish_def(p, start, first, name);
    }
    expect_or_mend(p, TOKEN_ASSIGN, TOKEN_COLON, "`=` after the name of a `let`");
    add_child(p, parse_expression(p));
    if (kind_here(p) == TOKEN_IN)
        expected(p, "`;` after a `let`")->help =
            "`let a = 1 in ...` is an expression, and a statement cannot be one";
    expect_semicolon(p, "a `let`");
    return finish_named(p, SYNTAX_LET, start, first, name);
}

/* param = "param" NAME "=" expression [ "in" expression ] ";" ; */
Syntax *parse_param(Parser *p)
{
    Span   start = token_here(p)->span;
    size_t first = begin_children(p);
    advance(p);
    const Token *name = expect_name(p, "of a `param`");
    expect_or_mend(p, TOKEN_ASSIGN, TOKEN_COLON, "`=` after the name of a `param`");
    read_default(p);
    expect_semicolon(p, "a `param`");
    return finish_named(p, SYNTAX_PARAM, start, first, name);
}

/* ---- declarations with properties ---- */

/* label = NAME | STATEMENT_WORD ; */
static const Token *parse_label(Parser *p) { return expect_label(p, "the name of a property"); }

/* property = label ":" expression ; */
static Syntax *parse_property(Parser *p)
{
    Span         start = token_here(p)->span;
    size_t       first = begin_children(p);
    const Token *name  = parse_label(p);
    if (name && kind_here(p) == TOKEN_LESS) {
        expected(p, "`:` after the name of a property")->help = form_help(p->diags,
                                                                          FORM_PROPERTY_COLON);
        p->abandoned = true; /* the commas of the vector separate no properties */
    }
    expect_or_mend(p, TOKEN_COLON, TOKEN_ASSIGN, "`:` after the name of a property");
    add_child(p, parse_expression(p));
    return finish_named(p, SYNTAX_PROPERTY, start, first, name);
}

/* Reads the separator of two properties.  A wrong or missing one is reported and accepted. */
static bool accept_separator(Parser *p)
{
    if (p->failed || accept(p, TOKEN_COMMA))
        return !p->failed;
    Span end = {token_before(p)->span.source, token_before(p)->span.end, token_before(p)->span.end};
    if (kind_here(p) == TOKEN_SEMICOLON) {
        report_at(p, DIAG_UNEXPECTED_TOKEN, token_here(p)->span,
                  "expected `,` or `}` after a property, found `;`")
            ->replacement = ",";
        advance(p);
        return true;
    }
    if (!is_label(p) || kind_after(p) != TOKEN_COLON)
        return false;
    report_at(p, DIAG_UNEXPECTED_TOKEN, end, "`,` is missing after a property")->replacement = ",";
    return true;
}

/* properties = "{" [ property { "," property } [ "," ] ] "}" ; */
static void parse_properties(Parser *p, const char *what, const char *example)
{
    size_t opener = p->here.at;
    if (!expect(p, TOKEN_LEFT_BRACE, what, example))
        return;
    while (is_label(p) && !begins_declaration(p)) {
        Level start = p->here;
        add_child(p, parse_property(p));
        bool more = accept_separator(p);
        if (p->failed && !p->abandoned)
            recover_property(p, start);
        else if (!more)
            break;
    }
    expect_closer(p, TOKEN_RIGHT_BRACE, opener, "a property like `name: value`, or `}`");
}

/* shape = "shape" NAME parameters properties ; */
Syntax *parse_shape(Parser *p)
{
    static const char example[] = "for example `shape ball(r = 1) { distance: length(p) - r }`";
    Span              start     = token_here(p)->span;
    size_t            first     = begin_children(p);
    advance(p);
    const Token *name = expect_name(p, "of a shape");
    parse_parameters(p, "`(` after the name of a shape", example);
    if (name && kind_here(p) == TOKEN_ASSIGN) {
        report_function(p, start, FORM_SHAPE_FUNCTION);
        return finish_value(p, start, first, name);
    }
    parse_properties(p, "`{` and the properties of the shape", example);
    return finish_named(p, SYNTAX_SHAPE, start, first, name);
}

/* material = "material" NAME [ parameters ] properties ; */
Syntax *parse_material(Parser *p)
{
    Span   start = token_here(p)->span;
    size_t first = begin_children(p);
    advance(p);
    const Token *name  = expect_name(p, "of a material");
    bool         calls = kind_here(p) == TOKEN_LEFT_PAREN;
    if (calls)
        parse_parameters(p, "`(` after the name of a material", NULL);
    parse_properties(p, "`{` and the properties of the material",
                     "for example `material clay { color: #c8553d, roughness: 0.6 }`");
    Syntax *material    = finish_named(p, SYNTAX_MATERIAL, start, first, name);
    material->number[0] = calls;
    return material;
}

/* Parses a keyword, a name where one is permitted, and properties. */
static Syntax *parse_block_of_properties(Parser *p, SyntaxKind kind, bool may_have_name,
                                         const char *what, const char *example)
{
    Span   start = token_here(p)->span;
    size_t first = begin_children(p);
    advance(p);
    const Token *name = may_have_name && kind_here(p) == TOKEN_NAME ? advance(p) : NULL;
    parse_properties(p, what, example);
    return finish(p, kind, start, first, name);
}

/* camera = "camera" [ NAME ] properties ; */
static Syntax *parse_camera(Parser *p)
{
    return parse_block_of_properties(p, SYNTAX_CAMERA, true, "`{` and the properties of the camera",
                                     "for example `camera { eye: [3, 2, 5], target: [0, 0, 0] }`");
}

/* light = "light" [ NAME ] properties ; */
static Syntax *parse_light(Parser *p)
{
    return parse_block_of_properties(p, SYNTAX_LIGHT, true, "`{` and the properties of the light",
                                     "for example `light sun { direction: [-1, 2, 1] }`");
}

/* sky = "sky" properties ; */
static Syntax *parse_sky(Parser *p)
{
    return parse_block_of_properties(p, SYNTAX_SKY, false, "`{` and the properties of the sky",
                                     "for example `sky { zenith: #5b87c5, horizon: #dfe9f2 }`");
}

/* fog = "fog" properties ; */
static Syntax *parse_fog(Parser *p)
{
    return parse_block_of_properties(p, SYNTAX_FOG, false, "`{` and the properties of the fog",
                                     "for example `fog { color: #dfe9f2, density: 0.05 }`");
}

/* medium = "medium" properties ; */
static Syntax *parse_medium(Parser *p)
{
    return parse_block_of_properties(
        p, SYNTAX_MEDIUM, false, "`{` and the properties of the medium",
        "for example `medium { within: box([4, 2, 4]), density: 0.5 }`");
}

/* image = "image" properties ; */
static Syntax *parse_image(Parser *p)
{
    return parse_block_of_properties(p, SYNTAX_IMAGE, false, "`{` and the properties of the image",
                                     "for example `image { size: [1920, 1080], samples: 64 }`");
}

/* zone = "zone" properties ; */
static Syntax *parse_zone(Parser *p)
{
    return parse_block_of_properties(p, SYNTAX_ZONE, false, "`{` and the properties of the zone",
                                     "for example `zone { center: [0, 1, 0], radius: 0.5 }`");
}

/* surroundings = camera | light | sky | fog | medium | image | zone ; */
Syntax *parse_surroundings(Parser *p)
{
    switch (kind_here(p)) {
    case TOKEN_CAMERA: return parse_camera(p);
    case TOKEN_LIGHT: return parse_light(p);
    case TOKEN_SKY: return parse_sky(p);
    case TOKEN_FOG: return parse_fog(p);
    case TOKEN_MEDIUM: return parse_medium(p);
    case TOKEN_ZONE: return parse_zone(p);
    default: return parse_image(p);
    }
}
