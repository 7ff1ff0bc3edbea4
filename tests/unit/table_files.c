/*
 * table_files.c: what `krs compile` writes for those who bind the tables of a scene by themselves: the
 * files have what krs_state_tables gives, the description names them, and the text compiles.
 */
#include <endian.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "compiler/base/text.h"
#include "compiler/scene/compiled.h"
#include "compiler/target/spirv.h"
#include "tests/support/folder.h"

static char *command; /* the path of krs */

static const char parts[] =
    "param height = 1 in [0.5, 2];"
    "show union([sphere(0.1 + 0.001 * i).move([i, 0, 0]) for i in 0..150])"
    ".move([0, height, 0]);"
    "for i in 0..160 { show box([0.2, 0.3, 0.2 + 0.01 * i]).move([i, 0, 3]); }";

/* ---- files ---- */

static void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

/* With a 0 behind it.  NULL: there is none. */
static char *read_file(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return NULL;
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    *size       = (size_t)ftell(file);
    char *bytes = calloc(1, *size + 1);
    rewind(file);
    assert_int_equal(fread(bytes, 1, *size, file), *size);
    fclose(file);
    return bytes;
}

/* Writes a scene, and runs `krs compile` on it. */
static void compile_files(const char *text)
{
    char line[4096];
    write_file("parts.krs", text);
    snprintf(line, sizeof line, "'%s' compile parts.krs -o out", command);
    assert_int_equal(system(line), 0);
}

/* ---- tables ---- */

static void assert_words(const char *path, const void *wanted, size_t size)
{
    size_t count;
    char  *bytes = read_file(path, &count);
    assert_non_null(bytes);
    assert_int_equal(count, size);
    for (size_t i = 0; i < size; i += 4) {
        uint32_t word, expected;
        memcpy(&word, bytes + i, 4);
        memcpy(&expected, (const char *)wanted + i, 4);
        assert_int_equal(le32toh(word), expected);
    }
    free(bytes);
}

static void assert_in_description(const char *wanted)
{
    size_t size;
    char  *json = read_file("out/parts.json", &size);
    assert_non_null(json);
    if (!strstr(json, wanted))
        fail_msg("no %s in %s", wanted, json);
    free(json);
}

static void files_have_the_tables(void **context)
{
    KrsScene *scene;
    KrsState *state;
    char      wanted[512];
    (void)context;
    compile_files(parts);
    assert_int_equal(krs_compile_file("parts.krs", NULL, &scene), KRS_OK);
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    size_t row_count = krs_table_rows(scene), cell_count = krs_table_cells(scene);
    assert_true(row_count >= 310 && cell_count > 16);
    float(*rows)[4]     = calloc(row_count, sizeof *rows);
    uint32_t(*cells)[2] = calloc(cell_count, sizeof *cells);
    krs_state_tables(state, rows, cells);
    assert_words("out/parts.rows.bin", rows, row_count * sizeof *rows);
    assert_words("out/parts.cells.bin", cells, cell_count * sizeof *cells);
    snprintf(wanted, sizeof wanted,
             "\"table_rows\": %zu, \"table_cells\": %zu, \"texel_buffers\": ["
             "{\"name\": \"krs_rows\", \"set\": 0, \"binding\": 1, \"format\": \"RGBA32F\", "
             "\"texels\": %zu, \"file\": \"parts.rows.bin\"}, "
             "{\"name\": \"krs_cells\", \"set\": 0, \"binding\": 2, \"format\": \"RG32UI\", "
             "\"texels\": %zu, \"file\": \"parts.cells.bin\"}]",
             row_count, cell_count, row_count, cell_count);
    assert_in_description(wanted);
    snprintf(wanted, sizeof wanted, "\"tables\": {\"kinds\": 2, \"rows\": 310, \"bytes\": %zu}",
             row_count * sizeof *rows + cell_count * sizeof *cells);
    assert_in_description(wanted);
    free(rows);
    free(cells);
    krs_state_free(state);
    krs_scene_free(scene);
}

/* A parameter is none of their numbers. */
static void tables_are_equal_in_all_states(void **context)
{
    KrsScene *scene;
    KrsState *state;
    (void)context;
    compile_files(parts);
    assert_int_equal(krs_compile_text(parts, strlen(parts), "parts.krs", NULL, &scene), KRS_OK);
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    assert_int_equal(krs_state_set(state, "height", (double[]){2}, 1), KRS_OK);
    assert_int_equal(krs_state_set_time(state, 7), KRS_OK);
    float(*rows)[4]     = calloc(krs_table_rows(scene), sizeof *rows);
    uint32_t(*cells)[2] = calloc(krs_table_cells(scene), sizeof *cells);
    krs_state_tables(state, rows, cells);
    assert_words("out/parts.rows.bin", rows, krs_table_rows(scene) * sizeof *rows);
    assert_words("out/parts.cells.bin", cells, krs_table_cells(scene) * sizeof *cells);
    free(rows);
    free(cells);
    krs_state_free(state);
    krs_scene_free(scene);
}

static void no_tables_no_files(void **context)
{
    size_t size;
    (void)context;
    compile_files("show sphere(1);");
    assert_in_description("\"tables\": {\"kinds\": 0, \"rows\": 0, \"bytes\": 0}");
    assert_in_description("\"table_rows\": 0, \"table_cells\": 0, \"texel_buffers\": []");
    assert_int_equal(access("out/parts.rows.bin", F_OK), -1);
    assert_int_equal(access("out/parts.cells.bin", F_OK), -1);
    char *text = read_file("out/parts.glsl", &size);
    assert_null(strstr(text, "krs_rows"));
    assert_null(strstr(text, "krs_cells"));
    free(text);
}

/* ---- the text ---- */

static const char shader_head[] =
    "#version 460\n"
    "layout(local_size_x = 1) in;\n"
    "layout(std430, set = 1, binding = 0) buffer Out { float d[]; };\n";
static const char shader_main[] = "void main()\n{\n    krs_prepare();\n"
                                  "    d[0] = krs_distance(vec3(1.0));\n}\n";

static void the_text_compiles(void **context)
{
    size_t    length, count;
    char     *log = NULL;
    uint32_t *words;
    (void)context;
    compile_files(parts);
    char *text = read_file("out/parts.glsl", &length);
    assert_non_null(text);
    assert_non_null(strstr(text, "binding = 1) uniform samplerBuffer krs_rows;"));
    assert_non_null(strstr(text, "binding = 2) uniform usamplerBuffer krs_cells;"));
    assert_non_null(strstr(text, "// Parts that are alike are rows of krs_rows"));
    char *shader = calloc(1, sizeof shader_head + length + sizeof shader_main);
    strcat(strcat(strcpy(shader, shader_head), text), shader_main);
    spirv_start();
    if (spirv_compile(shader, "parts", &words, &count, &log) != KRS_OK)
        fail_msg("%s", log ? log : "no memory");
    spirv_stop();
    free(words);
    free(shader);
    free(text);
}

int main(void)
{
    const char *path = getenv("KRS");
    command          = realpath(path ? path : "build/krs", NULL);
    if (!command) {
        fprintf(stderr, "there is no krs\n");
        return 1;
    }
#define TEST(name) cmocka_unit_test_setup_teardown(name, enter_folder, leave_folder)
    const struct CMUnitTest tests[] = {
        TEST(files_have_the_tables),
        TEST(tables_are_equal_in_all_states),
        TEST(no_tables_no_files),
        TEST(the_text_compiles),
    };
    int failed = cmocka_run_group_tests_name("table files", tests, NULL, NULL);
    free(command);
    return failed;
}
