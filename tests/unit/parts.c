/*
 * parts.c: scenes with 100,000 parts are read and evaluated, in memory that grows with them.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/passes/inspect.h"

static const size_t MEGABYTE = 1000 * 1000;

/* Memory of a run, and the shapes that were found. */
typedef struct Use {
    size_t held, most, asked; /* bytes: now, at most, and all that was ever asked for */
    size_t components, shapes;
    char   error[8]; /* the code of the last diagnostic */
} Use;

typedef union BlockSize {
    size_t      bytes;
    max_align_t aligned;
} BlockSize;

static void *counted_allocate(void *user, size_t bytes)
{
    Use       *use   = user;
    BlockSize *block = malloc(sizeof *block + bytes);
    if (!block)
        return NULL;
    block->bytes = bytes;
    use->held += bytes;
    use->asked += bytes;
    use->most = use->held > use->most ? use->held : use->most;
    return block + 1;
}

static void counted_release(void *user, void *memory)
{
    BlockSize *block = (BlockSize *)memory - 1;
    ((Use *)user)->held -= block->bytes;
    free(block);
}

static void show_error(void *user, const KrsDiagnostic *diagnostic)
{
    (void)user;
    print_message("%s", diagnostic->text);
}

static const KrsOptions errors_are_printed = {.diagnostic = show_error};

static void note_error(void *user, const KrsDiagnostic *diagnostic)
{
    snprintf(((Use *)user)->error, sizeof((Use *)user)->error, "%s", diagnostic->code);
}

static KrsStatus count_shapes(void *user, const Inspected *what)
{
    Use *use        = user;
    use->components = what->scene->shown.count;
    for (size_t i = 0; i < use->components; i++)
        use->shapes += what->scene->shown.items[i].shape->tree_shapes;
    return KRS_OK;
}

static KrsStatus elaborate_text(const char *text, size_t limit, Use *use)
{
    KrsOptions options = {.allocator    = {counted_allocate, counted_release, use},
                          .diagnostic   = note_error,
                          .user         = use,
                          .memory_limit = limit};
    *use               = (Use){0};
    KrsStatus status   = inspect_elaborated(text, strlen(text), &options, count_shapes, use);
    assert_int_equal(use->held, 0);
    return status;
}

static void a_list_of_spheres(void **state)
{
    (void)state;
    Use use;
    assert_int_equal(
        elaborate_text("show union([sphere(0.2 + 0.1 * random(4 * i)).move([100 * random("
                       "4 * i + 1), 100 * random(4 * i + 2), 0]) for i in 0..100000]);",
                       0, &use),
        KRS_OK);
    assert_int_equal(use.components, 1);
    assert_int_equal(use.shapes, 100001); /* the iterations of the loop, and the union */
    print_message("# %zu MB\n", use.most / MEGABYTE);
    assert_true(use.most < 200 * MEGABYTE);
}

/* A text in which each part has a line. */
static void parts_one_by_one(void **state)
{
    enum { PARTS = 10000, LONGEST = 64 };
    (void)state;
    Use    use;
    char  *text   = malloc((size_t)PARTS * LONGEST);
    size_t length = 0;
    assert_non_null(text);
    length += (size_t)sprintf(text, "let parts = [\n");
    for (int i = 0; i < PARTS; i++)
        length += (size_t)sprintf(text + length, "    sphere(0.25).move([%d.125, %d.5, 1]),\n",
                                  i % 100, i / 100);
    sprintf(text + length, "];\nshow parts;\n");
    assert_int_equal(elaborate_text(text, 0, &use), KRS_OK);
    assert_int_equal(use.components, PARTS);
    assert_int_equal(use.shapes, 2 * PARTS);
    free(text);
}

static size_t bytes_for(const char *format, int count)
{
    char text[256];
    Use  use;
    snprintf(text, sizeof text, format, count);
    assert_int_equal(elaborate_text(text, 0, &use), KRS_OK);
    return use.asked;
}

/* Rows of a scene, and most bytes for each.  Sanitizers take their time; a grid of few has more cells. */
#ifdef __SANITIZE_ADDRESS__
enum { MANY = 20000, ROW_BYTES = 6000 };
#else
enum { MANY = 60000, ROW_BYTES = 3000 };
#endif

/* Whole scenes of rows of one kind, sharp and blended. */
static void rows_are_compiled_in_little_memory(void **state)
{
    static const char *const endings[] = {"", ", blend: 0.01"};
    (void)state;
    for (int i = 0; i < 2; i++) {
        char       text[256];
        KrsScene  *scene;
        Use        use     = {0};
        size_t     limit   = (size_t)MANY * ROW_BYTES;
        KrsOptions options = {.allocator    = {counted_allocate, counted_release, &use},
                              .memory_limit = limit};
        snprintf(text, sizeof text,
                 "show union([sphere(0.01 + 0.01 * random(i)).move([random(3 * i), "
                 "random(3 * i + 1), random(3 * i + 2)]) for i in 0..%d]%s);",
                 MANY, endings[i]);
        assert_int_equal(krs_compile_text(text, strlen(text), "many.krs", &options, &scene),
                         KRS_OK);
        print_message("# %zu bytes for each row\n", use.most / MANY);
        krs_scene_free(scene);
        assert_int_equal(use.held, 0);
    }
}

/* ---- what values are needed for ---- */

enum { TURNS = 60 };

/* That of part i has its middle at (2 i, i % 7 / 2, i + 1). */
static KrsStatus check_places(void *user, const Inspected *what)
{
    (void)user;
    assert_int_equal(what->scene->shown.count, TURNS);
    for (size_t i = 0; i < TURNS; i++) {
        const Box   *box       = &what->scene->shown.items[i].shape->box;
        const double middles[] = {2.0 * (double)i, (double)(i % 7) / 2, (double)i + 1};
        for (int k = 0; k < 3; k++)
            assert_float_equal((box->axis[k].low + box->axis[k].high) / 2, middles[k], 1e-9);
    }
    return KRS_OK;
}

/* Values that are made in a turn, and needed after it, are not freed with the turn: lists of lists,
   definitions that are first needed there, functions, and what `.round` asks of a shape. */
static void values_stay_that_are_needed(void **state)
{
    static const char *const texts[] = {
        "def row(i) = [[i, 2 * i], [i + 1, 3]];"
        "let table = [row(i) for i in 0..60];"
        "let heights = [k / 2 for k in 0..7];"
        "for i in 0..60 { show box([1, 1, 1]).round(0.1).move("
        "  [table[i][0][1], heights[i % 7], table[i][1][0]]); }",
        "let places = [[2 * i, i % 7 / 2, i + 1] for i in 0..60];"
        "let solids = [[box([1, 1 + p[1], 1]), p] for p in places];"
        "show [s[0].round(0.1).move(s[1]) for s in solids];",
        "let solids = [box([1, 1 + i, 1]) for i in 0..60];"
        "let others = [[i, [i, i, i], i, i, i] for i in 0..200];"
        "show [solids[i].round(0.1).move([2 * i, i % 7 / 2, others[i][0] + 1]) for i in 0..60];",
        "for i in 0..60 { let twice = [2 * i, i + 1]; def high(n) = [n % 7 / 2, n, n, n, n];"
        "  let all = [high(k) for k in 0..60];"
        "  show sphere(0.5).move([twice[0], all[i][0], twice[1]]); }",
        "for i in 0..60 { if i % 2 == 0 { shape ball(r = [0.5, 1, 1]) {"
        "  distance: length(p) - r[0], within: [[-r[0], -r[0], -r[0]], [r[0], r[0], r[0]]],"
        "  exact: true, core: sphere(r[0] - rounding) }"
        "  show krs { kernel ball([0.7, i, i]).round(0.1); mobius translate([2 * i, i % 7 / 2, i + "
        "1]); }; }"
        " else { show sphere([k for k in [0.1, 0.2, 0.3, 0.4, 0.5] if k > 0.4][0]).move("
        "  [2 * i, i % 7 / 2, i + 1]); } }",
    };
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        assert_int_equal(
            inspect_elaborated(texts[i], strlen(texts[i]), &errors_are_printed, check_places, NULL),
            KRS_OK);
}

/* What each part takes is not the size of the graph of all of them. */
static void memory_grows_with_the_parts(void **state)
{
    static const char *const growing[] = {
        "show union([sphere(0.1 + random(i)).move([i, 0, 0]) for i in 0..%d]);",
        "show union([box([1, 1, 0.1 + random(i)]).rotate([0, 1, 0], i) for i in 0..%d]);",
        "for i in 0..%d { show sphere(0.3) - sphere(0.1 + 0.1 * random(i)).move([0.2, 0, 0]); }",
        "for i in 0..%d { show sphere(0.3).move([i, 0, 0]); show box([0.3, 0.3, 0.3]).move([i, 1, "
        "0]); }",
        "shape knob(r) { distance: length([x, 2 * y, z]) - r, within: box([2 * r, 2 * r, 2 * r]) }"
        "show union([knob(0.2 + 0.1 * random(i)) for i in 0..%d]);",
    };
    (void)state;
    for (size_t i = 0; i < sizeof growing / sizeof *growing; i++)
        assert_true(bytes_for(growing[i], 4000) < 5 * bytes_for(growing[i], 1000));
}

static void memory_may_run_out(void **state)
{
    (void)state;
    Use use;
    assert_int_equal(
        elaborate_text("show union([sphere(random(i)) for i in 0..4000000]);", 16 * MEGABYTE, &use),
        KRS_OUT_OF_MEMORY);
    assert_true(use.most <= 16 * MEGABYTE);
}

static void more_are_refused(void **state)
{
    (void)state;
    Use use;
    assert_int_equal(elaborate_text("show union([sphere(1) for i in 0..4000001]);", 0, &use),
                     KRS_BAD_SCENE);
    assert_string_equal(use.error, "E0503");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_list_of_spheres),
        cmocka_unit_test(parts_one_by_one),
        cmocka_unit_test(rows_are_compiled_in_little_memory),
        cmocka_unit_test(values_stay_that_are_needed),
        cmocka_unit_test(memory_grows_with_the_parts),
        cmocka_unit_test(memory_may_run_out),
        cmocka_unit_test(more_are_refused),
    };
    return cmocka_run_group_tests_name("parts", tests, NULL, NULL);
}
