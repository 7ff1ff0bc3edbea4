/* vdb.c: OpenVDB's files, by a module that is loaded when one is asked for. */
#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "cli/shell/console.h"
#include "cli/grid/vdb.h"
#include "cli/grid/gridding.h"

/* Finds the path of a file in the folder of this program, or told from there. */
static bool find_beside(const char *name, char path[PATH_MAX])
{
    char    self[PATH_MAX];
    ssize_t length = readlink("/proc/self/exe", self, sizeof self - 1);
    if (length <= 0)
        return false;
    self[length]        = '\0';
    *strrchr(self, '/') = '\0';
    return snprintf(path, PATH_MAX, "%s/%s", self, name) < PATH_MAX && access(path, R_OK) == 0;
}

static const VdbModule *load(const char *for_path)
{
    static const VdbModule *loaded;
    char                    path[PATH_MAX];
    if (loaded)
        return loaded;
    if (!find_beside(VDB_FILE, path) && !find_beside(VDB_INSTALLED, path)) {
        say("cannot write `%s`: there is no `" VDB_FILE "` beside this krs, which is built where "
            "libopenvdb-dev is installed; or write .npy, .nii, .ktx2, .vti or .vtu",
            for_path);
        return NULL;
    }
    void *module = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!module || !(loaded = dlsym(module, VDB_SYMBOL)))
        say("cannot write `%s`: OpenVDB cannot be loaded: %s", for_path, dlerror());
    return loaded;
}

KrsStatus grid_check_vdb(const char *path) { return load(path) ? KRS_OK : KRS_CANNOT_CREATE; }

static bool out_of_memory(GridFile *file)
{
    if (file->error->status == KRS_OK) {
        file->error->status = KRS_OUT_OF_MEMORY;
        snprintf(file->error->message, sizeof file->error->message,
                 "not enough memory for this file; a larger --cell needs less");
    }
    return false;
}

bool grid_begin_vdb(GridFile *file)
{
    const GridSheet *sheet = file->sheet;
    VdbHow           how   = {sheet->shape, sheet->fog, sheet->color, sheet->material, sheet->half};
    if (sheet->half)
        how.shape.band = half_value((float)sheet->shape.band);
    file->own = load("")->begin(&how);
    return file->own || out_of_memory(file);
}

bool grid_add_vdb(GridFile *file, const KrsGridBrick *brick)
{
    KrsGridBrick rounded = *brick;
    float        values[KRS_BRICK_SAMPLES];
    for (int i = 0; i < KRS_BRICK_SAMPLES && file->sheet->half; i++)
        values[i] = half_value(brick->values[i]);
    if (file->sheet->half)
        rounded.values = values;
    return load("")->add(file->own, &rounded) || out_of_memory(file);
}

static bool sink(void *user, const void *bytes, size_t count, uint64_t offset)
{
    const GridFile *file = user;
    return output_write(file->file, bytes, count, offset);
}

bool grid_end_vdb(GridFile *file)
{
    bool written = load("")->write(file->own, sink, file) || out_of_memory(file);
    load("")->end(file->own);
    return written;
}
