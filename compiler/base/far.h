/*
 * far.h: numbers that stand for what is infinitely far away, where infinity itself is no number to
 * compute with.
 */
#ifndef KRS_FAR_H
#define KRS_FAR_H

/* The distance to the empty set: larger than any scene, but finite, so that sums are finite; its
   square is finite in double precision. */
#define NOWHERE 1e30
/* The same in the text of shaders. */
#define NOWHERE_TEXT "1e30"
/* Coordinates, and the sides of boxes without an end, are no larger: single precision can square
   them.  KRS_MAX_COORDINATE is the same for callers. */
#define FAR_SIDE 1e18

#endif
