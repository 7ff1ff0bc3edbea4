/*
 * device_answers.h: what the device answers about points and rays of a scene, held against the
 * evaluator in double precision.
 *
 * Rays are not compared with another march but with what the evaluator says along them: where a ray
 * is said to hit there is a surface, and before that, at many places, there is none.
 */
#ifndef ORACLE_DEVICE_ANSWERS_H
#define ORACLE_DEVICE_ANSWERS_H

#include "krs/vulkan.h"
#include "tests/support/random.h"

typedef struct Scene {
    KrsScene     *scene;
    KrsState     *state;
    KrsRendering *rendering;
} Scene;

Scene scene_ready(KrsStatus status, KrsScene *scene, KrsPurpose purpose);
Scene scene_of(const char *text, KrsPurpose purpose);
void  scene_close(Scene s);

/* ---- questions and answers ---- */

extern Random chance;
double        uniform(double low, double high);
double        length3(const double v[3]);

enum { MOST = 40000 };
extern double points[MOST][3], aims[MOST][3];
extern KrsHit found[MOST];
#define POINTS ((const double(*)[3])points)
#define AIMS   ((const double(*)[3])aims)

void probe_device(Scene s, size_t count);
void cast_device(Scene s, size_t count, double farthest, double tolerance);

/* ---- comparisons ---- */

/* The evaluator's answers at points that single precision has, too. */
void points_agree(Scene s, size_t count, double size, double roughness);

/* Random rays near the scene, answered and checked. */
void rays_agree(Scene s, size_t count, double size, double tolerance, double roughness);

#endif
