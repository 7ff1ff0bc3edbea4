/*
 * queried.h: a scene that questions are put to through the C interface.
 */
#ifndef UNIT_QUERIED_H
#define UNIT_QUERIED_H

#include "krs/krs.h"
#include "tests/support/random.h"

typedef struct Scene {
    KrsScene *scene;
    KrsState *state;
} Scene;

Scene scene_of(const char *text);
void  scene_close(Scene s);

extern Random chance;

double uniform(double low, double high);
double length3(const double v[3]);
double apart(const double a[3], const double b[3]);
KrsHit cast(KrsState *state, const double origin[3], const double direction[3], double farthest,
            double tolerance);

#endif
