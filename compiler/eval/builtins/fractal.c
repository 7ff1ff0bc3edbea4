/*
 * fractal.c: the built-in functions that make fractals.
 */
#include "compiler/eval/builtins/builtins.h"

#include <math.h>

#include "compiler/base/elementary.h"
#include "compiler/graph/fractal.h"

/* Finds the iterations as a whole number of frame time, and the most there can be; false:
   reported. */
static bool want_iterations(Elaboration *e, const Call *call, uint32_t index, double otherwise,
                            Node *iterations, double *most)
{
    Node node = want_number(e, call, index, otherwise);
    if (node == NODE_NONE)
        return false;
    Range range  = node_range(e->builder, node, 0);
    bool  broken = range.low == range.high && range.low != floor(range.low);
    if (!(range.low >= 1 && range.high < MAX_ITERATIONS + 1) || broken) {
        const Syntax *syntax = call->arguments[index].syntax;
        Diag         *diag   = diag_add(e->diags, DIAG_BAD_VALUE, syntax->span,
                                        "the iterations of `%s` must be whole numbers from 1 to %d",
                                        call->name, MAX_ITERATIONS);
        diag->label = diag_text(e->diags, range.low == range.high ? "this is %g" : "from %g to %g",
                                range.low, range.high);
        if (range.low != range.high)
            diag->help = "give the `param` a range, or use `clamp(..., 1, 16)`: the most there can "
                         "be bounds the loop";
        return false;
    }
    *most       = floor(range.high);
    *iterations = graph_op1(e->graph, OP_floor, node);
    return true;
}

/* Returns as many iterations as give details of about a thousandth of the whole. */
static double usual_iterations(uint32_t power) { return ceil(10 / real_log2(power)); }

/* Returns a list of four numbers of frame time; NODE_NONE: reported. */
static Node want_quaternion(Elaboration *e, const Call *call, uint32_t index)
{
    static const double otherwise[4] = {-0.2, 0.6, 0.2, 0.1};
    const Argument     *argument     = &call->arguments[index];
    if (!argument->syntax)
        return graph_constant(e->graph, TYPE_VEC4, otherwise);
    Node node = value_size(e, argument->value) == 4 ? value_node(e, argument->value) : NODE_NONE;
    if (node == NODE_NONE) {
        type_error(e, argument->syntax, argument->value, "a quaternion, [re, i, j, k]");
        return NODE_NONE;
    }
    if (e->graph->items[node].time == TIME_POINT) {
        point_error(e, argument->syntax, diag_text(e->diags, "`c` of `%s`", call->name));
        return NODE_NONE;
    }
    return check_finite(e, node, argument->syntax) ? node : NODE_NONE;
}

Value builtin_julia(Elaboration *e, Call *call)
{
    uint32_t power;
    double   most;
    Node     iterations, c = want_quaternion(e, call, 0);
    if (c == NODE_NONE || !want_count(e, call, 1, 2, MAX_POWER, 2, &power) ||
        !want_iterations(e, call, 2, usual_iterations(power), &iterations, &most))
        return value_error();
    return value_shape(make_julia(e->builder, c, power, iterations, most, call->syntax->span));
}

Value builtin_mandelbulb(Elaboration *e, Call *call)
{
    uint32_t power;
    double   most;
    Node     iterations;
    if (!want_count(e, call, 0, 2, MAX_POWER, 8, &power) ||
        !want_iterations(e, call, 1, usual_iterations(power), &iterations, &most))
        return value_error();
    return value_shape(make_mandelbulb(e->builder, power, iterations, most, call->syntax->span));
}
