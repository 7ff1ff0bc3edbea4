/*
 * scattered.c: points in the boxes of components, and near surfaces.
 */
#include "tests/support/scattered.h"

#include <math.h>
#include <stdlib.h>

void scatter(const KrsScene *scene, Random *random, float (*points)[4], size_t count)
{
    const size_t components = krs_component_count(scene);
    for (size_t i = 0; i < count; i++) {
        KrsComponent component = {.low = {-2, -2, -2}, .high = {2, 2, 2}};
        krs_component(scene, components ? i % components : 0, &component);
        points[i][3] = 0;
        for (int k = 0; k < 3; k++) {
            double low = fmax(component.low[k], -10), high = fmin(component.high[k], 10);
            double margin = 0.2 * fmax(high - low, 0) + 0.1;
            points[i][k]  = (float)random_between(random, low - margin, fmax(high, low) + margin);
        }
    }
}

void bring_near(KrsState *state, Random *random, float (*points)[4], size_t count)
{
    enum { STEPS = 8 };
    double(*places)[3]  = malloc(count * sizeof *places);
    double(*normals)[3] = malloc(count * sizeof *normals);
    double *distances   = malloc(count * sizeof *distances);
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            places[i][k] = points[i][k];
    for (int step = 0; step < STEPS; step++) {
        if (krs_distance(state, (const double(*)[3])places, count, distances) != KRS_OK ||
            krs_normal(state, (const double(*)[3])places, count, normals) != KRS_OK)
            break;
        for (size_t i = 0; i < count; i++) {
            double off = step == STEPS - 1 ? distances[i] + random_between(random, -0.01, 0.01)
                                           : distances[i];
            for (int k = 0; k < 3 && fabs(off) < 100; k++)
                places[i][k] -= isfinite(normals[i][k]) ? off * normals[i][k] : 0;
        }
    }
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            points[i][k] = (float)places[i][k];
    free(places);
    free(normals);
    free(distances);
}
