/*
 * flat_circles.h: approximates what is round by planes.  The length of a pair of numbers is the
 * largest distance to the sides of a polygon.  The length of three is that of a pair of which one
 * is the length of a pair, so balls have bands.
 */
#ifndef KRS_MESH_FLAT_CIRCLES_H
#define KRS_MESH_FLAT_CIRCLES_H

#include "mesh/flat/flat_joins.h"

/* Returns the solid where rest + factor length is below 0. */
int flat_solid_of_length(Finding *f, const Form *rest, double factor, const LaneStep *step);

/* Tells whether a form depends on a length of several numbers. */
bool form_has_round(const Finding *f, const Form *form);
/* Returns about how fast a form changes. */
double form_steepness(const Finding *f, const Form *form);
/* Returns the slack of a number that is too large by `excess`, or too small if that is below 0. */
FlatSlack flat_slack_with(FlatSlack slack, double excess);

#endif
