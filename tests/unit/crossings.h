/*
 * crossings.h: whether triangles of a mesh go through each other.
 */
#ifndef UNIT_CROSSINGS_H
#define UNIT_CROSSINGS_H

#include <stdbool.h>

#include "compiler/passes/compile.h"

/* Tells whether an edge goes through a triangle that has none of its ends. */
bool crosses_itself(const KrsMesh *mesh);

#endif
