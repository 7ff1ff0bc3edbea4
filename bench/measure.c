/*
 * measure.c: medians member by member, and what else becomes of several runs.
 */
#include "bench/measure.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

enum { MEMBERS = sizeof(Times) / sizeof(double), MAX_RUNS = 64 };

double times_without_secondary(const Times *times)
{
    return times->total - times->phase[KRS_PHASE_SHADOWS] - times->phase[KRS_PHASE_OCCLUSION];
}

static int compare_numbers(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double median(double *numbers, size_t count)
{
    qsort(numbers, count, sizeof *numbers, compare_numbers);
    return (numbers[(count - 1) / 2] + numbers[count / 2]) / 2;
}

Times times_median(const Times *times, size_t count)
{
    assert(count > 0 && count <= MAX_RUNS);
    double middle[MEMBERS];
    for (size_t member = 0; member < MEMBERS; member++) {
        double column[MAX_RUNS];
        for (size_t run = 0; run < count; run++)
            memcpy(&column[run], (const char *)&times[run] + member * sizeof(double),
                   sizeof(double));
        middle[member] = median(column, count);
    }
    Times medians;
    memcpy(&medians, middle, sizeof medians);
    return medians;
}

double times_least(const Times *times, size_t count)
{
    double least = times_without_secondary(&times[0]);
    for (size_t run = 1; run < count; run++)
        least = fmin(least, times_without_secondary(&times[run]));
    return least;
}

static double milliseconds(struct timeval time)
{
    return (double)time.tv_sec * 1e3 + (double)time.tv_usec / 1e3;
}

double cpu_ms(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return milliseconds(usage.ru_utime) + milliseconds(usage.ru_stime);
}

Line line_through(const double *x, const double *y, size_t count)
{
    double mean_x = 0, mean_y = 0, xx = 0, xy = 0, yy = 0;
    for (size_t i = 0; i < count; i++) {
        mean_x += x[i] / (double)count;
        mean_y += y[i] / (double)count;
    }
    for (size_t i = 0; i < count; i++) {
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        xy += (x[i] - mean_x) * (y[i] - mean_y);
        yy += (y[i] - mean_y) * (y[i] - mean_y);
    }
    double slope = xy / xx;
    return (Line){slope, mean_y - slope * mean_x, yy > 0 ? xy * xy / (xx * yy) : 1};
}
