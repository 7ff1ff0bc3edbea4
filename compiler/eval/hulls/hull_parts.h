/*
 * hull_parts.h: what the arguments of `hull` are the hull of.
 *
 * Each is the hull of some balls, or of balls that go around a circle: of rims.  Shapes of the
 * language say of which, by the property `hull`.
 */
#ifndef KRS_HULL_PARTS_H
#define KRS_HULL_PARTS_H

#include "compiler/eval/hulls/hull_supports.h"
#include "compiler/eval/elaborate.h"

/* A ball whose centre goes around `ball.centre`: `rim` is along the axis and as long as the circle's
   radius is; 0 for a ball that stays. */
typedef struct HullPart {
    HullBall ball;
    double   rim[3];
} HullPart;

typedef struct HullParts {
    HullPart *items;
    size_t    count, capacity;
    size_t    points; /* how many of them are points given as such */
    bool      figure, painted;
    struct {
        const Shape **items;
        size_t        count, capacity;
    } unchecked; /* shapes of the scene whose property `hull` is used for the first time */
} HullParts;

/* Finds the parts of what stands before the parameter `radius` of a call; false: reported. */
bool hull_parts(Elaboration *e, const Call *call, HullParts *parts);
/* Adds the parts of a shape; false: reported at `syntax`. */
bool hull_parts_of_shape(Elaboration *e, const Call *call, const Syntax *syntax, const Shape *shape,
                         HullParts *parts);

#endif
