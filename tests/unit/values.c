/*
 * Values of the language: what has two ways to be said has the same shaders either way; what is
 * printed is what was read.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/scene/compiled.h"
#include "tests/support/random.h"

/* ---- scenes, and the files that they read ---- */

enum { MAX_SAID = 120, LONGEST = 400 };

typedef struct Heard {
    const char *csv, *json; /* what the files a/table.csv and a/data.json have */
    size_t      count;
    char        said[MAX_SAID][LONGEST];
} Heard;

static const char *supply(void *user, const char *path, size_t *length)
{
    const Heard *heard = user;
    const char  *text  = strcmp(path, "a/table.csv") == 0   ? heard->csv
                         : strcmp(path, "a/data.json") == 0 ? heard->json
                                                            : NULL;
    *length            = text ? strlen(text) : 0;
    return text;
}

static void listen(void *user, const KrsDiagnostic *diagnostic)
{
    Heard *heard = user;
    assert_true(heard->count < MAX_SAID);
    snprintf(heard->said[heard->count++], LONGEST, "%s %s", diagnostic->code, diagnostic->message);
}

static KrsStatus compile(const char *text, Heard *heard, KrsScene **scene)
{
    KrsOptions options = {.diagnostic = listen, .user = heard, .load = supply, .load_user = heard};
    heard->count       = 0;
    return krs_compile_text(text, strlen(text), "a/scene.krs", &options, scene);
}

/* Drops lines of blanks, in place: where comments were, which have other places. */
static void drop_empty_lines(char *text)
{
    char *to = text;
    for (const char *line = text, *next; *line; line = next) {
        size_t length = strcspn(line, "\n");
        next          = line + length + (line[length] == '\n');
        bool empty    = strspn(line, " ") == length;
        for (const char *c = line; !empty && c < next; c++)
            *to++ = *c;
    }
    *to = '\0';
}

/* Returns the shaders of a scene, for free(). */
static char *shaders(const char *text, Heard *heard)
{
    KrsScene *scene;
    if (compile(text, heard, &scene) != KRS_OK)
        fail_msg("%s: %s", text, heard->count ? heard->said[0] : "does not compile");
    char *result = krs_scene_plain_text(scene, NULL);
    krs_scene_free(scene);
    assert_non_null(result);
    drop_empty_lines(result);
    return result;
}

/* ---- two ways to say the same ---- */

#define TABLE "1, 2,0.5\r\n\n+3,-.5 , 4.\n"
#define DATA \
    "\xEF\xBB\xBF {\"sizes\": [1, 2e0, 0.5], \"big one\": {\"x\": -4, \"list\": [null, true]}}\n"

static const struct {
    const char *what, *one, *other;
} pairs[] = {
    {"components of a list", "let q = [1, 2, 3]; show box(q.zyx).move([q.z, q.y, 0]);",
     "show box([3, 2, 1]).move([3, 2, 0]);"},
    {"components of a point", "show field(length(p.xz) - 1 + 0.1 * p.y).within(box([2, 2, 2]));",
     "show field(length([x, z]) - 1 + 0.1 * y).within(box([2, 2, 2]));"},
    {"components of a parameter", "param s = [1, 2, 3] in [[1, 1, 1], [3, 3, 3]]; show box(s.yzx);",
     "param s = [1, 2, 3] in [[1, 1, 1], [3, 3, 3]]; show box([s[1], s[2], s[0]]);"},
    {"components of a colour", "show sphere(1).paint(mix(tomato.bgr, navy.rrr, normal.y));",
     "let t = tomato; show sphere(1).paint(mix([t[2], t[1], t[0]], [navy[0], navy[0], navy[0]], "
     "normal[1]));"},
    {"a component of what is computed", "show sphere((2 * [1, 2]).y - ([3, 4] + 1).x);",
     "show sphere(4 - 4 + 0);"},
    {"figures moved in their plane", "show circle(1).move([1, 2]).extrude(1);",
     "show circle(1).move([1, 2, 0]).extrude(1);"},
    {"figures turned in their plane", "show rectangle([1, 2]).rotate(30deg).extrude(1);",
     "show rectangle([1, 2]).rotate([0, 0, 1], 30deg).extrude(1);"},
    {"by a name", "show rectangle([1, 2]).rotate(angle: time).extrude(1);",
     "show rectangle([1, 2]).rotate([0, 0, 1], time).extrude(1);"},
    {"figures scaled in their plane", "show circle(1).scale([1, 2]).extrude(1);",
     "show circle(1).scale([1, 2, 1]).extrude(1);"},
    {"a material with parameters",
     "material m(a, b = 0.5 in [0, 1]) { color: mix(a, white, p.y), roughness: b }\n"
     "material n(a, b = 0.5 in [0, 1]) { color: mix(a, white, p.y), roughness: b }\n"
     "show sphere(1).paint(m(red)) | box([3, 1, 1]).paint(n(mix(red, navy, x), b: 0.2));",
     "material m { color: mix(red, white, y), roughness: 0.5 }\n"
     "material n { color: mix(mix(red, navy, x), white, y), roughness: 0.2 }\n"
     "show sphere(1).paint(m) | box([3, 1, 1]).paint(n);"},
    {"a material without any", "material m() { color: red } show sphere(1).paint(m());",
     "material m { color: red } show sphere(1).paint(m);"},
    {"remarks change nothing",
     "print(1); assert(true); def f(r) = assert(r > 0, \"r\") in print(r) in sphere(r);\n"
     "show krs { print(2); kernel f(1); assert(1 < 2); reflect plane([1, 0, 0], 0); };",
     "show krs { kernel sphere(1); reflect plane([1, 0, 0], 0); };"},
    {"strings that are built",
     "show union(sphere(1), sphere(2), blend: 1, kind: str(\"cu\", \"bic\"));",
     "show union(sphere(1), sphere(2), blend: 1, kind: \"cubic\");"},
    {"a table", "show union([box(r) for r in read_csv(\"table.csv\")]);",
     "show union([box(r) for r in [[1, 2, 0.5], [3, -0.5, 4]]]);"},
    {"a table without its first row",
     "show union([box(r * r) for r in read_csv(\"./table.csv\", skip: 1)]);",
     "show box([9, 0.25, 16]);"},
    {"data",
     "let d = read_json(\"../a/data.json\"); show box(d.sizes).move([d[\"big one\"].x, 0, 0]);",
     "show box([1, 2, 0.5]).move([-4, 0, 0]);"},
    {"cells that are counted",
     "def part(cell) = sphere(0.1 + 0.1 * dot(cell, [1, 3, 9])); show part.repeat([4, 2, 0], [3, "
     "2, 5]);",
     "show union([sphere(0.1 + 0.1 * (i + 3 * j)).move([4 * (i - 1), 2 * (j - 0.5), 0]) for j in "
     "0..2 for i in 0..3]);"},
    {"sectors",
     "def part(i) = sphere(0.1 * (i + 1)).move([2, 0, 0]); show part.repeat_polar(5, [1, 0, 0]);",
     "show union([sphere(0.1 * (i + 1)).move([2, 0, 0]).rotate([1, 0, 0], tau * i / 5) for i in "
     "0..5]);"},
    {"truth and nothing",
     "let l = read_json(\"data.json\")[\"big one\"].list; show sphere(if l[1] then 2 + len(l[0]) "
     "else 1);",
     "show sphere(2);"},
};

static void two_ways_are_the_same(void **state)
{
    (void)state;
    static Heard heard = {.csv = TABLE, .json = DATA};
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        char *one = shaders(pairs[i].one, &heard), *other = shaders(pairs[i].other, &heard);
        if (strcmp(one, other) != 0)
            fail_msg("%s: the shaders differ", pairs[i].what);
        free(one);
        free(other);
    }
}

/* ---- what is printed ---- */

static void notes_come_in_their_order(void **state)
{
    (void)state;
    static Heard heard;
    KrsScene    *scene;
    assert_int_equal(compile("def late(i) = print(\"b\", i) in i; let x = 1;\n"
                             "for i in 0..2 { print(\"a\", i); let j = late(i); }\n"
                             "show sphere(1);",
                             &heard, &scene),
                     KRS_OK);
    static const char *const wanted[] = {"N0301 a 0", "N0301 b 0", "N0301 a 1", "N0301 b 1"};
    assert_int_equal(heard.count, 5);
    for (size_t i = 0; i < 4; i++)
        assert_string_equal(heard.said[i], wanted[i]);
    assert_memory_equal(heard.said[4], "W0201", 5); /* warnings behind notes */
    krs_scene_free(scene);
}

/* Returns a number of any size, written in one of the ways of C. */
static double write_number(Random *random, char text[32])
{
    static const char *const ways[] = {"%.17g", "%.3f", "%.5e", "%.0f", "%g"};
    double                   size   = random_below(random, 2) ? 1e4 : 1e-9;
    double                   number = random_between(random, -size, size);
    snprintf(text, 32, ways[random_below(random, 5)], number);
    return strtod(text, NULL);
}

/* Reads numbers from a file and prints each: they are those that C reads. */
static void numbers_are_read_right(void **state)
{
    (void)state;
    enum { NUMBERS = 90 };
    static Heard heard;
    static char  csv[NUMBERS * 40], json[NUMBERS * 40];
    double       numbers[NUMBERS];
    Random       random = {5};
    size_t       length = 0;
    for (int i = 0; i < NUMBERS; i++) {
        char text[32];
        numbers[i] = write_number(&random, text);
        length += (size_t)sprintf(json + length, "%s%s", i ? ", " : "[", text);
        strcat(csv, text);
        strcat(csv, i % 3 == 2 ? "\n" : " , ");
    }
    strcat(json, "]");
    heard.csv                         = csv;
    heard.json                        = json;
    static const char *const scenes[] = {
        "for n in read_json(\"data.json\") { print(n); } show sphere(1);",
        "for r in read_csv(\"table.csv\") { for n in r { print(n); } } show sphere(1);"};
    for (int kind = 0; kind < 2; kind++) {
        KrsScene *scene;
        assert_int_equal(compile(scenes[kind], &heard, &scene), KRS_OK);
        assert_int_equal(heard.count, NUMBERS);
        for (int i = 0; i < NUMBERS; i++)
            if (strtod(heard.said[i] + 6, NULL) != numbers[i])
                fail_msg("%s is not %.17g", heard.said[i], numbers[i]);
        krs_scene_free(scene);
    }
}

/* ---- files that are not what they should be ---- */

static const char *const bad_json[] = {"",
                                       "[",
                                       "[1,]",
                                       "[1 2]",
                                       "{\"a\" 1}",
                                       "{\"a\":1,\"a\":2}",
                                       "{a:1}",
                                       "\"abc",
                                       "\"\\q\"",
                                       "1e999",
                                       "01",
                                       "[1] x",
                                       "nul",
                                       "{\"a\":1,}",
                                       "\"a\nb\"",
                                       "-",
                                       "1.",
                                       ".5",
                                       "\"\xff\"",
                                       "\"\\u0000\"",
                                       "+1",
                                       "\"\\u12\"",
                                       "\"\\ud800\"",
                                       "\"\\udc00\"",
                                       "\"\\ud800\\u0041\"",
                                       "NaN",
                                       "\v1"};
static const char *const bad_csv[]  = {"1,2\n3\n", "\"a", "\"a\"b,1", "\xff,1", "1e999", "1\n1,"};

static void expect_bad(const char *scene_text, Heard *heard, const char *data)
{
    KrsScene *scene;
    if (compile(scene_text, heard, &scene) != KRS_BAD_SCENE || heard->count != 1 ||
        strncmp(heard->said[0], "E0505", 5) != 0)
        fail_msg("%s: %s", data, heard->count ? heard->said[0] : "read");
}

static void bad_files_are_refused(void **state)
{
    (void)state;
    static Heard heard;
    for (size_t i = 0; i < sizeof bad_json / sizeof *bad_json; i++) {
        heard.json = bad_json[i];
        expect_bad("let d = read_json(\"data.json\"); show sphere(1);", &heard, bad_json[i]);
    }
    for (size_t i = 0; i < sizeof bad_csv / sizeof *bad_csv; i++) {
        heard.csv = bad_csv[i];
        expect_bad("let d = read_csv(\"table.csv\"); show sphere(1);", &heard, bad_csv[i]);
    }
}

/* Any part of a good file is read or refused, and nothing else happens. */
static void parts_of_files(void **state)
{
    (void)state;
    static Heard heard;
    char         part[sizeof DATA];
    for (size_t length = 0; length < sizeof DATA; length++) {
        KrsScene *scene;
        snprintf(part, sizeof part, "%.*s", (int)length, DATA);
        heard.json = heard.csv = part;
        compile(
            "let c = read_csv(\"table.csv\"); let d = read_json(\"data.json\"); show sphere(1);",
            &heard, &scene);
        krs_scene_free(scene);
        assert_true(heard.count <= 2);
    }
}

/* Nor with other bytes in it. */
static void changed_files(void **state)
{
    (void)state;
    static Heard heard;
    Random       random = {11};
    char         changed[sizeof DATA + sizeof TABLE];
    for (int i = 0; i < 400; i++) {
        KrsScene *scene;
        snprintf(changed, sizeof changed, "%s%s", i % 2 ? DATA : TABLE, i % 4 < 2 ? "" : TABLE);
        for (int k = 0; k < 3; k++)
            changed[random_below(&random, (int)strlen(changed))] = (char)random_bits(&random);
        heard.json = heard.csv = changed;
        compile(
            "let c = read_csv(\"table.csv\"); let d = read_json(\"data.json\"); show sphere(1);",
            &heard, &scene);
        krs_scene_free(scene);
        assert_true(heard.count <= 2);
    }
}

/* Deep, and wide: limits are reported, and soon. */
static void limits_of_files(void **state)
{
    (void)state;
    static Heard heard;
    enum { LONG = 100000 };
    char *deep = calloc(1, LONG + 1), *wide = calloc(1, 20 * LONG);
    memset(deep, '[', LONG);
    heard.json = deep;
    expect_bad("let d = read_json(\"data.json\"); show sphere(1);", &heard, "deep");
    size_t length = (size_t)sprintf(wide, "{");
    for (int i = 0; i < LONG; i++)
        length += (size_t)sprintf(wide + length, "\"%d\":0,", i);
    heard.json = wide;
    expect_bad("let d = read_json(\"data.json\"); show sphere(1);", &heard, "wide");
    free(deep);
    free(wide);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_ways_are_the_same),  cmocka_unit_test(notes_come_in_their_order),
        cmocka_unit_test(numbers_are_read_right), cmocka_unit_test(bad_files_are_refused),
        cmocka_unit_test(parts_of_files),         cmocka_unit_test(changed_files),
        cmocka_unit_test(limits_of_files),
    };
    return cmocka_run_group_tests_name("values", tests, NULL, NULL);
}
