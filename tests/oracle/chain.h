/*
 * chain.h: random solids: a few primitives behind chains of methods, CSG nodes and sequences.
 *
 * Each is written as a scene, and answers by itself whether a point is inside: it undoes one
 * method after the other on the point, in double precision, and asks the primitive.  Nothing of
 * this is shared with the compiler.  Where the language refers to the box of a shape (a taper's
 * ends, a cell that it must fit), the compiler is asked for that box.
 */
#ifndef ORACLE_CHAIN_H
#define ORACLE_CHAIN_H

#include "tests/oracle/product.h"

typedef enum LinkKind {
    LINK_BOX,
    LINK_BALL,
    LINK_ROD,
    LINK_RING,
    LINK_CAPSULE,
    LINK_GROWN,
    LINK_HOLLOW,
    LINK_WAVY,
    LINK_BLEND,
    LINK_POLYNOMIAL,
    LINK_FIGURE,
    LINK_PRIMITIVES,
    LINK_MOVE = LINK_PRIMITIVES,
    LINK_TURN,
    LINK_SCALE,
    LINK_STRETCH,
    LINK_MIRROR,
    LINK_REPEAT,
    LINK_POLAR,
    LINK_TWIST,
    LINK_BEND,
    LINK_TAPER,
    LINK_ELONGATE,
    LINK_INVERT,
    LINK_WITHIN,
    LINK_METHODS,
    LINK_UNION = LINK_METHODS,
    LINK_INTERSECTION,
    LINK_DIFFERENCE,
    LINK_XOR,
    LINK_SEQUENCE,
    LINK_MOBIUS,
    LINK_KINDS
} LinkKind;
extern const char *const link_names[LINK_KINDS];

enum { MAX_LINKS = 40 };

/* A primitive, or what is done to one or two solids. */
typedef struct Link {
    LinkKind kind;
    bool     moves;       /* `number` is a parameter of the scene, with a range */
    bool     touches;     /* REPEAT: cells are as large as what is in them */
    double   number;      /* a radius, an angle, a rate, a factor */
    double   least, most; /* of the parameter */
    Vec      v, w;        /* sizes, a shift or a unit axis; a centre, or counts */
    double   length;      /* of the axis, as it is written */
    double   low, high;   /* TAPER: where its ends are; BEND: as far as what is bent reaches */
    int      solids[2];
} Link;

typedef struct Chain {
    Link links[MAX_LINKS];
    int  count, root;
    bool shown[LINK_KINDS]; /* which kinds are in it */
} Chain;

typedef struct Recipe {
    int      methods;   /* on each primitive, at most */
    int      csg_nodes; /* at most */
    bool     moving;    /* with parameters */
    unsigned only;      /* bits of the methods to choose from; 0: all */
} Recipe;

/* How many steps the language refused, of how many. */
typedef struct Refusals {
    int tried, refused;
} Refusals;

void chain_random(Chain *chain, const Recipe *recipe, Random *random, Refusals *refusals);
void chain_write(const Chain *chain, SceneText *text);
bool chain_contains(const void *chain, Vec point);
/* The box that the compiler gives for the whole; false where it is endless. */
bool chain_box(const Product *product, Vec *low, Vec *high);
/* Other values of all parameters, in the chain and in both states. */
void chain_move(Chain *chain, const Product *product, const Product *other, Random *random);

#endif
