/*
 * blend_shares.c: smooth minima of several numbers that share the result.
 *
 * Distances are sorted, and counted from the least one, in widths: so the result is the same in any order, bit by
 * bit.  Where two have a share, it is that of two.
 */
#include "compiler/graph/blend_shares.h"

#include <math.h>

/* Finds how far each is above the least one, which is returned, in widths; none farther than one,
   where all are alike. */
static double heights_above_least(const double *distances, uint32_t count, double width,
                                  double heights[MAX_SHARERS])
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t at = i;
        for (; at > 0 && heights[at - 1] > distances[i]; at--)
            heights[at] = heights[at - 1];
        heights[at] = distances[i];
    }
    const double least = heights[0];
    heights[0]         = 0;
    for (uint32_t i = 1; i < count; i++) {
        const double height = heights[i] == least ? 0 : fabs(least - heights[i]) / width;
        heights[i]          = height < 1 ? height : 1;
    }
    return least;
}

/* Finds the shares of a quadratic blend.  With j of them below the threshold l, which is the mean
   of their heights and 1 / j, one more at the height h < l takes (l - h) / (j + 1) from the
   threshold, and j / (j + 1) (l - h)^2 / 2 from the result. */
BlendShares shares_quadratic(const double *distances, uint32_t count, double width)
{
    double       heights[MAX_SHARERS], taken = 0, second = 0;
    const double least     = heights_above_least(distances, count, width, heights);
    double       threshold = 1;
    if (!(width > 0))
        return (BlendShares){least, least};
    for (uint32_t j = 1; j < count; j++) {
        const double below = fmax(threshold - heights[j], 0);
        if (j == 1)
            second = below;
        else
            taken += (double)j / (2 * (j + 1)) * below * below;
        threshold -= below / (j + 1);
    }
    return (BlendShares){least - width * second * second / 4 - width * taken,
                         least + width * threshold};
}

static double cubic_share(double v)
{
    const double rest = 1 - v;
    return v < 0.5 ? 2 * v * v : 1 - 2 * rest * rest;
}

static double cubic_integral(double v)
{
    const double rest = 1 - v;
    return v < 0.5 ? v * v * v / 1.5 : v - 0.5 + rest * rest * rest / 1.5;
}

/* Tells how far an operand is below the threshold, as far as that counts. */
static double below_threshold(double threshold, double height)
{
    return fmin(fmax(threshold - height, 0), 1);
}

/* Finds the threshold from that of the two nearest downwards, by Newton's method: the shares of all
   grow faster and faster with the threshold, while there are two. */
static double cubic_threshold(const double *heights, uint32_t count, double threshold)
{
    enum { ITERATIONS = 8 };
    for (int i = 0; i < ITERATIONS; i++) {
        double shares = 0, growth = 0;
        for (uint32_t j = 0; j < count; j++) {
            const double v = below_threshold(threshold, heights[j]);
            shares += cubic_share(v);
            growth += 4 * fmin(v, 1 - v);
        }
        threshold -= (shares - 1) / fmax(growth, 1e-6);
    }
    return threshold;
}

BlendShares shares_cubic(const double *distances, uint32_t count, double width)
{
    double       heights[MAX_SHARERS], sum = 0;
    const double least = heights_above_least(distances, count, width, heights);
    if (!(width > 0))
        return (BlendShares){least, least};
    const double second = count > 1 ? heights[1] : 1, near = 1 - second;
    double       threshold = (1 + second) / 2;
    if (count < 3 || heights[2] >= threshold)
        return (BlendShares){least - width * near * near * near / 6, least + width * threshold};
    threshold = cubic_threshold(heights, count, threshold);
    for (uint32_t j = 0; j < count; j++)
        sum += cubic_integral(below_threshold(threshold, heights[j]));
    return (BlendShares){least + width * (threshold - 0.5 - sum), least + width * threshold};
}

SharingOp sharing_op(Op op)
{
    static const SharingOp all[OP_COUNT] = {
#define BLEND_SHARES(name, find, ...)                                             \
    [OP_smin4_##name] = {OP_smin_##name, OP_smin4_##name, OP_smin8_##name, find}, \
    [OP_smin8_##name] = {OP_smin_##name, OP_smin4_##name, OP_smin8_##name, find},
#include "compiler/graph/blends.def"
    };
    return all[op];
}
