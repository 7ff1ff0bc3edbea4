/*
 * similarity.h: similarities as matrices, and how far the items that they place reach.
 */
#ifndef KRS_MESH_SIMILARITY_H
#define KRS_MESH_SIMILARITY_H

#include "krs/krs.h"
#include "compiler/shape/box.h"

extern const double similarity_identity[3][4];

void similarity_mirror(const double normal[3], double offset, double matrix[3][4]);
void similarity_map(double scale, const double rows[3][3], const double shift[3],
                    double matrix[3][4]);
/* Sets matrix = a b; matrix must be neither of them. */
void   similarity_product(const double a[3][4], const double b[3][4], double matrix[3][4]);
double similarity_scale(const double matrix[3][4]);

/* A search for how far items reach; each item is within a box and a ball. */
typedef struct ReachSearch {
    const KrsAssembly *assembly;
    struct ItemBounds {
        Box  box;
        Ball ball;
    } * bounds;    /* of each item */
    size_t visits; /* visits of items that are left */
} ReachSearch;

/* Finds the bounds of an item from those that it places, or from its mesh; without either they
   stay. */
void find_item_bounds(ReachSearch *search, size_t item);
/* Returns the largest dot product of a direction with a point of the placed item, and not below
   `least`.  It may be too large where there are no meshes yet, and is infinite when visits have run
   out. */
double reach_along(ReachSearch *search, size_t item, const double matrix[3][4],
                   const double direction[3], double least);

#endif
