/*
 * compiled_files.c: what a renderer leaves in the folder of its cache.
 */
#include "tests/unit/compiled_files.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

const char small_text[] = "#version 440\n"
                          "layout(local_size_x = 1) in;\n"
                          "shared uint x;\n"
                          "void main() { x = gl_WorkGroupID.x; }\n";

int count_files_that_end(const char *ending, char last[NAME_MAX + 1])
{
    struct dirent **found;
    int             count = 0, all = scandir(".", &found, NULL, alphasort);
    for (int i = 0; i < all; i++) {
        const char *dot = strrchr(found[i]->d_name, '.');
        if (dot && strcmp(dot, ending) == 0) {
            snprintf(last, NAME_MAX + 1, "%s", found[i]->d_name);
            count++;
        }
        free(found[i]);
    }
    free(found);
    return count;
}

KrsStatus open_and_close(const KrsRendererOptions *options)
{
    KrsRenderer *renderer;
    KrsStatus    status = krs_renderer_new(options, &renderer);
    krs_renderer_free(renderer);
    return status;
}

ino_t number_of(const char *name)
{
    struct stat info;
    assert_int_equal(stat(name, &info), 0);
    return info.st_ino;
}
