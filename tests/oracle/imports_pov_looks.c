/*
 * imports_pov_looks.c: colours, finishes, cameras and lights of POV-Ray's scenes, by what its manual and
 * its pictures say of them.
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

static Random randomness = {1991};

static double between(double low, double high) { return random_between(&randomness, low, high); }

/* ---- looks ---- */

static void scene_has(const char *from, const char *words)
{
    Imported result = imported("look.pov", from);
    if (result.status != KRS_OK || !strstr(result.scene, words))
        fail_msg("no `%s`: %s\n%s", words, result.refusal, result.scene);
}

/* Three numbers behind a word of the first material, or zeros. */
static void numbers_behind(const char *scene, const char *word, double numbers[3])
{
    const char *at = strstr(scene, "material look_1");
    at             = at ? strstr(at, word) : NULL;
    numbers[0] = numbers[1] = numbers[2] = 0;
    if (at &&
        sscanf(at + strlen(word), ": [%lf, %lf, %lf]", &numbers[0], &numbers[1], &numbers[2]) != 3)
        fail_msg("no numbers: %s", at);
}

/* Checks what POV-Ray's manual says of a pigment below a light: its diffuse part scatters, its
   ambient part is there without light, and both only as far as nothing goes through. */
static void check_color(const char *pigment, const double p[5], double diffuse, double ambient,
                        const char *before, double (*light)(double))
{
    char   text[512];
    double through = p[3] + p[4], color[3], emission[3];
    snprintf(text, sizeof text, "%ssphere { 0, 1 pigment { %s } finish { diffuse %g ambient %g } }",
             before, pigment, diffuse, ambient);
    Imported found = imported("color.pov", text);
    numbers_behind(found.scene, "color", color);
    numbers_behind(found.scene, "emission", emission);
    for (int i = 0; i < 3; i++) {
        double tint     = through > 0 ? (p[3] * p[i] + p[4]) / through : 0;
        double expected = fmin((1 - through) * light(diffuse * p[i]) + through * light(tint), 1);
        double alone    = (1 - through) * light(ambient * p[i]);
        if (!(fabs(color[i] - expected) < 1e-4 && fabs(emission[i] - alone) < 1e-4))
            fail_msg("%s: %g and %g, not %g and %g\n%s%s", text, color[i], emission[i], expected,
                     alone, found.scene, found.refusal);
    }
}

static double linear(double s) { return s; }
static double squared(double s) { return s * s; }
static double of_screen(double s)
{
    return s <= 0.04045 ? s / 12.92 : pow((s + 0.055) / 1.055, 2.4);
}

static void colors_are_those_of_pov(void **state)
{
    static const struct {
        const char *pigment;
        double      color[5];
    } rows[] = {
        {"color red 0.9 green 0.5", {0.9, 0.5, 0}},
        {"Tan", {0.858824, 0.576471, 0.439216}},
        {"rgb <0.1, 0.2, 0.3>*2", {0.2, 0.4, 0.6}},
        {"color Red*0.5 + Blue*0.25", {0.5, 0, 0.25}},
        {"Gold filter 0.9", {0.8, 0.498039, 0.196078, 0.9}},
        {"color rgbf <0.9, 0.5, 0.1, 0.9>", {0.9, 0.5, 0.1, 0.9}},
        {"color rgbt <1, 0, 0, 0.75>", {1, 0, 0, 0, 0.75}},
        {"checker color rgb 0 color rgb 1", {0.5, 0.5, 0.5}},
        {"gradient y color_map { [0 color rgb 0] [1 color rgb <1, 0.5, 0>] }", {0.5, 0.25, 0}},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const double *color = rows[i].color;
        check_color(rows[i].pigment, color, 0.6, 0.1, "#version 3.7; ", linear);
        check_color(rows[i].pigment, color, 0.9, 0.4, "#version 3.7; ", linear);
        check_color(rows[i].pigment, color, 0.6, 0, "", of_screen);
        check_color(rows[i].pigment, color, 0.6, 0.2, "global_settings { assumed_gamma 2 } ",
                    squared);
    }
    /* Colours of a screen are the same in every space. */
    const double half[5] = {0.214041, 1, 0};
    check_color("color srgb <0.5, 1, 0>", half, 0.6, 0.1, "#version 3.7; ", linear);
    check_color("color srgb <0.5, 1, 0>", (const double[5]){0.5, 1}, 0.6, 0.1, "", of_screen);
}

static void defaults_are_those_of_the_file(void **state)
{
    (void)state;
    scene_has("#version 3.7; #default { finish { ambient 0 diffuse 1 } }\n"
              "sphere { 0, 1 pigment { rgb x } }",
              "color: [1, 0, 0], specular: 0 }");
    scene_has("#version 3.7; #default { pigment { rgb y } finish { ambient 0 diffuse 1 } }\n"
              "sphere { 0, 1 }",
              "color: [0, 1, 0], specular: 0 }");
    scene_has(
        "#version 3.7; #default { pigment { rgb y } } #declare F = finish { ambient 1 diffuse 0 }"
        "sphere { 0, 1 pigment { rgb x } finish { F } }",
        "color: [0, 0, 0], emission: [1, 0, 0], specular: 0 }");
    scene_has("#version 3.7; global_settings { ambient_light rgb 2 }\n"
              "sphere { 0, 1 pigment { rgb x } }",
              "emission: [0.2, 0, 0]");
}

/* The turns that POV-Ray's manual describes with a left hand: thumb along the axis. */
/* ---- the view ---- */

/* Returns the place of the camera in space as it is here, and the distance of what is seen first. */
static double seen_at(const char *pov, const double eye[3], const double towards[3])
{
    Imported   result  = imported("view.pov", pov);
    KrsOptions options = {0};
    KrsScene  *scene   = NULL;
    KrsState  *state   = NULL;
    KrsHit     hit;
    if (result.status != KRS_OK || krs_compile_text(result.scene, strlen(result.scene), "view.krs",
                                                    &options, &scene) != KRS_OK)
        fail_msg("%s\n%s", result.refusal, result.scene);
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    assert_int_equal(krs_raycast(state, (const double(*)[3])eye, (const double(*)[3])towards, 1,
                                 1000, 1e-6, &hit),
                     KRS_OK);
    krs_state_free(state);
    krs_scene_free(scene);
    return hit.hit ? hit.t : INFINITY;
}

/* POV-Ray's rays see surfaces from inside, too. */
static void solids_around_the_camera_are_seen(void **state)
{
    static const struct {
        const char *objects;
        double      towards[3], t;
    } rows[] = {
        {"plane { z, 10 }", {0, 0, -1}, 10},
        {"sphere { 0, 7 }", {0, 1, 0}, 7},
        {"sphere { 0, 1 scale 5 translate x }", {1, 0, 0}, 6},
        {"box { -3, 3 inverse }", {1, 0, 0}, 3},
        {"box { -3, 3 }", {1, 0, 0}, 3},
        {"plane { y, 9 } sphere { 3*x, 1 }", {1, 0, 0}, 2},
        {"cylinder { -3*y, 3*y, 5 }", {1, 0, 0}, 5},
        {"cylinder { -3*y, 3*y, 5 } sphere { 3*x, 1 }", {1, 0, 0}, 2},
        {"cylinder { <-3, -3, -3>, <5, 5, 5>, 4 } sphere { 3*z, 1 }", {0, 0, -1}, 2},
        {"cone { -4*y, 0, 4*y, 4 }", {1, 0, 0}, 2},
        {"cone { 4*y, 3, -2*y, 6 } sphere { 3*x, 1 }", {1, 0, 0}, 2},
        {"cone { -4*z, 0, 4*z, 8 } sphere { 3*y, 1 }", {0, 1, 0}, 2},
        {"torus { 3, 1 translate 3*x }", {-1, 0, 0}, 1},
        {"torus { 7, 4 translate 7*z } sphere { 2*y, 1 }", {0, 1, 0}, 1},
        {"union { sphere { 0, 9 } sphere { 3*x, 1 } }", {1, 0, 0}, 2},
        {"union { sphere { 0, 9 } sphere { 3*x, 1 } translate 2*x }", {1, 0, 0}, 4},
        {"difference { sphere { 0, 9 } sphere { 0, 4 } }", {1, 0, 0}, 4},
        {"intersection { sphere { 0, 9 } plane { x, 4 } }", {1, 0, 0}, 4},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char   pov[512];
        double eye[3] = {0, 0, 0}, t;
        snprintf(pov, sizeof pov, "camera { location 0 look_at z } %s", rows[i].objects);
        t = seen_at(pov, eye, rows[i].towards);
        if (!(fabs(t - rows[i].t) < 1e-4))
            fail_msg("%s: %g, not %g", pov, t, rows[i].t);
    }
}

static void looks_and_view_are_translated(void **state)
{
    (void)state;
    scene_has("#version 3.7; sphere { 0, 1 pigment { color rgb <1, 0.5, 0> } }",
              "color: [0.6, 0.3, 0], emission: [0.1, 0.05, 0], specular: 0 }\n"
              "let sphere_1 = sphere(1).paint(look_1);");
    scene_has("#declare T = texture { pigment { Red } } sphere { 0, 1 texture { T } }",
              ".paint(look_1);");
    scene_has("union { sphere { 0, 1 pigment { rgb x } } sphere { y, 1 } pigment { rgb z } }",
              "sphere_2 = sphere(1).move([0, 1, 0]).paint(look_2);");
    scene_has("#declare A = union { sphere { 0, 1 pigment { rgb x } } sphere { y, 1 } }\n"
              "object { A } object { A pigment { rgb z } }",
              "sphere_5 = sphere(1).paint(look_1);");
    scene_has("sphere { 0, 1 pigment { rgb x } } sphere { y, 1 pigment { rgb x } }",
              "sphere_2 = sphere(1).move([0, 1, 0]).paint(look_1);");
    scene_has("sphere { 0, 1 finish { phong 1 phong_size 7.5 metallic } }",
              "roughness: 0.5, metallic: 1 }");
    scene_has("sphere { 0, 1 finish { specular 1 roughness 1/30 } }", "roughness: 0.5 }");
    scene_has("sphere { 0, 1 pigment { checker Red, Blue scale 2 } }",
              "// Line 1: patterns of pigments are one colour, their mean.");
    scene_has(
        "sphere { 0, 1 } camera { location <1, 2, -5> look_at <0, 1, 3> angle 90 right 2*x }",
        "eye: [1, 2, 5],\n    target: [0, 1, -3],\n    up: [0, 1, 0],\n    fov: 53.1301023542deg");
    scene_has("sphere { 0, 1 } camera { location -4*z direction z }", "target: [0, 0, 3]");
    scene_has("sphere { 0, 1 } camera { location -4*z look_at 0 right -4/3*x }",
              "eye: [0, 0, -4],\n    target: [0, 0, 0],");
    scene_has("sphere { z, 1 } camera { location -4*z look_at 0 right -4/3*x }",
              "sphere_2 = sphere_1.transform(reflect(plane([0, 0, 1], 0)))");
    scene_has("sphere { 0, 1 } camera { location -4*z look_at 0 orthographic }",
              "projection: \"orthographic\",\n    height: 4\n");
    scene_has("sphere { 0, 1 } camera { orthographic location -4*z look_at 0 }",
              "projection: \"orthographic\",\n    height: 1\n");
    scene_has("sphere { 0, 1 } camera { orthographic location -4*z look_at 0 angle 90 right 2*x }",
              "projection: \"orthographic\",\n    height: 4\n");
    scene_has("sphere { 0, 1 } camera { translate 3*x location -4*z look_at 0 }", "eye: [0, 0, 4]");
    scene_has("sphere { 0, 1 } camera { location -4*z look_at 0 translate 3*x }",
              "eye: [3, 0, 4],\n    target: [3, 0, 0]");
    scene_has("sphere { 9*z, 1 } light_source { 9, rgb 1 }",
              "eye: [0, 0, 0],\n    target: [0, 0, -1]");
    scene_has("sphere { 0, 1 } light_source { <0, 3, 4>, rgb 2 } camera { location -z look_at 0 }"
              "#version 3.7;",
              "light { position: [0, 3, -4], color: [1, 1, 1], intensity: 157.08 }");
    scene_has(
        "sphere { 0, 1 } light_source { 9*y, rgb 2 spotlight point_at y radius 10 falloff 20 }",
        ", target: [0, 1, 0], angle: 40deg, edge: 0.5 }");
    scene_has("#version 3.7; sphere { 0, 1 } background { rgb <0, 0, 0.5> }",
              "sky { zenith: [0, 0, 0.5],");
    scene_has("sphere { 0, 1 } light_source { 9, rgb 1 }", "sky { zenith: [0, 0, 0],");
    scene_has("box { -1, 1 scale <1, 2, 1e-4> }", "= box([2, 4, 0.0002]);");
    scene_has("disc { 0, y, 10 }", "cylinder(10, 0.01).move([0, -0.005, 0]);");
}

/* Means of 600x600 pixels of pictures of POV-Ray 3.7 that show 50 units of a pattern: how often it has
   which value. */
static void means_of_patterns_are_those_of_pictures(void **state)
{
    static const struct {
        const char *pattern, *map;
        double      mean[3], slack;
    } rows[] = {
        {"granite", "[0 rgb 1][0.27 rgb 0][1 rgb 0]", {0.0618, 0.0618, 0.0618}, 0.01},
        {"granite turbulence 1", "[0 rgb 1][0.27 rgb 0][1 rgb 0]", {0.0617, 0.0617, 0.0617}, 0.01},
        {"bozo", "[0 rgb 1][0.4 rgb 0][1 rgb 0]", {0.035, 0.035, 0.035}, 0.01},
        {"agate", "[0 rgb x][0.5 rgb y][1 rgb z]", {0.2617, 0.3838, 0.3545}, 0.01},
        {"wrinkles", "[0.6 rgb 0][0.7 rgb 1]", {0.172, 0.172, 0.172}, 0.02},
        {"crackle", "[0 rgb 1][0.1 rgb 0]", {0.1801, 0.1801, 0.1801}, 0.02},
        {"leopard", "[0.2 rgb 0][0.4 rgb 1]", {0.2106, 0.2106, 0.2106}, 0.02},
        {"dents", "[0 rgb 0][1 rgb 1]", {0.1522, 0.1522, 0.1522}, 0.01},
        {"marble", "[0 rgb 1][0.27 rgb 0][1 rgb 0]", {0.135, 0.135, 0.135}, 0.001},
        {"gradient x",
         "[0.2 rgb 1][0.2 rgb 0][0.6 0.8 color rgb x color rgb z]",
         {0.5, 0.2, 0.5},
         0.001},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char   pov[512];
        double color[3];
        snprintf(pov, sizeof pov,
                 "#version 3.7; sphere { 0, 1 pigment { %s color_map { %s } } finish { diffuse 1 "
                 "ambient 0 } }",
                 rows[i].pattern, rows[i].map);
        Imported found = imported("mean.pov", pov);
        numbers_behind(found.scene, "color", color);
        for (int k = 0; k < 3; k++)
            if (!(fabs(color[k] - rows[i].mean[k]) < rows[i].slack))
                fail_msg("%s: %g, not %g\n%s%s", pov, color[k], rows[i].mean[k], found.scene,
                         found.refusal);
    }
    scene_has("#version 3.7; sphere { 0, 1 pigment { average pigment_map { [1 rgb x][3 rgb z] } } "
              "finish { diffuse 1 } }",
              "color: [0.25, 0, 0.75]");
}

/* What scatters D and mirrors R is a metal of the colour D + R, of which the part R / (D + R) mirrors. */
static void mirrors_are_metals(void **state)
{
    (void)state;
    scene_has("#version 3.7; sphere { 0, 1 pigment { rgb 1 } finish { diffuse 0 ambient 0 "
              "reflection 0.8 } }",
              "{ color: [0.8, 0.8, 0.8], specular: 0, roughness: 0.02, metallic: 1 }");
    scene_has("#version 3.7; sphere { 0, 1 pigment { rgb 0.5 } finish { diffuse 0.6 ambient 0 "
              "reflection { 0.1 } } }",
              "{ color: [0.4, 0.4, 0.4], specular: 0, roughness: 0.02, metallic: 0.25 }");
    scene_has(
        "#version 3.7; sphere { 0, 1 pigment { rgb <1, 0.5, 0> } finish { diffuse 0 ambient 0 "
        "reflection { 0.5 metallic } } }",
        "{ color: [0.5, 0.25, 0], specular: 0, roughness: 0.02, metallic: 1 }");
    /* D = 0.3, 0.15, 0, and R = 0.15 of each: half is mirrored, in a hue between both. */
    scene_has(
        "#version 3.7; sphere { 0, 1 pigment { rgb <1, 0.5, 0> } finish { diffuse 0.3 ambient "
        "0 reflection 0.15 } }",
        "{ color: [0.525, 0.3, 0.075], specular: 0, roughness: 0.02, metallic: 0.5 }");
    scene_has(
        "#version 3.7; sphere { 0, 1 pigment { rgbt 1 } finish { diffuse 0 reflection 0.5 } }",
        "`reflection` of what is transparent is that of its index of refraction");
    scene_has("sphere { 0, 1 finish { reflection { 0.1, 1 } } }",
              "`reflection` is the same from all sides");
}

/* A sky may be declared, and has layers; the first one is behind the others. */
static void skies_may_be_declared(void **state)
{
    (void)state;
    scene_has("#version 3.7; #declare S = sky_sphere { pigment { rgb <0.1, 0.2, 0.3> } }\n"
              "sky_sphere { S } sphere { 0, 1 }",
              "sky { zenith: [0.1, 0.2, 0.3],");
    scene_has("#version 3.7; sky_sphere { pigment { rgb x } pigment { rgbt <0, 0, 1, 0.25> } } "
              "sphere { 0, 1 }",
              "sky { zenith: [0.25, 0, 0.75],");
}

/* Rays end 10,000 times as far as the target: a plane far above the eye reaches down to less than half a
   pixel of 1,000 (0.0005) above the horizon, and the view stays. */
static void far_planes_reach_the_horizon(void **state)
{
    (void)state;
    for (int i = 0; i < 20; i++) {
        char   pov[256];
        double eye[3], target[3], look[3], height = exp(between(0, 12)), away = 0, was = 0,
                                           turn = 0;
        random_vector(&randomness, 3, eye);
        random_vector(&randomness, 3, look);
        snprintf(pov, sizeof pov,
                 "camera { location <%.9g, %.9g, %.9g> look_at <%.9g, %.9g, %.9g> }\n"
                 "plane { y, 1 scale %.9g inverse }",
                 eye[0], eye[1], eye[2], look[0], look[1], look[2], height);
        Imported    found = imported("sky.pov", pov);
        const char *at    = strstr(found.scene, "target: [");
        assert_non_null(at);
        assert_int_equal(sscanf(at, "target: [%lf, %lf, %lf]", &target[0], &target[1], &target[2]),
                         3);
        eye[2]  = -eye[2];
        look[2] = -look[2];
        for (int k = 0; k < 3; k++) {
            away += (target[k] - eye[k]) * (target[k] - eye[k]);
            was += (look[k] - eye[k]) * (look[k] - eye[k]);
            turn += (target[k] - eye[k]) * (look[k] - eye[k]);
        }
        if (!(fabs(height - eye[1]) / (1e4 * sqrt(away)) < 5.1e-4 && turn > 0 &&
              away >= was * (1 - 1e-6) && turn * turn > (1 - 1e-6) * away * was))
            fail_msg("%s\n%s", pov, found.scene);
    }
    scene_has("camera { location <0, 1, -3> look_at y } plane { y, 0 }", "target: [0, 1, 0],");
}

/* POV-Ray 3.7 shows a thing at the distance z of its axis, much smaller than its blur, as a disc of a
   quarter of the aperture times |1 - z / focus|: measured in its pictures, by second moments within 2 %.
   The focus is as far as the focal point before the camera is moved, and one length of `direction`
   without one. */
static void lenses_are_those_of_pov(void **state)
{
    (void)state;
    for (int i = 0; i < 30; i++) {
        char   pov[512], words[128];
        double at[3], point[3], aperture = between(0.01, 3), length = between(0.5, 3);
        bool   focal = i % 3 != 0, late = i % 2 != 0;
        random_vector(&randomness, 5, at);
        random_vector(&randomness, 5, point);
        for (int k = 0; k < 3; k++) {
            at[k]    = round(at[k]);
            point[k] = round(point[k]) + 0.5;
        }
        aperture = round(aperture * 100) / 100;
        length   = round(length * 8) / 8;
        char location[64], focus[64];
        snprintf(location, sizeof location, "location <%g, %g, %g>", at[0], at[1], at[2]);
        snprintf(focus, sizeof focus, "focal_point <%g, %g, %g>", point[0], point[1], point[2]);
        snprintf(pov, sizeof pov,
                 "sphere { 0, 1 } camera { %s direction %g*z %s look_at <9, 8, 7> aperture %g "
                 "blur_samples 20 variance 0 confidence 0.9 translate x rotate 30*y }",
                 late ? (focal ? focus : "") : location, length,
                 late ? location : (focal ? focus : ""), aperture);
        double away = sqrt(pow(at[0] - point[0], 2) + pow(at[1] - point[1], 2) +
                           pow(at[2] - point[2], 2));
        snprintf(words, sizeof words, "aperture: %.12g,\n    focus: %.12g,\n", aperture / 4,
                 focal ? away : length);
        scene_has(pov, words);
    }
}

static void has_not(const char *from, const char *words)
{
    Imported result = imported("look.pov", from);
    if (result.status != KRS_OK || strstr(result.scene, words))
        fail_msg("`%s`: %s\n%s", words, result.refusal, result.scene);
}

/* What a camera of krs cannot be is named with its line, and nothing stands in its place silently. */
static void cameras_are_those_of_pov_or_named(void **state)
{
    static const char *const others[] = {"fisheye", "ultra_wide_angle", "omnimax", "panoramic",
                                         "cylinder 1"};
    (void)state;
    scene_has("sphere { 9*z, 1 } camera { spherical look_at z }", "projection: \"panorama\"\n}");
    scene_has("sphere { 9*z, 1 } camera { look_at z spherical angle 360 }", "\"panorama\"");
    scene_has("sphere { 9*z, 1 } camera { spherical angle 360, 180 look_at z }", "\"panorama\"");
    has_not("sphere { 9*z, 1 } camera { spherical angle 180 look_at z }", "panorama\"");
    scene_has("sphere { 9*z, 1 }\ncamera { spherical angle 360, 90 look_at z }",
              "// Line 2: `spherical` of the camera is left out: it is of 360 by 90 degrees");
    has_not("sphere { 9*z, 1 } camera { look_at z aperture 2 focal_point 3*z }", "aperture:");
    has_not("sphere { 9*z, 1 } camera { look_at z blur_samples 9 focal_point 3*z }", "aperture:");
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        char pov[128], words[128], name[32];
        sscanf(others[i], "%31s", name);
        snprintf(pov, sizeof pov, "sphere { 9*z, 1 }\ncamera { %s look_at z }", others[i]);
        snprintf(words, sizeof words, "// Line 2: `%s` of the camera is left out.", name);
        scene_has(pov, words);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(colors_are_those_of_pov),
        cmocka_unit_test(defaults_are_those_of_the_file),
        cmocka_unit_test(solids_around_the_camera_are_seen),
        cmocka_unit_test(looks_and_view_are_translated),
        cmocka_unit_test(means_of_patterns_are_those_of_pictures),
        cmocka_unit_test(mirrors_are_metals),
        cmocka_unit_test(skies_may_be_declared),
        cmocka_unit_test(far_planes_reach_the_horizon),
        cmocka_unit_test(lenses_are_those_of_pov),
        cmocka_unit_test(cameras_are_those_of_pov_or_named),
    };
    return cmocka_run_group_tests_name("looks of POV-Ray", tests, NULL, NULL);
}
