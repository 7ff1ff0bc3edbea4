/*
 * builtins.c: the built-in functions and constants.
 */
#include "compiler/geometry/elaborate.h"

#include <math.h>
#include <string.h>

/* ---- vectors ---- */

/* An argument as the node of a number or vector; NODE_NONE: reported. */
static Node numeric_argument(Elaboration *e, const Call *call, uint32_t index)
{
    const Argument *argument = &call->arguments[index];
    Node            node     = value_node(e, argument->value);
    if (node != NODE_NONE && e->graph->items[node].type <= TYPE_VEC4)
        return node;
    type_error(e, argument->syntax, argument->value, "a vector");
    return NODE_NONE;
}

static Value vector_op(Elaboration *e, Call *call, Op op, uint32_t arity)
{
    Node      nodes[2];
    GraphType types[2];
    for (uint32_t i = 0; i < arity; i++) {
        nodes[i] = numeric_argument(e, call, i);
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
    Value way = vector_op(e, call, OP_sub, 2);
    if (way.type == VALUE_ERROR)
        return way;
    return value_of_node(e, graph_op1(e->graph, OP_length, value_node(e, way)));
}

static Value scaled(Elaboration *e, Call *call, double factor)
{
    Value values[] = {call->arguments[0].value, value_number(factor)};
    if (numeric_argument(e, call, 0) == NODE_NONE)
        return value_error();
    return value_map_op(e, OP_mul, values, 2, call->syntax);
}

static Value builtin_radians(Elaboration *e, Call *call) { return scaled(e, call, M_PI / 180); }
static Value builtin_degrees(Elaboration *e, Call *call) { return scaled(e, call, 180 / M_PI); }

/* ---- lists ---- */

static const List *list_argument(Elaboration *e, const Call *call, uint32_t index)
{
    const Argument *argument = &call->arguments[index];
    if (argument->value.type == VALUE_LIST)
        return argument->value.list;
    type_error(e, argument->syntax, argument->value, "a list");
    return NULL;
}

/* Reduces values with a binary operation, in pairs, so that the graph stays shallow. */
static Value reduce(Elaboration *e, Op op, const Value *items, size_t count, const Syntax *place)
{
    if (count == 1)
        return items[0];
    size_t half = count / 2;
    Value  a    = reduce(e, op, items, half, place);
    Value  b    = reduce(e, op, items + half, count - half, place);
    if (a.type == VALUE_ERROR || b.type == VALUE_ERROR)
        return value_error();
    Node nodes[] = {value_node(e, a), value_node(e, b)};
    if (nodes[0] == NODE_NONE || nodes[1] == NODE_NONE) {
        type_error(e, place, nodes[0] == NODE_NONE ? a : b,
                   op == OP_and || op == OP_or ? "truth values" : "numbers or vectors");
        return value_error();
    }
    GraphType types[] = {e->graph->items[nodes[0]].type, e->graph->items[nodes[1]].type};
    if (!graph_op_type(op, types, 2)) {
        diag_add(e->diags, DIAG_TYPE_MISMATCH, place->span, "%s and %s do not go together",
                 value_type_name(e, a), value_type_name(e, b));
        return value_error();
    }
    if (op == OP_and || op == OP_or)
        return value_of_node(e, graph_op(e->graph, op, nodes));
    return value_map_op(e, op, (Value[]){a, b}, 2, place);
}

/* Of the elements of the first argument; `empty` when it has none. */
static Value reduce_list(Elaboration *e, Call *call, Op op, Value empty)
{
    if (call->arguments[0].value.type == VALUE_EXPRESSION) { /* a vector known only as a node */
        Node  vector = call->arguments[0].value.node;
        Value parts[4];
        uint32_t type = e->graph->items[vector].type;
        if (type > TYPE_VEC4) {
            type_error(e, call->arguments[0].syntax, call->arguments[0].value, "a list");
            return value_error();
        }
        for (uint32_t i = 0; i < type; i++)
            parts[i] = value_of_node(e, graph_component(e->graph, vector, i));
        return reduce(e, op, parts, type, call->syntax);
    }
    const List *list = list_argument(e, call, 0);
    if (!list)
        return value_error();
    return list->count ? reduce(e, op, list->items, list->count, call->syntax) : empty;
}

static Value builtin_sum(Elaboration *e, Call *call)
{
    return reduce_list(e, call, OP_add, value_number(0));
}

static Value builtin_product(Elaboration *e, Call *call)
{
    return reduce_list(e, call, OP_mul, value_number(1));
}

static Value builtin_any(Elaboration *e, Call *call)
{
    return reduce_list(e, call, OP_or, value_boolean(false));
}

static Value builtin_all(Elaboration *e, Call *call)
{
    return reduce_list(e, call, OP_and, value_boolean(true));
}

/* Of all arguments, or of the elements of the only one. */
static Value extreme(Elaboration *e, Call *call, Op op)
{
    if (call->rest_count == 0) {
        Diag *diag  = diag_add(e->diags, DIAG_MISSING_ARGUMENT, call->syntax->span,
                               "`%s` needs something to choose from", call->name);
        diag->label = "nothing is given";
        return value_error();
    }
    if (call->rest_count == 1) {
        call->arguments[0] = call->rest[0];
        if (call->rest[0].value.type == VALUE_LIST && call->rest[0].value.list->count == 0) {
            diag_add(e->diags, DIAG_BAD_VALUE, call->rest[0].syntax->span, "the list is empty");
            return value_error();
        }
        return reduce_list(e, call, op, value_error());
    }
    Value *values = arena_new_array(e->arena, Value, call->rest_count);
    for (uint32_t i = 0; i < call->rest_count; i++)
        values[i] = call->rest[i].value;
    return reduce(e, op, values, call->rest_count, call->syntax);
}

static Value builtin_least(Elaboration *e, Call *call) { return extreme(e, call, OP_min); }
static Value builtin_greatest(Elaboration *e, Call *call) { return extreme(e, call, OP_max); }

static Value builtin_len(Elaboration *e, Call *call)
{
    Value value = call->arguments[0].value;
    if (value.type == VALUE_EXPRESSION && e->graph->items[value.node].type <= TYPE_VEC4 &&
        e->graph->items[value.node].type >= TYPE_VEC2)
        return value_number(e->graph->items[value.node].type);
    const List *list = list_argument(e, call, 0);
    return list ? value_number((double)list->count) : value_error();
}

/* A number that is known at compile time; *number stays when it is not given.  False: reported. */
static bool constant_argument(Elaboration *e, const Call *call, uint32_t index, double *number)
{
    const Argument *argument = &call->arguments[index];
    if (!argument->syntax)
        return true;
    if (argument->value.type == VALUE_NUMBER) {
        *number = argument->value.number;
        return true;
    }
    if (argument->value.type == VALUE_EXPRESSION)
        constant_error(e, argument->syntax,
                       diag_text(e->diags, "`%s` needs a number that is known at compile time",
                                 call->name));
    else
        type_error(e, argument->syntax, argument->value, "a number");
    return false;
}

static Value builtin_range(Elaboration *e, Call *call)
{
    double from = 0, to = 0, by = 1;
    if (!constant_argument(e, call, 0, &from) || !constant_argument(e, call, 1, &to) ||
        !constant_argument(e, call, 2, &by))
        return value_error();
    if (!is_given(call, 1)) {
        to   = from;
        from = 0;
    }
    double count = ceil((to - from) / by);
    if (!(by != 0) || !(count <= 1e6)) {
        bool  ends  = by != 0;
        Diag *diag  = diag_add(e->diags, ends ? DIAG_LIMIT : DIAG_BAD_VALUE, call->syntax->span,
                               ends ? "a range of more than a million elements"
                                    : "a range with steps of 0 does not end");
        diag->label = "this range";
        return value_error();
    }
    size_t size  = count > 0 ? (size_t)count : 0;
    Value *items = arena_new_array(e->arena, Value, size + 1);
    for (size_t i = 0; i < size; i++)
        items[i] = value_number(from + (double)i * by);
    return value_list(e, items, size);
}

/* ---- random numbers: the same on every machine ---- */

/* SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014) of
   the bits of the seed; -0 and 0 are one seed. */
static uint64_t hash_number(double seed, uint64_t stream)
{
    uint64_t bits;
    seed += 0.0;
    memcpy(&bits, &seed, sizeof bits);
    bits += (stream + 1) * 0x9E3779B97F4A7C15u;
    bits = (bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9u;
    bits = (bits ^ (bits >> 27)) * 0x94D049BB133111EBu;
    bits ^= bits >> 31;
    bits += 0x9E3779B97F4A7C15u;
    bits = (bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9u;
    bits = (bits ^ (bits >> 27)) * 0x94D049BB133111EBu;
    return bits ^ (bits >> 31);
}

/* In [0, 1). */
static double unit_random(double seed, uint64_t stream)
{
    return (double)(hash_number(seed, stream) >> 11) * 0x1p-53;
}

static Value builtin_random(Elaboration *e, Call *call)
{
    double seed = 0;
    return constant_argument(e, call, 0, &seed) ? value_number(unit_random(seed, 0))
                                                : value_error();
}

/* Marsaglia (1972): a point of the unit disc gives a point of the sphere by products and roots
   only, which every machine computes alike. */
static Value builtin_random_direction(Elaboration *e, Call *call)
{
    double seed = 0, a, b, s;
    if (!constant_argument(e, call, 0, &seed))
        return value_error();
    uint64_t stream = 1;
    do {
        a = 2 * unit_random(seed, stream) - 1;
        b = 2 * unit_random(seed, stream + 1) - 1;
        s = a * a + b * b;
        stream += 2;
    } while (s >= 1);
    double root = 2 * sqrt(1 - s);
    return value_vector(e, (double[]){a * root, 1 - 2 * s, b * root}, 3);
}

/* ---- noise ---- */

/* Of a number, a straight cut through the noise of the plane, off its zeros. */
static Node noise_of(Graph *g, Node place)
{
    if (g->items[place].type == TYPE_FLOAT) {
        Node aside = graph_number(g, 0.37);
        place      = graph_op2(g, OP_vec2, place, aside);
    }
    return graph_op1(g, g->items[place].type == TYPE_VEC2 ? OP_noise2 : OP_noise3, place);
}

/* The argument `p`; NODE_NONE: reported. */
static Node noise_place(Elaboration *e, const Call *call)
{
    Node place = numeric_argument(e, call, 0);
    if (place == NODE_NONE || e->graph->items[place].type <= TYPE_VEC3)
        return place;
    diag_add(e->diags, DIAG_LENGTH_MISMATCH, call->arguments[0].syntax->span,
             "`%s` needs a number or a vector of 2 or 3", call->name);
    return NODE_NONE;
}

static Value builtin_noise(Elaboration *e, Call *call)
{
    Node place = noise_place(e, call);
    if (place == NODE_NONE)
        return value_error();
    e->graph->here = call->syntax->span;
    return value_of_node(e, noise_of(e->graph, place));
}

/* Where an octave begins: all are 0 on their lattices, which must not meet. */
static Node octave_start(Graph *g, GraphType type, uint32_t octave)
{
    static const double steps[3] = {17.137, 9.713, 5.371};
    double              start[4] = {0};
    for (uint32_t i = 0; i < 3; i++)
        start[i] = octave * steps[i];
    return graph_constant(g, type, start);
}

static Value builtin_fbm(Elaboration *e, Call *call)
{
    Graph   *g = e->graph;
    Node     place = noise_place(e, call);
    Node     gain = want_number(e, call, 2, 0.5), lacunarity = want_number(e, call, 3, 2);
    uint32_t octaves;
    if (place == NODE_NONE || gain == NODE_NONE || lacunarity == NODE_NONE ||
        !want_count(e, call, 1, 1, 16, 5, &octaves))
        return value_error();
    if ((is_given(call, 2) && !check_positive(e, gain, call->arguments[2].syntax, "`gain`")) ||
        (is_given(call, 3) &&
         !check_positive(e, lacunarity, call->arguments[3].syntax, "`lacunarity`")))
        return value_error();
    g->here  = call->syntax->span;
    Node sum = NODE_NONE, total = NODE_NONE, loud = graph_number(g, 1), fine = loud;
    for (uint32_t i = 0; i < octaves; i++) {
        Node scaled_place = graph_op2(g, OP_mul, place, fine);
        Node start        = octave_start(g, g->items[place].type, i);
        Node moved        = graph_op2(g, OP_add, scaled_place, start);
        Node octave       = noise_of(g, moved);
        octave            = graph_op2(g, OP_mul, octave, loud);
        sum               = i ? graph_op2(g, OP_add, sum, octave) : octave;
        total             = i ? graph_op2(g, OP_add, total, loud) : loud;
        loud              = graph_op2(g, OP_mul, loud, gain);
        fine              = graph_op2(g, OP_mul, fine, lacunarity);
    }
    return value_of_node(e, graph_op2(g, OP_div, sum, total));
}

/* ---- joining ---- */

/* The kind of a blend by its spelling; without an argument the quadratic one.  False: reported. */
static bool blend_kind(Elaboration *e, const Argument *name, BlendKind *kind)
{
    *kind = BLEND_QUADRATIC;
    if (!name->syntax)
        return true;
    if (name->value.type != VALUE_STRING) {
        type_error(e, name->syntax, name->value, "the kind of a blend, a string");
        return false;
    }
    const char *spellings[BLEND_COUNT];
    for (uint32_t i = 0; i < BLEND_COUNT; i++) {
        spellings[i] = blend_info[i].spelling;
        *kind        = (BlendKind)i;
        if (strcmp(spellings[i], name->value.string) == 0)
            return true;
    }
    Diag *diag = diag_add(e->diags, DIAG_BAD_VALUE, name->syntax->span, "no blend is called \"%s\"",
                          name->value.string);
    const char *near = nearest_name(name->value.string, spellings, BLEND_COUNT);
    diag->label = "unknown kind of blend";
    if (near)
        diag->replacement = diag_text(e->diags, "\"%s\"", near);
    diag->help = "there are \"quadratic\", \"cubic\", \"exponential\", \"circular\", "
                 "\"chamfer\" and \"stairs\"";
    return false;
}

/* The parameters `blend= kind= steps=`, of which `first` is the first.  False: reported. */
static bool blend_arguments(Elaboration *e, const Call *call, uint32_t first, Blend *blend)
{
    uint32_t steps;
    *blend = blend_sharp;
    if (!blend_kind(e, &call->arguments[first + 1], &blend->kind) ||
        !want_count(e, call, first + 2, 1, 64, 4, &steps))
        return false;
    blend->steps = graph_number(e->graph, steps);
    if (!is_given(call, first))
        return true;
    Node width = want_number(e, call, first, 0);
    if (width == NODE_NONE)
        return false;
    Range range = node_range(e, width, 0);
    if (range.low < 0) {
        Diag *diag  = diag_add(e->diags, DIAG_BAD_VALUE, call->arguments[first].syntax->span,
                               "the width of a blend cannot be negative");
        diag->label = diag_text(e->diags, "this can be %g", range.low);
        return false;
    }
    if (range.high != 0)
        blend->width = width;
    return true;
}

bool collect_shapes(Elaboration *e, const Call *call, Value value, const Syntax *place,
                    Values *shapes)
{
    if (value.type == VALUE_LIST) {
        for (size_t i = 0; i < value.list->count; i++)
            if (!collect_shapes(e, call, value.list->items[i], place, shapes))
                return false;
        return true;
    }
    if (value.type != VALUE_SHAPE) {
        type_error(e, place, value, "shapes");
        return false;
    }
    array_push(e->arena, shapes, value);
    return true;
}

const Shape **joinable_shapes(Elaboration *e, const Call *call, const Values *values)
{
    const Shape **shapes = arena_new_array(e->arena, const Shape *, values->count + 1);
    for (size_t i = 0; i < values->count; i++) {
        shapes[i] = values->items[i].shape;
        if (shapes[i]->figure != shapes[0]->figure) {
            Diag *diag = diag_add(e->diags, DIAG_TYPE_MISMATCH, call->syntax->span,
                                  "plane figures and solids cannot be joined");
            diag->help = "make figures solid with `.extrude(height)` or `.revolve()`";
            return NULL;
        }
    }
    return shapes;
}

static Value join(Elaboration *e, const Call *call, ShapeKind kind, const Values *values,
                  uint32_t first_option)
{
    Blend blend;
    if (!blend_arguments(e, call, first_option, &blend))
        return value_error();
    if (values->count == 0 && kind != SHAPE_UNION) {
        diag_add(e->diags, DIAG_MISSING_ARGUMENT, call->syntax->span,
                 "`%s` needs at least one shape", call->name);
        return value_error();
    }
    const Shape **shapes = joinable_shapes(e, call, values);
    if (!shapes)
        return value_error();
    uint32_t count = (uint32_t)values->count;
    return value_shape(make_joint(e, kind, shapes, count, blend, call->syntax->span));
}

static Value join_rest(Elaboration *e, Call *call, ShapeKind kind)
{
    Values shapes = {0};
    if (is_given(call, 0) &&
        !collect_shapes(e, call, call->arguments[0].value, call->arguments[0].syntax, &shapes))
        return value_error();
    for (uint32_t i = 0; i < call->rest_count; i++)
        if (!collect_shapes(e, call, call->rest[i].value, call->rest[i].syntax, &shapes))
            return value_error();
    return join(e, call, kind, &shapes, 1);
}

static Value builtin_union(Elaboration *e, Call *call)
{
    return join_rest(e, call, SHAPE_UNION);
}

static Value builtin_intersection(Elaboration *e, Call *call)
{
    return join_rest(e, call, SHAPE_INTERSECTION);
}

static Value builtin_difference(Elaboration *e, Call *call)
{
    return join_rest(e, call, SHAPE_DIFFERENCE);
}

static Value builtin_xor(Elaboration *e, Call *call)
{
    const Shape *a = want_shape(e, call, 0), *b = want_shape(e, call, 1);
    if (!a || !b)
        return value_error();
    Value  pair[] = {call->arguments[0].value, call->arguments[1].value};
    Values values = {pair, 2, 2};
    return join(e, call, SHAPE_XOR, &values, 2);
}

static Value builtin_morph(Elaboration *e, Call *call)
{
    const Shape *a = want_shape(e, call, 0), *b = want_shape(e, call, 1);
    Node         t = want_number(e, call, 2, 0);
    if (!a || !b || t == NODE_NONE)
        return value_error();
    Range range = node_range(e, t, 0);
    if (range.low < 0 || range.high > 1) {
        Diag *diag  = diag_add(e->diags, DIAG_BAD_VALUE, call->arguments[2].syntax->span,
                               "`t` of `morph` must stay in [0, 1]");
        diag->label = diag_text(e->diags, "this goes from %g to %g", range.low, range.high);
        return value_error();
    }
    return value_shape(make_morph(e, a, b, t, call->syntax->span));
}

/* ---- maps ---- */

static Value builtin_translate(Elaboration *e, Call *call)
{
    return value_map(want_translation(e, call));
}

static Value builtin_rotate(Elaboration *e, Call *call)
{
    return value_map(want_rotation(e, call));
}

static Value builtin_scale(Elaboration *e, Call *call)
{
    return value_map(want_scaling(e, call));
}

static Value builtin_reflect(Elaboration *e, Call *call)
{
    Node normal, offset;
    if (!want_plane(e, call, &normal, &offset))
        return value_error();
    return value_map(map_reflection(e, normal, offset));
}

static Value builtin_invert(Elaboration *e, Call *call)
{
    static const double ORIGIN[3] = {0, 0, 0};
    Node center = want_vector(e, call, 0, ORIGIN), radius = want_number(e, call, 1, 1);
    if (center == NODE_NONE || radius == NODE_NONE)
        return value_error();
    if (is_given(call, 1) && !check_positive(e, radius, call->arguments[1].syntax,
                                             "the radius of an inversion"))
        return value_error();
    return value_map(map_inversion(e, center, radius));
}

/* A real number, or a list of four; false: reported. */
static bool quaternion_argument(Elaboration *e, const Call *call, uint32_t index, double entry[4])
{
    const Argument *argument = &call->arguments[index];
    entry[0] = entry[1] = entry[2] = entry[3] = 0;
    if (value_size(e, argument->value) == 1)
        return constant_argument(e, call, index, entry);
    if (argument->value.type == VALUE_LIST && value_size(e, argument->value) == 4) {
        Call one = *call;
        for (size_t i = 0; i < 4; i++) {
            one.arguments[index].value = argument->value.list->items[i];
            if (!constant_argument(e, &one, index, &entry[i]))
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
    const Map *map = map_of_matrix(e, (const double (*)[4])entries, &reason);
    if (map)
        return value_map(map);
    Diag *diag  = diag_add(e->diags, DIAG_NOT_A_MAP, call->syntax->span,
                           "this matrix does not map space to space");
    diag->label = reason;
    diag->help  = "products of `translate`, `rotate`, `scale`, `reflect` and `invert` are all the "
                  "maps there are";
    return value_error();
}

/* Left minus right of `left == right`; a surface needs no more. */
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
    return value_shape(make_field(e, formula, true, call->syntax));
}

static Value builtin_field(Elaboration *e, Call *call)
{
    const Argument *argument = &call->arguments[0];
    if (value_size(e, argument->value) != 1) {
        type_error(e, argument->syntax, argument->value, "a number at every point");
        return value_error();
    }
    Node formula = value_node(e, argument->value);
    return value_shape(make_field(e, formula, false, call->syntax));
}

static Value builtin_not_supported(Elaboration *e, Call *call)
{
    not_supported(e, call->syntax->span, diag_text(e->diags, "`%s`", call->name));
    return value_error();
}

/* ---- tables ---- */

static const Builtin builtins[] = {
#define NUMERIC(name, parameters, op, meaning) {#name, parameters, OP_##op, NULL},
#define SPECIAL(name, parameters, function, meaning)                                               \
    {#name, parameters, OP_COUNT, builtin_##function},
#include "compiler/geometry/functions.def"
#undef NUMERIC
#undef SPECIAL
};
enum { BUILTIN_COUNT = sizeof builtins / sizeof *builtins };

const Builtin *builtin_find(const char *name)
{
    for (size_t i = 0; i < BUILTIN_COUNT; i++)
        if (strcmp(builtins[i].name, name) == 0)
            return &builtins[i];
    return NULL;
}

static const char *const constants[] = {
    "pi", "tau", "x", "y", "z", "p", "time", "level", "instance", "u", "v", "normal", "identity",
    "orbit_trap", "orbit_step", "rounding"};
enum { CONSTANT_COUNT = sizeof constants / sizeof *constants };

size_t builtin_names(const char **names, size_t capacity)
{
    size_t count = 0;
    for (size_t i = 0; i < BUILTIN_COUNT && count < capacity; i++)
        names[count++] = builtins[i].name;
    for (size_t i = 0; i < CONSTANT_COUNT && count < capacity; i++)
        names[count++] = constants[i];
    return count;
}

/* level, instance, u, v, normal, orbit_trap and orbit_step: in materials only. */
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

/* The radius of .round(r), in `core:` of a shape declaration only. */
static Value rounding_name(Elaboration *e, Span span)
{
    if (e->rounding != NODE_NONE)
        return value_of_node(e, e->rounding);
    Diag *diag =
        diag_add(e->diags, DIAG_OUT_OF_PLACE, span, "`rounding` has a meaning in `core:` only");
    diag->label = "not in the core of a shape declaration";
    return value_error();
}

static Value coordinate(Elaboration *e, uint32_t axis)
{
    Node point = graph_leaf(e->graph, OP_POINT);
    return value_of_node(e, graph_component(e->graph, point, axis));
}

bool builtin_constant(Elaboration *e, const char *name, Span span, Value *value)
{
    Graph *g = e->graph;
    if (strcmp(name, "pi") == 0)
        *value = value_number(M_PI);
    else if (strcmp(name, "tau") == 0)
        *value = value_number(2 * M_PI);
    else if (strlen(name) == 1 && name[0] >= 'x' && name[0] <= 'z')
        *value = coordinate(e, (uint32_t)(name[0] - 'x'));
    else if (strcmp(name, "p") == 0)
        *value = value_of_node(e, graph_leaf(g, OP_POINT));
    else if (strcmp(name, "time") == 0)
        *value = value_of_node(e, graph_parameter(g, 0, TYPE_FLOAT));
    else if (strcmp(name, "level") == 0 || strcmp(name, "instance") == 0 ||
             strcmp(name, "u") == 0 || strcmp(name, "v") == 0 || strcmp(name, "normal") == 0 ||
             strcmp(name, "orbit_trap") == 0 || strcmp(name, "orbit_step") == 0)
        *value = material_name(e, name, span);
    else if (strcmp(name, "rounding") == 0)
        *value = rounding_name(e, span);
    else if (strcmp(name, "identity") == 0)
        *value = value_map(map_identity(e));
    else
        return false;
    return true;
}
