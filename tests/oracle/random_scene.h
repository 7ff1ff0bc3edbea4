/*
 * random_scene.h: texts of random scenes: solids that are moved, changed and reflected in
 * sequences, and an eye that sees them.
 */
#ifndef ORACLE_RANDOM_SCENE_H
#define ORACLE_RANDOM_SCENE_H

#include "tests/oracle/product.h"

Vec any_vec(Random *random, double size);
/* Solids around `at`, as large as `size`, and an eye that sees them. */
void write_random_scene(SceneText *text, Random *random, Vec at, double size);

#endif
