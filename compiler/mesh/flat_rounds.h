/*
 * flat_rounds.h: how many sides the polygons have that stand for circles.
 *
 * The length of a pair of numbers is taken for that of a regular polygon: its corners are on the circle, four of them on
 * the axes.  Steps of a lane tape that are kin have the same number of sides everywhere, as the largest radius needs that
 * the surface has.
 */
#ifndef KRS_MESH_FLAT_ROUNDS_H
#define KRS_MESH_FLAT_ROUNDS_H

#include "compiler/graph/lanes.h"
#include "compiler/mesh/numbering.h"

typedef struct FlatRound {
    double   radius;
    bool     shared; /* the error is shared with another circle */
    double   part;   /* of the error that its sides may take */
    bool     blamed; /* that was too much somewhere */
    uint32_t sides;
} FlatRound;

typedef struct FlatRounds {
    Arena    *arena;
    Numbering numbers; /* by what is kin */
    struct {
        FlatRound *items;
        size_t     count, capacity;
    } list;
    double error;            /* how far sides may be from the circle */
    double stretch, longest; /* as of LaneRanges */
    bool   counted;          /* sides are known; until then there are few */
    bool   blame;            /* those that are noted are blamed */
} FlatRounds;

FlatRounds flat_rounds_new(double error, Arena *arena);
/* Says that a surface has a part of a circle. */
void flat_rounds_note(FlatRounds *rounds, uint32_t kin, double radius, bool shared);
/* After all are noted. */
void flat_rounds_count(FlatRounds *rounds);
/* Makes those finer that are blamed; false: no more than that is of use. */
bool flat_rounds_refine(FlatRounds *rounds);
/* 0: it has not been noted. */
uint32_t flat_rounds_sides(const FlatRounds *rounds, uint32_t kin);

/* Has ranges hold for polygons, too, with crowds unrolled; and for the scene alone again. */
void flat_rounds_open(const FlatRounds *rounds, LaneRanges *ranges);
void flat_rounds_close(LaneRanges *ranges);

#endif
