/*
 * boundaries.c: distances to figures that are joined, against points of their true boundary.
 *
 * Each part is drawn here as points along its outline, and knows by a formula of its own what is inside.  A
 * point is on the boundary of a CSG node where the CSG node says something else on its two sides.
 */
#include <stdio.h>
#include <string.h>

#include "tests/oracle/judge.h"
#include "tests/oracle/product.h"

enum { MAX_PARTS = 12, POINTS = 80, MAX_BOUNDARY = 200000 };

/* How far points along outlines are from each other, and at most from the boundary. */
static const double SPACING = 1e-3, TOLERANCE = 1.01e-3;

/* ---- parts ---- */

enum { MAX_TIPS = 16, MAX_CORNERS = 2 * MAX_TIPS };

typedef enum Kind { CIRCLE, RECTANGLE, REGULAR, STAR, SEGMENT, ARC, ROUNDED, GROWN, KINDS } Kind;

typedef struct Part {
    Kind   kind;
    double a, b, c; /* sizes */
    int    n;
    double scale, turn, x, y;
    bool   mirrored;
    char   join; /* with what stands before: | & - ^ */
} Part;

static double square(double a) { return a * a; }

/* Tells whether a point in the part's own coordinates is inside. */
static double box_value(double x, double y, double a, double b)
{
    double u = fabs(x) - 0.5 * a, v = fabs(y) - 0.5 * b;
    return hypot(fmax(u, 0), fmax(v, 0)) + fmin(fmax(u, v), 0);
}

static double segment_value(double x, double y, const double from[2], const double to[2])
{
    double way[2] = {to[0] - from[0], to[1] - from[1]};
    double t      = ((x - from[0]) * way[0] + (y - from[1]) * way[1]) /
               (square(way[0]) + square(way[1]));
    t = fmin(fmax(t, 0), 1);
    return hypot(x - from[0] - t * way[0], y - from[1] - t * way[1]);
}

static bool in_corners(double x, double y, double (*corners)[2], int count)
{
    bool inside = false;
    for (int i = 0; i < count; i++) {
        const double *p = corners[i], *q = corners[(i + 1) % count];
        if ((p[1] > y) != (q[1] > y) && x < p[0] + (y - p[1]) * (q[0] - p[0]) / (q[1] - p[1]))
            inside = !inside;
    }
    return inside;
}

static int corners_of(const Part *part, double (*corners)[2])
{
    int count = part->kind == STAR ? 2 * part->n : part->n;
    for (int i = 0; i < count; i++) {
        double angle  = 2 * M_PI * i / count;
        double radius = part->kind == STAR && i % 2 ? part->b : part->a;
        corners[i][0] = radius * sin(angle);
        corners[i][1] = radius * cos(angle);
    }
    return count;
}

static bool in_shape(const Part *part, double x, double y)
{
    double corners[MAX_CORNERS][2];
    switch (part->kind) {
    case CIRCLE: return hypot(x, y) < part->a;
    case RECTANGLE: return fmax(fabs(x) - 0.5 * part->a, fabs(y) - 0.5 * part->b) < 0;
    case SEGMENT:
        return segment_value(x, y, (double[]){-part->a, 0}, (double[]){part->a, 0}) < 0.5 * part->b;
    case ARC: {
        double half = 0.5 * part->c, beside = fabs(atan2(x, y));
        double away = beside < half ? fabs(hypot(x, y) - part->a)
                                    : hypot(fabs(x) - part->a * sin(half), y - part->a * cos(half));
        return away < 0.5 * part->b;
    }
    case ROUNDED: return box_value(x, y, part->a - 2 * part->c, part->b - 2 * part->c) < part->c;
    case GROWN: {
        double least = 1e9;
        int    count = corners_of(part, corners);
        for (int i = 0; i < count; i++)
            least = fmin(least, segment_value(x, y, corners[i], corners[(i + 1) % count]));
        return least < part->c || in_corners(x, y, corners, count);
    }
    default: return in_corners(x, y, corners, corners_of(part, corners));
    }
}

static bool in_part(const Part *part, double x, double y)
{
    double c = cos(part->turn), s = sin(part->turn), u = x - part->x, v = y - part->y;
    double p = (c * u + s * v) / part->scale, q = (c * v - s * u) / part->scale;
    return in_shape(part, part->mirrored ? -p : p, q);
}

static bool in_csg_node(const Part *parts, int count, double x, double y)
{
    bool inside = in_part(&parts[0], x, y);
    for (int i = 1; i < count; i++) {
        bool next = in_part(&parts[i], x, y);
        switch (parts[i].join) {
        case '|': inside = inside || next; break;
        case '&': inside = inside && next; break;
        case '-': inside = inside && !next; break;
        default: inside = inside != next; break;
        }
    }
    return inside;
}

/* ---- the true boundary ---- */

typedef struct Boundary {
    double points[MAX_BOUNDARY][2];
    int    count;
} Boundary;

typedef struct Drawing {
    const Part *parts, *part;
    int         count;
    Boundary   *boundary;
} Drawing;

/* Draws a point along the outline of a part, and the direction across it, in the part's own
   coordinates. */
static void draw_point(const Drawing *drawing, double x, double y, double across_x, double across_y)
{
    const Part *part = drawing->part;
    double      c = part->scale * cos(part->turn), s = part->scale * sin(part->turn);
    double      p = part->mirrored ? -x : x, u = part->mirrored ? -across_x : across_x;
    double      at[2]   = {c * p - s * y + part->x, s * p + c * y + part->y};
    double      way     = 1e-7 / hypot(across_x, across_y) / part->scale;
    double      side[2] = {way * (c * u - s * across_y), way * (s * u + c * across_y)};
    if (in_csg_node(drawing->parts, drawing->count, at[0] + side[0], at[1] + side[1]) ==
        in_csg_node(drawing->parts, drawing->count, at[0] - side[0], at[1] - side[1]))
        return;
    Boundary *boundary = drawing->boundary;
    assert_true(boundary->count < MAX_BOUNDARY);
    boundary->points[boundary->count][0]   = at[0];
    boundary->points[boundary->count++][1] = at[1];
}

/* Points in the middle of equal parts: corners are none. */
static void draw_line(const Drawing *drawing, const double from[2], const double to[2])
{
    double way[2] = {to[0] - from[0], to[1] - from[1]};
    int    count  = 1 + (int)(hypot(way[0], way[1]) * drawing->part->scale / SPACING);
    for (int i = 0; i < count; i++) {
        double t = (i + 0.5) / count;
        draw_point(drawing, from[0] + t * way[0], from[1] + t * way[1], way[1], -way[0]);
    }
}

/* Angles from the direction up, clockwise. */
static void draw_arc(const Drawing *drawing, const double centre[2], double radius, double from,
                     double to)
{
    int count = 1 + (int)(radius * fabs(to - from) * drawing->part->scale / SPACING);
    for (int i = 0; i < count; i++) {
        double angle = from + (to - from) * (i + 0.5) / count;
        draw_point(drawing, centre[0] + radius * sin(angle), centre[1] + radius * cos(angle),
                   sin(angle), cos(angle));
    }
}

static void draw_corners(const Drawing *drawing, double (*corners)[2], int count)
{
    for (int i = 0; i < count; i++)
        draw_line(drawing, corners[i], corners[(i + 1) % count]);
}

/* Draws what surrounds lines: parallels and whole circles, of which the sides say what is left. */
static void draw_around(const Drawing *drawing, double (*corners)[2], int count, double radius)
{
    for (int i = 0; i < count; i++) {
        const double *p = corners[i], *q = corners[(i + 1) % count];
        double        away = radius / hypot(q[0] - p[0], q[1] - p[1]);
        draw_arc(drawing, p, radius, 0, 2 * M_PI);
        for (int side = -1; side <= 1; side += 2) {
            double x = side * away * (q[1] - p[1]), y = side * away * (p[0] - q[0]);
            draw_line(drawing, (double[]){p[0] + x, p[1] + y}, (double[]){q[0] + x, q[1] + y});
        }
    }
}

static void draw_part(const Drawing *drawing)
{
    const Part *part = drawing->part;
    double      w = 0.5 * part->a, h = 0.5 * part->b, in = part->kind == ROUNDED ? part->c : 0;
    double box[4][2] = {{w - in, h - in}, {in - w, h - in}, {in - w, in - h}, {w - in, in - h}};
    double corners[MAX_CORNERS][2], none[2] = {0, 0};
    switch (part->kind) {
    case CIRCLE: draw_arc(drawing, none, part->a, 0, 2 * M_PI); break;
    case RECTANGLE: draw_corners(drawing, box, 4); break;
    case ROUNDED: draw_around(drawing, box, 4, part->c); break;
    case GROWN: draw_around(drawing, corners, corners_of(part, corners), part->c); break;
    case SEGMENT: draw_around(drawing, (double[][2]){{-part->a, 0}, {part->a, 0}}, 2, h); break;
    case ARC:
        for (int side = -1; side <= 1; side += 2) {
            double end = 0.5 * part->c * side;
            draw_arc(drawing, none, part->a + side * h, -0.5 * part->c, 0.5 * part->c);
            draw_arc(drawing, (double[]){part->a * sin(end), part->a * cos(end)}, h, 0, 2 * M_PI);
        }
        break;
    default: draw_corners(drawing, corners, corners_of(part, corners)); break;
    }
}

static void find_boundary(const Part *parts, int count, Boundary *boundary)
{
    boundary->count = 0;
    for (int i = 0; i < count; i++)
        draw_part(&(Drawing){parts, &parts[i], count, boundary});
}

static double true_distance(const Boundary *boundary, const Part *parts, int count, double x,
                            double y)
{
    double least = 1e9;
    for (int i = 0; i < boundary->count; i++)
        least = fmin(least,
                     square(boundary->points[i][0] - x) + square(boundary->points[i][1] - y));
    return in_csg_node(parts, count, x, y) ? -sqrt(least) : sqrt(least);
}

/* ---- in the language ---- */

static void write_part(SceneText *text, const Part *part)
{
    switch (part->kind) {
    case CIRCLE: scene_write(text, "circle(%.17g)", part->a); break;
    case RECTANGLE: scene_write(text, "rectangle([%.17g, %.17g])", part->a, part->b); break;
    case REGULAR: scene_write(text, "regular(%d, %.17g)", part->n, part->a); break;
    case STAR: scene_write(text, "star(%d, %.17g, %.17g)", part->n, part->a, part->b); break;
    case SEGMENT:
        scene_write(text, "segment([%.17g, 0], [%.17g, 0], %.17g)", -part->a, part->a, part->b);
        break;
    case ARC: scene_write(text, "arc(%.17g, %.17g, %.17g)", part->a, part->c, part->b); break;
    case ROUNDED:
        scene_write(text, "rectangle([%.17g, %.17g]).round(%.17g)", part->a, part->b, part->c);
        break;
    default:
        scene_write(text, "regular(%d, %.17g).offset(%.17g)", part->n, part->a, part->c);
        break;
    }
    if (part->mirrored)
        scene_write(text, ".rotate([0, 1, 0], 180deg)");
    scene_write(text, ".scale(%.17g).rotate(%.17g).move([%.17g, %.17g])", part->scale, part->turn,
                part->x, part->y);
}

static void write_csg_node(SceneText *text, const Part *parts, int count)
{
    static const struct {
        char        join;
        const char *name;
    } names[] = {{'|', "union"}, {'&', "intersection"}, {'-', "difference"}, {'^', "xor"}};
    for (int i = count - 1; i > 0; i--)
        for (size_t k = 0; k < 4; k++)
            if (names[k].join == parts[i].join)
                scene_write(text, "%s(", names[k].name);
    write_part(text, &parts[0]);
    for (int i = 1; i < count; i++) {
        scene_write(text, ", ");
        write_part(text, &parts[i]);
        scene_write(text, ")");
    }
}

/* Returns a slab whose distance is that to the figure, as far as its height goes. */
static Product figure_product(const char *figure)
{
    return product_format("let figure = %s;\n"
                          "shape slab() { distance: max(figure.distance([x, y]), abs(z) - 9),\n"
                          "               slope: 1, within: box([19, 19, 18]) }\n"
                          "show slab();\n",
                          figure);
}

/* ---- members ---- */

/* Multiples of a quarter, so that parts often touch, share sides, or are in each other. */
static double quarter(Random *random, int low, int high)
{
    return 0.25 * (low + (int)random_below(random, high - low + 1));
}

static Part random_part(Random *random, bool even)
{
    Part part = {.kind  = (Kind)random_below(random, KINDS),
                 .n     = random_below(random, 4) ? 3 + random_below(random, 5) : MAX_TIPS,
                 .a     = quarter(random, 2, 5),
                 .b     = quarter(random, 2, 5),
                 .scale = 1,
                 .x     = quarter(random, -4, 4),
                 .y     = quarter(random, -4, 4),
                 .join  = "|||||&-^"[random_below(random, 8)]};
    if (part.kind == STAR)
        part.b = 0.5 * part.a;
    if (part.kind == SEGMENT || part.kind == ARC)
        part.b = 0.25 * quarter(random, 2, 4);
    part.c    = part.kind == ARC ? random_between(random, 0.5, 6) : 0.125;
    part.turn = 0.5 * M_PI * random_below(random, 4);
    if (even)
        return part;
    part.mirrored = random_below(random, 2);
    part.scale    = random_between(random, 0.6, 1.3);
    part.turn     = random_between(random, 0, 6);
    part.x += random_between(random, -0.2, 0.2);
    return part;
}

/* Some parts, with their boundary and text. */
typedef struct Member {
    Part      parts[MAX_PARTS];
    int       count;
    Boundary  boundary;
    SceneText text;
} Member;

/* Returns false if next to nothing is left of it. */
static bool random_member(Random *random, bool even, Member *member)
{
    member->count       = 2 + random_below(random, 4);
    member->text.length = 0;
    for (int k = 0; k < member->count; k++)
        member->parts[k] = random_part(random, even);
    find_boundary(member->parts, member->count, &member->boundary);
    write_csg_node(&member->text, member->parts, member->count);
    return member->boundary.count > 100;
}

static double true_distance_of(const Member *member, double x, double y)
{
    return true_distance(&member->boundary, member->parts, member->count, x, y);
}

static void check(const Member *member, const char *figure, Random *random)
{
    Product product = figure_product(figure);
    for (int i = 0; i < POINTS; i++) {
        double x = random_between(random, -2.5, 2.5), y = random_between(random, -2.5, 2.5);
        double truth = true_distance_of(member, x, y);
        double found = product_distance(&product, vec(x, y, 0));
        if (!(fabs(found - truth) <= TOLERANCE))
            fail_msg("%s\nat (%.9g, %.9g): %.9g, truly %.9g", figure, x, y, found, truth);
    }
    product_free(&product);
}

static void csg_nodes_have_true_distances(void **state)
{
    static Member member;
    Random        random = {11};
    (void)state;
    for (int i = 0; i < 50; i++)
        if (random_member(&random, i % 2, &member))
            check(&member, member.text.bytes, &random);
}

/* Parts that a loop makes are those that are written out. */
static void loops_have_true_distances(void **state)
{
    static Member member;
    Random        random = {12};
    (void)state;
    member.count = MAX_PARTS;
    for (int i = 0; i < MAX_PARTS; i++)
        member.parts[i] = (Part){.kind  = i < MAX_PARTS / 2 ? CIRCLE : RECTANGLE,
                                 .a     = i < MAX_PARTS / 2 ? 0.5 : 0.75,
                                 .b     = 0.5,
                                 .scale = 1,
                                 .x     = 0.25 * (i % 6) - 0.75,
                                 .y     = i < MAX_PARTS / 2 ? 0 : 0.125 * (i % 6),
                                 .join  = '|'};
    find_boundary(member.parts, member.count, &member.boundary);
    check(&member,
          "union(union([circle(0.5).move([0.25 * i - 0.75, 0]) for i in 0..6]),\n"
          "union([rectangle([0.75, 0.5]).move([0.25 * i - 0.75, 0.125 * i]) for i in 0..6]))",
          &random);
}

/* Copies touch, or are cut where they meet. */
static void copies_have_true_distances(void **state)
{
    static const struct {
        const char *text;
        int         count;
        Part        parts[MAX_PARTS];
    } copies[] = {
        {"rectangle([0.5, 0.75]).repeat([0.5, 0.75, 0], [3, 2, 1])",
         1,
         {{.kind = RECTANGLE, .a = 1.5, .b = 1.5, .scale = 1}}},
        {"circle(0.5).repeat([1, 0, 0], [3, 1, 1]) | rectangle([3, 0.25])",
         4,
         {{.kind = CIRCLE, .a = 0.5, .scale = 1, .x = -1},
          {.kind = CIRCLE, .a = 0.5, .scale = 1, .join = '|'},
          {.kind = CIRCLE, .a = 0.5, .scale = 1, .x = 1, .join = '|'},
          {.kind = RECTANGLE, .a = 3, .b = 0.25, .scale = 1, .join = '|'}}},
        {"circle(0.75).move([-0.25, 0.125]).mirror(plane([1, 0, 0], 0))",
         2,
         {{.kind = CIRCLE, .a = 0.75, .scale = 1, .x = -0.25, .y = 0.125},
          {.kind = CIRCLE, .a = 0.75, .scale = 1, .x = 0.25, .y = 0.125, .join = '|'}}},
        {"circle(0.75).move([0.25, 0.125]).mirror(plane([1, 0, 0], 0))",
         2,
         {{.kind = CIRCLE, .a = 0.75, .scale = 1, .x = -0.25, .y = 0.125},
          {.kind = CIRCLE, .a = 0.75, .scale = 1, .x = 0.25, .y = 0.125, .join = '&'}}},
    };
    static Member member;
    Random        random = {15};
    (void)state;
    for (size_t i = 0; i < sizeof copies / sizeof *copies; i++) {
        memcpy(member.parts, copies[i].parts, sizeof member.parts);
        member.count = copies[i].count;
        find_boundary(member.parts, member.count, &member.boundary);
        check(&member, copies[i].text, &random);
    }
}

/* A side on the axis is within the solid, so it is no boundary. */
static void solids_of_revolution_have_true_distances(void **state)
{
    static Member member;
    Random        random = {16};
    (void)state;
    for (int i = 0; i < 12; i++) {
        double shift       = i % 3 == 0 ? 0 : quarter(&random, 1, 4);
        int    kept        = 0;
        member.text.length = 0;
        member.count       = 1 + i % 3;
        for (int k = 0; k < member.count; k++) {
            double width    = quarter(&random, 2, 5);
            member.parts[k] = (Part){.kind  = RECTANGLE,
                                     .a     = width,
                                     .b     = quarter(&random, 2, 5),
                                     .scale = 1,
                                     .x     = 0.5 * width - shift,
                                     .y     = quarter(&random, -3, 3),
                                     .join  = "||-"[k]};
        }
        if (member.count == 3)
            member.parts[2].x += 0.5; /* a groove that does not reach the axis */
        find_boundary(member.parts, member.count, &member.boundary);
        write_csg_node(&member.text, member.parts, member.count);
        for (int k = 0; k < member.boundary.count; k++)
            if (member.boundary.points[k][0] > -shift + 1e-9)
                memcpy(member.boundary.points[kept++], member.boundary.points[k],
                       sizeof *member.boundary.points);
        member.boundary.count = kept;
        Product product       = product_format("let solid = %s.revolve(%.17g);\n"
                                                     "shape same() { distance: solid.distance([x, y, z]),\n"
                                                     "               slope: 1, within: box([19, 19, 19]) }\n"
                                                     "show same();\n",
                                               member.text.bytes, shift);
        for (int k = 0; k < POINTS; k++) {
            double radius = k % 4 == 0 ? 0 : random_between(&random, 0, 3),
                   angle = random_between(&random, 0, 6), y = random_between(&random, -2.5, 2.5);
            double truth = true_distance_of(&member, radius - shift + (radius == 0 ? 1e-9 : 0), y);
            double found = product_distance(&product,
                                            vec(radius * cos(angle), y, radius * sin(angle)));
            if (!(fabs(found - truth) <= TOLERANCE))
                fail_msg("%s\nat (%.9g, %.9g): %.9g, truly %.9g", member.text.bytes, radius, y,
                         found, truth);
        }
        product_free(&product);
    }
}

/* At each height the mean of the true distances says what is inside: there is no groove. */
static void lofts_go_by_true_distances(void **state)
{
    static Member member;
    Random        random = {13};
    (void)state;
    for (int i = 0; i < 4; i++) {
        if (!random_member(&random, true, &member))
            continue;
        Product product = product_format("let d = %s;\nshow loft([d, d.scale(0.5)], 2);",
                                         member.text.bytes);
        for (int k = 0; k < POINTS; k++) {
            double x = random_between(&random, -1.5, 1.5), y = random_between(&random, -1.5, 1.5);
            double t    = random_between(&random, 0, 1),
                   mean = (1 - t) * true_distance_of(&member, x, y);
            mean += t * 0.5 * true_distance_of(&member, 2 * x, 2 * y);
            double found = product_distance(&product, vec(x, y, 2 * t - 1));
            if (fabs(mean) > TOLERANCE && (found < 0) != (mean < 0))
                fail_msg("%s\nat (%.9g, %.9g, %.9g): %.9g, the mean is %.9g", member.text.bytes, x,
                         y, 2 * t - 1, found, mean);
        }
        product_free(&product);
    }
}

/* Where a parameter changes a part the distance is a bound, as everywhere else. */
static void parameters_leave_bounds(void **state)
{
    static Member member = {
        .parts = {{.kind = CIRCLE, .a = 1, .scale = 1},
                  {.kind = RECTANGLE, .a = 2, .b = 1, .scale = 1, .y = 1, .join = '|'}},
        .count = 2};
    Random random = {14};
    (void)state;
    find_boundary(member.parts, member.count, &member.boundary);
    Product product = figure_product(
        "circle(r) | rectangle([2, 1]).move([0, 1]); param r = 1 in [0.5, 2]");
    for (int i = 0; i < POINTS; i++) {
        double x = random_between(&random, -2, 2), y = random_between(&random, -2, 2);
        double truth = true_distance_of(&member, x, y);
        double found = product_distance(&product, vec(x, y, 0));
        assert_true(fabs(truth) < TOLERANCE || (found < 0) == (truth < 0));
        assert_true(fabs(found) < fabs(truth) + TOLERANCE);
    }
    product_free(&product);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(csg_nodes_have_true_distances),
        cmocka_unit_test(loops_have_true_distances),
        cmocka_unit_test(copies_have_true_distances),
        cmocka_unit_test(solids_of_revolution_have_true_distances),
        cmocka_unit_test(lofts_go_by_true_distances),
        cmocka_unit_test(parameters_leave_bounds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
