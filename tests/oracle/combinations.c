/*
 * combinations.c: every method on every family of shapes, and pairs of methods.
 *
 * A family is asked alone, as a scene of its own, what is inside of it; other oracles hold that
 * against its definition.  Here a method is undone on points, and the shape behind the method must
 * have what the family has there.  Methods that go by a distance have no such answer: they are held
 * to what they must contain, and to themselves.  A method without a row in methods.c fails the
 * test, so that a new one is tried on everything.
 */
#include "tests/oracle/methods.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

/* ---- what is asked ---- */

typedef struct Said {
    char   codes[64];
    size_t length;
} Said;

static void note_code(void *user, const KrsDiagnostic *diagnostic)
{
    Said *said = user;
    if (diagnostic->error && said->length + 8 < sizeof said->codes)
        said->length += (size_t)snprintf(said->codes + said->length, 8, "%s ", diagnostic->code);
}

/* Returns false if refused, for the reasons in `said`. */
static bool compile_quietly(const char *text, Product *product, Said *said)
{
    KrsOptions options = {.diagnostic = note_code, .user = said};
    *said              = (Said){.length = 0};
    if (krs_compile_text(text, strlen(text), "combination.krs", &options, &product->scene) !=
        KRS_OK)
        return false;
    assert_int_equal(krs_state_new(product->scene, &product->state), KRS_OK);
    return true;
}

/* `lipschitz`: as below something that moves the surface, where distances must not be steep. */
static void write_case(const Case *c, bool lipschitz, SceneText *text)
{
    scene_write(text, "%sshow ", prelude);
    for (int i = c->count; i-- > 0;)
        scene_write(text, "(%s", c->methods[i]->before);
    scene_write(text, "(%s)", c->family->text);
    for (int i = 0; i < c->count; i++)
        scene_write(text, "%s)", c->methods[i]->after);
    scene_write(text, "%s;\ncamera { eye: [0, 0, 9], target: [0, 0, 0] }\n",
                lipschitz ? ".offset(0)" : "");
}

typedef struct Tally {
    int cases, refused, wrong, near, hits;
} Tally;

static void complain(const char *text, const char *what, Vec p, double is, Tally *tally)
{
    tally->wrong++;
    fprintf(stderr, "# %s at (%.9g, %.9g, %.9g): %.9g\n# %s", what, p.x, p.y, p.z, is,
            text + strlen(prelude));
}

/* The distance against a membership: that of points, or its own sign. */
static void judge_case(const Product *product, Inside *membership, const void *user, bool lipschitz,
                       const char *text, uint64_t seed, Tally *tally)
{
    Trial   trial  = {product_field, product, membership, user, vec(0, 0, 0), 2, 24, seed};
    Verdict near   = judge(&trial);
    trial.half     = 8;
    trial.points   = 8;
    Verdict far    = judge(&trial);
    int     slopes = lipschitz ? near.slope_errors + far.slope_errors : 0;
    if (near.sign_errors + far.sign_errors)
        complain(text, "wrong side", vec(0, 0, 0), near.sign_errors + far.sign_errors, tally);
    else if (near.ball_errors + far.ball_errors)
        complain(text, "ball not empty", vec(0, 0, 0), near.ball_errors + far.ball_errors, tally);
    else if (slopes)
        complain(text, "too steep", vec(0, 0, 0), fmax(near.steepest, far.steepest), tally);
}

static bool is_negative(const void *product, Vec p) { return product_distance(product, p) <= 0; }

/* Checks a method that goes by a distance: nothing beyond the box that it may fill, and all that
   was inside, if it keeps that. */
static void check_growth(const Product *product, const Case *c, const char *text, Random *random,
                         Tally *tally)
{
    const Method *last   = c->methods[c->count - 1];
    Case          before = *c;
    before.count--;
    for (int i = 0; i < 200 && last->keeps; i++) {
        Vec p = random_in_cube(random, i % 2 ? 2 : 0.8);
        if (inside_case(&before, p) && product_distance(product, p) > 1e-9) {
            complain(text, "lost", p, product_distance(product, p), tally);
            return;
        }
    }
}

/* A ray ends where the membership along it changes, within what equal steps see. */
static void check_ray(const Product *product, Inside *membership, const void *user, Vec origin,
                      Vec target, const char *text, Tally *tally)
{
    enum { STEPS = 300 };
    const double farthest = 8, tolerance = 1e-6;
    Vec          direction = vec_unit(vec_sub(target, origin));
    bool         start     = membership(user, origin);
    double       change    = HUGE_VAL;
    for (int i = 1; i <= STEPS && change == HUGE_VAL; i++) {
        Vec p = vec_add(origin, vec_scale(farthest * i / STEPS, direction));
        if (membership(user, p) != start)
            change = farthest * i / STEPS;
    }
    KrsHit hit = product_raycast(product, origin, direction, farthest, tolerance);
    if (change < HUGE_VAL && !hit.unresolved && !(hit.hit && hit.t <= change + 2 * tolerance))
        complain(text, "late ray", origin, hit.hit ? hit.t : HUGE_VAL, tally);
    if (hit.hit && fabs(product_distance(product, vec(hit.point[0], hit.point[1], hit.point[2]))) >
                       4 * tolerance)
        complain(text, "ray that ends in the open", origin, hit.t, tally);
    tally->hits += hit.hit;
}

/* Tells whether each of the reasons is one for which a method of the case may be refused. */
static bool may_be_refused(const Case *c, const Said *said)
{
    bool expected = said->length > 0;
    for (const char *code = said->codes; *code; code += 6) {
        char one[8]  = {0};
        bool allowed = false;
        memcpy(one, code, 5);
        for (int i = 0; i < c->count; i++)
            allowed = allowed || strstr(c->methods[i]->refusals, one);
        expected = expected && allowed;
    }
    return expected;
}

/* `lipschitz`: as below something that moves the surface, where that can be. */
static void check_case(const Case *c, bool lipschitz, uint64_t seed, Tally *tally)
{
    SceneText text = {.length = 0};
    Product   product;
    Said      said;
    Random    random = {seed};
    write_case(c, lipschitz, &text);
    bool made = compile_quietly(text.bytes, &product, &said);
    if (!made && lipschitz && strstr(said.codes, "E0409")) {
        check_case(c, false, seed, tally);
        return;
    }
    tally->cases++;
    if (!made) {
        tally->refused++;
        if (!may_be_refused(c, &said))
            complain(text.bytes, said.codes, vec(0, 0, 0), 0, tally);
        return;
    }
    bool undone = true;
    int  wrong  = tally->wrong;
    for (int i = 0; i < c->count; i++)
        undone = undone && c->methods[i]->undo;
    Inside     *membership = undone ? inside_case : is_negative;
    const void *user       = undone ? (const void *)c : &product;
    judge_case(&product, membership, user, lipschitz, text.bytes, seed, tally);
    if (c->methods[c->count - 1]->keeps && (c->count == 1 || c->methods[0]->undo))
        check_growth(&product, c, text.bytes, &random, tally);
    for (int i = 0; i < 8 && tally->wrong == wrong; i++)
        check_ray(&product, membership, user, random_in_cube(&random, i % 2 ? 3 : 1),
                  random_in_cube(&random, 0.7), text.bytes, tally);
    product_free(&product);
}

/* ---- tests ---- */

static Product family_alone(const Family *family)
{
    return product_format("%sshow %s;", prelude, family->text);
}

static void tell(const char *what, const Tally *tally)
{
    print_message("# %s: %d cases, %d refused, %d hits\n", what, tally->cases, tally->refused,
                  tally->hits);
    if (tally->wrong)
        fail_msg("%d of %d are wrong", tally->wrong, tally->cases);
}

static void every_method_on(void **state)
{
    const Family *family = *state;
    Case          c      = {.family = family, .count = 1, .alone = family_alone(family)};
    Tally         tally  = {0};
    for (size_t i = 0; i < method_count; i++) {
        c.methods[0] = &methods[i];
        if (methods[i].before)
            check_case(&c, (i + (family - families)) % 2, (uint64_t)i, &tally);
    }
    product_free(&c.alone);
    tell(family->name, &tally);
}

static void pairs_of_methods(void **state)
{
    enum { PAIRS = 6 };
    (void)state;
    Tally  tally  = {0};
    Random random = {2};
    for (size_t f = 0; f < family_count; f++) {
        Case c = {.family = &families[f], .count = 2, .alone = family_alone(&families[f])};
        for (int i = 0; i < PAIRS; i++) {
            do {
                c.methods[0] = &methods[random_below(&random, (int)method_count)];
                c.methods[1] = &methods[random_below(&random, (int)method_count)];
            } while (!c.methods[0]->before || !c.methods[1]->before);
            check_case(&c, i % 2, (uint64_t)i, &tally);
        }
        product_free(&c.alone);
    }
    tell("pairs", &tally);
}

static void every_method_has_a_row(void **state)
{
    static const char *const names[] = {
#define METHOD(name, parameters, function, meaning) #name,
#include "compiler/eval/builtins/methods.def"
#undef METHOD
    };
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        bool found = false;
        for (size_t k = 0; k < method_count; k++)
            found = found || strcmp(names[i], methods[k].name) == 0;
        if (!found)
            fail_msg("`.%s` is not tried on anything", names[i]);
    }
}

enum { MAX_FAMILIES = 200 };

int main(void)
{
    struct CMUnitTest tests[MAX_FAMILIES + 2];
    assert(family_count <= MAX_FAMILIES);
    for (size_t i = 0; i < family_count; i++)
        tests[i] = (struct CMUnitTest){families[i].name, every_method_on, NULL, NULL,
                                       (void *)(uintptr_t)&families[i]};
    tests[family_count]     = (struct CMUnitTest)cmocka_unit_test(pairs_of_methods);
    tests[family_count + 1] = (struct CMUnitTest)cmocka_unit_test(every_method_has_a_row);
    return _cmocka_run_group_tests("methods of families", tests, family_count + 2, NULL, NULL);
}
