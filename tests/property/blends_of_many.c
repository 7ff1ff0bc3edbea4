/*
 * blends_of_many.c: what blends make of more than two parts depends neither on their order, nor on how many there
 * are elsewhere, nor on whether they are lowered one by one or as instances of groups.  The oracles are the
 * definitions (math.md, section 4), by search and by brute force.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "krs/krs.h"
#include "tests/support/random.h"

enum { MOST = 200, POINTS = 160, SHARERS = 8, KINDS = 6 };

static const char *const kinds[KINDS] = {"quadratic", "cubic",   "exponential",
                                         "circular",  "chamfer", "stairs"};

static Random randomness = {1017};

static double between(double low, double high) { return random_between(&randomness, low, high); }

/* ---- parts ---- */

/* Balls and bricks; half the sides of a brick are `size`. */
typedef struct Part {
    bool   brick;
    double centre[3], size[3];
} Part;

static Part random_part(bool mixed, double room)
{
    Part part = {.brick = mixed && random_below(&randomness, 2)};
    for (int k = 0; k < 3; k++) {
        part.centre[k] = between(-room, room);
        part.size[k]   = between(0.08, 0.2);
    }
    return part;
}

static double distance_to(const Part *part, const double p[3])
{
    double outside = 0, inside = -HUGE_VAL, square = 0;
    for (int k = 0; k < 3; k++) {
        double away = p[k] - part->centre[k], side = fabs(away) - part->size[k];
        square += away * away;
        outside += fmax(side, 0) * fmax(side, 0);
        inside = fmax(inside, side);
    }
    return part->brick ? sqrt(outside) + fmin(inside, 0) : sqrt(square) - part->size[0];
}

static void write_part(char *to, const Part *part)
{
    char shape[200];
    if (part->brick)
        sprintf(shape, "box([%.17g, %.17g, %.17g])", 2 * part->size[0], 2 * part->size[1],
                2 * part->size[2]);
    else
        sprintf(shape, "sphere(%.17g)", part->size[0]);
    sprintf(to, "%s.move([%.17g, %.17g, %.17g]), ", shape, part->centre[0], part->centre[1],
            part->centre[2]);
}

typedef struct CsgNode {
    const char *function, *kind;
    double      width;
} CsgNode;

static void probe(const CsgNode *csg_node, const Part *parts, int count, double (*points)[3],
                  KrsHit *hits)
{
    static char text[MOST * 400];
    size_t      length  = (size_t)sprintf(text, "show %s([", csg_node->function);
    KrsOptions  options = {0};
    KrsScene   *scene   = NULL;
    KrsState   *state   = NULL;
    for (int i = 0; i < count; i++) {
        write_part(text + length, &parts[i]);
        length += strlen(text + length);
    }
    length += (size_t)sprintf(text + length, "], blend: %.17g, kind: \"%s\"%s);", csg_node->width,
                              csg_node->kind, strcmp(csg_node->kind, "stairs") ? "" : ", steps: 3");
    assert_int_equal(krs_compile_text(text, length, "many.krs", &options, &scene), KRS_OK);
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    assert_int_equal(krs_probe(state, (const double(*)[3])points, POINTS, hits), KRS_OK);
    krs_state_free(state);
    krs_scene_free(scene);
}

/* ---- definitions ---- */

static double smooth_of_two(const char *kind, double a, double b, double k)
{
    double h = fmax(1 - fabs(a - b) / k, 0);
    return fmin(a, b) - (kind[0] == 'q' ? k * h * h / 4 : k * h * h * h / 6);
}

/* At most the result for all thresholds l, and that for one. */
static double at_threshold(const char *kind, const double *d, int count, double k, double l)
{
    double sum = l;
    for (int i = 0; i < count; i++)
        sum += smooth_of_two(kind, 2 * (d[i] - l), 0, k) / 2;
    return sum;
}

static double shared(const char *kind, const double *d, int count, double k)
{
    double low = d[0] - k, high = d[0] + k;
    for (int i = 0; i < 100; i++) {
        double a = low + (high - low) * 0.382, b = low + (high - low) * 0.618;
        if (at_threshold(kind, d, count, k, a) < at_threshold(kind, d, count, k, b))
            low = a;
        else
            high = b;
    }
    return at_threshold(kind, d, count, k, 0.5 * (low + high));
}

static double chamfer(double a, double b, double k)
{
    return fmin(fmin(a, b), (a + b - k) * sqrt(0.5));
}

/* Steps of equal width and height between both. */
static double stairs(double a, double b, double k)
{
    double s = k / 3, u = b - k;
    return fmin(fmin(a, b), 0.5 * (u + a + fabs(fmod(fmod(u - a + s, 2 * s) + 2 * s, 2 * s) - s)));
}

static double min_pair(const char *kind, const double *d, int count, double k)
{
    double least = HUGE_VAL;
    for (int i = 0; i < count; i++)
        for (int j = 0; j < count && i + j < 40; j++) /* they are sorted */
            if (i != j)
                least = fmin(least, (kind[0] == 's' ? stairs : chamfer)(d[i], d[j], k));
    return least;
}

static int compare(const void *a, const void *b)
{
    return (*(const double *)a > *(const double *)b) - (*(const double *)a < *(const double *)b);
}

static double blended(const CsgNode *csg_node, const Part *parts, int count, const double p[3])
{
    double d[MOST], sum = 0;
    bool   inverse = csg_node->function[0] == 'i', circular = !strcmp(csg_node->kind, "circular");
    for (int i = 0; i < count; i++)
        d[i] = (inverse ? -1 : 1) * distance_to(&parts[i], p);
    qsort(d, (size_t)count, sizeof *d, compare);
    double k = csg_node->width, result;
    for (int i = 0; i < count; i++)
        sum += circular ? pow(fmax(k - d[i], 0), 2) : exp((d[0] - d[i]) / k);
    if (csg_node->kind[0] == 'e')
        result = d[0] - k * log(sum);
    else if (circular)
        result = fmax(k, d[0]) - sqrt(sum);
    else if (csg_node->kind[0] == 'c' && csg_node->kind[1] == 'h')
        result = min_pair(csg_node->kind, d, count, k);
    else if (csg_node->kind[0] == 's')
        result = min_pair(csg_node->kind, d, count, k);
    else
        result = shared(csg_node->kind, d, count < SHARERS ? count : SHARERS, k);
    return inverse ? -result : result;
}

/* ---- trials ---- */

static void shuffle(Part *parts, int count)
{
    for (int i = count - 1; i > 0; i--) {
        int  other   = (int)random_below(&randomness, (uint32_t)i + 1);
        Part part    = parts[i];
        parts[i]     = parts[other];
        parts[other] = part;
    }
}

/* Points near the surface, by steps along the gradient: where they are far from it, distances may be other bounds. */
static void random_points(const CsgNode *csg_node, const Part *parts, int count,
                          double (*points)[3])
{
    for (int i = 0; i < POINTS; i++) {
        const Part *near = &parts[random_below(&randomness, (uint32_t)count)];
        for (int k = 0; k < 3; k++)
            points[i][k] = near->centre[k] + between(-0.35, 0.35);
        for (int step = 0; step < 6; step++) {
            double value = blended(csg_node, parts, count, points[i]), gradient[3], square = 0;
            for (int k = 0; k < 3; k++) {
                double there[3] = {points[i][0], points[i][1], points[i][2]};
                there[k] += 1e-6;
                gradient[k] = (blended(csg_node, parts, count, there) - value) / 1e-6;
                square += gradient[k] * gradient[k];
            }
            for (int k = 0; k < 3 && square > 0.01; k++)
                points[i][k] -= gradient[k] * (value - (step == 5 ? between(-1e-3, 1e-3) : 0)) /
                                square;
        }
    }
}

static bool is_steep(const CsgNode *csg_node)
{
    return !strcmp(csg_node->kind, "circular") || !strcmp(csg_node->kind, "chamfer");
}

/* What is left out of sums of powers is less than that. */
static double allowed(const CsgNode *csg_node)
{
    return csg_node->kind[0] == 'e' ? 1e-4 * csg_node->width : 1e-9;
}

/* What is steep is divided by its slope, which may depend on what is far: then signs are compared. */
static void assert_near(const CsgNode *csg_node, double is, double wanted, double most)
{
    if (!is_steep(csg_node))
        assert_true(fabs(is - wanted) <= most);
    else if (fabs(wanted) > 1e-9)
        assert_true((is < 0) == (wanted < 0));
}

static CsgNode random_csg_node(bool intersect)
{
    return (CsgNode){intersect ? "intersection" : "union", kinds[random_below(&randomness, KINDS)],
                     between(0.02, 0.4)};
}

static void follows_definition(void **context)
{
    static const int counts[] = {2, 3, 5, 8, 9, 17, 63, 64, 130};
    static double    points[POINTS][3];
    static KrsHit    hits[POINTS];
    static Part      parts[MOST];
    int              intersected = 0;
    (void)context;
    for (size_t n = 0; n < sizeof counts / sizeof *counts; n++)
        for (int trial = 0; trial < KINDS; trial++) {
            CsgNode csg_node = random_csg_node((trial + n) % 4 == 3 && counts[n] < 64);
            int     count = counts[n], inside = 0, near = 0;
            csg_node.kind = kinds[trial % KINDS];
            for (int i = 0; i < count; i++)
                parts[i] = random_part((trial + n) % 2, csg_node.function[0] == 'i' ? 0.04
                                                        : count > 20                ? 0.8
                                                                                    : 0.3);
            random_points(&csg_node, parts, count, points);
            probe(&csg_node, parts, count, points, hits);
            for (int i = 0; i < POINTS; i++) {
                double wanted = blended(&csg_node, parts, count, points[i]);
                if (fabs(wanted) > 2e-3)
                    continue;
                near++;
                inside += wanted < 0;
                assert_near(&csg_node, hits[i].distance, wanted, allowed(&csg_node));
            }
            assert_true(csg_node.function[0] == 'i' || (inside > 0 && near > POINTS / 2));
            intersected += csg_node.function[0] == 'i' && inside > 0;
        }
    assert_true(intersected > 0); /* some have nothing in common */
}

static void order_and_what_is_far_do_not_show(void **context)
{
    static double points[POINTS][3];
    static KrsHit before[POINTS], after[POINTS];
    static Part   parts[MOST];
    (void)context;
    for (int trial = 0; trial < 30; trial++) {
        CsgNode csg_node = random_csg_node(false);
        int     count    = 2 + (int)random_below(&randomness, trial % 3 ? 30 : 100), more;
        more             = 1 + (int)random_below(&randomness, (uint32_t)(MOST - count));
        csg_node.kind    = kinds[trial % KINDS];
        for (int i = 0; i < count; i++)
            parts[i] = random_part(trial % 2, count > 30 ? 0.6 : 0.3);
        random_points(&csg_node, parts, count, points);
        probe(&csg_node, parts, count, points, before);
        for (int i = 0; i < more; i++) {
            parts[count + i] = random_part(trial % 4 < 2, 8);
            parts[count + i].centre[0] += 60;
        }
        shuffle(parts, count + more);
        probe(&csg_node, parts, count + more, points, after);
        for (int i = 0; i < POINTS; i++)
            assert_near(&csg_node, after[i].distance, before[i].distance, 2 * allowed(&csg_node));
    }
}

/* Two sides of a step differ by no more than its length. */
static void slopes_hold(void **context)
{
    static double points[POINTS][3];
    static KrsHit hits[POINTS];
    static Part   parts[MOST];
    (void)context;
    for (int trial = 0; trial < 12; trial++) {
        CsgNode csg_node = random_csg_node(false);
        int     count    = 3 + (int)random_below(&randomness, trial % 2 ? 12 : 90);
        csg_node.kind    = kinds[trial % KINDS];
        for (int i = 0; i < count; i++)
            parts[i] = random_part(trial % 2, 0.4);
        random_points(&csg_node, parts, count, points);
        for (int i = 0; i < POINTS; i += 2)
            for (int k = 0; k < 3; k++)
                points[i + 1][k] = points[i][k] + between(-1e-3, 1e-3);
        probe(&csg_node, parts, count, points, hits);
        for (int i = 0; i < POINTS; i += 2) {
            double square = 0, changed = fabs(hits[i].distance - hits[i + 1].distance);
            for (int k = 0; k < 3; k++)
                square += pow(points[i][k] - points[i + 1][k], 2);
            if (csg_node.kind[0] != 'e')
                assert_true(changed <= sqrt(square) * (1 + 1e-9) + 1e-13);
        }
    }
}

/* What surfaces are mixed by is the same in any order, too. */
static void colours_do_not_show_the_order(void **context)
{
    static const char *const texts[] = {
        "let a = sphere(1).paint(#ff0000); let b = sphere(1).move([1, 0, 0]).paint(#00ff00);"
        "let c = box([1, 1, 1]).move([0.5, 0.8, 0]).paint(#0000ff); show union(a, b, c, blend: 1);",
        "let a = sphere(1).paint(#ff0000); let b = sphere(1).move([1, 0, 0]).paint(#00ff00);"
        "let c = box([1, 1, 1]).move([0.5, 0.8, 0]).paint(#0000ff); show union(c, a, b, blend: 1);",
        "let a = sphere(1).paint(#ff0000); let b = sphere(1).move([1, 0, 0]).paint(#00ff00);"
        "let c = box([1, 1, 1]).move([0.5, 0.8, 0]).paint(#0000ff); show union(c, a, b, "
        "[sphere(0.1 + 0.001 * i).move([i, 99, 0]) for i in 0..70], blend: 1);"};
    static double points[POINTS][3];
    static KrsHit hits[3][POINTS];
    (void)context;
    for (int i = 0; i < POINTS; i++)
        for (int k = 0; k < 3; k++)
            points[i][k] = between(-1, 1.5);
    for (int t = 0; t < 3; t++) {
        KrsOptions options = {0};
        KrsScene  *scene   = NULL;
        KrsState  *state   = NULL;
        assert_int_equal(krs_compile_text(texts[t], strlen(texts[t]), "c.krs", &options, &scene),
                         KRS_OK);
        assert_int_equal(krs_state_new(scene, &state), KRS_OK);
        assert_int_equal(krs_probe(state, (const double(*)[3])points, POINTS, hits[t]), KRS_OK);
        krs_state_free(state);
        krs_scene_free(scene);
    }
    for (int t = 1; t < 3; t++)
        for (int i = 0; i < POINTS; i++)
            for (int k = 0; k < 3; k++)
                assert_true(fabs(hits[0][i].color[k] - hits[t][i].color[k]) < 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(follows_definition),
        cmocka_unit_test(order_and_what_is_far_do_not_show),
        cmocka_unit_test(slopes_hold),
        cmocka_unit_test(colours_do_not_show_the_order),
    };
    return cmocka_run_group_tests_name("blends of many", tests, NULL, NULL);
}
