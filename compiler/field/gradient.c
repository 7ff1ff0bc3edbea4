/* gradient.c: derivatives in a box. */
#include "compiler/field/gradient.h"

#include <string.h>

#include "compiler/base/vec.h"

static const double ROUNDING = 1 + 1e-9;

bool find_gradient(const LaneSlope *slope, Gradient *gradient)
{
    double rest = 0, length, half[3];
    for (int k = 0; k < 3; k++) {
        gradient->middle[k]    = 0.5 * (slope->by[k].low + slope->by[k].high);
        gradient->direction[k] = gradient->middle[k];
        half[k]                = ROUNDING * max2(slope->by[k].high - gradient->middle[k],
                                                 gradient->middle[k] - slope->by[k].low);
    }
    length = length3(gradient->middle);
    if (!normalize3(gradient->direction))
        return false;
    for (int k = 0; k < 3; k++)
        rest += half[k] * fabs(gradient->direction[k]);
    gradient->across = length3(half);
    gradient->least  = length - rest;
    gradient->most   = length + rest;
    return gradient->least > 0;
}

Box corners_box(const double (*corners)[3], size_t count, double margin)
{
    Box box;
    for (int k = 0; k < 3; k++) {
        box.axis[k] = (Range){INFINITY, -INFINITY};
        for (size_t i = 0; i < count; i++) {
            box.axis[k].low  = min2(box.axis[k].low, corners[i][k] - margin);
            box.axis[k].high = max2(box.axis[k].high, corners[i][k] + margin);
        }
    }
    return box;
}
