/*
 * manual.c: the manual and the completion of command lines, from the tables of --help.
 *
 * `make install` writes them to files: `krs --manual` is krs.1, `krs --manual render` is
 * krs-render.1, `krs --completion` is what bash reads.
 */
#include <ctype.h>
#include <string.h>

#include "cli/options.h"
#include "compiler/base/diag.h"

/* ---- pages for man ---- */

/* Text in which nothing is a request of troff, line by line. */
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

static void print_option(FILE *out, const OptionInfo *option)
{
    fputs(".TP\n", out);
    if (option->letter)
        fprintf(out, "\\fB\\-%c\\fR, ", option->letter);
    fputs("\\fB\\-\\-", out);
    print_plain(out, option->name);
    fputs("\\fR", out);
    if (option->argument) {
        fputs(" \\fI", out);
        print_plain(out, option->argument);
        fputs("\\fR", out);
    }
    fputs("\n", out);
    print_plain(out, option->help);
    fputs("\n", out);
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
    fputs(".fi\n.SH OPTIONS\n", out);
    for (OptionId id = 0; id < OPTION_COUNT; id++)
        if (option_belongs(id, command))
            print_option(out, &option_info[id]);
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

/* ---- completion ---- */

/* The words of "on|off" or of "neutral, aces or none", a blank between two; false: other values
   are possible as well. */
static bool find_choices(const OptionInfo *option, char *words, size_t size)
{
    const char *from = option->argument && strchr(option->argument, '|') ? option->argument
                                                                         : option->wants;
    size_t length = 0;
    bool   listed = false;
    for (; from && *from && length + 2 < size; from++) {
        if (strncmp(from, " or ", 4) == 0 || strncmp(from, ", ", 2) == 0 || *from == '|') {
            listed         = true;
            words[length++] = ' ';
            from += *from == '|' ? 0 : *from == ',' ? 1 : 3;
        } else if (islower((unsigned char)*from) || *from == '-')
            words[length++] = *from;
        else
            return false;
    }
    words[length] = '\0';
    return listed;
}

static bool is_path(const OptionInfo *option)
{
    return strcmp(option->argument, "FILE") == 0 || strncmp(option->argument, "DIR", 3) == 0;
}

static void print_values(FILE *out)
{
    for (OptionId id = 0; id < OPTION_COUNT; id++) {
        const OptionInfo *option = &option_info[id];
        char              words[256];
        if (!option->argument || option->argument[0] == '[')
            continue;
        fprintf(out, "    --%s", option->name);
        if (option->letter)
            fprintf(out, "|-%c", option->letter);
        if (find_choices(option, words, sizeof words))
            fprintf(out, ") words='%s' ;;\n", words);
        else if (is_path(option))
            fputs(") _krs_files '' ;;\n", out);
        else
            fputs(") ;;\n", out);
    }
}

static void print_options(FILE *out)
{
    for (CommandId command = 0; command < COMMAND_COUNT; command++) {
        fprintf(out, "        %s) words='", command_table[command].name);
        for (OptionId id = 0; id < OPTION_COUNT; id++)
            if (option_belongs(id, command))
                fprintf(out, "--%s ", option_info[id].name);
        fputs("' ;;\n", out);
    }
}

void completion_print(FILE *out)
{
    fputs("# krs.bash: completion of command lines of krs.\n"
          "_krs_files() { # ending\n"
          "    mapfile -t COMPREPLY < <(compgen -d -- \"$word\"\n"
          "                             compgen -f -X \"!*$1\" -- \"$word\")\n"
          "}\n"
          "_krs() {\n"
          "    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} words=\n"
          "    COMPREPLY=()\n", out);
    fputs("    [ \"$COMP_CWORD\" -gt 1 ] || before=first\n"
          "    case $before in\n"
          "    first) words='--help --version", out);
    for (CommandId command = 0; command < COMMAND_COUNT; command++)
        fprintf(out, " %s", command_table[command].name);
    fputs("' ;;\n", out);
    print_values(out);
    fputs("    explain) words='", out);
    for (size_t i = 0; i < DIAG_CODE_COUNT; i++)
        fprintf(out, "%s ", diag_info[i].code);
    fputs("' ;;\n"
          "    *)\n"
          "        [[ $word == -* ]] || _krs_files .krs\n"
          "        [[ $word == -* ]] && case ${COMP_WORDS[1]} in\n", out);
    print_options(out);
    fputs("        esac ;;\n"
          "    esac\n"
          "    [ -z \"$words\" ] || mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n"
          "}\n"
          "complete -o filenames -F _krs krs\n", out);
}
