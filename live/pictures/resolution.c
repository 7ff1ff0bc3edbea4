/*
 * resolution.c: how large pictures of what moves may be, to be in time.
 *
 * A coarse picture alone does not tell which part of its time its pixels took.  A whole picture of the
 * same view does.  While something moves there are no whole ones, and what pixels cost changes with
 * the view, much more than the rest: so where a picture has as many as the one before, a longer time is
 * blamed on them.  If the next picture has fewer of them and takes as long, more of its time is of the
 * other kind.  What is late although its size should do is tried with fewer of them: pictures of one size
 * would never tell that their pixels are underrated.
 */
#include "live/pictures/resolution.h"

#include <math.h>
#include <stdbool.h>

/* The greatest growth and length that a single picture may find for the time that pixels do not
   cause. */
#define MAX_GROWTH 1.5
#define MAX_STEP   1.0

/* A picture is late from so many budgets on.  Where its pixels take less than this part of a budget, fewer
   of them are not tried. */
#define LATE         1.15
#define WORTH_TRYING 0.25

/* Returns the fixed part of a picture with as many pixels as the last one; a shorter time is shorter in all of
   its parts. */
static double fixed_of_same(const Resolution *resolution, double ms, double pixels)
{
    const double expected = resolution->fixed_ms + pixels * resolution->pixel_ms;
    return ms < expected ? resolution->fixed_ms * ms / expected : resolution->fixed_ms;
}

static double fixed_of_other(const Resolution *resolution, double ms, double pixels)
{
    const double most = MAX_GROWTH * resolution->fixed_ms + MAX_STEP;
    const double rest = ms - pixels * resolution->pixel_ms;
    return resolution->pixel_ms > 0 ? fmin(fmax(rest, 0), most) : 0;
}

void resolution_learn_coarse(Resolution *resolution, double ms, double pixels)
{
    const bool same           = pixels == resolution->coarse_pixels;
    resolution->fixed_ms      = same ? fixed_of_same(resolution, ms, pixels)
                                     : fixed_of_other(resolution, ms, pixels);
    resolution->pixel_ms      = (ms - resolution->fixed_ms) / pixels;
    resolution->coarse_pixels = pixels;
    resolution->coarse_ms     = ms;
}

void resolution_learn_whole(Resolution *resolution, double ms, double pixels)
{
    Resolution  *r       = resolution;
    const double divided = r->divisor > 1 ? pixels / (r->divisor * r->divisor) : pixels;
    const double coarse  = r->fixed_ms + r->pixel_ms * divided; /* ms of the coarse picture */
    r->whole_ms          = ms;
    if (r->pixel_ms <= 0 || divided >= pixels || ms / pixels < r->pixel_ms) {
        r->pixel_ms = ms / pixels;
        r->fixed_ms = divided < pixels ? fmax(coarse - divided * r->pixel_ms, 0) : r->fixed_ms;
    }
}

double resolution_divide(Resolution *resolution, double pixels, double budget)
{
    static const double steps[] = {1, 1.5, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 24, MAX_DIVISOR};
    /* Fewer pixels do not shorten the time that pixels do not cause: they have half of it in any
       case. */
    const double left   = fmax(budget - resolution->fixed_ms, budget / 2);
    double       needed = resolution->pixel_ms > 0 ? sqrt(pixels * resolution->pixel_ms / left) : 8;
    if (resolution->coarse_ms > LATE * budget &&
        resolution->coarse_pixels * resolution->pixel_ms > WORTH_TRYING * budget)
        needed = fmax(needed, 1.01 * resolution->divisor);
    /* The divisor stays where it would do, so that the picture does not flicker. */
    if (resolution->divisor > needed && resolution->divisor < 2.2 * needed)
        return resolution->divisor;
    int i = 0;
    while (i + 1 < (int)(sizeof steps / sizeof *steps) && steps[i] < needed)
        i++;
    return resolution->divisor = steps[i];
}
