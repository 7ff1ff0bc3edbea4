/*
 * graph.h: the typed, hash-consed graph of expressions.
 *
 * Everything that is computed per frame or per point is a node here: coordinates, parameters,
 * arithmetic.  Nodes are indices and operands come first: storage order is evaluation order, a
 * pass is one loop, and an analysis is an array beside the graph.  Equal nodes are one node.
 * The graph knows nothing of scenes.
 */
#ifndef KRS_GRAPH_H
#define KRS_GRAPH_H

#include "compiler/base/near_slots.h"
#include "compiler/base/source.h"
#include "compiler/base/text.h"

typedef uint32_t Node;
#define NODE_NONE UINT32_MAX

/* UINT is an instance number: 32 bits, arithmetic wraps. */
typedef enum GraphType {
    TYPE_FLOAT = 1, /* the value of FLOAT and VECn is their number of components */
    TYPE_VEC2  = 2,
    TYPE_VEC3  = 3,
    TYPE_VEC4  = 4,
    TYPE_BOOL,
    TYPE_UINT
} GraphType;

/* Returns how many numbers a value of a type has. */
static inline uint32_t components(GraphType type) { return type <= TYPE_VEC4 ? (uint32_t)type : 1; }

/* The time at which a node's value is known; a node is as late as its latest operand. */
typedef enum BindingTime { TIME_COMPILE, TIME_FRAME, TIME_POINT } BindingTime;

typedef enum Op {
#define LEAF(name, text, type, low, high, value, meaning)   OP_##name,
#define INDEXED(name, text)                                 OP_##name,
#define MAP(name, ...)                                      OP_##name,
#define OP(name, signature, glsl, evaluate, facts, meaning) OP_##name,
#include "compiler/graph/ops.def"
    OP_COUNT
} Op;

enum { MAX_OPERANDS = 4 };

/* The traits of an operation, as bits: ops.def. */
typedef enum OpTraits {
    NO_TRAITS     = 0,
    STAYS_FINITE  = 1,
    COMMUTES      = 2,
    BUILDS        = 4,
    READS_TABLES  = 8,
    FIRST_SETTING = 16, /* and three more: operand k is a setting, FIRST_SETTING << k */
    OF_HOST       = 256,
    COMPONENTWISE = 512,
    STEADY        = 1024
} OpTraits;

/* All operands from this one on are settings. */
#define SETTINGS_FROM(operand) (((1 << MAX_OPERANDS) - (1 << (operand))) * FIRST_SETTING)

typedef struct NodeValue {
    double v[4]; /* booleans 0 or 1; UINT exact */
} NodeValue;

/* op_values.c: the value of one operation for operand values of these types; never -0. */
NodeValue op_evaluate(Op op, GraphType type, uint32_t index, const GraphType *types,
                      const NodeValue *operands);

typedef struct Expr {
    uint8_t  op, type, time;
    uint8_t  operand_count;
    uint32_t index; /* OP_COMPONENT, OP_PARAMETER, OP_PARAMETERISED, leaves of instance groups */
    union {
        Node   operands[MAX_OPERANDS];
        double number[4]; /* OP_CONSTANT, OP_PARAMETERISED */
    };
    Span span; /* where the author wrote it, for blame */
} Expr;

/* The range a parameter may have, for slopes that must hold over all of it. */
typedef struct GraphParameter {
    double low[4], high[4];
} GraphParameter;

/* Ranges of nodes that depend neither on the point nor on parameters, as far as somebody has asked
   (frame_ranges.c). */
typedef struct FrameRanges {
    struct Range **items;       /* by node, of each component; NULL: not found yet */
    size_t         count, used; /* behind `used` none is found */
} FrameRanges;

typedef struct Graph {
    Arena       *arena;
    FrameRanges *frame_ranges;
    Expr        *items;
    size_t       count, capacity;
    Expr        *older; /* the array before `items` */
    NearSlots    slots; /* nodes by their expressions */
    struct {
        GraphParameter *items;
        size_t          count, capacity;
    } parameters;                /* [0] is time */
    struct Instances *instances; /* instance_table.h; NULL: there are none */
    struct Textures  *textures;  /* texture.h; likewise */
    Span              here;      /* span given to nodes made now */
    struct {
        Node  *items;
        size_t count, capacity;
    } respanned; /* nodes that got a span since the first mark that is not released */
    uint32_t marks;
} Graph;

/* Returns an empty graph whose parameter 0 is `time`, in (-inf, inf). */
Graph *graph_new(Arena *arena);

/* intern.c: the node of an expression, new if there is none; its operands and time are right. */
Node node_intern(Graph *graph, Expr e);
/* Frees what the graph keeps for those who refer to an Expr by its address: nobody does. */
void graph_drop_older(Graph *graph);

/*
 * The nodes made since a mark can be dropped again: the graph is then as it was.  Marks are released or kept
 * in the reverse order.
 */
typedef struct GraphMark {
    size_t count, slot_count, respanned;
} GraphMark;
GraphMark graph_mark(Graph *graph);
void      graph_release(Graph *graph, GraphMark mark);
void      graph_keep(Graph *graph); /* drops the last mark, not the nodes */
/* Releases all nodes but what these need; they are renumbered in place. */
void graph_release_but(Graph *graph, GraphMark mark, Node *kept, size_t count, Arena *scratch);

/* Leaves. */
Node graph_constant(Graph *graph, GraphType type, const double *numbers);
Node graph_number(Graph *graph, double number);
Node graph_vec3(Graph *graph, double x, double y, double z);
Node graph_bool(Graph *graph, bool value);
Node graph_uint(Graph *graph, uint32_t value);
Node graph_parameter(Graph *graph, uint32_t slot, GraphType type);
/* Returns a number of the frame that is known now, and told apart from others by its index alone. */
Node graph_parameterised(Graph *graph, GraphType type, const double *numbers, uint32_t index);
/* Copies a leaf of another graph. */
Node graph_copy_leaf(Graph *graph, const Expr *leaf);
Node graph_leaf(Graph *graph, Op op); /* one whose type is the same everywhere */
/* These return a leaf of point time that is told apart from others by its index: of the type of its
   row, and of any. */
Node graph_leaf_of(Graph *graph, Op op, uint32_t index);
Node graph_indexed_leaf(Graph *graph, Op op, GraphType type, uint32_t index);

/* These return an operation on as many operands as its row says (asserted, with their types).
   Operands that are all constant are folded by op_evaluate, unless the result is not finite: then
   the node stays, for whoever wants to report it.  What reads tables is never folded.  Where one
   operand of a componentwise row is a FLOAT and another a vector, the FLOAT is spread
   (OP_splat2..4). */
Node graph_op(Graph *graph, Op op, const Node *operands);
Node graph_op1(Graph *graph, Op op, Node a);
Node graph_op2(Graph *graph, Op op, Node a, Node b);
Node graph_op3(Graph *graph, Op op, Node a, Node b, Node c);
Node graph_op4(Graph *graph, Op op, Node a, Node b, Node c, Node d);
/* Returns the operation of an expression, which may be of another graph, on other operands. */
Node graph_like(Graph *graph, const Expr *e, const Node *operands);
/* Returns component `index` (0..3) of a vector; component 0 of a FLOAT is itself. */
Node graph_component(Graph *graph, Node vector, uint32_t index);
/* Returns base ^ exponent: by multiplication where the exponent is a small constant integer, by
   square roots where it is 1/2 or -1/2, else OP_pow. */
Node graph_power(Graph *graph, Node base, Node exponent);

/* Returns the type that an operation on these operands has, or 0 when it is not defined for them. */
GraphType graph_op_type(Op op, const GraphType *operands, uint32_t count);

const char *graph_op_name(Op op);
/* Tells whether its value, `number`, is known now: OP_CONSTANT or OP_PARAMETERISED. */
bool graph_is_constant(const Graph *graph, Node node);
/* Tells whether a component is such a number, which may be one of those that a vector is built of. */
bool graph_known_component(const Graph *graph, Node node, uint32_t component, double *number);
/* Finds the first `count` components; false: some are not known. */
bool graph_known_components(const Graph *graph, Node node, uint32_t count, double *numbers);
/* Tells whether all are known, and finite. */
bool graph_known_finite(const Graph *graph, Node node);

/* Returns the row's GLSL, operands $a..$d; NULL for leaves and OP_COMPONENT. */
const char *op_glsl(Op op);
bool        op_has_traits(Op op, OpTraits traits);
/* Tells whether the operand says how it works, not where: an exponent or a count. */
bool op_has_setting(Op op, int operand);
/* Returns the cost of an operation, in multiply-adds of one component, as measured on lavapipe. */
double op_cost(Op op, GraphType type, const GraphType *operands);

/* A copy of `root` (and all it needs) in the same graph, with leaves replaced: OP_POINT by
   `point`, OP_INSTANCE by `instance` and so on; NODE_NONE keeps a leaf. */
typedef struct Substitution {
    Node point, instance, level, uv, normal, trap, front;
} Substitution;
/* Makes a substitution of the point alone. */
Substitution substitute_point(Node point);
Node         graph_substitute(Graph *graph, Node root, Substitution with, Arena *scratch);
/* Returns a copy with one leaf replaced by a node of its type. */
Node graph_replace_leaf(Graph *graph, Node root, Node leaf, Node by, Arena *scratch);

/* Returns a copy of all that `roots` need, in a graph of its own with the same parameters; the
   roots are renumbered in place.  The work grows with what they need, not with the graph. */
Graph *graph_extract(const Graph *graph, Node *roots, size_t root_count, Arena *arena);
/* Returns the same with all functions of instance groups, so that it can be evaluated. */
Graph *graph_extract_with_instances(const Graph *graph, Node *roots, size_t root_count,
                                    Arena *arena);

/* Returns the same of roots that do not depend on the point, with its x in the place of a leaf; the
   copies of the roots go to `copies`. */
Graph *graph_extract_along(const Graph *graph, const Node *roots, size_t root_count, Node leaf,
                           Node *copies, Arena *arena);

/* Asserts what every pass must keep: operands first, types right, arity right, times right. */
void graph_validate(const Graph *graph, const char *pass);

/* Prints one needed node a line, "%12 vec3 point = sub %3 %11 ; file:line:column", then functions
   of instance groups with their bodies, then the roots, each as "root %12"; `sources` may be NULL. */
void graph_print(const Graph *graph, const Sources *sources, const Node *roots, size_t root_count,
                 Text *out);

#endif
