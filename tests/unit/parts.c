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

#include "compiler/inspect.h"

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
    assert_int_equal(use.shapes, 200001); /* spheres, their places, and the union */
    print_message("# %zu MB\n", use.most / MEGABYTE);
    assert_true(use.most < 300 * MEGABYTE);
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

/* What each part takes is not the size of the graph of all of them. */
static void memory_grows_with_the_parts(void **state)
{
    static const char *const growing[] = {
        "show union([sphere(0.1 + random(i)).move([i, 0, 0]) for i in 0..%d]);",
        "show union([box([1, 1, 0.1 + random(i)]).rotate([0, 1, 0], i) for i in 0..%d]);",
        "for i in 0..%d { show sphere(0.3) - sphere(0.1 + 0.1 * random(i)).move([0.2, 0, 0]); }",
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
        cmocka_unit_test(memory_grows_with_the_parts),
        cmocka_unit_test(memory_may_run_out),
        cmocka_unit_test(more_are_refused),
    };
    return cmocka_run_group_tests_name("parts", tests, NULL, NULL);
}
