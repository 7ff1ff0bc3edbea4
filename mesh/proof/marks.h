/*
 * marks.h: marks cells of a grid where the mesh is new, and compares them with those that a proof
 * uses.
 */
#ifndef KRS_MESH_MARKS_H
#define KRS_MESH_MARKS_H

#include "mesh/contour/tets.h"

enum { MARKS = 512, MARKS_IN_WORD = 64 }; /* cells along a side */

typedef struct Marks {
    bool     any;
    uint64_t cells[MARKS][MARKS][MARKS / MARKS_IN_WORD];
} Marks;

void marks_clear(Marks *marks);
void marks_set(Marks *marks, const MarkBox *box);
/* Tells whether a cell of the box is marked. */
bool marks_touch(const Marks *marks, const MarkBox *box);

/* Return a box without cells; and add the cells of a box of space to one. */
MarkBox mark_box_none(void);
void    mark_box_add(const Tets *tets, const double low[3], const double high[3], MarkBox *box);

#endif
