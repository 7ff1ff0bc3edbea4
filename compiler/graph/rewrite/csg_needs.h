/*
 * csg_needs.h: which parts of a tree of CSG nodes its surface needs (csg_nodes.h).
 */
#ifndef KRS_CSG_NEEDS_H
#define KRS_CSG_NEEDS_H

#include "compiler/graph/blend_shares.h"
#include "compiler/graph/range.h"

typedef enum CsgKind {
    CSG_LEAF,
    CSG_NEGATIVE, /* of part a */
    CSG_ADD,      /* part a + number */
    CSG_SCALE,    /* part a * number, which is above 0 */
    CSG_MIN,
    CSG_MAX,
    CSG_BLEND,  /* of parts a and b; their minimum where they differ by `number` or more */
    CSG_SHARES, /* of up to eight parts; what is `number` or more above the least has no share */
    CSG_CORNER  /* the distance to what is inside of all its sides, which are perpendicular */
} CsgKind;

enum { MAX_SIDES = 3 };

/* A node of the tree. */
typedef struct CsgPart {
    CsgKind  kind;
    Node     node;
    uint32_t a, b;             /* parts before it */
    uint32_t sides[MAX_SIDES]; /* of a corner: leaves, from a side's middle plane outwards */
    uint32_t side_count;
    uint32_t sharers[MAX_SHARERS];
    uint32_t sharer_count;
    uint8_t  shares[MAX_SHARERS]; /* with which others it is needed that one has a share, as bits */
    double   number;
    bool     upwards;   /* the whole may grow with it */
    bool     downwards; /* the whole may get less as it grows */
    bool     blends;    /* the blend is needed */
    uint32_t needed;    /* the sides that are, as bits */
    bool     is_round;  /* also what is nearest to an edge between two sides */
} CsgPart;

typedef struct CsgTree {
    Graph   *graph;
    CsgPart *parts; /* operands first; the last is the whole */
    uint32_t count;
} CsgTree;

/* Tells whether something of it may be left out.  A side may be where the whole gets larger by it: so a march
   has no smaller steps. */
static inline bool csg_node_is_candidate(const CsgPart *part)
{
    return part->kind == CSG_BLEND || part->kind == CSG_SHARES ||
           (part->kind == CSG_CORNER && !part->upwards);
}

/* Marks what the surface needs.  False: nothing may be left out. */
bool csg_nodes_find_needs(CsgTree *tree, Box box, Arena *scratch);

#endif
