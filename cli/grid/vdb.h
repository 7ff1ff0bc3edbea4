/*
 * vdb.h: the bridge to OpenVDB: a module of its own, since to load that library takes longer than most commands.
 */
#ifndef KRS_GRID_VDB_H
#define KRS_GRID_VDB_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "krs/krs.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Takes bytes of the file at an offset; false: there has been a failure. */
typedef bool VdbSink(void *user, const void *bytes, size_t count, uint64_t offset);

/* The contents of a file: a level set `surface`, or a fog volume `density`; and with them Cd and
   `material`. */
typedef struct VdbHow {
    KrsGridShape shape;
    bool         fog, color, material, half; /* half: numbers of the file have 16 bits, and fit */
} VdbHow;

typedef struct VdbModule {
    void *(*begin)(const VdbHow *how); /* NULL: there is no memory */
    bool (*add)(void *file, const KrsGridBrick *brick);
    /* False: the sink failed, or memory has run out.  Equal grids make equal bytes. */
    bool (*write)(void *file, VdbSink *sink, void *user);
    void (*end)(void *file);
} VdbModule;

/* The name of the module's only symbol, and of its file beside the command; or below the folder of libraries. */
#define VDB_SYMBOL    "krs_vdb_module"
#define VDB_FILE      "krs-vdb.so"
#define VDB_INSTALLED "../lib/krs/krs-vdb.so"

#ifdef __cplusplus
}
#endif

#endif
