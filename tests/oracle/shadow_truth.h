/*
 * shadow_truth.h: how much of a light exact rays reach.
 *
 * A shadow ray starts an eighth of a pixel above even ground: truths are computed for rays from the
 * surface and from there, or somewhat higher.
 */
#ifndef ORACLE_SHADOW_TRUTH_H
#define ORACLE_SHADOW_TRUTH_H

#include "tests/oracle/shadow_fixture.h"

/* The most that rays may start above even ground, in pixels: one, and what the permitted error
   makes. */
#define MAX_LIFT 1.25

/* The light as it is seen from a point: a disc across the way to its middle. */
typedef struct Disc {
    Vec    axis; /* unit */
    double remote, radius;
    bool   endless; /* nothing is behind the light */
} Disc;

Disc disc_from(const Shot *shot, Vec point);
/* Tells whether a solid stands between a point and another that is `direction` off. */
bool is_hidden(const Shot *shot, Vec point, Vec direction, bool endless);

typedef double Truth(const Shot *shot, Vec point);

/* By rays to points that divide the disc evenly. */
double share_by_rays(const Shot *shot, Vec point);
/* The ledge's upper edge and a point span a plane, which cuts the disc along a line.  Exact where
   all rays go up and towards the ledge. */
double share_above_edge(const Shot *shot, Vec point);

/* What rays from the surface see in the pixels of a window, and what they see that start above it:
   a pixel, unless said otherwise. */
typedef struct Truths {
    int    width, height;
    double low[MAX_PIXELS], lifted[MAX_PIXELS];
} Truths;

extern Truths truths; /* the last computed */

/* Into `truths`; the higher rays start `lift` pixels above the surface. */
void   compute_truths(Truth *truth, const Shot *shot, double lift);
double truth_low(int k);
double truth_high(int k);
/* The least and the greatest truth of the pixels up to so far away. */
void truths_within(int k, int reach, double *low, double *high);

#endif
