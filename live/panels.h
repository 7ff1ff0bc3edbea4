/*
 * panels.h: what stands over the picture.
 */
#ifndef KRS_PANELS_H
#define KRS_PANELS_H

#include "live/viewing.h"

void panels_draw(Viewing *viewing);
/* Tells how much of the window, at its right, is theirs: the picture stands beside it. */
double panels_width(const Viewing *viewing);

#endif
