/*
 * ray_images.h: images of rays and balls in maps that invert.
 */
#ifndef KRS_RAY_IMAGES_H
#define KRS_RAY_IMAGES_H

#include "compiler/lower/along_method.h"
#include "compiler/shape/shape.h"

struct LoweredGroups; /* instance_groups.h */

/* lower_along() by the method ALONG_DIRECTIONAL or ALONG_PROBE. */
Node lower_image(Graph *graph, const Shape *shape, Node plain, AlongMethod method,
                 struct LoweredGroups *groups, Arena *scratch);

#endif
