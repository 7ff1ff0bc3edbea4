/*
 * The library's algebraic surfaces against formulas of their own (formulas.h): which side is
 * solid and how far it is, where rays first meet it and what its normal is there, and how many
 * singular points it has, where the distance must still be of use.
 */
#include "tests/oracle/formulas.h"
#include "tests/oracle/judge.h"
#include "tests/oracle/product.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/passes/compile.h"

static Product surface_compile(const Surface *surface, double radius, bool open)
{
    return product_format("use \"std/surfaces.krs\";\n%sshow %swithin: %.17g, open: %s);",
                          surface->before, surface->call, radius, open ? "true" : "false");
}

static Real value_at(const Surface *surface, Vec p)
{
    return surface->formula((const Real[3]){p.x, p.y, p.z});
}

/* ---- sides and distances ---- */

static bool is_inside(const void *user, Vec p)
{
    const Surface *surface = user;
    return value_at(surface, p) <= 0 && vec_length(p) <= surface->radius;
}

static void is_safe(void **state)
{
    const Surface *surface = *state;
    Product        product = surface_compile(surface, surface->radius, false);
    Trial          trial   = {.field       = product_field,
                              .field_user  = &product,
                              .inside      = is_inside,
                              .inside_user = surface,
                              .half        = 1.3 * surface->radius,
                              .points      = 300,
                              .seed        = 3};
    judge_acquits(&trial, surface->name);
    product_free(&product);
}

/* ---- rays ---- */

static Vec point_of(const KrsHit *hit) { return vec(hit->point[0], hit->point[1], hit->point[2]); }

/* The angle between the hit's normal and the formula's gradient, or 0 where that is too small, or
   bends too much, to have a direction in double precision. */
static double turn_at(const Surface *surface, const KrsHit *hit)
{
    Vec normal = vec(hit->normal[0], hit->normal[1], hit->normal[2]), p = point_of(hit);
    Vec a = surface_slope(surface->formula, p);
    for (int i = 0; i < 3; i++) {
        double h      = 1e-4 * surface->radius;
        Vec    beside = vec_add(p, vec(h * (i == 0), h * (i == 1), h * (i == 2)));
        Vec    b      = surface_slope(surface->formula, beside);
        if (vec_length(vec_cross(vec_unit(a), vec_unit(b))) > 0.005)
            return 0;
    }
    double angle = vec_length(vec_cross(vec_unit(a), normal));
    return vec_dot(a, normal) > 0 ? angle : 2 - angle;
}

static void rays_find_first_roots(void **state)
{
    const Surface *surface = *state;
    Product        product = surface_compile(surface, surface->radius, false);
    Random         random  = {11};
    int            hits = 0, on_ball = 0, doubtful = 0;
    enum { RAYS = 250 };
    for (int i = 0; i < RAYS; i++) {
        Vec origin, direction;
        random_ray(&random, surface->radius, &origin, &direction);
        Entry entry = surface_entry(surface->formula, surface->radius, origin, direction);
        if (entry.fate == RAY_DOUBTFUL) {
            doubtful++;
            continue;
        }
        KrsHit hit = product_raycast(&product, origin, direction, 100 * surface->radius, 0);
        if (hit.hit != (entry.fate == RAY_HITS) || hit.unresolved)
            fail_msg("%s: ray %d is %s, its root at %.12Lg", surface->name, i,
                     hit.hit ? "a false hit" : "missed", entry.t);
        if (!hit.hit)
            continue;
        hits++;
        on_ball += entry.on_ball;
        double off = fabs(hit.t - (double)entry.t);
        if (off > surface_leeway(surface->formula, surface->radius, point_of(&hit), direction))
            fail_msg("%s: ray %d ends at %.12g, its root is at %.12Lg", surface->name, i, hit.t,
                     entry.t);
        double turn = entry.on_ball ? 0 : turn_at(surface, &hit);
        if (turn > 1e-3)
            fail_msg("%s: ray %d has a normal that is off by %g", surface->name, i, turn);
    }
    assert_true(hits > RAYS / 15 && hits - on_ball > RAYS / 30 && doubtful < RAYS / 10);
    product_free(&product);
}

/* A sheet is met no later than the surface, and nothing is met where that is far away: a sheet is
   where the bound is small, which is up to 20 times as thick where many sheets are close. */
static void sheets_are_thin(void **state)
{
    const Surface *surface   = *state;
    Product        product   = surface_compile(surface, surface->radius, true);
    Random         random    = {12};
    int            hits      = 0;
    const double   thickness = 1e-3 * 2 * sqrt(3) * surface->radius;
    for (int i = 0; i < 120; i++) {
        Vec origin, direction, near;
        random_ray(&random, surface->radius, &origin, &direction);
        Entry  entry = surface_crossing(surface->formula, surface->radius, origin, direction);
        KrsHit hit   = product_raycast(&product, origin, direction, 100 * surface->radius, 0);
        if (hit.unresolved || (entry.fate == RAY_HITS && !(hit.t <= entry.t + 1e-6)))
            fail_msg("%s: ray %d goes through the sheet at %.12Lg", surface->name, i, entry.t);
        if (!hit.hit)
            continue;
        hits++;
        if (surface_near(surface->formula, point_of(&hit), &near) &&
            vec_distance(near, point_of(&hit)) > 20 * thickness)
            fail_msg("%s: ray %d meets a sheet that is %g away", surface->name, i,
                     vec_distance(near, point_of(&hit)));
    }
    assert_true(hits > 8);
    product_free(&product);
}

/* ---- singular points ---- */

enum { MAX_NODES = 2000 };

typedef struct Nodes {
    Vec points[MAX_NODES];
    int count;
} Nodes;

static Real determinant(Real m[3][3])
{
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

static void second_derivatives(Formula *formula, const Real p[3], Real hessian[3][3])
{
    Real h = 1e-5L * (1 + fmaxl(fabsl(p[0]), fmaxl(fabsl(p[1]), fabsl(p[2]))));
    for (int i = 0; i < 3; i++) {
        Real before[3] = {p[0], p[1], p[2]}, after[3] = {p[0], p[1], p[2]}, low[3], high[3];
        before[i] -= h;
        after[i] += h;
        surface_gradient(formula, before, low);
        surface_gradient(formula, after, high);
        for (int k = 0; k < 3; k++)
            hessian[i][k] = (high[k] - low[k]) / (2 * h);
    }
}

/* hessian * step = gradient, by Cramer's rule. */
static bool newton_step(Real hessian[3][3], const Real gradient[3], Real step[3])
{
    Real whole = determinant(hessian);
    for (int column = 0; column < 3; column++) {
        Real changed[3][3];
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++)
                changed[i][k] = k == column ? gradient[i] : hessian[i][k];
        step[column] = determinant(changed) / whole;
        if (!isfinite((double)step[column]))
            return false;
    }
    return true;
}

/* Newton's method on grad f = 0 from p; whether it ends on f = 0. */
static bool find_node(Formula *formula, Real p[3])
{
    Real gradient[3], hessian[3][3], step[3], length = 1, most = 0;
    for (int round = 0; round < 60 && length > 1e-13L; round++) {
        surface_gradient(formula, p, gradient);
        second_derivatives(formula, p, hessian);
        if (!newton_step(hessian, gradient, step))
            return false;
        Real size = sqrtl(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        length    = sqrtl(step[0] * step[0] + step[1] * step[1] + step[2] * step[2]) / (1 + size);
        Real damp = length > 0.1L ? 0.1L / length : 1;
        for (int i = 0; i < 3; i++)
            p[i] -= damp * step[i];
    }
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            most = fmaxl(most, fabsl(hessian[i][k]));
    return length < 1e-9L && fabsl(formula(p)) < 1e-9L * most;
}

static void add_node(Nodes *nodes, const Real p[3])
{
    Vec point = vec((double)p[0], (double)p[1], (double)p[2]);
    for (int i = 0; i < nodes->count; i++)
        if (vec_distance(nodes->points[i], point) < 1e-5 * (1 + vec_length(point)))
            return;
    assert_true(nodes->count < MAX_NODES);
    nodes->points[nodes->count++] = point;
}

typedef enum Symmetry {
    SIGNS  = 1, /* (-x, y, z) and so on */
    CYCLES = 2, /* (y, z, x) */
    TURNS  = 4, /* `turns` of them about z, and (x, -y, z) */
    FLIP   = 8  /* (x, y, -z) */
} Symmetry;

typedef struct Census {
    const char *name;
    double      reach; /* seeds are drawn from this ball */
    int         nodes, seeds;
    int         symmetries, turns;
} Census;

static const Census censuses[] = {
    {"clebsch", 3, 0, 400, 0, 0},
    {"cayley", 2, 4, 100, 0, 0},
    {"ding_dong", 1, 1, 100, 0, 0},
    {"octdong", 1, 1, 100, 0, 0},
    {"tanglecube", 3, 0, 400, 0, 0},
    {"dupin_cyclide", 4, 0, 400, 0, 0},
    {"kummer", 2, 16, 1000, 0, 0},
    {"togliatti", 10, 31, 1000, TURNS, 5},
    {"barth_sextic", 2, 50, 400, SIGNS | CYCLES, 0},
    {"labs_septic", 18, 99, 2500, TURNS, 7},
    {"endrass_octic", 2.5, 112, 1500, TURNS | FLIP, 8},
    {"barth_decic", 2, 300, 1500, SIGNS | CYCLES, 0},
    {"chmutov of degree 6", 1.7, 54, 500, SIGNS | CYCLES, 0},
    {"chmutov of degree 14", 1.7, 3 * 6 * 49, 12000, SIGNS | CYCLES, 0},
};
enum { CENSUSES = sizeof censuses / sizeof *censuses };

enum { MAX_TWINS = 8 };

/* Returns the images of p under the generators of the surface's symmetries; returns how many. */
static int twins_of(const Census *census, const Real p[3], Real twins[MAX_TWINS][3])
{
    int count = 0;
    for (int i = 0; census->symmetries & SIGNS && i < 3; i++, count++)
        for (int k = 0; k < 3; k++)
            twins[count][k] = k == i ? -p[k] : p[k];
    if (census->symmetries & CYCLES) {
        for (int k = 0; k < 3; k++)
            twins[count][k] = p[(k + 1) % 3];
        count++;
    }
    if (census->symmetries & TURNS) {
        Real turn = 8 * atanl(1) / census->turns, c = cosl(turn), s = sinl(turn);
        Real turned[3] = {c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]};
        for (int k = 0; k < 3; k++) {
            twins[count][k]     = turned[k];
            twins[count + 1][k] = k == 1 ? -p[k] : p[k];
        }
        count += 2;
    }
    if (census->symmetries & FLIP) {
        for (int k = 0; k < 3; k++)
            twins[count][k] = k == 2 ? -p[k] : p[k];
        count++;
    }
    return count;
}

/* What one seed finds leads to all that look like it; every one of them is found by itself. */
static void find_nodes(const Census *census, Formula *formula, Nodes *nodes)
{
    Random random = {31};
    for (int i = 0; i < census->seeds; i++) {
        Vec  seed = random_in_ball(&random, vec(0, 0, 0), census->reach);
        Real p[3] = {seed.x, seed.y, seed.z};
        if (find_node(formula, p))
            add_node(nodes, p);
    }
    for (int i = 0; i < nodes->count; i++) {
        Vec  point = nodes->points[i];
        Real p[3]  = {point.x, point.y, point.z}, twins[MAX_TWINS][3];
        int  count = twins_of(census, p, twins);
        for (int k = 0; k < count; k++)
            if (find_node(formula, twins[k]))
                add_node(nodes, twins[k]);
    }
}

/* The distance is 0 at a node, and near one it goes down as the way there does: a field divided by
   its slope would go down with the square. */
static void distances_reach_nodes(const Surface *surface, const Nodes *nodes)
{
    double farthest = 0, sum = 0, change = 0;
    for (int i = 0; i < nodes->count; i++)
        farthest = fmax(farthest, vec_length(nodes->points[i]));
    Product product = surface_compile(surface, 2 * farthest + 1, false);
    Random  random  = {41};
    for (int i = 0; i < nodes->count; i++) {
        Vec    node = nodes->points[i], direction = random_unit(&random);
        double size = 1 + vec_length(node);
        double zero = fabs(product_distance(&product, node));
        if (zero > 1e-6 * size)
            fail_msg("%s: at a node the distance is %g", surface->name, zero);
        double far = 1e-3 * size, near = 1e-4 * size;
        double more = fabs(product_distance(&product, vec_add(node, vec_scale(far, direction)))) /
                      far;
        double less = fabs(product_distance(&product, vec_add(node, vec_scale(near, direction)))) /
                      near;
        if (more > 1 + 1e-6 || less > 1 + 1e-6)
            fail_msg("%s: %g and %g of the way to a node", surface->name, more, less);
        sum += less;
        change += fabs(more - less);
    }
    if (nodes->count > 0 && (sum < 0.05 * nodes->count || change > 0.3 * sum))
        fail_msg("%s: near its nodes the distance is %g of the way on average, and changes by %g",
                 surface->name, sum / nodes->count, change / nodes->count);
    product_free(&product);
}

static void has_its_nodes(void **state)
{
    static Nodes   nodes;
    const Census  *census  = *state;
    const Surface *surface = surface_named(census->name);
    nodes.count            = 0;
    find_nodes(census, surface->formula, &nodes);
    if (nodes.count != census->nodes)
        fail_msg("%s: %d nodes were found, not %d", census->name, nodes.count, census->nodes);
    distances_reach_nodes(surface, &nodes);
}

/* ---- Sarti's nodes ---- */

/* Returns the corners of the 600-cell: all of (1, 0, 0, 0), (1, 1, 1, 1) / 2 and the even
   permutations of (g, 1, 1 / g, 0) / 2, with all signs. */
static int corners_of_600_cell(double corners[120][4])
{
    const double g     = 1.6180339887498949;
    int          count = 0;
    for (int i = 0; i < 8; i++, count++)
        for (int k = 0; k < 4; k++)
            corners[count][k] = k == i / 2 ? 1 - 2 * (i % 2) : 0;
    for (int i = 0; i < 16; i++, count++)
        for (int k = 0; k < 4; k++)
            corners[count][k] = i >> k & 1 ? -0.5 : 0.5;
    for (int order = 0; order < 256; order++) {
        int place[4] = {order & 3, order >> 2 & 3, order >> 4 & 3, order >> 6}, inversions = 0;
        int seen = 0;
        for (int i = 0; i < 4; i++) {
            seen |= 1 << place[i];
            for (int k = 0; k < i; k++)
                inversions += place[k] > place[i];
        }
        if (seen != 15 || inversions % 2 != 0)
            continue;
        for (int signs = 0; signs < 8; signs++, count++) {
            double parts[4] = {g / 2, 0.5, 0.5 / g, 0};
            for (int k = 0; k < 4; k++)
                corners[count][place[k]] = signs >> k & 1 ? -parts[k] : parts[k];
        }
    }
    return count;
}

static double dot4(const double a[4], const double b[4])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

/* They are the middles of its 1200 triangles, two to a point of projective space. */
static void sarti_has_its_nodes(void **state)
{
    static Nodes   nodes;
    static double  corners[120][4];
    const Surface *surface  = surface_named("sarti_dodecic");
    const double   edge     = 0.80901699437494745; /* the cosine of what neighbours are apart */
    int            infinite = 0, triangles = 0;
    (void)state;
    assert_int_equal(corners_of_600_cell(corners), 120);
    for (int a = 0; a < 120; a++)
        for (int b = a + 1; b < 120; b++)
            for (int c = b + 1; c < 120; c++) {
                if (fabs(dot4(corners[a], corners[b]) - edge) > 1e-9 ||
                    fabs(dot4(corners[b], corners[c]) - edge) > 1e-9 ||
                    fabs(dot4(corners[a], corners[c]) - edge) > 1e-9)
                    continue;
                double q[4];
                for (int k = 0; k < 4; k++)
                    q[k] = corners[a][k] + corners[b][k] + corners[c][k];
                triangles++;
                infinite += fabs(q[3]) < 1e-9;
                Real p[3] = {q[1] / q[3], q[0] / q[3], q[2] / q[3]};
                if (fabs(q[3]) < 1e-9)
                    continue;
                assert_true(find_node(surface->formula, p));
                assert_true(hypot((double)p[0] - q[1] / q[3], (double)p[1] - q[0] / q[3]) < 1e-6);
                add_node(&nodes, p);
            }
    assert_int_equal(triangles, 1200);
    assert_int_equal(infinite / 2, 40);
    assert_int_equal(nodes.count, 560);
    distances_reach_nodes(surface, &nodes);
}

/* ---- pictures ---- */

/* From its vantage, NAME_view, a surface fills a good part of a picture, and touches no edge. */
static void is_well_in_view(void **state)
{
    enum { WIDTH = 48, HEIGHT = 27 };
    const Surface *surface = *state;
    int            name = (int)strcspn(surface->name, " "), hits = 0, on_edge = 0;
    KrsView        view;
    Product        product = product_format("use \"std/surfaces.krs\";\nshow %.*s();\n"
                                                   "camera { eye: %.*s_view }",
                                            name, surface->name, name, surface->name);
    assert_int_equal(krs_state_view(product.state, 0, &view), KRS_OK);
    Vec    eye     = vec(view.camera.eye[0], view.camera.eye[1], view.camera.eye[2]);
    Vec    forward = vec_unit(vec_scale(-1, eye)), up = vec(0, 1, 0);
    Vec    right = vec_unit(vec_cross(forward, up));
    double half  = tan(20 * M_PI / 180);
    up           = vec_cross(right, forward);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        int    column = i % WIDTH, row = i / WIDTH;
        double u         = half * WIDTH / HEIGHT * (2 * (column + 0.5) / WIDTH - 1);
        double v         = half * (2 * (row + 0.5) / HEIGHT - 1);
        Vec    direction = vec_add(forward, vec_add(vec_scale(u, right), vec_scale(v, up)));
        bool   hit       = product_raycast(&product, eye, direction, 1e3, 0.01).hit;
        bool   edge      = row == 0 || row == HEIGHT - 1 || column == 0 || column == WIDTH - 1;
        hits += hit;
        on_edge += hit && edge;
    }
    if (hits * 20 < WIDTH * HEIGHT || on_edge > 0)
        fail_msg("%s: %d of %d, %d at the edge", surface->name, hits, WIDTH * HEIGHT, on_edge);
    product_free(&product);
}

/* ---- all of it ---- */

typedef struct Check {
    const char *what;
    void (*run)(void **state);
} Check;

int main(void)
{
    static const Check checks[] = {{"is safe", is_safe},
                                   {"is where rays find it", rays_find_first_roots},
                                   {"is a thin sheet when open", sheets_are_thin},
                                   {"is well in view", is_well_in_view}};
    enum { CHECKS = sizeof checks / sizeof *checks };
    static struct CMUnitTest tests[CHECKS * SURFACES + CENSUSES + 1];
    static char              names[CHECKS * SURFACES + CENSUSES][64];
    size_t                   count = 0;
    for (size_t i = 0; i < SURFACES; i++)
        for (size_t k = 0; k < CHECKS; k++, count++) {
            snprintf(names[count], sizeof names[0], "%s %s", surfaces[i].name, checks[k].what);
            tests[count] = (struct CMUnitTest){names[count], checks[k].run, NULL, NULL,
                                               (void *)(uintptr_t)&surfaces[i]};
        }
    for (size_t i = 0; i < CENSUSES; i++, count++) {
        snprintf(names[count], sizeof names[0], "%s has %d nodes", censuses[i].name,
                 censuses[i].nodes);
        tests[count] = (struct CMUnitTest){names[count], has_its_nodes, NULL, NULL,
                                           (void *)(uintptr_t)&censuses[i]};
    }
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(sarti_has_its_nodes);
    return _cmocka_run_group_tests("surfaces", tests, count, NULL, NULL);
}
