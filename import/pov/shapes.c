/*
 * shapes.c: POV-Ray's spheres, boxes, columns, rings, planes and
 * polynomials.
 */
#include <math.h>
#include <string.h>

#include "import/pov/reader.h"
#include "compiler/base/vec.h"

enum { MAX_ORDER = 24 };

/* Moves a part so that its own origin goes to a point of POV-Ray. */
static void move_to(Part *part, const double q[3])
{
    double p[3];
    pov_point(q, p);
    Transform transform = transform_move(p);
    part_move(part, &transform);
}

static bool positive(PovReader *reader, unsigned line, double number)
{
    return number > 0 || import_refuse(reader->import, line, "a size is not above 0");
}

bool pov_sphere(PovReader *reader, unsigned line, Part **part)
{
    double center[3], radius;
    if (!pov_vector(reader, center))
        return false;
    word_accept(&reader->words, ",");
    if (!pov_number(reader, &radius))
        return false;
    if (radius == 0)
        return true; /* nothing is seen of it */
    radius          = fabs(radius);
    *part           = part_shape(reader->import, line, "sphere", "sphere(%s)",
                                 import_number_text(reader->import, radius));
    (*part)->inside = (PartInside){PART_BALL, {radius}};
    move_to(*part, center);
    return true;
}

/* Refuses open surfaces, which are no solids; a box with one length of 0 gets a little of it. */
static bool thicken(PovReader *reader, unsigned line, double size[3])
{
    double most = fmax(size[0], fmax(size[1], size[2]));
    int    flat = 0;
    for (int i = 0; i < 3; i++)
        flat += !(size[i] > 0);
    if (flat > 1)
        return positive(reader, line, 0);
    for (int i = 0; i < 3 && flat > 0; i++)
        if (!(size[i] > 0)) {
            size[i] = 1e-3 * most;
            import_note(reader->import, line,
                        "flat boxes are a thousandth of their longest edge thick");
        }
    return true;
}

bool pov_box(PovReader *reader, unsigned line, Part **part)
{
    double low[3], high[3], size[3], center[3];
    if (!pov_vector(reader, low))
        return false;
    word_accept(&reader->words, ",");
    if (!pov_vector(reader, high))
        return false;
    for (int i = 0; i < 3; i++) {
        size[i]   = fabs(high[i] - low[i]);
        center[i] = (high[i] + low[i]) / 2;
    }
    if (!thicken(reader, line, size))
        return false;
    *part           = part_shape(reader->import, line, "box", "box(%s)",
                                 import_vector_text(reader->import, size, 3));
    (*part)->inside = (PartInside){PART_BOX, {size[0] / 2, size[1] / 2, size[2] / 2}};
    move_to(*part, center);
    return true;
}

/* Makes a column from the bottom, of this radius, to the top, of radius `end`; scenes have it about
   y. */
static bool column(PovReader *reader, unsigned line, const double bottom[3], const double top[3],
                   double radius, double end, Part **part)
{
    Import *import = reader->import;
    double  along[3], center[3], from[3], to[3];
    pov_point(bottom, from);
    pov_point(top, to);
    add_scaled3(along, to, -1, from);
    double height = length3(along);
    if (!(height > 0) || !(radius >= 0 && end >= 0 && radius + end > 0))
        return import_refuse(import, line, "a column has no height, or no radius");
    normalize3(along);
    for (int i = 0; i < 3; i++)
        center[i] = (bottom[i] + top[i]) / 2;
    bool hanging = along[0] == 0 && along[2] == 0 && along[1] < 0;
    Text text    = {.arena = import->arena};
    if (radius == end)
        text_format(&text, "cylinder(%s, %s)", import_number_text(import, radius),
                    import_number_text(import, height));
    else
        text_format(
            &text, "capped_cone(%s, %s, %s)", import_number_text(import, hanging ? end : radius),
            import_number_text(import, hanging ? radius : end), import_number_text(import, height));
    if (along[0] != 0 || along[2] != 0)
        text_format(&text, ".align([0, 1, 0], %s)", import_vector_text(import, along, 3));
    *part = part_shape(import, line, radius == end ? "cylinder" : "cone", "%s", text.bytes);
    (*part)->inside = (PartInside){PART_ROUND,
                                   {along[0], along[1], along[2], height / 2, radius, end}};
    move_to(*part, center);
    return true;
}

bool pov_cylinder(PovReader *reader, unsigned line, Part **part)
{
    double bottom[3], top[3], radius;
    if (!pov_vector(reader, bottom))
        return false;
    word_accept(&reader->words, ",");
    if (!pov_vector(reader, top))
        return false;
    word_accept(&reader->words, ",");
    return pov_number(reader, &radius) && positive(reader, line, radius) &&
           column(reader, line, bottom, top, radius, radius, part);
}

bool pov_cone(PovReader *reader, unsigned line, Part **part)
{
    double bottom[3], top[3], radius, end;
    if (!pov_vector(reader, bottom))
        return false;
    word_accept(&reader->words, ",");
    if (!pov_number(reader, &radius))
        return false;
    word_accept(&reader->words, ",");
    if (!pov_vector(reader, top))
        return false;
    word_accept(&reader->words, ",");
    return pov_number(reader, &end) && column(reader, line, bottom, top, radius, end, part);
}

bool pov_torus(PovReader *reader, unsigned line, Part **part)
{
    double major, minor;
    if (!pov_number(reader, &major))
        return false;
    word_accept(&reader->words, ",");
    if (!pov_number(reader, &minor) || !positive(reader, line, major) ||
        !positive(reader, line, minor))
        return false;
    *part           = part_shape(reader->import, line, "torus", "torus(%s, %s)",
                                 import_number_text(reader->import, major),
                                 import_number_text(reader->import, minor));
    (*part)->inside = (PartInside){PART_RING, {major, minor}};
    return true;
}

/* Builds what is on the side that the normal points away from. */
bool pov_plane(PovReader *reader, unsigned line, Part **part)
{
    double v[3], normal[3], offset;
    if (!pov_vector(reader, v))
        return false;
    word_accept(&reader->words, ",");
    if (!pov_number(reader, &offset))
        return false;
    pov_point(v, normal);
    if (!normalize3(normal))
        return import_refuse(reader->import, line, "a plane has no normal");
    *part           = part_shape(reader->import, line, "plane", "plane(%s, %s)",
                                 import_vector_text(reader->import, normal, 3),
                                 import_number_text(reader->import, offset));
    (*part)->inside = (PartInside){PART_HALF_SPACE, {normal[0], normal[1], normal[2], offset}};
    return true;
}

/* ---- polynomials ---- */

/* Adds a factor of x^i y^j z^k, in the space of scenes: odd powers of z change their sign. */
static void add_term(Import *import, Text *text, double factor, const int powers[3])
{
    const char *between = "";
    factor              = powers[2] % 2 ? -factor : factor;
    if (factor == 0)
        return;
    text_add(text, text->length == 0 ? (factor < 0 ? "-" : "") : factor < 0 ? " - " : " + ");
    if (fabs(factor) != 1 || powers[0] + powers[1] + powers[2] == 0) {
        text_add(text, import_number_text(import, fabs(factor)));
        between = " * ";
    }
    for (int i = 0; i < 3; i++) {
        if (powers[i] == 0)
            continue;
        text_format(text, powers[i] == 1 ? "%s%c" : "%s%c^%d", between, "xyz"[i], powers[i]);
        between = " * ";
    }
}

static Part *algebraic(PovReader *reader, unsigned line, const char *stem, const Text *terms)
{
    Part *part     = part_shape(reader->import, line, stem, "algebraic(%s == 0)",
                            terms->length > 0 ? terms->bytes : "0");
    part->equation = part->shape;
    return part;
}

/* Reads `<` and all factors, from x^order down, with falling powers of x, then y, then z. */
static bool polynomial(PovReader *reader, unsigned line, int order, Part **part)
{
    Text terms = {.arena = reader->import->arena};
    int  left  = (order + 1) * (order + 2) * (order + 3) / 6;
    if (!word_expect(&reader->words, "<"))
        return false;
    for (int i = order; i >= 0; i--)
        for (int j = order - i; j >= 0; j--)
            for (int k = order - i - j; k >= 0; k--) {
                double factor;
                if (!pov_number(reader, &factor) ||
                    !word_expect(&reader->words, --left > 0 ? "," : ">"))
                    return false;
                add_term(reader->import, &terms, factor, (int[]){i, j, k});
            }
    *part = algebraic(reader, line, "poly", &terms);
    return true;
}

bool pov_cubic(PovReader *reader, unsigned line, Part **part)
{
    return polynomial(reader, line, 3, part);
}

bool pov_quartic(PovReader *reader, unsigned line, Part **part)
{
    return polynomial(reader, line, 4, part);
}

bool pov_poly(PovReader *reader, unsigned line, Part **part)
{
    double order;
    if (!pov_number(reader, &order))
        return false;
    word_accept(&reader->words, ",");
    if (!(order >= 2 && order <= MAX_ORDER && order == floor(order)))
        return import_refuse(reader->import, line, "the order of `poly` is from 2 to %d",
                             MAX_ORDER);
    return polynomial(reader, line, (int)order, part);
}

/* Squares; products of two; x, y, z; and 1. */
bool pov_quadric(PovReader *reader, unsigned line, Part **part)
{
    static const int powers[9][3] = {{2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {1, 1, 0}, {1, 0, 1},
                                     {0, 1, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    Text             terms        = {.arena = reader->import->arena};
    double           v[3], last;
    for (int i = 0; i < 3; i++) {
        if (!pov_vector(reader, v))
            return false;
        word_accept(&reader->words, ",");
        for (int k = 0; k < 3; k++)
            add_term(reader->import, &terms, v[k], powers[3 * i + k]);
    }
    if (!pov_number(reader, &last))
        return false;
    add_term(reader->import, &terms, last, (int[]){0, 0, 0});
    *part = algebraic(reader, line, "quadric", &terms);
    return true;
}
