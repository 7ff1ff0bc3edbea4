/*
 * modules.h: the SPIR-V of a scene without a device: every shader that includes the scene.
 */
#ifndef KRS_MODULES_H
#define KRS_MODULES_H

#include "cli/shell/commands.h"
#include "compiler/base/json.h"

typedef struct SpirvModule {
    const char *entry; /* "trace" */
    const char *file;  /* "trace.comp" */
    uint32_t   *words;
    size_t      word_count;
} SpirvModule;

typedef struct Modules {
    SpirvModule *items;
    size_t       count, capacity;
} Modules;

/* Returns the variant that suits graphics cards, unless the options differ. */
KrsVariant compiled_variant(const Options *options);

/* Compiles and validates every shader for the scene; when one is refused, a bug of ours, its
   log is said.  modules_free in either case. */
KrsStatus modules_compile(const Options *options, const KrsScene *scene, Modules *modules);
void      modules_free(Modules *modules);

/* Appends {"entry": "trace", "workgroup": [8, 8, 1], "bindings": [{"set": 0, ...}, ...]}. */
void module_add_json(Json *json, const SpirvModule *module);

#endif
