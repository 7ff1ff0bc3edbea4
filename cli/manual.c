/*
 * manual.c: the pages of the manual, from the tables of --help.
 *
 * `make install` writes them to files: `krs --manual` is krs.1, `krs --manual render` is
 * krs-render.1.
 */
#include <ctype.h>
#include <string.h>

#include "cli/help.h"

/* Prints text in which nothing is a request of troff, line by line. */
static void print_plain(FILE *out, const char *text)
{
    for (bool begin = true; *text; begin = *text++ == '\n') {
        if (begin && (*text == '.' || *text == '\''))
            fputs("\\&", out);
        if (*text == '\\')
            fputs("\\e", out);
        else if (*text == '-')
            fputs("\\-", out);
        else if (*text == '`')
            fputs("\\(ga", out);
        else if (*text == '\'')
            fputs("\\(aq", out);
        else
            fputc(*text, out);
    }
}

static void print_title(FILE *out, const char *name, const char *summary)
{
    fputs(".TH ", out);
    for (const char *c = name; *c; c++)
        fputc(toupper((unsigned char)*c), out);
    fprintf(out, " 1 \"\" \"krs %s\" \"krs\"\n.SH NAME\n", KRS_VERSION);
    print_plain(out, name);
    fputs(" \\- ", out);
    print_plain(out, summary);
    fputs("\n", out);
}

/* Prints what the words mean, if more is to be said of them; the default is in italics. */
static void print_choices(FILE *out, const Choice *choices)
{
    if (!choices || !choices->about[0])
        return;
    fputs(".RS\n", out);
    for (; choices->name; choices++) {
        if (!choices->name[0])
            continue;
        bool asked = find_choice(choices->name, choices) == 0;
        fputs(asked ? ".TP\n\\fB" : ".TP\n\\fI", out);
        print_plain(out, choices->name);
        fputs("\\fR\n", out);
        print_plain(out, choices->about);
        fputs("\n", out);
    }
    fputs(".RE\n", out);
}

static void print_option(FILE *out, const OptionInfo *option)
{
    char text[OPTION_TEXT];
    fputs(".TP\n", out);
    if (option->letter)
        fprintf(out, "\\fB\\-%c\\fR, ", option->letter);
    fputs("\\fB\\-\\-", out);
    print_plain(out, option->name);
    fputs("\\fR", out);
    if (option->argument) {
        fputs(" \\fI", out);
        print_plain(out, option_argument(option, text));
        fputs("\\fR", out);
    }
    fputs("\n", out);
    print_plain(out, option_help(option, text));
    fputs("\n", out);
    print_choices(out, option->choices);
}

static void print_group(FILE *out, OptionGroup group, CommandId command)
{
    fputs(".SS ", out);
    print_plain(out, group_headings[group]);
    fputs("\n", out);
    for (OptionId id = 0; id < OPTION_COUNT; id++)
        if (option_info[id].group == group && option_belongs(id, command))
            print_option(out, &option_info[id]);
}

static void print_command_page(CommandId command, FILE *out)
{
    const CommandInfo *info = &command_table[command];
    char               name[64];
    snprintf(name, sizeof name, "krs-%s", info->name);
    print_title(out, name, info->summary);
    fprintf(out, ".SH SYNOPSIS\n.B krs %s\n[OPTION]... ", info->name);
    print_plain(out, info->arguments);
    fputs("\n.SH EXAMPLES\n.nf\n", out);
    print_plain(out, info->examples);
    passes_print(command, out);
    fputs(".fi\n.SH OPTIONS\n", out);
    for (OptionGroup group = 0; group < GROUP_COUNT; group++)
        if (group_belongs(group, command))
            print_group(out, group, command);
    fputs(".SH EXIT STATUS\n", out);
    print_plain(out, exit_statuses);
    fputs(".SH SEE ALSO\n.BR krs (1)\n", out);
}

static void print_overview(FILE *out)
{
    print_title(out, "krs", "renders scenes of implicit surfaces");
    fputs(".SH SYNOPSIS\n.B krs\nCOMMAND [OPTION]... [FILE]...\n.SH COMMANDS\n", out);
    for (CommandId command = 0; command < COMMAND_COUNT; command++) {
        fprintf(out, ".TP\n.BR krs\\-%s (1)\n", command_table[command].name);
        print_plain(out, command_table[command].summary);
        fputs("\n", out);
    }
    fputs(".SH EXIT STATUS\n", out);
    print_plain(out, exit_statuses);
    fputs(".SH SEE ALSO\n", out);
    for (CommandId command = 0; command < COMMAND_COUNT; command++)
        fprintf(out, ".BR krs\\-%s (1)%s\n", command_table[command].name,
                command + 1 < COMMAND_COUNT ? "," : "");
}

void manual_print(CommandId command, FILE *out)
{
    if (command == COMMAND_COUNT)
        print_overview(out);
    else
        print_command_page(command, out);
}
