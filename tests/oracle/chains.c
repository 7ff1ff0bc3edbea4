/*
 * Random chains of methods, CSG nodes and sequences against points that are undone by hand.
 *
 * chain.h writes a scene and knows what is inside of it.  Asked are: that the sign of the distance
 * says so; that no distance is above that to any point of the surface, which bisection between
 * points inside and outside finds; that the box holds all of these; and that rays end where a
 * dense walk along them first meets the solid.
 */
#include "tests/oracle/chain.h"
#include "tests/oracle/judge.h"

#include <stdio.h>
#include <stdlib.h>

/* Rounding of a few hundred operations, and of bisection, in scenes some units wide. */
static const double ROUNDING = 1e-9;

typedef struct Tally {
    int      chains, states, wrong, empty, rays, hits, unresolved, kinds[LINK_KINDS];
    Refusals refusals;
} Tally;

static Vec between(Random *random, Vec low, Vec high)
{
    return vec(random_between(random, low.x, high.x), random_between(random, low.y, high.y),
               random_between(random, low.z, high.z));
}

/* Returns the part of a segment where the membership changes, halved until it is a point. */
static Vec border(const Chain *chain, Vec a, Vec b)
{
    bool inside = chain_contains(chain, a);
    for (int i = 0; i < 60; i++) {
        Vec middle = vec_mix(a, b, 0.5);
        if (chain_contains(chain, middle) == inside)
            a = middle;
        else
            b = middle;
    }
    return vec_mix(a, b, 0.5);
}

/* Points of the surface on random segments through a region. */
static Cloud borders(const Chain *chain, Vec low, Vec high, int segments, Random *random)
{
    enum { STEPS = 48 };
    Cloud cloud = {0};
    for (int i = 0; i < segments; i++) {
        Vec  from = between(random, low, high), to = between(random, low, high), last = from;
        bool inside = chain_contains(chain, from);
        for (int k = 1; k <= STEPS; k++) {
            Vec p = vec_mix(from, to, (double)k / STEPS);
            if (chain_contains(chain, p) != inside) {
                cloud_add(&cloud, border(chain, last, p));
                inside = !inside;
            }
            last = p;
        }
    }
    return cloud;
}

/* A chain that was compiled, and where to look. */
typedef struct Case {
    const char *text;
    Product     product, lipschitz; /* behind an offset by 0 */
    Chain       chain;
    Vec         low, high; /* a box some larger than that of the solid */
    bool        bounded;
    Cloud       cloud;
    uint64_t    seed;
    int         faults;
} Case;

/* The first fault of a chain is told. */
static void complain(Case *c, Vec p, const char *what, double is, double truth)
{
    if (c->faults++ == 0)
        fprintf(stderr, "# seed %llu: %s at (%.17g, %.17g, %.17g): %.9g, in truth %.9g\n%s",
                (unsigned long long)c->seed, what, p.x, p.y, p.z, is, truth, c->text);
}

/* Anywhere, or near to the surface. */
static Vec random_place(const Case *c, Random *random)
{
    if (!c->cloud.count || random_below(random, 3) == 0)
        return between(random, c->low, c->high);
    Vec    on    = c->cloud.points[random_below(random, (int)c->cloud.count)];
    double reach = pow(10, random_between(random, -4, 0));
    return vec_add(on, vec_scale(reach, random_unit(random)));
}

static void check_points(Case *c, int points, Random *random)
{
    for (int i = 0; i < points; i++) {
        Vec    p        = random_place(c, random);
        double distance = product_distance(&c->product, p), size = 1 + vec_length(p);
        bool   inside = chain_contains(&c->chain, p);
        double truth  = cloud_nearest(&c->cloud, p);
        if (fabs(distance) > ROUNDING * size && (distance < 0) != inside)
            complain(c, p, inside ? "outside" : "inside", distance, truth);
        if (!(fabs(distance) <= truth + ROUNDING * size))
            complain(c, p, "too far", distance, truth);
    }
}

static void check_box(Case *c)
{
    Vec low, high;
    if (!chain_box(&c->product, &low, &high))
        return;
    for (size_t i = 0; i < c->cloud.count; i++) {
        Vec    p = c->cloud.points[i];
        Vec    q = vec_sub(p, vec_mix(low, high, 0.5)), half = vec_scale(0.5, vec_sub(high, low));
        double excess = fmax(fabs(q.x) - half.x, fmax(fabs(q.y) - half.y, fabs(q.z) - half.z));
        if (!(excess <= ROUNDING * (1 + vec_length(p))))
            complain(c, p, "outside of the box", excess, 0);
    }
}

/* Where a ray first changes sides, looked for in equal steps; `farthest` if nowhere. */
static double first_change(const Chain *chain, Vec origin, Vec direction, double farthest)
{
    enum { STEPS = 1500 };
    bool inside = chain_contains(chain, origin);
    for (int i = 1; i <= STEPS; i++) {
        double t = farthest * i / STEPS;
        Vec    p = vec_add(origin, vec_scale(t, direction));
        if (chain_contains(chain, p) != inside) {
            Vec last = vec_add(origin, vec_scale(t - farthest / STEPS, direction));
            return vec_distance(border(chain, last, p), origin);
        }
    }
    return farthest;
}

/* Tells whether the surface comes near to a point. */
static bool is_near(const Case *c, Vec p, double reach, Random *random)
{
    bool inside = chain_contains(&c->chain, p);
    for (int i = 0; i < 3000; i++)
        if (chain_contains(&c->chain, random_in_ball(random, p, reach)) != inside)
            return true;
    return false;
}

/* Checks a ray, by a tolerance or, for 0, what the precision gives.  One along a surface, much
   nearer to it than its length, may run out of steps; it must be told, and where it is by then must
   be in the open. */
static void check_ray(Case *c, Vec origin, Vec direction, double tolerance, Random *random,
                      Tally *tally)
{
    double farthest = vec_distance(c->low, c->high), allowed = fmax(10 * tolerance, 1e-7);
    double change = first_change(&c->chain, origin, direction, farthest);
    KrsHit hit    = product_raycast(&c->product, origin, direction, farthest, tolerance);
    double t      = hit.hit || hit.unresolved ? hit.t : farthest;
    Vec    end    = vec_add(origin, vec_scale(t, direction));
    bool   late   = !(t <= change + allowed);
    bool   early  = hit.hit && t < change - allowed && !is_near(c, end, allowed, random);
    if (late || early) {
        complain(c, origin, late ? "late ray" : "early ray", t, change);
        fprintf(stderr, "# along (%.17g, %.17g, %.17g), tolerance %g\n", direction.x, direction.y,
                direction.z, tolerance);
    }
    tally->rays++;
    tally->hits += hit.hit;
    tally->unresolved += hit.unresolved;
}

static void check_rays(Case *c, int rays, Random *random, Tally *tally)
{
    for (int i = 0; i < rays && c->faults == 0; i++) {
        Vec origin = random_place(c, random), target = between(random, c->low, c->high);
        if (c->cloud.count && random_below(random, 3))
            target = c->cloud.points[random_below(random, (int)c->cloud.count)];
        check_ray(c, origin, vec_unit(vec_sub(target, origin)), i % 2 ? 1e-6 : 0, random, tally);
    }
}

static bool inside_case(const void *c, Vec p)
{
    return chain_contains(&((const Case *)c)->chain, p);
}

/* Distances may jump where nothing moves the surface; behind an offset, if only by 0, they must
   not be steep. */
static void check_slope(Case *c, int points, uint64_t seed)
{
    if (!c->lipschitz.scene)
        return; /* too large for the language */
    Vec    middle = vec_mix(c->low, c->high, 0.5);
    double half   = 0.5 *
                  fmax(c->high.x - c->low.x, fmax(c->high.y - c->low.y, c->high.z - c->low.z));
    Trial   trial   = {product_field, &c->lipschitz, inside_case, c, middle, half, points, seed};
    Verdict verdict = judge(&trial);
    if (verdict.sign_errors + verdict.ball_errors + verdict.slope_errors)
        complain(c, middle, "slope, or ball that is not empty", verdict.steepest, 1);
}

/* ---- runs ---- */

/* From the environment: CHAINS, how many times as many; SEED; the FIRST of them; RAYS
   through each. */
static uint64_t setting(const char *name, uint64_t otherwise)
{
    const char *text = getenv(name);
    return text ? strtoull(text, NULL, 10) : otherwise;
}

typedef struct Run {
    const char *name;
    Recipe      recipe;
    int         chains;
    uint64_t    seed;
} Run;

static const Run runs[] = {
    {"methods", {4, 0, false, 0}, 120, 1},
    {"joints and sequences", {2, 3, false, 0}, 80, 2},
    {"parameters", {3, 1, true, 0}, 40, 3},
    {"bends of what was moved",
     {5, 0, false, 1u << LINK_MOVE | 1u << LINK_TURN | 1u << LINK_SCALE | 1u << LINK_BEND},
     80,
     4},
    {"images",
     {3, 2, false, 1u << LINK_MOVE | 1u << LINK_INVERT | 1u << LINK_MIRROR | 1u << LINK_POLAR},
     60,
     5},
};
enum { RUNS = sizeof runs / sizeof *runs };

static void look_at(Case *c, Random *random, Tally *tally)
{
    c->cloud = borders(&c->chain, c->low, c->high, 150, random);
    check_box(c);
    check_points(c, 250, random);
    check_slope(c, 20, random_bits(random));
    check_rays(c, (int)setting("RAYS", 12), random, tally);
    tally->empty += c->cloud.count == 0;
    tally->states++;
    cloud_free(&c->cloud);
}

static void check_chain(const Run *run, Random *random, Tally *tally)
{
    static SceneText text, lipschitz;
    Case             c = {.text = text.bytes, .seed = random->state};
    text.length        = 0;
    chain_random(&c.chain, &run->recipe, random, &tally->refusals);
    chain_write(&c.chain, &text);
    c.product = product_compile(text.bytes);
    lipschitz = text;
    lipschitz.length -= 2;
    scene_write(&lipschitz, ".offset(0);\ncamera { eye: [0, 0, 9], target: [0, 0, 0] }\n");
    if (krs_compile_text(lipschitz.bytes, lipschitz.length, "steady.krs", NULL,
                         &c.lipschitz.scene) == KRS_OK)
        assert_int_equal(krs_state_new(c.lipschitz.scene, &c.lipschitz.state), KRS_OK);
    c.bounded = chain_box(&c.product, &c.low, &c.high);
    if (!c.bounded)
        c.low = vec(-4, -4, -4), c.high = vec(4, 4, 4);
    Vec margin = vec_add(vec_scale(0.15, vec_sub(c.high, c.low)), vec(0.1, 0.1, 0.1));
    c.low      = vec_sub(c.low, margin);
    c.high     = vec_add(c.high, margin);
    for (int k = 0; k < (run->recipe.moving ? 3 : 1); k++) {
        if (k)
            chain_move(&c.chain, &c.product, &c.lipschitz, random);
        look_at(&c, random, tally);
    }
    for (int k = 0; k < LINK_KINDS; k++)
        tally->kinds[k] += c.chain.shown[k];
    tally->chains++;
    tally->wrong += c.faults > 0;
    product_free(&c.product);
    product_free(&c.lipschitz);
}

static void chains_are_right(void **state)
{
    const Run *run   = *state;
    Tally      tally = {0};
    uint64_t   first = setting("SEED", run->seed), times = setting("CHAINS", 1);
    for (uint64_t i = setting("FIRST", 0); i < times * (uint64_t)run->chains; i++) {
        Random random = {first * 1000000 + i};
        check_chain(run, &random, &tally);
    }
    print_message("# %s: %d chains, %d of %d states empty, %d of %d rays hit, %d unresolved; %d of "
                  "%d steps refused;",
                  run->name, tally.chains, tally.empty, tally.states, tally.hits, tally.rays,
                  tally.unresolved, tally.refusals.refused, tally.refusals.tried);
    for (int k = 0; k < LINK_KINDS; k++)
        print_message(" %s %d", link_names[k], tally.kinds[k]);
    print_message("\n");
    assert_true(tally.unresolved * 1000 <= tally.rays);
    assert_true(tally.empty * 2 < tally.states);
    assert_true(tally.refusals.refused * 2 < tally.refusals.tried);
    if (tally.wrong)
        fail_msg("%d of %d chains are wrong", tally.wrong, tally.chains);
}

int main(int count, char **words)
{
    if (count > 1)
        cmocka_set_test_filter(words[1]);
    struct CMUnitTest tests[RUNS];
    for (int i = 0; i < RUNS; i++)
        tests[i] = (struct CMUnitTest){runs[i].name, chains_are_right, NULL, NULL,
                                       (void *)(uintptr_t)&runs[i]};
    return _cmocka_run_group_tests("chains of methods", tests, RUNS, NULL, NULL);
}
