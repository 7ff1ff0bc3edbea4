/*
 * mesh_flat_proofs.c: what is said to be near, against places that are tried.
 *
 * Solids are random trees of half-spaces, beside the same trees of half-spaces that are moved by no more than their slack.  Where
 * these are said to be within an error of each other, places of each surface in the box are looked up by bisection, and
 * inside and outside of the other solid are looked for around them.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/base/vec.h"
#include "mesh/flat/flat_proof.h"
#include "tests/support/random.h"

static const double ERROR = 1, HALF = 0.1;

static Random chance = {2026};

static double uniform(double low, double high) { return random_between(&chance, low, high); }

typedef struct Trial {
    FlatPieces pieces;
    double     moved[MAX_FLATS]; /* what is added to a number for that which it stands for */
} Trial;

static void random_normal(double normal[3])
{
    do
        for (int k = 0; k < 3; k++)
            normal[k] = uniform(-1, 1);
    while (length3(normal) > 1 || !normalize3(normal));
}

static int random_node(Trial *trial, int planes, int first)
{
    FlatPieces *pieces = &trial->pieces;
    FlatNode    node;
    if (planes == 1)
        node = (FlatNode){FLAT_HALF_SPACE, first, uniform(0, 1) < 0.5 ? 1 : -1};
    else {
        int left    = 1 + (int)uniform(0, planes - 1);
        node.kind   = uniform(0, 1) < 0.5 ? FLAT_BOTH : FLAT_EITHER;
        node.first  = random_node(trial, left, first);
        node.second = random_node(trial, planes - left, first + left);
    }
    pieces->nodes[pieces->node_count] = node;
    return (int)pieces->node_count++;
}

static void random_trial(Trial *trial)
{
    FlatPieces *pieces = &trial->pieces;
    memset(trial, 0, sizeof *trial);
    pieces->count = 2 + (size_t)uniform(0, 5);
    for (size_t i = 0; i < pieces->count; i++) {
        FlatSlack *slack = &pieces->slack[i];
        random_normal(pieces->list[i].normal);
        pieces->list[i].offset = uniform(-1, 1) * (uniform(0, 1) < 0.5 ? 0.1 : 1.2);
        if (uniform(0, 1) < 0.7)
            *slack = (FlatSlack){uniform(0, 0.8), uniform(0, 0.8)};
        trial->moved[i] = uniform(0, 1) < 0.5 ? -slack->below : slack->above;
    }
    pieces->root = random_node(trial, (int)pieces->count, 0);
}

/* Below 0 inside; by how much tells how far it is from the surface at least. */
static double value_of(const Trial *trial, int root, bool moved, const double p[3])
{
    const FlatNode *node = &trial->pieces.nodes[root];
    if (node->kind == FLAT_HALF_SPACE) {
        const HalfSpace *plane = &trial->pieces.list[node->first];
        return node->second *
               (dot3(plane->normal, p) + plane->offset + (moved ? trial->moved[node->first] : 0));
    }
    double first  = value_of(trial, node->first, moved, p),
           second = value_of(trial, node->second, moved, p);
    return node->kind == FLAT_BOTH ? fmax(first, second) : fmin(first, second);
}

static double value(const Trial *trial, bool moved, const double p[3])
{
    return value_of(trial, trial->pieces.root, moved, p);
}

static void random_place(double p[3])
{
    for (int k = 0; k < 3; k++)
        p[k] = uniform(-HALF, HALF);
}

/* Returns false if two places of the box are on one side. */
static bool find_surface(const Trial *trial, bool moved, double p[3])
{
    double ends[2][3];
    random_place(ends[0]);
    random_place(ends[1]);
    double sign = value(trial, moved, ends[0]);
    if (sign * value(trial, moved, ends[1]) > 0)
        return false;
    for (int i = 0; i < 50; i++) {
        for (int k = 0; k < 3; k++)
            p[k] = 0.5 * (ends[0][k] + ends[1][k]);
        memcpy(ends[sign * value(trial, moved, p) > 0 ? 0 : 1], p, sizeof ends[0]);
    }
    return true;
}

/* Returns the largest value, times a sign, within the error: from the best of some places by
   smaller and smaller steps. */
static double largest_around(const Trial *trial, bool moved, double sign, const double p[3])
{
    double best[3], most = sign * value(trial, moved, p), step = ERROR;
    memcpy(best, p, sizeof best);
    for (int i = 0; i < 4000 && most < 0; i++) {
        double direction[3], next[3];
        random_normal(direction);
        add_scaled3(next, i < 400 ? p : best, step * uniform(0, 1), direction);
        double far = distance3(next, p);
        if (far > ERROR)
            for (int k = 0; k < 3; k++)
                next[k] = p[k] + ERROR / far * (next[k] - p[k]);
        double found = sign * value(trial, moved, next);
        if (found > most) {
            most = found;
            memcpy(best, next, sizeof best);
        } else if (i >= 400)
            step = fmax(0.997 * step, 1e-3);
    }
    return most;
}

static bool is_around(const Trial *trial, bool moved, double sign, const double p[3])
{
    static const double ROUNDING = 2e-3; /* of what is looked for by steps */
    bool                found    = false;
    for (int i = 0; i < 30 && !found; i++)
        found = largest_around(trial, moved, sign, p) >= -ROUNDING;
    return found;
}

static void try_places(const Trial *trial)
{
    for (int i = 0; i < 6; i++) {
        double p[3];
        bool   moved = i % 2;
        if (!find_surface(trial, moved, p))
            continue;
        assert_true(is_around(trial, !moved, 1, p));
        assert_true(is_around(trial, !moved, -1, p));
    }
}

static void near_ones_are_near(void **state)
{
    static Trial trial;
    const Range  side = {-HALF, HALF};
    const Box    box  = {{side, side, side}};
    size_t       near = 0, thin = 0;
    (void)state;
    for (int i = 0; i < 200000; i++) {
        double p[3];
        random_trial(&trial);
        if (!find_surface(&trial, false, p))
            continue;
        if (flat_nearness(&trial.pieces, &box, ERROR) <= FLAT_HARD) {
            near++;
            try_places(&trial);
        } else
            thin++;
    }
    print_message("# %zu near, %zu not\n", near, thin);
    assert_true(near > thin);
    assert_true(thin > 1000);
}

/* Two edges that cross at a distance of a tenth of the error are known only if planes are off by less than that. */
static void edges_that_nearly_touch_are_told(void **state)
{
    static Trial trial;
    const Range  side          = {-HALF, HALF};
    const Box    box           = {{side, side, side}};
    const double normals[4][3] = {{0.6, 0, 0.8}, {-0.6, 0, 0.8}, {0, 0.6, -0.8}, {0, -0.6, -0.8}};
    FlatPieces  *pieces        = &trial.pieces;
    (void)state;
    pieces->count = 4;
    for (size_t i = 0; i < 4; i++) {
        memcpy(pieces->list[i].normal, normals[i], sizeof normals[i]);
        pieces->list[i].offset = 0.04;
        pieces->nodes[i]       = (FlatNode){FLAT_HALF_SPACE, (int)i, 1};
    }
    pieces->nodes[4]   = (FlatNode){FLAT_BOTH, 0, 1};
    pieces->nodes[5]   = (FlatNode){FLAT_BOTH, 2, 3};
    pieces->nodes[6]   = (FlatNode){FLAT_EITHER, 4, 5};
    pieces->node_count = 7;
    pieces->root       = 6;
    assert_int_equal(flat_nearness(pieces, &box, ERROR), FLAT_NEAR); /* planes are exact */
    for (size_t i = 0; i < 4; i++)
        pieces->slack[i] = (FlatSlack){0.1, 0.1};
    assert_true(flat_nearness(pieces, &box, ERROR) > FLAT_HARD);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(near_ones_are_near),
                                       cmocka_unit_test(edges_that_nearly_touch_are_told)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
