/*
 * joint_needs.h: which parts of a tree of joints its surface needs (joints.h).
 */
#ifndef KRS_JOINT_NEEDS_H
#define KRS_JOINT_NEEDS_H

#include "compiler/graph/blend_shares.h"
#include "compiler/graph/range.h"

typedef enum JointKind {
    JOINT_LEAF,
    JOINT_NEGATIVE, /* of part a */
    JOINT_ADD,      /* part a + number */
    JOINT_SCALE,    /* part a * number, which is above 0 */
    JOINT_MIN,
    JOINT_MAX,
    JOINT_BLEND,  /* of parts a and b; their minimum where they differ by `number` or more */
    JOINT_SHARES, /* of up to eight parts; what is `number` or more above the least has no share */
    JOINT_CORNER  /* the distance to what is inside of all its sides, which are perpendicular */
} JointKind;

enum { MOST_SIDES = 3 };

/* A node of the tree. */
typedef struct JointPart {
    JointKind kind;
    Node      node;
    uint32_t  a, b;              /* parts before it */
    uint32_t  sides[MOST_SIDES]; /* of a corner: leaves, from a side's middle plane outwards */
    uint32_t  side_count;
    uint32_t  sharers[MOST_SHARERS];
    uint32_t  sharer_count;
    uint8_t shares[MOST_SHARERS]; /* with which others it is needed that one has a share, as bits */
    double  number;
    bool    upwards;   /* the whole may grow with it */
    bool    downwards; /* the whole may get less as it grows */
    bool    blends;    /* the blend is needed */
    uint32_t needed;   /* the sides that are, as bits */
    bool     is_round; /* also what is nearest to an edge between two sides */
} JointPart;

typedef struct JointTree {
    Graph     *graph;
    JointPart *parts; /* operands first; the last is the whole */
    uint32_t   count;
} JointTree;

/* Whether something of it may be left out.  A side may be where the whole gets larger by it: so a march
   has no smaller steps. */
static inline bool joint_is_candidate(const JointPart *part)
{
    return part->kind == JOINT_BLEND || part->kind == JOINT_SHARES ||
           (part->kind == JOINT_CORNER && !part->upwards);
}

/* Marks what the surface needs.  False: nothing may be left out. */
bool joints_find_needs(JointTree *tree, Box box, Arena *scratch);

#endif
