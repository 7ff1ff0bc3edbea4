/*
 * presets.c: named values of a scene's parameters, in a file beside the scene.
 */
#include "live/text/presets.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/loader.h"
#include "compiler/base/paths.h"
#include "compiler/base/source.h"
#include "live/text/text_file.h"

static bool file_name(const char *scene_path, char path[4096])
{
    return snprintf(path, 4096, "%s.presets", scene_path) < 4096;
}

static Preset *add_preset(Presets *presets, const char *name)
{
    Preset *items = realloc(presets->items, (presets->count + 1) * sizeof *items);
    if (!items)
        return NULL;
    presets->items = items;
    Preset *added  = &items[presets->count++];
    *added         = (Preset){0};
    snprintf(added->name, sizeof added->name, "%s", name);
    return added;
}

static bool add_value(Preset *preset, const PresetValue *value)
{
    PresetValue *values = realloc(preset->values, (preset->count + 1) * sizeof *values);
    if (!values)
        return false;
    preset->values                  = values;
    preset->values[preset->count++] = *value;
    return true;
}

/* Parses "r=1.5" or "tint=[1, 0.5, 0]". */
static bool parse_value(const char *line, PresetValue *value)
{
    int at = 0;
    *value = (PresetValue){0};
    if (sscanf(line, " %63[A-Za-z0-9_] =%n", value->name, &at) != 1 || at == 0)
        return false;
    for (line += at + strspn(line + at, " ["); value->count < 4;) {
        char *end;
        value->value[value->count] = strtod(line, &end);
        if (end == line)
            break;
        value->count++;
        line = end + strspn(end, " ,");
    }
    return value->count > 0;
}

/* Reads a file by the rules for what a scene may read, if there is a folder that it may read
   from. */
static bool read_file(const char *scene_path, const char *root, Bytes *bytes)
{
    char   path[4096];
    Loader loader = {0};
    if (!file_name(scene_path, path))
        return false;
    if (!root)
        return text_file_read(path, bytes);
    if (!loader_open(&loader, root, scene_path))
        return false;
    path_simplify(path);
    const Loaded loaded = loader_read(&loader, path);
    loader_close(&loader);
    *bytes = (Bytes){loaded.owned, loaded.length};
    return loaded.owned && loaded.length <= MAX_SOURCE_BYTES;
}

Presets presets_read(const char *scene_path, const char *root)
{
    Presets presets = {0};
    Bytes   bytes   = {0};
    char    line[400], name[64];
    FILE   *file = read_file(scene_path, root, &bytes) && bytes.length > 0
                       ? fmemopen(bytes.text, bytes.length, "r")
                       : NULL;
    while (file && fgets(line, sizeof line, file)) {
        PresetValue value;
        if (sscanf(line, " [%63[^]\n]]", name) == 1)
            add_preset(&presets, name);
        else if (presets.count > 0 && parse_value(line, &value))
            add_value(&presets.items[presets.count - 1], &value);
    }
    if (file)
        fclose(file);
    free(bytes.text);
    return presets;
}

void presets_free(Presets *presets)
{
    for (size_t i = 0; i < presets->count; i++)
        free(presets->items[i].values);
    free(presets->items);
    *presets = (Presets){0};
}

bool presets_set(Presets *presets, const char *name, const KrsScene *scene,
                 const double (*values)[4])
{
    Preset *preset = NULL;
    for (size_t i = 0; i < presets->count; i++)
        if (strcmp(presets->items[i].name, name) == 0)
            preset = &presets->items[i];
    if (!preset)
        preset = add_preset(presets, name);
    if (!preset)
        return false;
    preset->count = 0;
    bool good     = true;
    for (size_t i = 0; i < krs_parameter_count(scene); i++) {
        KrsParameter parameter;
        PresetValue  value = {0};
        krs_parameter(scene, i, &parameter);
        snprintf(value.name, sizeof value.name, "%s", parameter.name);
        value.count = parameter.components;
        memcpy(value.value, values[i], sizeof value.value);
        good = add_value(preset, &value) && good;
    }
    return good;
}

void presets_remove(Presets *presets, size_t number)
{
    free(presets->items[number].values);
    presets->count--;
    memmove(presets->items + number, presets->items + number + 1,
            (presets->count - number) * sizeof *presets->items);
}

static void write_value(FILE *file, const PresetValue *value)
{
    fprintf(file, "%s=%s", value->name, value->count > 1 ? "[" : "");
    for (size_t i = 0; i < value->count; i++)
        fprintf(file, "%s%.17g", i == 0 ? "" : ", ", value->value[i]);
    fprintf(file, "%s\n", value->count > 1 ? "]" : "");
}

bool presets_write(const Presets *presets, const char *scene_path)
{
    char  path[4096];
    Bytes bytes = {0};
    FILE *file  = file_name(scene_path, path) ? open_memstream(&bytes.text, &bytes.length) : NULL;
    for (size_t i = 0; file && i < presets->count; i++) {
        fprintf(file, "%s[%s]\n", i == 0 ? "" : "\n", presets->items[i].name);
        for (size_t k = 0; k < presets->items[i].count; k++)
            write_value(file, &presets->items[i].values[k]);
    }
    const bool good = file && fclose(file) == 0 && text_file_write(path, &bytes);
    free(bytes.text);
    return good;
}
