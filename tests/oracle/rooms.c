/*
 * rooms.c: solids by their definitions.
 *
 * Bounds are made of lengths, maxima and minima; what bends space is divided by how much it may
 * stretch between a point and the solid.
 */
#include "tests/oracle/rooms.h"

#define DEGREE (M_PI / 180)

static double least(double a, double b) { return a < b ? a : b; }
static double most(double a, double b) { return a > b ? a : b; }

/* ---- Solids ---- */

static double box_bound(Vec p, double x, double y, double z)
{
    Vec    q      = vec(fabs(p.x) - x / 2, fabs(p.y) - y / 2, fabs(p.z) - z / 2);
    double inside = least(most(q.x, most(q.y, q.z)), 0);
    return vec_length(vec(most(q.x, 0), most(q.y, 0), most(q.z, 0))) + inside;
}

/* About y. */
static double cylinder_bound(Vec p, double radius, double height)
{
    return most(hypot(p.x, p.z) - radius, fabs(p.y) - height / 2);
}

/* Tip up. */
static double cone_bound(Vec p, double radius, double height)
{
    double side = (hypot(p.x, p.z) * height - radius * (height / 2 - p.y)) / hypot(radius, height);
    return most(side, -p.y - height / 2);
}

static double capsule_bound(Vec p, Vec from, Vec to, double radius)
{
    Vec    along = vec_sub(to, from);
    double part  = vec_dot(vec_sub(p, from), along) / vec_dot(along, along);
    return vec_distance(p, vec_mix(from, to, most(0, least(part, 1)))) - radius;
}

static double ball_bound(Vec p, Vec centre, double radius)
{
    return vec_distance(p, centre) - radius;
}

static double torus_bound(Vec p, double major, double minor)
{
    return hypot(hypot(p.x, p.z) - major, p.y) - minor;
}

/* About y, turned back. */
static Vec turned(Vec p, double angle) { return vec_rotate(p, vec(0, 1, 0), -angle); }
static Vec lowered(Vec p, double by) { return vec(p.x, p.y - by, p.z); }

/* ---- Rooms ---- */

static double below_ceiling(Vec p, const double n[])
{
    Vec    q     = lowered(p, 1.5);
    double walls = most(box_bound(q, 3.2, 3.2, 4.2), -box_bound(q, 3, 3, 6));
    double back  = box_bound(vec(q.x, q.y, q.z + 2), 3, 3, 0.1);
    double chest = box_bound(turned(vec(p.x - n[2], p.y - n[1] / 2, p.z + 0.7), n[3]), n[0], n[1],
                             n[0]);
    return least(least(walls, back), chest);
}

static double below_shade(Vec p, const double n[])
{
    Vec    q     = lowered(p, n[0]);
    double shade = most(cone_bound(q, 0.8, 1), -cone_bound(lowered(q, -0.05), 0.76, 0.95));
    return least(shade, least(p.y, p.z + 2));
}

static double by_windows(Vec p, const double n[])
{
    Vec    q    = vec(p.x, p.y - 1.5, p.z + 2);
    double wall = box_bound(q, 6, 3, 0.2);
    double roof = box_bound(vec(p.x, p.y - 3.1, p.z - 1), 6, 0.2, 6);
    for (int i = -1; i <= 1; i++)
        wall = most(wall, -box_bound(vec(q.x - 1.5 * i, q.y - 0.2, q.z), n[0], n[1], 1));
    return least(least(wall, roof), p.y);
}

static double metaballs(Vec p, const double n[])
{
    const Vec    centres[] = {{-0.4, 1, 0}, {0.4, 1.2, 0}, {0, 0.7, 0.5}};
    const double radii[]   = {0.3, n[0], 0.2};
    double       sum = 0, nearest = HUGE_VAL;
    for (int i = 0; i < 3; i++) {
        double distance = ball_bound(p, centres[i], radii[i]),
               t        = least(most(distance, 0) / n[2], 1);
        sum += pow(1 - t * t, 3);
        nearest = least(nearest, distance);
    }
    /* Each falls by 1.718 / reach at most. */
    double melted = (n[1] - sum) * n[2] / (3 * 1.718);
    return least(most(melted, nearest - n[2]), p.y);
}

static double twisted(Vec p, const double n[])
{
    Vec    q      = lowered(p, 1.2);
    double radius = n[0] * M_SQRT1_2, hull = cylinder_bound(q, radius, 2.4);
    double bar = box_bound(turned(q, n[1] * q.y), n[0], 2.4, n[0]) / (1 + n[1] * (radius + 0.1));
    return least(hull > 0.1 ? hull : bar, p.y);
}

static double displaced(Vec p, const double n[])
{
    Vec    q    = lowered(p, 1);
    double bump = sin(n[0] * q.x) * sin(n[0] * q.y) * sin(n[0] * q.z);
    return least((vec_length(q) - 0.7 - n[1] * bump) / (1 + 1.2 * n[0] * n[1]), p.y);
}

static double gyroid(Vec p, const double n[])
{
    Vec    q = lowered(p, 1.15), k = vec_scale(n[0], q);
    double value = sin(k.x) * cos(k.y) + sin(k.y) * cos(k.z) + sin(k.z) * cos(k.x);
    double sheet = (fabs(value) - n[1]) / (1.7321 * n[0]);
    return least(most(vec_length(q) - 1, sheet), p.y);
}

static double pierced(Vec p, const double n[])
{
    Vec    q    = lowered(p, 1.1);
    double vase = most(vec_length(q) - 0.9, 0.82 - vec_length(q));
    for (int i = 0; i < 4; i++) {
        Vec direction = turned(q, n[1] + 45 * DEGREE * i);
        vase = most(vase, -cylinder_bound(vec(direction.y, direction.x, direction.z), n[0], 4));
    }
    return least(vase, least(p.y, p.z + 1.5));
}

static double algebraic(Vec p, const double n[])
{
    Vec    q    = vec(p.x + 0.8, p.y - 0.8, p.z);
    double dice = sqrt(sqrt(pow(q.x, 4) + pow(q.y, 4) + pow(q.z, 4))) - sqrt(sqrt(n[0]));
    double ring = torus_bound(vec(p.x - 0.8, p.z, p.y - 0.9), 0.5, n[1]);
    return least(least(dice, ring), p.y);
}

/* A ball of radius r around q, rho from the pole, goes to points within R^2 r / (rho (rho - r)). */
static double inverted(Vec p, const double n[])
{
    Vec    q      = lowered(p, -0.6);
    double square = vec_dot(q, q), power = 1.44;
    double distance = box_bound(lowered(vec_scale(power / square, q), 1.2), n[0], 0.8, n[1]);
    return least(distance * square / (power + fabs(distance) * sqrt(square)), p.y);
}

static double tree(Vec p, const double n[])
{
    enum { LEVELS = 5 };
    double nearest = p.y, size = 1;
    for (int i = 0; i <= LEVELS; i++) {
        double twig = capsule_bound(p, vec(0, 0, 0), vec(0, 0.5, 0), n[1]);
        nearest     = least(nearest, size * twig);
        p.x         = -fabs(p.x);
        p           = vec_rotate(lowered(p, 0.5), vec(0, 1, 0), 70 * DEGREE);
        p           = vec_scale(1 / 0.85, vec_rotate(p, vec(1, 0, 0), -n[0]));
        size *= 0.85;
    }
    return nearest;
}

static double plates(Vec p, const double n[])
{
    double nearest = p.y;
    for (int i = -3; i <= 3; i++) {
        Vec q   = turned(lowered(p, 0.8), n[0]);
        nearest = least(nearest, box_bound(vec(q.x - 0.4 * i, q.y, q.z), n[1], 1.6, 0.8));
    }
    return nearest;
}

static double contacts(Vec p, const double n[])
{
    double box  = box_bound(turned(lowered(p, n[0] / 2), n[1]), 1, n[0], 0.6);
    double drum = cylinder_bound(vec(p.x + 1.1, p.y - 0.4, p.z - 0.3), 0.3, 0.8);
    double ball = ball_bound(p, vec(1.1, 0.4, 0.3), 0.4);
    double lid  = box_bound(turned(lowered(p, n[0] + 0.1), n[1] + 0.5), 0.5, 0.2, 0.5);
    return least(least(least(box, drum), least(ball, lid)), p.y);
}

static double stand(Vec p, const double n[])
{
    Vec    q    = vec_rotate(lowered(p, 1.2), vec(1, 0, 0), -n[0]);
    double cone = cone_bound(vec(p.x + 0.9, p.y - 0.6, p.z), 0.4, 1.2);
    return least(least(torus_bound(q, 0.6, n[1]), ball_bound(p, vec(0.9, 0.5, 0.5), 0.3)),
                 least(cone, p.y));
}

static double bars(Vec p, const double n[])
{
    double nearest = p.y;
    for (int i = 0; i < 9; i++)
        nearest = least(nearest,
                        cylinder_bound(vec(p.x - 0.35 * (i - 4), p.y - 1, p.z + 0.8), n[0], 2));
    return least(nearest, box_bound(vec(p.x, p.y - 2.05, p.z + 0.8), 3.2, 0.1, 0.2));
}

static double blended(Vec p, const double n[])
{
    double box  = box_bound(lowered(p, 0.6), 0.8, 0.8, 0.8);
    double ball = ball_bound(p, vec(0.5, 1.1, 0.2), 0.45);
    double h    = most(1 - fabs(box - ball) / n[0], 0);
    return least(least(box, ball) - n[0] * h * h / 4, p.y);
}

static double underestimate(Vec p, const double n[])
{
    double high = ball_bound(p, vec(-0.6, 1.2, 0), n[0]);
    return least(least(high, ball_bound(p, vec(0.7, 0.5, 0.4), 0.5)), p.y);
}

static double stretched(Vec p, const double n[])
{
    Vec q = turned(lowered(p, 0.9), n[1]);
    return least((vec_length(vec(q.x, q.y / n[0], q.z / 0.5)) - 1) * least(n[0], 0.5), p.y);
}

#define FLOOR          "show plane([0, 1, 0], 0).paint(white);\n"
#define FROM_THE_FRONT .eye = {0, 3.2, 5.5}, .target = {0.1, 0.4, 0}, .fov = 34
#define HIGH_SUN       .light_low = {-1.2, 1, -0.2}, .light_high = {1.2, 2, 1.2}, .wide = {2, 14}

const Room rooms[ROOMS] = {
    {"below a ceiling",
     "show (box([3.2, 3.2, 4.2]) - box([3, 3, 6])).move([0, 1.5, 0]).paint(white);\n"
     "show box([3, 3, 0.1]).move([0, 1.5, -2]).paint(white);\n"
     "show box([a, b, a]).rotate([0, 1, 0], d).move([c, b / 2, -0.7]).paint(white);\n",
     below_ceiling,
     {{0.5, 1}, {0.4, 1.7}, {-0.8, 0.8}, {-0.7, 0.7}},
     .eye        = {0, 1.5, 5.5},
     .target     = {0, 1.5, 0},
     .fov        = 36,
     .lamp       = true,
     .light_low  = {-0.8, 2.3, -0.8},
     .light_high = {0.8, 2.75, 1},
     .wide       = {0.1, 0.35}},
    {"below a shade",
     "show (cone(0.8, 1) - cone(0.76, 0.95).move([0, -0.05, 0])).move([0, a, 0]).paint(white);\n"
     "show plane([0, 0, 1], -2).paint(white);\n" FLOOR,
     below_shade,
     {{1.6, 2.2}},
     .eye        = {0, 2.2, 7},
     .target     = {0, 1, 0},
     .fov        = 38,
     .lamp       = true,
     .light_low  = {-0.1, 1.45, -0.1},
     .light_high = {0.1, 1.7, 0.1},
     .wide       = {0.04, 0.14}},
    {"by windows",
     "let wall = box([6, 3, 0.2]) - union([box([a, b, 1]).move([1.5 * i, 0.2, 0])"
     " for i in [-1, 0, 1]]);\n"
     "show wall.move([0, 1.5, -2]).paint(white);\n"
     "show box([6, 0.2, 6]).move([0, 3.1, 1]).paint(white);\n" FLOOR,
     by_windows,
     {{0.4, 1}, {0.8, 1.8}},
     .eye        = {0, 2.5, 4},
     .target     = {0, 0.4, -0.6},
     .fov        = 44,
     .light_low  = {-0.6, 0.6, -1},
     .light_high = {0.6, 1.2, -0.8},
     .wide       = {0.5, 8}},
    {"metaballs",
     "show meta([sphere(0.3).move([-0.4, 1, 0]), sphere(a).move([0.4, 1.2, 0]),"
     " sphere(0.2).move([0, 0.7, 0.5])], level: b, reach: c).paint(white);\n" FLOOR,
     metaballs,
     {{0.2, 0.4}, {0.35, 0.6}, {0.4, 0.7}},
     FROM_THE_FRONT,
     HIGH_SUN},
    {"a twisted box",
     "show box([a, 2.4, a]).twist([0, 1, 0], b).move([0, 1.2, 0]).paint(white);\n" FLOOR,
     twisted,
     {{0.5, 0.9}, {0.8, 2.6}},
     FROM_THE_FRONT,
     HIGH_SUN},
    {"a displaced ball",
     "show sphere(0.7).displace(sin(a * x) * sin(a * y) * sin(a * z), amplitude: b)"
     ".move([0, 1, 0]).paint(white);\n" FLOOR,
     displaced,
     {{3, 8}, {0.05, 0.2}},
     FROM_THE_FRONT,
     HIGH_SUN},
    {"a gyroid",
     "show field(abs(sin(a * x) * cos(a * y) + sin(a * y) * cos(a * z) + sin(a * z) * cos(a * x))"
     " - b).within(sphere(1)).move([0, 1.15, 0]).paint(white);\n" FLOOR,
     gyroid,
     {{4, 6}, {0.2, 0.5}},
     FROM_THE_FRONT,
     HIGH_SUN},
    {"a pierced vase",
     "let vase = sphere(0.9) - sphere(0.82) - union([cylinder(a, 4).rotate([0, 0, 1], 90deg)"
     ".rotate([0, 1, 0], b + 45deg * i) for i in 0..4]);\n"
     "show vase.move([0, 1.1, 0]).paint(white);\n"
     "show plane([0, 0, 1], -1.5).paint(white);\n" FLOOR,
     pierced,
     {{0.16, 0.26}, {0, 0.7}},
     .eye        = {0, 2.4, 5.5},
     .target     = {0.1, 0.9, 0},
     .fov        = 40,
     .lamp       = true,
     .light_low  = {-0.2, 1, -0.2},
     .light_high = {0.2, 1.3, 0.2},
     .wide       = {0.04, 0.15}},
    {"polynomials",
     "show algebraic(x^4 + y^4 + z^4 == a).within(sphere(1.2)).move([-0.8, 0.8, 0]).paint(white);\n"
     "show algebraic((x^2 + y^2 + z^2 + 0.25 - b^2)^2 == x^2 + y^2).within(sphere(1))"
     ".move([0.8, 0.9, 0]).paint(white);\n" FLOOR,
     algebraic,
     {{0.1, 0.25}, {0.1, 0.25}},
     FROM_THE_FRONT,
     HIGH_SUN},
    {"an inverted box",
     "show box([a, 0.8, b]).move([0, 1.2, 0]).transform(invert(radius: 1.2))"
     ".move([0, -0.6, 0]).paint(white);\n" FLOOR,
     inverted,
     {{0.5, 1.2}, {0.5, 1.2}},
     .eye    = {0, 2.4, 4},
     .target = {0.1, 0.2, 0},
     .fov    = 36,
     HIGH_SUN},
    {"a tree",
     "let twig = capsule([0, 0, 0], [0, 0.5, 0], radius: b);\n"
     "show krs { kernel twig; for i in 0..5 {\n"
     "    mobius translate([0, 0.5, 0]) * rotate([0, 1, 0], -70deg) * rotate([1, 0, 0], a)"
     " * scale(0.85);\n    reflect plane([1, 0, 0], 0); kernel twig; } }.paint(white);\n" FLOOR,
     tree,
     {{0.35, 0.6}, {0.04, 0.07}},
     .eye    = {0, 3.5, 5.5},
     .target = {0.1, 0.7, 0},
     .fov    = 34,
     HIGH_SUN},
    {"plates",
     "show box([b, 1.6, 0.8]).repeat([0.4, 0, 0], [7, 1, 1]).rotate([0, 1, 0], a)"
     ".move([0, 0.8, 0]).paint(white);\n" FLOOR,
     plates,
     {{-0.7, 0.7}, {0.03, 0.08}},
     FROM_THE_FRONT,
     HIGH_SUN},
    {"contacts",
     "show box([1, a, 0.6]).rotate([0, 1, 0], b).move([0, a / 2, 0]).paint(white);\n"
     "show cylinder(0.3, 0.8).move([-1.1, 0.4, 0.3]).paint(white);\n"
     "show sphere(0.4).move([1.1, 0.4, 0.3]).paint(white);\n"
     "show box([0.5, 0.2, 0.5]).rotate([0, 1, 0], b + 0.5).move([0, a + 0.1, "
     "0]).paint(white);\n" FLOOR,
     contacts,
     {{0.3, 0.9}, {-0.7, 0.7}},
     FROM_THE_FRONT,
     .light_low  = {-1.2, 0.4, -0.6},
     .light_high = {1.2, 1, 0.8},
     .wide       = {1, 10}},
    {"a lamp and solids",
     "show torus(0.6, b).rotate([1, 0, 0], a).move([0, 1.2, 0]).paint(white);\n"
     "show sphere(0.3).move([0.9, 0.5, 0.5]).paint(white);\n"
     "show cone(0.4, 1.2).move([-0.9, 0.6, 0]).paint(white);\n" FLOOR,
     stand,
     {{0.2, 1.2}, {0.05, 0.15}},
     FROM_THE_FRONT,
     .lamp       = true,
     .light_low  = {-0.8, 1.6, 0},
     .light_high = {0.8, 2.6, 1},
     .wide       = {0.1, 0.4}},
    {"bars",
     "show union([cylinder(a, 2).move([0.35 * (i - 4), 1, -0.8]) for i in 0..9]).paint(white);\n"
     "show box([3.2, 0.1, 0.2]).move([0, 2.05, -0.8]).paint(white);\n" FLOOR,
     bars,
     {{0.02, 0.09}},
     FROM_THE_FRONT,
     .light_low  = {-0.8, 0.7, -1},
     .light_high = {0.8, 1.2, -0.8},
     .wide       = {1, 10}},
    {"a blend",
     "show union(box([0.8, 0.8, 0.8]).move([0, 0.6, 0]), sphere(0.45).move([0.5, 1.1, 0.2]),"
     " blend: a).paint(white);\n" FLOOR,
     blended,
     {{0.1, 0.5}},
     FROM_THE_FRONT,
     HIGH_SUN},
    {"loose bounds",
     "shape ball(radius = 1) { distance: length(p) - radius, slope: 5,"
     " within: box(2 * radius * [1, 1, 1]) }\n"
     "show ball(a).move([-0.6, 1.2, 0]).paint(white);\n"
     "show ball(0.5).move([0.7, 0.5, 0.4]).paint(white);\n" FLOOR,
     underestimate,
     {{0.3, 0.8}},
     FROM_THE_FRONT,
     HIGH_SUN},
    {"a stretched ball",
     "show sphere(1).scale([1, a, 0.5]).rotate([0, 1, 0], b).move([0, 0.9, "
     "0]).paint(white);\n" FLOOR,
     stretched,
     {{0.1, 0.5}, {-0.7, 0.7}},
     FROM_THE_FRONT,
     HIGH_SUN},
};
