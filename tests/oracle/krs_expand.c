/*
 * Kernel-reflection sequences against the same sequences written out copy by copy.
 *
 * Random scenes of up to 12 mirrors, in no order, overlapping, cutting kernels at every level.
 * The distance must never exceed the true one, must be the true one wherever the nearest
 * point of the reported copy survives all mirrors, and must name that copy; rays must end
 * where rays against every single copy end.
 */
#include "tests/oracle/expand.h"
#include "tests/oracle/judge.h"
#include "tests/oracle/product.h"

#include <stdio.h>
#include <time.h>

/* What a random sequence is like. */
typedef struct Flavour {
    const char *name;
    int         mirrors;
    double      near, far;  /* offsets of the mirrors */
    double      reach;      /* kernels lie in the cube of this half size */
    double      size;       /* of kernels */
    int         max_bodies; /* per level */
    bool        capsules;
    uint64_t    seed;
} Flavour;

static const Flavour flavours[] = {
    {"no mirror", 0, 0, 0, 0.5, 0.3, 2, true, 1},
    {"one mirror", 1, -0.2, 0.4, 0.8, 0.4, 2, true, 2},
    {"separated", 6, 1.2, 2.5, 0.3, 0.3, 1, true, 3},
    {"overlapping", 5, -0.3, 0.6, 0.6, 0.5, 2, true, 4},
    {"strongly cut", 8, -0.4, 0.3, 0.8, 0.4, 1, true, 5},
    {"deep", 12, 0.1, 2, 0.4, 0.3, 1, true, 6},
    {"deep and cut", 12, -0.3, 1, 0.6, 0.3, 1, true, 7},
    {"no capsules", 6, -0.3, 0.8, 0.6, 0.4, 2, false, 8},
    {"deep, no capsules", 11, -0.1, 1.5, 0.5, 0.3, 1, false, 9},
};
enum { FLAVOURS = sizeof flavours / sizeof *flavours, REPEATS = 4 };

static Body random_body(const Flavour *flavour, Random *random, int level)
{
    double size = flavour->size;
    Body   body = {.level = level, .from = random_in_cube(random, flavour->reach)};
    body.to     = body.from;
    body.axis   = random_unit(random);
    body.radius = size * random_between(random, 0.2, 1);
    int kind    = random_below(random, flavour->capsules ? 3 : 2);
    if (kind == 1) {
        body.box   = true;
        body.sides = vec_add(vec(0.6 * size, 0.6 * size, 0.6 * size),
                             random_in_cube(random, 0.4 * size));
        body.angle = random_between(random, -3, 3);
    } else if (kind == 2) {
        body.to = vec_add(body.from, random_in_cube(random, size));
        body.radius /= 2;
    }
    return body;
}

static Sequence random_sequence(const Flavour *flavour, Random *random)
{
    Sequence sequence = {.mirror_count = flavour->mirrors};
    for (int i = 0; i < flavour->mirrors; i++)
        sequence.mirrors[i] = (Half){random_unit(random),
                                     random_between(random, flavour->near, flavour->far)};
    for (int level = 0; level <= flavour->mirrors; level++) {
        int count = random_below(random, flavour->max_bodies + 1);
        for (int i = 0; i < count || (level == 0 && i == 0); i++)
            sequence.bodies[sequence.body_count++] = random_body(flavour, random, level);
    }
    return sequence;
}

static void write_body(SceneText *text, const Body *b)
{
    scene_write(text, "    kernel ");
    if (b->box)
        scene_write(text, "box([%.17g, %.17g, %.17g]).rotate([%.17g, %.17g, %.17g], %.17g)",
                    2 * b->sides.x, 2 * b->sides.y, 2 * b->sides.z, b->axis.x, b->axis.y, b->axis.z,
                    b->angle);
    else if (vec_distance(b->from, b->to) == 0)
        scene_write(text, "sphere(%.17g)", b->radius);
    else {
        scene_write(text, "capsule([%.17g, %.17g, %.17g], [%.17g, %.17g, %.17g], %.17g);\n",
                    b->from.x, b->from.y, b->from.z, b->to.x, b->to.y, b->to.z, b->radius);
        return;
    }
    scene_write(text, ".move([%.17g, %.17g, %.17g]);\n", b->from.x, b->from.y, b->from.z);
}

/* Normals are written at various lengths: the language takes any. */
static Product compile_sequence(const Sequence *sequence)
{
    SceneText text = {.length = 0};
    scene_write(&text, "show krs {\n");
    for (int level = 0; level <= sequence->mirror_count; level++) {
        for (int i = 0; i < sequence->body_count; i++)
            if (sequence->bodies[i].level == level)
                write_body(&text, &sequence->bodies[i]);
        if (level == sequence->mirror_count)
            break;
        Half   m      = sequence->mirrors[level];
        double length = 0.5 + level % 4;
        Vec    normal = vec_scale(length, m.normal);
        scene_write(&text, "    reflect plane([%.17g, %.17g, %.17g], %.17g);\n", normal.x, normal.y,
                    normal.z, length * m.offset);
    }
    scene_write(&text, "};\n");
    return product_compile(text.bytes);
}

/* Distance to the uncut kernels of the copies with this number, and whether the nearest point
   of the nearest of them survives; HUGE_VAL when there is no such copy. */
static double named_distance(const Expansion *expansion, const KrsHit *hit, Vec point,
                             bool *survives)
{
    double best = HUGE_VAL;
    for (size_t i = 0; i < expansion->count; i++) {
        const Copy *copy = &expansion->copies[i];
        if (copy->id != hit->instance || copy->body->level != (int)hit->level)
            continue;
        bool   uncut;
        double distance = copy_distance_uncut(copy, point, &uncut);
        if (distance < best) {
            best      = distance;
            *survives = uncut;
        }
    }
    return best;
}

typedef struct Tally {
    int outside, exact, checked_exact;
} Tally;

static void check_point(const Product *product, const Sequence *sequence,
                        const Expansion *expansion, Vec point, Tally *tally)
{
    KrsHit hit      = product_probe(product, point);
    double distance = product_distance(product, point);
    assert_true(fabs(hit.distance - distance) <= 1e-12 * (1 + fabs(distance)));

    if (expansion_contains(expansion, point)) {
        assert_true(distance <= 1e-9);
        return;
    }
    assert_true(distance >= -1e-9);
    bool   sure, survives = false;
    double truth = expansion_distance(expansion, point, &sure);
    if (!(distance <= truth + 1e-9))
        fail_msg("distance %.12g is above the true %.12g", distance, truth);

    if ((int)hit.level > sequence->mirror_count ||
        hit.instance >> (sequence->mirror_count - (int)hit.level) != 1)
        fail_msg("level %u cannot have instance %u", hit.level, hit.instance);
    double named = named_distance(expansion, &hit, point, &survives);
    if (!(fabs(named - distance) <= 1e-9))
        fail_msg("instance %u of level %u is %.12g away, not %.12g", hit.instance, hit.level, named,
                 distance);
    tally->outside++;
    tally->exact += fabs(truth - distance) <= 1e-9;
    if (survives) {
        tally->checked_exact++;
        if (!(distance >= truth - 1e-9))
            fail_msg("distance %.12g should be the true %.12g", distance, truth);
    }
}

static void distances_and_copies(void **state)
{
    const Flavour *flavour = *state;
    Random         random  = {flavour->seed};
    Tally          tally   = {0};
    int            points  = flavour->mirrors > 8 ? 100 : 400;
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        Sequence  sequence  = random_sequence(flavour, &random);
        Expansion expansion = expand(&sequence);
        Product   product   = compile_sequence(&sequence);
        for (int i = 0; i < points; i++)
            check_point(&product, &sequence, &expansion,
                        random_in_cube(&random, i % 2 ? 1.5 : 5 + flavour->mirrors), &tally);
        product_free(&product);
        expansion_free(&expansion);
    }
    print_message("# %s: %d points outside, exact at %d, promised at %d\n", flavour->name,
                  tally.outside, tally.exact, tally.checked_exact);
    assert_true(tally.outside > points && tally.checked_exact > points / 8);
}

/* A hit is on the surface and no later than the first true one; a true hit is never missed. */
static void check_ray(const Product *product, const Expansion *expansion, Vec origin, Vec direction,
                      int *hits)
{
    const double farthest = 60, tolerance = 1e-7;
    KrsHit       hit   = product_raycast(product, origin, direction, farthest, tolerance);
    double       truth = expansion_enter(expansion, origin, vec_unit(direction));
    if (truth < farthest && !hit.hit)
        fail_msg("the ray misses what it meets at %.12g", truth);
    if (!hit.hit)
        return;
    *hits += 1;
    if (!(hit.t <= truth + 2 * tolerance))
        fail_msg("the ray ends at %.12g, behind %.12g", hit.t, truth);
    bool sure;
    Vec  point = vec(hit.point[0], hit.point[1], hit.point[2]);
    Vec  along = vec_add(origin, vec_scale(hit.t, vec_unit(direction)));
    assert_true(vec_distance(point, along) <= 1e-9);
    if (!expansion_contains(expansion, point))
        assert_true(expansion_distance(expansion, point, &sure) <= 2 * tolerance);
}

static void rays_end_where_copies_are(void **state)
{
    const Flavour *flavour = *state;
    Random         random  = {flavour->seed + 1000};
    int            hits    = 0;
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        Sequence  sequence  = random_sequence(flavour, &random);
        Expansion expansion = expand(&sequence);
        Product   product   = compile_sequence(&sequence);
        for (int i = 0; i < 150; i++) {
            Vec origin    = vec_scale(6, random_unit(&random));
            Vec direction = vec_sub(random_in_cube(&random, 1.5), origin);
            if (!expansion_contains(&expansion, origin))
                check_ray(&product, &expansion, origin, direction, &hits);
        }
        product_free(&product);
        expansion_free(&expansion);
    }
    assert_true(hits > 50);
}

static bool inside_expansion(const void *expansion, Vec point)
{
    return expansion_contains(expansion, point);
}

static void slope_and_empty_balls(void **state)
{
    const Flavour *flavour   = *state;
    Random         random    = {flavour->seed + 2000};
    Sequence       sequence  = random_sequence(flavour, &random);
    Expansion      expansion = expand(&sequence);
    Product        product   = compile_sequence(&sequence);
    Trial trial = {product_field, &product, inside_expansion, &expansion, vec(0, 0, 0), 3, 1500, 5};
    judge_acquits(&trial, flavour->name);
    product_free(&product);
    expansion_free(&expansion);
}

/* A sequence as the kernel of another is the longer sequence. */
static void nested_is_flat(void **state)
{
    (void)state;
    const char *inner = "kernel sphere(0.3).move([0.2, 0.1, 0]); reflect plane([1, 0.3, 0], 0.5);"
                        "kernel box([0.2, 0.5, 0.3]); reflect plane([0.2, 1, 0], 0.6);";
    const char *outer = "kernel sphere(0.2).move([0, 0, 0.5]); reflect plane([0, 0.1, 1], 0.7);";
    Product nested = product_format("let a = krs { %s }; show krs { kernel a; %s };", inner, outer);
    Product flat   = product_format("show krs { %s %s };", inner, outer);
    Random  random = {11};
    for (int i = 0; i < 2000; i++) {
        Vec    point = random_in_cube(&random, 4);
        double a = product_distance(&nested, point), b = product_distance(&flat, point);
        assert_true(fabs(a - b) <= 1e-12 * (1 + fabs(a)));
    }
    product_free(&nested);
    product_free(&flat);
}

/* Parallel mirrors at 0.5, 1.5, 3.5, ... make 2^n spheres, one at every whole x from 0. */
static Product compile_row(int mirrors)
{
    return product_format("show krs { kernel sphere(0.25).move([0, 0.1, 0]);"
                          "for i in 0..%d { reflect plane([1, 0, 0], 2 ^ i - 0.5); } };",
                          mirrors);
}

static double row_distance(Vec point, double count)
{
    double nearest = fmax(0, fmin(nearbyint(point.x), count - 1));
    return vec_distance(point, vec(nearest, 0.1, 0)) - 0.25;
}

static void more_mirrors_than_bits(void **state)
{
    (void)state;
    enum { MIRRORS = 36 };
    Product product = compile_row(MIRRORS);
    Random  random  = {36};
    for (int i = 0; i < 2000; i++) {
        Vec point = random_in_cube(&random, 2);
        point.x += ldexp(random_between(&random, 0, 1), random_below(&random, MIRRORS));
        double distance = product_distance(&product, point);
        double truth = row_distance(point, 0x1p36), rounding = 1e-9 + 1e-14 * fabs(point.x);
        assert_true(fabs(distance - truth) <= rounding);
    }
    KrsHit first  = product_probe(&product, vec(0x1p34, 1, 0));
    KrsHit second = product_probe(&product, vec(0x1p34 + 1, 1, 0));
    KrsHit third  = product_probe(&product, vec(1, 1, 0));
    assert_int_not_equal(first.instance, second.instance);
    assert_int_not_equal(first.instance, third.instance);
    assert_int_equal(first.level, 0);
    product_free(&product);
}

/* Twenty-eight levels: a line of about as many spheres, counted by their numbers. */
static void many_levels_compile_quickly(void **state)
{
    (void)state;
    clock_t start   = clock();
    Product product = compile_row(28);
    print_message("# 28 levels: %.3f s of CPU time to compile\n",
                  (double)(clock() - start) / CLOCKS_PER_SEC);
    KrsComponent component;
    assert_int_equal(krs_component(product.scene, 0, &component), KRS_OK);
    assert_int_equal(component.levels, 28);
    assert_true(component.instances == 0x1p28);
    Random random = {28};
    for (int i = 0; i < 1000; i++) {
        Vec point = random_in_cube(&random, 1);
        point.x += nearbyint(random_between(&random, 0, 0x1p28 - 1));
        assert_true(fabs(product_distance(&product, point) - row_distance(point, 0x1p28)) <= 1e-6);
    }
    product_free(&product);
}

/* Neighbours in a row have different numbers, and together they have all of them. */
static void numbers_are_unique(void **state)
{
    (void)state;
    enum { MIRRORS = 10 };
    Product product            = compile_row(MIRRORS);
    bool    seen[1 << MIRRORS] = {false};
    for (int i = 0; i < 1 << MIRRORS; i++) {
        KrsHit hit = product_probe(&product, vec(i, 0.5, 0));
        assert_in_range(hit.instance, 1 << MIRRORS, (2 << MIRRORS) - 1);
        assert_false(seen[hit.instance - (1 << MIRRORS)]);
        seen[hit.instance - (1 << MIRRORS)] = true;
    }
    product_free(&product);
}

static size_t add_test(struct CMUnitTest *tests, size_t count, char *name, const char *what,
                       CMUnitTestFunction test, const Flavour *flavour)
{
    snprintf(name, 80, "%s: %s", what, flavour->name);
    tests[count] = (struct CMUnitTest){name, test, NULL, NULL, (void *)(uintptr_t)flavour};
    return count + 1;
}

int main(void)
{
    struct CMUnitTest tests[3 * FLAVOURS + 4];
    char              names[3 * FLAVOURS][80];
    size_t            count = 0;
    for (const Flavour *f = flavours; f < flavours + FLAVOURS; f++) {
        count = add_test(tests, count, names[count], "distances, copies", distances_and_copies, f);
        if (f->mirrors <= 6)
            count = add_test(tests, count, names[count], "slope, balls", slope_and_empty_balls, f);
        if (!f->capsules)
            count = add_test(tests, count, names[count], "rays", rays_end_where_copies_are, f);
    }
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(nested_is_flat);
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(more_mirrors_than_bits);
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(many_levels_compile_quickly);
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(numbers_are_unique);
    return _cmocka_run_group_tests("kernel-reflection sequences", tests, count, NULL, NULL);
}
