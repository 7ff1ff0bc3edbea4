/*
 * pixel_filter.c: the pixel filters, by the integrals of their weights.
 */
#include "runtime/tracer/pixel_filter.h"

#include <math.h>

/* The reach is a column of the table; these are integrals of weights up to x, in [-reach, reach],
   times any constant. */
typedef double Integral(double x, double reach);

static double integral_box(double x, double reach) { return x + reach; }

/* Returns a normal distribution, less its value at the ends, so that it ends without a step. */
static double integral_gaussian(double x, double reach)
{
    const double deviation = 0.5, end = exp(-0.5 * reach * reach / (deviation * deviation));
    const double unit = deviation * sqrt(2);
    return deviation * sqrt(M_PI / 2) * (erf(x / unit) + erf(reach / unit)) - end * (x + reach);
}

/* Returns the window of four terms with the smallest side lobes (Harris 1978). */
static double integral_blackman_harris(double x, double reach)
{
    const double angle = M_PI * (1 + x / reach);
    return 0.35875 * angle - 0.48829 * sin(angle) + 0.14128 / 2 * sin(2 * angle) -
           0.01168 / 3 * sin(3 * angle);
}

static const struct {
    double    reach;
    Integral *integral;
} filters[KRS_PIXEL_FILTER_COUNT] = {
#define KRS_PIXEL_FILTER(id, name, reach, integral, about) {reach, integral_##integral},
#include "krs/choices.def"
};

double pixel_filter_reach(KrsPixelFilter filter) { return filters[filter].reach; }

double pixel_filter_place(KrsPixelFilter filter, double part)
{
    const double reach = filters[filter].reach;
    Integral    *found = filters[filter].integral;
    double       low = -reach, high = reach;
    if (found == integral_box)
        return part;
    for (int i = 0; i < 50; i++) {
        double middle = 0.5 * (low + high);
        bool   before = found(middle, reach) < part * found(reach, reach);
        low           = before ? middle : low;
        high          = before ? high : middle;
    }
    return 0.5 + 0.5 * (low + high);
}
