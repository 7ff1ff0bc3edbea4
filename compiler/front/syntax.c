/*
 * syntax.c: the syntax tree as text.
 */
#include "compiler/front/syntax.h"

const char *syntax_kind_name(SyntaxKind kind)
{
    static const char *const names[SYNTAX_KIND_COUNT] = {
        [SYNTAX_ERROR]         = "error",
        [SYNTAX_NUMBER]        = "number",
        [SYNTAX_COLOUR]        = "colour",
        [SYNTAX_STRING]        = "string",
        [SYNTAX_BOOLEAN]       = "boolean",
        [SYNTAX_NAME]          = "name",
        [SYNTAX_LIST]          = "list",
        [SYNTAX_COMPREHENSION] = "comprehension",
        [SYNTAX_FOR_CLAUSE]    = "for clause",
        [SYNTAX_IF_CLAUSE]     = "if clause",
        [SYNTAX_RANGE]         = "range",
        [SYNTAX_UNARY]         = "unary",
        [SYNTAX_BINARY]        = "binary",
        [SYNTAX_IF]            = "if then else",
        [SYNTAX_LET_IN]        = "let in",
        [SYNTAX_MESSAGE_IN]    = "message in",
        [SYNTAX_CALL]          = "call",
        [SYNTAX_METHOD]        = "method",
        [SYNTAX_ARGUMENT]      = "argument",
        [SYNTAX_INDEX]         = "index",
        [SYNTAX_KRS]           = "krs",
        [SYNTAX_BLOCK]         = "block",
        [SYNTAX_LET]           = "let",
        [SYNTAX_DEF]           = "def",
        [SYNTAX_PARAMETER]     = "parameter",
        [SYNTAX_PARAM]         = "param",
        [SYNTAX_SHAPE]         = "shape",
        [SYNTAX_MATERIAL]      = "material",
        [SYNTAX_CAMERA]        = "camera",
        [SYNTAX_LIGHT]         = "light",
        [SYNTAX_SKY]           = "sky",
        [SYNTAX_FOG]           = "fog",
        [SYNTAX_MEDIUM]        = "medium",
        [SYNTAX_IMAGE]         = "image",
        [SYNTAX_ZONE]          = "zone",
        [SYNTAX_PROPERTY]      = "property",
        [SYNTAX_SHOW]          = "show",
        [SYNTAX_MESSAGE]       = "message",
        [SYNTAX_USE]           = "use",
        [SYNTAX_FOR]           = "for",
        [SYNTAX_IF_STATEMENT]  = "if",
        [SYNTAX_KERNEL]        = "kernel",
        [SYNTAX_REFLECT]       = "reflect",
        [SYNTAX_MOBIUS]        = "mobius",
    };
    return names[kind];
}

/* Writes the operator, name or numbers of a node. */
static void print_content(const Syntax *syntax, Text *out)
{
    uint32_t numbers = 0;
    switch (syntax->kind) {
    case SYNTAX_NUMBER: numbers = 1; break;
    case SYNTAX_COLOUR: numbers = 3; break;
    case SYNTAX_BOOLEAN: text_add(out, syntax->number[0] != 0 ? " true" : " false"); break;
    case SYNTAX_STRING:
    case SYNTAX_USE:
        text_add(out, " ");
        text_json(out, syntax->name);
        return;
    case SYNTAX_UNARY:
    case SYNTAX_BINARY: text_format(out, " %s", token_kind_text(syntax->op)); break;
    default: break;
    }
    if (syntax->name)
        text_format(out, " %s", syntax->name);
    if (syntax->kind == SYNTAX_PARAMETER && syntax->number[0] != 0)
        text_format(out, ": %s", parameter_kind_name((ParameterKind)syntax->number[0]));
    for (uint32_t i = 0; i < numbers; i++) {
        text_add(out, " ");
        text_number(out, syntax->number[i]);
    }
}

static void print_level(const Syntax *syntax, const Sources *sources, int level, Text *out)
{
    const Source *source   = &sources->items[syntax->span.source];
    Position      position = source_position(source, syntax->span.start);
    text_format(out, "%*s%s", 2 * level, "", syntax_kind_name(syntax->kind));
    print_content(syntax, out);
    text_format(out, " %u:%u\n", position.line, position.column);
    for (uint32_t i = 0; i < syntax->count; i++)
        print_level(syntax->children[i], sources, level + 1, out);
}

void syntax_print(const Syntax *syntax, const Sources *sources, Text *out)
{
    print_level(syntax, sources, 0, out);
}

const char *parameter_kind_name(ParameterKind kind)
{
    static const char *const names[] = {
        NULL,
#define KIND(name, latest, many, check, wanted) #name,
#include "compiler/front/kinds.def"
#undef KIND
    };
    return names[kind];
}

bool syntax_is_function(const Syntax *syntax)
{
    return syntax->kind == SYNTAX_DEF || syntax->kind == SYNTAX_SHAPE ||
           (syntax->kind == SYNTAX_MATERIAL && syntax->number[0] != 0);
}

bool syntax_defines(const Syntax *syntax)
{
    switch (syntax->kind) {
    case SYNTAX_LET:
    case SYNTAX_DEF:
    case SYNTAX_PARAM:
    case SYNTAX_SHAPE:
    case SYNTAX_MATERIAL: return true;
    case SYNTAX_CAMERA:
    case SYNTAX_LIGHT: return syntax->name != NULL;
    default: return false;
    }
}
