/*
 * panels.h: what stands over the picture.
 */
#ifndef KRS_PANELS_H
#define KRS_PANELS_H

#include "live/viewing.h"

void panels_draw(Viewing *viewing);

#endif
