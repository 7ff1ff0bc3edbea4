/*
 * grid_halve.h: a cubic cell is halved along each axis: which instances of its list change a blend in each part.
 */
#ifndef KRS_GRID_HALVE_H
#define KRS_GRID_HALVE_H

#include "compiler/graph/instances/grid_blend.h"

/* Bit k of a part's number is its place along axis k. */
enum { GRID_PARTS = 8 };

typedef struct Halver {
    const GridBlend *blend;
    double           pad; /* how far from its cell single precision may find a point */
} Halver;

/* The memory of one processor. */
typedef struct HalvingDesk {
    void *rows;                      /* of lanes */
    double (*distances)[GRID_PARTS]; /* of each instance of the list at hand */
} HalvingDesk;

typedef struct Halving {
    double          low[3], size;
    const uint32_t *instances, *places; /* instances[places[i]], count of them */
    uint32_t        count;
    double          clearance; /* of results that are greater nothing need be right */
    double          share;     /* of what is left out of a blend that fades, in all halvings */
    double          least[GRID_PARTS]; /* found: no result in a part is less */
} Halving;

/* Makes a desk for lists of up to `most` instances. */
HalvingDesk halving_desk_new(const GridBlend *blend, uint32_t most, Arena *scratch);
double      halving_pad(const Grid *grid);

/* Finds the distances of an instance at points. */
void halving_distances(const Halver *halver, const HalvingDesk *desk, size_t instance,
                       const double (*points)[3], size_t count, double *distances);

/* Sets bit k of needs[i] where part k needs instance i of the list. */
void grid_halve(const Halver *halver, const HalvingDesk *desk, uint8_t *needs, Halving *h);

/* Returns the clearance of a part without instances. */
double halving_emptied(const Halving *h, int part);

#endif
