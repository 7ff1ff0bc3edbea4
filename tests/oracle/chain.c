/*
 * chain.c: texts of random solids, what is inside of them, and their parameters.
 */
#include "tests/oracle/chain.h"

#include <stdio.h>

static const double PI = 3.14159265358979323846;

const char *const link_names[LINK_KINDS] = {
    "box",    "ball",         "rod",        "ring", "capsule",  "grown",    "hollow",  "wavy",
    "blend",  "polynomial",   "figure",     "move", "turn",     "scale",    "stretch", "mirror",
    "repeat", "polar",        "twist",      "bend", "taper",    "elongate", "invert",  "within",
    "union",  "intersection", "difference", "xor",  "sequence", "mobius"};

/* ---- what is inside ---- */

static double box_depth(Vec p, Vec half)
{
    double x = fabs(p.x) - half.x, y = fabs(p.y) - half.y, z = fabs(p.z) - half.z;
    return vec_length(vec(fmax(x, 0), fmax(y, 0), fmax(z, 0))) + fmin(fmax(x, fmax(y, z)), 0);
}

static double segment_distance(Vec p, Vec to)
{
    double t = vec_dot(p, to) / vec_dot(to, to);
    return vec_distance(p, vec_scale(fmin(fmax(t, 0), 1), to));
}

/* Returns the quadratic blend of two distances. */
static double blended(double a, double b, double width)
{
    double h = fmax(width - fabs(a - b), 0) / width;
    return fmin(a, b) - h * h * width / 4;
}

static double square(double x) { return x * x; }

/* An L around the origin. */
static bool in_figure(Vec p, Vec v)
{
    p = vec_add(p, vec(0.3 * v.x, 0.3 * v.y, 0));
    return p.x >= 0 && p.y >= 0 && p.x <= v.x && p.y <= v.y &&
           (p.x <= 0.4 * v.x || p.y <= 0.4 * v.y);
}

static bool primitive_contains(const Link *link, Vec p)
{
    Vec    v = link->v;
    double n = link->number;
    switch (link->kind) {
    case LINK_BALL: return vec_length(p) <= n;
    case LINK_ROD: return hypot(p.x, p.z) <= n && fabs(p.y) <= v.y;
    case LINK_RING: return hypot(hypot(p.x, p.z) - v.x, p.y) <= n;
    case LINK_CAPSULE: return segment_distance(p, v) <= n;
    case LINK_GROWN: return box_depth(p, v) <= n;
    case LINK_HOLLOW: return fabs(box_depth(p, v)) <= n;
    case LINK_WAVY: return box_depth(p, v) <= n * sin(4 * p.x + p.y);
    case LINK_BLEND: return blended(box_depth(p, v), vec_distance(p, link->w) - 0.4, n) <= 0;
    case LINK_POLYNOMIAL: return square(p.x / v.x) + square(p.y / v.y) + square(p.z / v.z) < n;
    case LINK_FIGURE: return fabs(p.z) <= n && in_figure(p, v);
    default: return box_depth(p, v) <= 0;
    }
}

/* What stands upright for an axis of a bend, and the direction to which it bends. */
static void bend_frame(Vec axis, Vec *along, Vec *lateral)
{
    Vec up   = fabs(axis.y) > 0.999 ? vec(1, 0, 0) : vec(0, 1, 0);
    *along   = vec_unit(vec_sub(up, vec_scale(vec_dot(up, axis), axis)));
    *lateral = vec_cross(axis, *along);
}

/* Returns where a point was before it was bent; `turn` counts turns about the axis of the bend. */
static Vec unbent(const Link *link, Vec p, int turn)
{
    Vec along, lateral;
    bend_frame(link->v, &along, &lateral);
    double rate = link->number, side = rate > 0 ? 1 : -1;
    double y = vec_dot(p, along), z = vec_dot(p, lateral);
    double angle  = atan2(side * y, side * (1 / rate - z)) + 2 * PI * turn;
    double radius = hypot(y, 1 / rate - z);
    Vec    flat   = vec_add(vec_scale(angle / rate, along),
                            vec_scale(1 / rate - side * radius, lateral));
    return vec_add(vec_scale(vec_dot(p, link->v), link->v), flat);
}

static Vec untapered(const Link *link, Vec p)
{
    double t       = (vec_dot(p, link->v) - link->low) / (link->high - link->low);
    double factor  = link->number + (link->w.x - link->number) * fmin(fmax(t, 0), 1);
    Vec    on_axis = vec_scale(vec_dot(p, link->v), link->v);
    return vec_add(on_axis, vec_scale(1 / factor, vec_sub(p, on_axis)));
}

static double pulled(double x, double length) { return x - fmax(-length / 2, fmin(x, length / 2)); }

static Vec folded(const Link *link, Vec p)
{
    double excess = vec_dot(link->v, p) - link->number;
    return vec_sub(p, vec_scale(2 * fmax(excess, 0), link->v));
}

/* Returns the point before a method that is undone in one way only. */
static Vec undone(const Link *link, Vec p)
{
    Vec v = link->v;
    switch (link->kind) {
    case LINK_MOVE: return vec_sub(p, vec(link->number, v.y, v.z));
    case LINK_TURN: return vec_rotate(p, v, -link->number);
    case LINK_SCALE: return vec_scale(1 / link->number, p);
    case LINK_STRETCH: return vec(p.x / link->number, p.y / v.y, p.z / v.z);
    case LINK_MIRROR:
    case LINK_SEQUENCE: return folded(link, p);
    case LINK_TWIST: return vec_rotate(p, v, -link->number * vec_dot(p, vec_unit(v)));
    case LINK_TAPER: return untapered(link, p);
    case LINK_ELONGATE: return vec(pulled(p.x, v.x), pulled(p.y, v.y), pulled(p.z, v.z));
    default: {
        Vec offset = vec_sub(p, v); /* INVERT, MOBIUS */
        return vec_add(v, vec_scale(square(link->number) / vec_dot(offset, offset), offset));
    }
    }
}

static bool contains(const Chain *chain, int at, Vec p);

static bool in_copies(const Chain *chain, const Link *link, Vec p)
{
    int counts[3] = {(int)link->w.x, (int)link->w.y, (int)link->w.z};
    for (int i = 0; i < counts[0]; i++)
        for (int j = 0; j < counts[1]; j++)
            for (int k = 0; k < counts[2]; k++) {
                Vec shift = vec(link->v.x * (i - 0.5 * (counts[0] - 1)),
                                link->v.y * (j - 0.5 * (counts[1] - 1)),
                                link->v.z * (k - 0.5 * (counts[2] - 1)));
                if (contains(chain, link->solids[0], vec_sub(p, shift)))
                    return true;
            }
    return false;
}

static bool around(const Chain *chain, const Link *link, Vec p)
{
    int count = (int)link->w.x;
    for (int i = 0; i < count; i++)
        if (contains(chain, link->solids[0], vec_rotate(p, link->v, 2 * PI * i / count)))
            return true;
    return false;
}

/* As many turns about the axis, either way, as lead back to what was there before: points farther
   out on the line that was bent are outside of it. */
static bool in_bent(const Chain *chain, const Link *link, Vec p)
{
    int turns = (int)((link->high * fabs(link->number) / PI + 1) / 2);
    for (int turn = -turns; turn <= turns; turn++)
        if (contains(chain, link->solids[0], unbent(link, p, turn)))
            return true;
    return false;
}

static bool contains(const Chain *chain, int at, Vec p)
{
    const Link *link = &chain->links[at];
    int         a = link->solids[0], b = link->solids[1];
    if (link->kind < LINK_PRIMITIVES)
        return primitive_contains(link, p);
    switch (link->kind) {
    case LINK_REPEAT: return in_copies(chain, link, p);
    case LINK_POLAR: return around(chain, link, p);
    case LINK_BEND: return in_bent(chain, link, p);
    case LINK_WITHIN: return vec_distance(p, link->w) <= link->number && contains(chain, a, p);
    case LINK_UNION: return contains(chain, a, p) || contains(chain, b, p);
    case LINK_INTERSECTION: return contains(chain, a, p) && contains(chain, b, p);
    case LINK_DIFFERENCE: return contains(chain, a, p) && !contains(chain, b, p);
    case LINK_XOR: return contains(chain, a, p) != contains(chain, b, p);
    case LINK_SEQUENCE:
    case LINK_MOBIUS: return contains(chain, a, undone(link, p)) || contains(chain, b, p);
    default: return contains(chain, a, undone(link, p));
    }
}

bool chain_contains(const void *chain, Vec point)
{
    const Chain *c = chain;
    return contains(c, c->root, point);
}

/* ---- texts ---- */

/* Returns the number of a link: a literal, or its parameter. */
static const char *number_text(const Chain *chain, const Link *link, char text[32])
{
    if (link->moves)
        snprintf(text, 32, "p%d", (int)(link - chain->links));
    else
        snprintf(text, 32, "%.17g", link->number);
    return text;
}

static void write_primitive(const Chain *chain, const Link *link, SceneText *text)
{
    char        number[32];
    Vec         v = link->v, s = vec_scale(2, v), w = link->w;
    const char *n = number_text(chain, link, number);
    switch (link->kind) {
    case LINK_BALL: scene_write(text, "sphere(%s)", n); return;
    case LINK_ROD: scene_write(text, "cylinder(%s, %.17g)", n, s.y); return;
    case LINK_RING: scene_write(text, "torus(%.17g, %s)", v.x, n); return;
    case LINK_CAPSULE:
        scene_write(text, "capsule([0, 0, 0], [%.17g, %.17g, %.17g], %s)", v.x, v.y, v.z, n);
        return;
    case LINK_POLYNOMIAL:
        scene_write(text, "algebraic(x^2 * %.17g + y^2 * %.17g + z^2 * %.17g == %s)",
                    1 / (v.x * v.x), 1 / (v.y * v.y), 1 / (v.z * v.z), n);
        return;
    case LINK_FIGURE:
        scene_write(text,
                    "polygon([[-0.3, -0.3], [0.7, -0.3], [0.7, 0.1], [0.1, 0.1], [0.1, 0.7], "
                    "[-0.3, 0.7]]).scale([%.17g, %.17g, 1]).extrude(2 * %s)",
                    v.x, v.y, n);
        return;
    default: break;
    }
    if (link->kind == LINK_BLEND)
        scene_write(text, "union(sphere(0.4).move([%.17g, %.17g, %.17g]), ", w.x, w.y, w.z);
    scene_write(text, "box([%.17g, %.17g, %.17g])", s.x, s.y, s.z);
    if (link->kind == LINK_GROWN)
        scene_write(text, ".offset(%s)", n);
    if (link->kind == LINK_HOLLOW)
        scene_write(text, ".shell(2 * %s)", n);
    if (link->kind == LINK_WAVY)
        scene_write(text, ".displace(sin(4 * x + y), %s)", n);
    if (link->kind == LINK_BLEND)
        scene_write(text, ", blend: %s)", n);
}

static void write_method(const Chain *chain, const Link *link, SceneText *text)
{
    char        number[32];
    Vec         v = link->v, w = link->w, axis = vec_scale(link->length, v);
    const char *n = number_text(chain, link, number);
    switch (link->kind) {
    case LINK_MOVE: scene_write(text, ".move([%s, %.17g, %.17g])", n, v.y, v.z); return;
    case LINK_SCALE: scene_write(text, ".scale(%s)", n); return;
    case LINK_STRETCH: scene_write(text, ".scale([%s, %.17g, %.17g])", n, v.y, v.z); return;
    case LINK_ELONGATE:
        scene_write(text, ".elongate([%.17g, %.17g, %.17g])", v.x, v.y, v.z);
        return;
    case LINK_WITHIN:
        scene_write(text, ".within(sphere(%s).move([%.17g, %.17g, %.17g]))", n, w.x, w.y, w.z);
        return;
    case LINK_REPEAT:
        scene_write(text, ".repeat([%.17g, %.17g, %.17g], [%g, %g, %g])", v.x, v.y, v.z, w.x, w.y,
                    w.z);
        return;
    case LINK_MIRROR:
        scene_write(text, ".mirror(plane([%.17g, %.17g, %.17g], %s))", v.x, v.y, v.z, n);
        return;
    case LINK_INVERT:
        scene_write(text, ".transform(invert([%.17g, %.17g, %.17g], %s))", v.x, v.y, v.z, n);
        return;
    case LINK_POLAR:
        scene_write(text, ".repeat_polar(%g, [%.17g, %.17g, %.17g])", w.x, axis.x, axis.y, axis.z);
        return;
    default: break;
    }
    scene_write(text, ".%s([%.17g, %.17g, %.17g], %s",
                link->kind == LINK_TURN    ? "rotate"
                : link->kind == LINK_TWIST ? "twist"
                : link->kind == LINK_BEND  ? "bend"
                                           : "taper",
                axis.x, axis.y, axis.z, n);
    if (link->kind == LINK_TAPER)
        scene_write(text, ", %.17g", w.x);
    scene_write(text, ")");
}

static void write_link(const Chain *chain, int at, SceneText *text)
{
    static const char *const csg_nodes[] = {"union", "intersection", "difference", "xor"};
    const Link              *link        = &chain->links[at];
    char                     number[32];
    if (link->kind < LINK_PRIMITIVES) {
        write_primitive(chain, link, text);
        return;
    }
    if (link->kind < LINK_METHODS) {
        write_link(chain, link->solids[0], text);
        write_method(chain, link, text);
        return;
    }
    bool sequence = link->kind == LINK_SEQUENCE || link->kind == LINK_MOBIUS;
    scene_write(text, sequence ? "krs { kernel " : "%s(",
                sequence ? "" : csg_nodes[link->kind - LINK_METHODS]);
    write_link(chain, link->solids[0], text);
    if (sequence)
        scene_write(text, "; %s([%.17g, %.17g, %.17g], %s); kernel ",
                    link->kind == LINK_MOBIUS ? "mobius invert" : "reflect plane", link->v.x,
                    link->v.y, link->v.z, number_text(chain, link, number));
    else
        scene_write(text, ", ");
    write_link(chain, link->solids[1], text);
    scene_write(text, sequence ? "; }" : ")");
}

void chain_write(const Chain *chain, SceneText *text)
{
    for (int i = 0; i < chain->count; i++) {
        const Link *link = &chain->links[i];
        if (link->moves)
            scene_write(text, "param p%d = %.17g in [%.17g, %.17g];\n", i, link->number,
                        link->least, link->most);
    }
    scene_write(text, "show ");
    write_link(chain, chain->root, text);
    scene_write(text, ";\n");
}

/* ---- parameters ---- */

void chain_move(Chain *chain, const Product *product, const Product *other, Random *random)
{
    for (int i = 0; i < chain->count; i++) {
        Link *link = &chain->links[i];
        char  name[32];
        if (!link->moves)
            continue;
        number_text(chain, link, name);
        link->number = random_between(random, link->least, link->most);
        assert_int_equal(krs_state_set(product->state, name, &link->number, 1), KRS_OK);
        if (other->state)
            assert_int_equal(krs_state_set(other->state, name, &link->number, 1), KRS_OK);
    }
}
