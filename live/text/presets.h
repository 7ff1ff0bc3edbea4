/*
 * presets.h: named values of a scene's parameters, in a file beside the scene: SCENE.krs.presets.
 *
 * The file is text: a line `[name]`, and below it the values as `krs render --set` takes them.  What
 * does not fit the scene any more stays in the file.
 */
#ifndef KRS_PRESETS_H
#define KRS_PRESETS_H

#include <stdbool.h>

#include "krs/krs.h"

typedef struct PresetValue {
    char   name[64];
    double value[4];
    size_t count;
} PresetValue;

typedef struct Preset {
    char         name[64];
    PresetValue *values;
    size_t       count;
} Preset;

typedef struct Presets {
    Preset *items;
    size_t  count;
} Presets;

/* Reads those of a scene's file; without such a file there are none.  `root` is the only folder that may be read;
   NULL: any may. */
Presets presets_read(const char *scene_path, const char *root);
void    presets_free(Presets *presets);
/* Makes a preset of the values that a scene has, in place of one of this name; false: without
   memory. */
bool presets_set(Presets *presets, const char *name, const KrsScene *scene,
                 const double (*values)[4]);
/* Takes out the one with this number. */
void presets_remove(Presets *presets, size_t number);
/* Writes the file, whole or not at all; false: it cannot be written. */
bool presets_write(const Presets *presets, const char *scene_path);

#endif
