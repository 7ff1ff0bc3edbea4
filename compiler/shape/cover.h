/*
 * cover.h: sets covered by balls.
 *
 * An inversion takes balls to balls, exactly, and boxes to nothing of use; so the bounding volume
 * of a set that is inverted is a list of balls (math.md, section 2.2).
 */
#ifndef KRS_COVER_H
#define KRS_COVER_H

#include "compiler/base/arena.h"
#include "compiler/shape/box.h"

/* A ball, or the outside of it: all of space where its radius is 0. */
typedef struct CoverCell {
    Ball ball;
    bool outside;
} CoverCell;

/* Zero is the empty set. */
typedef struct Cover {
    CoverCell *items;
    size_t     count, capacity;
} Cover;

/* A map of space (shape.h) for all values of the parameters. */
typedef struct MapRange {
    bool  inverts;
    Range scale, rows[3][3], shift[3], pole[3];
} MapRange;

/* Adds a finite box. */
void cover_add(Arena *arena, Cover *cover, Box box);
/* Covers what has u.x <= w, and its mirror image, for a unit vector and an offset in their ranges. */
void cover_fold(Arena *arena, Cover *cover, const Range u[3], Range w);
/* Covers what is outside of a sphere, and its image in that, for centres and radii in their
   ranges. */
void cover_fold_sphere(Arena *arena, Cover *cover, const Range centre[3], Range radius);
void cover_map(Cover *cover, const MapRange *map);
Box  cover_box(const Cover *cover);
Ball cover_ball(const Cover *cover);

#endif
