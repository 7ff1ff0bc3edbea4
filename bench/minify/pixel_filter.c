/*
 * pixel_filter.c: the box of a pixel, and Gaussians over 3x3 pixels.
 *
 * A Gaussian shares each sample with the pixels around it.  That averages what is finer than a
 * pixel, and blurs what is not; so the truth is filtered as well, and what is left is noise.  The
 * samples are the middles of a pixel or of its quarters, as they are in pictures of one sample and
 * about as they are in those of four.
 */
#include "bench/minify/pixel_filter.h"

#include <math.h>
#include <stdlib.h>

#include "compiler/base/srgb.h"
#include "runtime/display/display.h"

typedef struct Filter {
    double sigma, radius; /* in pixels; sigma 0: the box */
} Filter;
static const Filter filters[] = {{0, 0.5}, {0.5, 1.5}, {0.7, 1.5}};
enum { FILTERS = sizeof filters / sizeof *filters };

/* A filtered picture: linear light and alpha. */
typedef struct Filtered {
    uint32_t width, height;
    double (*pixels)[4];
} Filtered;

/* Returns the weight as renderers have it: less what it is at the radius, so that it ends at 0. */
static double weight(Filter filter, double distance)
{
    if (fabs(distance) >= filter.radius)
        return 0;
    if (filter.sigma == 0)
        return 1;
    double scale = -0.5 / (filter.sigma * filter.sigma);
    return exp(scale * distance * distance) - exp(scale * filter.radius * filter.radius);
}

/* Along one side: the samples from `REACH` before a pixel to as many behind its first, by number;
   those that are not among the few weigh nothing. */
enum { REACH = FINE + FINE / 2, SPAN = 2 * REACH + FINE };

static void weigh(Filter filter, int step, double weights[SPAN])
{
    for (int i = 0; i < SPAN; i++) {
        /* The middle of a square of samples is between the two in its middle. */
        double place = (i - REACH + (step == 1 ? 0.5 : 0)) / FINE;
        bool   taken = i % step == (REACH + step / 2) % step;
        weights[i]   = taken ? weight(filter, place - 0.5) : 0;
    }
}

static void filter_pixel(const KrsPicture *fine, const double weights[SPAN], int x, int y,
                         double pixel[4])
{
    double sum = 0;
    for (int j = 0; j < SPAN; j++)
        for (int i = 0; i < SPAN; i++) {
            double share = weights[i] * weights[j];
            int    row = y * FINE + j - REACH, column = x * FINE + i - REACH;
            if (share == 0 || row < 0 || column < 0 || row >= (int)fine->height ||
                column >= (int)fine->width)
                continue;
            const float *color = &fine->color[4 * ((size_t)row * fine->width + (size_t)column)];
            for (int k = 0; k < 4; k++)
                pixel[k] += share * color[k];
            sum += share;
        }
    for (int k = 0; k < 4; k++)
        pixel[k] /= sum;
}

/* Filters a picture by the middles of squares of `step` samples. */
static Filtered filter_picture(const KrsPicture *fine, Filter filter, int step)
{
    Filtered picture = {.width = fine->width / FINE, .height = fine->height / FINE};
    double   weights[SPAN];
    weigh(filter, step, weights);
    picture.pixels = calloc((size_t)picture.width * picture.height, sizeof *picture.pixels);
    if (!picture.pixels) {
        fputs("minify: out of memory\n", stderr);
        exit(1);
    }
    for (uint32_t i = 0; i < picture.width * picture.height; i++)
        filter_pixel(fine, weights, (int)(i % picture.width), (int)(i / picture.width),
                     picture.pixels[i]);
    return picture;
}

/* Root mean square of what a screen shows, over the pixels that show something in either. */
static double error_of(const Filtered *picture, const Filtered *truth)
{
    double sum   = 0;
    size_t count = 0;
    for (uint32_t i = 0; i < truth->width * truth->height; i++) {
        const double *found = picture->pixels[i], *right = truth->pixels[i];
        double        shown[3], wanted[3];
        if (found[3] == 0 && right[3] == 0)
            continue;
        tone_map_apply(TONE_NEUTRAL, found, shown);
        tone_map_apply(TONE_NEUTRAL, right, wanted);
        for (int k = 0; k < 3; k++)
            sum += pow(255 * (srgb_of_linear(shown[k]) - srgb_of_linear(wanted[k])), 2);
        count += 3;
    }
    return sqrt(sum / (double)(count ? count : 1));
}

void pixel_filter_titles(const Sheet *sheet)
{
    sheet_print(sheet,
                "\nErrors of few samples by the filter of pixels, each against what that"
                " filter makes of %d samples; `sharp`: against the box's\n\n"
                "| scene | samples | box |",
                FINE * FINE);
    for (int f = 1; f < FILTERS; f++)
        sheet_print(sheet, " Gaussian %g | box / it | sharp |", filters[f].sigma);
    sheet_print(sheet, "\n| --- | --- | --- |");
    for (int f = 1; f < FILTERS; f++)
        sheet_print(sheet, " --- | --- | --- |");
    sheet_print(sheet, "\n");
}

void pixel_filter_rows(const Sheet *sheet, const char *scene, const KrsPicture *fine)
{
    Filtered truths[FILTERS];
    for (int f = 0; f < FILTERS; f++)
        truths[f] = filter_picture(fine, filters[f], 1);
    for (int side = 1; side <= 2; side++) {
        double box = 0;
        sheet_print(sheet, "| %s | %d |", scene, side * side);
        for (int f = 0; f < FILTERS; f++) {
            Filtered picture = filter_picture(fine, filters[f], FINE / side);
            double   error   = error_of(&picture, &truths[f]);
            box              = f == 0 ? error : box;
            sheet_print(sheet, " %.2f |", error);
            if (f > 0)
                sheet_print(sheet, " %.2f | %.2f |", box / error, error_of(&picture, &truths[0]));
            free(picture.pixels);
        }
        sheet_print(sheet, "\n");
    }
    for (int f = 0; f < FILTERS; f++)
        free(truths[f].pixels);
}
