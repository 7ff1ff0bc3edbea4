/*
 * Pictures of random chains and rays through them, by the device, against points that are undone by
 * hand.
 *
 * The ray of every pixel is built from the camera's definition and walked in small steps: where
 * chain.h first says "inside" is what the picture must show.  A pixel next to an outline, or to a
 * jump of depth, may show either side.  Rays that are asked for start anywhere, most of them next
 * to the surface, and must end within the tolerance of where a walk along them meets it.
 */
#include "tests/oracle/chain.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/target/spirv.h"
#include "tests/support/renderer.h"

enum { WIDTH = 64, HEIGHT = 48, PIXELS = WIDTH * HEIGHT };

typedef struct View {
    Vec    eye, forward, right, up;
    double half, farthest; /* the tangent of half the angle; of rays */
} View;

static View view_of(Vec low, Vec high, Random *random)
{
    Vec    middle = vec_mix(low, high, 0.5), direction = random_unit(random);
    double radius = 0.5 * vec_distance(low, high);
    View   view   = {.half = tan(0.35), .farthest = 5 * radius};
    view.eye      = vec_add(middle, vec_scale(2.9 * radius, direction));
    view.forward  = vec_scale(-1, direction);
    view.right    = vec_unit(vec_cross(view.forward, vec(0, 1, 0)));
    view.up       = vec_cross(view.right, view.forward);
    return view;
}

static Vec direction_of(const View *view, int i, int j)
{
    double u = ((i + 0.5) / WIDTH * 2 - 1) * view->half * WIDTH / HEIGHT;
    double v = (1 - (j + 0.5) / HEIGHT * 2) * view->half;
    return vec_unit(
        vec_add(view->forward, vec_add(vec_scale(u, view->right), vec_scale(v, view->up))));
}

/* Along the view axis; HUGE_VAL: nothing is there. */
static double depth_of(const Chain *chain, const View *view, int i, int j)
{
    enum { STEPS = 500, HALVINGS = 30 };
    Vec    direction = direction_of(view, i, j);
    double step      = view->farthest / STEPS;
    for (int k = 1; k <= STEPS; k++) {
        double low = (k - 1) * step, high = k * step;
        if (!chain_contains(chain, vec_add(view->eye, vec_scale(high, direction))))
            continue;
        for (int n = 0; n < HALVINGS; n++) {
            double middle = 0.5 * (low + high);
            if (chain_contains(chain, vec_add(view->eye, vec_scale(middle, direction))))
                high = middle;
            else
                low = middle;
        }
        return high * vec_dot(direction, view->forward);
    }
    return HUGE_VAL;
}

/* Tells whether the pixels around see about the same as one. */
static bool is_even(const double *depths, int i, int j)
{
    double here = depths[j * WIDTH + i];
    for (int y = j - 1; y <= j + 1; y++)
        for (int x = i - 1; x <= i + 1; x++) {
            if (x < 0 || y < 0 || x >= WIDTH || y >= HEIGHT)
                return false;
            double there = depths[y * WIDTH + x];
            if (isinf(there) != isinf(here) || fabs(there - here) > 0.02 * here)
                return false;
        }
    return true;
}

/* Tells whether the solid comes within a pixel of where a picture shows it: it may be thinner than the
   steps of depth_of. */
static bool is_there(const Chain *chain, const View *view, int i, int j, double depth)
{
    Random random    = {(uint64_t)(j * WIDTH + i)};
    Vec    direction = direction_of(view, i, j);
    double t         = depth / vec_dot(direction, view->forward);
    double pixel     = 2 * view->half / HEIGHT * t;
    Vec    p         = vec_add(view->eye, vec_scale(t, direction));
    for (int k = 0; k < 1000; k++)
        if (chain_contains(chain, random_in_ball(&random, p, pixel)))
            return true;
    return false;
}

typedef struct Tally {
    int pictures, hits, even, missed, extra, deep, wrong;
} Tally;

static void compare(const Chain *chain, const KrsPicture *picture, const View *view,
                    const double *depths, const char *text, Tally *tally)
{
    int missed = 0, extra = 0, deep = 0;
    for (int k = 0; k < PIXELS; k++) {
        int    i = k % WIDTH, j = k / WIDTH;
        double depth = picture->depth[k], truth = depths[k];
        bool   hit   = picture->component[k] != 0;
        double pixel = 2 * view->half / HEIGHT * (isinf(truth) ? depth : truth);
        tally->hits += !isinf(truth);
        if (!is_even(depths, i, j))
            continue;
        tally->even++;
        if (hit && depth < truth - 4 * pixel && is_there(chain, view, i, j, depth))
            continue;
        missed += !isinf(truth) && !hit;
        extra += isinf(truth) && hit;
        deep += !isinf(truth) && hit && fabs(depth - truth) > 4 * pixel;
    }
    tally->missed += missed;
    tally->extra += extra;
    tally->deep += deep;
    if (missed + extra + deep > 0) {
        fprintf(stderr, "# %d pixels missed, %d extra, %d off, eye [%.9g, %.9g, %.9g]\n%s", missed,
                extra, deep, view->eye.x, view->eye.y, view->eye.z, text);
        tally->wrong++;
    }
}

static void look_at(const Chain *chain, Random *random, Tally *tally)
{
    static SceneText text;
    static double    depths[PIXELS];
    text.length = 0;
    chain_write(chain, &text);
    Product product = product_compile(text.bytes);
    Vec     low, high;
    bool    bounded = chain_box(&product, &low, &high);
    product_free(&product);
    if (!bounded)
        low = vec(-3, -3, -3), high = vec(3, 3, 3);
    View view   = view_of(low, high, random);
    Vec  target = vec_add(view.eye, view.forward);
    if (chain_contains(chain, view.eye))
        return;
    scene_write(&text,
                "camera { eye: [%.17g, %.17g, %.17g], target: [%.17g, %.17g, %.17g], "
                "fov: 0.7 }\n",
                view.eye.x, view.eye.y, view.eye.z, target.x, target.y, target.z);
    KrsRenderOptions options = {
        .width = WIDTH, .height = HEIGHT, .samples = 1, .aovs = KRS_AOV_DEPTH | KRS_AOV_IDS};
    KrsPicture *picture = picture_of(text.bytes, &options);
    for (int k = 0; k < PIXELS; k++)
        depths[k] = depth_of(chain, &view, k % WIDTH, k / WIDTH);
    compare(chain, picture, &view, depths, text.bytes, tally);
    tally->pictures++;
    krs_picture_free(picture);
}

/* ---- rays ---- */

enum { RAYS = 400 };

typedef struct RayTally {
    int scenes, rays, hits, unresolved, late, early;
} RayTally;

static Vec between(Random *random, Vec low, Vec high)
{
    return vec(random_between(random, low.x, high.x), random_between(random, low.y, high.y),
               random_between(random, low.z, high.z));
}

/* Returns the first place of a segment where its sides differ, in equal steps; 1: nowhere. */
static double change_along(const Chain *chain, Vec from, Vec to)
{
    enum { STEPS = 600, HALVINGS = 40 };
    bool inside = chain_contains(chain, from);
    for (int k = 1; k <= STEPS; k++) {
        double low = (k - 1.0) / STEPS, high = (double)k / STEPS;
        if (chain_contains(chain, vec_mix(from, to, high)) == inside)
            continue;
        for (int n = 0; n < HALVINGS; n++) {
            double middle = 0.5 * (low + high);
            if (chain_contains(chain, vec_mix(from, to, middle)) == inside)
                low = middle;
            else
                high = middle;
        }
        return high;
    }
    return 1;
}

/* Returns a place next to the surface, if a random segment meets it. */
static Vec random_origin(const Chain *chain, Vec low, Vec high, Random *random)
{
    Vec    from = between(random, low, high), to = between(random, low, high);
    double at = change_along(chain, from, to), reach = pow(10, random_between(random, -8, 0));
    return vec_add(vec_mix(from, to, at), vec_scale(at < 1 ? reach : 0, random_unit(random)));
}

static bool surface_is_near(const Chain *chain, Vec p, double reach, Random *random)
{
    bool inside = chain_contains(chain, p);
    for (int i = 0; i < 3000; i++)
        if (chain_contains(chain, random_in_ball(random, p, reach)) != inside)
            return true;
    return false;
}

/* Tells whether a ray has passed a place that is farther from its first side than allowed. */
static bool is_passed(const Chain *chain, Vec o, Vec d, double from, double to, double allowed,
                      Random *random)
{
    enum { PLACES = 16 };
    bool inside = chain_contains(chain, o);
    for (int i = 0; i <= PLACES; i++) {
        Vec p = vec_add(o, vec_scale(from + (to - from) * i / PLACES, d));
        if (chain_contains(chain, p) != inside && !surface_is_near(chain, p, allowed, random))
            return true;
    }
    return false;
}

static void check_rays(const Chain *chain, const SceneText *text, const Product *product, Vec low,
                       Vec high, Random *random, RayTally *tally)
{
    static double origins[RAYS][3], directions[RAYS][3];
    static KrsHit hits[RAYS];
    const double  tolerance = 1e-4, allowed = 4 * tolerance, farthest = vec_distance(low, high);
    KrsRendering *rendering;
    for (int i = 0; i < RAYS; i++) {
        Vec o = random_origin(chain, low, high, random);
        Vec d = vec_unit(vec_sub(between(random, low, high), o));
        memcpy(origins[i], (double[]){o.x, o.y, o.z}, sizeof *origins);
        memcpy(directions[i], (double[]){d.x, d.y, d.z}, sizeof *directions);
    }
    assert_int_equal(krs_rendering_new(renderer, product->scene, KRS_FOR_QUESTIONS, &rendering),
                     KRS_OK);
    assert_int_equal(krs_device_raycast(rendering, product->state, (const double(*)[3])origins,
                                        (const double(*)[3])directions, RAYS, farthest, tolerance,
                                        hits),
                     KRS_OK);
    krs_rendering_free(rendering);
    int late = 0, early = 0;
    for (int i = 0; i < RAYS; i++) {
        Vec    o       = vec(origins[i][0], origins[i][1], origins[i][2]);
        Vec    d       = vec(directions[i][0], directions[i][1], directions[i][2]);
        double change  = farthest * change_along(chain, o, vec_add(o, vec_scale(farthest, d)));
        double t       = hits[i].hit || hits[i].unresolved ? hits[i].t : farthest;
        bool   is_late = t > change + allowed && is_passed(chain, o, d, change, t, allowed, random);
        bool   is_early = hits[i].hit && t < change - allowed &&
                        !surface_is_near(chain, vec_add(o, vec_scale(t, d)), allowed, random);
        if ((is_late || is_early) && late + early == 0)
            fprintf(stderr,
                    "# %s ray from (%.9g, %.9g, %.9g) along (%.9g, %.9g, %.9g): %.9g, in "
                    "truth %.9g\n%s",
                    is_late ? "late" : "early", o.x, o.y, o.z, d.x, d.y, d.z, t, change,
                    text->bytes);
        late += is_late;
        early += is_early;
        tally->hits += hits[i].hit;
        tally->unresolved += hits[i].unresolved;
    }
    tally->rays += RAYS;
    tally->late += late;
    tally->early += early;
    tally->scenes++;
}

static uint64_t setting(const char *name, uint64_t otherwise)
{
    const char *text = getenv(name);
    return text ? strtoull(text, NULL, 10) : otherwise;
}

static void pictures_are_right(void **state)
{
    static const Recipe recipes[] = {
        {3, 0, false, 0},
        {3, 0, false, 1u << LINK_MOVE | 1u << LINK_TURN | 1u << LINK_BEND},
        {2, 2, false, 0},
    };
    enum { RECIPES = sizeof recipes / sizeof *recipes };
    (void)state;
    Tally    tally    = {0};
    Refusals refusals = {0};
    uint64_t seed = setting("SEED", 1), count = setting("CHAINS", 9);
    for (uint64_t i = 0; i < count; i++) {
        Random random = {seed * 1000000 + i};
        Chain  chain;
        chain_random(&chain, &recipes[i % RECIPES], &random, &refusals);
        look_at(&chain, &random, &tally);
    }
    print_message("# %d pictures, %d hits, %d pixels compared: %d missed, %d extra, %d off\n",
                  tally.pictures, tally.hits, tally.even, tally.missed, tally.extra, tally.deep);
    if (tally.wrong)
        fail_msg("%d of %d pictures are wrong", tally.wrong, tally.pictures);
}

static void rays_are_right(void **state)
{
    static const Recipe recipes[] = {
        {3, 1, false, 1u << LINK_MOVE | 1u << LINK_INVERT | 1u << LINK_TURN},
        {3, 0, false, 0},
        {4, 0, false, 1u << LINK_MOVE | 1u << LINK_BEND | 1u << LINK_MIRROR},
        {2, 2, false, 0},
    };
    enum { RECIPES = sizeof recipes / sizeof *recipes };
    static SceneText text;
    (void)state;
    RayTally tally    = {0};
    Refusals refusals = {0};
    uint64_t seed = setting("SEED", 2), count = setting("CHAINS", 8);
    for (uint64_t i = 0; i < count; i++) {
        Random random = {seed * 1000000 + i};
        Chain  chain;
        Vec    low, high;
        chain_random(&chain, &recipes[i % RECIPES], &random, &refusals);
        text.length = 0;
        chain_write(&chain, &text);
        Product product = product_compile(text.bytes);
        if (!chain_box(&product, &low, &high))
            low = vec(-3, -3, -3), high = vec(3, 3, 3);
        Vec margin = vec_scale(0.2, vec_sub(high, low));
        if (vec_length(margin) > 0)
            check_rays(&chain, &text, &product, vec_sub(low, margin), vec_add(high, margin),
                       &random, &tally);
        product_free(&product);
    }
    print_message("# %d scenes, %d rays, %d hits: %d late, %d early, %d unresolved\n", tally.scenes,
                  tally.rays, tally.hits, tally.late, tally.early, tally.unresolved);
    assert_int_equal(tally.late + tally.early, 0);
    assert_true(tally.unresolved * 200 <= tally.rays);
}

int main(int count, char **words)
{
    if (count > 1)
        cmocka_set_test_filter(words[1]);
    const struct CMUnitTest tests[] = {cmocka_unit_test(pictures_are_right),
                                       cmocka_unit_test(rays_are_right)};
    return cmocka_run_group_tests_name("pictures of chains", tests, renderer_open, renderer_close);
}
