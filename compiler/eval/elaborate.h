/*
 * elaborate.h: compile-time evaluation, from the syntax tree to the scene.
 *
 * Evaluation is eager and by value; only top-level definitions are evaluated when first needed,
 * so that they may stand in any order.  A mistake is reported where it is found, its value is
 * VALUE_ERROR, and everything that meets such a value stays silent, so that one run reports
 * several independent mistakes.
 *
 * This header is for the files of this folder and its rooms; the rest of the compiler calls elaborate() only.
 */
#ifndef KRS_ELABORATE_H
#define KRS_ELABORATE_H

#include "compiler/base/loader.h"
#include "compiler/eval/call.h"
#include "compiler/eval/texture_keys.h"
#include "compiler/eval/value.h"
#include "compiler/eval/vocabulary.h"
#include "compiler/family/family.h"
#include "compiler/front/files.h"
#include "compiler/front/synonyms.h"
#include "compiler/base/fonts.h"
#include "compiler/shape/scene.h"
#include "compiler/shape/slope.h"

typedef struct Binding {
    const char           *name;
    Value                 value;
    const struct Binding *next; /* bound before, in this or an outer block */
} Binding;

struct Environment {
    const Binding *locals;
    struct Scope  *scope; /* the file whose top-level names are seen */
};

/* A top-level name. */
typedef struct Definition {
    const char   *name;
    const Syntax *syntax;
    struct Scope *scope;
    enum { DEFINITION_NEW, DEFINITION_RUNNING, DEFINITION_DONE } state;
    Value value;
} Definition;

/* A file, its definitions, and the files that it uses. */
typedef struct Scope {
    const Syntax *file;
    Environment   environment; /* no locals, this scope */
    struct {
        Definition **items;
        size_t       count, capacity;
    } definitions;
    Definition **slots; /* hash table by the address of the name */
    size_t       slot_count;
    struct {
        struct Scope **items;
        size_t         count, capacity;
    } used;
} Scope;

/* A name that is looked up among the built-in ones: a function, a constant, or neither. */
typedef struct BuiltinName {
    const char     *name;
    const Function *function; /* or NULL */
    bool            constant;
} BuiltinName;

enum { MAX_BUILTIN_NAMES = 512 };

/* The bytes of a file that scenes name in an argument. */
typedef struct FileBytes {
    const char          *path;
    const unsigned char *bytes;
    size_t               length;
    int                  face; /* of a font: which of several */
} FileBytes;

struct Elaboration {
    ShapeBuilder *builder; /* with the arenas, diagnostics and graph that stand here as well */
    Arena        *arena;   /* shapes and the scene */
    Arena        *values;  /* values and bindings of names, until they are forgotten */
    uint64_t      kept;    /* how often something began to refer to them for good */
    Arena        *scratch;
    Diags        *diags;
    Sources      *sources;
    Files        *files; /* with the names that equal strings share, and data that is read */
    Graph        *graph;
    Scene        *scene;
    Scope        *library; /* sees the files of the library */
    struct {
        Scope **items;
        size_t  count, capacity;
    } scopes; /* of the files, in their order */
    struct {
        const Syntax **items;
        size_t         count, capacity;
    } single; /* blocks that a scene has once: sky, fog, image, the camera without a name */
    struct {
        const Syntax **items;
        size_t         count, capacity;
    } checked; /* declarations of shapes, and properties, whose claims have been put to the test */
    struct {
        FileBytes *items;
        size_t     count, capacity;
    } read; /* files, bytes of which are no text */
    TextureKeys   textures;
    const Loader *loader;
    BuiltinName   builtins[MAX_BUILTIN_NAMES]; /* names looked up so far, by their addresses */
    bool     studio;   /* a scene without lights and sky gets those of the library, and a floor */
    bool     figures;  /* plane figures may be shown */
    bool     outlines; /* of polygons, also of those with few corners */
    bool     parameterises; /* numbers of the scene's own text are not those of the shaders' text */
    uint32_t number_count;  /* of such numbers so far */
    struct Derivations          *derivations;  /* which of them were computed from others: fold.c */
    uint64_t                     steps;        /* of evaluation, so far, */
    uint64_t                     max_steps;    /* and at most; 0: as many as a scene may take */
    uint32_t                     printed;      /* notes by `print`, so far */
    uint32_t                     depth, calls; /* how deep expressions and calls are nested now */
    const struct CalledFunction *called;       /* the innermost of these calls, or NULL */
    Node          rounding;    /* what the name `rounding` means in `core:`, or NODE_NONE */
    const Syntax *block;       /* the last one whose properties were looked at, or NULL */
    bool          in_material; /* level, instance, u, v, normal and front have a meaning */
    bool          uses_uv;     /* a material may need the coordinates on surfaces */
    /* Loops whose iterations are made at once (iterations.c), or NULL; and the one whose body is tried
       with a leaf for its variable now, or NULL. */
    struct IterationTrials *iterations;
    struct Iterated        *iterated;
    bool                    beams; /* someone asks for capsules that are shown */
    /* The expression whose shapes are made empty (hollow.c); source 0: there is none. */
    Span without;
    /* A call that joins shapes, or a `show`, of which the arguments are evaluated; or NULL. */
    const Syntax *joining;
};

/* The properties of the declaration that made a shape. */
struct Declaration {
    const Syntax *syntax;
    const Syntax *core;   /* what .round(r) grows by r, using `rounding`; or NULL */
    const Syntax *hull;   /* the balls and rims whose convex hull is its own; or NULL */
    const Syntax *border; /* the corners of its outline; or NULL */
    Environment   names;  /* what these expressions see */
};

/* Tells whether a text is the scene's, not the library's. */
static inline bool is_of_author(const Elaboration *e, const Syntax *syntax)
{
    return !e->sources->items[syntax->span.source].library;
}

/* The library's claims hold for all sizes: tests search them, and compiling does not wait. */
static inline bool is_of_library(const Elaboration *e, const Shape *shape)
{
    return !is_of_author(e, shape->declaration->syntax);
}

/* Tells whether a limit was reached: everything is an error from here, silently. */
static inline bool is_stopped(const Elaboration *e) { return e->builder->stopped; }

/* Evaluates the first of e->files, whose names have been checked, into e->scene; e->scene is
   complete unless e->diags has errors. */
void elaborate(Elaboration *e);

/* ---- scope.c ---- */
/* Makes e->scopes of e->files, and e->library of those that every scene sees. */
void scopes_make(Elaboration *e);
/* Returns a definition of the file or of the files that it uses, or NULL. */
Definition *scope_find(const Scope *scope, const char *name);

/* The distance from the origin that shapes, cameras and lights may have: single precision, in which
   devices compute, ends at 3e38, and its squares much earlier. */
static const double MAX_EXTENT = 1e12;

static const double ORIGIN[3] = {0, 0, 0};

/* ---- expression.c ---- */
/* A list has no more elements than that. */
enum { MAX_ELEMENTS = 4 * 1000 * 1000 };
/* Counts steps of evaluation; false when a limit is reached (reported once). */
bool count_steps(Elaboration *e, uint64_t count, Span span);
/* Evaluates an expression; VALUE_ERROR: a mistake was found, and has been reported. */
Value evaluate(Elaboration *e, const Environment *env, const Syntax *syntax);
/* A list's elements in turn: of a SYNTAX_RANGE without making the list.  False: reported. */
typedef bool EachElement(Elaboration *e, Value element, void *user);
bool evaluate_each(Elaboration *e, const Environment *env, const Syntax *syntax, EachElement *each,
                   void *user);
/* Returns the environment with one more name, which hides any equal one. */
Environment bind(Elaboration *e, const Environment *env, const char *name, Value value);
/* Tells whether one may go through all shapes of a list and of the lists in it; false: reported. */
bool check_shape_count(Elaboration *e, const List *list, Span span);
/* Returns the value of a top-level definition, evaluated when it is first needed, at `use`. */
Value run_definition(Elaboration *e, Definition *definition, Span use);

/* ---- hollow.c: a scene without a part ---- */
/* Returns the place as a span of the texts that are loaded; source 0: none of them is the author's
   and has that name. */
Span location_span(const Sources *sources, const KrsLocation *location);
/* Returns a shape as an empty one in its box, and shapes of a list likewise; any other value as it
   is. */
Value value_hollow(Elaboration *e, Value value);

/* ---- forget.c: what is needed while one element or one iteration of a loop is evaluated ---- */
typedef struct EvaluationMark {
    ArenaMark values;
    uint64_t  kept;
} EvaluationMark;
EvaluationMark evaluation_mark(const Elaboration *e);
/* Frees the values and bindings made since, but for this value, which may be NULL; not if something
   refers to them. */
void evaluation_forget(Elaboration *e, EvaluationMark mark, Value *result);
/* Returns the names that `inner` adds to `outer`, so that they stay. */
Environment keep_names(Elaboration *e, const Environment *inner, const Environment *outer);

/* The function that the clauses of a comprehension call: the next clause, or the element itself. */
typedef struct Comprehension {
    const Environment    *env;
    const Syntax         *syntax;
    uint32_t              clause;
    Values               *result;
    EvaluationMark        mark; /* before the innermost name was bound */
    struct IterationLoop *loop; /* its iterations may be made at once; or NULL */
} Comprehension;

/* ---- iterations.c: loops whose iterations differ in numbers only are evaluated once ---- */
typedef struct IterationTrials {
    uint32_t least;      /* iterations of such a loop */
    uint32_t loops;      /* made so far */
    uint32_t depth;      /* being tried now, one within a definition that another needs */
    uint32_t statements; /* loops of statements around what runs now */
    struct {
        Definition **items;
        size_t       count, capacity;
    } defined; /* while any was tried: all this is dropped with it */
} IterationTrials;
typedef struct IterationLoop {
    bool tried, made; /* all iterations at once: tried; and done */
} IterationLoop;
/* Evaluates what a statement shows. */
Value evaluate_shown(Elaboration *e, const Environment *env, const Syntax *show);
/* Tells whether that may be tried: the shapes of this comprehension are joined. */
bool iterations_possible(const Elaboration *e, const Syntax *comprehension);
/* Tries, behind the first element, to make all of them; true: they are made. */
bool iterations_made(Elaboration *e, const Comprehension *c);
/* Requires that a condition holds in each iteration of a loop that is tried; false: none is
   tried. */
bool iterations_require(Elaboration *e, Node condition);
/* Returns an iteration of a loop that was made at once by itself, for what needs its numbers, and
   any other shape as it is.  NULL: a limit was reached. */
const Shape *iteration_alone(Elaboration *e, const Shape *shape);
/* Begins a definition that is evaluated now, and is no part of a loop that is tried.  Returns
   e->iterated, to be set again behind it. */
struct Iterated *iterations_begin_definition(Elaboration *e, Definition *definition);

/* ---- iteration_statements.c: a `for` that shows shapes, evaluated once ---- */
/* Tries, behind the first iteration that shows something, to show what all iterations do, in their
   order; true: it is shown.  `shown`: how many components were there before the loop. */
typedef bool ShowShape(Elaboration *e, Value value, const Syntax *syntax);
bool         statement_iterations_made(Elaboration *e, const Environment *env, const Syntax *loop,
                                       size_t shown, ShowShape *show);

/* ---- fold.c ---- */
/* Returns a number that the author of the scene may change without another program: it gets an
   identity, by the order of evaluation, if such numbers are kept out of shaders. */
Value value_authored(Elaboration *e, Value value);
/* Returns a number that an operation on others gives: the author may change it if one of them.  The
   same operation on the same numbers gives the same number. */
Value value_from(Elaboration *e, Value value, Op op, const Value *arguments, uint32_t count);
/* Tells whether it is such a number, or a list of some. */
bool value_is_authored(Value value);
/* Computes the common case, which makes no node: an operation on numbers that are known now, though
   the author may change them.  False: some are not, or the result is not finite. */
bool fold_op(Op op, const Value *arguments, uint32_t count, double *result);
/* Does the same of vectors and numbers, of which the author may change some.  Of others nodes are
   constants, which are folded where they are made. */
bool fold_vectors(Elaboration *e, Op op, const Value *arguments, uint32_t count, Value *result);

/* ---- arithmetic.c ---- */
/* These return the operator `syntax->op` on values; types that it does not go with are reported. */
Value value_unary(Elaboration *e, const Syntax *syntax, Value a);
Value value_binary(Elaboration *e, const Syntax *syntax, Value a, Value b);
/* Evaluates an `if` on a condition that is a node: both branches are there, one is chosen. */
Value value_select(Elaboration *e, const Syntax *syntax, Value condition, Value yes, Value no);
/* Returns an operation that works element by element, on numbers and vectors whose types go
   together (graph_op_type); `origin` is blamed for results that are not finite. */
Value value_map_op(Elaboration *e, Op op, const Value *arguments, uint32_t count,
                   const Syntax *origin);
/* Returns a number, vector or truth value, plain where the node is constant. */
Value value_of_node(Elaboration *e, Node node);
/* Takes over `items`, which are in the arena. */
Value value_list(Elaboration *e, Value *items, size_t count);
Value value_vector(Elaboration *e, const double *numbers, uint32_t count);
/* Returns 1 for a number, 2 to 4 for a vector, 0 for anything else. */
uint32_t value_size(const Elaboration *e, Value value);
/* Tells how many elements a vector has, all of them finite numbers that are known now; else 0. */
uint32_t value_numbers(Value value, double numbers[4]);
/* Returns "a number", "a vector of 3", "a shape": for messages. */
const char *value_type_name(Elaboration *e, Value value);
/* Returns the node of a number, vector or truth value; NODE_NONE when it is none of these. */
Node value_node(Elaboration *e, Value value);
/* Returns the latest of its parts. */
BindingTime value_time(const Elaboration *e, Value value);

/* ---- units.c ---- */
/* Tells whether a number in an expression has `deg` behind it. */
bool written_in_degrees(const Elaboration *e, const Syntax *syntax);
/* Adds "1.5", or "90deg". */
void add_number(Text *text, double number, bool degrees);
/* Returns "90deg" for the literal 90 of a scene; NULL: it is none, or in degrees already. */
const char *degrees_instead(Elaboration *e, const Syntax *syntax);
/* Warns of an angle that is written as a number above one turn. */
void warn_of_revolutions(Elaboration *e, const Syntax *syntax, Value value);
/* Does the same of what turns something: also where names, or numbers times a name, seem to be
   degrees. */
void warn_of_angle(Elaboration *e, const Syntax *syntax, Value value);
/* Warns of a constant colour above 1; `help` says what else could be meant. */
void warn_of_bright_colour(Elaboration *e, const Syntax *syntax, Value value, const char *help);

/* ---- reports.c ---- */
/* Tells whether what has this range on an axis is near enough for devices to compute with; `what` names
   it.  False: reported. */
bool check_extent(Elaboration *e, Range range, uint32_t axis, const Syntax *syntax,
                  const char *what);
/* Returns the top-level definition that a name refers to, as far as its file tells; or NULL. */
const Definition *definition_of(const Elaboration *e, const Syntax *name);
/* Marks where `syntax` was defined as a second place of `diag`, if it is a top-level name. */
void point_at_definition(Elaboration *e, Diag *diag, const Syntax *syntax);

/* ---- members.c ---- */
/* Tells whether `value.name` has the letters of components behind a vector: `v.x`, `c.rgb`. */
bool is_component(const Elaboration *e, Value value, const Syntax *syntax);
/* These return a number, or a vector of as many components as the name has letters. */
Value value_components(Elaboration *e, const Syntax *syntax, Value vector);
Value value_record(Elaboration *e, const Value *names, const Value *values, size_t count);
/* Returns the member of a name, which is written at `span`. */
Value record_member(Elaboration *e, const Record *record, const char *name, Span span);
/* Evaluates `list[index]`, also of vectors and records. */
Value value_index(Elaboration *e, const Syntax *syntax, Value list, Value index);

/* ---- files.c ---- */
/* Reads a file that an argument names, relative to the file that has the call; false: reported.  It is
   read once. */
bool read_beside(Elaboration *e, const Argument *argument, const char *path, FileBytes *bytes);
/* Reports that the picture in a file that was read is none, and why. */
void refuse_picture(Elaboration *e, const Syntax *named, const char *path, const char *fault);
/* Reads a font that a scene names by its name, or any where that is NULL: the caller's, or one of the system. */
FontSearch read_font(Elaboration *e, const char *name, FileBytes *bytes);

/* ---- functions.c ---- */
/* Calls a function, or makes the shape of a declaration; `syntax` is the call. */
Value call_function(Elaboration *e, const Environment *env, const Syntax *syntax,
                    const Function *function);

/* Returns the same with one value for the first parameter; `call` is where that happens. */
Value call_with(Elaboration *e, const Function *function, Value first, const Syntax *call);
/* Returns the same of a function of the library that scenes do not see. */
Value call_library(Elaboration *e, const char *name, Value first, const Syntax *call);

/* Finds what in the scene called the function of the library that is evaluated now: its name, and
   the call.  False: the scene does so itself. */
bool made_for_author(const Elaboration *e, const char **name, Span *span);

/* ---- empty.c ---- */
/* Tells whether a shape can be empty though its parts are not. */
bool may_vanish(const Shape *shape);
/* Warns of a component, shown at `span`, that is known to be empty. */
void warn_if_nothing_is_left(Elaboration *e, const Shape *shape, const char *name, Span span);

/* ---- messages.c: `print`, `assert`, strings ---- */
/* Prints, or reports a condition that does not hold: then false. */
bool run_message(Elaboration *e, const Environment *env, const Syntax *syntax);
/* Adds what a value is, in words; nothing more once the text is longer than `most`. */
void value_text(Elaboration *e, Value value, Text *text, size_t most);
/* Returns a string like those that are written. */
Value           value_string(Elaboration *e, const char *bytes, size_t length);
BuiltinFunction builtin_str;

/* ---- properties.c: blocks with properties, and values of those ---- */
/* Reports properties that a block of this kind may not have; false: there is one. */
bool check_block(Elaboration *e, const Syntax *block);
/* Returns "a camera", for messages. */
const char *block_name(SyntaxKind kind);
/* Returns the value of `name:` in a block of properties, or NULL. */
const Syntax *find_property(const Syntax *block, const char *name);
/* These return a number or a vector that does not depend on the point; `otherwise` when it is not
   given, or is of another type, which is reported. */
Node number_property(Elaboration *e, const Environment *env, const Syntax *block, const char *name,
                     double otherwise);
Node vector_property(Elaboration *e, const Environment *env, const Syntax *block, const char *name,
                     const double otherwise[3]);
/* Returns the same of a position, which must be near enough for devices to compute with. */
Node position_property(Elaboration *e, const Environment *env, const Syntax *block,
                       const char *name, const double otherwise[3]);
/* Returns a number that must be known when the scene is compiled, and lie in a range. */
double constant_property(Elaboration *e, const Environment *env, const Syntax *block,
                         const char *name, double least, double most, double otherwise);
/* Returns one of a few words, behind which is NULL; NULL when it is not given, or none of them. */
const char *word_property(Elaboration *e, const Environment *env, const Syntax *block,
                          const char *name, const char *const *words);

/* ---- params.c ---- */
Value define_param(Elaboration *e, const Environment *env, const Syntax *syntax);

/* ---- statements.c ---- */
/* Returns what an `if` among statements runs, a block or another `if`; or NULL. */
const Syntax *branch_taken(const Syntax *syntax, bool condition);
/* Returns a function, shape or material of the text, with what it sees. */
Value value_function(Elaboration *e, const Environment *env, const Syntax *syntax);
/* Runs the statements of a file. */
void run_file(Elaboration *e, Scope *scope);
/* Returns the shape of a `krs` block. */
Value elaborate_krs(Elaboration *e, const Environment *env, const Syntax *syntax);

/* ---- shown.c ---- */
/* Gathers the components that iterations of a loop have shown; fills Scene.shown with all of them. */
void gather_shown(Elaboration *e);

/* ---- what evaluation asks of the rooms of this folder ---- */

/* builtins/builtins.c */
/* Returns the meaning of a name that no file defines; it is valid until the next call. */
const BuiltinName *builtin_find(Elaboration *e, const char *name);
/* Returns a constant (pi, x, time).  One that has no meaning at this place is reported. */
Value builtin_constant(Elaboration *e, const char *name, Span span);
/* Lists all names that need no definition, for names_check; returns how many, at most `capacity`. */
size_t builtin_names(const char **names, size_t capacity);

/* builtins/methods.c */
Value call_method(Elaboration *e, const Environment *env, const Syntax *syntax);

/* builtins/csg.c */
/* Tells whether it is `union`, `intersection` or `difference`. */
bool joins_shapes(const Builtin *builtin);
/* Evaluates `a | b`, `a & b` and `a - b` of shapes, and `if` on a condition that frames know. */
Value join_shapes(Elaboration *e, const Syntax *syntax, const Shape *a, const Shape *b);
Value choose_shape(Elaboration *e, const Syntax *syntax, Value condition, const Shape *yes,
                   const Shape *no);

/* hulls/beams.c */
/* Finds what a component is the union of, with KrsOptions.beams. */
void find_beams(Elaboration *e, Component *component);

/* data/texture.c */
/* Evaluates `t(u, v)` of the texture of this number. */
Value call_texture(Elaboration *e, const Environment *env, const Syntax *syntax, uint32_t number);

/* view/material.c: the value of a `material` block. */
Value elaborate_material(Elaboration *e, const Environment *env, const Syntax *syntax);

/* view/view.c */
/* Adds a camera, a light or a zone to the scene, or sets its sky or image. */
void elaborate_view(Elaboration *e, const Environment *env, const Syntax *syntax);
/* Adds what the scene leaves out: a camera, a sun, a sky. */
void complete_view(Elaboration *e);

/* view/studio.c */
/* Plans which boxes of components are to be found in each state. */
void plan_boxes(Elaboration *e);
/* Adds lights, a sky and a floor to a scene that has none, if that is wanted. */
void run_studio(Elaboration *e);

/* declared/declare.c */
/* Returns the name of property `index` of shapes (vocabulary.h). */
const char *property_of_shape(size_t index);
/* Returns the shape of a declaration whose parameters `env` binds; `span` is the call. */
Value declare_instance(Elaboration *e, const Function *function, const Environment *env, Span span);

#endif
