/*
 * albedos.h: how much light rough surfaces reflect, where they mirror all of it.
 *
 * tools/albedo_tables.c writes the tables when krs is built.
 */
#ifndef KRS_ALBEDOS_H
#define KRS_ALBEDOS_H

#include "runtime/shared/blocks.h"

/* The reflected share of GGX; the part of it that Schlick's factor (1 - cosine)^5 weights; and the share of
   sheen, which may be above 1.  Columns are the square roots of cosines, rows are roughnesses, both from 0 to 1
   in ALBEDO_SIDE steps.  Those of sheen begin at MIN_SHEEN_ROUGHNESS (bsdf.glsl). */
extern const float albedos[ALBEDO_ROWS][RESULT_NUMBERS];

/* The albedos of microfacets that are wider along a tangent, in thousandths: the reflected share at
   azimuths whose squared cosines are 0, 1/3, 2/3 and 1, and the part of it that Schlick's factor
   weights.  Cosines, whose square roots are from 0 to 1, follow each other, for each roughness, and
   for each anisotropy all of these. */
enum { WIDE_AZIMUTHS = 4 };
extern const uint16_t wide_albedos[WIDE_ALBEDO_ROWS][2 * WIDE_AZIMUTHS];

#endif
