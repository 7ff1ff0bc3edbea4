/*
 * flat_circles.h: what is round: the length of a pair of numbers is the largest distance that the sides of a polygon tell, and that
 * of three is the length of a pair of which one is the length of a pair.  So balls have bands.
 */
#ifndef KRS_MESH_FLAT_CIRCLES_H
#define KRS_MESH_FLAT_CIRCLES_H

#include "mesh/flat/flat_joins.h"

/* Where rest + factor length is below 0. */
int flat_solid_of_length(Finding *f, const Form *rest, double factor, const LaneStep *step);

/* Tells whether a form has a length of several numbers in it. */
bool form_has_round(const Finding *f, const Form *form);
/* How fast a form changes, about. */
double form_steepness(const Finding *f, const Form *form);
/* What is too large, or too small, by a number at most. */
FlatSlack flat_slack_with(FlatSlack slack, double excess);

#endif
