/*
 * update.c: edited texts of a scene: what is said to be different, and what states keep.
 *
 * An updated scene is the scene that its text alone makes: distances, cameras and slots are equal.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/support/random.h"
#include "tests/support/same_scene.h"
#include "tests/support/scarce.h"

typedef struct Heard {
    int  errors;
    char code[8], source[32];
} Heard;

static void hear(void *user, const KrsDiagnostic *diagnostic)
{
    Heard *heard = user;
    heard->errors += diagnostic->error;
    snprintf(heard->code, sizeof heard->code, "%s", diagnostic->code);
    snprintf(heard->source, sizeof heard->source, "%s", diagnostic->source);
}

static KrsScene *compile_with(const char *text, const KrsOptions *options)
{
    KrsScene *scene;
    assert_int_equal(krs_compile_text(text, strlen(text), "edited.krs", options, &scene), KRS_OK);
    return scene;
}

static KrsScene *compile(const char *text, KrsSpecialize specialize)
{
    return compile_with(text, &(KrsOptions){.specialize = specialize});
}

static KrsScene *update(const KrsScene *scene, const char *text, KrsChanges *changes)
{
    KrsScene *updated;
    assert_int_equal(krs_scene_update(scene, text, strlen(text), &updated, changes), KRS_OK);
    return updated;
}

/* ---- what is different ---- */

#define BEFORE                                                    \
    "param r = 1 in [0.5, 2];\n"                                  \
    "material m { color: #ff8000, roughness: 0.5 }\n"             \
    "let ball = sphere(r).move([0.25, 0, 0]);\n"                  \
    "show union([ball, box([2, 1, 1])], blend: 0.25).paint(m);\n" \
    "camera front { eye: [4, 3, 5], fov: 0.7 }\n"                 \
    "light sun { direction: [1, 2, 3], intensity: 2 }\n"

typedef struct Edit {
    const char *what, *from, *to;
    KrsChange   kind;
    bool        parameters, components, cameras, lights, image, solids, surfaces;
} Edit;

static const Edit edits[] = {
    {"nothing", "", "", KRS_CHANGE_NOTHING, 0, 0, 0, 0, 0, 0, 0},
    {"a comment", "show", "// the ball\n\n  show", KRS_CHANGE_NOTHING, 0, 0, 0, 0, 0, 0, 0},
    {"a name of a camera", "front", "side", KRS_CHANGE_VALUES, 0, 0, 1, 0, 0, 0, 0},
    {"a place", "0.25, 0, 0", "0.5, 0.1, 0", KRS_CHANGE_VALUES, 0, 0, 0, 0, 0, 1, 1},
    {"a size", "[2, 1, 1]", "[2, 1.5, 1]", KRS_CHANGE_VALUES, 0, 0, 0, 0, 0, 1, 1},
    {"a width", "blend: 0.25", "blend: 0.3", KRS_CHANGE_VALUES, 0, 0, 0, 0, 0, 1, 1},
    {"a colour", "#ff8000", "#20c040", KRS_CHANGE_VALUES, 0, 0, 0, 0, 0, 0, 1},
    {"a material", "roughness: 0.5", "roughness: 0.3", KRS_CHANGE_VALUES, 0, 0, 0, 0, 0, 0, 1},
    {"a name of a component", "show union([ball, box([2, 1, 1])], blend: 0.25).paint(m);",
     "let part = union([ball, box([2, 1, 1])], blend: 0.25).paint(m); show part;",
     KRS_CHANGE_NOTHING, 0, 1, 0, 0, 0, 0, 1},
    {"a default", "r = 1", "r = 1.5", KRS_CHANGE_VALUES, 1, 0, 0, 0, 0, 1, 1},
    {"an eye", "[4, 3, 5]", "[4, 3, 6]", KRS_CHANGE_VALUES, 0, 0, 1, 0, 0, 0, 0},
    {"another camera", "light", "camera { eye: [1, 9, 1] } light", KRS_CHANGE_VALUES, 0, 0, 1, 0, 0,
     0, 0},
    {"a light", "intensity: 2", "intensity: 3", KRS_CHANGE_VALUES, 0, 0, 0, 1, 0, 0, 0},
    {"another light", "light", "light { direction: [0, 1, 0] } light", KRS_CHANGE_VALUES, 0, 0, 0,
     1, 0, 0, 0},
    {"a sky", "light", "sky { zenith: #8090ff } light", KRS_CHANGE_VALUES, 0, 0, 0, 1, 0, 0, 0},
    {"fog", "light", "fog { density: 0.1 } light", KRS_CHANGE_VALUES, 0, 0, 0, 1, 0, 0, 0},
    {"a picture", "light", "image { size: [64, 48] } light", KRS_CHANGE_VALUES, 0, 0, 0, 0, 1, 0,
     0},
    {"another parameter", "let", "param s = 1; let", KRS_CHANGE_STRUCTURE, 1, 0, 0, 0, 0, 1, 1},
    {"another shape", "box([2, 1, 1])", "cylinder(0.5, 2)", KRS_CHANGE_STRUCTURE, 0, 0, 0, 0, 0, 1,
     1},
    {"another operator", ", blend: 0.25", "", KRS_CHANGE_STRUCTURE, 0, 0, 0, 0, 0, 1, 1},
    {"another component", "light", "show torus(3, 0.2); light", KRS_CHANGE_STRUCTURE, 0, 1, 0, 0, 0,
     1, 1},
};

/* Returns the text with the first occurrence of one string replaced by another. */
static const char *edited(const char *text, const char *from, const char *to)
{
    static char result[2000];
    const char *at = strstr(text, from);
    assert_non_null(at);
    snprintf(result, sizeof result, "%.*s%s%s", (int)(at - text), text, to, at + strlen(from));
    return result;
}

static void assert_changes(const Edit *edit, const KrsChanges *changes)
{
    if (changes->kind != edit->kind || changes->parameters != edit->parameters ||
        changes->components != edit->components || changes->cameras != edit->cameras ||
        changes->lights != edit->lights || changes->image != edit->image ||
        changes->solids != edit->solids || changes->surfaces != edit->surfaces)
        fail_msg("%s: kind %d, parameters %d, components %d, cameras %d, lights %d, image %d, "
                 "solids %d, surfaces %d",
                 edit->what, changes->kind, changes->parameters, changes->components,
                 changes->cameras, changes->lights, changes->image, changes->solids,
                 changes->surfaces);
}

static void changes_are_told(void **context)
{
    (void)context;
    KrsScene *scene = compile(BEFORE, KRS_SPECIALIZE_STRUCTURE);
    for (size_t i = 0; i < sizeof edits / sizeof *edits; i++) {
        KrsChanges  changes, back;
        const char *text    = edited(BEFORE, edits[i].from, edits[i].to);
        KrsScene   *updated = update(scene, text, &changes);
        KrsScene   *alone   = compile(text, KRS_SPECIALIZE_STRUCTURE);
        KrsScene   *undone  = update(updated, BEFORE, &back);
        assert_changes(&edits[i], &changes);
        assert_int_equal(back.kind, changes.kind);
        assert_int_equal(same_shaders(scene, updated), changes.kind != KRS_CHANGE_STRUCTURE);
        assert_same_scene(updated, alone);
        assert_same_scene(undone, scene);
        krs_scene_free(undone);
        krs_scene_free(alone);
        krs_scene_free(updated);
    }
    krs_scene_free(scene);
}

static void literals_are_structure(void **context)
{
    (void)context;
    KrsChanges  changes;
    const char *text    = edited(BEFORE, "[2, 1, 1]", "[2, 1.5, 1]");
    KrsScene   *scene   = compile(BEFORE, KRS_SPECIALIZE_NUMBERS);
    KrsScene   *updated = update(scene, text, &changes);
    assert_int_equal(changes.kind, KRS_CHANGE_STRUCTURE);
    assert_false(same_shaders(scene, updated));
    krs_scene_free(updated);
    krs_scene_free(scene);
}

static void auto_takes_numbers_out_with_the_first_edit(void **context)
{
    (void)context;
    KrsChanges changes;
    KrsScene  *literal = compile(BEFORE, KRS_SPECIALIZE_NUMBERS);
    KrsScene  *scene   = compile(BEFORE, KRS_SPECIALIZE_AUTO);
    assert_true(same_shaders(scene, literal));
    KrsScene *first = update(scene, edited(BEFORE, "0.25, 0, 0", "0.5, 0, 0"), &changes);
    assert_int_equal(changes.kind, KRS_CHANGE_STRUCTURE);
    KrsScene *second = update(first, edited(BEFORE, "0.25, 0, 0", "0.75, 0, 0"), &changes);
    assert_int_equal(changes.kind, KRS_CHANGE_VALUES);
    assert_true(same_shaders(first, second));
    krs_scene_free(second);
    krs_scene_free(first);
    krs_scene_free(scene);
    krs_scene_free(literal);
}

/* Sixty parts of each of twelve kinds: too few for instance groups, and thousands of numbers. */
#define MANY                                                                                 \
    "def solids(t) = [sphere(0.3 + t), box([0.2, 0.3, 0.2 + t]), cylinder(0.2 + t, 0.3),"    \
    " torus(0.3, 0.1 + t), capped_cone(0.1 + t, 0.2, 0.3), ellipsoid([0.1, 0.2, 0.2 + t])];" \
    "let more = 0.0001;"                                                                     \
    "show union([[s.move([i % 8 + 0.1, floor(i / 8), 2]),"                                   \
    " s.rotate([0, 0, 1], 1deg * i + 0.01).move([i % 8, 9.2, floor(i / 8)])]"                \
    " for i in 0..60 for s in solids(0.001 * i + more)]);"

/* Functions of a medium are in shaders, too. */
static void media_are_compared(void **context)
{
    static const char before[] = "param a = 1; medium { within: sphere(1), density: 1 + a * x }\n"
                                 "show box([4, 0.1, 4]);";
    static const struct {
        const char *from, *to;
        KrsChange   kind;
    } changed[] = {
        {"1 + a", "1 + a", KRS_CHANGE_NOTHING},
        {"1 + a * x", "2 + a * x", KRS_CHANGE_VALUES},
        {"1 + a * x", "1 + a * x * x", KRS_CHANGE_STRUCTURE},
        {"density", "emission: [x * x, 1, 1], density", KRS_CHANGE_STRUCTURE},
    };
    (void)context;
    KrsScene *scene = compile(before, KRS_SPECIALIZE_STRUCTURE);
    for (size_t i = 0; i < sizeof changed / sizeof *changed; i++) {
        KrsChanges changes;
        KrsScene *updated = update(scene, edited(before, changed[i].from, changed[i].to), &changes);
        if (changes.kind != changed[i].kind)
            fail_msg("%s: %d", changed[i].to, changes.kind);
        krs_scene_free(updated);
    }
    krs_scene_free(scene);
}

static void auto_keeps_very_many_numbers(void **context)
{
    (void)context;
    KrsChanges  changes;
    const char *text      = edited(MANY, "0.0001", "0.0002");
    KrsScene   *structure = compile(MANY, KRS_SPECIALIZE_STRUCTURE);
    KrsScene   *scene     = compile(MANY, KRS_SPECIALIZE_AUTO);
    KrsScene   *first     = update(scene, text, &changes);
    KrsScene   *literal   = compile(text, KRS_SPECIALIZE_NUMBERS);
    KrsScene   *second    = update(first, MANY, &changes);
    KrsScene   *few       = update(second, BEFORE, &changes);
    KrsScene   *again     = update(few, MANY, &changes);
    assert_false(krs_structure_is_affordable(structure));
    assert_true(same_shaders(again, scene));
    krs_scene_free(again);
    krs_scene_free(few);
    assert_true(same_shaders(first, literal));
    assert_true(same_shaders(second, scene));
    krs_scene_free(second);
    krs_scene_free(literal);
    krs_scene_free(first);
    krs_scene_free(scene);
    krs_scene_free(structure);
}

/* ---- instance groups ---- */

/* An instance group of 100 balls, of which one is lifted; and a block that is far away. */
#define GROUP                                                                               \
    "let lift = 0.2; let radius = 0.3;"                                                     \
    "show union([sphere(radius).move([i % 10, if i == 55 then lift else 0, floor(i / 10)])" \
    " for i in 0..100]).paint(#ff8000);"                                                    \
    "show box([1, 9, 1]).move([0, 0, -9]); camera { eye: [4, 3, 15] }"

typedef struct InstanceEdit {
    const char *what, *from, *to;
    KrsChange   with_literals, with_slots;
} InstanceEdit;

static const InstanceEdit instance_edits[] = {
    {"nothing", "", "", KRS_CHANGE_NOTHING, KRS_CHANGE_NOTHING},
    {"a comment", "show", "// balls\n show", KRS_CHANGE_NOTHING, KRS_CHANGE_NOTHING},
    {"one moves aside", "[i % 10,", "[if i == 55 then 5.1 else i % 10,", KRS_CHANGE_VALUES,
     KRS_CHANGE_VALUES},
    {"one grows the box", "0.2", "0.3", KRS_CHANGE_STRUCTURE, KRS_CHANGE_VALUES},
    {"one is left out", "0..100", "0..99", KRS_CHANGE_VALUES, KRS_CHANGE_VALUES},
    {"some grow the box", "0..100", "0..112", KRS_CHANGE_STRUCTURE, KRS_CHANGE_VALUES},
    {"all have another size", "0.3", "0.31", KRS_CHANGE_STRUCTURE, KRS_CHANGE_VALUES},
    {"each has its size", "sphere(radius)", "sphere(radius + 0.001 * i)", KRS_CHANGE_STRUCTURE,
     KRS_CHANGE_STRUCTURE},
    {"too few for an instance group", "0..100", "50..60", KRS_CHANGE_STRUCTURE,
     KRS_CHANGE_STRUCTURE},
    {"other parts", "sphere(radius)", "box([radius, 0.1, 0.2])", KRS_CHANGE_STRUCTURE,
     KRS_CHANGE_STRUCTURE},
};

static void assert_instance_edit(const InstanceEdit *edit, KrsSpecialize specialize)
{
    KrsChanges      changes, back;
    const bool      slots    = specialize == KRS_SPECIALIZE_STRUCTURE;
    const KrsChange expected = slots ? edit->with_slots : edit->with_literals;
    const char     *text     = edited(GROUP, edit->from, edit->to);
    KrsScene       *scene    = compile(GROUP, specialize);
    KrsScene       *updated  = update(scene, text, &changes);
    KrsScene       *alone    = compile(text, specialize);
    KrsScene       *undone   = update(updated, GROUP, &back);
    assert_true(krs_table_rows(scene) > 0);
    if (changes.kind != expected || back.kind != expected)
        fail_msg("%s: %d, and back %d", edit->what, changes.kind, back.kind);
    assert_int_equal(same_shaders(scene, updated), expected != KRS_CHANGE_STRUCTURE);
    assert_same_scene(updated, alone);
    assert_same_scene(undone, scene);
    krs_scene_free(undone);
    krs_scene_free(alone);
    krs_scene_free(updated);
    krs_scene_free(scene);
}

static void tables_are_values(void **context)
{
    (void)context;
    for (size_t i = 0; i < sizeof instance_edits / sizeof *instance_edits; i++) {
        assert_instance_edit(&instance_edits[i], KRS_SPECIALIZE_NUMBERS);
        assert_instance_edit(&instance_edits[i], KRS_SPECIALIZE_STRUCTURE);
    }
}

/* Instances with the same numbers and the same boxes: only operations of the body tell them apart. */
static void bodies_are_compared(void **context)
{
    (void)context;
    const char *waves = "show union([sphere(0.1).displace(0.01 * sin(20 * x))"
                        ".move([i % 10, 0, floor(i / 10)]) for i in 0..100]);";
    KrsChanges  changes;
    char        others[200];
    snprintf(others, sizeof others, "%s", edited(waves, "sin", "cos"));
    KrsScene *scene   = compile(waves, KRS_SPECIALIZE_NUMBERS);
    KrsScene *updated = update(scene, others, &changes);
    assert_true(krs_table_rows(scene) > 0 && krs_table_rows(updated) > 0);
    assert_int_equal(changes.kind, KRS_CHANGE_STRUCTURE);
    assert_true(changes.solids && changes.surfaces);
    assert_false(same_shaders(scene, updated));
    krs_scene_free(updated);
    krs_scene_free(scene);
}

/* ---- loops that are evaluated once ---- */

#define STREET                                                                                  \
    "let wall = 1.5; let colors = [#efe3cf, #c9d2d3, #e3b7a0];"                                 \
    "def house(i) = box([1 + 0.5 * random(2 * i), wall, 1]).rotate([0, 1, 0], 0.3 * random(i))" \
    " .paint(colors[floor(len(colors) * random(i + 0.5))]);"                                    \
    "show union([house(i).move([3 * (i % 10), 0, 2.5 * floor(i / 10)])"                         \
    " for i in 0..100 if random(i + 0.7) < 0.9]); camera { eye: [4, 9, 15] }"

static const char *const street_edits[][2] = {
    {"0.5 * random", "0.6 * random"},
    {"wall = 1.5", "wall = 1.6"},
    {"#c9d2d3", "#d0d040"},
    {"0.3 * random", "0.2 * random"},
    {"3 * (", "3.1 * ("},
    {"i + 0.5", "i + 0.25"},
    {"< 0.9", "< 0.8"},
};

static void numbers_of_loops_are_values(void **context)
{
    (void)context;
    KrsScene *scene = compile(STREET, KRS_SPECIALIZE_STRUCTURE);
    for (size_t i = 0; i < sizeof street_edits / sizeof *street_edits; i++) {
        KrsChanges  changes;
        const char *text    = edited(STREET, street_edits[i][0], street_edits[i][1]);
        KrsScene   *updated = update(scene, text, &changes);
        KrsScene   *alone   = compile(text, KRS_SPECIALIZE_STRUCTURE);
        if (changes.kind != KRS_CHANGE_VALUES)
            fail_msg("%s: %d", street_edits[i][0], changes.kind);
        assert_true(same_shaders(scene, updated));
        assert_same_scene(updated, alone);
        krs_scene_free(alone);
        krs_scene_free(updated);
    }
    krs_scene_free(scene);
}

/* ---- mistakes, and what is kept of the first compilation ---- */

static void mistakes_leave_the_scene(void **context)
{
    (void)context;
    Heard       heard = {0};
    KrsChanges  changes;
    KrsScene   *updated;
    KrsState   *state;
    const char *wrong = "show sphere(rr);";
    KrsScene   *scene = compile_with(
          BEFORE,
          &(KrsOptions){.diagnostic = hear, .user = &heard, .specialize = KRS_SPECIALIZE_STRUCTURE});
    KrsScene *alone = compile(BEFORE, KRS_SPECIALIZE_STRUCTURE);
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    assert_int_equal(krs_scene_update(scene, wrong, strlen(wrong), &updated, &changes),
                     KRS_BAD_SCENE);
    assert_null(updated);
    assert_int_equal(heard.errors, 1);
    assert_string_equal(heard.code, "E0201");
    assert_string_equal(heard.source, "edited.krs");
    assert_int_equal(krs_state_set(state, "r", (double[]){2}, 1), KRS_OK);
    assert_same_scene(scene, alone);
    krs_state_free(state);
    krs_scene_free(alone);
    krs_scene_free(scene);
}

static const char *load(void *user, const char *path, size_t *length)
{
    const char **text = user;
    if (strcmp(path, "inner/part.krs") != 0)
        return NULL;
    *length = strlen(*text);
    return *text;
}

/* The path of what is used begins with the scene's folder; the options may be gone by then. */
static void used_files_are_read_again(void **context)
{
    (void)context;
    static const char scene_text[] = "use \"part.krs\"; show part;";
    const char       *part         = "let part = sphere(1);";
    KrsChanges        changes;
    KrsScene         *scene, *updated;
    {
        KrsOptions options = {
            .load = load, .load_user = &part, .specialize = KRS_SPECIALIZE_STRUCTURE};
        char name[] = "inner/scene.krs";
        assert_int_equal(krs_compile_text(scene_text, strlen(scene_text), name, &options, &scene),
                         KRS_OK);
        memset(name, 'x', sizeof name - 1);
        memset(&options, 0, sizeof options);
    }
    part    = "let part = sphere(2);";
    updated = update(scene, scene_text, &changes);
    assert_int_equal(changes.kind, KRS_CHANGE_VALUES);
    krs_scene_free(scene);
    part  = "let part = box([1, 1, 1]);";
    scene = update(updated, scene_text, &changes);
    assert_int_equal(changes.kind, KRS_CHANGE_STRUCTURE);
    krs_scene_free(scene);
    krs_scene_free(updated);
}

static void memory_may_run_out(void **context)
{
    (void)context;
    Scarce     scarce  = {0};
    KrsStatus  status  = KRS_OUT_OF_MEMORY;
    int        refused = 0;
    KrsChanges changes;
    KrsScene  *updated,
        *scene   = compile_with(BEFORE, &(KrsOptions){.allocator  = scarce_allocator(&scarce),
                                                      .specialize = KRS_SPECIALIZE_STRUCTURE});
    int64_t held = scarce.held;
    for (int64_t failing = 1; status != KRS_OK; failing++) {
        scarce.made    = 0;
        scarce.failing = failing;
        status         = krs_scene_update(scene, edited(BEFORE, "box([2, 1, 1])", "sphere(1)"),
                                          strlen(edited(BEFORE, "box([2, 1, 1])", "sphere(1)")), &updated,
                                          &changes);
        assert_true(status == KRS_OK || (status == KRS_OUT_OF_MEMORY && !updated));
        assert_true(status == KRS_OK || scarce.held == held);
        refused += status != KRS_OK;
    }
    assert_true(refused > 2);
    scarce.failing = 0;
    krs_scene_free(updated);
    krs_scene_free(scene);
    assert_int_equal(scarce.held, 0);
}

/* ---- states ---- */

static double distance_at(KrsState *state, double x)
{
    double point[1][3] = {{x, 0, 0}}, distance;
    assert_int_equal(krs_distance(state, (const double(*)[3])point, 1, &distance), KRS_OK);
    return distance;
}

static KrsState *state_of(const KrsScene *scene)
{
    KrsState *state;
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    return state;
}

static void states_follow(void **context)
{
    (void)context;
    KrsScene *scene = compile("param r = 1 in [0.5, 4]; param at = 2; param gone = 1;"
                              "show sphere(r).move([at + time + 0 * gone, 0, 0]);",
                              KRS_SPECIALIZE_STRUCTURE);
    KrsState *state = state_of(scene), *other = state_of(scene);
    assert_int_equal(krs_state_set(state, "r", (double[]){3}, 1), KRS_OK);
    assert_int_equal(krs_state_set(state, "gone", (double[]){5}, 1), KRS_OK);
    assert_int_equal(krs_state_set_time(state, 10), KRS_OK);
    assert_int_equal(krs_state_set_zones(state, (const double[][4]){{0, 0, 0, 0.5}}, 1), KRS_OK);
    const double before = distance_at(other, 9);

    /* The radius was set; the place was not, so that it is the new default. */
    const char *text    = "param at = 4; param r = 1 in [0.5, 4];"
                          "show sphere(r).move([at + time, 0, 0]);";
    KrsScene   *updated = update(scene, text, NULL);
    assert_int_equal(krs_state_update(state, updated), KRS_OK);
    assert_true(distance_at(other, 9) == before);
    assert_true(fabs(distance_at(state, 20) - (20 - 14 - 3)) < 1e-12);

    /* A value that the other scene does not permit is left out. */
    text = "param r = 1 in [0.5, 2]; param at = 4; show sphere(r).move([at + time, 0, 0]);";
    KrsScene *third = update(updated, text, NULL);
    assert_int_equal(krs_state_update(state, third), KRS_OK);
    krs_scene_free(updated);
    assert_true(fabs(distance_at(state, 20) - (20 - 14 - 1)) < 1e-12);

    /* The zone is there still. */
    assert_int_equal(krs_state_set_time(state, -4), KRS_OK);
    assert_true(distance_at(state, 0) > 0);
    assert_int_equal(krs_state_set_zones(state, NULL, 0), KRS_OK);
    assert_true(distance_at(state, 0) < 0);
    krs_state_free(state);
    krs_state_free(other);
    krs_scene_free(third);
    krs_scene_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(changes_are_told),
        cmocka_unit_test(literals_are_structure),
        cmocka_unit_test(auto_takes_numbers_out_with_the_first_edit),
        cmocka_unit_test(media_are_compared),
        cmocka_unit_test(auto_keeps_very_many_numbers),
        cmocka_unit_test(tables_are_values),
        cmocka_unit_test(bodies_are_compared),
        cmocka_unit_test(numbers_of_loops_are_values),
        cmocka_unit_test(mistakes_leave_the_scene),
        cmocka_unit_test(used_files_are_read_again),
        cmocka_unit_test(memory_may_run_out),
        cmocka_unit_test(states_follow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
