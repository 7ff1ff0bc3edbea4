/*
 * imports_pov_open_surfaces.c: objects of POV-Ray that are clipped, open or flat: where rays meet them, against
 * where the surfaces of what they are made of change from one side to the other.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "tests/oracle/imported.h"
#include "tests/oracle/pov_trees.h"

enum { TRIALS = 24, RAYS = 40, STEPS = 4000, MAX_WALLS = 64 };

static const double FARTHEST = 12;

static Random randomness = {36};

static double between(double low, double high) { return random_between(&randomness, low, high); }
static int    below(int count) { return random_below(&randomness, count); }

typedef struct Ray {
    double origin[3], direction[3];
} Ray;

static void point_at(const Ray *ray, double t, double q[3])
{
    for (int i = 0; i < 3; i++)
        q[i] = ray->origin[i] + t * ray->direction[i];
}

static Ray random_ray(void)
{
    Ray    ray;
    double target[3], length = 0;
    random_vector(&randomness, 4, ray.origin);
    random_vector(&randomness, 1, target);
    for (int i = 0; i < 3; i++) {
        ray.direction[i] = target[i] - ray.origin[i];
        length += ray.direction[i] * ray.direction[i];
    }
    for (int i = 0; i < 3; i++)
        ray.direction[i] /= sqrt(length);
    return ray;
}

/* ---- where surfaces are ---- */

/* Where a ray goes from one side of a node to the other one, of which it is `has` at t. */
static double settled(const PovTree *tree, int index, const Ray *ray, double low, double high)
{
    double q[3];
    point_at(ray, low, q);
    bool before = pov_tree_has(tree, index, q);
    for (int i = 0; i < 60; i++) {
        double middle = (low + high) / 2;
        point_at(ray, middle, q);
        *(pov_tree_has(tree, index, q) == before ? &low : &high) = middle;
    }
    return (low + high) / 2;
}

typedef struct Walls {
    double at[MAX_WALLS];
    int    count;
} Walls;

/* `back`: the ray as it is before the nodes around this one are placed. */
static void primitive_walls(const PovTree *tree, int index, const Ray *back, Walls *walls)
{
    double q[3], step = FARTHEST / STEPS;
    point_at(back, 0, q);
    bool last = pov_tree_has(tree, index, q);
    for (int i = 1; i <= STEPS; i++) {
        point_at(back, i * step, q);
        bool has = pov_tree_has(tree, index, q);
        if (has != last && walls->count < MAX_WALLS)
            walls->at[walls->count++] = settled(tree, index, back, (i - 1) * step, i * step);
        last = has;
    }
}

/* Places are affine: a ray becomes one with the same parameter. */
static Ray inner_ray(const PovNode *node, const Ray *ray)
{
    Ray    back;
    double ahead[3];
    point_at(ray, 1, ahead);
    pov_tree_inner(node, ray->origin, back.origin);
    pov_tree_inner(node, ahead, back.direction);
    for (int i = 0; i < 3; i++)
        back.direction[i] -= back.origin[i];
    return back;
}

/* The surfaces of a union are those of its items; those of an intersection are where the others are,
   too; and so on. */
static void walls_of(const PovTree *tree, int index, const Ray *ray, Walls *walls)
{
    const PovNode *node = &tree->nodes[index];
    if (node->kind != TREE_JOIN) {
        primitive_walls(tree, index, ray, walls);
        return;
    }
    Ray back = inner_ray(node, ray);
    for (int i = 0; i < node->count; i++) {
        Walls own = {.count = 0};
        walls_of(tree, node->items[i], &back, &own);
        for (int w = 0; w < own.count; w++) {
            double q[3];
            bool   seen = true;
            point_at(&back, own.at[w], q);
            for (int k = 0; k < node->count; k++)
                if (k != i && node->join > 0)
                    seen = seen &&
                           pov_tree_has(tree, node->items[k], q) == (node->join == 1 || k == 0);
            if (seen && walls->count < MAX_WALLS)
                walls->at[walls->count++] = own.at[w];
        }
    }
}

/* Returns the first wall that is within the region; -1: none. */
static double first_wall(const PovTree *tree, int object, int region, const Ray *ray)
{
    Walls  walls = {.count = 0};
    double first = -1, q[3];
    walls_of(tree, object, ray, &walls);
    for (int i = 0; i < walls.count; i++) {
        point_at(ray, walls.at[i], q);
        if (pov_tree_has(tree, region, q) && (first < 0 || walls.at[i] < first))
            first = walls.at[i];
    }
    return first;
}

/* ---- clipped objects ---- */

/* Tells whether rays beside this one meet the same: it touches no edge, and nothing that is thin. */
static bool is_plain(const PovTree *tree, int object, int region, const Ray *ray, double first)
{
    for (int i = 0; i < 4; i++) {
        Ray    beside = *ray;
        double off[3], other;
        random_vector(&randomness, 2e-3, off);
        for (int k = 0; k < 3; k++)
            beside.origin[k] += off[k];
        other = first_wall(tree, object, region, &beside);
        if (fabs(other - first) > 0.05)
            return false;
    }
    return true;
}

static bool has_merge(const PovTree *tree)
{
    bool merge = false;
    for (int i = 0; i < tree->count; i++)
        merge = merge || (tree->nodes[i].kind == TREE_JOIN && tree->nodes[i].join == 3);
    return merge;
}

static int check_rays(const PovTree *tree, int object, int region)
{
    static double origins[RAYS][3], directions[RAYS][3];
    static Ray    rays[RAYS];
    static KrsHit hits[RAYS];
    int           met = 0;
    for (int i = 0; i < RAYS; i++) {
        rays[i] = random_ray();
        for (int k = 0; k < 3; k++) {
            origins[i][k]    = (k == 2 ? -1 : 1) * rays[i].origin[k];
            directions[i][k] = (k == 2 ? -1 : 1) * rays[i].direction[k];
        }
    }
    imported_hits("clipped.pov", tree->text, origins, directions, RAYS, FARTHEST, hits);
    for (int i = 0; i < RAYS; i++) {
        double first = first_wall(tree, object, region, &rays[i]);
        if (!is_plain(tree, object, region, &rays[i], first))
            continue;
        met += first >= 0;
        if (hits[i].hit != (first >= 0) || (hits[i].hit && fabs(hits[i].t - first) > 1e-5))
            fail_msg("hit %d at %g, not at %g, from %g %g %g along %g %g %g:\n%s\n%s", hits[i].hit,
                     hits[i].t, first, origins[i][0], origins[i][1], origins[i][2],
                     directions[i][0], directions[i][1], directions[i][2], tree->text,
                     imported("clipped.pov", tree->text).scene);
    }
    return met;
}

/* Objects of one to four parts, of which regions of one to four parts are left, placed once more. */
static void clipped_objects_are_met_where_their_walls_are(void **state)
{
    int met = 0;
    (void)state;
    for (int i = 0; i < TRIALS; i++) {
        static PovTree tree;
        do {
            pov_tree_begin(&tree, &randomness);
            pov_tree_add(&tree, "object { ");
            pov_tree_write(&tree, below(2));
            pov_tree_add(&tree, "clipped_by { ");
        } while (has_merge(&tree));
        int region = tree.count;
        pov_tree_write(&tree, below(2));
        pov_tree_add(&tree, "} }\n");
        met += check_rays(&tree, 0, region);
    }
    assert_true(met > TRIALS * RAYS / 20);
}

/* A region is where the object is when it is named: what moves the object later moves both. */
static void a_region_moves_with_what_it_clips(void **state)
{
    static const char *const texts[] = {
        "sphere { 0, 1 clipped_by { plane { y, 0 } } translate 2*y }",
        "sphere { 0, 1 translate 2*y clipped_by { plane { y, 2 } } }",
        "union { sphere { 0, 1 } translate 2*y clipped_by { plane { y, 2 } } }",
        "#declare H = sphere { 0, 1 clipped_by { plane { y, 0 } } } object { H translate 2*y }",
        "sphere { 2*y, 1 clipped_by { plane { -y, -2 inverse } } }",
        "sphere { 2*y, 1 clipped_by { plane { y, 2.5 } plane { y, 2 } } }"};
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        double from[2][3] = {{0, 5, 0}, {0, -5, 0}}, to[2][3] = {{0, -1, 0}, {0, 1, 0}};
        KrsHit hits[2];
        imported_hits("half.pov", texts[i], from, to, 2, 20, hits);
        if (!hits[0].hit || fabs(hits[0].t - 4) > 1e-6 || !hits[1].hit ||
            fabs(hits[1].t - 6) > 1e-6)
            fail_msg("%s: %g and %g", texts[i], hits[0].t, hits[1].t);
    }
}

/* ---- open columns ---- */

/* Rays from outside to a point of the axis: through an end they meet the side from within. */
static void open_columns_have_no_ends(void **state)
{
    (void)state;
    for (int i = 0; i < TRIALS; i++) {
        double height = between(0.5, 2), low = between(0.3, 1), high = between(0.3, 1);
        double side = between(1.5, 4), up = between(-4, 4), at = between(-0.4, 0.4) * height;
        char   pov[256];
        KrsHit hit;
        snprintf(pov, sizeof pov, "cone { <0, %.17g, 0>, %.17g, <0, %.17g, 0>, %.17g open }",
                 -height / 2, low, height / 2, high);
        double from[1][3] = {{side, up, 0}}, to[1][3] = {{-side, at - up, 0}}, first = -1;
        double length = hypot(side, at - up);
        for (int k = 0; k <= 1; k++) { /* (1 - t) side = +-(m + s y(t)), y = up + t (at - up) */
            double m = (low + high) / 2, s = (high - low) / height, sign = k == 0 ? 1 : -1;
            double t = (side - sign * (m + s * up)) / (side + sign * s * (at - up));
            double y = up + t * (at - up);
            if (t > 0 && fabs(y) < height / 2 && (first < 0 || t < first))
                first = t;
        }
        imported_hits("open.pov", pov, from, to, 1, 40, &hit);
        if (hit.hit != (first > 0) || (hit.hit && fabs(hit.t - first * length) > 1e-6))
            fail_msg("%s from %g %g: %d at %g, not %g", pov, side, up, hit.hit, hit.t,
                     first * length);
    }
}

/* ---- flat figures ---- */

/* On which side of the line from a to b a point of the plane is. */
static double side(const double a[2], const double b[2], const double p[2])
{
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}

/* Triangles and polygons with a hole, seen along a random direction: the ray to a point of their plane
   meets them where the point is in the figure. */
static void flat_figures_are_met_where_they_are(void **state)
{
    int met = 0;
    (void)state;
    for (int i = 0; i < TRIALS; i++) {
        double corners[3][3], u[3], v[3], from[RAYS][3], to[RAYS][3];
        bool   inside[RAYS], hole = below(2);
        char   pov[1024];
        KrsHit hits[RAYS];
        for (int k = 0; k < 3; k++)
            random_vector(&randomness, 1, corners[k]);
        for (int k = 0; k < 3; k++) {
            u[k] = corners[1][k] - corners[0][k];
            v[k] = corners[2][k] - corners[0][k];
        }
        /* The hole has the middle of the triangle, and half its size. */
        double in[3][3];
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < 3; k++)
                in[c][k] = (corners[0][k] + corners[1][k] + corners[2][k]) / 6 + corners[c][k] / 2;
        size_t end = (size_t)sprintf(pov, hole ? "polygon { 8" : "triangle { ");
        for (int c = 0; c < (hole ? 8 : 3); c++) {
            const double *q = c < 4 ? corners[c % 3] : in[(c - 4) % 3];
            end += (size_t)sprintf(pov + end, "%s<%.17g, %.17g, %.17g>", hole || c > 0 ? ", " : "",
                                   q[0], q[1], q[2]);
        }
        sprintf(pov + end, " }");
        for (int r = 0; r < RAYS; r++) {
            double s = between(-0.5, 1.5), t = between(-0.5, 1.5), away[3];
            double a[2] = {0, 0}, b[2] = {1, 0}, c[2] = {0, 1}, p[2] = {s, t};
            double third[2] = {2 * s - 1.0 / 3, 2 * t - 1.0 / 3}; /* of the hole */
            bool   has      = side(a, b, p) > 0 && side(b, c, p) > 0 && side(c, a, p) > 0;
            bool   out = side(a, b, third) > 0 && side(b, c, third) > 0 && side(c, a, third) > 0;
            random_vector(&randomness, 3, away);
            for (int k = 0; k < 3; k++) {
                double at  = corners[0][k] + s * u[k] + t * v[k];
                from[r][k] = (k == 2 ? -1 : 1) * (at + away[k]);
                to[r][k]   = (k == 2 ? 1 : -1) * away[k];
            }
            inside[r] = has && !(hole && out);
        }
        imported_hits("flat.pov", pov, from, to, RAYS, 40, hits);
        for (int r = 0; r < RAYS; r++) {
            met += inside[r];
            if (hits[r].hit != inside[r])
                fail_msg("ray %d: %d, not %d, of %s", r, hits[r].hit, inside[r], pov);
        }
    }
    assert_true(met > TRIALS * RAYS / 20);
}

static void what_has_no_inside_is_refused_where_it_needs_one(void **state)
{
    (void)state;
    assert_refused("a.pov",
                   "\ndifference { sphere { 0, 1 clipped_by { plane { x, 0 } } } box { 0, 1 } }",
                   "a.pov:2: what is clipped, open or flat has no inside");
    assert_refused("a.pov", "intersection { box { 0, 1 }\ntriangle { 0, x, y } }",
                   "a.pov:1: what is clipped, open or flat has no inside");
    assert_refused("a.pov", "sphere { 0, 1\nclipped_by { cylinder { 0, y, 1 open } } }",
                   "a.pov:2: `clipped_by` what is clipped");
    assert_refused("a.pov", "prism { 0, 1, 4, <0, 0>, <1, 0>, <0, 1>, <0, 0>\nopen }",
                   "a.pov:2: `open` of a prism");
    assert_refused("a.pov",
                   "merge { sphere { 0, 1 } sphere { x, 1 }\nclipped_by { plane { y, 0 } } }",
                   "a.pov:2: `clipped_by` of merge");
    assert_refused("a.pov",
                   "sphere { 0, 1 bounded_by { box { -1, 1 } }\nclipped_by { bounded_by } }",
                   "a.pov:2: `clipped_by` is translated with objects alone");
    assert_refused("a.pov", "#for (I, 1, 501)\ntriangle { 0, x, y + I*z }\n#end",
                   "a.pov:2: more than 500 triangles");
    assert_refused("a.pov", "polygon { 5, 0, x, y, z, 0 }",
                   "a.pov:1: the points are not in a plane");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clipped_objects_are_met_where_their_walls_are),
        cmocka_unit_test(a_region_moves_with_what_it_clips),
        cmocka_unit_test(open_columns_have_no_ends),
        cmocka_unit_test(flat_figures_are_met_where_they_are),
        cmocka_unit_test(what_has_no_inside_is_refused_where_it_needs_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
