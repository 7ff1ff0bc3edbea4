/*
 * imports_csg_sizes.c: OpenSCAD's `resize` and `projection` of random parts against the supports and
 * the insides of what they are made of.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "tests/oracle/imported.h"

enum { TREES = 16, POINTS = 300, MAX_PIECES = 3, PIECE_TEXT = 2048 };

static Random randomness = {2021};

static double between(double low, double high) { return random_between(&randomness, low, high); }
static int    below(int count) { return random_below(&randomness, count); }

/* A box, a ball, a round column or a cone: turned about x, then moved. */
typedef struct Piece {
    enum { BOX, BALL, COLUMN, CONE, PIECES } kind;
    double half[3]; /* of a ball and a column the first is the radius; a cone ends at half of it */
    double angle, shift[3];
} Piece;

static size_t write_piece(char *to, size_t room, const Piece *piece)
{
    double c = cos(piece->angle), s = sin(piece->angle);
    size_t at = (size_t)snprintf(to, room,
                                 "multmatrix([[1, 0, 0, %.17g], [0, %.17g, %.17g, %.17g],"
                                 " [0, %.17g, %.17g, %.17g], [0, 0, 0, 1]]) { ",
                                 piece->shift[0], c, -s, piece->shift[1], s, c, piece->shift[2]);
    if (piece->kind == BOX)
        at += (size_t)snprintf(to + at, room - at,
                               "cube(size = [%.17g, %.17g, %.17g], center = true); }\n",
                               2 * piece->half[0], 2 * piece->half[1], 2 * piece->half[2]);
    else if (piece->kind == BALL)
        at += (size_t)snprintf(to + at, room - at, "sphere(r = %.17g); }\n", piece->half[0]);
    else
        at += (size_t)snprintf(
            to + at, room - at,
            "cylinder($fn = 99, h = %.17g, r1 = %.17g, r2 = %.17g, center = true); }\n",
            2 * piece->half[2], piece->half[0],
            piece->kind == CONE ? piece->half[0] / 2 : piece->half[0]);
    return at;
}

static bool piece_has(const Piece *piece, const double p[3])
{
    double c = cos(piece->angle), s = sin(piece->angle), q[3], radius = piece->half[0];
    for (int i = 0; i < 3; i++)
        q[i] = p[i] - piece->shift[i];
    double y = c * q[1] + s * q[2], z = -s * q[1] + c * q[2];
    if (piece->kind == BOX)
        return fabs(q[0]) < radius && fabs(y) < piece->half[1] && fabs(z) < piece->half[2];
    if (piece->kind == BALL)
        return q[0] * q[0] + y * y + z * z < radius * radius;
    if (piece->kind == CONE)
        radius *= 1 - 0.25 * (z / piece->half[2] + 1);
    return hypot(q[0], y) < radius && fabs(z) < piece->half[2];
}

static Piece random_piece(int kinds, bool turned)
{
    Piece piece = {.kind = below(kinds), .angle = turned ? between(-3, 3) : 0};
    for (int i = 0; i < 3; i++) {
        piece.half[i]  = between(0.5, 2);
        piece.shift[i] = between(-2, 2);
    }
    return piece;
}

/* Returns the farthest point of a piece in a direction, by its definition: that of a box is a
   corner, that of a disc where the direction meets its edge. */
static double support(const Piece *piece, const double direction[3])
{
    double c = cos(piece->angle), s = sin(piece->angle), at = 0, most = -INFINITY;
    double d[3] = {direction[0], c * direction[1] + s * direction[2],
                   -s * direction[1] + c * direction[2]};
    for (int i = 0; i < 3; i++)
        at += direction[i] * piece->shift[i];
    if (piece->kind == BOX)
        return at + piece->half[0] * fabs(d[0]) + piece->half[1] * fabs(d[1]) +
               piece->half[2] * fabs(d[2]);
    if (piece->kind == BALL)
        return at + piece->half[0];
    for (int end = -1; end <= 1; end += 2) {
        double radius = piece->half[0] * (piece->kind == CONE && end > 0 ? 0.5 : 1);
        most          = fmax(most, end * piece->half[2] * d[2] + radius * hypot(d[0], d[1]));
    }
    return at + most;
}

/* Whether a scene has the points that it should have; `own` in OpenSCAD's space. */
static void check_points(const char *text, double (*own)[3], const bool *has)
{
    static double points[POINTS][3], distances[POINTS];
    for (int k = 0; k < POINTS; k++)
        upright_point(own[k], points[k]);
    imported_distances("sizes.csg", text, points, POINTS, distances);
    for (int k = 0; k < POINTS; k++)
        if (fabs(distances[k]) > 1e-6 && has[k] != (distances[k] < 0))
            fail_msg("%g %g %g is %s, but distance %g, of\n%s\n%s", own[k][0], own[k][1], own[k][2],
                     has[k] ? "inside" : "outside", distances[k], text,
                     imported("sizes.csg", text).scene);
}

static void check_distance(const char *text, double x, double y, double z, double expected)
{
    double point[1][3], found;
    upright_point((double[]){x, y, z}, point[0]);
    imported_distances("sizes.csg", text, point, 1, &found);
    if (!(fabs(found - expected) < 1e-6))
        fail_msg("%s\nat %g %g %g: %.9g, not %.9g", text, x, y, z, found, expected);
}

static void resized_parts_have_their_size(void **state)
{
    static double own[POINTS][3];
    static bool   has[POINTS];
    int           inside = 0;
    (void)state;
    for (int trial = 0; trial < TREES; trial++) {
        char   text[PIECE_TEXT];
        Piece  pieces[MAX_PIECES];
        int    count = 1 + below(MAX_PIECES), longest = 0;
        double size[3], factors[3], low[3], high[3];
        bool   follows[3];
        size_t at;
        for (int i = 0; i < 3; i++) {
            size[i]    = below(3) == 0 ? 0 : between(1, 9);
            follows[i] = below(2) == 0;
            longest    = size[i] > size[longest] ? i : longest;
        }
        at = (size_t)snprintf(text, sizeof text,
                              "resize(newsize = [%.17g, %.17g, %.17g], auto = [%d, %d, %d]) {\n"
                              "union() {",
                              size[0], size[1], size[2], follows[0], follows[1], follows[2]);
        for (int i = 0; i < count; i++) {
            pieces[i] = random_piece(PIECES, true);
            at += write_piece(text + at, sizeof text - at, &pieces[i]);
        }
        snprintf(text + at, sizeof text - at, "} }");
        for (int i = 0; i < 3; i++) {
            low[i]  = INFINITY;
            high[i] = -INFINITY;
            for (int k = 0; k < count; k++) {
                double up[3] = {i == 0, i == 1, i == 2}, down[3] = {-up[0], -up[1], -up[2]};
                high[i] = fmax(high[i], support(&pieces[k], up));
                low[i]  = fmin(low[i], -support(&pieces[k], down));
            }
        }
        for (int i = 0; i < 3; i++)
            factors[i] = size[i] > 0 ? size[i] / (high[i] - low[i]) : 1;
        for (int i = 0; i < 3; i++)
            if (follows[i] && !(size[i] > 0))
                factors[i] = factors[longest];
        for (int k = 0; k < POINTS; k++) {
            double q[3];
            has[k] = false;
            for (int i = 0; i < 3; i++) {
                q[i]      = between(low[i] - 0.5, high[i] + 0.5);
                own[k][i] = q[i] * factors[i];
            }
            for (int i = 0; i < count; i++)
                has[k] = has[k] || piece_has(&pieces[i], q);
            inside += has[k];
        }
        check_points(text, own, has);
    }
    assert_true(inside > TREES * POINTS / 50);
    check_distance("resize(newsize = [10, 0, 0], auto = [1, 1, 1]) { difference() {"
                   " cube(size = [5, 4, 3]); cylinder(h = 9, r1 = 1, r2 = 1, center = true); } }",
                   10.5, 4, 3, 0.5);
    assert_refused("a.csg",
                   "\nresize(newsize = [1, 2, 3]) { intersection() { cube(); sphere(r = 1); } }",
                   "a.csg:2: `resize` of a part whose exact size");
    assert_refused(
        "a.csg", "resize(newsize = [1, 2, 3]) { difference() { sphere(r = 2); cube(size = 9); } }",
        "a.csg:1: `resize` of a part whose exact size");
}

/* Sections at z = 0 of unions and differences; shadows of unions, of which a line up meets something. */
static void figures_of_solids_are_their_sections_and_shadows(void **state)
{
    static double own[POINTS][3];
    static bool   has[POINTS];
    int           inside = 0;
    (void)state;
    for (int trial = 0; trial < 2 * TREES; trial++) {
        char   text[PIECE_TEXT];
        Piece  pieces[MAX_PIECES];
        bool   cut = trial % 2 == 0, cuts = cut && below(2) == 0;
        int    count = 1 + below(MAX_PIECES);
        size_t at    = (size_t)snprintf(text, sizeof text,
                                        "linear_extrude(height = 2, center = true) {\n"
                                           "projection(cut = %s) { %s() { ",
                                     cut ? "true" : "false", cuts ? "difference" : "union");
        for (int i = 0; i < count; i++) {
            pieces[i]          = random_piece(COLUMN + 1, false);
            pieces[i].angle    = pieces[i].kind == COLUMN ? 0 : between(-3, 3);
            pieces[i].shift[2] = between(-0.4, 0.4); /* all are cut */
            at += write_piece(text + at, sizeof text - at, &pieces[i]);
        }
        snprintf(text + at, sizeof text - at, "} } }");
        for (int k = 0; k < POINTS; k++) {
            bool first = false, others = false;
            random_vector(&randomness, 4, own[k]);
            own[k][2] = between(-0.9, 0.9);
            for (int i = 0; i < count; i++) {
                bool met = false;
                for (int step = cut ? 200 : 0; step <= (cut ? 200 : 400) && !met; step++) {
                    double p[3] = {own[k][0], own[k][1], (step - 200) * 0.02};
                    met         = piece_has(&pieces[i], p);
                }
                first  = i == 0 ? met : first;
                others = i > 0 ? others || met : others;
            }
            has[k] = cuts ? first && !others : first || others;
            inside += has[k];
        }
        check_points(text, own, has);
    }
    assert_true(inside > TREES * POINTS / 50);
    assert_refused("a.csg",
                   "linear_extrude() { projection() {\ndifference() { cube(); sphere(r = 1); } } }",
                   "a.csg:2: `projection` shows balls, upright");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(resized_parts_have_their_size),
        cmocka_unit_test(figures_of_solids_are_their_sections_and_shadows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
