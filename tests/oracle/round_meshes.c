/*
 * round_meshes.c: solids of round and flat parts have few triangles, are within the error, and have the right shape.
 *
 * Random parts are joined by random set operations.  What is inside is told by the definitions of the parts.
 *
 * round_meshes [COUNT]: so many random solids.
 */
#include "tests/oracle/mesh_distance.h"
#include "tests/oracle/mesh_shape.h"
#include "tests/oracle/product.h"
#include "tests/support/folder.h"

#include <stdio.h>
#include <stdlib.h>

static const double PI     = 3.14159265358979323846;
static uint64_t     wanted = 14; /* random solids */

static KrsMesh *mesh_of_text(const char *text, double error)
{
    Product        product = product_compile(text);
    KrsMeshOptions options = {.error = error};
    KrsMesh       *mesh;
    assert_int_equal(krs_mesh(product.state, &options, &mesh), KRS_OK);
    product_free(&product);
    check_closed(mesh);
    return mesh;
}

/* ---- closed forms ---- */

/* So many sides a polygon has at least that is within the error of a circle and has its corners on it. */
static double min_sides(double error, double radius) { return PI / acos(1 - error / radius); }

static void solids_have_few_triangles(void **state)
{
    static const struct {
        const char *text;
        double error, each; /* triangles at least: that times the sides of one or two circles */
        double radii[2];
        double factor; /* and so many times these at most */
        long   genus;
        double volume, area;
    } solids[] = {
        {"show cylinder(1, 2);", 0.01, 4, {1}, 1.5, 0, 2 * PI, 6 * PI},
        {"show cylinder(1, 2).rotate([1, 2, 3], 1).move([5, 6, 7]);",
         0.001,
         4,
         {1},
         1.3,
         0,
         2 * PI,
         6 * PI},
        {"show cylinder(1, 2) - cylinder(0.5, 3);", 0.01, 8, {1}, 1.5, 1, 1.5 * PI, 7.5 * PI},
        {"show cone(1, 2);", 0.01, 2, {1}, 1.5, 0, 2 * PI / 3, 3.236 * PI},
        /* Hundreds of sides do not meet in a tip. */
        {"show cone(1, 2);", 0.0002, 2, {1}, 2.6, 0, 2 * PI / 3, 3.236 * PI},
        {"show box([2, 2, 2]).move([0, -1, 0]) | cone(1, 1.8).move([0, 0.8, 0]);",
         0.001,
         2,
         {1},
         4,
         0,
         8 + PI / 3 * 1.7 * 1.7 * 1.7 / 3.24,
         26},
        {"show box([2, 2, 2]).rotate([1, 2, 3], 1) - cone(0.8, 1.6).move([0, -0.3, 0]).rotate([1, "
         "2, 3], 1);",
         0.001,
         2,
         {0.8},
         5,
         0,
         8 - 0.28125 * PI,
         30},
        {"show cylinder(1, 2).taper([0, 1, 0], 1, 0.5);",
         0.01,
         4,
         {1},
         1.5,
         0,
         3.5 / 3 * PI,
         4.3423 * PI},
        {"show capped_cone(1, 0.5, 1);", 0.01, 4, {1}, 1.5, 0, 1.75 / 3 * PI, 3 * PI},
        {"show sphere(1);", 0.01, 1, {1, 1}, 3, 0, 4 * PI / 3, 4 * PI},
        {"show sphere(1);", 0.001, 1, {1, 1}, 3, 0, 4 * PI / 3, 4 * PI},
        {"show torus(1, 0.3);", 0.005, 2, {1.3, 0.3}, 3, 1, 0.18 * PI * PI, 1.2 * PI * PI},
        {"show capsule([-0.6, -0.3, 0], [0.6, 0.3, 0.1], radius: 0.3);",
         0.005,
         1,
         {0.3, 0.3},
         4,
         0,
         0.09 * PI * (1.3453624 + 0.4),
         3.667},
        /* The rim has 32 degrees. */
        {"show sphere(20) - cylinder(17, 100);",
         0.2,
         1,
         {20, 20},
         7,
         1,
         4 * PI / 3 * 1169.4618,
         4898.6},
        {"show box([2, 1, 1]) - sphere(0.7);", 0.01, 1, {0.7, 0.7}, 7, 3, 0, 0},
    };
    (void)state;
    for (size_t i = 0; i < sizeof solids / sizeof *solids; i++) {
        double    error = solids[i].error, least = solids[i].each;
        KrsMesh  *mesh  = mesh_of_text(solids[i].text, error);
        MeshShape shape = mesh_shape(mesh);
        for (int k = 0; k < 2; k++)
            least *= solids[i].radii[k] > 0 ? min_sides(error, solids[i].radii[k]) : 1;
        print_message("# %zu triangles, at least %.0f; volume %.6f of %.6f: %s\n",
                      mesh->triangle_count, least, shape.volume, solids[i].volume, solids[i].text);
        assert_int_equal(mesh->unresolved, 0);
        assert_true((double)mesh->triangle_count < solids[i].factor * least);
        assert_int_equal(shape.parts, 1);
        assert_int_equal(shape.euler, 2 - 2 * solids[i].genus);
        if (solids[i].volume > 0)
            assert_true(fabs(shape.volume - solids[i].volume) < error * solids[i].area);
        krs_mesh_free(mesh);
    }
}

/* ---- rims ---- */

/* Where two round faces meet at a small angle, the rim is off by a multiple of what they are: there is a proof of its own. */
static void sharp_rims_are_within_the_error(void **state)
{
    static const double ANGLES[] = {16, 24, 40, 70};
    enum { AROUND = 720 };
    (void)state;
    for (size_t i = 0; i < sizeof ANGLES / sizeof *ANGLES; i++) {
        double half = ANGLES[i] * PI / 360, error = 0.02 * sin(half), farthest = 0;
        char   text[256];
        snprintf(text, sizeof text,
                 "show sphere(1).move([0, %.17g, 0]) & sphere(1).move([0, %.17g, 0]);", cos(half),
                 -cos(half));
        KrsMesh  *mesh = mesh_of_text(text, error);
        MeshGrid *grid = mesh_grid_new(mesh, 8 * error);
        for (int k = 0; k < AROUND; k++) {
            double angle = k * 2 * PI / AROUND;
            Vec    at    = vec(sin(half) * cos(angle), 0, sin(half) * sin(angle));
            farthest     = fmax(farthest, mesh_grid_distance(grid, at) / error);
        }
        print_message(
            "# a rim of %g degrees: %zu triangles, %zu unresolved, at most %.3f errors away\n",
            ANGLES[i], mesh->triangle_count, mesh->unresolved, farthest);
        assert_true(farthest <= 1);
        mesh_grid_free(grid);
        krs_mesh_free(mesh);
    }
}

/* ---- what touches ---- */

static void solids_that_touch_stay_apart(void **state)
{
    static const struct {
        const char *text;
        double      error;
        long        parts, euler;
        size_t      most; /* triangles: no number of sides would prove what touches */
    } solids[] = {
        {"show cylinder(1, 2) | cylinder(1, 2).move([2, 0, 0]);", 0.1, 2, 4, 80},
        {"show sphere(0.5).move([0, 0.5, 0]) | box([1, 0.2, 1]).move([0, -0.1, 0]);", 0.02, 2, 4,
         800},
        {"show cone(1, 2).move([0, -1, 0]) | cone(1, 2).rotate([1, 0, 0], 180deg).move([0, 1, 0]);",
         0.02, 2, 4, 80},
    };
    (void)state;
    for (size_t i = 0; i < sizeof solids / sizeof *solids; i++) {
        KrsMesh  *mesh  = mesh_of_text(solids[i].text, solids[i].error);
        MeshShape shape = mesh_shape(mesh);
        print_message("# %zu triangles, %ld parts, Euler number %ld: %s\n", mesh->triangle_count,
                      shape.parts, shape.euler, solids[i].text);
        assert_int_equal(shape.parts, solids[i].parts);
        assert_int_equal(shape.euler, solids[i].euler);
        assert_true(mesh->triangle_count <= solids[i].most);
        krs_mesh_free(mesh);
    }
}

/* ---- what is not thin ---- */

/* Which face of a hull there is depends on conditions that are round, too; between the ends of an arc and the rest they are
   planes, and exact. */
static void nothing_is_reported_at_seams(void **state)
{
    static const struct {
        const char *text;
        double      error;
        size_t      most;
        int         euler;
    } rows[] = {
        {"show hull(cylinder(0.5, 0.2), cylinder(0.2, 0.2).move([1.2, 0, 0]));", 0.02, SIZE_MAX, 2},
        {"show hull(sphere(0.8), sphere(0.3).move([2, 0.4, 0]));", 0.02, SIZE_MAX, 2},
        {"show arc(1.3, 120deg, 0.5).extrude(0.6);", 0.02, 200, 2},
        {"show circle(2).extrude(0.4) - arc(1.3, 120deg, 0.5).extrude(0.6);", 0.01, 400, 0},
        {"show circle(2).extrude(0.4) - arc(1.3, 120deg, 0.5).extrude(0.6);", 0.002, 800, 0},
        /* Parts of a sweep overlap by little, at the plane of a mitre. */
        {"show sweep(rectangle([0.2, 0.2]), [[0, 0, 0], [2, 0, 0], [2, 1, 0]], taper: 0.8);", 0.012,
         SIZE_MAX, 2},
        /* The error is a quarter of the radius, and the notches between balls are a thirtieth of it deep. */
        {"show union([sphere(2).move([i, 0, 0]) for i in 0..100]);", 0.5, 10000, 2},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        KrsMesh  *mesh  = mesh_of_text(rows[i].text, rows[i].error);
        MeshShape shape = mesh_shape(mesh);
        print_message("# %zu triangles, %zu unresolved: %s\n", mesh->triangle_count,
                      mesh->unresolved, rows[i].text);
        assert_int_equal(mesh->unresolved, 0);
        assert_int_equal(shape.euler, rows[i].euler);
        assert_true(mesh->triangle_count < rows[i].most);
        krs_mesh_free(mesh);
    }
}

/* ---- random solids ---- */

enum { MAX_PARTS_HERE = 6 };

typedef enum Kind { A_BALL, A_CYLINDER, A_CONE, A_RING, A_CAPSULE, A_BOX, KINDS } Kind;

typedef struct Part {
    Kind   kind;
    double size[3];
    Vec    axis, shift;
    double angle;
    char   joined; /* to what is before it */
} Part;

typedef struct Parts {
    Part   list[MAX_PARTS_HERE];
    size_t count;
} Parts;

static Part random_part(Random *random)
{
    Part part  = {.kind   = (Kind)random_below(random, KINDS),
                  .axis   = random_unit(random),
                  .angle  = random_below(random, 2) ? random_between(random, 0, 2 * PI) : 0,
                  .joined = "|-&|-"[random_below(random, 5)]};
    part.shift = vec_scale(random_between(random, 0, 0.9), random_unit(random));
    for (int k = 0; k < 3; k++)
        part.size[k] = random_between(random, 0.4, 1.2);
    return part;
}

static void write_part(SceneText *text, const Part *part)
{
    static const char *const forms[KINDS] = {
        [A_BALL]     = "sphere(%.17g)",
        [A_CYLINDER] = "cylinder(%.17g, %.17g)",
        [A_CONE]     = "cone(%.17g, %.17g)",
        [A_RING]     = "torus(%.17g, 0.4 * %.17g)",
        [A_CAPSULE]  = "capsule([0, -%.17g, 0], [0, 0, 0], %.17g)",
        [A_BOX]      = "box([%.17g, %.17g, %.17g])"};
    char form[256];
    snprintf(form, sizeof form, forms[part->kind], part->size[0], part->size[1], part->size[2]);
    scene_write(text, "%s.rotate([%.17g, %.17g, %.17g], %.17g).move([%.17g, %.17g, %.17g])", form,
                part->axis.x, part->axis.y, part->axis.z, part->angle, part->shift.x, part->shift.y,
                part->shift.z);
}

/* Rodrigues' formula, backwards. */
static Vec turned_back(const Part *part, Vec point)
{
    Vec    at = vec_sub(point, part->shift);
    double c = cos(part->angle), s = -sin(part->angle);
    Vec    turned = vec_add(vec_scale(c, at), vec_scale(s, vec_cross(part->axis, at)));
    return vec_add(turned, vec_scale((1 - c) * vec_dot(part->axis, at), part->axis));
}

static double value_of_part(const Part *part, Vec point)
{
    Vec           q    = turned_back(part, point);
    const double *size = part->size;
    double        out  = hypot(q.x, q.z);
    switch (part->kind) {
    case A_BALL: return vec_length(q) - size[0];
    case A_CYLINDER: return fmax(out - size[0], fabs(q.y) - size[1] / 2);
    case A_CONE: /* as far out as it is below the tip, times radius over height */
        return fmax((out - size[0] / size[1] * (size[1] / 2 - q.y)) / hypot(1, size[0] / size[1]),
                    -size[1] / 2 - q.y);
    case A_RING: return hypot(out - size[0], q.y) - 0.4 * size[1];
    case A_CAPSULE: return hypot(out, q.y - fmax(-size[0], fmin(q.y, 0))) - size[1];
    default:
        return fmax(fabs(q.x) - size[0] / 2,
                    fmax(fabs(q.y) - size[1] / 2, fabs(q.z) - size[2] / 2));
    }
}

static double value_of_parts(const void *user, Vec point)
{
    const Parts *parts = user;
    double       value = value_of_part(&parts->list[0], point);
    for (size_t i = 1; i < parts->count; i++) {
        double next = value_of_part(&parts->list[i], point);
        char   how  = parts->list[i].joined;
        value       = how == '|' ? fmin(value, next) : fmax(value, how == '&' ? next : -next);
    }
    return value;
}

static void write_parts(SceneText *text, const Parts *parts)
{
    text->length = 0;
    scene_write(text, "show ");
    for (size_t i = 1; i < parts->count; i++)
        scene_write(text, "(");
    for (size_t i = 0; i < parts->count; i++) {
        if (i > 0)
            scene_write(text, " %c ", parts->list[i].joined);
        write_part(text, &parts->list[i]);
        if (i > 0)
            scene_write(text, ")");
    }
    scene_write(text, ";");
}

static void random_solids_are_within_the_error(void **state)
{
    static SceneText text;
    size_t           largest = 0, hits = 0, points = 0, reported = 0;
    double           farthest = 0;
    (void)state;
    for (uint64_t turn = 0; turn < wanted; turn++) {
        Random random = {7003 + turn};
        Parts  parts  = {.count = 1 + (size_t)random_below(&random, MAX_PARTS_HERE)};
        for (size_t i = 0; i < parts.count; i++)
            parts.list[i] = random_part(&random);
        double error = exp(random_between(&random, log(0.003), log(0.06)));
        write_parts(&text, &parts);
        KrsMesh *mesh    = mesh_of_text(text.bytes, error);
        Surface  surface = {value_of_parts, &parts, vec(-3, -3, -3), vec(3, 3, 3)};
        Apart    apart   = mesh_apart(mesh, &surface, error, 120, 600, &random);
        if (apart.off_surface > 0 || (apart.lost > 0 && mesh->unresolved == 0) || apart.thick > 0)
            fail_msg(
                "%zu points off the surface, as %.9g %.9g %.9g; %zu hits lost, as %.9g %.9g %.9g: "
                "error %.17g of %s",
                apart.off_surface, apart.off_surface_at.x, apart.off_surface_at.y,
                apart.off_surface_at.z, apart.lost, apart.lost_at.x, apart.lost_at.y,
                apart.lost_at.z, error, text.bytes);
        largest = mesh->triangle_count > largest ? mesh->triangle_count : largest;
        reported += mesh->unresolved > 0;
        hits += apart.hits;
        points += apart.points;
        farthest = fmax(farthest, apart.farthest_hit);
        krs_mesh_free(mesh);
    }
    print_message("# %zu hits, at most %.3f errors away; %zu points; at most %zu triangles; %zu "
                  "solids with reports\n",
                  hits, farthest, points, largest, reported);
    assert_true(hits > 100 * wanted && farthest > 0.3);
}

/* ---- many balls ---- */

enum { MAX_BALLS = 400 };

typedef struct Balls {
    Vec    centers[MAX_BALLS];
    double radii[MAX_BALLS];
    size_t count;
} Balls;

static double value_of_balls(const void *user, Vec point)
{
    const Balls *balls = user;
    double       value = HUGE_VAL;
    for (size_t i = 0; i < balls->count; i++)
        value = fmin(value, vec_length(vec_sub(point, balls->centers[i])) - balls->radii[i]);
    return value;
}

/* Balls that overlap at random are one part with many instances: some are nearly tangent, and need
   many more sides than others.  A draft of hundreds is made of faces, too, of which few points are
   farther than the error. */
static void many_balls_are_within_the_error(void **state)
{
    static const struct {
        size_t count, most; /* balls, and triangles */
        double side, error;
        bool   draft;
    } rows[] = {{40, 40000, 9, 0.1, false}, {400, 90000, 10, 0.05, true}};
    static SceneText text;
    static Balls     balls;
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        Random random = {8111};
        double side   = rows[i].side;
        balls.count   = rows[i].count;
        text.length   = 0;
        scene_write(&text, "show union([sphere(b[3]).move([b[0], b[1], b[2]]) for b in [");
        for (size_t k = 0; k < balls.count; k++) {
            balls.radii[k]   = random_between(&random, 0.8, 1.4);
            balls.centers[k] = vec(random_between(&random, 0, side),
                                   random_between(&random, 0, side),
                                   random_between(&random, 0, side));
            scene_write(&text, "[%.17g, %.17g, %.17g, %.17g],", balls.centers[k].x,
                        balls.centers[k].y, balls.centers[k].z, balls.radii[k]);
        }
        scene_write(&text, "]]);");
        Product        product = product_compile(text.bytes);
        KrsMeshOptions options = {.error = rows[i].error, .draft = rows[i].draft};
        KrsMesh       *mesh;
        assert_int_equal(krs_mesh(product.state, &options, &mesh), KRS_OK);
        product_free(&product);
        check_closed(mesh);
        Surface surface = {value_of_balls, &balls, vec(-2, -2, -2),
                           vec(side + 2, side + 2, side + 2)};
        Apart   apart   = mesh_apart(mesh, &surface, rows[i].error, 300, 3000, &random);
        print_message(
            "# %zu balls: %zu triangles, %zu unresolved, %zu of %zu hits lost, %zu of %zu points "
            "astray, at most %.3f errors\n",
            balls.count, mesh->triangle_count, mesh->unresolved, apart.lost, apart.hits,
            apart.off_surface, apart.points, apart.farthest_hit);
        assert_true(apart.hits > 300 && mesh->triangle_count < rows[i].most);
        assert_true(mesh->estimate == rows[i].draft);
        assert_int_equal(apart.thick, 0);
        assert_true(apart.off_surface <= (rows[i].draft ? apart.points / 200 : 0));
        krs_mesh_free(mesh);
    }
}

/* ---- random outlines ---- */

/* A star of curves, of which each goes from a knot towards a handle and to the next; and its points, dense ones. */
enum { KNOTS = 7, DENSE = 48, AROUND = KNOTS * DENSE };
typedef struct Star {
    double knots[KNOTS][2], handles[KNOTS][2], points[AROUND][2];
    double height; /* of a column; 0: it goes around an axis */
    Vec    axis;   /* and is turned about this one */
    double angle;
} Star;

enum { TO_THE_AXIS = 2 };

static Star random_star(Random *random)
{
    Star star = {.height = random_below(random, 2) ? random_between(random, 0.3, 1) : 0,
                 .axis   = random_unit(random),
                 .angle  = random_between(random, 0, 2 * PI)};
    for (int i = 0; i < KNOTS; i++) {
        double from = i * 2 * PI / KNOTS, to = (i + 0.5) * 2 * PI / KNOTS;
        double radius = random_between(random, 0.5, 1), out = random_between(random, 0.3, 1.3);
        star.knots[i][0]   = radius * cos(from);
        star.knots[i][1]   = radius * sin(from);
        star.handles[i][0] = out * cos(to);
        star.handles[i][1] = out * sin(to);
    }
    for (int i = 0; i < AROUND; i++) {
        int    piece = i / DENSE;
        double t     = (double)(i % DENSE) / DENSE;
        for (int k = 0; k < 2; k++)
            star.points[i][k] = (1 - t) * (1 - t) * star.knots[piece][k] +
                                2 * t * (1 - t) * star.handles[piece][k] +
                                t * t * star.knots[(piece + 1) % KNOTS][k];
    }
    return star;
}

/* The y axis of drawings goes downwards. */
static void write_star(const Star *star)
{
    FILE *file = fopen("star.svg", "w");
    assert_non_null(file);
    fprintf(file,
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='-2 -2 4 4'><path d='M%.17g %.17g",
            star->knots[0][0], -star->knots[0][1]);
    for (int i = 0; i < KNOTS; i++)
        fprintf(file, "Q%.17g %.17g %.17g %.17g", star->handles[i][0], -star->handles[i][1],
                star->knots[(i + 1) % KNOTS][0], -star->knots[(i + 1) % KNOTS][1]);
    fprintf(file, "z'/></svg>");
    assert_int_equal(fclose(file), 0);
}

/* Returns the distance to the dense points' lines, below 0 where a ray to the right crosses them an
   odd number of times. */
static double value_of_figure(const Star *star, double x, double y)
{
    double least  = HUGE_VAL;
    bool   inside = false;
    for (int i = 0; i < AROUND; i++) {
        const double *a = star->points[i], *b = star->points[(i + 1) % AROUND];
        double way[2] = {b[0] - a[0], b[1] - a[1]}, t = (x - a[0]) * way[0] + (y - a[1]) * way[1];
        t     = fmax(0, fmin(1, t / (way[0] * way[0] + way[1] * way[1])));
        least = fmin(least, hypot(x - a[0] - t * way[0], y - a[1] - t * way[1]));
        if ((a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / way[1] * way[0])
            inside = !inside;
    }
    return inside ? -least : least;
}

static double value_of_star(const void *user, Vec point)
{
    const Star *star = user;
    Part        part = {.axis = star->axis, .angle = star->angle};
    Vec         at   = turned_back(&part, point);
    if (star->height == 0)
        return value_of_figure(star, hypot(at.x, at.z) - TO_THE_AXIS, at.y);
    return fmax(value_of_figure(star, at.x, at.y), fabs(at.z) - star->height / 2);
}

static void random_outlines_are_within_the_error(void **state)
{
    size_t most = 0, hits = 0;
    double farthest = 0;
    (void)state;
    for (uint64_t turn = 0; turn < wanted; turn++) {
        Random random = {9001 + turn};
        Star   star   = random_star(&random);
        double error  = exp(random_between(&random, log(0.004), log(0.04)));
        char   text[512], solid[64];
        write_star(&star);
        snprintf(solid, sizeof solid, star.height > 0 ? "extrude(%.17g)" : "revolve(%g)",
                 star.height > 0 ? star.height : (double)TO_THE_AXIS);
        snprintf(text, sizeof text,
                 "show union(svg(\"star.svg\", size: 4)).%s.rotate([%.17g, %.17g, %.17g], %.17g);",
                 solid, star.axis.x, star.axis.y, star.axis.z, star.angle);
        KrsMesh  *mesh    = mesh_of_text(text, error);
        MeshShape shape   = mesh_shape(mesh);
        Surface   surface = {value_of_star, &star, vec(-3.5, -3.5, -3.5), vec(3.5, 3.5, 3.5)};
        Apart     apart   = mesh_apart(mesh, &surface, error, 60, 300, &random);
        print_message("# error %.4f, %zu triangles, %zu unresolved: %s\n", error,
                      mesh->triangle_count, mesh->unresolved, solid);
        assert_int_equal(apart.off_surface, 0);
        assert_true(apart.thick == 0 && (apart.lost == 0 || mesh->unresolved > 0));
        assert_true(mesh->unresolved > 0 || shape.euler == (star.height > 0 ? 2 : 0));
        hits += apart.hits;
        farthest = fmax(farthest, apart.farthest_hit);
        most     = mesh->triangle_count > most ? mesh->triangle_count : most;
        krs_mesh_free(mesh);
    }
    print_message("# %zu hits, at most %.3f errors away; at most %zu triangles\n", hits, farthest,
                  most);
    assert_true(hits > 20 * wanted && farthest > 0.2 && most < 20000);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solids_have_few_triangles),
        cmocka_unit_test(sharp_rims_are_within_the_error),
        cmocka_unit_test(solids_that_touch_stay_apart),
        cmocka_unit_test(nothing_is_reported_at_seams),
        cmocka_unit_test(random_solids_are_within_the_error),
        cmocka_unit_test(many_balls_are_within_the_error),
        cmocka_unit_test_setup_teardown(random_outlines_are_within_the_error, enter_folder,
                                        leave_folder),
    };
    if (argc > 1)
        wanted = (uint64_t)atoi(argv[1]);
    product_wants_outlines();
    return cmocka_run_group_tests_name("round_meshes", tests, NULL, NULL);
}
