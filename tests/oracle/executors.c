/*
 * executors.c: pictures do not tell who marched their rays, shaders or lanes of the host.
 *
 * Hits, depths and normals are the same but for rounding and, at outlines, the permitted error; light is, but for
 * what grazes a surface.  A scene that is moved by a hundredth must be seen to differ.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "tests/support/device.h"
#include "tests/support/folder.h"
#include "tests/support/random.h"
#include "tests/support/renderer.h"

enum { WIDTH = 160, HEIGHT = 90, PIXELS = WIDTH * HEIGHT };

static const char *const scenes[] = {
    "camera { eye: [2, 3, 5] } show box([1, 1.4, 0.8]) - sphere(0.7).move([0.4, 0.3, 0.4]); show "
    "plane([0, 1, 0], -0.8);",
    "camera { eye: [3, 2, 4], target: [0.2, 0, 0], fov: 35deg } show union([torus(1, 0.3), "
    "cylinder(0.4, 1.6)], blend: 0.2);"
    "show ellipsoid([0.4, 0.2, 0.3]).move([1.2, 0.7, 0]); light lamp { position: [3, 4, 2], "
    "radius: 0.5, intensity: 60 "
    "}",
    "camera { eye: [0, 4, 6], projection: \"orthographic\", height: 5 } show capsule([0, 0, 0], "
    "[0, 0.6, 0], "
    "0.15).repeat([0.8, 0, 0.8], [5, 1, 5]);"
    "show plane([0, 1, 0], -0.2); light sun { direction: [1, 2, 1], softness: 3deg }",
    "camera { eye: [0, 1.6, 4.5], target: [0, 1.2, 0] } show krs { kernel capsule([0, 0, 0], [0, "
    "0.4, 0], radius: 0.05); "
    "for i in 0..7 { mobius translate([0, 0.4, 0]) * rotate([0, 1, 0], -70deg) * rotate([1, 0, 0], "
    "28deg) * scale(0.88); "
    "reflect plane([1, 0, 0], 0); kernel capsule([0, 0, 0], [0, 0.4, 0], radius: 0.05); } };",
    "camera { eye: [2, 2, 3] } show (box([2, 2, 2]) & sphere(1.3)).shell(0.05) - cylinder(0.4, 4); "
    "show plane([0, 1, 0.2], -1);",
    /* Materials with all layers, and patterns. */
    "material car { color: #a01020, coat: 0.5 + 0.3 * sin(9 * x), coat_roughness: 0.4, sheen: "
    "[0.3, 0.2, 0.6] }"
    "material foil { color: #c0c0b0, metallic: 0.9, roughness: 0.6, specular_roughness_anisotropy: "
    "0.6, "
    "tangent: [0, 1, 0.3], thin_film_weight: 0.8, thin_film_thickness: 0.4 + 0.1 * y, "
    "thin_film_ior: 1.6 }"
    "material skin { color: #e0b090, subsurface_weight: 0.6, subsurface_color: #ff6040, ior: 1.8 }"
    "show union(sphere(0.8).paint(car), sphere(0.6).move([1, 0.3, 0]).paint(foil), blend: 0.25);"
    "show box([0.8, 0.8, 0.8]).round(0.1).move([-1.4, 0, 0.3]).paint(skin); show plane([0, 1, 0], "
    "-0.8);"
    "camera { eye: [1, 2, 5], target: [0, 0, 0], fov: 40deg } light sun { direction: [1, 2, 3] }",
    "use \"std/patterns.krs\"; material tiles { color: mix(#2c3a36, #efe9dd, checker([x, z] / "
    "0.5)) }"
    "material lit { color: 0.5 + 0.5 * normal, emission: [0.3, 0.1, 0], roughness: 0.8 }"
    "show plane([0, 1, 0], -1).paint(tiles); show sphere(0.9).paint(lit); zone { center: [0.6, "
    "0.6, 0.6], radius: 0.4 }"
    "camera { eye: [1, 2, 5], target: [0, 0, 0], fov: 40deg }",
    "camera { eye: [0, 0, 0.2], target: [1, 0, 0], fov: 70deg } show box([4, 3, 4]).shell(0.2); "
    "show sphere(0.5).move([1.2, -0.4, 0.3]);",
    "camera { eye: [0, 2, 4] } show plane(); light s { direction: [1, 2, 1], softness: 2deg }",
    "camera { eye: [0, 1, 5], target: [0, 1, 0], projection: \"orthographic\", height: 5 } show "
    "plane(); "
    "show box([4, 1.5, 1]).move([0, 2, 0]); light s { direction: [0, -1, 0.5], intensity: 3 }",
    /* Copies that differ by numbers of 32 bits. */
    "def pebble(cell) = sphere(0.15 + 0.2 * random(cell)); show pebble.repeat([1, 0, 1])"
    ".paint(mix(red, blue, instance)); camera { eye: [1, 2, 4] }",
    /* Outlines of a table, noise, sectors and alike parts. */
    "camera { eye: [0.6, 1, 4], target: [0, 0.3, 0] } material stone { color: mix(#a08060, "
    "#304050, "
    "0.5 + 0.5 * noise(4 * p)) } show text(\"Kr\", size: 1.2, align: \"center\").extrude(0.3)"
    ".rotate([0, 1, 0], 20deg).paint(stone); show plane([0, 1, 0], -0.3);",
    "camera { eye: [0.6, 1, 4], target: [0, 0.3, 0] } show sphere(0.9).displace(0.04 * noise(9 * "
    "p), "
    "0.05); show plane([0, 1, 0], -0.3);",
    "camera { eye: [1, 2, 4] } show union(circle(0.8), polygon([[0.7, -0.12], [1.3, -0.1], [1.4, "
    "0], "
    "[1.3, 0.1], [0.7, 0.12], [0.6, 0]]).repeat_polar(9, [0, 0, 1]), blend: 0.05).extrude(0.3); "
    "show "
    "union([sphere(0.1 + 0.02 * i).move([0.2 * i - 1, -1, 0.3]) for i in 0..9], blend: 0.1);",
    /* Mirrors of mirrors: balls, a box on a floor, a coat, a lamp between them. */
    "material mirror { color: #f0e0c0, metallic: 1, roughness: 0 } material lacquer { color: "
    "#802010, "
    "coat: 1, coat_roughness: 0 } show sphere(0.7).move([-0.8, 0.7, 0]).paint(mirror); show "
    "sphere(0.7).move([0.8, 0.7, 0.2]).paint(mirror); show box([0.5, 0.5, 0.5]).move([0, 0.25, "
    "1]).paint(lacquer); show cylinder(0.05, 1.2).move([0, 0.6, -0.9]); show plane(); camera { "
    "eye: "
    "[1, 1.8, 4], target: [0, 0.6, 0], fov: 40deg } light sun { direction: [1, 2, 1], softness: "
    "2deg } "
    "light lamp { position: [0, 1.5, 0.5], radius: 0.1, intensity: 3 }",
    /* A floor that mirrors, and a camera inside of a room with a mirror. */
    "material polished { color: #909498, roughness: 0.04 } show plane().paint(polished); show "
    "torus(0.6, 0.2).rotate([1, 0, 0], 70deg).move([0, 0.9, 0]).paint(#3050a0); show box([0.5, 1, "
    "0.5]).round(0.1).move([1.1, 0.5, -0.5]); camera { eye: [1, 1.2, 4], target: [0, 0.5, 0], fov: "
    "40deg "
    "} light sun { direction: [1, 1, 1] }",
    "material mirror { color: #f0f0f0, metallic: 1, roughness: 0.02 } camera { eye: [0.4, 0.3, "
    "0.2], "
    "target: [-1, 0, -0.6], fov: 70deg } show box([4, 3, 4]).shell(0.2); show "
    "sphere(0.5).move([-1.2, -0.6, -0.9]); show box([0.1, 1.6, 1.6]).move([-1.7, 0, "
    "0.2]).paint(mirror); light lamp { position: [0.3, 0.9, 0], intensity: 4 }",
};

typedef struct Verdict {
    size_t hits, other_hits, other_depths, other_normals, other_light, other_albedos;
} Verdict;

static Verdict judge(const KrsPicture *a, const KrsPicture *b)
{
    Verdict verdict = {0};
    for (size_t k = 0; k < PIXELS; k++) {
        const double depth = (double)a->depth[k];
        double       turn = 0, light = 0, paint = 0;
        verdict.hits += a->component[k] != 0;
        if (a->component[k] != b->component[k] || a->instance[k] != b->instance[k]) {
            verdict.other_hits++;
            continue;
        }
        for (size_t c = 0; c < 3; c++) {
            turn  = fmax(turn, fabs((double)(a->normal[3 * k + c] - b->normal[3 * k + c])));
            light = fmax(light, fabs((double)(a->color[4 * k + c] - b->color[4 * k + c])));
            paint = fmax(paint, fabs((double)(a->albedo[3 * k + c] - b->albedo[3 * k + c])));
        }
        if (a->component[k] == 0)
            continue;
        verdict.other_depths += !(fabs(depth - (double)b->depth[k]) < 1e-3 * depth);
        verdict.other_normals += turn > 0.02;
        verdict.other_light += light > 0.03;
        verdict.other_albedos += paint > 1.0 / 255;
    }
    return verdict;
}

static Verdict compare_as(KrsRenderOptions how, const char *text, const char *other_text)
{
    const KrsExecutor executor = how.methods.executor;
    how.width                  = WIDTH;
    how.height                 = HEIGHT;
    how.methods.executor       = KRS_EXECUTOR_KERNELS;
    KrsPicture *kernels        = picture_of(text, &how);
    how.methods.executor       = executor;
    KrsPicture   *lanes        = picture_of(other_text, &how);
    const Verdict verdict      = judge(kernels, lanes);
    const double  steps = (double)kernels->stats.unresolved - (double)lanes->stats.unresolved;
    assert_true(fabs(steps) <= PIXELS / 20 * fmax(how.samples, 1));
    krs_picture_free(kernels);
    krs_picture_free(lanes);
    return verdict;
}

static Verdict compare_with(KrsExecutor executor, const char *text, const char *other_text)
{
    return compare_as((KrsRenderOptions){.methods.executor = executor}, text, other_text);
}

static Verdict compare(const char *text, const char *other_text)
{
    return compare_with(KRS_EXECUTOR_LANES, text, other_text);
}

static void are_the_same(const Verdict *v)
{
    print_message("%zu hits; others: %zu hits, %zu depths, %zu normals, %zu light\n", v->hits,
                  v->other_hits, v->other_depths, v->other_normals, v->other_light);
    assert_true(v->hits > PIXELS / 20);
    assert_true(v->other_hits <= PIXELS / 1000);
    assert_true(v->other_depths <= PIXELS / 2000);
    assert_true(v->other_normals <= v->hits / 100);
    assert_true(v->other_light <= v->hits / 100);
    assert_true(v->other_albedos <= v->hits / 1000);
}

static void pictures_are_the_same(void **context)
{
    (void)context;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        const Verdict v = compare(scenes[i], scenes[i]);
        are_the_same(&v);
    }
}

/* Cameras whose rays do not meet in an eye, or not in a plane.  The first ray of a pixel goes through the middle of the
   lens, so others are needed. */
enum { SAMPLES = 3 };
#define SEEN_BY(camera)                                                                         \
    "use \"std/patterns.krs\"; material tiles { color: mix(#2c3a36, #efe9dd, checker([x, z] / " \
    "0.3)) } camera { " camera                                                                  \
    " } show box([1, 1.4, 0.8]) - sphere(0.7).move([0.4, 0.3, 0.4]); show capsule([-2, 0, 2], " \
    "[-2, 1, 2], 0.2); show torus(0.8, 0.2).move([2, 0, -3]); show plane([0, 1, 0], "           \
    "-0.8).paint(tiles); light sun { direction: [1, 2, 1], softness: 3deg }"
#define LENS(numbers) SEEN_BY("eye: [2, 3, 5], " numbers)

static const struct {
    const char *text;
    KrsEye      eye;
} cameras[] = {
    {LENS("aperture: 0.15"), KRS_EYE_OF_BOTH},
    {LENS("aperture: 0.2, focus: [-2, 0.5, 2], blades: 5"), KRS_EYE_OF_BOTH},
    {LENS("projection: \"orthographic\", height: 6, aperture: 0.3, focus: [2, 0, -3]"),
     KRS_EYE_OF_BOTH},
    {LENS("shift: [0.2, -0.15]"), KRS_EYE_OF_BOTH},
    {LENS("projection: \"orthographic\", height: 6, shift: [-0.1, 0.3]"), KRS_EYE_OF_BOTH},
    {LENS("eyes: 0.5"), KRS_EYE_ON_RIGHT},
    {SEEN_BY("eye: [0, 1.5, 2], projection: \"panorama\""), KRS_EYE_OF_BOTH},
    {SEEN_BY("eye: [0, 1.5, 2], projection: \"panorama\", eyes: 0.5"), KRS_EYE_ON_LEFT},
    {"material mirror { color: #f0e0c0, metallic: 1, roughness: 0 } show "
     "sphere(0.7).move([-0.8, 0.7, 0]).paint(mirror); show box([0.5, 1.2, 0.5]).move([0.9, 0.6, "
     "0.4]); show plane(); camera { eye: [1, 1.8, 4], target: [0, 0.6, 0], fov: 40deg, aperture: "
     "0.15, focus: [0.9, 0.6, 0.4] } light sun { direction: [1, 2, 1] }",
     KRS_EYE_OF_BOTH},
};

static KrsRenderOptions seen_by(KrsEye eye)
{
    return (KrsRenderOptions){
        .samples = SAMPLES, .eye = eye, .methods.executor = KRS_EXECUTOR_LANES};
}

static void pictures_of_all_cameras_are_the_same(void **context)
{
    (void)context;
    for (size_t i = 0; i < sizeof cameras / sizeof *cameras; i++) {
        const Verdict v = compare_as(seen_by(cameras[i].eye), cameras[i].text, cameras[i].text);
        are_the_same(&v);
    }
}

/* Another aperture, another place that is sharp, a lens with corners, a small shift. */
static void another_lens_is_seen(void **context)
{
    static const char *const others[] = {
        LENS("aperture: 0.2"), LENS("aperture: 0.15, focus: [2, 0, -3]"),
        LENS("aperture: 0.15, blades: 3"), LENS("aperture: 0.15, shift: [0.01, 0]")};
    (void)context;
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        const Verdict v = compare_as(seen_by(KRS_EYE_OF_BOTH), cameras[0].text, others[i]);
        print_message("another lens: %zu light of %zu\n", v.other_light, v.hits);
        assert_true(v.other_light > v.hits / 50);
    }
}

static void a_moved_scene_is_seen(void **context)
{
    (void)context;
    const Verdict v = compare(
        "camera { eye: [2, 3, 5] } show box([1, 1.4, 0.8]);",
        "camera { eye: [2, 3, 5] } show box([1, 1.4, 0.8]).move([0.01, 0, 0.01]);");
    assert_true(v.other_depths > v.hits / 4);
}

/* What a text is refused with. */
static void refused_by(KrsExecutor executor, const char *text, KrsIntegrator integrator,
                       KrsStatus status, const char *words)
{
    const KrsRenderOptions options = {
        .width = 8, .height = 8, .integrator = integrator, .methods.executor = executor};
    KrsScene     *scene;
    KrsState     *state;
    KrsRendering *rendering;
    KrsPicture   *picture;
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", NULL, &scene), KRS_OK);
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    assert_int_equal(krs_rendering_new(renderer, scene, KRS_FOR_PICTURES, &rendering), KRS_OK);
    assert_int_equal(krs_render(rendering, state, &options, &picture), status);
    assert_non_null(strstr(krs_renderer_message(renderer), words));
    krs_rendering_free(rendering);
    krs_state_free(state);
    krs_scene_free(scene);
}

static void refused(const char *text, KrsIntegrator integrator, const char *words)
{
    refused_by(KRS_EXECUTOR_LANES, text, integrator, KRS_BAD_ARGUMENT, words);
}

static void what_lanes_do_not_know_is_refused(void **context)
{
    (void)context;
    refused("show sphere(1);", KRS_INTEGRATOR_PATH, "`preview`");
    refused("show algebraic(x^4 + y^4 + z^4 == 1);", KRS_INTEGRATOR_PREVIEW, "method");
}

enum { SEEN = 12, UNSEEN = 3000, BYTES_OF_PART = 600 };

/* Returns a solid around a point of which others are taken: no two have the same kinds of them. */
static size_t write_part(char *to, Random *random, const double at[3])
{
    static const char *const kinds[] = {"sphere(%.4f)", "box([%.4f, 0.2, 0.15])",
                                        "torus(%.4f, 0.05)", "cylinder(%.4f, 0.3)"};
    const int                count   = 3 + random_below(random, 5);
    size_t                   length  = 0;
    for (int i = 0; i < count; i++) {
        double off[3];
        random_vector(random, i == 0 ? 0 : 0.25, off);
        length += (size_t)sprintf(to + length, i == 0 ? "" : " - ");
        length += (size_t)sprintf(to + length, kinds[random_below(random, 4)],
                                  random_between(random, 0.15, 0.3));
        length += (size_t)sprintf(to + length, ".move([%.4f, %.4f, %.4f])", at[0] + off[0],
                                  at[1] + off[1], at[2] + off[2]);
    }
    return length + (size_t)sprintf(to + length, ", ");
}

/* The first parts are before the camera, and so many more behind it. */
static char *different_parts(int unseen)
{
    Random random = {7};
    char  *text   = malloc((size_t)(SEEN + unseen + 1) * BYTES_OF_PART);
    size_t length = 0;
    assert_non_null(text);
    length += (size_t)sprintf(text, "camera { eye: [0, 0, 5], fov: 40deg } show union([");
    for (int i = 0; i < SEEN + unseen; i++) {
        double at[3];
        random_vector(&random, i < SEEN ? 1 : 8, at);
        at[2] += i < SEEN ? 0 : 20;
        length += write_part(text + length, &random, at);
    }
    sprintf(text + length, "]);");
    return text;
}

/* No shader is made of thousands of parts that differ; lanes march by themselves then. */
static void what_is_too_large_for_shaders_is_drawn(void **context)
{
    (void)context;
    char         *few = different_parts(0), *many = different_parts(UNSEEN);
    const Verdict v = compare_with(KRS_EXECUTOR_DEFAULT, few, many);
    print_message("%zu hits; others: %zu hits, %zu depths, %zu normals\n", v.hits, v.other_hits,
                  v.other_depths, v.other_normals);
    assert_true(v.hits > PIXELS / 40);
    assert_true(v.other_hits <= PIXELS / 1000);
    assert_true(v.other_depths <= PIXELS / 2000);
    assert_true(v.other_normals <= v.hits / 50);
    refused_by(KRS_EXECUTOR_KERNELS, many, KRS_INTEGRATOR_PREVIEW, KRS_BAD_SCENE, "E0401");
    refused_by(KRS_EXECUTOR_DEFAULT, many, KRS_INTEGRATOR_PATH, KRS_BAD_SCENE, "E0401");
    refused_by(KRS_EXECUTOR_LANES, many, KRS_INTEGRATOR_PATH, KRS_BAD_SCENE, "`preview`");
    free(few);
    free(many);
}

/* Rays do not depend on which others there are. */
static void crops_are_parts_of_the_whole(void **context)
{
    enum { X = 37, Y = 21, CROPPED_WIDTH = 75, CROPPED_HEIGHT = 50 };
    (void)context;
    KrsRenderOptions options = {
        .width = WIDTH, .height = HEIGHT, .methods.executor = KRS_EXECUTOR_LANES};
    KrsPicture *whole = picture_of(scenes[0], &options);
    options.crop      = (KrsWindow){X, Y, CROPPED_WIDTH, CROPPED_HEIGHT};
    KrsPicture *crop  = picture_of(scenes[0], &options);
    for (int row = 0; row < CROPPED_HEIGHT; row++)
        assert_memory_equal(&crop->depth[row * CROPPED_WIDTH], &whole->depth[(Y + row) * WIDTH + X],
                            CROPPED_WIDTH * sizeof *crop->depth);
    krs_picture_free(whole);
    krs_picture_free(crop);
}

/* One rendering after the other, with what is kept from picture to picture, or each from nothing. */
typedef struct Kept {
    KrsScene     *scene;
    KrsState     *state;
    KrsRendering *rendering;
} Kept;

static Kept open_scene(const char *text)
{
    Kept kept;
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", NULL, &kept.scene), KRS_OK);
    assert_int_equal(krs_state_new(kept.scene, &kept.state), KRS_OK);
    assert_int_equal(krs_rendering_new(renderer, kept.scene, KRS_FOR_LANES, &kept.rendering),
                     KRS_OK);
    return kept;
}

static void close_scene(Kept *kept)
{
    krs_rendering_free(kept->rendering);
    krs_state_free(kept->state);
    krs_scene_free(kept->scene);
}

static KrsPicture *render(const Kept *kept, double x, double wide)
{
    const KrsRenderOptions options = {
        .width = WIDTH, .height = HEIGHT, .methods.executor = KRS_EXECUTOR_LANES};
    KrsCamera   camera;
    KrsFilm    *film;
    KrsPicture *picture;
    assert_int_equal(krs_state_set(kept->state, "wide", &wide, 1), KRS_OK);
    assert_int_equal(krs_state_camera(kept->state, 0, &camera), KRS_OK);
    camera.eye[0] += x;
    assert_int_equal(krs_film_new(kept->rendering, &options, &film), KRS_OK);
    assert_int_equal(krs_film_add(film, kept->state, &camera, 1), KRS_OK);
    assert_int_equal(krs_film_read(film, 0, &picture), KRS_OK);
    krs_film_free(film);
    return picture;
}

static bool are_equal(const KrsPicture *a, const KrsPicture *b)
{
    return memcmp(a->depth, b->depth, PIXELS * sizeof *a->depth) == 0 &&
           memcmp(a->color, b->color, 4 * PIXELS * sizeof *a->color) == 0;
}

/* The camera goes into a solid and out of it, so planes are met at once or not; a parameter changes, and goes back. */
static void what_is_kept_changes_nothing(void **context)
{
    static const char text[] =
        "param wide = 1 in [0.5, 2]; camera { eye: [2, 3, 5] } show box([wide, 1.4, 0.8]) - "
        "sphere(0.7).move([0.4, 0.3, 0.4]); show plane([0, 1, 0], -0.8); show sphere(0.5).move([9, "
        "3, 5]).paint([wide / 3, 0.3, 0.1]); light lamp { position: [3, 4, 2] }";
    static const double asked[][2] = {{0, 1}, {0.5, 1}, {0.5, 1.7}, {7, 1.7}, {-3, 1.7}, {0, 1}};
    Kept                kept       = open_scene(text);
    KrsPicture         *last       = NULL;
    (void)context;
    for (size_t i = 0; i < sizeof asked / sizeof *asked; i++) {
        Kept        fresh   = open_scene(text);
        KrsPicture *picture = render(&kept, asked[i][0], asked[i][1]);
        KrsPicture *alone   = render(&fresh, asked[i][0], asked[i][1]);
        assert_true(are_equal(picture, alone));
        assert_true(!last || !are_equal(picture, last));
        krs_picture_free(last);
        krs_picture_free(alone);
        last = picture;
        close_scene(&fresh);
    }
    krs_picture_free(last);
    close_scene(&kept);
}

/* How many shaders that march rays of a scene a rendering has made, after so many samples. */
static size_t shaders_with_scene(KrsRendering *rendering, KrsState *state, KrsExecutor executor,
                                 uint32_t samples)
{
    KrsShaderStats         shaders[32];
    size_t                 found   = 0;
    const KrsRenderOptions options = {
        .width = 96, .height = 54, .samples = samples, .methods.executor = executor};
    KrsPicture *picture;
    assert_int_equal(krs_render(rendering, state, &options, &picture), KRS_OK);
    const size_t count = krs_rendering_shaders(rendering, shaders, 32);
    for (size_t i = 0; i < count; i++)
        found += strncmp(shaders[i].name, "trace.comp", 10) == 0;
    assert_int_equal(picture->stats.executor,
                     found > 0 ? KRS_EXECUTOR_KERNELS : KRS_EXECUTOR_LANES);
    krs_picture_free(picture);
    return found;
}

/* Lanes are tried without a shader of the scene; what they do not draw alone is refused. */
static void try_lanes(const char *text, KrsIntegrator integrator, const char *words)
{
    const KrsRenderOptions options = {.width = 320, .height = 180, .integrator = integrator};
    KrsScene              *scene;
    KrsState              *state;
    KrsRendering          *rendering;
    KrsFilm               *film;
    KrsShaderStats         shaders[32];
    double                 ms = 0, compilers = 0;
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", NULL, &scene), KRS_OK);
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    assert_int_equal(krs_rendering_new(renderer, scene, KRS_FOR_FIRST_PICTURES, &rendering),
                     KRS_OK);
    assert_int_equal(krs_film_new(rendering, &options, &film), KRS_OK);
    assert_int_equal(krs_film_try_lanes(film, state, NULL, &ms, &compilers),
                     words ? KRS_BAD_ARGUMENT : KRS_OK);
    assert_true(words ? strstr(krs_renderer_message(renderer), words) != NULL
                      : ms > 0 && isfinite(ms) && compilers > 0);
    assert_int_equal(krs_film_samples(film), 0);
    const size_t count = krs_rendering_shaders(rendering, shaders, 32);
    for (size_t i = 0; i < count; i++)
        assert_true(strcmp(shaders[i].name, "shade.comp") != 0 &&
                    strncmp(shaders[i].name, "trace.comp", 10) != 0);
    krs_film_free(film);
    krs_rendering_free(rendering);
    krs_state_free(state);
    krs_scene_free(scene);
}

static void trying_lanes_compiles_nothing(void **context)
{
    (void)context;
    try_lanes(scenes[0], KRS_INTEGRATOR_PREVIEW, NULL);
    try_lanes(scenes[0], KRS_INTEGRATOR_PATH, "`preview`");
    try_lanes("material glass { transmission: 1 } show sphere(1).paint(glass);",
              KRS_INTEGRATOR_PREVIEW, "light goes through something");
    try_lanes(
        "material mirror { metallic: 1, roughness: 0 } show sphere(1).paint(mirror); show plane();",
        KRS_INTEGRATOR_PREVIEW, NULL);
}

/* A first picture is made without shaders of the scene, unless they are asked for, or so many samples are that compilers take
   less time than lanes do.  Numbers keep the text out of the cache. */
static void first_pictures_wait_for_no_compiler(void **context)
{
    static const uint32_t many = 1024;
    char                  text[128];
    (void)context;
    for (int i = 0; i < 3; i++) {
        KrsScene     *scene;
        KrsState     *state;
        KrsRendering *rendering;
        snprintf(text, sizeof text, "show torus(1, 0.3) | sphere(0.5%d%d);", i, (int)getpid());
        assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", NULL, &scene), KRS_OK);
        assert_int_equal(krs_state_new(scene, &state), KRS_OK);
        assert_int_equal(krs_rendering_new(renderer, scene, KRS_FOR_FIRST_PICTURES, &rendering),
                         KRS_OK);
        if (i < 2)
            assert_int_equal(shaders_with_scene(rendering, state, KRS_EXECUTOR_DEFAULT, 1), 0);
        if (i == 0)
            assert_true(shaders_with_scene(rendering, state, KRS_EXECUTOR_DEFAULT, many) > 0);
        else
            assert_true(shaders_with_scene(rendering, state, KRS_EXECUTOR_KERNELS, 1) > 0);
        krs_rendering_free(rendering);
        krs_state_free(state);
        krs_scene_free(scene);
    }
}

/* Returns a renderer as that of another process: with a cache in the current folder. */
static KrsRenderer *new_process(void)
{
    const KrsRendererOptions options = {.device = tested_device(), .cache = "cache"};
    KrsRenderer             *other   = NULL;
    assert_int_equal(krs_renderer_new(&options, &other), KRS_OK);
    return other;
}

/* Returns as many samples as lanes draw in a twentieth of the time that compilers take. */
static uint32_t samples_of_a_twentieth(KrsScene *scene, KrsState *state)
{
    KrsRenderer           *process = new_process();
    const KrsRenderOptions options = {.width = 96, .height = 54};
    double                 lanes = 0, compilers = 0;
    KrsRendering          *rendering;
    KrsFilm               *film;
    assert_int_equal(krs_rendering_new(process, scene, KRS_FOR_FIRST_PICTURES, &rendering), KRS_OK);
    assert_int_equal(krs_film_new(rendering, &options, &film), KRS_OK);
    assert_int_equal(krs_film_try_lanes(film, state, NULL, &lanes, &compilers), KRS_OK);
    krs_film_free(film);
    krs_rendering_free(rendering);
    krs_renderer_free(process);
    return 1 + (uint32_t)(compilers / lanes / 20);
}

/* Processes that each draw little by lanes together lose what compilers take; then one compiles. */
static void what_processes_lose_is_added(void **context)
{
    enum { MOST = 400 };
    char      text[128];
    KrsScene *scene;
    KrsState *state;
    size_t    shaders = 0;
    int       drawn   = 0;
    (void)context;
    snprintf(text, sizeof text, "show torus(1, 0.3) | sphere(0.6%d);", (int)getpid());
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", NULL, &scene), KRS_OK);
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    const uint32_t samples = samples_of_a_twentieth(scene, state);
    for (; shaders == 0 && drawn < MOST; drawn++) {
        KrsRenderer  *process = new_process();
        KrsRendering *rendering;
        assert_int_equal(krs_rendering_new(process, scene, KRS_FOR_FIRST_PICTURES, &rendering),
                         KRS_OK);
        shaders = shaders_with_scene(rendering, state, KRS_EXECUTOR_DEFAULT, samples);
        krs_rendering_free(rendering);
        krs_renderer_free(process);
    }
    print_message("compiled for picture %d of %u samples\n", drawn, samples);
    assert_true(drawn > 1 && drawn < MOST);
    krs_state_free(state);
    krs_scene_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_are_the_same),
        cmocka_unit_test(pictures_of_all_cameras_are_the_same),
        cmocka_unit_test(another_lens_is_seen),
        cmocka_unit_test(a_moved_scene_is_seen),
        cmocka_unit_test(what_lanes_do_not_know_is_refused),
        cmocka_unit_test(what_is_too_large_for_shaders_is_drawn),
        cmocka_unit_test(crops_are_parts_of_the_whole),
        cmocka_unit_test(what_is_kept_changes_nothing),
        cmocka_unit_test(trying_lanes_compiles_nothing),
        cmocka_unit_test(first_pictures_wait_for_no_compiler),
        cmocka_unit_test_setup_teardown(what_processes_lose_is_added, enter_folder, leave_folder)};
    return cmocka_run_group_tests(tests, renderer_open, renderer_close);
}
