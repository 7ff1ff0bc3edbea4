/*
 * answers.h: the block in which point_query.comp answers about a point.
 *
 * C and GLSL read this one file, as they do blocks.h.
 */
#ifndef KRS_SHARED_ANSWERS_H
#define KRS_SHARED_ANSWERS_H

#include "runtime/shared/blocks.h"

#ifdef __STDC_VERSION__ /* C */
typedef unsigned int uvec4[4];
#endif

/* std430.  Each property of surface.def has a row of four numbers, of which it uses as many as it
   needs.  So both languages find each row at the same offset, whatever the types are. */
struct Answer {
    vec3  gradient; /* of the distance, a unit vector */
    float distance;
    vec3  normal; /* the normal for lighting */
    float surface_distance;
#define KRS_IDENTITY(name, type, shown, otherwise, nothing, blends)            uvec4 name;
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) vec4 name;
#include "krs/surface.def"
};

#ifdef __STDC_VERSION__
typedef struct Answer AnswerBlock;
static_assert(sizeof(AnswerBlock) % 16 == 0, "std430");
#endif

#endif
