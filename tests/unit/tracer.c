/*
 * tracer.c: the renderer against closed forms: a sphere seen by every kind of camera, from outside
 * and from inside; and what must not be seen in a picture: slices, crops, other samples.  All of it
 * under the validation layers, which must have nothing to say (devices.c shows that they speak).
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
#include "runtime/tracer/query.h"
#include "tests/unit/tracer_fixture.h"

/* The same on a ground that has to be marched. */
static const char terrace_text[] = "camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 40deg }\n"
                                   "show sphere(1).move([0, 1, 0]);\n"
                                   "show box([0.9, 0.9, 0.9]).move([2, 0.5, 0.2]);\n"
                                   "show box([80, 1, 80]).move([0, -0.5, 0]);\n";

static const double PI = 3.14159265358979323846;

/* ---- A sphere in closed form ---- */

static double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void unit3(double v[3])
{
    double length = sqrt(dot3(v, v));
    for (int i = 0; i < 3; i++)
        v[i] /= length;
}

static void cross3(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

typedef struct TestRay {
    double origin[3], direction[3], forward[3];
    double base, slope; /* of a pixel's width */
} TestRay;

/* Returns the ray through the centre of pixel (i, j), by interface.md and nothing else. */
static TestRay pixel_ray(const KrsCamera *camera, unsigned i, unsigned j)
{
    TestRay ray = {.base = 0};
    double  right[3], up[3];
    double  x = (i + 0.5) / WIDTH * 2 - 1, y = 1 - (j + 0.5) / HEIGHT * 2;
    for (int k = 0; k < 3; k++)
        ray.forward[k] = camera->target[k] - camera->eye[k];
    unit3(ray.forward);
    cross3(ray.forward, camera->up, right);
    unit3(right);
    cross3(right, ray.forward, up);

    double half = camera->projection == KRS_PERSPECTIVE ? tan(camera->fov / 2) : camera->height / 2;
    double lateral = x * half * WIDTH / HEIGHT, above = y * half;
    for (int k = 0; k < 3; k++) {
        ray.origin[k] = camera->eye[k];
        if (camera->projection == KRS_PERSPECTIVE) {
            ray.direction[k] = ray.forward[k] + lateral * right[k] + above * up[k];
        } else if (camera->projection == KRS_ORTHOGRAPHIC) {
            ray.origin[k] += lateral * right[k] + above * up[k];
            ray.direction[k] = ray.forward[k];
        } else {
            double level     = cos(x * PI) * ray.forward[k] + sin(x * PI) * right[k];
            ray.direction[k] = cos(y * PI / 2) * level + sin(y * PI / 2) * up[k];
        }
    }
    unit3(ray.direction);
    ray.base  = camera->projection == KRS_ORTHOGRAPHIC ? camera->height / HEIGHT : 0;
    ray.slope = camera->projection == KRS_PERSPECTIVE ? 2 * half / HEIGHT
                : camera->projection == KRS_PANORAMA  ? PI / HEIGHT
                                                      : 0;
    return ray;
}

static void check_pixel(const KrsPicture *picture, size_t index, const TestRay *ray, double radius,
                        bool panorama)
{
    double to_centre[3];
    for (int k = 0; k < 3; k++)
        to_centre[k] = CENTRE[k] - ray->origin[k];
    double along      = dot3(to_centre, ray->direction);
    double passes     = sqrt(fmax(dot3(to_centre, to_centre) - along * along, 0));
    bool   inside     = dot3(to_centre, to_centre) < radius * radius;
    double half_chord = sqrt(fmax(radius * radius - passes * passes, 0));
    double t          = inside ? along + half_chord : along - half_chord;
    double pixel      = ray->base + ray->slope * fmax(t, 0);
    bool   hit        = isfinite(picture->depth[index]);

    if (inside || (along > 0 && passes < radius - 1e-4 * pixel))
        assert_true(hit);
    if (!inside && (along < 0 || passes > radius + 0.26 * pixel))
        assert_false(hit);
    assert_int_equal(picture->component[index], hit);
    assert_true(picture->color[4 * index + 3] == (hit ? 1.0f : 0.0f));
    if (!hit) {
        for (int k = 0; k < 3; k++) {
            assert_true(picture->position[3 * index + k] == 0);
            assert_true(picture->normal[3 * index + k] == 0);
        }
        return;
    }

    double outwards[3], normal[3], distance = 0;
    for (int k = 0; k < 3; k++) {
        outwards[k] = picture->position[3 * index + k] - CENTRE[k];
        normal[k]   = picture->normal[3 * index + k];
    }
    distance = sqrt(dot3(outwards, outwards)) - radius;
    unit3(outwards);
    assert_near(sqrt(dot3(normal, normal)), 1, 1e-5);
    assert_true(dot3(outwards, normal) > 1 - 2e-5);

    /* Within a fiftieth of a pixel of the surface, unless the ray only grazes it. */
    double facing = fabs(dot3(outwards, ray->direction));
    assert_true(fabs(distance) < 0.26 * pixel + 2e-6);
    if (facing < 0.2)
        return;
    double depth = panorama ? t : t * dot3(ray->direction, ray->forward);
    assert_true(fabs(distance) < 0.02 * pixel + 2e-6);
    assert_near(picture->depth[index], depth, (0.02 * pixel + 4e-6) / facing);
}

static void sphere_is_where_it_should_be(void **state)
{
    Fixture *fixture = *state;
    for (size_t camera = 0; camera < CAMERA_COUNT; camera++) {
        KrsView     view;
        size_t      hits    = 0;
        KrsPicture *picture = fixture_render(fixture, (KrsRenderOptions){.camera = camera});
        assert_int_equal(krs_state_view(fixture->state, camera, &view), KRS_OK);
        for (unsigned j = 0; j < HEIGHT; j++)
            for (unsigned i = 0; i < WIDTH; i++) {
                TestRay ray = pixel_ray(&view.camera, i, j);
                check_pixel(picture, (size_t)j * WIDTH + i, &ray, 1,
                            view.camera.projection == KRS_PANORAMA);
                hits += picture->component[(size_t)j * WIDTH + i];
            }
        assert_int_equal(picture->stats.unresolved, 0);
        assert_in_range(hits, 100, WIDTH * HEIGHT - (camera != INNER));
        krs_picture_free(picture);
    }
}

static void parameters_need_no_compiling(void **state)
{
    Fixture *fixture = *state;
    double   size    = 0.5;
    KrsView  view;
    assert_int_equal(krs_state_set(fixture->state, "size", &size, 1), KRS_OK);
    KrsPicture *picture = fixture_render(fixture, (KrsRenderOptions){.camera = FLAT});
    assert_int_equal(krs_state_view(fixture->state, FLAT, &view), KRS_OK);
    for (unsigned j = 0; j < HEIGHT; j++)
        for (unsigned i = 0; i < WIDTH; i++) {
            TestRay ray = pixel_ray(&view.camera, i, j);
            check_pixel(picture, (size_t)j * WIDTH + i, &ray, size, false);
        }
    krs_picture_free(picture);
}

/* World position times the matrix, divided. */
static void project(const float p[3], float matrix[4][4], double out[3])
{
    double sum[4];
    for (int k = 0; k < 4; k++)
        sum[k] = p[0] * matrix[0][k] + p[1] * matrix[1][k] + p[2] * matrix[2][k] + matrix[3][k];
    for (int k = 0; k < 3; k++)
        out[k] = sum[k] / sum[3];
}

static void matrices_lead_back_to_the_pixel(void **state)
{
    Fixture *fixture = *state;
    for (size_t camera = FIRST; camera <= FLAT; camera++) {
        KrsPicture *picture = fixture_render(fixture, (KrsRenderOptions){.camera = camera});
        for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
            double place[3], ndc[3];
            if (!picture->component[i])
                continue;
            project(&picture->position[3 * i], picture->world_to_camera, place);
            project(&picture->position[3 * i], picture->world_to_ndc, ndc);
            assert_near(place[2], picture->depth[i], 1e-4);
            assert_near((ndc[0] + 1) / 2 * WIDTH, (double)(i % WIDTH) + 0.5, 1e-3);
            assert_near((1 - ndc[1]) / 2 * HEIGHT, (double)(i / WIDTH) + 0.5, 1e-3);
            /* The third coordinate tells depths apart: the matrix can be inverted. */
            assert_near(ndc[2], camera == FLAT ? place[2] : 1 - 1e-3 / place[2], 1e-4);
        }
        krs_picture_free(picture);
    }
}

static void samples_converge_on_the_area(void **state)
{
    Fixture         *fixture = *state;
    double           share = 0, pixel = 3.0 / HEIGHT;
    KrsRenderOptions options = {.camera = FLAT, .error = 0.01, .methods.no_filter = true};
    KrsPicture      *one     = fixture_render(fixture, options);
    options.samples          = 32;
    KrsPicture *many         = fixture_render(fixture, options);
    options.seed             = 5;
    KrsPicture *other        = fixture_render(fixture, options);
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        float alpha = many->color[4 * i + 3];
        assert_true(alpha * 32 == floorf(alpha * 32) && alpha <= 1);
        share += alpha;
    }
    assert_near(share, PI / (pixel * pixel), 0.002 * share);
    assert_int_equal(many->stats.rays, 32 * WIDTH * HEIGHT);

    /* What is not colour comes from the centre, whatever the samples and their seed. */
    assert_memory_equal(one->position, many->position, sizeof(float) * 3 * WIDTH * HEIGHT);
    assert_memory_equal(one->normal, other->normal, sizeof(float) * 3 * WIDTH * HEIGHT);
    assert_memory_equal(one->steps, other->steps, sizeof(uint32_t) * WIDTH * HEIGHT);
    assert_memory_not_equal(many->color, other->color, sizeof(float) * 4 * WIDTH * HEIGHT);
    krs_picture_free(one);
    krs_picture_free(many);
    krs_picture_free(other);
}

static void points_are_sampled(void **state)
{
    enum { COUNT = 40000 };
    Fixture            *fixture = *state;
    static float        points[COUNT][3], distances[COUNT];
    static SurfacePoint surfaces[COUNT];
    for (int i = 0; i < COUNT; i++)
        for (int k = 0; k < 3; k++)
            points[i][k] = (float)sin(i * (k + 1.7)) * 3;
    KrsStatus status = point_query_sample(fixture->rendering, fixture->state,
                                          (const float(*)[3])points, COUNT, distances, surfaces);
    assert_int_equal(status, KRS_OK);
    for (int i = 0; i < COUNT; i++) {
        double offset[3];
        for (int k = 0; k < 3; k++)
            offset[k] = points[i][k] - CENTRE[k];
        assert_near(distances[i], sqrt(dot3(offset, offset)) - 1, 2e-6);
        assert_near(surfaces[i].distance, distances[i], 2e-6);
        assert_int_equal(surfaces[i].component, 1);
    }
    assert_int_equal(krs_device_distance(fixture->rendering, fixture->state, NULL, 0, NULL),
                     KRS_OK);
    assert_int_equal(krs_device_distance(fixture->rendering, fixture->state, NULL, 1, distances),
                     KRS_BAD_ARGUMENT);
    static const float wrong[] = {NAN, INFINITY, -2e18f};
    for (int i = 0; i < 3; i++) {
        const float point[2][3] = {{0, 0, 0}, {0, wrong[i], 0}};
        distances[0]            = 7;
        assert_int_equal(
            krs_device_distance(fixture->rendering, fixture->state, point, 2, distances),
            KRS_BAD_ARGUMENT);
        assert_true(distances[0] == 7);
        assert_true(strlen(krs_renderer_message(fixture->renderer)) > 0);
    }
}

/* ---- What must not be seen ---- */

static void assert_same_pictures(const KrsPicture *a, const KrsPicture *b, size_t pixels)
{
    assert_memory_equal(a->color, b->color, pixels * 4 * sizeof(float));
    assert_memory_equal(a->depth, b->depth, pixels * sizeof(float));
    assert_memory_equal(a->position, b->position, pixels * 3 * sizeof(float));
    assert_memory_equal(a->normal, b->normal, pixels * 3 * sizeof(float));
    assert_memory_equal(a->albedo, b->albedo, pixels * 3 * sizeof(float));
    assert_memory_equal(a->component, b->component, pixels * sizeof(uint32_t));
    assert_memory_equal(a->steps, b->steps, pixels * sizeof(uint32_t));
}

static void slices_are_not_seen(void **state)
{
    (void)state;
    Fixture fixture = {0};
    fixture_open(&fixture, landscape_text, NULL);
    KrsPicture *whole = fixture_render(
        &fixture, (KrsRenderOptions){.slice_ms = 1e6, .methods.steps_at_once = 8192});
    KrsPicture *sliced = fixture_render(
        &fixture, (KrsRenderOptions){.slice_ms = 0.001, .methods.steps_at_once = 3});
    assert_true(whole->stats.max_evaluations_per_ray > 30);
    assert_same_pictures(whole, sliced, (size_t)WIDTH * HEIGHT);
    assert_int_equal(whole->stats.evaluations, sliced->stats.evaluations);
    for (size_t i = 0; i < (size_t)4 * WIDTH * HEIGHT; i++)
        assert_true(isfinite(whole->color[i]) && whole->color[i] >= 0);
    krs_picture_free(whole);
    krs_picture_free(sliced);
    assert_int_equal(krs_renderer_validation_messages(fixture.renderer), 0);
    fixture_close(&fixture);
}

/* Beams begin rays later, and that is all: what the rays see stays to a small part of a pixel,
   but for outlines, and costs less. */
static void beams_are_not_seen(void **state)
{
    (void)state;
    Fixture fixture = {0};
    fixture_open(&fixture, terrace_text, NULL);
    KrsPicture *behind = fixture_render(&fixture, (KrsRenderOptions){.samples = 1});
    KrsPicture *alone  = fixture_render(&fixture,
                                        (KrsRenderOptions){.samples = 1, .methods.no_beams = true});
    unsigned    other = 0, apart = 0;
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        other += behind->component[i] != alone->component[i];
        if (!behind->component[i] || behind->component[i] != alone->component[i])
            continue;
        double off = 0; /* across the surface: along it a grazing ray may end anywhere */
        for (int k = 0; k < 3; k++)
            off += ((double)behind->position[3 * i + k] - alone->position[3 * i + k]) *
                   alone->normal[3 * i + k];
        apart += fabs(off) > 3e-4 * alone->depth[i];
    }
    assert_true(other * 500 <= WIDTH * HEIGHT);
    assert_true(apart * 500 <= WIDTH * HEIGHT);
    assert_true(behind->stats.phase_ms[KRS_PHASE_BEAMS] > 0);
    assert_true(alone->stats.phase_ms[KRS_PHASE_BEAMS] == 0);
    assert_true(behind->stats.evaluations < 0.9 * (double)alone->stats.evaluations);
    krs_picture_free(behind);
    krs_picture_free(alone);
    fixture_close(&fixture);
}

/* A zone far away changes nothing but that planes may have holes, and so are marched. */
static void marched_planes_look_the_same(void **state)
{
    (void)state;
    static const double far_away[1][4] = {{0, -1e5, 0, 1}};
    Fixture             fixture        = {0};
    fixture_open(&fixture,
                 "camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 40deg }\n"
                 "camera below { eye: [3, -2, 5], target: [0, 0.5, 0] }\n"
                 "show sphere(1).move([0, 0.4, 0]);\n"
                 "show plane([0.1, 1, 0], 0);\n"
                 "show plane([0.5, 0.2, 1], -3).rotate([0, 1, 0], 20deg).paint(#4050c0);\n",
                 NULL);
    for (uint32_t camera = 0; camera < 2; camera++) {
        KrsPicture *known = fixture_render(&fixture,
                                           (KrsRenderOptions){.samples = 1, .camera = camera});
        assert_int_equal(krs_state_set_zones(fixture.state, far_away, 1), KRS_OK);
        KrsPicture *marched = fixture_render(&fixture,
                                             (KrsRenderOptions){.samples = 1, .camera = camera});
        assert_int_equal(krs_state_set_zones(fixture.state, NULL, 0), KRS_OK);
        unsigned other = 0, planes = 0;
        for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
            other += known->component[i] != marched->component[i];
            planes += known->component[i] > 1;
            if (known->component[i] == marched->component[i] && known->component[i])
                assert_true(fabsf(known->depth[i] - marched->depth[i]) <=
                            2e-3f * (1 + known->depth[i]));
        }
        assert_true(other * 200 <= WIDTH * HEIGHT);
        assert_true(planes > 1000);
        if (camera == 0) /* below, all rays begin inside, and none of the planes is known */
            assert_true(known->stats.evaluations < 0.3 * (double)marched->stats.evaluations);
        assert_int_equal(known->stats.unresolved, 0);
        krs_picture_free(known);
        krs_picture_free(marched);
    }
    assert_int_equal(krs_renderer_validation_messages(fixture.renderer), 0);
    fixture_close(&fixture);
}

/* A row of cells that mirrors fill looks the same everywhere, also where single precision knows a
   point to a thirty-second only. */
static void far_cells_look_like_near_ones(void **state)
{
    (void)state;
    static const char row[] =
        "param off = 16;\n"
        "camera { eye: [off + 1.2, 1.3, 3.5], target: [off, 0.6, 0], fov: 40deg }\n"
        "light { position: [off - 2, 4, 3] }\n"
        "show krs {\n"
        "    kernel capsule([0, 0, 0], [0.1, 0.8, 0], 0.05)\n"
        "         | box([0.2, 0.3, 0.2]).move([0.5, 0.2, 0]);\n"
        "    for i in 0..20 { reflect plane([1, 0, 0], 2^i); }\n"
        "};\n"
        "show plane([0, 1, 0], 0);\n";
    Fixture fixture = {0};
    fixture_open(&fixture, row, NULL);
    KrsPicture *near = fixture_render(&fixture, (KrsRenderOptions){.samples = 1});
    double      off  = 400000;
    assert_int_equal(krs_state_set(fixture.state, "off", &off, 1), KRS_OK);
    KrsPicture *far   = fixture_render(&fixture, (KrsRenderOptions){.samples = 1});
    unsigned    other = 0, hits = 0;
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        bool same = near->component[i] == far->component[i];
        hits += near->component[i] == 1;
        other += !same;
        for (int k = 0; same && near->component[i] && k < 3; k++) {
            double moved = k == 0 ? off - 16 : 0;
            double apart = fabs(far->position[3 * i + k] - moved - near->position[3 * i + k]);
            other += apart > (k == 0 ? 0.04 : 2e-3) + 1e-3 * near->depth[i]; /* outlines */
            other += fabsf(near->normal[3 * i + k] - far->normal[3 * i + k]) > 0.1f;
        }
    }
    assert_true(hits > 150);
    assert_true(other * 100 <= WIDTH * HEIGHT);
    krs_picture_free(near);
    krs_picture_free(far);
    assert_int_equal(krs_renderer_validation_messages(fixture.renderer), 0);
    fixture_close(&fixture);
}

static void crops_are_parts(void **state)
{
    Fixture        *fixture = *state;
    const KrsWindow crop    = {33, 17, 41, 30};
    KrsPicture     *whole   = fixture_render(fixture, (KrsRenderOptions){.samples = 2});
    KrsPicture     *part = fixture_render(fixture, (KrsRenderOptions){.samples = 2, .crop = crop});
    assert_int_equal(part->width, WIDTH);
    assert_memory_equal(&part->window, &crop, sizeof crop);
    for (uint32_t y = 0; y < crop.height; y++) {
        size_t     here = (size_t)y * crop.width, there = (size_t)(crop.y + y) * WIDTH + crop.x;
        KrsPicture a = *part, b = *whole;
        a.color += 4 * here, b.color += 4 * there;
        a.depth += here, b.depth += there;
        a.position += 3 * here, b.position += 3 * there;
        a.normal += 3 * here, b.normal += 3 * there;
        a.albedo += 3 * here, b.albedo += 3 * there;
        a.component += here, b.component += there;
        a.steps += here, b.steps += there;
        assert_same_pictures(&a, &b, crop.width);
    }
    krs_picture_free(whole);
    krs_picture_free(part);
}

static void bands_are_not_seen(void **state)
{
    /* Wide enough for several bands; its middle row is also rendered alone. */
    Fixture         *fixture = *state;
    KrsRenderOptions options = {.width = 1000, .height = 600};
    KrsPicture      *whole   = fixture_render(fixture, options);
    options.crop             = (KrsWindow){0, 300, 1000, 1};
    KrsPicture *part         = fixture_render(fixture, options);
    assert_memory_equal(part->color, &whole->color[4 * 1000 * 300], 4 * 1000 * sizeof(float));
    assert_int_equal(whole->stats.rays, 600000);
    krs_picture_free(whole);
    krs_picture_free(part);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(sphere_is_where_it_should_be, fixture_set_up,
                                        fixture_tear_down),
        cmocka_unit_test_setup_teardown(parameters_need_no_compiling, fixture_set_up,
                                        fixture_tear_down),
        cmocka_unit_test_setup_teardown(matrices_lead_back_to_the_pixel, fixture_set_up,
                                        fixture_tear_down),
        cmocka_unit_test_setup_teardown(samples_converge_on_the_area, fixture_set_up,
                                        fixture_tear_down),
        cmocka_unit_test_setup_teardown(points_are_sampled, fixture_set_up, fixture_tear_down),
        cmocka_unit_test(slices_are_not_seen),
        cmocka_unit_test(beams_are_not_seen),
        cmocka_unit_test(marched_planes_look_the_same),
        cmocka_unit_test(far_cells_look_like_near_ones),
        cmocka_unit_test_setup_teardown(crops_are_parts, fixture_set_up, fixture_tear_down),
        cmocka_unit_test_setup_teardown(bands_are_not_seen, fixture_set_up, fixture_tear_down),
    };
    spirv_start(); /* held for all, so that no renderer starts the shader compiler anew */
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    spirv_stop();
    return failed;
}
