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

enum { SIGNS = 100, TREES = 16, POINTS = 300, MOST_NODES = 64, MOST_TURNS = 3, MOST_TEXT = 16384 };

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

/* The turns that POV-Ray's manual describes with a left hand: thumb along the axis. */
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

typedef enum Kind { BALL, BOX, COLUMN, RING, HALF, JOIN } Kind;

typedef struct Turn {
    int    kind; /* 0 translate, 1 rotate, 2 scale */
    double by[3];
} Turn;

typedef struct Node {
    Kind   kind;
    int    join, count, items[3], turn_count;
    double a[3], b[3], r, s;
    Turn   turns[MOST_TURNS];
} Node;

static Node   nodes[MOST_NODES];
static int    node_count;
static char   text[MOST_TEXT];
static size_t length;

static void write_text(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    length += (size_t)vsnprintf(text + length, sizeof text - length, format, arguments);
    va_end(arguments);
    assert_true(length < sizeof text);
}

static void write_primitive(Node *node)
{
    const double *a = node->a, *b = node->b;
    random_vector(&randomness, 1, node->a);
    random_vector(&randomness, 1, node->b);
    node->r = between(0.3, 1);
    node->s = below(3) ? between(0, 1) : node->r;
    switch (node->kind) {
    case BALL:
        write_text("sphere { <%.17g, %.17g, %.17g>, %.17g ", a[0], a[1], a[2], node->r);
        break;
    case BOX:
        write_text("box { <%.17g, %.17g, %.17g>, <%.17g, %.17g, %.17g> ", a[0], a[1], a[2], b[0],
                   b[1], b[2]);
        break;
    case COLUMN:
        write_text("cone { <%.17g, %.17g, %.17g>, %.17g, <%.17g, %.17g, %.17g>, %.17g ", a[0], a[1],
                   a[2], node->r, b[0], b[1], b[2], node->s);
        break;
    case RING:
        node->s = node->r * between(0.2, 0.8);
        write_text("torus { %.17g, %.17g ", node->r, node->s);
        break;
    default: write_text("plane { <%.17g, %.17g, %.17g>, %.17g ", a[0], a[1], a[2], b[0]);
    }
}

static void write_turns(Node *node)
{
    static const char *const words[] = {"translate", "rotate", "scale"};
    node->turn_count                 = below(MOST_TURNS + 1);
    for (int i = 0; i < node->turn_count; i++) {
        Turn *turn = &node->turns[i];
        turn->kind = below(3);
        for (int k = 0; k < 3; k++)
            turn->by[k] = turn->kind == 0   ? between(-1, 1)
                          : turn->kind == 1 ? (below(2) ? between(-180, 180) : 0)
                                            : between(0.6, 1.4) * (below(8) ? 1 : -1);
        write_text("%s <%.17g, %.17g, %.17g> ", words[turn->kind], turn->by[0], turn->by[1],
                   turn->by[2]);
    }
    write_text("}\n");
}

static int write_tree(int depth)
{
    static const char *const joins[] = {"union", "intersection", "difference", "merge"};
    int                      index   = node_count++;
    assert_true(index < MOST_NODES);
    Node *node = &nodes[index];
    *node      = (Node){.kind = depth == 0 ? (Kind)below(JOIN) : JOIN};
    if (node->kind == JOIN) {
        node->join  = below(4);
        node->count = 2 + below(2);
        write_text("%s {\n", joins[node->join]);
        for (int i = 0; i < node->count; i++)
            node->items[i] = write_tree(depth - 1);
    } else {
        write_primitive(node);
    }
    write_turns(node);
    return index;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static bool primitive_has(const Node *node, const double q[3])
{
    double off[3], along[3], round = hypot(q[0], q[2]);
    for (int i = 0; i < 3; i++) {
        off[i]   = q[i] - node->a[i];
        along[i] = node->b[i] - node->a[i];
    }
    double t = dot(off, along) / dot(along, along);
    switch (node->kind) {
    case BALL: return dot(off, off) < node->r * node->r;
    case BOX:
        for (int i = 0; i < 3; i++)
            if ((q[i] - node->a[i]) * (q[i] - node->b[i]) > 0)
                return false;
        return true;
    case COLUMN:
        return t > 0 && t < 1 &&
               sqrt(fmax(dot(off, off) - t * t * dot(along, along), 0)) <
                   node->r + t * (node->s - node->r);
    case RING: return hypot(round - node->r, q[1]) < node->s;
    default: return dot(node->a, q) / sqrt(dot(node->a, node->a)) < node->b[0];
    }
}

/* Back from where a turn takes points: z, y and x in this order, each against its sense. */
static void undo(const Turn *turn, double q[3])
{
    for (int axis = 2; axis >= 0 && turn->kind == 1; axis--) {
        double angle = -turn->by[axis] * acos(-1) / 180;
        int    i = (axis + 1) % 3, k = (axis + 2) % 3;
        double a = q[i], b = q[k];
        q[i] = a * cos(angle) - b * sin(angle);
        q[k] = a * sin(angle) + b * cos(angle);
    }
    for (int i = 0; i < 3 && turn->kind != 1; i++)
        q[i] = turn->kind == 0 ? q[i] - turn->by[i] : q[i] / turn->by[i];
}

static bool tree_has(int index, const double outer[3])
{
    const Node *node = &nodes[index];
    double      q[3] = {outer[0], outer[1], outer[2]};
    for (int i = node->turn_count; i-- > 0;)
        undo(&node->turns[i], q);
    if (node->kind < JOIN)
        return primitive_has(node, q);
    bool first = tree_has(node->items[0], q), all = first, any = first, others = false;
    for (int i = 1; i < node->count; i++) {
        bool has = tree_has(node->items[i], q);
        all      = all && has;
        any      = any || has;
        others   = others || has;
    }
    return node->join == 1 ? all : node->join == 2 ? first && !others : any;
}

static void random_objects_have_the_points_of_their_predicate(void **state)
{
    int inside = 0;
    (void)state;
    for (int i = 0; i < TREES; i++) {
        double own[POINTS][3], points[POINTS][3], distances[POINTS];
        node_count = 0;
        length     = 0;
        int root   = write_tree(below(3));
        for (int k = 0; k < POINTS; k++) {
            random_vector(&randomness, 2, own[k]);
            memcpy(points[k], own[k], sizeof own[k]);
            points[k][2] = -own[k][2];
        }
        imported_distances("random.pov", text, points, POINTS, distances);
        for (int k = 0; k < POINTS; k++) {
            bool has = tree_has(root, own[k]);
            inside += has;
            if (fabs(distances[k]) > 1e-7 && has != (distances[k] < 0))
                fail_msg("%g %g %g is %s, but distance %g, of\n%s\n%s", own[k][0], own[k][1],
                         own[k][2], has ? "inside" : "outside", distances[k], text,
                         imported("random.pov", text).scene);
        }
    }
    assert_true(inside > TREES * POINTS / 50);
}

/* ---- looks, view, and what is no scene ---- */

static void scene_has(const char *from, const char *words)
{
    Imported result = imported("look.pov", from);
    if (result.status != KRS_OK || !strstr(result.scene, words))
        fail_msg("no `%s`: %s\n%s", words, result.refusal, result.scene);
}

static void looks_and_view_are_translated(void **state)
{
    (void)state;
    scene_has("sphere { 0, 1 pigment { color rgb <1, 0.5, 0> } }", ".paint([1, 0.5, 0]);");
    scene_has("#declare T = texture { pigment { Red } } sphere { 0, 1 texture { T } }",
              ".paint([1, 0, 0]);");
    scene_has("union { sphere { 0, 1 pigment { rgb x } } sphere { y, 1 } pigment { rgb z } }",
              "sphere_2 = sphere(1).move([0, 1, 0]).paint([0, 0, 1]);");
    scene_has("#declare A = union { sphere { 0, 1 pigment { rgb x } } sphere { y, 1 } }\n"
              "object { A } object { A pigment { rgb z } }",
              "sphere_5 = sphere(1).paint([1, 0, 0]);");
    scene_has("sphere { 0, 1 finish { phong 1 phong_size 6 metallic } }",
              "roughness: 0.5, metallic: 1 }");
    scene_has("sphere { 0, 1 pigment { checker Red, Blue scale 2 } }",
              "// Line 1: `checker` of a pigment is left out.");
    scene_has(
        "sphere { 0, 1 } camera { location <1, 2, -5> look_at <0, 1, 3> angle 90 right 2*x }",
        "eye: [1, 2, 5],\n    target: [0, 1, -3],\n    up: [0, 1, 0],\n    fov: 53.1301023542deg");
    scene_has("sphere { 0, 1 } camera { location -4*z direction z }", "target: [0, 0, 3]");
    scene_has("sphere { 0, 1 } light_source { <0, 3, 4>, rgb 2 }",
              "light { position: [0, 3, -4], color: [1, 1, 1], intensity: 150 }");
    scene_has("sphere { 0, 1 } background { rgb <0, 0, 0.5> }", "sky { zenith: [0, 0, 0.5],");
}

static void what_cannot_be_translated_is_said_with_its_line(void **state)
{
    (void)state;
    assert_refused("a.pov", "\nblob { threshold 1 }", "a.pov:2: `blob` is not translated");
    assert_refused("a.pov", "#while (1) #end", "a.pov:1: `#while` is not translated");
    assert_refused("a.pov", "\n\nsphere { 0, 1 clipped_by { plane { x, 0 } } }",
                   "a.pov:3: `clipped_by` in `sphere` is not translated");
    assert_refused("a.pov", "cylinder { 0, y, 1 open }", "a.pov:1: `open` in `cylinder`");
    assert_refused("a.pov", "sphere { 0, R }", "a.pov:1: there should be a number");
    assert_refused("a.pov", "sphere { 0, 1", "a.pov:1: the file ends where");
    assert_refused("a.pov", "sphere { 0, <1, 2, 3> }", "a.pov:1: a number is needed");
    assert_refused("a.pov", "sphere { 0, 1 / 0 }", "a.pov:1: a result is not a finite");
    assert_refused("a.pov", "/* /* */", "a.pov:1: this comment has no end");
    assert_refused("a.pov", "camera { location 0 }", "a.pov:1: nothing is shown");
    assert_refused("a.pov", "#declare A = union { object { B } }",
                   "a.pov:1: there should be an object");
    assert_refused("a.pov", "\nbox { 0, <1, 1, 0> }", "a.pov:2: a size is not above 0");
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
        cmocka_unit_test(what_is_declared_can_be_used),
        cmocka_unit_test(turns_are_left_handed),
        cmocka_unit_test(polynomials_have_their_signs),
        cmocka_unit_test(random_objects_have_the_points_of_their_predicate),
        cmocka_unit_test(looks_and_view_are_translated),
        cmocka_unit_test(what_cannot_be_translated_is_said_with_its_line),
        cmocka_unit_test(damaged_files_do_no_harm),
        cmocka_unit_test(doubled_names_are_written_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
