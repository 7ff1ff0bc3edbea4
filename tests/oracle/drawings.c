/*
 * drawings.c: shapes of SVG against their definitions, point by point.
 *
 * Each drawing has one shape.  Its contours, resolved, contain a point where the definition of the
 * shape says so.  A shape that is a little larger does not.
 */
#include <locale.h>
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
    char text[2048];
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

/* Counts the points on the wrong side, of those that are not within `more` of the outline. */
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
        "<style>.a{stroke:red;stroke-dasharray:1 2}#b,g>c{fill:none}</style>"
        "<polygon class='a' id='b' points='1,2 3,4 5,6'/></g><use href='#b' x='1'/></svg>";
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

/* ---- strokes ---- */

enum { STROKES = 60, STROKE_POINTS = 400, MAX_POINTS = 9 };

static double to_segment(const double a[2], const double b[2], const double p[2])
{
    double dx = b[0] - a[0], dy = b[1] - a[1];
    double t = ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / fmax(dx * dx + dy * dy, 1e-300);
    t        = fmin(fmax(t, 0), 1);
    return hypot(p[0] - a[0] - t * dx, p[1] - a[1] - t * dy);
}

/* How far a point is within the rectangle about a segment, lengthened at both ends. */
static double in_bar(const double a[2], const double b[2], double radius, double more,
                     const double p[2])
{
    double length = hypot(b[0] - a[0], b[1] - a[1]);
    double u[2]   = {(b[0] - a[0]) / length, (b[1] - a[1]) / length};
    double x      = (p[0] - a[0]) * u[0] + (p[1] - a[1]) * u[1];
    double y      = (p[0] - a[0]) * u[1] - (p[1] - a[1]) * u[0];
    return fmin(radius - fabs(y), fmin(x + more, length + more - x));
}

/* Returns the same of the corner at b: the half-planes of both outer sides, which `cut` is in front
   of. */
static double in_corner(const double a[2], const double b[2], const double c[2], double radius,
                        bool miter, double limit, const double p[2])
{
    double la = hypot(b[0] - a[0], b[1] - a[1]), lc = hypot(c[0] - b[0], c[1] - b[1]);
    double u[2] = {(b[0] - a[0]) / la, (b[1] - a[1]) / la};
    double v[2] = {(c[0] - b[0]) / lc, (c[1] - b[1]) / lc};
    double side = u[0] * v[1] - u[1] * v[0] > 0 ? -1 : 1;
    double q[2] = {p[0] - b[0], p[1] - b[1]};
    /* Between the two ends of radii, seen from b. */
    double behind_a = q[0] * u[0] + q[1] * u[1], before_c = -(q[0] * v[0] + q[1] * v[1]);
    double out_a     = side * (-q[0] * u[1] + q[1] * u[0]);
    double out_c     = side * (-q[0] * v[1] + q[1] * v[0]);
    double half      = 0.5 * acos(fmin(fmax(-(u[0] * v[0] + u[1] * v[1]), -1), 1));
    double middle[2] = {u[0] - v[0], u[1] - v[1]}, size = hypot(middle[0], middle[1]);
    double wedge = fmin(behind_a, before_c);
    double sharp = fmin(radius - out_a, radius - out_c);
    double bevel = radius * sin(half) - (q[0] * middle[0] + q[1] * middle[1]) / size;
    if (wedge < -1e-9)
        return -HUGE_VAL;
    return miter && 1 / sin(half) <= limit ? sharp : bevel;
}

/* Random open lines with random ends and corners.  `sure` is how far the point is from deciding. */
static bool stroke_contains(double (*points)[2], int count, double radius, int join, int cap,
                            const double p[2], double *sure)
{
    double deepest = -HUGE_VAL;
    *sure          = HUGE_VAL;
    for (int i = 0; i + 1 < count; i++) {
        double bar = in_bar(points[i], points[i + 1], radius, 0, p);
        deepest    = fmax(deepest, bar);
        *sure      = fmin(*sure, fabs(bar));
    }
    for (int i = 0; i < count; i++) {
        bool   end = i == 0 || i + 1 == count;
        double at  = -HUGE_VAL;
        if (end ? cap == 1 : join == 1)
            at = radius - hypot(p[0] - points[i][0], p[1] - points[i][1]);
        else if (!end)
            at = in_corner(points[i - 1], points[i], points[i + 1], radius, join == 0, 4, p);
        else if (cap == 2) {
            const double *next = points[i == 0 ? 1 : i - 1];
            double        ends[2][2];
            double        length = hypot(points[i][0] - next[0], points[i][1] - next[1]);
            for (int k = 0; k < 2; k++) {
                ends[0][k] = points[i][k];
                ends[1][k] = points[i][k] + radius * (points[i][k] - next[k]) / length;
            }
            at = in_bar(ends[0], ends[1], radius, 0, p);
        }
        deepest = fmax(deepest, at);
        *sure   = fmin(*sure, fabs(at));
    }
    return deepest > 0;
}

static void judge_stroke(const SvgDrawing *drawing, const char *element, double (*points)[2],
                         int count, double radius, int join, int cap, Bench *bench)
{
    Outline outline;
    double  at[2];
    int     in = 0;
    assert_int_equal(drawing->figures.count, 1);
    const SvgFigure *figure = &drawing->figures.items[0];
    if (outline_make(&outline, &figure->curves, figure->rule, &bench->arena, &bench->arena, at) !=
        OUTLINE_GOOD)
        fail_msg("%s: no outline", element);
    for (int i = 0; i < STROKE_POINTS; i++) {
        double p[2] = {random_between(&bench->random, 0, 100),
                       random_between(&bench->random, 0, 100)};
        double sure;
        bool   inside = stroke_contains(points, count, radius, join, cap, p, &sure);
        in += inside;
        if (sure > 1e-3 && inside != (distance_to(&outline, p) < 0))
            fail_msg("%s: %g %g is on the wrong side", element, p[0], p[1]);
    }
    assert_true(in > 0);
}

static void strokes_of_lines(void **state)
{
    static const char *const joins[] = {"miter", "round", "bevel"};
    static const char *const caps[]  = {"butt", "round", "square"};
    Bench                   *bench   = *state;
    for (int i = 0; i < STROKES; i++) {
        double     points[MAX_POINTS][2], radius = random_between(&bench->random, 1, 8);
        int        count = 2 + random_below(&bench->random, MAX_POINTS - 1), length = 0;
        int        join = random_below(&bench->random, 3), cap = random_below(&bench->random, 3);
        char       list[512], element[1024];
        SvgDrawing drawing;
        for (int k = 0; k < count; k++) {
            points[k][0] = 1 + random_below(&bench->random, 98);
            points[k][1] = k + 1 + random_below(&bench->random, 90); /* none twice */
            if (k > 0 && points[k][0] == points[k - 1][0])
                points[k][0] += 0.5;
            length += snprintf(list + length, sizeof list - (size_t)length, "%g %g ", points[k][0],
                               points[k][1]);
        }
        snprintf(element, sizeof element,
                 "<style>.%s {stroke-linejoin: %s} path { stroke-linecap: %s; fill: none }</style>"
                 "<g stroke='red' stroke-width='%.17g'><path class='a %s' d='M%s'/></g>",
                 joins[join], joins[join], caps[cap], 2 * radius, joins[join], list);
        read_drawing(element, &drawing, &bench->arena);
        judge_stroke(&drawing, element, points, count, radius, join, cap, bench);
    }
}

/* Round strokes of curves are all that is near to the curve. */
static void strokes_of_curves(void **state)
{
    enum { FINE = 4000 };
    Bench *bench = *state;
    for (int i = 0; i < STROKES / 2; i++) {
        double     c[8], radius = random_between(&bench->random, 0.5, 12);
        char       element[512];
        Outline    outline;
        double     at[2];
        SvgDrawing drawing;
        for (int k = 0; k < 8; k++)
            c[k] = random_between(&bench->random, 10, 90);
        snprintf(element, sizeof element,
                 "<path fill='none' stroke='black' stroke-linecap='round' stroke-linejoin='round' "
                 "stroke-width='%.17g' d='M%.17g %.17g C%.17g %.17g %.17g %.17g %.17g %.17g'/>",
                 2 * radius, c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7]);
        read_drawing(element, &drawing, &bench->arena);
        const SvgFigure *figure = &drawing.figures.items[0];
        if (outline_make(&outline, &figure->curves, figure->rule, &bench->arena, &bench->arena,
                         at) != OUTLINE_GOOD)
            fail_msg("%s: no outline", element);
        for (int n = 0; n < STROKE_POINTS / 4; n++) {
            double p[2]    = {random_between(&bench->random, 0, 100),
                              random_between(&bench->random, 0, 100)};
            double nearest = HUGE_VAL, before[2] = {c[0], c[1]};
            for (int k = 1; k <= FINE; k++) {
                double t = (double)k / FINE, u = 1 - t, q[2];
                for (int m = 0; m < 2; m++)
                    q[m] = u * u * u * c[m] + 3 * u * u * t * c[2 + m] + 3 * u * t * t * c[4 + m] +
                           t * t * t * c[6 + m];
                nearest = fmin(nearest, to_segment(before, q, p));
                memcpy(before, q, sizeof q);
            }
            if (fabs(nearest - radius) > 2e-3 &&
                (nearest < radius) != (distance_to(&outline, p) < 0))
                fail_msg("%s: %g %g is on the wrong side", element, p[0], p[1]);
        }
    }
}

static bool dashes(double x, double y, double more)
{
    return fabs(y - 50) <= 5 + more && x > 10 && x < 90 && fmod(x - 10 + 3, 15) < 10;
}

static bool ring_by_stroke(double x, double y, double more)
{
    double r = hypot(x - 50, y - 50);
    return fabs(r - 30) <= 10 + more;
}

static bool stretched_ring(double x, double y, double more)
{
    double r = hypot((x - 50) / 2, y - 50);
    return fabs(r - 15) <= 5 + more;
}

/* Styles, references and placements of the same shapes. */
static const Drawn styled_shapes[] = {
    {"<style>.a { fill: none; stroke: red }</style><path class='a' d='M1 1L9 1L9 9'/>", NULL, 1},
    {"<style>/* .b {} */ #x, .c .d { fill: none }</style><rect id='x' width='9' height='9'/>"
     "<g class='b c'><rect class='d' width='9' height='9'/></g>",
     NULL, 0},
    {"<style>g > rect { fill: none }</style><g><a><rect x='10' y='20' width='60' height='30'/></a>"
     "</g><g><rect width='9' height='9'/></g>",
     rectangle, 1},
    {"<style>.x g > a g rect { fill: none }</style><g><g><a class='x'><g><rect x='10' y='20' "
     "width='60' height='30'/></g></a></g></g><a class='x'><g><a><a><g><rect width='9' "
     "height='9'/></g></a></a></g></a>",
     rectangle, 1},
    {"<style>rect { fill: none } .k { fill: red } #i { fill: none !important }</style>"
     "<rect class='k' x='10' y='20' width='60' height='30'/><rect id='i' style='fill:red' "
     "width='9' "
     "height='9'/>",
     rectangle, 1},
    {"<use href='#r' x='10'/><defs><rect id='r' y='20' width='60' height='30'/></defs>", rectangle,
     1},
    {"<symbol id='s' viewBox='0 0 6 3'><rect width='6' height='3'/></symbol>"
     "<use xlink:href='#s' x='10' y='20' width='60' height='30' xmlns:xlink='x'/>",
     rectangle, 1},
    {"<use href='#u'/><use id='u' href='#u'/>", NULL, 0},
    {"<circle cx='50' cy='50' r='30' fill='none' stroke='red' stroke-width='20'/>", ring_by_stroke,
     1},
    {"<g transform='translate(50 50) scale(2 1)'><circle r='15' fill='none' stroke='red' "
     "stroke-width='10'/></g>",
     stretched_ring, 1},
    {"<line x1='10' y1='50' x2='90' y2='50' stroke='red' stroke-width='10' stroke-dasharray='10 5' "
     "stroke-dashoffset='3'/>",
     dashes, 1},
    {"<circle cx='50' cy='40' r='30' stroke='none' visibility='hidden'/>"
     "<circle cx='50' cy='40' r='30' stroke='red' stroke-width='0'/>",
     circle, 1},
    {"<path d='M50 40h0' stroke-linecap='round' stroke='red' stroke-width='60'/>", circle, 1},
};

static void styles_and_references(void **state)
{
    Bench *bench = *state;
    for (size_t i = 0; i < sizeof styled_shapes / sizeof *styled_shapes; i++) {
        SvgDrawing drawing;
        read_drawing(styled_shapes[i].element, &drawing, &bench->arena);
        if ((int)drawing.figures.count != styled_shapes[i].figures)
            fail_msg("%s: %zu figures", styled_shapes[i].element, drawing.figures.count);
        if (styled_shapes[i].contains &&
            count_wrong(&styled_shapes[i], &drawing.figures.items[0], 0, bench) > 0)
            fail_msg("%s: points are on the wrong side", styled_shapes[i].element);
    }
}

/* A selector with many parts on elements within elements: a search for each part from each element on
   would not end. */
static void selectors_end_on_nested_elements(void **state)
{
    enum { GROUPS = 60, PARTS = 20 };
    Bench     *bench = *state;
    SvgDrawing drawing;
    Text       text = {.arena = &bench->arena};
    text_add(&text, "<style>.missing ");
    for (int i = 0; i < PARTS; i++)
        text_add(&text, "g ");
    text_add(&text, "rect { fill: none }</style>");
    for (int i = 0; i < GROUPS; i++)
        text_add(&text, "<g>");
    text_add(&text, "<rect width='9' height='9'/>");
    for (int i = 0; i < GROUPS; i++)
        text_add(&text, "</g>");
    read_drawing(text.bytes, &drawing, &bench->arena);
    assert_int_equal(drawing.figures.count, 1);
}

/* A program that the library is part of may have set a locale with decimal commas. */
static void numbers_do_not_depend_on_the_locale(void **state)
{
    static const char *const locales[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE", "C"};
    for (size_t i = 0; !setlocale(LC_NUMERIC, locales[i]); i++)
        ;
    static const Drawn forms = {"<rect x='.1e2' y='+20.0' width='600e-1' height='30.'/>", rectangle,
                                1};
    Bench             *bench = *state;
    SvgDrawing         drawing;
    read_drawing(forms.element, &drawing, &bench->arena);
    assert_int_equal(drawing.figures.count, 1);
    assert_int_equal(count_wrong(&forms, &drawing.figures.items[0], 0, bench), 0);
    setlocale(LC_NUMERIC, "C");
}

static void gradients_have_their_mean(void **state)
{
    static const struct {
        const char *stops;
        uint32_t    rgb;
    } rows[] = {
        {"<stop stop-color='#ff0000'/><stop offset='1' stop-color='#0000ff'/>", 0x800080},
        {"<stop offset='50%' style='stop-color:#000000'/><stop offset='50%' stop-color='white'/>",
         0x808080},
        {"<stop offset='.2' stop-color='#000000'/><stop offset='.6' stop-color='#640000'/>",
         0x3c0000}, /* 0.4 * 50 + 0.4 * 100 */
        {"<stop stop-color='#00ff00' stop-opacity='0'/><stop offset='1' stop-color='#ff0000'/>",
         0xff0000},
    };
    Bench *bench = *state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char       element[512];
        SvgDrawing drawing;
        snprintf(element, sizeof element,
                 "<linearGradient id='a'>%s</linearGradient><radialGradient id='b' href='#a'/>"
                 "<rect width='9' height='9' fill='url(#b)'/>",
                 rows[i].stops);
        read_drawing(element, &drawing, &bench->arena);
        assert_int_equal(drawing.figures.items[0].rgb, rows[i].rgb);
        assert_int_equal(drawing.notes.count, 1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(shapes, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(colors, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(strokes_of_lines, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(strokes_of_curves, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(styles_and_references, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(selectors_end_on_nested_elements, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(numbers_do_not_depend_on_the_locale, bench_start,
                                        bench_stop),
        cmocka_unit_test_setup_teardown(gradients_have_their_mean, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(broken_files, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(random_files, bench_start, bench_stop),
    };
    return cmocka_run_group_tests_name("drawings", tests, NULL, NULL);
}
