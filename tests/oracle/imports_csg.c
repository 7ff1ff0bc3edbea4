/*
 * imports_csg.c: trees of OpenSCAD against closed forms, and random trees against a predicate that
 * the generator finds for them while it writes them: which points are inside.
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

enum { TREES = 10, POINTS = 300, MAX_NODES = 64, MAX_TEXT = 16384 };

static Random randomness = {152};

static double between(double low, double high) { return random_between(&randomness, low, high); }
static int    below(int count) { return random_below(&randomness, count); }

/* ---- closed forms ---- */

static double distance_at(const char *text, double x, double y, double z)
{
    double point[1][3], distance;
    upright_point((double[]){x, y, z}, point[0]);
    imported_distances("form.csg", text, point, 1, &distance);
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
    check("cube(size = [1, 2, 3], center = false);", 2, 1, 1, 1);
    check("cube(size = [1, 2, 3], center = false);", 0.5, 1, 4, 1);
    check("cube(size = [1, 2, 3], center = true);", 0, 3, 0, 2);
    check("sphere($fn = 0, $fa = 12, $fs = 2, r = 2);", 0, 0, 5, 3);
    check("cylinder(h = 2, r1 = 1, r2 = 1, center = false);", 0, 0, 3, 1);
    check("cylinder(h = 2, r1 = 1, r2 = 1, center = true);", 0, 0, 3, 2);
    check("cylinder(h = 4, r1 = 2, r2 = 0, center = false);", 0, 0, 5, 1);
    check("cylinder(h = 4, r1 = 2, r2 = 0, center = false);", 3, 0, 0, 1);
    check("cylinder($fn = 6, h = 2, r1 = 1, r2 = 1);", 3, 0, 1, 2);
    check("cylinder($fn = 6, h = 2, r1 = 1, r2 = 1);", 0, 3, 1, 3 - sqrt(0.75));
    check("cylinder($fn = 4, h = 2, r1 = 1, r2 = 0);", 0, 0, 5, 3);
    check("multmatrix([[1, 0, 0, 5], [0, 1, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]]) {"
          " sphere(r = 1); }",
          5, 6, 9, 1);
    check("multmatrix([[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) {"
          " cube(size = [4, 1, 1]); }",
          -5, 0.5, 0.5, 1);
    check("union() { sphere(r = 1); group(); cube(size = 1, center = true); }", 0, 0, 3, 2);
    check("difference() { cube(size = 4, center = true); sphere(r = 1); }", 0, 0, 0, 1);
    check("intersection() { sphere(r = 1); cube(size = [9, 9, 9]); }", 0, 0, 3, 2);
    check("minkowski() { cube(size = [2, 2, 2]); sphere(r = 0.5); }", 4, 1, 1, 1.5);
    check("linear_extrude(height = 3) { square(size = [1, 1]); }", 0.5, 0.5, 5, 2);
    check("linear_extrude(height = 3, center = true) { circle(r = 1); }", 0, 0, 2, 0.5);
    check("linear_extrude(height = 3) { offset(r = 1) { square(size = [2, 2]); } }", 4, 1, 1, 1);
    check("linear_extrude(height = 3) { polygon(points = [[0, 0], [4, 0], [0, 4]]); }", 4, 4, 1,
          2 * sqrt(2));
    check("rotate_extrude() { multmatrix([[1, 0, 0, 3], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])"
          " { circle(r = 1); } }",
          0, 6, 0, 2);
    check("hull() { sphere(r = 1); multmatrix([[1, 0, 0, 4], [0, 1, 0, 0], [0, 0, 1, 0],"
          " [0, 0, 0, 1]]) { sphere(r = 1); } multmatrix([[1, 0, 0, 0], [0, 1, 0, 4], [0, 0, 1, 0],"
          " [0, 0, 0, 1]]) { sphere(r = 1); } multmatrix([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 1],"
          " [0, 0, 0, 1]]) { sphere(r = 1); } }",
          2, 2, -3, 2);
    check("linear_extrude(height = 1) { hull() { circle(r = 1); } }", 3, 0, 0.5, 2);
    check("hull() { cube(size = 1); multmatrix([[1, 0, 0, 4], [0, 1, 0, 0], [0, 0, 1, 0],"
          " [0, 0, 0, 1]]) { cube(size = 1); } }",
          2.5, 0.5, 2, 1);
    check("polyhedron(points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],"
          " faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]);",
          1, 1, 1, 2 / sqrt(3));
    check("difference() { group(); cube(size = 9); } sphere(r = 1);", 0, 0, 3, 2);
#define AT(x, y, z) \
    "multmatrix([[1, 0, 0, " #x "], [0, 1, 0, " #y "], [0, 0, 1, " #z "], [0, 0, 0, 1]]) "
    /* Columns side by side are round, whatever points OpenSCAD has for them. */
    check("hull() { cylinder(h = 5, r1 = 3, r2 = 3); " AT(
              20, 0, 0) "{ cylinder(h = 5, r1 = 3, r2 = 3); } }",
          10, 5, 2, 2);
    check("hull() { cylinder(h = 5, r1 = 3, r2 = 3); " AT(
              20, 0, 0) "{ cylinder(h = 5, r1 = 3, r2 = 3); } }",
          20 + 4 * sqrt(0.5), 4 * sqrt(0.5), 2, 1);
    check("hull() { cube(size = 2, center = true); " AT(4, 0, 0) "{ sphere(r = 1); } }", 7, 0, 0,
          2);
    check("hull() { sphere(r = 2); " AT(0, 0, 9) "{ sphere(r = 1); } }", 0, 0, 12, 2);
    check("hull() { linear_extrude(height = 2) { circle(r = 1); } " AT(
              5, 0, 0) "{ cylinder(h = 2, r1 = 1, r2 = 1); } }",
          2, 3, 1, 2);
    check("minkowski() { cube(size = [10, 10, 2]); cylinder(h = 1, r1 = 2, r2 = 2); }", 13, 14, 2,
          3);
    check("minkowski() { cube(size = [10, 10, 2]); cylinder(h = 1, r1 = 2, r2 = 2); }", 5, 5, 5, 2);
    check(
        "minkowski() { cylinder(h = 1, r1 = 2, r2 = 2); linear_extrude(height = 3, center = true) {"
        " polygon(points = [[0, 0], [9, 0], [9, 1], [1, 1], [1, 9], [0, 9]]); } }",
        6, 6, 0, 3); /* not filled, as a hull would be */
    check("minkowski() { cube(size = 1); " AT(3, 0, 0) "{ cube(size = 2); } }", 8, 1, 1, 2);
    check("minkowski() { cube(size = 1); cube(size = 2); sphere(r = 1); }", 6, 1, 1, 2);
    check("linear_extrude(height = 2) { offset(delta = 1, chamfer = false) { square(size = [4, 4],"
          " center = true); } }",
          5, 5, 1, sqrt(8));
    check("linear_extrude(height = 2) { offset(delta = -1) { polygon(points = [[0, 0], [8, 0], [8, "
          "3],"
          " [3, 3], [3, 8], [0, 8]]); } }",
          4, 4, 1, 2);
    check("linear_extrude(height = 2) { offset(delta = 1) { circle(r = 2); } }", 5, 0, 1, 2);
    check("intersection() { cube(size = 9); group(); } sphere(r = 1);", 0, 0, 3, 2);
    check("%cube(size = 9); #sphere(r = 1);", 3, 0, 0, 2);
}

/* Turns and twists go the right way round. */
static void turns_have_a_sense(void **state)
{
    const char *sector = "rotate_extrude(angle = 90) { multmatrix([[1, 0, 0, 3], [0, 1, 0, 0],"
                         " [0, 0, 1, 0], [0, 0, 0, 1]]) { circle(r = 1); } }";
    const char *left   = "rotate_extrude(angle = 30) { multmatrix([[1, 0, 0, -3], [0, 1, 0, 0],"
                         " [0, 0, 1, 0], [0, 0, 0, 1]]) { circle(r = 1); } }";
    const char *twist  = "linear_extrude(height = 4, twist = 90) { multmatrix([[1, 0, 0, 3],"
                         " [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { circle(r = 1); } }";
    const char *taper  = "linear_extrude(height = 4, scale = [0.5, 0.5]) {"
                         " square(size = [4, 4], center = true); }";
    (void)state;
    assert_true(distance_at(sector, 2.1, 2.1, 0) < 0);
    assert_true(distance_at(sector, 2.1, -2.1, 0) > 0);
    assert_true(distance_at(sector, -2.1, 2.1, 0) > 0);
    assert_true(distance_at(left, -3, -0.5, 0) < 0);
    assert_true(distance_at(left, -3, 0.5, 0) > 0);
    assert_true(distance_at(twist, 3, 0, 0.05) < 0);
    assert_true(distance_at(twist, 0, -3, 3.95) < 0);
    assert_true(distance_at(twist, 2.1, -2.1, 2) < 0);
    assert_true(distance_at(twist, 2.1, 2.1, 2) > 0);
    assert_true(distance_at(taper, 1.9, 0, 0.05) < 0);
    assert_true(distance_at(taper, 1.1, 0, 3.9) > 0);
    assert_true(distance_at(taper, 0.9, 0, 3.9) < 0);
}

/* ---- random trees ---- */

typedef enum Kind { CUBE, BALL, CONE, PRISM, RING, JOIN, PLACED } Kind;

typedef struct Node {
    Kind   kind;
    int    join; /* of JOIN: union, intersection, difference */
    int    count;
    int    items[3];
    double numbers[3];
    bool   center;
    double inverse[3][3], shift[3];
} Node;

static Node   nodes[MAX_NODES];
static int    node_count;
static char   text[MAX_TEXT];
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
    double a = between(0.3, 1.5), b = between(0.3, 1.5), c = between(0.3, 1.5);
    node->center     = below(2);
    node->numbers[0] = a;
    node->numbers[1] = b;
    node->numbers[2] = c;
    switch (node->kind) {
    case CUBE:
        write_text("cube(size = [%.17g, %.17g, %.17g], center = %s);\n", a, b, c,
                   node->center ? "true" : "false");
        break;
    case BALL: write_text("sphere($fn = 0, $fa = 12, $fs = 2, r = %.17g);\n", a); break;
    case CONE:
        write_text("cylinder($fn = 30, $fa = 12, $fs = 2, h = %.17g, r1 = %.17g, r2 = %.17g, "
                   "center = %s);\n",
                   a, b, c, node->center ? "true" : "false");
        break;
    case PRISM:
        write_text("linear_extrude(height = %.17g, center = %s, convexity = 1) {\n"
                   "polygon(points = [[0, 0], [%.17g, 0], [0, %.17g]], paths = [[0, 1, 2]]);\n}\n",
                   a, node->center ? "true" : "false", b, c);
        break;
    default: /* of a square section between the radii b and b + c */
        write_text("rotate_extrude(convexity = 2, $fn = 50) { multmatrix([[1, 0, 0, %.17g],"
                   "[0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) {"
                   "square(size = [%.17g, %.17g], center = false); } }\n",
                   b, c, a);
    }
}

static void invert(double a[3][3], double inverse[3][3])
{
    double whole = 0;
    for (int i = 0; i < 3; i++)
        whole += a[0][i] *
                 (a[1][(i + 1) % 3] * a[2][(i + 2) % 3] - a[1][(i + 2) % 3] * a[2][(i + 1) % 3]);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            inverse[k][i] = (a[(i + 1) % 3][(k + 1) % 3] * a[(i + 2) % 3][(k + 2) % 3] -
                             a[(i + 1) % 3][(k + 2) % 3] * a[(i + 2) % 3][(k + 1) % 3]) /
                            whole;
}

/* A turn, stretched unless `rigid`, mirrored or sheared now and then. */
static void write_place(Node *node)
{
    double a[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int axis = 0; axis < 3; axis++) {
        double angle = below(2) ? between(-4, 4) : 0, c = cos(angle), s = sin(angle);
        double by = below(3) ? 1 : between(0.5, 1.5) * (below(3) ? 1 : -1);
        int    i = (axis + 1) % 3, k = (axis + 2) % 3;
        for (int column = 0; column < 3; column++) {
            double x = a[i][column], y = a[k][column];
            a[i][column] = (c * x - s * y) * by;
            a[k][column] = s * x + c * y;
        }
    }
    if (below(4) == 0)
        for (int column = 0; column < 3; column++)
            a[0][column] += 0.4 * a[2][column];
    invert(a, node->inverse);
    write_text("multmatrix([");
    for (int i = 0; i < 3; i++) {
        node->shift[i] = below(2) ? between(-1, 1) : 0;
        write_text("[%.17g, %.17g, %.17g, %.17g], ", a[i][0], a[i][1], a[i][2], node->shift[i]);
    }
    write_text("[0, 0, 0, 1]]) {\n");
}

static int write_tree(int depth)
{
    static const char *const joins[] = {"union", "intersection", "difference", "group"};
    int                      index   = node_count++;
    assert_true(index < MAX_NODES);
    Node *node = &nodes[index];
    *node      = (Node){.kind = depth == 0 ? (Kind)below(JOIN) : JOIN + (Kind)below(2)};
    if (node->kind < JOIN) {
        write_primitive(node);
        return index;
    }
    node->join  = below(4);
    node->count = node->kind == PLACED ? 1 : 2 + below(2);
    if (node->kind == PLACED)
        write_place(node);
    else
        write_text("%s() {\n", joins[node->join]);
    for (int i = 0; i < node->count; i++)
        node->items[i] = write_tree(depth - 1);
    write_text("}\n");
    return index;
}

static bool primitive_has(const Node *node, const double q[3])
{
    double a = node->numbers[0], b = node->numbers[1], c = node->numbers[2];
    double round = hypot(q[0], q[1]), z = node->center ? q[2] + a / 2 : q[2];
    switch (node->kind) {
    case CUBE:
        for (int i = 0; i < 3; i++) {
            double from = node->center ? -node->numbers[i] / 2 : 0;
            if (q[i] < from || q[i] > from + node->numbers[i])
                return false;
        }
        return true;
    case BALL: return round * round + q[2] * q[2] < a * a;
    case CONE: return z > 0 && z < a && round < b + (c - b) * z / a;
    case PRISM: return z > 0 && z < a && q[0] > 0 && q[1] > 0 && q[0] / b + q[1] / c < 1;
    default: return q[2] > 0 && q[2] < a && round > b && round < b + c;
    }
}

static bool tree_has(int index, const double q[3])
{
    const Node *node = &nodes[index];
    if (node->kind < JOIN)
        return primitive_has(node, q);
    if (node->kind == PLACED) {
        double local[3];
        for (int i = 0; i < 3; i++) {
            local[i] = 0;
            for (int k = 0; k < 3; k++)
                local[i] += node->inverse[i][k] * (q[k] - node->shift[k]);
        }
        return tree_has(node->items[0], local);
    }
    bool first = tree_has(node->items[0], q), all = first, any = first, others = false;
    for (int i = 1; i < node->count; i++) {
        bool has = tree_has(node->items[i], q);
        all      = all && has;
        any      = any || has;
        others   = others || has;
    }
    return node->join == 1 ? all : node->join == 2 ? first && !others : any;
}

static void random_trees_have_the_points_of_their_predicate(void **state)
{
    int inside = 0;
    (void)state;
    for (int i = 0; i < TREES; i++) {
        double own[POINTS][3], points[POINTS][3], distances[POINTS];
        node_count = 0;
        length     = 0;
        int root   = write_tree(1 + below(3));
        for (int k = 0; k < POINTS; k++) {
            random_vector(&randomness, 2, own[k]);
            upright_point(own[k], points[k]);
        }
        imported_distances("random.csg", text, points, POINTS, distances);
        for (int k = 0; k < POINTS; k++) {
            bool has = tree_has(root, own[k]);
            inside += has;
            if (fabs(distances[k]) > 1e-7 && has != (distances[k] < 0))
                fail_msg("%g %g %g is %s, but distance %g, of\n%s\n%s", own[k][0], own[k][1],
                         own[k][2], has ? "inside" : "outside", distances[k], text,
                         imported("random.csg", text).scene);
        }
    }
    assert_true(inside > TREES * POINTS / 50);
}

/* ---- what is no scene ---- */

static void what_cannot_be_translated_is_said_with_its_line(void **state)
{
    (void)state;
    assert_refused("a.csg", "group() {\n text(text = \"a\", direction = \"rtl\");\n}",
                   "a.csg:2: `text` that runs");
    assert_refused("a.csg", "linear_extrude(height = 4, scale = [0, 0]) {\ncircle(r = 2);\n}",
                   "a.csg:1: `scale` of 0 is not translated");
    assert_refused("a.csg", "cube();\nimport(file = \"a.stl\");",
                   "a.csg:2: `import` is not translated: scenes have no meshes, such as `a.stl`");
    assert_refused("a.csg", "\nsurface(file = \"a.dat\");",
                   "a.csg:2: `surface` is not translated: scenes have no fields");
    assert_refused("a.csg", "linear_extrude() { offset(delta = -2) { square(size = 3); } }",
                   "a.csg:1: `offset` by `delta`");
    assert_refused("a.csg", "\ncubes(size = 1);",
                   "a.csg:2: `cubes` is not translated; is it `cube`");
    assert_refused("a.csg", "cube(size = 1)", "a.csg:1: the file ends where");
    assert_refused("a.csg", "\n\ncube(size = [1, 2]);", "a.csg:3: `size` of `cube` needs 3");
    assert_refused("a.csg", "union() { cube(); square(); }", "a.csg:1: a plane figure stands");
    assert_refused("a.csg", "linear_extrude() { cube(); }",
                   "a.csg:1: `linear_extrude` needs plane");
    assert_refused("a.csg", "hull() { difference() { cube(); sphere(r = 0.2); } }",
                   "a.csg:1: a hull is translated if");
    assert_refused("a.csg", "minkowski() { difference() { cube(); sphere(r = 0.2); } cube(); }",
                   "a.csg:1: `minkowski` is translated for");
    assert_refused("a.csg", "!cube();", "a.csg:1: `!` shows");
    assert_refused("a.csg", "", "a.csg:1: there is nothing");
    assert_refused("a.csg", "rotate_extrude() { square(center = true); }",
                   "a.csg:1: the figure is");
    assert_refused("a.csg",
                   "polyhedron(points = [[0,0,0],[4,0,0],[0,4,0],[0,0,4],[1,1,1]],\n"
                   "faces = [[0,1,2],[0,3,1],[0,2,3],[1,4,2],[1,3,4],[2,4,3]]);",
                   "a.csg:1: a polyhedron that is not convex");
    assert_refused("a.csg", "multmatrix([[0,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) {cube();}",
                   "a.csg:1: its transform flattens");
}

/* Two of three parts are left; the scene and the words about it name the third. */
static void what_is_left_out_is_named(void **state)
{
    static const char parts[] =
        "sphere(r = 1);\nunion() { cube(size = 9);\nimport(file = \"a.stl\"); }\n";
    Imported found = imported_as_far_as_possible("parts.csg", parts);
    (void)state;
    assert_int_equal(found.status, KRS_OK);
    assert_non_null(strstr(found.scene, "sphere(1)"));
    assert_non_null(strstr(found.scene, "box([9, 9, 9])"));
    assert_non_null(strstr(found.scene, "Line 3: a part is left out"));
}

static void damaged_files_do_no_harm(void **state)
{
    const char *whole =
        "group() { difference() { minkowski() { cube(size = [3, 2, 0.4], center = true);\n"
        "sphere($fn = 0, $fa = 12, $fs = 2, r = 0.1); } multmatrix([[1, 0, 0, -1], [0, 1, 0, 0],\n"
        "[0, 0, 1, 0], [0, 0, 0, 1]]) { cylinder($fn = 4, h = 2, r1 = 0.15, r2 = 0.1); } } }\n"
        "color([1, 0, 0, 0.5]) { linear_extrude(height = 2, twist = 30, scale = [0.5, 0.5]) {\n"
        "hull() { circle(r = 1); polygon(points = [[0, 0], [1, 0], [0, 1]], paths = undef); } } }\n"
        "%sphere(r = 1); /* left */ #cube(); // out\n";
    char nested[4000];
    (void)state;
    assert_damage_is_harmless(&randomness, "damaged.csg", whole, 32);
    memset(nested, 0, sizeof nested);
    for (int i = 0; i < 300; i++)
        strcat(nested, "hull(){");
    assert_refused("nested.csg", nested, "nested.csg:1: more than 200 deep");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(distances_are_closed_forms),
        cmocka_unit_test(turns_have_a_sense),
        cmocka_unit_test(random_trees_have_the_points_of_their_predicate),
        cmocka_unit_test(what_cannot_be_translated_is_said_with_its_line),
        cmocka_unit_test(what_is_left_out_is_named),
        cmocka_unit_test(damaged_files_do_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
