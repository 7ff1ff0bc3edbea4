/*
 * primitive_solids.c: definitions of the solids of the library.
 */
#include "tests/oracle/primitives.h"

static const double PI = 3.14159265358979323846;

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

/* ---- swept balls ---- */

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

static void make_bezier_capsule(Solid *s)
{
    make_sweep(s, curve_bezier(argument_vec(s, 0), argument_vec(s, 3), argument_vec(s, 6)), s->a[9],
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

/* ---- convex hulls ---- */

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

/* On each half of each axis a point, and two more. */
static void make_irregular(Solid *s)
{
    const double *a = s->a;
    for (int i = 0; i < 6; i++) {
        double out = i & 1 ? -a[i] : a[i];
        hull_add(&s->hull, i / 2 == 0 ? out : 0, i / 2 == 1 ? out : 0, i / 2 == 2 ? out : 0);
    }
    hull_add(&s->hull, a[6], a[7], a[8]);
    hull_add(&s->hull, -a[9], a[10], -a[11]);
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

static Vec convex_patch(const void *user, double u, double v)
{
    Vec direction = vec(sin(PI * u) * cos(2 * PI * v), cos(PI * u), sin(PI * u) * sin(2 * PI * v));
    return vec_scale(1 / generalised(user, direction), direction);
}

static void convex_surface(const Solid *s, Cloud *cloud, double step)
{
    cloud_patch(cloud, convex_patch, NULL, s, step);
}

/* ---- the table ---- */

#define TUBE      \
    {             \
        0.05, 0.4 \
    }
#define HULL  in_hull, hull_surface
#define SWEEP in_sweep, sweep_surface

const Primitive solid_primitives[SOLIDS] = {
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
    {"hull",
     "hull([[$a, 0, 0], [-$b, 0, 0], [0, $c, 0], [0, -$d, 0], [0, 0, $e], [0, 0, -$f],"
     " [$g, $h, $i], [-$j, $k, -$l]])",
     make_irregular,
     HULL,
     true,
     {SIZE, SIZE, SIZE, SIZE, SIZE, SIZE, SIZE, SIZE, SIZE, SIZE, SIZE, SIZE}},
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
    {"bezier capsule",
     "bezier_capsule([$a, $b, $c], [$d, $e, $f], [$g, $h, $i], $j)",
     make_bezier_capsule,
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
};
