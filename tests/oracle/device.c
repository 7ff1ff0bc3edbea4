/*
 * device.c: the device and the double-precision evaluator agree.
 *
 * Scenes that use every primitive, blend, operation and function are sampled at the same points
 * by both.  The permitted difference grows with the size of the numbers that were added (the
 * coordinates and the distance), in units of single precision; identities must be equal except
 * where two components, or two sides of a mirror, are equally near.
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

#include "compiler/passes/compile.h"
#include "runtime/tracer/query.h"
#include "tests/support/random.h"
#include "tests/support/renderer.h"

/* Identities are asked for at the first of them: the host finds a normal with each. */
enum { POINTS = 20000, IDENTITIES = 4000 };

static Random chance = {12345};

static double uniform(double low, double high) { return random_between(&chance, low, high); }

static void print_diagnostic(void *user, const KrsDiagnostic *diagnostic)
{
    (void)user;
    fputs(diagnostic->text, stderr);
}

/* A texture of points: some all around, most near the origin. */
static void scatter(double (*points)[3], float (*rounded)[3])
{
    for (size_t i = 0; i < POINTS; i++)
        for (int k = 0; k < 3; k++) {
            rounded[i][k] = (float)uniform(-1, 1) * (i % 4 ? 2.5f : 12);
            points[i][k]  = rounded[i][k];
        }
}

typedef struct Comparison {
    double worst; /* difference over what is permitted */
    size_t wrong_ids, id_count;
} Comparison;

/* `planted` multiplies what the device says: 1, except to show that a fault is found. */
static Comparison compare_scene(const char *text, double roughness, double planted)
{
    KrsOptions    options = {.diagnostic = print_diagnostic};
    KrsScene     *scene;
    KrsState     *state;
    KrsRendering *rendering;
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", &options, &scene), KRS_OK);
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    KrsStatus status = krs_rendering_new(renderer, scene, KRS_FOR_QUESTIONS, &rendering);
    if (status != KRS_OK)
        fprintf(stderr, "%s\n", krs_renderer_message(renderer));
    assert_int_equal(status, KRS_OK);

    double(*points)[3]     = malloc(POINTS * sizeof *points);
    float(*rounded)[3]     = malloc(POINTS * sizeof *rounded);
    float        *device   = malloc(POINTS * sizeof *device);
    double       *host     = malloc(POINTS * sizeof *host);
    KrsHit       *hits     = malloc(IDENTITIES * sizeof *hits);
    SurfacePoint *surfaces = malloc(POINTS * sizeof *surfaces);
    scatter(points, rounded);
    status = point_query_sample(rendering, state, (const float(*)[3])rounded, POINTS, device,
                                surfaces);
    assert_int_equal(status, KRS_OK);
    krs_distance(state, (const double(*)[3])points, POINTS, host);
    krs_probe(state, (const double(*)[3])points, IDENTITIES, hits);

    Comparison result = {0};
    for (size_t i = 0; i < POINTS; i++) {
        double reach   = fabs(points[i][0]) + fabs(points[i][1]) + fabs(points[i][2]);
        double size    = 1 + reach + fabs(host[i]);
        double allowed = roughness * 0x1p-23 * size;
        double excess  = fabs(planted * device[i] - host[i]) / allowed;
        if (!(excess <= result.worst))
            result.worst = isnan(excess) ? INFINITY : excess;
    }
    for (size_t i = 0; i < IDENTITIES; i++) {
        result.id_count++;
        result.wrong_ids += surfaces[i].component != hits[i].component ||
                            surfaces[i].level != hits[i].level ||
                            surfaces[i].instance != hits[i].instance;
    }
    free(points);
    free(rounded);
    free(device);
    free(host);
    free(hits);
    free(surfaces);
    krs_rendering_free(rendering);
    krs_state_free(state);
    krs_scene_free(scene);
    return result;
}

static void agrees(const char *text, double roughness)
{
    Comparison c = compare_scene(text, roughness, 1);
    if (c.worst > 1 || c.wrong_ids * 500 > c.id_count)
        fprintf(stderr, "worst %.3g, wrong ids %zu of %zu: %s\n", c.worst, c.wrong_ids, c.id_count,
                text);
    assert_true(c.worst <= 1);
    /* Ties only: a point in 500 at most. */
    assert_true(c.wrong_ids * 500 <= c.id_count);
}

static void primitives_agree(void **context)
{
    static const char *const solids[] = {
        "sphere(0.8)",
        "box([1, 2, 0.7])",
        "cylinder(0.6, 1.3)",
        "cone(0.7, 1.2)",
        "capped_cone(0.8, 0.3, 1)",
        "capsule([-0.5, 0, 0.2], [0.6, 0.7, 0], 0.2)",
        "round_cone([-0.6, 0, 0], [0.7, 0.4, 0.1], 0.4, 0.15)",
        "arc_capsule([-0.8, 0, 0], [0, 0.7, 0.1], [0.9, 0.1, 0], 0.15, 0.15)",
        "torus(0.8, 0.25)",
        "ellipsoid([1, 0.5, 0.7])",
        "link(0.6, 0.4, 0.12)",
        "octahedron(1)",
        "hull([[0, 1, 0], [-1, 0, -0.6], [1, 0, -0.6], [0, 0, 1.2]], 0.1)",
        "hull(sphere(0.6), sphere(0.3).move([1, 0.2, 0]), box([0.4, 0.5, 0.6]).move([0, 1, 0.3]))",
        "tetrahedron(1)",
        "dodecahedron(0.9)",
        "icosahedron(0.9)",
        "prism(6, 0.8, 1)",
        "pyramid(1.2, 1)",
        "wedge(70deg)",
        "plane([0.3, 1, 0.2], 0.1)",
        "circle(0.7).extrude(0.5)",
        "rectangle([1, 0.6]).revolve(1)",
        "regular(5, 0.8).extrude(0.4)",
        "star().extrude(0.3)",
        "polygon([[-1, -0.5], [1, -0.6], [0.2, 0.1], [0.5, 0.9]]).extrude(0.6)"};
    (void)context;
    for (size_t i = 0; i < sizeof solids / sizeof *solids; i++) {
        char text[400];
        snprintf(text, sizeof text, "show %s.rotate([1, 2, 3], 0.7).move([0.1, -0.2, 0.3]);",
                 solids[i]);
        agrees(text, 16);
    }
}

static void operations_agree(void **context)
{
    static const char *const shapes[] = {
        "a | b",
        "a & b",
        "a - b",
        "xor(a, b)",
        "morph(a, b, 0.3)",
        "union(a, b, blend: 0.3)",
        "intersection(a, b, blend: 0.3, kind: \"cubic\")",
        "difference(a, b, blend: 0.2, kind: \"exponential\")",
        "union(a, b, blend: 0.4, kind: \"circular\")",
        "union(a, b, blend: 0.4, kind: \"chamfer\")",
        "union(a, b, blend: 0.4, kind: \"stairs\")",
        "a.scale(1.7)",
        "a.scale([1, 2, 0.5])",
        "a.shell(0.1)",
        "a.round(0.1)",
        "a.offset(0.2)",
        "a.elongate([0.5, 0, 1])",
        "a.mirror(plane([1, 1, 0], 0.3))",
        "a.align([1, 2, 3], [0, -1, 0.2])",
        "a.scale(0.3).repeat([1, 1.2, 0], [4, 3, 1])",
        "a.scale(0.2).move([1.5, 0, 0]).repeat_polar(7)",
        "a.scale(0.3).repeat(0.8)",
        "a.twist([0, 1, 0], 0.8)",
        "a.twist([1, 2, 0.5], -0.4)",
        "a.bend([1, 0, 0], 0.4)",
        "a.scale([0.4, 3, 0.4]).bend([0, 0, 1], -1.1)",
        "a.taper([0, 1, 0], 1.2, 0.4)",
        "a.displace(sin(3 * x) * cos(2 * y), 0.2)",
        "(a | b).displace(fbm(p, 3), 0.3)",
        "(a - b).taper([1, 0, 0], 0.5, 1).twist([0, 1, 0], 0.5).bend([1, 0, 0], 0.2)"};
    (void)context;
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        char text[400];
        snprintf(text, sizeof text,
                 "let a = box([1, 1.4, 0.8]); let b = sphere(0.7).move([0.4, 0.3, 0.2]); show %s;",
                 shapes[i]);
        agrees(text, 32);
    }
}

static void functions_agree(void **context)
{
    static const char *const fields[] = {"sin(x) + cos(2 * y)",
                                         "tan(0.1 * z)",
                                         "asin(clamp(x, -0.9, 0.9))",
                                         "acos(clamp(0.3 * y, -0.9, 0.9))",
                                         "atan(x * y)",
                                         "atan2(y, x + 20)",
                                         "sqrt(x * x + 1)",
                                         "inversesqrt(y * y + 0.5)",
                                         "exp(0.2 * x)",
                                         "exp2(0.3 * x)",
                                         "log(1 + x * x)",
                                         "log2(2 + y * y)",
                                         "sinh(0.2 * x)",
                                         "cosh(0.2 * y)",
                                         "tanh(z)",
                                         "abs(x) - sign(y + 100)",
                                         "pow(1 + x * x, 0.7)",
                                         "x ^ 3 * 0.01",
                                         "mix(x, y, 0.3)",
                                         "smoothstep(-1, 2, x)",
                                         "clamp(x, -1, y)",
                                         "min(x, y, z)",
                                         "max([x, y, z])",
                                         "length(p - [1, 2, 3])",
                                         "dot(p, [1, 0.5, 0.2])",
                                         "length(cross(p, [0, 1, 0]))",
                                         "normalize(p + [20, 0, 0])[0]",
                                         "distance(p, [1, 1, 1])",
                                         "sum([x, y, 2 * z])",
                                         "noise(p)",
                                         "noise([z, x])",
                                         "noise(3 * y)",
                                         "fbm(p, 4)"};
    (void)context;
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++) {
        char text[400];
        snprintf(text, sizeof text,
                 "shape f() { distance: max(0.2 * (%s), length(p) - 3.5), within: sphere(3.5) }"
                 " show f();",
                 fields[i]);
        agrees(text, 64);
    }
}

/* The sine, cosine and tangent that the device finds of scale x at points along x, through the
   emission of a surface; scale is a power of two, so that arguments are exact. */
static void sample_sines(double scale, double *arguments, SurfacePoint *found)
{
    char          text[200];
    KrsScene     *scene;
    KrsState     *state;
    KrsRendering *rendering;
    float        *distances = malloc(POINTS * sizeof *distances);
    float(*points)[3]       = calloc(POINTS, sizeof *points);
    for (size_t i = 0; i < POINTS; i++) {
        points[i][0] = (float)uniform(-2.5, 2.5);
        arguments[i] = scale * points[i][0];
    }
    snprintf(text, sizeof text,
             "material waves { emission: [sin(%.17g * x), cos(%.17g * x), tan(%.17g * x)] }"
             "show sphere(1).paint(waves);",
             scale, scale, scale);
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", NULL, &scene), KRS_OK);
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    assert_int_equal(krs_rendering_new(renderer, scene, KRS_FOR_QUESTIONS, &rendering), KRS_OK);
    assert_int_equal(
        point_query_sample(rendering, state, (const float(*)[3])points, POINTS, distances, found),
        KRS_OK);
    krs_rendering_free(rendering);
    krs_state_free(state);
    krs_scene_free(scene);
    free(distances);
    free(points);
}

/* Up to 2^14 pi, sines are good to 2^-22, tangents to as much times how steep they are; beyond, to
   what the last digit of the argument is worth.  However large that is, sines are at most 1. */
static void sines_are_accurate(void **context)
{
    static const double scales[]  = {1,      0x1p4,  0x1p8,  0x1p11, 0x1p14,
                                     0x1p15, 0x1p18, 0x1p21, 0x1p60};
    double             *arguments = malloc(POINTS * sizeof *arguments);
    SurfacePoint       *found     = malloc(POINTS * sizeof *found);
    (void)context;
    for (size_t k = 0; k < sizeof scales / sizeof *scales; k++) {
        double worst = 0, worst_tangent = 0, largest = 0;
        sample_sines(scales[k], arguments, found);
        for (size_t i = 0; i < POINTS; i++) {
            double a = arguments[i], tangent = tan(a);
            double digit   = fabs(a) > 16384 * acos(-1) ? 0x1p-23 * fabs(a) : 0;
            double allowed = 0x1p-22 + digit;
            for (int j = 0; j < 2; j++) {
                double excess = fabs(found[i].emission[j] - (j ? cos(a) : sin(a))) / allowed;
                worst         = excess <= worst ? worst : excess;
                largest       = fmax(largest, fabs(found[i].emission[j]));
            }
            if (digit > 0 || fabs(tangent) > 1000)
                continue;
            double excess = fabs(found[i].emission[2] - tangent) /
                            (allowed * (1 + tangent * tangent));
            worst_tangent = excess <= worst_tangent ? worst_tangent : excess;
        }
        if (!(worst <= 1) || !(worst_tangent <= 1) || !(largest <= 1 + 0x1p-22))
            fprintf(stderr,
                    "sines up to %g: %.3g of what is permitted, tangents %.3g; up to %.9g\n",
                    2.5 * scales[k], worst, worst_tangent, largest);
        assert_true(worst <= 1);
        assert_true(worst_tangent <= 1);
        assert_true(largest <= 1 + 0x1p-22);
    }
    free(arguments);
    free(found);
}

static void sequences_agree(void **context)
{
    (void)context;
    agrees("show krs { kernel capsule([0, 0, 0], [0.3, 0.6, 0], 0.1); for i in 0..12 {"
           "    reflect plane(random_direction(i), 0.3 + 0.1 * i);"
           "    kernel sphere(0.1).move(random_direction(100 + i)); } };",
           64);
    agrees("show krs { kernel box([0.3, 0.4, 0.5]);"
           "    for i in 0..28 { reflect plane(random_direction(i), 0.2 + 0.02 * i); } };",
           256);
    agrees("show krs { kernel sphere(0.2);"
           "    for i in 0..36 { reflect plane(random_direction(i), 0.3 + 0.02 * i); } };",
           256);
    agrees("let inner = krs {"
           "    kernel sphere(0.2).move([0.3, 0, 0]); reflect plane([1, 0, 0], 0.2); };"
           "show krs { kernel inner; reflect plane([0, 1, 0], 0.5);"
           "    mobius rotate([0, 0, 1], 0.3) * scale(1.3) * translate([0.1, 0.2, 0]);"
           "    reflect plane([0, 1, 1], 0.7); };",
           64);
    /* Mirrors across axes are written in a way of their own. */
    agrees("param t = 0.3 in [0.1, 0.5]; show krs { kernel sphere(0.4).move([0.3, -0.1, 0.1]);"
           "    reflect plane([0, 0, -1], -0.1); reflect plane([0, -1, 0], t);"
           "    reflect plane([1, 0, 0], 2 * t); reflect plane([0, 0, 1], 0.4); };",
           64);
}

static void inversions_agree(void **context)
{
    (void)context;
    agrees("show sphere(0.5).move([0, 1, 0]).transform(invert());"
           "show box([1, 1, 1]).transform(matrix([1, 0, 0, 0.4], [0, 1, 0, 0], [0, 0, 0.4, 0], 1));"
           "show sphere(0.6).transform(invert([0, 0.2, 0], 0.5));",
           64);
    agrees("show krs { kernel sphere(0.35); for i in 0..9 {"
           "    mobius scale(0.9) * rotate([0, 0, 1], 0.4 + 0.05 * i) * translate([0.6, 0, 0]);"
           "    mobius invert(center: [0, -3, 0], radius: 3); reflect plane([-1, 0, 0], 0);"
           "    kernel capsule([0, 0, 0], [0.5, 0.4, 0], radius: 0.08); } };",
           256);
    agrees("param t = 0.5 in [0, 1]; show krs { kernel box([0.3, 0.4, 0.5]);"
           "    mobius invert([t, 2, 0], 2); mobius invert([0.5, 2, 0], 1 + t);"
           "    reflect plane([1, 0, 0], 0.1); mobius invert([0, 0.3 * t, -1], 1); };",
           256);
}

static void fractals_agree(void **context)
{
    static const char *const scenes[] = {
        "show julia(c: [-0.2, 0.6, 0.2, 0.1]);",
        "show julia(c: [-1, 0.2, 0, 0], iterations: 5);",
        "show julia(c: [-0.2, 0.6, 0.2, 0.1], power: 3, iterations: 6).rotate([1, 2, 3], 0.7);",
        "show julia(c: [0.4, 0.3, 0.5, 0.1], power: 8, iterations: 3);",
        "show mandelbulb(iterations: 3);",
        "show mandelbulb(power: 2, iterations: 8);",
        "show mandelbulb(power: 4, iterations: 4) | mandelbulb(6, 3).move([2, 0, 0])"
        "   | mandelbulb(7, 3).move([0, 0, 2]) | mandelbulb(12, 2).move([2, 0, 2]);",
        "show mandelbulb(16, 2) | mandelbulb(3, 9).move([2, 0, 0]);",
        "show mandelbulb(power: 5, iterations: 3).scale(2).move([0.1, 0.2, 0.3]);",
        "param n = 4 in [2, 9]; param a = 0.1 in [-0.5, 0.5];"
        "show julia(c: [a, 0.6, 0.2, a], power: 3, iterations: n) | mandelbulb(iterations: n - 1);",
        "show meta([sphere(0.4).move([cos(i), sin(2 * i), 0]) for i in 0..7], level: 0.5);",
        "show meta([sphere(0.4), box([1, 2, 0.3]) - sphere(0.5), torus(1.5, 0.2)],"
        "    falloff: \"gaussian\", reach: 0.8);",
        "show meta([sphere(0.4), sphere(0.2).move([1, 0, 0])], falloff: \"soft\", level: 0.3);",
        "show union(meta([sphere(0.4), capsule([1, 0, 0], [0, 2, 1], 0.1)],"
        "    falloff: \"exponential\", reach: 0.9), julia(c: [-0.2, 0.6, 0.2, 0.1]), blend: 0.2);"};
    (void)context;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
        agrees(scenes[i], 64);
}

static void parameters_agree(void **context)
{
    (void)context;
    agrees("param a = 0.7 in [0, 2]; param w = [0.3, 0.2, 0.1]; param c = #ff8000;"
           "show box([1, 1, 1]).rotate([1, 1, 0], 3 * a + time).move(w * 2)"
           "    .scale(1 + 0.5 * sin(a)).paint(c);"
           "show sphere(0.3 + 0.1 * a).move([2, cos(a), 0]);",
           32);
    /* Truth values, vectors with constants in them, signs and components. */
    agrees("param a = 0.7 in [0, 2]; param w = [0.3, 0.2, 0.1]; param n = 3 in [1, 5];"
           "let far = if a > 0.5 and n < 4 then 1.5 else 3;"
           "show box([1, w[1] + 1, 1]).move([0, -far * a, 0]).rotate([0, 1, 0], n * a);"
           "show sphere(0.4).move([0, -cos(a), w[2]]).move(if n > 2 then -w else 2 * w);"
           "show capsule([0, 0, 0], [0, sin(a), 0], 0.1 + w[0]).repeat_polar(5).move([0, 0, far]);",
           32);
}

/* Largest difference, over what is permitted; `late`: the device is asked before a state is set. */
static double compare_states(KrsRendering *rendering, KrsState *state, bool late)
{
    static const double times[] = {0, 0.4, -3, 25, 200, 1};
    enum { FEW = 2000 };
    static float  rounded[FEW][3], device[FEW];
    static double points[FEW][3], host[FEW];
    double        worst = 0;
    for (size_t f = 0; f < sizeof times / sizeof *times; f++) {
        for (size_t i = 0; i < FEW; i++)
            for (int k = 0; k < 3; k++)
                points[i][k] = rounded[i][k] = (float)uniform(-2, 2);
        if (late)
            krs_device_distance(rendering, state, (const float(*)[3])rounded, FEW, device);
        double k = 2 + times[f];
        assert_int_equal(krs_state_set(state, "k", &k, 1), KRS_OK);
        assert_int_equal(krs_state_set_time(state, times[f]), KRS_OK);
        if (!late)
            krs_device_distance(rendering, state, (const float(*)[3])rounded, FEW, device);
        krs_distance(state, (const double(*)[3])points, FEW, host);
        for (size_t i = 0; i < FEW; i++)
            worst = fmax(worst, fabs(device[i] - host[i]) / (64 * 0x1p-23 * (7 + fabs(host[i]))));
    }
    return worst;
}

/* Slopes that the host finds for each state reach shaders that are compiled once. */
static void states_agree(void **context)
{
    static const char text[] =
        "param k = 2; shape w() { distance: length(p) - 1 + 0.1 * sin(x * time) }"
        "show w(); show field(y + 1 - 0.1 * sin(k * x * y)).within(box([2, 3, 2]));"
        "show sphere(0.5).displace(sin(time * x + k * z), 0.1).move([1, 1, 0]);";
    (void)context;
    KrsScene     *scene;
    KrsState     *state;
    KrsRendering *rendering;
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", NULL, &scene), KRS_OK);
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    assert_int_equal(krs_state_slope_count(scene), 3);
    assert_int_equal(krs_rendering_new(renderer, scene, KRS_FOR_PICTURES, &rendering), KRS_OK);
    assert_true(compare_states(rendering, state, false) <= 1);
    assert_true(compare_states(rendering, state, true) > 100); /* the state before */
    krs_rendering_free(rendering);
    krs_state_free(state);
    krs_scene_free(scene);
}

/* The comparison can fail: distances off by a hundredth of a percent are found. */
static void a_fault_is_found(void **context)
{
    (void)context;
    assert_true(compare_scene("show sphere(1);", 16, 1.0001).worst > 1);
    assert_true(compare_scene("show sphere(1);", 16, 1).worst <= 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(primitives_agree), cmocka_unit_test(operations_agree),
        cmocka_unit_test(functions_agree),  cmocka_unit_test(sines_are_accurate),
        cmocka_unit_test(sequences_agree),  cmocka_unit_test(fractals_agree),
        cmocka_unit_test(inversions_agree), cmocka_unit_test(parameters_agree),
        cmocka_unit_test(states_agree),     cmocka_unit_test(a_fault_is_found),
    };
    return cmocka_run_group_tests_name("device and evaluator", tests, renderer_open,
                                       renderer_close);
}
