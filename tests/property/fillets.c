/*
 * fillets.c: a union with `kind: "fillet"` holds its parts, has the arc of a rolling ball in concave edges, and
 * never leaves the convex hull of two parts.  The oracles are closed forms of the parts: distances, and supports
 * in many directions.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "krs/krs.h"
#include "tests/support/random.h"

enum { POINTS = 240, MOST = 130 };

static const double PI = 3.14159265358979323846;

static Random randomness = {1710};

static double between(double low, double high) { return random_between(&randomness, low, high); }

/* ---- parts, in a frame of their own ---- */

typedef enum PartKind { BOX, BALL, ROD, CAPSULE, PART_KINDS } PartKind;

/* A box has half its sides in `size`; other parts have the radius in size[0] and half the height in size[1],
   along the second axis of the frame. */
typedef struct Part {
    PartKind kind;
    double   size[3], centre[3];
    double   axis[3], angle; /* the turn of the frame, about a unit vector */
    double   rows[3][3];     /* of the inverse turn */
} Part;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void unit(double v[3])
{
    const double length = sqrt(dot(v, v));
    for (int k = 0; k < 3; k++)
        v[k] /= length;
}

/* By Rodrigues' formula. */
static void turn(const double axis[3], double angle, const double v[3], double turned[3])
{
    const double along = dot(axis, v) * (1 - cos(angle));
    for (int k = 0; k < 3; k++) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        turned[k] = v[k] * cos(angle) + (axis[a] * v[b] - axis[b] * v[a]) * sin(angle) +
                    axis[k] * along;
    }
}

static void set_turn(Part *part, const double axis[3], double angle)
{
    memcpy(part->axis, axis, sizeof part->axis);
    part->angle = angle;
    for (int k = 0; k < 3; k++) {
        const double along[3] = {k == 0, k == 1, k == 2};
        turn(axis, angle, along, part->rows[k]);
    }
}

static double distance_to(const Part *part, const double p[3])
{
    double q[3], away[3], outside = 0, inside;
    for (int k = 0; k < 3; k++)
        away[k] = p[k] - part->centre[k];
    for (int k = 0; k < 3; k++)
        q[k] = dot(part->rows[k], away);
    const double about = hypot(q[0], q[2]), height = fabs(q[1]) - part->size[1];
    switch (part->kind) {
    case BALL: return sqrt(dot(q, q)) - part->size[0];
    case CAPSULE: return hypot(about, fmax(height, 0)) - part->size[0];
    case ROD:
        return hypot(fmax(about - part->size[0], 0), fmax(height, 0)) +
               fmin(fmax(about - part->size[0], height), 0);
    default: inside = -HUGE_VAL;
    }
    for (int k = 0; k < 3; k++) {
        outside += pow(fmax(fabs(q[k]) - part->size[k], 0), 2);
        inside = fmax(inside, fabs(q[k]) - part->size[k]);
    }
    return sqrt(outside) + fmin(inside, 0);
}

/* Returns the greatest of dot(u, x). */
static double support(const Part *part, const double u[3])
{
    double       v[3];
    const double middle = dot(u, part->centre);
    for (int k = 0; k < 3; k++)
        v[k] = dot(part->rows[k], u);
    switch (part->kind) {
    case BALL: return middle + part->size[0];
    case CAPSULE: return middle + part->size[0] + fabs(v[1]) * part->size[1];
    case ROD: return middle + part->size[0] * hypot(v[0], v[2]) + fabs(v[1]) * part->size[1];
    default:
        return middle + fabs(v[0]) * part->size[0] + fabs(v[1]) * part->size[1] +
               fabs(v[2]) * part->size[2];
    }
}

static int write_part(char *to, const Part *part)
{
    int n = 0;
    switch (part->kind) {
    case BALL: n = sprintf(to, "sphere(%.17g)", part->size[0]); break;
    case ROD: n = sprintf(to, "cylinder(%.17g, %.17g)", part->size[0], 2 * part->size[1]); break;
    case CAPSULE:
        n = sprintf(to, "capsule([0, %.17g, 0], [0, %.17g, 0], %.17g)", -part->size[1],
                    part->size[1], part->size[0]);
        break;
    default:
        n = sprintf(to, "box([%.17g, %.17g, %.17g])", 2 * part->size[0], 2 * part->size[1],
                    2 * part->size[2]);
    }
    if (part->angle != 0)
        n += sprintf(to + n, ".rotate([%.17g, %.17g, %.17g], %.17g)", part->axis[0], part->axis[1],
                     part->axis[2], part->angle);
    return n + sprintf(to + n, ".move([%.17g, %.17g, %.17g])", part->centre[0], part->centre[1],
                       part->centre[2]);
}

static Part upright(PartKind kind, double x, double y, double z, double a, double b, double c)
{
    Part part = {.kind = kind, .size = {a, b, c}, .centre = {x, y, z}};
    set_turn(&part, (const double[3]){0, 1, 0}, 0);
    return part;
}

static Part random_part(PartKind kind, double room)
{
    Part   part = {.kind = kind};
    double axis[3];
    for (int k = 0; k < 3; k++) {
        part.centre[k] = between(-room, room);
        part.size[k]   = between(0.2, 0.8);
        axis[k]        = between(-1, 1);
    }
    unit(axis);
    set_turn(&part, axis, between(0, 3));
    return part;
}

/* ---- scenes ---- */

static void probe_text(const char *text, const char *param, double value, double (*points)[3],
                       int count, KrsHit *hits)
{
    KrsOptions options = {0};
    KrsScene  *scene   = NULL;
    KrsState  *state   = NULL;
    assert_int_equal(krs_compile_text(text, strlen(text), "fillets.krs", &options, &scene), KRS_OK);
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    if (param)
        assert_int_equal(krs_state_set(state, param, &value, 1), KRS_OK);
    assert_int_equal(krs_probe(state, (const double(*)[3])points, (size_t)count, hits), KRS_OK);
    krs_state_free(state);
    krs_scene_free(scene);
}

/* `behind` is what is called of the union, such as ".move([1, 0, 0])". */
static const char *union_text(const Part *parts, int count, double width, const char *kind,
                              const char *behind)
{
    static char text[MOST * 500];
    int         n = sprintf(text, "show union([");
    for (int i = 0; i < count; i++) {
        n += write_part(text + n, &parts[i]);
        n += sprintf(text + n, i + 1 < count ? ", " : "");
    }
    sprintf(text + n, "], blend: %.17g, kind: \"%s\")%s;", width, kind, behind);
    return text;
}

static double nearest(const Part *parts, int count, const double p[3])
{
    double least = HUGE_VAL;
    for (int i = 0; i < count; i++)
        least = fmin(least, distance_to(&parts[i], p));
    return least;
}

static double circular(double a, double b, double k)
{
    return fmax(k, fmin(a, b)) - hypot(fmax(k - a, 0), fmax(k - b, 0));
}

static void gradient_of(const Part *part, const double p[3], double gradient[3])
{
    for (int k = 0; k < 3; k++) {
        double there[3] = {p[0], p[1], p[2]};
        there[k] += 1e-6;
        gradient[k] = (distance_to(part, there) - distance_to(part, p)) / 1e-6;
    }
}

/* How far a point is outside of the hull of two parts, or less: the greatest in some directions.  The first are
   those away from the parts, the last get closer and closer to the best. */
static double outside_hull(const Part *a, const Part *b, const double p[3])
{
    double most = -HUGE_VAL;
    for (int start = 0; start < 3; start++) {
        double best[3] = {0}, here = -HUGE_VAL;
        for (int i = 0; i < 300; i++) {
            const double step = i < 60 ? 2 : pow(0.95, i - 60);
            double       u[3];
            for (int k = 0; k < 3; k++)
                u[k] = best[k] + step * between(-1, 1);
            if (i == 0 && start < 2)
                gradient_of(start ? b : a, p, u);
            unit(u);
            const double height = dot(u, p) - fmax(support(a, u), support(b, u));
            if (height > here) {
                here = height;
                memcpy(best, u, sizeof u);
            }
        }
        most = fmax(most, here);
    }
    return most;
}

/* ---- what does not change ---- */

/* Where it is clear, a point is inside of the fillet if and only if it is inside of a part. */
static void assert_unchanged(const Part *parts, int count, double width, double room)
{
    static double points[POINTS][3];
    static KrsHit hits[POINTS];
    int           inside = 0, near = 0;
    for (int i = 0; i < POINTS; i++)
        for (int k = 0; k < 3; k++)
            points[i][k] = between(-room, room);
    for (int i = 0; i < POINTS / 2; i++) /* half of them are near to the surface */
        for (int step = 0; step < 30; step++) {
            const double d = nearest(parts, count, points[i]);
            double       way[3];
            for (int k = 0; k < 3; k++) {
                double there[3] = {points[i][0], points[i][1], points[i][2]};
                there[k] += 1e-6;
                way[k] = (nearest(parts, count, there) - d) / 1e-6;
            }
            for (int k = 0; k < 3; k++)
                points[i][k] -= way[k] * (d - (i % 2 ? 1e-5 : -1e-5));
        }
    probe_text(union_text(parts, count, width, "fillet", ""), NULL, 0, points, POINTS, hits);
    for (int i = 0; i < POINTS; i++) {
        const double wanted = nearest(parts, count, points[i]);
        inside += wanted < 0;
        near += fabs(wanted) < 1e-4;
        if (fabs(wanted) > 1e-7)
            assert_true((hits[i].distance < 0) == (wanted < 0));
    }
    assert_true(inside > 0 && near > POINTS / 4);
}

static void abutting_parts_stay(void **state)
{
    (void)state;
    for (int trial = 0; trial < 3; trial++) {
        const double h = between(0.3, 0.8), r = between(0.3, 0.8), w = between(0.1, 0.7);
        const Part boxes[]  = {upright(BOX, -h, 0, 0, h, r, 0.5), upright(BOX, r, 0, 0, r, r, 0.5)};
        const Part rods[]   = {upright(ROD, 0, -h, 0, r, h, 0), upright(ROD, 0, 0.4, 0, r, 0.4, 0)};
        const Part within[] = {upright(BALL, 0, 0, 0, 0.9, 0, 0),
                               upright(BALL, 0, 0.9 - 0.4 * r, 0, 0.4 * r, 0, 0)};
        const Part overlap[] = {upright(CAPSULE, 0, -h, 0, 0.4, h, 0),
                                upright(CAPSULE, 0, 0.8 * h, 0, 0.4, h, 0)};
        assert_unchanged(boxes, 2, w, 1.5);
        assert_unchanged(rods, 2, w, 1.5);
        assert_unchanged(within, 2, w, 1.2);
        assert_unchanged(overlap, 2, w, 1.5);
    }
}

/* All of a wall of bricks, too: each touches many others. */
static void a_wall_stays(void **state)
{
    static Part parts[MOST];
    int         count = 0;
    (void)state;
    for (int i = 0; i < 5; i++)
        for (int j = 0; j < 5; j++)
            for (int k = 0; k < 4; k++)
                parts[count++] = upright(BOX, 0.5 * i - 1, 0.4 * j - 0.8, 0.6 * k - 0.9, 0.25, 0.2,
                                         0.3);
    assert_unchanged(parts, count, 0.15, 1.5);
}

/* ---- level tops ---- */

/* Points above and below the top y = 0.5 of a box and a rod, and on the CSG node; `back` takes them to where a
   scene has it. */
typedef void Back(double p[3]);

static void stay(double p[3]) { (void)p; }
static void back_turned(double p[3])
{
    const double axis[3] = {2. / 3, 1. / 3, 2. / 3};
    double       turned[3];
    turn(axis, 0.8, p, turned);
    for (int k = 0; k < 3; k++)
        p[k] = 1.7 * turned[k] + (k == 0 ? 0.3 : -0.2);
}
static void back_mirrored(double p[3]) { p[0] = 3 - p[0]; }
static void back_stretched(double p[3])
{
    p[0] *= 1.5;
    p[1] *= 0.7;
}

static void assert_level(const char *text, const char *param, double top, Back *back)
{
    static double points[POINTS][3];
    static KrsHit hits[POINTS];
    for (int i = 0; i < POINTS; i++) {
        points[i][0] = between(0.4, 1.3); /* about the seam */
        points[i][1] = 0.5 * top + (i % 2 ? 1e-6 : -1e-6);
        points[i][2] = between(-0.5, 0.5);
        if (i % 2 == 0 && points[i][0] > 1)
            points[i][2] = between(-0.3, 0.3);
        back(points[i]);
    }
    probe_text(text, param, top, points, POINTS, hits);
    for (int i = 0; i < POINTS; i++)
        assert_true((hits[i].distance > 0) == (i % 2 == 1));
}

static void level_tops_stay(void **state)
{
    static const char *const csg_node = "union(box([2, 1, 2]), cylinder(0.5, 1).move([1, 0, 0]), "
                                        "blend: 0.4, kind: \"fillet\")";
    static const struct {
        const char *before, *behind;
        Back       *back;
    } places[] = {
        {"", "", stay},
        {"", ".rotate([2, 1, 2], 0.8).scale(1.7).move([0.3, -0.2, -0.2])", back_turned},
        {"", ".mirror(plane([1, 0, 0], 1.5))", back_mirrored},
        {"", ".scale([1.5, 0.7, 1])", back_stretched},
        {"", ".repeat([9, 9, 9], count: [1, 1, 1])", stay},
        {"sphere(0.1).move([8, 0, 0]) | ", "", stay},
    };
    static const char *const texts[] = {
        /* A part is a union, which is elsewhere higher; or it is moved as a whole, or a box with a hole. */
        "show union(box([2, 1, 2]) | box([0.2, 3, 0.2]).move([-0.8, 0, 0]), cylinder(0.5, "
        "1).move([1, 0, 0]), "
        "blend: 0.4, kind: \"fillet\");",
        "show union((box([2, 1, 2]) | box([0.2, 3, 0.2]).move([-0.8, 0, "
        "0])).paint(#ff0000).move([0, 1, 0]), "
        "cylinder(0.5, 1).move([1, 1, 0]), blend: 0.4, kind: \"fillet\").move([0, -1, 0]);",
        "show union(box([2, 1, 2]) - cylinder(0.2, 3), cylinder(0.5, 1).move([1, 0, 0]), blend: "
        "0.4, "
        "kind: \"fillet\");",
        "show union(box([2, 1, 2]).twist([0, 1, 0], 1e-9), cylinder(0.5, 1).move([1, 0, 0]), "
        "blend: 0.4, "
        "kind: \"fillet\");",
        "show union(rectangle([2, 2]).extrude(1).rotate([1, 0, 0], 90deg), cylinder(0.5, "
        "1).move([1, 0, 0]), "
        "blend: 0.4, kind: \"fillet\");",
        "show union(union(box([1, 1, 2]).move([-0.5, 0, 0]), box([1, 1, 2]).move([0.5, 0, 0]), "
        "blend: 0.2, kind: "
        "\"fillet\"), cylinder(0.5, 1).move([1, 0, 0]), blend: 0.4, kind: \"fillet\");",
        "show union(box([2, 1, 2]), [cylinder(0.5, 1).move([1 - i, 0, 0]) for i in 0..3], "
        "blend: 0.4, kind: "
        "\"fillet\");",
    };
    char text[400];
    (void)state;
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        sprintf(text, "show %s%s%s;", places[i].before, csg_node, places[i].behind);
        assert_level(text, NULL, 1, places[i].back);
    }
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        assert_level(texts[i], NULL, 1, stay);
}

/* Also where a frame knows their heights. */
static void level_tops_stay_in_frames(void **state)
{
    static const char text[] =
        "param h = 1 in [0.4, 3]; show union(box([2, h, 2]), cylinder(0.5, h)"
        ".move([1, 0, 0]), blend: 0.4, kind: \"fillet\");";
    static const char turned[] =
        "param h = 1 in [0.4, 3]; show union(box([2, h, 2]), cylinder(0.5, h)"
        ".move([1, 0, 0]), blend: 0.4, kind: \"fillet\").rotate([0, 0, 1], time);";
    static const double tops[] = {0.4, 0.7, 1, 2.2, 3};
    (void)state;
    for (size_t i = 0; i < sizeof tops / sizeof *tops; i++) {
        assert_level(text, "h", tops[i], stay);
        assert_level(turned, "h", tops[i], stay);
    }
}

/* A CSG node reaches no farther than its parts. */
static void bounds_stay(void **state)
{
    static const char text[] = "let s = union(box([2, 1, 2]), cylinder(0.5, 1).move([1, 0, 0]), "
                               "blend: 0.4, kind: \"fillet\");"
                               "let b = s.bounds(); assert(b[0][0] == -1 and b[0][1] == -0.5 and "
                               "b[1][1] == 0.5 and b[1][0] == 1.5);"
                               "show s;";
    double            point[1][3] = {{0, 0, 0}};
    KrsHit            hit;
    (void)state;
    probe_text(text, NULL, 0, point, 1, &hit);
}

/* ---- arcs ---- */

/* Concave edges at right angles have the arc of a ball of that radius that rolls along both sides: outside of two
   plates, and around a rod on a plate. */
static void edges_have_arcs(void **state)
{
    static double points[POINTS][3];
    static KrsHit hits[POINTS];
    (void)state;
    for (int trial = 0; trial < 6; trial++) {
        const double r      = between(0.1, 0.5);
        const Part   two[2] = {upright(BOX, 0, -0.5, 0, 2, 0.5, 1),
                               upright(BOX, -1.5, 0.5, 0, 0.5, 1, 1)};
        const Part   rod[2] = {upright(BOX, 0, -0.5, 0, 2, 0.5, 2),
                               upright(ROD, 0, 0.5, 0, 1, 1.2, 0)};
        const Part  *parts  = trial % 2 ? rod : two;
        for (int i = 0; i < POINTS; i++) {
            const double angle = between(0, PI / 2), off = i % 2 ? 1e-6 : -1e-6;
            const double away = (trial % 2 ? 1 : -1) + r - (r - off) * cos(angle);
            const double up = r - (r - off) * sin(angle), about = between(0, 2 * PI);
            points[i][0] = trial % 2 ? away * cos(about) : away;
            points[i][1] = up;
            points[i][2] = trial % 2 ? away * sin(about) : between(-0.9, 0.9);
        }
        probe_text(union_text(parts, 2, r, "fillet", ""), NULL, 0, points, POINTS, hits);
        for (int i = 0; i < POINTS; i++) {
            assert_true(fabs(hits[i].distance) < 1.01e-6);
            assert_true((hits[i].distance < 0) == (i % 2 == 0));
        }
    }
}

/* ---- hulls ---- */

/* What a fillet adds to two parts is what the circular blend adds, as far as that is in their hull. */
static void pairs_stay_in_their_hull(void **state)
{
    static double points[POINTS][3];
    static KrsHit hits[POINTS];
    int           added = 0, cut = 0;
    (void)state;
    for (int trial = 0; trial < 2 * PART_KINDS * PART_KINDS; trial++) {
        Part parts[2] = {random_part((PartKind)(trial % PART_KINDS), 0.5),
                         random_part((PartKind)(trial / PART_KINDS % PART_KINDS), 0.5)};
        if (trial / PART_KINDS / PART_KINDS % 2) /* one frame for both */
            set_turn(&parts[1], parts[0].axis, parts[0].angle);
        const double r     = between(0.1, 0.8);
        const bool   rods  = parts[0].kind == ROD || parts[1].kind == ROD;
        const bool   balls = parts[0].kind == BALL || parts[1].kind == BALL ||
                           parts[0].kind == CAPSULE || parts[1].kind == CAPSULE;
        /* Beside columns there are solids with corners instead of circles and balls. */
        const double slack = !rods ? 1e-7 : balls ? 0.025 : 0.006;
        for (int i = 0; i < POINTS; i++)
            for (int tries = 0; tries < 200; tries++) {
                for (int k = 0; k < 3; k++)
                    points[i][k] = between(-1.5, 1.5);
                const double a = distance_to(&parts[0], points[i]),
                             b = distance_to(&parts[1], points[i]);
                if (fmin(a, b) > 0 && circular(a, b, r) < 0)
                    break;
            }
        probe_text(union_text(parts, 2, r, "fillet", ""), NULL, 0, points, POINTS, hits);
        for (int i = 0; i < POINTS; i++) {
            const double a       = distance_to(&parts[0], points[i]),
                         b       = distance_to(&parts[1], points[i]);
            const double blend   = circular(a, b, r),
                         outside = outside_hull(&parts[0], &parts[1], points[i]);
            if (fmin(a, b) < -1e-9)
                assert_true(hits[i].distance < 0);
            if (blend > 1e-9 || (fmin(a, b) > 1e-9 && outside > slack))
                assert_true(hits[i].distance > 0);
            if (blend < -1e-9 && outside < -0.01)
                assert_true(hits[i].distance < 0);
            added += fmin(a, b) > 0 && hits[i].distance < 0;
            cut += fmin(a, b) > 0 && blend < 0 && outside > slack;
        }
    }
    assert_true(added > 800 && cut > 800);
}

/* ---- many ---- */

static int random_instances(Part *parts, int count, double room)
{
    for (int i = 0; i < count; i++) {
        parts[i] = random_part(i % 3 ? BOX : BALL, room);
        for (int k = 0; k < 3; k++)
            parts[i].size[k] *= 0.4;
    }
    return count;
}

static void random_points(const Part *parts, int count, double (*points)[3])
{
    for (int i = 0; i < POINTS; i++) {
        const Part *near = &parts[random_below(&randomness, count)];
        for (int k = 0; k < 3; k++)
            points[i][k] = near->centre[k] + between(-0.4, 0.4);
    }
}

static void order_and_what_is_far_do_not_show(void **state)
{
    static double points[POINTS][3];
    static KrsHit before[POINTS], after[POINTS];
    static Part   parts[MOST];
    (void)state;
    for (int trial = 0; trial < 4; trial++) {
        const int    count = random_instances(parts, trial % 2 ? 3 : 12, 0.5);
        const double r     = between(0.05, 0.3);
        random_points(parts, count, points);
        probe_text(union_text(parts, count, r, "fillet", ""), NULL, 0, points, POINTS, before);
        for (int i = 0; i < count / 2; i++) {
            const Part part      = parts[i];
            parts[i]             = parts[count - 1 - i];
            parts[count - 1 - i] = part;
        }
        parts[count] = upright(BOX, 1000, 0, 0, 1, 1, 1);
        probe_text(union_text(parts, count + 1, r, "fillet", ""), NULL, 0, points, POINTS, after);
        for (int i = 0; i < POINTS; i++)
            assert_true(fabs(before[i].distance - after[i].distance) < 1e-12);
    }
}

/* Takes the least over each two of many; 100 that are alike become an instance group. */
static double min_pair(const Part *parts, int count, double r, const double p[3], bool hulls)
{
    double d[MOST], least = HUGE_VAL;
    for (int i = 0; i < count; i++)
        d[i] = distance_to(&parts[i], p);
    for (int a = 0; a < count; a++)
        for (int b = a + 1; b < count; b++) {
            const double blend = circular(d[a], d[b], r);
            if (blend < 1e-3)
                least = fmin(least,
                             hulls ? fmax(blend, outside_hull(&parts[a], &parts[b], p)) : blend);
        }
    return least;
}

static void many_are_all_pairs(void **state)
{
    static double points[POINTS][3];
    static KrsHit hits[POINTS];
    static Part   parts[MOST];
    const double  r     = 0.12;
    int           added = 0, cut = 0;
    (void)state;
    for (int trial = 0; trial < 4; trial++) {
        const int count = trial < 3 ? random_instances(parts, 3 + 4 * trial, 0.4) : 100;
        for (int i = 0; i < count; i++)
            if (trial < 3)
                parts[i].kind = BOX;
            else /* a town of towers that touch each other */
                parts[i] = upright(BOX, 0.4 * (i % 10), 0, 0.5 * (i / 10), 0.2, between(0.2, 0.5),
                                   0.25);
        for (int i = 0; i < POINTS; i++)
            for (int tries = 0; tries < 300; tries++) {
                for (int k = 0; k < 3; k++)
                    points[i][k] = parts[i % count].centre[k] + between(-0.5, 0.5);
                if (i % 4 == 0 || (nearest(parts, count, points[i]) > 0 &&
                                   min_pair(parts, count, r, points[i], false) < 0))
                    break;
            }
        probe_text(union_text(parts, count, r, "fillet", ""), NULL, 0, points, POINTS, hits);
        for (int i = 0; i < POINTS; i++) {
            const double least = nearest(parts, count, points[i]);
            const double pair  = min_pair(parts, count, r, points[i], true);
            if (fabs(fmin(least, pair)) < 1e-3)
                continue;
            assert_true((hits[i].distance < 0) == (fmin(least, pair) < 0));
            added += least > 0 && pair < 0;
            cut += least > 0 && pair > 0 && pair < HUGE_VAL;
        }
    }
    assert_true(added > 150 && cut > 20);
}

/* Two sides of a step differ by no more than its length. */
static void slopes_hold(void **state)
{
    static double points[POINTS][3];
    static KrsHit hits[POINTS];
    static Part   parts[MOST];
    (void)state;
    for (int trial = 0; trial < 12; trial++) {
        const int count = trial % 3 ? 2 : 6;
        for (int i = 0; i < count; i++)
            parts[i] = random_part((PartKind)((trial + i * (trial / 4)) % PART_KINDS), 0.4);
        random_points(parts, count, points);
        for (int i = 0; i < POINTS; i += 2)
            for (int k = 0; k < 3; k++)
                points[i + 1][k] = points[i][k] + between(-1, 1) * (i % 4 ? 1e-3 : 0.3);
        probe_text(union_text(parts, count, between(0.1, 0.8), "fillet", ""), NULL, 0, points,
                   POINTS, hits);
        for (int i = 0; i < POINTS; i += 2) {
            double square = 0;
            for (int k = 0; k < 3; k++)
                square += pow(points[i][k] - points[i + 1][k], 2);
            assert_true(fabs(hits[i].distance - hits[i + 1].distance) <=
                        sqrt(square) * (1 + 1e-9) + 1e-13);
        }
    }
}

/* ---- colours ---- */

/* Across the CSG node of level tops colours mix as those of circular blends do; the cut has none of its own. */
static void colours_mix(void **state)
{
    static const char text[] =
        "show union(box([2, 1, 2]).paint(#ff0000), box([2, 1, 2]).move([2, 0, 0]).paint(#0000ff), "
        "blend: 0.4, kind: \"%s\");";
    double points[3][3] = {{0.2, 0.5, 0}, {1, 0.5, 0}, {1.8, 0.5, 0}};
    KrsHit hits[3];
    char   scene[300];
    (void)state;
    for (int circles = 0; circles < 2; circles++) {
        sprintf(scene, text, circles ? "circular" : "fillet");
        probe_text(scene, NULL, 0, points, 3, hits);
        for (int k = 0; k < 3; k++) {
            assert_true(fabs(hits[0].color[k] - (k == 0)) < 1e-9);
            assert_true(fabs(hits[1].color[k] - (k == 1 ? 0 : 0.5)) < 1e-9);
            assert_true(fabs(hits[2].color[k] - (k == 2)) < 1e-9);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(abutting_parts_stay),
        cmocka_unit_test(a_wall_stays),
        cmocka_unit_test(level_tops_stay),
        cmocka_unit_test(level_tops_stay_in_frames),
        cmocka_unit_test(bounds_stay),
        cmocka_unit_test(edges_have_arcs),
        cmocka_unit_test(pairs_stay_in_their_hull),
        cmocka_unit_test(order_and_what_is_far_do_not_show),
        cmocka_unit_test(many_are_all_pairs),
        cmocka_unit_test(slopes_hold),
        cmocka_unit_test(colours_mix),
    };
    return cmocka_run_group_tests_name("fillets", tests, NULL, NULL);
}
