/*
 * imported.h: files of other programs, imported and compiled in memory, for tests.
 */
#ifndef ORACLE_IMPORTED_H
#define ORACLE_IMPORTED_H

#include "krs/krs.h"
#include "tests/support/random.h"

/* What came of a file; valid until the next one. */
typedef struct Imported {
    KrsStatus   status;
    const char *scene, *refusal; /* texts; "" where there is none */
} Imported;

Imported imported(const char *path, const char *text);
/* The same with --keep-going. */
Imported imported_as_far_as_possible(const char *path, const char *text);

/* The distances of the scene that a text becomes; fails the test when it becomes none. */
void imported_distances(const char *path, const char *text, double (*points)[3], size_t count,
                        double *distances);

/* The first hits of rays with the scene that a text becomes, likewise. */
void imported_hits(const char *path, const char   *text, double (*origins)[3],
                   double (*directions)[3], size_t count, double farthest, KrsHit *hits);

/* Where a point of OpenSCAD is in the scene: its z is up, that of the scene is to the front. */
void upright_point(const double q[3], double p[3]);

/* Fails the test unless the text is refused with a line of it and these words: "3: no operation". */
void assert_refused(const char *path, const char *text, const char *words);

/* Fails the test unless the text becomes a scene that compiles, or is refused with one of its
   lines.  Returns whether it became a scene. */
bool assert_scene_or_line(const char *path, const char *text);

/* The same for texts that are cut and have bytes changed, left out and moved. */
void assert_damage_is_harmless(Random *random, const char *path, const char *text, int trials);

#endif
