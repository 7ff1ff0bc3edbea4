/*
 * flat_faces.h: the faces of a solid between planes, from what is known of it in boxes.
 *
 * Boxes that fill space each have a part of the solid (flat_pieces.h).  In each the planes are cut into polygons, of which
 * those that have the solid on one side are parts of faces.  What two parts have in common at the border of boxes is no
 * edge: edges lie between two planes, and end where a third one is.  So faces come out whole, whatever the boxes
 * were.
 *
 * Planes are moved by about a ten-millionth of the size, each by its own amount, so that no four of them meet in
 * a point.  Where they did, edges without length are left, whose ends become one.  Vertices are where the planes meet that
 * were not moved.
 */
#ifndef KRS_MESH_FLAT_FACES_H
#define KRS_MESH_FLAT_FACES_H

#include "mesh/common/numbering.h"
#include "mesh/flat/flat_pieces.h"
#include "mesh/flat/polygons.h"

typedef struct FlatPlane {
    HalfSpace exact;
    double    moved; /* the offset of the plane that is cut */
    uint32_t  next;  /* with the same mark; NO_NUMBER */
} FlatPlane;

#define FLAT_WALL UINT32_MAX

/* Part of an edge: of a face, at another plane. */
typedef struct FlatSegment {
    uint32_t face, line; /* twice the plane, and 1 where the solid is above it; the other plane */
    int      way; /* 1: it goes along the line, which goes along the product of both normals; -1 */
    double   begin, end; /* on the line */
    uint32_t ends[2];    /* planes that end it; FLAT_WALL: it goes on in the next box */
} FlatSegment;

typedef struct FlatFaces {
    Arena   *arena;
    double   size;     /* of what is meshed */
    double   shortest; /* edges that are not made a point */
    double   joined;   /* the longest that is made a point */
    uint32_t attempt;  /* at another one planes are moved otherwise */
    struct {
        FlatPlane *items;
        size_t     count, capacity;
    } planes;
    Numbering marks; /* the first plane that has a mark */
    struct {
        FlatSegment *items;
        size_t       count, capacity;
    } segments;
} FlatFaces;

/* Adds what is in a box.  False: it is too near to what cannot be told apart. */
bool flat_faces_add(FlatFaces *faces, Box box, const FlatPieces *pieces);

/* Finds the direction of the line of two planes, in whichever order. */
void flat_line_direction(const FlatFaces *faces, uint32_t a, uint32_t b, double along[3]);

#endif
