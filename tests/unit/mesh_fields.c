/* mesh_fields.c: what the mesher knows of a scene in a box, against the distances at points of the box. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/base/vec.h"
#include "compiler/scene/program.h"
#include "mesh/proof/smooth.h"
#include "tests/support/random.h"

enum { BOXES = 400, POINTS = 32 };

static Random chance = {7};

static double uniform(double low, double high) { return random_between(&chance, low, high); }

typedef struct Opened {
    KrsScene *scene;
    MeshSolid solid;
    Memory    memory;
    Arena     arena;
    MeshField field;
} Opened;

static Opened *open_field(const char *text)
{
    Opened *o = calloc(1, sizeof *o);
    assert_non_null(o);
    KrsState  *state;
    KrsOptions options = {.outlines = true};
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", &options, &o->scene),
                     KRS_OK);
    assert_int_equal(krs_state_new(o->scene, &state), KRS_OK);
    o->memory       = o->scene->memory;
    o->memory.used  = 0;
    o->memory.limit = (size_t)1 << 30;
    o->arena.memory = &o->memory;
    o->solid.roots  = malloc(solid_root_bytes(o->scene));
    solid_of_components(o->scene, NULL, &o->solid);
    o->field = (MeshField){.state = state, .solid = &o->solid};
    state_refresh(o->field.state);
    field_open(&o->field, &o->arena);
    return o;
}

static void close_field(Opened *o)
{
    arena_free(&o->arena);
    free(o->solid.roots);
    krs_state_free(o->field.state);
    krs_scene_free(o->scene);
    free(o);
}

static Box random_box(double size, double most)
{
    Box    box;
    double half = most * exp(uniform(-4, 0));
    for (int k = 0; k < 3; k++) {
        double at   = uniform(-size, size);
        box.axis[k] = (Range){at - half * uniform(0.2, 1), at + half * uniform(0.2, 1)};
    }
    return box;
}

static void points_in(Box box, double points[POINTS][3])
{
    for (int i = 0; i < POINTS; i++)
        for (int k = 0; k < 3; k++)
            points[i][k] = i < 8 ? (i >> k & 1 ? box.axis[k].high : box.axis[k].low)
                                 : uniform(box.axis[k].low, box.axis[k].high);
}

/* Text is an outline of a table, with curves. */
static void ranges_of_outlines_hold(void **context)
{
    Opened *o     = open_field("show text(\"S8&\", size: 2).extrude(0.3);");
    size_t  sided = 0;
    double  worst = 0;
    (void)context;
    for (int i = 0; i < BOXES; i++) {
        double points[POINTS][3], distances[POINTS], diagonal = 0;
        Box    box   = random_box(2, 0.5);
        Range  range = field_range(&o->field, box);
        points_in(box, points);
        for (int k = 0; k < 3; k++)
            diagonal = hypot(diagonal, box.axis[k].high - box.axis[k].low);
        field_distances(&o->field, (const double(*)[3])points, POINTS, distances);
        for (int k = 0; k < POINTS; k++) {
            double middle = 0.5 * (range.low + range.high);
            assert_true(distances[k] >= range.low && distances[k] <= range.high);
            worst = fmax(worst, fabs(distances[k] - middle) / (0.5 * diagonal));
        }
        sided += range.low > 0 || range.high < 0;
    }
    /* They are narrow, and points use what they permit. */
    assert_true(sided > BOXES / 4 && worst > 0.6);
    close_field(o);
}

static double value_of(const FieldPieces *pieces, const double *values)
{
    double stack[MAX_PIECE_STEPS];
    int    depth = 0;
    for (size_t i = 0; i < pieces->step_count; i++) {
        int step = pieces->steps[i];
        if (step >= 0) {
            stack[depth++] = values[step];
        } else {
            double b = stack[--depth], a = stack[depth - 1];
            stack[depth - 1] = step == PIECE_MAX ? fmax(a, b) : fmin(a, b);
        }
    }
    assert_int_equal(depth, 1);
    return stack[0];
}

/* Returns in how many boxes there are some, and points on both sides. */
static size_t try_pieces(const char *text)
{
    Opened *o       = open_field(text);
    size_t  crossed = 0;
    for (int i = 0; i < BOXES; i++) {
        double      points[POINTS][3], distances[POINTS], values[POINTS * MAX_PIECES];
        FieldPieces pieces;
        Box         box = random_box(1.2, 0.7);
        if (!field_enter(&o->field, box))
            continue;
        if (field_pieces(&o->field, box, &pieces) && pieces.side == 0) {
            bool sides[2] = {false, false};
            points_in(box, points);
            field_distances(&o->field, (const double(*)[3])points, POINTS, distances);
            field_piece_values(&o->field, &pieces, (const double(*)[3])points, POINTS, values);
            for (int k = 0; k < POINTS; k++) {
                double value = value_of(&pieces, values + (size_t)k * pieces.count);
                if (fabs(distances[k]) > 1e-9)
                    assert_true((value > 0) == (distances[k] > 0));
                sides[distances[k] > 0] = true;
            }
            crossed += sides[0] && sides[1];
        }
        field_leave(&o->field);
    }
    close_field(o);
    return crossed;
}

static void pieces_have_the_sign_of_the_distance(void **context)
{
    (void)context;
    assert_true(try_pieces("show box([2, 1, 1.5]);") > 20);
    assert_true(try_pieces("show box([2, 1, 1.5]).offset(-0.2);") > 20);
    assert_true(try_pieces("show box([2, 1, 1.5]).round(0.2);") > 0);
    assert_true(try_pieces("show rectangle([2, 1]).extrude(1.5).offset(0.05);") > 0);
    assert_true(try_pieces("show box([2, 1, 1.5]).round(0.2) - cylinder(0.5, 3).offset(0.1);") > 0);
    assert_true(try_pieces("show cylinder(0.2, 3).move([0.8, 0, 0]).repeat_polar(5);") > 0);
    assert_true(try_pieces("show star(5, 1, 0.4).extrude(1).twist([0, 0, 1], 0.5);") > 20);
    assert_true(try_pieces("show star(5, 1, 0.4).offset(0.05).extrude(1);") > 0);
    assert_true(try_pieces("show star(5, 1, 0.4).offset(-0.05).extrude(1);") > 0);
    assert_true(try_pieces("show box([2, 1, 0.5]).bend([1, 0, 0], 0.5);") > 20);
}

/* In a cube, so that it has an end. */
#define IN_CUBE(distance)                                                                     \
    "shape part() { distance: max(" distance ", max(abs(x), abs(y), abs(z)) - 1), slope: 1, " \
    "within: [-[1, 1, 1], [1, 1, 1]] } show part();"

/* Sums of minima, distances to multiples of a number, and choices that tell the sign. */
static void sums_and_choices_have_pieces(void **context)
{
    (void)context;
    assert_true(try_pieces("show field(2 * abs(x) + abs(abs(y) - 0.3) - 0.5 * z - 0.2);") > 20);
    assert_true(try_pieces("show thread(diameter: 1.6, pitch: 0.5, length: 1.6);") > 20);
    assert_true(try_pieces("show field(y - 0.3 * sin(3 * x)).within(box([2, 1.2, 2]));") > 40);
    assert_true(try_pieces(IN_CUBE("(y + abs(x - 0.4 * round(x / 0.4))) / 2")) > 20);
    assert_true(try_pieces(IN_CUBE("if x <= 0 and not (y > 0) then -sqrt(min(x * x, y * y)) "
                                   "else length([max(x, 0), max(y, 0)])")) > 20);
}

/* In how many boxes around the face of touching solids there are no pieces, since all is inside, or outside of it. */
static size_t try_touching(const char *text, int side)
{
    Opened *o     = open_field(text);
    size_t  found = 0;
    for (int i = 0; i < BOXES; i++) {
        double      points[POINTS][3], distances[POINTS];
        FieldPieces pieces;
        Box         box = random_box(0.6, 0.2);
        if (!field_enter(&o->field, box))
            continue;
        if (field_pieces(&o->field, box, &pieces) && pieces.side != 0) {
            assert_int_equal(pieces.side, side);
            points_in(box, points);
            field_distances(&o->field, (const double(*)[3])points, POINTS, distances);
            for (int k = 0; k < POINTS; k++)
                assert_true(side * distances[k] >= -1e-12);
            found++;
        }
        field_leave(&o->field);
    }
    close_field(o);
    return found;
}

/* Turned, and with a gap or a skin that is thin, they do not touch.  Those of boxes that overlap by little tell nothing within both,
   and what is beside them has the sign of the distance. */
static void touching_faces_are_no_surface(void **context)
{
    (void)context;
    assert_true(try_pieces("show box([2, 1, 2]).move([0, 0.5, 0]) | "
                           "box([1.6, 1.00001, 1.6]).move([0.1, -0.5, 0]);") > 20);
    assert_true(try_pieces("show box([2, 2, 2]) - box([1.6, 1, 1.6]).move([0, 1, 0]) - "
                           "box([1.2, 1.00001, 1.2]).move([0.1, 0, 0]);") > 20);
    assert_true(
        try_touching("show box([2, 1, 2]).move([0, 0.5, 0]) | box([2, 1, 2]).move([0, -0.5, 0]);",
                     -1) > 10);
    assert_true(
        try_touching(
            "show (box([2, 1, 2]).move([0.3, 0.6, 0]) | cylinder(0.9, 1).move([0.3, -0.4, 0]))"
            ".rotate([1, 2, 3], 40deg);",
            -1) > 10);
    assert_true(
        try_touching("show box([2, 1, 2]).move([0, 0.5, 0]) - box([1.4, 2, 1.4]).move([0, 1, 0]);",
                     1) > 10);
    assert_int_equal(try_touching("show box([2, 1, 2]).move([0, 0.5, 0]) | "
                                  "box([2, 1, 2]).move([0, -0.5000001, 0]);",
                                  -1),
                     0);
    assert_int_equal(
        try_touching(
            "show box([2, 1, 2]).move([0, 0.5, 0]) - box([1.4, 2, 1.4]).move([0, 1.0000001, 0]);",
            1),
        0);
}

/* A box that is not entered has no surface, and in one that is distances are as before. */
static void boxes_that_are_left_out_are_empty(void **context)
{
    static const char *const TEXTS[] = {
        "show text(\"S8&\", size: 2).extrude(1);",
        "show text(\"S8&\", size: 2).extrude(1).taper([0, 0, 1], 1, 0.7);",
        "show polygon([[0, 0], [1, 0], [0, 1]]).extrude(1).taper([0, 0, 1], 1, 0.7);",
        "show star(5, 1, 0.5).extrude(1).bend([1, 0, 0], 0.3);"};
    static const Box ALL = {
        {{-1.1, 1.1}, {-1.1, 1.1}, {-1.1, 1.1}}}; /* at its axis a taper goes far */
    (void)context;
    for (size_t t = 0; t < sizeof TEXTS / sizeof *TEXTS; t++) {
        Opened *o       = open_field(TEXTS[t]);
        size_t  entered = 0;
        for (int i = 0; i < BOXES; i++) {
            double points[POINTS][3], before[POINTS], after[POINTS];
            Box    box = i == 0 ? ALL : random_box(1.5, 0.5);
            points_in(box, points);
            field_distances(&o->field, (const double(*)[3])points, POINTS, before);
            bool inside = field_enter(&o->field, box);
            if (inside)
                field_distances(&o->field, (const double(*)[3])points, POINTS, after);
            for (int k = 0; k < POINTS; k++)
                if (inside ? after[k] != before[k] : (before[k] > 0) != (before[0] > 0))
                    fail_msg("%s: box %d, point %d: %g, %g", TEXTS[t], i, k, before[k],
                             inside ? after[k] : before[0]);
            entered += inside;
            if (inside)
                field_leave(&o->field);
        }
        assert_true(entered > BOXES / 40);
        close_field(o);
    }
}

/* In one half of a plate, beyond its middle plane, only one of its faces decides. */
static void faces_that_are_far_are_no_pieces(void **context)
{
    static const char *const PLATES[] = {"show box([2, 0.4, 1.5]);",
                                         "show box([2, 0.4, 1.5]).round(0.1);",
                                         "show box([2, 0.4, 1.5]) | sphere(0.2).move([0, -2, 0]);"};
    static const Box         HALF     = {{{-0.3, 0.3}, {-0.1, 0.4}, {-0.3, 0.3}}};
    (void)context;
    for (size_t i = 0; i < sizeof PLATES / sizeof *PLATES; i++) {
        Opened     *o = open_field(PLATES[i]);
        FieldPieces pieces;
        assert_true(field_enter(&o->field, HALF));
        assert_true(field_pieces(&o->field, HALF, &pieces));
        assert_int_equal(pieces.count, 1);
        close_field(o);
    }
    assert_true(try_pieces("show box([2, 0.4, 1.5]).round(0.1) - box([0.3, 1, 0.3]);") > 20);
}

/* Answers in boxes within boxes are those of the whole, bit for bit.  Only one that is much smaller has a tape of its
   own. */
static void little_is_gained_in_boxes_of_the_same_size(void **context)
{
    static const char BALLS[] =
        "show union([sphere(0.2).move([a, b, c]) for a in [-0.5, 0, 0.5] for b in [-0.5, 0, 0.5] "
        "for c in [-0.5, 0, 0.5]]);";
    static const Box OUTER = {{{-1, 1}, {-1, 1}, {-1, 1}}}, SAME = {{{-1, 0.9}, {-1, 1}, {-1, 1}}},
                     SMALL = {{{0.4, 0.7}, {0.4, 0.7}, {0.4, 0.7}}};
    Opened *o              = open_field(BALLS);
    double  points[POINTS][3], whole[POINTS], within[POINTS];
    (void)context;
    points_in(SMALL, points);
    field_distances(&o->field, (const double(*)[3])points, POINTS, whole);
    assert_true(field_enter(&o->field, OUTER));
    size_t steps = o->field.regions[0].tape.count;
    assert_true(field_enter(&o->field, SAME));
    assert_int_equal(o->field.regions[1].tape.count, steps);
    field_distances(&o->field, (const double(*)[3])points, POINTS, within);
    assert_memory_equal(within, whole, sizeof whole);
    field_leave(&o->field);
    assert_true(field_enter(&o->field, SMALL));
    assert_true(o->field.regions[1].tape.count < steps / 2);
    field_distances(&o->field, (const double(*)[3])points, POINTS, within);
    assert_memory_equal(within, whole, sizeof whole);
    field_leave(&o->field);
    field_leave(&o->field);
    assert_int_equal(o->field.region_count, 0);
    close_field(o);
}

/* A number whose parts above and below 0 are added is as steep as it is, and no corner.  The length of the part below
   has the other sign: with it there is a corner. */
static void parts_of_a_number_are_that_number(void **context)
{
    static const struct {
        const char *text;
        bool        smooth;
    } SUMS[]                = {{"show box([2, 2, 2]);", true},
                               {"show field(max(x - 1, 0) + length([min(x - 1, 0), 0, 0]) - 0.01);", false}};
    static const Box ACROSS = {{{0.9, 1.1}, {-0.1, 0.1}, {-0.1, 0.1}}};
    (void)context;
    for (size_t i = 0; i < sizeof SUMS / sizeof *SUMS; i++) {
        Opened     *o = open_field(SUMS[i].text);
        Range       range;
        LaneSlope   slope;
        LaneHessian hessian;
        assert_true(field_enter(&o->field, ACROSS));
        assert_true(field_slope(&o->field, ACROSS, &range, &slope));
        assert_true(fabs(slope.by[0].low - (SUMS[i].smooth ? 1 : -1)) < 1e-9);
        assert_true(fabs(slope.by[0].high - 1) < 1e-9 && slope.by[1].low == 0 &&
                    slope.by[2].high == 0);
        assert_int_equal(field_hessian(&o->field, ACROSS, &range, &slope, &hessian),
                         SUMS[i].smooth);
        close_field(o);
    }
}

/* What the value grows by along a normal, by a difference. */
static double growth_at(const MeshField *field, const double p[3], const double normal[3])
{
    const double step = 1e-5;
    double       ends[2][3], values[2];
    add_scaled3(ends[0], p, -step, normal);
    add_scaled3(ends[1], p, step, normal);
    field_distances(field, (const double(*)[3])ends, 2, values);
    return (values[1] - values[0]) / (2 * step);
}

/* Returns the least growth on ways along a normal that begin in a box, where the value is at most
   the error, and are as long. */
static double min_growth(const MeshField *field, Box box, double error, const double normal[3])
{
    double points[POINTS][3], values[POINTS], least = INFINITY;
    points_in(box, points);
    field_distances(field, (const double(*)[3])points, POINTS, values);
    for (int i = 0; i < POINTS; i++)
        for (int way = -4; fabs(values[i]) <= error && way <= 4; way++) {
            double p[3];
            add_scaled3(p, points[i], 0.25 * way * error, normal);
            least = fmin(least, growth_at(field, p, normal));
        }
    return least;
}

static Box wider(Box box, double margin)
{
    for (int k = 0; k < 3; k++) {
        box.axis[k].low -= margin;
        box.axis[k].high += margin;
    }
    return box;
}

/* What the slope of a box is of the least growth, which it must not exceed; 0: nothing is known of it. */
static double slope_share(MeshField *field, Box inner, double error)
{
    SmoothCell cell;
    double     middle[3], normal[3], least;
    for (int k = 0; k < 3; k++)
        middle[k] = 0.5 * (inner.axis[k].low + inner.axis[k].high);
    smooth_bound(field, wider(inner, error), error, &cell);
    if (!cell.known || cell.empty || !field_normal(field, middle, 1e-2 * error, normal))
        return 0;
    cell.slope = 0; /* it is that along another normal */
    smooth_narrow(field, error, &cell);
    least = min_growth(field, inner, error, normal);
    return cell.slope > 0 && least < INFINITY ? cell.slope / least : 0;
}

/* After a closer look no value grows by less than the slope, also on ways that lead out of the box.  Gradients turn, and
   change in length, along them. */
static void slopes_of_ways_hold(void **context)
{
    static const double ERROR = 0.05;
    Opened *o     = open_field("show field(sin(2 * x) + 0.4 * cos(1.5 * y) * sin(z) - 0.6);");
    double  most  = 0;
    int     known = 0;
    (void)context;
    for (int i = 0; i < 10 * BOXES; i++) {
        Box inner = random_box(1.2, 0.3);
        if (!field_enter(&o->field, wider(inner, 2 * ERROR)))
            continue;
        double share = slope_share(&o->field, inner, ERROR);
        field_leave(&o->field);
        assert_true(share >= 0 && share <= 1 + 1e-6);
        most = fmax(most, share);
        known += share > 0;
    }
    print_message("# %d boxes, slopes of up to %.3f of the least growth\n", known, most);
    assert_true(known > BOXES && most > 0.95);
    close_field(o);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ranges_of_outlines_hold),
        cmocka_unit_test(pieces_have_the_sign_of_the_distance),
        cmocka_unit_test(faces_that_are_far_are_no_pieces),
        cmocka_unit_test(parts_of_a_number_are_that_number),
        cmocka_unit_test(little_is_gained_in_boxes_of_the_same_size),
        cmocka_unit_test(slopes_of_ways_hold),
        cmocka_unit_test(boxes_that_are_left_out_are_empty),
        cmocka_unit_test(sums_and_choices_have_pieces),
        cmocka_unit_test(touching_faces_are_no_surface),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
