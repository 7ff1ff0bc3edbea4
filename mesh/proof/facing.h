/*
 * facing.h: finds directions in which pieces grow.
 *
 * On both sides of a gap, or of a wall, pieces grow in opposite directions.  There the last choice
 * is between parts of the solid that face each other, and the pieces of each part have a direction
 * of their own.
 */
#ifndef KRS_MESH_FACING_H
#define KRS_MESH_FACING_H

#include "compiler/field/field.h"

/* Operands of the last choice, and of those like it that it chooses from, with their steps. */
typedef struct Facing {
    int    choice;        /* PIECE_MIN or PIECE_MAX */
    size_t operand_count; /* 0: all pieces grow along one direction */
    size_t begins[MAX_PIECES], ends[MAX_PIECES], parts[MAX_PIECES];
} Facing;

/* Finds the directions; returns by how much the pieces of each part grow at least along its own; 0:
   there are no such directions.  `direction` becomes the last one. */
double facing_find(const FieldPieces *pieces, float direction[3], Facing *facing);

#endif
