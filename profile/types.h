/*
 * types.h: what is found of the parts of a scene.
 */
#ifndef KRS_PROFILE_TYPES_H
#define KRS_PROFILE_TYPES_H

#include "krs/vulkan.h"
#include "profile/parts.h"

/* The cost of a point of the distance, and the length of its text. */
typedef struct PartCost {
    double flops, operations, glsl_bytes;
} PartCost;

/* A row of a profile: a part, or what is left of it beside parts that have rows. */
typedef struct ProfileRow {
    const Part *part; /* NULL: all others, and what belongs to no part */
    bool        rest;
    double      ms; /* that a frame takes longer because of it; below 0: what it hides takes more */
    double      share; /* of the frame; those of the rows up to the others are 1 */
    PartCost    cost;  /* that it adds */
} ProfileRow;

typedef struct Profile {
    double      frame_ms;
    bool        of_processors; /* times are those of processors */
    uint32_t    width, height;
    KrsPicture *picture; /* of the whole scene: its colour and depth */
    uint32_t   *row_of; /* for each pixel: the row from 1 of the part that is seen there; 0: none */
    PartCost    whole;
    ProfileRow *
        rows; /* the greatest share first, up to the others; then what several of these have in common */
    size_t row_count, others; /* all; the index of the others */
    size_t timed, untimed; /* parts for which there was time; and parts for which there was none */
} Profile;

/* Parts below this share of the frame have no row of their own. */
#define PROFILE_MIN 0.02

#endif
