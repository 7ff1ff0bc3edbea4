/*
 * cut.h: what is cut away to look inside: a plane, and a ball, which the mouse moves.
 *
 * Both are zones of the library, which are balls: a plane is one that is so large that nobody sees
 * that it is round.
 */
#ifndef KRS_CUT_H
#define KRS_CUT_H

#include <stdbool.h>
#include <stddef.h>

#include "krs/krs.h"

typedef struct Cut {
    bool   plane, ball;
    double point[3], normal[3]; /* of the plane: what is on the side of the normal is cut away */
    double center[3], radius;   /* of the ball */
    double size;                /* of the scene: its diagonal */
} Cut;

/* Cuts by a plane through a point that faces a camera. */
void cut_face(Cut *cut, const KrsCamera *camera, const double point[3]);
/* Moves the ball with the mouse, or where there is none the plane along its normal; in parts of the
   picture's height, to the right and upwards. */
void cut_drag(Cut *cut, const KrsCamera *camera, double right, double up);
/* Adds the zones behind `count` that are there already, as far as there is room; returns how many
   there are. */
size_t cut_zones(const Cut *cut, double (*zones)[4], size_t count);

#endif
