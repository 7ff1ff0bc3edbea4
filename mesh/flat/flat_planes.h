/*
 * flat_planes.h: half-spaces, and solids as trees of intersections and unions of them.
 */
#ifndef KRS_MESH_FLAT_PLANES_H
#define KRS_MESH_FLAT_PLANES_H

#include <stdbool.h>
#include <stddef.h>

/* The points where normal . p + offset is below 0; the normal has length 1. */
typedef struct HalfSpace {
    double normal[3], offset;
} HalfSpace;

/* The part of the size by which planes are moved at most where they are cut (flat_faces.h). */
#define FLAT_MOVED 1e-7

/* The bounds by which the number may be less, or more, that a half-space approximates. */
typedef struct FlatSlack {
    double below, above;
} FlatSlack;

enum { MAX_FLATS = 128, MAX_FLAT_NODES = 1024 };

/* A solid: all, none, or a node. */
enum { FLAT_ALL = -1, FLAT_NONE = -2 };

typedef struct FlatNode {
    enum { FLAT_HALF_SPACE, FLAT_BOTH, FLAT_EITHER } kind;
    int first, second; /* of a half-space: its number, and its sign */
} FlatNode;

typedef struct FlatPieces {
    size_t    count, node_count;
    HalfSpace list[MAX_FLATS];
    FlatSlack slack[MAX_FLATS];
    bool      chooses[MAX_FLATS]; /* its side is a condition that chooses one of two surfaces */
    FlatNode  nodes[MAX_FLAT_NODES];
    int       root;
    bool      round; /* some approximate what is round */
} FlatPieces;

/* Faces are made in boxes of few planes.  Proofs are made in wider boxes, with more planes. */
typedef enum FlatUse { FLAT_MAKING, FLAT_PROVING } FlatUse;

#endif
