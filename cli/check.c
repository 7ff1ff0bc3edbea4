/*
 * check.c: `krs check`: mistakes in scenes, without a device.
 */
#include "cli/shell/commands.h"

/* Goes through all files and returns the status of the first that failed. */
KrsStatus command_check(Options *options)
{
    KrsStatus worst = KRS_OK;
    for (size_t i = 0; i < options->files.count; i++) {
        KrsScene *scene;
        KrsStatus status = scene_open(options, options->files.items[i], &scene);
        if (status == KRS_OK)
            krs_scene_free(scene);
        else if (worst == KRS_OK)
            worst = status;
    }
    return worst;
}
