/*
 * shadow_fixture.c: scenes of solids over white ground, and pictures of their shadows.
 */
#include "tests/oracle/shadow_fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/support/random.h"
#include "tests/support/renderer.h"

const Solid a_ledge = {SLAB, {-20, 0, -20}, {0, 2, 20}, 0};

static const Solid A_BALL = {BALL, {0, 1.6, 0}, {0, 0, 0}, 0.9};

Fixture fixtures[FIXTURES] = {
    [LEDGE]       = {.target = {1.5, 0, 0}, .high = 4},
    [LEDGE_LAMP]  = {.lamp = true, .target = {1.5, 0, 0}, .high = 4},
    [BALLS]       = {.target = {1.2, 0, 0}, .high = 5},
    [BALL_LAMP]   = {.lamp = true, .target = {1.2, 0, 0}, .high = 5},
    [TWIGS]       = {.target = {0, 0, 0}, .high = 4},
    [BOUNDS]      = {.slope = 4, .target = {1.2, 0, 0}, .high = 5},
    [FAR_BOUNDS]  = {.slope = 20, .target = {1.2, 0, 0}, .high = 5},
    [POLYNOMIALS] = {.ball = "algebraic(x^2 + y^2 + z^2 == 1)", .target = {1.2, 0, 0}, .high = 5},
    [FIELDS]      = {.ball   = "field(x^2 + y^2 + abs(z)^2 - 1).within(box([8, 8, 8]))",
                     .target = {1.2, 0, 0},
                     .high   = 5},
    [TWISTS]      = {.ball = "sphere(1).twist([0, 1, 0], 1)", .target = {1.2, 0, 0}, .high = 5},
};

/* Twigs in all directions that lie above the ground. */
static void scatter_twigs(Fixture *fixture)
{
    Random random  = {5};
    fixture->count = 20;
    for (int i = 0; i < fixture->count; i++) {
        double turn = random_between(&random, 0, M_PI), length = random_between(&random, 0.5, 1.2);
        Vec    middle      = vec(random_between(&random, -3, 3), random_between(&random, 0.6, 1),
                                 random_between(&random, -2, 2));
        Vec    lateral     = vec(0.5 * length * cos(turn), random_between(&random, -0.2, 0.2),
                                 0.5 * length * sin(turn));
        fixture->solids[i] = (Solid){TWIG, vec_sub(middle, lateral), vec_add(middle, lateral), 1};
    }
}

static void place_solids(FixtureKind kind)
{
    Fixture *fixture = &fixtures[kind];
    if (kind == TWIGS) {
        scatter_twigs(fixture);
        return;
    }
    bool ledge                        = kind == LEDGE || kind == LEDGE_LAMP;
    fixture->solids[fixture->count++] = ledge ? a_ledge : A_BALL;
    if (kind == BALLS || fixture->slope > 0 || fixture->ball) /* one that lies on the ground */
        fixture->solids[fixture->count++] = (Solid){BALL, {-1.5, 0.4, 1.5}, {0, 0, 0}, 0.4};
}

static void write_solid(SceneText *text, const Fixture *fixture, const Solid *solid)
{
    Vec a = solid->a, b = solid->b, middle = vec_mix(a, b, 0.5), sides = vec_sub(b, a);
    switch (solid->kind) {
    case BALL:
        scene_write(text, "show %s.scale(%.17g).move([%.17g, %.17g, %.17g]).paint(white);\n",
                    fixture->slope > 0 ? "ball()"
                    : fixture->ball    ? fixture->ball
                                       : "sphere(1)",
                    solid->radius, a.x, a.y, a.z);
        break;
    case SLAB:
        scene_write(text,
                    "show box([%.17g, %.17g, %.17g]).move([%.17g, %.17g, %.17g])"
                    ".paint(white);\n",
                    sides.x, sides.y, sides.z, middle.x, middle.y, middle.z);
        break;
    case TWIG:
        scene_write(text,
                    "show capsule([%.17g, %.17g, %.17g], [%.17g, %.17g, %.17g], "
                    "%.17g * size).paint(white);\n",
                    a.x, a.y, a.z, b.x, b.y, b.z, solid->radius);
    }
}

static void write_view(SceneText *text, const Fixture *fixture)
{
    const char *where = fixture->lamp ? "position" : "direction";
    const char *wide  = fixture->lamp ? "radius" : "softness";
    Vec         t     = fixture->target;
    scene_write(text,
                "param at = [-1, 2, 0.5];\nparam wide = 0 in [0, 1];\n"
                "param size = 0.01 in [1e-6, 1];\n"
                "light red { %s: at, %s: wide, color: [1, 0, 0] }\n"
                "light green { %s: at, %s: wide, color: [0, 1, 0], shadow: false }\n"
                "sky { zenith: #000000, horizon: #000000, ground: #000000 }\n"
                "image { tone_map: \"none\" }\n"
                "material white { color: [1, 1, 1], roughness: 1 }\n"
                "show plane([0, 1, 0], 0).paint(white);\n",
                where, wide, where, wide);
    scene_write(text,
                "camera above { eye: [%g, 50, %g], target: [%g, %g, %g], "
                "projection: \"orthographic\", height: %g }\n",
                t.x, t.z + 50, t.x, t.y, t.z, fixture->high);
    scene_write(text, "camera aside { eye: [%g, 5, %g], target: [%g, %g, %g], fov: 40deg }\n",
                t.x + 4, t.z + 7, t.x, t.y, t.z);
}

void open_rendering(const Product *product, KrsRendering **rendering)
{
    if (krs_rendering_new(renderer, product->scene, KRS_FOR_PICTURES, rendering) != KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
}

Fixture *use_fixture(FixtureKind kind)
{
    Fixture *fixture = &fixtures[kind];
    if (fixture->rendering)
        return fixture;
    place_solids(kind);
    write_view(&fixture->text, fixture);
    if (fixture->slope > 0)
        scene_write(&fixture->text,
                    "shape ball(radius = 1) { distance: length(p) - radius, "
                    "slope: %.17g, within: box(2 * radius * [1, 1, 1]) }\n",
                    fixture->slope);
    for (int i = 0; i < fixture->count; i++)
        write_solid(&fixture->text, fixture, &fixture->solids[i]);
    fixture->product = product_compile(fixture->text.bytes);
    open_rendering(&fixture->product, &fixture->rendering);
    return fixture;
}

/* ---- Pictures ---- */

static void set_parameter(const Fixture *fixture, const char *name, const double *values,
                          size_t count)
{
    assert_int_equal(krs_state_set(fixture->product.state, name, values, count), KRS_OK);
}

KrsPicture *take_picture(KrsRendering *rendering, KrsState *state, KrsRenderOptions options)
{
    KrsPicture *picture;
    if (krs_render(rendering, state, &options, &picture) != KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
    assert_int_equal(picture->stats.unresolved, 0);
    return picture;
}

void set_lighting(const Shot *shot)
{
    const Fixture *fixture = use_fixture(shot->fixture);
    set_parameter(fixture, "at", (double[]){shot->light.x, shot->light.y, shot->light.z}, 3);
    set_parameter(fixture, "wide", &shot->wide, 1);
    if (shot->size > 0)
        set_parameter(fixture, "size", &shot->size, 1);
}

KrsPicture *shoot(const Shot *shot)
{
    const Fixture *fixture = use_fixture(shot->fixture);
    set_lighting(shot);
    return take_picture(fixture->rendering, fixture->product.state, shot->options);
}

Lens shot_lens(const Shot *shot)
{
    const Fixture *fixture = use_fixture(shot->fixture);
    Vec            t       = fixture->target;
    int            width = (int)shot->options.width, height = (int)shot->options.height;
    if (shot->options.camera == FROM_ABOVE)
        return lens_make(vec(t.x, 50, t.z + 50), t, fixture->high / 2, true, width, height);
    return lens_make(vec(t.x + 4, 5, t.z + 7), t, tan(20 * DEGREE), false, width, height);
}

double seen_at(const KrsPicture *picture, int k)
{
    const float *color = picture->color + 4 * k;
    if (picture->component[k] != 1 || !(color[1] > 0))
        return -1;
    return (double)color[0] / (double)color[1];
}

Vec ground_at(const Lens *lens, const KrsWindow *window, double x, double y)
{
    Line ray = lens_ray(lens, window->x + x + 0.5, window->y + y + 0.5);
    return line_at(ray, -ray.origin.y / ray.direction.y);
}

double pixel_at(const Lens *lens, Vec ground)
{
    return lens_pixel(lens, vec_dot(vec_sub(ground, lens->eye), lens->forward));
}

/* ---- Lights ---- */

const Lighting lightings[LIGHTINGS] = {
    {"sun of 4 degrees", LEDGE, BALLS, {-1, 1.3, 0.4}, {-1, 1.4, -0.6}, 4 * DEGREE},
    {"sun of 10 degrees", LEDGE, BALLS, {-1, 2, 0.4}, {-1, 1.4, -0.6}, 10 * DEGREE},
    {"lamp", LEDGE_LAMP, BALL_LAMP, {-2.5, 5, 1}, {-3, 5.5, -1.6}, 0.4},
};

Shot edge_shot(const Lighting *lighting, KrsShadows shadows, uint32_t samples)
{
    return (Shot){lighting->ledge,
                  lighting->edge_light,
                  lighting->wide,
                  0,
                  {.width                 = 640,
                   .height                = 360,
                   .crop                  = {192, 174, 448, 12},
                   .shadows               = shadows,
                   .samples               = samples,
                   .methods.no_upsampling = true},
                  0};
}

Shot ball_shot(const Lighting *lighting, KrsShadows shadows, uint32_t samples)
{
    return (Shot){lighting->ball,
                  lighting->ball_light,
                  lighting->wide,
                  0,
                  {.width                 = 320,
                   .height                = 180,
                   .crop                  = {110, 65, 165, 90},
                   .shadows               = shadows,
                   .samples               = samples,
                   .methods.no_upsampling = true},
                  0};
}

/* ---- Tests ---- */

static int close_all(void **state)
{
    for (int i = 0; i < FIXTURES; i++) {
        krs_rendering_free(fixtures[i].rendering);
        product_free(&fixtures[i].product);
    }
    return renderer_close(state);
}

int run_shadow_tests(const char *name, const struct CMUnitTest *tests, size_t count)
{
    return _cmocka_run_group_tests(name, tests, count, renderer_open, close_all);
}
