/*
 * export.h: a scene as files for a program that has shaders of its own.
 */
#ifndef KRS_EXPORT_H
#define KRS_EXPORT_H

#include "compiler/base/text.h"
#include "krs/krs.h"

typedef enum ExportId {
#define EXPORT_TARGET(id, name, words, language, source, tables, baked, cameras, longest, about) \
    EXPORT_##id,
#include "export/targets.def"
    EXPORT_COUNT
} ExportId;

/* Where tables of parts that are alike, and textures, are. */
typedef enum ExportTables {
    EXPORT_WITHOUT_TABLES,
    EXPORT_TABLES_INSIDE,
    EXPORT_TABLES_BESIDE /* in files of their own */
} ExportTables;

/* In which language a scene's text is. */
typedef enum ExportLanguage {
    EXPORT_IN_SHORT_ESSL, /* without comments and indents */
    EXPORT_IN_GLSL,
    EXPORT_IN_ESSL,
    EXPORT_IN_WGSL,
    EXPORT_IN_HLSL,
    EXPORT_IN_MSL,
    EXPORT_IN_HLSL_PART,   /* parameters are a global that a shader fills */
    EXPORT_IN_HLSL_STRUCT, /* all is in a struct, for a text within a function */
    EXPORT_IN_GDSHADER,
    EXPORT_IN_OSL
} ExportLanguage;

/* The properties of a target, as its row says them. */
typedef struct ExportTarget {
    const char    *name, *words; /* vec3 is `words` with a 3 for its # */
    ExportLanguage language;
    const char
        *source; /* the template of what another language is made of; NULL: the scene's text */
    ExportTables tables;
    const char  *baked; /* NULL: it can have no samples; else how their file ends */
    bool         cameras;
    size_t       longest;
} ExportTarget;
extern const ExportTarget export_targets[EXPORT_COUNT];

/* A file that is called STEM`ending`. */
typedef struct ExportFile {
    const char *ending;
    Text        text;
} ExportFile;

typedef struct ExportFiles {
    ExportFile *items;
    size_t      count, capacity;
} ExportFiles;

/* Tells how a target's first file ends, and how many there are beside tables. */
const char *export_ending(ExportId target);
size_t      export_file_count(ExportId target);

typedef struct ExportOptions {
    ExportId    target;
    const char *name, *stem; /* of the scene; of the files, without their endings */
    size_t      camera;
    uint32_t    bake;      /* samples along the longest side; 0: the scene is a text */
    size_t      component; /* which is sampled alone, from 1; 0: all */
    bool        within;    /* of what is in a box alone */
    double      low[3], high[3];
} ExportOptions;

/* Adds the files for a target, in memory of the arena of `why`.  KRS_BAD_ARGUMENT: the target cannot have the scene, and
   `why` says why, in words of its author.  KRS_OUT_OF_MEMORY; KRS_IO_ERROR. */
KrsStatus export_scene(KrsState *state, const ExportOptions *options, ExportFiles *files,
                       Text *why);

#endif
