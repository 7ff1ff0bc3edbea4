/*
 * ray_images.h: images of rays and balls in maps that invert.
 */
#ifndef KRS_RAY_IMAGES_H
#define KRS_RAY_IMAGES_H

#include "compiler/lower/along_method.h"
#include "compiler/shape/shape.h"

struct LoweredCrowds; /* crowd.h */

/* lower_along() by the method ALONG_DIRECTIONAL or ALONG_PROBE. */
Node lower_image(Graph *graph, const Shape *shape, Node plain, AlongMethod method,
                 struct LoweredCrowds *crowds, Arena *scratch);

#endif
