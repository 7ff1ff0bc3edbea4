/*
 * texts.c: writes what the compiler makes of scenes, for core.mjs to compare with.
 *
 *     texts FOLDER COUNT FILE...
 *
 * COUNT scenes are random; FILE... are read.  FOLDER/NAME.scene is a text, NAME.glsl what is made of it, NAME.numbers the
 * parameters and tables that that reads, and NAME.distances those at some points.  FOLDER/list has a name in each line, and
 * its path.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/disk.h"
#include "tests/oracle/random_scene.h"
#include "tests/support/instance_texts.h"

static const char *folder;

static void write_bytes(const char *name, const char *ending, const void *bytes, size_t length)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s.%s", folder, name, ending);
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(bytes, 1, length, file) != length || fclose(file) != 0)
        exit(1);
}

static void write_numbers(const char *name, const KrsScene *scene, KrsState *state)
{
    const size_t slots = krs_parameter_slots(scene), rows = krs_table_rows(scene),
                 cells  = krs_table_cells(scene);
    const size_t length = 16 * slots + 16 * rows + 8 * cells;
    float(*numbers)[4]  = calloc(length + 1, 1);
    krs_state_parameters(state, numbers);
    krs_state_tables(state, numbers + slots, (uint32_t(*)[2])(numbers + slots + rows));
    write_bytes(name, "numbers", numbers, length);
    free(numbers);
}

/* Distances on a lattice. */
static void write_distances(const char *name, KrsState *state)
{
    enum { COUNT = 64 };
    double points[COUNT][3], distances[COUNT] = {0};
    for (int i = 0; i < COUNT; i++) {
        points[i][0] = 0.7 * (i % 4 - 1.5);
        points[i][1] = 0.7 * (i / 4 % 4 - 1.5);
        points[i][2] = 0.7 * (i / 16 - 1.5);
    }
    krs_distance(state, (const double(*)[3])points, COUNT, distances);
    write_bytes(name, "distances", distances, sizeof distances);
}

/* A text that is too large for shaders is empty. */
static void write_scene(FILE *list, const char *name, const char *path, const char *text,
                        size_t length)
{
    const KrsOptions options = {0};
    KrsScene        *scene;
    KrsState        *state;
    char            *glsl = NULL;
    write_bytes(name, "scene", text, length);
    fprintf(list, "%s %s\n", name, path);
    if (krs_compile_text(text, length, path, &options, &scene) != KRS_OK)
        return;
    krs_text(scene, KRS_TARGET_GLSL, NULL, &glsl);
    write_bytes(name, "glsl", glsl ? glsl : "", glsl ? strlen(glsl) : 0);
    if (krs_state_new(scene, &state) != KRS_OK)
        exit(1);
    write_numbers(name, scene, state);
    write_distances(name, state);
    krs_state_free(state);
    krs_scene_free(scene);
    free(glsl);
}

/* Each tenth has parts that are alike. */
static void write_random(FILE *list, int number)
{
    static SceneText text;
    Random           random = {(uint64_t)number};
    char             name[40];
    snprintf(name, sizeof name, "random-%d", number);
    text.length = 0;
    if (number % 10 == 0) {
        const size_t which = (size_t)(number / 10) % instance_text_count;
        char        *own   = instance_text(&instance_texts[which], 1, number);
        write_scene(list, name, "scene.krs", own, strlen(own));
        free(own);
        return;
    }
    write_random_scene(&text, &random, vec(0, 0, 0), 1);
    write_scene(list, name, "scene.krs", text.bytes, text.length);
}

int main(int count, char **arguments)
{
    char path[512];
    if (count < 3)
        return 2;
    folder = arguments[1];
    snprintf(path, sizeof path, "%s/list", folder);
    FILE *list = fopen(path, "w");
    if (!list)
        return 1;
    for (int i = 0; i < atoi(arguments[2]); i++)
        write_random(list, i);
    for (int i = 3; i < count; i++) {
        const char  *slash  = strrchr(arguments[i], '/');
        const Loaded loaded = disk_read(arguments[i]);
        if (!loaded.text)
            return 1;
        write_scene(list, slash ? slash + 1 : arguments[i], arguments[i], loaded.text,
                    loaded.length);
        free(loaded.owned);
    }
    return fclose(list) != 0;
}
