/*
 * field.h: what is known of a solid: a number at a point, and ranges of it in a box.
 *
 * Its sign says what is solid (negative inside), and its size is never above the distance to the
 * nearest surface.  Nothing else here asks the scene.
 *
 * Questions are answered by lane tapes (graph/lanes/lanes.h).  Who asks much within one box enters it: the lane
 * tape is then pruned to that box.  Answers are the same, bit for bit.
 */
#ifndef KRS_FIELD_FIELD_H
#define KRS_FIELD_FIELD_H

#include "compiler/field/solid.h"
#include "compiler/graph/lanes/lanes.h"

/* A box that was entered, and its lane tape. */
typedef struct FieldRegion {
    Box      box;
    LaneTape tape;
    char    *memory; /* of the tape */
    size_t   used;
} FieldRegion;

enum { MAX_REGIONS = 8, MAX_FIELD_POINTS = LANES };

/* A field for one thread. */
typedef struct MeshField {
    KrsState        *state; /* its own */
    const MeshSolid *solid;
    bool             cut; /* nothing is solid outside of the box */
    double           low[3], high[3];
    double           skin; /* what is solid is thicker by that at points, not in boxes */

    LaneTape     tape;
    LaneWork     work;
    LaneRanges   ranges;
    LaneSlope   *slopes;
    LaneHessian *hessians;
    FieldRegion  regions[MAX_REGIONS]; /* each within the one before */
    size_t       region_count, region_bytes;
    FieldRegion  pieces; /* of field_pieces */
    char        *spare;  /* as much memory as that of a region */
} MeshField;

/* Makes what a field needs to answer; frame, solid and box are set, and the frame is up to date. */
void field_open(MeshField *field, Arena *arena);

/* Enters a box, of which only what is within the last one entered is looked at, and leaves it.  False: there is
   no surface in it, and it was not entered.  Where little would be pruned the tape stays, and true only means that
   nothing is known. */
bool field_enter(MeshField *field, Box box);
/* Enters it in any case; or unless the tape is short. */
void field_focus(MeshField *field, Box box);
void field_narrow(MeshField *field, Box box);
void field_leave(MeshField *field);
/* Returns the tape of the box that was entered last. */
const LaneTape *field_tape(const MeshField *field);

/* Finds distances at up to MAX_FIELD_POINTS points. */
void   field_distances(const MeshField *field, const double (*points)[3], size_t count,
                       double *distances);
double field_distance(const MeshField *field, const double point[3]);
/* Finds the unit gradient, by differences over `step`; false and 0 where there is none. */
bool field_normal(const MeshField *field, const double point[3], double step, double normal[3]);

/* Returns the range of all values in a box. */
Range field_range(const MeshField *field, Box box);
/* Finds that and the ranges of the derivatives by x, y and z; false: there are none, or no value is
   0. */
bool field_slope(const MeshField *field, Box box, Range *range, LaneSlope *slope);
/* Tells where the distance comes from in the box that was entered last, as LaneStep has it. */
uint32_t field_origin(const MeshField *field, Box box);
/* Finds these and the ranges of the second derivatives; false: there are none, or the first may
   jump. */
bool field_hessian(const MeshField *field, Box box, Range *range, LaneSlope *slope,
                   LaneHessian *hessian);

/* Tells whether what cuts the components may be what is least in the box. */
bool field_is_cut(const MeshField *field, Box box);
/* Keeps values of the tape that was entered last, to be found at points. */
bool field_keep(MeshField *field, uint32_t *outputs, size_t count);

enum { MAX_PIECES = 8, MAX_PIECE_STEPS = 32, PIECE_VALUES = 4 };

/* A number that has the sign of the distance in a box, and is as often 0: made of pieces whose
   derivatives do not jump by minima and maxima.  It is told in the order of a stack: a number of a
   piece, or one of these. */
enum { PIECE_MIN = -1, PIECE_MAX = -2 };
typedef struct FieldPieces {
    uint32_t origin; /* if it is one piece: of its step, as of LaneStep; else 0 */
    int      side; /* -1 or 1: there are no pieces, since it is nowhere above or below 0; else 0 */
    size_t   count, step_count;
    int      steps[MAX_PIECE_STEPS];
    /* a piece is sign times a sum of values times weights, and the offset; derivatives are those of the sum */
    double      signs[MAX_PIECES], offsets[MAX_PIECES], weights[MAX_PIECES][PIECE_VALUES];
    uint32_t    values[MAX_PIECES]; /* how many there are in its sum */
    LaneSlope   slopes[MAX_PIECES];
    LaneHessian hessians[MAX_PIECES];
} FieldPieces;

/* Finds the pieces in the box that was entered last; false: it is not made like that. */
bool field_pieces(MeshField *field, Box box, FieldPieces *pieces);
/* Returns -1 or 1 where pieces tell that all of a box of the region is inside or outside; 0: they
   do not. */
int field_side(MeshField *field, Box box);
/* Computes the values of pieces at up to MAX_FIELD_POINTS points in that box: values[i * count] and
   so on are those of point i. */
void field_piece_values(const MeshField *field, const FieldPieces *pieces,
                        const double (*points)[3], size_t point_count, double *values);

/* Finds the slopes of the first piece, before its sign, in a part of that box which is no point; as
   of lane_slopes_run. */
bool field_piece_slope(const MeshField *field, const FieldPieces *pieces, Box part,
                       LaneSlope *slope);

enum { MAX_FACES = 8 };

/* Operands of a lane tape. */
typedef struct FieldFaces {
    uint32_t operands[MAX_FACES];
    size_t   count;
} FieldFaces;

/* Distances to boxes are length(max(q, 0)) + part min(greatest q, 0), or nearly so.  Adds all q of either part, after a
   run of ranges, and multiplies the part by its factor; false: it is none. */
bool field_outside(const LaneTape *tape, const LaneRanges *ranges, uint32_t operand,
                   FieldFaces *faces);
bool field_inside(const LaneTape *tape, const LaneRanges *ranges, uint32_t operand,
                  FieldFaces *faces, double *part);
bool field_has_face(const FieldFaces *faces, uint32_t operand);

/* Tells whether a step takes the greater or the lesser of two numbers. */
bool field_is_greater(const LaneStep *step);
bool field_is_lesser(const LaneStep *step);

#endif
