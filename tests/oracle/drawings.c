/*
 * drawings.c: shapes of SVG against their definitions, point by point.
 *
 * Each drawing has one shape.  Its contours, resolved, contain a point where the definition of the
 * shape says so.  A shape that is a little larger does not.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/outline/svg.h"
#include "tests/support/bench.h"

enum { POINTS = 2000 };

typedef struct Drawn {
    const char *element; /* in a view of 100 x 100 */
    bool (*contains)(double x, double y, double more);
    int figures;
} Drawn;

static bool in_box(double x, double y, double a, double b) { return fabs(x) <= a && fabs(y) <= b; }

static bool in_ellipse(double x, double y, double a, double b)
{
    return x * x / (a * a) + y * y / (b * b) <= 1;
}

static bool rectangle(double x, double y, double more)
{
    return in_box(x - 40, y - 35, 30 + more, 15 + more);
}

/* Corners of radii 10 and 5. */
static bool round_rectangle(double x, double y, double more)
{
    double u = fmax(fabs(x - 40) - 20, 0), v = fmax(fabs(y - 35) - 10, 0);
    return in_ellipse(u, v, 10 + more, 5 + more);
}

static bool circle(double x, double y, double more)
{
    return in_ellipse(x - 50, y - 40, 30 + more, 30 + more);
}

static bool turned_ellipse(double x, double y, double more)
{
    double c = cos(M_PI / 6), s = sin(M_PI / 6), u = x - 50, v = y - 50;
    return in_ellipse(c * u + s * v, c * v - s * u, 40 + more, 15 + more);
}

/* The greater part of a disc, cut by the line x = 50. */
static bool greater_arc(double x, double y, double more)
{
    return in_ellipse(x - 35, y - 50, 25 + more, 25 + more) && x <= 50 + more;
}

static bool ring(double x, double y, double more)
{
    double r = hypot(x - 50, y - 50);
    return r <= 40 + more && r >= 20 - more;
}

/* Under the curve y = x (1 - x), 0 <= x <= 1, times 80. */
static bool under_parabola(double x, double y, double more)
{
    double t = (x - 10) / 80;
    return y <= 80 + more && y >= 80 - 80 * t * (1 - t) - more && x >= 10 && x <= 90;
}

/* x = t, y = t^3, -1 <= t <= 1, closed by its chord: two lobes. */
static bool beside_cubic(double x, double y, double more)
{
    double t = (x - 50) / 40, u = (y - 50) / 40, low = t * t * t, high = t;
    return fabs(t) <= 1 && u >= fmin(low, high) - more / 40 && u <= fmax(low, high) + more / 40;
}

static bool skewed_square(double x, double y, double more)
{
    return in_box(x - y - 10, y - 30, 10 + more, 10 + more);
}

static bool triangle(double x, double y, double more)
{
    return y <= 70 + more && y >= 10 + 2 * fabs(x - 50) - 2 * more;
}

static const Drawn drawn[] = {
    {"<rect x='10' y='20' width='60' height='30'/>", rectangle, 1},
    {"<rect x='10' y='20' width='60' height='30' rx='10' ry='5'/>", round_rectangle, 1},
    {"<circle cx='50' cy='40' r='30'/>", circle, 1},
    {"<ellipse transform='translate(50,50) rotate(30)' rx='40' ry='15'/>", turned_ellipse, 1},
    {"<ellipse cx='50' cy='50' rx='40' ry='15' transform='rotate(30 50 50)'/>", turned_ellipse, 1},
    {"<path d='M40 80 a40 15 30 1 0 .01 0z' fill='none'/>", NULL, 0},
    {"<path d='M50 30 A 25 25 0 1 0 50 70 z'/>", greater_arc, 1},
    {"<path d='m50 70a25 25 0 110-40z'/>", greater_arc, 1},
    {"<path fill-rule='evenodd' d='M90 50A40 40 0 0 1 10 50A40 40 0 0 1 90 50z"
     "M70 50a20 20 0 0 1-40 0a20 20 0 0 1 40 0'/>",
     ring, 1},
    {"<g style='stroke:none; fill-rule : evenodd'><path d='M90 50A40 40 0 0 1 10 50A40 40 0 0 1 90 "
     "50z"
     "M70 50a20 20 0 0 1-40 0a20 20 0 0 1 40 0'/></g>",
     ring, 1},
    {"<path d='M10,80 Q50,40 90,80'/>", under_parabola, 1},
    {"<path d='M10 80 q20-20 40-20 t40 20'/>", under_parabola, 1},
    {"<path d='M10 10 C36.666666667 90 63.333333333 10 90 90z'/>", beside_cubic, 1},
    {"<g transform='matrix(1 0 0 1 0 20)'><path transform='skewX(45)' d='M20 0h20v20H20z'/></g>",
     NULL, 1},
    {"<path transform='skewX(45)' d='M0 20h20v20H0z'/>", skewed_square, 1},
    {"<polygon points='50,10 80,70 20,70'/>", triangle, 1},
    {"<polyline points='50 10,80 70 20 70'/>", triangle, 1},
    {"<defs><rect width='9' height='9'/></defs><g display='none'><rect width='9' height='9'/></g>",
     NULL, 0},
};
enum { DRAWN = sizeof drawn / sizeof *drawn };

static void read_drawing(const char *element, SvgDrawing *drawing, Arena *arena)
{
    char text[1024];
    snprintf(text, sizeof text, "<svg viewBox='0 0 100 100'>%s</svg>", element);
    *drawing = (SvgDrawing){.arena = arena};
    if (!svg_read(drawing, text, strlen(text)))
        fail_msg("%s: %s", element, drawing->fault);
}

static double distance_to(const Outline *outline, const double p[2])
{
    double nearest = INFINITY;
    for (uint32_t i = 0; i < outline->count; i++) {
        double distance = piece_distance(&outline->pieces[i], p);
        nearest         = fabs(distance) < fabs(nearest) ? distance : nearest;
    }
    return nearest;
}

/* Of points that are not within `more` of the outline, how many are on the wrong side. */
static int count_wrong(const Drawn *of, const SvgFigure *figure, double more, Bench *bench)
{
    Outline outline;
    double  at[2];
    int     wrong = 0;
    assert_int_equal(
        outline_make(&outline, &figure->curves, figure->rule, &bench->arena, &bench->arena, at),
        OUTLINE_GOOD);
    for (int i = 0; i < POINTS; i++) {
        double p[2]     = {random_between(&bench->random, 0, 100),
                           random_between(&bench->random, 0, 100)};
        double distance = distance_to(&outline, p);
        wrong += fabs(distance) > 1e-3 && (distance < 0) != of->contains(p[0], p[1], more);
    }
    return wrong;
}

static void shapes(void **state)
{
    Bench *bench = *state;
    for (int i = 0; i < DRAWN; i++) {
        SvgDrawing drawing;
        read_drawing(drawn[i].element, &drawing, &bench->arena);
        if ((int)drawing.figures.count != drawn[i].figures)
            fail_msg("%s: %zu figures", drawn[i].element, drawing.figures.count);
        if (!drawn[i].contains)
            continue;
        int wrong = count_wrong(&drawn[i], &drawing.figures.items[0], 0, bench);
        if (wrong > 0)
            fail_msg("%s: %d points are on the wrong side", drawn[i].element, wrong);
        assert_true(count_wrong(&drawn[i], &drawing.figures.items[0], 1, bench) > 0);
    }
}

static void colors(void **state)
{
    static const struct {
        const char *fill;
        uint32_t    rgb;
    } filled[] = {
        {"fill='#12aBfe'", 0x12abfe},          {"fill='#fa3'", 0xffaa33},
        {"fill='tomato'", 0xff6347},           {"style=' fill: rgb(1, 2,3) ;x:y'", 0x010203},
        {"fill='rgb(100%,0%,50%)'", 0xff0080}, {"", 0}};
    Bench *bench = *state;
    for (size_t i = 0; i < sizeof filled / sizeof *filled; i++) {
        char       element[128];
        SvgDrawing drawing;
        snprintf(element, sizeof element, "<g %s><rect width='9' height='9'/></g>", filled[i].fill);
        read_drawing(element, &drawing, &bench->arena);
        assert_int_equal(drawing.figures.items[0].rgb, filled[i].rgb);
        assert_int_equal(drawing.notes.count, 0);
    }
}

/* What cannot be read is refused with its line, whatever it is. */
static void broken_files(void **state)
{
    static const struct {
        const char *text;
        unsigned    line;
    } broken[]   = {{"", 1},
                    {"no XML", 1},
                    {"<html/>", 1},
                    {"<svg>\n<g>\n</svg>", 3},
                    {"<svg>\n<path d='M0 0 L 1'/></svg>", 2},
                    {"<svg>\n\n<path d='L 1 1'/></svg>", 3},
                    {"<svg><path d='M0 0 X 1 1'/></svg>", 1},
                    {"<svg><path d='M0 0 L 1e999 1'/></svg>", 1},
                    {"<svg><polygon points='1 2 3'/></svg>", 1},
                    {"<svg><g transform='turn(3)'/></svg>", 1}};
    Bench *bench = *state;
    for (size_t i = 0; i < sizeof broken / sizeof *broken; i++) {
        SvgDrawing drawing = {.arena = &bench->arena};
        if (svg_read(&drawing, broken[i].text, strlen(broken[i].text)))
            fail_msg("%s was read", broken[i].text);
        assert_non_null(drawing.fault);
        assert_int_equal(drawing.fault_line, broken[i].line);
    }
}

/* Random bytes in a drawing: read or refused. */
static void random_files(void **state)
{
    static const char whole[] =
        "<svg viewBox='0 0 9 9'><g fill='red' transform='rotate(3)'>"
        "<path d='M1 2c3-4 5 6 7,8s1 2 3 4a5 6 7 0 1 8 9zq1 2 3 4t5 6v7h8'/>"
        "<polygon points='1,2 3,4 5,6'/></g></svg>";
    Bench *bench = *state;
    for (int i = 0; i < 2000; i++) {
        char text[sizeof whole];
        memcpy(text, whole, sizeof whole);
        for (int k = random_below(&bench->random, 4); k >= 0; k--)
            text[random_below(&bench->random, (int)sizeof whole - 1)] =
                "0.-+eMzAq'<>/ \"f9"[random_below(&bench->random, 17)];
        SvgDrawing drawing = {.arena = &bench->arena};
        assert_true(svg_read(&drawing, text, strlen(text)) || drawing.fault);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(shapes, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(colors, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(broken_files, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(random_files, bench_start, bench_stop),
    };
    return cmocka_run_group_tests_name("drawings", tests, NULL, NULL);
}
