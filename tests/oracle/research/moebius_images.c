/*
 * moebius_images.c: steps along rays through conformal maps, and balls that are said to be empty,
 * against clouds of points (map_chain.h).
 */
#include "compiler/scene/program.h"
#include "tests/oracle/map_chain.h"

#include <stdio.h>

/* What is marched by instead of the distance: compiler/lower/research/ray_images.c. */
typedef struct Asked {
    Product product;
    Node    root;
    Tape    tape;
} Asked;

static Asked asked_new(Product product, ResearchMethod method)
{
    KrsScene *scene = product.scene;
    Asked     asked = {product, research_roots(&scene->roots, method)[0], {0}};
    asked.tape      = tape_new(scene->graph, &asked.root, 1, &scene->arena);
    state_refresh(product.state);
    tape_run_frame(&asked.tape, product.state->parameters, product.state->values);
    return asked;
}

static double ask(const Asked *asked, Vec p, Vec direction, double radius)
{
    double at[3] = {p.x, p.y, p.z}, v[3] = {direction.x, direction.y, direction.z};
    tape_run_surface(&asked->tape, at, v, radius, asked->product.state->values);
    return asked->product.state->values[asked->root].v[0];
}

/* Tells whether something of the chain is on the segment of this length, but for its last millionth. */
static bool meets(const Chain *chain, Vec p, Vec direction, double length, int samples)
{
    for (int i = 0; i < samples; i++) {
        double t = (1 - 1e-6) * length * (i + 0.5) / samples;
        if (map_chain_contains(chain, vec_add(p, vec_scale(t, direction))))
            return true;
    }
    return map_chain_contains(chain, vec_add(p, vec_scale((1 - 1e-6) * length, direction)));
}

typedef struct Progress {
    int    steps, longer;              /* than by the distance */
    int    rays, directional, centred; /* evaluations of all rays */
    int    balls, empty, centred_empty;
    double gain;
} Progress;

/* Checks one step from a point outside, as far as 20. */
static void check_step(const Asked *asked, const Chain *chain, Vec p, Vec direction,
                       Progress *progress)
{
    double step = ask(asked, p, direction, 0), distance = product_distance(&asked->product, p);
    if (map_chain_contains(chain, p)) {
        assert_true(step <= 1e-9);
        return;
    }
    if (!(step >= distance * (1 - 1e-9)))
        fail_msg("a step of %.12g is shorter than the distance, %.12g", step, distance);
    if (meets(chain, p, direction, fmin(step, 20), 60))
        fail_msg("a step of %.12g, by the distance %.12g, leads through the set", step, distance);
    progress->steps++;
    progress->longer += step > 1.01 * distance;
    progress->gain += fmin(step / distance, 10);
}

/* Marches until the step is short; the end is no later than what samples find of the set. */
static void check_march(const Asked *asked, const Chain *chain, Vec origin, Vec target,
                        Progress *progress)
{
    const double farthest = 12, tolerance = 1e-6;
    Vec          direction = vec_unit(vec_sub(target, origin)), p = origin;
    double       step = 1, t = 0;
    if (map_chain_contains(chain, origin))
        return;
    progress->rays++;
    for (int i = 0; i < 1000 && t < farthest && step > tolerance; i++) {
        step = ask(asked, p, direction, 0);
        t += step;
        p = vec_add(origin, vec_scale(t, direction));
        progress->directional++;
    }
    if (meets(chain, origin, direction, fmin(t, farthest) - 2 * tolerance, 1500))
        fail_msg("the march to %.12g leads through the set", t);
    if (t < farthest && !(naive_distance(chain, p, 1, NULL) <= 1e-4))
        fail_msg("the march ends at %.12g, %.3g before the set", t,
                 naive_distance(chain, p, 1, NULL));
    for (t = 0, step = 1; t < farthest && step > tolerance; t += step) {
        step = product_distance(&asked->product, vec_add(origin, vec_scale(t, direction)));
        progress->centred++;
    }
}

static void check_ball(const Asked *asked, const Chain *chain, Cloud *cloud, Vec centre,
                       double radius, Random *random, Progress *progress)
{
    Vec  none  = vec(0, 0, 0);
    bool empty = ask(asked, centre, none, radius) > radius;
    progress->balls++;
    progress->empty += empty;
    if (empty && !(cloud_nearest(cloud, centre) >= radius * (1 - 1e-9)))
        fail_msg("the ball of radius %.12g is not empty", radius);
    for (int i = 0; empty && i < 30; i++)
        if (map_chain_contains(chain, random_in_ball(random, centre, radius * (1 - 1e-9))))
            fail_msg("the ball of radius %.12g is not empty", radius);
    radius = 0.999 * product_distance(&asked->product, centre);
    if (radius > 0)
        progress->centred_empty += ask(asked, centre, none, radius) > radius;
    else
        progress->balls--, progress->empty -= empty;
}

static void images(void **state)
{
    const Flavour *flavour = *state;
    Random         random  = {flavour->seed + 200};
    Progress       all     = {0};
    for (int repeat = 0; repeat < flavour->chains; repeat++) {
        Flavour innermost = *flavour;
        innermost.nested  = false;
        Chain   inner     = random_chain(&innermost, NULL, &random);
        Chain   chain     = random_chain(flavour, flavour->nested ? &inner : NULL, &random);
        Product product   = compile_chain(&chain);
        Cloud   cloud     = chain_cloud(&chain, flavour->levels > 4 ? 200 : 800, &random);
        Asked   steps     = asked_new(product, RESEARCH_DIRECTIONAL);
        Asked   balls     = asked_new(product, RESEARCH_PROBE);
        for (int i = 0; i < 200 && cloud.count; i++) {
            Vec p  = i % 3 ? random_near(&cloud, &random) : random_in_cube(&random, 3);
            Vec to = vec_sub(cloud.points[random_below(&random, (int)cloud.count)], p);
            check_step(&steps, &chain, p, i % 2 ? vec_unit(to) : random_unit(&random), &all);
            check_ball(&balls, &chain, &cloud, p,
                       random_between(&random, 0.2, 1.2) * cloud_nearest(&cloud, p), &random, &all);
        }
        for (int i = 0; i < 10 && cloud.count; i++)
            check_march(&steps, &chain, vec_scale(5, random_unit(&random)),
                        random_near(&cloud, &random), &all);
        cloud_free(&cloud);
        product_free(&product);
    }
    print_message("# %s: %d steps, %d longer than the distance, %.2f times on average; %.1f "
                  "evaluations a ray, by distances %.1f; %d of %d balls empty, and %d of those by "
                  "distances\n",
                  flavour->name, all.steps, all.longer, all.gain / all.steps,
                  (double)all.directional / all.rays, (double)all.centred / all.rays, all.empty,
                  all.balls, all.centred_empty);
    assert_true(all.longer * 4 > all.steps || flavour->inverting == 0);
    assert_true(all.directional < all.centred || flavour->inverting == 0);
    assert_true(all.empty * 5 > all.balls && all.centred_empty * 100 > 95 * all.balls);
}

int main(void)
{
    product_wants_research();
    struct CMUnitTest tests[FLAVOURS];
    char              names[FLAVOURS][80];
    for (size_t i = 0; i < FLAVOURS; i++) {
        snprintf(names[i], sizeof names[i], "images: %s", flavours[i].name);
        tests[i] = (struct CMUnitTest){names[i], images, NULL, NULL,
                                       (void *)(uintptr_t)&flavours[i]};
    }
    return _cmocka_run_group_tests("images of conformal maps", tests, FLAVOURS, NULL, NULL);
}
