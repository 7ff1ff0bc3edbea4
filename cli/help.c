/*
 * help.c: the pages of --help; manual.c and completion.c have the other forms of them.
 */
#include "cli/help.h"

#include <string.h>

#include "cli/shell/commands.h"
#include "cli/shell/console.h"
#include "compiler/passes/compile.h"

const char exit_statuses[] =
    "0 done; 1 the scene is wrong or beyond a limit; 2 wrong usage; 69 no device; 70 a bug, or\n"
    "the driver's; 71 out of memory; 73 cannot create the output; 74 cannot read the scene\n"
    "or write the output; 75 interrupted, with a checkpoint (--resume); 130 interrupted.\n"
    "SIGUSR1, by which batch systems warn, is an interrupt where --resume has a checkpoint, and\n"
    "else ignored.  Deadlines and limits count time of work, not of being stopped or starved.\n";

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

/* Columns of a page, and where texts of options begin. */
enum { PAGE_WIDTH = 80, TEXT_COLUMN = 33 };

/* Prints words in lines that begin at TEXT_COLUMN; `column` is where the first begins. */
static void print_wrapped(const char *text, size_t column, FILE *out)
{
    for (size_t length; *text; text += length) {
        text += strspn(text, " ");
        length = strcspn(text, " ");
        if (column > TEXT_COLUMN && column + 1 + length > PAGE_WIDTH) {
            fputc('\n', out);
            column = 0;
        }
        int blanks = column < TEXT_COLUMN ? (int)(TEXT_COLUMN - column) : column > TEXT_COLUMN;
        fprintf(out, "%*s%.*s", blanks, "", (int)length, text);
        column += (size_t)blanks + length;
    }
    fputc('\n', out);
}

static void print_option(const OptionInfo *option, FILE *out)
{
    char argument[OPTION_TEXT] = "", text[OPTION_TEXT];
    int  column                = fprintf(out, "    ");
    if (option->letter)
        column += fprintf(out, "-%c, ", option->letter);
    column += fprintf(out, "--%s %s", option->name,
                      option->argument ? option_argument(option, argument) : "");
    if (column >= TEXT_COLUMN) { /* it has a line of its own */
        fputc('\n', out);
        column = 0;
    }
    print_wrapped(option_help(option, text), (size_t)column, out);
}

static void print_group(OptionGroup group, CommandId command, FILE *out)
{
    fprintf(out, "\n%s:\n", group_headings[group]);
    for (OptionId id = 0; id < OPTION_COUNT; id++)
        if (option_info[id].group == group && option_belongs(id, command))
            print_option(&option_info[id], out);
}

void help_print_command(CommandId command, bool all, FILE *out)
{
    const CommandInfo *info = &command_table[command];
    fprintf(out, "krs %s: %s\n\n%s", info->name, info->summary, info->examples);
    passes_print(command, out);
    fprintf(out, "\nusage: krs %s [OPTION]... %s\n", info->name, info->arguments);
    for (OptionGroup group = 0; group < GROUP_COUNT; group++)
        if (group_belongs(group, command) && (all || group != GROUP_RESEARCH))
            print_group(group, command, out);
    if (!all && group_belongs(GROUP_RESEARCH, command))
        fprintf(out, "\nMore options compare methods with each other: `krs help %s --all`.\n",
                info->name);
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
    help_print_command(command, options->all, stdout);
    return KRS_OK;
}
