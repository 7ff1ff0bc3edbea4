/*
 * points.c: writes scenes as WGSL, with points and what is there, for wgsl.mjs to compare with.
 *
 *     points FOLDER COUNT FILE...
 *
 * COUNT scenes are random, FILE... are read, and functions of the language are in more.  FOLDER/NAME.wgsl is the text,
 * NAME.parameters, NAME.rows and NAME.cells what that reads.  NAME.points has points of single precision, four floats
 * each; NAME.normals the normals there, likewise; NAME.distances and NAME.surfaces what the evaluator in double
 * precision says: a distance, and a color and a roughness.  FOLDER/list has the names, one in a line.
 *
 * variant-NAME.wgsl has all functions of a scene in some variant: for those there is nothing to compare with.
 */
#include <math.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/scene/program.h"
#include "tests/oracle/random_scene.h"
#include "tests/support/instance_texts.h"
#include "tests/support/scattered.h"

enum { POINTS = 1024 };

static const char *folder;
static FILE       *list;

static void write_bytes(const char *name, const char *ending, const void *bytes, size_t length)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s.%s", folder, name, ending);
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(bytes, 1, length, file) != length || fclose(file) != 0)
        exit(1);
}

static void expect(KrsStatus status)
{
    if (status != KRS_OK)
        exit(1);
}

/* ---- scenes ---- */

static void write_numbers(const char *name, const KrsScene *scene, KrsState *state)
{
    const size_t slots = krs_parameter_slots(scene), values = krs_value_slots(scene);
    const size_t rows = krs_table_rows(scene), cells = krs_table_cells(scene);
    float(*parameters)[4]     = calloc(slots + values, sizeof *parameters);
    float(*row_texels)[4]     = calloc(rows + 1, sizeof *row_texels);
    uint32_t(*cell_texels)[2] = calloc(cells + 1, sizeof *cell_texels);
    krs_state_parameters(state, parameters);
    krs_state_values(state, parameters + slots);
    krs_state_tables(state, row_texels, cell_texels);
    write_bytes(name, "parameters", parameters, (slots + values) * sizeof *parameters);
    write_bytes(name, "rows", row_texels, rows * sizeof *row_texels);
    write_bytes(name, "cells", cell_texels, cells * sizeof *cell_texels);
    free(parameters);
    free(row_texels);
    free(cell_texels);
}

/* Half of them are near surfaces: there tables have no bounds in the place of distances. */
static void write_points(const char *name, const KrsScene *scene, KrsState *state)
{
    static float  points[POINTS][4], normals[POINTS][4], surfaces[POINTS][4];
    static double same[POINTS][3], distances[POINTS];
    static KrsHit hits[POINTS];
    Random        random = {77};
    scatter(scene, &random, points, POINTS);
    bring_near(state, &random, points, POINTS / 2);
    for (size_t i = 0; i < POINTS; i++)
        for (int k = 0; k < 3; k++)
            same[i][k] = points[i][k];
    expect(krs_distance(state, (const double(*)[3])same, POINTS, distances));
    expect(krs_probe(state, (const double(*)[3])same, POINTS, hits));
    for (size_t i = 0; i < POINTS; i++) {
        for (int k = 0; k < 3; k++) {
            normals[i][k]  = (float)hits[i].normal[k];
            surfaces[i][k] = (float)hits[i].color[k];
        }
        surfaces[i][3] = (float)hits[i].roughness;
    }
    write_bytes(name, "points", points, sizeof points);
    write_bytes(name, "normals", normals, sizeof normals);
    write_bytes(name, "distances", distances, sizeof distances);
    write_bytes(name, "surfaces", surfaces, sizeof surfaces);
}

/* A text that is too large for shaders is none. */
static void write_scene(const char *name, KrsScene *scene, const KrsTextOptions *options)
{
    KrsState *state;
    char     *text;
    if (krs_text(scene, KRS_TARGET_WGSL, options, &text) == KRS_OK) {
        expect(krs_state_new(scene, &state));
        fprintf(list, "%s\n", name);
        write_bytes(name, "wgsl", text, strlen(text));
        write_numbers(name, scene, state);
        write_points(name, scene, state);
        krs_state_free(state);
        free(text);
    }
    krs_scene_free(scene);
}

/* Copies of some scenes are too large for their cells. */
static void write_random(int number)
{
    static SceneText     text;
    const KrsTextOptions options = {.state_values = number % 2, .no_early_outs = number % 3 == 0};
    Random               random  = {(uint64_t)number + 5000};
    KrsScene            *scene;
    char                 name[40];
    snprintf(name, sizeof name, "random-%d", number);
    text.length = 0;
    write_random_scene(&text, &random, vec(0, 0, 0), 1);
    if (krs_compile_text(text.bytes, text.length, "scene.krs", NULL, &scene) == KRS_OK)
        write_scene(name, scene, &options);
}

/* ---- functions of the language, of numbers and of vectors ---- */

static const char *const fields[] = {
    "sin(x) + cos(2 * y)",
    "tan(0.1 * z)",
    "asin(clamp(x, -0.9, 0.9))",
    "acos(clamp(0.3 * y, -0.9, 0.9))",
    "atan(x * y)",
    "atan2(y, x + 20)",
    "sqrt(x * x + 1)",
    "inversesqrt(y * y + 0.5)",
    "exp(0.2 * x)",
    "exp2(0.3 * x)",
    "log(1 + x * x)",
    "log2(2 + y * y)",
    "sinh(0.2 * x)",
    "cosh(0.2 * y)",
    "tanh(z)",
    "abs(x) - sign(y + 100)",
    "pow(1 + x * x, 0.7)",
    "x ^ 3 * 0.01",
    "mix(x, y, 0.3)",
    "smoothstep(-1, 2, x)",
    "clamp(x, -1, y)",
    "min(x, y, z)",
    "max([x, y, z])",
    "length(p - [1, 2, 3])",
    "dot(p, [1, 0.5, 0.2])",
    "length(cross(p, [0, 1, 0]))",
    "normalize(p + [20, 0, 0])[0]",
    "normalize([x + 20, y])[0]",
    "normalize([x, y, z, 20])[1]",
    "noise(p)",
    "noise([z, x])",
    "noise(3 * y)",
    "fbm(p, 4)",
    "sum(sin(p)) + sum(cos([x, y]))",
    "sum(tan(0.1 * p))",
    "sum(asin(clamp(0.3 * p, -0.9, 0.9))) + sum(acos(clamp(0.3 * p, -0.9, 0.9)))",
    "sum(atan(p)) + sum(atan([x, y]))",
    "sum(tanh(p)) + sum(sinh(0.2 * p)) + sum(cosh(0.2 * p))",
    "sum(pow(1 + p * p, [0.7, 0.5, 0.2]))",
    "sum(smoothstep([-1, -2, -3], [2, 3, 4], p))",
    "sum(mix(p, 2 * p, 0.3)) + sum(min(p, [0, 1, 2])) + sum(max(p, [0, 1, 2]))",
    "sum(inversesqrt(1 + p * p)) + sum(sqrt(1 + p * p)) + sum(exp(0.1 * p)) + sum(log(1 + p * p))",
    "sum(exp2(0.1 * p)) + sum(log2(2 + p * p)) + sum(abs(p))",
};

/* Those that jump are no distances. */
static const char *const colors[] = {
    "if x > 0 and not (y < 0.3 or z == 7) then 1 else 0, 0.5 + 0.5 * sin(9 * x), fract(y)",
    "0.2 * floor(2 * x), 0.2 * ceil(3 * y), 0.3 * round(5 * z)",
    "step(0.1, x), sign(y), mod(z, 0.4)",
    "0.5 + 0.5 * sin(4096 * x), 0.5 + 0.5 * cos(16384 * y), 0.5 + 0.1 * tan(64 * z)",
};

/* Scenes with one after the other in their midst. */
static void write_functions(const char *kind, const char *begin, const char *end,
                            const char *const functions[], size_t count)
{
    for (size_t i = 0; i < count; i++) {
        char      text[400], name[40];
        KrsScene *scene;
        snprintf(text, sizeof text, "%s%s%s", begin, functions[i], end);
        snprintf(name, sizeof name, "%s-%zu", kind, i + 1);
        expect(krs_compile_text(text, strlen(text), "scene.krs", NULL, &scene));
        write_scene(name, scene, NULL);
    }
}

/* ---- variants ---- */

/* Tells whether a function can be had in a variant (module.h). */
static bool can_want(const KrsProgram *program, const KrsVariant *v, KrsFunction function)
{
    switch (function) {
    case KRS_FUNCTION_PLANE_T:
    case KRS_FUNCTION_PLANE_COSINE: return program->planes;
    case KRS_FUNCTION_ALONG:
    case KRS_FUNCTION_STEPS:
    case KRS_FUNCTION_PROBE:
    case KRS_FUNCTION_DISTANCE_LOD:
    case KRS_FUNCTION_GRADIENT:
    case KRS_FUNCTION_TANGENT: return !v->camera_relative;
    case KRS_FUNCTION_SCENE_PART_DISTANCE:
    case KRS_FUNCTION_SCENE_PART_BOX: return program->scene_parts >= 2;
    case KRS_FUNCTION_MEDIUM_AT:
    case KRS_FUNCTION_GLASS: return program->media;
    case KRS_FUNCTION_SUBSURFACE: return program->subsurface;
    default: return true;
    }
}

static void write_variant(const KrsScene *scene, const KrsVariant *variant, const char *name)
{
    KrsFunction wanted[KRS_FUNCTION_COUNT];
    size_t      count = 0;
    jmp_buf     exhausted;
    Memory      memory = {.exhausted = &exhausted};
    Arena       arena  = {.memory = &memory};
    Text        text   = {.arena = &arena};
    if (setjmp(exhausted) != 0)
        exit(1);
    for (KrsFunction function = 0; function < KRS_FUNCTION_COUNT; function++)
        if (can_want(&scene->program, variant, function))
            wanted[count++] = function;
    module_print(&scene->module, variant, wanted, count, printers[KRS_TARGET_WGSL], &text);
    fprintf(list, "%s\n", name);
    write_bytes(name, "wgsl", text.bytes, text.length);
    arena_free(&arena);
}

static const KrsOptions all_there_is = {.gradients = true, .research = true};

static void write_variants(KrsScene *scene, const char *name)
{
    const KrsProgram *program    = &scene->program;
    const KrsGlass    left_out   = program->media ? KRS_GLASS_LEFT_OUT : 0;
    const KrsGlass    nested     = program->media ? KRS_GLASS_NESTED : 0;
    const KrsVariant  variants[] = {
         {.many_threads = false, .gathers_noises = true},
         {.many_threads = true, .values = true, .zones = 2},
         {.planes = program->planes, .values = true, .shares = true, .tangents = program->gradients},
         {.glass = left_out, .step = KRS_STEP_TAYLOR},
         {.glass = nested, .zones = 2, .many_threads = true, .step = KRS_STEP_DIRECTIONAL},
         {.camera_relative = program->camera_relative, .zones = 2, .planes = program->planes},
    };
    for (size_t i = 0; i < sizeof variants / sizeof *variants; i++) {
        char own[300];
        snprintf(own, sizeof own, "variant-%s-%zu", name, i);
        write_variant(scene, &variants[i], own);
    }
    krs_scene_free(scene);
}

/* ---- operations ---- */

static uint32_t count_operands(const char *glsl)
{
    uint32_t count = 0;
    while (count < 4 && strstr(glsl, (const char[]){'$', (char)('a' + count), 0}))
        count++;
    return count;
}

/* What an operation calls, of each type; no scene has all of them. */
static void write_helpers(Op op, GraphType type)
{
    char    name[80];
    jmp_buf exhausted;
    Memory  memory = {.exhausted = &exhausted};
    Arena   arena  = {.memory = &memory};
    Text    text   = {.arena = &arena};
    if (setjmp(exhausted) != 0)
        exit(1);
    const uint32_t operands = count_operands(op_glsl(op));
    if (module_print_helpers(printers[KRS_TARGET_WGSL], op, type, operands, &text) &&
        text.length > 0) {
        snprintf(name, sizeof name, "variant-%s-%d", graph_op_name(op), (int)type);
        fprintf(list, "%s\n", name);
        write_bytes(name, "wgsl", text.bytes, text.length);
    }
    arena_free(&arena);
}

static void write_operations(void)
{
    for (Op op = OP_COMPONENT + 1; op < OP_COUNT; op++)
        for (GraphType type = TYPE_FLOAT; op_glsl(op) && type <= TYPE_UINT; type++)
            write_helpers(op, type);
}

/* ---- what examples do not call ---- */

#define TWO  "sphere(0.6), box([1, 0.8, 1.2]).move([0.6, 0.2, 0])"
#define FOUR TWO ", torus(0.8, 0.2).move([0, 0.5, 0]), cylinder(0.3, 1.5)"
#define SIX  FOUR ", octahedron(0.6).move([0, 0, 0.8]), cone(0.5, 1)"

static const char *const solids[] = {
    "show sphere(0.4).move([0.05, 0, 0]).repeat([1, 1.2, 0], [4, 3, 1]);",
    "param a = 1 in [0.9, 1.1]; show sphere(0.3).repeat(a);",
    "show sphere(0.2).move([1.5, 0, 0]).repeat_polar(7);",
    "show krs { kernel sphere(0.2); for i in 0..36 { reflect plane(random_direction(i), 0.3 + 0.02 "
    "* i); } };",
    "show union(" TWO ", blend: 0.4, kind: \"stairs\");",
    "show union(" FOUR ", blend: 0.4, kind: \"quadratic\");",
    "show union(" FOUR ", blend: 0.4, kind: \"cubic\");",
    "show union(" SIX ", blend: 0.4, kind: \"quadratic\");",
    "show union(" SIX ", blend: 0.4, kind: \"cubic\");",
    "show union(" TWO ", blend: 0.4, kind: \"circular\");",
    "show union(" TWO ", blend: 0.4, kind: \"chamfer\");",
    "show union(" TWO ", blend: 0.4, kind: \"exponential\");",
    "show union([sphere(0.25).move(2 * [2 * random(i) - 1, 2 * random(i + 0.3) - 1, 2 * random(i + "
    "0.6) - 1])"
    "    for i in 0..300], blend: 0.1, kind: \"exponential\");",
    "material house(cell) { color: mix(#6f6a66, #b39a7c, random(cell, 2)) }"
    "def lot(cell) = box([0.7, 0.5 + random(cell), 0.7]).paint(house(cell)); show lot.repeat([1, "
    "0, 1], count: [9, 0, 9]);",
    "show sphere(1).move([100000, 1, 0]); show plane([0, 1, 0], 0); show box([1, 1, "
    "1]).move([100003, 1, 0]);"
    "zone { center: [100000, 1, 1], radius: 0.7 } camera { eye: [100000, 2, 5], target: [100000, "
    "1, 0] }",
    "material glass { transmission: 1, ior: 1.5, absorption: [1, 0.2, 2] }"
    "show sphere(1).paint(glass); show box([1, 0.4, 3]).paint(glass); show sphere(0.5); zone { "
    "radius: 0.7 }",
};

/* Parts that are alike take long to compile: with few random scenes only those that join in all ways. */
static void write_solids(int random_scenes)
{
    for (size_t i = 0; i < sizeof solids / sizeof *solids; i++) {
        char      name[40];
        KrsScene *scene;
        snprintf(name, sizeof name, "solid-%zu", i + 1);
        expect(krs_compile_text(solids[i], strlen(solids[i]), "scene.krs", NULL, &scene));
        write_scene(name, scene, NULL);
        expect(krs_compile_text(solids[i], strlen(solids[i]), "scene.krs", &all_there_is, &scene));
        write_variants(scene, name);
    }
    const size_t groups = random_scenes < 100 ? PICTURED_GROUPS : instance_text_count;
    for (size_t i = 0; i < groups; i++) {
        char      name[40], *text = instance_text(&instance_texts[i], 1, 1);
        KrsScene *scene;
        snprintf(name, sizeof name, "instances-%zu", i + 1);
        expect(krs_compile_text(text, strlen(text), "scene.krs", NULL, &scene));
        write_scene(name, scene, NULL);
        free(text);
    }
}

int main(int count, char **arguments)
{
    char path[512];
    if (count < 3)
        return 2;
    folder = arguments[1];
    snprintf(path, sizeof path, "%s/list", folder);
    list = fopen(path, "w");
    if (!list)
        return 1;
    for (int i = 3; i < count; i++) {
        const char *slash = strrchr(arguments[i], '/'), *name = slash ? slash + 1 : arguments[i];
        KrsScene   *scene;
        expect(krs_compile_file(arguments[i], NULL, &scene));
        write_scene(name, scene, NULL);
        if (strstr(arguments[i], "golden/")) {
            expect(krs_compile_file(arguments[i], &all_there_is, &scene));
            write_variants(scene, name);
        }
    }
    write_functions("field", "shape f() { distance: max(0.2 * (",
                    "), length(p) - 3.5), within: sphere(3.5) } show f();", fields,
                    sizeof fields / sizeof *fields);
    write_functions("color", "material m { color: [", "] } show sphere(2).paint(m);", colors,
                    sizeof colors / sizeof *colors);
    write_operations();
    write_solids(atoi(arguments[2]));
    for (int i = 0; i < atoi(arguments[2]); i++)
        write_random(i);
    return fclose(list) != 0;
}
