/*
 * flat_rounds.h: how many sides the polygons have that stand for circles, and how far chords are from curves.
 *
 * The length of a pair of numbers is taken for that of a polygon whose sides have equal angles.  Its corners on the axes are on
 * the circle, so that what touches it there still does; the others are as far outside as sides are within.  Steps of a lane tape that are kin have the same number of sides everywhere, as the largest radius needs that
 * the surface has.  So have the curves of an outline chords that are near enough everywhere.
 */
#ifndef KRS_MESH_FLAT_ROUNDS_H
#define KRS_MESH_FLAT_ROUNDS_H

#include "compiler/graph/lanes/lanes.h"
#include "mesh/common/numbering.h"

typedef struct FlatRound {
    double   radius; /* of curves: how much of the scene a length of their plane is */
    bool     curves;
    bool     shared; /* the error is shared with another circle */
    double   part;   /* of the error that its sides may take */
    double   kept;   /* that part, when it was kept */
    bool     blamed; /* that was too much somewhere */
    uint32_t sides;
    double   chord; /* how far chords may be from curves, in lengths of their plane */
} FlatRound;

typedef struct FlatRounds {
    Arena    *arena;
    Numbering numbers; /* by what is kin */
    struct {
        FlatRound *items;
        size_t     count, capacity;
    } list;
    double error;                    /* how far sides may be from the circle */
    double stretch, longest, chords; /* as of LaneRanges */
    bool   counted;                  /* sides are known; until then there are few */
    bool   blame;                    /* those that are noted are blamed */
} FlatRounds;

/* How far corners of a polygon of so many sides are that are not on the axes, of a circle of radius 1; a multiple of four. */
double flat_corner_radius(uint32_t sides);
/* How far the sides of a polygon are whose corners are so far; 1: on the circle. */
double flat_side_distance(uint32_t sides, double wide);

FlatRounds flat_rounds_new(double error, Arena *arena);
/* Says that a surface has a part of a circle. */
void flat_rounds_note(FlatRounds *rounds, uint32_t kin, double radius, bool shared);
/* Says that a surface has curves of an outline; a length of its plane is at most so long in the scene. */
void flat_rounds_note_curves(FlatRounds *rounds, uint32_t table, double length, bool shared);
/* After all are noted. */
void flat_rounds_count(FlatRounds *rounds);
/* Makes those finer that are blamed; false: no more than that is of use. */
bool flat_rounds_refine(FlatRounds *rounds);
/* Keeps how fine all are, and makes them so again. */
void flat_rounds_keep(FlatRounds *rounds);
void flat_rounds_go_back(FlatRounds *rounds);
bool flat_rounds_has_curves(const FlatRounds *rounds);
/* 0: it has not been noted. */
uint32_t flat_rounds_sides(const FlatRounds *rounds, uint32_t kin);
/* The largest that has been noted, in lengths of the scene; 0: none has. */
double flat_rounds_radius(const FlatRounds *rounds, uint32_t kin);
/* How far chords of an outline may be from its curves; infinite until all are noted. */
double flat_rounds_chord(const FlatRounds *rounds, uint32_t table);

/* Has ranges hold for polygons, too, with instance groups unrolled; and for the scene alone again. */
void flat_rounds_open(const FlatRounds *rounds, LaneRanges *ranges);
void flat_rounds_close(LaneRanges *ranges);

#endif
