/*
 * call.h: arguments of built-in functions and methods: which belongs to which parameter, what
 * it must be, and what is said when it is not.
 *
 * It is for the files of this folder, which get it by elaborate.h.
 */
#ifndef KRS_CALL_H
#define KRS_CALL_H

#include "compiler/eval/value.h"
#include "compiler/graph/graph.h"
#include "compiler/shape/shape.h"

typedef struct Elaboration Elaboration;
typedef struct Environment Environment;

/* An argument as it arrived: its value and where it was written. */
typedef struct Argument {
    Value         value;
    const Syntax *syntax; /* NULL: not given */
} Argument;

enum { MAX_PARAMETERS = 12 };

/* A call of a built-in function or method, arguments in the order of its parameters.  What
   stood in a variadic first parameter is gathered in `rest`. */
typedef struct Call {
    const Syntax *syntax; /* the whole call, or method call */
    const char   *name;
    Argument      arguments[MAX_PARAMETERS];
    Argument     *rest;
    uint32_t      rest_count;
} Call;

/* A function that is built in. */
typedef Value BuiltinFunction(Elaboration *e, Call *call);
typedef struct Builtin {
    const char      *name;
    const char      *parameters;
    Op               op;       /* of componentwise functions, else OP_COUNT */
    BuiltinFunction *function; /* NULL: componentwise `op` */
} Builtin;

/*
 * Each `want_` says what an argument must be, reports when it is not and then returns NODE_NONE,
 * NULL or false.  A missing argument gives the default and no report.  Values that are VALUE_ERROR
 * fail silently.
 */

/* The names that an argument may choose: kinds of blends, palettes. */
typedef struct Choices {
    const char *noun, *wanted;  /* "blend"; "the kind of a blend, a string" */
    const char *unknown, *more; /* label of another name; what follows the names in its help */
    const char *const *items;
    uint32_t           count;
} Choices;

/* Finds which name an argument has, the first without one. */
bool want_name(Elaboration *e, const Argument *argument, const Choices *names, uint32_t *chosen);

/* These return a FLOAT, or a VEC3, of frame time. */
Node want_number(Elaboration *e, const Call *call, uint32_t index, double otherwise);
Node want_vector(Elaboration *e, const Call *call, uint32_t index, const double otherwise[3]);
bool want_count(Elaboration *e, const Call *call, uint32_t index, uint32_t least, uint32_t most,
                uint32_t otherwise, uint32_t *count);
const Shape *want_shape(Elaboration *e, const Call *call, uint32_t index);
/* Returns the node of a number or a vector. */
Node want_numeric(Elaboration *e, const Call *call, uint32_t index);
/* These find a list, or a number, that is known at compile time; *number stays what it is when
   nothing was given. */
const List *want_list(Elaboration *e, const Call *call, uint32_t index);
bool        want_constant(Elaboration *e, const Call *call, uint32_t index, double *number);
/* Finds true or false, known at compile time; *flag stays what it is when nothing was given. */
bool want_flag(Elaboration *e, const Call *call, uint32_t index, bool *flag);
/* Finds the parameter "plane": its unit normal and offset. */
bool want_plane(Elaboration *e, const Call *call, Node *normal, Node *offset);
/* These return the map that the parameters "by", "axis angle" and "by" describe. */
const Map *want_translation(Elaboration *e, const Call *call);
const Map *want_rotation(Elaboration *e, const Call *call);
const Map *want_scaling(Elaboration *e, const Call *call);
/* These return the same for a value that stands anywhere; `what` names it: "`fov`", "this
   argument". */
Node to_number(Elaboration *e, Value value, const Syntax *syntax, const char *what);
Node to_vector(Elaboration *e, Value value, const Syntax *syntax, const char *what);
Node to_pair(Elaboration *e, Value value, const Syntax *syntax, const char *what);
bool is_given(const Call *call, uint32_t index);

/* Reports a direction that is always the zero vector, or a size that can be 0 or less. */
bool check_direction(Elaboration *e, Node vector, const Syntax *syntax, const char *what);
bool check_positive(Elaboration *e, Node number, const Syntax *syntax, const char *what);
/* Reports a number or vector of which some part can be negative. */
bool check_not_negative(Elaboration *e, Node node, const Syntax *syntax, const char *what);
/* Reports a number that can be infinite for some permitted value of the parameters. */
bool check_finite(Elaboration *e, Node node, const Syntax *syntax);

/* Sorts the arguments of a call into the parameters "a b= rest..."; false: reported.  `=` marks
   an optional parameter, `...` one that takes all positional ones. */
bool bind_arguments(Elaboration *e, const Environment *env, const Syntax *call_syntax,
                    uint32_t first, const char *name, const char *parameters, Call *call);

/* Reports too many arguments; the strings of `parameters` must live as long as the diagnostics. */
Diag *too_many_arguments(Elaboration *e, const Syntax *argument, const char *name, uint32_t count);
Diag *missing_argument(Elaboration *e, const Syntax *call, const char *name, const char *parameter);
void unknown_parameter(Elaboration *e, const Syntax *call, const Syntax *argument, const char *name,
                       const char *const *parameters, uint32_t count);
/* Adds how a function or method of the language is called, where synonyms.def has that. */
void explain_usage(Elaboration *e, Diag *diag, const Syntax *call, const char *name);
/* Adds a note with the names that would be right: "its properties: eye, target". */
void note_names(Elaboration *e, Diag *diag, const char *what, const char *const *names,
                size_t count);
/* Returns a value of another type than `wanted` ("a number"); silent for VALUE_ERROR. */
Diag *type_error(Elaboration *e, const Syntax *syntax, Value found, const char *wanted);
/* Reports a value that must be known at compile time, and is not. */
void constant_error(Elaboration *e, const Syntax *syntax, const char *message);
/* Reports a value that must be the same at every point, and is not; `what` names it. */
void point_error(Elaboration *e, const Syntax *syntax, const char *what);
/* Reports what the language describes and this version does not have. */
void not_supported(Elaboration *e, Span span, const char *what);
/* Returns "torus(major, minor)", for notes. */
const char *signature(Elaboration *e, const char *name, const char *const *parameters,
                      uint32_t count);

#endif
