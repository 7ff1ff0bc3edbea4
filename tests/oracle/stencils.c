/*
 * stencils.c: the normals of pictures, by each stencil and by derivatives.
 *
 * By derivatives they are held against closed forms, and for scenes of every kind against
 * differences of the distance in double precision at the position that the picture has; where two
 * differences of different width do not agree there is an edge, and no normal.  By stencils they
 * must agree with those by derivatives within what their order promises: r k for differences of
 * first order, (r k)^2 for those of second, r the reach and k the largest curvature.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "krs/vulkan.h"
#include "tests/support/device.h"

enum { WIDTH = 160, HEIGHT = 90, PIXELS = WIDTH * HEIGHT };

static KrsRenderer *renderer;

static int start(void **context)
{
    (void)context;
    return krs_renderer_new(&(KrsRendererOptions){.device = tested_device()}, &renderer) != KRS_OK;
}

static int stop(void **context)
{
    (void)context;
    krs_renderer_free(renderer);
    return 0;
}

typedef struct Fixture {
    KrsScene     *scene;
    KrsState     *state;
    KrsRendering *rendering;
} Fixture;

static Fixture fixture_open(const char *text)
{
    Fixture    fixture;
    KrsOptions options = {.gradients = true};
    if (krs_compile_text(text, strlen(text), "scene.krs", &options, &fixture.scene) != KRS_OK)
        fail_msg("does not compile: %s", text);
    assert_int_equal(krs_state_new(fixture.scene, &fixture.state), KRS_OK);
    assert_int_equal(
        krs_rendering_new(renderer, fixture.scene, KRS_FOR_PICTURES, &fixture.rendering), KRS_OK);
    return fixture;
}

static void fixture_close(Fixture *fixture)
{
    krs_rendering_free(fixture->rendering);
    krs_state_free(fixture->state);
    krs_scene_free(fixture->scene);
}

static KrsPicture *shoot(Fixture *fixture, KrsNormals normals)
{
    KrsPicture      *picture;
    KrsRenderOptions options = {.width             = WIDTH,
                                .height            = HEIGHT,
                                .error             = 0.01,
                                .methods.no_filter = true,
                                .aovs = KRS_AOV_NORMAL | KRS_AOV_POSITION | KRS_AOV_DEPTH |
                                        KRS_AOV_IDS,
                                .methods.normals = normals};
    if (krs_render(fixture->rendering, fixture->state, &options, &picture) != KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
    return picture;
}

/* Radians. */
static double angle(const float a[3], const double b[3])
{
    double cross[3], dot = 0;
    for (int i = 0; i < 3; i++) {
        int k = (i + 1) % 3, m = (i + 2) % 3;
        cross[i] = a[k] * b[m] - a[m] * b[k];
        dot += a[i] * b[i];
    }
    return atan2(sqrt(cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]), dot);
}

/* ---- closed forms ---- */

typedef void Closed(const double p[3], double n[3]);

static void normal_of_torus(const double p[3], double n[3])
{
    double distance = hypot(p[0], p[2]), side = (distance - 1) / distance;
    n[0] = p[0] * side;
    n[1] = p[1];
    n[2] = p[2] * side;
}

/* (1 + 2 g) (r^2 - 1)^2 = 4 (h x^2 - y^2) (h y^2 - z^2) (h z^2 - x^2), h = g^2, g golden */
static void normal_of_barth(const double p[3], double n[3])
{
    const double g = (1 + sqrt(5)) / 2, h = g * g;
    double       s[3] = {p[0] * p[0], p[1] * p[1], p[2] * p[2]};
    double       a = h * s[0] - s[1], b = h * s[1] - s[2], c = h * s[2] - s[0];
    double       ball = 4 * (1 + 2 * g) * (s[0] + s[1] + s[2] - 1);
    n[0]              = p[0] * (ball - 8 * (h * b * c - a * b));
    n[1]              = p[1] * (ball - 8 * (h * a * c - b * c));
    n[2]              = p[2] * (ball - 8 * (h * a * b - a * c));
}

static void agrees_with(const char *text, Closed *closed, double largest, double radius)
{
    Fixture     fixture = fixture_open(text);
    KrsPicture *picture = shoot(&fixture, KRS_NORMALS_ANALYTIC);
    size_t      seen    = 0;
    double      worst   = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        double p[3], n[3];
        for (int k = 0; k < 3; k++)
            p[k] = picture->position[3 * i + k];
        if (isinf(picture->depth[i]) || p[0] * p[0] + p[1] * p[1] + p[2] * p[2] > radius * radius)
            continue;
        closed(p, n);
        worst = fmax(worst, angle(&picture->normal[3 * i], n));
        seen++;
    }
    krs_picture_free(picture);
    fixture_close(&fixture);
    if (seen < PIXELS / 10 || worst > largest)
        fail_msg("%zu pixels, worst %g: %s", seen, worst, text);
}

static void derivatives_agree_with_closed_forms(void **context)
{
    (void)context;
    agrees_with("camera { eye: [1, 3, 3] } show torus(1, 0.4);", normal_of_torus, 1e-5, 10);
    agrees_with("use \"std/surfaces.krs\"; camera { eye: [2, 1.5, 3.5] } show barth_sextic();",
                normal_of_barth, 2e-2, 2.19);
}

/* ---- differences ---- */

/* The gradient of the distance by differences of two widths; false where they do not agree. */
static bool differences(KrsState *state, const float at[3], double n[3])
{
    const double steps[2] = {1e-5, 2e-5};
    double       found[2][3], apart = 0, size = 0;
    for (int i = 0; i < 6; i++) {
        KrsHit hits[2];
        double points[2][3] = {{at[0], at[1], at[2]}, {at[0], at[1], at[2]}};
        points[0][i % 3] -= steps[i / 3];
        points[1][i % 3] += steps[i / 3];
        krs_probe(state, (const double(*)[3])points, 2, hits);
        found[i / 3][i % 3] = (hits[1].distance - hits[0].distance) / (2 * steps[i / 3]);
    }
    for (int k = 0; k < 3; k++) {
        n[k]  = found[0][k];
        apart = fmax(apart, fabs(found[0][k] - found[1][k]));
        size  = fmax(size, fabs(n[k]));
    }
    return apart < 1e-3 * size;
}

static void agrees_with_differences(const char *text)
{
    Fixture     fixture = fixture_open(text);
    KrsPicture *picture = shoot(&fixture, KRS_NORMALS_ANALYTIC);
    size_t      seen = 0, hit = 0, wrong = 0;
    double      worst = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        double n[3];
        hit += !isinf(picture->depth[i]);
        if (isinf(picture->depth[i]) || !differences(fixture.state, &picture->position[3 * i], n))
            continue;
        double off = angle(&picture->normal[3 * i], n);
        worst      = fmax(worst, off);
        wrong += off > 5e-3;
        seen++;
    }
    krs_picture_free(picture);
    fixture_close(&fixture);
    if (getenv("KRS_TELL"))
        fprintf(stderr, "%zu hit, %zu told, %zu wrong, worst %g: %.60s\n", hit, seen, wrong, worst,
                text);
    if (seen * 5 < hit * 4 || hit < 100 || wrong * 500 > seen)
        fail_msg("%zu hit, %zu told, %zu wrong, worst %g: %s", hit, seen, wrong, worst, text);
}

static void derivatives_agree_with_differences(void **context)
{
    (void)context;
    static const char *const scenes[] = {
        "camera { eye: [2, 3, 5] } show box([1, 1.4, 0.8]) - sphere(0.7).move([0.4, 0.3, 0.4]);"
        "show plane([0, 1, 0], -0.8) & box([8, 2, 8]);",
        "camera { eye: [3, 2, 4], fov: 35deg }"
        "show union([torus(1, 0.3), cylinder(0.4, 1.6)], blend: 0.2);"
        "show ellipsoid([0.4, 0.2, 0.3]).move([1.2, 0.7, 0]).scale([1, 2, 1]);",
        "camera { eye: [0, 4, 6] } show capsule([0, 0, 0], [0, 0.6, 0], 0.15)"
        ".repeat([0.8, 0, 0.8], [5, 1, 5]);"
        "show cone(0.3, 0.6).move([1.8, 0.9, 0]).repeat_polar(9);",
        "camera { eye: [0, 2, 9], fov: 50deg }"
        "show krs { kernel sphere(0.8).move([0.5, 0, 0]); for i in 0..6 {"
        "reflect plane([sin(i), cos(i), 0.3 * i], 0.2 + 0.1 * i); } };",
        "camera { eye: [2, 2, 5] } show box([0.8, 2, 0.8]).twist(axis: [0, 1, 0], rate: 0.5);"
        "show torus(0.8, 0.2).move([2, 0, 0]).round(0.05);",
        "camera { eye: [3, 2, 4] } show field(sin(3 * x) * sin(3 * y) + sin(3 * z) - 0.2)"
        ".within(sphere(1.4));",
        "use \"std/surfaces.krs\"; camera { eye: [3, 2, 4] }"
        "show clebsch(2).rotate([0, 1, 0], 30deg) - box([1, 1, 1]).move([1, 1, 1]);",
        "camera { eye: [3, 2, 4] } show sphere(1).displace(0.2 * sin(4 * x) * cos(5 * y));"
        "show meta([sphere(0.3).move([1.5 + 0.2 * i, 0.4 * i, 0]) for i in 0..3], level: 0.5);",
        "camera { eye: [0.2, 3, 8], fov: 20deg } show krs { kernel sphere(0.8).move([1, 0, 0]);"
        "mobius translate([0.4, 0, 0]) * rotate([0, 1, 0], 50deg) * scale(0.8);"
        "mobius reflect(plane([0, 1, 0], 0)) * invert(center: [0, -6, 0], radius: 6); };",
        "camera { eye: [3, 2, 4] } zone { center: [1, 0.7, 1], radius: 0.8 } show sphere(1.2);",
    };
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
        agrees_with_differences(scenes[i]);
}

/* Shapes of the library, by the examples of their declarations, so many to a picture. */
enum { TOGETHER = 6 };

static void check_examples(const char *path)
{
    static char line[1024], text[8192];
    FILE       *file   = fopen(path, "rb");
    int         count  = 0;
    size_t      length = 0;
    assert_non_null(file);
    bool more = true;
    while (more) {
        more                = fgets(line, sizeof line, file) != NULL;
        const char *example = more ? strstr(line, "example:") : NULL;
        /* A plane would hide the others; shapes whose names begin with _ are made by builtins alone. */
        if (example && !strstr(example, " plane(") && !strstr(example, " _")) {
            length += (size_t)snprintf(
                text + length, sizeof text - length, "show (%.*s).move([%d, 0, %d]);",
                (int)strcspn(example + 8, "\n"), example + 8, 3 * (count % 3), 3 * (count / 3));
            count++;
        }
        if (count == TOGETHER || (!more && count > 0)) {
            snprintf(text + length, sizeof text - length,
                     "camera { eye: [3.5, 6, 8], target: [3, 0, 1.5], fov: 48deg }");
            agrees_with_differences(text);
            count  = 0;
            length = 0;
        }
    }
    fclose(file);
}

static void shapes_of_the_library_agree(void **context)
{
    (void)context;
    check_examples("compiler/library/solids.krs");
    check_examples("compiler/library/figures.krs");
}

/* ---- stencils ---- */

/* A torus, whose largest curvature is known, seen from nearby. */
static void stencils_keep_their_order(void **context)
{
    (void)context;
    static const double curvature = 1 / 0.4;
    Fixture fixture = fixture_open("camera { eye: [1, 3, 3], fov: 40deg } show torus(1, 0.4);");
    for (KrsNormals normals = KRS_NORMALS_DEFAULT; normals < KRS_NORMALS_ANALYTIC; normals++) {
        KrsPicture *picture = shoot(&fixture, normals);
        bool        first   = normals == KRS_NORMALS_FORWARD || normals == KRS_NORMALS_TETRAHEDRON;
        double      worst = 0, most = 0;
        size_t      seen = 0;
        for (size_t i = 0; i < PIXELS; i++) {
            double p[3], n[3];
            if (isinf(picture->depth[i]))
                continue;
            for (int k = 0; k < 3; k++)
                p[k] = picture->position[3 * i + k];
            normal_of_torus(p, n);
            double distance = sqrt(pow(p[0] - 1, 2) + pow(p[1] - 3, 2) + pow(p[2] - 3, 2));
            double reach    = fmax(0.5 * distance * 2 * tan(0.5 * 40 * acos(-1) / 180) / HEIGHT,
                                   3e-4 * 2);
            double error    = angle(&picture->normal[3 * i], n);
            double bound    = reach * curvature;
            bound           = (first ? bound : bound * bound) + 1e-3;
            worst           = fmax(worst, error / bound);
            most            = fmax(most, error);
            seen++;
        }
        krs_picture_free(picture);
        if (getenv("KRS_TELL"))
            fprintf(stderr, "%s: %zu, worst %g, %g of the bound\n", krs_normals_names[normals],
                    seen, most, worst);
        if (seen < PIXELS / 10 || worst > 1)
            fail_msg("%s: %zu pixels, worst %g of the bound", krs_normals_names[normals], seen,
                     worst);
        /* What is of first order shows it. */
        assert_true(most > (first ? 5e-3 : 0));
    }
    fixture_close(&fixture);
}

/* A component without derivatives has the normals of the octahedron, another its own. */
static void components_without_derivatives_have_differences(void **context)
{
    (void)context;
    Fixture fixture = fixture_open("camera { eye: [3, 2, 4] } show julia([-0.2, 0.6, 0.2, 0.2]);"
                                   "show torus(1, 0.2).move([0, 1.2, 0]);");
    KrsPicture *analytic = shoot(&fixture, KRS_NORMALS_ANALYTIC);
    KrsPicture *corners  = shoot(&fixture, KRS_NORMALS_OCTAHEDRON);
    size_t      seen[2] = {0}, other[2] = {0};
    for (size_t i = 0; i < PIXELS; i++) {
        double n[3];
        if (isinf(analytic->depth[i]))
            continue;
        for (int k = 0; k < 3; k++)
            n[k] = corners->normal[3 * i + k];
        bool torus = analytic->component[i] == 2;
        seen[torus]++;
        other[torus] += angle(&analytic->normal[3 * i], n) > 1e-4;
    }
    krs_picture_free(analytic);
    krs_picture_free(corners);
    fixture_close(&fixture);
    assert_true(seen[0] > PIXELS / 40 && seen[1] > PIXELS / 40);
    assert_true(other[0] * 100 < seen[0] && other[1] * 2 > seen[1]);
}

static void analytic_normals_are_asked_for_in_time(void **context)
{
    (void)context;
    const char      *text = "show sphere(1);";
    Fixture          fixture;
    KrsPicture      *picture;
    KrsRenderOptions options = {.width = 16, .height = 16, .methods.normals = KRS_NORMALS_ANALYTIC};
    assert_int_equal(krs_compile_text(text, strlen(text), "s.krs", NULL, &fixture.scene), KRS_OK);
    assert_int_equal(krs_state_new(fixture.scene, &fixture.state), KRS_OK);
    assert_int_equal(
        krs_rendering_new(renderer, fixture.scene, KRS_FOR_PICTURES, &fixture.rendering), KRS_OK);
    assert_int_equal(krs_render(fixture.rendering, fixture.state, &options, &picture),
                     KRS_BAD_ARGUMENT);
    assert_non_null(strstr(krs_renderer_message(renderer), "gradients"));
    options.methods.normals = KRS_NORMALS_COUNT;
    assert_int_equal(krs_render(fixture.rendering, fixture.state, &options, &picture),
                     KRS_BAD_ARGUMENT);
    fixture_close(&fixture);
}

/* Pixels of a turned box that stands on a floor, and is cut off aslant, whose normal is that of no
   face; a mean of two normals mirrors light where neither side does. */
static int count_between(const KrsPicture *picture, int pixels)
{
    const double turned = 0.3, c = cos(turned), s = sin(turned), half = sqrt(0.5);
    const double faces[7][3] = {{0, 1, 0},
                                {c, 0, -s},
                                {-c, 0, s},
                                {s, 0, c},
                                {-s, 0, -c},
                                {0, 0, 0},
                                {s * half, half, c * half}};
    int          between     = 0;
    for (int k = 0; k < pixels; k++) {
        double nearest = INFINITY;
        for (int i = 0; i < 7 && picture->component[k]; i++)
            nearest = fmin(nearest, i == 5 ? INFINITY : angle(picture->normal + 3 * k, faces[i]));
        between += picture->component[k] && nearest > 0.03;
    }
    return between;
}

/* Far from the origin differences reach farther, so many hits lie next to the line of an edge.  Few
   may still have a mean: those at corners, where three faces meet, and on outlines. */
static void pixels_on_edges_show_one_side(void **context)
{
    (void)context;
    enum { ACROSS = 480, DOWN = 270, MOST = 12 };
    Fixture fixture = fixture_open(
        "camera { eye: [49, 6, 17], target: [40, 1, 0], fov: 15deg }\n"
        "show plane([0, 1, 0], 0);\n"
        "show (box([4, 3, 4]).move([0, 1.5, 0]) & half_space([0, 1, 1], 2.8))\n"
        "    .rotate([0, 1, 0], 0.3).move([40, 0, 0]);\n");
    KrsPicture *picture = NULL;
    assert_int_equal(krs_render(fixture.rendering, fixture.state,
                                &(KrsRenderOptions){.width           = ACROSS,
                                                    .height          = DOWN,
                                                    .methods.normals = KRS_NORMALS_OCTAHEDRON},
                                &picture),
                     KRS_OK);
    int between = count_between(picture, ACROSS * DOWN);
    print_message("# %d pixels on edges have a normal between two sides\n", between);
    assert_true(between <= MOST);
    krs_picture_free(picture);
    fixture_close(&fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(derivatives_agree_with_closed_forms),
        cmocka_unit_test(derivatives_agree_with_differences),
        cmocka_unit_test(shapes_of_the_library_agree),
        cmocka_unit_test(stencils_keep_their_order),
        cmocka_unit_test(components_without_derivatives_have_differences),
        cmocka_unit_test(analytic_normals_are_asked_for_in_time),
        cmocka_unit_test(pixels_on_edges_show_one_side),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, start, stop);
}
