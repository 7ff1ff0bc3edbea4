/*
 * imports_pov.c: scenes of POV-Ray against closed forms, and random objects against a predicate that
 * the generator finds for them while it writes them, in POV-Ray's left-handed space.
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

enum { SIGNS = 100, TREES = 16, POINTS = 300 };

static Random randomness = {1991};

static double between(double low, double high) { return random_between(&randomness, low, high); }
static int    below(int count) { return random_below(&randomness, count); }

/* ---- closed forms ---- */

static double distance_at(const char *text, double x, double y, double z)
{
    double point[1][3] = {{x, y, -z}}, distance; /* the scene's z points to the eye */
    imported_distances("form.pov", text, point, 1, &distance);
    return distance;
}

static void check(const char *text, double x, double y, double z, double expected)
{
    double found = distance_at(text, x, y, z);
    if (!(fabs(found - expected) < 1e-6))
        fail_msg("%s\nat %g %g %g: %.9g, not %.9g", text, x, y, z, found, expected);
}

static void distances_are_closed_forms(void **state)
{
    (void)state;
    check("sphere { <1, 2, 3>, 0.5 }", 1, 2, 5, 1.5);
    check("sphere { 0, 1 translate 3*z }", 0, 0, 5, 1);
    check("box { <0, 0, 0>, <1, 2, 3> }", 0.5, 1, 5, 2);
    check("box { <1, 2, 3>, <0, 0, 0> }", 0.5, 1, -1, 1);
    check("cylinder { <0, 0, 1>, <0, 0, 4>, 1 }", 0, 0, 6, 2);
    check("cylinder { <0, 0, 1>, <0, 0, 4>, 1 }", 0, 3, 2, 2);
    check("cone { <0, 0, 0>, 2, <0, 4, 0>, 0 }", 3, 0, 0, 1);
    check("cone { <0, 0, 0>, 2, <0, -4, 0>, 0 }", 3, 0, 0, 1);
    check("cone { <0, 0, 0>, 2, <0, 0, 4>, 0 }", 0, 0, 6, 2);
    check("torus { 2, 0.5 }", 0, 0, 4, 1.5);
    check("torus { 2, 0.5 rotate 90*x }", 0, 4, 0, 1.5);
    check("plane { z, 3 }", 1, 2, 5, 2);
    check("plane { <0, 0, -2>, 3 }", 0, 0, 1, -4);
    check("union { sphere { 0, 1 } box { 2, 3 } }", 0, 0, -3, 2);
    check("merge { sphere { 0, 1 } sphere { 4*x, 1 } }", 4, 0, 3, 2);
    check("difference { sphere { 0, 3 } sphere { 0, 1 } }", 0, 0, 0, 1);
    check("intersection { sphere { 0, 1 } plane { z, 0 } }", 0, 0, 3, 3);
    check("#declare R = 2; #declare P = <1, 0, R>; sphere { P*R + y, sqrt(R*8)/pow(2, R) }", 2, 1,
          8, 3);
}

/* A prism of two contours, each of them through the corners of a square, has a hole, whatever spline
   goes through them. */
static void contours_of_splines_cut_holes(void **state)
{
    static const struct {
        const char *name;
        int         before, behind; /* points beside the corners, which begin and end equal */
        bool        bezier;
    } splines[]                       = {{"linear_spline", 0, 0, false},
                                         {"quadratic_spline", 1, 0, false},
                                         {"cubic_spline", 1, 1, false},
                                         {"bezier_spline", 0, 0, true}};
    static const double corners[5][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
    (void)state;
    for (size_t s = 0; s < sizeof splines / sizeof *splines; s++) {
        char   pov[2048];
        int    count = splines[s].bezier ? 16 : 5 + splines[s].before + splines[s].behind;
        size_t end   = (size_t)sprintf(pov, "prism { %s 0, 1, %d", splines[s].name, 2 * count);
        for (int i = 0; i < 2 * count; i++) {
            double        side = i < count ? 3 : 1, t = i % 4 / 3.0;
            int           k = splines[s].bezier ? i % count / 4 : i % count - splines[s].before;
            const double *a = corners[(k + 4) % 4], *b = corners[(k + 4) % 4 + 1];
            double        x = splines[s].bezier ? a[0] + t * (b[0] - a[0]) : a[0];
            double        y = splines[s].bezier ? a[1] + t * (b[1] - a[1]) : a[1];
            end += (size_t)sprintf(pov + end, ", <%.9g, %.9g>", side * x, side * y);
        }
        sprintf(pov + end, " }");
        assert_true(distance_at(pov, 0, 0.5, 0) > 0.4);
        assert_true(distance_at(pov, 0.8, 0.5, -0.8) > 0.1);
        assert_true(distance_at(pov, 2, 0.5, 0) < 0 && distance_at(pov, -2, 0.5, -2.5) < 0);
        assert_true(distance_at(pov, 0, 0.5, -2.5) < 0 && distance_at(pov, 5, 0.5, 0) > 0.5);
        if (splines[s].before == 0) {
            check(pov, 0, 0.5, 0.25, 0.75);
            check(pov, 2.75, 0.5, 0, -0.25);
        }
    }
}

static void what_is_declared_can_be_used(void **state)
{
    (void)state;
    check("#declare A = sphere { 0, 1 }\nobject { A scale 2 translate 5*z }", 0, 0, 9, 2);
    check("#local V = vnormalize(<0, 3, 4>);\nsphere { V, 0.5 }", 0, 0.6, 2.8, 1.5);
    check("#declare sphere_1 = sphere { 0, 1 }\n#declare sphere_1 = sphere { 0, 2 }\n"
          "object { sphere_1 }",
          0, 0, 5, 3);
    check("sphere { <0, 0, vdot(<1, 2, 3>, z)>, max(1, 0.5).x }", 0, 0, 6, 2);
}

/* Programs against what they unroll to. */
static void programs_are_carried_out(void **state)
{
    static const struct {
        const char *program, *unrolled;
    } rows[] = {
        {"#declare A = array[3] {1, 2} #for (I, 0, 2) #ifdef (A[I]) sphere { A[I]*x, 1 } #end #end",
         "sphere { x, 1 } sphere { 2*x, 1 }"},
        {"#declare A = array[2] {1} #ifndef (A[1]) sphere { 0, A[0] } #else box { 0, 1 } #end",
         "sphere { 0, 1 }"},
        {"#macro M(P) #ifdef (P) sphere { 0, P } #else sphere { 0, 2 } #end #end M(3) #ifdef (M) "
         "box { 4, 5 } #end",
         "sphere { 0, 3 } box { 4, 5 }"},
        {"#local I = 0; union { #while (I < 3) sphere { I*4*x, 1 } #local I = I + 1; #end }",
         "union { sphere { 0, 1 } sphere { 4*x, 1 } sphere { 8*x, 1 } }"},
        {"#for (I, 1, 3) sphere { I*4*y, 1 } #end",
         "sphere { 4*y, 1 } sphere { 8*y, 1 } sphere { 12*y, 1 }"},
        {"#for (I, 2, 0, -1) sphere { I*4*y, 1 } #end",
         "sphere { 8*y, 1 } sphere { 4*y, 1 } sphere { 0, 1 }"},
        {"#macro Ball(P, R) sphere { P, R } #end Ball(<1, 2, 3>, 2)", "sphere { <1, 2, 3>, 2 }"},
        {"#macro Twice(A) (2*(A)) #end sphere { 0, Twice(3) + Twice(Twice(1)) }",
         "sphere { 0, 10 }"},
        {"#declare N = 4; #if (N > 3 & N != 5) sphere { 0, 1 } #else box { 0, 1 } #end",
         "sphere { 0, 1 }"},
        {"#declare N = 4; #if (N > 4) sphere { 0, 1 } #elseif (N = 4) box { 0, 2 } #else box { 0, "
         "1 } #end",
         "box { 0, 2 }"},
        {"#switch (3) #case (1) sphere { 0, 1 } #break #range (2, 4) sphere { 0, 2 } #case (9) "
         "sphere { x, 3 }"
         " #break #else box { 0, 1 } #end",
         "sphere { 0, 2 } sphere { x, 3 }"},
        {"#local I = 0; #while (1) #if (I = 2) #break #end sphere { I*4*x, 1 } #local I = I + 1; "
         "#end",
         "sphere { 0, 1 } sphere { 4*x, 1 }"},
        {"#declare A = 3 #declare B = A + 1 sphere { 0, B }", "sphere { 0, 4 }"},
        {"#declare A = 1; #macro Set(V) #declare V = 5; #end Set(A) sphere { 0, A }",
         "sphere { 0, 5 }"},
        {"#macro M() #local A = 7; #end #declare A = 2; M() sphere { 0, A }", "sphere { 0, 2 }"},
        {"#declare A = array[2][2] {{1, 2}, {3, 4}}; #declare A[1][1] = 9; sphere { A[0][1]*x, "
         "A[1][1] }",
         "sphere { 2*x, 9 }"},
        {"#declare F = function(u, v) { u*u + v }; sphere { 0, F(2, 3) }", "sphere { 0, 7 }"},
        {"#declare T = transform { translate x rotate 90*z } sphere { 0, 1 transform { T } }",
         "sphere { 0, 1 translate x rotate 90*z }"},
        {"#declare T = transform { scale 2 translate x inverse } sphere { 0, 2 transform T }",
         "sphere { -x/2, 1 }"},
        {"sphere { <1, #if (1) 2 #else 5 #end, 3>, select(-1, 4, 5) }", "sphere { <1, 2, 3>, 4 }"},
        {"#ifndef (A) #declare A = 2; #end #ifdef (A) sphere { 0, A } #end", "sphere { 0, 2 }"},
        {"#declare S = concat(\"a\", str(2, 0, 1)); sphere { 0, strlen(S) }", "sphere { 0, 4 }"},
        {"sphere { vrotate(2*x, 90*z), (3 > 2 ? 1 : 5) }", "sphere { 2*y, 1 }"},
        {"prism { linear_spline 0, 2, 5, <0,0>, <3,0>, <3,1>, <0,1>, <0,0> }",
         "box { 0, <3, 2, 1> }"},
        {"lathe { linear_spline 4, <0,0>, <2,0>, <2,3>, <0,3> }", "cylinder { 0, 3*y, 2 }"},
        {"union { object { box { -1, 1 } inverse } sphere { 8*x, 2 } }",
         "union { difference { plane { y, 1000000 } box { -1, 1 } } sphere { 8*x, 2 } }"},
        {"#declare A = array[2][2]; #declare A[1][1] = sphere { 2*x, 1 } object { A[1][1] }",
         "sphere { 2*x, 1 }"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        double points[200][3], found[200], wanted[200];
        for (int k = 0; k < 200; k++)
            for (int m = 0; m < 3; m++)
                points[k][m] = between(-12, 12);
        imported_distances("program.pov", rows[i].program, points, 200, found);
        imported_distances("unrolled.pov", rows[i].unrolled, points, 200, wanted);
        for (int k = 0; k < 200; k++)
            if (!(fabs(found[k] - wanted[k]) < 1e-6))
                fail_msg("%s\nat %g %g %g: %.9g, not %.9g", rows[i].program, points[k][0],
                         points[k][1], points[k][2], found[k], wanted[k]);
    }
}

/* Strength (1 - (d / r)^2)^2 within r, above the threshold. */
static void blobs_have_their_formula(void **state)
{
    static const char text[] =
        "blob { threshold 0.5 sphere { 0, 2, 1 } sphere { <1.5, 0, 1>, 2, 0.8 }"
        " cylinder { <0, 1, 0>, <0, 3, 0>, 1, 1.2 } }";
    double points[POINTS][3], distances[POINTS];
    (void)state;
    for (int i = 0; i < POINTS; i++)
        for (int k = 0; k < 3; k++)
            points[i][k] = between(-2, 3.5);
    imported_distances("blob.pov", text, points, POINTS, distances);
    for (int i = 0; i < POINTS; i++) {
        double q[3] = {points[i][0], points[i][1], -points[i][2]}, sum = 0;
        double a = q[0] * q[0] + q[1] * q[1] + q[2] * q[2];
        double b = (q[0] - 1.5) * (q[0] - 1.5) + q[1] * q[1] + (q[2] - 1) * (q[2] - 1);
        double h = fmin(fmax(q[1], 1), 3);
        double c = q[0] * q[0] + (q[1] - h) * (q[1] - h) + q[2] * q[2];
        sum += a < 4 ? pow(1 - a / 4, 2) : 0;
        sum += b < 4 ? 0.8 * pow(1 - b / 4, 2) : 0;
        sum += c < 1 ? 1.2 * pow(1 - c, 2) : 0;
        if (fabs(sum - 0.5) > 1e-4 && (distances[i] < 0) != (sum > 0.5))
            fail_msg("at %g %g %g: %g where the field is %g", q[0], q[1], q[2], distances[i], sum);
    }
}

static void turns_are_left_handed(void **state)
{
    (void)state;
    check("sphere { 3*x, 1 rotate 90*y }", 0, 0, -3, -1);
    check("sphere { 3*z, 1 rotate <0, 90, 0> }", 3, 0, 0, -1);
    check("sphere { 3*y, 1 rotate 90*x }", 0, 0, 3, -1);
    check("sphere { 3*x, 1 rotate 90*z }", 0, 3, 0, -1);
    check("sphere { 3*x, 1 rotate <90, 90, 0> }", 0, 0, -3, -1);
    check("sphere { 3*y, 1 rotate <90, 90, 0> }", 3, 0, 0, -1);
    check("sphere { 3*z, 1 matrix <1, 0, 0, 0, 1, 0, 1, 0, 1, 0, 0, 2> }", 3, 0, 5, -0.618033989);
}

static double samples[SIGNS][3];

static double ball(const double p[3]) { return p[0] * p[0] + p[1] * p[1] + p[2] * p[2] - 1; }
static double mixed_value(const double p[3]) { return ball(p) + p[1] * p[2]; }
static double quartic_value(const double p[3])
{
    return pow(p[0], 4) + pow(p[1], 4) + pow(p[2], 4) - 2 * p[2] - 0.5;
}

/* At these points, moved along z, which the scene has the other way round. */
static void check_signs(const char *text, double (*value)(const double p[3]), double z)
{
    double moved[SIGNS][3], distances[SIGNS];
    for (int i = 0; i < SIGNS; i++) {
        memcpy(moved[i], samples[i], sizeof moved[i]);
        moved[i][2] = -(samples[i][2] + z);
    }
    imported_distances("form.pov", text, moved, SIGNS, distances);
    for (int i = 0; i < SIGNS; i++)
        assert_true((value(samples[i]) < 0) == (distances[i] < 0));
}

/* The zero set, not the distance: polynomials have a bound. */
static void polynomials_have_their_signs(void **state)
{
    const char *quadric = "quadric { <1, 1, 1>, <0, 0, 0>, <0, 0, -8>, 15 }";
    const char *mixed   = "quadric { <1, 1, 1>, <0, 0, 1>, <0, 0, 0>, -1 }"; /* y z */
    const char *quartic = "quartic { <1,0,0,0,0,0,0,0,0,0, 0,0,0,0,0,0,0,0,0,0,"
                          "1,0,0,0,0,0,0,0,0,0, 1,0,0,-2,-0.5> }";
    const char *poly    = "poly { 2, <1, 0, 0, 0, 1, 0, 0, 1, -8, 15> }";
    (void)state;
    for (int i = 0; i < SIGNS; i++)
        random_vector(&randomness, 2, samples[i]);
    check_signs(quadric, ball, 4);
    check_signs(poly, ball, 4);
    check_signs(mixed, mixed_value, 0);
    check_signs(quartic, quartic_value, 0);
}

/* ---- random objects ---- */

static void random_objects_have_the_points_of_their_predicate(void **state)
{
    int inside = 0;
    (void)state;
    for (int i = 0; i < TREES; i++) {
        double  own[POINTS][3], points[POINTS][3], distances[POINTS];
        PovTree tree;
        pov_tree_begin(&tree, &randomness);
        int root = pov_tree_write(&tree, below(3));
        for (int k = 0; k < POINTS; k++) {
            random_vector(&randomness, 2, own[k]);
            memcpy(points[k], own[k], sizeof own[k]);
            points[k][2] = -own[k][2];
        }
        imported_distances("random.pov", tree.text, points, POINTS, distances);
        for (int k = 0; k < POINTS; k++) {
            bool has = pov_tree_has(&tree, root, own[k]);
            inside += has;
            if (fabs(distances[k]) > 1e-7 && has != (distances[k] < 0))
                fail_msg("%g %g %g is %s, but distance %g, of\n%s\n%s", own[k][0], own[k][1],
                         own[k][2], has ? "inside" : "outside", distances[k], tree.text,
                         imported("random.pov", tree.text).scene);
        }
    }
    assert_true(inside > TREES * POINTS / 50);
}

/* ---- what is no scene ---- */

static void what_cannot_be_translated_is_said_with_its_line(void **state)
{
    (void)state;
    assert_refused("a.pov", "\nmesh { }", "a.pov:2: `mesh` is not translated");
    assert_refused("a.pov", "\n#while (1) #end", "a.pov:2: this program has no end");
    assert_refused("a.pov", "\n#macro A() A() #end A()", "a.pov:2: macros and files are more than");
    assert_refused("a.pov", "\n#if (1) sphere { 0, 1 } #else", "a.pov:2: there is no `#end`");
    assert_refused("a.pov", "#end", "a.pov:1: `#end` of nothing");
    assert_refused("a.pov", "#declare A = array[3]; sphere { 0, A[3] }",
                   "a.pov:1: the index 3 is not");
    assert_refused("a.pov", "\n#declare A = array[2] {\"x\"} #declare B = concat(A[1], \"y\");",
                   "a.pov:2: this element of the array has no value yet");
    assert_refused("a.pov", "#declare A = array[2] {x, sphere { 0, 1 }} sphere { A[1], 1 }",
                   "a.pov:1: there should be an element that is a number");
    assert_refused("a.pov", "#declare A = array[2] {sphere { 0, 1 }} object { A[1] }",
                   "a.pov:1: this element of the array has no value yet");
    assert_refused("a.pov", "#declare A = array[2] {sphere { 0, 1 }, \"x\"} object { A[1] }",
                   "a.pov:1: this is another kind of value than the array's first");
    assert_refused("a.pov", "\n#error \"stop here\"", "a.pov:2: the file says: stop here");
    assert_refused("a.pov", "\n\nsphere { 0, 1 contained_by { plane { x, 0 } } }",
                   "a.pov:3: `contained_by` in `sphere` is not translated");
    assert_refused("a.pov", "sphere { 0, R }", "a.pov:1: there should be a number");
    assert_refused("a.pov", "sphere { 0, 1", "a.pov:1: the file ends where");
    assert_refused("a.pov", "sphere { 0, <1, 2, 3> }", "a.pov:1: a number is needed");
    assert_refused("a.pov", "sphere { 0, 1 / 0 }", "a.pov:1: a result is not a finite");
    assert_refused("a.pov", "/* /* */", "a.pov:1: this comment has no end");
    assert_refused("a.pov", "camera { location 0 }", "a.pov:1: nothing is shown");
    assert_refused("a.pov", "#declare A = union { object { B } }",
                   "a.pov:1: there should be an object");
    assert_refused("a.pov", "\nbox { 0, <1, 0, 0> }", "a.pov:2: a size is not above 0");
}

static void damaged_files_do_no_harm(void **state)
{
    const char *whole =
        "#version 3.7;\n#include \"colors.inc\"\n/* a /* nested */ comment */\n"
        "#declare R = 0.9; #declare Hole = cylinder { <0, -1, 0>, <0, 3, 0>, R/3 }\n"
        "camera { location <0, 2, -5> look_at <0, 1, 0> angle 40 }\n"
        "light_source { <100, 200, -100>, rgb 1 parallel point_at 0 }\nbackground { rgb 0.5 }\n"
        "difference { box { <-1, 0, -1>, <1, 2, 1> } object { Hole rotate <0, 30, 0> scale 2 }\n"
        "pigment { color rgb <0.8, 0.5, 0.2> } finish { phong 0.8 ambient 0.1 } }\n"
        "plane { y, -sqrt(2)*(1 - 0.5) pigment { checker Red, White } }\n";
    static char deep[8192];
    (void)state;
    assert_damage_is_harmless(&randomness, "damaged.pov", whole, 32);
    for (int i = 0; i < 1000; i++)
        strcpy(deep + 8 + 2 * i, "-(");
    memcpy(deep, "sphere {", 8);
    assert_refused("deep.pov", deep, "deep.pov:1: more than 200 deep");
}

/* With --keep-going: each part that is refused is named once, with its line; the others are there. */
static void what_is_refused_is_left_out(void **state)
{
    static const struct {
        const char *pov, *said, *kept; /* the scene has all words of both, behind each other */
    } rows[] = {
        {"sphere { 0, 1 }\nmesh { triangle { 0, x, y } }\nbox { 2, 3 }", "Line 2: a part",
         "= box("},
        {"#declare M = mesh { triangle { 0, x, y } }\nobject { M translate x }\nbox { 2, 3 }",
         "Line 1: a part", "= box("},
        {"#declare M = difference { sphere { 0, 1 } mesh { triangle { 0, x, y } } }\nunion { "
         "object { M "
         "} "
         "box { 2, 3 } }",
         "Line 1: a part", "= box("},
        {"union { sphere { 0, 1 }\nbicubic_patch { type 1 } }", "Line 2: a part", "= sphere("},
        {"union { sphere { 0, 1 contained_by { plane { y, 0 } } }\nbox { 2, 3 } }",
         "Line 1: a part", "= box("},
        {"difference { sphere { 0, 1 }\nmesh { triangle { 0, x, y } } }\nbox { 2, 3 }",
         "Line 1: a part", "= box("},
        {"#declare N = 0;\n#while (N < 3)\nsphere { 0, 1 contained_by { plane { y, 0 } } }\n"
         "box { N, N + 1 }\n#declare N = N + 1;\n#end",
         "Line 3: a part", "2.5, 2.5, -2.5"},
        {"#macro Ball(P) sphere { P, 1 } height_field { png \"a.png\" } #end\nBall(9*z) box { 2, 3 "
         "}",
         "a part is left out", "= box("},
        {"torus { 0, 1 }\nsphere { 7, 1 }", "Line 1: a part", "[7, 7, -7]"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        Imported    found = imported_as_far_as_possible("rest.pov", rows[i].pov);
        const char *said  = found.status == KRS_OK ? strstr(found.scene, rows[i].said) : NULL;
        if (!said || !strstr(said, rows[i].kept) || strstr(said + 1, rows[i].said))
            fail_msg("%s\n%s\n%s", rows[i].pov, found.scene, found.refusal);
    }
    assert_refused("all.pov", "\nmesh { }", "all.pov:2: `mesh` is not translated");
}

/* Declarations of declarations: twice as many parts with each, but for their names. */
static void doubled_names_are_written_once(void **state)
{
    static char many[8192] = "#declare A0 = sphere { 0, 1 }\n";
    size_t      end        = strlen(many);
    (void)state;
    for (int i = 1; i <= 12; i++)
        end += (size_t)snprintf(
            many + end, sizeof many - end,
            "#declare A%d = union { object { A%d } object { A%d translate %d } }\n", i, i - 1,
            i - 1, i);
    strcpy(many + end, "object { A12 }\n");
    Imported result = imported("many.pov", many);
    assert_true(strlen(result.scene) < 8192);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(distances_are_closed_forms),
        cmocka_unit_test(contours_of_splines_cut_holes),
        cmocka_unit_test(what_is_declared_can_be_used),
        cmocka_unit_test(programs_are_carried_out),
        cmocka_unit_test(blobs_have_their_formula),
        cmocka_unit_test(turns_are_left_handed),
        cmocka_unit_test(polynomials_have_their_signs),
        cmocka_unit_test(random_objects_have_the_points_of_their_predicate),
        cmocka_unit_test(what_cannot_be_translated_is_said_with_its_line),
        cmocka_unit_test(what_is_refused_is_left_out),
        cmocka_unit_test(damaged_files_do_no_harm),
        cmocka_unit_test(doubled_names_are_written_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
