/*
 * Texts of scenes: every variant compiles, has no directives, and holds what is wanted, what that
 * calls, and nothing else.  What a stranger pastes gives what shaders of the runtime give.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <ctype.h>
#include <glob.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <xxhash.h>

#include "compiler/print/module.h"
#include "runtime/tracer/shaders.h"
#include "runtime/tracer/variants.h"
#include "tests/support/renderer.h"

static KrsScene *open_file(const char *path, bool gradients)
{
    KrsScene        *scene;
    const KrsOptions options = {.gradients = gradients, .research = gradients};
    if (krs_compile_file(path, &options, &scene) != KRS_OK)
        fail_msg("%s does not compile", path);
    return scene;
}

static void each_of(const char *pattern, void (*look)(const char *path))
{
    glob_t found;
    assert_int_equal(glob(pattern, 0, NULL, &found), 0);
    for (size_t i = 0; i < found.gl_pathc; i++)
        look(found.gl_pathv[i]);
    globfree(&found);
}

/* ---- what is in a text ---- */

enum { LONGEST_NAME = 64 };

static bool is_of_name(char c) { return isalnum((unsigned char)c) || c == '_'; }

/* Times that a name stands there by itself. */
static int count_name(const char *text, const char *name)
{
    size_t length = strlen(name);
    int    count  = 0;
    for (const char *at = text; (at = strstr(at, name)); at += length)
        count += (at == text || !is_of_name(at[-1])) && !is_of_name(at[length]);
    return count;
}

/* Reads the name that a line declares, if it does: "float krs_cut(vec3 p, float d)", "vec3
   krs_frame0;". */
static bool read_name(const char *line, char name[LONGEST_NAME])
{
    size_t      type = strspn(line, "abcdefghijklmnopqrstuvwxyzKS234"), length = 0;
    const char *from = line + type + 1;
    if (type == 0 || line[type] != ' ' || strncmp(from, "krs_", 4) != 0)
        return false;
    while (is_of_name(from[length]) && length < LONGEST_NAME - 1)
        length++;
    snprintf(name, LONGEST_NAME, "%.*s", (int)length, from);
    return true;
}

/* Lines that declare the name; of all lines only those are read that have it. */
static int count_declarations(const char *text, const char *name)
{
    char other[LONGEST_NAME];
    int  count = 0;
    for (const char *at = text; (at = strstr(at, name)); at += strcspn(at, "\n")) {
        const char *line = at;
        while (line > text && line[-1] != '\n')
            line--;
        count += read_name(line, other) && strcmp(name, other) == 0;
    }
    return count;
}

static const char *name_of(KrsFunction function)
{
    const char *name = module_function_name(function);
    return name ? name : "";
}

static bool is_entry_point(const char *name, const ShaderScene *of)
{
    bool sines = false, arcs = false, volumes = false;
    for (size_t i = 0; i < of->wanted_count; i++) {
        sines   = sines || of->wanted[i] == KRS_FUNCTION_SINES;
        arcs    = arcs || of->wanted[i] == KRS_FUNCTION_ARCS;
        volumes = volumes ||
                  of->wanted[i] == KRS_FUNCTION_DENSITY; /* the caller asks where the ray is */
        if (strcmp(name, name_of(of->wanted[i])) == 0)
            return true;
    }
    return strcmp(name, "krs_prepare") == 0 || (sines && strlen(name) == strlen("krs_sin")) ||
           (arcs && strcmp(name, "krs_atan2") == 0) || (volumes && strcmp(name, "krs_medium") == 0);
}

/* A global is declared, set and read; a function that is not wanted is called. */
static void check_names(const char *text, const ShaderScene *of, const char *path)
{
    char name[LONGEST_NAME];
    for (const char *line = text; *line; line += strcspn(line, "\n"), line += *line == '\n') {
        if (!read_name(line, name) || is_entry_point(name, of))
            continue;
        int uses = count_name(text, name) - count_declarations(text, name);
        if (uses < (strncmp(name, "krs_frame", 9) == 0 ? 2 : 1))
            fail_msg("%s: nobody needs %s in\n%s", path, name, text);
    }
    for (size_t i = 0; i < of->wanted_count; i++) /* a prototype and the function */
        if (*name_of(of->wanted[i]))
            assert_int_equal(count_declarations(text, name_of(of->wanted[i])), 2);
    if (strchr(text, '#'))
        fail_msg("%s: a directive, or a macro, in\n%s", path, text);
    for (const char *at = text; (at = strstr(at, "KRS_")); at += 4)
        assert_int_equal(strncmp(at, "KRS_SCENE_PARTS", 9), 0);
}

static char *print(const ShaderScene *of)
{
    char *text = krs_scene_text(of->scene, &of->variant, of->wanted, of->wanted_count, NULL);
    assert_non_null(text);
    return text;
}

/* ---- every variant ---- */

static const char *const calls[KRS_FUNCTION_COUNT] = {
    [KRS_FUNCTION_DISTANCE]            = "krs_distance(p)",
    [KRS_FUNCTION_PLANE_T]             = "krs_plane_t(p, p)",
    [KRS_FUNCTION_PLANE_COSINE]        = "krs_plane_cosine(p)",
    [KRS_FUNCTION_ALONG]               = "krs_along(p, p, 0.0)",
    [KRS_FUNCTION_STEPS]               = "krs_steps(p, p, 0.0).y",
    [KRS_FUNCTION_PROBE]               = "krs_probe(p, 0.0)",
    [KRS_FUNCTION_DISTANCE_LOD]        = "krs_distance_lod(p, 0.0)",
    [KRS_FUNCTION_SCENE_PART_DISTANCE] = "krs_scene_part_distance(KRS_SCENE_PARTS - 1u, p)",
    [KRS_FUNCTION_SCENE_PART_BOX]      = "(krs_scene_part_box(0u, p, p), p.x)",
    [KRS_FUNCTION_GRADIENT]            = "krs_gradient(p, 0.1).x",
    [KRS_FUNCTION_TANGENT]             = "krs_tangent(p, 0.1).w",
    [KRS_FUNCTION_SURFACE]             = "krs_surface(p, p, 0.0).roughness",
    [KRS_FUNCTION_MEDIUM_AT]           = "float(krs_medium_at(p))",
    [KRS_FUNCTION_GLASS]               = "krs_glass(p)",
    [KRS_FUNCTION_SUBSURFACE]          = "krs_subsurface(p)",
    [KRS_FUNCTION_DENSITY]             = "krs_volume_density(0u, p)",
    [KRS_FUNCTION_ALBEDO]              = "krs_volume_albedo(0u, p).x",
    [KRS_FUNCTION_ANISOTROPY]          = "krs_volume_anisotropy(0u, p)",
    [KRS_FUNCTION_EMISSION]            = "krs_volume_emission(0u, p).x",
    [KRS_FUNCTION_SINES]               = "krs_sin(p.x) + krs_cos(p.x) + krs_tan(p.x)",
    [KRS_FUNCTION_ARCS]                = "krs_atan2(p.x, p.y)",
};

enum { MAX_SHADERS = 8192 };
static uint64_t compiled_shaders[MAX_SHADERS];
static size_t   compiled_count;

/* Tells whether this very shader was compiled before: most functions say the same in many variants. */
static bool was_compiled(const char *shader, size_t length)
{
    uint64_t hash = XXH3_64bits(shader, length);
    for (size_t i = 0; i < compiled_count; i++)
        if (compiled_shaders[i] == hash)
            return true;
    assert_true(compiled_count < MAX_SHADERS);
    compiled_shaders[compiled_count++] = hash;
    return false;
}

/* A shader around it, as a stranger would write one. */
static void compile_text(const char *text, const ShaderScene *of, const char *path)
{
    char  *shader = NULL, *log = NULL;
    size_t length, count;
    FILE  *out = open_memstream(&shader, &length);
    assert_non_null(out);
    fprintf(out,
            "#version 440\n#extension GL_EXT_control_flow_attributes : enable\n%s"
            "layout(std430, set = 1, binding = 0) buffer Sum { float sum; };\n"
            "void main()\n{\n    krs_prepare();\n    vec3 p = vec3(sum);\n",
            text);
    for (size_t i = 0; i < of->wanted_count; i++)
        fprintf(out, "    sum += %s;\n", calls[of->wanted[i]]);
    fputs("}\n", out);
    fclose(out);
    uint32_t *words = NULL;
    if (!was_compiled(shader, length) &&
        spirv_compile(shader, path, &words, &count, &log) != KRS_OK)
        fail_msg("%s: %s\n%s", path, log ? log : "no memory", shader);
    free(words);
    free(log);
    free(shader);
}

static int texts_seen, kinds_seen[KRS_FUNCTION_COUNT], groups_seen, relative_seen, planes_seen;

static void look_at_text(const ShaderScene *of, const char *path, bool compiled)
{
    char *text = print(of);
    check_names(text, of, path);
    if (compiled)
        compile_text(text, of, path);
    free(text);
    texts_seen++;
    groups_seen += of->variant.march_group > 0;
    relative_seen += of->variant.camera_relative;
    planes_seen += of->variant.planes;
    for (size_t i = 0; i < of->wanted_count; i++)
        kinds_seen[of->wanted[i]]++;
}

/* Tells whether a function can be had in a variant (module.h). */
static bool can_want(const ShaderScene *of, KrsFunction function)
{
    const KrsProgram *program = krs_scene_program(of->scene);
    const KrsVariant *v       = &of->variant;
    switch (function) {
    case KRS_FUNCTION_PLANE_T:
    case KRS_FUNCTION_PLANE_COSINE: return program->planes && v->march_group == 0;
    case KRS_FUNCTION_ALONG:
    case KRS_FUNCTION_STEPS: return !v->camera_relative;
    case KRS_FUNCTION_PROBE:
    case KRS_FUNCTION_DISTANCE_LOD:
    case KRS_FUNCTION_GRADIENT:
    case KRS_FUNCTION_TANGENT: return !v->camera_relative && v->march_group == 0;
    case KRS_FUNCTION_SCENE_PART_DISTANCE:
    case KRS_FUNCTION_SCENE_PART_BOX: return program->scene_parts >= 2 && v->march_group == 0;
    case KRS_FUNCTION_MEDIUM_AT:
    case KRS_FUNCTION_GLASS: return program->media && v->march_group == 0;
    case KRS_FUNCTION_SUBSURFACE: return program->subsurface && v->march_group == 0;
    case KRS_FUNCTION_SURFACE: return v->march_group == 0;
    case KRS_FUNCTION_DENSITY:
    case KRS_FUNCTION_ALBEDO:
    case KRS_FUNCTION_ANISOTROPY:
    case KRS_FUNCTION_EMISSION: return program->volumes > 0 && v->march_group == 0;
    default: return true;
    }
}

/* Each function by itself, and all of them. */
static void look_at_variant(ShaderScene of, const char *path, bool compiled)
{
    ShaderScene all = of;
    for (KrsFunction function = 0; function < KRS_FUNCTION_COUNT; function++) {
        if (!can_want(&of, function))
            continue;
        of.wanted[0]    = function;
        of.wanted_count = 1;
        look_at_text(&of, path, compiled);
        all.wanted[all.wanted_count++] = function;
    }
    look_at_text(&all, path, compiled);
}

/* Tells whether an earlier variant says the same: a scene has no planes, or no glass, to choose for. */
static bool is_repeated(const KrsVariant *variants, size_t number)
{
    bool repeated = false;
    for (size_t i = 0; i < number; i++)
        repeated = repeated || krs_variant_hash(&variants[i], NULL, 0) ==
                                   krs_variant_hash(&variants[number], NULL, 0);
    return repeated;
}

/* Every choice, where there is one. */
static void look_at_variants(KrsScene *scene, const char *path, bool compiled)
{
    const KrsProgram *program  = krs_scene_program(scene);
    const KrsGlass    left_out = program->media ? KRS_GLASS_LEFT_OUT : 0;
    const KrsGlass    nested   = program->media ? KRS_GLASS_NESTED : 0;
    const KrsVariant  chosen[] = {
         {.many_threads = false},
         {.many_threads = true},
         {.many_threads = true, .shares = true},
         {.values = true, .gathers_noises = true},
         {.values = true, .tangents = program->gradients},
         {.values = true, .zones = 2, .many_threads = true},
         {.step = KRS_STEP_TAYLOR},
         {.step = KRS_STEP_ROOT_FREE},
         {.step = KRS_STEP_DIRECTIONAL},
         {.glass = left_out},
         {.glass = nested, .values = true},
         {.glass = nested, .zones = 2, .many_threads = true},
         {.glass = nested, .planes = program->planes},
         {.planes = program->planes, .values = true},
         {.planes = program->planes, .many_threads = true},
         {.camera_relative = program->camera_relative, .values = true},
         {.camera_relative = program->camera_relative, .values = true, .planes = program->planes},
    };
    for (size_t i = 0; i < sizeof chosen / sizeof *chosen; i++)
        if (!is_repeated(chosen, i))
            look_at_variant((ShaderScene){.scene = scene, .variant = chosen[i]}, path, compiled);
    for (uint32_t group = 1; group <= program->march_group_count; group++)
        for (int many = 0; many < 2; many++)
            look_at_variant((ShaderScene){.scene   = scene,
                                          .variant = {.march_group = group, .many_threads = many}},
                            path, compiled);
    krs_scene_free(scene);
}

static void look_at_scene(const char *path)
{
    look_at_variants(open_file(path, true), path, false);
}
static void compile_scene(const char *path) { look_at_variants(open_file(path, true), path, true); }

/* Points of such a scene are camera-relative. */
static void look_at_far_scene(bool compiled)
{
    static const char text[] = "show sphere(1).move([100000, 1, 0]);"
                               "show plane([0, 1, 0], 0).paint(#ffffff);"
                               "show box([1, 1, 1]).move([100003, 1, 0]);"
                               "camera { eye: [100000, 2, 5], target: [100000, 1, 0] }";
    KrsScene         *scene;
    const KrsOptions  options = {.gradients = true, .research = true};
    assert_int_equal(krs_compile_text(text, strlen(text), "far.krs", &options, &scene), KRS_OK);
    assert_true(krs_scene_program(scene)->camera_relative);
    look_at_variants(scene, "far.krs", compiled);
}

/* Glass of different kinds: alone, many, by polynomials; and a solid that is none. */
static void look_at_glass(void)
{
    static const char text[] = "use \"std/surfaces.krs\";"
                               "material glass { transmission: 1 }"
                               "show sphere(1).paint(glass);"
                               "for i in 0..50 { show sphere(0.1).move([i, 1, 0]).paint(glass); }"
                               "show barth_sextic(within: 1.5).move([0, 3, 0]).paint(glass);"
                               "show box([1, 1, 1]).paint(gold);"
                               "show plane([0, 1, 0], 0);";
    KrsScene         *scene;
    const KrsOptions  options = {.gradients = true, .research = true};
    assert_int_equal(krs_compile_text(text, strlen(text), "glass.krs", &options, &scene), KRS_OK);
    assert_true(krs_scene_program(scene)->media);
    look_at_variants(scene, "glass.krs", true);
}

/* Boxes around polynomials that are numbers of the frame. */
static void look_at_moved_boxes(void)
{
    static const char text[]  = "use \"std/surfaces.krs\";"
                                "show barth_sextic(within: 1.5).move([0, 3, 0]);"
                                "show heart().move([3, 0, 0]); show box([1, 1, 1]);";
    const KrsOptions  options = {.specialize = KRS_SPECIALIZE_STRUCTURE};
    ShaderScene       of      = {
                   .variant = {.tangents = true}, .wanted = {KRS_FUNCTION_SURFACE}, .wanted_count = 1};
    KrsScene *scene;
    assert_int_equal(krs_compile_text(text, strlen(text), "boxes.krs", &options, &scene), KRS_OK);
    of.scene = scene;
    look_at_text(&of, "boxes.krs", true);
    of.wanted[0] = KRS_FUNCTION_TANGENT;
    look_at_text(&of, "boxes.krs", true);
    krs_scene_free(scene);
}

static void texts_hold_what_is_called(void **state)
{
    (void)state;
    texts_seen = 0;
    each_of("examples/*.krs", look_at_scene);
    each_of("bench/scenes/*.krs", look_at_scene);
    each_of("tests/golden/*.krs", look_at_scene);
    look_at_far_scene(false);
    assert_true(texts_seen > 1000);
    assert_true(groups_seen > 0);
    assert_true(relative_seen > 0);
    assert_true(planes_seen > 0);
    for (KrsFunction function = 0; function < KRS_FUNCTION_COUNT; function++)
        assert_true(kinds_seen[function] > 0);
}

static void texts_are_glsl(void **state)
{
    (void)state;
    groups_seen = relative_seen = planes_seen = 0;
    spirv_start();
    each_of("tests/golden/[acl]*.krs", compile_scene);
    compile_scene("tests/golden/places.krs");
    compile_scene("tests/golden/fractals.krs"); /* without derivatives */
    compile_scene("bench/scenes/compound.krs");
    look_at_far_scene(true);
    look_at_glass();
    look_at_moved_boxes();
    spirv_stop();
    assert_true(groups_seen > 0 && relative_seen > 0 && planes_seen > 0);
}

static void texts_differ_by_what_is_wanted(void **state)
{
    (void)state;
    const KrsVariant  plain = {0}, zoned = {.zones = 1};
    const KrsFunction wanted[] = {KRS_FUNCTION_DISTANCE, KRS_FUNCTION_SURFACE};
    const KrsFunction turned[] = {KRS_FUNCTION_SURFACE, KRS_FUNCTION_DISTANCE};
    uint64_t          hash     = krs_variant_hash(&plain, wanted, 2);
    assert_true(hash == krs_variant_hash(&plain, turned, 2)); /* the order says nothing */
    assert_true(hash != krs_variant_hash(&plain, wanted, 1));
    assert_true(hash != krs_variant_hash(&zoned, wanted, 2));
}

/* What `krs compile` writes. */
static void texts_are_short(void **state)
{
    (void)state;
    KrsScene   *scene = open_file("examples/02-gear.krs", false);
    ShaderScene of    = {.scene = scene, .variant = {.many_threads = true, .shares = true}};
    of.wanted_count   = krs_entry_points(scene, true, of.wanted);
    char *text        = print(&of);
    assert_in_range(strlen(text), 10000, 84000);
    assert_true(strlen(text) < 2 * krs_scene_program(scene)->glsl_length / 3);
    free(text);
    krs_scene_free(scene);
}

/* ---- on a device ---- */

enum { POINTS = 4096 };

/* What is at the points, by the shader of questions in another variant. */
static void probe_by(KrsRendering *rendering, KrsState *state, const KrsVariant *variant,
                     const double (*points)[3], KrsHit *hits)
{
    ShaderVariant other = variant_of_point_query(rendering);
    Shader       *used = rendering_point_query(rendering), before = *used, shader;
    double        spirv_ms = 0, pipeline_ms = 0;
    other.scene.variant.shares       = variant->shares;
    other.scene.variant.values       = variant->values;
    other.scene.variant.many_threads = variant->many_threads;
    ShaderSource source              = variant_source("point_query.comp", &other);
    assert_true(
        shader_create(&renderer->gpu, &shader, &source, renderer->layout, &spirv_ms, &pipeline_ms));
    *used            = shader;
    KrsStatus status = krs_device_probe(rendering, state, points, POINTS, hits);
    *used            = before;
    assert_true(gpu_wait(&renderer->gpu));
    shader_destroy(&renderer->gpu, &shader);
    assert_int_equal(status, KRS_OK);
}

static bool are_near(double a, double b) { return fabs(a - b) <= 1e-4 * (1 + fabs(a)); }

/* Most of the time to the bit; a choice between parts may fall the other way by a rounding. */
static int count_different(const KrsHit *a, const KrsHit *b)
{
    int different = 0;
    for (int i = 0; i < POINTS; i++) {
        bool same = are_near(a[i].distance, b[i].distance) && a[i].component == b[i].component &&
                    a[i].instance == b[i].instance && are_near(a[i].roughness, b[i].roughness);
        for (int k = 0; k < 3; k++)
            same = same && are_near(a[i].color[k], b[i].color[k]);
        different += !same;
    }
    return different;
}

static void compare_variants(const char *path)
{
    static const KrsVariant variants[] = {
        {.shares = true}, {.values = true}, {.shares = true, .many_threads = true}};
    static double points[POINTS][3];
    static KrsHit right[POINTS], found[POINTS];
    KrsScene     *scene = open_file(path, false);
    KrsState     *state;
    KrsRendering *rendering;
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    assert_int_equal(krs_state_set_time(state, 0.7), KRS_OK);
    assert_int_equal(krs_rendering_new(renderer, scene, KRS_FOR_QUESTIONS, &rendering), KRS_OK);
    for (int i = 0; i < POINTS; i++)
        for (int k = 0; k < 3; k++)
            points[i][k] = 6 * fmod(i * (double[]){0.8191725, 0.6710436, 0.5497005}[k], 1) - 3;
    assert_int_equal(krs_device_probe(rendering, state, (const double(*)[3])points, POINTS, right),
                     KRS_OK);
    for (size_t v = 0; v < sizeof variants / sizeof *variants; v++) {
        probe_by(rendering, state, &variants[v], (const double(*)[3])points, found);
        int different = count_different(right, found);
        if (different > POINTS / 1000)
            fail_msg("%s: %d of %d points differ in variant %zu", path, different, POINTS, v);
    }
    krs_rendering_free(rendering);
    krs_state_free(state);
    krs_scene_free(scene);
}

static void variants_agree(void **state)
{
    (void)state;
    compare_variants("examples/02-gear.krs");
    compare_variants("examples/13-lamps.krs");
    compare_variants("tests/golden/csg.krs");
    compare_variants("tests/golden/sequence.krs");
    compare_variants("tests/golden/looks.krs");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texts_hold_what_is_called),
        cmocka_unit_test(texts_are_glsl),
        cmocka_unit_test(texts_differ_by_what_is_wanted),
        cmocka_unit_test(texts_are_short),
        cmocka_unit_test_setup_teardown(variants_agree, renderer_open, renderer_close),
    };
    return cmocka_run_group_tests_name("printing", tests, NULL, NULL);
}
