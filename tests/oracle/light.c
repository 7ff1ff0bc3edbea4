/*
 * light.c: the light of random rooms, lamps, windows and fields, held against Monte Carlo in
 * double precision.
 *
 * Two lights of every room are one but for colour: red light casts shadows, green light does not.
 * So green holds how surfaces reflect, and red over green how much of the light is seen.  With four
 * rays a pixel the light at their places must be right, as the mean of 5x5 pixels (how well these
 * places stand for the pixel is not asked here); with one ray what is wrong must
 * be noise of high frequencies, which such a mean takes away, and no contour, ring or seam.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/oracle/montecarlo.h"
#include "tests/oracle/product.h"
#include "tests/support/renderer.h"

enum { WIDTH = 64, HEIGHT = 48, PIXELS = WIDTH * HEIGHT, SETTINGS = 3 };
#define SHADOWS    KRS_SHADOWS_SOFT       /* the default */
#define PLASTIC    1.32471795724474602596 /* x^3 = x + 1 */
#define SAME_PLACE 0.05                   /* as seen by the reference and in a picture */
enum { MEAN = 5 };                        /* pixels of a mean, a side */
enum { CENTRE_RAYS = 16 }; /* to the light, of the reference: from the centre of a pixel, */
/* and from the places in it that a picture of so many samples looks at: the multiples of the powers
   of 1 over the plastic number */
enum { PLACES = 4, PLACE_RAYS = 8 };

/* What is asked for.  In parts of the mean light: */
#define MAX_WRONG    0.05 /* the mean of what is wrong with four rays, */
#define MAX_UNSHADED 0.01 /* and where nothing casts shadows */
/* With one ray, of means of 5x5 pixels: */
#define MAX_NOISE 1.5   /* what is wrong, for what it is of independent rays, */
#define MIN_NOISE 0.025 /* and so much more, as edges are somewhere in a pixel */
#define MAX_SEEN  0.4   /* wrong anywhere */

/* ---- The truth ---- */

typedef struct Truth {
    Seen   centre[PIXELS];
    double red[PIXELS], green[PIXELS]; /* means of the places */
    double mean_red, mean_green;
} Truth;

static Truth truth;

static void look_at_pixel(const Setting *setting, const Lens *lens, int k, Random *random)
{
    int x = k % WIDTH, y = k / WIDTH;
    truth.centre[k] = see(setting, lens_ray(lens, x + 0.5, y + 0.5), CENTRE_RAYS, random);
    truth.red[k] = truth.green[k] = 0;
    for (int i = 0; i < PLACES; i++) {
        double right = 0.5 + i / PLASTIC, down = 0.5 + i / (PLASTIC * PLASTIC);
        Line   ray  = lens_ray(lens, x + right - floor(right), y + down - floor(down));
        Seen   seen = see(setting, ray, PLACE_RAYS, random);
        truth.red[k] += seen.light * seen.visible / PLACES;
        truth.green[k] += seen.light / PLACES;
    }
    truth.mean_red += truth.red[k] / PIXELS;
    truth.mean_green += truth.green[k] / PIXELS;
}

static void find_truth(const Setting *setting)
{
    const Room *room = setting->room;
    Lens        lens = lens_make(room->eye, room->target, tan(room->fov * M_PI / 360), false, WIDTH,
                                 HEIGHT);
    Random      random = {1};
    truth.mean_red = truth.mean_green = 0;
    for (int k = 0; k < PIXELS; k++)
        look_at_pixel(setting, &lens, k, &random);
}

/* ---- Pictures ---- */

typedef struct Fixture {
    const Room   *room;
    Product       product;
    KrsRendering *rendering;
} Fixture;

static Fixture open_fixture(const Room *room)
{
    static SceneText text;
    const char      *where   = room->lamp ? "position" : "direction";
    const char      *wide    = room->lamp ? "radius" : "softness";
    Fixture          fixture = {.room = room};
    text.length              = 0;
    for (int i = 0; i < ROOM_NUMBERS && room->numbers[i].high > room->numbers[i].low; i++)
        scene_write(&text, "param %c = %g in [%.17g, %.17g];\n", 'a' + i,
                    (room->numbers[i].low + room->numbers[i].high) / 2, room->numbers[i].low,
                    room->numbers[i].high);
    scene_write(&text,
                "param at = [0, 1, 0];\nparam wide = 0.1 in [0, 1];\n"
                "light red { %s: at, %s: wide, color: [1, 0, 0] }\n"
                "light green { %s: at, %s: wide, color: [0, 1, 0], shadow: false }\n"
                "sky { zenith: #000000, horizon: #000000, ground: #000000 }\n"
                "material white { color: [1, 1, 1], roughness: 1 }\n"
                "camera { eye: [%g, %g, %g], target: [%g, %g, %g], fov: %gdeg }\n%s",
                where, wide, where, wide, room->eye.x, room->eye.y, room->eye.z, room->target.x,
                room->target.y, room->target.z, room->fov, room->text);
    fixture.product = product_compile(text.bytes);
    if (krs_rendering_new(renderer, fixture.product.scene, KRS_FOR_PICTURES, &fixture.rendering) !=
        KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
    return fixture;
}

static void close_fixture(Fixture *fixture)
{
    krs_rendering_free(fixture->rendering);
    product_free(&fixture->product);
}

static void set_numbers(Fixture *fixture, const Setting *setting)
{
    const Room *room  = setting->room;
    KrsState   *state = fixture->product.state;
    Vec         at    = setting->light;
    for (int i = 0; i < ROOM_NUMBERS && room->numbers[i].high > room->numbers[i].low; i++)
        assert_int_equal(
            krs_state_set(state, (char[]){(char)('a' + i), 0}, &setting->numbers[i], 1), KRS_OK);
    assert_int_equal(krs_state_set(state, "at", (double[]){at.x, at.y, at.z}, 3), KRS_OK);
    assert_int_equal(krs_state_set(state, "wide", &setting->wide, 1), KRS_OK);
}

/* NULL: lanes cannot march rays of the room. */
static KrsPicture *take_picture(Fixture *fixture, KrsShadows shadows, KrsExecutor executor,
                                uint32_t samples)
{
    KrsRenderOptions options = {.width            = WIDTH,
                                .height           = HEIGHT,
                                .samples          = samples,
                                .shadows          = shadows,
                                .no_occlusion     = true,
                                .methods.executor = executor};
    KrsPicture      *picture;
    const KrsStatus  status = krs_render(fixture->rendering, fixture->product.state, &options,
                                         &picture);
    if (status == KRS_BAD_ARGUMENT && executor == KRS_EXECUTOR_LANES)
        return NULL;
    if (status != KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
    assert_int_equal(picture->stats.unresolved, 0);
    return picture;
}

/* ---- What is wrong ---- */

/* The mean of the pixels around one, where it is inside of the picture. */
static double mean_around(const double *values, int k)
{
    double sum = 0;
    for (int y = -MEAN / 2; y <= MEAN / 2; y++)
        for (int x = -MEAN / 2; x <= MEAN / 2; x++)
            sum += values[k + y * WIDTH + x];
    return sum / (MEAN * MEAN);
}

static bool is_inside(int k)
{
    int x = k % WIDTH, y = k / WIDTH, edge = MEAN / 2;
    return x >= edge && y >= edge && x < WIDTH - edge && y < HEIGHT - edge;
}

/* Returns how wrong means of 5x5 pixels are, in parts of the mean light. */
static double mean_wrong(const KrsPicture *picture, int channel, const double *right, double mean)
{
    double off[PIXELS], sum = 0;
    int    count = 0;
    for (int k = 0; k < PIXELS; k++)
        off[k] = (double)picture->color[4 * k + channel] - right[k];
    for (int k = 0; k < PIXELS; k++)
        if (is_inside(k)) {
            sum += fabs(mean_around(off, k));
            count++;
        }
    return sum / count / mean;
}

/* What is wrong in a picture of one ray a pixel: of the light seen, or where surfaces turn away
   from it, of light in parts of its mean.  Roots of mean squares. */
typedef struct Noise {
    double single, mean; /* of pixels; of means of 5x5, */
    double independent;  /* and what these would be of independent rays, one each */
    double worst;        /* of means */
} Noise;

/* How much of the light a pixel sees too much; false where it does not see what the centre of the
   true one does. */
static bool find_off(const KrsPicture *picture, int k, double *off, double *variance)
{
    const float *place = &picture->position[3 * k], *color = &picture->color[4 * k];
    const Seen  *seen = &truth.centre[k];
    double       red = (double)color[0], green = (double)color[1];
    Vec          point = vec((double)place[0], (double)place[1], (double)place[2]);
    *off = *variance = 0;
    if (!seen->hit || picture->component[k] == 0 || green <= 0 || seen->light <= 0 ||
        vec_distance(point, seen->point) > SAME_PLACE)
        return false;
    double weight = green / fmax(green, truth.mean_green);
    *off          = weight * (red / green - seen->visible);
    *variance     = weight * weight * seen->visible * (1 - seen->visible);
    return true;
}

static Noise find_noise(const KrsPicture *picture)
{
    double off[PIXELS], variance;
    Noise  noise = {0};
    int    count = 0, means = 0;
    for (int k = 0; k < PIXELS; k++) {
        count += find_off(picture, k, &off[k], &variance);
        noise.single += off[k] * off[k];
        noise.independent += variance;
    }
    for (int k = 0; k < PIXELS; k++)
        if (is_inside(k)) {
            double mean = mean_around(off, k);
            noise.mean += mean * mean;
            noise.worst = fmax(noise.worst, fabs(mean));
            means++;
        }
    noise.single      = sqrt(noise.single / count);
    noise.independent = sqrt(noise.independent / count) / MEAN;
    noise.mean        = sqrt(noise.mean / means);
    return noise;
}

/* ---- Tests ---- */

static bool light_is_right(const char *name, const KrsPicture *one, const KrsPicture *four)
{
    double red   = mean_wrong(four, 0, truth.red, truth.mean_red);
    double green = mean_wrong(four, 1, truth.green, truth.mean_green);
    Noise  noise = find_noise(one);
    bool   right = red < MAX_WRONG && green < MAX_UNSHADED && noise.worst < MAX_SEEN &&
                 noise.mean < MAX_NOISE * noise.independent + MIN_NOISE;
    print_message("# %s%s: wrong by %.3f, unshaded by %.3f; one ray: %.3f, of 5x5 %.3f (of "
                  "independent rays %.3f), the worst %.3f\n",
                  name, right ? "" : ", WRONG", red, green, noise.single, noise.mean,
                  noise.independent, noise.worst);
    return right;
}

/* Tells whether a setting is lit right by an executor, where that can march its rays. */
static bool is_lit_right(Fixture *fixture, KrsExecutor executor, int setting, int *lit)
{
    KrsPicture *one = take_picture(fixture, SHADOWS, executor, 1), *four;
    char        name[80];
    if (!one)
        return true;
    four = take_picture(fixture, SHADOWS, executor, PLACES);
    snprintf(name, sizeof name, "%s by %s, %d", fixture->room->name, krs_executor_names[executor],
             setting);
    const bool right = light_is_right(name, one, four);
    krs_picture_free(one);
    krs_picture_free(four);
    *lit += 1;
    return right;
}

/* Returns how many settings of a room come out wrong. */
static size_t count_wrong(const Room *room, int lit[KRS_EXECUTOR_COUNT])
{
    Random  random  = {(uint64_t)(room - rooms) + 1};
    Fixture fixture = open_fixture(room);
    size_t  wrong   = 0;
    for (int i = 0; i < SETTINGS; i++) {
        Setting setting = setting_choose(room, &random);
        set_numbers(&fixture, &setting);
        find_truth(&setting);
        for (KrsExecutor e = KRS_EXECUTOR_KERNELS; e < KRS_EXECUTOR_COUNT; e++)
            wrong += !is_lit_right(&fixture, e, i, &lit[e]);
    }
    close_fixture(&fixture);
    return wrong;
}

static void rooms_are_lit_right(void **state)
{
    size_t wrong                   = 0;
    int    lit[KRS_EXECUTOR_COUNT] = {0};
    (void)state;
    for (int i = 0; i < ROOMS; i++)
        wrong += count_wrong(&rooms[i], lit);
    assert_int_equal(wrong, 0);
    assert_int_equal(lit[KRS_EXECUTOR_KERNELS], ROOMS * SETTINGS);
    assert_true(lit[KRS_EXECUTOR_LANES] > ROOMS * SETTINGS / 2);
}

/* A fault planted in a right picture: red light is multiplied by this. */
typedef double Fault(double x, double y);
static double  darker(double x, double y)
{
    (void)x;
    (void)y;
    return 0.94;
}
static double contours(double x, double y) { return 1 + 0.2 * sin(0.8 * x + 0.3 * y); }
static double hole(double x, double y) { return hypot(x - 32, y - 30) < 4 ? 0.2 : 1; }

static void faults_are_found(void **state)
{
    (void)state;
    static Fault *const      faults[] = {darker, contours, hole};
    static const char *const names[]  = {"PLANTED darkness", "PLANTED contours", "PLANTED hole"};
    const Room              *room     = &rooms[3];
    Random                   random   = {4};
    Fixture                  fixture  = open_fixture(room);
    Setting                  setting  = setting_choose(room, &random);
    set_numbers(&fixture, &setting);
    find_truth(&setting);
    for (int i = 0; i < 3; i++) {
        KrsPicture *one  = take_picture(&fixture, SHADOWS, KRS_EXECUTOR_KERNELS, 1);
        KrsPicture *four = take_picture(&fixture, SHADOWS, KRS_EXECUTOR_KERNELS, 4);
        assert_true(light_is_right("right", one, four));
        for (int k = 0; k < PIXELS; k++) {
            one->color[4 * k] *= (float)faults[i](k % WIDTH, k / WIDTH);
            four->color[4 * k] *= (float)(i == 0 ? faults[i](0, 0) : 1);
        }
        assert_false(light_is_right(names[i], one, four));
        krs_picture_free(one);
        krs_picture_free(four);
    }
    close_fixture(&fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rooms_are_lit_right),
        cmocka_unit_test(faults_are_found),
    };
    return cmocka_run_group_tests_name("light", tests, renderer_open, renderer_close);
}
