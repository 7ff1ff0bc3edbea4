/*
 * inspect.h: access to the elaborated scene with its shapes, which a compiled scene has no longer, and
 * to scenes with fewer or more groups.
 */
#ifndef KRS_INSPECT_H
#define KRS_INSPECT_H

#include "compiler/base/diag.h"
#include "krs/krs.h"
#include "compiler/shape/scene.h"

/* An elaborated scene, for the time of the call.  `diags` is empty; what is added is reported. */
typedef struct Inspected {
    const Scene  *scene; /* nodes may be added to its graph */
    Diags        *diags;
    Arena        *arena, *scratch; /* `scratch` may be used, and freed */
    const double *pass_ms; /* time of each pass that ran (krs_pass, compile.h), in milliseconds */
} Inspected;

typedef KrsStatus Inspect(void *user, const Inspected *what);

/* Compiles a text or, where that is NULL, the file `name`, calls `inspect` and returns its status.  The compiled scene is freed.  Warnings
   of the compiler are not reported. */
KrsStatus inspect_text(const char *text, size_t length, const char *name, const KrsOptions *options,
                       Inspect *inspect, void *user);

/* Does the same of a text, for which only the passes up to `elaborate` run. */
KrsStatus inspect_elaborated(const char *text, size_t length, const KrsOptions *options,
                             Inspect *inspect, void *user);

/* Compiles a text as krs_compile_text does, but parts that are alike are an instance group from
   this number of instances on; UINT32_MAX: they stay separate.  So tests hold instance groups
   against separate parts. */
KrsStatus compile_with_instances(const char *text, size_t length, uint32_t least,
                                 const KrsOptions *options, KrsScene **scene);

/* Does so, and evaluates loops iteration by iteration, though these differ in numbers only. */
KrsStatus compile_iteration_by_iteration(const char *text, size_t length, uint32_t least,
                                         const KrsOptions *options, KrsScene **scene);

#endif
