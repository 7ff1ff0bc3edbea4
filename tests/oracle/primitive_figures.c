/*
 * primitive_figures.c: definitions of the plane figures of the library, made solid: the last
 * argument is the height or the offset.
 */
#include "tests/oracle/primitives.h"

static const double PI = 3.14159265358979323846;

static bool in_extrusion(const void *user, Vec p)
{
    const Solid *s = user;
    return fabs(p.z) <= s->a[ARGUMENTS - 1] / 2 && figure_contains(&s->figure, p.x, p.y);
}

static void extrusion_surface(const Solid *s, Cloud *cloud, double step)
{
    extrusion_cloud(&s->figure, s->a[ARGUMENTS - 1], cloud, step);
}

static bool in_revolution(const void *user, Vec p)
{
    const Solid *s = user;
    return figure_contains(&s->figure, hypot(p.x, p.z) - s->a[ARGUMENTS - 1], p.y);
}

static void revolution_surface(const Solid *s, Cloud *cloud, double step)
{
    revolution_cloud(&s->figure, s->a[ARGUMENTS - 1], cloud, step);
}

static void make_stroke(Solid *s, Curve curve, double radius)
{
    s->figure.stroke = (Sweep){
        .curves = {curve}, .curve_count = 1, .radius = radius, .radius_end = radius};
}

static Vec argument_corner(const Solid *s, int at) { return vec(s->a[at], s->a[at + 1], 0); }

static void make_circle(Solid *s)
{
    make_stroke(s, curve_segment(vec(0, 0, 0), vec(0, 0, 0)), s->a[0]);
}

static void make_segment(Solid *s)
{
    make_stroke(s, curve_segment(argument_corner(s, 0), argument_corner(s, 2)), s->a[4] / 2);
}

/* Radius, angle, width; the middle up. */
static void make_arc(Solid *s)
{
    double radius = s->a[0], x = radius * sin(s->a[1] / 2), y = radius * cos(s->a[1] / 2);
    make_stroke(s, curve_arc(vec(-x, y, 0), vec(0, radius, 0), vec(x, y, 0)), s->a[2] / 2);
}

static void make_bezier(Solid *s)
{
    make_stroke(s,
                curve_bezier(argument_corner(s, 0), argument_corner(s, 2), argument_corner(s, 4)),
                s->a[6] / 2);
}

static void make_rectangle(Solid *s)
{
    double x = s->a[0] / 2, y = s->a[1] / 2;
    figure_add(&s->figure, -x, -y);
    figure_add(&s->figure, x, -y);
    figure_add(&s->figure, x, y);
    figure_add(&s->figure, -x, y);
}

static void make_polygon(Solid *s)
{
    for (int i = 0; i < 5; i++)
        figure_add(&s->figure, s->a[2 * i], s->a[2 * i + 1]);
}

/* The first corner, or tip, up. */
static void make_regular(Solid *s)
{
    int sides = (int)floor(s->a[0]);
    for (int i = 0; i < sides; i++)
        figure_add(&s->figure, s->a[1] * sin(2 * PI * i / sides),
                   s->a[1] * cos(2 * PI * i / sides));
}

static void make_star(Solid *s)
{
    int tips = (int)floor(s->a[0]);
    for (int i = 0; i < 2 * tips; i++) {
        double radius = s->a[i % 2 ? 2 : 1];
        figure_add(&s->figure, radius * sin(PI * i / tips), radius * cos(PI * i / tips));
    }
}

/* ---- the table ---- */

#define EXTRUDED in_extrusion, extrusion_surface
#define TURNED   in_revolution, revolution_surface
#define LAST     [ARGUMENTS - 1]

const Primitive figure_primitives[FIGURES] = {
    {"circle, extruded",
     "circle($a).extrude($l)",
     make_circle,
     EXTRUDED,
     true,
     {SIZE, LAST = SIZE}},
    {"circle, revolved",
     "circle($a).revolve($l)",
     make_circle,
     TURNED,
     true,
     {{0.1, 0.4}, LAST = {0.5, 1}}},
    {"rectangle, extruded",
     "rectangle([$a, $b]).extrude($l)",
     make_rectangle,
     EXTRUDED,
     true,
     {SIZE, SIZE, LAST = SIZE}},
    {"rectangle, revolved",
     "rectangle([$a, $b]).revolve($l)",
     make_rectangle,
     TURNED,
     true,
     {{0.2, 0.8}, SIZE, LAST = {0.5, 1}}},
    {"concave polygon",
     "polygon([[$a, $b], [$c, $d], [$e, $f], [$g, $h], [$i, $j]]).extrude($l)",
     make_polygon,
     EXTRUDED,
     true,
     {{-0.9, -0.7},
      {-0.9, -0.7},
      {0.7, 0.9},
      {-0.9, -0.7},
      {-0.1, 0.1},
      {-0.2, 0.1},
      {0.7, 0.9},
      {0.7, 0.9},
      {-0.9, -0.7},
      {0.7, 0.9},
      LAST = SIZE}},
    {"clockwise polygon",
     "polygon([[$a, $b], [$c, $d], [$e, $f], [$g, $h], [$i, $j]]).extrude($l)",
     make_polygon,
     EXTRUDED,
     true,
     {{-0.9, -0.7},
      {0.7, 0.9},
      {0.7, 0.9},
      {0.7, 0.9},
      {-0.1, 0.1},
      {-0.2, 0.1},
      {0.7, 0.9},
      {-0.9, -0.7},
      {-0.9, -0.7},
      {-0.9, -0.7},
      LAST = SIZE}},
    {"regular pentagon",
     "regular(5, $b).extrude($l)",
     make_regular,
     EXTRUDED,
     true,
     {{5, 5}, SIZE, LAST = SIZE}},
    {"regular octagon",
     "regular(8, $b).revolve($l)",
     make_regular,
     TURNED,
     true,
     {{8, 8}, {0.2, 0.4}, LAST = {0.6, 1}}},
    {"star",
     "star(5, $b, $c).extrude($l)",
     make_star,
     EXTRUDED,
     true,
     {{5, 5}, {0.7, 1.2}, {0.2, 0.5}, LAST = SIZE}},
    {"blunt star",
     "star(4, $b, $c).revolve($l)",
     make_star,
     TURNED,
     true,
     {{4, 4}, {0.2, 0.3}, {0.3, 0.4}, LAST = {0.6, 1}}},
    {"segment",
     "segment([$a, $b], [$c, $d], $e).extrude($l)",
     make_segment,
     EXTRUDED,
     true,
     {PLACE, PLACE, PLACE, PLACE, {0.1, 0.6}, LAST = SIZE}},
    {"arc",
     "arc($a, $b, $c).extrude($l)",
     make_arc,
     EXTRUDED,
     true,
     {SIZE, {0.5, 5}, {0.05, 0.3}, LAST = SIZE}},
    {"arc, revolved",
     "arc($a, $b, $c).revolve($l)",
     make_arc,
     TURNED,
     true,
     {{0.2, 0.4}, {0.5, 5}, {0.05, 0.3}, LAST = {0.7, 1}}},
    {"bezier",
     "bezier([$a, $b], [$c, $d], [$e, $f], $g).extrude($l)",
     make_bezier,
     EXTRUDED,
     true,
     {PLACE, {-0.9, -0.5}, PLACE, {-0.2, 0.2}, PLACE, {0.5, 0.9}, {0.1, 0.4}, LAST = SIZE}},
    {"straight bezier",
     "bezier([$a, $b], [0, 0], [0.5, 0.5], $g).extrude($l)",
     make_bezier,
     EXTRUDED,
     true,
     {{-0.5, -0.5}, {-0.5, -0.5}, {0, 0}, {0, 0}, {0.5, 0.5}, {0.5, 0.5}, {0.1, 0.4}, LAST = SIZE}},
};
