/*
 * triangles.h: what tests know of triangles by themselves, without the code of the mesher.
 */
#ifndef KRS_TESTS_TRIANGLES_H
#define KRS_TESTS_TRIANGLES_H

#include <stddef.h>
#include <stdint.h>

/* Returns the distance of a point from a triangle. */
double distance_to_triangle(const double corners[3][3], const double point[3]);
/* Counts the sides of triangles that are not there once in the other direction. */
size_t count_open_sides(const uint32_t (*triangles)[3], size_t count);

#endif
