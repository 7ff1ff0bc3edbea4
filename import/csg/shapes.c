/*
 * shapes.c: OpenSCAD's solids and figures, and how figures become solid.
 *
 * OpenSCAD's columns stand along z, those of scenes along y; figures lie in x and y in both.
 */
#include <ctype.h>
#include <math.h>
#include <string.h>

#include "import/csg/node.h"

static const double DEGREE = 3.14159265358979323846 / 180;

/* The number of sides up to which they are meant to be seen; more of them stand for a circle. */
enum { MAX_SIDES_SEEN = 8, MAX_FRAGMENTS = 1000 };

const CsgValue *csg_argument(const CsgNode *node, const char *name)
{
    for (size_t i = 0; i < node->arguments.count; i++)
        if (strcmp(node->arguments.items[i].name, name) == 0)
            return &node->arguments.items[i].value;
    return NULL;
}

bool csg_number(const CsgNode *node, const char *name, double otherwise, double *number)
{
    const CsgValue *value = csg_argument(node, name);
    *number               = otherwise;
    if (!value || value->kind == CSG_UNDEF)
        return true;
    if (value->kind != CSG_NUMBER && value->kind != CSG_TRUTH)
        return import_refuse(node->import, node->line, "`%s` of `%s` is no number", name,
                             node->name);
    *number = value->number;
    return true;
}

bool csg_vector(const CsgNode *node, const char *name, double *numbers, int count)
{
    const CsgValue *value = csg_argument(node, name);
    if (!value || value->kind == CSG_UNDEF)
        return true;
    bool good = value->kind == CSG_NUMBER ||
                (value->kind == CSG_LIST && value->list.count == (size_t)count);
    for (int i = 0; good && i < count; i++) {
        const CsgValue *item = value->kind == CSG_NUMBER ? value : &value->list.items[i];
        good                 = item->kind == CSG_NUMBER;
        numbers[i]           = item->number;
    }
    return good || import_refuse(node->import, node->line, "`%s` of `%s` needs %d numbers", name,
                                 node->name, count);
}

bool csg_points(const CsgNode *node, const CsgValue *list, size_t numbers, double (**points)[3])
{
    size_t count = list && list->kind == CSG_LIST ? list->list.count : 0;
    *points      = arena_alloc(node->import->arena, count + 1, sizeof **points);
    for (size_t i = 0; i < count; i++) {
        const CsgValue *point = &list->list.items[i];
        if (point->kind != CSG_LIST || point->list.count != numbers)
            return import_refuse(node->import, node->line, "a point of `%s` needs %zu numbers",
                                 node->name, numbers);
        for (size_t k = 0; k < numbers; k++) {
            if (point->list.items[k].kind != CSG_NUMBER)
                return import_refuse(node->import, node->line, "a point of `%s` needs numbers",
                                     node->name);
            (*points)[i][k] = point->list.items[k].number;
        }
    }
    return count > 0 || import_refuse(node->import, node->line, "`%s` has no points", node->name);
}

bool csg_sides(const CsgNode *node, int *sides)
{
    double number;
    if (!csg_number(node, "$fn", 0, &number))
        return false;
    *sides = number >= 1 && number <= MAX_SIDES_SEEN ? (int)fmax(number, 3) : 0;
    if (*sides == 0)
        import_note(node->import, node->line,
                    "round surfaces are round, whatever `$fn`, `$fa` and `$fs` are");
    return true;
}

static bool is_nothing(const CsgNode *node)
{
    import_note(node->import, node->line, "`%s` has no size, and is left out", node->name);
    return true;
}

/* Moves a part that is not centred, so that it begins at the origin. */
static void move_corner(Part *part, const double size[3])
{
    Transform transform = transform_move((double[]){size[0] / 2, size[1] / 2, size[2] / 2});
    part_move(part, &transform);
}

static void rotate_upright(Part *part)
{
    Transform transform = transform_rotate(0, 90 * DEGREE);
    part_move(part, &transform);
}

static PartBalls new_balls(const CsgNode *node, size_t count, double radius)
{
    return (PartBalls){arena_alloc(node->import->arena, count, 3 * sizeof(double)), count, count,
                       radius, NULL};
}

static Part *rectangle(const CsgNode *node, const double size[2])
{
    Part *part         = part_shape(node->import, node->line, "square", "rectangle(%s)",
                                    import_vector_text(node->import, size, 2));
    part->figure       = true;
    part->balls        = new_balls(node, 4, 0);
    part->corners      = part->balls.points;
    part->corner_count = 4;
    for (int i = 0; i < 4; i++) { /* around, counterclockwise */
        part->corners[i][0] = (i == 1 || i == 2 ? 0.5 : -0.5) * size[0];
        part->corners[i][1] = (i >= 2 ? 0.5 : -0.5) * size[1];
        part->corners[i][2] = 0;
    }
    return part;
}

bool csg_cube(const CsgNode *node, Part **part)
{
    double size[3] = {1, 1, 1}, center;
    if (!csg_vector(node, "size", size, 3) || !csg_number(node, "center", 0, &center))
        return false;
    if (!(size[0] > 0 && size[1] > 0 && size[2] > 0))
        return is_nothing(node);
    *part          = part_shape(node->import, node->line, "cube", "box(%s)",
                                import_vector_text(node->import, size, 3));
    (*part)->balls = new_balls(node, 8, 0);
    for (int i = 0; i < 8; i++)
        for (int k = 0; k < 3; k++)
            (*part)->balls.points[i][k] = (i >> k & 1 ? 0.5 : -0.5) * size[k];
    (*part)->column = (PartColumn){rectangle(node, size), size[2]};
    if (center == 0)
        move_corner(*part, size);
    return true;
}

bool csg_sphere(const CsgNode *node, Part **part)
{
    double radius;
    if (!csg_number(node, "r", 1, &radius))
        return false;
    if (!(radius > 0))
        return is_nothing(node);
    import_note(node->import, node->line,
                "round surfaces are round, whatever `$fn`, `$fa` and `$fs` are");
    *part          = part_shape(node->import, node->line, "sphere", "sphere(%s)",
                                import_number_text(node->import, radius));
    (*part)->balls = new_balls(node, 1, radius);
    return true;
}

/* Finds the polygons that OpenSCAD has for the ends of a column, in a space where it stands along
   z. */
static bool column_corners(const CsgNode *node, double bottom, double top, double height, int sides,
                           PartBalls *balls)
{
    double angle, size, radius = fmax(bottom, top), count = sides;
    if (!csg_number(node, "$fa", 12, &angle) || !csg_number(node, "$fs", 2, &size) ||
        !csg_number(node, "$fn", 0, &count))
        return false;
    if (!(count > 0))
        count = ceil(fmax(fmin(360 / angle, radius * 360 * DEGREE / size), 5));
    int corners = count >= 3 && count <= MAX_FRAGMENTS ? (int)count : MAX_FRAGMENTS;
    corners     = count < 3 ? 3 : corners;
    *balls      = new_balls(node, 2 * (size_t)corners, 0);
    for (int i = 0; i < 2 * corners; i++) {
        double at = 360 * DEGREE * (i / 2) / corners, r = i % 2 ? top : bottom;
        balls->points[i][0] = r * cos(at);
        balls->points[i][1] = r * sin(at);
        balls->points[i][2] = (i % 2 ? 0.5 : -0.5) * height;
    }
    return true;
}

static Part *column(const CsgNode *node, double bottom, double top, double height, int sides,
                    const PartBalls *corners)
{
    Import     *import = node->import;
    const char *tall   = import_number_text(import, height);
    const char *wide   = import_number_text(import, bottom);
    const char *narrow = import_number_text(import, top);
    if (sides > 0 && bottom == top)
        return part_shape(import, node->line, "prism",
                          "regular(%d, %s).rotate([0, 0, 1], -90deg).extrude(%s)", sides, wide,
                          tall);
    if (sides > 0) {
        Text list = {.arena = import->arena};
        for (size_t i = 0; i < corners->count; i++)
            text_format(&list, "%s%s", i == 0 ? "" : ", ",
                        import_vector_text(import, corners->points[i], 3));
        return part_shape(import, node->line, "frustum", "hull([%s])", list.bytes);
    }
    if (bottom == top)
        return part_shape(import, node->line, "cylinder",
                          "cylinder(%s, %s).rotate([1, 0, 0], 90deg)", wide, tall);
    return part_shape(import, node->line, "cone",
                      "capped_cone(%s, %s, %s).rotate([1, 0, 0], 90deg)", wide, narrow, tall);
}

static Part *circle(const CsgNode *node, double radius, int sides)
{
    const char *text    = import_number_text(node->import, radius);
    Part       *part    = sides > 0 ? part_shape(node->import, node->line, "regular",
                                                 "regular(%d, %s).rotate([0, 0, 1], -90deg)", sides, text)
                                    : part_shape(node->import, node->line, "circle", "circle(%s)", text);
    part->figure        = true;
    part->figure_radius = sides > 0 ? 0 : radius;
    part->balls         = new_balls(node, sides > 0 ? (size_t)sides : 1, sides > 0 ? 0 : radius);
    for (int i = 0; i < sides; i++) {
        part->balls.points[i][0] = radius * cos(360 * DEGREE * i / sides);
        part->balls.points[i][1] = radius * sin(360 * DEGREE * i / sides);
    }
    part->corners      = sides > 0 ? part->balls.points : NULL;
    part->corner_count = (size_t)sides;
    return part;
}

bool csg_cylinder(const CsgNode *node, Part **part)
{
    double    height, bottom, top, center;
    int       sides;
    PartBalls corners;
    if (!csg_number(node, "h", 1, &height) || !csg_number(node, "r1", 1, &bottom) ||
        !csg_number(node, "r2", 1, &top) || !csg_number(node, "center", 0, &center))
        return false;
    if (!(height > 0 && bottom >= 0 && top >= 0 && bottom + top > 0))
        return is_nothing(node);
    if (!csg_sides(node, &sides) || !column_corners(node, bottom, top, height, sides, &corners))
        return false;
    *part          = column(node, bottom, top, height, sides, &corners);
    (*part)->balls = corners;
    if (bottom == top)
        (*part)->column = (PartColumn){circle(node, bottom, sides), height};
    else if (sides == 0)
        (*part)->cone = (PartCone){bottom, top, height};
    if (center == 0)
        move_corner(*part, (double[]){0, 0, height});
    return true;
}

/* ---- texts ---- */

const char *csg_string(const CsgNode *node, const char *name, const char *otherwise)
{
    const CsgValue *value = csg_argument(node, name);
    return value && value->kind == CSG_STRING ? value->string : otherwise;
}

/* Escapes of OpenSCAD are those of the language, but for tabs and what has a number. */
static void add_string(Text *text, const char *string)
{
    text_add(text, "\"");
    for (; *string; string++) {
        bool escapes = string[0] == '\\' && string[1] != '\0';
        if (escapes && !strchr("\\\"n", string[1])) {
            text_add(text, string[1] == 't' ? " " : "");
            string++;
            continue;
        }
        text_add_bytes(text, string, escapes ? 2 : 1);
        string += escapes;
    }
    text_add(text, "\"");
}

/* Adds a font: "Family:style=Bold" is "Family:bold" here.  One that is not installed is replaced,
   with a note. */
static void add_font(const CsgNode *node, Text *text, const char *name)
{
    Text        font  = {.arena = node->import->arena};
    Text        trial = {.arena = node->import->arena};
    const char *style = strstr(name, ":style=");
    size_t      most  = style ? (size_t)(style - name) : strlen(name);
    text_add_bytes(&font, most > 0 ? name : "Liberation Sans", most > 0 ? most : 15);
    if (style && strcmp(style + 7, "Regular") != 0) {
        text_add(&font, ":");
        for (const char *c = style + 7; *c && *c != ':'; c++)
            text_add_bytes(&font, (char[]){(char)tolower((unsigned char)*c)}, 1);
    }
    text_add(&trial, "show text(\"a\", font: ");
    add_string(&trial, font.bytes);
    text_add(&trial, ").extrude(1);");
    if (import_compiles(node->import, trial.bytes)) {
        text_add(text, ", font: ");
        add_string(text, font.bytes);
    } else {
        import_note(node->import, node->line,
                    "the font `%.60s` is not installed: another one is taken", font.bytes);
    }
}

/* ---- figures ---- */

bool csg_square(const CsgNode *node, Part **part)
{
    double size[3] = {1, 1, 0}, center;
    if (!csg_vector(node, "size", size, 2) || !csg_number(node, "center", 0, &center))
        return false;
    if (!(size[0] > 0 && size[1] > 0))
        return is_nothing(node);
    *part = rectangle(node, size);
    if (center == 0)
        move_corner(*part, size);
    return true;
}

bool csg_circle(const CsgNode *node, Part **part)
{
    double radius;
    int    sides;
    if (!csg_number(node, "r", 1, &radius))
        return false;
    if (!(radius > 0))
        return is_nothing(node);
    if (!csg_sides(node, &sides))
        return false;
    *part = circle(node, radius, sides);
    return true;
}

/* Builds text.  Liberation Sans is OpenSCAD's own; its sizes are those of letters of 100 in an em
   of 139. */
bool csg_text(const CsgNode *node, Part **part)
{
    static const struct {
        const char *argument, *from, *to;
    } aligned[]        = {{"halign", "left", "left"},    {"halign", "center", "center"},
                          {"halign", "right", "right"},  {"valign", "baseline", "baseline"},
                          {"valign", "top", "top"},      {"valign", "center", "middle"},
                          {"valign", "bottom", "bottom"}};
    const char *across = "left", *up = "baseline";
    double      size, spacing;
    const char *string    = csg_string(node, "text", "");
    const char *direction = csg_string(node, "direction", "ltr");
    if (!csg_number(node, "size", 10, &size) || !csg_number(node, "spacing", 1, &spacing))
        return false;
    if (!(size > 0) || string[0] == '\0')
        return is_nothing(node);
    if (strcmp(direction, "ltr") != 0)
        return import_refuse(node->import, node->line,
                             "`text` that runs by `%.10s` is not translated", direction);
    if (spacing != 1)
        return import_refuse(node->import, node->line, "`spacing` of `text` is not translated");
    for (size_t i = 0; i < sizeof aligned / sizeof *aligned; i++)
        if (strcmp(csg_string(node, aligned[i].argument, ""), aligned[i].from) == 0)
            *(aligned[i].argument[0] == 'h' ? &across : &up) = aligned[i].to;
    Text text = {.arena = node->import->arena};
    text_add(&text, "text(");
    add_string(&text, string);
    text_format(&text, ", size: %s", import_number_text(node->import, size * 100 / 72));
    add_font(node, &text, csg_string(node, "font", ""));
    if (strcmp(across, "left") != 0)
        text_format(&text, ", align: \"%s\"", across);
    if (strcmp(up, "baseline") != 0)
        text_format(&text, ", vertical: \"%s\"", up);
    text_add(&text, ")");
    *part           = part_shape(node->import, node->line, "text", "%s", text.bytes);
    (*part)->figure = true;
    return true;
}

/* ---- from figures to solids ---- */

bool csg_linear_extrude(const CsgNode *node, Part **part)
{
    double height, center, twist, scale[2] = {1, 1}, along[3] = {0, 0, 1};
    Part  *figure = NULL;
    if (!csg_number(node, "height", 100, &height) || !csg_number(node, "center", 0, &center) ||
        !csg_number(node, "twist", 0, &twist) || !csg_vector(node, "scale", scale, 2) ||
        !csg_vector(node, "v", along, 3) || !csg_joined(node, true, &figure))
        return false;
    if (scale[0] != scale[1])
        return import_refuse(node->import, node->line,
                             "`scale` that differs in x and y is not translated");
    if (!(scale[0] > 0))
        return import_refuse(node->import, node->line,
                             "`scale` of 0 is not translated: the tip of a cone or pyramid is, by "
                             "`cylinder` with `r2 = 0`, or `polyhedron`");
    if (along[0] != 0 || along[1] != 0 || along[2] <= 0)
        return import_refuse(node->import, node->line, "`v` that is not along z is not translated");
    if (!figure || !(height > 0))
        return !figure || is_nothing(node);
    Text methods = {.arena = node->import->arena};
    text_format(&methods, ".extrude(%s)", import_number_text(node->import, height));
    if (scale[0] != 1)
        text_format(&methods, ".taper([0, 0, 1], 1, %s)",
                    import_number_text(node->import, scale[0]));
    if (center == 0 && twist != 0) /* a twist does not turn what is at 0 */
        text_format(&methods, ".move([0, 0, %s])", import_number_text(node->import, height / 2));
    if (twist != 0)
        text_format(&methods, ".twist([0, 0, 1], %sdeg)",
                    import_number_text(node->import, -twist / height));
    *part            = part_around(node->import, node->line, "extruded", figure);
    (*part)->methods = methods.bytes;
    (*part)->figure  = false;
    if (twist == 0 && scale[0] == 1)
        (*part)->column = (PartColumn){figure, height};
    if (center == 0 && twist == 0)
        move_corner(*part, (double[]){0, 0, height});
    return true;
}

/* Tells how far a part reaches from low to high in x; what is cut away counts. */
static void reach_in_x(const Part *part, const Transform *outer, double reach[2])
{
    Transform transform = transform_chain(&part->transform, outer);
    for (size_t i = 0; i < part->balls.count && part->shape; i++) {
        double at[3], size = hypot(transform.rows[0][0], transform.rows[0][1]);
        transform_apply(&transform, part->balls.points[i], at);
        reach[0] = fmin(reach[0], at[0] - size * part->balls.radius);
        reach[1] = fmax(reach[1], at[0] + size * part->balls.radius);
    }
    size_t count = part->join == PART_DIFFERENCE ? 1 : part->parts.count;
    for (size_t i = 0; i < count && i < part->parts.count; i++)
        reach_in_x(part->parts.items[i], &transform, reach);
}

bool csg_rotate_extrude(const CsgNode *node, Part **part)
{
    double    angle, start, reach[2] = {INFINITY, -INFINITY};
    Part     *figure = NULL;
    Transform here   = transform_identity();
    if (!csg_number(node, "angle", 360, &angle) || !csg_number(node, "start", 0, &start) ||
        !csg_joined(node, true, &figure) || !figure)
        return node->import->refusal.length == 0;
    reach_in_x(figure, &here, reach);
    double slack = 1e-9 * (reach[1] - reach[0]);
    if (reach[0] < -slack && reach[1] > slack)
        return import_refuse(node->import, node->line,
                             "the figure is on both sides of the axis, as far as is known");
    if (reach[1] <= slack) { /* the other side shows the same, half a turn later */
        Transform mirror = transform_scale((double[]){-1, 1, 1});
        figure           = part_around(node->import, node->line, "mirrored", figure);
        part_move(figure, &mirror);
        start += 180;
    }
    *part            = part_around(node->import, node->line, "revolved", figure);
    (*part)->methods = ".revolve(0)";
    (*part)->figure  = false;
    rotate_upright(*part);
    if (fabs(angle) >= 360 || angle == 0)
        return true;
    Part     *wedge  = part_shape(node->import, node->line, "wedge", "wedge(%sdeg)",
                                  import_number_text(node->import, fabs(angle)));
    Transform middle = transform_rotate(2, (start + angle / 2 + 90) * DEGREE);
    rotate_upright(wedge); /* its middle is then at -y */
    part_move(wedge, &middle);
    Part *cut = part_new(node->import, node->line, "sector");
    cut->join = PART_INTERSECTION;
    part_add(node->import, cut, *part);
    part_add(node->import, cut, wedge);
    *part = cut;
    return true;
}
