/*
 * builtins.c: the table of built-in functions and constants; those of vectors and maps, and fields.
 *
 * Those of lists, random numbers and CSG have files of their own.
 */
#include "compiler/eval/builtins/builtins.h"

#include <math.h>
#include <string.h>

#include "compiler/eval/data/from_files.h"
#include "compiler/eval/hulls/hull.h"

/* ---- vectors ---- */

static Value vector_op(Elaboration *e, Call *call, Op op, uint32_t arity)
{
    Node      nodes[2];
    GraphType types[2];
    Value     result;
    if (fold_vectors(e, op, (Value[]){call->arguments[0].value, call->arguments[1].value}, arity,
                     &result))
        return result;
    for (uint32_t i = 0; i < arity; i++) {
        nodes[i] = want_numeric(e, call, i);
        if (nodes[i] == NODE_NONE)
            return value_error();
        types[i] = e->graph->items[nodes[i]].type;
    }
    if (!graph_op_type(op, types, arity)) {
        const char *wanted = op == OP_cross ? "two vectors of 3" : "two vectors of one length";
        diag_add(e->diags, DIAG_LENGTH_MISMATCH, call->syntax->span, "`%s` needs %s", call->name,
                 arity == 1 ? "a vector" : wanted);
        return value_error();
    }
    e->graph->here = call->syntax->span;
    return value_of_node(e, graph_op(e->graph, op, nodes));
}

static Value builtin_length(Elaboration *e, Call *call) { return vector_op(e, call, OP_length, 1); }
static Value builtin_dot(Elaboration *e, Call *call) { return vector_op(e, call, OP_dot, 2); }
static Value builtin_cross(Elaboration *e, Call *call) { return vector_op(e, call, OP_cross, 2); }

static Value builtin_normalize(Elaboration *e, Call *call)
{
    return vector_op(e, call, OP_normalize, 1);
}

static Value builtin_distance(Elaboration *e, Call *call)
{
    Value offset = vector_op(e, call, OP_sub, 2);
    if (offset.type == VALUE_ERROR)
        return offset;
    Value result;
    if (value_size(e, offset) == 1) {
        diag_add(e->diags, DIAG_LENGTH_MISMATCH, call->syntax->span, "`%s` needs two vectors",
                 call->name)
            ->help = "numbers are `abs(a - b)` apart";
        return value_error();
    }
    if (fold_vectors(e, OP_length, &offset, 1, &result))
        return result;
    return value_of_node(e, graph_op1(e->graph, OP_length, value_node(e, offset)));
}

static Value scaled(Elaboration *e, Call *call, double factor)
{
    Value values[] = {call->arguments[0].value, value_number(factor)};
    if (want_numeric(e, call, 0) == NODE_NONE)
        return value_error();
    return value_map_op(e, OP_mul, values, 2, call->syntax);
}

static Value builtin_radians(Elaboration *e, Call *call) { return scaled(e, call, M_PI / 180); }
static Value builtin_degrees(Elaboration *e, Call *call) { return scaled(e, call, 180 / M_PI); }

/* ---- maps ---- */

static Value builtin_translate(Elaboration *e, Call *call)
{
    return value_map(want_translation(e, call));
}

static Value builtin_rotate(Elaboration *e, Call *call)
{
    return value_map(want_rotation(e, call));
}

static Value builtin_scale(Elaboration *e, Call *call) { return value_map(want_scaling(e, call)); }

static Value builtin_reflect(Elaboration *e, Call *call)
{
    Node normal, offset;
    if (!want_plane(e, call, &normal, &offset))
        return value_error();
    return value_map(map_reflection(e->builder, normal, offset));
}

static Value builtin_invert(Elaboration *e, Call *call)
{
    Node center = want_vector(e, call, 0, ORIGIN), radius = want_number(e, call, 1, 1);
    if (center == NODE_NONE || radius == NODE_NONE)
        return value_error();
    if (is_given(call, 1) &&
        !check_positive(e, radius, call->arguments[1].syntax, "the radius of an inversion"))
        return value_error();
    return value_map(map_inversion(e->builder, center, radius));
}

/* Finds a real number, or a list of four; false: reported. */
static bool quaternion_argument(Elaboration *e, const Call *call, uint32_t index, double entry[4])
{
    const Argument *argument = &call->arguments[index];
    entry[0] = entry[1] = entry[2] = entry[3] = 0;
    if (value_size(e, argument->value) == 1)
        return want_constant(e, call, index, entry);
    if (argument->value.type == VALUE_LIST && value_size(e, argument->value) == 4) {
        Call one = *call;
        for (size_t i = 0; i < 4; i++) {
            one.arguments[index].value = argument->value.list->items[i];
            if (!want_constant(e, &one, index, &entry[i]))
                return false;
        }
        return true;
    }
    if (argument->value.type == VALUE_EXPRESSION)
        constant_error(e, argument->syntax,
                       "the entries of a matrix must be known at compile time");
    else
        type_error(e, argument->syntax, argument->value, "a quaternion, [re, i, j, k]");
    return false;
}

static Value builtin_matrix(Elaboration *e, Call *call)
{
    double      entries[4][4];
    const char *reason;
    for (uint32_t i = 0; i < 4; i++)
        if (!quaternion_argument(e, call, i, entries[i]))
            return value_error();
    const Map *map = map_of_matrix(e->builder, (const double(*)[4])entries, &reason);
    if (map)
        return value_map(map);
    Diag *diag  = diag_add(e->diags, DIAG_NOT_A_MAP, call->syntax->span,
                           "this matrix does not map space to space");
    diag->label = reason;
    diag->help  = "products of `translate`, `rotate`, `scale`, `reflect` and `invert` are all the "
                  "maps there are";
    return value_error();
}

/* Returns the left minus the right of `left == right`; a surface needs no more. */
static Value builtin_algebraic(Elaboration *e, Call *call)
{
    const Argument *equation = &call->arguments[0];
    Value           value    = equation->value;
    const Expr     *expr     = value.type == VALUE_EXPRESSION ? &e->graph->items[value.node] : NULL;
    if (!expr || expr->op != OP_equal) {
        if (value.type == VALUE_ERROR)
            return value;
        Diag *diag  = diag_add(e->diags, DIAG_TYPE_MISMATCH, equation->syntax->span,
                               "`algebraic` needs an equation of x, y and z");
        diag->label = "no `==` of expressions of the point";
        diag->help  = "write `algebraic(x^2 + y^2 + z^2 == 1)`";
        return value_error();
    }
    Node left = expr->operands[0], right = expr->operands[1];
    Node formula = graph_op2(e->graph, OP_sub, left, right);
    return value_shape(make_field(e->builder, formula, true, call->syntax->span));
}

static Value builtin_field(Elaboration *e, Call *call)
{
    const Argument *argument = &call->arguments[0];
    if (value_size(e, argument->value) != 1) {
        type_error(e, argument->syntax, argument->value, "a number at every point");
        return value_error();
    }
    Node formula = value_node(e, argument->value);
    return value_shape(make_field(e->builder, formula, false, call->syntax->span));
}

/* ---- tables ---- */

/* Operations of the graph without parameters are not called by scenes. */
static const Builtin builtins[] = {
#define MAP(name, arity, called, ...) {#name, called, OP_##name, NULL},
#include "compiler/graph/ops.def"
#define FUNCTION(name, parameters, function, meaning) \
    {#name, parameters, OP_COUNT, builtin_##function},
#include "compiler/eval/builtins/functions.def"
};
enum { BUILTIN_COUNT = sizeof builtins / sizeof *builtins };

static const Builtin *find_row(const char *name)
{
    for (size_t i = 0; i < BUILTIN_COUNT; i++)
        if (builtins[i].parameters && strcmp(builtins[i].name, name) == 0)
            return &builtins[i];
    return NULL;
}

static const char *const constants[] = {
#define CONSTANT(name, meaning) #name,
#include "compiler/eval/builtins/constants.def"
};
enum { CONSTANT_COUNT = sizeof constants / sizeof *constants };

/* Names are compared by their addresses, which are looked up here before tables are searched. */
const BuiltinName *builtin_find(Elaboration *e, const char *name)
{
    uintptr_t    address = (uintptr_t)name;
    BuiltinName *known   = &e->builtins[(address >> 3 ^ address >> 11) % MAX_BUILTIN_NAMES];
    if (known->name == name)
        return known;
    *known = (BuiltinName){.name = name};
    for (size_t i = 0; i < CONSTANT_COUNT; i++)
        known->constant = known->constant || strcmp(constants[i], name) == 0;
    const Builtin *row = find_row(name);
    if (row) {
        Function *function = arena_new(e->arena, Function);
        *function          = (Function){.name = row->name, .builtin = row};
        known->function    = function;
    }
    return known;
}

size_t builtin_names(const char **names, size_t capacity)
{
    size_t count = 0;
    for (size_t i = 0; i < BUILTIN_COUNT && count < capacity; i++)
        if (builtins[i].parameters)
            names[count++] = builtins[i].name;
    for (size_t i = 0; i < CONSTANT_COUNT && count < capacity; i++)
        names[count++] = constants[i];
    return count;
}

/* Evaluates level, instance, u, v, normal, front, orbit_trap and orbit_step, which are in materials
   only. */
static Value material_name(Elaboration *e, const char *name, Span span)
{
    if (!e->in_material) {
        Diag *diag  = diag_add(e->diags, DIAG_OUT_OF_PLACE, span,
                               "`%s` has a meaning in materials only", name);
        diag->label = "not in a material";
        return value_error();
    }
    if (strcmp(name, "level") == 0)
        return value_of_node(e, graph_leaf(e->graph, OP_LEVEL));
    if (strcmp(name, "normal") == 0)
        return value_of_node(e, graph_leaf(e->graph, OP_NORMAL));
    if (strcmp(name, "front") == 0) {
        Node half = graph_number(e->graph, 0.5);
        return value_of_node(e, graph_op2(e->graph, OP_less, half, graph_leaf(e->graph, OP_FRONT)));
    }
    if (strlen(name) == 1) {
        Node uv = graph_leaf(e->graph, OP_UV);
        return value_of_node(e, graph_component(e->graph, uv, name[0] == 'v'));
    }
    if (strncmp(name, "orbit", 5) == 0) {
        Node trap = graph_leaf(e->graph, OP_TRAP);
        return value_of_node(e, graph_component(e->graph, trap, strcmp(name, "orbit_step") == 0));
    }
    Node instance = graph_leaf(e->graph, OP_INSTANCE);
    return value_of_node(e, graph_op1(e->graph, OP_id_unit, instance));
}

/* Returns the radius of .round(r), in `core:` of a shape declaration only. */
static Value rounding_name(Elaboration *e, Span span)
{
    if (e->rounding != NODE_NONE)
        return value_of_node(e, e->rounding);
    Diag *diag  = diag_add(e->diags, DIAG_OUT_OF_PLACE, span,
                           "`rounding` has a meaning in `core:` only");
    diag->label = "not in the core of a shape declaration";
    return value_error();
}

static Value coordinate(Elaboration *e, uint32_t axis)
{
    Node point = graph_leaf(e->graph, OP_POINT);
    return value_of_node(e, graph_component(e->graph, point, axis));
}

Value builtin_constant(Elaboration *e, const char *name, Span span)
{
    Graph *g = e->graph;
    if (strcmp(name, "pi") == 0)
        return value_number(M_PI);
    if (strcmp(name, "tau") == 0)
        return value_number(2 * M_PI);
    if (strlen(name) == 1 && name[0] >= 'x' && name[0] <= 'z')
        return coordinate(e, (uint32_t)(name[0] - 'x'));
    if (strcmp(name, "p") == 0)
        return value_of_node(e, graph_leaf(g, OP_POINT));
    if (strcmp(name, "time") == 0)
        return value_of_node(e, graph_parameter(g, 0, TYPE_FLOAT));
    if (strcmp(name, "rounding") == 0)
        return rounding_name(e, span);
    if (strcmp(name, "identity") == 0)
        return value_map(map_identity(e->builder));
    return material_name(e, name, span);
}
