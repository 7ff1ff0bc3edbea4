/*
 * measure.h: times, medians and straight lines.
 */
#ifndef KRS_BENCH_MEASURE_H
#define KRS_BENCH_MEASURE_H

#include "krs/vulkan.h"

/* What one picture took, in milliseconds; only doubles, so that medians are taken of all alike. */
typedef struct Times {
    double phase[KRS_PHASE_COUNT]; /* on the device, by its own clock where it has one */
    double total;                  /* their sum */
    double wall;                   /* from the call to the picture in memory of the host */
    double cpu;                    /* of all threads of the process, in and out of the shader */
} Times;

/* Less what hand-written shaders do not do either: shadows and occlusion. */
double times_without_secondary(const Times *times);

/* Member by member the median of so many; an even number has the mean of the middle two. */
Times times_median(const Times *times, size_t count);

/* Returns the least that any of so many took, without shadows and occlusion: what disturbs a run
   only makes it longer, so this tells more when the machine was busy with other things as well. */
double times_least(const Times *times, size_t count);

/* Returns the median of so many numbers, which are put into order. */
double median(double *numbers, size_t count);

/* Milliseconds that the threads of this process have computed. */
double cpu_ms(void);

/* The straight line nearest to the points, by least squares, and its coefficient of
   determination. */
typedef struct Line {
    double slope, intercept, r2;
} Line;
Line line_through(const double *x, const double *y, size_t count);

#endif
