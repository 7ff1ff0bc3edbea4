/*
 * explain.c: `krs explain`: the page of a diagnostic.
 */
#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "cli/shell/commands.h"
#include "cli/shell/console.h"
#include "compiler/base/diag.h"

/* What this command alone says of each code. */
static const struct {
    const char *title, *explanation;
} pages[DIAG_CODE_COUNT] = {
#define DIAG(code, severity, name, title, explanation) [DIAG_##name] = {title, explanation},
#include "compiler/base/diag.def"
#undef DIAG
};

static void print_list(void)
{
    for (size_t i = 0; i < DIAG_CODE_COUNT; i++)
        printf("%s  %s\n", diag_info[i].code, pages[i].title);
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
    const DiagCode found = (DiagCode)(info - diag_info);
    printf("%s[%s]: %s\n\n%s", diag_severity(found), info->code, pages[found].title,
           pages[found].explanation);
    return KRS_OK;
}
