/*
 * occlusion.c: how open places are to the sky, held against closed forms, exact rays, and in random
 * rooms against Monte Carlo in double precision.
 *
 * Openness is the part of the hemisphere, by the cosine, in which there is only sky.  What rays that
 * fall would meet beyond the reach R does not count.  A scene that has no end reaches 0.15 of the way
 * from the eye to its target.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/oracle/exact.h"
#include "tests/oracle/montecarlo.h"
#include "tests/oracle/path_fixture.h"
#include "tests/oracle/product.h"
#include "tests/support/renderer.h"

/* What is asked for, of means of 5x5 pixels of openness. */
#define MAX_MISJUDGED   0.02 /* root of the mean square */
#define MAX_UNLIKE      5e-3 /* by how much openness changes with a bound, on average */
#define MIN_CONVEX      0.998
#define MAX_BESIDE_WALL 0.018 /* on average, of the first pixels at the foot of a wall */
#define MAX_WRONG       0.035 /* in random rooms on average */
#define MIN_OPEN        0.07  /* where white occluders are held against a white world */
#define MAX_BIAS        0.01  /* of the mean of a picture from a closed form */
#define MAX_SPREAD      0.03  /* of its pixels */

#define REACH 0.15 /* of the way from the eye to the target */

enum { WIDTH = 320, HEIGHT = 180 };

/* ---- Pictures ---- */

/* White sky, no light, and a surface that reflects half of red, no green and all of blue.  What
   its coat reflects is the same in all colours.  Blue light below the coat is what a white surface
   gives back, all of it however closed it is; of red so much is left as says how open it is. */
#define WHITE_SKY                                                        \
    "sky { zenith: [1, 1, 1], horizon: [1, 1, 1], ground: [1, 1, 1] }\n" \
    "light none { direction: [0, 1, 0], intensity: 0, shadow: false }\n" \
    "material striped { color: [0.5, 0, 1], roughness: 1 }\n"
#define OPEN_SKY                                                                                \
    WHITE_SKY                                                                                   \
    "camera { eye: [2, 40, 40], target: [2, 0, 0], projection: \"orthographic\", height: 9 }\n" \
    "show plane([0, 1, 0], 0).paint(striped);\n"

static double openness_to_sky(const KrsPicture *picture, int k)
{
    const float *color = picture->color + 4 * k;
    double below = ((double)color[0] - (double)color[1]) / ((double)color[2] - (double)color[1]);
    return below / (1 - below); /* below = 0.5 open / (1 - 0.5 (1 - open)) */
}

static Vec position_of(const KrsPicture *picture, int k)
{
    const float *at = picture->position + 3 * k;
    return vec((double)at[0], (double)at[1], (double)at[2]);
}

/* ---- What exact rays see ---- */

static const KrsRenderOptions WALL_VIEW = {
    .width = 160, .height = 48, .methods.no_upsampling = true};

static int count_closed(const KrsPicture *picture)
{
    int closed = 0;
    for (int k = 0; k < 160 * 48; k++)
        closed += picture->component[k] == 1 && fabs(openness_to_sky(picture, k) - 1) > 1e-3;
    return closed;
}

static void open_ground_is_open(void **state)
{
    (void)state;
    KrsPicture *picture = picture_of(OPEN_SKY, &WALL_VIEW);
    assert_int_equal(count_closed(picture), 0);
    krs_picture_free(picture);
}

/* Returns how open ground is at a distance from a long wall so high. */
static double openness_before_wall(double distance, double height)
{
    return 0.5 + 0.5 * distance / hypot(distance, height);
}

/* The ground to the right of the wall, but for the first pixel, some of whose rays hit the wall:
   the means of all rows, which all see the same, and where they are. */
static int ground_of_rows(const KrsPicture *picture, double *mean, double *place)
{
    int  count = 0;
    bool edge  = true;
    for (int x = 0; x < 160; x++) {
        double sum  = 0;
        int    seen = 0;
        for (int y = 0; y < 48; y++)
            if (picture->component[y * 160 + x] == 1) {
                sum += openness_to_sky(picture, y * 160 + x);
                seen++;
            }
        if (seen == 48 && !edge) {
            place[count]  = 2 + (x + 0.5 - 80) * 9 / 48;
            mean[count++] = sum / seen;
        }
        edge = edge && seen < 48;
    }
    return count;
}

/* Tells whether ground is as open as places at most a pixel away. */
static bool is_ground_before_wall(const double *mean, const double *place, int count)
{
    const double pixel = 9.0 / 48;
    bool         right = true;
    for (int i = 0; i < count; i++)
        right = right && mean[i] > openness_before_wall(place[i] - pixel, 3) - MAX_BESIDE_WALL &&
                mean[i] < openness_before_wall(place[i] + pixel, 3) + MAX_BESIDE_WALL;
    return right;
}

static void a_wall_closes_the_ground_at_its_foot(void **state)
{
    (void)state;
    static const bool upsampled[2] = {true, false};
    for (int i = 0; i < 2; i++) {
        KrsRenderOptions options      = WALL_VIEW;
        options.methods.no_upsampling = upsampled[i];
        options.samples               = 16;
        KrsPicture *picture           = picture_of(
                      OPEN_SKY "show box([40, 3, 80]).move([-20, 1.5, 0]).paint(striped);", &options);
        double row[160], place[160];
        int    count = ground_of_rows(picture, row, place);
        print_message("# occlusion: %.3f at the foot of a wall, then %.3f, %.3f, %.3f\n", row[0],
                      row[1], row[2], row[3]);
        assert_true(count > 80);
        assert_true(is_ground_before_wall(row, place, count));
        row[9] = row[5]; /* planted faults: a band, and light at the foot */
        assert_false(is_ground_before_wall(row, place, count));
        ground_of_rows(picture, row, place);
        row[0] = 1;
        assert_false(is_ground_before_wall(row, place, count));
        assert_true(count_closed(picture) > 500);
        krs_picture_free(picture);
    }
}

/* How far means of columns are from the truth within four pixels of a wall so high, on average: the
   mean of what is wrong, with its sign.  What neighbours share has noise, but no bias. */
static double misjudge_wall(const KrsPicture *picture, double height)
{
    double wrong = 0;
    int    count = 0;
    for (int x = 0; x < WIDTH && count < 4; x++) {
        double place = 2 + (x + 0.5 - 0.5 * WIDTH) * 9 / HEIGHT;
        for (int y = 0; y < HEIGHT && place > 0; y++)
            wrong += openness_to_sky(picture, y * WIDTH + x) - openness_before_wall(place, height);
        count += place > 0;
    }
    return fabs(wrong) / (count * HEIGHT);
}

static void shared_rays_see_a_wall_where_it_is(void **state)
{
    (void)state;
    KrsPicture *picture = picture_of(
        OPEN_SKY "show box([40, 3, 80]).move([-20, 1.5, 0]).paint(striped);",
        &(KrsRenderOptions){.width = WIDTH, .height = HEIGHT, .methods.no_filter = true});
    double wrong = misjudge_wall(picture, 3);
    print_message("# occlusion before a wall, one ray a pixel: off by %.4f\n", wrong);
    assert_true(wrong < MAX_BESIDE_WALL);
    assert_false(misjudge_wall(picture, 0.3) < MAX_BESIDE_WALL);
    krs_picture_free(picture);
}

/* Returns two walls, a floor and a ball on it, whose distance is `slope` times too small. */
static KrsPicture *take_room(double slope, double radius)
{
    SceneText text = {0};
    scene_write(&text,
                WHITE_SKY
                "shape room() {\n"
                "    distance: min(min(x, z), min(y, length(p - [1.5, 1, 1.5]) - %.17g)),\n"
                "    slope: %.17g\n}\n"
                "camera { eye: [9, 6, 7], target: [1, 0.5, 1], fov: 30deg }\n"
                "show room().paint(striped);\n",
                radius, slope);
    return picture_of(text.bytes, &(KrsRenderOptions){
                                      .width = WIDTH, .height = HEIGHT, .methods.no_filter = true});
}

/* Tells whether a ray from within the room meets nothing within its reach; of its walls so many count. */
static bool leaves_room(Line line, int walls, double reach)
{
    const double origin[3] = {line.origin.x, line.origin.y, line.origin.z};
    const double along[3]  = {line.direction.x, line.direction.y, line.direction.z};
    Chord        ball      = chord_of_ball(line, vec(1.5, 1, 1.5), 1);
    double       nearest = chord_is_empty(ball) || ball.leave < 0 ? INFINITY : fmax(ball.enter, 0);
    for (int i = 0; i < walls; i++)
        if (along[i] < 0)
            nearest = fmin(nearest, -origin[i] / along[i]);
    return along[1] < 0 ? nearest > reach : isinf(nearest);
}

/* Returns the part of the hemisphere, by the cosine, in which rays leave: by directions that divide
   it evenly. */
static double openness_of_room(Vec p, Vec normal, int walls, double reach)
{
    enum { RINGS = 16, SPOKES = 32 };
    Vec    lateral = vec_across(normal), other = vec_cross(normal, lateral);
    double sum = 0;
    for (int i = 0; i < RINGS; i++)
        for (int k = 0; k < SPOKES; k++) {
            double distance = sqrt((i + 0.5) / RINGS), turn = 2 * M_PI * (k + 0.618 * i) / SPOKES;
            Vec    direction = vec_add(vec_add(vec_scale(distance * cos(turn), lateral),
                                               vec_scale(distance * sin(turn), other)),
                                       vec_scale(sqrt(1 - distance * distance), normal));
            sum += leaves_room((Line){p, direction}, walls, reach);
        }
    return sum / (RINGS * SPOKES);
}

/* How far means of 5x5 pixels are from the truth of a room, on average; and how many pixels are looked
   at. */
static double misjudge_room(const KrsPicture *picture, int walls, double reach, int *count)
{
    static double off[WIDTH * HEIGHT];
    double        squares = 0;
    for (int k = 0; k < WIDTH * HEIGHT; k++) {
        const float *up     = picture->normal + 3 * k;
        Vec          normal = vec((double)up[0], (double)up[1], (double)up[2]);
        Vec          p      = vec_add(position_of(picture, k), vec_scale(1e-3, normal));
        off[k]              = picture->component[k] == 1
                                  ? openness_to_sky(picture, k) - openness_of_room(p, normal, walls, reach)
                                  : NAN;
    }
    *count = 0;
    for (int y = 2; y < HEIGHT - 2; y++)
        for (int x = 2; x < WIDTH - 2; x++) {
            double mean = 0;
            for (int i = 0; i < 25; i++)
                mean += off[(y + i / 5 - 2) * WIDTH + x + i % 5 - 2] / 25;
            squares += isnan(mean) ? 0 : mean * mean;
            *count += !isnan(mean);
        }
    return sqrt(squares / *count);
}

/* By how much two pictures are differently open, on average. */
static double openness_apart(const KrsPicture *a, const KrsPicture *b)
{
    double sum = 0;
    for (int k = 0; k < WIDTH * HEIGHT; k++)
        if (a->component[k] == 1 && b->component[k] == 1)
            sum += fabs(openness_to_sky(a, k) - openness_to_sky(b, k));
    return sum / (WIDTH * HEIGHT);
}

static void occlusion_is_a_share_of_the_hemisphere(void **state)
{
    (void)state;
    const double reach = REACH * vec_distance(vec(9, 6, 7), vec(1, 0.5, 1));
    int          count;
    KrsPicture  *picture = take_room(1, 1);
    double       off     = misjudge_room(picture, 3, reach, &count);
    print_message("# occlusion: off by %.4f, %d pixels\n", off, count);
    assert_true(count > 20000);
    assert_true(off < MAX_MISJUDGED);
    assert_false(misjudge_room(picture, 2, reach, &count) < MAX_MISJUDGED);
    assert_false(misjudge_room(picture, 3, 1.5 * reach, &count) < MAX_MISJUDGED);
    krs_picture_free(picture);
}

/* Occlusion hangs on the shape, not on how its distance is bounded. */
static void bounds_close_as_much_as_distances(void **state)
{
    (void)state;
    static const double slopes[] = {4, 32};
    KrsPicture         *exact    = take_room(1, 1);
    for (int i = 0; i < 2; i++) {
        KrsPicture *picture = take_room(slopes[i], 1);
        double      apart   = openness_apart(exact, picture);
        print_message("# occlusion, distance / %g: off by %.5f\n", slopes[i], apart);
        assert_true(apart < MAX_UNLIKE);
        krs_picture_free(picture);
    }
    KrsPicture *larger = take_room(4, 1.1); /* so much would be found */
    assert_false(openness_apart(exact, larger) < MAX_UNLIKE);
    krs_picture_free(larger);
    krs_picture_free(exact);
}

/* What is convex is open all around: a ball, and a long one, at whose tips the distance is a fifth
   of the true one. */
static void convex_solids_are_open(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double      least;
    } solids[] = {{"sphere(1)", MIN_CONVEX},
                  {"sphere(1).scale([5, 1, 1])", MIN_CONVEX},
                  {"box([2, 1, 1]).rotate([1, 2, 3], 1).scale([1, 1, 6])", MIN_CONVEX},
                  {"algebraic(x^2 + y^2 + z^2 == 1)", MIN_CONVEX},
                  {"algebraic(x^8 + y^8 + z^8 == 1)", MIN_CONVEX},
                  {"field(x^2 + y^2 + abs(z)^2 - 1).within(box([8, 8, 8]))", MIN_CONVEX},
                  {"sphere(1).twist([0, 1, 0], 1)", MIN_CONVEX},
                  {"sphere(1).transform(invert([3, 0, 0], 3))", MIN_CONVEX}};
    for (size_t i = 0; i < sizeof solids / sizeof solids[0]; i++) {
        SceneText text = {0};
        scene_write(&text,
                    WHITE_SKY "camera { eye: [9, 4, 6], target: [1, 0, 0], fov: 40deg }\n"
                              "show %s.paint(striped);\n",
                    solids[i].text);
        KrsPicture *picture = picture_of(
            text.bytes,
            &(KrsRenderOptions){.width = WIDTH, .height = HEIGHT, .methods.no_upsampling = true});
        int    seen  = 0;
        double least = 1;
        for (int k = 0; k < WIDTH * HEIGHT; k++)
            if (picture->component[k] == 1) {
                least = fmin(least, openness_to_sky(picture, k));
                seen++;
            }
        print_message("# occlusion, %s: %d pixels, open by %.4f at least\n", solids[i].text, seen,
                      least);
        assert_true(seen > 1000);
        assert_true(least > solids[i].least);
        krs_picture_free(picture);
    }
}

/* ---- Closed forms ---- */

/* A floor of some grey, and occluders of another; numbers `a` to `c` say where they are. */
#define FLOOR                                                                      \
    "param a = 1 in [0, 100]; param b = 1 in [0, 100]; param c = 1 in [0, 100];\n" \
    "param shade = 1 in [0, 1]; param back = 0 in [0, 1];\n"                       \
    "sky { zenith: white, horizon: white, ground: white }\n"                       \
    "light none { direction: [0, 1, 0], intensity: 0, shadow: false }\n"           \
    "material floor { color: [shade, shade, shade], specular: 0 }\n"               \
    "material dark { color: [back, back, back], specular: 0 }\n"                   \
    "show plane([0, 1, 0], 0).paint(floor);\n"
#define FROM_ABOVE "camera { eye: [3, 2.5, 4], target: [0.4, 0, 0], fov: 40deg }\n"
#define FROM_BELOW "camera { eye: [0.8, 0.25, 1.3], target: [0.3, 0, 0.4], fov: 28deg }\n"

typedef struct Form {
    const char *name, *text;
    Range       numbers[3];
    double (*openness)(Vec p, double a, double b, double c); /* NAN: not known there */
} Form;

/* A ball above the horizon takes as much as its disc would, across the direction to it. */
static double openness_below_ball(Vec p, double a, double b, double c)
{
    double height = a + b, far = vec_distance(p, vec(c, height, 0));
    return 1 - a * a * height / (far * far * far);
}

static double openness_below_disc(Vec p, double a, double b, double c)
{
    double beside = (p.x - c) * (p.x - c) + p.z * p.z, all = beside + b * b + a * a;
    return 1 - 0.5 * (1 - (all - 2 * a * a) / sqrt(all * all - 4 * a * a * beside));
}

static double openness_beside_wall(Vec p, double a, double b, double c)
{
    (void)b, (void)c;
    return p.x > 0 ? openness_before_wall(p.x, a) : NAN;
}

/* Below a roof to the left of `b`, at the height `a`; its side hides more from places beside it. */
static double openness_below_roof(Vec p, double a, double b, double c)
{
    (void)c;
    return p.x < b ? 0.5 - 0.5 * (b - p.x) / hypot(b - p.x, a) : NAN;
}

/* Between planes that meet at an angle. */
static double openness_of_wedge(Vec p, double a, double b, double c)
{
    (void)b, (void)c;
    return p.x > 0 ? 0.5 - 0.5 * cos(a) : NAN;
}

/* Returns the part of the hemisphere, by the cosine, that a polygon takes whose corners are above
   the floor (Lambert 1760). */
static double part_of_quad(Vec p, const Vec corners[4])
{
    double sum = 0;
    for (int i = 0; i < 4; i++) {
        Vec    from = vec_unit(vec_sub(corners[i], p));
        Vec    to = vec_unit(vec_sub(corners[(i + 1) % 4], p)), across = vec_cross(from, to);
        double sine = vec_length(across);
        sum += sine > 0 ? atan2(sine, vec_dot(from, to)) * across.y / sine : 0;
    }
    return fabs(sum) / (2 * M_PI);
}

/* Beside a box of the sides 2a, b and 1 that hangs so high: all faces that face the place. */
static double openness_beside_box(Vec p, double a, double b, double c)
{
    const double low[3] = {-a, c, -0.5}, high[3] = {a, c + b, 0.5}, at[3] = {p.x, p.y, p.z};
    double       open = 1;
    for (int side = 0; side < 6; side++) {
        const int    axis = side / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        const double wall = side % 2 ? high[axis] : low[axis];
        Vec          corners[4];
        for (int i = 0; i < 4; i++) {
            double corner[3];
            corner[axis] = wall;
            corner[u]    = i == 1 || i == 2 ? high[u] : low[u];
            corner[v]    = i >= 2 ? high[v] : low[v];
            corners[i]   = vec(corner[0], corner[1], corner[2]);
        }
        if (side % 2 ? at[axis] > wall : at[axis] < wall)
            open -= part_of_quad(p, corners);
    }
    return open;
}

static const Form forms[] = {
    {"a ball",
     FLOOR FROM_BELOW "show sphere(a).move([c, a + b, 0]).paint(dark);\n",
     {{0.2, 1}, {0.3, 3}, {0, 0.5}},
     openness_below_ball},
    {"a ball on the floor",
     FLOOR FROM_ABOVE "show sphere(a).move([c, a + b, 0]).paint(dark);\n",
     {{0.3, 1}, {0.001, 0.01}, {0, 0.5}},
     openness_below_ball},
    {"a disc",
     FLOOR FROM_BELOW "show cylinder(a, 0.002).move([c, b + 0.001, 0]).paint(dark);\n",
     {{0.2, 2}, {0.3, 3}, {0, 0.5}},
     openness_below_disc},
    {"a wall",
     FLOOR FROM_ABOVE "show box([20, a, 8000]).move([-10, a / 2, 0]).paint(dark);\n",
     {{0.05, 3}, {0, 0}, {0, 0}},
     openness_beside_wall},
    {"a roof",
     FLOOR FROM_BELOW "show box([8000, 1, 8000]).move([b - 4000, a + 0.5, 0]).paint(dark);\n",
     {{0.3, 2}, {0.4, 1}, {0, 0}},
     openness_below_roof},
    {"a wedge",
     FLOOR "camera { eye: [3 * cos(a / 2), 3 * sin(a / 2), 2], target: [1.2, 0, 0], fov: 30deg }\n"
           "show plane([sin(a), -cos(a), 0], 0).paint(dark);\n",
     {{0.6, 2.8}, {0, 0}, {0, 0}},
     openness_of_wedge},
    {"a box",
     FLOOR FROM_ABOVE "show box([2 * a, b, 1]).move([0, c + b / 2, 0]).paint(dark);\n",
     {{0.2, 1}, {0.2, 2}, {0.2, 0.6}},
     openness_beside_box},
    {"a box on the floor",
     FLOOR FROM_ABOVE "show box([2 * a, b, 1]).move([0, c + b / 2, 0]).paint(dark);\n",
     {{0.2, 1}, {0.2, 2}, {0, 0}},
     openness_beside_box},
};
enum { FORMS = sizeof forms / sizeof *forms };

/* What is wrong of the light on the floor, relative to that of the open sky: the mean, with its sign, and
   the root of the mean square.  It may be anything between two truths. */
typedef struct Wrong {
    double bias, spread;
} Wrong;

/* Finds the least and the most light on the floor where it is so open, by the albedo of what
   closes it.  Black gives none back, and white all of it in a white world, but for places that
   are nearly closed.  Other occluders give back at most what they would in the open, and no less
   than nothing. */
static void find_limits(double open, double back, double limits[2])
{
    limits[0] = open;
    limits[1] = open + (1 - open) * back;
    if (back == 1 && open > MIN_OPEN)
        limits[0] = 1;
}

static Wrong judge_form(const KrsPicture *picture, const Form *form, const double *numbers,
                        double shade, double back)
{
    double sum = 0, squares = 0;
    int    count = 0;
    for (int k = 0; k < (int)(picture->width * picture->height); k++) {
        double truth = picture->component[k] == 1
                           ? form->openness(position_of(picture, k), numbers[0], numbers[1],
                                            numbers[2])
                           : NAN;
        if (isnan(truth))
            continue;
        double light = (double)picture->color[4 * k] / shade, limits[2];
        find_limits(truth, back, limits);
        double off = light - fmin(fmax(light, limits[0]), limits[1]);
        sum += off;
        squares += off * off;
        count++;
    }
    assert_true(count > 10);
    return (Wrong){sum / count, sqrt(squares / count)};
}

/* A picture of a random member of a form; the grey of what occludes. */
static bool form_is_right(PathFixture *fixture, const Form *form, uint32_t width, double back,
                          Random *random)
{
    static const char *const names[] = {"a", "b", "c"};
    double                   numbers[3], shade = back == 1 ? 1 : random_between(random, 0.1, 1);
    for (int k = 0; k < 3; k++) {
        numbers[k] = random_between(random, form->numbers[k].low, form->numbers[k].high);
        path_fixture_set(fixture, names[k], numbers[k]);
    }
    path_fixture_set(fixture, "shade", shade);
    path_fixture_set(fixture, "back", back);
    KrsRenderOptions options = {.width = width, .height = width * 3 / 4, .methods.no_filter = true};
    KrsPicture      *picture = path_fixture_render(fixture, &options);
    Wrong            wrong   = judge_form(picture, form, numbers, shade, back);
    krs_picture_free(picture);
    bool right = fabs(wrong.bias) < MAX_BIAS && wrong.spread < MAX_SPREAD;
    print_message("# %s%s of grey %.2f, %.3f %.3f %.3f, %u pixels: off by %.4f, spread %.4f\n",
                  right ? "" : "WRONG: ", form->name, back, numbers[0], numbers[1], numbers[2],
                  (unsigned)width, wrong.bias, wrong.spread);
    return right;
}

static void light_is_that_of_closed_forms(void **state)
{
    (void)state;
    static const struct {
        uint32_t width;
        double   back;
    } views[]     = {{160, 0}, {240, 0}, {320, 0}, {480, 0}, {160, 0.5}, {240, 0.8}, {240, 1}};
    Random random = {7};
    size_t wrong  = 0;
    for (int i = 0; i < FORMS; i++) {
        PathFixture fixture = path_fixture_open(forms[i].text);
        for (size_t k = 0; k < sizeof views / sizeof *views; k++)
            wrong += !form_is_right(&fixture, &forms[i], views[k].width, views[k].back, &random);
        path_fixture_close(&fixture);
    }
    assert_int_equal(wrong, 0);
}

/* ---- What occluders give back ---- */

/* A white ball on grey ground: all that closes the ground is white, so in a white world as much light comes from there
   as from the sky.  What grey occluders would give back is missing else. */
#define GREY 0.3
#define BRIGHT_BALL(ground, look)                                                       \
    "sky { zenith: white, horizon: white, ground: white }\n"                            \
    "light none { direction: [0, 1, 0], intensity: 0, shadow: false }\n"                \
    "material floor { color: [0.3, 0.3, 0.3], specular: 0 }\n"                          \
    "material ball { color: white, specular: 0, " look " }\n" FROM_ABOVE "show " ground \
    ".paint(floor); show sphere(0.8).move([0, 0.802, 0]).paint(ball);\n"

static const struct {
    const char *name, *text;
} grounds[] = {
    {"a plane", BRIGHT_BALL("plane()", "roughness: 1")},
    {"a plane below a mirror", BRIGHT_BALL("plane()", "metallic: 1, roughness: 0")},
    {"a slab", BRIGHT_BALL("box([60, 1, 60]).move([0, -0.5, 0])", "roughness: 1")},
    {"a slab below a mirror",
     BRIGHT_BALL("box([60, 1, 60]).move([0, -0.5, 0])", "metallic: 1, roughness: 0")},
};

/* What is wrong of the light on ground around the ball, which grey occluders would darken by a tenth at least. */
static Wrong judge_bright_ball(const KrsPicture *picture, int *count)
{
    double sum = 0, squares = 0;
    *count = 0;
    for (int k = 0; k < (int)(picture->width * picture->height); k++) {
        const double open = picture->component[k] == 1
                                ? openness_below_ball(position_of(picture, k), 0.8, 0.002, 0)
                                : 1;
        const double grey = open / (1 - GREY * (1 - open));
        if (open < MIN_OPEN || grey > 0.9)
            continue;
        const double off = (double)picture->color[4 * k] / GREY - 1;
        sum += off;
        squares += off * off;
        ++*count;
    }
    return (Wrong){sum / *count, sqrt(squares / *count)};
}

static void bright_occluders_give_light_back(void **state)
{
    static const KrsExecutor executors[] = {KRS_EXECUTOR_KERNELS, KRS_EXECUTOR_LANES};
    size_t                   all_wrong   = 0;
    (void)state;
    for (size_t i = 0; i < sizeof grounds / sizeof *grounds; i++)
        for (size_t e = 0; e < 2; e++) {
            const KrsRenderOptions options = {.width             = 160,
                                              .height            = 90,
                                              .methods.no_filter = true,
                                              .methods.executor  = executors[e]};
            KrsPicture            *picture = picture_of(grounds[i].text, &options);
            int                    count;
            const Wrong            wrong = judge_bright_ball(picture, &count);
            print_message("# a white ball on %s, %s: off by %.4f, spread %.4f, %d pixels\n",
                          grounds[i].name, e ? "lanes" : "kernels", wrong.bias, wrong.spread,
                          count);
            assert_true(count > 500);
            all_wrong += !(fabs(wrong.bias) < MAX_BIAS && wrong.spread < MAX_SPREAD);
            krs_picture_free(picture);
        }
    assert_int_equal(all_wrong, 0);
}

/* ---- Random rooms ---- */

enum { ACROSS = 64, DOWN = 48, PIXELS = ACROSS * DOWN, MEAN = 5, RAYS = 64 };

/* The scene of a room, white sky, and a floor without end far below it. */
static void write_room(SceneText *text, const Setting *setting)
{
    const Room *room = setting->room;
    Vec         eye = room->eye, target = room->target;
    text->length = 0;
    for (int i = 0; i < ROOM_NUMBERS && room->numbers[i].high > room->numbers[i].low; i++)
        scene_write(text, "param %c = %.17g in [%.17g, %.17g];\n", 'a' + i, setting->numbers[i],
                    room->numbers[i].low, room->numbers[i].high);
    scene_write(text,
                WHITE_SKY "material white { color: [0.5, 0, 1], roughness: 1 }\n"
                          "camera { eye: [%g, %g, %g], target: [%g, %g, %g], fov: %gdeg }\n%s"
                          "show plane([0, 1, 0], -30);\n",
                eye.x, eye.y, eye.z, target.x, target.y, target.z, room->fov, room->text);
}

/* Finds how open the centres of pixels are; NAN where nothing is seen. */
static void find_openness(const Setting *setting, double *open)
{
    const Room *room  = setting->room;
    double      reach = REACH * vec_distance(room->eye, room->target);
    Lens   lens   = lens_make(room->eye, room->target, tan(room->fov * M_PI / 360), false, ACROSS,
                              DOWN);
    Random random = {1};
    for (int k = 0; k < PIXELS; k++) {
        Seen seen = see(setting, lens_ray(&lens, k % ACROSS + 0.5, k / ACROSS + 0.5), 1, &random);
        open[k] = seen.hit ? openness(setting, seen.point, seen.normal, reach, RAYS, &random) : NAN;
    }
}

/* The mean of what is wrong, of means of 5x5 pixels that all see the room; and of openness. */
static double mean_wrong(const KrsPicture *picture, const double *open, double *mean)
{
    double wrong = 0, sum = 0;
    int    count = 0;
    for (int y = MEAN / 2; y < DOWN - MEAN / 2; y++)
        for (int x = MEAN / 2; x < ACROSS - MEAN / 2; x++) {
            double seen = 0, truth = 0;
            for (int i = 0; i < MEAN * MEAN; i++) {
                int k = (y + i / MEAN - MEAN / 2) * ACROSS + x + i % MEAN - MEAN / 2;
                truth += picture->component[k] ? open[k] / (MEAN * MEAN) : NAN;
                seen += openness_to_sky(picture, k) / (MEAN * MEAN);
            }
            if (isnan(truth))
                continue;
            wrong += fabs(seen - truth);
            sum += truth;
            count++;
        }
    *mean = sum / count;
    assert_true(count > PIXELS / 8);
    return wrong / count;
}

/* Wrong with one ray a pixel, and with four, if the truth were a part of it. */
static bool room_is_right(const Setting *setting, double part)
{
    static SceneText text;
    static double    open[PIXELS];
    const Room      *room = setting->room;
    double           mean, wrong[2];
    write_room(&text, setting);
    find_openness(setting, open);
    for (int k = 0; k < PIXELS; k++)
        open[k] *= part;
    for (int i = 0; i < 2; i++) {
        KrsPicture *picture = picture_of(
            text.bytes,
            &(KrsRenderOptions){
                .width = ACROSS, .height = DOWN, .samples = i ? 4 : 1, .methods.no_filter = true});
        wrong[i] = mean_wrong(picture, open, &mean);
        krs_picture_free(picture);
    }
    print_message("# %s: open by %.2f, wrong by %.3f with a ray, %.3f with four\n", room->name,
                  mean, wrong[0], wrong[1]);
    return wrong[0] < MAX_WRONG && wrong[1] < MAX_WRONG;
}

static void rooms_are_as_open_as_rays_say(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (int i = 0; i < ROOMS; i++) {
        Random  random  = {(uint64_t)i + 1};
        Setting setting = setting_choose(&rooms[i], &random);
        wrong += !room_is_right(&setting, 1);
    }
    assert_int_equal(wrong, 0);
}

/* A twentieth too much, in a room that is open. */
static void wrong_openness_is_found(void **state)
{
    (void)state;
    Random  random  = {1};
    Setting setting = setting_choose(&rooms[3], &random);
    assert_false(room_is_right(&setting, 1 / 1.05));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(open_ground_is_open),
        cmocka_unit_test(a_wall_closes_the_ground_at_its_foot),
        cmocka_unit_test(shared_rays_see_a_wall_where_it_is),
        cmocka_unit_test(occlusion_is_a_share_of_the_hemisphere),
        cmocka_unit_test(bounds_close_as_much_as_distances),
        cmocka_unit_test(convex_solids_are_open),
        cmocka_unit_test(light_is_that_of_closed_forms),
        cmocka_unit_test(bright_occluders_give_light_back),
        cmocka_unit_test(rooms_are_as_open_as_rays_say),
        cmocka_unit_test(wrong_openness_is_found),
    };
    return cmocka_run_group_tests_name("occlusion", tests, renderer_open, renderer_close);
}
