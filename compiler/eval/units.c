/*
 * units.c: numbers that seem to be in another unit than the language's: angles in degrees without
 * `deg`, colours that go up to 255.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "compiler/eval/elaborate.h"

/* ---- angles ---- */

bool written_in_degrees(const Elaboration *e, const Syntax *syntax)
{
    bool found = false;
    if (syntax->kind == SYNTAX_NUMBER) {
        const char *text = e->sources->items[syntax->span.source].text;
        for (uint32_t at = syntax->span.start; at + 3 <= syntax->span.end; at++)
            found = found || memcmp(text + at, "deg", 3) == 0;
    }
    for (uint32_t i = 0; i < syntax->count && !found; i++)
        found = written_in_degrees(e, syntax->children[i]);
    return found;
}

void add_number(Text *text, double number, bool degrees)
{
    /* Conversions to radians and back make noise of the last digits. */
    char printed[64];
    if (!degrees) {
        text_number(text, number);
        return;
    }
    snprintf(printed, sizeof printed, "%.12g", number * 180 / M_PI);
    text_printed_number(text, printed);
    text_add(text, "deg");
}

/* Tells whether an expression is a number as such, perhaps with a minus. */
static bool is_literal(const Syntax *syntax)
{
    if (syntax->kind == SYNTAX_UNARY && syntax->op == TOKEN_MINUS)
        syntax = syntax->children[0];
    return syntax->kind == SYNTAX_NUMBER;
}

const char *degrees_instead(Elaboration *e, const Syntax *syntax)
{
    const Source *source = &e->sources->items[syntax->span.source];
    if (source->library || !is_literal(syntax) || written_in_degrees(e, syntax))
        return NULL;
    int length = (int)(syntax->span.end - syntax->span.start);
    return diag_text(e->diags, "%.*sdeg", length, source->text + syntax->span.start);
}

void warn_of_revolutions(Elaboration *e, const Syntax *syntax, Value value)
{
    if (value.type != VALUE_NUMBER || fabs(value.number) <= 2 * M_PI + 1e-9)
        return;
    const char *instead = degrees_instead(e, syntax);
    if (!instead)
        return;
    Diag *diag        = diag_add(e->diags, DIAG_MANY_REVOLUTIONS, syntax->span,
                                 "an angle of %g radians, which are %.3g turns", value.number,
                                 fabs(value.number) / (2 * M_PI));
    diag->label       = "angles are radians";
    diag->help        = "degrees have their unit behind the number";
    diag->replacement = instead;
}

/* Tells whether it is a number of degrees that people write: 10 or more, and 360 or 15 go with it. */
static bool looks_like_degrees(double number)
{
    number = fabs(number);
    return number >= 10 && (fmod(number, 15) == 0 || fmod(360, number) == 0);
}

/* Returns the literal by which an expression of names, numbers and + - * / counts degrees; NULL:
   none, or something else is in it, as a function or a unit.  Names are followed `depth` times. */
static const Syntax *degrees_in(const Elaboration *e, const Syntax *syntax, int depth, bool *else_)
{
    const Syntax     *found = NULL;
    const Definition *definition;
    switch (syntax->kind) {
    case SYNTAX_NUMBER:
        *else_ = *else_ || written_in_degrees(e, syntax);
        return looks_like_degrees(syntax->number[0]) ? syntax : NULL;
    case SYNTAX_NAME:
        definition = definition_of(e, syntax);
        if (definition && definition->syntax && definition->syntax->kind == SYNTAX_LET && depth > 0)
            return degrees_in(e, definition->syntax->children[0], depth - 1, else_);
        return NULL;
    case SYNTAX_UNARY:
    case SYNTAX_BINARY:
        for (uint32_t i = 0; i < syntax->count; i++) {
            const Syntax *part = degrees_in(e, syntax->children[i], depth, else_);
            found              = found ? found : part;
        }
        return found;
    default: *else_ = true; return NULL;
    }
}

void warn_of_angle(Elaboration *e, const Syntax *syntax, Value value)
{
    enum { DEEPEST_CHAIN = 4 };
    bool          more = false, large = value.type == VALUE_NUMBER && fabs(value.number) >= 10;
    const Syntax *literal = NULL;
    warn_of_revolutions(e, syntax, value);
    /* An iteration with a large number earns the warning, so each is evaluated by itself. */
    if (value.type == VALUE_EXPRESSION && degrees_in(e, syntax, DEEPEST_CHAIN, &more) && !more)
        iterations_require(e, graph_bool(e->graph, false));
    if (!large || is_literal(syntax) || !is_of_author(e, syntax))
        return;
    /* A multiple of pi or degrees is no multiple of a half. */
    if (fmod(value.number, 0.5) == 0)
        literal = degrees_in(e, syntax, DEEPEST_CHAIN, &more);
    if (!literal || more)
        return;
    Diag *diag  = diag_add(e->diags, DIAG_MANY_REVOLUTIONS, syntax->span,
                           "an angle of %g radians, which are %.3g turns", value.number,
                           fabs(value.number) / (2 * M_PI));
    diag->label = "angles are radians";
    diag->help  = diag_text(e->diags, "degrees have their unit behind the number: `%gdeg`",
                            literal->number[0]);
    point_at_definition(e, diag, syntax);
}

/* ---- colours ---- */

/* Returns "#ff8000" for [255, 128, 0]: whole numbers up to 255 are the bytes of a colour; else
   NULL. */
static const char *bytes_instead(Elaboration *e, const double color[3])
{
    for (int i = 0; i < 3; i++)
        if (color[i] != floor(color[i]) || color[i] < 0 || color[i] > 255)
            return NULL;
    return diag_text(e->diags, "#%02x%02x%02x", (unsigned)color[0], (unsigned)color[1],
                     (unsigned)color[2]);
}

/* The largest part of a colour is at least this if it counts bytes; lights may be a little above 1. */
enum { MIN_BYTE = 16 };

/* Leaves iterations with colours that earn the warning to be evaluated by themselves. */
static void require_colour(Elaboration *e, Value value)
{
    const Node color = value_node(e, value);
    if (!e->iterated || color == NODE_NONE || e->graph->items[color].time != TIME_FRAME ||
        e->graph->items[color].type != TYPE_VEC3)
        return;
    const Node one = graph_number(e->graph, 1);
    for (uint32_t i = 0; i < 3; i++)
        iterations_require(
            e, graph_op2(e->graph, OP_less_equal, graph_component(e->graph, color, i), one));
}

void warn_of_bright_colour(Elaboration *e, const Syntax *syntax, Value value, const char *help)
{
    double color[3], most = 0;
    if (!is_of_author(e, syntax))
        return;
    require_colour(e, value);
    if (value.type != VALUE_LIST || value.list->count != 3)
        return;
    for (int i = 0; i < 3; i++) {
        if (value.list->items[i].type != VALUE_NUMBER)
            return;
        color[i] = value.list->items[i].number;
        most     = fmax(most, color[i]);
    }
    if (most <= 1)
        return;
    Diag *diag        = diag_add(e->diags, DIAG_BRIGHT_COLOUR, syntax->span,
                                 "a colour of %g, but the parts of a colour go from 0 to 1", most);
    diag->label       = "this is brighter than white";
    diag->help        = help;
    const char *bytes = most >= MIN_BYTE ? bytes_instead(e, color) : NULL;
    if (bytes)
        diag->help = diag_text(e->diags, "a colour of bytes has `#` and six digits: `%s`", bytes);
    if (syntax->kind == SYNTAX_LIST)
        diag->replacement = bytes;
    point_at_definition(e, diag, syntax);
}
