/*
 * flat_forms.h: represents numbers in a box as sums of coordinates and of kinks.
 *
 * Each linear step of a lane tape is a form: a sum of coordinates, and of kinks, which are minima,
 * maxima, absolute values and lengths of forms.  A taper divides coordinates by a linear number:
 * the sign of such a form is that of its numerator.
 */
#ifndef KRS_MESH_FLAT_FORMS_H
#define KRS_MESH_FLAT_FORMS_H

#include "compiler/field/field.h"
#include "mesh/flat/flat_planes.h"
#include "mesh/flat/flat_rounds.h"

enum { MAX_KINKS = 6 };

/* A linear number, which is above 0 in the box. */
typedef struct Divisor {
    double by[3], at;
} Divisor;

/* The sum of by . p + at, which may be divided, and of kinks: results of steps, by their numbers as
   operands, the last ones first. */
typedef struct Form {
    bool     known, divided;
    double   by[3], at;
    Divisor  divisor;
    uint32_t kinks[MAX_KINKS];
    double   factors[MAX_KINKS];
    int      kink_count;
} Form;

/* The findings about one box. */
typedef struct Finding {
    const MeshField *field;
    const LaneTape  *tape;
    Box              box;
    double           size;
    Form            *forms;      /* of inputs and steps */
    int             *conditions; /* of each operand, where it is true; UNKNOWN: not asked yet */
    FlatRounds      *rounds;
    FlatPieces      *pieces;
    FlatUse          use;
    FlatSlack        slack;                /* of the form that is split */
    bool             chooses;              /* that form is a condition */
    uint32_t         max_used, max_around; /* of the sides of a polygon */
    bool             failed;
} Finding;

/* Half-spaces that differ by less than this part of the size are one. */
#define FLAT_ROUNDING 1e-11

void find_forms(Finding *f);
Form form_of_operand(const Finding *f, uint32_t operand);

Form form_constant(double number);
bool form_is_constant(const Form *form);
/* Returns a + factor b. */
Form form_sum(Form a, double factor, const Form *b);
Form form_scaled(double factor, const Form *form);
void form_drop_kink(Form *form, int i);
/* Tells whether a form is a kink plus a number. */
bool form_is_kink_alone(const Form *form);
/* Returns the range of what a form is divided by. */
Range form_divisor(const Finding *f, const Form *form);
/* Returns the largest slope of the linear part of a form. */
double form_slope(const Finding *f, const Form *form);
/* Returns the range of a form in the box, by the ranges of its kinks. */
Range form_range(const Finding *f, const Form *form);

static inline bool is_greater(const LaneStep *step)
{
    return step->op == OP_max || step->op == LANE_GREATER;
}
static inline bool is_lesser(const LaneStep *step)
{
    return step->op == OP_min || step->op == LANE_LESSER;
}

#endif
