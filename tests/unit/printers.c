/*
 * Printers: GLSL's has words for all templates, and a text is in the language of its printer alone.
 *
 * A language that nobody has is printed: it has other words for types, operations and templates.  What
 * the files of compiler/print wrote by themselves would be GLSL in the midst of it.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <ctype.h>
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/scene/program.h"
#include "tests/support/instance_texts.h"

/* ---- the words of GLSL ---- */

static const int template_operands[TEMPLATE_COUNT] = {
#define TEMPLATE(NAME, operands, meaning) operands,
#include "compiler/print/templates.def"
};

/* How many of $a, $b and $c there are, without gaps. */
static int count_operands(const char *words)
{
    int count = 0;
    while (count < 3 && strstr(words, (const char[]){'$', (char)('a' + count), 0}))
        count++;
    for (const char *at = words; (at = strchr(at, '$')); at++)
        assert_in_range(at[1], 'a', 'a' + count - 1);
    return count;
}

static void glsl_has_words_for_all_templates(void **state)
{
    (void)state;
    for (int i = 0; i < TEMPLATE_COUNT; i++) {
        assert_non_null(glsl_printer.templates[i]);
        assert_int_equal(count_operands(glsl_printer.templates[i]), template_operands[i]);
    }
}

/* ---- another language ---- */

static const char *const types[] = {
    [TYPE_FLOAT] = "f32",  [TYPE_VEC2] = "vec2f", [TYPE_VEC3] = "vec3f",
    [TYPE_VEC4] = "vec4f", [TYPE_BOOL] = "truth", [TYPE_UINT] = "u32",
};

/* As many operands as there are. */
static const char *operation(Op op, GraphType type)
{
    static const char *const texts[] = {"f()", "f($a)", "f($a, $b)", "f($a, $b, $c)",
                                        "f($a, $b, $c, $D)"};
    const char              *glsl    = op_glsl(op);
    size_t                   count   = 0;
    (void)type;
    if (!glsl) /* it reads tables: a call of a function of the module */
        return NULL;
    while (count < 4 && strstr(glsl, (const char[]){'$', (char)('a' + count), 0}))
        count++;
    return texts[count];
}

static const EmbeddedFile helpers[] = {
    {.name = "helpers",
     .text = "// What texts call by themselves.\n\n"
             "fn krs_gradient_N(p: vec3f, reach: f32) -> vec4f {\n    krs_distance_N(p);\n}\n\n"
             "fn krs_box_distance(p: vec3f, center: vec3f, half_sides: vec3f) -> f32 {\n}\n\n"
             "fn krs_mirror_excess(p: vec3f, n: vec3f, w: f32) -> f32 {\n}\n\n"
             "fn krs_sin(a: f32) -> f32 {\n}\n\n"
             "fn krs_cos(a: f32) -> f32 {\n}\n\n"
             "fn krs_tan(a: f32) -> f32 {\n}\n\n"
             "fn krs_atan2(y: f32, x: f32) -> f32 {\n}\n\n"
             "fn krs_read_texture(header: u32) -> KrsTexture {\n}\n\n"
             "fn krs_texture_sharp(uv: vec2f, read: KrsTexture) -> vec4f {\n}\n\n"
             "fn krs_texture(uv: vec2f, pixel: vec4f, read: KrsTexture) -> vec4f {\n}\n\n"
             "fn krs_read_table(table: u32) -> KrsTable {\n}\n\n"
             "fn krs_near(p: vec3f, table: KrsTable) -> KrsNear {\n}\n\n"
             "fn krs_listed(i: u32, table: KrsTable) -> u32 {\n}\n\n"
             "fn krs_row(row: u32, texels: u32, texel: u32, table: KrsTable) -> vec4f {\n}\n\n"
             "fn krs_listed_row(i: u32, texels: u32, texel: u32, table: KrsTable) -> vec4f {\n}\n\n"
             "fn krs_growth(p: vec3f, table: KrsTable) -> f32 {\n}\n\n"
             "fn krs_exact_from(p: vec3f, table: KrsTable) -> f32 {\n}\n\n"
             "fn krs_lack(sum: f32, exact_from: f32) -> f32 {\n}\n"},
    {0},
};

static const Alternative alternatives[] = {
    {"KRS_MIN", "min($a, $b)", "least($a, $b)"},
    {"KRS_MAX", "max($a, $b)", "most($a, $b)"},
    {"KRS_BACK", "$b", "$a"},
    {NULL, NULL, NULL},
};

static const char *const templates[TEMPLATE_COUNT] = {
    [TEMPLATE_FUNCTION]        = "fn $b($c) -> $a",
    [TEMPLATE_PROCEDURE]       = "fn $a($b)",
    [TEMPLATE_PARAMETER]       = "$b: $a",
    [TEMPLATE_PARAMETER_OUT]   = "$b: ptr<$a>",
    [TEMPLATE_PARAMETER_INOUT] = "$b: ptr<$a>",
    [TEMPLATE_CHANGED]         = "*$a",
    [TEMPLATE_ARGUMENT_OUT]    = "&$a",
    [TEMPLATE_PROTOTYPE]       = "",
    [TEMPLATE_LOCAL]           = "    let $b: $a = $c;\n",
    [TEMPLATE_VARIABLE]        = "    var $b: $a = $c;\n",
    [TEMPLATE_LOCAL_UNSET]     = "    var $b: $a;\n",
    [TEMPLATE_GLOBAL]          = "var<private> $b: $a;\n",
    [TEMPLATE_CONSTANT_UINT]   = "let $a = $bu;\n",
    [TEMPLATE_MEMBER]          = "    $b: $a,\n",
    [TEMPLATE_RETURN_IF]       = "    if ($a) { return $b; }\n",
    [TEMPLATE_SET_IF]          = "    if ($a) { $b = $c; }\n",
    [TEMPLATE_CHOICE]          = "select($c, $b, $a)",
    [TEMPLATE_SWITCH]          = "    match $a {\n",
    [TEMPLATE_CASE]            = "    $au => {\n",
    [TEMPLATE_CASE_END]        = "    }\n",
    [TEMPLATE_SWITCH_END]      = "    default => {}\n    }\n",
    [TEMPLATE_ITERATIONS]      = "    repeat var $a: u32 {\n",
    [TEMPLATE_ITERATIONS_END]  = "    } until ($a == $b)\n",
    [TEMPLATE_BITS]            = "bitcast<u32>($a)",
    [TEMPLATE_PARAMETER_BLOCK] = "var<block> krs_parameter: array<vec4f, $a>;\n",
    [TEMPLATE_ZONES]           = "var<private> krs_zones: array<vec4f, $a>;\n",
    [TEMPLATE_READ_ZONES]      = "    read_zones($a, $b);\n",
    [TEMPLATE_CUT]             = "fn krs_cut(p: vec3f, uncut: f32) -> f32\n{\n    var d = uncut;\n",
    [TEMPLATE_CUT_ZONES]       = "    d = zone_depth(p, d, $a);\n",
    [TEMPLATE_CUT_NEAR_ZONES]  = "    d = near_zone_depth(p, d, $a);\n",
    [TEMPLATE_TEXEL_CELLS]     = "texel cells;\n",
    [TEMPLATE_BUFFER_CELLS]    = "buffer cells;\n",
    [TEMPLATE_TEXTURES]        = "textures;\n",
    [TEMPLATE_TEXEL_TABLES]    = "texel tables;\n",
    [TEMPLATE_BUFFER_TABLES]   = "buffer tables;\n",
    [TEMPLATE_TABLES]          = "tables;\n",
    [TEMPLATE_EACH_LISTED]     = "    each_listed(p, $a) {\n",
    [TEMPLATE_NEAREST_GRADIENT] = "    var nearest: vec4f; var other: vec4f;\n",
    [TEMPLATE_NEAREST_OF_ZONES] = "    nearest = of_zones(nearest, $a);\n",
};

static const Printer other_printer = {
    .name         = "another",
    .types        = types,
    .operation    = operation,
    .helpers      = helpers,
    .alternatives = alternatives,
    .templates    = templates,
};

/* ---- its texts ---- */

/* Those that are no words of WGSL, either. */
static const char *const no_words_of_wgsl[] = {"float", "bvec2", "bvec3",   "bvec4",
                                               "void",  "uint",  "out",     "inout",
                                               "?",     "int",   "precise", NULL};

static const char *const words_of_glsl[] = {
    "float",  "vec2", "vec3",  "vec4",    "bool",   "uint",  "bvec2",   "bvec3",
    "bvec4",  "void", "const", "uniform", "out",    "inout", "mix",     "for",
    "switch", "case", "break", "?",       "layout", "int",   "precise", NULL};

static bool is_of_name(char c) { return isalnum((unsigned char)c) || c == '_'; }

/* A word by itself, outside of comments. */
static bool has_word(const char *line, size_t length, const char *word)
{
    size_t size = strlen(word);
    for (size_t at = 0; at + size <= length && strncmp(line + at, "//", 2) != 0; at++)
        if (strncmp(line + at, word, size) == 0 &&
            (!is_of_name(*word) ||
             ((at == 0 || !is_of_name(line[at - 1])) && !is_of_name(line[at + size]))))
            return true;
    return false;
}

/* In this language no name follows its type. */
static bool declares_as_glsl(const char *line, size_t length)
{
    for (size_t at = 0; at < length; at++)
        for (GraphType type = TYPE_FLOAT; type <= TYPE_UINT; type++) {
            size_t size = strlen(types[type]);
            if (strncmp(line + at, types[type], size) == 0 && line[at + size] == ' ' &&
                isalpha((unsigned char)line[at + size + 1]))
                return true;
        }
    return false;
}

static int lines_seen;

static void check_language(const char *text, const char *const *others, const char *path)
{
    for (const char *line = text; *line; line += *line == '\n') {
        size_t length = strcspn(line, "\n");
        for (const char *const *word = others; *word; word++)
            if (has_word(line, length, *word))
                fail_msg("%s: `%s` in %.*s", path, *word, (int)length, line);
        if (declares_as_glsl(line, length))
            fail_msg("%s: a type before a name in %.*s", path, (int)length, line);
        line += length;
        lines_seen++;
    }
}

static void print_in(const Printer *printer, const char *const *others, const KrsScene *scene,
                     const KrsVariant *variant, const char *path)
{
    KrsFunction wanted[KRS_FUNCTION_COUNT];
    size_t      count = 0;
    Memory      memory;
    jmp_buf     exhausted;
    memory = (Memory){.exhausted = &exhausted};
    assert_int_equal(setjmp(exhausted), 0);
    Arena arena = {.memory = &memory};
    Text  text  = {.arena = &arena};
    for (KrsFunction function = 0; function < KRS_FUNCTION_COUNT; function++) {
        bool plane = function == KRS_FUNCTION_PLANE_T || function == KRS_FUNCTION_PLANE_COSINE;
        bool part  = function == KRS_FUNCTION_SCENE_PART_DISTANCE ||
                    function == KRS_FUNCTION_SCENE_PART_BOX;
        if ((!plane || scene->program.planes) && (!part || scene->program.scene_parts >= 2))
            wanted[count++] = function;
    }
    module_print(&scene->module, variant, wanted, count, printer, &text);
    check_language(text.bytes, others, path);
    arena_free(&arena);
}

static void print_variants(KrsScene *scene, const char *path)
{
    const KrsVariant variants[] = {
        {.many_threads = false},
        {.many_threads = true, .shares = true},
        {.many_threads = true, .values = true, .zones = 2},
        {.planes = scene->program.planes, .values = true, .shares = true},
        {.gathers_noises = true},
    };
    for (size_t i = 0; i < sizeof variants / sizeof *variants; i++)
        for (int own = 0; own < 2; own++)
            print_in(own ? &other_printer : printers[KRS_TARGET_WGSL],
                     own ? words_of_glsl : no_words_of_wgsl, scene, &variants[i], path);
    krs_scene_free(scene);
}

static const KrsOptions all_there_is = {.gradients = true, .research = true};

static void print_scene(const char *path)
{
    KrsScene *scene;
    assert_int_equal(krs_compile_file(path, &all_there_is, &scene), KRS_OK);
    print_variants(scene, path);
}

/* Parts that are alike. */
static void print_instances(const InstanceText *instances)
{
    KrsScene *scene;
    char     *text = instance_text(instances, 1, 1);
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", &all_there_is, &scene),
                     KRS_OK);
    print_variants(scene, instances->name);
    free(text);
}

static void texts_are_in_the_language_of_their_printer(void **state)
{
    glob_t found;
    (void)state;
    lines_seen = 0;
    assert_int_equal(glob("tests/golden/*.krs", 0, NULL, &found), 0);
    for (size_t i = 0; i < found.gl_pathc; i++)
        print_scene(found.gl_pathv[i]);
    globfree(&found);
    print_scene("bench/scenes/compound.krs");
    for (size_t i = 0; i < instance_text_count; i++)
        print_instances(&instance_texts[i]);
    assert_true(lines_seen > 10000);
}

/* ---- GLSL in WGSL ---- */

static const struct {
    GraphType   type; /* of operands */
    const char *glsl, *wgsl;
} spelled[] = {
    {TYPE_FLOAT, "max($a, 0.0)", "max($a, 0.0)"},
    {TYPE_VEC3, "(max($a, 0.0) + log(1.0 + exp(-abs($a))))",
     "(max($a, vec3f(0.0)) + log(1.0 + exp(-abs($a))))"},
    {TYPE_FLOAT, "float $t = inversesqrt($a); mix($a, $t, $c > 0.0)",
     "let $t: f32 = inverseSqrt($a); select($a, $t, $c > 0.0)"},
    {TYPE_FLOAT, "mix($a, $b, $c)", "mix($a, $b, $c)"},
    {TYPE_FLOAT, "mix($a, $b, all(bvec2($c > 0.0, $d > 0.0)))",
     "select($a, $b, all(vec2<bool>($c > 0.0, $d > 0.0)))"},
    {TYPE_FLOAT, "a > b ? c : d == e ? -f : f", "select(select(f, -f, d == e), c, a > b)"},
    {TYPE_FLOAT, "uvec2 a; vec2 b = uintBitsToFloat(a) * floatBitsToUint(c);",
     "var a: vec2u; var b: vec2f = bitcast<vec2f>(a) * bitcast<u32>(c);"},
    {TYPE_FLOAT, "    float a = 1.0, b[4];", "    var a: f32 = 1.0;\n    var b: array<f32, 4>;"},
    {TYPE_FLOAT, "if (a == b)\n    a = b <= c ? b : c;\nelse\n    a += 1.0; // so",
     "if (a == b) {\n    a = select(c, b, b <= c);\n} else {\n    a += 1.0;\n} // so"},
    {TYPE_FLOAT,
     "// One.\nint krs_f(bool a, KrsTable b)\n{\n    for (int i = 0; i < 4; i++) {\n        a = "
     "!a;\n"
     "    }\n    return mix(1, int(b.width), a);\n}\n",
     "// One.\nfn krs_f(a: bool, b: KrsTable) -> i32\n{\n    for (var i: i32 = 0; i < 4; i++) {\n  "
     "      a = !a;\n"
     "    }\n    return select(1, i32(b.width), a);\n}\n"},
};

static void glsl_is_spelled_in_wgsl(void **state)
{
    Memory  memory;
    jmp_buf exhausted;
    (void)state;
    memory = (Memory){.exhausted = &exhausted};
    assert_int_equal(setjmp(exhausted), 0);
    Arena arena = {.memory = &memory};
    for (size_t i = 0; i < sizeof spelled / sizeof *spelled; i++) {
        Text text = {.arena = &arena};
        printers[KRS_TARGET_WGSL]->spell(spelled[i].glsl, strlen(spelled[i].glsl), spelled[i].type,
                                         &text);
        assert_string_equal(text.bytes, spelled[i].wgsl);
    }
    arena_free(&arena);
}

/* A comment ends with its line, in WGSL by each character of Unicode that ends one, and texts are UTF-8. */
static void names_of_files_end_no_comment(void **state)
{
    static const char text[] = "show sphere(1).twist([0, 1, 0], 0.5);";
    static const char name[] = "a\n\xC2\x85\xE2\x80\xA8\xE2\x80\xA9\xFF\xC3\xA9.krs";
    KrsScene         *scene;
    char             *printed;
    (void)state;
    assert_int_equal(krs_compile_text(text, strlen(text), name, NULL, &scene), KRS_OK);
    assert_int_equal(krs_text(scene, KRS_TARGET_WGSL, NULL, &printed), KRS_OK);
    assert_non_null(strstr(printed, "// a?????\xC3\xA9.krs:1\n"));
    free(printed);
    krs_scene_free(scene);
}

/* The same search finds GLSL where there is some. */
static void words_of_glsl_are_found(void **state)
{
    static const char line[] = "    float t1 = mix(a, b, c); // void";
    (void)state;
    assert_true(has_word(line, strlen(line), "float"));
    assert_true(has_word(line, strlen(line), "mix"));
    assert_false(has_word(line, strlen(line), "void"));
    assert_false(has_word("afloat floats", 13, "float"));
    assert_true(has_word("a ? b : c", 9, "?"));
    assert_true(declares_as_glsl("    vec3f v1 = p;", 17));
    assert_false(declares_as_glsl("    var v1: vec3f = p;", 22));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(glsl_has_words_for_all_templates),
        cmocka_unit_test(texts_are_in_the_language_of_their_printer),
        cmocka_unit_test(glsl_is_spelled_in_wgsl),
        cmocka_unit_test(names_of_files_end_no_comment),
        cmocka_unit_test(words_of_glsl_are_found),
    };
    return cmocka_run_group_tests_name("printers", tests, NULL, NULL);
}
