/*
 * chords.c: the truth that coverage.c holds pictures against: where lines meet capsules and boxes,
 * and that this is about the scene that the compiler has.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "tests/oracle/twigs.h"

/* Distance to a segment, by trisection: it is a convex function of the place on the segment. */
static double distance_to_segment(Vec from, Vec to, Vec point)
{
    double low = 0, high = 1;
    for (int i = 0; i < 100; i++) {
        double a = low + (high - low) / 3, b = high - (high - low) / 3;
        if (vec_distance(vec_mix(from, to, a), point) < vec_distance(vec_mix(from, to, b), point))
            high = b;
        else
            low = a;
    }
    return vec_distance(vec_mix(from, to, low), point);
}

static double excess_over_box(Vec low, Vec high, Vec p)
{
    double x = fmax(p.x - high.x, low.x - p.x), y = fmax(p.y - high.y, low.y - p.y);
    return fmax(x, fmax(y, fmax(p.z - high.z, low.z - p.z)));
}

/* The rod, or the box between the ends of its segment. */
static double excess(const Rod *rod, bool box, Vec p)
{
    if (box)
        return excess_over_box(rod->from, rod->to, p);
    double most = distance_to_segment(rod->from, rod->to, p) - rod->radius;
    for (int i = 0; i < rod->cut_count; i++)
        most = fmax(most, half_excess(rod->cuts[i], p));
    return most;
}

/* Marches along a line in small steps: the points inside are those of the chord.  Returns whether
   there is one. */
static bool check_chord(Line line, const Rod *rod, bool box)
{
    enum { STEPS = 300 };
    Chord chord = box ? chord_of_box(line, rod->from, rod->to) : chord_of_rod(line, rod);
    for (int i = 0; i <= STEPS; i++) {
        double t = 6.0 * i / STEPS - 3, over = excess(rod, box, line_at(line, t));
        if (fabs(over) > 1e-9)
            assert_int_equal(over<0, t> chord.enter && t < chord.leave);
    }
    if (chord_is_empty(chord))
        return false;
    assert_true(fabs(excess(rod, box, line_at(line, chord.enter))) < 1e-6);
    assert_true(fabs(excess(rod, box, line_at(line, chord.leave))) < 1e-6);
    return true;
}

static void chords_are_what_marching_finds(void **state)
{
    (void)state;
    enum { TRIALS = 600 };
    Random random = {3};
    int    met    = 0;
    for (int i = 0; i < TRIALS; i++) {
        bool box = i % 5 == 0;
        Rod  rod = {.from      = random_in_cube(&random, 1),
                    .to        = random_in_cube(&random, 1),
                    .radius    = random_between(&random, 0.01, 0.6),
                    .cut_count = i % 4};
        for (int k = 0; k < rod.cut_count; k++)
            rod.cuts[k] = (Half){random_unit(&random), random_between(&random, -0.3, 0.8)};
        if (box)
            rod.to = vec_add(rod.from, vec(0.5, random_between(&random, 0, 1), 0.7));
        Line line = {.direction = random_unit(&random)};
        if (i % 7 == 0) /* along the axis of a capsule, along a face of a box */
            line.direction = box ? vec(0, 0, 1) : vec_unit(vec_sub(rod.to, rod.from));
        line.origin = vec_mix(rod.from, rod.to, random_between(&random, -0.2, 1.2));
        line.origin = vec_add(line.origin, random_in_cube(&random, 0.3));
        met += check_chord(line, &rod, box);
    }
    assert_in_range(met, TRIALS / 3, TRIALS - TRIALS / 10);
}

/* The picture rod by rod is that of each ray against all rods. */
static void pictures_are_what_rays_see(void **state)
{
    (void)state;
    const Shot shots[] = {{.kind = TREE, .wide = 3},
                          {.kind = HEAP, .wide = 30},
                          {.kind = HEAP, .wide = 1, .camera = FLAT}};
    for (size_t n = 0; n < sizeof shots / sizeof shots[0]; n++) {
        const Scene *scene = use_scene(shots[n].kind);
        Lens         lens  = twigs_lens(&shots[n], WIDTH, HEIGHT);
        double      *enter = twigs_truth(&shots[n], &lens, 0.3, 0.8);
        double       size  = twigs_size(scene, &lens, shots[n].wide);
        int          hits  = 0;
        for (int k = 0; k < PIXELS; k += 7) {
            Line   ray   = lens_ray(&lens, k % WIDTH + 0.3, k / WIDTH + 0.8);
            double first = HUGE_VAL;
            for (size_t i = 0; i < scene->count; i++) {
                Rod rod = scene->rods[i];
                rod.radius *= size;
                Chord chord = chord_of_rod(ray, &rod);
                first       = chord_is_empty(chord) ? first : fmin(first, chord.enter);
            }
            assert_true(enter[k] == first);
            hits += first < HUGE_VAL;
        }
        assert_true(hits > 300);
        free(enter);
    }
}

/* The expansion, and the compiler's distance in double precision, are about one scene. */
static void rods_are_those_of_the_scene(void **state)
{
    (void)state;
    for (SceneKind kind = 0; kind < SCENES; kind++) {
        Scene *scene = use_scene(kind);
        Shot   shot  = {.kind = kind, .wide = 2};
        Lens   lens  = twigs_lens(&shot, WIDTH, HEIGHT);
        double size  = twigs_size(scene, &lens, shot.wide);
        assert_int_equal(krs_state_set(scene->product.state, "size", &size, 1), KRS_OK);
        double *enter = twigs_truth(&shot, &lens, 0.5, 0.5);
        for (int k = 0; k < PIXELS; k += 11) {
            Line ray = lens_ray(&lens, k % WIDTH + 0.5, k / WIDTH + 0.5);
            if (enter[k] == HUGE_VAL)
                continue;
            double distance = product_distance(&scene->product, line_at(ray, enter[k]));
            assert_true(fabs(distance) < 1e-9);
        }
        free(enter);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chords_are_what_marching_finds),
        cmocka_unit_test(rods_are_those_of_the_scene),
        cmocka_unit_test(pictures_are_what_rays_see),
    };
    return run_twig_tests("chords", tests, sizeof tests / sizeof tests[0]);
}
