/*
 * completion.c: how shells complete command lines of `krs`, from the tables of --help.
 *
 * `krs --completion bash` and so on print what `make install` puts where each shell looks for it.
 * Commands, options, values that are one of a few words, codes of diagnostics, and files of the
 * endings that a command takes.
 */
#include <string.h>

#include "import/file.h"
#include "cli/help.h"
#include "compiler/base/diag.h"

/* ---- what the tables say ---- */

static bool is_path(const OptionInfo *option)
{
    return strcmp(option->argument, "FILE") == 0 || strncmp(option->argument, "DIR", 3) == 0;
}

static bool may_repeat(const OptionInfo *option) { return strstr(option->help, "may repeat"); }

/* Returns the endings of the files that a command takes, a blank between two. */
static const char *find_endings(CommandId command)
{
    if (command == COMMAND_IMPORT)
        return import_endings();
    if (command == COMMAND_MERGE || command == COMMAND_DENOISE)
        return ".exr";
    return takes_scenes(command) ? ".krs .krsz" : "";
}

/* Prints a text as it stands between single quotes, where characters of `special` get a backslash. */
static void print_inside(FILE *out, const char *text, const char *special, const char *quote)
{
    for (; *text; text++) {
        if (strchr(special, *text))
            fputc('\\', out);
        if (*text == '\'')
            fputs(quote, out);
        else
            fputc(*text, out);
    }
}

/* Prints the words, a blank between two, of which the command takes one. */
static void print_words(FILE *out, CommandId command)
{
    for (size_t i = 0; command == COMMAND_EXPLAIN && i < DIAG_CODE_COUNT; i++)
        fprintf(out, "%s%s", i > 0 ? " " : "", diag_info[i].code);
    for (CommandId i = 0; command == COMMAND_HELP && i < COMMAND_COUNT; i++)
        fprintf(out, "%s%s", i > 0 ? " " : "", command_table[i].name);
}

/* ---- bash ---- */

/* Tells whether a row before this one has the same option, of other commands. */
static bool is_told(OptionId id)
{
    OptionId first = 0;
    while (strcmp(option_info[first].name, option_info[id].name) != 0)
        first++;
    return first < id;
}

static void print_bash_values(FILE *out)
{
    for (OptionId id = 0; id < OPTION_COUNT; id++) {
        const OptionInfo *option = &option_info[id];
        char              text[OPTION_TEXT];
        const char       *words = option_words(option, text);
        if (!option->argument || is_told(id))
            continue;
        if (option->argument[0] == '[') /* left out, a file may follow */
            continue;
        fprintf(out, "    --%s", option->name);
        if (option->letter)
            fprintf(out, "|-%c", option->letter);
        if (words)
            fprintf(out, ") words='%s' ;;\n", words);
        else
            fprintf(out, ") %s;;\n", is_path(option) ? "_krs_files '' " : "");
    }
}

static void print_bash_options(FILE *out)
{
    for (CommandId command = 0; command < COMMAND_COUNT; command++) {
        fprintf(out, "        %s) endings='%s' words='", command_table[command].name,
                find_endings(command));
        for (OptionId id = 0; id < OPTION_COUNT; id++)
            if (option_belongs(id, command))
                fprintf(out, "--%s ", option_info[id].name);
        fputs("' ;;\n", out);
    }
}

static void print_bash(FILE *out)
{
    fputs("# krs.bash: completion of command lines of krs.\n"
          "_krs_files() { # endings\n"
          "    mapfile -t COMPREPLY < <(compgen -d -- \"$word\"\n"
          "        for ending; do compgen -f -X \"!*$ending\" -- \"$word\"; done)\n"
          "}\n"
          "_krs() {\n"
          "    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}\n"
          "    local words='' endings=''\n"
          "    COMPREPLY=()\n"
          "    [ \"$COMP_CWORD\" -gt 1 ] || before=first\n"
          "    case $before in\n"
          "    first) words='--help --version",
          out);
    for (CommandId command = 0; command < COMMAND_COUNT; command++)
        fprintf(out, " %s", command_table[command].name);
    fputs("' ;;\n", out);
    print_bash_values(out);
    for (CommandId command = 0; command < COMMAND_COUNT; command++) {
        if (command_table[command].files != MAYBE_A_WORD)
            continue;
        fprintf(out, "    %s) words='", command_table[command].name);
        print_words(out, command);
        fputs("' ;;\n", out);
    }
    fputs("    *)\n"
          "        case ${COMP_WORDS[1]} in\n",
          out);
    print_bash_options(out);
    fputs("        esac\n"
          "        [[ $word == -* ]] || words=''\n"
          "        [[ $word == -* || -z $endings ]] || _krs_files $endings ;;\n"
          "    esac\n"
          "    [ -z \"$words\" ] || mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n"
          "}\n"
          "complete -o filenames -F _krs krs\n",
          out);
}

/* ---- zsh ---- */

/* Prints a text for descriptions of _arguments and _describe. */
static void print_zsh_text(FILE *out, const char *text)
{
    print_inside(out, text, "\\[]:", "'\\''");
}

static void print_zsh_option(FILE *out, const OptionInfo *option)
{
    const char *equals = option->argument ? "=" : "", *plus = option->argument ? "+" : "";
    char        text[OPTION_TEXT], help[OPTION_TEXT], argument[OPTION_TEXT];
    const char *words = option_words(option, text);
    fputs(" \\\n        ", out);
    if (option->letter && may_repeat(option))
        fputs("'*'", out);
    else if (option->letter)
        fprintf(out, "'(-%c --%s)'", option->letter, option->name);
    if (option->letter)
        fprintf(out, "{-%c%s,--%s%s}'[", option->letter, plus, option->name, equals);
    else
        fprintf(out, "'%s--%s%s[", may_repeat(option) ? "*" : "", option->name, equals);
    print_zsh_text(out, option_help(option, help));
    fputs("]", out);
    if (option->argument) {
        fputs(option->argument[0] == '[' ? "::" : ":", out);
        print_zsh_text(out, option_argument(option, argument));
        if (words)
            fprintf(out, ":(%s)", words);
        else
            fprintf(out, ":%s", is_path(option) ? "_files" : " ");
    }
    fputs("'", out);
}

static void print_zsh_files(FILE *out, CommandId command)
{
    const CommandInfo *info = &command_table[command];
    if (info->files == MAYBE_A_WORD) {
        fprintf(out, " \\\n        '1:%s:(", command == COMMAND_EXPLAIN ? "code" : "command");
        print_words(out, command);
        fputs(")'", out);
    } else if (info->files != 0) {
        fprintf(out, " \\\n        '%s:file:_files -g \"", info->files == MANY_FILES ? "*" : "1");
        for (const char *c = find_endings(command); *c; c++)
            fprintf(out, "%s%c", *c == '.' ? "*" : "", *c);
        fputs("\"'", out);
    }
}

static void print_zsh(FILE *out)
{
    fputs("#compdef krs\n"
          "# _krs: completion of command lines of krs.\n"
          "local -a commands\n"
          "commands=(\n",
          out);
    for (CommandId command = 0; command < COMMAND_COUNT; command++) {
        fprintf(out, "    '%s:", command_table[command].name);
        print_zsh_text(out, command_table[command].summary);
        fputs("'\n", out);
    }
    fputs(")\n"
          "if (( CURRENT == 2 )); then\n"
          "    _describe -t commands command commands\n"
          "    _arguments '--help[the commands]' '--version[versions of krs and its libraries]'\n"
          "    return\n"
          "fi\n"
          "shift words\n"
          "(( CURRENT-- ))\n"
          "case $words[1] in\n",
          out);
    for (CommandId command = 0; command < COMMAND_COUNT; command++) {
        fprintf(out, "%s)\n    _arguments", command_table[command].name);
        for (OptionId id = 0; id < OPTION_COUNT; id++)
            if (option_belongs(id, command))
                print_zsh_option(out, &option_info[id]);
        print_zsh_files(out, command);
        fputs(" ;;\n", out);
    }
    fputs("esac\n", out);
}

/* ---- fish ---- */

static void print_fish_option(FILE *out, const char *command, const OptionInfo *option)
{
    char        text[OPTION_TEXT], help[OPTION_TEXT];
    const char *words = option_words(option, text);
    fprintf(out, "complete -c krs -n '__fish_seen_subcommand_from %s' -l %s", command,
            option->name);
    if (option->letter)
        fprintf(out, " -s %c", option->letter);
    if (words)
        fprintf(out, "%s -a '%s'", option->argument[0] == '[' ? "" : " -x", words);
    else if (option->argument)
        fputs(is_path(option) ? " -r -F" : " -x", out);
    fputs(" -d '", out);
    print_inside(out, option_help(option, help), "\\'", "'");
    fputs("'\n", out);
}

static void print_fish_files(FILE *out, CommandId command)
{
    char        ending[16];
    const char *name = command_table[command].name;
    if (command_table[command].files == MAYBE_A_WORD) {
        fprintf(out, "complete -c krs -n '__fish_seen_subcommand_from %s' -a '", name);
        print_words(out, command);
        fputs("'\n", out);
        return;
    }
    for (const char *at = find_endings(command); sscanf(at, "%15s", ending) == 1;
         at += strlen(ending) + (at[strlen(ending)] == ' '))
        fprintf(out,
                "complete -c krs -n '__fish_seen_subcommand_from %s' -k -a "
                "'(__fish_complete_suffix %s)'\n",
                name, ending);
}

static void print_fish(FILE *out)
{
    fputs("# krs.fish: completion of command lines of krs.\n"
          "complete -c krs -f\n"
          "complete -c krs -n __fish_use_subcommand -l help -d 'the commands'\n"
          "complete -c krs -n __fish_use_subcommand -l version "
          "-d 'versions of krs and its libraries'\n",
          out);
    for (CommandId command = 0; command < COMMAND_COUNT; command++) {
        const CommandInfo *info = &command_table[command];
        fprintf(out, "complete -c krs -n __fish_use_subcommand -a %s -d '", info->name);
        print_inside(out, info->summary, "\\'", "'");
        fputs("'\n", out);
        for (OptionId id = 0; id < OPTION_COUNT; id++)
            if (option_belongs(id, command))
                print_fish_option(out, info->name, &option_info[id]);
        print_fish_files(out, command);
    }
}

bool completion_print(const char *shell, FILE *out)
{
    static const struct {
        const char *name;
        void (*print)(FILE *out);
    } shells[] = {{"bash", print_bash}, {"zsh", print_zsh}, {"fish", print_fish}};
    for (size_t i = 0; i < sizeof shells / sizeof *shells; i++)
        if (strcmp(shell, shells[i].name) == 0) {
            shells[i].print(out);
            return true;
        }
    return false;
}
