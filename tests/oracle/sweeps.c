/*
 * sweeps.c: figures along paths against their definition.  The nearest point of the path is searched
 * among many, and the figure's frame is carried from point to point, so nothing is known of
 * parabolas but how to evaluate them.
 */
#include <stdio.h>

#include "tests/oracle/judge.h"
#include "tests/oracle/product.h"

static const double PI = 3.14159265358979323846;

enum { MAX_PARTS = 4, STEPS = 600, POINTS = 160 };

/* Parabolas that continue each other, their figure a rectangle of this half size. */
typedef struct Path {
    Vec    parts[MAX_PARTS][3];
    int    count;
    Vec    up; /* where it begins */
    double wide, high, twist, taper;
    Vec    frames[MAX_PARTS * STEPS + 1]; /* the y axis at each step, before twist */
    double ways[MAX_PARTS * STEPS + 1];   /* the share of the path's length before it */
} Path;

/* `t` counts parts. */
static int part_at(const Path *path, double t) { return (int)fmin(floor(t), path->count - 1); }

static Vec path_at(const Path *path, double t)
{
    const Vec *part = path->parts[part_at(path, t)];
    double     s    = t - part_at(path, t);
    return vec_mix(vec_mix(part[0], part[1], s), vec_mix(part[1], part[2], s), s);
}

static Vec path_tangent(const Path *path, double t)
{
    const Vec *part = path->parts[part_at(path, t)];
    double     s    = t - part_at(path, t);
    return vec_unit(vec_sub(vec_mix(part[1], part[2], s), vec_mix(part[0], part[1], s)));
}

/* Lengths by chords of many small steps. */
static void path_measure(Path *path)
{
    for (int i = 0; i < path->count * STEPS; i++)
        path->ways[i + 1] = path->ways[i] + vec_distance(path_at(path, (double)i / STEPS),
                                                         path_at(path, (i + 1.0) / STEPS));
    for (int i = 0; i <= path->count * STEPS; i++)
        path->ways[i] /= path->ways[path->count * STEPS];
}

/* Frames by transport in many small steps: what is along the tangent is taken away. */
static void path_close(Path *path)
{
    path->ways[0] = 0;
    path_measure(path);
    path->frames[0] = path->up;
    for (int i = 0; i <= path->count * STEPS; i++) {
        Vec along = path_tangent(path, (double)i / STEPS), last = path->frames[i ? i - 1 : 0];
        path->frames[i] = vec_unit(vec_sub(last, vec_scale(vec_dot(last, along), along)));
    }
}

/* Three points at the same speed go on where the last part ends. */
static void path_extend(Path *path, Vec to)
{
    Vec *last = path->parts[path->count - 1], *next = path->parts[path->count];
    next[0] = last[2];
    next[1] = vec_add(last[2], vec_sub(last[2], last[1]));
    next[2] = to;
    path->count++;
}

static double path_nearest(const Path *path, Vec point)
{
    double best = 0, low, high;
    for (int i = 0; i <= path->count * 60; i++)
        if (vec_distance(point, path_at(path, i / 60.0)) < vec_distance(point, path_at(path, best)))
            best = i / 60.0;
    low  = fmax(0, best - 1 / 60.0);
    high = fmin(path->count, best + 1 / 60.0);
    for (int i = 0; i < 60; i++) {
        double a = low + (high - low) / 3, b = high - (high - low) / 3;
        if (vec_distance(point, path_at(path, a)) < vec_distance(point, path_at(path, b)))
            high = b;
        else
            low = a;
    }
    return (low + high) / 2;
}

static double path_way(const Path *path, double t)
{
    int step = (int)fmin(floor(t * STEPS), path->count * STEPS - 1);
    return path->ways[step] + (t * STEPS - step) * (path->ways[step + 1] - path->ways[step]);
}

/* The figure's axes at a place of the path. */
static void path_axes(const Path *path, double t, Vec *x, Vec *y)
{
    Vec    along = path_tangent(path, t);
    double angle = path->twist * path_way(path, t);
    Vec    frame = path->frames[(int)round(t * STEPS)];
    frame        = vec_unit(vec_sub(frame, vec_scale(vec_dot(frame, along), along)));
    *y           = vec_rotate(frame, along, angle);
    *x           = vec_cross(*y, along);
}

static bool in_sweep(const void *user, Vec point)
{
    const Path *path = user;
    double      t    = path_nearest(path, point);
    Vec         q    = vec_sub(point, path_at(path, t)), x, y;
    double      size = 1 + (path->taper - 1) * path_way(path, t);
    path_axes(path, t, &x, &y);
    return fabs(vec_dot(q, path_tangent(path, t))) < 1e-6 &&
           fabs(vec_dot(q, x)) <= path->wide * size && fabs(vec_dot(q, y)) <= path->high * size;
}

static Product path_product(const Path *path)
{
    SceneText text = {.length = 0};
    scene_write(&text, "show sweep(rectangle([%.17g, %.17g]), [", 2 * path->wide, 2 * path->high);
    for (int i = 0; i < path->count; i++) {
        scene_write(&text, "%s[", i ? ", " : "");
        for (int k = 0; k < 3; k++) {
            Vec v = path->parts[i][k];
            scene_write(&text, "%s[%.17g, %.17g, %.17g]", k ? ", " : "", v.x, v.y, v.z);
        }
        scene_write(&text, "]");
    }
    scene_write(&text, "], twist: %.17g, taper: %.17g);", path->twist, path->taper);
    return product_compile(text.bytes);
}

/* Returns a path that begins along z, so that y is up. */
static Path path_new(double twist, double taper)
{
    return (Path){.parts = {{vec(-0.3, 0, -1), vec(-0.3, 0, -0.4), vec(-0.1, 0.3, 0)}},
                  .count = 1,
                  .up    = vec(0, 1, 0),
                  .wide  = 0.12,
                  .high  = 0.07,
                  .twist = twist,
                  .taper = taper};
}

static void path_lengthen(Path *path)
{
    path_extend(path, vec(0.4, 0.7, 0.4));
    path_extend(path, vec(1.1, 0.5, 0.2));
}

/* What overlaps inside, and what a parabola is bent by less than its neighbour, is a thousandth of the
   figure: points so near to the surface are not asked for. */
static void check_path(Path *path, uint64_t seed)
{
    path_close(path);
    Product product = path_product(path);
    Trial trial = {product_field, &product, in_sweep, path, vec(0.2, 0.2, -0.2), 1.1, POINTS, seed};
    judge_acquits(&trial, "sweep");
    judge_refutes_larger(&trial, 1.6, "sweep");
    product_free(&product);
}

static void sweeps_are_their_definition(void **state)
{
    (void)state;
    static const double kinds[][2] = {{0, 1}, {PI, 1}, {0, 0.4}, {-2 * PI, 0.5}};
    static Path         path;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        for (int longer = 0; longer < 2; longer++) {
            path = path_new(kinds[i][0], kinds[i][1]);
            if (longer)
                path_lengthen(&path);
            check_path(&path, 7 + i);
        }
}

/* Beside a side of the figure the distance is that to the side: exact without twist and taper, and
   with them less by no more than half. */
static void sweeps_are_sharp(void **state)
{
    (void)state;
    static Path path;
    Random      random = {5};
    for (int kind = 0; kind < 2; kind++) {
        path = path_new(kind ? PI : 0, 1);
        path_lengthen(&path);
        path_close(&path);
        Product product = path_product(&path);
        for (int i = 1; i < path.count; i++) /* no sheet where parts meet */
            assert_true(product_distance(&product, path_at(&path, i)) < 0);
        for (int i = 0; i < 300; i++) {
            double t = random_between(&random, 0.02, path.count - 0.02), off = 0.003;
            Vec    x, y, at = path_at(&path, t);
            path_axes(&path, t, &x, &y);
            double side  = random_between(&random, -0.5, 0.5) * path.high;
            Vec    point = vec_add(at, vec_add(vec_scale(path.wide + off, x), vec_scale(side, y)));
            double distance = product_distance(&product, point);
            if (!(distance <= off * 1.005 && distance >= (kind ? 0.5 : 0.99) * off))
                fail_msg("twist %g, at %g of the path: %g, truly %g", path.twist, t, distance, off);
        }
        product_free(&product);
    }
}

/* Inside a little below the figure's edge along y, outside a little above it. */
static void check_edge(const Product *product, Vec at, Vec axis, double high)
{
    double below = product_distance(product, vec_add(at, vec_scale(high - 0.01, axis)));
    double above = product_distance(product, vec_add(at, vec_scale(high + 0.01, axis)));
    if (!(below < 0 && above > 0))
        fail_msg("at (%g, %g, %g): %g below the edge, %g above", at.x, at.y, at.z, below, above);
}

/* A frame that stays upright leans against the path alone. */
static void frames_stay_upright(void **state)
{
    (void)state;
    Product product = product_format(
        "show sweep(rectangle([0.1, 0.3]), winding(0.6, 0.4, 2), upright: true);");
    for (int i = 0; i < 200; i++) {
        double t = -1.9 * PI + 3.8 * PI * i / 200, rise = 0.2 / PI;
        Vec    at    = vec(0.6 * cos(t), rise * t, -0.6 * sin(t));
        Vec    along = vec_unit(vec(-0.6 * sin(t), rise, -0.6 * cos(t)));
        check_edge(&product, at, vec_unit(vec_sub(vec(0, 1, 0), vec_scale(along.y, along))), 0.15);
    }
    product_free(&product);
}

/* Returns how far the solid goes in a direction from a point of its path. */
static double reach_of(const Product *product, Vec from, Vec direction)
{
    double far = 0;
    while (far < 1 && product_distance(product, vec_add(from, vec_scale(far, direction))) < 0)
        far += 0.001;
    return far;
}

/* Where a closed path begins, its end fits: sections before and after it are alike. */
static void closed_sweeps_fit(void **state)
{
    (void)state;
    static const char closed[] =
        "show sweep(rectangle([0.1, 0.2]), spline([[cos(60deg * i), 0.3 * sin(120deg * i + 0.3),"
        " sin(60deg * i) * (0.8 + 0.2 * (i %% 2))] for i in 0..6], closed: true)%s);";
    static const char *const kinds[] = {"", ", upright: true", ", twist: 360deg"};
    for (size_t kind = 0; kind < sizeof kinds / sizeof *kinds; kind++) {
        char text[300];
        snprintf(text, sizeof text, closed, kinds[kind]);
        Product product = product_compile(text);
        Vec     at = vec(1, 0.3 * sin(0.3), 0), along = vec(0, 0, 0);
        for (int i = 1; i < 6; i += 4) { /* towards the next point, and from the last */
            Vec step = vec(cos(i * PI / 3), 0.3 * sin(i * 2 * PI / 3 + 0.3), sin(i * PI / 3));
            along    = vec_add(along, vec_scale(i == 1 ? 1 : -1, vec_unit(vec_sub(step, at))));
        }
        along      = vec_unit(along);
        Vec across = vec_across(along);
        for (int i = 0; i < 72; i++) {
            Vec    out = vec_rotate(across, along, i * PI / 36), back = vec_scale(0.01, along);
            double before = reach_of(&product, vec_sub(at, back), out);
            double after  = reach_of(&product, vec_add(at, back), out);
            if (fabs(before - after) > 0.02)
                fail_msg("a closed sweep%s does not fit: %g before, %g after", kinds[kind], before,
                         after);
        }
        product_free(&product);
    }
}

/* `.distance` is the distance, or a bound of slope 1, and `.bounds` the corners of a box. */
static void shapes_tell_of_themselves(void **state)
{
    (void)state;
    static const char *const pairs[][2] = {
        {"show box([1, 0.6, 0.8]).move([0.2, 0, 0]);",
         "shape moved(b = box()) { distance: b.distance(p - [0.2, 0, 0]), slope: 1 }\n"
         "show moved(box([1, 0.6, 0.8]));"},
        {"show star(5, 1, 0.4).extrude(0.5);",
         "shape tall(f = circle()) { distance: let d = [f.distance([x, y]), abs(z) - 0.25] in"
         " length(max(d, 0)) + min(max(d), 0), slope: 1, within: let b = f.bounds() in"
         " [[b[0][0], b[0][1], -0.25], [b[1][0], b[1][1], 0.25]] }\nshow tall(star(5, 1, 0.4));"}};
    Random random = {9};
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        Product a = product_compile(pairs[i][0]), b = product_compile(pairs[i][1]);
        for (int k = 0; k < 300; k++) {
            Vec point = random_in_cube(&random, 1.5);
            assert_true(fabs(product_distance(&a, point) - product_distance(&b, point)) < 1e-12);
        }
        product_free(&a);
        product_free(&b);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sweeps_are_their_definition), cmocka_unit_test(sweeps_are_sharp),
        cmocka_unit_test(frames_stay_upright),         cmocka_unit_test(closed_sweeps_fit),
        cmocka_unit_test(shapes_tell_of_themselves),
    };
    return cmocka_run_group_tests_name("sweeps", tests, NULL, NULL);
}
