/*
 * sheet.h: what a bench of its own says: printed, and kept in bench/results/ under a head that says
 * where, when, of which revision and by which command.
 */
#ifndef KRS_BENCH_SHEET_H
#define KRS_BENCH_SHEET_H

#include <stdbool.h>
#include <stdio.h>

#include "krs/vulkan.h"

typedef struct Sheet {
    const char *bench; /* its name, and that of its file */
    FILE       *file;  /* NULL: what is asked for is a part, which is not kept */
    char        path[128], unfinished[128];
} Sheet;

/* Begins bench/results/DATE-BENCH-DEVICE.md, unless `part`; ends the process when it cannot.
   REVISION in the environment is the revision of the source. */
Sheet sheet_open(const char *bench, const char *title, const char *command,
                 const KrsRenderer *renderer, bool part);
void sheet_print(const Sheet *sheet, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Only now the file has its name. */
void sheet_close(Sheet *sheet);

/* "llvmpipe (LLVM 15.0.6, 256 bits)" is llvmpipe for the names of files. */
void device_slug(const char *device, char *slug, size_t size);

/* 2026-11-21. */
void date_today(char *date, size_t size);

#endif
