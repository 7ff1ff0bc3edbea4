/*
 * curves.c: coils, threads and tubes against their definitions: curves sampled finely and refined,
 * surfaces as clouds of points.
 */
#include "tests/oracle/judge.h"
#include "tests/oracle/product.h"

static const double PI = 3.14159265358979323846;

enum { POINTS = 400 };

/* A curve in space, for `t` from 0 to 1. */
typedef struct Line {
    Vec (*at)(const double *a, double t);
    double a[16];
    int    pieces; /* finer than the curve turns */
} Line;

static double line_distance(const Line *line, Vec point, double t)
{
    return vec_distance(point, line->at(line->a, t));
}

/* Returns the least distance between two places, by trisection. */
static double min_between(const Line *line, Vec point, double low, double high)
{
    for (int i = 0; i < 80; i++) {
        double a = low + (high - low) / 3, b = high - (high - low) / 3;
        if (line_distance(line, point, a) < line_distance(line, point, b))
            high = b;
        else
            low = a;
    }
    return line_distance(line, point, (low + high) / 2);
}

static double line_nearest(const Line *line, Vec point)
{
    double best = HUGE_VAL, before = HUGE_VAL, here = line_distance(line, point, 0);
    for (int i = 0; i <= line->pieces; i++) {
        double after = i < line->pieces ? line_distance(line, point, (i + 1.0) / line->pieces)
                                        : HUGE_VAL;
        if (here <= before && here <= after)
            best = fmin(best, min_between(line, point, fmax(0, i - 1.0) / line->pieces,
                                          fmin(line->pieces, i + 1.0) / line->pieces));
        before = here;
        here   = after;
    }
    return best;
}

/* ---- coils ---- */

/* Radius, pitch, turns, width, strands, strand: right-handed about y, the middle towards x. */
static Vec helix_at(const double *a, double t)
{
    double turn = (t - 0.5) * 2 * PI * a[2], angle = turn + 2 * PI * a[5] / a[4];
    double hand = a[1] < 0 ? -1 : 1;
    return vec(a[0] * cos(angle), fabs(a[1]) * turn / (2 * PI), -hand * a[0] * sin(angle));
}

static double helix_truth(const double *a, Vec point)
{
    double best = HUGE_VAL;
    for (int strand = 0; strand < a[4]; strand++) {
        Line line = {helix_at, {a[0], a[1], a[2], a[3], a[4], strand}, 16 + (int)(48 * a[2])};
        best      = fmin(best, line_nearest(&line, point));
    }
    return best - a[3] / 2;
}

static Product helix_product(const double *a)
{
    return product_format("show helix(%.17g, %.17g, %.17g, %.17g, strands: %.17g);", a[0], a[1],
                          a[2], a[3], a[4]);
}

/* Returns where the hard cases are: near the axis, opposite to a turn, beyond the ends. */
static Vec helix_place(Random *random, const double *a)
{
    double reach = random_below(random, 2) ? 2 * a[0] : 0.3 * a[0];
    double angle = random_between(random, 0, 2 * PI), out = random_between(random, 0, reach);
    double half = fabs(a[1]) * a[2] / 2 + fabs(a[1]);
    if (random_below(random, 3) == 0)
        out = a[0] > 0 ? pow(a[1] / (2 * PI), 2) / a[0] * random_between(random, 0.98, 1.02) : out;
    return vec(out * cos(angle), random_between(random, -half, half), out * sin(angle));
}

/* Returns how many of the points have another distance than that to the definition. */
static int helix_errors(const double *product_of, const double *a, Random *random)
{
    Product product = helix_product(product_of);
    int     errors  = 0;
    for (int i = 0; i < POINTS; i++) {
        Vec    point = helix_place(random, a);
        double truth = helix_truth(a, point), distance = product_distance(&product, point);
        errors += !(fabs(distance - truth) <= 1e-7 * (1 + fabs(truth)));
    }
    product_free(&product);
    return errors;
}

static void helices_are_exact(void **state)
{
    (void)state;
    static const double chosen[][5] = {
        {1, 0.5, 3, 0.2, 1},   {0.5, -0.3, 12, 0.1, 1}, {0.3, 1.9, 2, 0.2, 1},
        {0.2, 3, 1.5, 0.2, 3}, {0.1, -0.9, 3, 0.2, 3},  {1, 6.3, 1, 0.1, 1},
        {1, 0.7, 0.4, 0.1, 1}, {0.6, 5, 0.9, 0.1, 1},   {1, 0.4, 0.1, 0.1, 2},
        {0.5, 3, 0.3, 0.1, 2}, {0.2, 4, 5, 0.1, 5},     {1, 0.01, 2, 0.1, 1}};
    Random random = {1};
    for (size_t i = 0; i < sizeof chosen / sizeof *chosen; i++)
        if (helix_errors(chosen[i], chosen[i], &random))
            fail_msg("helix %zu is not exact", i);
    for (int i = 0; i < 20; i++) {
        double a[5] = {random_between(&random, 0.1, 1), random_between(&random, -2, 2),
                       random_between(&random, 0.1, 4), 0.1, 1 + random_below(&random, 4)};
        if (helix_errors(a, a, &random))
            fail_msg("helix(%g, %g, %g, strands: %g) is not exact", a[0], a[1], a[2], a[4]);
    }
}

/* A helix that is a little wrong is found out. */
static void wrong_helices_are_seen(void **state)
{
    (void)state;
    static const double right[5]   = {0.5, 0.6, 2.25, 0.1, 1};
    static const double wrong[][5] = {{0.5, -0.6, 2.25, 0.1, 1},
                                      {0.5, 0.6, 2.26, 0.1, 1},
                                      {0.5, 0.6, 2.25, 0.1, 2},
                                      {0.5, 0.6, 2.25, 0.10001, 1}};
    Random              random     = {2};
    assert_int_equal(helix_errors(right, right, &random), 0);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_true(helix_errors(wrong[i], right, &random) > 0);
}

/* ---- threads ---- */

/* Diameter, pitch, length, angle, depth, crest, starts, chamfer. */
typedef struct Thread {
    double diameter, pitch, length, angle, depth, crest, starts, chamfer;
} Thread;

/* Returns the radius at a distance along the axis from the middle of a ridge. */
static double thread_radius(const Thread *t, double along)
{
    double pitch = fabs(t->pitch), off = fabs(along - pitch * floor(along / pitch + 0.5));
    double down = fmax(0, off - t->crest / 2) / tan(t->angle / 2);
    return t->diameter / 2 - fmin(down, t->depth);
}

/* Returns how far ridges have risen at an angle about the axis. */
static double thread_rise(const Thread *t, double angle)
{
    return fabs(t->pitch) * t->starts * angle / (2 * PI);
}

static double thread_limit(const Thread *t, double y)
{
    return t->diameter / 2 - t->chamfer + t->length / 2 - fabs(y);
}

static bool in_thread(const void *user, Vec p)
{
    const Thread *t     = user;
    double        angle = atan2(t->pitch < 0 ? p.z : -p.z, p.x), out = hypot(p.x, p.z);
    return fabs(p.y) <= t->length / 2 && out <= thread_limit(t, p.y) &&
           out <= thread_radius(t, p.y - thread_rise(t, angle));
}

static Vec thread_patch(const void *user, double u, double v)
{
    const Thread *t     = user;
    double        angle = 2 * PI * (u - 0.5), y = t->length * (v - 0.5);
    double        out = fmin(thread_radius(t, y - thread_rise(t, angle)), thread_limit(t, y));
    return vec(out * cos(angle), y, (t->pitch < 0 ? 1 : -1) * out * sin(angle));
}

static Vec thread_lid(const void *user, double u, double v)
{
    const Thread *t   = user;
    Vec           rim = thread_patch(t, fmod(2 * u, 1), u < 0.5 ? 0 : 1);
    return vec(v * rim.x, rim.y, v * rim.z);
}

static Product thread_product(const Thread *t)
{
    return product_format("show thread(%.17g, %.17g, %.17g, angle: %.17g, depth: %.17g,"
                          " crest: %.17g, starts: %.17g, chamfer: %.17g);",
                          t->diameter, t->pitch, t->length, t->angle, t->depth, t->crest, t->starts,
                          t->chamfer);
}

/* Returns how much less than the true distance the distance near the surface may be. */
static double thread_factor(const Thread *t)
{
    double core = t->diameter / 2 - t->depth, keep = core - fmin(t->depth, core / 2);
    return hypot(1, thread_rise(t, 2 * PI) / (2 * PI) / keep);
}

/* Never above the truth, and beside the thread no less than by that factor. */
static void check_thread(const Thread *t, uint64_t seed)
{
    Product product = thread_product(t);
    Random  random  = {seed};
    Cloud   cloud   = {0};
    cloud_patch(&cloud, thread_patch, NULL, t, 0.012);
    cloud_patch(&cloud, thread_lid, NULL, t, 0.012);
    for (int i = 0; i < 3 * POINTS; i++) {
        Vec    point    = random_in_cube(&random, i % 2 ? 0.7 : 1.5);
        double distance = product_distance(&product, point), nearest = cloud_nearest(&cloud, point);
        bool   beside = fabs(point.y) < t->length / 2 - t->depth - nearest - t->chamfer;
        if (!(fabs(distance) <= nearest + 1e-9))
            fail_msg("thread at (%g, %g, %g): %.9g above %.9g", point.x, point.y, point.z, distance,
                     nearest);
        if (beside && distance > 0 && !(distance * thread_factor(t) >= nearest - cloud.spacing))
            fail_msg("thread at (%g, %g, %g): %.9g is far below %.9g", point.x, point.y, point.z,
                     distance, nearest);
    }
    cloud_free(&cloud);
    Trial trial = {product_field, &product, in_thread, t, vec(0, 0, 0), 0.8, 3 * POINTS, seed};
    judge_acquits(&trial, "thread");
    judge_refutes_larger(&trial, 1.5, "thread");
    product_free(&product);
}

static const Thread threads[] = {
    {1, 0.15, 1.2, 60 * PI / 180, 0.625 * 0.8660254037844386 * 0.15, 0.15 / 8, 1, 0.08},
    {1, -0.3, 1, 60 * PI / 180, 0.16, 0.04, 1, 0},
    {0.8, 0.25, 1.2, 30 * PI / 180, 0.125, 0.09, 3, 0.1},
    {1, 0.4, 1, 90 * PI / 180, 0.15, 0.05, 2, 0},
};

static void threads_are_safe(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof threads / sizeof *threads; i++)
        check_thread(&threads[i], 10 + i);
}

/* A metric thread is less than a fiftieth below the true distance, as its comment says. */
static void metric_threads_are_sharp(void **state)
{
    (void)state;
    static const double metric[][2] = {{1, 0.25}, {3, 0.5}, {10, 1.5}, {64, 6}};
    for (size_t i = 0; i < sizeof metric / sizeof *metric; i++) {
        Thread t = {.diameter = metric[i][0],
                    .depth    = 0.625 * sqrt(0.75) * metric[i][1],
                    .pitch    = metric[i][1],
                    .starts   = 1};
        assert_true(thread_factor(&t) < 1.02);
    }
}

/* ---- tubes ---- */

static Vec cubic_at(const double *a, double t)
{
    Vec p[4];
    for (int i = 0; i < 4; i++)
        p[i] = vec(a[3 * i], a[3 * i + 1], a[3 * i + 2]);
    for (int left = 3; left > 0; left--)
        for (int i = 0; i < left; i++)
            p[i] = vec_mix(p[i], p[i + 1], t);
    return p[0];
}

/* How far the parabolas for a cubic curve may be from it, by its third derivative. */
static double cubic_error(const double *a, int pieces)
{
    double third[3];
    for (int k = 0; k < 3; k++)
        third[k] = a[k] - 3 * a[3 + k] + 3 * a[6 + k] - a[9 + k];
    return vec_length(vec(third[0], third[1], third[2])) / (54 * pow(pieces, 3));
}

/* The bound holds, and what is found is more than half of it. */
static void cubics_are_near(void **state)
{
    static const int pieces[] = {1, 2, 4, 42};
    Random           random   = {31};
    (void)state;
    for (int set = 0; set < 12; set++) {
        Line   line = {.at = cubic_at, .pieces = 200};
        int    n    = pieces[set % 4];
        double most = 0;
        for (int i = 0; i < 12; i++)
            line.a[i] = random_between(&random, -1, 1);
        const double *a       = line.a;
        double        bound   = cubic_error(a, n);
        Product       product = product_format(
                  "show tube(cubic([%.17g, %.17g, %.17g], [%.17g, %.17g, %.17g],"
                        " [%.17g, %.17g, %.17g], [%.17g, %.17g, %.17g], pieces: %d), 0.05);",
                  a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8], a[9], a[10], a[11], n);
        for (int i = 0; i < POINTS; i++) {
            Vec    point = random_in_cube(&random, 1.5);
            double truth = line_nearest(&line, point) - 0.05;
            most         = fmax(most, fabs(product_distance(&product, point) - truth));
        }
        if (!(most < bound && most > bound / 2))
            fail_msg("%d pieces are off by %g; the bound is %g", n, most, bound);
        product_free(&product);
    }
}

/* Through its points, and on a circle where they are: twelve of a circle make one. */
static void splines_go_through(void **state)
{
    (void)state;
    Product ring   = product_format("show tube(spline([[cos(30deg * i), 0, sin(30deg * i)]"
                                      " for i in 0..12], closed: true), 0.05);");
    Random  random = {32};
    for (int i = 0; i < POINTS; i++) {
        Vec    point = random_in_cube(&random, 1.5);
        double truth = hypot(hypot(point.x, point.z) - 1, point.y) - 0.05;
        assert_true(fabs(product_distance(&ring, point) - truth) < 2e-3);
    }
    product_free(&ring);
    Vec     through[5];
    Product open;
    for (int i = 0; i < 5; i++)
        through[i] = random_in_cube(&random, 1);
    const Vec *t = through;
    open         = product_format("show tube(spline([[%.17g, %.17g, %.17g], [%.17g, %.17g, %.17g],"
                                          " [%.17g, %.17g, %.17g], [%.17g, %.17g, %.17g],"
                                          " [%.17g, %.17g, %.17g]]), 0.05);",
                                  t[0].x, t[0].y, t[0].z, t[1].x, t[1].y, t[1].z, t[2].x, t[2].y, t[2].z,
                                  t[3].x, t[3].y, t[3].z, t[4].x, t[4].y, t[4].z);
    for (int i = 0; i < 5; i++)
        assert_true(fabs(product_distance(&open, through[i]) + 0.05) < 1e-9);
    product_free(&open);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(helices_are_exact), cmocka_unit_test(wrong_helices_are_seen),
        cmocka_unit_test(threads_are_safe),  cmocka_unit_test(metric_threads_are_sharp),
        cmocka_unit_test(cubics_are_near),   cmocka_unit_test(splines_go_through),
    };
    return cmocka_run_group_tests_name("curves", tests, NULL, NULL);
}
