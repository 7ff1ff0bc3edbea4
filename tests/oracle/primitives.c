/*
 * Every primitive of the library against its definition: points of its surface, and what is
 * inside.  The size of its distance is never above the distance to the nearest point of the
 * surface, and for those that are exact not below it either, outside.
 */
#include "tests/oracle/judge.h"
#include "tests/oracle/product.h"
#include "tests/oracle/solids.h"

#include <stdio.h>

static const double PI = 3.14159265358979323846;

enum { ARGUMENTS = 12, SETS = 3, POINTS = 700 };

/* A primitive with its arguments chosen, and whatever defines it. */
typedef struct Solid {
    double a[ARGUMENTS];
    Hull   hull;
    Sweep  sweep;
    Figure figure;
} Solid;

/* One row per primitive: `text` has $a..$l for the arguments, which are drawn from the ranges. */
typedef struct Primitive {
    const char *name, *text;
    void (*make)(Solid *solid);
    Inside *inside;
    void (*surface)(const Solid *solid, Cloud *cloud, double step);
    bool   exact;
    double range[ARGUMENTS][2];
} Primitive;

static Vec argument_vec(const Solid *s, int at)
{
    return vec(s->a[at], s->a[at + 1], s->a[at + 2]);
}

static void make_nothing(Solid *s) { (void)s; }

/* ---- round ones ---- */

static bool in_sphere(const void *user, Vec p)
{
    const Solid *s = user;
    return vec_length(p) <= s->a[0];
}
static void sphere_surface(const Solid *s, Cloud *cloud, double step)
{
    ellipsoid_cloud(cloud, vec(s->a[0], s->a[0], s->a[0]), step);
}

static bool in_ellipsoid(const void *user, Vec p)
{
    const Solid *s = user;
    return vec_length(vec(p.x / s->a[0], p.y / s->a[1], p.z / s->a[2])) <= 1;
}
static void ellipsoid_surface(const Solid *s, Cloud *cloud, double step)
{
    ellipsoid_cloud(cloud, argument_vec(s, 0), step);
}

/* Within `minor` of some point of the circle: the nearest one has the same direction. */
static bool in_torus(const void *user, Vec p)
{
    const Solid *s   = user;
    double       out = hypot(p.x, p.z);
    Vec on_circle    = out > 0 ? vec_scale(s->a[0] / out, vec(p.x, 0, p.z)) : vec(s->a[0], 0, 0);
    return vec_distance(p, on_circle) <= s->a[1];
}
static void torus_surface(const Solid *s, Cloud *cloud, double step)
{
    torus_cloud(cloud, s->a[0], s->a[1], step);
}

/* Radius at the bottom, radius at the top, height. */
static bool in_cone(const double a[3], Vec p)
{
    double up = p.y / a[2] + 0.5;
    return up >= 0 && up <= 1 && hypot(p.x, p.z) <= (1 - up) * a[0] + up * a[1];
}
static void cone_surface(const double a[3], Cloud *cloud, double step)
{
    frustum_cloud(cloud, 0, -a[2] / 2, a[0], -a[2] / 2, step);
    frustum_cloud(cloud, a[0], -a[2] / 2, a[1], a[2] / 2, step);
    frustum_cloud(cloud, a[1], a[2] / 2, 0, a[2] / 2, step);
}

static bool in_cylinder(const void *user, Vec p)
{
    const Solid *s = user;
    return in_cone((double[]){s->a[0], s->a[0], s->a[1]}, p);
}
static void cylinder_surface(const Solid *s, Cloud *cloud, double step)
{
    cone_surface((double[]){s->a[0], s->a[0], s->a[1]}, cloud, step);
}
static bool in_pointed_cone(const void *user, Vec p)
{
    const Solid *s = user;
    return in_cone((double[]){s->a[0], 0, s->a[1]}, p);
}
static void pointed_cone_surface(const Solid *s, Cloud *cloud, double step)
{
    cone_surface((double[]){s->a[0], 0, s->a[1]}, cloud, step);
}
static bool in_capped_cone(const void *user, Vec p)
{
    const Solid *s = user;
    return in_cone(s->a, p);
}
static void capped_cone_surface(const Solid *s, Cloud *cloud, double step)
{
    cone_surface(s->a, cloud, step);
}

/* ---- swept by balls ---- */

static bool in_sweep(const void *user, Vec p)
{
    const Solid *s = user;
    return sweep_depth(&s->sweep, p) <= 0;
}
static void sweep_surface(const Solid *s, Cloud *cloud, double step)
{
    sweep_cloud(&s->sweep, cloud, 1.5 * step);
}
static void make_sweep(Solid *s, Curve curve, double radius, double radius_end)
{
    s->sweep = (Sweep){
        .curves = {curve}, .curve_count = 1, .radius = radius, .radius_end = radius_end};
}
static void make_capsule(Solid *s)
{
    make_sweep(s, curve_segment(argument_vec(s, 0), argument_vec(s, 3)), s->a[6], s->a[6]);
}
static void make_round_cone(Solid *s)
{
    make_sweep(s, curve_segment(argument_vec(s, 0), argument_vec(s, 3)), s->a[6], s->a[7]);
}
static void make_arc_capsule(Solid *s)
{
    make_sweep(s, curve_arc(argument_vec(s, 0), argument_vec(s, 3), argument_vec(s, 6)), s->a[9],
               s->a[9]);
}
/* Both sides of a chain link are upright, its plane is that of x and y. */
static void make_link(Solid *s)
{
    double half = s->a[0] / 2, major = s->a[1];
    Vec    right = vec(major, half, 0), left = vec(-major, half, 0);
    Vec    low_right = vec(major, -half, 0), low_left = vec(-major, -half, 0);
    s->sweep           = (Sweep){.curve_count = 4, .radius = s->a[2], .radius_end = s->a[2]};
    s->sweep.curves[0] = curve_segment(low_right, right);
    s->sweep.curves[1] = curve_arc(right, vec(0, half + major, 0), left);
    s->sweep.curves[2] = curve_segment(left, low_left);
    s->sweep.curves[3] = curve_arc(low_left, vec(0, -half - major, 0), low_right);
}

/* ---- with flat faces ---- */

static bool in_hull(const void *user, Vec p)
{
    const Solid *s = user;
    return hull_contains(&s->hull, p);
}
static void hull_surface(const Solid *s, Cloud *cloud, double step)
{
    hull_cloud(&s->hull, cloud, step);
}
static void make_box(Solid *s)
{
    for (int i = 0; i < 8; i++)
        hull_add(&s->hull, (i & 1 ? 0.5 : -0.5) * s->a[0], (i & 2 ? 0.5 : -0.5) * s->a[1],
                 (i & 4 ? 0.5 : -0.5) * s->a[2]);
    hull_close(&s->hull);
}
static void make_octahedron(Solid *s)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        hull_add(&s->hull, sign * s->a[0], 0, 0);
        hull_add(&s->hull, 0, sign * s->a[0], 0);
        hull_add(&s->hull, 0, 0, sign * s->a[0]);
    }
    hull_close(&s->hull);
}
/* One corner up, another towards z. */
static void make_tetrahedron(Solid *s)
{
    double r = s->a[0];
    hull_add(&s->hull, 0, r, 0);
    for (int i = 0; i < 3; i++)
        hull_add(&s->hull, r * sqrt(8) / 3 * sin(2 * PI * i / 3), -r / 3,
                 r * sqrt(8) / 3 * cos(2 * PI * i / 3));
    hull_close(&s->hull);
}
/* (0, a, b) with all signs, and what comes of it by turning x to y to z. */
static void add_cyclic(Hull *hull, double a, double b)
{
    for (int i = 0; i < 4; i++) {
        double u = i & 1 ? a : -a, v = i & 2 ? b : -b;
        hull_add(hull, 0, u, v);
        hull_add(hull, u, v, 0);
        hull_add(hull, v, 0, u);
    }
}
static void make_icosahedron(Solid *s)
{
    double golden = (1 + sqrt(5)) / 2, unit = s->a[0] / hypot(1, golden);
    add_cyclic(&s->hull, unit, unit * golden);
    hull_close(&s->hull);
}
/* With an edge up, along z. */
static void make_dodecahedron(Solid *s)
{
    double golden = (1 + sqrt(5)) / 2, unit = s->a[0] / sqrt(3);
    add_cyclic(&s->hull, unit * golden, unit / golden);
    for (int i = 0; i < 8; i++)
        hull_add(&s->hull, i & 1 ? unit : -unit, i & 2 ? unit : -unit, i & 4 ? unit : -unit);
    hull_close(&s->hull);
}
/* The first corner towards z. */
static void make_prism(Solid *s)
{
    int sides = (int)floor(s->a[0]);
    for (int i = 0; i < sides; i++) {
        double x = s->a[1] * sin(2 * PI * i / sides), z = s->a[1] * cos(2 * PI * i / sides);
        hull_add(&s->hull, x, -s->a[2] / 2, z);
        hull_add(&s->hull, x, s->a[2] / 2, z);
    }
    hull_close(&s->hull);
}
static void make_pyramid(Solid *s)
{
    double half = s->a[0] / 2;
    for (int i = 0; i < 4; i++)
        hull_add(&s->hull, i & 1 ? half : -half, -s->a[1] / 2, i & 2 ? half : -half);
    hull_add(&s->hull, 0, s->a[1] / 2, 0);
    hull_close(&s->hull);
}

/* ---- without end: as much of the surface as the points asked about can see ---- */

enum { VISIBLE = 6 };

typedef struct Sheet {
    Vec corner, side, other;
} Sheet;
static Vec sheet_patch(const void *user, double u, double v)
{
    const Sheet *sheet = user;
    return vec_add(sheet->corner, vec_add(vec_scale(u, sheet->side), vec_scale(v, sheet->other)));
}

static bool in_half_space(const void *user, Vec p)
{
    const Solid *s = user;
    return vec_dot(argument_vec(s, 0), p) <= s->a[3];
}
static void plane_surface(const Solid *s, Cloud *cloud, double step)
{
    Vec normal = argument_vec(s, 0), side = vec_scale(2 * VISIBLE, vec_across(normal));
    Vec other  = vec_cross(vec_unit(normal), side);
    Vec middle = vec_scale(s->a[3] / vec_dot(normal, normal), normal);
    Vec corner = vec_sub(middle, vec_scale(0.5, vec_add(side, other)));
    cloud_patch(cloud, sheet_patch, NULL, &(Sheet){corner, side, other}, 2 * step);
}

static bool in_wedge(const void *user, Vec p)
{
    const Solid *s = user;
    return fabs(atan2(p.x, p.z)) <= s->a[0] / 2;
}
static void wedge_surface(const Solid *s, Cloud *cloud, double step)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        Sheet sheet = {vec(0, -VISIBLE, 0), vec(0, 2 * VISIBLE, 0),
                       vec(sign * VISIBLE * sin(s->a[0] / 2), 0, VISIBLE * cos(s->a[0] / 2))};
        cloud_patch(cloud, sheet_patch, NULL, &sheet, 2 * step);
    }
}

/* ---- Akleman and Chen's generalised distance to the sides x = +-a, y = +-b, z = +-c ---- */

static double generalised(const Solid *s, Vec p)
{
    double x = fabs(p.x) / s->a[0], y = fabs(p.y) / s->a[1], z = fabs(p.z) / s->a[2];
    return pow(pow(x, s->a[3]) + pow(y, s->a[3]) + pow(z, s->a[3]), 1 / s->a[3]);
}
static bool in_convex(const void *user, Vec p) { return generalised(user, p) <= 1; }
static Vec  convex_patch(const void *user, double u, double v)
{
    Vec direction = vec(sin(PI * u) * cos(2 * PI * v), cos(PI * u), sin(PI * u) * sin(2 * PI * v));
    return vec_scale(1 / generalised(user, direction), direction);
}
static void convex_surface(const Solid *s, Cloud *cloud, double step)
{
    cloud_patch(cloud, convex_patch, NULL, s, step);
}

/* ---- plane figures, made solid: the last argument is the height or the offset ---- */

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
static Vec  argument_corner(const Solid *s, int at) { return vec(s->a[at], s->a[at + 1], 0); }
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

#define SIZE     \
    {            \
        0.3, 1.5 \
    }
#define PLACE     \
    {             \
        -0.9, 0.9 \
    }
#define TUBE      \
    {             \
        0.05, 0.4 \
    }
#define HULL     in_hull, hull_surface
#define SWEEP    in_sweep, sweep_surface
#define EXTRUDED in_extrusion, extrusion_surface
#define TURNED   in_revolution, revolution_surface
#define LAST     [ARGUMENTS - 1]

static const Primitive primitives[] = {
    {"sphere", "sphere($a)", make_nothing, in_sphere, sphere_surface, true, {SIZE}},
    {"box", "box([$a, $b, $c])", make_box, HULL, true, {SIZE, SIZE, SIZE}},
    {"cylinder",
     "cylinder($a, $b)",
     make_nothing,
     in_cylinder,
     cylinder_surface,
     true,
     {SIZE, SIZE}},
    {"cone",
     "cone($a, $b)",
     make_nothing,
     in_pointed_cone,
     pointed_cone_surface,
     true,
     {SIZE, SIZE}},
    {"capped cone",
     "capped_cone($a, $b, $c)",
     make_nothing,
     in_capped_cone,
     capped_cone_surface,
     true,
     {SIZE, SIZE, SIZE}},
    {"capsule",
     "capsule([$a, $b, $c], [$d, $e, $f], $g)",
     make_capsule,
     SWEEP,
     true,
     {PLACE, PLACE, PLACE, PLACE, PLACE, PLACE, TUBE}},
    {"round cone",
     "round_cone([$a, $b, $c], [$d, $e, $f], $g, $h)",
     make_round_cone,
     SWEEP,
     true,
     {PLACE, PLACE, PLACE, PLACE, PLACE, PLACE, TUBE, TUBE}},
    {"round cone, one ball in the other",
     "round_cone([$a, $b, $c], [$d, $e, $f], $g, $h)",
     make_round_cone,
     SWEEP,
     true,
     {{-0.2, 0}, {-0.2, 0}, {-0.2, 0}, {0, 0.1}, {0, 0.1}, {0, 0.1}, {0.8, 1}, {0.1, 0.2}}},
    {"arc capsule",
     "arc_capsule([$a, $b, $c], [$d, $e, $f], [$g, $h, $i], $j, $j)",
     make_arc_capsule,
     SWEEP,
     true,
     {PLACE,
      {-0.9, -0.5},
      PLACE,
      PLACE,
      {-0.2, 0.2},
      PLACE,
      PLACE,
      {0.5, 0.9},
      PLACE,
      {0.05, 0.2}}},
    {"arc capsule, straight",
     "arc_capsule([$a, 0, 0], [0, 0, 0], [$g, 0, 0], $j, $j)",
     make_arc_capsule,
     SWEEP,
     true,
     {{-1, -0.5}, {0, 0}, {0, 0}, {0, 0}, {0, 0}, {0, 0}, {0.5, 1}, {0, 0}, {0, 0}, TUBE}},
    {"torus", "torus($a, $b)", make_nothing, in_torus, torus_surface, true, {{0.5, 1.2}, TUBE}},
    {"ellipsoid",
     "ellipsoid([$a, $b, $c])",
     make_nothing,
     in_ellipsoid,
     ellipsoid_surface,
     false,
     {SIZE, SIZE, SIZE}},
    {"link", "link($a, $b, $c)", make_link, SWEEP, true, {SIZE, {0.4, 0.8}, {0.1, 0.3}}},
    {"octahedron", "octahedron($a)", make_octahedron, HULL, true, {SIZE}},
    {"tetrahedron", "tetrahedron($a)", make_tetrahedron, HULL, true, {SIZE}},
    {"dodecahedron", "dodecahedron($a)", make_dodecahedron, HULL, true, {SIZE}},
    {"icosahedron", "icosahedron($a)", make_icosahedron, HULL, true, {SIZE}},
    {"hexagonal prism", "prism(6, $b, $c)", make_prism, HULL, true, {{6, 6}, SIZE, SIZE}},
    {"triangular prism", "prism(3, $b, $c)", make_prism, HULL, true, {{3, 3}, SIZE, SIZE}},
    {"heptagonal prism", "prism(7, $b, $c)", make_prism, HULL, true, {{7, 7}, SIZE, SIZE}},
    {"pyramid", "pyramid($a, $b)", make_pyramid, HULL, true, {SIZE, SIZE}},
    {"wedge", "wedge($a)", make_nothing, in_wedge, wedge_surface, true, {{0.2, 3}}},
    {"wide wedge", "wedge($a)", make_nothing, in_wedge, wedge_surface, true, {{3.3, 6}}},
    {"plane",
     "plane([$a, $b, $c], $d)",
     make_nothing,
     in_half_space,
     plane_surface,
     true,
     {SIZE, PLACE, PLACE, {-0.5, 0.5}}},
    {"half-space",
     "half_space([$a, $b, $c], $d)",
     make_nothing,
     in_half_space,
     plane_surface,
     true,
     {PLACE, SIZE, PLACE, {-0.5, 0.5}}},
    {"convex",
     "convex([[[1, 0, 0], $a], [[-1, 0, 0], $a], [[0, 1, 0], $b], [[0, -1, 0], $b],"
     " [[0, 0, 1], $c], [[0, 0, -1], $c]], $d)",
     make_nothing,
     in_convex,
     convex_surface,
     false,
     {SIZE, SIZE, SIZE, {2, 12}}},
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
enum { PRIMITIVES = sizeof primitives / sizeof *primitives };

/* `show` of the primitive's text with the arguments in place. */
static void write_call(SceneText *text, const char *call, const double *a)
{
    scene_write(text, "show ");
    for (; *call; call++)
        if (*call == '$')
            scene_write(text, "%.17g", a[*++call - 'a']);
        else
            scene_write(text, "%c", *call);
    scene_write(text, ";\n");
}

/* Arguments from their ranges, and the definition made from them. */
static Solid random_solid(const Primitive *primitive, Random *random)
{
    Solid solid = {0};
    for (int i = 0; i < ARGUMENTS; i++)
        solid.a[i] = random_between(random, primitive->range[i][0], primitive->range[i][1]);
    primitive->make(&solid);
    return solid;
}

static bool ball_has(const Primitive *primitive, const Solid *solid, Random *random, Vec centre,
                     double radius, bool side)
{
    for (int i = 0; i < 200; i++)
        if (primitive->inside(solid, random_in_ball(random, centre, radius)) == side)
            return true;
    return false;
}

/* The two definitions of a solid, its surface and its inside, are about the same thing: both
   sides meet at the surface, and nowhere else. */
static void definitions_agree(void **state)
{
    (void)state;
    for (size_t k = 0; k < PRIMITIVES; k++) {
        const Primitive *primitive = &primitives[k];
        Random           random    = {k};
        Solid            solid     = random_solid(primitive, &random);
        Cloud            cloud     = {0};
        primitive->surface(&solid, &cloud, 0.05);
        for (int i = 0; i < 60; i++) {
            Vec on = cloud.points[random_below(&random, (int)cloud.count)];
            if (!ball_has(primitive, &solid, &random, on, 1e-3, true) ||
                !ball_has(primitive, &solid, &random, on, 1e-3, false))
                fail_msg("%s: (%g, %g, %g) is not on the surface", primitive->name, on.x, on.y,
                         on.z);
            Vec    off    = random_in_cube(&random, 1.5);
            double radius = cloud_nearest(&cloud, off) - cloud.spacing;
            bool   side   = primitive->inside(&solid, off);
            if (radius > 0 && ball_has(primitive, &solid, &random, off, radius, !side))
                fail_msg("%s: a surface near (%g, %g, %g) is missing", primitive->name, off.x,
                         off.y, off.z);
        }
        cloud_free(&cloud);
    }
}

/* |distance| <= nearest point, and, for exact ones and outside, no less than the spacing of the
   cloud allows. */
static void check_brackets(const Primitive *primitive, const Product *product, bool exact,
                           const Solid *solid, Random *random)
{
    Cloud cloud = {0};
    primitive->surface(solid, &cloud, 0.025);
    assert_true(cloud.count > 500 && cloud.spacing < 0.2);
    for (int i = 0; i < POINTS; i++) {
        Vec    point    = random_in_cube(random, i % 2 ? 1 : 2);
        double distance = product_distance(product, point), nearest = cloud_nearest(&cloud, point);
        if (!(fabs(distance) <= nearest + 1e-9))
            fail_msg("%s at (%g, %g, %g): %.9g, but a point of it is %.9g away", primitive->name,
                     point.x, point.y, point.z, distance, nearest);
        if (exact && distance > 0 && !(distance >= nearest - cloud.spacing))
            fail_msg("%s at (%g, %g, %g): %.9g is not exact: %.9g", primitive->name, point.x,
                     point.y, point.z, distance, nearest);
    }
    cloud_free(&cloud);
}

/* Outside of a union of balls the distance is known to more digits. */
static void check_sweep(const Primitive *primitive, const Product *product, bool exact,
                        const Solid *solid, Random *random)
{
    for (int i = 0; i < POINTS; i++) {
        Vec    point    = random_in_cube(random, 2);
        double distance = product_distance(product, point);
        double truth    = sweep_depth(&solid->sweep, point);
        if (truth > 0 && !(distance <= truth + 1e-7 && (!exact || distance >= truth - 1e-7)))
            fail_msg("%s at (%g, %g, %g): %.9g, truly %.9g", primitive->name, point.x, point.y,
                     point.z, distance, truth);
    }
}

static void primitive_is_its_definition(void **state)
{
    const Primitive *primitive = *state;
    Random           random    = {(uint64_t)(primitive - primitives)};
    for (int set = 0; set < SETS; set++) {
        Solid     solid = random_solid(primitive, &random);
        SceneText text  = {.length = 0};
        write_call(&text, primitive->text, solid.a);

        Product      product = product_compile(text.bytes);
        KrsComponent component;
        assert_int_equal(krs_component(product.scene, 0, &component), KRS_OK);
        bool exact = primitive->exact || component.exact;
        check_brackets(primitive, &product, exact, &solid, &random);
        if (solid.sweep.curve_count)
            check_sweep(primitive, &product, exact, &solid, &random);
        Trial trial = {product_field, &product, primitive->inside, &solid, vec(0, 0, 0), 1.8,
                       POINTS,        77};
        judge_acquits(&trial, text.bytes);
        if (exact)
            judge_refutes_larger(&trial, 1.15, text.bytes);
        product_free(&product);
    }
}

static bool negative(const void *product, Vec p) { return product_distance(product, p) <= 0; }

/* How a tapered arc goes from one radius to the other is its own affair, within limits: the
   surface is never farther than a third of the change from that of the linear one. */
static void tapered_arcs(void **state)
{
    (void)state;
    Random random = {78};
    for (int set = 0; set < 6; set++) {
        Vec from = random_in_cube(&random, 0.3), via = random_in_cube(&random, 0.3);
        Vec to = random_in_cube(&random, 0.3);
        from.y -= 0.7;
        to.y += 0.7;
        double radius = random_between(&random, 0.1, 0.3), end = random_between(&random, 0.02, 0.1);
        Sweep  sweep    = {.curves      = {curve_arc(from, via, to)},
                           .curve_count = 1,
                           .radius      = radius,
                           .radius_end  = end};
        Product product = product_format(
            "show arc_capsule([%.17g, %.17g, %.17g], [%.17g, %.17g, %.17g], [%.17g, %.17g, %.17g],"
            " %.17g, %.17g);",
            from.x, from.y, from.z, via.x, via.y, via.z, to.x, to.y, to.z, radius, end);
        Trial trial = {product_field, &product, negative, &product, vec(0, 0, 0), 1.5, POINTS, 79};
        judge_acquits(&trial, "tapered arc");
        product_keeps_claim(&product, "tapered arc", 1.5, 80);
        for (int i = 0; i < POINTS; i++) {
            Vec    point = random_in_cube(&random, 1.2);
            double depth = sweep_depth(&sweep, point), slack = (radius - end) / 3;
            double distance = product_distance(&product, point);
            assert_true(depth <= slack || distance > 0);
            assert_true(depth >= -slack || distance < 0);
        }
        product_free(&product);
    }
}

/* All names of the language reference, with nothing said about their sizes. */
static const char *const solids[] = {
    "sphere",      "box",   "cylinder",  "cone",  "capped_cone", "capsule",     "round_cone",
    "arc_capsule", "torus", "ellipsoid", "link",  "octahedron",  "tetrahedron", "dodecahedron",
    "icosahedron", "prism", "pyramid",   "wedge", "plane",       "half_space",  "convex",
};
static const char *const figures[] = {"circle", "rectangle", "polygon", "regular",
                                      "star",   "segment",   "arc",     "bezier"};

/* With its defaults a shape is somewhere solid, somewhere not, and no steeper than distance. */
static void check_default(const char *name, const char *rest)
{
    Product product = product_format("show %s()%s;", name, rest);
    Random  random  = {12};
    int     inside = 0, outside = 0;
    for (int i = 0; i < 4000; i++) {
        Vec    a = random_in_cube(&random, 1.5), b = random_in_ball(&random, a, 0.5);
        double at_a = product_distance(&product, a), at_b = product_distance(&product, b);
        inside += at_a < 0;
        outside += at_a > 0;
        if (!(fabs(at_a - at_b) <= vec_distance(a, b) * (1 + 1e-9) + 1e-12))
            fail_msg("%s()%s rises too fast", name, rest);
    }
    if (inside == 0 || outside == 0)
        fail_msg("%s()%s: %d points inside, %d outside", name, rest, inside, outside);
    product_free(&product);
}

static void defaults_are_shapes(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof solids / sizeof *solids; i++)
        check_default(solids[i], "");
    for (size_t i = 0; i < sizeof figures / sizeof *figures; i++) {
        check_default(figures[i], ".extrude(0.5)");
        check_default(figures[i], ".revolve(0.5)");
    }
}

int main(void)
{
    struct CMUnitTest tests[PRIMITIVES + 3];
    size_t            count = 0;
    tests[count++]          = (struct CMUnitTest)cmocka_unit_test(definitions_agree);
    for (const Primitive *p = primitives; p < primitives + PRIMITIVES; p++)
        tests[count++] = (struct CMUnitTest){p->name, primitive_is_its_definition, NULL, NULL,
                                             (void *)(uintptr_t)p};
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(tapered_arcs);
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(defaults_are_shapes);
    return _cmocka_run_group_tests("primitives", tests, count, NULL, NULL);
}
