/*
 * The renderer against closed forms: a sphere seen by every kind of camera, from outside and
 * from inside; and what must not be seen in a picture: slices, crops, other samples.  All of it
 * under the validation layers, which must have nothing to say, and are first shown to speak.
 */
#include <ctype.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <cmocka.h>

#include "compiler/compile.h"
#include "runtime/device/buffer.h"
#include "runtime/krs_vulkan.h"
#include "tests/support/device.h"
#include "tests/support/scarce.h"

#define assert_near(value, expected, within) assert_true(fabs((value) - (expected)) <= (within))

static const char scene_text[] =
    "param size = 1 in [0.1, 1.5];\n"
    "camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 40deg }\n"
    "camera flat { eye: [-2, 3, 4], target: [0.3, 0.2, -0.1],\n"
    "              projection: \"orthographic\", height: 3 }\n"
    "camera round { eye: [2, 0.5, 1], target: [0, 0, 0], projection: \"panorama\" }\n"
    "camera inner { eye: [0.2, 0.1, -0.3], target: [0, 1, 0], up: [0, 0, 1], fov: 60deg }\n"
    "light sun { direction: [-1, 2, 1], intensity: 3, softness: 1deg }\n"
    "show sphere(size).move([0.3, 0.2, -0.1]);\n";

static const char landscape_text[] =
    "camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 40deg }\n"
    "light sun { direction: [-1, 2, 1], intensity: 3, softness: 1deg }\n"
    "show sphere(1).move([0, 1, 0]);\n"
    "show box([0.9, 0.9, 0.9]).move([2, 0.5, 0.2]);\n"
    "show plane([0, 1, 0], 0);\n";

/* The same on a ground that has to be marched. */
static const char terrace_text[] = "camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 40deg }\n"
                                   "show sphere(1).move([0, 1, 0]);\n"
                                   "show box([0.9, 0.9, 0.9]).move([2, 0.5, 0.2]);\n"
                                   "show box([80, 1, 80]).move([0, -0.5, 0]);\n";

enum { FIRST, FLAT, ROUND, INNER, CAMERA_COUNT };
enum { WIDTH = 97, HEIGHT = 61 };

static const double CENTRE[3] = {0.3, 0.2, -0.1};
static const double PI        = 3.14159265358979323846;

/* What most tests need: a renderer with validation, and the sphere on it. */
typedef struct Stage {
    KrsRenderer  *renderer;
    KrsScene     *scene;
    KrsFrame     *frame;
    KrsRendering *rendering;
    unsigned      complaints;
    char          complaint[2048]; /* the last */
} Stage;

static void note_complaint(void *user, const char *message)
{
    Stage *stage = user;
    stage->complaints++;
    snprintf(stage->complaint, sizeof stage->complaint, "%s", message);
}

static void print_diagnostic(void *user, const KrsDiagnostic *diagnostic)
{
    (void)user;
    fputs(diagnostic->text, stderr);
}

static void stage_open(Stage *stage, const char *text, const KrsAllocator *allocator)
{
    KrsRendererOptions options = {
        .device = tested_device(), .validation = true, .complaint = note_complaint, .user = stage};
    KrsOptions compiling = {.diagnostic = print_diagnostic};
    if (allocator)
        options.allocator = *allocator;
    KrsStatus status = krs_renderer_new(&options, &stage->renderer);
    if (status != KRS_OK)
        fail_msg("%s", krs_renderer_message(stage->renderer));
    assert_int_equal(krs_compile_text(text, strlen(text), "test.krs", &compiling, &stage->scene),
                     KRS_OK);
    assert_int_equal(krs_frame_new(stage->scene, &stage->frame), KRS_OK);
    if (krs_rendering_new(stage->renderer, stage->scene, &stage->rendering) != KRS_OK)
        fail_msg("%s", krs_renderer_message(stage->renderer));
}

static void stage_close(Stage *stage)
{
    krs_rendering_free(stage->rendering);
    krs_frame_free(stage->frame);
    krs_scene_free(stage->scene);
    krs_renderer_free(stage->renderer);
}

static KrsPicture *render(Stage *stage, KrsRenderOptions options)
{
    KrsPicture *picture;
    if (options.width == 0) {
        options.width  = WIDTH;
        options.height = HEIGHT;
    }
    if (krs_render(stage->rendering, stage->frame, &options, &picture) != KRS_OK)
        fail_msg("%s", krs_renderer_message(stage->renderer));
    return picture;
}

static int set_up(void **state)
{
    static Stage stage;
    stage = (Stage){0};
    stage_open(&stage, scene_text, NULL);
    *state = &stage;
    return 0;
}

/* Every test that used the stage was watched. */
static int tear_down(void **state)
{
    Stage   *stage      = *state;
    uint64_t complaints = krs_renderer_complaints(stage->renderer);
    stage_close(stage);
    if (complaints != 0 || stage->complaints != 0)
        fprintf(stderr, "the validation layers complain: %s\n", stage->complaint);
    return complaints != 0 || stage->complaints != 0;
}

/* ---- The layers speak when something is wrong ---- */

static void copy_between(Gpu *gpu, const Buffer *from, const Buffer *to, bool with_barrier)
{
    double ms = 0;
    assert_true(gpu_begin(gpu));
    vkCmdFillBuffer(gpu->commands, from->buffer, 0, VK_WHOLE_SIZE, 7);
    if (with_barrier)
        gpu_barrier(gpu);
    vkCmdCopyBuffer(gpu->commands, from->buffer, to->buffer, 1,
                    &(VkBufferCopy){.size = from->size});
    assert_true(gpu_finish(gpu, &ms));
}

static void a_planted_hazard_is_reported(void **state)
{
    (void)state;
    static Gpu gpu;
    Stage      stage = {0};
    Buffer     from, to;
    assert_true(gpu_open(&gpu, &(KrsRendererOptions){.device     = tested_device(),
                                                     .validation = true,
                                                     .complaint  = note_complaint,
                                                     .user       = &stage}));
    assert_true(buffer_create(&gpu, &from, 1024, ON_DEVICE, "source"));
    assert_true(buffer_create(&gpu, &to, 1024, SHARED, "target"));

    copy_between(&gpu, &from, &to, true);
    assert_int_equal(stage.complaints, 0);
    assert_int_equal(((uint32_t *)to.bytes)[255], 7);

    copy_between(&gpu, &from, &to, false); /* reads what may not be written yet */
    assert_true(stage.complaints > 0);
    assert_non_null(strstr(stage.complaint, "SYNC-HAZARD-READ-AFTER-WRITE"));

    unsigned before = stage.complaints;
    assert_true(gpu_begin(&gpu)); /* a copy beyond the end of the buffer */
    vkCmdCopyBuffer(gpu.commands, from.buffer, to.buffer, 1,
                    &(VkBufferCopy){.srcOffset = 4096, .size = 4});
    assert_true(stage.complaints > before);
    assert_non_null(strstr(stage.complaint, "VUID-vkCmdCopyBuffer"));
    assert_int_equal(gpu.complaints, stage.complaints);

    buffer_destroy(&gpu, &from);
    buffer_destroy(&gpu, &to);
    gpu_close(&gpu);
    assert_int_equal(gpu.memory_used, 0);
}

/* ---- Devices ---- */

static void devices_are_listed(void **state)
{
    (void)state;
    KrsDevice devices[16];
    size_t    count, preferred = 0, none;
    assert_int_equal(krs_devices(devices, 16, &count), KRS_OK);
    assert_in_range(count, 1, 16);
    for (size_t i = 0; i < count; i++) {
        assert_true(devices[i].name[0] != '\0');
        preferred += devices[i].preferred;
        assert_true(devices[i].usable || !devices[i].preferred);
    }
    assert_int_equal(preferred, 1);
    assert_int_equal(krs_devices(NULL, 0, &none), KRS_OK);
    assert_int_equal(none, count);
}

static KrsStatus open_named(const char *name, KrsDevice *device, char *message)
{
    KrsRenderer *renderer;
    KrsStatus    status = krs_renderer_new(&(KrsRendererOptions){.device = name}, &renderer);
    if (status == KRS_OK)
        *device = krs_renderer_device(renderer);
    snprintf(message, 512, "%s", krs_renderer_message(renderer));
    krs_renderer_free(renderer);
    return status;
}

static void devices_are_chosen(void **state)
{
    (void)state;
    KrsDevice devices[16], device;
    size_t    count;
    bool      cpu = false;
    char      message[512], word[32];
    assert_int_equal(krs_devices(devices, 16, &count), KRS_OK);
    assert_in_range(count, 1, 16);
    for (size_t i = 0; i < count; i++) {
        if (!devices[i].usable)
            continue;
        cpu |= devices[i].kind == KRS_DEVICE_CPU;
        snprintf(word, sizeof word, "%zu", i);
        assert_int_equal(open_named(word, &device, message), KRS_OK);
        assert_string_equal(device.name, devices[i].name);
        assert_string_equal(message, "");
        /* a part of the name, in another case */
        for (size_t k = 0; k < sizeof word; k++)
            word[k] = (char)toupper((unsigned char)devices[i].name[k]);
        word[8] = '\0';
        assert_int_equal(open_named(word, &device, message), KRS_OK);
        assert_int_equal(strncasecmp(device.name, word, strlen(word)), 0);
    }
    assert_int_equal(open_named("cpu", &device, message), cpu ? KRS_OK : KRS_NO_DEVICE);
    assert_true(!cpu || device.kind == KRS_DEVICE_CPU);

    assert_int_equal(open_named("99", &device, message), KRS_NO_DEVICE);
    assert_int_equal(open_named("no such card", &device, message), KRS_NO_DEVICE);
    assert_non_null(strstr(message, "no such card"));
}

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

/* The ray through the centre of pixel (i, j), by interface.md and nothing else. */
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
    Stage *stage = *state;
    for (size_t camera = 0; camera < CAMERA_COUNT; camera++) {
        KrsView     view;
        size_t      hits    = 0;
        KrsPicture *picture = render(stage, (KrsRenderOptions){.camera = camera});
        assert_int_equal(krs_frame_view(stage->frame, camera, &view), KRS_OK);
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
    Stage  *stage = *state;
    double  size  = 0.5;
    KrsView view;
    assert_int_equal(krs_frame_set(stage->frame, "size", &size, 1), KRS_OK);
    KrsPicture *picture = render(stage, (KrsRenderOptions){.camera = FLAT});
    assert_int_equal(krs_frame_view(stage->frame, FLAT, &view), KRS_OK);
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
    Stage *stage = *state;
    for (size_t camera = FIRST; camera <= FLAT; camera++) {
        KrsPicture *picture = render(stage, (KrsRenderOptions){.camera = camera});
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
    Stage           *stage = *state;
    double           share = 0, pixel = 3.0 / HEIGHT;
    KrsRenderOptions options = {.camera = FLAT, .error = 0.01, .no_filter = true};
    KrsPicture      *one     = render(stage, options);
    options.samples          = 32;
    KrsPicture *many         = render(stage, options);
    options.seed             = 5;
    KrsPicture *other        = render(stage, options);
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
    Stage                 *stage = *state;
    static float           points[COUNT][3], distances[COUNT];
    static KrsSurfacePoint surfaces[COUNT];
    for (int i = 0; i < COUNT; i++)
        for (int k = 0; k < 3; k++)
            points[i][k] = (float)sin(i * (k + 1.7)) * 3;
    KrsStatus status = krs_sample(stage->rendering, stage->frame, (const float(*)[3])points, COUNT,
                                  distances, surfaces);
    assert_int_equal(status, KRS_OK);
    for (int i = 0; i < COUNT; i++) {
        double offset[3];
        for (int k = 0; k < 3; k++)
            offset[k] = points[i][k] - CENTRE[k];
        assert_near(distances[i], sqrt(dot3(offset, offset)) - 1, 2e-6);
        assert_near(surfaces[i].distance, distances[i], 2e-6);
        assert_int_equal(surfaces[i].component, 1);
    }
    assert_int_equal(krs_sample(stage->rendering, stage->frame, NULL, 0, NULL, NULL), KRS_OK);
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
    Stage stage = {0};
    stage_open(&stage, landscape_text, NULL);
    KrsPicture *whole  = render(&stage, (KrsRenderOptions){.slice_ms = 1e6, .steps_at_once = 8192});
    KrsPicture *sliced = render(&stage, (KrsRenderOptions){.slice_ms = 0.001, .steps_at_once = 3});
    assert_true(whole->stats.most_evaluations_per_ray > 30);
    assert_same_pictures(whole, sliced, (size_t)WIDTH * HEIGHT);
    assert_int_equal(whole->stats.evaluations, sliced->stats.evaluations);
    for (size_t i = 0; i < (size_t)4 * WIDTH * HEIGHT; i++)
        assert_true(isfinite(whole->color[i]) && whole->color[i] >= 0);
    krs_picture_free(whole);
    krs_picture_free(sliced);
    assert_int_equal(krs_renderer_complaints(stage.renderer), 0);
    stage_close(&stage);
}

/* Beams begin rays later, and that is all: what the rays see stays to a small part of a pixel,
   but for outlines, and costs less. */
static void beams_are_not_seen(void **state)
{
    (void)state;
    Stage stage = {0};
    stage_open(&stage, terrace_text, NULL);
    KrsPicture *behind = render(&stage, (KrsRenderOptions){.samples = 1});
    KrsPicture *alone  = render(&stage, (KrsRenderOptions){.samples = 1, .no_beams = true});
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
    stage_close(&stage);
}

/* A zone far away changes nothing but that planes may have holes, and so are marched. */
static void marched_planes_look_the_same(void **state)
{
    (void)state;
    static const double far_away[1][4] = {{0, -1e5, 0, 1}};
    Stage               stage          = {0};
    stage_open(&stage,
               "camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 40deg }\n"
               "camera below { eye: [3, -2, 5], target: [0, 0.5, 0] }\n"
               "show sphere(1).move([0, 0.4, 0]);\n"
               "show plane([0.1, 1, 0], 0);\n"
               "show plane([0.5, 0.2, 1], -3).rotate([0, 1, 0], 20deg).paint(#4050c0);\n",
               NULL);
    for (uint32_t camera = 0; camera < 2; camera++) {
        KrsPicture *known = render(&stage, (KrsRenderOptions){.samples = 1, .camera = camera});
        assert_int_equal(krs_frame_set_zones(stage.frame, far_away, 1), KRS_OK);
        KrsPicture *marched = render(&stage, (KrsRenderOptions){.samples = 1, .camera = camera});
        assert_int_equal(krs_frame_set_zones(stage.frame, NULL, 0), KRS_OK);
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
    assert_int_equal(krs_renderer_complaints(stage.renderer), 0);
    stage_close(&stage);
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
    Stage stage = {0};
    stage_open(&stage, row, NULL);
    KrsPicture *near = render(&stage, (KrsRenderOptions){.samples = 1});
    double      off  = 400000;
    assert_int_equal(krs_frame_set(stage.frame, "off", &off, 1), KRS_OK);
    KrsPicture *far   = render(&stage, (KrsRenderOptions){.samples = 1});
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
    assert_int_equal(krs_renderer_complaints(stage.renderer), 0);
    stage_close(&stage);
}

static void crops_are_parts(void **state)
{
    Stage          *stage = *state;
    const KrsWindow crop  = {33, 17, 41, 30};
    KrsPicture     *whole = render(stage, (KrsRenderOptions){.samples = 2});
    KrsPicture     *part  = render(stage, (KrsRenderOptions){.samples = 2, .crop = crop});
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
    Stage           *stage   = *state;
    KrsRenderOptions options = {.width = 1000, .height = 600};
    KrsPicture      *whole   = render(stage, options);
    options.crop             = (KrsWindow){0, 300, 1000, 1};
    KrsPicture *part         = render(stage, options);
    assert_memory_equal(part->color, &whole->color[4 * 1000 * 300], 4 * 1000 * sizeof(float));
    assert_int_equal(whole->stats.rays, 600000);
    krs_picture_free(whole);
    krs_picture_free(part);
}

/* ---- Ends before the end ---- */

static bool stop_later(void *user, double done)
{
    int *left = user;
    assert_true(done >= 0 && done <= 1 + 1e-9);
    return --*left > 0;
}

static void interruption_is_heard(void **state)
{
    Stage      *stage = *state;
    KrsPicture *picture;
    for (int calls = 1; calls < 6; calls++) {
        int              left    = calls;
        KrsRenderOptions options = {
            .width = WIDTH, .height = HEIGHT, .progress = stop_later, .user = &left};
        assert_int_equal(krs_render(stage->rendering, stage->frame, &options, &picture),
                         KRS_INTERRUPTED);
        assert_null(picture);
        assert_int_equal(left, 0);
    }
    krs_picture_free(render(stage, (KrsRenderOptions){0})); /* and nothing is broken */
}

static bool never_back(void *user, double done)
{
    double *before = user;
    assert_true(done >= *before - 1e-12);
    *before = done;
    return true;
}

static void progress_goes_forwards(void **state)
{
    (void)state;
    Stage  stage = {0};
    double done  = 0;
    stage_open(&stage, landscape_text, NULL);
    krs_picture_free(render(
        &stage, (KrsRenderOptions){
                    .steps_at_once = 10, .samples = 3, .progress = never_back, .user = &done}));
    assert_near(done, 1, 1e-9);
    stage_close(&stage);
}

static void exhausted_rays_are_counted(void **state)
{
    Stage      *stage    = *state;
    KrsPicture *picture  = render(stage, (KrsRenderOptions){.most_steps = 3});
    size_t      creeping = 0;
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        assert_true(picture->steps[i] <= 3 + 3); /* a ray that is there may finish */
        creeping += picture->steps[i] >= 3;
    }
    assert_in_range(picture->stats.unresolved, 1, creeping);
    krs_picture_free(picture);
}

static void wrong_use_is_refused(void **state)
{
    Stage                 *stage   = *state;
    const KrsRenderOptions wrong[] = {
        {.width = 16385, .height = 10},
        {.width = 10, .height = 10, .crop = {0, 0, 11, 10}},
        {.width = 10, .height = 10, .crop = {5, 10, 1, 1}},
        {.width = 10, .height = 10, .crop = {0xffffffff, 0, 2, 1}},
        {.samples = 65537},
        {.camera = 99},
        {.error = -1},
        {.error = NAN},
        {.slice_ms = -1},
        {.steps_at_once = 8193},
        {.trace = KRS_TRACE_COUNT},
        {.schedule = KRS_SCHEDULE_COUNT},
        {.shadows = KRS_SHADOWS_COUNT},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        KrsPicture *picture;
        assert_int_equal(krs_render(stage->rendering, stage->frame, &wrong[i], &picture),
                         KRS_BAD_ARGUMENT);
        assert_null(picture);
        assert_true(strlen(krs_renderer_message(stage->renderer)) > 10);
    }
}

static void only_wanted_planes_are_held(void **state)
{
    Stage           *stage   = *state;
    KrsRenderOptions options = {.planes = KRS_PLANE_DEPTH | KRS_PLANE_IDS};
    KrsPicture      *picture = render(stage, options);
    assert_non_null(picture->depth);
    assert_non_null(picture->instance);
    assert_null(picture->color);
    assert_null(picture->normal);
    assert_null(picture->steps);
    krs_picture_free(picture);
}

/* What is not asked for is not made, and what is comes out the same. */
static void planes_do_not_hang_on_others(void **state)
{
    Stage           *stage   = *state;
    const size_t     pixels  = (size_t)WIDTH * HEIGHT;
    KrsRenderOptions options = {.samples = 3};
    KrsPicture      *whole   = render(stage, options);
    for (int bit = 0; KRS_PLANE_ALL >> bit; bit++) {
        /* What this leaves in memory is not to be taken for what has not been made. */
        krs_picture_free(render(stage, (KrsRenderOptions){.camera = ROUND}));
        options.planes   = 1u << bit;
        KrsPicture *part = render(stage, options);
        const struct {
            const void *part, *whole;
            size_t      numbers;
        } planes[] = {
#define KRS_PLANE(id, bit, aov, about, arrays) arrays
#define KRS_ARRAY(plane, member, type, numbers, row, first, sample, ...) \
    {part->member, whole->member, numbers},
#include "runtime/planes.def"
#undef KRS_ARRAY
#undef KRS_PLANE
        };
        size_t held = 0;
        for (size_t i = 0; i < sizeof planes / sizeof *planes; i++) {
            held += planes[i].part != NULL;
            if (planes[i].part)
                assert_memory_equal(planes[i].part, planes[i].whole,
                                    pixels * planes[i].numbers * 4);
        }
        assert_true(held > 0);
        assert_int_equal(part->stats.evaluations, whole->stats.evaluations);
        krs_picture_free(part);
    }
    krs_picture_free(whole);
}

/* The steps of the first rays are among what the statistics count. */
static void evaluations_are_counted(void **state)
{
    KrsPicture *picture = render(*state, (KrsRenderOptions){.no_beams = true});
    uint64_t    sum     = 0;
    uint32_t    most    = 0;
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        sum += picture->steps[i];
        most = picture->steps[i] > most ? picture->steps[i] : most;
    }
    assert_int_equal(picture->stats.evaluations, sum);
    assert_int_equal(picture->stats.most_evaluations_per_ray, most);
    krs_picture_free(picture);
}

/* A ball over a floor: without occlusion no pixel is darker, and some below it are lighter. */
static void occlusion_can_be_left_out(void **state)
{
    (void)state;
    Stage stage = {0};
    stage_open(&stage, landscape_text, NULL);
    KrsPicture *with    = render(&stage, (KrsRenderOptions){0});
    KrsPicture *without = render(&stage, (KrsRenderOptions){.no_occlusion = true});
    size_t      lighter = 0;
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        assert_true(without->color[4 * i] >= with->color[4 * i] - 1e-5f);
        lighter += without->color[4 * i] > 1.1f * with->color[4 * i];
    }
    assert_true(lighter > 50);
    assert_true(without->stats.phase_ms[KRS_PHASE_OCCLUSION] == 0);
    krs_picture_free(with);
    krs_picture_free(without);
    stage_close(&stage);
}

/* A light that casts no shadows is the same where the shadowing one is not in the way: on a ball
   alone, which is convex. */
static void shadows_that_are_not_cast_are_not_missed(void **state)
{
    static const char form[] = "camera { eye: [3, 2, 5], fov: 30deg }\n"
                               "light sun { direction: [-1, 2, 1], softness: 0deg, shadow: %s }\n"
                               "show sphere(1);\n";
    (void)state;
    KrsPicture *pictures[2];
    Stage       stages[2] = {0};
    for (int i = 0; i < 2; i++) {
        char text[256];
        snprintf(text, sizeof text, form, i ? "true" : "false");
        stage_open(&stages[i], text, NULL);
        pictures[i] = render(&stages[i], (KrsRenderOptions){0});
    }
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT * 4; i++)
        assert_near(pictures[0]->color[i], pictures[1]->color[i], 0.01);
    assert_true(pictures[0]->stats.phase_ms[KRS_PHASE_SHADOWS] == 0);
    for (int i = 0; i < 2; i++) {
        krs_picture_free(pictures[i]);
        stage_close(&stages[i]);
    }
}

/* The sky is the sum of what each light adds to it, for the first sample as for others; a light
   without a size, or with a place, adds nothing. */
static void every_sun_is_in_the_sky(void **state)
{
    static const char text[] =
        "param one = 0 in [0, 9]; param two = 0 in [0, 9]; param three = 0 in [0, 9];\n"
        "camera { eye: [3, 2, 5], target: [0, 2.5, 0], fov: 70deg }\n"
        "light point { position: [0, 3, 0], intensity: 5 }\n"
        "light a { direction: [-3, 0.9, -5], intensity: one, softness: 6deg }\n"
        "light sharp { direction: [-1, 2, -5], intensity: 5, softness: 0deg }\n"
        "light b { direction: [-5, 2, -5], intensity: two, softness: 4deg }\n"
        "light c { direction: [-4, 2, -8], intensity: three, softness: 5deg }\n"
        "show sphere(1);\n";
    static const char *const names[] = {"one", "two", "three"};
    enum { NONE, ALL = 4, PICTURES };
    (void)state;
    Stage       stage = {0};
    KrsPicture *pictures[PICTURES];
    stage_open(&stage, text, NULL);
    for (int i = 0; i < PICTURES; i++) {
        for (int sun = 0; sun < 3; sun++) {
            double intensity = i == ALL || i == sun + 1 ? 2 + sun : 0;
            assert_int_equal(krs_frame_set(stage.frame, names[sun], &intensity, 1), KRS_OK);
        }
        pictures[i] = render(&stage, (KrsRenderOptions){.samples = 2, .no_occlusion = true});
    }
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT * 4; i++) {
        double sum = -2 * (double)pictures[NONE]->color[i];
        for (int sun = 1; sun <= 3; sun++)
            sum += pictures[sun]->color[i];
        if (pictures[NONE]->color[i / 4 * 4 + 3] == 0)
            assert_near(pictures[ALL]->color[i], sum, 1e-5 * (1 + fabs(sum)));
    }
    for (int i = 1; i <= 3; i++) {
        double brightest = 0;
        for (size_t k = 0; k < (size_t)WIDTH * HEIGHT; k++)
            brightest = fmax(brightest, pictures[i]->color[4 * k] - pictures[NONE]->color[4 * k]);
        assert_near(brightest, 2.15 * (1 + i), 0.1 * (1 + i)); /* disc and glow: 2, and 0.15 */
    }
    for (int i = 0; i < PICTURES; i++)
        krs_picture_free(pictures[i]);
    stage_close(&stage);
}

/* ---- Memory ---- */

static KrsStatus render_with(Scarce *scarce, Stage *stage)
{
    KrsRenderer       *renderer;
    KrsRendering      *rendering = NULL;
    KrsPicture        *picture   = NULL;
    KrsRenderOptions   small     = {.width = 16, .height = 16};
    KrsRendererOptions options = {.device = tested_device(), .allocator = scarce_allocator(scarce)};
    KrsStatus          status  = krs_renderer_new(&options, &renderer);
    if (status == KRS_OK)
        status = krs_rendering_new(renderer, stage->scene, &rendering);
    if (status == KRS_OK)
        status = krs_render(rendering, stage->frame, &small, &picture);
    if (status != KRS_OK)
        assert_non_null(strstr(krs_renderer_message(renderer), "memory"));
    krs_picture_free(picture);
    krs_rendering_free(rendering);
    krs_renderer_free(renderer);
    assert_int_equal(scarce->held, 0);
    return status;
}

static void memory_that_runs_out_is_reported(void **state)
{
    Stage    *stage       = *state;
    int       allocations = 0;
    KrsStatus status;
    do {
        Scarce scarce = {.failing = ++allocations, .lasting = true};
        status        = render_with(&scarce, stage);
        assert_true(status == KRS_OK || status == KRS_OUT_OF_MEMORY);
    } while (status != KRS_OK && allocations < 100);
    assert_int_equal(status, KRS_OK);
    assert_true(allocations > 8);
}

/* A material that divides by 0 somewhere, or takes the root of what is negative, gives numbers all
   the same: what is none is 0, what is too much the most that there is. */
static void materials_give_numbers(void **state)
{
    static const char *const materials[] = {
        "color: [1 / (k * x), (k * x) / (k * y), sqrt(-1 - x * x)], roughness: (k * z) / (k * x)",
        "color: log(x), metallic: sqrt(-1 - y * y), emission: 1 / (k * x)",
        "color: red, emission: [x / k, sqrt(x), exp(1000 * y)]",
        "color: [1e30, -1e30, 0.5] * x / k, roughness: 1 / max(k, 0), emission: 1e38",
    };
    (void)state;
    for (size_t m = 0; m < sizeof materials / sizeof *materials; m++) {
        Stage stage = {0};
        char  text[400];
        snprintf(text, sizeof text, "param k = 0; material m { %s } show sphere(1).paint(m);",
                 materials[m]);
        stage_open(&stage, text, NULL);
        KrsPicture *picture = render(&stage, (KrsRenderOptions){.samples = 5});
        size_t      wrong = 0, pixels = (size_t)WIDTH * HEIGHT;
        for (size_t i = 0; i < 4 * pixels; i++)
            wrong += !(picture->color[i] >= 0 && picture->color[i] < 1e38f);
        for (size_t i = 0; i < 3 * pixels; i++)
            wrong += !(picture->albedo[i] >= 0 && picture->albedo[i] <= 1) +
                     !(fabsf(picture->normal[i]) <= 1.001f);
        if (wrong > 0)
            print_message("%zu wrong: %s\n", wrong, materials[m]);
        assert_int_equal(wrong, 0);
        krs_picture_free(picture);
        double places[3][3] = {{1, 0, 0}, {-0.6, 0.8, 0}, {0, 0, 1}};
        KrsHit hits[3];
        assert_int_equal(krs_probe(stage.frame, (const double(*)[3])places, 3, hits), KRS_OK);
        for (int i = 0; i < 9; i++)
            assert_true(hits[i / 3].color[i % 3] >= 0 && hits[i / 3].color[i % 3] <= 1 &&
                        hits[i / 3].roughness >= 0 && hits[i / 3].roughness <= 1);
        stage_close(&stage);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_planted_hazard_is_reported),
        cmocka_unit_test(devices_are_listed),
        cmocka_unit_test(devices_are_chosen),
        cmocka_unit_test_setup_teardown(sphere_is_where_it_should_be, set_up, tear_down),
        cmocka_unit_test_setup_teardown(parameters_need_no_compiling, set_up, tear_down),
        cmocka_unit_test_setup_teardown(matrices_lead_back_to_the_pixel, set_up, tear_down),
        cmocka_unit_test_setup_teardown(samples_converge_on_the_area, set_up, tear_down),
        cmocka_unit_test_setup_teardown(points_are_sampled, set_up, tear_down),
        cmocka_unit_test(slices_are_not_seen),
        cmocka_unit_test(beams_are_not_seen),
        cmocka_unit_test(marched_planes_look_the_same),
        cmocka_unit_test(far_cells_look_like_near_ones),
        cmocka_unit_test_setup_teardown(crops_are_parts, set_up, tear_down),
        cmocka_unit_test_setup_teardown(bands_are_not_seen, set_up, tear_down),
        cmocka_unit_test_setup_teardown(interruption_is_heard, set_up, tear_down),
        cmocka_unit_test(progress_goes_forwards),
        cmocka_unit_test(materials_give_numbers),
        cmocka_unit_test_setup_teardown(exhausted_rays_are_counted, set_up, tear_down),
        cmocka_unit_test_setup_teardown(wrong_use_is_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(only_wanted_planes_are_held, set_up, tear_down),
        cmocka_unit_test_setup_teardown(planes_do_not_hang_on_others, set_up, tear_down),
        cmocka_unit_test_setup_teardown(evaluations_are_counted, set_up, tear_down),
        cmocka_unit_test(occlusion_can_be_left_out),
        cmocka_unit_test(shadows_that_are_not_cast_are_not_missed),
        cmocka_unit_test(every_sun_is_in_the_sky),
        cmocka_unit_test_setup_teardown(memory_that_runs_out_is_reported, set_up, tear_down),
    };
    spirv_start(); /* held for all, so that no renderer starts the shader compiler anew */
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    spirv_stop();
    return failed;
}
