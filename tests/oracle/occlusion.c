/*
 * occlusion.c: how open places are to the sky, held against exact rays, and in random rooms against
 * Monte Carlo in double precision.
 *
 * Openness is the mean over the hemisphere, by the cosine, of min(t / R, 1)^2, where t is how far
 * away what a direction hits is, and R the reach.  A scene that has no end reaches 0.15 of the way
 * from the eye to its target.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "compiler/compile.h"
#include "tests/oracle/exact.h"
#include "tests/oracle/montecarlo.h"
#include "tests/oracle/product.h"
#include "tests/support/renderer.h"

/* What is asked for, of means of 5x5 pixels of openness. */
#define MOST_MISJUDGED   0.02 /* root of the mean square */
#define MOST_UNLIKE      5e-3 /* by how much openness changes with a bound, on average */
#define LEAST_CONVEX     0.998
#define MOST_BESIDE_WALL 0.018 /* on average, of the first pixels at the foot of a wall */
#define MOST_WRONG       0.035 /* in random rooms on average, in parts of the mean */

#define REACH 0.15 /* of the way from the eye to the target */
#define LIFT  128  /* rays begin so little a part of the reach above the surface */

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

/* ---- What exact rays see ---- */

static const KrsRenderOptions WALL_VIEW = {.width = 160, .height = 48, .no_upsampling = true};

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

/* Whether ground is the more open the farther it is from a wall, half open at its foot and open far
   away. */
static bool rises_to_open(const double *row, int count)
{
    bool right = row[0] > 0.4 && row[0] < 0.65 && fabs(row[count - 1] - 1) < 1e-3;
    for (int x = 1; x < count; x++)
        right = right && row[x] >= row[x - 1] - 0.012;
    return right;
}

/* The ground to the right of the wall, but for the first pixel, some of whose rays hit the wall:
   the means of all rows, which all see the same. */
static int ground_of_rows(const KrsPicture *picture, double *mean)
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
        if (seen == 48 && !edge)
            mean[count++] = sum / seen;
        edge = edge && seen < 48;
    }
    return count;
}

static void a_wall_closes_the_ground_at_its_foot(void **state)
{
    (void)state;
    static const bool upsampled[2] = {true, false};
    for (int i = 0; i < 2; i++) {
        KrsRenderOptions options = WALL_VIEW;
        options.no_upsampling    = upsampled[i];
        options.samples          = 16;
        KrsPicture *picture      = picture_of(
                 OPEN_SKY "show box([40, 3, 80]).move([-20, 1.5, 0]).paint(striped);", &options);
        double row[160];
        int    count = ground_of_rows(picture, row);
        print_message("# occlusion: %.3f at the foot of a wall, then %.3f, %.3f, %.3f\n", row[0],
                      row[1], row[2], row[3]);
        assert_true(count > 80);
        assert_true(rises_to_open(row, count));
        row[9] = row[5]; /* planted faults: a band, and light at the foot */
        assert_false(rises_to_open(row, count));
        ground_of_rows(picture, row);
        row[0] = 1;
        assert_false(rises_to_open(row, count));
        assert_true(count_closed(picture) > 500);
        krs_picture_free(picture);
    }
}

/* How open ground is at a distance from that wall, with its top 3 above. */
static double openness_before_wall(double distance, double reach)
{
    enum { RINGS = 64, SPOKES = 256 };
    double sum = 0, lift = reach / LIFT;
    for (int i = 0; i < RINGS; i++)
        for (int k = 0; k < SPOKES; k++) {
            double across = sqrt((i + 0.5) / RINGS), turn = 2 * M_PI * (k + 0.5) / SPOKES;
            double t    = across * cos(turn) < 0 ? -distance / (across * cos(turn)) : reach;
            double part = lift + t * sqrt(1 - across * across) < 3 ? fmin(t / reach, 1) : 1;
            sum += part * part;
        }
    return sum / (RINGS * SPOKES);
}

/* How far means of columns are from the truth within four pixels of the wall, on average: the mean
   of what is wrong, with its sign.  What neighbours share has noise, but no bias. */
static double misjudge_wall(const KrsPicture *picture, double reach)
{
    double wrong = 0;
    int    count = 0;
    for (int x = 0; x < WIDTH && count < 4; x++) {
        double place = 2 + (x + 0.5 - 0.5 * WIDTH) * 9 / HEIGHT;
        for (int y = 0; y < HEIGHT && place > 0; y++)
            wrong += openness_to_sky(picture, y * WIDTH + x) - openness_before_wall(place, reach);
        count += place > 0;
    }
    return fabs(wrong) / (count * HEIGHT);
}

static void shared_rays_see_a_wall_where_it_is(void **state)
{
    (void)state;
    const double reach   = REACH * vec_distance(vec(2, 40, 40), vec(2, 0, 0));
    KrsPicture  *picture = picture_of(
         OPEN_SKY "show box([40, 3, 80]).move([-20, 1.5, 0]).paint(striped);",
         &(KrsRenderOptions){.width = WIDTH, .height = HEIGHT, .no_filter = true});
    double wrong = misjudge_wall(picture, reach);
    print_message("# occlusion before a wall, one ray a pixel: off by %.4f\n", wrong);
    assert_true(wrong < MOST_BESIDE_WALL);
    assert_false(misjudge_wall(picture, 0.25 * reach) < MOST_BESIDE_WALL);
    krs_picture_free(picture);
}

/* Two walls, a floor and a ball on it, whose distance is `slope` times too small. */
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
    return picture_of(text.bytes,
                      &(KrsRenderOptions){.width = WIDTH, .height = HEIGHT, .no_filter = true});
}

/* Where a ray from within the room ends, as a share of what occlusion reaches; 1: beyond. */
static double part_of_reach(Line line, double reach)
{
    const double origin[3] = {line.origin.x, line.origin.y, line.origin.z};
    const double along[3]  = {line.direction.x, line.direction.y, line.direction.z};
    Chord        ball      = chord_of_ball(line, vec(1.5, 1, 1.5), 1);
    double       nearest   = chord_is_empty(ball) || ball.leave < 0 ? reach : fmax(ball.enter, 0);
    for (int i = 0; i < 3; i++)
        if (along[i] < 0)
            nearest = fmin(nearest, -origin[i] / along[i]);
    return fmin(nearest / reach, 1);
}

/* The mean over the hemisphere, by the cosine, of the square of that share: by directions that
   divide it evenly. */
static double openness_of_room(Vec p, Vec normal, double reach)
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
            double part      = part_of_reach((Line){p, direction}, reach);
            sum += part * part;
        }
    return sum / (RINGS * SPOKES);
}

/* How far means of 5x5 pixels are from the truth, on average, if occlusion reaches so far; and how
   many pixels are looked at. */
static double misjudge_room(const KrsPicture *picture, double reach, int *count)
{
    static double off[WIDTH * HEIGHT];
    double        squares = 0;
    for (int k = 0; k < WIDTH * HEIGHT; k++) {
        const float *at = picture->position + 3 * k, *up = picture->normal + 3 * k;
        Vec          normal = vec((double)up[0], (double)up[1], (double)up[2]);
        Vec          p      = vec_add(vec((double)at[0], (double)at[1], (double)at[2]),
                                      vec_scale(reach / LIFT, normal)); /* where rays start */
        off[k]              = picture->component[k] == 1
                                  ? openness_to_sky(picture, k) - openness_of_room(p, normal, reach)
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
    double       off     = misjudge_room(picture, reach, &count);
    print_message("# occlusion: off by %.4f, %d pixels\n", off, count);
    assert_true(count > 20000);
    assert_true(off < MOST_MISJUDGED);
    assert_false(misjudge_room(picture, 1.3 * reach, &count) < MOST_MISJUDGED);
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
        assert_true(apart < MOST_UNLIKE);
        krs_picture_free(picture);
    }
    KrsPicture *larger = take_room(4, 1.1); /* so much would be found */
    assert_false(openness_apart(exact, larger) < MOST_UNLIKE);
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
    } solids[] = {{"sphere(1)", LEAST_CONVEX},
                  {"sphere(1).scale([5, 1, 1])", LEAST_CONVEX},
                  {"box([2, 1, 1]).rotate([1, 2, 3], 1).scale([1, 1, 6])", LEAST_CONVEX},
                  {"algebraic(x^2 + y^2 + z^2 == 1)", LEAST_CONVEX},
                  {"algebraic(x^8 + y^8 + z^8 == 1)", LEAST_CONVEX},
                  {"field(x^2 + y^2 + abs(z)^2 - 1).within(box([8, 8, 8]))", LEAST_CONVEX},
                  {"sphere(1).twist([0, 1, 0], 1)", LEAST_CONVEX},
                  {"sphere(1).transform(invert([3, 0, 0], 3))", LEAST_CONVEX}};
    for (size_t i = 0; i < sizeof solids / sizeof solids[0]; i++) {
        SceneText text = {0};
        scene_write(&text,
                    WHITE_SKY "camera { eye: [9, 4, 6], target: [1, 0, 0], fov: 40deg }\n"
                              "show %s.paint(striped);\n",
                    solids[i].text);
        KrsPicture *picture = picture_of(
            text.bytes,
            &(KrsRenderOptions){.width = WIDTH, .height = HEIGHT, .no_upsampling = true});
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

/* How open the centres of pixels are, if occlusion reaches so far; NAN where nothing is seen. */
static void find_openness(const Setting *setting, double reach, double *open)
{
    const Room *room = setting->room;
    Lens   lens   = lens_make(room->eye, room->target, tan(room->fov * M_PI / 360), false, ACROSS,
                              DOWN);
    Random random = {1};
    for (int k = 0; k < PIXELS; k++) {
        Seen seen = see(setting, lens_ray(&lens, k % ACROSS + 0.5, k / ACROSS + 0.5), 1, &random);
        open[k]   = seen.hit ? openness(setting, seen.point, seen.normal, reach, reach / LIFT, RAYS,
                                        &random)
                             : NAN;
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

/* Wrong with one ray a pixel, and with four, in parts of the mean, for truths of such a reach. */
static bool room_is_right(const Setting *setting, double part)
{
    static SceneText text;
    static double    open[PIXELS];
    const Room      *room  = setting->room;
    double           reach = part * vec_distance(room->eye, room->target), mean, wrong[2];
    write_room(&text, setting);
    find_openness(setting, reach, open);
    for (int i = 0; i < 2; i++) {
        KrsPicture *picture = picture_of(text.bytes, &(KrsRenderOptions){.width     = ACROSS,
                                                                         .height    = DOWN,
                                                                         .samples   = i ? 4 : 1,
                                                                         .no_filter = true});
        wrong[i]            = mean_wrong(picture, open, &mean) / mean;
        krs_picture_free(picture);
    }
    print_message("# %s: open by %.2f, wrong by %.3f with a ray, %.3f with four\n", room->name,
                  mean, wrong[0], wrong[1]);
    return wrong[0] < MOST_WRONG && wrong[1] < MOST_WRONG;
}

static void rooms_are_as_open_as_rays_say(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (int i = 0; i < ROOMS; i++) {
        Random  random  = {(uint64_t)i + 1};
        Setting setting = setting_choose(&rooms[i], &random);
        wrong += !room_is_right(&setting, REACH);
    }
    assert_int_equal(wrong, 0);
}

/* A reach a third too long, in a room that is closed off on all sides. */
static void wrong_openness_is_found(void **state)
{
    (void)state;
    Random  random  = {1};
    Setting setting = setting_choose(&rooms[0], &random);
    assert_false(room_is_right(&setting, 1.33 * REACH));
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
        cmocka_unit_test(rooms_are_as_open_as_rays_say),
        cmocka_unit_test(wrong_openness_is_found),
    };
    return cmocka_run_group_tests_name("occlusion", tests, renderer_open, renderer_close);
}
