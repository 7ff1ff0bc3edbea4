/*
 * help.h: what the command says of itself: --help, pages of the manual, completions of shells.
 */
#ifndef KRS_HELP_H
#define KRS_HELP_H

#include <stdio.h>

#include "cli/options/options.h"

/* A sentence of several lines for each exit status. */
extern const char exit_statuses[];

/* Prints `krs --help` or `krs COMMAND --help`; `all`: also the options of GROUP_RESEARCH. */
void help_print(FILE *out);
void help_print_command(CommandId command, bool all, FILE *out);
/* Prints the passes of the compiler, a line each, on the page of `dump`; else nothing. */
void passes_print(CommandId command, FILE *out);

/* manual.c: the same as a page for man, of a command or, with COMMAND_COUNT, of `krs` itself. */
void manual_print(CommandId command, FILE *out);
/* completion.c: what a shell (bash, zsh or fish; else false) completes command lines by. */
bool completion_print(const char *shell, FILE *out);

#endif
