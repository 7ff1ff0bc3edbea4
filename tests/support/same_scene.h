/*
 * same_scene.h: whether two compiled scenes are the same, to the last bit.
 */
#ifndef KRS_SAME_SCENE_H
#define KRS_SAME_SCENE_H

#include <stdbool.h>

#include "krs/krs.h"

/* The texts of what shaders call, without comments. */
bool same_shaders(const KrsScene *a, const KrsScene *b);
/* Distances at many points. */
void assert_same_distances(const KrsScene *a, const KrsScene *b);
/* Texts, tables, distances at many points, and the first camera. */
void assert_same_scene(const KrsScene *a, const KrsScene *b);

#endif
