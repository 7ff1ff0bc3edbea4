/*
 * help.c: the pages of --help; manual.c and completion.c have the other forms of them.
 */
#include "cli/help.h"

#include <string.h>

#include "cli/commands.h"
#include "cli/console.h"
#include "compiler/compile.h"

const char exit_statuses[] =
    "0 done; 1 the scene is wrong or beyond a limit; 2 wrong usage; 69 no device; 70 a bug, or\n"
    "the driver's; 71 out of memory; 73 cannot create the output; 74 cannot read the scene\n"
    "or write the output; 75 interrupted, with a checkpoint (--resume); 130 interrupted.\n";

void help_print(FILE *out)
{
    fputs("krs renders scenes of implicit surfaces.\n\n"
          "    krs render ring.krs -o ring.png\n"
          "    krs check ring.krs\n\n"
          "usage: krs COMMAND [OPTION]... [FILE]...\n\n",
          out);
    for (CommandId command = 0; command < COMMAND_COUNT; command++)
        fprintf(out, "    %-10s %s\n", command_table[command].name, command_table[command].summary);
    fprintf(out,
            "\n`krs help COMMAND` shows examples and options, `krs --version` the version.\n"
            "Exit status: %s",
            exit_statuses);
}

void passes_print(CommandId command, FILE *out)
{
    const KrsPass *pass;
    for (size_t i = 0; command == COMMAND_DUMP && (pass = krs_pass(i)); i++)
        fprintf(out, "    %-10s%-10s%s\n", pass->name,
                strcmp(pass->name, pass->form) == 0 ? "" : pass->form, pass->meaning);
}

void help_print_command(CommandId command, FILE *out)
{
    const CommandInfo *info = &command_table[command];
    fprintf(out, "krs %s: %s\n\n%s", info->name, info->summary, info->examples);
    passes_print(command, out);
    fprintf(out, "\nusage: krs %s [OPTION]... %s\n\n", info->name, info->arguments);
    for (OptionId id = 0; id < OPTION_COUNT; id++) {
        if (!option_belongs(id, command))
            continue;
        const OptionInfo *option = &option_info[id];
        char              form[64], letter[8] = "", argument[OPTION_TEXT] = "", text[OPTION_TEXT];
        if (option->letter)
            snprintf(letter, sizeof letter, "-%c, ", option->letter);
        snprintf(form, sizeof form, "%s--%s %s", letter, option->name,
                 option->argument ? option_argument(option, argument) : "");
        bool wide = strlen(form) > 28;
        fprintf(out, "    %-28s%s %s\n", form, wide ? "\n                                " : "",
                option_help(option, text));
    }
}

KrsStatus command_help(Options *options)
{
    if (options->files.count == 0) {
        help_print(stdout);
        return KRS_OK;
    }
    CommandId command = find_command(options->files.items[0]);
    if (command == COMMAND_COUNT)
        return say_no_command(options->files.items[0]);
    help_print_command(command, stdout);
    return KRS_OK;
}
