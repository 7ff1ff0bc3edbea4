/*
 * explain.c: `krs explain`: the page of a diagnostic.
 */
#include <stdio.h>

#include "cli/commands.h"
#include "cli/console.h"
#include "compiler/base/diag.h"

static void print_list(void)
{
    for (size_t i = 0; i < DIAG_CODE_COUNT; i++)
        printf("%s  %s\n", diag_info[i].code, diag_info[i].title);
}

KrsStatus command_explain(Options *options)
{
    if (options->files.count == 0) {
        print_list();
        return KRS_OK;
    }
    const DiagInfo *info = diag_find(options->files.items[0]);
    if (!info)
        return say_usage(options, "there is no diagnostic `%s`; `krs explain` lists them",
                         options->files.items[0]);
    printf("%s[%s]: %s\n\n%s", info->severity == DIAG_ERROR ? "error" : "warning", info->code,
           info->title, info->explanation);
    return KRS_OK;
}
