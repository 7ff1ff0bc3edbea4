/*
 * specialize.c: scenes whose numbers are apart from their shaders are the same scenes, and an edit of
 * a number leaves the text of their kernels as it is.
 *
 * Distances of every example, and pictures of some, agree with those of literals.  Numbers of the
 * examples are changed one by one: whatever counts or chooses nothing leaves the text alone, and
 * what the edited scene shows is what a program made of literals shows.
 */
#include <ctype.h>
#include <glob.h>
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
#include "tests/support/renderer.h"

enum { EDITS = 4, MAX_NUMBERS = 2000 };

/* ---- Texts ---- */

static char *read_text(const char *path)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    const long length = ftell(file);
    rewind(file);
    char *text = calloc((size_t)length + 1, 1);
    assert_int_equal(fread(text, 1, (size_t)length, file), (size_t)length);
    fclose(file);
    return text;
}

/* Behind a comment or a string that begins here; else the same place. */
static const char *skip_words(const char *at)
{
    if (at[0] == '"')
        return strchr(at + 1, '"') + 1;
    if (at[0] == '/' && at[1] == '/')
        return at + strcspn(at, "\n");
    return at;
}

/* Where the numbers of a text begin, but for those in names, colours, comments and strings. */
static size_t find_numbers(const char *text, const char *numbers[MAX_NUMBERS])
{
    size_t count = 0;
    for (const char *at = text; *at && count < MAX_NUMBERS;) {
        const char *behind = skip_words(at);
        if (behind != at) {
            at = behind;
        } else if (isalpha((unsigned char)*at) || *at == '_' || *at == '#') {
            at += 1 +
                  strspn(at + 1, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789");
        } else if (isdigit((unsigned char)*at)) {
            char *end;
            numbers[count++] = at;
            strtod(at, &end);
            /* "0..4" is a range of whole numbers. */
            at += strncmp(at + strspn(at, "0123456789"), "..", 2) == 0 ? strspn(at, "0123456789")
                                                                       : (size_t)(end - at);
        } else {
            at++;
        }
    }
    return count;
}

/* Returns the text with that number a little larger. */
static char *edit(const char *text, const char *number)
{
    char        *end, *edited = malloc(strlen(text) + 40);
    const char  *dots  = strstr(number, "..");
    const double value = strtod(number, &end);
    if (dots && dots < end)
        end = (char *)dots;
    sprintf(edited, "%.*s%.9g%s", (int)(number - text), text, value == 0 ? 0.013 : 1.013 * value,
            end);
    return edited;
}

/* ---- Scenes ---- */

static KrsScene *compile(const char *text, const char *name, KrsSpecialize specialize)
{
    const KrsOptions options = {.specialize = specialize};
    KrsScene        *scene   = NULL;
    krs_compile_text(text, strlen(text), name, &options, &scene);
    return scene;
}

/* Returns the text of a kernel that marches and shades, of a processor or of a graphics card,
   without comments. */
static char *kernel_text_of(const KrsScene *scene, bool card)
{
    const KrsVariant  variant  = {.values = true, .many_threads = card};
    const KrsFunction wanted[] = {card ? KRS_FUNCTION_DISTANCE_LOD : KRS_FUNCTION_DISTANCE,
                                  KRS_FUNCTION_SURFACE};
    char *text = krs_scene_text(scene, &variant, wanted, 2, NULL), *to = text;
    assert_non_null(text);
    for (const char *from = text; *from;) {
        if (from[0] == '/' && from[1] == '/')
            from += strcspn(from, "\n");
        else
            *to++ = *from++;
    }
    *to = '\0';
    return text;
}

typedef struct Texts {
    char *of_processor, *of_card;
} Texts;

static Texts texts_of(const KrsScene *scene)
{
    return (Texts){kernel_text_of(scene, false), kernel_text_of(scene, true)};
}

static void free_texts(Texts texts)
{
    free(texts.of_processor);
    free(texts.of_card);
}

static bool has_texts(const KrsScene *scene, Texts wanted)
{
    Texts found = texts_of(scene);
    bool  same  = strcmp(found.of_processor, wanted.of_processor) == 0 &&
                strcmp(found.of_card, wanted.of_card) == 0;
    free_texts(found);
    return same;
}

/* Returns the largest difference of distances, as a part of the coordinates, at points in and
   around the box of the scene.  What is only a bound may be another one, but is one of the same
   solid. */
static double difference(const KrsScene *a, const KrsScene *b)
{
    KrsState *first, *second;
    Random    random = {1};
    double    most   = 0;
    assert_int_equal(krs_state_new(a, &first), KRS_OK);
    assert_int_equal(krs_state_new(b, &second), KRS_OK);
    for (int i = 0; i < 300; i++) {
        double point[1][3], x, y;
        random_vector(&random, i % 2 ? 2 : 12, point[0]);
        assert_int_equal(krs_distance(first, (const double(*)[3])point, 1, &x), KRS_OK);
        assert_int_equal(krs_distance(second, (const double(*)[3])point, 1, &y), KRS_OK);
        const bool far = (x > 0) == (y > 0) && fmin(fabs(x), fabs(y)) > 0.01;
        most           = fmax(most, (isinf(x) && isinf(y)) || far ? 0 : fabs(x - y) / 12);
    }
    krs_state_free(first);
    krs_state_free(second);
    return most;
}

/* ---- Examples ---- */

typedef struct Tally {
    int edits, same, told, literal_edits, literal_same;
} Tally;

static void edit_example(const char *text, const char *path, const KrsScene *scene,
                         const KrsScene *literal, Tally *tally)
{
    const char *numbers[MAX_NUMBERS];
    size_t      count  = find_numbers(text, numbers);
    Random      random = {count};
    Texts       right = texts_of(scene), of_literal = texts_of(literal);
    for (int i = 0; i < EDITS && count > 0; i++) {
        char      *edited = edit(text, numbers[random_below(&random, (int)count)]);
        KrsScene  *other;
        KrsChanges changes;
        krs_scene_update(scene, edited, strlen(edited), &other, &changes);
        const bool same = other && has_texts(other, right);
        const bool told = other && changes.kind != KRS_CHANGE_STRUCTURE;
        tally->edits += other != NULL; /* some numbers count, and must be whole */
        tally->same += same;
        tally->told += told;
        if (told && !same)
            fail_msg("%s: after an edit another text is said to be the same", path);
        KrsScene *plain = i < 2 && other ? compile(edited, path, KRS_SPECIALIZE_NUMBERS) : NULL;
        if (plain) {
            tally->literal_edits++;
            tally->literal_same += has_texts(plain, of_literal);
            assert_true(difference(plain, other) < 1e-9);
        }
        krs_scene_free(plain);
        krs_scene_free(other);
        free(edited);
    }
    free_texts(right);
    free_texts(of_literal);
}

static void examples_are_the_same(void **state)
{
    glob_t paths;
    Tally  tally = {0};
    (void)state;
    assert_int_equal(glob("examples/*.krs", 0, NULL, &paths), 0);
    for (size_t i = 0; i < paths.gl_pathc; i++) {
        const char *path    = paths.gl_pathv[i];
        char       *text    = read_text(path);
        KrsScene   *literal = compile(text, path, KRS_SPECIALIZE_NUMBERS);
        KrsScene   *scene   = compile(text, path, KRS_SPECIALIZE_STRUCTURE);
        if (!scene || !literal)
            fail_msg("%s does not compile", path);
        const double differs = difference(literal, scene);
        if (!(differs < 1e-9))
            fail_msg("%s: distances differ by %g", path, differs);
        edit_example(text, path, scene, literal, &tally);
        krs_scene_free(literal);
        krs_scene_free(scene);
        free(text);
    }
    globfree(&paths);
    print_message(
        "# %d of %d edits leave the text as it is, %d are said to; with literals %d of %d\n",
        tally.same, tally.edits, tally.told, tally.literal_same, tally.literal_edits);
    assert_in_range(tally.told, tally.same * 95 / 100, tally.same);
    assert_in_range(tally.same, tally.edits * 93 / 100, tally.edits);
    assert_in_range(tally.literal_same, 0, tally.literal_edits / 2);
}

/* ---- Vectors ---- */

/* Functions of vectors that are known give numbers that are known, as those of literals do, and may
   count.  The same function of the same vector is one number of the kernels. */
static void vectors_are_known(void **state)
{
    static const char counted[] =
        "let n = floor(length([3, 4])); let m = floor(dot([1, 2], [3, 1])"
        "  - distance([1, 1], [1, 3]) - cross([1, 0, 0], [0, 1, 0])[2]"
        "  + normalize([2, 0, 0])[0]);"
        "show union([sphere(0.4).move([i, k, 0]) for i in 0..n for k in 0..m]);";
    static const char once[]  = "let a = [0.3, 0.4]; let r = length(a);"
                                "show sphere(r) & cylinder(r, 2) & torus(1, r);";
    static const char twice[] = "let a = [0.3, 0.4]; def r() = length(a);"
                                "show sphere(r()) & cylinder(r(), 2) & torus(1, r());";
    (void)state;
    KrsScene *literal = compile(counted, "a.krs", KRS_SPECIALIZE_NUMBERS);
    KrsScene *scene   = compile(counted, "a.krs", KRS_SPECIALIZE_STRUCTURE);
    assert_non_null(literal);
    assert_non_null(scene);
    assert_true(difference(literal, scene) < 1e-9);
    krs_scene_free(literal);
    krs_scene_free(scene);
    KrsScene *one = compile(once, "a.krs", KRS_SPECIALIZE_STRUCTURE);
    KrsScene *two = compile(twice, "a.krs", KRS_SPECIALIZE_STRUCTURE);
    assert_int_equal(krs_value_slots(one), krs_value_slots(two));
    krs_scene_free(one);
    krs_scene_free(two);
}

/* ---- Pictures ---- */

/* What changes nothing but numbers: sizes, places, turns, colours, blends, sequences. */
static const char *const texts[][2] = {
    {"let r = 1; show union([sphere(r), box([1, 0.5, 2]).move([1, 0, 0])], blend: 0.25)"
     "  .paint(#ff8000); show plane([0, 1, 0], -1); camera { eye: [3, 2, 5] }",
     "let r = 0.8; show union([sphere(r), box([0.8, 0.6, 1]).move([0.9, 0.2, 0])], blend: 0.4)"
     "  .paint(#20c040); show plane([0, 1, 0.1], -1.2); camera { eye: [2, 3, 4] }"},
    {"show krs { kernel sphere(0.45); for i in 0..9 { reflect plane(random_direction(i),"
     "  0.4 + 0.2 * i); } }; camera { eye: [2, 6, 16], fov: 0.6 }",
     "show krs { kernel sphere(0.4); for i in 0..9 { reflect plane(random_direction(i + 7),"
     "  0.3 + 0.25 * i); } }; camera { eye: [3, 5, 16], fov: 0.6 }"},
    {"show torus(1, 0.3).rotate([0, 0, 1], 90deg).shell(0.1) & box([3, 3, 3]).move([0, 0, 1.5]);"
     "show cylinder(0.2, 2).repeat([1, 0, 1], [3, 1, 3]); camera { eye: [4, 3, 5] }",
     "show torus(1.1, 0.2).rotate([0, 1, 1], 40deg).shell(0.05) & box([3, 2, 3]).move([0, 0, 1.4]);"
     "show cylinder(0.1, 1.5).repeat([1.3, 0, 1.2], [3, 1, 3]); camera { eye: [4, 3, 4] }"},
};

static KrsPicture *render(const KrsScene *scene)
{
    const KrsRenderOptions options = {.width = 120, .height = 80};
    KrsState              *state;
    KrsRendering          *rendering;
    KrsPicture            *picture;
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    if (krs_rendering_new(renderer, scene, KRS_FOR_PICTURES, &rendering) != KRS_OK ||
        krs_render(rendering, state, &options, &picture) != KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
    krs_rendering_free(rendering);
    krs_state_free(state);
    return picture;
}

/* Pixels that show another component, depth or colour. */
static int differing_pixels(const KrsPicture *a, const KrsPicture *b)
{
    int differ = 0;
    for (int k = 0; k < 120 * 80; k++) {
        bool same = a->component[k] == b->component[k] &&
                    (!a->component[k] || fabsf(a->depth[k] - b->depth[k]) < 0.02f);
        for (int i = 0; i < 3; i++)
            same = same && fabsf(a->color[4 * k + i] - b->color[4 * k + i]) < 0.05f;
        differ += !same;
    }
    return differ;
}

static void pictures_are_the_same(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        KrsScene   *scenes[2];
        KrsPicture *pictures[2];
        for (int k = 0; k < 2; k++) {
            KrsScene *literal = compile(texts[i][k], "a.krs", KRS_SPECIALIZE_NUMBERS);
            scenes[k]         = compile(texts[i][k], "a.krs", KRS_SPECIALIZE_STRUCTURE);
            assert_non_null(scenes[k]);
            KrsPicture *right = render(literal);
            pictures[k]       = render(scenes[k]);
            const int differ  = differing_pixels(pictures[k], right);
            print_message("# scene %zu, %s: %d pixels differ\n", i, k ? "edited" : "as it was",
                          differ);
            assert_in_range(differ, 0, 120 * 80 / 500);
            krs_picture_free(right);
            krs_scene_free(literal);
        }
        Texts right = texts_of(scenes[0]);
        assert_true(has_texts(scenes[1], right));
        free_texts(right);
        assert_true(differing_pixels(pictures[0], pictures[1]) > 120 * 80 / 20);
        for (int k = 0; k < 2; k++) {
            krs_picture_free(pictures[k]);
            krs_scene_free(scenes[k]);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(examples_are_the_same),
        cmocka_unit_test(vectors_are_known),
        cmocka_unit_test(pictures_are_the_same),
    };
    return cmocka_run_group_tests(tests, renderer_open, renderer_close);
}
