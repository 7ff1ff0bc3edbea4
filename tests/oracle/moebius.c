/*
 * moebius.c: sequences with conformal maps against the same sets as clouds of points.
 *
 * Random chains of kernels, mirrors and maps, nested and placed by maps, near poles and far from
 * them.  The distance of the compiler must never exceed the distance to any point of the cloud, be
 * positive outside and only there; rays must end where the set begins; the box must hold all
 * points.  That the clouds are dense enough to notice is shown by the distance without the bound,
 * which they must refute.
 */
#include "tests/oracle/judge.h"
#include "tests/oracle/map_chain.h"

#include <stdio.h>

typedef struct Tally {
    int    outside, naive_refuted, identified, bounded, chains;
    double tightness; /* sum of distance over the cloud's */
} Tally;

/* Checks the box, the cloud and a point: everything that is asked of a distance. */
static void check_point(const Product *product, const Chain *chain, Cloud *cloud, Vec p,
                        Tally *tally)
{
    double  distance = product_distance(product, p), truth = cloud_nearest(cloud, p);
    double  size = 1 + vec_length(p);
    Nearest nearest;
    naive_distance(chain, p, 1, &nearest);
    if (nearest.naive <= 0) {
        if (!(distance <= 1e-9 * size))
            fail_msg("distance %.12g inside", distance);
        return;
    }
    if (!(distance > 0) && nearest.naive > 1e-9 * size)
        fail_msg("distance %.12g outside, %.3g from the surface", distance, nearest.naive);
    if (!(distance <= truth + 1e-9 * size))
        fail_msg("distance %.12g is above the true %.12g", distance, truth);
    tally->outside++;
    tally->naive_refuted += nearest.naive > truth * (1 + 1e-9) + 1e-9 * size;
    tally->tightness += fmin(1, distance / truth);
}

/* Level and instance of a point well inside of one kernel. */
static void check_identity(const Product *product, const Chain *chain, Vec p, Tally *tally)
{
    Nearest nearest;
    naive_distance(chain, p, 1, &nearest);
    KrsHit hit = product_probe(product, p);
    if (nearest.naive > 1e-7 || !(fabs(hit.distance) < 1e-7))
        return; /* another kernel covers the point */
    tally->identified++;
    if (hit.level != nearest.level || hit.instance != nearest.id)
        fail_msg("level %u, instance %u should be %u, %u", hit.level, hit.instance, nearest.level,
                 nearest.id);
}

static void check_box(const Product *product, const Cloud *cloud, Tally *tally)
{
    KrsComponent component;
    assert_int_equal(krs_component(product->scene, 0, &component), KRS_OK);
    for (size_t i = 0; i < cloud->count; i++) {
        Vec    v    = cloud->points[i];
        double p[3] = {v.x, v.y, v.z}, slack = 1e-9 * (1 + vec_length(v));
        for (int k = 0; k < 3; k++)
            if (!(p[k] >= component.low[k] - slack && p[k] <= component.high[k] + slack))
                fail_msg("%.12g is outside of the box, %.12g to %.12g", p[k], component.low[k],
                         component.high[k]);
    }
    tally->bounded += isfinite(component.low[0]) && isfinite(component.high[0]);
    tally->chains++;
}

/* A hit is on the surface, and no later than the first of many samples that is inside. */
static int check_ray(const Product *product, const Chain *chain, Vec origin, Vec target)
{
    const double farthest = 12, tolerance = 1e-7;
    const int    samples   = 1500;
    Vec          direction = vec_unit(vec_sub(target, origin));
    double       entry     = HUGE_VAL;
    if (map_chain_contains(chain, origin))
        return 0;
    for (int i = 0; i < samples && entry == HUGE_VAL; i++) {
        double t = farthest * i / samples;
        if (map_chain_contains(chain, vec_add(origin, vec_scale(t, direction))))
            entry = t;
    }
    KrsHit hit = product_raycast(product, origin, direction, farthest, tolerance);
    if (entry < farthest && !(hit.hit && hit.t <= entry + 2 * tolerance))
        fail_msg("the ray ends at %.12g, behind %.12g", hit.hit ? hit.t : HUGE_VAL, entry);
    if (!hit.hit)
        return 0;
    /* The distance without the bound is right to first order, next to the surface. */
    Vec    point = vec_add(origin, vec_scale(hit.t, direction));
    double left  = naive_distance(chain, point, 1, NULL);
    if (!(left <= 1e-5))
        fail_msg("the ray ends %.6g before the surface", left);
    return 1;
}

static void chains(void **state)
{
    const Flavour *flavour = *state;
    Random         random  = {flavour->seed};
    Tally          tally   = {0};
    int            hits    = 0;
    for (int repeat = 0; repeat < flavour->chains; repeat++) {
        Flavour innermost = *flavour;
        innermost.nested  = false;
        Chain   inner     = random_chain(&innermost, NULL, &random);
        Chain   chain     = random_chain(flavour, flavour->nested ? &inner : NULL, &random);
        Product product   = compile_chain(&chain);
        Cloud   cloud     = chain_cloud(&chain, flavour->levels > 4 ? 400 : 1500, &random);
        if (cloud.count) {
            check_box(&product, &cloud, &tally);
            for (int i = 0; i < 150; i++)
                check_point(&product, &chain, &cloud,
                            i % 3 ? random_near(&cloud, &random) : random_in_cube(&random, 3),
                            &tally);
            for (int i = 0; i < 20 && !flavour->nested; i++)
                check_identity(&product, &chain,
                               cloud.points[random_below(&random, (int)cloud.count)], &tally);
            for (int i = 0; i < 10; i++)
                hits += check_ray(&product, &chain, vec_scale(5, random_unit(&random)),
                                  random_near(&cloud, &random));
        }
        cloud_free(&cloud);
        product_free(&product);
    }
    print_message("# %s: %d points outside, mean %.2f of the true distance, %d refute the plain "
                  "quotient; %d of %d bounded; %d hits, %d copies named\n",
                  flavour->name, tally.outside, tally.tightness / tally.outside,
                  tally.naive_refuted, tally.bounded, tally.chains, hits, tally.identified);
    assert_true(tally.chains > flavour->chains / 2 && hits > flavour->chains / 2);
    assert_true(tally.tightness > 0.2 * tally.outside);
    assert_true(flavour->nested || tally.identified > flavour->chains);
    /* The same points find the fault when the bound is left out. */
    if (flavour->inverting > 0)
        assert_true(tally.naive_refuted * 100 > tally.outside);
    else
        assert_int_equal(tally.naive_refuted, 0);
}

static void slope_and_empty_balls(void **state)
{
    const Flavour *flavour = *state;
    Random         random  = {flavour->seed + 100};
    for (int repeat = 0; repeat < 3; repeat++) {
        Chain   chain   = random_chain(flavour, NULL, &random);
        Product product = compile_chain(&chain);
        Trial   trial   = {product_field, &product,     map_chain_contains, &chain, vec(0, 0, 0), 2,
                           1000,          flavour->seed};
        judge_acquits(&trial, flavour->name);
        product_free(&product);
    }
}

/* ---- poles ---- */

/* Where the inversion in a statement takes infinity, after the statements that follow; false when
   it has none or a mirror drops the place. */
static bool world_pole(const Chain *chain, int statement, Vec *pole)
{
    const Word *word  = &chain->statements[statement].map;
    bool        found = false;
    if (chain->statements[statement].kind != MAP)
        return false;
    for (int i = 0; i < word->count; i++) {
        const Elementary *l = &word->letters[i];
        *pole               = l->kind == INVERT ? l->vector : elementary_apply(l, *pole, false);
        found               = found || l->kind == INVERT;
    }
    for (int i = statement + 1; found && i < chain->count; i++) {
        const Statement *s = &chain->statements[i];
        if (s->kind == MIRROR)
            found = half_excess(s->mirror, *pole) <= 0;
        if (s->kind == MAP)
            *pole = word_apply(&s->map, *pole);
    }
    return found && vec_length(*pole) < 100;
}

/* Next to a pole, where the maps overflow, there is a distance, and it is that to the set: a pole
   is no point of the surface. */
static void poles_are_empty(void **state)
{
    Random random = {77};
    int    poles = 0, near_nothing = 0;
    double tightness = 0;
    (void)state;
    for (int repeat = 0; repeat < 40; repeat++) {
        const Flavour *flavour = &flavours[repeat % 4 < 3 ? repeat % 4 : 6];
        Chain          chain   = random_chain(flavour, NULL, &random);
        Product        product = compile_chain(&chain);
        Cloud          cloud   = chain_cloud(&chain, 1000, &random);
        for (int i = 0; i < chain.count; i++) {
            Vec pole = vec(0, 0, 0);
            if (!cloud.count || !world_pole(&chain, i, &pole))
                continue;
            Vec    lateral = vec_add(pole, vec_scale(1e-7, random_unit(&random)));
            double truth   = cloud_nearest(&cloud, pole);
            if (!(truth > 1e-2) || map_chain_contains(&chain, lateral))
                continue;
            for (double gap = 1e-3; gap > 1e-13; gap *= 0.1) {
                Vec    p = vec_add(pole, vec_scale(gap > 1e-12 ? gap : 0, random_unit(&random)));
                double distance = product_distance(&product, p);
                if (!(distance > 0 && distance <= truth + gap))
                    fail_msg("distance %.12g at %g from a pole, %.12g from the set", distance, gap,
                             truth);
            }
            double part = product_distance(&product, pole) / truth;
            near_nothing += part < 0.05; /* what no ball is around */
            tightness += part;
            poles++;
        }
        cloud_free(&cloud);
        product_free(&product);
    }
    print_message("# %d poles, mean %.2f of the true distance, next to nothing at %d\n", poles,
                  tightness / poles, near_nothing);
    assert_true(poles > 30 && tightness > 0.5 * poles && near_nothing * 25 < poles);
}

/* What moves the zero set does so at the set, not at the pole; the image of this ball is the
   ball of radius 0.5 / 0.75 about (0, 1 / 0.75, 0). */
static void offsets_do_not_show_poles(void **state)
{
    const char *ball   = "sphere(0.5).move([0, 1, 0]).transform(invert())";
    Random      random = {78};
    (void)state;
    Product plain  = product_format("show %s;", ball);
    Product grown  = product_format("show %s.offset(0.1);", ball);
    Product joined = product_format("show union(%s, sphere(0.1).move([0, -0.3, 0]), blend: 0.3);",
                                    ball);
    for (int i = 0; i < 3000; i++) {
        Vec    p     = random_in_cube(&random, i % 2 ? 0.3 : 2);
        double truth = vec_distance(p, vec(0, 1 / 0.75, 0)) - 0.5 / 0.75;
        double other = vec_distance(p, vec(0, -0.3, 0)) - 0.1;
        assert_true(truth <= 0 || product_distance(&plain, p) <= truth + 1e-12);
        assert_true(truth <= 0.25 || product_distance(&grown, p) > 0);
        assert_true(truth <= 0.4 || other <= 0.15 || product_distance(&joined, p) > 0);
    }
    assert_true(product_distance(&grown, vec(0, 0, 0)) > 0.1);
    assert_true(product_distance(&joined, vec(0, 0.1, 0)) > 0.1);
    product_free(&plain);
    product_free(&grown);
    product_free(&joined);
}

/* Returns a chain in which everything moves; at 0.5 the poles of the two inversions meet. */
static Chain moving_chain(double t)
{
    Chain  chain = {.count = 0};
    Kernel ball  = {
         .from = {0.2, 0.1, 0}, .to = {0.2, 0.1, 0}, .axis = {0, 0, 1}, .radius = 0.3 + 0.1 * t};
    Kernel    rod = {.from = {0, 0, 0}, .to = {0.3, 0.5, 0.1}, .axis = {0, 0, 1}, .radius = 0.1};
    Statement statements[6] = {{.kind = KERNEL, .kernel = ball},
                               {.kind = MIRROR, .mirror = {{1, 0, 0}, 0.3 - 0.2 * t}},
                               {.kind = MAP},
                               {.kind = MAP},
                               {.kind = KERNEL, .kernel = rod},
                               {.kind = MIRROR, .mirror = {{0, 0, 1}, 0.2}}};
    word_add(&statements[2].map, ROTATE, vec(0, 1, 0), t);
    word_add(&statements[2].map, INVERT, vec(0, -2 + t, 0.3), 2);
    word_add(&statements[3].map, INVERT, vec(0.2 * t - 0.1, -1.5, 0.3), 1 + t);
    word_add(&statements[3].map, SCALE, vec(0, 0, 0), 1 - 0.3 * t);
    for (int i = 0; i < 6; i++)
        chain.statements[chain.count++] = statements[i];
    chain.mirrors = 2;
    return chain;
}

static void parameters_move_poles(void **state)
{
    Product product = product_compile(
        "param t = 0 in [-0.5, 0.9];"
        "show krs { kernel sphere(0.3 + 0.1 * t).move([0.2, 0.1, 0]);"
        "    reflect plane([1, 0, 0], 0.3 - 0.2 * t);"
        "    mobius invert([0, t - 2, 0.3], 2) * rotate([0, 1, 0], t);"
        "    mobius scale(1 - 0.3 * t) * invert([0.2 * t - 0.1, -1.5, 0.3], 1 + t);"
        "    kernel capsule([0, 0, 0], [0.3, 0.5, 0.1], 0.1); reflect plane([0, 0, 1], 0.2); };");
    Random random = {79};
    Tally  tally  = {0};
    (void)state;
    for (int i = 0; i <= 28; i++) {
        double t     = fmin(-0.5 + 0.05 * i, 0.9);
        Chain  chain = moving_chain(t);
        Cloud  cloud = chain_cloud(&chain, 2000, &random);
        assert_int_equal(krs_state_set(product.state, "t", &t, 1), KRS_OK);
        check_box(&product, &cloud, &tally);
        for (int k = 0; k < 200; k++)
            check_point(&product, &chain, &cloud,
                        k % 3 ? random_near(&cloud, &random) : random_in_cube(&random, 3), &tally);
        cloud_free(&cloud);
    }
    print_message("# %d points outside, mean %.2f of the true distance\n", tally.outside,
                  tally.tightness / tally.outside);
    assert_true(tally.outside > 2000 && tally.naive_refuted > 100);
    assert_true(tally.tightness > 0.3 * tally.outside);
    product_free(&product);
}

/* A pole that moves out of the ball that it inverts: what is around it has no inside, then no
   outside, and the pole at t is never on the surface. */
static void pole_leaves_the_set(void **state)
{
    Product product = product_compile("param t = 1 in [0.1, 3];"
                                      "show sphere(0.5).transform(invert([t, 0, 0], 1));");
    Random  random  = {80};
    (void)state;
    for (int i = 0; i <= 29; i++) {
        double t = fmin(0.1 + 0.1 * i, 3), d = t * t - 0.25;
        assert_int_equal(krs_state_set(product.state, "t", &t, 1), KRS_OK);
        for (int k = 0; k < 300 && fabs(d) > 1e-6; k++) {
            Vec    p        = k ? random_in_cube(&random, k % 2 ? 5 : 1) : vec(t, 0, 0);
            double truth    = vec_distance(p, vec(t - t / d, 0, 0)) - 0.5 / fabs(d);
            truth           = d < 0 ? -truth : truth;
            double distance = product_distance(&product, p);
            assert_true((distance <= 0) == (truth <= 0));
            if (truth > 0 && !(distance <= truth + 1e-12 && (k || distance > 0.1 * truth)))
                fail_msg("distance %.12g, in truth %.12g, for t = %g", distance, truth, t);
        }
    }
    product_free(&product);
}

int main(void)
{
    struct CMUnitTest tests[2 * FLAVOURS + 4];
    char              names[2 * FLAVOURS][80];
    size_t            count = 0;
    for (const Flavour *f = flavours; f < flavours + FLAVOURS; f++) {
        snprintf(names[count], sizeof names[count], "%s", f->name);
        tests[count] = (struct CMUnitTest){names[count], chains, NULL, NULL, (void *)(uintptr_t)f};
        count++;
        if (f->nested)
            continue;
        snprintf(names[count], sizeof names[count], "slope, balls: %s", f->name);
        tests[count] = (struct CMUnitTest){names[count], slope_and_empty_balls, NULL, NULL,
                                           (void *)(uintptr_t)f};
        count++;
    }
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(poles_are_empty);
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(offsets_do_not_show_poles);
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(parameters_move_poles);
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(pole_leaves_the_set);
    return _cmocka_run_group_tests("conformal maps", tests, count, NULL, NULL);
}
