/*
 * methods.c: families of shapes, methods of shapes, and how a method is undone on points.
 */
#include "tests/oracle/methods.h"

static const double PI = 3.14159265358979323846;

/* ---- families ---- */

const char prelude[] =
    "let tool = sphere(0.6).move([0.35, 0.25, 0.1]);\n"
    "let block = box([0.9, 0.6, 0.7]).rotate([1, 2, 0], 0.4).move([-0.2, 0.1, 0]);\n"
    "let lump = algebraic((x - 0.2)^2 + 2 * y^2 + z^2 == 0.4);\n";

const Family families[] = {
    {"sphere", "sphere(0.5).move([0.3, 0.1, 0.2])"},
    {"box", "block"},
    {"cylinder", "cylinder(0.4, 0.9)"},
    {"cone", "cone(0.5, 0.9)"},
    {"capped cone", "capped_cone(0.5, 0.2, 0.8)"},
    {"capsule", "capsule([-0.3, -0.2, 0], [0.4, 0.5, 0.2], 0.2)"},
    {"round cone", "round_cone([0, -0.4, 0], [0.2, 0.4, 0], 0.4, 0.15)"},
    {"arc", "arc_capsule([-0.6, -0.3, 0], [0, 0.4, 0], [0.6, -0.2, 0.1], 0.2, 0.05)"},
    {"torus", "torus(0.6, 0.2)"},
    {"ellipsoid", "ellipsoid([0.8, 0.5, 0.3])"},
    {"link", "link(0.5, 0.4, 0.12)"},
    {"octahedron", "octahedron(0.8)"},
    {"hull of points", "hull([[0, 1, 0], [-1, 0, -0.6], [1, 0, -0.6], [0, 0, 1.2]], 0.1)"},
    {"hull of balls",
     "hull(sphere(0.5), sphere(0.2).move([0.7, 0, 0]), sphere(0.1).move([0, 0.8, 0.3]))"},
    {"tetrahedron", "tetrahedron(0.9)"},
    {"dodecahedron", "dodecahedron(0.8)"},
    {"icosahedron", "icosahedron(0.8)"},
    {"prism", "prism(5, 0.6, 0.7)"},
    {"pyramid", "pyramid(1, 0.9)"},
    {"wedge", "wedge(70deg)"},
    {"plane", "plane([0.2, 1, 0.1], 0.1)"},
    {"convex", "convex(exponent: 8).scale(0.5)"},
    {"extruded figure", "polygon([[0.1, 0], [0.7, -0.1], [0.4, 0.6]]).extrude(0.5)"},
    {"revolved figure", "rectangle([0.3, 0.5]).revolve(0.4)"},
    {"algebraic", "lump"},
    {"algebraic, cut", "lump.within(block)"},
    {"algebraic of degree 6", "algebraic((x^2 + 9/4 * z^2 + y^2 - 1)^3 == x^2 * y^3 + 9/80 * z^2"
                              " * y^3).within(sphere(1.4)).scale(0.6)"},
    {"algebraic sheet", "algebraic(x^2 + y^2 - z^2 == 0.1).within(sphere(0.8), open: true)"},
    {"field", "field(length(p) - 0.5 + 0.1 * sin(3 * x))"},
    {"field, cut", "field(sin(4 * x) * cos(4 * y) + sin(4 * y) * cos(4 * z) + sin(4 * z)"
                   " * cos(4 * x)).within(sphere(0.8))"},
    {"field sheet", "field(y - 0.3 * sin(4 * x) * z).within(block, open: true)"},
    {"julia", "julia([-0.2, 0.6, 0.2, 0.1], iterations: 4).scale(0.5)"},
    {"mandelbulb", "mandelbulb(iterations: 3).scale(0.6)"},
    {"meta", "meta([tool, capsule([-0.7, 0, 0], [0, 0.4, 0], 0.1)], reach: 0.3)"},
    {"union", "block | tool"},
    {"blend", "union(block, tool, blend: 0.2)"},
    {"intersection", "block & tool"},
    {"difference", "block - tool"},
    {"endless difference", "plane([0, 1, 0], 0) - tool"},
    {"xor", "xor(block, tool)"},
    {"morph", "morph(block, tool, 0.4)"},
    {"sequence", "krs { kernel block; reflect plane([1, 0.1, 0], 0.2); kernel tool.scale(0.5);"
                 " reflect plane([0, 1, 0.3], 0.3); }"},
    {"sequence that inverts", "krs { kernel tool; mobius invert([0.2, 1.9, 0], 1.4);"
                              " reflect plane([1, 0, 0], 0.1); }"},
    {"endless sequence", "krs { kernel lump; reflect plane([1, 0.1, 0], 0.3); kernel tool; }"},
    {"moved", "(block - tool).rotate([1, 2, -0.5], 0.8).scale(0.8).move([0.3, -0.2, 0.4])"},
    {"stretched", "block.scale([1.2, 0.6, 1])"},
    {"inverted", "block.transform(invert([0.3, 1.9, 0.4], 1.5))"},
    {"inverted, endless", "block.transform(invert([-0.2, 0.1, 0.1], 0.5))"},
    {"mirrored", "block.mirror(plane([1, 0.2, -0.1], 0.1))"},
    {"repeated", "tool.scale(0.4).repeat([0.8, 0.8, 0.8], [2, 3, 1])"},
    {"repeated for ever", "tool.scale(0.4).repeat([0.9, 0, 1])"},
    {"around", "capsule([0.3, -0.2, 0.1], [0.5, 0.3, -0.1], 0.1).repeat_polar(5)"},
    {"grown", "block.offset(0.1)"},
    {"shrunk", "block.offset(-0.1)"},
    {"round", "box([0.9, 0.6, 0.7]).round(0.1)"},
    {"hollow", "block.shell(0.1)"},
    {"elongated", "tool.elongate([0.3, 0.2, 0.4])"},
    {"twisted", "block.twist([0, 1, 0.2], 1.2)"},
    {"bent", "block.bend([1, 0, 0], 0.6)"},
    {"tapered", "block.taper([0, 1, 0], 1, 0.5)"},
    {"displaced", "block.displace(sin(5 * x) * cos(4 * z), 0.1)"},
    {"painted", "block.paint(#ff8040)"},
    {"smooth mirrors", "block.mirror(plane([1, 0, 0], 0.1)).smooth_mirrors(0.1)"},
    {"nothing", "block & tool.move([5, 0, 0])"},
};
const size_t family_count = sizeof families / sizeof *families;

/* ---- methods ---- */

/* What is inside after `done` methods. */
static bool inside(const Case *c, int done, Vec p);

static bool in_tool(Vec p) { return vec_distance(p, vec(0.35, 0.25, 0.1)) <= 0.6; }

static bool undo_move(const Case *c, int k, Vec p)
{
    return inside(c, k, vec_sub(p, vec(0.3, -0.4, 0.5)));
}

static bool undo_rotate(const Case *c, int k, Vec p)
{
    return inside(c, k, vec_rotate(p, vec(1, 2, -0.5), -0.8));
}

static bool undo_scale(const Case *c, int k, Vec p) { return inside(c, k, vec_scale(1 / 0.6, p)); }

static bool undo_stretch(const Case *c, int k, Vec p)
{
    return inside(c, k, vec(p.x / 1.3, p.y / 0.7, p.z / 0.9));
}

static bool undo_align(const Case *c, int k, Vec p)
{
    Vec from = vec_unit(vec(0, 0.3, 1)), to = vec_unit(vec(1, -0.6, 0.2));
    return inside(c, k, vec_rotate(p, vec_cross(from, to), -acos(vec_dot(from, to))));
}

static Vec folded(Vec p, Vec normal, double offset)
{
    double size = vec_length(normal), excess = (vec_dot(normal, p) - offset) / size;
    return vec_sub(p, vec_scale(2 * fmax(excess, 0) / size, normal));
}

static bool undo_mirror(const Case *c, int k, Vec p)
{
    return inside(c, k, folded(p, vec(1, 0.2, -0.1), 0.2));
}

static Vec inverted(Vec p, Vec centre, double radius)
{
    Vec offset = vec_sub(p, centre);
    return vec_add(centre, vec_scale(radius * radius / vec_dot(offset, offset), offset));
}

static bool undo_invert(const Case *c, int k, Vec p)
{
    return inside(c, k, inverted(p, vec(0.3, 2.5, 0.4), 1.5));
}

static bool undo_repeat(const Case *c, int k, Vec p)
{
    for (int i = 0; i < 6; i++)
        if (inside(c, k, vec_sub(p, vec(5 * (i % 2 - 0.5), 0, 5.5 * (i / 2 - 1)))))
            return true;
    return false;
}

static bool undo_repeat_for_ever(const Case *c, int k, Vec p)
{
    for (int i = -2; i <= 2; i++)
        if (inside(c, k, vec_sub(p, vec(5 * i, 0, 0))))
            return true;
    return false;
}

static bool around(const Case *c, int k, Vec p, Vec axis, int count)
{
    for (int i = 0; i < count; i++)
        if (inside(c, k, vec_rotate(p, axis, 2 * PI * i / count)))
            return true;
    return false;
}

static bool undo_polar(const Case *c, int k, Vec p) { return around(c, k, p, vec(0, 1, 0), 5); }

static bool undo_polar_far(const Case *c, int k, Vec p)
{
    for (int i = 0; i < 6; i++)
        if (inside(c, k, vec_sub(vec_rotate(p, vec(0, 1, 0), PI * i / 3), vec(0, 0, 3))))
            return true;
    return false;
}

static bool undo_polar_offset(const Case *c, int k, Vec p)
{
    return around(c, k, p, vec(1, 0, 1), 2);
}

static double pulled(double x, double half) { return x - fmax(-half, fmin(x, half)); }

static bool undo_elongate(const Case *c, int k, Vec p)
{
    return inside(c, k, vec(pulled(p.x, 0.15), pulled(p.y, 0.1), pulled(p.z, 0.05)));
}

static bool undo_twist(const Case *c, int k, Vec p)
{
    return inside(c, k, vec_rotate(p, vec(0, 1, 0), -0.7 * p.y));
}

static bool undo_bend(const Case *c, int k, Vec p)
{
    double radius = 1 / 0.2 - p.z, angle = atan2(p.y, radius);
    return inside(c, k, vec(p.x, angle / 0.2, 1 / 0.2 - hypot(p.y, radius)));
}

static bool undo_nothing(const Case *c, int k, Vec p) { return inside(c, k, p); }

static bool undo_within(const Case *c, int k, Vec p) { return in_tool(p) && inside(c, k, p); }

static bool undo_union(const Case *c, int k, Vec p) { return in_tool(p) || inside(c, k, p); }

static bool undo_difference(const Case *c, int k, Vec p) { return inside(c, k, p) && !in_tool(p); }

static bool undo_cut_from(const Case *c, int k, Vec p) { return in_tool(p) && !inside(c, k, p); }

static bool undo_xor(const Case *c, int k, Vec p) { return in_tool(p) != inside(c, k, p); }

static bool undo_sequence(const Case *c, int k, Vec p)
{
    Vec q = folded(p, vec(0.3, 1, 0), 0.1);
    return inside(c, k, q) || in_tool(vec_scale(1 / 0.5, p));
}

static bool undo_mobius(const Case *c, int k, Vec p)
{
    Vec q = inverted(folded(p, vec(1, 0, 0), 0.1), vec(-0.3, -2.4, 0.2), 1.6);
    return inside(c, k, vec_rotate(q, vec(0, 1, 0), -0.5));
}

#define ENDS     "E0408 "
#define INVERTS  "E0407 "
#define MEASURED "E0409 "
#define STEEP    "E0402 "
#define CELLS    "E0403 "
const Method methods[] = {
    {"move", "", ".move([0.3, -0.4, 0.5])", undo_move, 0, false, ""},
    {"rotate", "", ".rotate([1, 2, -0.5], 0.8)", undo_rotate, 0, false, ""},
    {"scale", "", ".scale(0.6)", undo_scale, 0, false, ""},
    {"scale", "", ".scale([1.3, 0.7, 0.9])", undo_stretch, 0, false, ""},
    {"align", "", ".align([0, 0.3, 1], [1, -0.6, 0.2])", undo_align, 0, false, ""},
    {"mirror", "", ".mirror(plane([1, 0.2, -0.1], 0.2))", undo_mirror, 0, false, ""},
    {"transform", "", ".transform(invert([0.3, 2.5, 0.4], 1.5))", undo_invert, 0, false, INVERTS},
    {"repeat", "", ".repeat([5, 0, 5.5], [2, 1, 3])", undo_repeat, 0, false, CELLS},
    {"repeat", "", ".repeat([5, 0, 0])", undo_repeat_for_ever, 0, false, CELLS},
    {"repeat_polar", "", ".repeat_polar(5)", undo_polar, 0, false, ""},
    {"repeat_polar", "", ".move([0, 0, 3]).repeat_polar(6)", undo_polar_far, 0, false, ""},
    {"repeat_polar", "", ".repeat_polar(2, [1, 0, 1])", undo_polar_offset, 0, false, ""},
    {"round", "", ".round(0.05)", NULL, 0.05, false, MEASURED},
    {"offset", "", ".offset(0.1)", NULL, 0.1, true, MEASURED},
    {"shell", "", ".shell(0.1)", NULL, 0.05, false, MEASURED},
    {"elongate", "", ".elongate([0.3, 0.2, 0.1])", undo_elongate, 0, false, ""},
    {"paint", "", ".paint(#ff8040)", undo_nothing, 0, false, ""},
    {"within", "", ".within(tool)", undo_within, 0, false, ""},
    {"within", "", ".within(tool, open: true)", NULL, 0.01, false, MEASURED STEEP},
    {"twist", "", ".twist([0, 1, 0], 0.7)", undo_twist, 0, false, ENDS MEASURED},
    {"bend", "", ".bend([1, 0, 0], 0.2)", undo_bend, 0, false, ENDS MEASURED "E0309 "},
    {"taper", "", ".taper([0, 1, 0], 1, 0.6)", NULL, 0, false, ENDS MEASURED},
    {"displace", "", ".displace(1 + sin(3 * x), 0.05)", NULL, 0.1, true, MEASURED},
    {"color_by", "", ".color_by(0.5 + 0.1 * x)", undo_nothing, 0, false, ""},
    {"smooth_mirrors", "", ".smooth_mirrors(0.1)", undo_nothing, 0, false, ""},
    {"|", "(", ") | tool", undo_union, 0, false, ""},
    {"&", "(", ") & tool", undo_within, 0, false, ""},
    {"-", "(", ") - tool", undo_difference, 0, false, ""},
    {"- from", "tool - (", ")", undo_cut_from, 0, false, ""},
    {"xor", "xor(", ", tool)", undo_xor, 0, false, ""},
    {"union", "union(", ", tool, blend: 0.2)", NULL, 1, true, MEASURED},
    {"morph", "morph(", ", tool, 0.4)", NULL, 1, false, MEASURED},
    {"meta", "meta([", ", tool])", NULL, 2, true, MEASURED ENDS},
    {"krs", "krs { kernel ", "; reflect plane([0.3, 1, 0], 0.1); kernel tool.scale(0.5); }",
     undo_sequence, 0, false, ""},
    {"mobius", "krs { kernel ",
     "; mobius invert([-0.3, -2.4, 0.2], 1.6) * rotate([0, 1, 0], 0.5);"
     " reflect plane([1, 0, 0], 0.1); }",
     undo_mobius, 0, false, INVERTS},
    /* These are methods of figures only, or make no shapes. */
    {"extrude", NULL, NULL, NULL, 0, false, ""},
    {"revolve", NULL, NULL, NULL, 0, false, ""},
    {"distance", NULL, NULL, NULL, 0, false, ""},
    {"bounds", NULL, NULL, NULL, 0, false, ""},
    {"corners", NULL, NULL, NULL, 0, false, ""},
    {"hull", NULL, NULL, NULL, 0, false, ""}, /* tests/oracle/hulls.c */
};
const size_t method_count = sizeof methods / sizeof *methods;

static bool inside(const Case *c, int done, Vec p)
{
    if (done == 0)
        return product_distance(&c->alone, p) <= 0;
    return c->methods[done - 1]->undo(c, done - 1, p);
}

bool inside_case(const void *c, Vec p) { return inside(c, ((const Case *)c)->count, p); }
