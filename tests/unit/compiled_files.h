/*
 * compiled_files.h: what a renderer leaves in the folder of its cache.
 */
#ifndef UNIT_COMPILED_FILES_H
#define UNIT_COMPILED_FILES_H

#include <limits.h>
#include <sys/types.h>

#include "krs/vulkan.h"

/* Returns the files that end in `ending`: how many, and which of them is the last in the alphabet. */
int       count_files_that_end(const char *ending, char last[NAME_MAX + 1]);
KrsStatus open_and_close(const KrsRendererOptions *options);
/* A file that is written again is another one, because writing is renaming. */
ino_t number_of(const char *name);

/* A shader that needs nothing. */
extern const char small_text[];

#endif
