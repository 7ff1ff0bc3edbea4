/*
 * algebraic.c: algebraic surfaces as the device traces them, by every way to advance.
 *
 * The ray of every pixel is built here from the camera's definition, and formulas.h finds its
 * first root in long double precision.  Away from outlines, those of the surface in front of itself
 * among them, every pixel must see what its ray meets, and where; at outlines it may be off by
 * one pixel.
 */
#include "krs/vulkan.h"
#include "tests/oracle/formulas.h"
#include "tests/oracle/product.h"
#include "tests/support/device.h"

#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 112, HEIGHT = 84, PIXELS = WIDTH * HEIGHT };

static const double FOV = 40 * 0.017453292519943295;

static KrsRenderer *renderer;

typedef struct Pixel {
    Vec   origin, direction;
    Entry entry;
} Pixel;

/* Pixel (i, j) looks through (i + 0.5, j + 0.5), row 0 is the top, fov is vertical. */
static void look(const Surface *surface, Vec eye, Pixel *pixels)
{
    Vec    forward = vec_unit(vec_scale(-1, eye));
    Vec    right = vec_unit(vec_cross(forward, vec(0, 1, 0))), up = vec_cross(right, forward);
    double half = tan(0.5 * FOV);
    for (int k = 0; k < PIXELS; k++) {
        double u     = ((k % WIDTH + 0.5) / WIDTH * 2 - 1) * half * WIDTH / HEIGHT;
        double v     = (1 - (k / WIDTH + 0.5) / HEIGHT * 2) * half;
        Pixel *pixel = &pixels[k];
        *pixel       = (Pixel){.origin    = eye,
                               .direction = vec_unit(
                                   vec_add(forward, vec_add(vec_scale(u, right), vec_scale(v, up))))};
        pixel->entry = surface_entry(surface->formula, surface->radius, eye, pixel->direction);
    }
}

/* Tells whether all pixels around see the same surface at about the same depth. */
static bool is_inside(const Surface *surface, const Pixel *pixels, int k)
{
    const Entry *here = &pixels[k].entry;
    for (int y = k / WIDTH - 1; y <= k / WIDTH + 1; y++)
        for (int x = k % WIDTH - 1; x <= k % WIDTH + 1; x++) {
            if (x < 0 || y < 0 || x >= WIDTH || y >= HEIGHT)
                continue;
            const Entry *there = &pixels[y * WIDTH + x].entry;
            if (there->fate != here->fate || there->fate == RAY_DOUBTFUL)
                return false;
            if (here->fate == RAY_HITS && fabsl(here->t - there->t) > 0.1 * surface->radius)
                return false;
        }
    return true;
}

/* How far a place that was seen is from the surface, and no farther than from the ray's root. */
static double distance_from(const Surface *surface, const Pixel *pixel, Vec seen)
{
    Vec    root = vec_add(pixel->origin, vec_scale((double)pixel->entry.t, pixel->direction)), near;
    double off  = vec_distance(root, seen);
    if (pixel->entry.on_ball)
        off = fmin(off, fabs(vec_length(seen) - surface->radius));
    if (surface_near(surface->formula, seen, &near))
        off = fmin(off, vec_distance(near, seen));
    return off;
}

typedef struct Verdict {
    int    inside, hits, missed, invented, misplaced;
    double farthest; /* from the surface, in pixels */
} Verdict;

static Verdict judge_picture(const Surface *surface, const KrsPicture *picture, const Pixel *pixels)
{
    Verdict verdict = {0};
    for (int k = 0; k < PIXELS; k++) {
        const Pixel *pixel = &pixels[k];
        bool         seen = picture->component[k] != 0, is = pixel->entry.fate == RAY_HITS;
        if (!is_inside(surface, pixels, k))
            continue;
        verdict.inside++;
        verdict.hits += is;
        verdict.missed += is && !seen;
        verdict.invented += seen && !is;
        if (!is || !seen)
            continue;
        const float *at    = &picture->position[3 * k];
        Vec          place = vec(at[0], at[1], at[2]);
        double       size  = 2 * tan(0.5 * FOV) / HEIGHT * vec_distance(place, pixel->origin);
        double       off   = distance_from(surface, pixel, place) / size;
        verdict.farthest   = fmax(verdict.farthest, off);
        verdict.misplaced += off > 0.25;
    }
    return verdict;
}

static const Vec eye_direction = {0.42, 0.31, 0.853};

/* `planted` is a factor on the size of what the device is given, 1 for none. */
static Product open_surface(const Surface *surface, Vec eye, double planted)
{
    return product_format("use \"std/surfaces.krs\";\n%sshow %sopen: false).scale(%.9g);\n"
                          "camera { eye: [%.17g, %.17g, %.17g], target: [0, 0, 0], fov: 40deg }",
                          surface->before, surface->call, planted, eye.x, eye.y, eye.z);
}

static void judge_by(const char *name, KrsTrace first, KrsTrace last, double planted, Verdict *sum)
{
    static Pixel   pixels[PIXELS];
    const Surface *surface = surface_named(name);
    Vec            eye     = vec_scale(3.2 * surface->radius, vec_unit(eye_direction));
    Product        product = open_surface(surface, eye, planted);
    KrsRendering  *rendering;
    assert_int_equal(krs_rendering_new(renderer, product.scene, KRS_FOR_PICTURES, &rendering),
                     KRS_OK);
    look(surface, eye, pixels);
    for (KrsTrace trace = first; trace <= last; trace++) {
        KrsRenderOptions options = {.width         = WIDTH,
                                    .height        = HEIGHT,
                                    .methods.trace = trace,
                                    .aovs          = KRS_AOV_POSITION | KRS_AOV_IDS};
        KrsPicture      *picture;
        if (krs_render(rendering, product.state, &options, &picture) != KRS_OK)
            fail_msg("%s: %s", name, krs_renderer_message(renderer));
        Verdict verdict = judge_picture(surface, picture, pixels);
        assert_int_equal(picture->stats.unresolved, 0);
        krs_picture_free(picture);
        sum->inside += verdict.inside;
        sum->missed += verdict.missed;
        sum->invented += verdict.invented;
        sum->misplaced += verdict.misplaced;
        if (planted == 1 && (verdict.missed + verdict.invented + verdict.misplaced > 0 ||
                             verdict.inside < PIXELS / 3 || verdict.hits < PIXELS / 40))
            fail_msg("%s by %s: of %d pixels inside of outlines, %d with hits, %d are missed, %d "
                     "invented, %d misplaced (by up to %g pixels)",
                     name, krs_trace_names[trace], verdict.inside, verdict.hits, verdict.missed,
                     verdict.invented, verdict.misplaced, verdict.farthest);
    }
    krs_rendering_free(rendering);
    product_free(&product);
}

static void by_all_methods(void **state)
{
    Verdict sum = {0};
    judge_by(*state, KRS_TRACE_PLAIN, KRS_TRACE_ROOT_FREE, 1, &sum);
}

static void by_exact_steps(void **state)
{
    Verdict sum = {0};
    judge_by(*state, KRS_TRACE_EXACT, KRS_TRACE_EXACT, 1, &sum);
}

/* A surface that is a fiftieth too large is found out. */
static void a_planted_fault_is_seen(void **state)
{
    Verdict sum = {0};
    (void)state;
    judge_by("barth_sextic", KRS_TRACE_EXACT, KRS_TRACE_EXACT, 1.02, &sum);
    assert_true(sum.misplaced > 50);
}

static int open_device(void **state)
{
    KrsRendererOptions options = {.device = tested_device()};
    (void)state;
    if (krs_renderer_new(&options, &renderer) == KRS_OK)
        return 0;
    fprintf(stderr, "%s\n", krs_renderer_message(renderer));
    return 1;
}

static int close_device(void **state)
{
    (void)state;
    krs_renderer_free(renderer);
    return 0;
}

int main(void)
{
    product_wants_research();
    static const char *const thorough[] = {"kummer of a param", "barth_sextic", "labs_septic"};
    static const char *const exact[]    = {
           "clebsch",     "cayley",        "togliatti",           "endrass_octic",
           "barth_decic", "sarti_dodecic", "chmutov of degree 14"};
    enum { THOROUGH = sizeof thorough / sizeof *thorough, EXACT = sizeof exact / sizeof *exact };
    struct CMUnitTest tests[THOROUGH + EXACT + 1];
    size_t            count = 0;
    for (size_t i = 0; i < THOROUGH; i++)
        tests[count++] = (struct CMUnitTest){thorough[i], by_all_methods, NULL, NULL,
                                             (void *)(uintptr_t)thorough[i]};
    for (size_t i = 0; i < EXACT; i++)
        tests[count++] = (struct CMUnitTest){exact[i], by_exact_steps, NULL, NULL,
                                             (void *)(uintptr_t)exact[i]};
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(a_planted_fault_is_seen);
    return _cmocka_run_group_tests("algebraic", tests, count, open_device, close_device);
}
