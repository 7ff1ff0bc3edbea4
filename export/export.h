/*
 * export.h: a scene as a file for a program that has shaders of its own.
 */
#ifndef KRS_EXPORT_H
#define KRS_EXPORT_H

#include "compiler/base/text.h"
#include "krs/krs.h"

typedef enum ExportId {
#define EXPORT_TARGET(id, name, template, ending, tables, cameras, longest, about) EXPORT_##id,
#include "export/targets.def"
    EXPORT_COUNT
} ExportId;

/* The properties of a target, as its row says them. */
typedef struct ExportTarget {
    const char *name, *template, *ending;
    bool        tables, cameras;
    size_t      longest;
} ExportTarget;
extern const ExportTarget export_targets[EXPORT_COUNT];

/* Adds the file for a target to `file`.  `name` is that of the scene.  KRS_BAD_ARGUMENT: the target cannot have it, and
   `file` says why, in words of its author.  KRS_OUT_OF_MEMORY. */
KrsStatus export_scene(KrsState *state, ExportId target, const char *name, size_t camera,
                       Text *file);

#endif
