/*
 * mixed_rays.c: shaders that are for the rays of a picture and for those of its paths make the same
 * pictures as shaders for one of both, and there are fewer of them.  So do shaders for small pictures,
 * and those of light that meets planes without a march.
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

enum { WIDTH = 96, HEIGHT = 64, PIXELS = WIDTH * HEIGHT };

#define CAMERA "camera { eye: [0, 1.5, 7], target: [0, 0.5, 0], fov: 0.7 }\n"
/* No mirrors, so paths are followed by shaders of their own, unless pictures are of paths. */
static const char dull[] = CAMERA
    "show plane([0, 1, 0], 0); show sphere(0.7).move([-1, 0.7, 0]).paint(#cc8844);\n"
    "show box([0.5, 1, 0.5]).move([0.8, 0.5, 0.4]);\n";
/* Mirrors and glass of several march groups. */
static const char bright[] = CAMERA
    "def tree(seed) = krs { kernel capsule([0, 0, 0], [0, 0.3, 0], 0.04).move([0, 0.4, 0]);\n"
    "    for i in 0..6 { reflect plane(random_direction(seed + i), 0.12 * i + 0.05);\n"
    "        kernel capsule([0, 0, 0], [0.1 * i, 0.3, 0], 0.05 + 0.01 * i); } };\n"
    "let bushes = [tree(1), tree(20), tree(40)];\n"
    "material glass { color: white, transmission: 1, roughness: 0 }\n"
    "material chrome { color: #ffeecc, metallic: 1, roughness: 0.05 }\n"
    "show plane([0, 1, 0], -1);\n"
    "show bushes[0].move([-2.5, 0, 0]).paint(chrome);\n"
    "show bushes[1].move([0.5, 0, -1]);\n"
    "show bushes[2].move([2.5, 0, 1]).paint(chrome);\n"
    "show sphere(0.5).move([0, 0.2, 2]).paint(glass);\n";

static KrsRenderer *renderer;

static int open_renderer(void **state)
{
    (void)state;
    return krs_renderer_new(&(KrsRendererOptions){.device = tested_device(), .validation = true},
                            &renderer) != KRS_OK;
}

static int close_renderer(void **state)
{
    (void)state;
    uint64_t validation_messages = krs_renderer_validation_messages(renderer);
    krs_renderer_free(renderer);
    return validation_messages > 0;
}

typedef struct Fixture {
    KrsScene     *scene;
    KrsState     *state;
    KrsRendering *rendering;
} Fixture;

static Fixture open_fixture(const char *text, KrsPurpose purpose)
{
    Fixture fixture;
    assert_int_equal(krs_compile_text(text, strlen(text), "mixed", NULL, &fixture.scene), KRS_OK);
    assert_int_equal(krs_state_new(fixture.scene, &fixture.state), KRS_OK);
    assert_int_equal(krs_rendering_new(renderer, fixture.scene, purpose, &fixture.rendering),
                     KRS_OK);
    return fixture;
}

static void close_fixture(Fixture *fixture)
{
    krs_rendering_free(fixture->rendering);
    krs_state_free(fixture->state);
    krs_scene_free(fixture->scene);
}

static KrsPicture *render(const Fixture *fixture, KrsIntegrator integrator,
                          KrsComponents components)
{
    const KrsRenderOptions options = {.width              = WIDTH,
                                      .height             = HEIGHT,
                                      .bounces            = 3,
                                      .integrator         = integrator,
                                      .methods.executor   = KRS_EXECUTOR_KERNELS,
                                      .methods.components = components};
    KrsPicture            *picture;
    if (krs_render(fixture->rendering, fixture->state, &options, &picture) != KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
    return picture;
}

/* Returns how many pixels of two pictures are apart by more than a twentieth. */
static int count_different(const KrsPicture *a, const KrsPicture *b)
{
    int count = 0;
    for (int i = 0; i < PIXELS; i++) {
        float most = 0;
        for (int k = 0; k < 3; k++)
            most = fmaxf(most, fabsf(a->color[4 * i + k] - b->color[4 * i + k]));
        count += !(most <= 0.05F);
    }
    return count;
}

enum { MAX_SHADERS = 64 };

static int count_shaders(const Fixture *fixture, const char *name)
{
    KrsShaderStats shaders[MAX_SHADERS];
    const size_t   count = krs_rendering_shaders(fixture->rendering, shaders, MAX_SHADERS);
    int            found = 0;
    for (size_t i = 0; i < count && i < MAX_SHADERS; i++)
        found += strncmp(shaders[i].name, name, strlen(name)) == 0;
    return found;
}

static size_t count_bytes(const Fixture *fixture, const char *name)
{
    KrsShaderStats shaders[MAX_SHADERS];
    const size_t   count = krs_rendering_shaders(fixture->rendering, shaders, MAX_SHADERS);
    size_t         bytes = 0;
    for (size_t i = 0; i < count && i < MAX_SHADERS; i++)
        bytes += strcmp(shaders[i].name, name) == 0 ? shaders[i].glsl_bytes : 0;
    return bytes;
}

static void paths_are_as_by_shaders_of_their_own(void **state)
{
    (void)state;
    Fixture own = open_fixture(dull, KRS_FOR_PICTURES), mixed = open_fixture(dull, KRS_FOR_PATHS);
    KrsPicture *a = render(&own, KRS_INTEGRATOR_PATH, KRS_COMPONENTS_DEFAULT);
    KrsPicture *b = render(&mixed, KRS_INTEGRATOR_PATH, KRS_COMPONENTS_DEFAULT);
    assert_int_equal(count_shaders(&own, "trace.comp"), 3); /* rays of previews snap no hits */
    assert_int_equal(count_shaders(&mixed, "trace.comp"), 1);
    assert_in_range(count_different(a, b), 0, PIXELS / 500);
    krs_picture_free(a);
    krs_picture_free(b);
    close_fixture(&own);
    close_fixture(&mixed);
}

/* Where march groups are asked for, the picture's rays have shaders of their own again. */
static void mirrors_are_as_with_march_groups(void **state)
{
    (void)state;
    Fixture fixture = open_fixture(bright, KRS_FOR_PICTURES);
    assert_true(krs_scene_program(fixture.scene)->mirrors);
    assert_true(krs_scene_program(fixture.scene)->march_group_count > 2);
    assert_int_equal(count_shaders(&fixture, "trace.comp"), 1);
    assert_int_equal(count_shaders(&fixture, "normals.comp"), 1);
    KrsPicture *a = render(&fixture, KRS_INTEGRATOR_PREVIEW, KRS_COMPONENTS_DEFAULT);
    assert_int_equal(count_shaders(&fixture, "trace.comp"), 1);
    KrsPicture *b = render(&fixture, KRS_INTEGRATOR_PREVIEW, KRS_COMPONENTS_APART);
    assert_true(count_shaders(&fixture, "trace.comp") > 2);
    assert_in_range(count_different(a, b), 0, PIXELS / 100);
    krs_picture_free(a);
    krs_picture_free(b);
    close_fixture(&fixture);
}

/* A floor, a wall, and solids whose undersides the floor hides from the sky. */
#define ROOM                                                                               \
    CAMERA                                                                                 \
    "light sun { direction: [-1, 2, 1], intensity: 2, softness: 6deg }\n"                  \
    "light lamp { position: [2, 3, 3], intensity: 8, radius: 0.3 }\n"                      \
    "show plane([0, 1, 0], 0).paint(#dddddd); show plane([0, 0, 1], -2).paint(#cc8866);\n" \
    "show sphere(0.7).move([-1, 0.9, 0]).paint(#dddddd);\n"                                \
    "show box([0.5, 1, 0.5]).move([0.8, 0.5, 0.4]);\n"
/* Zones cut holes into planes, so with this one, where nothing is, planes are marched. */
static const char marched[] = ROOM "zone { center: [0, 40, 0], radius: 0.1 }\n";

static void planes_are_in_the_light(KrsPurpose purpose, KrsIntegrator integrator, int permitted)
{
    Fixture own = open_fixture(ROOM, purpose), all = open_fixture(marched, purpose);
    assert_true(krs_scene_program(own.scene)->planes && !krs_scene_program(all.scene)->planes);
    KrsPicture *a = render(&own, integrator, KRS_COMPONENTS_DEFAULT);
    KrsPicture *b = render(&all, integrator, KRS_COMPONENTS_DEFAULT);
    assert_in_range(count_different(a, b), 0, permitted);
    krs_picture_free(a);
    krs_picture_free(b);
    close_fixture(&own);
    close_fixture(&all);
}

/* Paths that begin some roundings elsewhere may go elsewhere. */
static void planes_are_in_the_light_as_where_they_are_marched(void **state)
{
    (void)state;
    planes_are_in_the_light(KRS_FOR_PICTURES, KRS_INTEGRATOR_PREVIEW, PIXELS / 500);
    planes_are_in_the_light(KRS_FOR_PATHS, KRS_INTEGRATOR_PATH, PIXELS / 100);
}

/* Trees of four march groups without mirrors, and rays that go from root to root. */
static const char trees[] =
    "camera { eye: [0, 2, 16], target: [0, 0.3, 0], fov: 0.6 }\n"
    "def tree(seed) = krs { kernel capsule([0, 0, 0], [0, 0.3, 0], 0.04).move([0, 0.4, 0]);\n"
    "    for i in 0..20 { reflect plane(random_direction(seed + i), 0.04 * i + 0.05);\n"
    "        kernel capsule([0, 0, 0], [0.03 * i, 0.3, 0], 0.05 + 0.003 * i); } };\n"
    "let bushes = [tree(1), tree(20), tree(40), tree(60)];\n"
    "show bushes[0].move([-4.5, 0, 0]); show bushes[1].move([-1.5, 0, 0.7]);\n"
    "show bushes[2].move([1.5, 0, 1.4]); show bushes[3].move([4.5, 0, 2.1]);\n";
static const char roots[] = CAMERA
    "show algebraic(x^4 + y^4 + z^4 == 1).paint(#cc8844); show plane([0, 1, 0], -1);\n";

/* Shaders for small pictures are fewer, none is missing, and what they show is what is asked for by name
   of a rendering for large ones. */
static void small_pictures_have_fewer_shaders(const char *text, const char *name)
{
    Fixture     small = open_fixture(text, KRS_FOR_SMALL_PICTURES);
    Fixture     large = open_fixture(text, KRS_FOR_PICTURES);
    const int   all   = count_shaders(&large, "");
    KrsPicture *a     = render(&small, KRS_INTEGRATOR_PREVIEW, KRS_COMPONENTS_DEFAULT);
    KrsPicture *b     = render(&large, KRS_INTEGRATOR_PREVIEW, KRS_COMPONENTS_TOGETHER);
    assert_int_equal(count_shaders(&small, name), 1);
    assert_true(count_shaders(&small, "") < all);
    assert_in_range(count_different(a, b), 0, PIXELS / 100);
    krs_picture_free(a);
    krs_picture_free(b);
    close_fixture(&small);
    close_fixture(&large);
}

static void small_pictures_have_no_march_groups(void **state)
{
    (void)state;
    small_pictures_have_fewer_shaders(trees, "normals.comp");
    small_pictures_have_fewer_shaders(trees, "trace.comp");
}

static void small_pictures_have_no_beams_before_roots(void **state)
{
    (void)state;
    small_pictures_have_fewer_shaders(roots, "trace.comp");
}

/* Noises side by side, one in the other, of the plane and of space, in a shape and in colours. */
static const char noises[] = CAMERA
    "show sphere(1).displace(0.1 * fbm(2 * p)).paint(mix(#cc8844, #224466, 0.5 + fbm(3 * p + "
    "fbm(p))));\n"
    "show plane([0, 1, 0], -1).paint(mix(white, black, 0.5 + fbm([x, z]) * fbm([z, 2 * x])));\n";

/* In a small picture they are loops, for which the text is another. */
static void small_pictures_have_the_same_noises(void **state)
{
    (void)state;
    Fixture     small = open_fixture(noises, KRS_FOR_SMALL_PICTURES);
    Fixture     large = open_fixture(noises, KRS_FOR_PICTURES);
    KrsPicture *a     = render(&small, KRS_INTEGRATOR_PREVIEW, KRS_COMPONENTS_TOGETHER);
    KrsPicture *b     = render(&large, KRS_INTEGRATOR_PREVIEW, KRS_COMPONENTS_TOGETHER);
    for (int i = 0; i < 4 * PIXELS; i++)
        assert_true(fabsf(a->color[i] - b->color[i]) <= 1e-4F);
    assert_int_not_equal(count_bytes(&small, "shade.comp"), count_bytes(&large, "shade.comp"));
    krs_picture_free(a);
    krs_picture_free(b);
    close_fixture(&small);
    close_fixture(&large);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(paths_are_as_by_shaders_of_their_own),
        cmocka_unit_test(mirrors_are_as_with_march_groups),
        cmocka_unit_test(planes_are_in_the_light_as_where_they_are_marched),
        cmocka_unit_test(small_pictures_have_no_march_groups),
        cmocka_unit_test(small_pictures_have_no_beams_before_roots),
        cmocka_unit_test(small_pictures_have_the_same_noises),
    };
    return cmocka_run_group_tests_name("mixed rays", tests, open_renderer, close_renderer);
}
