/*
 * What is left out for being far away is far away: guards and the bounds of levels that they rest
 * on (compiler/lower/guards.c).
 *
 * What rays are marched by may be less than the distance, but never more than the true distance to
 * all copies, one by one, and it must not be above 0 where one of them is: a bound of a level that
 * cuts off a part of it would be.  Random sequences, sequences that parameters move, and nested,
 * scaled and inverted ones, which are judged by their own distance, tested elsewhere.  That the
 * judge would notice is shown with bounds that are too small on purpose.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/oracle/expand.h"
#include "tests/oracle/judge.h"
#include "tests/oracle/product.h"

#include "compiler/scene/program.h"

/* What rays are marched by, of a scene at given parameters. */
typedef struct March {
    const KrsScene *scene;
    NodeValue      *values;
    double          footprint;
    size_t          left_out, asked; /* points at which guards left something out, of how many */
} March;

static March march_new(const Product *product)
{
    const KrsScene *scene  = product->scene;
    NodeValue      *values = calloc(scene->graph->count, sizeof *values);
    uint32_t        slots  = scene->program.parameter_slots;
    float(*block)[4]       = calloc(slots, sizeof *block);
    NodeValue *parameters  = calloc(slots, sizeof *parameters);
    assert_true(values && block && parameters);
    krs_state_parameters(product->state, block);
    for (uint32_t i = 0; i < slots; i++)
        for (int k = 0; k < 4; k++)
            parameters[i].v[k] = block[i][k];
    tape_run_frame(&scene->guarded, parameters, values);
    free(block);
    free(parameters);
    return (March){.scene = scene, .values = values};
}

static double march_field(const void *user, Vec point)
{
    March       *march = (March *)(uintptr_t)user;
    const double p[3] = {point.x, point.y, point.z}, up[3] = {0, 1, 0};
    double       least = HUGE_VAL;
    tape_run_surface(&march->scene->guarded, p, up, march->footprint, march->values);
    for (size_t i = 0; i < march->scene->component_count; i++)
        least = fmin(least,
                     march->values[roots_of(&march->scene->roots, ROOTS_GUARDED).items[i]].v[0]);
    march->asked++;
    return least;
}

static double plain_field(const void *product, Vec point) { return product_field(product, point); }
static bool   plain_inside(const void *product, Vec point)
{
    return product_field(product, point) <= 0;
}

/* ---- random sequences, copy by copy ---- */

typedef struct Flavour {
    const char *name;
    int         mirrors;
    double      near, far, reach, size; /* of mirrors' offsets; of kernels */
    uint64_t    seed;
} Flavour;

static const Flavour flavours[] = {
    {"one mirror", 1, -0.2, 0.4, 0.8, 0.4, 1},  {"separated", 6, 1.2, 2.5, 0.3, 0.3, 2},
    {"overlapping", 5, -0.3, 0.6, 0.6, 0.5, 3}, {"strongly cut", 8, -0.4, 0.3, 0.8, 0.4, 4},
    {"deep", 12, 0.1, 2, 0.4, 0.3, 5},          {"deep and cut", 12, -0.3, 1, 0.6, 0.3, 6},
};
enum { FLAVOURS = sizeof flavours / sizeof *flavours, REPEATS = 5 };

static Sequence random_sequence(const Flavour *flavour, Random *random)
{
    Sequence sequence = {.mirror_count = flavour->mirrors};
    for (int level = 0; level <= flavour->mirrors; level++) {
        if (level < flavour->mirrors)
            sequence.mirrors[level] = (Half){random_unit(random),
                                             random_between(random, flavour->near, flavour->far)};
        Body body   = {.level = level, .from = random_in_cube(random, flavour->reach)};
        body.to     = vec_add(body.from, random_in_cube(random, flavour->size));
        body.radius = flavour->size * random_between(random, 0.1, 0.6);
        if (level == 0 || random_below(random, 3) > 0)
            sequence.bodies[sequence.body_count++] = body;
    }
    return sequence;
}

/* With `slack`, each mirror is a parameter that moves by so much. */
static Product compile_sequence(const Sequence *sequence, double slack)
{
    SceneText text = {.length = 0};
    for (int i = 0; i < sequence->mirror_count && slack > 0; i++) {
        double w = sequence->mirrors[i].offset;
        scene_write(&text, "param w%d = %.17g in [%.17g, %.17g];\n", i, w, w - slack, w + slack);
    }
    scene_write(&text, "show krs {\n");
    for (int level = 0; level <= sequence->mirror_count; level++) {
        for (int i = 0; i < sequence->body_count; i++) {
            const Body *b = &sequence->bodies[i];
            if (b->level == level)
                scene_write(&text,
                            "kernel capsule([%.17g, %.17g, %.17g], [%.17g, %.17g, %.17g],"
                            " %.17g);\n",
                            b->from.x, b->from.y, b->from.z, b->to.x, b->to.y, b->to.z, b->radius);
        }
        if (level == sequence->mirror_count)
            break;
        Half m = sequence->mirrors[level];
        if (slack > 0)
            scene_write(&text, "reflect plane([%.17g, %.17g, %.17g], w%d);\n", m.normal.x,
                        m.normal.y, m.normal.z, level);
        else
            scene_write(&text, "reflect plane([%.17g, %.17g, %.17g], %.17g);\n", m.normal.x,
                        m.normal.y, m.normal.z, m.offset);
    }
    scene_write(&text, "};\n");
    return product_compile(text.bytes);
}

/* Points around copies, where bounds are needed, and anywhere. */
static Vec random_point(Random *random, const Expansion *expansion, double half)
{
    const Copy *copy = &expansion->copies[random_below(random, (int)expansion->count)];
    if (copy->empty || random_below(random, 4) == 0)
        return random_in_cube(random, half);
    return vec_add(copy->interior, random_in_cube(random, random_below(random, 2) ? 0.05 : 0.5));
}

static void check_point(March *march, const Product *product, const Expansion *expansion, Vec point)
{
    double room = march_field(march, point), distance = product_distance(product, point);
    bool   sure;
    if (expansion_contains(expansion, point)) {
        if (!(room <= 1e-9))
            fail_msg("%.12g of room in the middle of a copy", room);
        return;
    }
    double truth = expansion_distance(expansion, point, &sure);
    if (!(room <= truth + 1e-9))
        fail_msg("%.12g of room where the nearest copy is %.12g away", room, truth);
    if (march->footprint == 0 && !(room >= -1e-9))
        fail_msg("%.12g of room outside of all copies", room);
    march->left_out += room < distance - 1e-9;
}

static void check_sequence(const Product *product, const Sequence *sequence, Random *random,
                           double footprint, size_t *left_out)
{
    enum { POINTS = 300 };
    Expansion expansion = expand(sequence);
    March     march     = march_new(product);
    march.footprint     = footprint;
    for (int i = 0; i < POINTS; i++) {
        double half = i % 2 ? 1.5 : 4 + sequence->mirror_count;
        check_point(&march, product, &expansion, random_point(random, &expansion, half));
    }
    *left_out += march.left_out;
    free(march.values);
    expansion_free(&expansion);
}

static void room_is_never_above_the_distance(void **state)
{
    const Flavour *flavour  = *state;
    Random         random   = {flavour->seed};
    size_t         left_out = 0;
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        Sequence sequence = random_sequence(flavour, &random);
        Product  product  = compile_sequence(&sequence, 0);
        check_sequence(&product, &sequence, &random, repeat % 2 ? 0.2 : 0, &left_out);
        product_free(&product);
    }
    print_message("# %s: something left out at %zu points\n", flavour->name, left_out);
    assert_true(left_out > 50);
}

/* Bounds hold for all values of the parameters. */
static void parameters_do_not_break_bounds(void **state)
{
    const Flavour *flavour  = *state;
    Random         random   = {flavour->seed + 100};
    size_t         left_out = 0;
    Sequence       sequence = random_sequence(flavour, &random);
    Product        product  = compile_sequence(&sequence, 0.3);
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        Sequence moved = sequence;
        for (int i = 0; i < moved.mirror_count; i++) {
            char name[16];
            /* As the parameter block will have it: single precision. */
            double w = (float)(moved.mirrors[i].offset + random_between(&random, -0.29, 0.29));
            snprintf(name, sizeof name, "w%d", i);
            moved.mirrors[i].offset = w;
            assert_int_equal(krs_state_set(product.state, name, &w, 1), KRS_OK);
        }
        check_sequence(&product, &moved, &random, 0, &left_out);
    }
    product_free(&product);
    assert_true(left_out > 50);
}

/* ---- whatever else stands around a sequence ---- */

static const char *const scenes[] = {
    /* maps within and around */
    "show krs { kernel sphere(0.3).move([0.4, 0, 0]); reflect plane([1, 0.2, 0], 0.5);"
    "    mobius scale(1.7); kernel capsule([0, 0, 0], [1, 1, 0], 0.2);"
    "    reflect plane([0.1, 1, 0], 0.9); mobius rotate([0, 0, 1], 40deg); kernel sphere(0.4); }"
    "    .scale(0.6).move([0.5, 0, 0]);",
    /* a sequence in a sequence, and a part taken out of it */
    "let twig = krs { kernel capsule([0, 0, 0], [0, 0.5, 0], 0.05); reflect plane([1, -0.4, 0], 0);"
    "    kernel capsule([0, -0.5, 0], [0, 0, 0], 0.08); reflect plane([-0.4, -0.7, 0.5], 0.3); };"
    "show krs { kernel twig.move([0.3, 0, 0]); reflect plane([1, 0, 0.3], 0.6);"
    "    kernel twig.scale(1.5); reflect plane([0, 0, 1], 0.4); } - sphere(0.4);",
    /* two components, one endless */
    "show plane([0, 1, 0], -1);"
    "show krs { kernel sphere(0.2); for i in 0..6 { reflect plane(random_direction(i), 0.3 * i);"
    "    kernel sphere(0.1 + 0.1 * i).move([0, 0.1 * i, 0]); } };",
    /* maps that invert */
    "show krs { kernel sphere(0.3); reflect plane([1, 0.3, 0], 0.2);"
    "    mobius invert([0, 2.5, 0.3], 2); kernel sphere(0.3).move([0.5, 0, 0]);"
    "    reflect plane([0, 0.3, 1], 0.4); mobius invert([-3, 0, 0], 2.5);"
    "    kernel capsule([0, 0, 0], [0, 1, 0], 0.1); reflect plane([0, -1, 0.2], 0.3); };",
    /* copies in cells, and a blend above, which needs the slope */
    "show krs { kernel sphere(0.1).move([0.2, 0.1, 0]); reflect plane([1, 1, 0], 0.1);"
    "    kernel sphere(0.15); }.repeat([1.5, 1.5, 1.5], [3, 3, 3]);"
    "show union([krs { kernel sphere(0.2).move([0, 2, 0]); reflect plane([1, 1, 0], 1);"
    "    kernel sphere(0.3); }, box([1, 1, 1])], blend: 0.3).move([0, 3, 0]);",
};
enum { SCENES = sizeof scenes / sizeof *scenes };

static void balls_are_empty(void **state)
{
    const char *text    = *state;
    Product     product = product_compile(text);
    March       march   = march_new(&product);
    Trial       trial   = {march_field, &march, plain_inside, &product, vec(0, 0, 0), 3, 3000, 11};
    Verdict     verdict = judge(&trial);
    if (verdict.sign_errors || verdict.ball_errors)
        fail_msg("%d wrong signs, %d balls that are not empty:\n%s", verdict.sign_errors,
                 verdict.ball_errors, text);
    Exaggeration larger = {march_field, &march, 1.5};
    trial.field         = exaggerated_field;
    trial.field_user    = &larger;
    assert_true(judge(&trial).ball_errors > 0);
    free(march.values);
    product_free(&product);
}

/* Less work: what the tape skips. */
static void far_away_little_is_run(void **state)
{
    (void)state;
    Product product = product_format("%s", scenes[2]);
    March   march   = march_new(&product);
    Vec     far     = vec(40, 50, 30);
    double  room = march_field(&march, far), distance = plain_field(&product, far);
    assert_true(room > 0.5 * distance && room <= distance + 1e-9);
    const KrsScene *scene = product.scene;
    size_t          run   = 0;
    for (size_t i = scene->guarded.frame_count; i < scene->guarded.count; i++, run++)
        if (scene->guarded.skips[i] && march.values[scene->guarded.nodes[i]].v[0] > 1)
            i += scene->guarded.skips[i];
    assert_true(2 * run < scene->distance.count - scene->distance.frame_count);
    free(march.values);
    product_free(&product);
}

int main(void)
{
    struct CMUnitTest tests[2 * FLAVOURS + SCENES + 1];
    size_t            count = 0;
    for (int i = 0; i < FLAVOURS; i++) {
        void *flavour  = (void *)(uintptr_t)&flavours[i];
        tests[count++] = (struct CMUnitTest){flavours[i].name, room_is_never_above_the_distance,
                                             NULL, NULL, flavour};
        tests[count++] = (struct CMUnitTest){"parameters_do_not_break_bounds",
                                             parameters_do_not_break_bounds, NULL, NULL, flavour};
    }
    for (int i = 0; i < SCENES; i++)
        tests[count++] = (struct CMUnitTest){"balls_are_empty", balls_are_empty, NULL, NULL,
                                             (void *)(uintptr_t)scenes[i]};
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(far_away_little_is_run);
    return _cmocka_run_group_tests("what is left out is far away", tests, count, NULL, NULL);
}
