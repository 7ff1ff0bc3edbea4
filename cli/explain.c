/*
 * explain.c: `krs explain`: the page of a diagnostic.
 */
#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "cli/shell/commands.h"
#include "cli/shell/console.h"
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
    char *code           = arena_copy_text(options->arena, options->files.items[0],
                                           strlen(options->files.items[0]));
    code[0]              = (char)toupper((unsigned char)code[0]); /* e0203, too */
    const DiagInfo *info = diag_find(code);
    if (!info)
        return say_usage(options, "there is no diagnostic `%s`; `krs explain` lists them",
                         options->files.items[0]);
    printf("%s[%s]: %s\n\n%s", diag_severity((DiagCode)(info - diag_info)), info->code, info->title,
           info->explanation);
    return KRS_OK;
}
