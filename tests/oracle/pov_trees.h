/*
 * pov_trees.h: random objects in POV-Ray's language, and what they are as its manual says it: points
 * are those of its left-handed space.
 */
#ifndef ORACLE_POV_TREES_H
#define ORACLE_POV_TREES_H

#include <stdbool.h>
#include <stddef.h>

#include "tests/support/random.h"

enum { POV_TREE_NODES = 64, POV_TREE_TURNS = 3, POV_TREE_TEXT = 16384 };

typedef enum PovTreeKind {
    TREE_BALL,
    TREE_BOX,
    TREE_COLUMN,
    TREE_RING,
    TREE_HALF,
    TREE_JOIN
} PovTreeKind;

typedef struct PovTurn {
    int    kind; /* 0 translate, 1 rotate, 2 scale */
    double by[3];
} PovTurn;

typedef struct PovNode {
    PovTreeKind kind;
    int         join, count, items[3], turn_count;
    double      a[3], b[3], r, s;
    PovTurn     turns[POV_TREE_TURNS];
} PovNode;

/* Nodes are named by their places in `nodes`. */
typedef struct PovTree {
    Random *random;
    PovNode nodes[POV_TREE_NODES];
    int     count;
    char    text[POV_TREE_TEXT]; /* as POV-Ray has it */
    size_t  length;
} PovTree;

void pov_tree_begin(PovTree *tree, Random *random);
/* Adds words to the text. */
void pov_tree_add(PovTree *tree, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Adds a primitive, or CSG nodes of so many levels; returns the node. */
int pov_tree_write(PovTree *tree, int depth);
/* Tells whether a point is inside of a node. */
bool pov_tree_has(const PovTree *tree, int index, const double outer[3]);
/* The point before the node is placed. */
void pov_tree_inner(const PovNode *node, const double outer[3], double q[3]);

#endif
