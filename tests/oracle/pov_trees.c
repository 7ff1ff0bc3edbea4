/*
 * pov_trees.c: random objects in POV-Ray's language, and what they are as its manual says it.
 */
#include "tests/oracle/pov_trees.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

void pov_tree_begin(PovTree *tree, Random *random)
{
    tree->random = random;
    tree->count  = 0;
    tree->length = 0;
}

void pov_tree_add(PovTree *tree, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    tree->length += (size_t)vsnprintf(tree->text + tree->length, sizeof tree->text - tree->length,
                                      format, arguments);
    va_end(arguments);
    assert_true(tree->length < sizeof tree->text);
}

static void write_primitive(PovTree *tree, PovNode *node)
{
    const double *a = node->a, *b = node->b;
    random_vector(tree->random, 1, node->a);
    random_vector(tree->random, 1, node->b);
    node->r = random_between(tree->random, 0.3, 1);
    node->s = random_below(tree->random, 3) ? random_between(tree->random, 0, 1) : node->r;
    switch (node->kind) {
    case TREE_BALL:
        pov_tree_add(tree, "sphere { <%.17g, %.17g, %.17g>, %.17g ", a[0], a[1], a[2], node->r);
        break;
    case TREE_BOX:
        pov_tree_add(tree, "box { <%.17g, %.17g, %.17g>, <%.17g, %.17g, %.17g> ", a[0], a[1], a[2],
                     b[0], b[1], b[2]);
        break;
    case TREE_COLUMN:
        pov_tree_add(tree, "cone { <%.17g, %.17g, %.17g>, %.17g, <%.17g, %.17g, %.17g>, %.17g ",
                     a[0], a[1], a[2], node->r, b[0], b[1], b[2], node->s);
        break;
    case TREE_RING:
        node->s = node->r * random_between(tree->random, 0.2, 0.8);
        pov_tree_add(tree, "torus { %.17g, %.17g ", node->r, node->s);
        break;
    default: pov_tree_add(tree, "plane { <%.17g, %.17g, %.17g>, %.17g ", a[0], a[1], a[2], b[0]);
    }
}

static void write_turns(PovTree *tree, PovNode *node)
{
    static const char *const words[] = {"translate", "rotate", "scale"};
    node->turn_count                 = random_below(tree->random, POV_TREE_TURNS + 1);
    for (int i = 0; i < node->turn_count; i++) {
        PovTurn *turn = &node->turns[i];
        turn->kind    = random_below(tree->random, 3);
        for (int k = 0; k < 3; k++)
            turn->by[k] = turn->kind == 0   ? random_between(tree->random, -1, 1)
                          : turn->kind == 1 ? (random_below(tree->random, 2)
                                                   ? random_between(tree->random, -180, 180)
                                                   : 0)
                                            : random_between(tree->random, 0.6, 1.4) *
                                                  (random_below(tree->random, 8) ? 1 : -1);
        pov_tree_add(tree, "%s <%.17g, %.17g, %.17g> ", words[turn->kind], turn->by[0], turn->by[1],
                     turn->by[2]);
    }
    pov_tree_add(tree, "}\n");
}

int pov_tree_write(PovTree *tree, int depth)
{
    static const char *const joins[] = {"union", "intersection", "difference", "merge"};
    int                      index   = tree->count++;
    assert_true(index < POV_TREE_NODES);
    PovNode *node = &tree->nodes[index];
    *node = (PovNode){.kind = depth == 0 ? (PovTreeKind)random_below(tree->random, TREE_JOIN)
                                         : TREE_JOIN};
    if (node->kind == TREE_JOIN) {
        node->join  = random_below(tree->random, 4);
        node->count = 2 + random_below(tree->random, 2);
        pov_tree_add(tree, "%s {\n", joins[node->join]);
        for (int i = 0; i < node->count; i++)
            node->items[i] = pov_tree_write(tree, depth - 1);
    } else {
        write_primitive(tree, node);
    }
    write_turns(tree, node);
    return index;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static bool primitive_has(const PovNode *node, const double q[3])
{
    double off[3], along[3], round = hypot(q[0], q[2]);
    for (int i = 0; i < 3; i++) {
        off[i]   = q[i] - node->a[i];
        along[i] = node->b[i] - node->a[i];
    }
    double t = dot(off, along) / dot(along, along);
    switch (node->kind) {
    case TREE_BALL: return dot(off, off) < node->r * node->r;
    case TREE_BOX:
        for (int i = 0; i < 3; i++)
            if ((q[i] - node->a[i]) * (q[i] - node->b[i]) > 0)
                return false;
        return true;
    case TREE_COLUMN:
        return t > 0 && t < 1 &&
               sqrt(fmax(dot(off, off) - t * t * dot(along, along), 0)) <
                   node->r + t * (node->s - node->r);
    case TREE_RING: return hypot(round - node->r, q[1]) < node->s;
    default: return dot(node->a, q) / sqrt(dot(node->a, node->a)) < node->b[0];
    }
}

/* Back from where a turn takes points: z, y and x in this order, each against its sense. */
static void undo(const PovTurn *turn, double q[3])
{
    for (int axis = 2; axis >= 0 && turn->kind == 1; axis--) {
        double angle = -turn->by[axis] * acos(-1) / 180;
        int    i = (axis + 1) % 3, k = (axis + 2) % 3;
        double a = q[i], b = q[k];
        q[i] = a * cos(angle) - b * sin(angle);
        q[k] = a * sin(angle) + b * cos(angle);
    }
    for (int i = 0; i < 3 && turn->kind != 1; i++)
        q[i] = turn->kind == 0 ? q[i] - turn->by[i] : q[i] / turn->by[i];
}

void pov_tree_inner(const PovNode *node, const double outer[3], double q[3])
{
    for (int k = 0; k < 3; k++)
        q[k] = outer[k];
    for (int i = node->turn_count; i-- > 0;)
        undo(&node->turns[i], q);
}

bool pov_tree_has(const PovTree *tree, int index, const double outer[3])
{
    const PovNode *node = &tree->nodes[index];
    double         q[3];
    pov_tree_inner(node, outer, q);
    if (node->kind < TREE_JOIN)
        return primitive_has(node, q);
    bool first = pov_tree_has(tree, node->items[0], q), all = first, any = first, others = false;
    for (int i = 1; i < node->count; i++) {
        bool has = pov_tree_has(tree, node->items[i], q);
        all      = all && has;
        any      = any || has;
        others   = others || has;
    }
    return node->join == 1 ? all : node->join == 2 ? first && !others : any;
}
