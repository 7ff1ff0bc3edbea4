/*
 * closed_forms.h: random shapes whose surfaces have closed forms, for tests that need the truth at any point.
 */
#ifndef UNIT_CLOSED_FORMS_H
#define UNIT_CLOSED_FORMS_H

#include <stdbool.h>

#include "krs/krs.h"
#include "tests/support/random.h"

typedef enum Form { BALL, RING, EQUATION, CAN, CONE, BLOCK, FORMS } Form;
typedef enum CsgNode { ALONE, UNION, INTERSECTION, DIFFERENCE, BLEND, CSG_NODES } CsgNode;

typedef struct Body {
    Form   form;
    double size[3], axis[3], angle, move[3]; /* turned by the angle, in degrees, then moved */
    double rows[3][3];                       /* take a point back to before it was turned */
} Body;

typedef struct Subject {
    CsgNode csg_node;
    Body    bodies[2];
    double  width; /* of the blend */
} Subject;

/* What random subjects are made of. */
typedef struct Kind {
    const Form    *forms;
    int            form_count;
    const CsgNode *csg_nodes;
    int            csg_node_count;
} Kind;

/* Half of the CSG nodes are of two that nearly have one surface, whose edges are blunt. */
Subject random_subject(Random *random, const Kind *kind);
/* Returns the same as a scene. */
KrsState *state_of_subject(const Subject *subject, KrsScene **scene);

/* Returns a number with the sign of the distance, whose slope is 1 at most, so that it is nowhere
   more than the distance.  Where there are no edges it is the distance, unless it is that of an
   equation or a blend. */
double subject_value(const Subject *subject, const double point[3]);
/* By differences. */
void subject_gradient(const Subject *subject, const double point[3], double gradient[3]);
/* A point of the surface, by Newton's steps from one beside it; false: none was found. */
bool random_surface_point(Random *random, const Subject *subject, double p[3]);

#endif
