/*
 * plates.c: shadows on the plate of another renderer, whose depths are those of a floor, held
 * against closed forms: what a ball hides of a point, of a lamp and of the sky.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "runtime/device/gpu.h"
#include "tests/unit/tracer_fixture.h"

/* The ball alone is in the scene; the floor, y = 0, is known by the depths alone. */
#define RADIUS 0.6
static const double middle[3] = {0.2, 1, -0.3};
static const double lamp[3] = {2.5, 4, 1}, sun[3] = {-1 / 1.5, 1 / 1.5, 0.5 / 1.5};
static const char   ball_text[] =
    "param at_lamp = 1 in [0, 1]; param at_sun = 1 in [0, 1]; param day = 0 in [0, 1];\n"
    "param shine = 0 in [0, 1];\n"
    "camera { eye: [0, 3, 6], target: [0, 0, 0], fov: 50deg }\n"
    "camera flat { eye: [0, 3, 6], target: [0, 0, 0], projection: \"orthographic\", height: 4 }\n"
    "camera round { eye: [0.5, 1.5, 2.5], target: [0.5, 1.5, 0], projection: \"panorama\" }\n"
    "sky { zenith: [day, day, day], horizon: [day, day, day], ground: [day, day, day] }\n"
    "light lamp { position: [2.5, 4, 1], intensity: 20 * at_lamp }\n"
    "light sun { direction: [-1, 1, 0.5], intensity: 2 * at_sun }\n"
    "material soot { color: [shine, shine, shine], specular: 0, metallic: shine, roughness: 0.2 }\n"
    "show sphere(0.6).move([0.2, 1, -0.3]).paint(soot);\n";
enum { ACROSS = 90, DOWN = 60, PIXELS = ACROSS * DOWN, CAMERAS = 3 };

typedef struct Ray {
    double origin[3], direction[3]; /* depths count along the direction */
} Ray;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Returns the rays of the cameras above, in their own words. */
static Ray ray_of(int camera, double x, double y)
{
    const double back = sqrt(45.0), ahead[3] = {0, -3 / back, -6 / back};
    const double up[3] = {0, 6 / back, -3 / back}, aspect = (double)ACROSS / DOWN;
    const double right = 2 * x / ACROSS - 1, rise = 1 - 2 * y / DOWN;
    const double half    = camera == 0 ? tan(25 * M_PI / 180) : 2;
    const double side[3] = {right * aspect * half, rise * half * up[1], rise * half * up[2]};
    Ray          ray     = {{0, 3, 6}, {ahead[0], ahead[1], ahead[2]}};
    if (camera == 2) {
        const double longitude = M_PI * right, latitude = 0.5 * M_PI * rise;
        return (Ray){
            {0.5, 1.5, 2.5},
            {sin(longitude) * cos(latitude), sin(latitude), -cos(longitude) * cos(latitude)}};
    }
    for (int i = 0; i < 3; i++)
        *(camera == 0 ? &ray.direction[i] : &ray.origin[i]) += side[i];
    return ray;
}

/* Returns the depth of the floor; infinite where the ray does not meet it. */
static double floor_depth(const Ray *ray)
{
    const double depth = -ray->origin[1] / ray->direction[1];
    return ray->direction[1] < 0 && depth < 60 ? depth : HUGE_VAL;
}

/* How far a ray misses the ball, in radii of the ball: below 1 it hits. */
static double miss(const double origin[3], const double direction[3])
{
    double to[3], along, square;
    for (int i = 0; i < 3; i++)
        to[i] = middle[i] - origin[i];
    along  = dot(to, direction) / sqrt(dot(direction, direction));
    square = dot(to, to) - along * along;
    return along > 0 ? sqrt(fmax(square, 0)) / RADIUS : HUGE_VAL;
}

typedef struct Floor {
    float  depth[PIXELS], plate[PIXELS][4];
    bool   exists[PIXELS]; /* it is seen, and not behind the ball or its outline */
    double place[PIXELS][3];
} Floor;

static Floor ground;

static void make_floor(int camera)
{
    for (int k = 0; k < PIXELS; k++) {
        const Ray    ray   = ray_of(camera, k % ACROSS + 0.5, k / ACROSS + 0.5);
        const double depth = floor_depth(&ray);
        ground.depth[k]    = (float)depth;
        ground.plate[k][0] = 1;
        ground.plate[k][1] = 0.5f;
        ground.plate[k][2] = 0.25f;
        ground.plate[k][3] = 1;
        ground.exists[k]   = isfinite(depth) && miss(ray.origin, ray.direction) > 1.1;
        for (int i = 0; i < 3 && isfinite(depth); i++)
            ground.place[k][i] = ray.origin[i] + depth * ray.direction[i];
    }
}

static KrsRenderOptions on_floor(int camera)
{
    return (KrsRenderOptions){.width        = ACROSS,
                              .height       = DOWN,
                              .camera       = (size_t)camera,
                              .samples      = 1,
                              .depth        = ground.depth,
                              .plate        = (const float(*)[4])ground.plate,
                              .no_occlusion = true};
}

static void set(Fixture *fixture, const char *name, double value)
{
    assert_int_equal(krs_state_set(fixture->state, name, &value, 1), KRS_OK);
}

/* The direction from the floor to a light. */
static void toward(int light, const double place[3], double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = light == 0 ? lamp[i] - place[i] : sun[i];
}

/* Shadows are where they must be, and only there; the plate is darkened by them, and its depth stays. */
static void check_shadows(const KrsPicture *seen, int light, int least)
{
    int dark = 0;
    for (int k = 0; k < PIXELS; k++) {
        double to[3];
        toward(light, ground.place[k], to);
        const double from = ground.exists[k] ? miss(ground.place[k], to) : 1;
        if (fabs(from - 1) < 0.12)
            continue; /* the edge may lie within this pixel */
        dark += from < 1;
        for (int i = 0; i < 3; i++) {
            assert_near((double)seen->caught[k][i], from < 1 ? 0 : 1, 0);
            assert_near((double)seen->color[4 * k + i], from < 1 ? 0 : (double)ground.plate[k][i],
                        0);
        }
        assert_true(seen->color[4 * k + 3] == 1 && seen->depth[k] == ground.depth[k]);
        assert_int_equal(seen->component[k], 0);
    }
    assert_in_range(dark, least, PIXELS / 4);
}

static void points_cast_shadows(void **state)
{
    static const KrsIntegrator integrators[]  = {KRS_INTEGRATOR_PREVIEW, KRS_INTEGRATOR_DIRECT};
    static const int           least[CAMERAS] = {40, 40, 10};
    Fixture                   *fixture        = *state;
    set(fixture, "day", 0);
    for (int camera = 0; camera < CAMERAS; camera++)
        for (int light = 0; light < 2; light++)
            for (int i = 0; i < 2; i++) {
                KrsRenderOptions options = on_floor(camera);
                options.integrator       = integrators[i];
                make_floor(camera);
                set(fixture, "at_lamp", light == 0);
                set(fixture, "at_sun", light == 1);
                KrsPicture *seen = fixture_render(fixture, options);
                check_shadows(seen, light, least[camera]);
                krs_picture_free(seen);
            }
}

/* A ball that does not reach the horizon hides (r / d)^2 cos(a) of the light of an even sky. */
static void skies_are_hidden(void **state)
{
    Fixture         *fixture = *state;
    KrsRenderOptions options = on_floor(0);
    double           error = 0, square = 0, most = 0;
    int              count = 0;
    make_floor(0);
    options.integrator = KRS_INTEGRATOR_DIRECT;
    options.samples    = 64;
    options.catcher    = KRS_CATCHER_SHADOWS;
    set(fixture, "day", 1);
    set(fixture, "at_lamp", 0);
    set(fixture, "at_sun", 0);
    KrsPicture *seen = fixture_render(fixture, options);
    for (int k = 0; k < PIXELS; k++) {
        double to[3];
        for (int i = 0; i < 3; i++)
            to[i] = middle[i] - ground.place[k][i];
        if (!ground.exists[k])
            continue;
        const double far = dot(to, to), hidden = RADIUS * RADIUS * to[1] / (far * sqrt(far));
        const double off = (double)seen->caught[k][0] - (1 - hidden);
        most             = fmax(most, hidden);
        error += off;
        square += off * off;
        count++;
    }
    krs_picture_free(seen);
    assert_true(count > 2000 && most > 0.3);
    assert_near(error / count, 0, 5 * sqrt(square) / count + 1e-4);
    assert_true(sqrt(square / count) < 0.05);
}

/* With all three lights of the scene the ratio is that of all light: of what the lamp, the sun and the
   sky send, as far as each is seen. */
static void lights_add_up(void **state)
{
    Fixture         *fixture = *state;
    KrsRenderOptions options = on_floor(0);
    make_floor(0);
    set(fixture, "day", 0.5);
    set(fixture, "at_lamp", 1);
    set(fixture, "at_sun", 1);
    KrsPicture *seen = fixture_render(fixture, options);
    for (int k = 0; k < PIXELS; k++) {
        double found = 0.5, without = 0.5, to[3];
        bool   clear = ground.exists[k];
        for (int light = 0; light < 2; light++) {
            toward(light, ground.place[k], to);
            const double far = dot(to, to), from = miss(ground.place[k], to);
            const double sent = (light == 0 ? 20 / far : 2) * to[1] / sqrt(far) / M_PI;
            clear             = clear && fabs(from - 1) >= 0.12;
            without += sent;
            found += from < 1 ? 0 : sent;
        }
        if (clear)
            assert_near((double)seen->caught[k][1], found / without, 2e-3);
    }
    krs_picture_free(seen);
}

/* The part of a whole picture that another shows is the same. */
static void assert_same_caught(const KrsPicture *a, const KrsPicture *b)
{
    const KrsWindow *window = &b->window;
    for (uint32_t y = 0; y < window->height; y++) {
        const size_t from = (y + window->y) * ACROSS + window->x, to = y * window->width;
        assert_memory_equal(a->caught[from], b->caught[to], window->width * sizeof *b->caught);
        assert_memory_equal(&a->color[4 * from], &b->color[4 * to],
                            4 * window->width * sizeof *b->color);
        assert_true(!a->mirrored == !b->mirrored);
        if (a->mirrored)
            assert_memory_equal(a->mirrored[from], b->mirrored[to],
                                window->width * sizeof *b->mirrored);
    }
}

/* Makes the ball a mirror, and the plate, where paths find what it mirrors. */
static void make_shiny(Fixture *fixture, KrsRenderOptions *options)
{
    set(fixture, "shine", 1);
    if (options->integrator == KRS_INTEGRATOR_PREVIEW)
        return;
    options->catcher           = KRS_CATCHER_GLOSSY;
    options->catcher_roughness = 0.1;
}

/* Bands and crops find the same.  Rays of a list do, but for rounding. */
static void slices_change_nothing(void **state)
{
    Fixture         *fixture = *state;
    KrsRenderOptions options = on_floor(0), part = options;
    make_floor(0);
    set(fixture, "day", 0.5);
    for (int i = 0; i < 2; i++) {
        options.integrator = i ? KRS_INTEGRATOR_PATH : KRS_INTEGRATOR_PREVIEW;
        options.samples    = 2;
        make_shiny(fixture, &options);
        part              = options;
        part.crop         = (KrsWindow){21, 13, 40, 30};
        KrsPicture *whole = fixture_render(fixture, options), *cut = fixture_render(fixture, part);
        assert_same_caught(whole, cut);
        krs_picture_free(whole);
        krs_picture_free(cut);
    }
    set(fixture, "shine", 0);
}

static void lists_of_rays_have_plates(void **state)
{
    static double origins[PIXELS][3], directions[PIXELS][3];
    static float  along[PIXELS];
    Fixture      *fixture = *state;
    KrsFilm      *film;
    KrsPicture   *seen;
    KrsRays       rays = {(const double(*)[3])origins, (const double(*)[3])directions, 0, 0.015, 0};
    make_floor(0);
    for (int k = 0; k < PIXELS; k++) {
        const Ray ray = ray_of(0, k % ACROSS + 0.5, k / ACROSS + 0.5);
        memcpy(origins[k], ray.origin, sizeof ray.origin);
        memcpy(directions[k], ray.direction, sizeof ray.direction);
        along[k] = ground.depth[k] * (float)sqrt(dot(ray.direction, ray.direction));
    }
    KrsRenderOptions options = on_floor(0);
    options.depth            = along;
    set(fixture, "day", 0);
    set(fixture, "at_lamp", 0);
    set(fixture, "at_sun", 1);
    assert_int_equal(krs_film_new(fixture->rendering, &options, &film), KRS_OK);
    assert_int_equal(krs_film_add_rays(film, fixture->state, &rays), KRS_OK);
    assert_int_equal(krs_film_read(film, 0, &seen), KRS_OK);
    memcpy(ground.depth, along, sizeof along);
    check_shadows(seen, 1, 40);
    krs_picture_free(seen);
    krs_film_free(film);
}

/* Without a plate the ratio is there if it is asked for, and not otherwise.  It needs depths. */
static void catchers_are_chosen(void **state)
{
    Fixture         *fixture = *state;
    KrsRenderOptions options = on_floor(0);
    KrsFilm         *film;
    make_floor(0);
    options.catcher   = KRS_CATCHER_NONE;
    KrsPicture *plain = fixture_render(fixture, options);
    assert_null(plain->caught);
    options.plate     = NULL;
    options.catcher   = KRS_CATCHER_DEFAULT;
    KrsPicture *alone = fixture_render(fixture, options);
    assert_null(alone->caught);
    options.catcher    = KRS_CATCHER_SHADOWS;
    KrsPicture *caught = fixture_render(fixture, options);
    assert_non_null(caught->caught);
    for (int k = 0; k < PIXELS; k++)
        if (!isfinite(ground.depth[k]))
            assert_true(caught->caught[k][0] == 1);
    options.depth = NULL;
    assert_int_equal(krs_film_new(fixture->rendering, &options, &film), KRS_BAD_ARGUMENT);
    options.depth   = ground.depth;
    options.catcher = KRS_CATCHER_GLOSSY; /* not with previews */
    assert_int_equal(krs_film_new(fixture->rendering, &options, &film), KRS_BAD_ARGUMENT);
    options.integrator          = KRS_INTEGRATOR_PATH;
    options.catcher_reflectance = 1;
    assert_int_equal(krs_film_new(fixture->rendering, &options, &film), KRS_BAD_ARGUMENT);
    krs_picture_free(plain);
    krs_picture_free(alone);
    krs_picture_free(caught);
}

/* Samples of plates end by noise as well, and the light of lights is apart from what is caught. */
static void noise_and_groups_have_plates(void **state)
{
    Fixture         *fixture = *state;
    KrsRenderOptions options = on_floor(0);
    make_floor(0);
    set(fixture, "day", 1);
    set(fixture, "at_lamp", 1);
    set(fixture, "at_sun", 0);
    options.integrator   = KRS_INTEGRATOR_DIRECT;
    options.samples      = 256;
    KrsPicture *all      = fixture_render(fixture, options);
    options.noise        = 0.02;
    KrsPicture *some     = fixture_render(fixture, options);
    options.noise        = 0;
    options.light_groups = true;
    options.samples      = 16;
    KrsPicture *groups   = fixture_render(fixture, options);
    options.light_groups = false;
    KrsPicture *together = fixture_render(fixture, options);
    double      square   = 0;
    for (int k = 0; k < PIXELS; k++) {
        const double off = (double)(all->caught[k][0] - some->caught[k][0]);
        square += off * off;
    }
    assert_true(sqrt(square / PIXELS) < 0.03);
    assert_true(some->stats.rays < all->stats.rays);
    assert_memory_equal(groups->caught, together->caught, PIXELS * sizeof *groups->caught);
    krs_picture_free(all);
    krs_picture_free(some);
    krs_picture_free(groups);
    krs_picture_free(together);
}

/* Graphics cards chain their passes; with the least limits there are several bands, without texels. */
static void every_device_finds_the_same(void **state)
{
    static const unsigned emulations[] = {EMULATE_CARD, EMULATE_MIN_LIMITS,
                                          EMULATE_CARD | EMULATE_MIN_LIMITS};
    Fixture              *plain        = *state;
    KrsRenderOptions      options      = on_floor(0);
    make_floor(0);
    options.no_occlusion = false;
    options.samples      = 2;
    set(plain, "day", 1);
    set(plain, "at_lamp", 1);
    set(plain, "at_sun", 0);
    for (int i = 0; i < 2; i++) {
        options.integrator = i ? KRS_INTEGRATOR_PATH : KRS_INTEGRATOR_PREVIEW;
        make_shiny(plain, &options);
        KrsPicture *expected = fixture_render(plain, options);
        for (size_t k = 0; k < sizeof emulations / sizeof *emulations; k++) {
            Fixture fixture;
            fixture_open_as(&fixture, ball_text, emulations[k]);
            set(&fixture, "day", 1);
            set(&fixture, "at_lamp", 1);
            set(&fixture, "at_sun", 0);
            set(&fixture, "shine", 1);
            KrsPicture *seen = fixture_render(&fixture, options);
            assert_same_caught(expected, seen);
            assert_int_equal(krs_renderer_validation_messages(fixture.renderer), 0);
            krs_picture_free(seen);
            fixture_close(&fixture);
        }
        krs_picture_free(expected);
    }
    set(plain, "shine", 0);
}

static int open_ball(void **state)
{
    static Fixture fixture;
    fixture_open(&fixture, ball_text, NULL);
    *state = &fixture;
    return 0;
}

static int close_ball(void **state)
{
    fixture_close(*state);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_cast_shadows),
        cmocka_unit_test(skies_are_hidden),
        cmocka_unit_test(lights_add_up),
        cmocka_unit_test(slices_change_nothing),
        cmocka_unit_test(lists_of_rays_have_plates),
        cmocka_unit_test(catchers_are_chosen),
        cmocka_unit_test(noise_and_groups_have_plates),
        cmocka_unit_test(every_device_finds_the_same),
    };
    return cmocka_run_group_tests(tests, open_ball, close_ball);
}
