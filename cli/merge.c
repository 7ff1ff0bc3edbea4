/*
 * merge.c: `krs merge`: parts of a picture, from EXR files, as one file.
 */
#include <string.h>

#include "cli/farm/tiles.h"
#include "cli/shell/commands.h"
#include "cli/shell/console.h"
#include "cli/shell/supervise.h"

KrsStatus command_merge(Options *options)
{
    Tiles tiles;
    if (options->outputs.count != 1)
        return say_usage(options, "merge writes one file: -o whole.exr");
    const char *output = options->outputs.items[0];
    KrsStatus   status = KRS_OK;
    for (size_t i = 0; i < options->files.count && status == KRS_OK; i++)
        if (output_is_same(options->files.items[i], output))
            status = say_usage(options, "the output `%s` is one of the parts", output);
    stage_enter(STAGE_COMPILE);
    if (status == KRS_OK)
        status = tiles_read(options, options->files.items, options->files.count, &tiles);
    if (status != KRS_OK)
        return status;
    status = tiles_write(&tiles, output);
    tiles_free(&tiles);
    return status;
}
