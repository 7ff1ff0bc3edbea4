/*
 * known_solid.h: random solids of which two things are known: their text, and a number for each
 * point that is negative inside and positive outside.
 *
 * Those numbers are found here, by the meaning of each word (docs/language.md), and share nothing with
 * the compiler.  They are distances where the words that follow ask for distances: blends, shells.
 */
#ifndef ORACLE_KNOWN_SOLID_H
#define ORACLE_KNOWN_SOLID_H

#include "tests/oracle/product.h"

typedef struct KnownSolid KnownSolid;

/* Returns a solid within the cube around the origin with sides of 4; its parts are thicker than
   `thick`, as far as they do not come so near to each other that others become of them.  For
   known_solid_free. */
KnownSolid *known_solid_random(Random *random, double thick);
void        known_solid_free(KnownSolid *solid);

/* Its expression. */
void known_solid_write(const KnownSolid *solid, SceneText *text);
/* Returns the value of `user`, a KnownSolid: below 0 inside. */
double known_solid_value(const void *user, Vec point);

#endif
