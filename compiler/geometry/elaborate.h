/*
 * elaborate.h: compile-time evaluation, from the syntax tree to the scene.
 *
 * Evaluation is eager and by value; only top-level definitions are evaluated when first needed,
 * so that they may stand in any order.  A mistake is reported where it is found, its value is
 * VALUE_ERROR, and everything that meets such a value stays silent, so that one run reports
 * several independent mistakes.
 *
 * This header is for the files of this folder; the rest of the compiler calls elaborate() only.
 */
#ifndef KRS_ELABORATE_H
#define KRS_ELABORATE_H

#include "compiler/geometry/shape.h"

/* Reads a file that a `use` names: malloc'ed bytes, or NULL with *reason set. */
typedef char *FileReader(void *user, const char *path, size_t *length, const char **reason);

typedef struct Binding {
    const char           *name;
    Value                 value;
    Span                  span; /* of the name where it was bound */
    const struct Binding *next;
} Binding;

typedef struct Environment Environment;
struct Environment {
    const Binding *locals;
    struct Scope  *scope; /* the file whose top-level names are seen */
};

/* A top-level name. */
typedef struct Definition {
    const char    *name;
    const Syntax  *syntax;
    struct Scope  *scope;
    enum { DEFINITION_NEW, DEFINITION_RUNNING, DEFINITION_DONE } state;
    Value          value;
} Definition;

/* A file, its definitions, and the files that it uses. */
typedef struct Scope {
    const char    *path;
    const Syntax  *file;
    bool           loading;
    Environment    environment; /* no locals, this scope */
    struct { Definition **items; size_t count, capacity; } definitions;
    Definition   **slots; /* hash table by the address of the name */
    size_t         slot_count;
    struct { struct Scope **items; size_t count, capacity; } used;
} Scope;

typedef struct Elaboration {
    Arena      *arena;  /* values, shapes and the scene */
    Arena      *syntax; /* trees of used files */
    Arena      *scratch;
    Diags      *diags;
    Names      *names;
    Sources    *sources;
    Graph      *graph;
    Scene      *scene;
    Scope      *library;
    struct { Scope **items; size_t count, capacity; } scopes;
    struct { const Syntax **items; size_t count, capacity; } checked; /* shape declarations sampled */
    FileReader *read_file;
    void       *reader;
    uint64_t    steps;
    uint32_t    depth, calls;
    size_t      text_total;
    bool        stopped; /* a limit was reached: everything is an error from here, silently */
    Node        rounding; /* what the name `rounding` means in `core:`, or NODE_NONE */
    bool        in_material; /* level and instance have a meaning */
} Elaboration;

/* Evaluates a file, whose source is already in e->sources, into e->scene. */
void elaborate(Elaboration *e, uint32_t source, const char *path);

/* ---- scope.c ---- */
/* Makes e->library of the embedded files that every scene sees. */
void        scope_load_library(Elaboration *e);
Scope      *scope_load(Elaboration *e, uint32_t source, const char *path);
Definition *scope_find(const Scope *scope, const char *name);

/* ---- expression.c ---- */
Value evaluate(Elaboration *e, const Environment *env, const Syntax *syntax);
/* A list's elements in turn: of a SYNTAX_RANGE without making the list.  False: reported. */
typedef bool EachElement(Elaboration *e, Value element, void *user);
bool evaluate_each(Elaboration *e, const Environment *env, const Syntax *syntax, EachElement *each, void *user);
Environment bind(Elaboration *e, const Environment *env, const char *name, Value value, Span span);
/* Counts a step of evaluation; false when a limit is reached (reported once). */
bool step(Elaboration *e, Span span);
Value run_definition(Elaboration *e, Definition *definition, Span use);

/* ---- arithmetic.c ---- */
Value value_unary(Elaboration *e, const Syntax *syntax, Value a);
Value value_binary(Elaboration *e, const Syntax *syntax, Value a, Value b);
Value value_select(Elaboration *e, const Syntax *syntax, Value condition, Value yes, Value no);
Value value_map_op(Elaboration *e, Op op, const Value *arguments, uint32_t count, const Syntax *place);
Value value_of_node(Elaboration *e, Node node);
Value value_vector(Elaboration *e, const double *numbers, uint32_t count);
/* 1 for a number, 2 to 4 for a vector, 0 for anything else. */
uint32_t value_size(const Elaboration *e, Value value);
/* "a number", "a vector of 3", "a shape": for messages. */
const char *value_type_name(Elaboration *e, Value value);
/* The node of a number, vector or truth value; NODE_NONE when it is none of these. */
Node value_node(Elaboration *e, Value value);
BindingTime value_time(const Elaboration *e, Value value);

/* ---- arguments.c ---- */
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

/*
 * Each `want_` says what an argument must be, reports when it is not and then returns NODE_NONE
 * or false.  A missing argument gives the default and no report.  Values that are VALUE_ERROR
 * fail silently.
 */
Node want_number(Elaboration *e, const Call *call, uint32_t index, double otherwise);   /* frame time FLOAT */
Node want_vector(Elaboration *e, const Call *call, uint32_t index, const double otherwise[3]); /* VEC3 */
bool want_count(Elaboration *e, const Call *call, uint32_t index, uint32_t least, uint32_t most,
                uint32_t otherwise, uint32_t *count);
const Shape *want_shape(Elaboration *e, const Call *call, uint32_t index);
/* Reports a direction that is always the zero vector, or a size that can be 0 or less. */
bool check_direction(Elaboration *e, Node vector, const Syntax *syntax, const char *what);
bool check_positive(Elaboration *e, Node number, const Syntax *syntax, const char *what);
/* Reports a number that can be infinite for some permitted value of the parameters. */
bool check_finite(Elaboration *e, Node node, const Syntax *syntax);
bool is_given(const Call *call, uint32_t index);
/* The same for a value that stands anywhere. */
Node to_number(Elaboration *e, Value value, const Syntax *syntax, const char *what);
Node to_vector(Elaboration *e, Value value, const Syntax *syntax, const char *what);
/* Sorts the arguments of a call into the parameters "a b= rest..."; false: reported.  `=` marks
   an optional parameter, `...` one that takes all positional ones. */
bool bind_arguments(Elaboration *e, const Environment *env, const Syntax *call_syntax, uint32_t first,
                    const char *name, const char *parameters, Call *call);
Diag *type_error(Elaboration *e, const Syntax *syntax, Value found, const char *wanted);
/* Marks where the name that `syntax` is was defined, as a second place of a diagnostic. */
void point_at_definition(Elaboration *e, Diag *diag, const Syntax *syntax, const char *label);

/* ---- builtins.c ---- */
typedef Value BuiltinFunction(Elaboration *e, Call *call);
typedef struct Builtin {
    const char      *name;
    const char      *parameters;
    Op               op; /* of componentwise functions, else OP_COUNT */
    BuiltinFunction *function; /* NULL: componentwise `op` */
    const char      *meaning;
} Builtin;
const Builtin *builtin_find(const char *name);
/* A constant (pi, x, time); false when there is none of this name. */
bool builtin_constant(Elaboration *e, const char *name, Span span, Value *value);
/* All names that need no definition, for names_check. */
size_t builtin_names(const char **names, size_t capacity);

/* ---- functions.c ---- */
Value call_function(Elaboration *e, const Environment *env, const Syntax *syntax, const Function *function);
Value call_values(Elaboration *e, const Function *function, const Value *values, const Syntax *const *places,
                  const Syntax *syntax);

/* ---- declare.c: shapes declared in the language ---- */
Value declare_instance(Elaboration *e, const Function *function, const Environment *parameters, Span span);

/* ---- methods.c ---- */
Value call_method(Elaboration *e, const Environment *env, const Syntax *syntax);

/* ---- make.c: shapes from shapes, each with its rule for box and slope ---- */
Shape *shape_new(Elaboration *e, ShapeKind kind, const char *name, Span span, const Shape *const *children,
                 uint32_t count);
const Shape *make_empty(Elaboration *e, Span span);
const Shape *make_transform(Elaboration *e, const Shape *shape, const Similarity *map, Span span);
const Shape *make_stretch(Elaboration *e, const Shape *shape, Node factors, Span span);
const Shape *make_joint(Elaboration *e, ShapeKind kind, const Shape *const *shapes, uint32_t count, BlendKind blend,
                        Node width, Node steps, Span span);
const Shape *make_morph(Elaboration *e, const Shape *a, const Shape *b, Node t, Span span);
const Shape *make_offset(Elaboration *e, const Shape *shape, Node radius, Span span);
const Shape *make_shell(Elaboration *e, const Shape *shape, Node thickness, Span span);
const Shape *make_elongate(Elaboration *e, const Shape *shape, Node half, Span span);
const Shape *make_extrude(Elaboration *e, const Shape *figure, Node height, Span span);
const Shape *make_revolve(Elaboration *e, const Shape *figure, Node offset, Span span);
const Shape *make_repeat(Elaboration *e, const Shape *shape, Node period, const uint32_t cells[3], const Syntax *place);
const Shape *make_repeat_polar(Elaboration *e, const Shape *shape, uint32_t count, const Syntax *place);
const Shape *make_mirror(Elaboration *e, const Shape *shape, Node normal, Node offset, Span span);
const Shape *make_paint(Elaboration *e, const Shape *shape, const Material *material, Span span);
const Shape *make_krs(Elaboration *e, const Stage *stages, uint32_t stage_count, const Shape *const *kernels,
                      uint32_t kernel_count, Span span);
/* Unit normal and offset of a shape that is a plane, also a moved, turned or scaled one. */
bool shape_plane(Elaboration *e, const Shape *shape, Node *normal, Node *offset);
/* Ranges of frame-time nodes over all values of the parameters. */
Range node_range(Elaboration *e, Node node, uint32_t component);

/* ---- similarity.c ---- */
const Similarity *similarity_identity(Elaboration *e);
const Similarity *similarity_translation(Elaboration *e, Node shift);
const Similarity *similarity_scaling(Elaboration *e, Node scale);
const Similarity *similarity_rotation(Elaboration *e, Node axis, Node angle);
const Similarity *similarity_alignment(Elaboration *e, Node from, Node to);
const Similarity *similarity_reflection(Elaboration *e, Node normal, Node offset);
const Similarity *similarity_product(Elaboration *e, const Similarity *f, const Similarity *g); /* f(g(x)) */
const Similarity *similarity_inverse(Elaboration *e, const Similarity *f);
Node similarity_turn(Elaboration *e, const Similarity *f, Node vector); /* rows times vector */
Box  similarity_box(Elaboration *e, const Similarity *f, Box box);

/* ---- looks.c: cameras, lights, sky, image, materials ---- */
Value elaborate_material(Elaboration *e, const Environment *env, const Syntax *syntax);
void  elaborate_look(Elaboration *e, const Environment *env, const Syntax *syntax);
void  finish_looks(Elaboration *e);
/* A material, or a colour that becomes one; NULL: reported. */
const Material *to_material(Elaboration *e, Value value, const Syntax *syntax);

/* ---- statements.c ---- */
Value elaborate_krs(Elaboration *e, const Environment *env, const Syntax *syntax);

#endif
