/*
 * agree.c: what a picture, a query of the device and one of the host say of one ray.
 *
 * Rays through random pixels of examples and of random scenes are asked for on the host, in double
 * precision, and on the device, and held against the picture: the same hit, as deep, of the same
 * component, level and instance.  Where the picture and the host disagree about a hit the ray must
 * graze something: what it goes through, or what it passes by, is then a small part of a pixel.
 * Crops are the picture bit by bit, and so are tracing methods but for the permitted error.
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
#include "tests/oracle/exact.h"
#include "tests/oracle/random_scene.h"
#include "tests/support/renderer.h"

/* In pixels at the place: how far a hit may be off, the permitted error and what stays open; and
   how deep or how near it is what rays may graze. */
#define MAX_OFF   (0.25 + 2.0 / 64)
#define MAX_GRAZE (1.0 / 16)
/* The share of rays that graze, or end where several copies meet. */
#define MAX_EXCUSED 0.05
enum { WIDTH = 160, HEIGHT = 90, PIXELS = WIDTH * HEIGHT, ASKED = 400 };

typedef struct Fixture {
    const char   *name;
    KrsScene     *scene;
    KrsState     *state;
    KrsRendering *rendering;
    KrsView       view;
    Lens          lens;
} Fixture;

static Vec vec_of(const double v[3]) { return vec(v[0], v[1], v[2]); }

static void fixture_open(Fixture *fixture, KrsStatus status)
{
    if (status != KRS_OK)
        fail_msg("%s does not compile", fixture->name);
    assert_int_equal(krs_state_new(fixture->scene, &fixture->state), KRS_OK);
    if (krs_rendering_new(renderer, fixture->scene, KRS_FOR_PICTURES, &fixture->rendering) !=
        KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
    assert_int_equal(krs_state_view(fixture->state, 0, &fixture->view), KRS_OK);
    const KrsCamera *camera = &fixture->view.camera;
    assert_int_equal(camera->projection, KRS_PERSPECTIVE);
    fixture->lens = lens_make(vec_of(camera->eye), vec_of(camera->target), tan(camera->fov / 2),
                              false, WIDTH, HEIGHT);
}

static void fixture_close(Fixture *fixture)
{
    krs_rendering_free(fixture->rendering);
    krs_state_free(fixture->state);
    krs_scene_free(fixture->scene);
}

static KrsPicture *fixture_render(Fixture *fixture, KrsRenderOptions options)
{
    KrsPicture *picture;
    options.width   = WIDTH;
    options.height  = HEIGHT;
    options.samples = 1;
    if (krs_render(fixture->rendering, fixture->state, &options, &picture) != KRS_OK)
        fail_msg("%s: %s", fixture->name, krs_renderer_message(renderer));
    return picture;
}

/* What is said of it; `t` HUGE_VAL: nothing is hit. */
typedef struct Answer {
    double   t;
    uint32_t component, level, instance;
} Answer;

static Answer answer_of(const KrsHit *hit)
{
    return (Answer){hit->hit ? hit->t : HUGE_VAL, hit->component, hit->level, hit->instance};
}

static Answer seen_at(const Fixture *fixture, const KrsPicture *picture, int pixel, Line ray)
{
    double stretch = vec_dot(ray.direction, fixture->lens.forward);
    return (Answer){picture->component[pixel] ? picture->depth[pixel] / stretch : HUGE_VAL,
                    picture->component[pixel], picture->level[pixel], picture->instance[pixel]};
}

static double distance_at(Fixture *fixture, Vec p)
{
    const double point[1][3] = {{p.x, p.y, p.z}};
    double       distance;
    assert_int_equal(krs_distance(fixture->state, point, 1, &distance), KRS_OK);
    return distance;
}

/* Returns the deepest, or where nothing is the nearest, that a ray comes to a solid within some
   pixels around a place, before the end. */
static double min_around(Fixture *fixture, Line ray, double t, double end, double pixel)
{
    double least = HUGE_VAL;
    for (int i = -64; i <= 256 && t + i / 16.0 * pixel < end; i++)
        least = fmin(least, distance_at(fixture, line_at(ray, t + i / 16.0 * pixel)));
    return least;
}

static double pixel_at(const Fixture *fixture, double t) { return lens_pixel(&fixture->lens, t); }

typedef enum Verdict { AGREED, GRAZED, MANY_MEET, WRONG_HIT, WRONG_IDS, VERDICTS } Verdict;

/* Tells whether the ids are those of a point nearby. */
static bool is_of_neighbour(Fixture *fixture, Line ray, const Answer *said, double pixel)
{
    Vec at = line_at(ray, said->t);
    for (int i = 0; i < 27; i++) {
        Vec p = vec_add(at, vec((i % 3 - 1) * pixel, (i / 3 % 3 - 1) * pixel, (i / 9 - 1) * pixel));
        const double point[1][3] = {{p.x, p.y, p.z}};
        KrsHit       hit;
        assert_int_equal(krs_probe(fixture->state, point, 1, &hit), KRS_OK);
        if (hit.component == said->component && hit.level == said->level &&
            hit.instance == said->instance)
            return true;
    }
    return false;
}

/* `rounding`: how much more the one who answers may be off. */
static Verdict judge(Fixture *fixture, Line ray, const Answer *truth, const Answer *said,
                     double rounding)
{
    double first = fmin(truth->t, said->t);
    if (first == HUGE_VAL)
        return AGREED;
    double pixel = pixel_at(fixture, first), most = MAX_OFF * pixel + rounding;
    if (fabs(truth->t - said->t) > most) {
        /* The one that goes farther has gone through, or passed by, next to nothing. */
        bool   through = truth->t < said->t;
        double least   = through ? min_around(fixture, ray, first, said->t - pixel / 16, pixel)
                                 : distance_at(fixture, line_at(ray, first));
        double graze   = MAX_GRAZE * pixel + rounding;
        return (through ? least > -graze : least < graze) ? GRAZED : WRONG_HIT;
    }
    if (truth->component == said->component && truth->level == said->level &&
        truth->instance == said->instance)
        return AGREED;
    return is_of_neighbour(fixture, ray, said, pixel) ? MANY_MEET : WRONG_IDS;
}

static void tell(const Fixture *fixture, const char *who, Verdict verdict, int pixel,
                 const Answer *truth, const Answer *said)
{
    print_message("# %s, %s, pixel %d %d: %s; host t %.9g, %u %u %u; said t %.9g, %u %u %u\n",
                  fixture->name, who, pixel % WIDTH, pixel / WIDTH,
                  verdict == WRONG_HIT ? "another hit" : "other ids", truth->t, truth->component,
                  truth->level, truth->instance, said->t, said->component, said->level,
                  said->instance);
}

typedef struct Tally {
    const char *who;
    size_t      verdicts[VERDICTS], hits;
} Tally;

static void count(Tally *tally, const Fixture *fixture, Verdict verdict, int pixel,
                  const Answer *truth, const Answer *said)
{
    tally->verdicts[verdict]++;
    tally->hits += said->t < HUGE_VAL;
    if (verdict >= WRONG_HIT && tally->verdicts[verdict] <= 3)
        tell(fixture, tally->who, verdict, pixel, truth, said);
}

static bool is_right(const Fixture *fixture, const Tally *tally, size_t asked)
{
    size_t wrong   = tally->verdicts[WRONG_HIT] + tally->verdicts[WRONG_IDS];
    size_t excused = tally->verdicts[GRAZED] + tally->verdicts[MANY_MEET];
    if (wrong == 0 && (double)excused <= MAX_EXCUSED * (double)asked)
        return true;
    print_message(
        "# %s, %s: %zu rays, %zu hits, %zu graze, %zu where several meet, %zu hits and %zu ids "
        "wrong\n",
        fixture->name, tally->who, asked, tally->hits, tally->verdicts[GRAZED],
        tally->verdicts[MANY_MEET], tally->verdicts[WRONG_HIT], tally->verdicts[WRONG_IDS]);
    return false;
}

static void put(double to[3], Vec v)
{
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
}

static bool is_border(const KrsPicture *picture, int k)
{
    const int neighbours[2] = {k + 1, k + WIDTH};
    for (int i = 0; i < 2; i++) {
        int n = neighbours[i];
        if (n < PIXELS &&
            (picture->component[k] != picture->component[n] ||
             picture->instance[k] != picture->instance[n] ||
             fabsf(picture->depth[k] - picture->depth[n]) > 0.05f * picture->depth[k]))
            return true;
    }
    return false;
}

/* Any pixel, or one at a border, if there is one. */
static int choose_pixel(Random *random, const KrsPicture *picture, bool at_border)
{
    int pixel = random_below(random, PIXELS);
    for (int i = 0; at_border && i < PIXELS && !is_border(picture, pixel); i++)
        pixel = random_below(random, PIXELS);
    return pixel;
}

/* Rays through the middles of pixels, every second at a border. */
static size_t wrong_rays(Fixture *fixture, const KrsPicture *picture)
{
    static double places[ASKED][3], directions[ASKED][3];
    const double(*origins)[3] = (const double(*)[3])places;
    const double(*rays)[3]    = (const double(*)[3])directions;
    static KrsHit host[ASKED], device[ASKED];
    static int    pixels[ASKED];
    Random        random = {(uint64_t)strlen(fixture->name) + 3};
    Tally         seen = {.who = "picture"}, asked = {.who = "query of the device"};
    double        size = vec_length(fixture->lens.eye);
    for (int i = 0; i < ASKED; i++) {
        pixels[i] = choose_pixel(&random, picture, i % 2 == 1);
        Line ray  = lens_ray(&fixture->lens, pixels[i] % WIDTH + 0.5, pixels[i] / WIDTH + 0.5);
        put(places[i], ray.origin);
        put(directions[i], ray.direction);
    }
    assert_int_equal(
        krs_raycast(fixture->state, origins, rays, ASKED, HUGE_VAL, 1e-7 * (1 + size), host),
        KRS_OK);
    double nearest = HUGE_VAL;
    for (int i = 0; i < ASKED; i++)
        if (host[i].hit)
            nearest = fmin(nearest, host[i].t);
    double tolerance = nearest < HUGE_VAL ? 0.25 * pixel_at(fixture, nearest) : 1e-3;
    if (krs_device_raycast(fixture->rendering, fixture->state, origins, rays, ASKED, HUGE_VAL,
                           tolerance, device) != KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
    for (int i = 0; i < ASKED; i++) {
        Line   ray      = {vec_of(origins[i]), vec_of(rays[i])};
        Answer truth    = answer_of(&host[i]);
        Answer picked   = seen_at(fixture, picture, pixels[i], ray);
        Answer answered = answer_of(&device[i]);
        double far      = fmin(truth.t, picked.t) < HUGE_VAL ? fmin(truth.t, picked.t) : 0;
        double rounding = 2e-6 * (size + far); /* some units in the last place */
        count(&seen, fixture, judge(fixture, ray, &truth, &picked, 2e-6 * far), pixels[i], &truth,
              &picked);
        count(&asked, fixture, judge(fixture, ray, &truth, &answered, rounding), pixels[i], &truth,
              &answered);
    }
    /* Queries of the device are not camera-relative: far out single precision is all they have. */
    bool has_digits = nearest == HUGE_VAL || 2.4e-7 * size < pixel_at(fixture, nearest) / 64;
    bool right      = is_right(fixture, &seen, ASKED);
    return !right + (has_digits && !is_right(fixture, &asked, ASKED));
}

static bool rows_are_equal(const void *whole, const void *crop, const KrsWindow *window,
                           size_t size)
{
    for (uint32_t y = 0; y < window->height; y++)
        if (memcmp((const char *)whole + ((window->y + y) * WIDTH + window->x) * size,
                   (const char *)crop + y * window->width * size, window->width * size) != 0)
            return false;
    return true;
}

static size_t wrong_crops(Fixture *fixture, const KrsPicture *whole)
{
    Random random = {5};
    size_t wrong  = 0;
    for (int i = 0; i < 3; i++) {
        KrsWindow window  = {.x = (uint32_t)random_below(&random, WIDTH - 40),
                             .y = (uint32_t)random_below(&random, HEIGHT - 30)};
        window.width      = 1 + (uint32_t)random_below(&random, 39);
        window.height     = 1 + (uint32_t)random_below(&random, 29);
        KrsPicture *crop  = fixture_render(fixture, (KrsRenderOptions){.crop = window});
        bool        equal = rows_are_equal(whole->depth, crop->depth, &window, sizeof(float)) &&
                     rows_are_equal(whole->position, crop->position, &window, 3 * sizeof(float)) &&
                     rows_are_equal(whole->normal, crop->normal, &window, 3 * sizeof(float)) &&
                     rows_are_equal(whole->color, crop->color, &window, 4 * sizeof(float)) &&
                     rows_are_equal(whole->albedo, crop->albedo, &window, 3 * sizeof(float)) &&
                     rows_are_equal(whole->component, crop->component, &window, 4) &&
                     rows_are_equal(whole->level, crop->level, &window, 4) &&
                     rows_are_equal(whole->instance, crop->instance, &window, 4);
        if (!equal)
            print_message("# %s: the crop %u %u %u %u is another picture\n", fixture->name,
                          window.x, window.y, window.width, window.height);
        wrong += !equal;
        krs_picture_free(crop);
    }
    return wrong;
}

/* A position is where the ray is at its depth. */
static size_t wrong_positions(const Fixture *fixture, const KrsPicture *picture)
{
    size_t wrong = 0;
    for (int k = 0; k < PIXELS; k++) {
        if (!picture->component[k])
            continue;
        Line   ray  = lens_ray(&fixture->lens, k % WIDTH + 0.5, k / WIDTH + 0.5);
        double t    = picture->depth[k] / vec_dot(ray.direction, fixture->lens.forward);
        Vec    at   = line_at(ray, t);
        Vec    said = vec(picture->position[3 * k], picture->position[3 * k + 1],
                          picture->position[3 * k + 2]);
        wrong += !(vec_distance(at, said) <= 1e-5 * (vec_length(at) + t + 1));
    }
    if (wrong)
        print_message("# %s: %zu positions are not where rays end\n", fixture->name, wrong);
    return wrong;
}

static size_t wrong_scene(Fixture *fixture, KrsTrace trace)
{
    KrsPicture *picture = fixture_render(fixture, (KrsRenderOptions){.methods.trace = trace});
    size_t      wrong   = wrong_rays(fixture, picture) + wrong_positions(fixture, picture);
    if (picture->stats.unresolved)
        print_message("# %s: %llu rays are unresolved\n", fixture->name,
                      (unsigned long long)picture->stats.unresolved);
    if (trace == KRS_TRACE_DEFAULT)
        wrong += wrong_crops(fixture, picture);
    krs_picture_free(picture);
    return wrong;
}

static void examples_agree(void **context)
{
    (void)context;
    static const char *const paths[] = {"examples/01-hello.krs", "examples/05-rock.krs",
                                        "examples/14-inversion.krs"};
    size_t                   wrong   = 0;
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        Fixture fixture = {.name = paths[i]};
        fixture_open(&fixture, krs_compile_file(paths[i], NULL, &fixture.scene));
        wrong += wrong_scene(&fixture, KRS_TRACE_DEFAULT);
        fixture_close(&fixture);
    }
    assert_int_equal(wrong, 0);
}

/* A picture of something else does not pass: moved by two pixels, or of other ids. */
static void other_pictures_are_found(void **context)
{
    (void)context;
    static const char text[] =
        "param aside = 0;\n"
        "camera { eye: [0, 1, 5], target: [0, 0, 0], fov: 0.6 }\n"
        "show krs { kernel box([0.6, 0.5, 0.7]).move([-0.5 + aside, 0.1, 0]);\n"
        "           reflect plane([1, 0.2, 0], 0.3); };\n";
    Fixture fixture = {.name = "two boxes"};
    fixture_open(&fixture, krs_compile_text(text, strlen(text), "scene.krs", NULL, &fixture.scene));
    KrsPicture *picture = fixture_render(&fixture, (KrsRenderOptions){0});
    assert_int_equal(wrong_rays(&fixture, picture), 0);
    for (int k = 0; k < PIXELS; k++)
        picture->instance[k] ^= 1;
    assert_true(wrong_rays(&fixture, picture) > 0);
    krs_picture_free(picture);
    const double lateral = 2 * pixel_at(&fixture, 5), none = 0;
    assert_int_equal(krs_state_set(fixture.state, "aside", &lateral, 1), KRS_OK);
    picture = fixture_render(&fixture, (KrsRenderOptions){0});
    assert_int_equal(krs_state_set(fixture.state, "aside", &none, 1), KRS_OK);
    assert_true(wrong_rays(&fixture, picture) > 0);
    krs_picture_free(picture);
    fixture_close(&fixture);
}

/* ---- random scenes ---- */

static const KrsTrace methods[] = {KRS_TRACE_PLAIN, KRS_TRACE_RELAXED, KRS_TRACE_EXACT,
                                   KRS_TRACE_TAYLOR, KRS_TRACE_DIRECTIONAL};

/* Every third is far out, and of any size. */
static size_t wrong_random_scene(int number)
{
    Random    random = {(uint64_t)number + 1000};
    SceneText text   = {.length = 0};
    bool      far    = number % 3 == 2;
    double    size   = far ? pow(10, random_between(&random, -2, 1)) : 1;
    char      name[40];
    snprintf(name, sizeof name, "random scene %d", number);
    write_random_scene(&text, &random, far ? any_vec(&random, 3000) : vec(0, 0, 0), size);
    Fixture          fixture = {.name = name};
    size_t           method  = (size_t)number % (sizeof methods / sizeof *methods);
    const KrsOptions options = {.research = true};
    fixture_open(&fixture,
                 krs_compile_text(text.bytes, text.length, "scene.krs", &options, &fixture.scene));
    size_t wrong = wrong_scene(&fixture, KRS_TRACE_DEFAULT) +
                   wrong_scene(&fixture, methods[method]);
    if (wrong)
        print_message("%s\n", text.bytes);
    fixture_close(&fixture);
    return wrong;
}

static void random_scenes_agree(void **context)
{
    (void)context;
    size_t wrong = 0;
    for (int i = 0; i < 6; i++)
        wrong += wrong_random_scene(i);
    assert_int_equal(wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(other_pictures_are_found),
        cmocka_unit_test(examples_agree),
        cmocka_unit_test(random_scenes_agree),
    };
    return cmocka_run_group_tests_name("agree", tests, renderer_open, renderer_close);
}
