/*
 * random.c: random numbers, known at compile time, and noise, which is a value at each point.
 */
#include "compiler/eval/builtins/builtins.h"

#include <math.h>
#include <string.h>

/* ---- seeds that are cells ---- */

/*
 * Seeds that are vectors, or not known when the scene is compiled, are cells of a lattice: their
 * nearest whole numbers count, from -2^23 to 2^23.  Such numbers are hashed by integers alone, so
 * that devices find the same.
 */
static bool is_cell(const Elaboration *e, Value seed)
{
    return value_size(e, seed) > 0 && seed.type != VALUE_NUMBER;
}

static Node id_of_cell(Graph *g, Node cell, uint32_t stream)
{
    const double MIDDLE = 8388608, LAST = 16777215;
    Node         id = graph_uint(g, stream);
    for (uint32_t i = 0; i < g->items[cell].type; i++) {
        Node whole   = graph_op1(g, OP_round, graph_component(g, cell, i));
        Node shifted = graph_op2(g, OP_add, whole, graph_number(g, MIDDLE));
        Node last = graph_number(g, LAST), first = graph_number(g, 0);
        Node limited = graph_op3(g, OP_clamp, shifted, first, last);
        Node number  = graph_op1(g, OP_to_uint, limited);
        id           = graph_op2(g, OP_join_id, id, number);
    }
    return id;
}

static Node random_of_cell(Elaboration *e, const Call *call, uint32_t stream)
{
    e->graph->here = call->syntax->span;
    Node cell      = value_node(e, call->arguments[0].value);
    return graph_op1(e->graph, OP_id_unit, id_of_cell(e->graph, cell, stream));
}

/* Chooses a direction whose height and angle are uniform (Archimedes: the sphere has the area of
   the cylinder). */
static Value direction_of_cell(Elaboration *e, const Call *call, uint32_t stream)
{
    Graph *g     = e->graph;
    Node   up    = random_of_cell(e, call, 2 * stream);
    Node   round = random_of_cell(e, call, 2 * stream + 1);
    Node   one = graph_number(g, 1), two = graph_number(g, 2);
    Node   angle  = graph_op2(g, OP_mul, round, graph_number(g, 2 * M_PI));
    Node   height = graph_op2(g, OP_sub, one, graph_op2(g, OP_mul, two, up));
    Node   square = graph_op2(g, OP_sub, one, graph_op2(g, OP_mul, height, height));
    Node   across = graph_op1(g, OP_sqrt, graph_op2(g, OP_max, square, graph_number(g, 0)));
    Node   x      = graph_op2(g, OP_mul, across, graph_op1(g, OP_cos, angle));
    Node   z      = graph_op2(g, OP_mul, across, graph_op1(g, OP_sin, angle));
    return value_of_node(e, graph_op3(g, OP_vec3, x, height, z));
}

/* ---- seeds that are numbers ---- */

/* Tells whether a seed depends on the iteration of a loop whose iterations are evaluated at once
   (iterations.c). */
static bool is_of_iteration(const Elaboration *e, Value seed)
{
    return e->iterated && seed.type == VALUE_EXPRESSION &&
           e->graph->items[seed.node].type == TYPE_FLOAT &&
           e->graph->items[seed.node].time == TIME_FRAME;
}

static Value seeded_of_iteration(Elaboration *e, const Call *call, Op op, uint32_t numbers,
                                 uint32_t stream)
{
    const uint32_t first = e->parameterises ? e->number_count + 1 : 0;
    e->number_count += e->parameterises ? numbers : 0;
    e->graph->here        = call->syntax->span;
    const Node operands[] = {call->arguments[0].value.node, graph_uint(e->graph, stream),
                             graph_uint(e->graph, first)};
    return value_of_node(e, graph_op(e->graph, op, operands));
}

/* Makes a random number of a number's seed; false: reported. */
static bool seeded_of_number(Elaboration *e, const Call *call, Op op, GraphType type,
                             uint32_t stream, NodeValue *result)
{
    const GraphType types[MAX_OPERANDS]    = {TYPE_FLOAT, TYPE_UINT, TYPE_UINT};
    NodeValue       operands[MAX_OPERANDS] = {{{0}}, {{stream}}};
    if (!want_constant(e, call, 0, &operands[0].v[0]))
        return false;
    *result = op_evaluate(op, type, 0, types, operands);
    return true;
}

/* ---- the functions ---- */

static Value number_of_cell(Elaboration *e, const Call *call, uint32_t stream)
{
    return value_authored(e, value_of_node(e, random_of_cell(e, call, 2 * stream)));
}

/* Returns a number or a vector of a seed and a stream, whichever the seed is. */
static Value seeded(Elaboration *e, const Call *call, Op op, GraphType type,
                    Value (*of_cell)(Elaboration *e, const Call *call, uint32_t stream))
{
    NodeValue result;
    uint32_t  stream;
    if (!want_count(e, call, 1, 0, 1000000, 0, &stream))
        return value_error();
    if (is_of_iteration(e, call->arguments[0].value))
        return seeded_of_iteration(e, call, op, type, stream);
    if (is_cell(e, call->arguments[0].value))
        return of_cell(e, call, stream);
    if (!seeded_of_number(e, call, op, type, stream, &result))
        return value_error();
    Value *items = arena_new_array(e->values, Value, type);
    for (uint32_t i = 0; i < type; i++)
        items[i] = value_authored(e, value_number(result.v[i]));
    return type == TYPE_FLOAT ? items[0] : value_list(e, items, type);
}

Value builtin_random(Elaboration *e, Call *call)
{
    return seeded(e, call, OP_seeded, TYPE_FLOAT, number_of_cell);
}

Value builtin_random_direction(Elaboration *e, Call *call)
{
    return seeded(e, call, OP_seeded_direction, TYPE_VEC3, direction_of_cell);
}

/* ---- noise ---- */

/* Makes the noise of a number as a straight cut through the noise of the plane, off its zeros. */
static Node noise_of(Graph *g, Node point)
{
    if (g->items[point].type == TYPE_FLOAT) {
        Node second = graph_number(g, 0.37);
        point       = graph_op2(g, OP_vec2, point, second);
    }
    return graph_op1(g, g->items[point].type == TYPE_VEC2 ? OP_noise2 : OP_noise3, point);
}

/* Returns the argument `p`; NODE_NONE: reported. */
static Node noise_point(Elaboration *e, const Call *call)
{
    Node point = want_numeric(e, call, 0);
    if (point == NODE_NONE || e->graph->items[point].type <= TYPE_VEC3)
        return point;
    diag_add(e->diags, DIAG_LENGTH_MISMATCH, call->arguments[0].syntax->span,
             "`%s` needs a number or a vector of 2 or 3", call->name);
    return NODE_NONE;
}

Value builtin_noise(Elaboration *e, Call *call)
{
    Node point = noise_point(e, call);
    if (point == NODE_NONE)
        return value_error();
    e->graph->here = call->syntax->span;
    return value_of_node(e, noise_of(e->graph, point));
}

/* Returns where an octave begins: all are 0 on their lattices, which must not meet. */
static Node octave_start(Graph *g, GraphType type, uint32_t octave)
{
    static const double steps[3] = {17.137, 9.713, 5.371};
    double              start[4] = {0};
    for (uint32_t i = 0; i < 3; i++)
        start[i] = octave * steps[i];
    return graph_constant(g, type, start);
}

Value builtin_fbm(Elaboration *e, Call *call)
{
    Graph   *g     = e->graph;
    Node     point = noise_point(e, call);
    Node     gain = want_number(e, call, 2, 0.5), lacunarity = want_number(e, call, 3, 2);
    uint32_t octaves;
    if (point == NODE_NONE || gain == NODE_NONE || lacunarity == NODE_NONE ||
        !want_count(e, call, 1, 1, 16, 5, &octaves))
        return value_error();
    if ((is_given(call, 2) && !check_positive(e, gain, call->arguments[2].syntax, "`gain`")) ||
        (is_given(call, 3) &&
         !check_positive(e, lacunarity, call->arguments[3].syntax, "`lacunarity`")))
        return value_error();
    g->here  = call->syntax->span;
    Node sum = NODE_NONE, total = NODE_NONE, loud = graph_number(g, 1), fine = loud;
    for (uint32_t i = 0; i < octaves; i++) {
        Node scaled_point = graph_op2(g, OP_mul, point, fine);
        Node start        = octave_start(g, g->items[point].type, i);
        Node moved        = graph_op2(g, OP_add, scaled_point, start);
        Node octave       = noise_of(g, moved);
        octave            = graph_op2(g, OP_mul, octave, loud);
        sum               = i ? graph_op2(g, OP_add, sum, octave) : octave;
        total             = i ? graph_op2(g, OP_add, total, loud) : loud;
        loud              = graph_op2(g, OP_mul, loud, gain);
        fine              = graph_op2(g, OP_mul, fine, lacunarity);
    }
    return value_of_node(e, graph_op2(g, OP_div, sum, total));
}
