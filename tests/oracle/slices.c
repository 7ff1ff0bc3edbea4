/*
 * slices.c: sections against closed forms, and against whether points are inside.
 */
#include "tests/oracle/product.h"
#include "tests/support/random.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static KrsSlicer *open_slicer(const Product *product, double error, bool arcs)
{
    KrsSliceOptions options = {.error = error, .arcs = arcs};
    KrsSlicer      *slicer;
    assert_int_equal(krs_slicer_new(product->state, &options, &slicer), KRS_OK);
    return slicer;
}

static KrsSection *slice_at(KrsSlicer *slicer, Vec point, Vec normal)
{
    KrsSectionPlane plane = {{point.x, point.y, point.z}, {normal.x, normal.y, normal.z}};
    KrsSection     *section;
    assert_int_equal(krs_slice(slicer, &plane, 1, &section), KRS_OK);
    return section;
}

/* Returns the area of a section without arcs, by its points alone. */
static double area_of_points(const KrsSection *section)
{
    double area = 0;
    for (size_t c = 0; c < section->contour_count; c++) {
        const KrsContour *contour = &section->contours[c];
        for (size_t i = 0; i < contour->count; i++) {
            const double *a = section->points[contour->first + i];
            const double *b = section->points[contour->first + (i + 1) % contour->count];
            area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
        }
    }
    return area;
}

/* How often the contours go around a point, to the left. */
static int winding(const KrsSection *section, const double at[2])
{
    int around = 0;
    for (size_t c = 0; c < section->contour_count; c++) {
        const KrsContour *contour = &section->contours[c];
        for (size_t i = 0; i < contour->count; i++) {
            const double *a    = section->points[contour->first + i];
            const double *b    = section->points[contour->first + (i + 1) % contour->count];
            double        side = (b[0] - a[0]) * (at[1] - a[1]) - (b[1] - a[1]) * (at[0] - a[0]);
            if (a[1] <= at[1] && b[1] > at[1] && side > 0)
                around++;
            if (a[1] > at[1] && b[1] <= at[1] && side < 0)
                around--;
        }
    }
    return around;
}

/* ---- closed forms ---- */

typedef struct Form {
    const char *text;
    double      point[3], normal[3], error;
    double      area;     /* of the section */
    double      length;   /* of its outline: the area is right up to the error along it */
    size_t      contours; /* and holes among them */
    size_t      holes;
    size_t      points; /* 0: as many as are needed */
} Form;

static const Form forms[] = {
    {"show sphere(1);", {0, 0, 0.3}, {0, 0, 1}, 1e-3, 0.91 * 3.14159265358979, 6, 1, 0, 0},
    {"show sphere(1);", {0.1, 0.2, 0.3}, {1, 2, -3}, 1e-4, 3.1056840764, 6.3, 1, 0, 0},
    {"show box([1, 2, 3]);", {0, 0, 0.1}, {0, 0, 1}, 0.01, 2, 0, 1, 0, 4},
    {"show box([1, 2, 3]);", {0, 0, 0.1}, {0, 1, 0}, 0.01, 3, 0, 1, 0, 4},
    {"show box([1, 2, 3]);", {0, 0, 0.1}, {-1, 0, 0}, 0.01, 6, 0, 1, 0, 4},
    {"show box([1, 2, 3]).rotate([0, 0, 1], 30deg);", {0, 0, 0.1}, {0, 0, 1}, 0.01, 2, 0, 1, 0, 4},
    /* Faces stay flat and corners exact, however small the error is. */
    {"show box([20, 10, 4]);", {0, 0, 0.3}, {0, 0, 1}, 1e-4, 200, 0, 1, 0, 4},
    {"show box([20, 10, 4]);", {0, 0, 0.3}, {0, 0, 1}, 1e-5, 200, 0, 1, 0, 4},
    {"show box([3, 2, 1]).rotate([0, 0, 1], 0.1);", {0, 0, 0}, {0, 0, 1}, 1e-5, 6, 0, 1, 0, 4},
    {"show box([20, 10, 4]) - box([3, 2, 9]).move([1, 2, 0]);",
     {0, 0, 0.3},
     {0, 0, 1},
     3e-6,
     194,
     0,
     2,
     1,
     8},
    /* A cube across its diagonal is a hexagon. */
    {"show box([2, 2, 2]);", {0, 0, 0}, {1, 1, 1}, 0.01, 5.196152422706632, 0, 1, 0, 6},
    {"show box([2, 2, 2]).rotate([0, 0, 1], 90deg);", {0, 0, 0}, {0, 0, 1}, 1e-3, 4, 0, 1, 0, 4},
    {"show torus(2, 0.5);", {0, 0, 0}, {0, 1, 0}, 1e-3, 12.566370614359172, 26, 2, 1, 0},
    {"show torus(2, 0.5);", {0, 0, 0}, {1, 0, 0}, 1e-3, 1.5707963267948966, 7, 2, 0, 0},
    {"show cone(1, 2);", {0, -0.5, 0}, {0, 1, 0}, 1e-3, 0, 0, 1, 0, 0},
    {"show cylinder(1, 2) - cylinder(0.5, 3).move([0.2, 0, 0]);",
     {0, 0.1, 0},
     {0, 1, 0},
     1e-4,
     0.75 * 3.14159265358979,
     9.5,
     2,
     1,
     0},
    {"show cylinder(1, 2);",
     {0, 0, 0},
     {1, 1, 0},
     1e-4,
     3.14159265358979 * 1.4142135623731,
     8,
     1,
     0,
     0},
    /* Shells within each other. */
    {"show sphere(2) - sphere(1.5) | sphere(1) - sphere(0.5);",
     {0, 0, 0},
     {0, 0, 1},
     1e-3,
     2.5 * 3.14159265358979,
     32,
     4,
     2,
     0},
    /* Parts that touch along a face are one; nothing is between them. */
    {"show box([1, 1, 1]) | box([1, 1, 1]).move([1, 0, 0]);",
     {0, 0, 0.1},
     {0, 0, 1},
     0.01,
     2,
     0,
     1,
     0,
     4},
    {"show (box([1, 1, 1]) | box([1, 1, 1]).move([1, 0, 0])).rotate([0, 0, 1], 31deg);",
     {0, 0, 0.1},
     {0, 0, 1},
     0.01,
     2,
     0,
     1,
     0,
     4},
    {"show box([4, 4, 1]) - box([1, 1, 2]) - box([1, 1, 2]).rotate([0, 0, 1], 45deg).move([1.2, "
     "1.2, 0]);",
     {0, 0, 0.1},
     {0, 0, 1},
     0.01,
     14,
     0,
     3,
     2,
     12},
    /* A plane that only touches has no dust. */
    {"show torus(2, 0.5);", {0, 0.5, 0}, {0, 1, 0}, 1e-3, 0, 0, 0, 0, 0},
    /* In the plane of a face, of one, and of one that is turned. */
    {"show box([2, 2, 2]);", {0, 0, 1}, {0, 0, 1}, 0.01, 4, 8, 1, 0, 4},
    {"show box([2, 2, 2]);", {0, 0, -1}, {0, 0, 1}, 0.01, 4, 8, 1, 0, 4},
    {"show box([2, 2, 2]);", {0, 0, 1.0001}, {0, 0, 1}, 0.01, 0, 0, 0, 0, 0},
    {"show sphere(1);", {0, 0, 2}, {0, 0, 1}, 0.01, 0, 0, 0, 0, 0},
    {"show regular(7, 1).extrude(1);", {0, 0, 0}, {0, 0, 1}, 0.01, 2.736410188638104, 0, 1, 0, 7},
    {"show star(5, 1, 0.4).extrude(1);",
     {0, 0, 0},
     {0, 0, 1},
     1e-3,
     1.1755705045849463,
     0,
     1,
     0,
     10},
};

static void sections_have_the_areas_of_closed_forms(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        const Form *form    = &forms[i];
        Product     product = product_compile(form->text);
        KrsSlicer  *slicer  = open_slicer(&product, form->error, false);
        KrsSection *section = slice_at(slicer, vec(form->point[0], form->point[1], form->point[2]),
                                       vec(form->normal[0], form->normal[1], form->normal[2]));
        size_t      holes   = 0;
        double      area    = area_of_points(section);
        for (size_t c = 0; c < section->contour_count; c++)
            holes += section->contours[c].area < 0;
        print_message("# area %.9f for %.9f, %zu contours, %zu points: %s\n", area, form->area,
                      section->contour_count, section->point_count, form->text);
        if (form->area > 0 || form->contours == 0)
            assert_true(fabs(area - form->area) <= form->error * form->length + 1e-9);
        assert_int_equal(section->contour_count, form->contours);
        assert_int_equal(holes, form->holes);
        if (form->points > 0)
            assert_int_equal(section->point_count, form->points);
        krs_section_free(section);
        krs_slicer_free(slicer);
        product_free(&product);
    }
}

/* ---- lines and arcs ---- */

typedef struct Figure {
    const char *text;
    double      area;
    size_t      lines, arcs;
} Figure;

/* A point of the piece between two points, at half of its way. */
static void middle_of(const double a[2], const double b[2], double bulge, double at[2])
{
    at[0] = 0.5 * (a[0] + b[0]) + 0.5 * bulge * (b[1] - a[1]);
    at[1] = 0.5 * (a[1] + b[1]) - 0.5 * bulge * (b[0] - a[0]);
}

static void figures_are_of_lines_and_arcs(void **state)
{
    static const double pi        = 3.14159265358979323846;
    const Figure        figures[] = {
               {"circle(1)", pi, 0, 2},
               {"rectangle([4, 3])", 12, 4, 0},
               {"rectangle([4, 3]).round(0.5)", 12 - (4 - pi) * 0.25, 4, 4},
               {"rectangle([4, 3]).round(0.5).rotate(20deg) - circle(0.5).move([1, 0])",
                12 - (4 - pi) * 0.25 - 0.25 * pi, 4, 6},
               {"segment([0, 0], [3, 0], 0.5)", 1.5 + 0.0625 * pi, 2, 2},
               {"rectangle([2, 2]) | circle(1).move([1, 0])", 4 + 0.5 * pi, 3, 1},
               {"polygon([[0, 0], [4, 0], [4, 1], [1, 1], [1, 3], [0, 3]])", 6, 6, 0},
               {"circle(1) & circle(1).move([1, 0])", 2 * pi / 3 - 0.5 * sqrt(3), 0, 2},
               {"circle(1) - circle(1).move([1, 0])", pi / 3 + 0.5 * sqrt(3), 0, 2},
               {"star(12, 1, 0.7)", 8.4 * sin(pi / 12), 24, 0},
               {"star(40, 1, 0.7)", 28 * sin(pi / 40), 80, 0},
               {"star(100, 1, 0.7)", 70 * sin(pi / 100), 200, 0},
               {"star(37, 1, 0.8).rotate(17deg)", 29.6 * sin(pi / 37), 74, 0},
               {"regular(131, 1).rotate(3deg)", 65.5 * sin(pi / 65.5), 131, 0},
               {"regular(220, 1)", 110 * sin(pi / 110), 220, 0},
    };
    (void)state;
    for (size_t i = 0; i < sizeof figures / sizeof *figures; i++) {
        Product     product = product_format("show (%s).extrude(1);", figures[i].text);
        KrsSlicer  *slicer  = open_slicer(&product, 0.001, true);
        KrsSection *section = slice_at(slicer, vec(0, 0, 0), vec(0, 0, 1));
        size_t      lines = 0, arcs = 0;
        double      area = 0;
        for (size_t c = 0; c < section->contour_count; c++) {
            const KrsContour *contour = &section->contours[c];
            area += contour->area;
            for (size_t k = 0; k < contour->count; k++) {
                const double *a     = section->points[contour->first + k];
                const double *b     = section->points[contour->first + (k + 1) % contour->count];
                double        bulge = section->bulges[contour->first + k], at[2];
                middle_of(a, b, bulge, at);
                assert_true(fabs(product_distance(&product, vec(at[0], at[1], 0))) < 1e-4);
                arcs += bulge != 0;
                lines += bulge == 0;
            }
        }
        print_message("# %zu lines, %zu arcs, area %.9f for %.9f: %s\n", lines, arcs, area,
                      figures[i].area, figures[i].text);
        assert_true(fabs(area - figures[i].area) < 1e-4);
        assert_int_equal(lines, figures[i].lines);
        assert_int_equal(arcs, figures[i].arcs);
        krs_section_free(section);
        krs_slicer_free(slicer);
        product_free(&product);
    }
}

/* Boxes of blends and of what is turned have room to spare: layers begin where the solid does. */
static void boxes_are_narrow(void **state)
{
    static const struct {
        const char *text;
        double      low[3], high[3];
    } boxes[] = {
        {"show box([1, 2, 3]);", {-0.5, -1, -1.5}, {0.5, 1, 1.5}},
        {"show sphere(1).rotate([1, 0, 0], 1).move([1, 2, 3]);", {0, 1, 2}, {2, 3, 4}},
        {"show sphere(1) - half_space([0, 0, 1], -0.25);", {-1, -1, -0.25}, {1, 1, 1}},
        {"show torus(2, 0.5).rotate([0, 0, 1], 90deg);", {-0.5, -2.5, -2.5}, {0.5, 2.5, 2.5}},
        {"show union(sphere(1).move([2, 0, 0]), sphere(1).move([-2, 0, 0]), blend: 0.5);",
         {-3, -1, -1},
         {3, 1, 1}},
    };
    (void)state;
    for (size_t i = 0; i < sizeof boxes / sizeof *boxes; i++) {
        Product    product = product_compile(boxes[i].text);
        KrsSlicer *slicer  = open_slicer(&product, 0.01, false);
        double     low[3], high[3];
        assert_true(krs_slicer_box(slicer, low, high));
        print_message("# [%g, %g, %g] to [%g, %g, %g]: %s\n", low[0], low[1], low[2], high[0],
                      high[1], high[2], boxes[i].text);
        for (int k = 0; k < 3; k++) {
            assert_true(fabs(low[k] - boxes[i].low[k]) < 1e-4);
            assert_true(fabs(high[k] - boxes[i].high[k]) < 1e-4);
        }
        krs_slicer_free(slicer);
        product_free(&product);
    }
}

/* ---- random solids ---- */

static void write_part(SceneText *text, Random *random)
{
    static const char *const parts[] = {"box([%.3f, %.3f, %.3f])",
                                        "cylinder(%.3f, %.3f)",
                                        "sphere(%.3f)",
                                        "torus(1.2 * %.3f, 0.4 * %.3f)",
                                        "prism(5, %.3f, %.3f)",
                                        "box([%.3f, %.3f, %.3f]).round(0.1)",
                                        "cone(%.3f, %.3f)",
                                        "star(5, %.3f, 0.3).extrude(%.3f)",
                                        "capsule([0, 0, 0], [%.3f, %.3f, 0.1], 0.3)",
                                        "box([%.3f, %.3f, %.3f]).shell(0.15)"};
    double                   sizes[3], at[3], axis[3];
    for (int k = 0; k < 3; k++)
        sizes[k] = random_between(random, 0.5, 1.5);
    random_vector(random, 1, at);
    random_vector(random, 1, axis);
    char part[256];
    snprintf(part, sizeof part, parts[random_below(random, sizeof parts / sizeof *parts)], sizes[0],
             sizes[1], sizes[2]);
    scene_write(text, "%s", part);
    if (random_below(random, 2) > 0)
        scene_write(text, ".rotate([%.3f, %.3f, %.3f], %.3f)", axis[0], axis[1], axis[2] + 2,
                    random_between(random, -3, 3));
    scene_write(text, ".move([%.3f, %.3f, %.3f])", at[0], at[1], at[2]);
}

static Product random_solid(Random *random)
{
    static const char *const csg_nodes[] = {"union", "difference", "union", "intersection"};
    SceneText                text        = {.length = 0};
    int                      parts       = 2 + random_below(random, 5);
    for (int i = 1; i < parts; i++)
        scene_write(&text, "%s(", i == 1 ? "show union" : csg_nodes[random_below(random, 4)]);
    write_part(&text, random);
    for (int i = 1; i < parts; i++) {
        scene_write(&text, ", ");
        write_part(&text, random);
        scene_write(&text, random_below(random, 3) ? ")" : ", blend: 0.1)");
    }
    scene_write(&text, ";");
    print_message("# %s\n", text.bytes);
    return product_compile(text.bytes);
}

static Vec point_of(const KrsSectionPlane *plane, const double at[2])
{
    double right[3], up[3], normal[3], length = 0, depth = 0, point[3];
    krs_plane_axes(plane, right, up);
    for (int k = 0; k < 3; k++)
        length += plane->normal[k] * plane->normal[k];
    for (int k = 0; k < 3; k++) {
        normal[k] = plane->normal[k] / sqrt(length);
        depth += plane->point[k] * normal[k];
    }
    for (int k = 0; k < 3; k++)
        point[k] = at[0] * right[k] + at[1] * up[k] + depth * normal[k];
    return vec(point[0], point[1], point[2]);
}

/* Points of contours are on the surface, and so are places between them but for the error. */
static void points_are_on_the_surface(const Product *product, const KrsSection *section,
                                      const KrsSectionPlane *plane, double error)
{
    for (size_t c = 0; c < section->contour_count; c++) {
        const KrsContour *contour = &section->contours[c];
        for (size_t i = 0; i < contour->count; i++) {
            const double *a = section->points[contour->first + i];
            const double *b = section->points[contour->first + (i + 1) % contour->count];
            for (int k = 0; k < 4; k++) {
                const double at[2]    = {a[0] + 0.25 * k * (b[0] - a[0]),
                                         a[1] + 0.25 * k * (b[1] - a[1])};
                double       distance = product_distance(product, point_of(plane, at));
                if (fabs(distance) > (k ? 1.01 * error : 0.01 * error))
                    print_message("# %g %g - %g %g\n# %d: at %.9g, %.9g it is %g\n", a[0], a[1],
                                  b[0], b[1], k, at[0], at[1], distance);
                assert_true(fabs(distance) <= (k ? 1.01 * error : 0.01 * error));
            }
        }
    }
}

static double side_of(const double a[2], const double b[2], const double at[2])
{
    return (b[0] - a[0]) * (at[1] - a[1]) - (b[1] - a[1]) * (at[0] - a[0]);
}

/* By how much two pieces cross: what the nearest of their four ends is from the other's line; below 0: not. */
static double crossing_depth(const double a[2], const double b[2], const double c[2],
                             const double d[2])
{
    double first = hypot(b[0] - a[0], b[1] - a[1]), second = hypot(d[0] - c[0], d[1] - c[1]);
    if (side_of(a, b, c) * side_of(a, b, d) >= 0 || side_of(c, d, a) * side_of(c, d, b) >= 0)
        return -1;
    return fmin(fmin(fabs(side_of(a, b, c)), fabs(side_of(a, b, d))) / first,
                fmin(fabs(side_of(c, d, a)), fabs(side_of(c, d, b))) / second);
}

/* Contours do not cross, but where something is thinner than the error, nor does one go back along itself. */
static void contours_do_not_cross(const KrsSection *section, double error)
{
    size_t *next = calloc(section->point_count + 1, sizeof *next);
    for (size_t c = 0; c < section->contour_count; c++)
        for (size_t i = 0; i < section->contours[c].count; i++)
            next[section->contours[c].first + i] = section->contours[c].first +
                                                   (i + 1) % section->contours[c].count;
    for (size_t i = 0; i < section->point_count; i++) {
        const double *a = section->points[i], *b = section->points[next[i]];
        const double *behind = section->points[next[next[i]]];
        double        turn   = atan2(side_of(a, b, behind), (b[0] - a[0]) * (behind[0] - b[0]) +
                                                                (b[1] - a[1]) * (behind[1] - b[1]));
        assert_true(fabs(turn) < 3.1415);
        for (size_t k = 0; k < i; k++)
            assert_true(crossing_depth(a, b, section->points[k], section->points[next[k]]) <=
                        0.5 * error);
    }
    free(next);
}

static void sections_are_where_solids_are(void **state)
{
    enum { SOLIDS = 90, POINTS = 400 };
    Random random = {7};
    size_t told   = 0;
    (void)state;
    for (int i = 0; i < SOLIDS; i++) {
        Product         product = random_solid(&random);
        double          error   = i % 3 ? 0.01 : 0.001;
        KrsSlicer      *slicer  = open_slicer(&product, error, false);
        KrsSectionPlane plane   = {{0, 0, random_between(&random, -0.3, 0.3)}, {0, 0, 1}};
        if (i % 2)
            random_vector(&random, 1, plane.normal);
        KrsSection *section;
        print_message("# error %g, plane 0 0 %.17g %.17g %.17g %.17g\n", error, plane.point[2],
                      plane.normal[0], plane.normal[1], plane.normal[2]);
        assert_int_equal(krs_slice(slicer, &plane, 1, &section), KRS_OK);
        points_are_on_the_surface(&product, section, &plane, error);
        contours_do_not_cross(section, error);
        for (int k = 0; k < POINTS; k++) {
            double at[3];
            random_vector(&random, 2.5, at);
            double distance = product_distance(&product, point_of(&plane, at));
            if (fabs(distance) < 1.5 * error)
                continue;
            told++;
            if (winding(section, at) != (distance < 0))
                print_message("# at %.9g, %.9g it is %g and around %d\n", at[0], at[1], distance,
                              winding(section, at));
            assert_int_equal(winding(section, at), distance < 0);
        }
        krs_section_free(section);
        krs_slicer_free(slicer);
        product_free(&product);
    }
    print_message("# %zu points\n", told);
}

/* ---- what is thinner than the error ---- */

/* A bar along z of a section of 1 by `thin`, or one whose ends are round, turned and moved. */
typedef struct Bar {
    bool   round;
    double thin, angle, at[2];
} Bar;

static Product compile_bars(const Bar *bars, int count)
{
    SceneText text = {.length = 0};
    for (int i = 0; i < count; i++) {
        if (bars[i].round)
            scene_write(&text, "show segment([-0.5, 0], [0.5, 0], %.17g).extrude(1)", bars[i].thin);
        else
            scene_write(&text, "show box([1, %.17g, 1])", bars[i].thin);
        scene_write(&text, ".rotate([0, 0, 1], %.17g).move([%.17g, %.17g, 0]);\n", bars[i].angle,
                    bars[i].at[0], bars[i].at[1]);
    }
    return product_compile(text.bytes);
}

static double area_of_bar(const Bar *bar)
{
    return bar->thin + (bar->round ? 0.25 * 3.14159265358979 * bar->thin * bar->thin : 0);
}

/* Bars and rods between twice the error and a twelfth of it have one contour each, of their area. */
static void thin_parts_are_found(void **state)
{
    enum { SCENES = 24, BARS = 3 };
    Random random = {11};
    (void)state;
    for (int i = 0; i < SCENES; i++) {
        const double error = 0.002;
        Bar          bars[BARS];
        double       area = 0, thinnest = INFINITY;
        for (int k = 0; k < BARS; k++) {
            bars[k] = (Bar){random_below(&random, 3) == 0,
                            error * pow(2, random_between(&random, -3.5, 1)),
                            random_between(&random, -3, 3),
                            {random_between(&random, -0.1, 0.1), 1.5 * k}};
            if (i == 0)
                bars[k].angle = 0;
            area += area_of_bar(&bars[k]);
            thinnest = fmin(thinnest, bars[k].thin);
        }
        Product     product = compile_bars(bars, BARS);
        KrsSlicer  *slicer  = open_slicer(&product, error, false);
        KrsSection *section = slice_at(slicer, vec(0, 0, 0.1), vec(0, 0, 1));
        print_message(
            "# %d: area %.9f for %.9f, %zu contours, thinnest %g of the error, %zu lost\n", i,
            area_of_points(section), area, section->contour_count, thinnest / error, section->lost);
        if (section->contour_count != BARS)
            for (int k = 0; k < BARS; k++)
                print_message("# %d %g %g at %g %g\n", bars[k].round, bars[k].thin / error,
                              bars[k].angle, bars[k].at[0], bars[k].at[1]);
        assert_int_equal(section->contour_count, BARS);
        assert_true(section->lost <= 2 * BARS); /* of their ends */
        assert_true(fabs(area_of_points(section) / area - 1) < 0.15);
        krs_section_free(section);
        krs_slicer_free(slicer);
        product_free(&product);
    }
}

/* What is thinner still is counted, at a place in it: bars and rods, and slots; corners of what is thick are not. */
static void thinner_parts_are_counted(void **state)
{
    enum { SCENES = 24 };
    Random random = {12};
    (void)state;
    for (int i = 0; i < SCENES; i++) {
        const double thin = pow(10, random_between(&random, -8.5, -5.5)),
                     turn = i % 4 ? 0.1 * i : 0;
        Product product =
            i % 3 == 0
                ? product_format("show box([2, 2, 2]).rotate([0, 0, 1], %.17g) - box([1, %.17g, "
                                 "3]).move([0.1, 0.05, 0]);",
                                 turn, thin)
            : i % 3 == 1
                ? product_format(
                      "show box([0.3, 0.2, 1]).rotate([0, 0, 1], %.17g); show box([%.17g, 1, "
                      "1]).rotate([0, 0, 1], %.17g).move([1, 0, 0]);",
                      turn, thin, -turn)
                : product_format(
                      "show prism(3, 0.3, 1).rotate([1, 0, 0], 90deg).rotate([0, 0, 1], %.17g); "
                      "show sphere(%.17g).move([1, 0.1, 0]);",
                      turn, 0.5 * thin);
        KrsSlicer    *slicer  = open_slicer(&product, 0.002, false);
        KrsSection   *section = slice_at(slicer, vec(0, 0, 0), vec(0, 0, 1));
        const double *at      = section->lost_at;
        print_message("# %d: thickness %g, %zu contours, %zu lost, at %g %g %g\n", i, thin,
                      section->contour_count, section->lost, at[0], at[1], at[2]);
        assert_int_equal(section->contour_count, 1);
        assert_true(section->lost > 0);
        assert_true(section->thinnest > thin && section->thinnest < 0.002);
        assert_true(fabs(product_distance(&product, vec(at[0], at[1], at[2]))) < thin);
        krs_section_free(section);
        krs_slicer_free(slicer);
        product_free(&product);
    }
}

/* ---- saddles ---- */

/* A section of known area: one contour, or two; parts as thick as `neck` are between two, or join them. */
typedef struct Saddle {
    Product product;
    Vec     point, normal;
    double  area, length; /* of the section, and of its outline */
    size_t  contours;
} Saddle;

static const double PI = 3.14159265358979323846;

/* Writes where it is moved and turned. */
static void write_place(SceneText *text, Random *random)
{
    double angle = random_between(random, -3, 3), x = random_between(random, -0.3, 0.3);
    scene_write(text, ".rotate([0, 0, 1], %.17g).move([%.17g, %.17g, 0])", angle, x,
                random_between(random, -0.3, 0.3));
}

static Product compile_placed(Random *random, const char *format, double a, double b, double c)
{
    SceneText text = {.length = 0};
    char      solid[512];
    snprintf(solid, sizeof solid, format, a, b, c);
    scene_write(&text, "show (%s)", solid);
    write_place(&text, random);
    scene_write(&text, ";");
    print_message("# %s\n", text.bytes);
    return product_compile(text.bytes);
}

/* Returns two discs that nearly touch, or two holes. */
static Saddle make_discs(Random *random, double neck)
{
    const double r = random_between(random, 0.3, 1), q = random_between(random, 0.3, 1);
    const bool   holes  = random_below(random, 2) > 0;
    Saddle       saddle = {.normal = {0, 0, 1}};
    saddle.product      = compile_placed(
             random,
        holes ? "sphere(4) - sphere(%.17g) - sphere(%.17g).move([%.17g, 0, 0])"
                   : "sphere(%.17g) | sphere(%.17g).move([%.17g, 0, 0])",
             r, q, r + q + neck);
    saddle.area     = PI * (r * r + q * q);
    saddle.length   = 2 * PI * (r + q + (holes ? 4 : 0));
    saddle.contours = 2;
    if (holes) {
        saddle.area     = 16 * PI - saddle.area;
        saddle.contours = 3;
    }
    return saddle;
}

/* Returns two lemniscates of Bernoulli's kind, of a half axis near 1: their neck joins or parts
   them. */
static Saddle make_ovals(Random *random, double neck)
{
    const double half = 0.5 * neck, part = random_below(random, 2) ? -1 : 1;
    const double level  = pow(half, 4) + part * 2 * half * half;
    Saddle       saddle = {.normal = {0, 0, 1}, .length = 8};
    saddle.product      = compile_placed(
             random, "algebraic((x^2 + y^2)^2 - 2 * (x^2 - y^2) + %.17g * z^4 == %.17g)", 0.01, level,
             0);
    saddle.area     = 2; /* of the one between both, but for a part as small as the neck */
    saddle.contours = part > 0 ? 1 : 2;
    return saddle;
}

/* A torus cut beside the plane that touches it from within, a figure of eight.  The distance is shallow there, so necks
   are wider. */
static Saddle make_ring(Random *random, double least)
{
    const double neck  = 4 * least;
    const double major = random_between(random, 0.8, 1.2), minor = random_between(random, 0.2, 0.5);
    const double half = 0.5 * neck, inner = major - minor;
    const bool   apart  = random_below(random, 2) > 0;
    const double height = apart ? sqrt(inner * inner - half * half)
                                : major - sqrt(minor * minor - half * half);
    Saddle       saddle = {.point = {height, 0, 0}, .normal = {1, 0, 0}, .length = 8};
    saddle.product  = product_format("show torus(%.17g, %.17g).rotate([1, 0, 0], %.17g);", major,
                                     minor, random_between(random, -3, 3));
    saddle.contours = apart ? 2 : 1;
    /* Simpson's rule, of the width at each height over the plane's middle line. */
    const int steps = 20000;
    for (int i = 0; i <= steps; i++) {
        double z = (major + minor) * i / steps, round = hypot(z, height) - major;
        double wide = minor * minor - round * round;
        saddle.area += (i == 0 || i == steps ? 1 : i % 2 ? 4 : 2) * (wide > 0 ? 2 * sqrt(wide) : 0);
    }
    saddle.area *= 2 * (major + minor) / steps / 3;
    return saddle;
}

/* Returns a wall that stands on a block, and a slot into one. */
static Saddle make_wall(Random *random, double neck)
{
    const double length = random_between(random, 0.4, 0.55), at = random_between(random, -0.2, 0.2);
    const bool   slot   = random_below(random, 2) > 0;
    Saddle       saddle = {.normal = {0, 0, 1}, .length = 2, .contours = 1};
    saddle.product      = compile_placed(
             random,
        slot ? "box([0.6, 0.6, 1]) - box([%.17g, %.17g, 2]).move([0.3, %.17g, 0])"
                  : "box([0.6, 0.6, 1]) | box([%.17g, %.17g, 1]).move([0.3, %.17g, 0])",
             2 * length, neck, at);
    saddle.area = 0.36 + (slot ? -length : length) * neck;
    return saddle;
}

/* Returns two blocks with a bar between them. */
static Saddle make_bridge(Random *random, double neck)
{
    Saddle saddle  = {.normal = {0, 0, 1}, .length = 4, .contours = 1};
    saddle.product = compile_placed(random,
                                    "box([0.4, 0.4, 1]).move([-%.17g, 0, 0]) | box([0.4, 0.4, "
                                    "1]).move([%.17g, 0, 0]) | box([0.8, %.17g, 1])",
                                    0.4, 0.4, neck);
    saddle.area    = 0.32 + 0.4 * neck;
    return saddle;
}

/* What is between two contours, or joins them, is told down to an eighth of the error, also where it widens to both
   sides, or to one. */
static void saddles_are_told(void **state)
{
    enum { SADDLES = 75 };
    typedef Saddle           MakeSaddle(Random * random, double neck);
    static MakeSaddle *const makers[] = {make_discs, make_ovals, make_ring, make_wall, make_bridge};
    Random                   random   = {13};
    (void)state;
    for (int i = 0; i < SADDLES; i++) {
        const double error = 0.005, neck = error * pow(2, random_between(&random, -2.9, 1));
        Saddle       saddle  = makers[i % 5](&random, neck);
        KrsSlicer   *slicer  = open_slicer(&saddle.product, error, false);
        KrsSection  *section = slice_at(slicer, saddle.point, saddle.normal);
        double       area    = area_of_points(section);
        print_message("# %d: neck %g of the error, area %.9f for %.9f, %zu contours for %zu\n", i,
                      neck / error, area, saddle.area, section->contour_count, saddle.contours);
        assert_int_equal(section->contour_count, saddle.contours);
        assert_true(fabs(area - saddle.area) < error * saddle.length);
        krs_section_free(section);
        krs_slicer_free(slicer);
        product_free(&saddle.product);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sections_are_where_solids_are),
        cmocka_unit_test(boxes_are_narrow),
        cmocka_unit_test(thin_parts_are_found),
        cmocka_unit_test(thinner_parts_are_counted),
        cmocka_unit_test(saddles_are_told),
        cmocka_unit_test(figures_are_of_lines_and_arcs),
        cmocka_unit_test(sections_have_the_areas_of_closed_forms),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
