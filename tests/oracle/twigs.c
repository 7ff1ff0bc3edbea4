/*
 * twigs.c: scenes of thin twigs, pictures of them, and where exact rays meet them.
 */
#include "tests/oracle/twigs.h"

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
#include "tests/support/renderer.h"

#define DEFAULT_ERROR 0.25 /* krs/vulkan.h */
#define ROUGH_ERROR   0.5  /* of a scene that asks for it */

static Scene scenes[SCENES];

static void write_view(Scene *scene, const char *more)
{
    Vec    eye = scene->eye, target = scene->target;
    double height = 2 * tan(scene->fov / 2) * vec_distance(eye, target);
    scene_write(&scene->text, "%sparam size = 0.01 in [1e-6, 0.1];\n", more);
    scene_write(&scene->text, "light sun { direction: [1, 2, 1], shadow: false }\n");
    for (int i = 0; i < CAMERAS; i++)
        scene_write(&scene->text,
                    "camera %s{ eye: [%.17g, %.17g, %.17g], target: [%.17g, %.17g, %.17g], "
                    "fov: %.17g, projection: \"%s\", height: %.17g }\n",
                    i == FLAT ? "flat " : "", eye.x, eye.y, eye.z, target.x, target.y, target.z,
                    scene->fov, i == FLAT ? "orthographic" : "perspective", height);
    if (scene->walled) {
        Vec sides  = vec_sub(scene->high, scene->low);
        Vec middle = vec_mix(scene->low, scene->high, 0.5);
        scene_write(&scene->text, "let wall = box([%.17g, %.17g, %.17g]);\n", sides.x, sides.y,
                    sides.z);
        scene_write(&scene->text, "let place = [%.17g, %.17g, %.17g];\n", middle.x, middle.y,
                    middle.z);
    }
}

static void write_capsule(SceneText *text, Vec from, Vec to, double radius)
{
    scene_write(text, "capsule([%.17g, %.17g, %.17g], [%.17g, %.17g, %.17g], %.17g * size)", from.x,
                from.y, from.z, to.x, to.y, to.z, radius);
}

static void show_wall(Scene *scene)
{
    if (scene->walled)
        scene_write(&scene->text, "show wall.move(place);\n");
}

/* Writes the sequence into the scene's text, and its copies into the scene's rods. */
static void show_sequence(Scene *scene, const Sequence *sequence)
{
    scene_write(&scene->text, "show krs {\n");
    for (int level = 0; level <= sequence->mirror_count; level++) {
        if (level > 0) {
            Half mirror = sequence->mirrors[level - 1];
            scene_write(&scene->text, "reflect plane([%.17g, %.17g, %.17g], %.17g);\n",
                        mirror.normal.x, mirror.normal.y, mirror.normal.z, mirror.offset);
        }
        for (int i = 0; i < sequence->body_count; i++) {
            const Body *body = &sequence->bodies[i];
            if (body->level != level)
                continue;
            scene_write(&scene->text, "kernel ");
            write_capsule(&scene->text, body->from, body->to, body->radius);
            scene_write(&scene->text, ";\n");
        }
    }
    scene_write(&scene->text, "};\n");

    Expansion expansion = expand(sequence);
    scene->count        = expansion.count;
    scene->rods         = calloc(scene->count, sizeof *scene->rods);
    assert_non_null(scene->rods);
    for (size_t i = 0; i < scene->count; i++)
        scene->rods[i] = rod_of_copy(&expansion.copies[i]);
    expansion_free(&expansion);
}

/* Twigs in a cell, and the cell mirrored 9 times into a cube of 8 x 8 x 8: nothing is cut. */
static void make_thicket(Scene *scene, const char *more)
{
    enum { TWIGS = 24, MIRRORS = 9 };
    const Vec axes[3]  = {vec(1, 0, 0), vec(0, 1, 0), vec(0, 0, 1)};
    Sequence  sequence = {.mirror_count = MIRRORS, .body_count = TWIGS};
    Random    random   = {7};
    for (int i = 0; i < MIRRORS; i++)
        sequence.mirrors[i] = (Half){axes[i % 3], (1 << i / 3) - 1};
    for (int i = 0; i < TWIGS; i++) {
        Body *body   = &sequence.bodies[i];
        Vec   middle = vec(-0.5, -0.5, -0.5);
        body->from   = vec_add(middle, random_in_cube(&random, 0.45));
        do
            body->to = vec_add(middle, random_in_cube(&random, 0.45));
        while (vec_distance(body->from, body->to) < 0.6);
        body->radius = 1;
    }
    scene->target = vec(3, 3, 3);
    scene->eye    = vec(11.3, 7.1, 18.2);
    scene->fov    = 0.45;
    scene->low    = vec(-20, -20, -2.3);
    scene->high   = vec(20, 20, -2);
    write_view(scene, more);
    show_sequence(scene, &sequence);
    show_wall(scene);
}

/* Twigs all over the picture, at depths that differ by a factor of two, and yet of the same
   apparent width. */
static void make_heap(Scene *scene)
{
    enum { TWIGS = 160 };
    Random random = {11};
    scene->eye    = vec(1, 2, 10);
    scene->fov    = 0.6;
    scene->low    = vec(-9, -7, -5.5);
    scene->high   = vec(9, 7, -5);
    Lens lens     = lens_make(scene->eye, scene->target, tan(scene->fov / 2), false, 16, 9);
    scene->count  = TWIGS;
    scene->rods   = calloc(TWIGS, sizeof *scene->rods);
    assert_non_null(scene->rods);
    write_view(scene, "");
    scene_write(&scene->text, "show union([\n");
    for (size_t i = 0; i < TWIGS; i++) {
        double across   = random_between(&random, 0, 16);
        Line   ray      = lens_ray(&lens, across, random_between(&random, 0, 9));
        double distance = random_between(&random, 7, 13), share = distance / vec_length(scene->eye);
        Vec middle = line_at(ray, distance), lateral = vec_scale(0.5 * share, random_unit(&random));
        Rod *rod    = &scene->rods[i];
        *rod        = (Rod){.from = vec_sub(middle, lateral), .to = vec_add(middle, lateral)};
        rod->radius = vec_dot(vec_sub(middle, lens.eye), lens.forward) / vec_length(scene->eye);
        write_capsule(&scene->text, rod->from, rod->to, rod->radius);
        scene_write(&scene->text, i + 1 < TWIGS ? ",\n" : "]);\n");
    }
    show_wall(scene);
}

/* A tree of 10 mirrors, as in bench/scenes/tree28.krs: what its mirrors cut away is not seen. */
static void make_tree(Scene *scene)
{
    enum { LEVELS = 11 };
    Sequence sequence = {.mirror_count = LEVELS - 1, .body_count = LEVELS};
    Vec      fork = vec(0, 0, 0), before = vec(0, 1, 0);
    for (int i = 0; i < LEVELS; i++) {
        double lean = 0.42 + 0.02 * i, turn = 2.4 * i;
        Vec    heading     = vec(sin(lean) * cos(turn), cos(lean), sin(lean) * sin(turn));
        Vec    end         = vec_add(fork, vec_scale(0.9 * pow(0.88, i), heading));
        sequence.bodies[i] = (Body){
            .from = fork, .to = end, .radius = pow(0.75, i - LEVELS + 1), .level = LEVELS - 1 - i};
        if (i > 0) {
            Vec lateral = vec_sub(vec_scale(vec_dot(heading, before), before), heading);
            Vec normal  = vec_unit(lateral);
            sequence.mirrors[LEVELS - 1 - i] = (Half){normal, vec_dot(normal, fork)};
        }
        fork   = end;
        before = heading;
    }
    scene->target = vec(0, 2.6, 0);
    scene->eye    = vec(2, 3.2, 11);
    scene->fov    = 0.5;
    write_view(scene, "");
    show_sequence(scene, &sequence);
}

Scene *use_scene(SceneKind kind)
{
    Scene *scene = &scenes[kind];
    if (scene->rendering)
        return scene;
    scene->walled = kind == WALLED_THICKET || kind == WALLED_HEAP;
    switch (kind) {
    case HEAP:
    case WALLED_HEAP: make_heap(scene); break;
    case TREE: make_tree(scene); break;
    case ROUGH: make_thicket(scene, "image { error: 0.5 }\n"); break;
    default: make_thicket(scene, "");
    }
    scene->product = product_compile(scene->text.bytes);
    if (krs_rendering_new(renderer, scene->product.scene, KRS_FOR_PICTURES, &scene->rendering) !=
        KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
    return scene;
}

/* ---- Pictures, and what is there ---- */

Lens twigs_lens(const Shot *shot, int width, int height)
{
    const Scene *scene = use_scene(shot->kind);
    double       half  = tan(scene->fov / 2);
    if (shot->camera == FLAT)
        half *= vec_distance(scene->eye, scene->target);
    return lens_make(scene->eye, scene->target, half, shot->camera == FLAT, width, height);
}

double twigs_size(const Scene *scene, const Lens *lens, double wide)
{
    return wide / 2 * lens_pixel(lens, vec_distance(scene->eye, scene->target));
}

double twigs_error(const Shot *shot)
{
    if (shot->error > 0)
        return shot->error;
    return shot->kind == ROUGH ? ROUGH_ERROR : DEFAULT_ERROR;
}

KrsPicture *twigs_render(const Shot *shot, const Lens *lens, uint32_t samples)
{
    Scene           *scene = use_scene(shot->kind);
    double           size  = twigs_size(scene, lens, shot->wide + 2 * shot->grown);
    KrsPicture      *picture;
    KrsRenderOptions options = {.width   = (uint32_t)lens->width,
                                .height  = (uint32_t)lens->height,
                                .samples = samples,
                                .error   = shot->error,
                                .camera  = (size_t)shot->camera};
    assert_int_equal(krs_state_set(scene->product.state, "size", &size, 1), KRS_OK);
    if (krs_render(scene->rendering, scene->product.state, &options, &picture) != KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
    assert_int_equal(picture->stats.unresolved, 0);
    return picture;
}

double *twigs_truth(const Shot *shot, const Lens *lens, double x, double y)
{
    const Scene *scene = use_scene(shot->kind);
    double       size  = twigs_size(scene, lens, shot->wide);
    double      *enter = calloc((size_t)(lens->width * lens->height), sizeof *enter);
    Rod         *rods  = calloc(scene->count, sizeof *rods);
    assert_non_null(enter);
    assert_non_null(rods);
    for (size_t i = 0; i < scene->count; i++) {
        rods[i] = scene->rods[i];
        rods[i].radius *= size;
        rods[i].cut_count = shot->uncut ? 0 : rods[i].cut_count;
    }
    rods_seen(rods, scene->count, lens, x, y, enter);
    free(rods);
    for (int k = 0; scene->walled && k < lens->width * lens->height; k++) {
        Line  ray  = lens_ray(lens, k % lens->width + x, k / lens->width + y);
        Chord wall = chord_of_box(ray, scene->low, scene->high);
        if (!chord_is_empty(wall) && wall.enter <= enter[k])
            enter[k] = HUGE_VAL;
    }
    return enter;
}

/* ---- Tests ---- */

static int close_all(void **state)
{
    for (int i = 0; i < SCENES; i++) {
        krs_rendering_free(scenes[i].rendering);
        product_free(&scenes[i].product);
        free(scenes[i].rods);
    }
    return renderer_close(state);
}

int run_twig_tests(const char *name, const struct CMUnitTest *tests, size_t count)
{
    return _cmocka_run_group_tests(name, tests, count, renderer_open, close_all);
}
