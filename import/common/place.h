/*
 * place.h: affine maps of imported files, as methods of the language.
 */
#ifndef KRS_IMPORT_PLACE_H
#define KRS_IMPORT_PLACE_H

#include "import/common/text.h"

/* The point q goes to rows q + shift. */
typedef struct Place {
    double rows[3][3];
    double shift[3];
} Place;

Place place_identity(void);
Place place_move(const double by[3]);
Place place_scale(const double by[3]);
/* About x (0), y (1) or z (2), by radians, from each axis to the next one. */
Place place_rotate(int axis, double angle);
/* First `first`, then `then`. */
Place place_chain(const Place *first, const Place *then);
/* The same map seen in a mirror that changes the sign of z. */
Place place_mirrored(const Place *place);
/* False: it flattens space. */
bool place_invert(Place *place);
void place_apply(const Place *place, const double q[3], double to[3]);
/* The factor by which all lengths grow; 0 where it differs by direction. */
double place_factor(const Place *place);
/* Whether figures in x and y stay there; makes it the plain map of space that
 * does the same. */
bool place_flatten(Place *place);

/* Adds `.scale(...).rotate(...).move(...)`, as much of it as is needed; false
   when the place flattens space to a plane, or is larger or smaller than
   numbers allow. */
bool place_write(Text *text, const Place *place);

#endif
