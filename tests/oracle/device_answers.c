/*
 * device_answers.c: what the device answers about points and rays of a scene, held against the
 * evaluator in double precision.
 */
#include "tests/oracle/device_answers.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/support/renderer.h"

Scene scene_ready(KrsStatus status, KrsScene *scene, KrsPurpose purpose)
{
    Scene s = {.scene = scene};
    assert_int_equal(status, KRS_OK);
    assert_int_equal(krs_state_new(scene, &s.state), KRS_OK);
    status = krs_rendering_new(renderer, scene, purpose, &s.rendering);
    if (status != KRS_OK)
        print_message("%s\n", krs_renderer_message(renderer));
    assert_int_equal(status, KRS_OK);
    return s;
}

Scene scene_of(const char *text, KrsPurpose purpose)
{
    KrsScene *scene;
    KrsStatus status = krs_compile_text(text, strlen(text), "scene.krs", NULL, &scene);
    return scene_ready(status, scene, purpose);
}

void scene_close(Scene s)
{
    krs_rendering_free(s.rendering);
    krs_state_free(s.state);
    krs_scene_free(s.scene);
}

Random chance = {77};

double uniform(double low, double high) { return random_between(&chance, low, high); }

double length3(const double v[3]) { return hypot(hypot(v[0], v[1]), v[2]); }

double        points[MOST][3], aims[MOST][3];
KrsHit        found[MOST];
static KrsHit wanted[MOST];

#define POINTS ((const double(*)[3])points)
#define AIMS   ((const double(*)[3])aims)
void probe_device(Scene s, size_t count)
{
    KrsStatus status = krs_device_probe(s.rendering, s.state, POINTS, count, found);
    if (status != KRS_OK)
        print_message("%s\n", krs_renderer_message(renderer));
    assert_int_equal(status, KRS_OK);
}

void cast_device(Scene s, size_t count, double farthest, double tolerance)
{
    KrsStatus status = krs_device_raycast(s.rendering, s.state, POINTS, AIMS, count, farthest,
                                          tolerance, found);
    if (status != KRS_OK)
        print_message("%s\n", krs_renderer_message(renderer));
    assert_int_equal(status, KRS_OK);
}

/* ---- comparisons ---- */

void points_agree(Scene s, size_t count, double size, double roughness)
{
    size_t wrong_ids = 0, wrong_normals = 0;
    for (size_t i = 0; i < count; i++) {
        random_vector(&chance, size, points[i]);
        for (int k = 0; k < 3; k++)
            points[i][k] = (float)points[i][k];
    }
    probe_device(s, count);
    assert_int_equal(krs_probe(s.state, POINTS, count, wanted), KRS_OK);
    for (size_t i = 0; i < count; i++) {
        double allowed = roughness * 0x1p-23 * (1 + length3(points[i]) + fabs(wanted[i].distance));
        assert_true(fabs(found[i].distance - wanted[i].distance) <= allowed);
        assert_true(memcmp(found[i].point, points[i], sizeof points[i]) == 0 && found[i].hit);
        wrong_ids += found[i].component != wanted[i].component ||
                     found[i].level != wanted[i].level || found[i].instance != wanted[i].instance;
        for (int k = 0; k < 3; k++)
            if (fabs(found[i].normal[k] - wanted[i].normal[k]) > 0.01 ||
                fabs(found[i].shading[k] - wanted[i].shading[k]) > 0.01) {
                wrong_normals++;
                break;
            }
    }
    /* Ties, and edges that a difference reaches over. */
    assert_true(wrong_ids * 200 <= count);
    assert_true(wrong_normals * 20 <= count);
}

/* Returns how far the evaluator contradicts an answer about a ray from the open: by the distance
   where it is said to hit, and by how deep the ray was in something before. */
static double contradiction(Scene s, size_t i, double farthest)
{
    enum { PLACES = 400 };
    static double places[PLACES + 1][3], there[PLACES + 1];
    double        unit[3], length = length3(aims[i]), worst = 0;
    double        t = found[i].hit || found[i].unresolved ? found[i].t : farthest;
    for (int k = 0; k < 3; k++)
        unit[k] = aims[i][k] / length;
    for (int p = 0; p <= PLACES; p++)
        for (int k = 0; k < 3; k++)
            places[p][k] = points[i][k] + t * p / PLACES * unit[k];
    assert_int_equal(krs_distance(s.state, (const double(*)[3])places, PLACES + 1, there), KRS_OK);
    for (int p = 0; p < PLACES; p++)
        worst = fmax(worst, -there[p]);
    if (found[i].hit)
        worst = fmax(worst, fabs(there[PLACES]));
    return worst;
}

/* Rays from places in the open, of which some may be near nothing. */
static void aim_rays(Scene s, size_t count, double size)
{
    for (size_t i = 0; i < count;) {
        double target[3], distance;
        random_vector(&chance, size, points[i]);
        random_vector(&chance, 0.7 * size, target);
        assert_int_equal(krs_distance(s.state, POINTS + i, 1, &distance), KRS_OK);
        if (distance < 0.02)
            continue;
        for (int k = 0; k < 3; k++)
            aims[i][k] = 3 * (target[k] - points[i][k]);
        i++;
    }
}

void rays_agree(Scene s, size_t count, double size, double tolerance, double roughness)
{
    double farthest = 4 * size, worst = 0;
    size_t hits = 0, misses = 0, unresolved = 0;
    aim_rays(s, count, size);
    cast_device(s, count, farthest, tolerance);
    for (size_t i = 0; i < count; i++) {
        double allowed = tolerance + roughness * 0x1p-23 * (1 + 2 * size);
        worst          = fmax(worst, contradiction(s, i, farthest) / allowed);
        hits += found[i].hit;
        unresolved += found[i].unresolved;
        misses += !found[i].hit && !found[i].unresolved;
        assert_false(found[i].hit && found[i].t > farthest);
    }
    if (worst > 1 || hits * 20 < count || misses * 100 < count || unresolved * 500 > count)
        print_message("worst %g, %zu hits, %zu misses, %zu unresolved\n", worst, hits, misses,
                      unresolved);
    assert_true(worst <= 1);
    assert_true(hits * 20 >= count && misses * 100 >= count && unresolved * 500 <= count);
}
