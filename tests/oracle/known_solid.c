/*
 * known_solid.c: random trees of solids, their texts and what is inside of them.
 */
#include "tests/oracle/known_solid.h"

#include <stdlib.h>

typedef enum Kind {
    KNOWN_SPHERE,   /* a[0]: radius */
    KNOWN_BOX,      /* a: sides */
    KNOWN_TORUS,    /* a[0], a[1]: radii */
    KNOWN_CAPSULE,  /* a, b: ends; number: radius */
    KNOWN_CYLINDER, /* a[0]: radius, a[1]: height */
    KNOWN_PRIMITIVES,
    KNOWN_GYROID = KNOWN_PRIMITIVES, /* a[0]: factor of the coordinates; a[1]: of a ball around */
    KNOWN_QUARTIC,                   /* x^4 + y^4 + z^4 = number */
    KNOWN_CSG_NODE,                  /* of two; `choice` is one of CSG nodes, number the width */
    KNOWN_SHELL,                     /* number: thickness */
    KNOWN_ROUND,                     /* of a box; number: radius */
    KNOWN_MOVE,                      /* by a */
    KNOWN_ROTATE,                    /* about a, by number */
    KNOWN_SCALE,                     /* by number */
    KNOWN_MIRROR,                    /* in the plane of the normal a and offset number */
    KNOWN_SEQUENCE,                  /* of a kernel and `choice` mirrors: normals and offsets */
} Kind;

enum { MAX_MIRRORS = 3 };

struct KnownSolid {
    Kind        kind;
    KnownSolid *parts[2];
    Vec         a, b;
    double      number;
    int         choice;
    Half        mirrors[MAX_MIRRORS];
};

typedef enum CsgNode { JOIN_UNION, JOIN_INTERSECTION, JOIN_DIFFERENCE, CSG_NODES } CsgNode;
static const char *const csg_node_names[CSG_NODES] = {"union", "intersection", "difference"};
static const char *const blend_names[]             = {"quadratic", "cubic", "circular", "chamfer"};
enum { BLENDS = sizeof blend_names / sizeof *blend_names };

/* ---- what is inside ---- */

static double distance_to_box(Vec p, Vec sides)
{
    double x = fabs(p.x) - sides.x / 2, y = fabs(p.y) - sides.y / 2, z = fabs(p.z) - sides.z / 2;
    return vec_length(vec(fmax(x, 0), fmax(y, 0), fmax(z, 0))) + fmin(fmax(x, fmax(y, z)), 0);
}

static double distance_to_capsule(Vec p, Vec from, Vec to, double radius)
{
    Vec    along = vec_sub(to, from);
    double t     = vec_dot(vec_sub(p, from), along) / vec_dot(along, along);
    return vec_distance(p, vec_mix(from, to, fmax(0, fmin(t, 1)))) - radius;
}

static double distance_to_cylinder(Vec p, double radius, double height)
{
    double out = hypot(p.x, p.z) - radius, over = fabs(p.y) - height / 2;
    return hypot(fmax(out, 0), fmax(over, 0)) + fmin(fmax(out, over), 0);
}

static double gyroid(Vec p, double k)
{
    return sin(k * p.x) * cos(k * p.y) + sin(k * p.y) * cos(k * p.z) + sin(k * p.z) * cos(k * p.x);
}

/* Returns the CSG node of two distances with a rounded edge k wide, as blends.def says in words. */
static double blended_union(double a, double b, double k, int blend)
{
    double h = fmax(1 - fabs(a - b) / k, 0);
    switch (blend) {
    case 0: return fmin(a, b) - k * h * h / 4;
    case 1: return fmin(a, b) - k * h * h * h / 6;
    case 2: return fmax(k, fmin(a, b)) - hypot(fmax(k - a, 0), fmax(k - b, 0));
    default: return fmin(fmin(a, b), (a + b - k) / sqrt(2));
    }
}

static double joined(const KnownSolid *solid, double a, double b)
{
    CsgNode csg_node = (CsgNode)(solid->choice % CSG_NODES);
    int     blend    = solid->choice / CSG_NODES % BLENDS;
    double  k        = solid->number;
    if (csg_node == JOIN_UNION)
        return k > 0 ? blended_union(a, b, k, blend) : fmin(a, b);
    b = csg_node == JOIN_DIFFERENCE ? -b : b;
    return k > 0 ? -blended_union(-a, -b, k, blend) : fmax(a, b);
}

static Vec mirrored(Half mirror, Vec p)
{
    return vec_sub(p, vec_scale(2 * half_excess(mirror, p), mirror.normal));
}

/* Returns the value of the set after so many mirrors: what the last one keeps, and its image. */
static double value_of_sequence(const KnownSolid *solid, int mirrors, Vec p)
{
    if (mirrors == 0)
        return known_solid_value(solid->parts[0], p);
    Half last = solid->mirrors[mirrors - 1];
    return value_of_sequence(solid, mirrors - 1, half_excess(last, p) <= 0 ? p : mirrored(last, p));
}

double known_solid_value(const void *user, Vec p)
{
    const KnownSolid *s = user, *part = s->parts[0];
    switch (s->kind) {
    case KNOWN_SPHERE: return vec_length(p) - s->a.x;
    case KNOWN_BOX: return distance_to_box(p, s->a);
    case KNOWN_TORUS: return hypot(hypot(p.x, p.z) - s->a.x, p.y) - s->a.y;
    case KNOWN_CAPSULE: return distance_to_capsule(p, s->a, s->b, s->number);
    case KNOWN_CYLINDER: return distance_to_cylinder(p, s->a.x, s->a.y);
    case KNOWN_GYROID: return fmax(gyroid(p, s->a.x), vec_length(p) - s->a.y);
    case KNOWN_QUARTIC:
        return fmax(p.x * p.x * p.x * p.x + p.y * p.y * p.y * p.y + p.z * p.z * p.z * p.z -
                        s->number,
                    distance_to_box(p, vec(2, 2, 2)));
    case KNOWN_CSG_NODE:
        return joined(s, known_solid_value(part, p), known_solid_value(s->parts[1], p));
    case KNOWN_SHELL: return fabs(known_solid_value(part, p)) - s->number / 2;
    case KNOWN_ROUND:
        return distance_to_box(p,
                               vec_sub(part->a, vec(2 * s->number, 2 * s->number, 2 * s->number))) -
               s->number;
    case KNOWN_MOVE: return known_solid_value(part, vec_sub(p, s->a));
    case KNOWN_ROTATE: return known_solid_value(part, vec_rotate(p, s->a, -s->number));
    case KNOWN_SCALE: return s->number * known_solid_value(part, vec_scale(1 / s->number, p));
    case KNOWN_MIRROR: {
        Half mirror = {s->a, s->number};
        return known_solid_value(part, half_excess(mirror, p) <= 0 ? p : mirrored(mirror, p));
    }
    case KNOWN_SEQUENCE: return value_of_sequence(s, s->choice, p);
    }
    return 0;
}

/* ---- text ---- */

static void write_vec(SceneText *text, const char *before, Vec v, const char *after)
{
    scene_write(text, "%s[%.17g, %.17g, %.17g]%s", before, v.x, v.y, v.z, after);
}

static void write_csg_node(const KnownSolid *s, SceneText *text)
{
    scene_write(text, "%s(", csg_node_names[s->choice % CSG_NODES]);
    known_solid_write(s->parts[0], text);
    scene_write(text, ",\n  ");
    known_solid_write(s->parts[1], text);
    if (s->number > 0)
        scene_write(text, ", blend: %.17g, kind: \"%s\"", s->number,
                    blend_names[s->choice / CSG_NODES % BLENDS]);
    scene_write(text, ")");
}

static void write_sequence(const KnownSolid *s, SceneText *text)
{
    scene_write(text, "krs { kernel ");
    known_solid_write(s->parts[0], text);
    scene_write(text, ";");
    for (int i = 0; i < s->choice; i++) {
        write_vec(text, " reflect plane(", s->mirrors[i].normal, ", ");
        scene_write(text, "%.17g);", s->mirrors[i].offset);
    }
    scene_write(text, " }");
}

static void write_leaf(const KnownSolid *s, SceneText *text)
{
    const double k = s->a.x;
    switch (s->kind) {
    case KNOWN_SPHERE: scene_write(text, "sphere(%.17g)", k); break;
    case KNOWN_BOX: write_vec(text, "box(", s->a, ")"); break;
    case KNOWN_TORUS: scene_write(text, "torus(%.17g, %.17g)", k, s->a.y); break;
    case KNOWN_CYLINDER: scene_write(text, "cylinder(%.17g, %.17g)", k, s->a.y); break;
    case KNOWN_CAPSULE:
        write_vec(text, "capsule(", s->a, ", ");
        write_vec(text, "", s->b, "");
        scene_write(text, ", %.17g)", s->number);
        break;
    case KNOWN_GYROID:
        scene_write(text,
                    "field(sin(%.17g * x) * cos(%.17g * y) + sin(%.17g * y) * cos(%.17g * z) + "
                    "sin(%.17g * z) * cos(%.17g * x)).within(sphere(%.17g))",
                    k, k, k, k, k, k, s->a.y);
        break;
    default:
        scene_write(text, "algebraic(x^4 + y^4 + z^4 == %.17g).within(box([2, 2, 2]))", s->number);
        break;
    }
}

void known_solid_write(const KnownSolid *s, SceneText *text)
{
    if (!s->parts[0])
        write_leaf(s, text);
    else if (s->kind == KNOWN_CSG_NODE)
        write_csg_node(s, text);
    else if (s->kind == KNOWN_SEQUENCE)
        write_sequence(s, text);
    else
        known_solid_write(s->parts[0], text);
    switch (s->kind) {
    case KNOWN_SHELL: scene_write(text, ".shell(%.17g)", s->number); break;
    case KNOWN_ROUND: scene_write(text, ".round(%.17g)", s->number); break;
    case KNOWN_MOVE: write_vec(text, ".move(", s->a, ")"); break;
    case KNOWN_SCALE: scene_write(text, ".scale(%.17g)", s->number); break;
    case KNOWN_ROTATE:
        write_vec(text, ".rotate(", s->a, ", ");
        scene_write(text, "%.17g)", s->number);
        break;
    case KNOWN_MIRROR:
        write_vec(text, ".mirror(plane(", s->a, ", ");
        scene_write(text, "%.17g))", s->number);
        break;
    default: break;
    }
}

/* ---- at random ---- */

static KnownSolid *make(Kind kind, KnownSolid *part)
{
    KnownSolid *solid = calloc(1, sizeof *solid);
    assert_non_null(solid);
    solid->kind     = kind;
    solid->parts[0] = part;
    return solid;
}

static KnownSolid *moved(Random *random, double size, KnownSolid *part)
{
    KnownSolid *solid = make(KNOWN_MOVE, part);
    solid->a          = random_in_cube(random, size);
    return solid;
}

/* Returns one that has a distance, about as large as 1; some are plates. */
static KnownSolid *primitive(Random *random, double thick)
{
    KnownSolid *s = make((Kind)random_below(random, KNOWN_PRIMITIVES), NULL);
    double      r = random_between(random, 0.3, 0.6), t = random_between(random, 0.1, 0.2);
    bool        plate = random_below(random, 3) == 0;
    s->a              = vec(r, random_between(random, 0.5, 1), random_between(random, 0.4, 1));
    switch (s->kind) {
    case KNOWN_TORUS: s->a.y = t; break;
    case KNOWN_CAPSULE:
        s->b      = vec_scale(-1, s->a);
        s->number = t;
        break;
    case KNOWN_BOX: s->a = vec(plate ? 1.2 * thick : 2 * r, s->a.y, s->a.z); break;
    default: break;
    }
    return s;
}

static KnownSolid *placed(Random *random, KnownSolid *part)
{
    KnownSolid *turn = make(KNOWN_ROTATE, part);
    turn->a          = random_unit(random);
    turn->number     = random_between(random, -3, 3);
    if (random_below(random, 3) == 0) {
        KnownSolid *scale = make(KNOWN_SCALE, turn);
        scale->number     = random_between(random, 1, 1.4);
        turn              = scale;
    }
    return random_below(random, 2) ? moved(random, 0.3, turn) : turn;
}

static KnownSolid *shell_or_round(Random *random, double thick)
{
    KnownSolid *part = make(random_below(random, 2) ? KNOWN_SPHERE : KNOWN_BOX, NULL);
    part->a          = vec(0.6, 0.7, 0.8);
    KnownSolid *s    = make(
           part->kind == KNOWN_BOX && random_below(random, 2) ? KNOWN_ROUND : KNOWN_SHELL, part);
    s->number = s->kind == KNOWN_ROUND ? random_between(random, 0.05, 0.25) : 1.2 * thick;
    return s;
}

static KnownSolid *formula(Random *random)
{
    KnownSolid *s = make(random_below(random, 2) ? KNOWN_GYROID : KNOWN_QUARTIC, NULL);
    s->a          = vec(random_between(random, 2.5, 4), random_between(random, 0.6, 0.9), 0);
    s->number     = random_between(random, 0.1, 0.5);
    return s;
}

static KnownSolid *csg_node(Random *random, double width, KnownSolid *a, KnownSolid *b)
{
    KnownSolid *s = make(KNOWN_CSG_NODE, a);
    s->parts[1]   = b;
    s->choice     = random_below(random, CSG_NODES * BLENDS);
    s->number     = width;
    return s;
}

static KnownSolid *sequence(Random *random, KnownSolid *kernel)
{
    KnownSolid *s = make(KNOWN_SEQUENCE, kernel);
    s->choice     = 1 + random_below(random, MAX_MIRRORS);
    for (int i = 0; i < s->choice; i++)
        s->mirrors[i] = (Half){random_unit(random), random_between(random, 0.1, 0.3)};
    return s;
}

static KnownSolid *simple(Random *random, double thick)
{
    KnownSolid *a = placed(random, primitive(random, thick));
    switch (random_below(random, 6)) {
    case 0: known_solid_free(a); return placed(random, shell_or_round(random, thick));
    case 1: known_solid_free(a); return placed(random, formula(random));
    case 2:
    case 3:
        return csg_node(random, random_between(random, 0.05, 0.3), a,
                        placed(random, primitive(random, thick)));
    default: return a;
    }
}

KnownSolid *known_solid_random(Random *random, double thick)
{
    KnownSolid *s = simple(random, thick), *mirror;
    switch (random_below(random, 5)) {
    case 0: return s;
    case 1: return sequence(random, moved(random, 0.3, s));
    case 2:
        mirror         = make(KNOWN_MIRROR, moved(random, 0.4, s));
        mirror->a      = random_unit(random);
        mirror->number = random_between(random, 0, 0.2);
        return mirror;
    default: return csg_node(random, 0, s, moved(random, 0.4, simple(random, thick)));
    }
}

void known_solid_free(KnownSolid *solid)
{
    if (!solid)
        return;
    known_solid_free(solid->parts[0]);
    known_solid_free(solid->parts[1]);
    free(solid);
}
