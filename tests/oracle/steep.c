/*
 * steep.c: fields whose slope differs by powers of ten within their region, held against roots.
 *
 * A field is divided by its largest slope, so where it is flat its distance is next to nothing,
 * and single precision leaves nothing at all.  A surface is where the sign changes and nowhere
 * else: the ray of every pixel is searched for the first root of the formula in double precision,
 * and away from outlines the picture must show that, by every method, and `krs_raycast` too.  A
 * ray may be unresolved; it must be counted then, and show nothing.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/oracle/exact.h"
#include "tests/oracle/product.h"
#include "tests/support/renderer.h"

enum { WIDTH = 96, HEIGHT = 72, PIXELS = WIDTH * HEIGHT, SAMPLES = 600 };

/* Half of the region's side; the eye is outside of it. */
#define HALF 2.0
/* What is asked for: rays that may be unresolved, and where a hit may be, in pixels. */
#define MAX_UNRESOLVED 0.01
#define MAX_OFF        0.3

typedef double Formula(Vec p);

static double smallest(Vec p)
{
    double t = fmin(fmax((p.x - 1.5) / 0.1, 0), 1);
    return (vec_length(p) - 1) * (1 + 1000 * t * t * (3 - 2 * t));
}
static double bell(Vec p) { return exp(vec_dot(p, p)) - 3; }
static double power_16(Vec p) { return pow(p.x, 16) + pow(p.y, 16) + pow(p.z, 16) - 1; }
static double power_24(Vec p) { return pow(p.x, 24) + pow(p.y / 0.7, 24) + pow(p.z, 4) - 1; }
static double power_32(Vec p) { return pow(p.x, 32) + pow(p.y, 2) + pow(p.z, 32) - 1; }
static double rational(Vec p) { return 1 - 1 / (pow(vec_dot(p, p), 2) + 0.001); }
static double slope(Vec p) { return exp(4 * (p.x + p.y + p.z)) - 1; }
static double weighted(Vec p) { return (vec_length(p) - 1) * exp(5 * p.x); }
static double ring(Vec p)
{
    double distance = hypot(p.x, p.z) - 1;
    return (hypot(distance, p.y) - 0.4) * (1 + 10000 * pow(p.x, 8));
}
static double waves(Vec p) { return sinh(5 * (p.y - 0.3 * sin(2 * p.x))) - 1; }

static const struct Field {
    const char *name, *text;
    Formula    *formula;
} fields[] = {
    {"a ball and a step far from it", "(length(p) - 1) * (1 + 1000 * smoothstep(1.5, 1.6, x))",
     smallest},
    {"a power of e", "exp(x^2 + y^2 + z^2) - 3", bell},
    {"16th powers", "pow(abs(x), 16) + pow(abs(y), 16) + pow(abs(z), 16) - 1", power_16},
    {"24th powers", "pow(abs(x), 24) + pow(abs(y / 0.7), 24) + pow(abs(z), 4) - 1", power_24},
    {"32nd powers", "pow(abs(x), 32) + y^2 + pow(abs(z), 32) - 1", power_32},
    {"a quotient", "1 - 1 / ((x^2 + y^2 + z^2)^2 + 0.001)", rational},
    {"a plane by a power of e", "exp(4 * (x + y + z)) - 1", slope},
    {"a ball times a power of e", "(length(p) - 1) * exp(5 * x)", weighted},
    {"a ring times 10,000 of eighth powers",
     "(length([length([x, z]) - 1, y]) - 0.4) * (1 + 10000 * x^8)", ring},
    {"waves by a hyperbolic sine", "sinh(5 * (y - 0.3 * sin(2 * x))) - 1", waves},
};
enum { FIELDS = sizeof fields / sizeof fields[0] };

static const Vec    eye = {1.9, 2.6, 4.4};
static const double FOV = 50 * 0.017453292519943295;

/* ---- Truth ---- */

/* Returns where a line first comes into the solid within the region; HUGE_VAL: nowhere. */
static double first_root(Formula *formula, Line line)
{
    Chord  chord = chord_of_box(line, vec(-HALF, -HALF, -HALF), vec(HALF, HALF, HALF));
    double step  = (chord.leave - chord.enter) / SAMPLES;
    if (chord_is_empty(chord))
        return HUGE_VAL;
    for (int i = 0; i <= SAMPLES; i++) {
        double high = chord.enter + i * step, low = high - step;
        if (!(formula(line_at(line, high)) <= 0))
            continue;
        for (int k = 0; i > 0 && k < 50; k++) {
            double middle                                         = 0.5 * (low + high);
            *(formula(line_at(line, middle)) <= 0 ? &high : &low) = middle;
        }
        return high;
    }
    return HUGE_VAL;
}

static void find_truth(Formula *formula, Line *rays, double *roots)
{
    Lens lens = lens_make(eye, vec(0, 0, 0), tan(0.5 * FOV), false, WIDTH, HEIGHT);
    for (int k = 0; k < PIXELS; k++) {
        rays[k]  = lens_ray(&lens, k % WIDTH + 0.5, k / WIDTH + 0.5);
        roots[k] = first_root(formula, rays[k]);
    }
}

static double pixel_at(double t) { return 2 * tan(0.5 * FOV) / HEIGHT * t; }

/* Tells whether the pixels around see the same, at about the same depth. */
static bool is_inside(const double *roots, int k)
{
    for (int y = k / WIDTH - 1; y <= k / WIDTH + 1; y++)
        for (int x = k % WIDTH - 1; x <= k % WIDTH + 1; x++) {
            if (x < 0 || y < 0 || x >= WIDTH || y >= HEIGHT)
                return false;
            double there = roots[y * WIDTH + x];
            if (isfinite(there) != isfinite(roots[k]) ||
                (isfinite(there) && fabs(there - roots[k]) > 0.2))
                return false;
        }
    return true;
}

/* ---- Tests ---- */

static Product open_field(const struct Field *field, double planted)
{
    return product_format("show field(%s).within(box([4, 4, 4])).scale(%g);\n"
                          "camera { eye: [%g, %g, %g], target: [0, 0, 0], fov: 50deg }",
                          field->text, planted, eye.x, eye.y, eye.z);
}

/* Pixels away from outlines that show something else than is there; unresolved ones show nothing,
   and no more are missed than are counted. */
static int count_wrong(const KrsPicture *picture, const Line *rays, const double *roots, int *hits)
{
    int wrong = 0, missed = 0;
    *hits = 0;
    for (int k = 0; k < PIXELS; k++) {
        bool is = isfinite(roots[k]), seen = picture->component[k] != 0;
        if (!is_inside(roots, k))
            continue;
        const float *at = &picture->position[3 * k];
        *hits += is;
        missed += is && !seen;
        wrong += seen && !is;
        if (is && seen) {
            double t = vec_distance(vec(at[0], at[1], at[2]), rays[k].origin);
            wrong += !(fabs(t - roots[k]) <= MAX_OFF * pixel_at(t));
        }
    }
    int unresolved = (int)picture->stats.unresolved;
    assert_true(unresolved <= MAX_UNRESOLVED * PIXELS);
    return wrong + (missed > unresolved ? missed - unresolved : 0);
}

static KrsPicture *take(const Product *product, KrsTrace trace)
{
    KrsRenderOptions options = {.width         = WIDTH,
                                .height        = HEIGHT,
                                .samples       = 1,
                                .methods.trace = trace,
                                .aovs          = KRS_AOV_POSITION | KRS_AOV_IDS};
    KrsRendering    *rendering;
    KrsPicture      *picture = NULL;
    if (krs_rendering_new(renderer, product->scene, KRS_FOR_PICTURES, &rendering) != KRS_OK ||
        krs_render(rendering, product->state, &options, &picture) != KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
    krs_rendering_free(rendering);
    return picture;
}

static void pictures_show_roots(void **state)
{
    const struct Field *field = *state;
    static Line         rays[PIXELS];
    static double       roots[PIXELS];
    Product             product = open_field(field, 1);
    int                 hits;
    find_truth(field->formula, rays, roots);
    for (KrsTrace trace = KRS_TRACE_PLAIN; trace <= KRS_TRACE_AUTO; trace++) {
        if (trace != KRS_TRACE_AUTO && field >= fields + 3)
            continue;
        KrsPicture *picture = take(&product, trace);
        int         wrong   = count_wrong(picture, rays, roots, &hits);
        if (wrong > 0 || hits < 200)
            fail_msg("%s by %s: of %d hits %d pixels are wrong, %llu are unresolved", field->name,
                     krs_trace_names[trace], hits, wrong,
                     (unsigned long long)picture->stats.unresolved);
        krs_picture_free(picture);
    }
    product_free(&product);
}

static void rays_end_at_roots(void **state)
{
    const struct Field *field = *state;
    static Line         rays[PIXELS];
    static double       roots[PIXELS];
    Product             product = open_field(field, 1);
    int                 asked = 0, unresolved = 0;
    find_truth(field->formula, rays, roots);
    for (int k = 0; k < PIXELS; k += 7) {
        if (!is_inside(roots, k))
            continue;
        KrsHit hit = product_raycast(&product, rays[k].origin, rays[k].direction, 20, 1e-6);
        asked++;
        unresolved += hit.unresolved;
        if (!hit.unresolved &&
            (hit.hit != isfinite(roots[k]) || (hit.hit && !(fabs(hit.t - roots[k]) <= 1e-4))))
            fail_msg("%s: the ray of pixel %d ends at %g, its root is at %g", field->name, k, hit.t,
                     roots[k]);
    }
    if (asked < 300 || unresolved > MAX_UNRESOLVED * asked)
        fail_msg("%s: of %d rays %d are unresolved", field->name, asked, unresolved);
    product_free(&product);
}

/* A solid that is a fiftieth too large is found out. */
static void a_planted_fault_is_seen(void **state)
{
    static Line   rays[PIXELS];
    static double roots[PIXELS];
    Product       product = open_field(&fields[0], 1.02);
    KrsPicture   *picture = take(&product, KRS_TRACE_DEFAULT);
    int           hits;
    (void)state;
    find_truth(fields[0].formula, rays, roots);
    assert_true(count_wrong(picture, rays, roots, &hits) > 100);
    krs_picture_free(picture);
    product_free(&product);
}

int main(void)
{
    struct CMUnitTest tests[2 * FIELDS + 1];
    static char       names[FIELDS][80];
    size_t            count = 0;
    for (size_t i = 0; i < FIELDS; i++) {
        void *field = (void *)(uintptr_t)&fields[i];
        snprintf(names[i], sizeof names[i], "%s, asked on the host", fields[i].name);
        tests[count++] = (struct CMUnitTest){fields[i].name, pictures_show_roots, NULL, NULL,
                                             field};
        tests[count++] = (struct CMUnitTest){names[i], rays_end_at_roots, NULL, NULL, field};
    }
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(a_planted_fault_is_seen);
    return _cmocka_run_group_tests("steep", tests, count, renderer_open, renderer_close);
}
