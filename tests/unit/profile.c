/*
 * profile.c: scenes without a part, the parts of a scene, and the rows of a profile.  Nothing is timed here.
 *
 * A scene without a part is held against a text from which the part was taken out by hand.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/base/splitmix.h"
#include "compiler/passes/compile.h"
#include "profile/rows.h"

static KrsScene *compile(const char *text, const KrsLocation *without)
{
    KrsScene  *scene   = NULL;
    KrsOptions options = {.without = without};
    if (krs_compile_text(text, strlen(text), "scene.krs", &options, &scene) != KRS_OK)
        fail_msg("not a scene: %s", text);
    return scene;
}

/* Returns where a text has some words first. */
static KrsLocation location_of(const char *text, const char *words)
{
    const char *at = strstr(text, words);
    assert_non_null(at);
    return (KrsLocation){.source = "scene.krs",
                         .start  = (uint32_t)(at - text),
                         .end    = (uint32_t)(at - text + (ptrdiff_t)strlen(words))};
}

/* ---- without a part ---- */

static const struct {
    const char *text, *part, *by_hand;
} lefts[] = {
    {"show torus(1, 0.25) | box([1, 2, 1]).move([2, 0, 0]);", "torus(1, 0.25)",
     "show box([1, 2, 1]).move([2, 0, 0]);"},
    {"show box([2, 2, 2]) - sphere(1.2);", "sphere(1.2)", "show box([2, 2, 2]);"},
    {"show (box([1, 1, 1]) & sphere(0.6)) | sphere(0.2).move([3, 0, 0]);", "sphere(0.6)",
     "show sphere(0.2).move([3, 0, 0]);"},
    {"let ring = torus(1, 0.2); show ring; show ring.move([3, 0, 0]) | sphere(1);", "torus(1, 0.2)",
     "show sphere(1);"},
    {"let ring = torus(1, 0.2); show ring.move([0, 0, 0]); show ring.move([3, 0, 0]) | sphere(1);",
     "ring.move([0, 0, 0])", "let ring = torus(1, 0.2); show ring.move([3, 0, 0]) | sphere(1);"},
    {"def tooth(i) = box([0.2, 1, 0.2]).rotate([0, 0, 1], i * 20deg);\n"
     "show union([tooth(1), tooth(2), sphere(0.4)], blend: 0.1);",
     "box([0.2, 1, 0.2])", "show sphere(0.4);"},
    {"show union([torus(1, 0.2), sphere(0.5), box([3, 0.2, 0.2])], blend: 0.1);", "sphere(0.5)",
     "show union([torus(1, 0.2), box([3, 0.2, 0.2])], blend: 0.1);"},
    {"show [sphere(0.3).move([i, 0, 0]) for i in 0..40];\nshow torus(1, 0.3);",
     "sphere(0.3).move([i, 0, 0])", "show torus(1, 0.3);"},
    {"show [sphere(1), box([1, 1, 3])]; show torus(1, 0.3);", "[sphere(1), box([1, 1, 3])]",
     "show torus(1, 0.3);"},
    {"show (circle(1) | rectangle([0.4, 3])).extrude(1);", "circle(1)",
     "show rectangle([0.4, 3]).extrude(1);"},
    {"show (rectangle([2, 3]) - circle(0.5)).extrude(1);", "circle(0.5)",
     "show rectangle([2, 3]).extrude(1);"},
    {"show krs { kernel sphere(0.3).move([1, 0, 0]); reflect plane([1, 0, 0], 0.2);\n"
     "  kernel box([0.2, 2, 0.2]); reflect plane([0, 1, 0], 0.3); };",
     "box([0.2, 2, 0.2])",
     "show krs { kernel sphere(0.3).move([1, 0, 0]); reflect plane([1, 0, 0], 0.2);\n"
     "  reflect plane([0, 1, 0], 0.3); };"},
    {"show sphere(0.5).repeat([2, 0, 0], [5, 1, 1]) | torus(2, 0.1);", "sphere(0.5)",
     "show torus(2, 0.1);"},
    {"show plane([0, 1, 0], -1); show sphere(1);", "plane([0, 1, 0], -1)", "show sphere(1);"},
    {"show box([1, 1, 1]).twist([0, 1, 0], 30deg).round(0.1) | sphere(0.2).move([3, 0, 0]);",
     "box([1, 1, 1])", "show sphere(0.2).move([3, 0, 0]);"},
};

/* The same distance at points in and around both. */
static void expect_same_distance(const KrsScene *a, const KrsScene *b, const char *text)
{
    KrsState *states[2];
    uint64_t  random = 7;
    assert_int_equal(krs_state_new(a, &states[0]), KRS_OK);
    assert_int_equal(krs_state_new(b, &states[1]), KRS_OK);
    for (int i = 0; i < 500; i++) {
        double point[1][3], found[2];
        for (int k = 0; k < 3; k++)
            point[0][k] = 8 * splitmix_unit(&random) - 4;
        for (int k = 0; k < 2; k++)
            krs_distance(states[k], (const double(*)[3])point, 1, &found[k]);
        if (!(fabs(found[0] - found[1]) < 1e-9))
            fail_msg("%s: %.9g, by hand %.9g", text, found[0], found[1]);
    }
    krs_state_free(states[0]);
    krs_state_free(states[1]);
}

static void a_part_is_left_out(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof lefts / sizeof *lefts; i++) {
        const KrsLocation location = location_of(lefts[i].text, lefts[i].part);
        KrsScene         *without  = compile(lefts[i].text, &location);
        KrsScene         *by_hand  = compile(lefts[i].by_hand, NULL);
        KrsScene         *whole    = compile(lefts[i].text, NULL);
        expect_same_distance(without, by_hand, lefts[i].text);
        const double flops = krs_scene_program(without)->flops;
        if (fabs(flops - krs_scene_program(by_hand)->flops) > 1e-9 ||
            krs_scene_program(whole)->flops <= flops)
            fail_msg("%s: %g flops, without the part %g, by hand %g", lefts[i].text,
                     krs_scene_program(whole)->flops, flops, krs_scene_program(by_hand)->flops);
        krs_scene_free(without);
        krs_scene_free(by_hand);
        krs_scene_free(whole);
    }
}

/* What follows from the size of the scene does not move. */
static void the_box_stays(void **state)
{
    (void)state;
    const char       *text     = "show sphere(1); show box([1, 1, 1]).move([9, -7, 0]);";
    const KrsLocation location = location_of(text, "box([1, 1, 1])");
    KrsScene         *whole = compile(text, NULL), *without = compile(text, &location);
    for (int k = 0; k < 3; k++) {
        assert_true(krs_scene_program(whole)->low[k] == krs_scene_program(without)->low[k]);
        assert_true(krs_scene_program(whole)->high[k] == krs_scene_program(without)->high[k]);
    }
    krs_scene_free(whole);
    krs_scene_free(without);
}

/* An update has the options of the first compilation. */
static void an_update_leaves_the_same_place_out(void **state)
{
    (void)state;
    const char *text     = "show torus(1, 0.25) | sphere(1);",
               *edited   = "show torus(1, 0.15) | sphere(1);";
    KrsLocation location = location_of(text, "torus(1, 0.25)");
    KrsScene   *scene    = compile(text, &location), *updated;
    location             = (KrsLocation){0};
    assert_int_equal(krs_scene_update(scene, edited, strlen(edited), &updated, NULL), KRS_OK);
    KrsScene *by_hand = compile("show sphere(1);", NULL);
    expect_same_distance(updated, by_hand, edited);
    krs_scene_free(updated);
    krs_scene_free(by_hand);
    krs_scene_free(scene);
}

/* ---- parts ---- */

static const char wheel[] = "let rim = torus(1, 0.1).rotate([1, 0, 0], 90deg);\n"
                            "def spoke(i) = box([0.1, 2, 0.1]).rotate([0, 0, 1], i * 20deg);\n"
                            "let wheel = union([\n"
                            "    rim,\n"
                            "    union([spoke(i) for i in 0..9]),\n"
                            "    sphere(0.2) - cylinder(0.1, 1),\n"
                            "]).move([0, 1, 0]);\n"
                            "show wheel;\n"
                            "for i in 0..3 { show sphere(0.1).move([i, 0, 0]); }\n"
                            "show plane([0, 1, 0], 0);\n";

static void expect_part(const Parts *parts, const char *name, uint32_t line, const char *parent,
                        size_t count)
{
    for (size_t i = 0; i < parts->count; i++) {
        const Part *part = &parts->items[i];
        if (strcmp(part->name, name) != 0 || part->location.line != line)
            continue;
        const char *found = part->parent == NO_PART ? "" : parts->items[part->parent].name;
        assert_string_equal(found, parent);
        assert_int_equal(part->count, count);
        return;
    }
    for (size_t i = 0; i < parts->count; i++)
        print_message("%s, line %u\n", parts->items[i].name, parts->items[i].location.line);
    fail_msg("no part `%s` of line %u", name, line);
}

static void parts_are_what_the_author_can_point_at(void **state)
{
    (void)state;
    Memory      memory = {0};
    Arena       arena  = {.memory = &memory};
    KrsScene   *scene  = compile(wheel, NULL);
    const Parts parts  = parts_of(scene, &arena);
    expect_part(&parts, "wheel", 8, "", 1);
    expect_part(&parts, "rim", 1, "wheel", 1);
    expect_part(&parts, "box", 2, "union", 9);
    expect_part(&parts, "sphere", 6, "difference", 1);
    expect_part(&parts, "cylinder", 6, "difference", 1);
    expect_part(&parts, "sphere", 9, "", 3);
    for (size_t i = 0; i < parts.count; i++)
        assert_true(parts.items[i].parent == NO_PART || parts.items[i].parent < i);
    krs_scene_free(scene);
    arena_free(&arena);
}

/* ---- rows ---- */

enum { PARTS = 7 };
static Part        made[]     = {{.name = "a", .parent = NO_PART}, {.name = "b", .parent = NO_PART},
                                 {.name = "b1", .parent = 1},      {.name = "b2", .parent = 1},
                                 {.name = "c", .parent = NO_PART}, {.name = "d", .parent = 0, .shared = true},
                                 {.name = "d1", .parent = 5}};
static const Parts made_parts = {made, PARTS, PARTS};

static Profile rows_of(const double ms[PARTS], Arena *arena)
{
    PartProfile found[PARTS] = {{0}};
    Profile     profile      = {.frame_ms = 100, .whole = {1000, 100, 10000}};
    for (int i = 0; i < PARTS; i++) {
        found[i].timed = !isnan(ms[i]);
        found[i].ms    = ms[i];
        found[i].cost  = (PartCost){fmax(10 * ms[i], 0), 1, 10};
    }
    profile_rows(&made_parts, found, arena, &profile);
    double sum = 0;
    for (size_t i = 0; i <= profile.others; i++) {
        sum += profile.rows[i].share;
        assert_true(profile.rows[i].share >= 0);
        assert_true(i + 1 >= profile.others || profile.rows[i].share >= profile.rows[i + 1].share);
    }
    assert_true(fabs(sum - 1) < 1e-12);
    assert_null(profile.rows[profile.others].part);
    return profile;
}

static void expect_row(const Profile *profile, size_t index, const char *name, bool rest,
                       double share)
{
    const ProfileRow *row = &profile->rows[index];
    assert_true(index < profile->row_count);
    assert_string_equal(row->part ? row->part->name : "", name);
    assert_true(row->rest == rest && fabs(row->share - share) < 1e-12);
}

static void shares_are_the_whole_frame(void **state)
{
    (void)state;
    Memory  memory  = {0};
    Arena   arena   = {.memory = &memory};
    Profile profile = rows_of((double[PARTS]){20, 50, 30, 1, NAN, NAN, NAN}, &arena);
    assert_int_equal(profile.row_count, 4);
    expect_row(&profile, 0, "b1", false, 0.3);
    expect_row(&profile, 1, "a", false, 0.2);
    expect_row(&profile, 2, "b", true, 0.2);
    expect_row(&profile, 3, "", false, 0.3);
    assert_true(fabs(profile.rows[2].cost.flops - 200) < 1e-9); /* of the rest of b */
    assert_true(fabs(profile.rows[3].cost.flops - 300) < 1e-9); /* of all others */

    /* What hides more than it costs, and what costs next to nothing, has no row. */
    profile = rows_of((double[PARTS]){-30, 1, NAN, NAN, 60, 1, NAN}, &arena);
    assert_int_equal(profile.row_count, 2);
    expect_row(&profile, 0, "c", false, 0.6);
    expect_row(&profile, 1, "", false, 0.4);

    /* Without any of three each time saves more than there is, as where all three reflect each other. */
    profile = rows_of((double[PARTS]){90, 90, NAN, NAN, 60, NAN, NAN}, &arena);
    assert_int_equal(profile.row_count, 4);
    expect_row(&profile, 0, "a", false, 90 / 240.0);
    expect_row(&profile, 2, "c", false, 60 / 240.0);
    assert_true(profile.rows[0].ms == 90);

    /* Likewise within a part. */
    profile = rows_of((double[PARTS]){0, 50, 40, 60, 0, NAN, NAN}, &arena);
    assert_int_equal(profile.row_count, 3);
    expect_row(&profile, 0, "b2", false, 0.3);
    expect_row(&profile, 1, "b1", false, 0.2);
    expect_row(&profile, 2, "", false, 0.5);

    /* What several have in common is not taken from any of them. */
    profile = rows_of((double[PARTS]){30, 40, NAN, NAN, 10, 50, 20}, &arena);
    assert_int_equal(profile.row_count, 6);
    assert_int_equal(profile.others, 3);
    expect_row(&profile, 1, "a", false, 0.3);
    expect_row(&profile, 3, "", false, 0.2);
    expect_row(&profile, 4, "d", false, 0.5);
    expect_row(&profile, 5, "d1", false, 0.2);
    arena_free(&arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_part_is_left_out),
        cmocka_unit_test(the_box_stays),
        cmocka_unit_test(an_update_leaves_the_same_place_out),
        cmocka_unit_test(parts_are_what_the_author_can_point_at),
        cmocka_unit_test(shares_are_the_whole_frame),
    };
    return cmocka_run_group_tests_name("profiles", tests, NULL, NULL);
}
