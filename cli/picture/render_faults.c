/*
 * render_faults.c: what pictures lack.
 */
#include "cli/picture/render_faults.h"

#include "cli/shell/console.h"

/* Rays that graze a surface take many steps: so few of a picture change nothing that can be seen. */
static const double SEEN = 1e-5;

void render_faults_add(RenderFaults *faults, const KrsPicture *picture, double noise)
{
    const size_t pixels = (size_t)picture->window.width * picture->window.height;
    faults->unresolved += picture->stats.unresolved;
    faults->rays += picture->stats.rays;
    if (!picture->noise || noise <= 0)
        return;
    faults->noise   = noise;
    faults->samples = picture->samples;
    faults->pixels += pixels;
    for (size_t i = 0; i < pixels; i++)
        faults->noisy += picture->pixel_samples[i] >= picture->samples && picture->noise[i] > noise;
}

void render_faults_say(const RenderFaults *faults, const Options *options)
{
    if (options->quiet)
        return;
    if ((double)faults->unresolved > SEEN * (double)faults->rays)
        say("warning: %llu of %llu rays (%.2g %%) ran out of steps, so pixels are wrong; a "
            "distance that is far too "
            "small makes steps short: is a `slope` larger than need be?",
            (unsigned long long)faults->unresolved, (unsigned long long)faults->rays,
            100.0 * (double)faults->unresolved / (double)faults->rays);
    if (faults->noisy > 0)
        say("warning: %llu of %llu pixels (%.2g %%) have more noise than %g after all %u samples; "
            "more --samples "
            "make it less",
            (unsigned long long)faults->noisy, (unsigned long long)faults->pixels,
            100.0 * (double)faults->noisy / (double)faults->pixels, faults->noise, faults->samples);
}
