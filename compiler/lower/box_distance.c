/*
 * box_distance.c: bounds for the distance to a shape, from a box around it.
 */
#include "compiler/lower/box_distance.h"

#include <math.h>

/* Returns how far outside of a finite box a point is along each axis; negative inside. */
static Node excess_along(Graph *g, Node point, Box box)
{
    double centre[3], half[3];
    box_centre(box, centre);
    for (int i = 0; i < 3; i++)
        half[i] = 0.5 * (box.axis[i].high - box.axis[i].low);
    Node middle = graph_constant(g, TYPE_VEC3, centre);
    Node sides  = graph_constant(g, TYPE_VEC3, half);
    Node local  = graph_op2(g, OP_sub, point, middle);
    Node size   = graph_op1(g, OP_abs, local);
    return graph_op2(g, OP_sub, size, sides);
}

Node box_distance(Graph *g, Node point, Box box)
{
    Node zero    = graph_number(g, 0);
    Node outside = graph_op2(g, OP_max, excess_along(g, point, box), zero);
    return graph_op1(g, OP_length, outside);
}

Node box_excess(Graph *g, Node point, Box box)
{
    Node along = excess_along(g, point, box), parts[3];
    for (uint32_t i = 0; i < 3; i++)
        parts[i] = graph_component(g, along, i);
    return graph_op2(g, OP_max, parts[0], graph_op2(g, OP_max, parts[1], parts[2]));
}

Node sides_excess(Graph *g, Node point, Box box)
{
    Node most = NODE_NONE;
    for (uint32_t i = 0; i < 3; i++) {
        Range side = box.axis[i];
        if (!isfinite(side.low) || !isfinite(side.high) || side.low >= side.high)
            continue;
        Node middle = graph_number(g, 0.5 * (side.low + side.high));
        Node half   = graph_number(g, 0.5 * (side.high - side.low));
        Node offset = graph_op2(g, OP_sub, graph_component(g, point, i), middle);
        Node excess = graph_op2(g, OP_sub, graph_op1(g, OP_abs, offset), half);
        most        = most == NODE_NONE ? excess : graph_op2(g, OP_max, most, excess);
    }
    return most;
}
