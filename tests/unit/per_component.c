/*
 * per_component.c: heavy components marched one by one, in shaders of their own or packed in one,
 * and levels that are left out for being far away, are not seen.
 *
 * Pictures of compounds marched apart or packed must be those of the union: no more than one pixel
 * in 2,000 hits where the other misses, depths differ by the permitted error and what a grazing ray
 * makes of it, each pixel shows the same component, level and instance, and normals are apart in
 * seams between components alone.  So must pictures with early-outs.  Crops, bands and schedules
 * change no bit.  A scene is only taken apart where the compiler says that it pays, and not when
 * the camera is inside of a solid.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "krs/vulkan.h"
#include "tests/support/device.h"

enum { WIDTH = 160, HEIGHT = 100, PIXELS = WIDTH * HEIGHT };

#define TREES                                                                                \
    "def tree(seed) = krs { kernel capsule([0, 0, 0], [0, 0.3, 0], 0.04).move([0, 0.4, 0]);" \
    "    for i in 0..6 { reflect plane(random_direction(seed + i), 0.12 * i + 0.05);"        \
    "        kernel capsule([0, 0, 0], [0.1 * i, 0.3, 0], 0.05 + 0.01 * i); } };"            \
    "let bushes = [tree(1), tree(20), tree(40), tree(60)];"
#define SHOWN(places)                                         \
    "def at(i) = " places ";"                                 \
    "show bushes[0].move(at(0)); show bushes[1].move(at(1));" \
    "show bushes[2].move(at(2)); show bushes[3].move(at(3));"

typedef struct Scene {
    const char   *name, *text;
    KrsScene     *scene;
    KrsState     *state;
    KrsRendering *plain, *early; /* of renderers without and with early-outs */
} Scene;

enum { SCATTERED, MIXED, GROUND, ORTHOGRAPHIC, PANORAMA, INSIDE, ZONED, SCENES };
static Scene scenes[SCENES] = {
    [SCATTERED] = {.name = "scattered",
                   .text = TREES SHOWN(
                       "[3 * i - 4.5, 0, 0.7 * i]") "camera { eye: [0, 2, 16], target: [0, 0.3, "
                                                    "0], fov: 0.6 }"},
    [MIXED] =
        {.name = "within each other",
         .text = TREES SHOWN(
             "[0.2 * i, 0.1 * i, 0.1]") "camera { eye: [1, 2, 8], target: [0, 0.3, 0], fov: 0.5 }"},
    [GROUND]       = {.name = "on a plane",
                      .text = TREES SHOWN("[3 * i - 4.5, 0, 1.5 * i]") "show plane([0, 1, 0], -1); show "
                                                                             "sphere(0.4).move([0, 0, 3]);"
                                                                             "camera { eye: [3, 3, 14], "
                                                                             "target: [0, 0, 0], fov: 0.6 }"},
    [ORTHOGRAPHIC] = {.name = "orthographic",
                      .text = TREES SHOWN(
                          "[2 * i - 3, 0, 2 * i]") "camera { projection: \"orthographic\", eye: "
                                                   "[2, 3, 20], target: [0, 0, 2],"
                                                   "         height: 6 }"},
    [PANORAMA] =
        {.name = "all around",
         .text = TREES SHOWN(
             "[1.5 * cos(2 * i), 0, 1.5 * sin(2 * i)]") "camera { projection: \"panorama\", eye: "
                                                        "[0, 0.2, 0], target: [1, 0.2, 0] }"},
    [INSIDE] =
        {.name = "from inside of a solid",
         .text = TREES SHOWN(
             "[3 * i - 4.5, 0, 0]") "show sphere(30) - sphere(0.9);"
                                    "camera { eye: [2, 0.2, 0], target: [0, 0, 0], fov: 1 }"},
    [ZONED] = {.name = "with a zone",
               .text = TREES SHOWN("[3 * i - 4.5, 0, 0.7 * i]") "camera { eye: [0, 2, 16], target: "
                                                                "[0, 0.3, 0], fov: 0.6 }"},
};

static KrsRenderer *plain, *early;

static void print_diagnostic(void *user, const KrsDiagnostic *diagnostic)
{
    (void)user;
    fprintf(stderr, "%s\n", diagnostic->text);
}

static void print_validation_message(void *user, const char *message)
{
    (void)user;
    fprintf(stderr, "the validation layers complain: %s\n", message);
}

static int open_scenes(void **context)
{
    (void)context;
    KrsRendererOptions options = {.device             = tested_device(),
                                  .validation         = true,
                                  .validation_message = print_validation_message};
    KrsOptions         with    = {.diagnostic = print_diagnostic};
    KrsStatus          status  = krs_renderer_new(&options, &plain);
    options.early_outs         = KRS_EARLY_OUTS_ON;
    if (status == KRS_OK)
        status = krs_renderer_new(&options, &early);
    for (int i = 0; i < SCENES && status == KRS_OK; i++) {
        Scene       *s       = &scenes[i];
        const double zone[4] = {-4.5, 0, 0, 0.8};
        status = krs_compile_text(s->text, strlen(s->text), s->name, &with, &s->scene);
        if (status == KRS_OK)
            status = krs_state_new(s->scene, &s->state);
        if (status == KRS_OK && i == ZONED)
            status = krs_state_set_zones(s->state, &zone, 1);
        if (status == KRS_OK)
            status = krs_rendering_new(plain, s->scene, KRS_FOR_PICTURES, &s->plain);
        if (status == KRS_OK)
            status = krs_rendering_new(early, s->scene, KRS_FOR_PICTURES, &s->early);
    }
    return status != KRS_OK;
}

static int close_scenes(void **context)
{
    (void)context;
    for (int i = 0; i < SCENES; i++) {
        krs_rendering_free(scenes[i].plain);
        krs_rendering_free(scenes[i].early);
        krs_state_free(scenes[i].state);
        krs_scene_free(scenes[i].scene);
    }
    uint64_t validation_messages = krs_renderer_validation_messages(plain) +
                                   krs_renderer_validation_messages(early);
    krs_renderer_free(plain);
    krs_renderer_free(early);
    return validation_messages > 0;
}

static KrsPicture *render(const Scene *scene, bool with_early_outs, KrsRenderOptions options)
{
    KrsPicture *picture;
    if (options.width == 0) {
        options.width  = WIDTH;
        options.height = HEIGHT;
    }
    KrsRendering *rendering = with_early_outs ? scene->early : scene->plain;
    KrsStatus     status    = krs_render(rendering, scene->state, &options, &picture);
    if (status != KRS_OK)
        fail_msg("%s: %s", scene->name, krs_renderer_message(with_early_outs ? early : plain));
    return picture;
}

/* How two pictures differ. */
typedef struct Difference {
    int    hits;   /* of one of the two alone */
    int    depths; /* farther apart than a surface seen at a small angle explains */
    int    components;
    int    places;  /* of level and instance, where the components are the same */
    int    normals; /* farther apart than 0.2 */
    int    seen;    /* in both */
    double mean;    /* of the depths, in pixels' widths, where both hit */
} Difference;

static Difference compare(const KrsPicture *a, const KrsPicture *b, double pixel)
{
    Difference d = {0};
    for (int i = 0; i < PIXELS; i++) {
        bool here = isfinite(a->depth[i]), there = isfinite(b->depth[i]);
        d.hits += here != there;
        if (!here || !there)
            continue;
        double apart = fabs((double)a->depth[i] - (double)b->depth[i]) / (pixel * a->depth[i]);
        d.seen++;
        d.mean += apart;
        d.depths += apart > 4;
        d.components += a->component[i] != b->component[i];
        d.places += a->component[i] == b->component[i] &&
                    (a->level[i] != b->level[i] || a->instance[i] != b->instance[i]);
        double turned = 0;
        for (int k = 0; k < 3; k++) {
            double more = (double)a->normal[3 * i + k] - (double)b->normal[3 * i + k];
            turned += more * more;
        }
        d.normals += turned > 0.04;
    }
    d.mean /= d.seen > 0 ? d.seen : 1;
    return d;
}

static void check_same(const Scene *scene, const KrsPicture *a, const KrsPicture *b)
{
    Difference d = compare(a, b, 0.6 / HEIGHT);
    print_message("# %s: of %d: %d hits, %d depths, %d components, %d places, %d normals differ; "
                  "depths by %.4f pixels\n",
                  scene->name, d.seen, d.hits, d.depths, d.components, d.places, d.normals, d.mean);
    assert_true(d.seen > PIXELS / 50);
    assert_true(d.hits <= PIXELS / 2000);
    assert_true(d.depths <= PIXELS / 2000);
    assert_true(d.components <= PIXELS / 2000);
    assert_true(d.places <= PIXELS / 2000);
    assert_true(d.normals <= PIXELS / 500);
    assert_true(d.mean < 0.25);
    assert_int_equal(a->stats.unresolved, 0);
    assert_int_equal(b->stats.unresolved, 0);
}

static const KrsRenderOptions together = {.methods.components = KRS_COMPONENTS_TOGETHER};
static const KrsRenderOptions by_turns = {.methods.components = KRS_COMPONENTS_APART};
static const KrsRenderOptions packed   = {.methods.components = KRS_COMPONENTS_PACKED};

static void parts_make_the_union(void **context)
{
    const Scene *scene = *context;
    KrsPicture  *whole = render(scene, false, together);
    KrsPicture  *apart = render(scene, false, by_turns);
    KrsPicture  *turns = render(scene, false, packed);
    check_same(scene, whole, apart);
    check_same(scene, whole, turns);
    /* Otherwise there was nothing to compare. */
    bool parted = memcmp(whole->steps, apart->steps, PIXELS * sizeof *apart->steps) != 0;
    assert_int_equal(parted, scene != &scenes[INSIDE]);
    parted = memcmp(whole->steps, turns->steps, PIXELS * sizeof *turns->steps) != 0;
    assert_int_equal(parted, scene != &scenes[INSIDE]);
    krs_picture_free(whole);
    krs_picture_free(apart);
    krs_picture_free(turns);
}

static void early_outs_are_not_seen(void **context)
{
    const Scene *scene = *context;
    KrsPicture  *all   = render(scene, false, together);
    KrsPicture  *few   = render(scene, true, (KrsRenderOptions){0});
    check_same(scene, all, few);
    /* Inside of a solid that is larger than all else nothing else counts anyway. */
    bool left_out = memcmp(all->steps, few->steps, PIXELS * sizeof *few->steps) != 0;
    assert_int_equal(left_out, scene != &scenes[INSIDE]);
    krs_picture_free(all);
    krs_picture_free(few);
}

/* All planes, bit by bit, of a part of the picture. */
static void check_equal(const KrsPicture *whole, const KrsPicture *part)
{
    const KrsWindow *w = &part->window;
    for (uint32_t y = 0; y < w->height; y++)
        for (uint32_t x = 0; x < w->width; x++) {
            size_t i = (size_t)(w->y + y) * whole->width + w->x + x, k = (size_t)y * w->width + x;
            assert_memory_equal(&whole->depth[i], &part->depth[k], sizeof(float));
            assert_memory_equal(&whole->color[4 * i], &part->color[4 * k], 4 * sizeof(float));
            assert_memory_equal(&whole->normal[3 * i], &part->normal[3 * k], 3 * sizeof(float));
            assert_int_equal(whole->component[i], part->component[k]);
            assert_int_equal(whole->steps[i], part->steps[k]);
        }
}

static void crops_and_schedules_change_nothing(void **context)
{
    (void)context;
    const Scene     *scene = &scenes[GROUND];
    KrsRenderOptions apart = {.methods.components = KRS_COMPONENTS_APART};
    KrsPicture      *whole = render(scene, false, apart);
    apart.crop             = (KrsWindow){37, 21, 60, 50};
    KrsPicture *part       = render(scene, false, apart);
    check_equal(whole, part);
    krs_picture_free(part);
    for (int schedule = KRS_SCHEDULE_PIXEL; schedule < KRS_SCHEDULE_COUNT; schedule++) {
        apart.methods.schedule = (KrsSchedule)schedule;
        part                   = render(scene, false, apart);
        check_equal(whole, part);
        krs_picture_free(part);
    }
    krs_picture_free(whole);
}

/* ---- packed, of any number ---- */

/* Solids of several kinds on a spiral around the y axis, each into the next: cut ones, and
   sequences of levels and instances. */
static void write_spiral(Text *text, int count, double far, const char *more)
{
    static const char sequence[] =
        "krs { kernel sphere(0.2).move([0.3, 0, 0]); reflect plane([1, 0, 0.3], 0.1);"
        " kernel box([0.3, 0.5, 0.3]); reflect plane([0, 1, 0], 0.15); }";
    static const char *const kinds[3] = {"(box([1, 0.8, 0.9]) - sphere(0.52))",
                                         "(sphere(0.5) & box([0.7, 2, 0.7]))", sequence};
    for (int i = 0; i < count; i++)
        text_format(text, "show %s.rotate([1, 2, 3], %ddeg).move([%g, %g, %g]);\n", kinds[i % 3],
                    57 * i, far + 1.6 * sin(0.7 * i), 0.12 * i - 1, 1.6 * cos(0.7 * i));
    text_format(text, "%s camera { eye: [%.1f, 2, 8], target: [%.1f, %g, 0], fov: 0.5 }\n", more,
                far + 1, far, 0.06 * count - 1);
}

static void spiral_is_the_union(int count, double far, const char *more, const char *name)
{
    Memory memory = {0};
    Arena  arena  = {.memory = &memory};
    Text   text   = {.arena = &arena};
    Scene  scene  = {.name = name};
    write_spiral(&text, count, far, more);
    KrsOptions with = {.diagnostic = print_diagnostic};
    assert_int_equal(krs_compile_text(text.bytes, text.length, name, &with, &scene.scene), KRS_OK);
    assert_int_equal(krs_state_new(scene.scene, &scene.state), KRS_OK);
    assert_int_equal(krs_rendering_new(plain, scene.scene, KRS_FOR_PICTURES, &scene.plain), KRS_OK);
    assert_int_equal(krs_scene_program(scene.scene)->camera_relative, far > 0);
    KrsPicture *whole = render(&scene, false, together), *turns = render(&scene, false, packed);
    check_same(&scene, whole, turns);
    bool parted = memcmp(whole->steps, turns->steps, PIXELS * sizeof *turns->steps) != 0;
    assert_int_equal(parted, count > 1);
    krs_picture_free(whole);
    krs_picture_free(turns);
    krs_rendering_free(scene.plain);
    krs_state_free(scene.state);
    krs_scene_free(scene.scene);
    arena_free(&arena);
}

static void any_number_is_packed(void **context)
{
    (void)context;
    static const int counts[] = {1, 8, 9, 65};
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        char name[32];
        snprintf(name, sizeof name, "a spiral of %d", counts[i]);
        spiral_is_the_union(counts[i], 0, "", name);
    }
}

static void zones_are_packed(void **context)
{
    (void)context;
    spiral_is_the_union(9, 0,
                        "show plane([0, 1, 0], -1);"
                        "zone { center: [0.5, 0, 1.5], radius: 0.9 }",
                        "a spiral in a zone");
}

static void far_away_is_packed(void **context)
{
    (void)context;
    spiral_is_the_union(9, 1e5, "", "a spiral far from the origin");
}

static void packed_in_every_way(void **context)
{
    (void)context;
    const Scene *scene = &scenes[MIXED];
    KrsPicture  *whole = render(scene, false, packed);
    for (int schedule = KRS_SCHEDULE_PIXEL; schedule < KRS_SCHEDULE_COUNT; schedule++) {
        KrsRenderOptions options = packed;
        options.methods.schedule = (KrsSchedule)schedule;
        options.crop             = (KrsWindow){41, 21, 70, 50};
        KrsPicture *part         = render(scene, false, options);
        check_equal(whole, part);
        krs_picture_free(part);
    }
    for (int trace = KRS_TRACE_PLAIN; trace <= KRS_TRACE_RELAXED; trace++) {
        KrsRenderOptions options = packed;
        options.methods.trace    = (KrsTrace)trace;
        options.methods.no_beams = true;
        KrsPicture *other        = render(scene, false, options);
        check_same(scene, whole, other);
        krs_picture_free(other);
    }
    KrsPicture *early_outs = render(scene, true, packed);
    check_same(scene, whole, early_outs);
    krs_picture_free(early_outs);
    krs_picture_free(whole);
}

/* What is cheap is not worth shaders of its own. */
static void only_what_is_heavy_is_apart(void **context)
{
    (void)context;
    static const char cheap[] = "show sphere(1); show box([1, 1, 1]).move([3, 0, 0]);"
                                "show torus(1, 0.2).move([0, 0, 3]);";
    KrsScene         *scene;
    assert_int_equal(krs_compile_text(cheap, strlen(cheap), "cheap", NULL, &scene), KRS_OK);
    assert_int_equal(krs_scene_program(scene)->march_group_count, 0);
    assert_int_equal(krs_scene_program(scene)->expensive, 0);
    krs_scene_free(scene);
    assert_int_equal(krs_scene_program(scenes[SCATTERED].scene)->march_group_count, 4);
    assert_int_equal(krs_scene_program(scenes[SCATTERED].scene)->expensive, 4);
    assert_false(krs_scene_program(scenes[MIXED].scene)->per_component);
    const KrsProgram *ground = krs_scene_program(scenes[GROUND].scene);
    assert_int_equal(ground->march_group_count, 5); /* the last: the ball; rays know the plane */
    assert_true(ground->planes && isfinite(ground->march_groups[4].high[0]));
    assert_true(ground->march_groups[4].flops < 100);
}

int main(void)
{
    struct CMUnitTest tests[2 * SCENES + 6];
    size_t            count = 0;
    for (int i = 0; i < SCENES; i++) {
        tests[count++] = (struct CMUnitTest){scenes[i].name, parts_make_the_union, NULL, NULL,
                                             &scenes[i]};
        tests[count++] = (struct CMUnitTest){"early_outs_are_not_seen", early_outs_are_not_seen,
                                             NULL, NULL, &scenes[i]};
    }
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(crops_and_schedules_change_nothing);
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(any_number_is_packed);
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(zones_are_packed);
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(far_away_is_packed);
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(packed_in_every_way);
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(only_what_is_heavy_is_apart);
    return _cmocka_run_group_tests("components apart", tests, count, open_scenes, close_scenes);
}
