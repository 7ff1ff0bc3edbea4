/*
 * inspect.h: a look at a scene while its shapes are there; a compiled scene has none.
 */
#ifndef KRS_INSPECT_H
#define KRS_INSPECT_H

#include "compiler/base/diag.h"
#include "compiler/krs.h"
#include "compiler/shape/scene.h"

/* All of it lives until the look is over.  `diags` is empty; what is added is reported. */
typedef struct Inspected {
    const Scene *scene; /* its graph may grow */
    Diags       *diags;
    Arena       *arena, *scratch; /* `scratch` is free to use, and to free */
} Inspected;

typedef KrsStatus Inspect(void *user, const Inspected *what);

/* As krs_compile_file, but then `inspect` says what comes of it, and nothing is kept.  Warnings are
   for those who compile, and not repeated. */
KrsStatus inspect_file(const char *path, const KrsOptions *options, Inspect *inspect, void *user);

#endif
