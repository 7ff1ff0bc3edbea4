/*
 * flat_rounds.h: decides how many sides the polygons have that approximate circles, and how far
 * chords are from curves.
 *
 * A circle becomes a polygon whose sides have equal angles.  Its corners on the axes are on the
 * circle, so that what touches it there still does; the others are as far outside as sides are
 * within.  Steps of a lane tape that are kin have the same number of sides everywhere, as many as
 * the largest radius of the surface needs; where that is not enough, only those of these instances
 * have more.  The chords of an outline are near enough to its curves everywhere, too.
 */
#ifndef KRS_MESH_FLAT_ROUNDS_H
#define KRS_MESH_FLAT_ROUNDS_H

#include "compiler/graph/lanes/lanes.h"
#include "mesh/common/numbering.h"

typedef struct FlatRound {
    double   radius; /* of curves: how long a length of 1 in their plane is in the scene */
    bool     curves;
    bool     shared; /* the error is shared with another circle */
    uint32_t like;   /* the round that has its radius, and tells whether it is shared: of its kin */
    double   part;   /* of the error that its sides may take */
    double   saved;  /* that part, when it was saved */
    bool     blamed; /* the part was too large somewhere */
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
    bool   blame;                    /* rounds that are noted are blamed */
} FlatRounds;

/* Returns the radius of corners off the axes, of a polygon with so many sides, a multiple of four,
   for a circle of radius 1. */
double flat_corner_radius(uint32_t sides);
/* Returns the least distance of the sides of a polygon whose corners off the axes have the radius
   `wide`. */
double flat_side_distance(uint32_t sides, double wide);

FlatRounds flat_rounds_new(double error, Arena *arena);
/* Notes that the surface has a part of a circle. */
void flat_rounds_note(FlatRounds *rounds, const LaneStep *step, double radius, bool shared);
/* Notes that the surface has curves of an outline; a length of 1 in its plane is at most `length`
   in the scene. */
void flat_rounds_note_curves(FlatRounds *rounds, uint32_t table, double length, bool shared);
/* Finds the numbers of sides, after all are noted. */
void flat_rounds_count(FlatRounds *rounds);
/* Blames all that are kin of those that are blamed. */
void flat_rounds_blame_kin(FlatRounds *rounds);
/* Makes those finer that are blamed; returns false if all are as fine as is of use. */
bool flat_rounds_refine(FlatRounds *rounds);
/* These save how fine all are, and restore that. */
void flat_rounds_save(FlatRounds *rounds);
void flat_rounds_restore(FlatRounds *rounds);
bool flat_rounds_has_curves(const FlatRounds *rounds);
/* Returns the number of sides; 0 if it has not been noted. */
uint32_t flat_rounds_sides(const FlatRounds *rounds, const LaneStep *step);
/* Returns the largest radius that was noted, in lengths of the scene; 0 if none was. */
double flat_rounds_radius(const FlatRounds *rounds, uint32_t kin);
/* Returns how far chords of an outline may be from its curves; infinite until all are noted. */
double flat_rounds_chord(const FlatRounds *rounds, uint32_t table);

/* Make ranges hold for polygons, too; and for the scene alone again. */
void flat_rounds_open(const FlatRounds *rounds, LaneRanges *ranges);
void flat_rounds_close(LaneRanges *ranges);

#endif
