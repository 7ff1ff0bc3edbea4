/*
 * folds.c: sequences of planes, spheres and conformal maps over balls, against the same sets written
 * out.
 *
 * The image of a ball is a ball, so a set is a list of balls, and the distance to it is exact.
 * Mirrors are drawn until none cuts a ball: each is kept whole, with its image, or dropped.  The
 * distance of the compiler must never be above the true one, have its sign, rise no faster than
 * distance, and be nearly the true one next to a surface.  That the points would notice a wrong
 * bound is shown by the bound without what holds in front of a sphere, which they must refute.
 */
#include <stdio.h>

#include "tests/oracle/product.h"

/* ---- sets of balls ---- */

enum { MAX_BALLS = 512, MAX_STEPS = 24 };

/* The image of a kernel, and which mirrors it comes through. */
typedef struct Image {
    Vec      centre;
    double   radius;
    uint32_t level, passed, bits;
    int      kernel; /* number of its step */
} Image;

typedef struct Step {
    enum { KERNEL, PLANE, SPHERE, SHIFT, INVERT } kind;
    Vec    vector; /* normal, centre, or way */
    double number; /* radius, offset */
} Step;

typedef struct Set {
    Step  steps[MAX_STEPS];
    Image images[MAX_BALLS];
    int   count, balls, mirrors;
} Set;

static Vec invert_point(const Step *step, Vec p)
{
    Vec z = vec_sub(p, step->vector);
    return vec_add(step->vector, vec_scale(step->number * step->number / vec_dot(z, z), z));
}

static void invert_ball(const Step *step, Image *image)
{
    Vec    z      = vec_sub(image->centre, step->vector);
    double d      = vec_dot(z, z) - image->radius * image->radius;
    double s      = step->number * step->number / d;
    image->centre = vec_add(step->vector, vec_scale(s, z));
    image->radius *= s;
}

/* Returns how far a ball's centre is in front of a mirror; behind it where that is negative. */
static double in_front(const Step *step, Vec p)
{
    return step->kind == PLANE ? step->number - vec_dot(step->vector, p)
                               : vec_distance(p, step->vector) - step->number;
}

static bool is_cut(const Set *set, const Step *step)
{
    for (int i = 0; i < set->balls; i++) {
        double height = in_front(step, set->images[i].centre);
        if (fabs(height) < set->images[i].radius || 2 * set->balls > MAX_BALLS)
            return true;
    }
    return false;
}

static void mirror_set(Set *set, const Step *step)
{
    int retained = 0;
    for (int i = 0; i < set->balls; i++)
        if (in_front(step, set->images[i].centre) > 0)
            set->images[retained++] = set->images[i];
    for (int i = 0; i < retained; i++) {
        Image *image = &set->images[retained + i];
        *image       = set->images[i];
        if (step->kind == SPHERE)
            invert_ball(step, image);
        else
            image->centre = vec_add(image->centre,
                                    vec_scale(2 * in_front(step, image->centre), step->vector));
        image->bits |= 1u << image->passed;
    }
    set->balls = 2 * retained;
    for (int i = 0; i < set->balls; i++)
        set->images[i].passed++;
    set->mirrors++;
}

/* Returns false if the step would cut a ball, or make none of them. */
static bool take_step(Set *set, Step step)
{
    bool left = step.kind != PLANE && step.kind != SPHERE;
    if (!left && is_cut(set, &step))
        return false;
    for (int i = 0; i < set->balls; i++) {
        const Image *image = &set->images[i];
        left               = left || in_front(&step, image->centre) > 0;
        if (step.kind == INVERT && vec_distance(image->centre, step.vector) < 1.3 * image->radius)
            return false;
    }
    if (!left)
        return false;
    if (step.kind == KERNEL)
        set->images[set->balls++] = (Image){step.vector, step.number, (uint32_t)set->mirrors,
                                            0,           0,           set->count};
    else if (step.kind == PLANE || step.kind == SPHERE)
        mirror_set(set, &step);
    else
        for (int i = 0; i < set->balls; i++) {
            Image *image = &set->images[i];
            if (step.kind == INVERT)
                invert_ball(&step, image);
            else
                image->centre = vec_add(image->centre, step.vector);
        }
    set->steps[set->count++] = step;
    return true;
}

static double set_distance(const Set *set, Vec p, const Image **nearest)
{
    double least = HUGE_VAL;
    for (int i = 0; i < set->balls; i++) {
        double d = vec_distance(p, set->images[i].centre) - set->images[i].radius;
        if (d < least) {
            least    = d;
            *nearest = &set->images[i];
        }
    }
    return least;
}

/* Returns the bound without the factor q / (d + r) in front of spheres, of the first steps. */
static double careless_bound(const Set *set, int count, Vec p)
{
    if (count == 0)
        return HUGE_VAL;
    const Step *step   = &set->steps[count - 1];
    double      height = in_front(step, p), q = vec_distance(p, step->vector), r = step->number;
    if (step->kind == KERNEL)
        return fmin(q - r, careless_bound(set, count - 1, p));
    if (step->kind == SHIFT)
        return careless_bound(set, count - 1, vec_sub(p, step->vector));
    if (step->kind == PLANE && height < 0)
        p = vec_add(p, vec_scale(2 * height, step->vector));
    if (step->kind == PLANE || (step->kind == SPHERE && height >= 0))
        return careless_bound(set, count - 1, p);
    double d = careless_bound(set, count - 1, invert_point(step, p));
    return d / (r * r / (q * q) + fabs(d) / q);
}

/* Returns the least distance of a point from the origin on its way back to a kernel, and after how
   many mirrors. */
static double orbit_trap(const Set *set, int kernel, Vec p, int *step)
{
    double least  = vec_length(p);
    int    passed = 0;
    *step         = 0;
    for (int i = set->count; i-- > kernel + 1;) {
        const Step *s = &set->steps[i];
        if (s->kind == SHIFT)
            p = vec_sub(p, s->vector);
        if (s->kind == INVERT || (s->kind == SPHERE && in_front(s, p) < 0))
            p = invert_point(s, p);
        if (s->kind == PLANE && in_front(s, p) < 0)
            p = vec_add(p, vec_scale(2 * in_front(s, p), s->vector));
        if (s->kind != PLANE && s->kind != SPHERE)
            continue;
        passed++;
        if (vec_length(p) < least) {
            least = vec_length(p);
            *step = passed;
        }
    }
    return least;
}

/* ---- random sets ---- */

typedef struct Flavour {
    const char *name;
    int         steps, sets;
    double      planes, inversions, kernels; /* shares of the steps; the rest are spheres */
    bool        moving;                      /* mirrors are parameters with a range */
    uint64_t    seed;
} Flavour;

static Step random_step(const Flavour *flavour, Random *random)
{
    double kind = random_between(random, 0, 1);
    Vec    near = random_in_cube(random, 1.5);
    if ((kind -= flavour->planes) < 0)
        return (Step){PLANE, random_unit(random), random_between(random, -0.5, 1.5)};
    if ((kind -= flavour->inversions) < 0)
        return random_below(random, 3) ? (Step){INVERT, near, random_between(random, 0.5, 2)}
                                       : (Step){SHIFT, near, 0};
    if ((kind -= flavour->kernels) < 0)
        return (Step){KERNEL, near, random_between(random, 0.05, 0.4)};
    return (Step){SPHERE, near, random_between(random, 0.2, 1.5)};
}

static Set random_set(const Flavour *flavour, Random *random)
{
    Set set = {.count = 0};
    for (int i = 0; i < 2; i++)
        take_step(&set,
                  (Step){KERNEL, random_in_cube(random, 1), random_between(random, 0.05, 0.4)});
    for (int tries = 0; tries < 400 && set.count < flavour->steps; tries++)
        take_step(&set, random_step(flavour, random));
    return set;
}

static void write_mirror(SceneText *text, const Step *step, bool moving, int number)
{
    Vec v = step->vector;
    if (moving)
        scene_write(text, "r%d", number);
    else
        scene_write(text, "%.17g", step->number);
    scene_write(text, step->kind == SPHERE ? ").move([%.17g, %.17g, %.17g]);\n" : ");\n", v.x, v.y,
                v.z);
}

static Product compile_set(const Set *set, bool moving)
{
    static SceneText text;
    text.length = 0;
    for (int i = 0; i < set->count && moving; i++)
        scene_write(&text, "param r%d = %.17g in [%.17g, %.17g];\n", i, set->steps[i].number,
                    set->steps[i].number - 0.1, set->steps[i].number + 0.3);
    scene_write(&text, "material orbit { emission: [orbit_trap, orbit_step, 0] }\nshow krs {\n");
    for (int i = 0; i < set->count; i++) {
        const Step *step = &set->steps[i];
        Vec         v    = step->vector;
        switch (step->kind) {
        case KERNEL:
            scene_write(&text, "kernel sphere(%.17g).move([%.17g, %.17g, %.17g]);\n", step->number,
                        v.x, v.y, v.z);
            break;
        case PLANE:
            scene_write(&text, "reflect plane([%.17g, %.17g, %.17g], ", v.x, v.y, v.z);
            write_mirror(&text, step, moving, i);
            break;
        case SPHERE:
            scene_write(&text, "reflect sphere(");
            write_mirror(&text, step, moving, i);
            break;
        case SHIFT:
            scene_write(&text, "mobius translate([%.17g, %.17g, %.17g]);\n", v.x, v.y, v.z);
            break;
        case INVERT:
            scene_write(&text, "mobius invert([%.17g, %.17g, %.17g], radius: %.17g);\n", v.x, v.y,
                        v.z, step->number);
            break;
        }
    }
    scene_write(&text, set->mirrors ? "}.paint(orbit);\n" : "};\n");
    return product_compile(text.bytes);
}

/* ---- what is asked ---- */

typedef struct Tally {
    int    outside, careless, near, hits;
    double tightness, nearness; /* sums of distance over the true one: of all, next to a surface */
} Tally;

static void check_point(const Product *product, const Set *set, Vec p, Tally *tally)
{
    const Image *nearest;
    double       distance = product_distance(product, p), truth = set_distance(set, p, &nearest);
    double       rounding = 1e-10 * (1 + vec_length(p));
    if (!(distance <= truth + rounding) && truth > 0)
        fail_msg("distance %.12g is above the true %.12g", distance, truth);
    if (truth > rounding ? !(distance > 0) : truth < -rounding && !(distance < 0))
        fail_msg("distance %.12g, but the true one is %.12g", distance, truth);
    Vec    other = vec_add(p, vec_scale(0.01 * fabs(truth) + 1e-6, vec_unit(vec(p.y, p.z, p.x))));
    double rise  = fabs(product_distance(product, other) - distance);
    if (!(rise <= vec_distance(p, other) * (1 + 1e-7) + rounding))
        fail_msg("the slope is %.12g", rise / vec_distance(p, other));
    if (!(truth > 0))
        return;
    tally->outside++;
    tally->careless += careless_bound(set, set->count, p) > truth + rounding;
    tally->tightness += distance / truth;
}

/* Next to a ball: how much of the distance is left, which instance it is, and its normal. */
static void check_surface(const Product *product, const Set *set, Random *random, Tally *tally)
{
    const Image *image = &set->images[random_below(random, set->balls)], *nearest;
    Vec          u     = random_unit(random);
    Vec          p     = vec_add(image->centre, vec_scale(image->radius * (1 + 1e-3), u));
    double       truth = set_distance(set, p, &nearest);
    if (nearest != image || truth < 1e-4 * image->radius)
        return; /* another is as near */
    KrsHit   hit = product_probe(product, p);
    uint32_t id  = (1u << image->passed) | image->bits;
    if (!(hit.distance > 0.9 * truth))
        fail_msg("the distance is %.3g of the true %.12g", hit.distance / truth, truth);
    tally->near++;
    tally->nearness += hit.distance / truth;
    if (hit.level != image->level || hit.instance != id)
        fail_msg("level %u, instance %u should be %u, %u", hit.level, hit.instance, image->level,
                 id);
    int    step;
    double trap = orbit_trap(set, image->kernel, p, &step);
    if (set->mirrors && fabs(hit.emission[0] - trap) > 1e-9 * (1 + trap))
        fail_msg("orbit_trap is %.12g, not %.12g", hit.emission[0], trap);
    if (set->mirrors && fabs(hit.emission[1] - (double)step / set->mirrors) > 1e-9)
        fail_msg("orbit_step is %.12g, not %d of %d", hit.emission[1], step, set->mirrors);
    Vec normal = vec(hit.normal[0], hit.normal[1], hit.normal[2]);
    if (image->radius > 0.01 && !(vec_dot(normal, u) > 0.999)) /* it is a difference */
        fail_msg("the normal is off by %.3g", acos(vec_dot(normal, u)));
}

/* A ray ends on a ball, and no later than in the first one that it meets. */
static void check_ray(const Product *product, const Set *set, Random *random, Tally *tally)
{
    const double tolerance = 1e-6;
    const Image *nearest, *image = &set->images[random_below(random, set->balls)];
    Vec          origin    = vec_scale(6, random_unit(random));
    Vec          target    = vec_add(image->centre, vec_scale(image->radius, random_unit(random)));
    Vec          direction = vec_unit(vec_sub(target, origin));
    double       first     = HUGE_VAL;
    if (set_distance(set, origin, &nearest) < tolerance)
        return;
    for (int i = 0; i < set->balls; i++) {
        Vec    z     = vec_sub(set->images[i].centre, origin);
        double along = vec_dot(z, direction), r = set->images[i].radius;
        double chord = r * r - vec_dot(z, z) + along * along;
        if (along > 0 && chord > 1e-8) /* else it grazes the ball */
            first = fmin(first, along - sqrt(chord));
    }
    if (first == HUGE_VAL)
        return;
    KrsHit hit = product_raycast(product, origin, direction, first + 1, tolerance);
    if (!hit.hit || hit.t > first + 2 * tolerance)
        fail_msg("the ray ends at %.12g, behind %.12g", hit.hit ? hit.t : HUGE_VAL, first);
    if (set_distance(set, vec_add(origin, vec_scale(hit.t, direction)), &nearest) > 1e-5)
        fail_msg("the ray ends at %.12g, before %.12g", hit.t, first);
    tally->hits++;
}

static void check_box(const Product *product, const Set *set)
{
    KrsComponent component;
    assert_int_equal(krs_component(product->scene, 0, &component), KRS_OK);
    for (int i = 0; i < set->balls; i++) {
        const Image *image  = &set->images[i];
        double       c[3]   = {image->centre.x, image->centre.y, image->centre.z};
        double       radius = image->radius * (1 - 1e-9);
        for (int k = 0; k < 3; k++)
            if (c[k] - radius < component.low[k] || c[k] + radius > component.high[k])
                fail_msg("ball %d leaves the box", i);
    }
}

static void folds(void **state)
{
    const Flavour *flavour = *state;
    Random         random  = {flavour->seed};
    Tally          tally   = {0};
    static Set     set;
    for (int repeat = 0; repeat < flavour->sets; repeat++) {
        set             = random_set(flavour, &random);
        Product product = compile_set(&set, flavour->moving);
        check_box(&product, &set);
        for (int i = 0; i < 300; i++) {
            const Image *image = &set.images[random_below(&random, set.balls)];
            double       reach = image->radius * exp(random_between(&random, -4, 3));
            check_point(&product, &set,
                        i % 3 ? vec_add(image->centre, vec_scale(reach, random_unit(&random)))
                              : random_in_cube(&random, 3),
                        &tally);
        }
        for (int i = 0; i < set.count; i++) /* centres of mirrors */
            check_point(&product, &set, set.steps[i].vector, &tally);
        for (int i = 0; i < 40; i++)
            check_surface(&product, &set, &random, &tally);
        for (int i = 0; i < 20; i++)
            check_ray(&product, &set, &random, &tally);
        product_free(&product);
    }
    print_message("# %s: %d points outside, mean %.2f of the true distance, %d refute the bound "
                  "without care; %d next to a surface, mean %.3f; %d hits\n",
                  flavour->name, tally.outside, tally.tightness / tally.outside, tally.careless,
                  tally.near, tally.nearness / tally.near, tally.hits);
    assert_true(tally.hits > 10 * flavour->sets);
    assert_true(tally.near > 10 * flavour->sets);
    assert_true(tally.tightness > 0.3 * tally.outside);
    assert_true(tally.nearness > 0.99 * tally.near);
    assert_true(tally.careless * 100 > tally.outside);
}

static Flavour flavours[] = {
    {"one sphere", 3, 60, 0, 0, 0, false, 1},
    {"spheres", 8, 60, 0, 0, 0.3, false, 2},
    {"spheres and planes", 9, 60, 0.4, 0, 0.2, false, 3},
    {"spheres, planes and maps", 10, 60, 0.3, 0.3, 0.2, false, 4},
    {"moving mirrors", 6, 40, 0.4, 0, 0.2, true, 5},
};

int main(void)
{
    enum { COUNT = sizeof flavours / sizeof *flavours };
    struct CMUnitTest tests[COUNT];
    for (int i = 0; i < COUNT; i++)
        tests[i] = (struct CMUnitTest){flavours[i].name, folds, NULL, NULL, &flavours[i]};
    return _cmocka_run_group_tests("sequences with spheres as mirrors", tests, COUNT, NULL, NULL);
}
