/*
 * flat_faces.h: finds the faces of a solid between planes from its parts in boxes.
 *
 * Boxes that fill space each have a part of the solid (flat_pieces.h).  In each the planes are cut
 * into polygons, of which those that have the solid on one side are parts of faces.  What two parts
 * have in common at the border of boxes is no edge: edges lie between two planes, and end where a
 * third one is.  So faces come out whole, whatever the boxes were.
 *
 * Planes are moved by about a ten-millionth of the size, each by its own amount, so that no four of
 * them meet in a point.  Where they did, edges without length are left, whose ends are joined.
 * Vertices are where the exact planes meet.
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

/* Part of an edge of a face, at another plane. */
typedef struct FlatSegment {
    uint32_t face, line; /* twice the plane, and 1 where the solid is above it; the other plane */
    int      direction;  /* 1: along flat_line_direction, -1: back */
    double   begin, end; /* on the line */
    uint32_t ends[2];    /* planes that end it; FLAT_WALL: it continues in the next box */
} FlatSegment;

typedef struct FlatFaces {
    Arena   *arena;
    double   size;     /* of what is meshed */
    double   shortest; /* shortest edges that are not joined to a point */
    double   joined;   /* the longest that was joined */
    uint32_t attempt;  /* each moves planes otherwise */
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

/* Adds the segments in a box; returns false, and adds none, if rounding makes them ambiguous, or
   there are too many. */
bool flat_faces_add(FlatFaces *faces, Box box, const FlatPieces *pieces);

/* Finds the direction of the line of two planes, whatever their order. */
void flat_line_direction(const FlatFaces *faces, uint32_t a, uint32_t b, double along[3]);

#endif
