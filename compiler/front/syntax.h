/*
 * syntax.h: the syntax tree.
 *
 * Every node has a kind, a span, a name, and children.  The table says what these mean for each
 * kind.  Printing, checking of names and elaboration rely on it.
 */
#ifndef KRS_SYNTAX_H
#define KRS_SYNTAX_H

#include "compiler/base/source.h"
#include "compiler/base/text.h"
#include "compiler/front/token.h"

/* Behind each kind are its name, its children, and the other members that are set. */
typedef enum SyntaxKind {
    SYNTAX_ERROR, /* -      none; a mistake here has been reported */
    /* expressions */
    SYNTAX_NUMBER,        /* -      none; number[0] (degrees are already radians) */
    SYNTAX_COLOUR,        /* -      none; number[0..2], linear Rec.709 */
    SYNTAX_STRING,        /* text   none; the name is the text between the quotes, unescaped */
    SYNTAX_BOOLEAN,       /* -      none; number[0] is 0 or 1 */
    SYNTAX_NAME,          /* name   none */
    SYNTAX_LIST,          /* -      elements */
    SYNTAX_COMPREHENSION, /* -      [0] element, [1..] FOR_CLAUSE or IF_CLAUSE, outermost first */
    SYNTAX_FOR_CLAUSE,    /* name   [0] the list */
    SYNTAX_IF_CLAUSE,     /* -      [0] the condition */
    SYNTAX_RANGE,         /* -      [0] from, [1] to */
    SYNTAX_UNARY,         /* -      [0] operand; op is TOKEN_MINUS or TOKEN_NOT */
    SYNTAX_BINARY,        /* -      [0] left, [1] right; op; name_span is the operator's */
    SYNTAX_IF,            /* -      [0] condition, [1] then, [2] else */
    SYNTAX_LET_IN,        /* name   [0] value, [1] body */
    SYNTAX_MESSAGE_IN,    /* -      [0] MESSAGE, [1] body */
    SYNTAX_CALL,          /* -      [0] callee, [1..] ARGUMENT */
    SYNTAX_METHOD,        /* name   [0] receiver, [1..] ARGUMENT; parentheses may be missing */
    SYNTAX_ARGUMENT,      /* name?  [0] value; name NULL when positional */
    SYNTAX_INDEX,         /* -      [0] list, [1] index */
    SYNTAX_KRS, /* -      statements: KERNEL REFLECT MOBIUS LET MESSAGE FOR IF_STATEMENT */
    /* statements */
    SYNTAX_BLOCK,        /* -      statements (of a `for` or `if`, and of the whole file) */
    SYNTAX_LET,          /* name   [0] value */
    SYNTAX_DEF,          /* name   [0..n-2] PARAMETER, [n-1] body */
    SYNTAX_PARAMETER,    /* name   [0] default, [1] range (any expression); no [1], or no child;
                         number[0] is its ParameterKind */
    SYNTAX_PARAM,        /* name   [0] default, [1] range (any expression), or no [1] */
    SYNTAX_SHAPE,        /* name   PARAMETER..., PROPERTY... */
    SYNTAX_MATERIAL,     /* name   PARAMETER..., PROPERTY...; number[0] is 1 if it is called */
    SYNTAX_CAMERA,       /* name?  PROPERTY... */
    SYNTAX_LIGHT,        /* name?  PROPERTY... */
    SYNTAX_SKY,          /* -      PROPERTY... */
    SYNTAX_FOG,          /* -      PROPERTY... */
    SYNTAX_MEDIUM,       /* -      PROPERTY... */
    SYNTAX_IMAGE,        /* -      PROPERTY... */
    SYNTAX_ZONE,         /* -      PROPERTY... */
    SYNTAX_PROPERTY,     /* name   [0] value */
    SYNTAX_SHOW,         /* -      [0] value */
    SYNTAX_MESSAGE,      /* word   ARGUMENT...; the name is `print` or `assert` */
    SYNTAX_USE,          /* path   none; the name is the path */
    SYNTAX_FOR,          /* name   [0] the list, [1] BLOCK */
    SYNTAX_IF_STATEMENT, /* -      [0] condition, [1] BLOCK, [2] BLOCK, IF_STATEMENT, or none */
    SYNTAX_KERNEL,       /* -      [0] shape */
    SYNTAX_REFLECT,      /* -      [0] plane */
    SYNTAX_MOBIUS,       /* -      [0] map */
    SYNTAX_KIND_COUNT
} SyntaxKind;

/* The kind of values that a parameter takes: kinds.def. */
typedef enum ParameterKind {
    KIND_ANY,
#define KIND(name, latest, many, check, wanted) KIND_##name,
#include "compiler/front/kinds.def"
#undef KIND
    KIND_COUNT
} ParameterKind;

typedef struct Syntax Syntax;
struct Syntax {
    SyntaxKind  kind;
    TokenKind   op;
    Span        span;      /* of the whole node */
    Span        name_span; /* of the name; for UNARY, BINARY and RANGE of the operator */
    const char *name;      /* interned, or NULL */
    const char *doc;       /* the `///` comment before what defines a name of the file, or NULL */
    double      number[3];
    Syntax    **children;
    uint32_t    count;
    uint32_t    height; /* levels of this subtree, at least 1 */
};

/* Most levels of an expression, so that functions may walk the tree by recursion. */
enum { SYNTAX_MAX_LEVELS = 1000 };

/* Returns "points"; NULL for KIND_ANY. */
const char *parameter_kind_name(ParameterKind kind);

/* Returns "comprehension", for dumps. */
const char *syntax_kind_name(SyntaxKind kind);

/* Tells whether a definition is called: a `def`, a shape, a material with a list of parameters. */
bool syntax_is_function(const Syntax *syntax);

/* Tells whether a statement gives its name a meaning in the whole file. */
bool syntax_defines(const Syntax *syntax);

/* Writes the tree as indented text, a node in each line: kind, name, number, line:column. */
void syntax_print(const Syntax *syntax, const Sources *sources, Text *out);

#endif
