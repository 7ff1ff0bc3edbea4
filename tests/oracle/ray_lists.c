/*
 * ray_lists.c: pictures by rays of a list show what those rays meet.
 *
 * Random rays, from outside and from within solids, are pixels of a picture; the host casts the same
 * rays in double precision.  Rays of spheres and planes have closed forms, too.  And the rays of a
 * camera, as a list, show what the camera shows.  A list that is slightly wrong is found out.
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
#include "tests/support/random.h"
#include "tests/support/renderer.h"

enum { WIDTH = 72, HEIGHT = 44, PIXELS = WIDTH * HEIGHT };
enum { ASKED = 400 }; /* rays that the host casts, too */

typedef struct Fixture {
    KrsScene     *scene;
    KrsState     *state;
    KrsRendering *rendering;
} Fixture;

static void fixture_prepare(Fixture *fixture, KrsStatus status)
{
    assert_int_equal(status, KRS_OK);
    assert_int_equal(krs_state_new(fixture->scene, &fixture->state), KRS_OK);
    if (krs_rendering_new(renderer, fixture->scene, KRS_FOR_PICTURES, &fixture->rendering) !=
        KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
}

static Fixture fixture_of_text(const char *text)
{
    Fixture fixture;
    fixture_prepare(&fixture,
                    krs_compile_text(text, strlen(text), "rays.krs", NULL, &fixture.scene));
    return fixture;
}

static void fixture_close(Fixture *fixture)
{
    krs_rendering_free(fixture->rendering);
    krs_state_free(fixture->state);
    krs_scene_free(fixture->scene);
}

/* ---- Lists ---- */

typedef struct List {
    double origins[PIXELS][3], directions[PIXELS][3]; /* the latter of any length */
} List;

static KrsRays rays_of(const List *list, double spread)
{
    return (KrsRays){(const double(*)[3])list->origins, (const double(*)[3])list->directions,
                     .width = 1e-4, .spread = spread};
}

static KrsPicture *picture_of_rays(Fixture *fixture, const KrsRays *rays,
                                   const KrsRenderOptions *asked)
{
    KrsRenderOptions options = asked ? *asked : (KrsRenderOptions){0};
    KrsFilm         *film;
    KrsPicture      *picture;
    options.width  = WIDTH;
    options.height = HEIGHT;
    if (krs_film_new(fixture->rendering, &options, &film) != KRS_OK ||
        krs_film_add_rays(film, fixture->state, rays) != KRS_OK ||
        krs_film_read(film, 0, &picture) != KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
    krs_film_free(film);
    return picture;
}

/* Rays to points of a box, from a larger one around it. */
static void draw_rays(List *list, const double low[3], const double high[3], Random *random)
{
    for (int k = 0; k < PIXELS; k++) {
        const double stretch = random_between(random, 0.5, 20);
        for (int i = 0; i < 3; i++) {
            const double size      = high[i] - low[i];
            const double target    = random_between(random, low[i], high[i]);
            list->origins[k][i]    = random_between(random, low[i] - size, high[i] + size);
            list->directions[k][i] = stretch * (target - list->origins[k][i]);
        }
    }
}

/* ---- What rays meet ---- */

/* Returns the part of the rays of which a picture says something else than the host: a hit where
   the distance is not next to nothing, or none where the host's ray goes well into something. */
static double disagreement(Fixture *fixture, const KrsPicture *picture, const List *list,
                           double spread)
{
    KrsHit hits[ASKED];
    int    wrong = 0;
    assert_int_equal(krs_raycast(fixture->state, (const double(*)[3])list->origins,
                                 (const double(*)[3])list->directions, ASKED, HUGE_VAL, 1e-6, hits),
                     KRS_OK);
    for (int k = 0; k < ASKED; k++) {
        const double t = picture->depth[k], width = 1e-4 + spread * fmin(t, hits[k].t);
        if (!hits[k].hit || !isfinite(t))
            wrong += hits[k].hit != (bool)isfinite(t);
        else
            wrong += fabs(t - hits[k].t) > width + 1e-5 * (1 + t) ||
                     picture->component[k] != hits[k].component;
    }
    return (double)wrong / ASKED;
}

/* The box around the bounded components. */
static void box_of(const KrsScene *scene, double low[3], double high[3])
{
    for (int i = 0; i < 3; i++) {
        low[i]  = HUGE_VAL;
        high[i] = -HUGE_VAL;
    }
    for (size_t c = 0; c < krs_component_count(scene); c++) {
        KrsComponent component;
        krs_component(scene, c, &component);
        for (int i = 0; i < 3; i++) {
            low[i]  = isfinite(component.low[i]) ? fmin(low[i], component.low[i]) : low[i];
            high[i] = isfinite(component.high[i]) ? fmax(high[i], component.high[i]) : high[i];
        }
    }
}

static void examples_are_met(void **context)
{
    static const char *const paths[] = {"examples/03-machined-part.krs",
                                        "examples/14-inversion.krs", "examples/21-sextic.krs"};
    static List              list, turned;
    Random                   random = {5};
    const double             spread = 2e-3;
    (void)context;
    for (size_t i = 0; i < sizeof paths / sizeof paths[0]; i++) {
        double  low[3], high[3];
        Fixture fixture;
        fixture_prepare(&fixture, krs_compile_file(paths[i], NULL, &fixture.scene));
        box_of(fixture.scene, low, high);
        draw_rays(&list, low, high, &random);
        const KrsRays rays    = rays_of(&list, spread);
        KrsPicture   *picture = picture_of_rays(&fixture, &rays, NULL);
        const double  wrong   = disagreement(&fixture, picture, &list, spread);
        /* The same question with rays that are turned by a hundredth must not agree. */
        for (int k = 0; k < PIXELS; k++)
            for (int n = 0; n < 3; n++)
                turned.directions[k][n] = list.directions[k][n] +
                                          0.01 * list.directions[k][(n + 1) % 3];
        memcpy(turned.origins, list.origins, sizeof turned.origins);
        const double planted = disagreement(&fixture, picture, &turned, spread);
        print_message("# %s: %.4f of the rays disagree, %.2f if turned\n", paths[i], wrong,
                      planted);
        assert_true(wrong <= 0.01);
        assert_true(planted >= 0.1);
        krs_picture_free(picture);
        fixture_close(&fixture);
    }
}

/* Where a ray meets a sphere around `centre`, from outside or from within; HUGE_VAL: nowhere. */
static double sphere_t(const double origin[3], const double unit[3], const double centre[3],
                       double radius)
{
    double b = 0, c = -radius * radius;
    for (int i = 0; i < 3; i++) {
        b += (origin[i] - centre[i]) * unit[i];
        c += (origin[i] - centre[i]) * (origin[i] - centre[i]);
    }
    const double root = b * b - c;
    if (root < 0)
        return HUGE_VAL;
    const double first = -b - sqrt(root), second = -b + sqrt(root);
    return first > 0 ? first : second > 0 ? second : HUGE_VAL;
}

/* A ball far from the origin, in whose middle half of the rays begin. */
static void spheres_have_a_closed_form(void **context)
{
    static List  list;
    const double centre[3] = {40000, -20000, 30000}, low[3] = {39998, -20002, 29998},
                 high[3] = {40002, -19998, 30002};
    Fixture fixture      = fixture_of_text("show sphere(1).move([40000, -20000, 30000]);");
    Random  random       = {9};
    int     inside = 0, outside = 0;
    (void)context;
    draw_rays(&list, low, high, &random);
    for (int k = 0; k < PIXELS / 2; k++)
        for (int i = 0; i < 3; i++)
            list.origins[k][i] = centre[i] + random_between(&random, -0.5, 0.5);
    const KrsRays rays    = rays_of(&list, 1e-4);
    KrsPicture   *picture = picture_of_rays(&fixture, &rays, NULL);
    for (int k = 0; k < PIXELS; k++) {
        const double *d = list.directions[k], length = hypot(hypot(d[0], d[1]), d[2]);
        const double  unit[3] = {d[0] / length, d[1] / length, d[2] / length};
        const double  t       = sphere_t(list.origins[k], unit, centre, 1);
        assert_true(isfinite(t) == (bool)isfinite(picture->depth[k]));
        if (!isfinite(t))
            continue;
        inside += k < PIXELS / 2;
        outside += k >= PIXELS / 2;
        assert_true(fabs(t - picture->depth[k]) < 1e-4 * (1 + t));
        for (int i = 0; i < 3; i++) {
            const double position = list.origins[k][i] + t * unit[i];
            assert_true(fabs(position - picture->position[3 * k + i]) < 0.01);
            assert_true(fabs((position - centre[i]) - picture->normal[3 * k + i]) < 0.02);
        }
    }
    assert_int_equal(inside, PIXELS / 2);
    assert_in_range(outside, PIXELS / 50, PIXELS / 2);
    krs_picture_free(picture);
    fixture_close(&fixture);
}

/* ---- A camera as a list ---- */

static void subtract(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[i] - b[i];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static double length_of(const double v[3]) { return hypot(hypot(v[0], v[1]), v[2]); }

/* Lists the rays through the centres of the pixels of a perspective camera; *spread as of its
   pixels. */
static void list_camera(const KrsCamera *camera, List *list, double *spread)
{
    const double half = tan(camera->fov / 2);
    double       forward[3], right[3], up[3];
    subtract(camera->target, camera->eye, forward);
    cross(forward, camera->up, right);
    cross(right, forward, up);
    for (int k = 0; k < PIXELS; k++) {
        const double x = (2 * (k % WIDTH + 0.5) / WIDTH - 1) * half * WIDTH / HEIGHT;
        const double y = (1 - 2 * (k / WIDTH + 0.5) / HEIGHT) * half;
        for (int i = 0; i < 3; i++) {
            list->origins[k][i]    = camera->eye[i];
            list->directions[k][i] = forward[i] / length_of(forward) +
                                     x * right[i] / length_of(right) + y * up[i] / length_of(up);
        }
    }
    *spread = 2 * half / HEIGHT;
}

/* The mean difference of colours where both show the same component and none of the neighbours
   another; a ray's own width differs from a pixel's towards the edges of the picture. */
static double color_difference(const KrsPicture *a, const KrsPicture *b)
{
    double sum = 0, size = 0;
    for (int k = 1; k < PIXELS; k++) {
        if (a->component[k] != b->component[k] || a->component[k] != a->component[k - 1])
            continue;
        for (int i = 0; i < 3; i++) {
            sum += fabs((double)a->color[4 * k + i] - (double)b->color[4 * k + i]);
            size += fabs((double)a->color[4 * k + i]);
        }
    }
    return sum / size;
}

static void cameras_are_lists(void **context)
{
    static const char text[] =
        "camera { eye: [3, 2, 5], target: [0, 0.7, 0], fov: 40deg }"
        "light sun { direction: [-1, 2, 1], intensity: 3, softness: 2deg }"
        "light lamp { position: [1, 3, 2], intensity: 8, softness: 0.2 }"
        "show sphere(1).move([0, 1, 0]); show box([0.9, 0.9, 0.9]).move([2, 0.5, 0.2]);"
        "show plane([0, 1, 0], 0);";
    static List list;
    Fixture     fixture = fixture_of_text(text);
    KrsCamera   camera;
    double      spread;
    (void)context;
    assert_int_equal(krs_state_camera(fixture.state, 0, &camera), KRS_OK);
    list_camera(&camera, &list, &spread);
    KrsRays rays                     = rays_of(&list, spread);
    rays.width                       = 0;
    const KrsRenderOptions choices[] = {
        {.width = WIDTH, .height = HEIGHT},
        {.width = WIDTH, .height = HEIGHT, .crop = {11, 7, 40, 30}},
        {.width                 = WIDTH,
         .height                = HEIGHT,
         .methods.schedule      = KRS_SCHEDULE_QUEUE,
         .methods.steps_at_once = 3},
    };
    KrsPicture *seen, *whole = picture_of_rays(&fixture, &rays, &choices[0]);
    assert_int_equal(krs_render(fixture.rendering, fixture.state, &choices[0], &seen), KRS_OK);
    int same = 0;
    for (int k = 0; k < PIXELS; k++) {
        const double *d = list.directions[k]; /* 1 along the view */
        same += seen->component[k] == whole->component[k] &&
                (!seen->component[k] ||
                 fabs(whole->depth[k] / length_of(d) - seen->depth[k]) < 1e-3 * seen->depth[k]);
    }
    print_message("# %d of %d pixels are the camera's, colours differ by %.4f\n", same, PIXELS,
                  color_difference(seen, whole));
    assert_in_range(same, PIXELS * 99 / 100, PIXELS);
    assert_true(color_difference(seen, whole) < 0.02);
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 4; k++)
            assert_true(whole->world_to_camera[i][k] == (float)(i == k));

    /* Crops and schedules change no bit. */
    KrsPicture *part = picture_of_rays(&fixture, &rays, &choices[1]),
               *fine = picture_of_rays(&fixture, &rays, &choices[2]);
    for (uint32_t y = 0; y < 30; y++)
        assert_memory_equal(part->color + (size_t)4 * 40 * y,
                            whole->color + 4 * ((size_t)(7 + y) * WIDTH + 11),
                            40 * 4 * sizeof(float));
    assert_memory_equal(fine->color, whole->color, PIXELS * 4 * sizeof(float));
    krs_picture_free(seen);
    krs_picture_free(whole);
    krs_picture_free(part);
    krs_picture_free(fine);
    fixture_close(&fixture);
}

/* ---- What else is promised ---- */

static void rays_end_where_they_are_told(void **context)
{
    static List  list;
    const double low[3] = {-1, -1, -1}, high[3] = {1, 1, 1};
    Fixture      fixture = fixture_of_text("show sphere(1);");
    Random       random  = {2};
    int          nearer  = 0;
    (void)context;
    draw_rays(&list, low, high, &random);
    KrsRays     rays = rays_of(&list, 1e-3);
    KrsPicture *far  = picture_of_rays(&fixture, &rays, NULL);
    rays.farthest    = 1.5;
    KrsPicture *near = picture_of_rays(&fixture, &rays, NULL);
    for (int k = 0; k < PIXELS; k++) {
        if (fabsf(far->depth[k] - 1.5f) < 1e-3f)
            continue;
        assert_true(far->depth[k] < 1.5f ? near->depth[k] == far->depth[k] : isinf(near->depth[k]));
        nearer += far->depth[k] < 1.5f;
    }
    assert_in_range(nearer, PIXELS / 20, PIXELS);
    krs_picture_free(far);
    krs_picture_free(near);
    fixture_close(&fixture);
}

/* A camera and lists by turns: each has its own kernels, and samples add up. */
static void lists_and_cameras_take_turns(void **context)
{
    static List            list;
    const KrsRenderOptions options = {.width = WIDTH, .height = HEIGHT, .samples = 2};
    Fixture     fixture = fixture_of_text("camera { eye: [0, 0.5, 4], fov: 0.6 } show sphere(1);");
    KrsCamera   camera;
    double      spread;
    KrsFilm    *film;
    KrsPicture *picture, *before, *after;
    (void)context;
    assert_int_equal(krs_state_camera(fixture.state, 0, &camera), KRS_OK);
    list_camera(&camera, &list, &spread);
    const KrsRays rays = rays_of(&list, spread);
    assert_int_equal(krs_render(fixture.rendering, fixture.state, &options, &before), KRS_OK);
    assert_int_equal(krs_film_new(fixture.rendering, &options, &film), KRS_OK);
    assert_int_equal(krs_film_add_rays(film, fixture.state, &rays), KRS_OK);
    assert_int_equal(krs_film_add(film, fixture.state, NULL, 1), KRS_OK);
    assert_int_equal(krs_film_add_rays(film, fixture.state, &rays), KRS_OK);
    assert_int_equal(krs_film_read(film, 0, &picture), KRS_OK);
    assert_int_equal(krs_render(fixture.rendering, fixture.state, &options, &after), KRS_OK);
    assert_memory_equal(before->color, after->color, PIXELS * 4 * sizeof(float));
    for (int k = 0; k < PIXELS; k++)
        assert_true(fabsf(3 * picture->color[4 * k + 3] - roundf(3 * picture->color[4 * k + 3])) <
                    1e-5f);
    krs_picture_free(before);
    krs_picture_free(after);
    krs_picture_free(picture);
    krs_film_free(film);
    fixture_close(&fixture);
}

static void wrong_rays_are_refused(void **context)
{
    static List            list;
    const double           low[3] = {-1, -1, -1}, high[3] = {1, 1, 1};
    const KrsRenderOptions options = {.width = WIDTH, .height = HEIGHT};
    Fixture                fixture = fixture_of_text("show sphere(1);");
    Random                 random  = {3};
    KrsFilm               *film;
    (void)context;
    draw_rays(&list, low, high, &random);
    assert_int_equal(krs_film_new(fixture.rendering, &options, &film), KRS_OK);
    const struct {
        double *number, value;
    } wrong[]    = {{&list.origins[PIXELS - 1][2], NAN}, {&list.directions[7][0], INFINITY}};
    KrsRays rays = rays_of(&list, 0);
    rays.width   = 0;
    assert_int_equal(krs_film_add_rays(film, fixture.state, &rays), KRS_BAD_ARGUMENT);
    rays.width = -1;
    assert_int_equal(krs_film_add_rays(film, fixture.state, &rays), KRS_BAD_ARGUMENT);
    rays.width = 1e-3;
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        const double right = *wrong[i].number;
        *wrong[i].number   = wrong[i].value;
        assert_int_equal(krs_film_add_rays(film, fixture.state, &rays), KRS_BAD_ARGUMENT);
        *wrong[i].number = right;
    }
    memset(list.directions[5], 0, sizeof list.directions[5]);
    assert_int_equal(krs_film_add_rays(film, fixture.state, &rays), KRS_BAD_ARGUMENT);
    list.directions[5][0] = 1;
    assert_int_equal(krs_film_add_rays(film, fixture.state, &rays), KRS_OK);
    krs_film_free(film);
    fixture_close(&fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(examples_are_met),
        cmocka_unit_test(spheres_have_a_closed_form),
        cmocka_unit_test(cameras_are_lists),
        cmocka_unit_test(rays_end_where_they_are_told),
        cmocka_unit_test(lists_and_cameras_take_turns),
        cmocka_unit_test(wrong_rays_are_refused),
    };
    return cmocka_run_group_tests(tests, renderer_open, renderer_close);
}
